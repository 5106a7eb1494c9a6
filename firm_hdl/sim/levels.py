"""Combinational logic divided by depth, so that a simulation evaluates less of it.

Amaranth's simulator has one process for the combinational logic of a module. The whole process runs
again when an input changes, or a signal that the process itself drives. So a module with a chain of
n signals is evaluated n times in a cycle. This module makes many processes, each for a few signals
of one depth. Then a change runs only the processes that depend on it. The values do not change.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from amaranth.hdl import Elaboratable, Fragment, Signal
from amaranth.hdl._ast import Assign, Statement, Switch
from amaranth.hdl._mem import MemoryInstance

__all__ = ["divide", "divided"]

# Signals per process. With fewer signals, less is evaluated without need, but there are more
# processes to generate.
PART = 12


def divided(design: Elaboratable) -> Fragment:
    """Elaborate a design, and divide the combinational logic of each module by its depth."""
    fragment = Fragment.get(design, None)
    divide(fragment)
    return fragment


def divide(fragment: Fragment) -> None:
    """Divide the combinational logic of an elaborated design."""
    for child, *_ in fragment.subfragments:
        divide(child)
    statements = fragment.statements.get("comb")
    if not statements or isinstance(fragment, MemoryInstance):
        return
    levels = _Levels(statements).found()
    if len(levels) == 1:
        return
    del fragment.statements["comb"]
    place = {id(signal): number for number, signals in enumerate(levels) for signal in signals}
    for _, own in sorted(_by_part(statements, place).items()):
        part = Fragment()
        part.add_statements("comb", *own)
        fragment.add_subfragment(part)


def _by_part(
    statements: Iterable[Statement], place: Mapping[int, int]
) -> dict[int, list[Statement]]:
    """Return the statements of each part: those that drive its signals, or what does so in them.

    * `place`: number of the part of each signal, by the `id` of the signal.
    """
    parts: dict[int, list[Statement]] = {}
    for statement in statements:
        if isinstance(statement, Switch):
            bodies = [_by_part(body, place) for _, body, _ in statement.cases]
            for number in sorted(set().union(*bodies)):
                cases = [
                    (patterns, body.get(number, []), where)
                    for (patterns, _, where), body in zip(statement.cases, bodies, strict=True)
                ]
                split = Switch(statement.test, cases, src_loc=statement.src_loc)
                parts.setdefault(number, []).append(split)
        else:
            # All signals of a statement are in one part. A slice of no bits drives none.
            for signal in statement._lhs_signals():
                parts.setdefault(place[id(signal)], []).append(statement)
                break
    return parts


class _Levels:
    """The signals that statements drive, and the depth of each.

    The depth of a signal is the number of driven signals on the longest path to it. Signals of one
    statement are in one group, and so are those of statements that share a signal. Loops exist only
    inside a group. Signals stand for themselves by their `id`: Amaranth's sets are slower.
    """

    def __init__(self, statements: Iterable[Statement]):
        self.signals: dict[int, Signal] = {}
        # Signals that one statement drives stay together.
        self.groups: dict[int, dict[int, None]] = {}
        self.reads: dict[int, set[int]] = {}
        self.depths: dict[int, int] = {}
        self._add(statements, set())

    def _add(self, statements: Iterable[Statement], tests: set[int]) -> None:
        for statement in statements:
            if isinstance(statement, Switch):
                inner = tests.union(map(id, statement.test._rhs_signals()))
                for _, body, _ in statement.cases:
                    self._add(body, inner)
                continue
            assert isinstance(statement, Assign)
            driven = {id(signal): signal for signal in statement._lhs_signals()}
            self.signals |= driven
            reads = tests.union(map(id, statement._rhs_signals()))
            group = dict.fromkeys(driven)
            for signal in driven:
                group |= self.groups.get(signal, {})
                self.reads.setdefault(signal, set()).update(reads)
            for signal in group:
                self.groups[signal] = group

    def found(self) -> list[list[Signal]]:
        """Return lists of about PART signals of one depth, in the order of depths."""
        levels: dict[int, list[list[Signal]]] = {}
        placed: set[int] = set()
        for signal, group in self.groups.items():
            if signal in placed:
                continue
            placed.update(group)
            parts = levels.setdefault(self._depth(signal), [[]])
            if len(parts[-1]) >= PART:
                parts.append([])
            parts[-1] += [self.signals[each] for each in group]
        return [part for depth in sorted(levels) for part in levels[depth]]

    def _depth(self, start: int) -> int:
        stack, entered = [start], set[int]()
        while stack:
            signal = stack[-1]
            if signal in self.depths:
                stack.pop()
                continue
            group = self.groups[signal]
            sources = {
                source
                for each in group
                for source in self.reads[each]
                if source in self.groups and source not in group
            }
            missing = [each for each in sources if each not in self.depths and each not in entered]
            entered.update(group)
            if missing:
                stack += missing
                continue
            depth = 1 + max((self.depths.get(each, 0) for each in sources), default=0)
            for each in group:
                self.depths[each] = depth
        return self.depths[start]
