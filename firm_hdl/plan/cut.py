"""Cut a segment (bytes whose map to leaves is static) into steps."""

from __future__ import annotations

from dataclasses import replace
from itertools import accumulate

from firm_hdl.plan.tree import Fixed, Pad, Part, Slice, size_of

__all__ = ["cut", "split", "step_sizes"]


def step_sizes(
    segment: list[Slice], bus_bytes: int, *, at_start: bool, may_be_wide: bool, has_rest: bool
) -> list[int]:
    """Return step sizes for a segment.

    A step takes up to a bus word. The last step may take two words if it takes no rest of a run:
    the converters move two words a cycle, and a rest is one of them. A stream has one transfer per
    cycle, so a step ends between two transfers of a leaf.

    * `segment`: with at least one slice; all transfers in it are whole.
    * `at_start`: whether the segment starts a packet. A packet starts in lane 0 (rule 7 of
      docs/reference/streams.md), so steps that are cut at bus words need no rotator.
    * `may_be_wide`: whether a last step may take two words.
    * `has_rest`: whether the first step takes the rest of a run.
    """
    sizes: list[int] = []
    for piece in _pieces(segment):
        total = size_of(piece)
        if sizes or not at_start:
            # With more than two words, there is a step before the last one, and it takes the rest.
            is_wide = may_be_wide and (bool(sizes) or not has_rest or total > 2 * bus_bytes)
            sizes += cut(piece, bus_bytes, 2 * bus_bytes if is_wide else bus_bytes)
            continue
        # A trigger alone has no bytes, but a step.
        sizes = [min(bus_bytes, total - at) for at in range(0, total, bus_bytes)] or [0]
        if len(sizes) > 1 and may_be_wide:
            sizes[-2:] = [sizes[-2] + sizes[-1]]
    return sizes


def _pieces(segment: list[Slice]) -> list[list[Slice]]:
    """Divide a segment between transfers of the same leaf."""
    pieces: list[list[Slice]] = [[]]
    previous: Slice | None = None
    for item in segment:
        if isinstance(previous, Part) and isinstance(item, Part) and previous.leaf == item.leaf:
            pieces.append([])
        pieces[-1].append(item)
        previous = item
    return pieces


def cut(segment: list[Slice], bus_bytes: int, last_bytes: int) -> list[int]:
    """Return step sizes for a segment: as few steps as possible, cut between values if possible.

    Steps take up to a bus word, the last one up to `last_bytes`.
    """
    borders = set(accumulate(item.bytes for item in segment))
    total = size_of(segment)
    sizes: list[int] = []
    start = 0
    while total - start > last_bytes:
        # Steps between this one and the last one.
        inner = -(-(total - start - last_bytes) // bus_bytes) - 1
        # If this step ended earlier, full steps after it would not reach the last one any more.
        lowest = max(total - last_bytes - inner * bus_bytes, start + 1)
        cuts = [at for at in range(lowest, start + bus_bytes + 1) if at in borders]
        end = cuts[-1] if cuts else start + bus_bytes
        sizes.append(end - start)
        start = end
    return [*sizes, total - start]


def split(segment: list[Slice], sizes: list[int]) -> list[tuple[Slice, ...]]:
    """Distribute slices over steps, splitting those that cross a border."""
    steps: list[list[Slice]] = [[]]
    ends = iter(sizes)
    room = next(ends)
    for item in segment:
        done = 0
        while True:
            # A slice without bytes is in the step after a border, unless that is the end.
            if not room and (following := next(ends, None)) is not None:
                steps.append([])
                room = following
            size = min(item.bytes - done, room)
            steps[-1].append(_piece(item, done, size))
            done += size
            room -= size
            if done == item.bytes:
                break
    return [tuple(step) for step in steps]


def _piece(item: Slice, first: int, size: int) -> Slice:
    match item:
        case Pad():
            return Pad(bytes=size)
        case Fixed():
            return Fixed(data=item.data[first : first + size], check=item.check)
        case Part():
            return replace(item, bytes=size, first=first)
