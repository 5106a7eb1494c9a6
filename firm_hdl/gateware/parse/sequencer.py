"""The sequencer: the control flow of a program over packets in the buffer, without their data."""

from __future__ import annotations

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.parse.budget import Budget
from firm_hdl.gateware.parse.buffer import ArrivalSignature
from firm_hdl.gateware.parse.orders import order_layout
from firm_hdl.gateware.parse.walk import Findings, Walk
from firm_hdl.gateware.positions import Ring, named, sum_of_three
from firm_hdl.gateware.signatures import Status
from firm_hdl.program import DeserializerProgram

__all__ = ["Sequencer"]


class Sequencer(wiring.Component):
    """Run a program over the packets in the buffer: check them, and give orders to the mover.

    Each state gives one order, once all its bytes are in the buffer. The sequencer waits only for
    bytes and for `orders.ready`. The last order of a packet carries its status. The page "How the
    converters work" follows one packet through all cycles.

    An error in the bytes of a state takes two cycles: one finds it, and one computes which bytes
    are good. Then the state is ordered with its good bytes. All later states are ordered without
    bytes and with lengths of 0, and the rest of the packet is dropped::

        cycle         | 0        | 1         | 2            | 3
        state         | s        | s         | s            | next one
        found         | 1        |           |              |
        bad           |          | 1         | 1            | 1
        new_error     |          | 1         |              |
        *_room        |          |           | good bytes   | 0
        orders.valid  |          |           | s            | next one

    A length over its limit takes no cycle: its state transfers it as 0.

    A length that is charged to the :class:`Budget` stalls the sequencer before the next state. Its
    order waits, too. If the length claims too much, its order transfers it as 0, and the sequencer
    goes back to the length's state, and leaves it with an order that has no state::

        cycle         | 0        | 1         | 2         | 3         | 4           | 5
        state         | length   | body      | body      | body      | body        | length
        pending       |          | 1         | 1         | 1         | 1           |
        zero_length   |          |           |           |           | 1           |
        orders.valid  | length   |           |           |           |             | blank

    Parameters
    ----------
    program : DeserializerProgram

    Members
    -------
    arrival : In(ArrivalSignature(plan))
        `next` is high as the packet's last order is taken.
    oldest : Out(beat)
        The sequencer needs no beat before this one.
    stall_newest : Out(1)
        The newest order must wait: its length is not checked yet.
    zero_length : Out(1)
        The newest order must transfer its length as 0. Only in the last cycle of `stall_newest`.
    orders : Out(stream.Signature(order_layout(plan)))
        `valid` does not depend on `ready`; the payload is stable only with `valid`.
    """

    def __init__(self, program: DeserializerProgram):
        self.program = program
        super().__init__(
            {
                "arrival": In(ArrivalSignature(program.plan)),
                "oldest": Out(Ring(program.plan).beat_bits),
                "stall_newest": Out(1),
                "zero_length": Out(1),
                "orders": Out(stream.Signature(order_layout(program.plan))),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        program, arrival, ready = self.program, self.arrival, self.orders.ready
        # The packet has an error; it was found in the cycle before, in this state.
        bad = Signal()
        new_error = Signal()
        code = Signal(Status)
        walk = Walk(m, program, arrival, bad)
        found = walk.find()
        issue = Signal()

        # The budget. While a length is not checked, its error would be the first one.
        pending: Value = Const(0, 1)
        claims_too_much: Value | None = None
        if program.plan.has_claims:
            m.submodules.budget = budget = Budget(program)
            pending, claims_too_much = budget.pending, budget.fails
            m.d.comb += [
                budget.step.eq(walk.flow.bits),
                budget.starts.eq(issue & walk.length.charged & ~bad),
                budget.count.eq(walk.length.count),
                self.stall_newest.eq(pending),
                self.zero_length.eq(claims_too_much),
            ]

        # The first error in wire order. A length above its limit does not stop its state.
        overrun = walk.ends_message & ~arrival.ended & found.trailing
        stops = Signal()
        m.d.comb += stops.eq((found.header | found.nul | found.cut | overrun) & ~pending)
        with m.If(issue & walk.ends_packet):
            m.d.sync += bad.eq(0)
        with m.Elif(~bad):
            m.d.sync += [
                bad.eq(stops | (issue & found.over)),
                code.eq(Mux(walk.ends_message, Status.TRAILING, Status.LENGTH)),
            ]
            with m.If(found.header):
                m.d.sync += code.eq(Status.ENCAPSULATION)
            with m.Elif(found.nul):
                m.d.sync += code.eq(Status.STRING)
            with m.Elif(found.cut):
                m.d.sync += code.eq(Status.TRUNCATED)
        m.d.sync += new_error.eq(stops & ~bad)
        if claims_too_much is not None:
            # An error that was found before is later in wire order. No packet ends in this cycle.
            with m.If(claims_too_much):
                m.d.sync += [bad.eq(1), code.eq(Status.LENGTH)]

        # The order. Without an error, it is given if it is allowed and the bytes are good. `good`
        # is late in the cycle; so it is a factor of its own, and all else is computed before it.
        drains = Signal()
        allowed = Signal()
        m.d.comb += [
            drains.eq(bad & ~new_error & (~walk.at_end | arrival.ended)),
            allowed.eq(~bad & (~walk.ends_message | arrival.ended) & ~walk.too_early & ~pending),
            self.orders.valid.eq(drains | (allowed & found.good)),
            issue.eq((drains & ready) | (allowed & ready & found.good)),
            arrival.next.eq(
                (drains & ready & walk.ends_packet)
                | (allowed & ready & walk.ends_packet & found.good)
            ),
            self.oldest.eq(walk.ring.beat(walk.first_at)),
        ]
        self._order(m, walk, found, bad, new_error, code, drains & ready)
        walk.advance(issue, revisit=claims_too_much)
        return m

    def _order(
        self,
        m: Module,
        walk: Walk,
        found: Findings,
        bad: Signal,
        new_error: Signal,
        code: Signal,
        drained: Value,
    ) -> None:
        """Compute the order of the state, and after an error how many bytes of it are good.

        A state has two words: that of items is a rest, a word of a counted run, or the first word
        of a map with two; the other one is the map, or its last word.

        * `drained`: after an error, the state is executed.
        """
        flow, ring, bus = walk.flow, walk.ring, self.program.plan.bus_bytes
        limit, order = self.arrival.limit, self.orders.payload
        map_offset = flow.register(
            "map_offset",
            bus.bit_length() + 1,
            lambda s: s.map_offset,
            remark="signed: first byte of the map's last word, relative to last_at",
        )
        two_word_map = flow.register(
            "two_word_map", 1, lambda s: s.two_word_map, remark="the map has two bus words"
        )
        is_counted = flow.register(
            "is_counted",
            1,
            lambda s: s.is_counted,
            remark="the step is a word that a length counts",
        )
        offset = map_offset.as_signed()

        # First bytes of the two words.
        items_at, map_at = ring.position("items_at"), ring.position("map_at")
        first_beat = named(
            m, "first_beat_of_map", (ring.beat(map_at) - two_word_map)[: ring.beat_bits]
        )
        first_word: Value = Cat(ring.lane(map_at), first_beat)
        # A choice whose condition is a constant would hide the concatenation from the Verilog back
        # end, which gives such vectors a net of their own.
        if not isinstance(walk.takes_rest, Const):
            first_word = Mux(walk.takes_rest, walk.first_at, first_word)
        m.d.comb += [map_at.eq(walk.last_at + offset), items_at.eq(first_word)]

        # After an error: good bytes of the two words, from the cycle after `new_error` on.
        items_room = Signal(range(bus + 1))
        map_room = Signal(range(bus + 1))
        map_left = ring.position("map_left", remark="signed: limit - map_at")
        # limit - map_at = limit + not_last_at + 1 - map_offset, as one sum from registers.
        to_first = named(m, "one_less_map_offset", 1 - offset, "1 - map_offset, signed")
        m.d.comb += map_left.eq(
            sum_of_three(m, "map_left", limit, walk.not_last_at, to_first.as_signed())
        )
        # If the map has two words, the word of items is the first one. A negative `map_left` is at
        # least -bus: the packet ends within the first word.
        in_front = Mux(ring.beat(map_left).all(), ring.lane(map_left), 0)
        of_map = Signal(range(bus + 1), name="map_room_if_cut")
        m.d.comb += of_map.eq(self._room(map_left))
        items_left = named(m, "items_left", (limit - walk.first_at)[: ring.bits])
        of_rest = named(m, "rest_room_if_cut", self._room(items_left))
        of_items = Mux(walk.takes_rest, of_rest, of_map)
        of_items = Mux(two_word_map, Mux(map_left[-1], in_front, bus), of_items)
        of_items = named(m, "items_room_if_cut", of_items)
        bad_drained = named(m, "bad_drained", bad & drained)
        with m.If(bad & new_error):
            # The bytes that trail, and those of a string before its NUL, are good.
            trails, is_string = code == Status.TRAILING, code == Status.STRING
            m.d.sync += [
                items_room.eq(Mux(trails | is_string, bus, 0)),
                map_room.eq(Mux(trails, bus, 0)),
            ]
            with m.If(code == Status.TRUNCATED):
                m.d.sync += [items_room.eq(of_items), map_room.eq(of_map)]
        with m.Elif(bad_drained):
            m.d.sync += [items_room.eq(0), map_room.eq(0)]

        wanted = Signal(range(bus + 1), name="items_wanted")
        good_status = Signal(Status)
        with m.If(found.trailing):
            m.d.comb += good_status.eq(Status.TRAILING)
        m.d.comb += [
            wanted.eq(Mux(walk.takes_rest, flow.rest_bytes(walk.rest), bus)),
            order.step.eq(flow.select(len(order.step), lambda s: 0 if s.at_end else s.number)),
            order.blank.eq(walk.at_end | walk.revisits),
            order.items_at.eq(items_at),
            order.map_at.eq(map_at),
            order.items_next.eq(ring.slot(items_at) + 1),
            order.map_next.eq(ring.slot(map_at) + 1),
            order.items_bytes.eq(Mux(bad & ~(items_room >= wanted), items_room, wanted)),
            order.map_bytes.eq(Mux(bad, map_room, bus)),
            order.items.eq((walk.takes_rest & walk.rest.any()) | is_counted),
            order.last.eq(walk.takes_rest | (flow.words.last & ~is_counted)),
            order.length_good.eq(~bad & ~walk.length.zero & ~walk.length.over),
            order.final.eq(Cat(level.last for level in flow.levels)),
            order.first.eq(ring.beat(walk.first_at)),
            order.ends.eq(walk.ends_packet),
            order.status.eq(Mux(bad, code, good_status)),
        ]

    def _room(self, room: Value) -> Value:
        """Return how many bytes of a word come before the packet's end.

        * `room`: distance from the word's first byte to the packet's end; may be negative.
        """
        bus, room = self.program.plan.bus_bytes, room[: Ring(self.program.plan).bits]
        return Mux(room[-1], 0, Mux(room >= bus, bus, room[: bus.bit_length()]))
