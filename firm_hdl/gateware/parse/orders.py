"""Orders: what the sequencer tells the mover to do, one per step."""

from __future__ import annotations

import types
from collections.abc import MutableMapping
from typing import Any

from amaranth.hdl import Module, Mux, Signal, Value
from amaranth.lib import data, enum, stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.positions import Ring
from firm_hdl.gateware.signatures import Status
from firm_hdl.names.attributes import REMARK
from firm_hdl.plan import Plan
from firm_hdl.program import state_names

__all__ = ["OrderQueue", "order_layout"]


def order_layout(plan: Plan) -> data.StructLayout:
    """Return the payload of orders, which come in wire order.

    Members
    -------
    step : enumeration of the steps
    blank : unsigned(1)
        The order has no step, and writes no leaf.
    items_at, map_at : position, without the lap bit
        First byte of the word of items, and of the map's last word. The word of items is the first
        word of a map that has two.
    items_next, map_next : slot
        The beats after the beats of these bytes.
    items_bytes, map_bytes : range(bus_bytes + 1)
        Good bytes of these words; values with later bytes transfer as 0. `map_bytes` is the bus
        width unless the packet has an error.
    items : unsigned(1)
        Items of a counted run transfer.
    last : unsigned(1)
        The transfer of items is the last one of the run.
    length_good : unsigned(1)
        The length is legal and not 0; otherwise it transfers as 0.
    final : unsigned(levels)
        Bit k: the current element of loop k is its last one.
    first : beat
        Neither this order nor a later one needs a beat before this one.
    ends : unsigned(1)
        The packet ends with this order.
    status : Status
        The result of the packet that ends.
    """
    ring, bus = Ring(plan), plan.bus_bytes
    return data.StructLayout(
        {
            "step": _step_type(plan),
            "blank": 1,
            "items_at": ring.bits - 1,
            "map_at": ring.bits - 1,
            "items_next": ring.beat_bits - 1,
            "map_next": ring.beat_bits - 1,
            "items_bytes": range(bus + 1),
            "map_bytes": range(bus + 1),
            "items": 1,
            "last": 1,
            "length_good": 1,
            "final": max(1, plan.levels),
            "first": ring.beat_bits,
            "ends": 1,
            "status": Status,
        }
    )


def _step_type(plan: Plan) -> type:
    """Return the enumeration of the steps, so that the circuit's text has names for them."""

    def members(namespace: MutableMapping[str, Any]) -> None:
        for number, name in enumerate(state_names(plan)):
            # An enumeration may have no member `mro`.
            namespace[name.upper()] = number

    shape = range(max(2, len(plan.steps)))
    return types.new_class("Step", (enum.IntEnum,), {"shape": shape}, members)


class OrderQueue(wiring.Component):
    """A queue of two orders, so that `i.ready` is a register.

    Members
    -------
    i : In(stream.Signature(order_layout(plan)))
    o : Out(stream.Signature(order_layout(plan)))
        Latency 1 cycle.
    oldest : In(beat)
        The first beat that the sequencer still needs.
    freed : Out(beat)
        The first beat that any order or the sequencer still needs.
    stall_newest, zero_length : In(1)
        As of :class:`Sequencer`; not used if the plan has no claims. No order comes while
        `stall_newest` is high.
    """

    def __init__(self, plan: Plan):
        layout, beat = order_layout(plan), Ring(plan).beat_bits
        self.stalls = plan.has_claims
        super().__init__(
            {
                "i": In(stream.Signature(layout)),
                "o": Out(stream.Signature(layout)),
                "oldest": In(beat),
                "freed": Out(beat),
                "stall_newest": In(1),
                "zero_length": In(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        second = Signal(
            self.i.payload.shape(),
            reset_less=True,
            attrs={REMARK: "the order that came while o was waiting"},
        )
        has_second = Signal()
        # Without a budget, the first register is `o` itself.
        first, valid, ready = self.o.payload, self.o.valid, self.o.ready
        if self.stalls:
            shape = first.shape()
            first, valid = Signal(shape, name="first", reset_less=True), Signal(name="has_first")
            ready = self._wait(m, first, valid, has_second)
        m.d.comb += [
            self.i.ready.eq(~has_second),
            self.freed.eq(Mux(valid, first.first, Mux(has_second, second.first, self.oldest))),
        ]
        # `o` waits for `ready` even if it has no order: so `ready` alone enables its registers.
        with m.If(ready):
            m.d.sync += [
                valid.eq(self.i.valid | has_second),
                first.eq(Mux(has_second, Value.cast(second), Value.cast(self.i.payload))),
                has_second.eq(0),
            ]
        with m.Elif(self.i.valid):
            m.d.sync += has_second.eq(1)
        with m.If(~has_second):
            m.d.sync += second.eq(self.i.payload)
        return m

    def _wait(self, m: Module, first: data.View, valid: Signal, has_second: Signal) -> Value:
        """Let the newest order wait for the check of its length; return whether the first moves.

        That a length is refused is a bit of its own: the orders' own bits come late in the cycle.
        """
        # The newest order is `second`, if there is one; else `first`. While it waits, the orders
        # before it go on, so that their leaves are not delayed by the check.
        #
        #   cycle          | 0       | 1       | 2       | 3       | 4       | 5
        #   i              | length  |         |         |         |         | blank
        #   stall_newest   |         | 1       | 1       | 1       | 1       |
        #   zero_length    |         |         |         |         | 1       |
        #   first          |         | length  | length  | length  | length  | length, refused
        #   o.valid        |         | 0       | 0       | 0       | 0       | 1
        waits, ready = Signal(name="waits"), Signal(name="moves")
        first_refused, second_refused = Signal(name="first_refused"), Signal(name="second_refused")
        m.d.comb += [
            waits.eq(self.stall_newest & ~has_second),
            ready.eq(self.o.ready & ~waits),
            self.o.valid.eq(valid & ~waits),
            self.o.payload.eq(first),
            self.o.payload.length_good.eq(first.length_good & ~first_refused),
        ]
        with m.If(ready):
            m.d.sync += [
                first_refused.eq(has_second & (second_refused | self.zero_length)),
                second_refused.eq(0),
            ]
        with m.Elif(self.zero_length & has_second):
            m.d.sync += second_refused.eq(1)
        with m.Elif(self.zero_length):
            m.d.sync += first_refused.eq(1)
        return ready
