from amaranth.hdl import Module
from amaranth.lib import wiring

from firm_hdl.node import accelerator_signature


class Double(wiring.Component):
    def __init__(self, description):
        super().__init__(accelerator_signature(description))

    def elaborate(self, platform):
        m = Module()
        came, sent = self.subscribe.number.data, self.publish.double.data
        m.d.comb += [
            sent.payload.eq(came.payload * 2),
            sent.valid.eq(came.valid),
            came.ready.eq(sent.ready),
        ]
        return m
