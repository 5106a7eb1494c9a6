"""The memory of samples: a part of it for each writer of a topic, used in a circle."""

from __future__ import annotations

from dataclasses import dataclass, replace

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out
from amaranth.utils import ceil_log2

from firm_hdl.gateware.memories import BlockMemory
from firm_hdl.node.capacity import assembly_bytes, largest_bytes
from firm_hdl.node.description import Description
from firm_hdl.node.rtps.endpoints import Endpoint

__all__ = ["MOST_SAMPLES", "History", "Part", "assembly_parts", "bytes_of", "parts_of"]

MOST_SAMPLES = 16
"""Samples that a writer keeps at most: a power of two."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """The memory of a writer, or of a reader.

    Attributes
    ----------
    base, bytes : int
        Where it begins, and its size: a power of two, of which `base` is a multiple. Or 0: it has
        none.
    depth : int
        As of QoS, and `MOST_SAMPLES` + 1 for what is deeper or has no end. So many samples a late
        reader gets, if it is not volatile, and so many wait for readers to acknowledge them.
    replays : bool
        Whether there are such late readers.
    has_tags : bool
        Whether its samples are replies, each with the tag of a request.
    """

    base: int
    bytes: int
    depth: int = 1
    replays: bool = False
    has_tags: bool = False


def bytes_of(parts: tuple[Part, ...]) -> int:
    """Return the size of the memory that some parts are of; at least 8."""
    return max([8, *(each.base + each.bytes for each in parts)])


def parts_of(writers: tuple[Endpoint, ...]) -> tuple[Part, ...]:
    """Return the memory of each writer of a topic, as large as that of the topic."""
    users, endless = [each for each in writers if each.topic], MOST_SAMPLES + 1
    sizes = [each.topic.store("out").memory_bytes for each in users if each.topic]
    return tuple(
        replace(
            part,
            depth=min(each.data.qos.depth or endless, endless),
            replays=bool(each.data.qos.durability),
            has_tags=each.is_service,
        )
        for part, each in zip(_placed(sizes), users, strict=True)
    )


def assembly_parts(description: Description, readers: tuple[Endpoint, ...]) -> tuple[Part, ...]:
    """Return the memory in which each reader puts a sample together that comes in fragments.

    Readers whose messages fit into a datagram of `datagram_bytes` have none.
    """
    datagram = description.link.datagram_bytes
    stores = [each.topic.store("in") for each in readers if each.topic]
    return _placed(
        [assembly_bytes(datagram, largest_bytes(description, store)) for store in stores]
    )


def _placed(sizes: list[int]) -> tuple[Part, ...]:
    """Place parts, larger ones first: so each begins at a multiple of its size."""
    order = sorted(range(len(sizes)), key=lambda number: -sizes[number])
    bases, at = {}, 0
    for number in order:
        bases[number], at = at, at + sizes[number]
    return tuple(Part(base=bases[number], bytes=size) for number, size in enumerate(sizes))


class History(wiring.Component):
    """A memory of words with one write port and one read port; a word is read a cycle later.

    Parameters
    ----------
    size : int
        Bytes.

    Members
    -------
    write_at, write_word, writes : In
    read_at, reads : In
        Addresses are those of bytes, of which the lowest two bits do not count.
    word : Out(32)
    """

    def __init__(self, size: int):
        self.bytes = max(8, size)
        address = ceil_log2(self.bytes)
        super().__init__(
            {
                "write_at": In(address),
                "write_word": In(32),
                "writes": In(1),
                "read_at": In(address),
                "reads": In(1),
                "word": Out(32),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        memory = BlockMemory(m, 32, 1 << len(self.write_at[2:]))
        m.d.comb += [
            memory.write_at.eq(self.write_at[2:]),
            memory.write_word.eq(self.write_word),
            memory.writes.eq(self.writes),
            memory.read_at.eq(self.read_at[2:]),
            memory.reads.eq(self.reads),
            self.word.eq(memory.word),
        ]
        return m
