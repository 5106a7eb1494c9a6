"""Statements of several registers merged into one process assign the same values as before."""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterable
from dataclasses import replace

import pytest

from firm_hdl.rtlil.ir import Assign, Bits, Case, Slice, Statement, Switch
from firm_hdl.vhdl.process import flatten, merged
from tests.depth import by_depth

Body = tuple[Statement, ...]
WIDTHS = {"s": 2, "t": 2, "u": 1}
STATES = [
    dict(zip(WIDTHS, bits, strict=True))
    for bits in itertools.product(*(["".join(b) for b in itertools.product("01", repeat=width)]
                                    for width in WIDTHS.values()))
]  # fmt: skip


def run(body: Iterable[Statement], state: dict[str, str], seen: dict[str, str]) -> dict[str, str]:
    """Execute statements by the rules of RTLIL: the first matching case, the last assignment."""
    for statement in body:
        if isinstance(statement, Assign):
            for target, value in zip(statement.target, statement.value, strict=True):
                assert isinstance(target, Slice) and isinstance(value, Bits)
                seen[target.wire] = value.text
            continue
        bits = "".join(state[each.wire] for each in statement.selector if isinstance(each, Slice))
        for case in statement.cases:
            if not case.patterns or any(matches(each, bits) for each in case.patterns):
                run(case.body, state, seen)
                break
    return seen


def matches(pattern: str, bits: str) -> bool:
    return all(mark in ("-", bit) for mark, bit in zip(pattern, bits, strict=True))


def body_of(wire: str, chosen: random.Random, depth: int = 0) -> Body:
    """Make random statements that assign one register."""
    result: list[Statement] = []
    for _ in range(chosen.randint(0 if depth else 1, 3)):
        if chosen.random() < 0.05:
            result.append(Assign(target=(), value=()))
        if depth == 3 or chosen.random() < 0.4:
            result.append(assign(wire, f"{chosen.randrange(16):04b}"))
            continue
        name = chosen.choice([*WIDTHS, ""])
        marks = "01-" if chosen.random() < 0.3 else "01"
        width = WIDTHS.get(name, 0)
        patterns = ["".join(each) for each in itertools.product(marks, repeat=width)]
        cases = []
        for _ in range(chosen.randint(1, 3)):
            few = chosen.sample(patterns, min(len(patterns), chosen.randint(0, 2)))
            cases.append(Case(patterns=tuple(few), body=body_of(wire, chosen, depth + 1)))
        result.append(Switch(selector=(Slice(name, 0, width),) if name else (), cases=tuple(cases)))
    return tuple(result)


def assign(wire: str, text: str) -> Assign:
    return Assign(target=(Slice(wire, 0, 4),), value=(Bits(text),))


@pytest.mark.parametrize("start", range(0, by_depth(200, 600), 100))
def test_merged_statements_assign_the_same_values(start: int) -> None:
    for seed in range(start, start + 100):
        chosen = random.Random(seed)
        first, second = (flatten(body_of(wire, chosen)) for wire in "pq")
        both = merged(first, second)
        for state in STATES:
            apart = run(second, state, run(first, state, {}))
            assert run(both, state, {}) == apart, (seed, state)


@pytest.mark.parametrize("start", range(0, 300, 100))
def test_empty_switches_are_removed_without_effect(start: int) -> None:
    for seed in range(start, start + 100):
        body = body_of("p", random.Random(seed))
        flat = flatten(body)
        for state in STATES:
            assert run(flat, state, {}) == run(body, state, {}), (seed, state)
        for statement in all_statements(flat):
            if isinstance(statement, Switch):
                assert statement.selector and any(case.body for case in statement.cases)
            else:
                assert statement.target


def all_statements(body: Body) -> Iterable[Statement]:
    for statement in body:
        yield statement
        for case in statement.cases if isinstance(statement, Switch) else ():
            yield from all_statements(case.body)


def switch_on(wire: str, **bodies: str) -> Switch:
    """Return a switch on `s`: from a pattern such as `b01`, or `other`, to the value of `wire`."""
    cases = [
        Case(patterns=() if name == "other" else (name[1:],), body=(assign(wire, text),))
        for name, text in bodies.items()
    ]
    return Switch(selector=(Slice("s", 0, 2),), cases=tuple(cases))


def test_no_statement_overtakes_another_one_of_its_register() -> None:
    on_t = Switch(
        selector=(Slice("t", 0, 2),), cases=(Case(patterns=("01",), body=(assign("p", "0001"),)),)
    )
    later = replace(on_t, cases=(Case(patterns=("01",), body=(assign("q", "1111"),)),))
    first, second = (on_t, switch_on("p", b01="0010")), (switch_on("q", b01="0100"), later)
    both = merged(first, second)
    for state in STATES:
        assert run(both, state, {}) == run(second, state, run(first, state, {})), state
