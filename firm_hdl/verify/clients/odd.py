"""Packets that are unusual, and either legal or not: what do libraries make of them?

Each is a packet of a chosen case with one thing done in another way, at its first place. The
writer here is one of our own; as long as nothing is done in another way, it has to write what the
reference writes, or none of its packets is used.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

from firm_hdl.model import Array, FieldType, Message, Primitive, String
from firm_hdl.model import Sequence as SequenceType
from firm_hdl.verify.references.values import Plain
from firm_hdl.wire import Wire

__all__ = [
    "ODDITIES",
    "odd_packet",
    "odd_packets",
    "odd_value",
    "odd_values",
    "plain_packet",
    "zero",
]

MOST_PACKET_BYTES = 1 << 12
"""Longer packets are not made odd."""

MOST_OF_A_KIND = 2
"""Of a type, so many packets and so many values of each kind are made odd."""

MOST_BOUND = 64
"""Higher bounds are not exceeded."""

TOO_LONG = 70_000
"""More than any packet here has, and no more than what a library may be made to allocate."""

_CODES = {1: "B", 2: "H", 4: "I", 8: "Q"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Oddity:
    """One thing that is done in another way.

    Attributes
    ----------
    name : str
    wires : str
        Where there is such a thing: ``ros1``, ``cdr``, or both.
    is_legal : bool
        Whether a receiver has to take the packet.
    text : str
        What is odd.
    """

    name: str
    wires: str
    is_legal: bool
    text: str


def _oddities() -> Iterator[Oddity]:
    def odd(name: str, text: str, wires: str = "ros1 cdr", is_legal: bool = False) -> Oddity:
        return Oddity(name=name, wires=wires, is_legal=is_legal, text=text)

    yield odd("bare-string", "the length of an empty string is 0, and it has no NUL", "cdr", True)
    yield odd("no-nul", "a string has no NUL behind it", "cdr")
    yield odd("nul-inside", "a string has a NUL among its characters")
    yield odd("not-utf8", "a string is not UTF-8")
    yield odd("bool-2", "a bool is 2")
    yield odd("big-endian", "the packet is big-endian", "cdr", True)
    yield odd("options", "the options in the header are not zero", "cdr", True)
    yield odd("dirty-padding", "padding is not zero", "cdr", True)
    for count in (1, 2, 3):
        yield odd(f"pad-{count}", f"{count} zero bytes follow", "cdr", True)
    yield odd("trailing-1", "a byte follows", "ros1")
    yield odd("trailing-4", "4 zero bytes follow")
    yield odd("cut-1", "the last byte is missing")
    yield odd("cut-half", "the second half is missing")
    yield odd("cut-all", "there is nothing")
    yield odd("cut-header", "there is nothing but half a header", "cdr")
    yield odd("bound-text", "a string is longer than its bound")
    yield odd("bound-items", "a sequence is longer than its bound")
    yield odd("long-text", "a string says that it is longer than the packet")
    yield odd("long-items", "a sequence says that it is longer than the packet")


ODDITIES: dict[str, Oddity] = {each.name: each for each in _oddities()}
"""Every one by name."""

_TAILS: dict[str, Callable[[bytes], bytes]] = {
    "options": lambda packet: packet[:2] + b"\x00\x03" + packet[4:],
    "pad-1": lambda packet: packet + bytes(1),
    "pad-2": lambda packet: packet + bytes(2),
    "pad-3": lambda packet: packet + bytes(3),
    "trailing-1": lambda packet: packet + b"\0",
    "trailing-4": lambda packet: packet + bytes(4),
    "cut-1": lambda packet: packet[:-1],
    "cut-half": lambda packet: packet[: len(packet) // 2],
    "cut-all": lambda packet: b"",
    "cut-header": lambda packet: packet[:2],
}


def odd_packets(
    message: Message, wire: Wire, values: Sequence[Plain]
) -> Iterator[tuple[Oddity, Plain, bytes]]:
    """Yield odd packets of a type, of each kind at most so many; and the values they come from."""
    for oddity in ODDITIES.values():
        if wire not in oddity.wires.split():
            continue
        found = 0
        for value in values:
            packet = odd_packet(message, wire, value, oddity)
            if packet is not None:
                yield oddity, value, packet
                found += 1
            if found == MOST_OF_A_KIND:
                break


def odd_packet(message: Message, wire: Wire, value: Plain, oddity: Oddity) -> bytes | None:
    """Return the packet of a value with one oddity; `None` if there is no place for it."""
    plain = plain_packet(message, wire, value)
    if len(plain) > MOST_PACKET_BYTES:
        return None
    if oddity.name in _TAILS:
        packet = _TAILS[oddity.name](plain)
    else:
        writer = _Writer(wire=wire, odd=oddity.name)
        writer.packet(message, value)
        packet = bytes(writer.data)
    return None if packet == plain else packet


_VALUE_ODDITIES = ("nul-inside", "not-utf8", "bound-text", "bound-items")


def odd_values(message: Message, values: Sequence[Plain]) -> Iterator[tuple[str, Plain]]:
    """Yield values that are odd, of each kind at most so many: what does a library write?"""
    for odd in _VALUE_ODDITIES:
        changed = (odd_value(message, value, odd) for value in values)
        for value in [value for value in changed if value is not None][:MOST_OF_A_KIND]:
            yield odd, value


def odd_value(message: Message, value: Plain, odd: str) -> Plain | None:
    """Return a value with one oddity; `None` if there is no place for it."""
    writer = _Writer(wire="cdr", odd=odd)
    changed = writer.changed(message, value)
    return changed if writer.is_done else None


def plain_packet(message: Message, wire: Wire, value: Plain) -> bytes:
    """Return the packet of a value, without anything odd."""
    writer = _Writer(wire=wire)
    writer.packet(message, value)
    return bytes(writer.data)


def zero(kind: FieldType) -> Plain:
    """Return a value of a type in which everything is zero and empty."""
    match kind:
        case Message():
            return {item.name: zero(item.type) for item in kind.fields}
        case Primitive(kind="bool"):
            return False
        case Primitive():
            return 0
        case String(wide=wide):
            return [] if wide else b""
        case Array():
            return [zero(kind.element)] * kind.count
        case _:
            return []


@dataclass(slots=True, kw_only=True)
class _Writer:
    wire: Wire
    odd: str = ""
    is_done: bool = False
    data: bytearray = field(default_factory=bytearray)

    def here(self, odd: str) -> bool:
        """Whether this is the first place for what is odd."""
        if odd != self.odd or self.is_done:
            return False
        self.is_done = True
        return True

    def packet(self, message: Message, value: Plain) -> None:
        if self.wire == "cdr":
            self.data += b"\0\0\0\0" if self.odd == "big-endian" else b"\0\1\0\0"
        self.message(message, value)

    def number(self, value: int, size: int) -> None:
        if self.wire == "cdr":
            gap = -(len(self.data) - 4) % size
            self.data += bytes([0xFF if gap and self.here("dirty-padding") else 0]) * gap
        order = ">" if self.odd == "big-endian" else "<"
        self.data += struct.pack(order + _CODES[size], value & ((1 << 8 * size) - 1))

    def message(self, kind: Message, value: Plain) -> None:
        if not kind.fields and self.wire == "cdr":
            self.number(0, 1)
        for item in kind.fields:
            self.field(item.type, value[item.name])

    def field(self, kind: FieldType, value: Plain) -> None:
        match kind:
            case Message():
                self.message(kind, value)
            case Primitive(kind="bool"):
                self.number(2 if self.here("bool-2") else value, 1)
            case Primitive():
                self.number(value, kind.bytes)
            case String(wide=True):
                value = self.odd_items(kind.bound, value, 0x61, "bound-text")
                self.items(None, value, lambda unit: self.number(unit, 4), 0)
            case String():
                self.text(kind, value)
            case Array(element=element):
                for each in value:
                    self.field(element, each)
            case SequenceType(element=element):
                self.items(kind.bound, value, lambda each: self.field(element, each), zero(element))

    def items(
        self, bound: int | None, values: Plain, write: Callable[[Plain], None], more: Plain
    ) -> None:
        values = self.odd_items(bound, values, more)
        self.number(TOO_LONG if self.here("long-items") else len(values), 4)
        for each in values:
            write(each)

    def odd_items(
        self, bound: int | None, values: Plain, more: Plain, odd: str = "bound-items"
    ) -> Plain:
        if bound is not None and bound <= MOST_BOUND and self.here(odd):
            return [*values, *[more] * (bound + 1 - len(values))]
        return values

    def odd_text(self, kind: String, value: bytes) -> bytes:
        if self.here("not-utf8"):
            return b"\xc3("
        if self.here("nul-inside"):
            return b"a\0b"
        if value and self.here("no-nul"):
            return b"ab"
        if kind.bound is not None and kind.bound <= MOST_BOUND and self.here("bound-text"):
            return value[: kind.bound].ljust(kind.bound + 1, b"x")
        return value

    def changed(self, kind: FieldType, value: Plain) -> Plain:
        """Return a value with what is odd in it, instead of writing it."""
        match kind:
            case Message():
                return {
                    item.name: self.changed(item.type, value[item.name]) for item in kind.fields
                }
            case String(wide=False):
                return self.odd_text(kind, value)
            case String(bound=bound):
                return self.odd_items(bound, value, 0x61, "bound-text")
            case SequenceType(element=element):
                items = self.odd_items(kind.bound, value, zero(element))
                return [self.changed(element, each) for each in items]
            case Array(element=element):
                return [self.changed(element, each) for each in value]
            case _:
                return value

    def text(self, kind: String, value: bytes) -> None:
        had_nul = self.is_done
        value = self.odd_text(kind, value)
        nul = b"\0" if self.wire == "cdr" else b""
        if not value and self.here("bare-string"):
            nul = b""
        if self.odd == "no-nul" and self.is_done and not had_nul:
            nul = b""
        size = len(value) + len(nul)
        self.number(TOO_LONG if self.here("long-text") else size, 4)
        self.data += value + nul
