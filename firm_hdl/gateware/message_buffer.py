"""The message buffer: it lets a deserializer feed a serializer at full rate."""

from __future__ import annotations

from amaranth.hdl import Module, Mux, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.component import Component
from firm_hdl.gateware.members import member_tree
from firm_hdl.gateware.signatures import MessageSignature, leaf_streams
from firm_hdl.model import Message
from firm_hdl.plan import build_plan
from firm_hdl.wire import Wire, lay_out

__all__ = ["MessageBuffer"]


class MessageBuffer(Component):
    """Let a deserializer run ahead of the serializer that it feeds.

    A serializer takes a `length` one cycle after the length is offered, and a deserializer waits
    while the register of its next leaf is full. Connected directly, they wait for each other in
    every string and sequence. The buffer has a second register for each `length` and each `items`;
    other leaves pass through.

    Latency 0. `ready` of the buffered leaves is a register; so no combinational path leads from
    their consumer to the deserializer.

    Parameters
    ----------
    message, wire, bus_bytes
        As for :class:`Deserializer`.

    Members
    -------
    i : In(MessageSignature(message, bus_bytes))
    o : Out(MessageSignature(message, bus_bytes))
    """

    def __init__(self, message: Message, *, wire: Wire | None = None, bus_bytes: int = 8):
        self._plan = build_plan(lay_out(message, wire), bus_bytes=bus_bytes)
        signature = MessageSignature(message, plan=self._plan)
        super().__init__({"i": In(signature), "o": Out(signature)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        leaves = self._plan.leaves
        tree = member_tree(leaf.path for leaf in leaves)
        sinks = leaf_streams(self.o, tree)
        for index, source in leaf_streams(self.i, tree).items():
            if leaves[index].kind in ("length", "items"):
                _hold_one(m, source, sinks[index], index)
            else:
                wiring.connect(m, wiring.flipped(source), wiring.flipped(sinks[index]))
        return m


def _hold_one(m: Module, source: stream.Interface, sink: stream.Interface, index: int) -> None:
    """Connect a stream; one transfer that the sink does not take at once waits in a register."""
    #   cycle         | 0     | 1     | 2     | 3
    #   source        | a     | b     | b     |
    #   source.ready  | 1     | 0     | 1     | 1
    #   held          |       | a     |       |
    #   sink          | a     | a     | b     |
    #   sink.ready    | 0     | 1     | 1     |
    has = Signal(name=f"has_{index}")
    came = Value.cast(source.payload)
    held = Signal(len(came), name=f"held_{index}", reset_less=True)
    m.d.comb += [
        source.ready.eq(~has),
        sink.valid.eq(source.valid | has),
        Value.cast(sink.payload).eq(Mux(has, held, came)),
    ]
    m.d.sync += has.eq(sink.valid & ~sink.ready)
    with m.If(~has):
        m.d.sync += held.eq(came)
