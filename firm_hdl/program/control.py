"""Transitions between states. No other module of the program reads the control flow of the plan."""

from __future__ import annotations

from dataclasses import dataclass

from firm_hdl.plan.ir import RUN_COUNTER, Begin, Jump, RunStep
from firm_hdl.plan.tree import Plan

__all__ = ["Control", "Load", "Transition", "control_of", "start_of"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Load:
    """A counter that a transition loads with a constant.

    Attributes
    ----------
    level : int or None
        The loop whose elements are counted; `None`: the words of a run.
    number : int
        Elements or words.
    """

    level: int | None
    number: int

    def __str__(self) -> str:
        return f"{'words' if self.level is None else f'level {self.level}'} = {self.number}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Transition:
    """The way to a state.

    Attributes
    ----------
    to : int or None
        Number of the state; `None`: the packet ends.
    loads : tuple of Load
        Loops and runs of constant count that start at the state.
    level : int or None
        The transition is taken only if this loop has more than one element left.
    """

    to: int | None
    loads: tuple[Load, ...] = ()
    level: int | None = None

    def __str__(self) -> str:
        words = ["end" if self.to is None else str(self.to)]
        words += [f"({', '.join(map(str, self.loads))})"] if self.loads else []
        words += [f"while level {self.level}"] if self.level is not None else []
        return " ".join(words)


@dataclass(frozen=True, slots=True, kw_only=True)
class Control:
    """The transitions of a state.

    Attributes
    ----------
    body : Transition or None
        Into the body of the run or loop that a length of the state counts, or to the next word of
        the same run. `None`: the state always takes an exit.
    exits : tuple of Transition
        In the order in which they are tried: the innermost loop first. The last one is always
        possible.
    begin : Begin or None
        The run or loop that a length of the state counts.
    """

    body: Transition | None
    exits: tuple[Transition, ...]
    begin: Begin | None


def start_of(plan: Plan) -> Transition:
    """Return the transition to the first state of each packet."""
    return _transition(plan, plan.start)


def control_of(plan: Plan) -> tuple[Control, ...]:
    """Return the transitions of each step."""
    found = []
    for index, step in enumerate(plan.steps):
        body = Transition(to=index) if isinstance(step, RunStep) else None
        if step.begin is not None:
            body = _transition(plan, step.begin.body)
        repeats = [_transition(plan, jump, level) for level, jump in step.exits.repeats]
        exits = (*repeats, _transition(plan, step.exits.default))
        found.append(Control(body=body, exits=exits, begin=step.begin))
    return tuple(found)


def _transition(plan: Plan, jump: Jump, level: int | None = None) -> Transition:
    loads = []
    for counter, count in jump.enter:
        if counter == RUN_COUNTER:
            assert jump.step is not None
            run = plan.steps[jump.step]
            assert isinstance(run, RunStep)
            loads.append(Load(level=None, number=count // plan.items_leaf(run.run).lanes))
        else:
            loads.append(Load(level=int(counter), number=count))
    return Transition(to=jump.step, loads=tuple(loads), level=level)
