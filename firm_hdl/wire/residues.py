"""Sets of residues: the statically known part of the offsets where a field may start.

A set is a bit mask: bit r is set if the offset may be r modulo 8. Modulo 8 is enough for alignment,
because no primitive has a larger one. For lanes of a bus word, a plan uses the width of the bus,
another power of two. Every operation distributes over union: the image of a set is the union of the
images of its members.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

__all__ = [
    "ALL",
    "MODULUS",
    "advance",
    "aligned",
    "members",
    "pad_of",
    "repeat",
    "single",
    "spread",
]

MODULUS = 8
ALL = (1 << MODULUS) - 1


def single(offset: int, modulus: int = MODULUS) -> int:
    """Return the set of one known offset."""
    return 1 << (offset % modulus)


def members(residues: int) -> Iterator[int]:
    """Yield the residues of a set in ascending order."""
    return (r for r in range(residues.bit_length()) if residues >> r & 1)


def advance(residues: int, count: int, modulus: int = MODULUS) -> int:
    """Return the set of offsets after `count` bytes."""
    count %= modulus
    return (residues << count | residues >> (modulus - count)) & ((1 << modulus) - 1)


def aligned(residues: int, align: int, modulus: int = MODULUS) -> int:
    """Return the set of offsets after padding to a multiple of `align` bytes."""
    result = 0
    for r in members(residues):
        result |= single(r + -r % align, modulus)
    return result


def pad_of(residues: int, align: int) -> int | None:
    """Return the padding to a multiple of `align` bytes, or `None` if it depends on the offset."""
    pads = {-r % align for r in members(residues)}
    return pads.pop() if len(pads) == 1 else None


def spread(residues: int, unit_bytes: int, modulus: int = MODULUS) -> int:
    """Return the set of offsets after any number of units, zero included."""
    result = residues
    for n in range(1, modulus // math.gcd(unit_bytes, modulus)):
        result |= advance(residues, n * unit_bytes, modulus)
    return result


def repeat(residues: int, body: Callable[[int], int], count: int | None) -> tuple[int, int]:
    """Run a loop body `count` times (`None`: any number of times, zero included).

    Returns
    -------
    entry : int
        Offsets where an iteration may start.
    after : int
        Offsets where the loop may end.
    """
    seen: list[int] = []
    now = residues
    entry = 0
    # There are finitely many sets, so one of them recurs. From there on, the sets form a cycle.
    while now not in seen and (count is None or len(seen) < count):
        seen.append(now)
        entry |= now
        now = body(now)
    if count is None:
        return entry, entry
    if len(seen) < count:
        start = seen.index(now)
        now = seen[start + (count - start) % (len(seen) - start)]
    return entry, now
