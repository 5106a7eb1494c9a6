"""Link steps: where the control flow of a plan goes from each step.

:mod:`firm_hdl.plan.build` makes a program: steps in wire order, and marks between them where loops
start and end, and where counters of constant counts are loaded. Marks take no cycle. So they become
parts of the jumps between steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

from firm_hdl.plan.ir import BeginLoop, Exits, Jump, Step

__all__ = ["END", "NOWHERE", "BodyEnd", "BodyStart", "Load", "Mark", "link"]

END = Jump(step=None)
"""The jump to the end of the packet; also in place of a jump that is not linked yet."""

NOWHERE = Exits(default=END)
"""The exits of a step that is not linked yet."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Load:
    """A position where a loop or run of constant count starts: its counter is loaded.

    Attributes
    ----------
    counter : int or RUN_COUNTER
        The level of a loop, or the counter of the items of a run.
    count : int
        Elements or items.
    """

    counter: int | str
    count: int


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyStart:
    """A position where the body of a loop starts."""

    level: int


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyEnd:
    """A position where the body of a loop ends."""

    level: int


Mark: TypeAlias = Load | BodyStart | BodyEnd
"""A position between steps."""


def link(program: Sequence[Step | Mark]) -> tuple[Jump, tuple[Step, ...]]:
    """Return the jump to the first step of a program, and its steps with bodies and exits."""
    linker = _Linker(program)
    return linker.jump_to(0), linker.steps()


class _Linker:
    """A program, with the places of its steps and loops."""

    def __init__(self, program: Sequence[Step | Mark]):
        self.program = program
        places = [place for place, item in enumerate(program) if not isinstance(item, Mark)]
        # Index of the step at each place of the program that is a step.
        self.numbers = {place: index for index, place in enumerate(places)}
        # The start of each loop's body by the loop's end, and the end by the loop's start.
        self.bodies: dict[int, int] = {}
        self.ends: dict[int, int] = {}
        open_loops: list[int] = []
        for place, item in enumerate(program):
            if isinstance(item, BodyStart):
                open_loops.append(place)
            elif isinstance(item, BodyEnd):
                start = open_loops.pop()
                self.bodies[place] = start + 1
                self.ends[start] = place

    def jump_to(self, place: int) -> Jump:
        """Return the jump to the next step from a place of the program where no loop ends."""
        enter: list[tuple[int | str, int]] = []
        while place < len(self.program):
            item = self.program[place]
            if not isinstance(item, Mark):
                break
            assert not isinstance(item, BodyEnd)
            if isinstance(item, Load):
                enter.append((item.counter, item.count))
            place += 1
        return Jump(enter=tuple(enter), step=self.numbers.get(place))

    def exits_at(self, place: int) -> Exits:
        """Return the exits of a step or run that ends before a place of the program."""
        repeats: list[tuple[int, Jump]] = []
        while place < len(self.program):
            item = self.program[place]
            if not isinstance(item, BodyEnd):
                break
            repeats.append((item.level, self.jump_to(self.bodies[place])))
            place += 1
        return Exits(repeats=tuple(repeats), default=self.jump_to(place))

    def steps(self) -> tuple[Step, ...]:
        """Return the steps of the program, linked."""
        found: list[Step] = []
        for place, item in enumerate(self.program):
            if isinstance(item, Mark):
                continue
            after = place + 1
            if item.begin is not None:
                # The body follows: of a loop, the steps up to its end; of a run, one step.
                body = self.jump_to(after)
                item = replace(item, begin=replace(item.begin, body=body))
                after = self.ends[after] + 1 if isinstance(item.begin, BeginLoop) else after + 1
            found.append(replace(item, exits=self.exits_at(after)))
        return tuple(found)
