"""Encode transfers to a packet, as a serializer does."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from firm_hdl.plan.interpret.machine import Machine, Payload
from firm_hdl.plan.tree import Fixed, Leaf, Part, Plan, Run

__all__ = ["EncodeStatus", "encode"]

EncodeStatus: TypeAlias = Literal["OK", "LENGTH", "ITEMS"]


def encode(
    plan: Plan, streams: Mapping[int, Iterable[Payload]], *, bare_strings: bool = False
) -> tuple[bytes, EncodeStatus]:
    """Encode a message as the serializer of a plan does.

    Parameters
    ----------
    plan : Plan
    streams : mapping of int to iterable
        Payloads by index of the leaf. Each call takes the payloads of one message from iterators,
        so that calls with the same iterators give one packet each.
    bare_strings : bool
        Whether to write an empty CDR string as the length 0, without its NUL. A serializer never
        writes it, but ROS 2 and the deserializer accept it.

    Returns
    -------
    packet : bytes
        All bytes that the lengths promise, even if the status is not ``OK``.
    status : str
        ``OK``, or the first error in wire order.

    Raises
    ------
    ValueError
        If a leaf has fewer transfers than its length promises, or a payload does not fit its leaf.
    """
    iterators = {leaf: iter(given) for leaf, given in streams.items()}
    writer = _Writer(plan=plan, streams=iterators, bare_strings=bare_strings)
    writer.run()
    return bytes(writer.packet), writer.status


@dataclass(slots=True, kw_only=True)
class _Writer(Machine):
    streams: Mapping[int, Iterator[Payload]]
    bare_strings: bool
    status: EncodeStatus = "OK"
    packet: bytearray = field(default_factory=bytearray)
    # All bytes of the current transfer.
    whole: bytes = b""

    @property
    def offset(self) -> int:
        return len(self.packet)

    def skip(self, count: int) -> None:
        self.packet += bytes(count)

    def fixed(self, item: Fixed) -> None:
        self.packet += item.data

    def fail(self, status: EncodeStatus) -> None:
        if self.status == "OK":
            self.status = status

    def receive(self, index: int) -> Payload:
        for payload in self.streams.get(index, iter(())):
            return payload
        raise ValueError(f"Leaf {self.plan.leaves[index]} has fewer transfers than are needed")

    def part(self, part: Part) -> None:
        leaf = self.plan.leaves[part.leaf]
        if part.first == 0:
            if leaf.kind == "items":
                count = part.size // leaf.item_bytes
                self.whole = self.lanes(part.leaf, count, self.is_last(part))
            else:
                self.whole = self.number(part.leaf)
        self.packet += self.whole[part.first : part.first + part.bytes]

    def number(self, index: int) -> bytes:
        leaf = self.plan.leaves[index]
        payload = self.receive(index)
        if not isinstance(payload, int):
            raise ValueError(f"Leaf {leaf} takes a number, not {payload!r}")
        if leaf.kind == "length":
            given = self.plan.lengths[index]
            if payload > given.limit:
                self.fail("LENGTH")
            has_nul = given.nul and (payload or not self.bare_strings)
            payload += 1 if has_nul else 0
            self.length = payload
        return _bytes(leaf, payload)

    def lanes(self, index: int, count: int, last: bool) -> bytes:
        leaf = self.plan.leaves[index]
        payload = self.receive(index)
        if isinstance(payload, int) or len(payload[0]) < count:
            raise ValueError(f"Leaf {leaf} takes at least {count} lanes and last, not {payload!r}")
        values, given = payload
        if given != last:
            self.fail("ITEMS")
        return b"".join(_bytes(leaf, value) for value in values[:count])

    def items(self, run: Run, count: int, last: bool) -> None:
        self.packet += self.lanes(run.leaf, count, last)

    def terminator(self) -> None:
        self.packet.append(0)


def _bytes(leaf: Leaf, value: int) -> bytes:
    """Return the bytes of a number on the wire, cut to the width of its leaf."""
    bits = min(1 if leaf.type == "bool" else 64, 8 * leaf.item_bytes)
    return (value & ((1 << bits) - 1)).to_bytes(leaf.item_bytes, "little")
