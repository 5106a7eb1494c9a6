"""The bytes of a step that belong to them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

__all__ = ["ArrayEnd", "Fixed", "LoopEnd", "Pad", "Part", "Run", "Slice"]


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
class ArrayEnd:
    """The mark of a transfer that is always the last one of its array."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopEnd:
    """The mark of a transfer that is the last one if the loop counter `level` is 1."""

    level: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """Bytes of one transfer of a leaf; the transfer is complete with its last byte.

    Attributes
    ----------
    at : int
        Offset of the part in its step.
    bytes : int
        Size of the part; 0 for a trigger.
    leaf : int
        Index into `Plan.leaves`.
    first : int
        Index of the part's first byte in the transfer.
    size : int
        Bytes of the whole transfer.
    end : ArrayEnd, LoopEnd or None
        For items: when this transfer is the last one of its leaf; `None` for never.

    An array of one or two transfers consists of parts, the last of which has an `ArrayEnd`. A
    longer array is a run of full words; a part with the tail follows, if the items do not fill all
    words. Items that are wider than the bus are a loop, whose parts have a `LoopEnd`.
    """

    at: int
    bytes: int
    leaf: int
    first: int
    size: int
    end: ArrayEnd | LoopEnd | None = None

    @property
    def completes(self) -> bool:
        """Whether the part holds the last byte of its transfer."""
        return self.first + self.bytes == self.size


Slice: TypeAlias = "Pad | Fixed | Part"


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """Items in a row, one bus word per transfer.

    Attributes
    ----------
    items : int
        Index of the leaf.
    counted : bool
        Whether a length counts the items. Then the last word, which may be short, is the rest that
        the step after the run takes. Otherwise the count is constant, and all words are full.
    terminated : bool
        Whether a NUL follows the items on the wire. The length on the wire counts the NUL, too.
    last : bool
        Whether the last transfer of the run is the last one of its leaf. False if a part with the
        tail of a fixed array follows.
    """

    items: int
    counted: bool = True
    terminated: bool = False
    last: bool = True
