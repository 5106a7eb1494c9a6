"""Random packets for tests of parts of converters, a bench for parsers, and a search for paths."""

from __future__ import annotations

import random
from functools import lru_cache

from amaranth.hdl import Cat, Value
from amaranth.sim import Simulator

from firm_hdl import Parser
from firm_hdl.plan import Plan, encode
from firm_hdl.sim.bench import Bench, Ports
from tests.depth import by_depth

__all__ = ["has_path", "is_quick", "parser_bench", "random_packets"]

MOST_LANES = by_depth(64, 1 << 20)
"""Limit on steps times bytes of the bus; larger circuits take seconds to generate, up to 15."""


def is_quick(plan: Plan) -> bool:
    """Return whether the circuits of a random plan are small enough for this depth of tests."""
    return len(plan.steps) * plan.bus_bytes <= MOST_LANES


def has_path(component, inputs, outputs):
    """Return whether an output changes with the inputs within a cycle."""
    rng = random.Random(1)
    changes = []

    async def bench(ctx):
        for _ in range(by_depth(150, 500)):
            found = set()
            for _ in range(4):
                ctx.set(inputs, rng.getrandbits(len(inputs)))
                found.add(ctx.get(outputs))
            changes.append(len(found) > 1)
            await ctx.tick()

    simulator = Simulator(component)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    simulator.run()
    return any(changes)


@lru_cache(maxsize=4)
def parser_bench(parser: Parser) -> Bench:
    """Return a bench of a parser; each run of it starts with all initial values."""
    status = Cat(Value.cast(parser.status.payload), Value.cast(parser.sizes))
    ports = Ports(
        sources={"packets": parser.packets},
        sinks={"status": parser.status},
        payloads={"status": status},
    )
    return Bench(parser, ports)


def random_packets(
    plan: Plan, count: int, seed: int = 0, *, sizes: tuple[range, range] = (range(13), range(5))
) -> list[bytes]:
    """Return packets with random values.

    Parameters
    ----------
    sizes : pair of ranges
        Possible lengths on the wire of strings, and of sequences.
    """
    rng = random.Random(f"{plan.message}/{seed}")
    strings = {
        leaf.path[:-1] for leaf in plan.leaves if leaf.kind == "items" and leaf.item_bytes == 1
    }

    def payloads(index, leaf):
        bits = 1 if leaf.type == "bool" else 8 * max(1, leaf.item_bytes)
        low = -(1 << (bits - 1)) if leaf.signed else 0
        while True:
            if leaf.kind == "length":
                possible = sizes[leaf.path[:-1] not in strings]
                yield min(rng.choice(possible), plan.lengths[index].limit)
            elif leaf.kind == "items":
                yield tuple(rng.getrandbits(bits) + low for _ in range(leaf.lanes)), False
            else:
                yield 1 if leaf.kind == "trigger" else rng.getrandbits(bits) + low

    streams = {index: payloads(index, leaf) for index, leaf in enumerate(plan.leaves)}
    return [encode(plan, streams)[0] for _ in range(count)]
