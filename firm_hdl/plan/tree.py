"""The plan: all decisions about a converter, as a tree of steps, runs and loops.

A :class:`Step` is one cycle's work: the rest of a run, then padding, then bytes whose map to leaves
is static. A :class:`Run` takes items, one bus word per cycle. A :class:`Loop` repeats its body. One
plan serves both directions: a deserializer takes the bytes of a step from the packet and writes
leaves, a serializer reads leaves and appends the bytes.

The count of a run or loop is a constant, or a length of the message. The length is complete at the
end of the step before the run or loop.

Only the last bus word of a run that a length counts may be short. This word is the *rest*. The step
after the run takes the rest together with its own bytes, so that the rest costs no cycle. A run of
at most one word is only a rest. A string of 20 characters on a bus of 8 bytes, and a field after
it::

    step   | length | word   | word    | field
    items  |        | 0 .. 7 | 8 .. 15 | 16 .. 19 and the NUL: the rest

Steps and runs are numbered from 0 in the order of the tree, which is that of the wire.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal, TypeAlias

from firm_hdl.model import PRIMITIVE_OF, Primitive, Wire
from firm_hdl.wire import RULES

__all__ = [
    "DIRECTIONS",
    "Charge",
    "Constant",
    "Count",
    "Direction",
    "Fixed",
    "Item",
    "Leaf",
    "LeafKind",
    "Length",
    "Loop",
    "Pad",
    "Part",
    "Plan",
    "Run",
    "Slice",
    "Step",
    "numbered",
    "size_of",
    "walk",
]

Direction: TypeAlias = Literal["deserializer", "serializer"]
DIRECTIONS: tuple[Direction, ...] = ("deserializer", "serializer")
"""The two converters of a plan."""

LeafKind: TypeAlias = Literal["scalar", "length", "items", "trigger"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Leaf:
    """One stream of the message side.

    Attributes
    ----------
    path : tuple of str
        Names of fields from the message down. Unless `kind` is "scalar", the last name is `kind`.
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
        """The primitive that `type` names; for `byte` and `char`, the one with the leaf's sign."""
        # Only a wrong plan has the other sign, and `check` reports it.
        found = PRIMITIVE_OF.get((self.type, self.signed))
        return found or PRIMITIVE_OF[self.type, not self.signed]

    @property
    def item_bytes(self) -> int:
        """Bytes of one item on the wire."""
        return 0 if self.kind == "trigger" else self.primitive.bytes


# Slices: the static map of a step, each byte once.


@dataclass(frozen=True, slots=True, kw_only=True)
class Pad:
    """Alignment bytes: zero when written, ignored when read."""

    bytes: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Fixed:
    """Bytes that are the same in every packet: compared when read (`check`) or ignored."""

    data: bytes
    check: bool

    @property
    def bytes(self) -> int:
        """Size in bytes."""
        return len(self.data)


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """Bytes of one transfer of a leaf; the transfer is complete with its last byte.

    An array of one or two transfers consists of parts. A longer array is a run of full words; a
    part with the tail follows, if the items do not fill all words. Items that are wider than the
    bus are a loop.

    Attributes
    ----------
    bytes : int
        Size of the part; 0 for a trigger.
    leaf : int
        Index into `Plan.leaves`.
    first : int
        Index of the part's first byte in the transfer.
    size : int
        Bytes of the whole transfer.
    last : "always", "in loop" or None
        For items, whether this transfer is the last one of its leaf: always, in the last element of
        the innermost loop, or never.
    """

    bytes: int
    leaf: int
    first: int
    size: int
    last: Literal["always", "in loop"] | None = None

    @property
    def completes(self) -> bool:
        """Whether the part holds the last byte of its transfer."""
        return self.first + self.bytes == self.size


Slice: TypeAlias = Pad | Fixed | Part


def size_of(slices: Sequence[Slice]) -> int:
    """Return the bytes of slices in a row."""
    return sum(item.bytes for item in slices)


# Counts.


@dataclass(frozen=True, slots=True, kw_only=True)
class Charge:
    """How much of a packet a length claims: at least so many bytes follow it, if it is true.

    A sequence and the lengths inside its elements share a budget of bytes. A length that claims
    more than is left of the budget is an error, as a length over its limit is. See
    :mod:`firm_hdl.plan.limits`.

    Attributes
    ----------
    bytes : int
        Bytes of the packet that each item or element claims, padding between elements included; an
        element without bytes claims one. The NUL of a string is an item.
    charged_from : int
        Smallest count on the wire, a NUL included, that is charged.
    padding_credit : int
        Subtracted: added items can shorten later padding by up to this many bytes.
    budget : int or None
        The budget in bytes, which the outermost sequence renews. `None`: the length is inside this
        sequence and uses its budget.
    """

    bytes: int
    charged_from: int
    padding_credit: int = 0
    budget: int | None = None


@dataclass(frozen=True, slots=True)
class Constant:
    """The same number of items or elements in every packet."""

    number: int

    nul: ClassVar[bool] = False

    @property
    def most(self) -> int:
        """The count."""
        return self.number


@dataclass(frozen=True, slots=True, kw_only=True)
class Length:
    """A number of items or elements that a length of the message gives.

    Attributes
    ----------
    leaf : int
        Index of the leaf of the length.
    limit : int
        Largest legal value of the leaf: the declared bound, or the count that `max_message_bytes`
        can hold.
    nul : bool
        Whether a NUL follows the items on the wire. The length on the wire counts it, too.
    charge : Charge or None
        What the length claims; `None`: the length is not charged.
    """

    leaf: int
    limit: int
    nul: bool = False
    charge: Charge | None = None

    @property
    def most(self) -> int:
        """The largest legal count on the wire."""
        return self.limit + self.nul


