# amaranth: UnusedElaboratable=no
"""The unit that answers requests of control, alone, with a response for each request by hand."""

from __future__ import annotations

import struct

import pytest
from amaranth.hdl import Cat, Const, Module, ResetInserter, Signal, Value
from amaranth.sim import Simulator

from firm_hdl.node.gateware.control_unit import ControlUnit, RegisterReader, read_cycles
from firm_hdl.sim import Stalls
from tests.gateware.packets.bench import PacketBench, beats, with_side
from tests.node.traffic import counters_of

READ, SET_TIME, SET_RATE = 1, 2, 3
OK, NO_OPERATION, NO_ARGUMENT = 0, 1, 2
SECOND = 10**9

FIRST, FROM, COUNTERS = 6, 16, 27
# Two whole groups of registers, and one that is alone in the third.
VALUES = [0xF000_0000 + 7 * number for number in range(FIRST + COUNTERS)]
TIME = (0xFEDC_BA98, 999_999_999)


class UnitBench:
    """A unit with all its registers, and a clock that stands still."""

    def __init__(self, bus):
        self.bus = bus
        m = Module()
        m.submodules.unit = self.unit = unit = ControlUnit(bus, FIRST, FROM, COUNTERS)
        m.submodules.reader = reader = RegisterReader(len(VALUES))
        m.d.comb += [
            reader.number.eq(unit.number),
            unit.value.eq(reader.value),
            unit.time.sec.eq(TIME[0]),
            unit.time.nanosec.eq(TIME[1]),
            Value.cast(reader.values).eq(Cat(Const(each, 32) for each in VALUES)),
        ]
        self.bench = PacketBench(
            m,
            {"in": with_side(unit.packets_in, unit.tag_in)},
            {"out": (unit.packets_out, bus, unit.tag_out)},
            events={
                "sets": (unit.sets, Value.cast(unit.to)),
                "sets_rate": (unit.sets_rate, unit.to_rate),
            },
            final={name: unit.counters[name] for name in ("control", "control_full")},
        )

    def run(self, requests, stalls=None, answers=None, deadline=200):
        """Send requests one by one; return the responses with their tags, and what was set."""
        tags = [0xF000_0000 + number for number in range(len(requests))]
        sides = [(lambda last, tag=tag: tag if last else 99) for tag in tags]
        count = len(requests) if answers is None else answers
        seen = self.bench.run(
            {"in": list(beats(requests, self.bus, sides))},
            {"out": count, "in": sum(-(-len(each) // self.bus) for each in requests)},
            stalls=stalls,
            deadline=deadline,
            settle=60,
        )
        return list(zip(seen.packets["out"], seen.sides["out"], strict=True)), seen


def request(operation, argument=0, seconds=0, nanoseconds=0):
    # Reserved bytes are ignored.
    return struct.pack("<B3sIII", operation, b"abc", argument, seconds, nanoseconds)


def response(operation, result, value=0):
    return struct.pack("<BBHIII", operation, result, 0, value, *TIME)


def read(argument):
    """Return a request to read, and its response."""
    if argument < FIRST:
        value = VALUES[argument]
    elif FROM <= argument < FROM + COUNTERS:
        value = VALUES[argument - FROM + FIRST]
    else:
        return request(READ, argument), response(READ, NO_ARGUMENT)
    return request(READ, argument), response(READ, OK, value)


CASES = [
    *(read(argument) for argument in (0, 1, 5, 6, 7, 15, 16, 17, 31, 32, 41, 42, 43, 44, 48)),
    *(read(argument) for argument in (0x100, 0x1_0010, 0xFFFF_FFFF)),
    # Nothing is wrong with a time that is not set.
    (request(READ, 2, 5, SECOND), response(READ, OK, VALUES[2])),
    (request(SET_RATE, 9, 5, SECOND), response(SET_RATE, OK)),
    (request(SET_TIME, 99, 0xFFFF_FFFF, SECOND - 1), response(SET_TIME, OK)),
    (request(SET_TIME, 99, 5, SECOND), response(SET_TIME, NO_ARGUMENT)),
    (request(SET_TIME, 2, 5, 0xFFFF_FFFF), response(SET_TIME, NO_ARGUMENT)),
    (request(SET_TIME, 2, 6, 7), response(SET_TIME, OK)),
    (request(SET_RATE, 0xFFFF_FFFE), response(SET_RATE, OK)),
    *((request(op, 2), response(op, NO_OPERATION)) for op in (0, 4, 5, 9, 129, 255)),
    # The operation of a longer one is that of its last 16 bytes.
    *(
        (request(op, 2) * times, response(op, NO_OPERATION))
        for op in (READ, SET_TIME, SET_RATE)
        for times in (2, 3)
    ),
]
"""Requests, and the responses that they should have."""

SETS = [0xFFFF_FFFF | (SECOND - 1) << 32, 6 | 7 << 32]
SETS_RATE = [9, 0xFFFF_FFFE]


@pytest.mark.parametrize("bus", [1, 8, 16])
@pytest.mark.sampled(2)
def test_every_request_has_its_response(bus):
    bench = UnitBench(bus)
    # Each request is answered before the next one comes.
    pause = {"in": Stalls.bits("1" + "0" * (2 * bus))}
    found, seen = bench.run([each for each, _ in CASES], pause)
    tags = [{0xF000_0000 + number} for number in range(len(CASES))]
    assert found == list(zip([want for _, want in CASES], tags, strict=True))
    assert seen.values("sets") == SETS and seen.values("sets_rate") == SETS_RATE
    assert counters_of(bench.bench) == {"control": len(CASES)}


@pytest.mark.parametrize("size", [1, 8, 9, 15, 17, 24, 31, 40])
@pytest.mark.sampled(4)
def test_a_request_of_another_size_is_none(size):
    bench = UnitBench(8)
    requests = [(request(SET_RATE, 3) * 4)[:size], request(READ, 4)]
    found, seen = bench.run(requests, {"in": Stalls.bits("1" + "0" * 40)})
    (first, _), (second, _) = found
    assert first[1] == NO_OPERATION and first[2:] == response(0, 0)[2:]
    # The next one is not touched by it.
    assert second == response(READ, OK, VALUES[4])
    assert seen.values("sets_rate") == seen.values("sets") == []


def test_four_requests_wait_and_more_are_dropped():
    bench = UnitBench(16)
    requests = [request(READ, number % 6) for number in range(10)]
    late = {"out": Stalls.bits("0" * 60 + "1" * 400)}
    # One is being answered.
    found, _ = bench.run(requests, late, answers=5, deadline=500)
    assert [struct.unpack_from("<I", each, 4)[0] for each, _ in found] == VALUES[:5]
    assert [tag for _, (tag,) in found] == [0xF000_0000 + number for number in range(5)]
    assert counters_of(bench.bench) == {"control": 5, "control_full": 5}


def test_a_reset_ends_a_response():
    unit, clear, seen = ControlUnit(16, FIRST, FROM, COUNTERS), Signal(), []
    simulator = Simulator(ResetInserter(clear)(unit))

    async def use(ctx):
        payload = unit.packets_in.payload
        ctx.set(Value.cast(payload.data), int.from_bytes(request(READ, 1), "little"))
        ctx.set(payload.count, 16)
        ctx.set(payload.last, 1)
        # One response waits until the reset; the request after the reset has the next one.
        for reset, ready in ((0, 0), (1, 0), (0, 1)):
            for cycle in range(20):
                ctx.set(clear, reset and cycle == 0)
                ctx.set(unit.packets_in.valid, not reset and cycle == 0)
                ctx.set(unit.packets_out.ready, ready)
                seen.append(ctx.get(unit.packets_out.valid))
                await ctx.tick()

    simulator.add_clock(1e-6)
    simulator.add_testbench(use)
    simulator.run()
    waits, after, sent = seen[:20], seen[20:40], seen[40:]
    assert waits[-1] and not any(after[1:]) and sum(sent) == 1


@pytest.mark.parametrize(("count", "cycles"), [(1, 3), (2, 3), (16, 3), (17, 4), (32, 4), (33, 5)])
def test_a_register_is_read_in_as_many_cycles_as_are_stated(count, cycles):
    reader, seen = RegisterReader(count), []

    async def use(ctx):
        ctx.set(Value.cast(reader.values), sum(VALUES[n] << 32 * n for n in range(count)))
        for number in [*range(count), 0]:
            ctx.set(reader.number, number)
            await ctx.tick().repeat(cycles)
            seen.append(ctx.get(reader.value))

    simulator = Simulator(reader)
    simulator.add_clock(1e-6)
    simulator.add_testbench(use)
    simulator.run()
    assert read_cycles(count) == cycles and seen == [*VALUES[:count], VALUES[0]]
