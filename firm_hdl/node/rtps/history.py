"""The memory of samples: a part of it for each writer of a topic, used in a circle."""

from __future__ import annotations

from dataclasses import dataclass

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out
from amaranth.utils import ceil_log2

from firm_hdl.gateware.memories import BlockMemory
from firm_hdl.node.rtps.endpoints import Endpoint

__all__ = ["MOST_SAMPLES", "History", "Part", "parts_of"]

MOST_SAMPLES = 16
"""Samples that a writer keeps at most: a power of two. The depth of QoS is a request of at least as
many, where readers are served from the history; what has room is kept."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """The memory of a writer.

    Attributes
    ----------
    base, bytes : int
        Where it begins, and its size: a power of two, of which `base` is a multiple.
    depth : int
        Samples that a late reader gets, if it is not volatile.
    """

    base: int
    bytes: int
    depth: int


def parts_of(writers: tuple[Endpoint, ...]) -> tuple[Part, ...]:
    """Return the memory of each writer of a topic, as large as that of the topic."""
    sizes = [each.topic.store("out").memory_bytes for each in writers if each.topic]
    # Larger ones first, so that each begins at a multiple of its size.
    order = sorted(range(len(sizes)), key=lambda number: -sizes[number])
    bases, at = {}, 0
    for number in order:
        bases[number], at = at, at + sizes[number]
    depths = [each.data.qos.depth or MOST_SAMPLES for each in writers if each.topic]
    return tuple(
        Part(base=bases[number], bytes=size, depth=min(depths[number], MOST_SAMPLES))
        for number, size in enumerate(sizes)
    )


class History(wiring.Component):
    """A memory of bytes with one write port and one read port; a byte is read a cycle later.

    Parameters
    ----------
    size : int
        Bytes.

    Members
    -------
    write_at, write_byte, writes : In
    read_at, reads : In
    byte : Out(8)
    """

    def __init__(self, size: int):
        self.bytes = max(2, size)
        address = ceil_log2(self.bytes)
        super().__init__(
            {
                "write_at": In(address),
                "write_byte": In(8),
                "writes": In(1),
                "read_at": In(address),
                "reads": In(1),
                "byte": Out(8),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        memory = BlockMemory(m, 8, 1 << ceil_log2(self.bytes))
        m.d.comb += [
            memory.write_at.eq(self.write_at),
            memory.write_word.eq(self.write_byte),
            memory.writes.eq(self.writes),
            memory.read_at.eq(self.read_at),
            memory.reads.eq(self.reads),
            self.byte.eq(memory.word),
        ]
        return m
