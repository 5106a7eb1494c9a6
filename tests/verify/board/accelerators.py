"""A loop with a fault, for a node in simulation."""

from __future__ import annotations

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring

from firm_hdl.node import accelerator_signature

__all__ = ["Flips"]


class Flips(wiring.Component):
    """Send truth values back; the third one is wrong."""

    def __init__(self, description):
        super().__init__(accelerator_signature(description))

    def elaborate(self, platform):
        m = Module()
        came = self.subscribe.loopback_in_std_msgs_Bool.data
        goes = self.publish.loopback_out_std_msgs_Bool.data
        count = Signal(8)
        m.d.comb += [
            goes.payload.eq(came.payload ^ (count == 2)),
            goes.valid.eq(came.valid),
            came.ready.eq(goes.ready),
        ]
        with m.If(goes.valid & goes.ready):
            m.d.sync += count.eq(count + 1)
        return m
