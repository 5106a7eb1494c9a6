"""Steps, the loops and runs that they start, and the jumps that follow them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, TypeAlias

from firm_hdl.plan.ir.leaves import Part, Slice

__all__ = [
    "RUN_COUNTER",
    "Begin",
    "BeginArray",
    "BeginLoop",
    "BeginRun",
    "CountedBegin",
    "Exits",
    "Jump",
    "MapStep",
    "RunStep",
    "Step",
    "Take",
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
    body : Jump
        Taken if the count is above zero.
    """

    length: int
    limit: int
    level: int
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
    gap : int
        Padding bytes in front of the first item; an empty run has none.
    head : int
        Largest number of bytes of the run that this step itself takes; 0: none. They start `gap`
        bytes after the step's own bytes. A run that is no longer ends in this step.
    body : Jump or None
        Taken if the run is longer than the head. `None`: it never is.
    """

    length: int
    limit: int
    run: int
    gap: int = 0
    head: int = 0
    body: Jump | None


@dataclass(frozen=True, slots=True, kw_only=True)
class BeginArray:
    """The start of a run of constant count.

    Attributes
    ----------
    count : int
        Number of items, at least 1.
    run, gap, head, body
        As in `BeginRun`.
    """

    count: int
    run: int
    gap: int = 0
    head: int = 0
    body: Jump | None


Begin: TypeAlias = BeginLoop | BeginRun | BeginArray
"""The loop or run that a step starts."""

CountedBegin: TypeAlias = BeginLoop | BeginRun
"""A loop or run that a length counts."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MapStep:
    """One cycle's work on bytes whose map to leaves is static.

    Attributes
    ----------
    align : int
        The step starts at a multiple of this many bytes, counted from the end of the encapsulation
        header. The step before has skipped the padding. 1 where padding is statically known.
    bytes : int
        Bytes of the static map.
    slices : tuple of Slice
        The static map: each byte once, in wire order.
    begin : Begin or None
        The loop or run that the step starts after its map.
    exits : Exits
        Taken when the step, and a run that it starts, is done.
    """

    align: int = 1
    bytes: int = 0
    slices: tuple[Slice, ...] = ()
    begin: Begin | None = None
    exits: Exits

    @property
    def parts(self) -> tuple[Part, ...]:
        """The slices that belong to leaves."""
        return tuple(item for item in self.slices if isinstance(item, Part))

    @property
    def gap(self) -> int:
        """Padding bytes between the map and the first item of a run that starts here."""
        return 0 if self.begin is None or isinstance(self.begin, BeginLoop) else self.begin.gap

    @property
    def take(self) -> Take | None:
        """The items that the step may take of a run that it starts."""
        begin = self.begin
        if begin is None or isinstance(begin, BeginLoop) or not begin.head:
            return None
        return Take(run=begin.run, at=self.bytes + begin.gap, head=begin.head)

    @property
    def most_bytes(self) -> int:
        """Largest number of bytes that one cycle of the step can take."""
        take = self.take
        return self.bytes if take is None else take.at + take.head


@dataclass(frozen=True, slots=True, kw_only=True)
class RunStep:
    """The body of a run: repeated, a bus word at a time, until the run is done.

    Attributes
    ----------
    align : int
        As in `MapStep`, in front of the first repetition.
    run : int
        Index into `Plan.runs`.
    head : int
        Largest number of bytes of the run per repetition.
    exits : Exits
        Taken when the run is done.
    """

    align: int = 1
    run: int
    head: int
    exits: Exits

    # A body has no map, and starts no loop or run.
    bytes: ClassVar[int] = 0
    slices: ClassVar[tuple[Slice, ...]] = ()
    parts: ClassVar[tuple[Part, ...]] = ()
    begin: ClassVar[None] = None
    gap: ClassVar[int] = 0

    @property
    def take(self) -> Take:
        """The items that one repetition takes."""
        return Take(run=self.run, at=0, head=self.head)

    @property
    def most_bytes(self) -> int:
        """Largest number of bytes that one cycle of the step can take."""
        return self.head


Step: TypeAlias = MapStep | RunStep


@dataclass(frozen=True, slots=True, kw_only=True)
class Take:
    """Items of a run that one cycle of a step takes.

    Attributes
    ----------
    run : int
        Index into `Plan.runs`.
    at : int
        Offset of the first item in the step.
    head : int
        Largest number of bytes of these items.
    """

    run: int
    at: int
    head: int
