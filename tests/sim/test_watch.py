"""The watcher of stream rules: silent on correct streams, and a numbered rule for each fault."""

from __future__ import annotations

import pytest
from amaranth.hdl import ClockDomain, Module
from amaranth.sim import Simulator

from firm_hdl.gateware.signatures import packet_layout
from firm_hdl.sim import Stalls, StreamRuleError, receive, send, watch
from firm_hdl.sim.payloads import packet_beats
from firm_hdl.sim.watch import PacketRules
from tests.sim.components import Relay, run_testbenches

SLOW = Stalls.bits("00001")


def relay(fault, stalls=SLOW):
    dut = Relay(8, fault)
    got = []

    async def source(ctx):
        await send(ctx, dut.i, range(1, 9))

    async def sink(ctx):
        got.extend(await receive(ctx, dut.o, 8, stalls=stalls))

    run_testbenches(dut, source, sink, background=[watch({"i": dut.i, "dut.o": dut.o})])
    return got


def test_right_stream_passes():
    assert relay("") == list(range(1, 9))


def test_valid_that_falls_is_rule_2():
    with pytest.raises(StreamRuleError) as caught:
        relay("drop")
    error = caught.value
    assert (error.stream, error.rule) == ("dut.o", 2)
    assert str(error) == (
        f"Stream 'dut.o' breaks rule 2 in cycle {error.cycle}: valid fell before the transfer"
    )


def test_payload_that_changes_is_rule_3():
    with pytest.raises(
        StreamRuleError,
        match=r"^Stream 'dut\.o' breaks rule 3 in cycle \d+: payload changed from 0x1 to 0x0 ",
    ):
        relay("change")


def test_reset_takes_back_what_was_offered_and_begins_a_new_packet():
    dut = Relay(packet_layout(4))
    top = Module()
    top.domains.sync = domain = ClockDomain("sync")
    top.submodules.dut = dut
    seen = []

    async def source(ctx):
        # The first beat is taken, and the second one waits when the reset comes.
        ctx.set(dut.o.ready, 1)
        await send(ctx, dut.i, [beat(4, 0)])
        await ctx.tick()
        ctx.set(dut.o.ready, 0)
        await send(ctx, dut.i, [beat(4, 0)])
        await ctx.tick().repeat(2)
        seen.append(ctx.get(dut.o.valid))
        ctx.set(domain.rst, 1)
        await ctx.tick()
        ctx.set(domain.rst, 0)
        seen.append(ctx.get(dut.o.valid))
        await ctx.tick().repeat(2)
        ctx.set(dut.o.ready, 1)
        await send(ctx, dut.i, [beat(0, 1)])
        await ctx.tick().repeat(2)

    simulator = Simulator(top)
    simulator.add_clock(1e-6)
    simulator.add_testbench(source)
    simulator.add_testbench(watch({"o": dut.o}), background=True)
    simulator.run()
    assert seen == [1, 0]


def test_a_watcher_begins_anew_with_each_simulation():
    dut = Relay(packet_layout(4))
    watcher, seen = watch({"o": dut.o}), []
    # The first simulation ends inside a packet; in the second one, an empty packet comes.
    for given in (beat(4, 0), beat(0, 1)):

        async def source(ctx, given=given):
            await send(ctx, dut.i, [given])

        async def sink(ctx):
            seen.extend(await receive(ctx, dut.o, 1))
            await ctx.tick()

        run_testbenches(dut, source, sink, background=[watcher])
    assert [each.last for each in seen] == [0, 1]


def beat(count, last, bus_bytes=4):
    return packet_layout(bus_bytes).const({"data": [0] * bus_bytes, "count": count, "last": last})


@pytest.mark.parametrize(
    ("beats", "rule"),
    [
        ([(3, 0)], 5),
        ([(0, 0)], 5),
        ([(5, 1)], 6),
        ([(4, 0), (0, 1)], 6),
        ([(4, 0), (4, 1), (2, 0)], 5),
    ],
)
def test_beats_that_no_packet_has_are_rules_5_and_6(beats, rule):
    rules = PacketRules("p", 4)
    with pytest.raises(StreamRuleError, match=f"^Stream 'p' breaks rule {rule} in cycle "):
        for cycle, (count, last) in enumerate(beats):
            rules.check(cycle, beat(count, last).as_bits())


@pytest.mark.parametrize("size", range(10))
def test_beats_of_packets_are_right(size):
    rules = PacketRules("p", 4)
    for packet in (bytes(size), bytes(size)):
        for cycle, bits in enumerate(packet_beats(packet, 4)):
            rules.check(cycle, bits)


def test_a_beat_is_checked_in_the_cycle_of_its_transfer_and_cycles_of_a_reset_count():
    dut = Relay(packet_layout(4))
    top = Module()
    top.domains.sync = domain = ClockDomain("sync")
    top.submodules.dut = dut

    async def source(ctx):
        ctx.set(domain.rst, 1)
        for _ in range(2):
            await ctx.tick()
        ctx.set(domain.rst, 0)
        # Taken in cycle 2.
        await send(ctx, dut.i, [beat(4, 0)])
        await send(ctx, dut.i, [beat(2, 0)])

    async def sink(ctx):
        for _ in range(6):
            await ctx.tick()
        # The register gets free.
        ctx.set(dut.o.ready, 1)

    simulator = Simulator(top)
    simulator.add_clock(1e-6)
    simulator.add_testbench(source)
    simulator.add_testbench(sink)
    simulator.add_testbench(watch({"i": dut.i}), background=True)
    with pytest.raises(StreamRuleError, match=r"^Stream 'i' breaks rule 5 in cycle 6:"):
        simulator.run()
