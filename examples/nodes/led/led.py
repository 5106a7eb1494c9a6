"""A number comes in and is shown by lights; where buttons change, their number goes out."""

from __future__ import annotations

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.cdc import FFSynchronizer
from amaranth.lib.wiring import In, Out

from firm_hdl.node import Description, accelerator_signature

__all__ = ["Led"]


class Led(wiring.Component):
    """The accelerator. `lights` and `buttons` are pins, which the description names."""

    def __init__(self, description: Description) -> None:
        super().__init__(accelerator_signature(description, lights=Out(8), buttons=In(2)))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        came, sent = self.subscribe.lights.data, self.publish.buttons.data
        m.d.comb += came.ready.eq(1)
        with m.If(came.valid):
            m.d.sync += self.lights.eq(came.payload)

        # Pins change at any time, so they go through two registers first.
        now, before = Signal(2), Signal(2)
        m.submodules.buttons = FFSynchronizer(self.buttons, now)
        with m.If((now != before) & ~sent.valid):
            m.d.sync += [before.eq(now), sent.payload.eq(now), sent.valid.eq(1)]
        with m.If(sent.valid & sent.ready):
            m.d.sync += sent.valid.eq(0)
        return m
