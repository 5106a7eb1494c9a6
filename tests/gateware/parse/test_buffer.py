# amaranth: UnusedElaboratable=no
"""The packet buffer against lists: what has arrived, where packets end, and what is free again."""

from __future__ import annotations

import random

import pytest
from amaranth.sim import Simulator

from firm_hdl.gateware.parse.buffer import Buffer
from firm_hdl.plan import build_plan
from firm_hdl.plan.geometry import ring_beats
from firm_hdl.wire import lay_out
from tests.strategies import make

CYCLES = 1500


def buffer_of(bus_bytes):
    return Buffer(build_plan(lay_out(make("ros1", {"x": "uint8"})), bus_bytes=bus_bytes))


class Reference:
    """The packets that a buffer has taken, and how far they are read.

    Attributes
    ----------
    beats : list of (cycle, bytes, last)
        Beats that were taken.
    start : int
        The first beat of the packet that is read.
    freed : int
        Beats before this one are not needed.
    """

    def __init__(self, bus_bytes):
        self.bus, self.depth = bus_bytes, ring_beats(bus_bytes)
        self.beats, self.start, self.freed = [], 0, 0

    def expected(self, cycle):
        """Return `limit`, `ended` and `following`, as they are without end."""
        seen = [beat for beat in self.beats[self.start :] if beat[0] + 2 <= cycle]
        for number, (_, count, last) in enumerate(seen):
            if last:
                at = self.start + number
                return at * self.bus + count, True, at + 1
        return (self.start + len(seen)) * self.bus, False, None


def compare(dut, seed, tamper=None):
    """Run a buffer with random traffic, and compare it in each cycle.

    `tamper`: a function that changes what was seen, so that a test can show that it matters.
    """
    bus = dut.plan.bus_bytes
    rng, reference = random.Random(seed), Reference(bus)
    modulus = 2 * reference.depth
    # All beats, and the longest time in which none was taken although all was free.
    waiting = 0

    async def testbench(ctx):
        nonlocal waiting
        offered = None
        for cycle in range(CYCLES):
            limit, ended, following = reference.expected(cycle)
            seen = {
                "limit": ctx.get(dut.limit),
                "ended": bool(ctx.get(dut.ended)),
                "following": ctx.get(dut.following) if ended else None,
            }
            seen |= tamper(seen) if tamper else {}
            want = {"limit": limit % (modulus * bus), "ended": ended, "following": None}
            if ended:
                want["following"] = following % modulus
            assert seen == want, cycle
            written = [k for k, beat in enumerate(reference.beats) if beat[0] + 1 == cycle]
            assert ctx.get(dut.beat.valid) == len(written)
            if written:
                _, count, last = reference.beats[written[0]]
                assert ctx.get(dut.beat.at) == written[0] % modulus
                assert ctx.get(dut.beat.last) == last
                assert ctx.get(dut.beat.count) == count
                assert ctx.get(dut.beat.data) == written[0] % 256
            if offered is None and rng.random() < 0.7:
                last = rng.random() < 0.3
                offered = rng.randint(1, bus) if last else rng.randint(0, bus), last
            if offered is not None:
                number = len(reference.beats)
                ctx.set(dut.packets.payload, packet_beat(number, *offered, bus))
            ctx.set(dut.packets.valid, offered is not None)
            # The packet may be left; what is before the reader may be freed later.
            leave = ended and rng.random() < 0.5
            ctx.set(dut.next, leave)
            here = limit // bus
            if rng.random() < 0.6:
                reference.freed = rng.randint(reference.freed, max(reference.freed, here))
            ctx.set(dut.freed, reference.freed % modulus)
            taken = offered is not None and ctx.get(dut.packets.ready)
            waiting = 0 if taken or offered is None or reference.freed < here else waiting + 1
            assert waiting < 4, "beats are not taken although there is room"
            if taken:
                reference.beats.append((cycle, *offered))
                offered = None
            if leave:
                reference.start = following
            assert len(reference.beats) - reference.freed <= reference.depth
            await ctx.tick()

    simulator = Simulator(dut)
    simulator.add_clock(1e-6)
    simulator.add_testbench(testbench)
    simulator.run()
    return reference


def packet_beat(number, count, last, bus):
    lanes = [number % 256, *[0] * (bus - 1)]
    return {"data": lanes, "count": count, "last": last}


@pytest.mark.parametrize("bus_bytes", [1, 2, 4, 8, 64])
def test_beats_and_ends_of_packets(bus_bytes):
    reference = compare(buffer_of(bus_bytes), seed=bus_bytes)
    # The traffic had all cases: the ring was full, and several packets were in it.
    assert len(reference.beats) > CYCLES / 5
    assert sum(last for _, _, last in reference.beats) > CYCLES / 20


@pytest.mark.parametrize(
    "tamper",
    [
        lambda seen: {"limit": seen["limit"] ^ 1},
        lambda seen: {"ended": not seen["ended"]},
        lambda seen: {"following": seen["following"] and seen["following"] ^ 1},
    ],
)
def test_what_is_wrong_is_noticed(tamper):
    with pytest.raises(AssertionError):
        compare(buffer_of(4), seed=1, tamper=tamper)
