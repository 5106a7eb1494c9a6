# amaranth: UnusedElaboratable=no
"""The queue of orders, compared with a list of at most two."""

from __future__ import annotations

import random

import pytest
from amaranth.hdl import Value
from amaranth.sim import Simulator

from firm_hdl.gateware.parse.orders import OrderQueue, order_layout
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.strategies import make

PLAN = build_plan(lay_out(make("ros1", {"s": "string", "x": "uint8"})), bus_bytes=4)
LAYOUT = order_layout(PLAN)


def compare(rates, tamper=lambda bits: bits):
    """Send random orders; `rates` has the rates of offered and of taken orders."""
    dut, rng = OrderQueue(PLAN), random.Random(str(rates))
    queue, taken, most = [], 0, 0

    async def testbench(ctx):
        nonlocal taken, most
        offered = None
        for _ in range(600):
            if offered is None and rng.random() < rates[0]:
                offered = rng.getrandbits(LAYOUT.size)
            ctx.set(Value.cast(dut.i.payload), rng.getrandbits(LAYOUT.size))
            if offered is not None:
                ctx.set(Value.cast(dut.i.payload), offered)
            ctx.set(dut.i.valid, offered is not None)
            ready, at = rng.random() < rates[1], rng.randrange(16)
            ctx.set(dut.o.ready, ready)
            ctx.set(dut.oldest, at)
            assert ctx.get(dut.i.ready) or queue
            first = LAYOUT.from_bits(queue[0]).first if queue else at
            assert ctx.get(dut.freed) == first
            accepted = offered is not None and ctx.get(dut.i.ready)
            if ctx.get(dut.o.valid):
                assert tamper(ctx.get(Value.cast(dut.o.payload))) == queue[0]
                if ready:
                    queue.pop(0)
                    taken += 1
            if accepted:
                queue.append(offered)
                offered = None
            most = max(most, len(queue))
            await ctx.tick()

    simulator = Simulator(dut)
    simulator.add_clock(1e-6)
    simulator.add_testbench(testbench)
    simulator.run()
    return taken, most


@pytest.mark.parametrize("rates", [(1, 0.5), (0.5, 1), (0.5, 0.5), (0.2, 0.9), (0.9, 0.2)])
def test_orders_come_out_as_they_went_in(rates):
    taken, most = compare(rates)
    assert taken > 600 * min(rates) * 0.6
    assert most == (2 if rates[1] < 1 else 1)


def test_an_order_per_cycle():
    assert compare((1, 1)) == (599, 1)


def test_another_order_is_noticed():
    with pytest.raises(AssertionError):
        compare((1, 0.5), tamper=lambda bits: bits ^ 1 << LAYOUT["status"].offset)


TEXT = make("ros1", {"s": "string"}, "Text")
CLAIMS = build_plan(lay_out(make("ros1", {"t": (TEXT, "[]")})), bus_bytes=4)


@pytest.mark.parametrize("taken", ["before", "with", "after"])
@pytest.mark.parametrize("refused", [False, True])
def test_only_the_newest_order_is_refused(refused, taken):
    """Send two orders, and refuse the second one; `taken` tells when the first one is taken."""
    dut, seen = OrderQueue(CLAIMS), []
    sends, refuses = (0, 1), 4
    takes = {"before": refuses - 1, "with": refuses, "after": refuses + 1}[taken]

    async def testbench(ctx):
        for cycle in range(12):
            ctx.set(dut.i.valid, cycle in sends)
            ctx.set(dut.i.payload.step, cycle)
            ctx.set(dut.i.payload.length_good, 1)
            ctx.set(dut.holds, 1 < cycle <= refuses)
            ctx.set(dut.refuses, refused and cycle == refuses)
            # An order enters the first place only if nothing waits there.
            ctx.set(dut.o.ready, cycle == 0 or cycle >= takes)
            if ctx.get(dut.o.valid) and cycle >= takes:
                order = dut.o.payload
                seen.append((cycle, ctx.get(order.step), ctx.get(order.length_good)))
            await ctx.tick()

    simulator = Simulator(dut)
    simulator.add_clock(1e-6)
    simulator.add_testbench(testbench)
    simulator.run()
    # Only the second order waits for the check.
    assert seen == [(takes, 0, 1), (max(takes, refuses) + 1, 1, not refused)]
