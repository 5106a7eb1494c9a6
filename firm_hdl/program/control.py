"""Transitions between states. No other module of the program reads the control flow of the plan."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from firm_hdl.plan.tree import Item, Length, Loop, Plan, Run, Step, numbered

__all__ = ["Control", "Load", "Transition", "control_of", "start_of"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Load:
    """A counter that a transition loads with a constant."""

    level: int | None  # The loop whose elements are counted; `None`: the words of a run.
    number: int  # Elements or words.

    def __str__(self) -> str:
        return f"{'words' if self.level is None else f'level {self.level}'} = {self.number}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Transition:
    """The way to a state."""

    to: int | None  # Number of the state; `None`: the packet ends.
    loads: tuple[Load, ...] = ()  # Loops and runs of constant count that start at the state.
    # The transition is taken only if this loop has more than one element left.
    level: int | None = None

    def __str__(self) -> str:
        words = ["end" if self.to is None else str(self.to)]
        words += [f"({', '.join(map(str, self.loads))})"] if self.loads else []
        words += [f"while level {self.level}"] if self.level is not None else []
        return " ".join(words)


@dataclass(frozen=True, slots=True, kw_only=True)
class Control:
    """The transitions of a state."""

    item: Step | Run  # What the state does.
    level: int  # Number of loops around the state.
    # Into the body of the run or loop that a length of the state counts, or to the next word of the
    # same run. `None`: the state always takes an exit.
    body: Transition | None
    # In the order in which they are tried: the innermost loop first. The last one is always
    # possible.
    exits: tuple[Transition, ...]
    begin: Run | Loop | None = None  # What a length of the state counts.


def start_of(plan: Plan) -> Transition:
    """Return the transition to the first state of each packet."""
    return _enter(plan, plan.items, 0, 0)


def control_of(plan: Plan) -> tuple[Control, ...]:
    """Return the transitions of each step and run."""
    return tuple(_block(plan, plan.items, 0, 0, (Transition(to=None),)))


def _block(
    plan: Plan, items: Sequence[Item], first: int, level: int, after: tuple[Transition, ...]
) -> Iterator[Control]:
    """Yield the control of items inside `level` loops; `after` are the exits behind the last."""
    # From the end: what comes after each item decides its exits.
    behind = [after]
    places = [*numbered(items, first)]
    for place in range(len(items) - 1, 0, -1):
        index, item = places[place]
        # The exits of a step before a length's run or loop are those behind the run or loop.
        is_begun = _begun(item) is not None
        behind.append(behind[-1] if is_begun else (_enter(plan, items[place:], index, level),))
    behind.reverse()
    for place, (index, item) in enumerate(places):
        exits = behind[place]
        match item:
            case Step():
                body, begin = None, _begun(*items[place + 1 : place + 2])
                if isinstance(begin, Run):
                    body = Transition(to=index + 1)
                elif begin is not None:
                    body = _enter(plan, begin.body, index + 1, level + 1)
                yield Control(item=item, level=level, body=body, exits=exits, begin=begin)
            case Run():
                yield Control(item=item, level=level, body=Transition(to=index), exits=exits)
            case Loop():
                again = replace(_enter(plan, item.body, index, level + 1), level=level)
                yield from _block(plan, item.body, index, level + 1, (again, *exits))


def _begun(item: Item | None = None) -> Run | Loop | None:
    """Return an item if a length counts it."""
    if isinstance(item, Run | Loop) and isinstance(item.count, Length):
        return item
    return None


def _enter(plan: Plan, items: Sequence[Item], index: int, level: int) -> Transition:
    """Return the transition to the first of items that are inside `level` loops."""
    first, loads = items[0], list[Load]()
    while isinstance(first, Loop):
        loads.append(Load(level=level, number=first.count.most))
        first, level = first.body[0], level + 1
    if isinstance(first, Run):
        loads.append(Load(level=None, number=first.count.most // plan.leaves[first.leaf].lanes))
    return Transition(to=index, loads=tuple(loads))
