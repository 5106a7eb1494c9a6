# amaranth: UnusedElaboratable=no
"""Logic divided by depth: the same values in every cycle, from more processes."""

from __future__ import annotations

import random

import pytest
from amaranth.hdl import Cat, Fragment, Module, Signal
from amaranth.hdl._ast import Switch
from amaranth.sim import Simulator

from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.sim import levels
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


def test_lost_statement_is_noticed(monkeypatch):
    chain = Chain()
    rows = run(chain, chain.top())
    kept = levels._by_part

    def lossy(statements, place):
        return kept(list(statements)[:-1], place)

    monkeypatch.setattr(levels, "_by_part", lossy)
    assert run(chain, divided(chain.top())) != rows


@pytest.mark.parametrize("converter", [Deserializer, Serializer])
def test_a_converter_has_more_parts(converter):
    message = load_message("sensor_msgs/msg/JointState")
    whole = parts(Fragment.get(converter(message), None))
    assert parts(divided(converter(message))) >= 2 * whole


def assignments(statements, tests=()):
    """Yield the signals that each assignment drives, and those that it reads, by their `id`."""
    for statement in statements:
        if isinstance(statement, Switch):
            inner = {*tests, *map(id, statement.test._rhs_signals())}
            for _, body, _ in statement.cases:
                yield from assignments(body, inner)
        else:
            read = {*tests, *map(id, statement._rhs_signals())}
            yield set(map(id, statement._lhs_signals())), read


def groups_of(steps):
    """Return the signals that assignments drive, joined if one assignment drives both."""
    groups = []
    for driven, _ in steps:
        joined = driven.union(*(each for each in groups if each & driven))
        groups = [each for each in groups if not each & driven] + [joined]
    return {signal: group for group in groups for signal in group}


def nested():
    """Return a module with a choice inside a choice, and a signal that two assignments join."""
    m = Module()
    a, b, c, d, e, f = (Signal(8, name=name) for name in "abcdef")
    # Only the last signal of the group reads what is driven.
    outer, inner = Signal(name="outer"), Signal(name="inner")
    m.d.comb += [outer.eq(a[0] ^ a[1]), inner.eq(outer ^ a[2])]
    with m.If(inner), m.If(a[3]):
        m.d.comb += b.eq(1)
    m.d.comb += [Cat(c, d[:4]).eq(a), Cat(d[4:], e).eq(inner), f.eq(e + b)]
    return m


def converter_parts():
    """Yield the parts of a converter that have logic."""
    waiting = [Fragment.get(Deserializer(load_message("std_msgs/msg/Header")), None)]
    while waiting:
        fragment = waiting.pop()
        waiting += [child for child, *_ in fragment.subfragments]
        if "comb" in fragment.statements:
            yield fragment


def test_what_a_signal_reads_is_of_a_part_before_it():
    for fragment in [Fragment.get(nested(), None), *converter_parts()]:
        statements = fragment.statements["comb"]
        steps = list(assignments(statements))
        groups = groups_of(steps)
        found = [list(map(id, part)) for part in levels._Levels(statements).found()]
        at = {signal: number for number, part in enumerate(found) for signal in part}
        assert sorted(signal for part in found for signal in part) == sorted(groups)
        for driven, read in steps:
            (place,) = {at[signal] for signal in driven}
            (group,) = {frozenset(groups[signal]) for signal in driven}
            assert all(at[other] < place for other in (read & groups.keys()) - group)


def test_signals_that_assignments_join_stay_together():
    found = levels._Levels(Fragment.get(nested(), None).statements["comb"]).found()
    names = [sorted(signal.name for signal in part) for part in found]
    assert names == [["outer"], ["inner"], ["b", "c", "d", "e"], ["f"]]
