# amaranth: UnusedElaboratable=no
"""Counters of 32 bits, which stay at their largest value instead of beginning again."""

from __future__ import annotations

import struct

import pytest
from amaranth.hdl import Module, Signal, Value
from amaranth.sim import Simulator

from firm_hdl.gateware.packets.counters import add_counters, counters_layout
from firm_hdl.node.gateware.fragments import Reassembler

MOST = 0xFFFF_FFFF


def simulated(part, use):
    simulator = Simulator(part)
    simulator.add_clock(1e-6)
    simulator.add_testbench(use)
    simulator.run()


def test_events_are_counted_up_to_the_largest_value():
    m, event = Module(), Signal()
    counters = Signal(counters_layout("first", "other"))
    add_counters(m, counters, {"first": event, "other": ~event})

    async def use(ctx):
        await ctx.tick()
        ctx.set(event, 1)
        await ctx.tick().repeat(3)
        ctx.set(counters, {"first": MOST - 3, "other": MOST})
        seen = []
        for _ in range(6):
            seen.append(ctx.get(counters.first))
            await ctx.tick()
        assert seen == [MOST - 3, MOST - 2, MOST - 1, MOST, MOST, MOST]
        ctx.set(event, 0)
        await ctx.tick().repeat(4)
        assert (ctx.get(counters.first), ctx.get(counters.other)) == (MOST, MOST)

    simulated(m, use)


@pytest.mark.parametrize(
    ("before", "gap", "after"),
    [
        (7, 5, 12),
        (MOST - 5, 5, MOST),
        (MOST - 4, 5, MOST),
        (MOST, 5, MOST),
        (MOST - 9, 32767, MOST),
    ],
)
def test_lost_messages_are_counted_up_to_the_largest_value(before, gap, after):
    part = Reassembler(16)

    async def use(ctx):
        async def take(sequence):
            header = struct.pack("<BBHIIHH", 0xF1, 1, 1, 0, 0, sequence, 0)
            ctx.set(Value.cast(part.i.payload.data), int.from_bytes(header, "little"))
            ctx.set(part.i.valid, 1)
            await ctx.tick().until(part.i.ready)
            ctx.set(part.i.valid, 0)
            await ctx.tick().repeat(9)

        ctx.set(part.o.ready, 1)
        ctx.set(part.i.payload.count, 16)
        ctx.set(part.i.payload.last, 1)
        await take(4)
        assert ctx.get(part.lost) == 0
        ctx.set(part.lost, before)
        if gap > 64:
            # The message before is one of them, as it is too far away to be believed.
            await take(4 + gap)
        await take(5 + gap)
        assert ctx.get(part.lost) == after
        # The next one follows, so none is missing.
        await take(6 + gap)
        assert ctx.get(part.lost) == after

    simulated(part, use)
