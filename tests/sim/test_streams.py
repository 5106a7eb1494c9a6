"""Drivers and monitors of single streams, on a relay."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from firm_hdl.gateware.signatures import Status, packet_layout
from firm_hdl.sim import (
    DeadlineError,
    Stalls,
    receive,
    receive_packets,
    receive_statuses,
    send,
    send_packets,
    watch,
)
from tests.sim.components import Relay, run_testbenches

stalls = st.one_of(
    st.just(Stalls.none),
    st.builds(Stalls, st.floats(0, 1), st.just(1), st.integers(1, 5), st.integers(0, 99)),
    st.sampled_from(["1101", "0111", "10", "001"]).map(Stalls.bits),
)


def exchange(dut, payloads, *, i_stall=Stalls.none, o_stall=Stalls.none, **options):
    got = []

    async def source(ctx):
        await send(ctx, dut.i, payloads, stalls=i_stall, name="i")

    async def sink(ctx):
        count = options.pop("count", len(payloads))
        got.extend(await receive(ctx, dut.o, count, stalls=o_stall, name="o", **options))

    run_testbenches(dut, source, sink, background=[watch({"i": dut.i, "o": dut.o})])
    return got


@settings(max_examples=15, deadline=None)
@given(payloads=st.lists(st.integers(0, 255), max_size=12), i_stall=stalls, o_stall=stalls)
def test_payloads_arrive_in_order_under_any_stall(payloads, i_stall, o_stall):
    assert exchange(Relay(8), payloads, i_stall=i_stall, o_stall=o_stall) == payloads


def test_lost_payloads_hit_the_deadline_of_the_sink():
    with pytest.raises(
        DeadlineError,
        match=r"^No transfer on stream 'o' in 21 cycles; outstanding: 2 of 8 transfers$",
    ):
        exchange(Relay(8, "swallow"), range(8), deadline=20)


@pytest.mark.parametrize("bus_bytes", [1, 4, 8])
@settings(max_examples=10, deadline=None)
@given(packets=st.lists(st.binary(max_size=20), max_size=4), i_stall=stalls, o_stall=stalls)
def test_packets_arrive_whole(bus_bytes, packets, i_stall, o_stall):
    dut = Relay(packet_layout(bus_bytes))
    got = []

    async def source(ctx):
        await send_packets(ctx, dut.i, packets, stalls=i_stall)

    async def sink(ctx):
        got.extend(await receive_packets(ctx, dut.o, len(packets), stalls=o_stall))

    run_testbenches(dut, source, sink, background=[watch({"i": dut.i, "o": dut.o})])
    assert got == packets


def test_deadline_of_packets_reports_the_partial_packet():
    dut = Relay(packet_layout(4), "block")

    async def source(ctx):
        ctx.set(dut.i.valid, 0)
        for bits in (bytes(4), bytes(13)):
            await send_packets(ctx, dut.i, [bits])

    async def sink(ctx):
        await receive_packets(ctx, dut.o, 2, deadline=9)

    message = (
        r"^No transfer on stream 'packets_out' in 10 cycles; "
        r"outstanding: 1 of 2 packets, 12 bytes of one have come; "
        r"offered while `ready` is low: design\.i$"
    )
    with pytest.raises(DeadlineError, match=message):
        run_testbenches(dut, sink, background=[source])


def test_a_stream_has_the_stalls_of_its_name():
    stall, patterns = Stalls(0.5, 1, 5, seed=3), {}
    for name in ("packets_in", "other"):
        dut, cycles = Relay(packet_layout(4)), []

        async def source(ctx, name=name, dut=dut):
            await send_packets(ctx, dut.i, [bytes(40)], stalls=stall, name=name)

        async def sink(ctx, dut=dut, cycles=cycles):
            ctx.set(dut.o.ready, 1)
            for _ in range(60):
                _, _, valid = await ctx.tick().sample(dut.i.valid)
                cycles.append(valid)

        run_testbenches(dut, source, sink)
        patterns[name] = cycles
    offered = [not stalled for stalled, _ in zip(stall.cycles("other"), range(60), strict=False)]
    assert sum(patterns["other"]) == sum(patterns["packets_in"]) == 10
    assert patterns["other"].index(1) == offered.index(True)
    assert patterns["other"] != patterns["packets_in"]


@pytest.mark.parametrize("call", [receive, receive_packets, receive_statuses])
def test_silence_of_1000_cycles_is_no_missed_deadline(call):
    dut = Relay(Status if call is receive_statuses else packet_layout(1))

    async def sink(ctx):
        await call(ctx, dut.o, 1)

    with pytest.raises(DeadlineError, match=r"^No transfer on stream '.*' in 1001 cycles"):
        run_testbenches(dut, sink)
