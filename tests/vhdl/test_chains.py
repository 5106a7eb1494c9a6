"""Statements written as `if`, `case` or conditional assignments do what the netlist says.

The text is executed by a small interpreter of its own, the netlist by the rules of RTLIL.
"""

from __future__ import annotations

import itertools
import random
import re

import pytest

from firm_hdl.rtlil.ir import Assign, Bits, Case, Slice, Spec, Statement, Switch, spec_width
from firm_hdl.vhdl.expr import Declared, Values
from firm_hdl.vhdl.process import Statements, flatten

Body = tuple[Statement, ...]
State = dict[str, str]
WIDTHS = {"s": 3, "t": 2, "u": 1, "v": 4, "p": 4}
SELECTORS: list[Spec] = [
    (Slice("s", 0, 3),),
    (Slice("t", 0, 2),),
    (Slice("u", 0, 1),),
    (Slice("s", 1, 2),),
    (Slice("t", 1, 1),),
    (Slice("u", 0, 1), Slice("t", 0, 2)),
    (Slice("t", 0, 1), Bits("1"), Slice("u", 0, 1)),
]
STATES = [
    {"s": s, "t": t, "u": u, "v": "0110", "p": "1001"}
    for s, t, u in itertools.product(
        *(["".join(bits) for bits in itertools.product("01", repeat=n)] for n in (3, 2, 1))
    )
]
STATEMENTS = Statements(
    Values({name: Declared(name=name, width=n) for name, n in WIDTHS.items()}, {}, WIDTHS),
    {"p": Declared(name="p", width=4)},
    lambda *_: "",
)


def bits_of(spec: Spec, state: State) -> str:
    chunks = (each.text if isinstance(each, Bits) else part(each, state) for each in spec)
    return "".join(reversed(list(chunks)))


def part(chunk: Slice, state: State) -> str:
    bits = state[chunk.wire]
    return bits[len(bits) - chunk.low - chunk.width : len(bits) - chunk.low]


def store(state: State, low: int, value: str) -> None:
    bits = state["p"]
    end = len(bits) - low
    state["p"] = bits[: end - len(value)] + value + bits[end:]


def run(body: Body, state: State) -> None:
    """Execute statements by the rules of RTLIL: the first arm that matches."""
    for statement in body:
        if isinstance(statement, Assign):
            (chunk,) = statement.target
            assert isinstance(chunk, Slice)
            store(state, chunk.low, bits_of(statement.value, state))
            continue
        bits = bits_of(statement.selector, state)
        for case in statement.cases:
            fits = (
                all(m in ("-", b) for m, b in zip(each, bits, strict=True))
                for each in case.patterns
            )
            if not case.patterns or any(fits):
                run(case.body, state)
                break


PLACE = r"(\w+)(?:\((\d+)(?: downto (\d+))?\))?"


def read(text: str, state: State) -> str:
    """Return the bits of a literal, a signal or a part of one."""
    if text == "(others => '0')":
        return "0" * WIDTHS["p"]
    if text[0] in "'\"":
        return text[1:-1]
    match = re.fullmatch(PLACE, text)
    assert match, text
    name, high, low = match.groups()
    if high is None:
        return state[name]
    return part(Slice(name, int(low or high), int(high) - int(low or high) + 1), state)


def holds(condition: str, state: State) -> bool:
    def compare(match: re.Match[str]) -> str:
        left, right = match[0].split(" = ")
        assert len(read(left, state)) == len(read(right, state)), match[0]
        return str(read(left, state) == read(right, state))

    text = re.sub(PLACE + r""" = ['"][01]+['"]""", compare, condition)
    return bool(eval(text.replace("true", "True").replace("false", "False"), {}))


def execute(lines: list[str], state: State | None) -> None:
    """Execute lines of VHDL up to the end of their block; without a state, only skip them."""
    while lines and not re.match(r"elsif|else|end|when", lines[0]):
        line = lines.pop(0)
        if line == "null;":
            continue
        if line.startswith("if "):
            choose(lines, line, state)
        elif line.startswith("case "):
            decide(lines, line[5:-3], state)
        elif state is not None:
            target, value = line.removesuffix(";").split(" <= ", 1)
            match = re.fullmatch(PLACE, target)
            assert match and match[1] == "p", line
            bits = read(value, state)
            assert len(bits) == len(read(target, state)), line
            store(state, int(match[3] or match[2] or 0), bits)


def choose(lines: list[str], line: str, state: State | None) -> None:
    done = False
    while line != "end if;":
        condition = re.sub(r"^(if|elsif) (.*) then$", r"\2", line)
        taken = state is not None and not done and (line == "else" or holds(condition, state))
        done |= taken
        execute(lines, state if taken else None)
        line = lines.pop(0)


def decide(lines: list[str], selector: str, state: State | None) -> None:
    seen: list[str] = []
    taken = False
    while (line := lines.pop(0)) != "end case;":
        assert "others" not in seen
        choices = line.removeprefix("when ").removesuffix(" =>").replace('"', "").split(" | ")
        seen += choices
        now = state is not None and (read(selector, state) in choices or choices == ["others"])
        execute(lines, state if now and not taken else None)
        taken |= now
    assert seen[-1] == "others" and len(set(seen)) == len(seen), "VHDL allows no choice twice"


