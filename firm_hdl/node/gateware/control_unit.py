"""The unit that answers control messages, and the counters and registers that a host reads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.fifo import SyncFIFO
from amaranth.lib.wiring import In, Out
from amaranth.utils import ceil_log2

from firm_hdl.gateware import PacketSignature
from firm_hdl.gateware.packets.counters import add_counters, counters_layout
from firm_hdl.node.control import CONTROL_BYTES, REQUEST, RESPONSE, Operation, Result
from firm_hdl.node.gateware.streams import TAG_BITS, time_layout

__all__ = ["ByteCounter", "ControlUnit", "RegisterReader", "read_cycles"]

REQUESTS = 4
"""Requests that wait. A host sends no more at once."""


class ControlUnit(wiring.Component):
    """Answer requests of the host, in order.

    A request takes about 10 cycles, and one more for each 16 registers. While 4 requests wait,
    others are dropped and counted.

    Parameters
    ----------
    bus_bytes : int
        1, 2, 4, 8 or 16.
    first : int
        Number of registers that begin at 0.
    counters_from, counters : int
        Number of the first counter, and number of counters.

    Members
    -------
    packets_in : In(PacketSignature(bus_bytes))
        Requests; `ready` is always high.
    tag_in : In(32)
        Counts with the last beat.
    packets_out : Out(PacketSignature(bus_bytes))
        Responses.
    tag_out : Out(32)
        Tag of the response, in all its beats.
    number : Out(range(first + counters))
        Register to read: counters follow the first registers without a gap.
    value : In(32)
        Its value, `read_cycles` later.
    time : In(time_layout())
    to : Out(time_layout())
    sets, sets_rate : Out(1)
        As for :class:`NodeClock`.
    to_rate : Out(32)
    counters : Out(counters_layout("control", "control_full"))
        Requests, and those that were dropped.
    """

    def __init__(self, bus_bytes: int, first: int, counters_from: int, counters: int):
        self.bus_bytes, self.first = bus_bytes, first
        self.counters_from, self.last = counters_from, counters_from + counters
        self.read_cycles = read_cycles(first + counters)
        super().__init__(
            {
                "packets_in": In(PacketSignature(bus_bytes)),
                "tag_in": In(TAG_BITS),
                "packets_out": Out(PacketSignature(bus_bytes)),
                "tag_out": Out(TAG_BITS),
                "number": Out(range(first + counters)),
                "value": In(32),
                "time": In(time_layout()),
                "to": Out(time_layout()),
                "sets": Out(1),
                "sets_rate": Out(1),
                "to_rate": Out(32),
                "counters": Out(counters_layout("control", "control_full")),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        layout = data.StructLayout({"request": _layout(REQUEST), "is_whole": 1, "tag": TAG_BITS})
        m.submodules.waiting = waiting = SyncFIFO(width=layout.size, depth=REQUESTS)
        self._receive(m, waiting, layout)
        self._answer(m, layout, waiting)
        return m

    def _receive(self, m: Module, waiting: SyncFIFO, layout: data.StructLayout) -> None:
        """Collect the beats of a request.

        A request of another size is kept all the same: it gets an answer, which says what is wrong.
        """
        beats = CONTROL_BYTES // self.bus_bytes
        packets, beat = self.packets_in, self.packets_in.payload
        words = Signal(8 * CONTROL_BYTES)
        number = Signal(range(beats + 1))
        bits = 8 * self.bus_bytes
        whole = Signal(layout)
        kept = Signal(8 * CONTROL_BYTES)
        ends = Signal()
        m.d.comb += [
            packets.ready.eq(1),
            # The first beat comes first, and moves to the lowest bits.
            kept.eq(Cat(words[bits:], Value.cast(beat.data))),
            ends.eq(packets.valid & beat.last),
            Value.cast(whole.request).eq(kept),
            # `number` stops behind the last beat that a request has.
            whole.is_whole.eq((number == beats - 1) & (beat.count == self.bus_bytes)),
            whole.tag.eq(self.tag_in),
            waiting.w_data.eq(whole),
            waiting.w_en.eq(ends),
        ]
        with m.If(packets.valid):
            m.d.sync += [
                words.eq(kept),
                number.eq(Mux(beat.last, 0, Mux(number == beats, beats, number + 1))),
            ]
        add_counters(
            m,
            self.counters,
            {"control": ends & waiting.w_rdy, "control_full": ends & ~waiting.w_rdy},
        )

    def _answer(self, m: Module, layout: data.StructLayout, waiting: SyncFIFO) -> None:
        """Do the oldest request, and send the response."""
        asked = Signal(layout)
        response = Signal(_layout(RESPONSE))
        cycles = Signal(range(self.read_cycles + 1))
        is_known = Signal()
        # The response is sent. A register of its own, because the arbiter is far away.
        sends = Signal()
        m.d.comb += [
            self.tag_out.eq(asked.tag),
            self.to.sec.eq(asked.request.seconds),
            self.to.nanosec.eq(asked.request.nanoseconds),
            self.to_rate.eq(asked.request.argument),
        ]
        m.d.sync += [self.sets.eq(0), self.sets_rate.eq(0)]
        with m.FSM():
            with m.State("IDLE"):
                # No logic follows the read of the FIFO in the same cycle.
                m.d.comb += waiting.r_en.eq(1)
                m.d.sync += Value.cast(asked).eq(waiting.r_data)
                with m.If(waiting.r_rdy):
                    m.next = "CHECK"
            with m.State("CHECK"):
                self._check(m, asked, response, is_known)
                m.next = "DO"
            with m.State("DO"):
                self._do(m, asked, response, is_known, sends)
                m.d.sync += cycles.eq(self.read_cycles)
            with m.State("READ"):
                m.d.sync += [cycles.eq(cycles - 1), response.value.eq(self.value)]
                with m.If(cycles == 0):
                    m.d.sync += sends.eq(1)
                    m.next = "SEND"
            with m.State("SEND"), m.If(~sends):
                m.next = "IDLE"
        self._send(m, response, sends)

    def _check(self, m: Module, asked: data.View, response: data.View, is_known: Signal) -> None:
        """Compare the numbers of a request with their limits."""
        request, argument = asked.request, asked.request.argument
        is_first = argument < self.first
        is_counter = Signal()
        reads = request.operation == Operation.READ
        sets = request.operation == Operation.SET_TIME
        m.d.comb += is_counter.eq((argument >= self.counters_from) & (argument < self.last))
        m.d.sync += [
            self.number.eq(Mux(is_first, argument, argument - (self.counters_from - self.first))),
            is_known.eq(
                asked.is_whole & (reads | sets | (request.operation == Operation.SET_RATE))
            ),
            response.result.eq(
                Mux(
                    (reads & ~is_first & ~is_counter)
                    | (sets & (request.nanoseconds >= 1_000_000_000)),
                    Result.ARGUMENT,
                    Result.OK,
                )
            ),
        ]

    def _do(
        self, m: Module, asked: data.View, response: data.View, is_known: Signal, sends: Signal
    ) -> None:
        """Do a request; go on to the state that follows."""
        request = asked.request
        does = Signal()
        m.d.comb += does.eq(is_known & (response.result == Result.OK))
        m.d.sync += [
            self.sets.eq(does & (request.operation == Operation.SET_TIME)),
            self.sets_rate.eq(does & (request.operation == Operation.SET_RATE)),
            response.operation.eq(request.operation),
            response.reserved.eq(0),
            response.value.eq(0),
            response.seconds.eq(self.time.sec),
            response.nanoseconds.eq(self.time.nanosec),
        ]
        m.d.sync += sends.eq(1)
        m.next = "SEND"
        with m.If(~is_known):
            m.d.sync += response.result.eq(Result.OPERATION)
        with m.Elif(does & (request.operation == Operation.READ)):
            m.d.sync += sends.eq(0)
            m.next = "READ"

    def _send(self, m: Module, response: data.View, sends: Signal) -> None:
        """Send the response, its first bytes first."""
        beats = CONTROL_BYTES // self.bus_bytes
        out = self.packets_out
        number = Signal(range(max(2, beats)))
        bits = 8 * self.bus_bytes
        m.d.comb += [
            out.valid.eq(sends),
            Value.cast(out.payload.data).eq(Value.cast(response)[:bits]),
            out.payload.count.eq(self.bus_bytes),
            out.payload.last.eq(number == beats - 1),
        ]
        with m.If(sends & out.ready):
            m.d.sync += [
                Value.cast(response).eq(Value.cast(response)[bits:]),
                number.eq(number + 1),
            ]
            with m.If(out.payload.last):
                m.d.sync += [number.eq(0), sends.eq(0)]


def _layout(fields: Mapping[str, int]) -> data.StructLayout:
    return data.StructLayout({name: 8 * size for name, size in fields.items()})


_GROUP = 16


def read_cycles(count: int) -> int:
    """Return the cycles from a new number of one of `count` registers to its value."""
    return 2 + -(-count // _GROUP)


class ByteCounter(wiring.Component):
    """Count bytes of packets, in 64 bits. The upper half changes a cycle after the lower one.

    Members
    -------
    adds : In(1)
        A packet of `size` bytes is counted in this cycle.
    size : In(size_bits)
    low, high : Out(32)
    """

    def __init__(self, size_bits: int):
        super().__init__({"adds": In(1), "size": In(size_bits), "low": Out(32), "high": Out(32)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        # An addition of 64 bits would be too long for a cycle: the carry waits in a register.
        adds = Signal()
        size = Signal.like(self.size)
        carry = Signal()
        total = Signal(33)
        m.d.comb += total.eq(self.low + Mux(adds, size, 0))
        m.d.sync += [
            adds.eq(self.adds),
            size.eq(self.size),
            self.low.eq(total),
            carry.eq(total[32]),
            self.high.eq(self.high + carry),
        ]
        return m


class RegisterReader(wiring.Component):
    """Give the value of one of many registers, `read_cycles(count)` cycles after its number.

    The registers are far from each other. So they are divided into groups, and each group has
    registers for the number and for its value, in a chain from group to group.

    Parameters
    ----------
    count : int
        Number of registers.

    Members
    -------
    values : In(ArrayLayout(32, count))
    number : In(range(count))
        Has to stay until the value is there.
    value : Out(32)
    """

    def __init__(self, count: int):
        super().__init__(
            {
                "values": In(data.ArrayLayout(32, count)),
                "number": In(range(max(2, count))),
                "value": Out(32),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        # A number moves on by a group in each cycle, and a value two cycles behind it. Each group
        # passes on the value that comes, or its own if that is meant. Of 3 groups, the second one:
        #
        #     cycle    0       1         2         3         4         5
        #     number   given   number_0  number_1  number_2
        #     own                        group_0   group_1   group_2
        #     value                                value_0   value_1   value_2
        #                                                    = group_1 = value_1
        values = [Value.cast(each) for each in self.values]
        bits = ceil_log2(_GROUP)
        number, value = self.number, Const(0, 32)
        for place, at in enumerate(range(0, len(values), _GROUP)):
            here = Signal.like(self.number, name=f"number_{place}", reset_less=True)
            mine = Signal(32, name=f"group_{place}", reset_less=True)
            chosen = Signal(32, name=f"value_{place}", reset_less=True)
            m.d.sync += [
                here.eq(number),
                mine.eq(_pick(values[at : at + _GROUP], here[:bits])),
                chosen.eq(Mux(here[bits:] == place, mine, value)),
            ]
            number, value = here, chosen
        m.d.comb += self.value.eq(value)
        return m


def _pick(values: Sequence[Value], number: Value) -> Value:
    """Return the value with a number; the last one for numbers without a value."""
    if len(values) == 1:
        return values[0]
    half = 1 << (ceil_log2(len(values)) - 1)
    bit = ceil_log2(half)
    if bit >= len(number):
        return _pick(values[:half], number)
    return Mux(number[bit], _pick(values[half:], number[:bit]), _pick(values[:half], number[:bit]))
