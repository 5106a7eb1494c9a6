# amaranth: UnusedElaboratable=no
"""Logic divided by depth: the same values in every cycle, from more processes."""

from __future__ import annotations

import random

import pytest
from amaranth.hdl import Cat, Fragment, Module, Signal
from amaranth.sim import Simulator

from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.sim.levels import divided


class Chain:
    """A chain with a choice, an assignment to two signals, one to some bits, and a register."""

    def __init__(self):
        self.a, self.b = Signal(8), Signal(8)
        self.found = [Signal(8, name=f"found_{k}") for k in range(7)]

    def top(self):
        m = Module()
        a, b, found = self.a, self.b, self.found
        m.d.comb += found[0].eq(a + b)
        with m.If(found[0][0]):
            m.d.comb += [found[1].eq(found[0] ^ a), found[2].eq(1)]
        with m.Else():
            m.d.comb += [found[2].eq(found[1] + 3), found[6].eq(found[4] ^ b)]
        m.d.comb += Cat(found[3][:4], found[4]).eq(found[2] * 5)
        m.d.comb += found[3][4:].eq(found[1][4:])
        m.d.sync += found[5].eq(found[5] + found[4])
        return m


def run(chain, design):
    """Return the values of all signals in each of 200 cycles."""
    rows, rng = [], random.Random(1)

    async def testbench(ctx):
        for _ in range(200):
            ctx.set(chain.a, rng.getrandbits(8))
            ctx.set(chain.b, rng.getrandbits(8))
            rows.append([ctx.get(each) for each in chain.found])
            await ctx.tick()

    simulator = Simulator(design)
    simulator.add_clock(1e-6)
    simulator.add_testbench(testbench)
    simulator.run()
    return rows


def parts(fragment):
    """Return how many parts of a design have combinational logic."""
    own = "comb" in fragment.statements
    return own + sum(parts(child) for child, *_ in fragment.subfragments)


def test_values_are_the_same():
    chain = Chain()
    rows = run(chain, chain.top())
    assert len({tuple(row) for row in rows}) > 150
    assert run(chain, divided(chain.top())) == rows
    # found_0, found_1, found_2, the two signals that are written together, and found_6.
    assert parts(divided(chain.top())) == 5


@pytest.mark.parametrize("converter", [Deserializer, Serializer])
@pytest.mark.sampled(2)
def test_a_converter_has_more_parts(converter):
    message = load_message("sensor_msgs/msg/JointState")
    whole = parts(Fragment.get(converter(message), None))
    assert parts(divided(converter(message))) >= 2 * whole
