"""Cut a segment (bytes whose map to leaves is static) into steps."""

from __future__ import annotations

from dataclasses import replace

from firm_hdl.plan.ir import Fixed, Pad, Part, Slice

__all__ = ["cut", "split"]


def cut(segment: list[Slice], bus_bytes: int, last_bytes: int) -> list[int]:
    """Return step sizes for a segment: as few steps as possible, cut between values if possible.

    Steps take up to a bus word, the last one up to `last_bytes`.
    """
    borders = {item.at for item in segment}
    total = segment[-1].at + segment[-1].bytes
    sizes: list[int] = []
    start = 0
    while total - start > last_bytes:
        later = -(-(total - start - last_bytes) // bus_bytes) - 1
        lowest = max(total - last_bytes - later * bus_bytes, start + 1)
        cuts = [at for at in range(lowest, start + bus_bytes + 1) if at in borders]
        end = cuts[-1] if cuts else start + bus_bytes
        sizes.append(end - start)
        start = end
    return [*sizes, total - start]


def split(segment: list[Slice], sizes: list[int]) -> list[tuple[Slice, ...]]:
    """Distribute slices over steps, splitting those that cross a border."""
    steps: list[list[Slice]] = [[] for _ in sizes]
    index, start = 0, 0
    for item in segment:
        done = 0
        while True:
            while index < len(sizes) - 1 and item.at + done >= start + sizes[index]:
                start += sizes[index]
                index += 1
            size = min(item.bytes - done, start + sizes[index] - item.at - done)
            steps[index].append(_piece(item, done, size, item.at + done - start))
            done += size
            if done == item.bytes:
                break
    return [tuple(step) for step in steps]


def _piece(item: Slice, first: int, size: int, at: int) -> Slice:
    match item:
        case Pad():
            return Pad(at=at, bytes=size)
        case Fixed():
            return Fixed(at=at, data=item.data[first : first + size], check=item.check)
        case Part():
            return replace(item, at=at, bytes=size, first=first)