Count: TypeAlias = Constant | Length


# The tree.


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """One cycle's work: the rest of a run, and bytes whose map to leaves is static.

    Attributes
    ----------
    rest : int or None
        Leaf of the items whose rest the step takes first: at most one bus word of items, and the
        NUL. There is no rest if the step was reached without the run, or the run was empty.
    align : int
        The map starts at a multiple of this many bytes, counted from the end of the encapsulation
        header. Padding before the map is skipped. 1 if this padding is statically known.
    slices : tuple of Slice
        The static map, in wire order.
    """

    rest: int | None = None
    align: int = 1
    slices: tuple[Slice, ...] = ()

    steps: ClassVar[int] = 1

    @property
    def bytes(self) -> int:
        """Bytes of the static map."""
        return size_of(self.slices)

    @property
    def parts(self) -> tuple[Part, ...]:
        """The slices that belong to leaves."""
        return tuple(item for item in self.slices if isinstance(item, Part))

    @property
    def places(self) -> Iterator[tuple[int, Slice]]:
        """Each slice with its offset in the map."""
        at = 0
        for item in self.slices:
            yield at, item
            at += item.bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """Items in a row, one bus word per cycle.

    Attributes
    ----------
    leaf : int
        Index of the leaf of the items.
    count : Count
        If constant, all words are full.
    align : int
        The first item starts at a multiple of this many bytes, counted from the end of the
        encapsulation header. An empty run has no padding.
    has_tail : bool
        Whether the step after the run has more items of the same array.
    """

    leaf: int
    count: Count
    align: int = 1
    has_tail: bool = False

    steps: ClassVar[int] = 1

    @property
    def counted(self) -> bool:
        """Whether a length counts the items."""
        return isinstance(self.count, Length)


@dataclass(frozen=True, kw_only=True)
class Loop:
    """Elements in a row.

    Attributes
    ----------
    count : Count
    body : tuple of Item
        An element.
    """

    count: Count
    body: tuple[Item, ...]

    @cached_property
    def steps(self) -> int:
        """Number of steps and runs in the body."""
        return sum(item.steps for item in self.body)


Item: TypeAlias = Step | Run | Loop


def numbered(items: Sequence[Item], first: int) -> Iterator[tuple[int, Item]]:
    """Yield items with the number of their first step or run; `first` is that of the first item."""
    for item in items:
        yield first, item
        first += item.steps


def walk(items: Sequence[Item]) -> Iterator[Item]:
    """Yield all items and, after each loop, those in its body."""
    for item in items:
        yield item
        if isinstance(item, Loop):
            yield from walk(item.body)


@dataclass(frozen=True, kw_only=True)
class Plan:
    """A converter of one message type, for one wire and one bus width.

    Attributes
    ----------
    message : str
        Full name of the type.
    wire : Wire
    bus_bytes : int
        1, 2, 4, 8, 16, 32 or 64.
    max_message_bytes : int
        Size of the longest packet that lengths may promise, header included.
    leaves : tuple of Leaf
        In wire order.
    items : tuple of Item
    """

    message: str
    wire: Wire
    bus_bytes: int
    max_message_bytes: int
    leaves: tuple[Leaf, ...]
    items: tuple[Item, ...]

    @property
    def header_bytes(self) -> int:
        """Bytes of the encapsulation header; alignment counts from its end."""
        return RULES[self.wire].header_bytes

    @property
    def max_trailing_bytes(self) -> int:
        """Largest number of bytes that may follow the message in its packet."""
        return RULES[self.wire].max_trailing_bytes

    @cached_property
    def lengths(self) -> dict[int, Length]:
        """What each length counts, by the index of its leaf."""
        return {
            item.count.leaf: item.count
            for item in walk(self.items)
            if not isinstance(item, Step) and isinstance(item.count, Length)
        }

    @cached_property
    def levels(self) -> int:
        """The most loops that are open at once."""
        return _levels(self.items)

    def word_count(self, run: Run) -> int:
        """Return the largest count that fits in one word of a run, its NUL included."""
        # The NUL needs no lane: a deserializer only compares it, and a serializer writes it as a
        # byte of padding.
        return self.leaves[run.leaf].lanes + run.count.nul

    @cached_property
    def steps(self) -> tuple[Step | Run, ...]:
        """All steps and runs, in wire order."""
        return tuple(item for item in walk(self.items) if not isinstance(item, Loop))

    @cached_property
    def begins(self) -> dict[int, Run | Loop]:
        """What the length in a step counts, by the number of the step."""
        return dict(_begins(self.items, 0))

    @cached_property
    def run_of(self) -> dict[int, Run]:
        """The runs, by their leaves."""
        return {step.leaf: step for step in self.steps if isinstance(step, Run)}

    @property
    def has_claims(self) -> bool:
        """Whether lengths share a budget."""
        return any(length.charge is not None for length in self.lengths.values())

    @property
    def max_run_lanes(self) -> int:
        """Lanes of the widest run; 1 without runs."""
        return max((self.leaves[leaf].lanes for leaf in self.run_of), default=1)


def _begins(items: Sequence[Item], first: int) -> Iterator[tuple[int, Run | Loop]]:
    for index, item in numbered(items, first):
        if isinstance(item, Run | Loop) and isinstance(item.count, Length):
            yield index - 1, item
        if isinstance(item, Loop):
            yield from _begins(item.body, index)


def _levels(items: Sequence[Item]) -> int:
    return max((1 + _levels(i.body) for i in items if isinstance(i, Loop)), default=0)
