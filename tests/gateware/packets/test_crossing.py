# amaranth: UnusedElaboratable=no
"""The clock domain crossing: the same packets in the other domain, whatever the clocks."""

from __future__ import annotations

import random

import pytest
from amaranth.hdl import ClockDomain, Value
from amaranth.sim import Simulator

from firm_hdl import PacketCrossing, load_message
from firm_hdl.plan import build_plan
from firm_hdl.sim.payloads import PacketCollector, all_beats
from firm_hdl.sim.watch import PacketRules, StreamRules
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.gateware.traffic import random_packets

TYPE = load_message(by_depth("std_msgs/msg/Header", "sensor_msgs/msg/Imu"))


def run(crossing, packets, *, write=1.0, read=1.0, phase=0.0, stall=0.0, most=20_000):
    """Check that packets cross; return the cycles of the reading clock in which beats left."""
    bus = crossing.bus_bytes
    came, out = crossing.packets_in, crossing.packets_out
    collector, rules = PacketCollector(bus), PacketRules("out", bus)
    held, times = StreamRules(["out"]), []
    rng, other = random.Random(1), random.Random(2)

    async def send(ctx):
        for beat in all_beats(packets, bus):
            while rng.random() < stall:
                await ctx.tick(crossing.write_domain)
            ctx.set(Value.cast(came.payload), beat)
            ctx.set(came.valid, 1)
            taken = 0
            while not taken:
                _, _, taken = await ctx.tick(crossing.write_domain).sample(came.ready)
            ctx.set(came.valid, 0)

    async def receive(ctx):
        cycle = 0
        while len(collector.packets) < len(packets):
            ready = int(other.random() >= stall)
            ctx.set(out.ready, ready)
            tick = ctx.tick(crossing.read_domain)
            _, _, valid, bits = await tick.sample(out.valid, Value.cast(out.payload))
            held.check(cycle, valid, ready, lambda _, bits=bits: bits)
            if valid and ready:
                rules.check(cycle, bits)
                collector.take(bits)
                times.append(cycle)
            cycle += 1
            assert cycle < most, "packets are missing"

    simulator = Simulator(crossing)
    simulator.add_clock(1e-6 * write, domain=crossing.write_domain)
    simulator.add_clock(1e-6 * read, phase=1e-6 * phase, domain=crossing.read_domain)
    simulator.add_testbench(send, background=True)
    simulator.add_testbench(receive)
    simulator.run()
    assert collector.packets == packets
    return times


def sent(bus_bytes):
    plan = build_plan(lay_out(TYPE), bus_bytes=bus_bytes)
    rng = random.Random(3)
    short = [rng.randbytes(rng.randrange(3 * bus_bytes)) for _ in range(20)]
    return short + random_packets(plan, 2)


CLOCKS = [(1, 1, 0.3), (1, 1.01, 0), (1, 3.7, 0.1), (5.3, 1, 0.4), (1, 2, 0)]


@pytest.mark.parametrize(("write", "read", "phase"), CLOCKS)
@pytest.mark.parametrize("bus_bytes", [1, 8, 64])
@pytest.mark.sampled(8)
def test_packets_are_the_same_in_the_other_domain(bus_bytes, write, read, phase):
    for stall in (0, 0.4):
        crossing = PacketCrossing(bus_bytes, 8)
        run(crossing, sent(bus_bytes), write=write, read=read, phase=phase, stall=stall)


@pytest.mark.parametrize("ratio", [1, 1.1, 1.9])
@pytest.mark.sampled(4)
def test_a_beat_per_cycle_of_the_slower_clock(ratio):
    packets = [bytes(800), bytes(8), bytes(720)]
    times = run(PacketCrossing(8), packets, read=ratio, phase=0.3)
    assert times == list(range(times[0], times[0] + 191))
    # The same clock writes faster than it reads. The other way, the gaps are those of the writer.
    times = run(PacketCrossing(8), packets, write=ratio, phase=0.3)
    assert times[-1] - times[0] <= 191 * ratio + 1


@pytest.mark.parametrize(("phase", "want"), [(0.1, 3), (0.4, 3), (0.6, 2), (0.9, 2)])
def test_a_beat_is_valid_after_the_second_edge(phase, want):
    # The beat is written at 0.5 periods, and the edges that read are `phase` after 0, 1, 2...
    assert run(PacketCrossing(8), [b"x"], phase=phase) == [want]


def test_the_domains_have_the_names_that_are_asked_for():
    crossing = PacketCrossing(8, write_domain="sync", read_domain="fast")
    run(crossing, sent(8), read=0.7, phase=0.2)


def test_parameters_are_checked():
    for beats in (2, 12):
        with pytest.raises(ValueError, match=f"power of two from 4 on, not {beats}$"):
            PacketCrossing(8, beats)
    with pytest.raises(TypeError, match=r"^Number of beats must be an integer, not '16'$"):
        PacketCrossing(8, "16")
    with pytest.raises(TypeError, match=r"^write_domain= must be the name of a clock domain, not "):
        PacketCrossing(8, write_domain=ClockDomain("sync"))
    with pytest.raises(ValueError, match=r"^read_domain= must be the name .*, not 'comb'$"):
        PacketCrossing(8, read_domain="comb")


class _ReadsWhatIsNotThere(PacketCrossing):
    def elaborate(self, platform):
        m = super().elaborate(platform)
        m.d.comb += self.packets_out.valid.eq(1)
        return m


@pytest.mark.parametrize("fault", [_ReadsWhatIsNotThere])
def test_a_fault_is_found(fault):
    with pytest.raises(AssertionError):
        run(fault(8, 8), sent(8), read=2.3, stall=0.2, most=2_000)
