"""The plan: all decisions about a converter, as a list of steps that hardware transcribes.

A plan is a small program over a window of wire bytes. Each step moves a fixed number of bytes whose
map to leaves is static, and may end in the head of a run of items. One plan serves both directions:
a deserializer takes the bytes of a step from its window and writes leaves, a serializer reads
leaves and appends the bytes.

Control flow. Steps stand in wire order. A step ends in its :class:`Exits`: loop counters are tried
from the innermost outwards, and the first loop that has elements left is repeated; otherwise the
plan goes on at another step or ends the packet. `Step.begin` starts what a length (or a constant)
counts: a loop over elements, or a run of items.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from firm_hdl.model import PRIMITIVE_OF, Primitive

__all__ = [
    "RUN_COUNTER",
    "Begin",
    "Exits",
    "Fixed",
    "Jump",
    "Leaf",
    "LeafKind",
    "Pad",
    "Part",
    "Plan",
    "Run",
    "Slice",
    "Step",
]

RUN_COUNTER = "run"
"""Name of the counter of items, beside the loop counters 0, 1, ... (outermost first)."""


LeafKind: TypeAlias = Literal["scalar", "length", "items", "trigger"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Leaf:
    """One stream of the message side.

    Attributes
    ----------
    path : tuple of str
        ROS names from the message down; the last one is ``length``, ``items`` or ``trigger`` where
        `kind` says so.
    kind : "scalar", "length", "items" or "trigger"
    type : str
        ROS name of the primitive (``uint32`` for a length, ``bool`` for a trigger).
    signed : bool
        Whether the stream's shape is signed.
    lanes : int
        Items per transfer; 1 unless `kind` is "items".
    """

    path: tuple[str, ...]
    kind: LeafKind
    type: str
    signed: bool
    lanes: int = 1

    def __str__(self) -> str:
        return ".".join(self.path)

    @property
    def primitive(self) -> Primitive:
        """The primitive that `type` names; of `byte` and `char`, that with the sign."""
        # Only a plan that is wrong has the other sign, and the check of plans says so.
        found = PRIMITIVE_OF.get((self.type, self.signed))
        return found or PRIMITIVE_OF[self.type, not self.signed]

    @property
    def item_bytes(self) -> int:
        """Bytes of one item on the wire."""
        return 0 if self.kind == "trigger" else self.primitive.bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class Pad:
    """Alignment bytes: zero when written, ignored when read."""

    at: int
    bytes: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Fixed:
    """Bytes that are the same in every packet: compared when read (`check`) or ignored."""

    at: int
    data: bytes
    check: bool

    @property
    def bytes(self) -> int:
        """Size in bytes."""
        return len(self.data)


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """Bytes of one transfer of a leaf; the transfer is done with its last byte.

    Attributes
    ----------
    at : int
        Where the part starts in its step.
    bytes : int
        Size of the part; 0 for a trigger.
    leaf : int
        Index into `Plan.leaves`.
    first : int
        Index of the part's first byte in the transfer.
    size : int
        Bytes of the whole transfer.
    last : bool
        For items: whether this transfer ends its array whatever the counters say.
    last_level : int or None
        For items: the loop counter that says so.
    """

    at: int
    bytes: int
    leaf: int
    first: int
    size: int
    last: bool = False
    last_level: int | None = None

    @property
    def completes(self) -> bool:
        """Whether the part holds the last byte of its transfer."""
        return self.first + self.bytes == self.size


Slice: TypeAlias = "Pad | Fixed | Part"


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """Items in a row, a bus word per transfer. Takes what `Plan.runs` has at its index.

    Attributes
    ----------
    items : int
        Index of the leaf.
    terminated : bool
        Whether a NUL follows on the wire, counted there.
    last : bool
        Whether the last transfer of the run is the last of its leaf (false if a tail of a fixed
        array follows as a part).
    """

    items: int
    terminated: bool = False
    last: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class Jump:
    """Where to go on.

    Attributes
    ----------
    enter : tuple of (counter, count)
        Counters to load on the way, for loops and runs of constant count that start there.
    step : int or None
        Index of the next step; `None` ends the packet.
    """

    enter: tuple[tuple[int | str, int], ...] = ()
    step: int | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Exits:
    """What follows a finished step.

    Attributes
    ----------
    repeats : tuple of (level, Jump)
        Loops that may end here, innermost first. The first with more than one element left counts
        down and is repeated.
    default : Jump
        Taken when no loop repeats.
    """

    repeats: tuple[tuple[int, Jump], ...] = ()
    default: Jump


@dataclass(frozen=True, slots=True, kw_only=True)
class Begin:
    """What a step starts: a loop or a run.

    Attributes
    ----------
    length : int or None
        Index of the leaf that counts; its last part is in this step. `None`: `count` counts.
    count : int or None
        A constant number of items.
    limit : int
        Largest legal count: the declared bound, and what `max_message_bytes` can hold.
    terminated : bool
        Whether the length on the wire counts a NUL that the leaf does not.
    level : int or None
        Loop counter to load; `None` for a run.
    run : int or None
        Index into `Plan.runs`; `None` for a loop.
    gap : int
        Padding bytes in front of the first item, if there is one.
    head : int
        Most bytes of the run that this step takes itself; 0: none. They start `gap` bytes behind
        the step's own. A count that needs no more is done here.
    body : Jump or None
        Where a count above zero (and, for a run, beyond the head) goes on. `None`: never needed.
    """

    length: int | None
    count: int | None
    limit: int
    terminated: bool
    level: int | None
    run: int | None
    gap: int = 0
    head: int = 0
    body: Jump | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """One cycle's work.

    Attributes
    ----------
    align : int
        The step starts at a multiple of this many bytes (behind the encapsulation header); whatever
        led here has skipped the padding. 1 where padding is statically known.
    bytes : int
        Bytes of the static map.
    slices : tuple of Slice
        The static map: each byte once, in wire order.
    begin : Begin or None
    run : int or None
        Not `None`: the step is the body of that run, is repeated until the run is done, and has no
        map.
    head : int
        For a body: most bytes of the run per repetition.
    exits : Exits
        Where to go when the step (and the run that it starts or is) is done.
    """

    align: int = 1
    bytes: int = 0
    slices: tuple[Slice, ...] = ()
    begin: Begin | None = None
    run: int | None = None
    head: int = 0
    exits: Exits

    @property
    def parts(self) -> tuple[Part, ...]:
        """The slices that belong to leaves."""
        return tuple(item for item in self.slices if isinstance(item, Part))

    @property
    def takes_items(self) -> bool:
        """Whether the step may take items of a run."""
        begin = self.begin
        return self.run is not None or (
            begin is not None and begin.run is not None and begin.head > 0
        )

    @property
    def most_bytes(self) -> int:
        """Most bytes that one cycle of the step can take."""
        gap_and_head = (
            0 if self.begin is None or not self.begin.head else self.begin.gap + self.begin.head
        )
        return self.bytes + gap_and_head + (self.head if self.run is not None else 0)


@dataclass(frozen=True, kw_only=True)
class Plan:
    """A converter of one message type, for one wire and one bus width.

    Attributes
    ----------
    message : str
        Full name of the type.
    wire : "ros1" or "cdr"
    bus_bytes : int
        1, 2, 4, 8, 16, 32 or 64.
    max_message_bytes : int
        Longest packet, header included, that lengths may promise.
    header_bytes : int
        Bytes of the encapsulation header; alignment counts from behind it.
    slack_bytes : int
        Most bytes that may follow the message in its packet.
    leaves : tuple of Leaf
        In wire order.
    runs : tuple of Run
    levels : int
        Number of loop counters.
    start : Jump
        Where each packet starts.
    steps : tuple of Step
    """

    message: str
    wire: Literal["ros1", "cdr"]
    bus_bytes: int
    max_message_bytes: int
    header_bytes: int
    slack_bytes: int
    leaves: tuple[Leaf, ...]
    runs: tuple[Run, ...]
    levels: int
    start: Jump
    steps: tuple[Step, ...]
