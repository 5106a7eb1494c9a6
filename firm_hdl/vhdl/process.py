"""Amaranth's statements as VHDL: `if`, `case`, conditional assignments, clocked processes.

RTLIL's switch takes the first arm that matches, and its patterns may have don't-care bits. If all
patterns are distinct and have no don't-care bits, the switch becomes a `case`. Otherwise it becomes
a chain of conditions; many of these switches were an `If` in Amaranth.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from firm_hdl.rtlil.ir import (
    Assign,
    Case,
    Cell,
    Slice,
    Spec,
    Statement,
    Switch,
    bits_of,
    cut,
    spec_width,
)
from firm_hdl.vhdl.expr import Declared, Values
from firm_hdl.vhdl.text import Expression, atom, chain, infix, literal

__all__ = ["Arm", "Statements", "flatten", "merged"]

# Most choices of a conditional assignment, for readability; fewest of a `case` instead of an `if`.
_MAX_CHOICE_LINE = 130
"""Most characters of an `if` that is written as one assignment."""

_MAX_CHOICES = 6
_MIN_CHOICES = 3


@dataclass(frozen=True, slots=True)
class Arm:
    """One arm of a chain: its condition (`None` for `else`) and its statements."""

    condition: Expression | None
    body: tuple[Statement, ...]


def flatten(body: tuple[Statement, ...]) -> tuple[Statement, ...]:
    """Drop switches without a selector: Amaranth uses them to keep assignments in order."""
    result: list[Statement] = []
    for statement in body:
        if isinstance(statement, Assign):
            if statement.target:
                result.append(statement)
            continue
        cases = tuple(
            Case(patterns=case.patterns, body=flatten(case.body)) for case in statement.cases
        )
        if not statement.selector:
            result.extend(cases[0].body if cases else ())
        elif any(case.body for case in cases):
            result.append(Switch(selector=statement.selector, cases=cases))
    return tuple(result)


def merged(first: tuple[Statement, ...], second: tuple[Statement, ...]) -> tuple[Statement, ...]:
    """Join the statements of two registers; a switch in both is written once.

    Amaranth makes a process for each signal. No statement of a clocked process reads a value that
    another one assigns, so order matters only among the statements of one register.
    """
    result = list(first)
    earliest = 0
    for statement in second:
        index = next(
            (i for i in range(earliest, len(first)) if _same_choice(result[i], statement)), None
        )
        if index is None:
            result.append(statement)
            earliest = len(first)
            continue
        a, b = result[index], statement
        assert isinstance(a, Switch) and isinstance(b, Switch)
        result[index] = _joined(a, b)
        earliest = index + 1
    return tuple(result)


def _joined(a: Switch, b: Switch) -> Switch:
    if [case.patterns for case in a.cases] == [case.patterns for case in b.cases]:
        cases = tuple(
            Case(patterns=x.patterns, body=merged(x.body, y.body))
            for x, y in zip(a.cases, b.cases, strict=True)
        )
        return Switch(selector=a.selector, cases=cases)
    bodies: dict[str, tuple[Statement, ...]] = {}
    for switch in (a, b):
        for case in switch.cases:
            for pattern in case.patterns:
                bodies[pattern] = merged(bodies.get(pattern, ()), case.body)
    return Switch(
        selector=a.selector,
        cases=tuple(Case(patterns=(pattern,), body=body) for pattern, body in bodies.items()),
    )


def _same_choice(a: Statement, b: Statement) -> bool:
    """Return whether two switches on one selector have the same patterns, or are both plain."""
    if not isinstance(a, Switch) or not isinstance(b, Switch) or a.selector != b.selector:
        return False
    if [case.patterns for case in a.cases] == [case.patterns for case in b.cases]:
        return True
    return _is_plain(a) and _is_plain(b)


def _is_plain(switch: Switch) -> bool:
    """Return whether at most one arm can match, and no arm is a default."""
    patterns = [pattern for case in switch.cases for pattern in case.patterns]
    return (
        all(case.patterns for case in switch.cases)
        and not any("-" in pattern for pattern in patterns)
        and len(set(patterns)) == len(patterns)
        and spec_width(switch.selector) > 1
    )


class Statements:
    """Writes statements.

    * `values`: writer of the values that are read.
    * `targets`: signals by the wire that is assigned; for a next state, the register.
    """

    true = "true"
    literal = staticmethod(literal)

    def __init__(self, values: Values, targets: Mapping[str, Declared]) -> None:
        self.values = values
        self.targets = targets

    def body(self, statements: tuple[Statement, ...]) -> Iterator[str]:
        """Yield the lines of statements."""
        for statement in statements:
            if isinstance(statement, Assign):
                yield from self.assign(statement)
            elif (plain := self._plain_cases(statement)) is not None:
                yield from self.case(statement, plain)
            elif line := self._choice_line(statement):
                yield line
            else:
                yield from self.if_(self.arms(statement))

    def _choice_line(self, switch: Switch) -> str:
        """Write an `if` with one assignment to the same signal in both arms as one assignment."""
        bodies = [case.body for case in switch.cases]
        patterns = [case.patterns for case in switch.cases]
        if patterns not in ([("1",), ()], [("0",), ()], [("1",), ("0",)], [("0",), ("1",)]):
            return ""
        if any(len(body) != 1 or not isinstance(body[0], Assign) for body in bodies):
            return ""
        first, second = (body[0] for body in bodies)
        assert isinstance(first, Assign) and isinstance(second, Assign)
        chunk = first.target[0]
        if first.target != second.target or len(first.target) > 1 or not isinstance(chunk, Slice):
            return ""
        values = (first.value, second.value)
        if any(self.chosen(chunk, value) or self.values.folded(value) for value in values):
            return ""
        if all(self.values.constant(value) is not None for value in values):
            return ""
        b, a = values if patterns[0] == ("1",) else reversed(values)
        line = self.choice_of(chunk, switch.selector, b, a)
        return line if len(line) <= _MAX_CHOICE_LINE else ""

    def choice_of(self, target: Slice, select: Spec, b: Spec, a: Spec) -> str:
        """Write the assignment of one of two values."""
        declared = self.targets[target.wire]
        value = declared.accept(self.values.cells.choice(select, b, a), target.width)
        return f"{declared.part(target.low, target.width)} <= {value};"

    def assign(self, statement: Assign) -> Iterator[str]:
        """Yield an assignment, one line for each chunk of its target."""
        position = 0
        for chunk in statement.target:
            assert isinstance(chunk, Slice)
            part = cut(statement.value, position, chunk.width)
            target = self.targets[chunk.wire]
            cell = self.values.folded(part)
            if cell is not None and cell.kind == "$mux":
                yield from self.choose(chunk, cell)
                position += chunk.width
                continue
            value = self.chosen(chunk, part) or self.value(part, whole=chunk.width == target.width)
            yield f"{target.part(chunk.low, chunk.width)} <= {target.accept(value, chunk.width)};"
            position += chunk.width

    def choose(self, chunk: Slice, cell: Cell) -> Iterator[str]:
        """Yield the assignment of a multiplexer as an `if`, which is easier to read."""
        yield f"if {self.values.boolean(cell.ports['S']).text} then"
        for port, end in (("B", "else"), ("A", "end if;")):
            value = cut(cell.ports[port], 0, chunk.width)
            lines = self.assign(Assign(target=(chunk,), value=value))
            yield from (f"  {line}" for line in lines)
            yield end

    def chosen(self, target: Slice, spec: Spec) -> Expression | None:
        """Return the constant of an enumeration that is assigned to a signal, else `None`."""
        bits = bits_of(spec)
        name = self.values.choice((target,), bits) if bits is not None else ""
        return Expression(name, "literal") if name else None

    def choice(self, spec: Spec, bits: str) -> str:
        """Write a constant to which a value is compared."""
        return self.values.choice(spec, bits) or self.literal(bits)

    def value(self, spec: Spec, *, whole: bool = True) -> Expression:
        """Write the value of an assignment. `whole`: the target is a whole signal."""
        if spec_width(spec) == 1:
            return self.values.logic(spec)
        constant = self.values.constant(spec)
        if whole and constant == 0:
            return Expression("(others => '0')", "literal")
        return self.values.unsigned(spec, target=True)

    def arms(self, switch: Switch) -> list[Arm]:
        """Turn a switch into a chain of conditions."""
        chain_: list[Arm] = []
        seen: set[str] = set()
        for case in switch.cases:
            patterns = [p for p in dict.fromkeys(case.patterns) if p not in seen]
            seen.update(patterns)
            if case.patterns and not patterns:
                continue
            total = not patterns or any(not p.strip("-") for p in patterns)
            last_bit = len(seen) == 2 and seen == {"0", "1"}
            if total or last_bit:
                chain_.append(Arm(None, case.body))
                break
            tests = [self._test(switch.selector, pattern) for pattern in patterns]
            if chain_ and chain_[-1].body == case.body and chain_[-1].condition is not None:
                tests.insert(0, chain_.pop().condition or tests[0])
                tests = list(dict.fromkeys(tests))
            chain_.append(Arm(self.any_of(*tests), case.body))
        while chain_ and not chain_[-1].body:
            chain_.pop()
        if len(chain_) == 1 and chain_[0].condition is not None:
            return [self._nested(chain_[0])]
        if len(chain_) == 2 and not chain_[0].body and chain_[1].condition is None:
            return self._inverted(switch, chain_[1].body) or chain_
        return chain_

    def _nested(self, arm: Arm) -> Arm:
        """Join the conditions of an `if` and of another `if` that is its only statement."""
        if len(arm.body) != 1 or not isinstance(arm.body[0], Switch) or arm.condition is None:
            return arm
        inner = arm.body[0]
        if self._plain_cases(inner) is not None:
            return arm
        chain_ = self.arms(inner)
        if len(chain_) != 1 or chain_[0].condition is None:
            return arm
        return Arm(self.all_of(arm.condition, chain_[0].condition), chain_[0].body)

    def _inverted(self, switch: Switch, body: tuple[Statement, ...]) -> list[Arm] | None:
        """Write an empty `if` with an `else` as an `if` with the inverted condition."""
        if spec_width(switch.selector) != 1:
            return None
        opposite = "1" if switch.cases[0].patterns[0] == "0" else "0"
        return [Arm(self._test(switch.selector, opposite), body)]

    def _test(self, selector: Spec, pattern: str) -> Expression:
        tests: list[Expression] = []
        position = len(pattern)
        for chunk in selector:
            part = pattern[position - chunk.width : position]
            position -= chunk.width
            for low, bits in reversed(_tested_runs(part)):
                tests.append(self.equal(cut((chunk,), low, len(bits)), bits))
        return self.all_of(*tests) if tests else atom(self.true)

    def all_of(self, *tests: Expression) -> Expression:
        """Join conditions by `and`."""
        return chain("and", *tests)

    def any_of(self, *tests: Expression) -> Expression:
        """Join conditions by `or`."""
        return chain("or", *tests)

    def equal(self, spec: Spec, bits: str) -> Expression:
        """Write the test that a value has these bits."""
        constant = self.values.constant(spec)
        if constant is not None:
            return atom("true" if constant == int(bits, 2) else "false")
        if len(bits) > 1:
            return infix("=", self.values.unsigned(spec), atom(self.choice(spec, bits)))
        cell = self.values.folded(spec)
        if cell is not None:
            return self.values.cells.boolean(cell, inverted=bits == "0")
        if bits == "1":
            return self.values.boolean(spec)
        return infix("=", self.values.logic(spec), atom("'0'"))

    def _plain_cases(self, switch: Switch) -> list[tuple[list[str], Case]] | None:
        """Return the choices of an equivalent `case` statement, or `None` if none exists."""
        if not self.values.is_name(switch.selector) or spec_width(switch.selector) < 2:
            return None
        seen: set[str] = set()
        plain: list[tuple[list[str], Case]] = []
        default: Case | None = None
        for case in switch.cases:
            if any("-" in pattern for pattern in case.patterns):
                return None
            if not case.patterns:
                default = case
                break
            new = [p for p in dict.fromkeys(case.patterns) if p not in seen]
            seen.update(new)
            same = next((old for old, other in plain if other.body == case.body), None)
            if same is not None:
                same.extend(new)
            elif new:
                plain.append((new, case))
        otherwise = default.body if default is not None else ()
        # The order of distinct choices does not matter, so choices equal to `others` are left out.
        plain = [(new, case) for new, case in plain if case.body != otherwise]
        if len(plain) < 2 and sum(len(new) for new, _ in plain) < _MIN_CHOICES:
            return None
        return [*plain, ([], Case(patterns=(), body=otherwise))]

    def case(self, switch: Switch, plain: list[tuple[list[str], Case]]) -> Iterator[str]:
        """Yield a choice by the value of a signal."""
        selector = self.values.unsigned(switch.selector).text
        yield f"case {selector} is"
        for patterns, case in plain:
            choices = " | ".join(self.choice(switch.selector, p) for p in sorted(patterns))
            yield f"  when {choices or 'others'} =>"
            yield from (f"    {line}" for line in self.body(case.body))
            if not case.body:
                yield "    null;"
        yield "end case;"

    def if_(self, chain_: list[Arm]) -> Iterator[str]:
        """Yield a chain of conditions."""
        if chain_ and chain_[0].condition is None:
            yield from self.body(chain_[0].body)
            return
        keyword = "if"
        for arm in chain_:
            yield f"{keyword} {arm.condition.text} then" if arm.condition else "else"
            yield from (f"  {line}" for line in self.body(arm.body))
            if not arm.body:
                yield "  null;"
            keyword = "elsif"
        if chain_:
            yield "end if;"

    def conditional(self, body: tuple[Statement, ...]) -> list[tuple[str, str | None]] | None:
        """Return (value, condition) pairs of a conditional assignment equivalent to a process.

        `None` if none exists: the body must be a default for the whole signal and at most one
        switch, whose arms assign the whole signal once.
        """
        first = body[0]
        if not isinstance(first, Assign) or len(body) > 2 or not self._is_whole(first):
            return None
        default = self.accepted(first)
        if len(body) == 1:
            return [(default, None)]
        switch = body[1]
        if not isinstance(switch, Switch) or self._plain_cases(switch) is not None:
            return None
        pairs: list[tuple[str, str | None]] = []
        for arm in self.arms(switch):
            if len(arm.body) > 1 or (arm.body and not self._is_whole(arm.body[0])):
                return None
            inner = arm.body[0] if arm.body else first
            assert isinstance(inner, Assign)
            value = self.accepted(inner)
            pairs.append((value, arm.condition.text if arm.condition else None))
        if not pairs or pairs[-1][1] is not None:
            pairs.append((default, None))
        while len(pairs) > 1 and pairs[-2][0] == pairs[-1][0]:
            del pairs[-2]
        return pairs if len(pairs) <= _MAX_CHOICES else None

    def accepted(self, statement: Assign) -> str:
        """Write the value of an assignment to a whole signal."""
        (chunk,) = statement.target
        assert isinstance(chunk, Slice)
        value = self.chosen(chunk, statement.value) or self.value(statement.value)
        return self.targets[chunk.wire].accept(value, chunk.width)

    def _is_whole(self, statement: Statement) -> bool:
        if not isinstance(statement, Assign) or len(statement.target) != 1:
            return False
        (chunk,) = statement.target
        return isinstance(chunk, Slice) and chunk.width == self.targets[chunk.wire].width


def _tested_runs(pattern: str) -> list[tuple[int, str]]:
    """Split a pattern into runs without don't-care bits, each with the index of its lowest bit."""
    runs: list[tuple[int, str]] = []
    start = None
    for index, mark in enumerate(f"{pattern}-"):
        if mark != "-" and start is None:
            start = index
        elif mark == "-" and start is not None:
            runs.append((len(pattern) - index, pattern[start:index]))
            start = None
    return runs
