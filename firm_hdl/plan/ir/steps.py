"""Steps, the loops and runs that they start, and the jumps that follow them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar, TypeAlias

from firm_hdl.plan.ir.leaves import Part, Slice

__all__ = [
    "RUN_COUNTER",
    "Begin",
    "BeginLoop",
    "BeginRun",
    "Claim",
    "Exits",
    "IntoBody",
    "Jump",
    "LoopAgain",
    "MapStep",
    "Next",
    "RunStep",
    "Step",
    "Way",
    "successors",
]

RUN_COUNTER = "run"
"""Name of the counter of items. Loop counters are called 0, 1, ... (outermost first)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Jump:
    """The transition to the next step.

    Attributes
    ----------
    enter : tuple of (counter, count)
        Counters to load, for loops and runs of constant count that start at the next step.
    step : int or None
        Index of the next step; `None` ends the packet.
    """

    enter: tuple[tuple[int | str, int], ...] = ()
    step: int | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Exits:
    """The jumps that may follow a finished step.

    Attributes
    ----------
    repeats : tuple of (level, Jump)
        Loops that may end here, innermost first. The first loop with more than one element left is
        repeated, and its counter is decremented.
    default : Jump
        Taken when no loop repeats.
    """

    repeats: tuple[tuple[int, Jump], ...] = ()
    default: Jump

    @property
    def jumps(self) -> tuple[Jump, ...]:
        """All jumps, in the order in which they are tried."""
        return (*(jump for _, jump in self.repeats), self.default)


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """How much of a packet a length claims: at least so many bytes follow it, if it is true.

    A sequence and the lengths inside its elements share a budget of bytes. A length that claims
    more than is left of the budget is an error, as a length over its limit is. A length below
    `least` is not counted. See :mod:`firm_hdl.plan.limits`.

    Attributes
    ----------
    bytes : int
        Bytes of the packet that each item or element claims, padding between elements included; an
        element without bytes claims one. The NUL of a string is an item.
    least : int
        Smallest count on the wire, a NUL included, that is counted.
    saved : int
        Subtracted from the claim: items may shorten later padding by up to this many bytes.
    total : int or None
        The budget in bytes, which the outermost sequence renews. `None`: the length is inside this
        sequence and uses its budget.
    """

    bytes: int
    least: int
    saved: int = 0
    total: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class BeginLoop:
    """The start of a loop over elements whose number is a length of the message.

    Attributes
    ----------
    length : int
        Index of the leaf of the length; its last part is in this step.
    limit : int
        Largest legal count: the declared bound, or the count that `max_message_bytes` can hold.
    level : int
        Loop counter to load.
    claim : Claim or None
        What the length claims; `None`: the length is not counted.
    body : Jump
        Taken if the count is above zero.
    """

    length: int
    limit: int
    level: int
    claim: Claim | None = None
    body: Jump


@dataclass(frozen=True, slots=True, kw_only=True)
class BeginRun:
    """The start of a run of items whose number is a length of the message.

    Attributes
    ----------
    length : int
        Index of the leaf of the length; its last part is in this step. On the wire, the length of
        a run with a NUL counts the NUL, too.
    limit : int
        Largest legal count: the declared bound, or the count that `max_message_bytes` can hold.
    run : int
        Index into `Plan.runs`.
    align : int
        The first item starts at a multiple of this many bytes, counted from the end of the
        encapsulation header. An empty run has no padding.
    claim : Claim or None
        What the length claims; `None`: the length is not counted.
    body : Jump
        Taken if the run has more than one word. If `limit` is at most a word, only a serializer
        takes it, because it writes lengths over the limit, too.
    """

    length: int
    limit: int
    run: int
    align: int = 1
    claim: Claim | None = None
    body: Jump


Begin: TypeAlias = BeginLoop | BeginRun
"""The loop or run that a step starts; a length counts it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MapStep:
    """One cycle's work: the rest of a run, and bytes whose map to leaves is static.

    Attributes
    ----------
    rest : int or None
        Run whose rest the step takes first: at most one bus word of items, and the NUL. If the
        step was reached without starting the run, there is no rest.
    align : int
        The map starts at a multiple of this many bytes, counted from the end of the encapsulation
        header. Padding before the map is skipped. 1 if this padding is statically known.
    bytes : int
        Bytes of the static map.
    slices : tuple of Slice
        The static map: each byte once, in wire order.
    begin : Begin or None
        The loop or run that the step starts after its map.
    exits : Exits
        Taken when the step, and the words of a run that it starts, are done.
    """

    rest: int | None = None
    align: int = 1
    bytes: int = 0
    slices: tuple[Slice, ...] = ()
    begin: Begin | None = None
    exits: Exits

    @property
    def parts(self) -> tuple[Part, ...]:
        """The slices that belong to leaves."""
        return tuple(item for item in self.slices if isinstance(item, Part))


@dataclass(frozen=True, slots=True, kw_only=True)
class RunStep:
    """The body of a run: one bus word of items per cycle.

    The step is repeated while more than one word is left, or while any item is left if the run has
    a constant count.

    Attributes
    ----------
    align : int
        As in `MapStep`, before the first word.
    run : int
        Index into `Plan.runs`.
    exits : Exits
        Taken when the words are done. The next step takes the rest.
    """

    align: int = 1
    run: int
    exits: Exits

    # A body has no map, and starts no loop or run.
    rest: ClassVar[None] = None
    bytes: ClassVar[int] = 0
    slices: ClassVar[tuple[Slice, ...]] = ()
    parts: ClassVar[tuple[Part, ...]] = ()
    begin: ClassVar[None] = None


Step: TypeAlias = MapStep | RunStep


@dataclass(frozen=True, slots=True, kw_only=True)
class IntoBody:
    """The way into the body of the loop or run that a step starts.

    It is taken unless the count allows to skip the body: a loop without elements, or a run of at
    most one word. Then the step takes one of its exits.
    """

    begin: Begin


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopAgain:
    """The way to the first step of a loop that has more than one element left."""

    level: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Next:
    """The way that is taken when no loop repeats: to the following step, or to the end."""


Way: TypeAlias = IntoBody | LoopAgain | Next


def successors(step: Step) -> Iterator[tuple[Way, Jump]]:
    """Yield the jumps that may follow a step, with what selects each, in the order of selection.

    The repetition of a run's body for each word is not a jump, and not among them.
    """
    if step.begin is not None:
        yield IntoBody(begin=step.begin), step.begin.body
    for level, jump in step.exits.repeats:
        yield LoopAgain(level=level), jump
    yield Next(), step.exits.default