class Maker:
    """Random statements that assign `p`."""

    def __init__(self, seed: int) -> None:
        self.chosen = random.Random(seed)

    def assign(self, whole: bool) -> Assign:
        width = 4 if whole else self.chosen.randint(1, 4)
        low = self.chosen.randint(0, 4 - width)
        text = "".join(self.chosen.choice("01") for _ in range(width))
        value = self.chosen.choice([Bits(text), Bits(text), Slice("v", low, width)])
        return Assign(target=(Slice("p", low, width),), value=(value,))

    def switch(self, depth: int, whole: bool) -> Switch:
        selector = self.chosen.choice(SELECTORS)
        marks = self.chosen.choice(["01", "01", "01-"])
        patterns = ["".join(p) for p in itertools.product(marks, repeat=spec_width(selector))]
        cases = []
        for _ in range(self.chosen.randint(1, 5)):
            few = self.chosen.choices(patterns, k=self.chosen.choice([1, 1, 1, 2, 3]))
            cases.append(Case(patterns=tuple(few), body=self.body(depth - 1, whole)))
        if self.chosen.random() < 0.4:
            # Nothing after the default counts.
            at = self.chosen.choice([len(cases), len(cases), len(cases) - 1])
            cases.insert(at, Case(patterns=(), body=self.body(depth - 1, whole)))
        return Switch(selector=selector, cases=tuple(cases))

    def body(self, depth: int, whole: bool = False) -> Body:
        if whole:
            return (self.assign(True),) if self.chosen.random() < 0.8 else ()
        number = self.chosen.choice([0, 1, 1, 2])
        return tuple(
            self.switch(depth, False)
            if depth and self.chosen.random() < 0.6
            else self.assign(False)
            for _ in range(number)
        )


@pytest.mark.parametrize("start", range(0, 80, 40))
def test_statements_do_what_the_netlist_says(start: int) -> None:
    words: set[str] = set()
    for seed in range(start, start + 40):
        body = flatten((Maker(seed).switch(2, False), *Maker(-seed).body(2)))
        lines = [line.strip() for line in STATEMENTS.body(body)]
        words |= {line.split()[0] for line in lines}
        for state in STATES:
            wanted, seen, left = dict(state), dict(state), list(lines)
            run(body, wanted)
            execute(left, seen)
            assert not left and seen == wanted, (seed, state, lines)
    assert {"if", "elsif", "else", "case", "when", "null;"} <= words


@pytest.mark.parametrize("start", range(0, 120, 60))
def test_conditional_assignments_do_what_the_netlist_says(start: int) -> None:
    found = 0
    for seed in range(start, start + 60):
        maker = Maker(seed)
        body = flatten((maker.assign(True), maker.switch(1, maker.chosen.random() < 0.9)))
        pairs = STATEMENTS.conditional(body)
        if pairs is None:
            continue
        found += 1
        for state in STATES:
            wanted = dict(state)
            run(body, wanted)
            value = next(v for v, c in pairs if c is None or holds(c, state))
            assert read(value, state) == wanted["p"], (seed, state, pairs)
    assert found > 12


def test_what_is_no_conditional_assignment() -> None:
    whole = Assign(target=(Slice("p", 0, 4),), value=(Bits("0101"),))
    other = Assign(target=(Slice("p", 0, 4),), value=(Bits("0001"),))
    low = Assign(target=(Slice("p", 0, 2),), value=(Bits("11"),))
    arm = Switch(selector=(Slice("u", 0, 1),), cases=(Case(patterns=("1",), body=(other,)),))
    part_arm = Switch(selector=(Slice("u", 0, 1),), cases=(Case(patterns=("1",), body=(low,)),))
    assert STATEMENTS.conditional((whole,)) == [('"0101"', None)]
    assert STATEMENTS.conditional((whole, arm)) == [('"0001"', "u = '1'"), ('"0101"', None)]
    for body in ((low,), (arm,), (whole, low), (whole, arm, arm), (whole, part_arm)):
        assert STATEMENTS.conditional(body) is None


@pytest.mark.parametrize(
    ("old", "new"), [('"1001"', '"1011"'), ('t = "01"', 't = "11"'), ("p(3) ", "p(1) ")]
)
def test_a_changed_text_is_noticed(old: str, new: str) -> None:
    one, two = (
        Assign(target=(Slice("p", low, len(text)),), value=(Bits(text),))
        for low, text in ((3, "0"), (0, "1001"))
    )
    inner = Switch(selector=(Slice("u", 0, 1),), cases=(Case(patterns=("1",), body=(two,)),))
    body = (
        Switch(selector=(Slice("t", 0, 2),), cases=(Case(patterns=("01",), body=(one, inner)),)),
    )
    text = "\n".join(STATEMENTS.body(body))
    assert old in text
    changed = [line.strip() for line in text.replace(old, new).splitlines()]
    results = []
    for state in STATES:
        wanted, seen = dict(state), dict(state)
        run(body, wanted)
        execute(list(changed), seen)
        results.append(seen != wanted)
    assert any(results)
