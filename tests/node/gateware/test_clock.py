# amaranth: UnusedElaboratable=no
"""The clock of a node, cycle by cycle, against integers that count its steps."""

from __future__ import annotations

from itertools import pairwise

import pytest
from amaranth.sim import Simulator

from firm_hdl.node.gateware.clock import NodeClock

STEP = 1 << 22
"""Steps of a nanosecond."""
SECOND = 10**9
DAY = (1 << 32) * SECOND
"""The time after which the seconds return to 0."""


def times(clock, cycles, *changes):
    """Run a clock; return its time in ns after each cycle. Changes are (cycle, inputs)."""
    seen, inputs = [], dict(changes)

    async def use(ctx):
        for cycle in range(cycles):
            given = inputs.get(cycle, {})
            for name in ("sets", "sets_rate"):
                ctx.set(getattr(clock, name), 0)
            for name, value in given.items():
                ctx.set(getattr(clock, name), value)
            await ctx.tick()
            seconds, nanoseconds = ctx.get(clock.time.sec), ctx.get(clock.time.nanosec)
            assert nanoseconds < SECOND
            seen.append(seconds * SECOND + nanoseconds)

    simulator = Simulator(clock)
    simulator.add_clock(1e-6)
    simulator.add_testbench(use)
    simulator.run()
    return seen


def to(seconds, nanoseconds):
    return {"sets": 1, "to": {"sec": seconds, "nanosec": nanoseconds}}


@pytest.mark.parametrize("hertz", [1e6, 125e6, 156.25e6, 300e6])
def test_a_clock_that_nobody_sets_counts_from_0_at_its_frequency(hertz):
    clock = NodeClock(hertz)
    step = round(1e9 / hertz * STEP)
    assert times(clock, 60) == [number * step // STEP for number in range(60)]


@pytest.mark.parametrize(
    "begin",
    [
        (0, 0),
        (7, SECOND - 1),
        (0xFFFF, SECOND - 20_000),
        (0xFF_FFFF, SECOND - 7_777),
        # The seconds return to 0.
        (0xFFFF_FFFF, SECOND - 12_345),
    ],
)
@pytest.mark.parametrize("rate", [0xFFFF_FFFF, 0x8000_0001, 333 * STEP + 12_345])
def test_a_time_and_a_rate_that_are_set(begin, rate):
    changes = (3, {"sets_rate": 1, "to_rate": rate}), (20, to(*begin))
    found = times(NodeClock(100e6), 60, *changes)
    # 2 cycles after the time is taken, it is on the output.
    start = (begin[0] * SECOND + begin[1]) * STEP
    assert found[21:] == [(start + number * rate) // STEP % DAY for number in range(39)]


@pytest.mark.parametrize("at", range(6, 14))
def test_a_rate_changes_without_a_jump(at):
    slow, fast = 10 * STEP, 25 * STEP
    # The second ends about when the rate changes.
    found = times(
        NodeClock(100e6),
        30,
        (2, to(4, SECOND - 70)),
        (at, {"sets_rate": 1, "to_rate": fast}),
    )
    steps = [(after - before) * STEP for before, after in pairwise(found[3:])]
    switch = steps.index(fast)
    assert steps == [slow] * switch + [fast] * (len(steps) - switch)
    assert 0 <= 4 + switch - at <= 4


def test_a_new_time_does_not_change_the_rate():
    clock = NodeClock(100e6)
    found = times(clock, 20, (0, {"to_rate": 99}), (5, to(1, 0)))
    assert found[6:] == [SECOND + 10 * number for number in range(14)]


def test_the_slowest_clock():
    assert NodeClock(1e6).nominal == 1000 * STEP
    # One whose rate would have 33 bits.
    for hertz in (976_562.5, 1.0):
        with pytest.raises(ValueError, match=rf"^Frequency must be from 1 MHz on, not {hertz:g} "):
            NodeClock(hertz)
