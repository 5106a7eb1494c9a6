# amaranth: UnusedElaboratable=no
"""Marks of bytes and headers, compared with the bytes themselves."""

from __future__ import annotations

import random

import pytest
from amaranth.sim import Simulator

from firm_hdl.gateware.parse.marks import Marks
from firm_hdl.plan import build_plan
from firm_hdl.plan.geometry import ring_beats
from firm_hdl.wire import lay_out
from tests.strategies import make

TEXT = make("ros2", {"s": "string"})
# The first two bytes are checked; the next two may have any value.
HEADER = (0, 1)


def compare(bus_bytes, tamper=lambda found: found):
    """Fill the ring with random beats, and look up every mark."""
    plan = build_plan(lay_out(TEXT), bus_bytes=bus_bytes)
    dut, rng, depth = Marks(plan), random.Random(bus_bytes), ring_beats(bus_bytes)
    found, want = [], []

    async def testbench(ctx):
        for lap in range(4):
            beats = []
            for at in range(depth):
                lanes = [rng.choice((0, 0, 1, 200)) for _ in range(bus_bytes)]
                last = rng.random() < 0.5
                beats.append((lanes, rng.randint(0, bus_bytes), last))
                data = int.from_bytes(bytes(lanes), "little")
                beat = {"data": data, "count": beats[-1][1], "last": last, "valid": 1}
                ctx.set(dut.beat, beat | {"at": at + depth * (lap % 2)})
                await ctx.tick()
            ctx.set(dut.beat.valid, 0)
            ctx.set(dut.beat.data, 0)
            await ctx.tick()
            for at, (lanes, count, last) in enumerate(beats):
                for lane, byte in enumerate(lanes):
                    ctx.set(dut.nul_at, at * bus_bytes + lane)
                    found.append(ctx.get(dut.nonzero))
                    want.append(byte != 0)
                ctx.set(dut.header_at, at)
                found.append(ctx.get(dut.mismatch))
                present = lanes[:count] if last else lanes
                want.append(mismatch(dut.checks, present))

    simulator = Simulator(dut)
    simulator.add_clock(1e-6)
    simulator.add_testbench(testbench)
    simulator.run()
    assert [tamper(bits) for bits in found] == want
    return want


def mismatch(checks, present):
    """Return a bit for each step with checked bytes: whether an arrived one differs."""
    wrong = [
        any(present[k] != byte for k, byte in each if k < len(present)) for each in checks.values()
    ]
    return sum(1 << k for k, flag in enumerate(wrong) if flag)


@pytest.mark.parametrize("bus_bytes", [1, 2, 4, 8, 64])
def test_marks_are_those_of_the_bytes(bus_bytes):
    assert len(set(compare(bus_bytes))) > 1


@pytest.mark.parametrize(("bus_bytes", "steps"), [(1, [0, 1]), (2, [0]), (8, [0])])
def test_each_step_with_bytes_of_the_header_is_checked(bus_bytes, steps):
    dut = Marks(build_plan(lay_out(TEXT), bus_bytes=bus_bytes))
    assert dut.steps == steps
    assert [byte for each in dut.checks.values() for _, byte in each] == list(HEADER)


def test_a_wrong_mark_is_noticed():
    with pytest.raises(AssertionError):
        compare(4, tamper=lambda found: found ^ 1)
