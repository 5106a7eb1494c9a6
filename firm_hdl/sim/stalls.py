"""Stalls: the cycles in which a stream may not transfer, as one frozen record with a seed.

A record can be used for any stream. The random pattern of a stream depends only on the record and
on the stream's name. So a run is reproducible, and two streams with the same record have different
patterns. A fixed `pattern` is the same for all streams.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from numbers import Integral, Real
from typing import ClassVar, TypeAlias

__all__ = ["StallPlan", "Stalls", "check_stalls", "stalls_of"]

_MOST_NAMES = 12
"""Names of streams that an error lists."""


@dataclass(frozen=True, slots=True)
class Stalls:
    """The stalls of a stream.

    A stalled source does not offer its next payload; a payload that is already offered stays. A
    stalled sink is not ready.

    Attributes
    ----------
    probability : float
        Probability of a stall before each cycle without a stall.
    min_cycles, max_cycles : int
        Length of a stall, drawn uniformly from this range (both ends included).
    seed : int
        Seed of the pattern.
    pattern : str
        Bits that are repeated instead of random stalls, one per cycle: ``1`` does not stall, ``0``
        stalls.
    """

    probability: float = 0.0
    min_cycles: int = 1
    max_cycles: int = 1
    seed: int = 0
    pattern: str = ""

    none: ClassVar[Stalls]

    def __post_init__(self) -> None:
        if not isinstance(self.pattern, str):
            raise TypeError(f"Pattern must be a text of 0 and 1, not {self.pattern!r}")
        if isinstance(self.probability, bool) or not isinstance(self.probability, Real):
            raise TypeError(
                f"Probability must be a number, not {self.probability!r}; "
                "Stalls.bits takes a pattern"
            )
        for cycles in (self.min_cycles, self.max_cycles):
            if not isinstance(cycles, Integral):
                raise TypeError(f"Cycles of a stall must be an integer, not {cycles!r}")
        if not 0 <= self.probability <= 1:
            raise ValueError(f"Probability must be in 0..1, not {self.probability!r}")
        if not 1 <= self.min_cycles <= self.max_cycles:
            raise ValueError(
                f"Lengths must be 1 <= min_cycles <= max_cycles, not "
                f"{self.min_cycles!r} and {self.max_cycles!r}"
            )
        if set(self.pattern) - {"0", "1"}:
            raise ValueError(f"Pattern must consist of 0 and 1, not {self.pattern!r}")
        if self.pattern and "1" not in self.pattern:
            raise ValueError(f"Pattern {self.pattern!r} would stall for ever")

    @classmethod
    def bits(cls, pattern: str) -> Stalls:
        """Return the stalls of a repeated bit string: ``1`` does not stall, ``0`` stalls."""
        if pattern == "":
            raise ValueError("Pattern must not be empty")
        return cls(pattern=pattern)

    def __bool__(self) -> bool:
        """Return whether a stall can happen."""
        return "0" in self.pattern if self.pattern else self.probability > 0

    @property
    def longest(self) -> int:
        """Most consecutive cycles of a stall."""
        if self.pattern:
            return max(map(len, (self.pattern * 2).split("1")))
        return self.max_cycles if self else 0

    def cycles(self, name: str) -> Iterator[bool]:
        """Yield for each cycle, without end, whether the stream of that name is stalled."""
        while self.pattern:
            yield from (bit == "0" for bit in self.pattern)
        # A string seeds the same way in every process and Python release, unlike a hash.
        rng = random.Random(f"{self.seed}/{name}")
        while True:
            if self and rng.random() < self.probability:
                yield from (True for _ in range(rng.randint(self.min_cycles, self.max_cycles)))
            yield False


Stalls.none = Stalls()

StallPlan: TypeAlias = "Stalls | Mapping[str, Stalls] | None"
"""Stalls of many streams: one record for all of them, or records by stream name.

A name also includes all streams below it: ``message`` includes every leaf, and ``message.header``
the leaves of the header. The longest name that fits a stream counts. Streams that no name fits are
not stalled.
"""


def check_stalls(plan: StallPlan, names: Iterable[str] | None = None) -> None:
    """Check a user's stalls of the streams with these names; `None`: of any.

    Raises `TypeError` if the plan is not a `StallPlan`. Raises `ValueError` if it names a stream
    that does not exist.
    """
    if plan is None or isinstance(plan, Stalls):
        return
    if not isinstance(plan, Mapping):
        raise TypeError(
            "stalls= must be Stalls, such as Stalls(0.5), or a dict of Stalls by the names of "
            f"streams, not {plan!r}"
        )
    # The streams of packets and statuses come before those of leaves.
    known = None if names is None else sorted(names, key=lambda name: name.count("."))
    for name, stalls in plan.items():
        if known is not None and not any(f"{each}.".startswith(f"{name}.") for each in known):
            raise ValueError(f"There is no stream {name!r} to stall; there are {_listed(known)}")
        if not isinstance(stalls, Stalls):
            raise TypeError(
                f"The stalls of {name!r} must be Stalls, such as Stalls(0.5), not {stalls!r}"
            )


def _listed(names: list[str]) -> str:
    more = f" and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else ""
    return ", ".join(map(repr, names[:_MOST_NAMES])) + more


def stalls_of(plan: StallPlan, name: str) -> Stalls:
    """Return the stalls of one stream."""
    if plan is None:
        return Stalls.none
    if isinstance(plan, Stalls):
        return plan
    while name and name not in plan:
        name = name.rpartition(".")[0]
    return plan.get(name, Stalls.none)
