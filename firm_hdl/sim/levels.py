"""Combinational logic divided by depth, so that a simulation evaluates less of it.

Amaranth's simulator has one process for the combinational logic of a module. The whole process runs
again when an input changes, or a signal that the process itself drives. So a module with a chain of
n signals is evaluated n times in a cycle. This module makes many processes, each for a few signals
of one depth. Then a change runs only the processes that depend on it. The values do not change.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from amaranth.hdl import Elaboratable, Fragment, Signal
from amaranth.hdl._ast import Assign, SignalDict, SignalSet, Statement, Switch
from amaranth.hdl._mem import MemoryInstance

__all__ = ["divided"]

# Signals per process. With fewer signals, less is evaluated without need, but there are more
# processes to generate.
PART = 12


def divided(design: Elaboratable) -> Fragment:
    """Elaborate a design, and divide the combinational logic of each module by its depth."""
    fragment = Fragment.get(design, None)
    _divide(fragment)
    return fragment


def _divide(fragment: Fragment) -> None:
    for child, *_ in fragment.subfragments:
        _divide(child)
    statements = fragment.statements.get("comb")
    if not statements or isinstance(fragment, MemoryInstance):
        return
    levels = _Levels(statements).found()
    if len(levels) == 1:
        return
    del fragment.statements["comb"]
    for signals in levels:
        part = Fragment()
        part.add_statements("comb", *_driving(statements, signals))
        fragment.add_subfragment(part)


def _driving(statements: Iterable[Statement], signals: SignalSet) -> Iterator[Statement]:
    """Yield the statements, or the parts of them, that drive the given signals."""
    for statement in statements:
        if isinstance(statement, Switch):
            cases = [
                (patterns, list(_driving(body, signals)), where)
                for patterns, body, where in statement.cases
            ]
            if any(body for _, body, _ in cases):
                yield Switch(statement.test, cases, src_loc=statement.src_loc)
        elif any(signal in signals for signal in statement._lhs_signals()):
            yield statement


class _Levels:
    """The signals that statements drive, and the depth of each.

    The depth of a signal is the number of driven signals on the longest path to it. Signals of one
    statement are in one group, and so are those of statements that share a signal. Loops exist only
    inside a group.
    """

    def __init__(self, statements: Iterable[Statement]):
        # Signals that one statement drives stay together.
        self.groups: SignalDict = SignalDict()
        self.reads: SignalDict = SignalDict()
        self.depths: SignalDict = SignalDict()
        self._add(statements, SignalSet())

    def _add(self, statements: Iterable[Statement], tests: SignalSet) -> None:
        for statement in statements:
            if isinstance(statement, Switch):
                inner = tests | statement.test._rhs_signals()
                for _, body, _ in statement.cases:
                    self._add(body, inner)
                continue
            assert isinstance(statement, Assign)
            driven = statement._lhs_signals()
            group = driven
            for signal in driven:
                group = group | self.groups.get(signal, SignalSet())
                self.reads.setdefault(signal, SignalSet())
                self.reads[signal] |= tests | statement._rhs_signals()
            for signal in group:
                self.groups[signal] = group

    def found(self) -> list[SignalSet]:
        """Return sets of about PART signals of one depth, in the order of depths."""
        levels: dict[int, list[SignalSet]] = {}
        placed = SignalSet()
        for signal, group in self.groups.items():
            if signal in placed:
                continue
            placed |= group
            parts = levels.setdefault(self._depth(signal), [SignalSet()])
            if len(parts[-1]) >= PART:
                parts.append(SignalSet())
            parts[-1] |= group
        return [part for depth in sorted(levels) for part in levels[depth]]

    def _depth(self, start: Signal) -> int:
        stack, entered = [start], SignalSet()
        while stack:
            signal = stack[-1]
            if signal in self.depths:
                stack.pop()
                continue
            group = self.groups[signal]
            sources = [
                source
                for each in group
                for source in self.reads[each]
                if source in self.groups and source not in group
            ]
            missing = [each for each in sources if each not in self.depths and each not in entered]
            for each in group:
                entered.add(each)
            if missing:
                stack += missing
                continue
            depth = 1 + max((self.depths.get(each, 0) for each in sources), default=0)
            for each in group:
                self.depths[each] = depth
        result: int = self.depths[start]
        return result
