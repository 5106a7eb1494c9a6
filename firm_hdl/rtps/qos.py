"""Quality of service: what endpoints offer and ask for, and whether they fit (8.7.2, DDS 2.2.3)."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import TypeVar

from firm_hdl.rtps.wire.octets import Cursor, MalformedError, padded
from firm_hdl.rtps.wire.parameters import ParameterList, Pid, string

__all__ = ["INFINITE", "Durability", "Qos", "Reliability", "duration", "seconds"]

_T = TypeVar("_T")

INFINITE = float("inf")
"""A duration without end, in seconds."""

_INFINITE_BYTES = struct.pack("<iI", 0x7FFF_FFFF, 0xFFFF_FFFF)
# DATA_REPRESENTATION: XCDR version 1, which ROS 2 uses (DDS-XTypes 7.6.3.1.1).
_XCDR1 = 0
_MAX_PARTITIONS = 64


class Reliability(IntEnum):
    """Whether lost samples are sent again. The numbers are those of the wire (9.3.2)."""

    BEST_EFFORT = 1
    RELIABLE = 2


class Durability(IntEnum):
    """Whether a reader that comes late gets old samples. The numbers are those of the wire."""

    VOLATILE = 0
    TRANSIENT_LOCAL = 1
    TRANSIENT = 2
    PERSISTENT = 3


@dataclass(frozen=True, slots=True, kw_only=True)
class Qos:
    """The policies of an endpoint.

    Attributes
    ----------
    deadline, lease : float
        Seconds; of the policies DEADLINE and LIVELINESS. Ours are infinite, as in ROS 2 by default.
    """

    # A reliable reader does not fit a best-effort writer.
    reliability: Reliability = Reliability.RELIABLE
    durability: Durability = Durability.VOLATILE  # Our endpoints are volatile or transient-local.
    # How many samples a writer keeps for readers that miss them (KEEP_LAST), the newest. 0 keeps
    # all that a reliable reader has not acknowledged (KEEP_ALL).
    depth: int = 10
    max_samples: int = 5000  # Limit of what a writer keeps if the depth is 0 (RESOURCE_LIMITS).
    deadline: float = INFINITE
    liveliness: int = 0  # Kind: 0 automatic, 1 manual by participant, 2 manual by topic.
    lease: float = INFINITE
    exclusive: bool = False  # Kind of ownership.
    partitions: tuple[str, ...] = ()  # Names of partitions; none is the partition without a name.
    # Data representations that a reader accepts, or that a writer uses. None is XCDR version 1.
    representations: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        kinds = {"reliability": Reliability, "durability": Durability}
        for name, kind in (*kinds.items(), ("depth", int), ("max_samples", int)):
            value = getattr(self, name)
            if not isinstance(value, kind) or isinstance(value, bool):
                raise TypeError(f"{name} is of type {kind.__name__}, and is {value!r}")
        if self.depth < 0:
            raise ValueError(f"Depth must be at least 0, not {self.depth}")
        if self.max_samples < 1:
            raise ValueError(f"Limit of samples must be at least 1, not {self.max_samples}")

    @property
    def reliable(self) -> bool:
        """Whether lost samples are sent again."""
        return self.reliability is Reliability.RELIABLE

    def refused(self, offered: Qos) -> tuple[str, ...]:
        """Return the policies of `offered`, a writer's, that do not satisfy this reader's.

        By table 2.2.3 of DDS. The names are those that ROS 2 uses in its warnings.
        """
        mine = self.representations or (_XCDR1,)
        theirs = (offered.representations or (_XCDR1,))[0]
        problems = {
            "RELIABILITY": offered.reliability < self.reliability,
            "DURABILITY": offered.durability < self.durability,
            "DEADLINE": offered.deadline > self.deadline,
            "LIVELINESS": offered.liveliness < self.liveliness or offered.lease > self.lease,
            "OWNERSHIP": offered.exclusive != self.exclusive,
            "PARTITION": not set(offered.partitions or ("",)) & set(self.partitions or ("",)),
            "DATA_REPRESENTATION": theirs not in mine,
        }
        return tuple(name for name, wrong in problems.items() if wrong)

    def parameters(self) -> tuple[tuple[int, bytes], ...]:
        """Return the policies of one of our endpoints as parameters of discovery data."""
        # With the time that a writer may block for: 100 ms, the default. No peer acts on it.
        reliability = struct.pack("<IiI", self.reliability, 0, 429496730)
        history = struct.pack("<Ii", self.depth == 0, self.depth or 1)
        partitions = b"".join(padded(string(each)) for each in self.partitions)
        named = struct.pack("<I", len(self.partitions)) + partitions
        return (
            (Pid.RELIABILITY, reliability),
            (Pid.DURABILITY, struct.pack("<I", self.durability)),
            (Pid.HISTORY, history),
            (Pid.DEADLINE, duration(self.deadline)),
            (Pid.LIVELINESS, struct.pack("<I", self.liveliness) + duration(self.lease)),
            (Pid.OWNERSHIP, struct.pack("<I", self.exclusive)),
            *([(Pid.PARTITION, named)] if self.partitions else []),
            (Pid.DATA_REPRESENTATION, struct.pack("<IH2x", 1, _XCDR1)),
        )

    @classmethod
    def decode(cls, parameters: ParameterList, writer: bool) -> Qos:
        """Read the policies of a peer's endpoint.

        A policy that is not there has its default (9.6.2.2.2), which is reliable for writers and
        best-effort for readers (DDS 2.2.3). Cyclone DDS leaves defaults out.
        """
        default = Reliability.RELIABLE if writer else Reliability.BEST_EFFORT
        first = parameters.first
        liveliness = first(Pid.LIVELINESS)
        return cls(
            reliability=_read(first(Pid.RELIABILITY), _reliability, default),
            durability=_read(first(Pid.DURABILITY), _durability, Durability.VOLATILE),
            deadline=_read(first(Pid.DEADLINE), seconds, INFINITE),
            liveliness=_read(liveliness, Cursor.u32, 0),
            lease=_read(liveliness, seconds, INFINITE),
            exclusive=bool(_read(first(Pid.OWNERSHIP), Cursor.u32, 0)),
            partitions=_read(first(Pid.PARTITION), _partitions, ()),
            representations=_read(first(Pid.DATA_REPRESENTATION), _representations, ()),
        )


def _read(value: Cursor | None, reader: Callable[[Cursor], _T], default: _T) -> _T:
    return default if value is None else reader(value)


def duration(value: float) -> bytes:
    """Return the 8 bytes of a duration in seconds, little-endian: seconds, and 2**-32 s (9.3.2)."""
    if value >= 0x7FFF_FFFF:
        return _INFINITE_BYTES
    whole = int(value)
    return struct.pack("<iI", whole, int((value - whole) * 2**32))


def seconds(value: Cursor) -> float:
    """Read a duration, in seconds."""
    whole, fraction = value.i32(), value.u32()
    return INFINITE if whole == 0x7FFF_FFFF else whole + fraction / 2**32


def _reliability(value: Cursor) -> Reliability:
    # Kinds that are not known promise nothing.
    return Reliability.RELIABLE if value.u32() == 2 else Reliability.BEST_EFFORT


def _durability(value: Cursor) -> Durability:
    kind = value.u32()
    if kind not in Durability._value2member_map_:
        raise MalformedError(f"durability {kind}")
    return Durability(kind)


def _partitions(value: Cursor) -> tuple[str, ...]:
    names = []
    for _ in range(_limited(value.u32(), _MAX_PARTITIONS)):
        value.align(4)
        names.append(value.string())
    return tuple(names)


def _representations(value: Cursor) -> tuple[int, ...]:
    return tuple(value.u16() for _ in range(_limited(value.u32(), _MAX_PARTITIONS)))


def _limited(count: int, limit: int) -> int:
    if count > limit:
        raise MalformedError(f"{count} entries, where {limit} may be")
    return count
