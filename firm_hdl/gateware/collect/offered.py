"""Lengths that producers offer, decoded one cycle before they are taken."""

from __future__ import annotations

from amaranth.hdl import Module, Mux, Signal, Value
from amaranth.lib import stream

from firm_hdl.gateware.flow import exceeds, last_word
from firm_hdl.program import Length

__all__ = ["OfferedLength"]


class OfferedLength:
    """Registers with the decoded length that a leaf offers. Not a component: logic of one module.

    Parameters
    ----------
    length : Length
    port : stream.Interface
        Stream of the leaf.

    Attributes
    ----------
    known : Signal(1)
        The fields belong to the length that is offered now. High from one cycle after the offer
        until the transfer.
    zero, over : Signal(1)
        The length is 0, or above its limit.
    skips : Signal(1)
        The body is skipped: the length is 0, or all items are in the rest.
    single : Signal(1)
        At most one pass of the body: one element, or one word.
    rest : Signal(range(lanes + 1))
        Number of items in the rest; always 0 for a loop.
    held : Signal(1)
        Input: the fields keep their values, because the length was taken, but its step is not
        complete.
    """

    def __init__(self, m: Module, length: Length, port: stream.Interface):
        leaf = length.leaf
        self.known = Signal(name=f"known_{leaf}")
        names = ("zero", "over", "skips", "single")
        self.zero, self.over, self.skips, self.single = (
            Signal(name=f"{name}_{leaf}", reset_less=True) for name in names
        )
        self.held = Signal(name=f"held_{leaf}")
        m.d.sync += self.known.eq(port.valid & ~port.ready & ~self.held)
        with m.If(~self.held):
            self._decode(m, length, port.payload)

    def _decode(self, m: Module, length: Length, value: Value) -> None:
        zero = ~value.any()
        m.d.sync += [self.zero.eq(zero), self.over.eq(exceeds(value, length.limit))]
        if length.level is not None:
            self.rest = Signal(1, name=f"rest_{length.leaf}")
            m.d.sync += [self.skips.eq(zero), self.single.eq(value == 1)]
            return
        lanes = length.lanes
        self.rest = Signal(range(lanes + 1), name=f"rest_{length.leaf}", reset_less=True)
        m.d.sync += [
            self.skips.eq(~exceeds(value, lanes)),
            self.single.eq(~exceeds(value, 2 * lanes)),
            self.rest.eq(Mux(zero, 0, last_word(value, lanes))),
        ]
