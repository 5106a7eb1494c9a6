# amaranth: UnusedElaboratable=no
"""Decoded lengths, compared with plain arithmetic, for each lane and each meaning."""

from __future__ import annotations

import random

import pytest
from amaranth.sim import Simulator

from firm_hdl import Parser
from firm_hdl.gateware.parse.lengths import (
    LENGTH_BYTES,
    Lengths,
    LoopMeaning,
    RunMeaning,
    meanings_of,
    shift_of,
)
from firm_hdl.gateware.positions import Ring
from firm_hdl.plan import build_plan
from firm_hdl.plan.geometry import geometry
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.gateware.test_parser import run
from tests.strategies import make

TEXT = make("ros2", {"s": "string", "d": "float64[]"}, "Text")
MESSAGES = {
    "string": make("ros1", {"s": "string", "t": "string", "x": "uint8"}),
    "cdr": make("ros2", {"s": "string<=9", "a": "uint16[]", "t": (TEXT, "[<=3]"), "x": "float64"}),
    "words": make("ros1", {"a": "uint32[]", "b": "float64[]", "c": "uint8[]", "x": "uint8"}),
}


def plan_of(name, bus_bytes):
    return build_plan(lay_out(MESSAGES[name]), bus_bytes=bus_bytes, max_message_bytes=1 << 12)


def expected(plan, meaning, length, key, phase):
    """Return the decoded values of a length, by the names of their fields.

    Parameters
    ----------
    key : int
        Position of the length's last byte.
    phase : int
        Position after the header, modulo 8.
    """
    over = length > meaning.max_count
    if isinstance(meaning, LoopMeaning):
        found = {"skips": length == 0, "single": length == 1, "double": length == 2}
        fields = {name: int(value) for name, value in found.items()}
    else:
        run = plan.runs[meaning.begin.run]
        lanes, nul = plan.leaves[run.items].lanes, int(run.terminated)
        items = max(0, length - nul)
        words = -(-items // lanes)
        # All words but the last one are the body.
        fields = {"skips": words <= 1, "single": words <= 2, "double": words <= 3}
        rest = items - (words - 1) * lanes if items else 0
        fields = {name: int(value) for name, value in fields.items()} | {"rest": rest}
    named = {
        "zero": int(length == 0),
        meaning.over: int(over),
        meaning.skips: int(fields["skips"] or over),
        meaning.single: fields["single"],
        meaning.double: fields["double"],
    }
    if meaning.begin.claim is not None:
        named[meaning.counted] = int(length >= meaning.begin.claim.least)
    if isinstance(meaning, RunMeaning):
        named[meaning.rest] = fields["rest"]
        if length <= plan.word(meaning.begin.run):
            named |= next_last_bytes(plan, meaning, length, key, phase)
    return named


def next_last_bytes(plan, meaning, length, key, phase):
    """Return the last byte of each step that may follow, if all items are in the rest."""

    def aligned(position, align):
        return position + (phase - position) % align

    ring = Ring(plan)
    start = aligned(key + 1, meaning.begin.align) if length else key + 1
    after = start + length * plan.item_bytes(meaning.begin.run)
    return {
        meaning.next_last_at(step): (aligned(after, plan.steps[step].align) + shift_of(plan, step))
        % (1 << ring.bits)
        for step in meaning.nexts
    }


def compare(plan, tamper=lambda name, value: value):
    """Write random lengths to each lane, and look them up; return how many values were compared."""
    meanings = list(meanings_of(plan).values())
    dut = Lengths(plan, geometry(plan), meanings)
    bus, ring, rng = plan.bus_bytes, Ring(plan), random.Random(plan.bus_bytes)
    edges = {m.max_count + d for m in meanings for d in (-1, 0, 1)}
    edges |= {m.begin.claim.least + d for m in meanings if m.begin.claim for d in (-1, 0)}
    edges |= {0, 1, 2, (1 << 32) - 1}
    values = sorted(edges | set(range(4 * bus if bus < 16 else 70)))
    few = random.Random(1)
    compared = 0

    async def testbench(ctx):
        nonlocal compared
        beat = 0
        for length in values:
            # Each edge in every lane; what lies between them in some.
            some = by_depth(1, len(dut.lanes))
            for lane in dut.lanes if length in edges else few.sample(dut.lanes, some):
                phase = plan.header_bytes % 8 if bus >= 8 else rng.randrange(8)
                ctx.set(dut.phase, phase)
                # The length ends in this lane of the second, third, ... beat from here on.
                count = -(-(LENGTH_BYTES + bus) // bus)
                data = bytearray(rng.randbytes(count * bus))
                end = (count - 1) * bus + lane + 1
                data[end - LENGTH_BYTES : end] = length.to_bytes(LENGTH_BYTES, "little")
                for k in range(count):
                    word = int.from_bytes(data[k * bus : (k + 1) * bus], "little")
                    at = (beat + k) % (2 * ring.depth)
                    ctx.set(dut.beat, {"data": word, "at": at, "valid": 1})
                    await ctx.tick()
                ctx.set(dut.beat.valid, 0)
                key = ((beat + count - 1) % (2 * ring.depth)) * bus + lane
                beat += count
                ctx.set(dut.key, key)
                for meaning in meanings:
                    for name, want in expected(plan, meaning, length, key, phase).items():
                        found = ctx.get(dut.entry[name])
                        assert tamper(name, found) == want, (name, length, lane)
                        compared += 1
                await ctx.tick()
                ctx.set(dut.key, 0)
                assert ctx.get(dut.count) == length % (1 << dut.count_bits)

    simulator = Simulator(dut)
    simulator.add_clock(1e-6)
    simulator.add_testbench(testbench)
    simulator.run()
    return compared


@pytest.mark.parametrize(
    ("name", "bus_bytes"),
    # 16 lanes take most of the time; those of 8 have the same logic.
    [
        pytest.param(name, bus, marks=[pytest.mark.thorough] if bus == 16 else [])
        for name in MESSAGES
        for bus in (1, 2, 4, 8, 16)
    ],
)
@pytest.mark.sampled(2)
def test_lengths_are_decoded(name, bus_bytes):
    assert compare(plan_of(name, bus_bytes)) >= 100


@pytest.mark.parametrize(
    "field", ["zero", "over", "skips", "single", "double", "counted", "rest", "last"]
)
def test_each_field_matters(field):
    def tamper(name, value):
        return value ^ 1 if name.startswith(field) else value

    with pytest.raises(AssertionError):
        compare(plan_of("cdr", 8), tamper)


NOTHING, BYTE = make("ros1", {}, "Nothing"), make("ros1", {"x": "uint8"}, "Byte")
MANY = "40420f00"
# Two bytes in elements, a million elements without bytes, and the other way round.
BOTH = {
    "bytes first": ({"b": (BYTE, "[]"), "n": (NOTHING, "[]")}, f"02000000aabb{MANY}"),
    "nothing first": ({"n": (NOTHING, "[]"), "b": (BYTE, "[]")}, f"{MANY}02000000aabb"),
}


@pytest.mark.parametrize("bus_bytes", [1, 8])
@pytest.mark.parametrize("order", BOTH)
def test_a_parser_skips_elements_without_bytes_and_no_others(order, bus_bytes):
    fields, text = BOTH[order]
    packet = bytes.fromhex(text)
    seen = run(Parser(make("ros1", fields), bus_bytes=bus_bytes), [packet, packet[:-1], packet])
    assert [status.name for status in seen.statuses] == ["OK", "TRUNCATED", "OK"]
    # All beats, and a few cycles: none for each of the million elements.
    assert max(seen.times) <= 3 * len(packet) + 20
