# amaranth: UnusedElaboratable=no
"""The packet buffer, compared with lists: arrived beats, ends of packets, and freed beats."""

from __future__ import annotations

import random

import pytest
from amaranth.sim import Simulator

from firm_hdl.gateware.parse.buffer import Buffer
from firm_hdl.plan import build_plan
from firm_hdl.plan.geometry import ring_beats
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.strategies import make

CYCLES = by_depth(700, 1500)


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
        """Return `limit`, `ended` and `following`, without their wrap-around."""
        seen = [beat for beat in self.beats[self.start :] if beat[0] + 2 <= cycle]
        for number, (_, count, last) in enumerate(seen):
            if last:
                at = self.start + number
                return at * self.bus + count, True, at + 1
        return (self.start + len(seen)) * self.bus, False, None


class Comparison:
    """A buffer with random traffic, compared with the reference in each cycle.

    Parameters
    ----------
    tamper : function or None
        Changes observed values, so that a test can show that they matter.
    lasts, leaves : float
        Shares of the beats that end a packet, and of the cycles in which an ended packet is left.
    """

    def __init__(self, dut, seed, tamper=None, *, lasts=0.3, leaves=0.5):
        self.dut, self.tamper = dut, tamper
        self.lasts, self.leaves = lasts, leaves
        self.bus = dut.plan.bus_bytes
        self.rng, self.reference = random.Random(seed), Reference(self.bus)
        self.modulus = 2 * self.reference.depth
        self.offered = None
        # The longest time without a transfer while half of the ring is free.
        self.waiting = 0
        # The largest number of packets that have ended and are not left.
        self.most_ended = 0

    async def run(self, ctx):
        for cycle in range(CYCLES):
            limit, ended, following = self.reference.expected(cycle)
            self.check_window(ctx, cycle, limit, ended, following)
            self.check_beat(ctx, cycle)
            self.offer(ctx)
            leave = self.free(ctx, limit // self.bus, ended)
            self.take(ctx, cycle)
            if leave:
                self.reference.start = following
            assert len(self.reference.beats) - self.reference.freed <= self.reference.depth
            kept = self.reference.beats[self.reference.start :]
            self.most_ended = max(self.most_ended, sum(last for _, _, last in kept))
            await ctx.tick()

    def check_window(self, ctx, cycle, limit, ended, following):
        dut = self.dut
        seen = {
            "limit": ctx.get(dut.limit),
            "ended": bool(ctx.get(dut.ended)),
            "following": ctx.get(dut.following) if ended else None,
        }
        seen |= self.tamper(seen) if self.tamper else {}
        want = {"limit": limit % (self.modulus * self.bus), "ended": ended, "following": None}
        if ended:
            want["following"] = following % self.modulus
        assert seen == want, cycle

    def check_beat(self, ctx, cycle):
        """Check the beat that is written to the buffer: it was taken in the cycle before."""
        beat, beats = self.dut.beat, self.reference.beats
        written = [k for k, (taken, *_) in enumerate(beats) if taken + 1 == cycle]
        assert ctx.get(beat.valid) == len(written)
        if written:
            _, count, last = beats[written[0]]
            assert ctx.get(beat.at) == written[0] % self.modulus
            assert ctx.get(beat.last) == last
            assert ctx.get(beat.count) == count
            assert ctx.get(beat.data) == written[0] % 256

    def offer(self, ctx):
        rng, packets = self.rng, self.dut.packets
        if self.offered is None and rng.random() < 0.7:
            last = rng.random() < self.lasts
            self.offered = rng.randint(1, self.bus) if last else rng.randint(0, self.bus), last
        if self.offered is not None:
            number = len(self.reference.beats)
            ctx.set(packets.payload, packet_beat(number, *self.offered, self.bus))
        ctx.set(packets.valid, self.offered is not None)

    def free(self, ctx, here, ended):
        """Leave the packet or not; free some of the beats before the reader."""
        reference = self.reference
        leave = ended and self.rng.random() < self.leaves
        ctx.set(self.dut.next, leave)
        if self.rng.random() < 0.6:
            reference.freed = self.rng.randint(reference.freed, max(reference.freed, here))
        ctx.set(self.dut.freed, reference.freed % self.modulus)
        return leave

    def take(self, ctx, cycle):
        taken = self.offered is not None and ctx.get(self.dut.packets.ready)
        used = len(self.reference.beats) - self.reference.freed
        has_room = used <= self.reference.depth // 2
        self.waiting = self.waiting + 1 if self.offered and not taken and has_room else 0
        assert self.waiting < 4, "beats are not taken although there is room"
        if taken:
            self.reference.beats.append((cycle, *self.offered))
            self.offered = None


def compare(dut, seed, tamper=None, **shares):
    """Run a comparison to its end, and return it."""
    comparison = Comparison(dut, seed, tamper, **shares)
    simulator = Simulator(dut)
    simulator.add_clock(1e-6)
    simulator.add_testbench(comparison.run)
    simulator.run()
    return comparison


def packet_beat(number, count, last, bus):
    lanes = [number % 256, *[0] * (bus - 1)]
    return {"data": lanes, "count": count, "last": last}


@pytest.mark.parametrize("bus_bytes", [1, 2, 4, 8, 64])
def test_beats_and_ends_of_packets(bus_bytes):
    reference = compare(buffer_of(bus_bytes), seed=bus_bytes).reference
    # The traffic covers all cases: the ring was full, and several packets were in it.
    assert len(reference.beats) > CYCLES / 5
    assert sum(last for _, _, last in reference.beats) > CYCLES / 20


def test_ends_of_as_many_packets_as_the_ring_has_beats():
    """Each beat is a packet, and they are left more slowly than they come."""
    comparison = compare(buffer_of(8), seed=1, lasts=0.97, leaves=0.2)
    assert comparison.most_ended >= comparison.reference.depth


@pytest.mark.parametrize(
    "tamper",
    [
        lambda seen: {"limit": seen["limit"] ^ 1},
        lambda seen: {"ended": not seen["ended"]},
        lambda seen: {"following": seen["following"] and seen["following"] ^ 1},
    ],
)
def test_wrong_outputs_are_noticed(tamper):
    with pytest.raises(AssertionError):
        compare(buffer_of(4), seed=1, tamper=tamper)
