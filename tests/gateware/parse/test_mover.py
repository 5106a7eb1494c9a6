# amaranth: UnusedElaboratable=no
"""The mover alone: orders by hand, with noise where no order is offered, or one without a step."""

from __future__ import annotations

import random
from itertools import product

import pytest
from amaranth.sim import Simulator

from firm_hdl import Deserializer
from firm_hdl.gateware.mover import Mover
from firm_hdl.gateware.signatures import Status, leaf_streams
from tests.strategies import make

MESSAGE = make("ros1", {"v": "uint32"})
"""On a bus of one byte: three steps, the last one of two bytes."""
PARTS = [(0, 1), (1, 1), (2, 2)]
"""First byte and size of each step."""
VALUES = [0x44332211, 0xFFEEDDCC, 0x80000001]
STATUSES = [Status.OK, Status.TRAILING, Status.OK]


def moved(gap, noise, ready_rate):
    """Return the values and statuses that leave.

    Parameters
    ----------
    gap : int
        Cycles with noise after each order.
    noise : callable
        From the step before to the payload of `orders`. With `blank`, it is an order.
    ready_rate : float
        Of the leaf and of the status.
    """
    rx = Deserializer(MESSAGE, bus_bytes=1)
    streams, rng = leaf_streams(rx.message, rx.tree), random.Random(gap)
    assert [(part.first, part.bytes) for step in rx.plan.steps for part in step.parts] == PARTS
    mover, values, statuses = Mover(rx.plan, streams), [], []
    data = b"".join(value.to_bytes(4, "little") for value in VALUES)

    async def bench(ctx):
        async def tick(payload, valid):
            """Offer an order for a cycle; return whether it is taken."""
            ctx.set(mover.orders.payload, payload)
            ctx.set(mover.orders.valid, valid)
            for port, found in ((streams[0], values), (mover.status, statuses)):
                ready = rng.random() < ready_rate
                ctx.set(port.ready, ready)
                if ready and ctx.get(port.valid):
                    found.append(ctx.get(port.payload))
            taken = valid and ctx.get(mover.orders.ready)
            await ctx.tick()
            return taken

        for at, byte in enumerate(data):
            ctx.set(mover.beat, {"data": byte, "count": 1, "at": at, "valid": 1})
            await tick({}, 0)
        ctx.set(mover.beat, {"valid": 0})
        for number, (step, (first, size)) in product(range(len(VALUES)), enumerate(PARTS)):
            # The first byte of the last step is in the word of items.
            at = 4 * number + first
            order = {"step": step, "items_at": at, "map_at": at + size - 1, "ends": step == 2}
            order |= {"items_bytes": 1, "map_bytes": 1, "status": STATUSES[number]}
            while not await tick(order, 1):
                pass
            for _ in range(gap):
                nothing = noise(step)
                while not await tick(nothing, nothing["blank"]) and nothing["blank"]:
                    pass
        while len(statuses) < len(VALUES):
            await tick({}, 0)
        for _ in range(8):
            await tick({}, 0)

    simulator = Simulator(mover)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    simulator.run_until(1e-3)
    return values, statuses


@pytest.mark.parametrize("ready_rate", [1, 0.4])
@pytest.mark.parametrize("blank", [0, 1])
@pytest.mark.parametrize("gap", range(4))
def test_what_is_no_order_or_has_no_step_moves_nothing(gap, blank, ready_rate):
    rng = random.Random(gap)

    def noise(step):
        # The step before, whose bytes would go to the same place, or any other one.
        noisy = {"step": rng.choice([step, rng.randrange(3)]), "blank": blank}
        for word in ("items", "map"):
            noisy |= {f"{word}_at": rng.randrange(12), f"{word}_bytes": rng.randrange(2)}
        return noisy | {"ends": 0 if blank else rng.randrange(2), "status": Status.LENGTH}

    assert moved(gap, noise, ready_rate) == (VALUES, STATUSES)
