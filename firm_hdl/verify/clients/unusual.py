"""Unusual packets and values: rare ones that are legal, and malformed ones.

An unusual packet is the packet of a value with one unusual case, at the first place for this case.
Our own writer makes it. The packet is used only if this writer writes the value without the case as
the reference does.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice

from firm_hdl.cases.values import Plain, changed
from firm_hdl.model import Array, FieldType, Message, Primitive, String
from firm_hdl.model import Sequence as SequenceType
from firm_hdl.wire import Wire

__all__ = [
    "UNUSUAL_CASES",
    "plain_packet",
    "unusual_packet",
    "unusual_packets",
    "unusual_value",
    "unusual_values",
    "zero",
]

MOST_PACKET_BYTES = 1 << 12
"""Packets that are longer get no unusual case."""

MOST_OF_A_KIND = 2
"""The most packets with a case, and the most values with a case, for a type."""

MOST_BOUND = 64
"""No case exceeds a bound that is higher than this."""

TOO_LONG = 70_000
"""A length that exceeds every packet here, but that a library can still allocate."""

_CODES = {1: "B", 2: "H", 4: "I", 8: "Q"}


UNUSUAL_CASES: dict[str, str] = {
    # A receiver has to take these packets.
    "bare-string": "cdr",  # The length of an empty string is 0, and it has no NUL.
    "big-endian": "cdr",  # The packet is big-endian.
    "options": "cdr",  # The options in the header are not zero.
    "dirty-padding": "cdr",  # Padding is not zero.
    **dict.fromkeys(("pad-1", "pad-2", "pad-3"), "cdr"),  # One to three zero bytes follow.
    # A receiver may refuse these packets.
    "no-nul": "cdr",  # A string has no NUL after it.
    "nul-inside": "ros1 cdr",  # A string has a NUL among its characters.
    "not-utf8": "ros1 cdr",  # A string is not UTF-8.
    "bool-2": "ros1 cdr",  # A bool is 2.
    "trailing-1": "ros1",  # A byte follows.
    "trailing-4": "ros1 cdr",  # Four zero bytes follow.
    "cut-1": "ros1 cdr",  # The last byte is missing.
    "cut-half": "ros1 cdr",  # The second half is missing.
    "cut-all": "ros1 cdr",  # The packet is empty.
    "cut-header": "cdr",  # The packet is half a header.
    "bound-text": "ros1 cdr",  # A string is longer than its bound.
    "bound-items": "ros1 cdr",  # A sequence is longer than its bound.
    "long-text": "ros1 cdr",  # The length of a string exceeds the packet.
    "long-items": "ros1 cdr",  # The length of a sequence exceeds the packet.
}
"""Cases by name, and the wires that can have them: ``ros1``, ``cdr``, or both."""

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


def unusual_packets(
    message: Message, wire: Wire, values: Sequence[Plain]
) -> Iterator[tuple[str, Plain, bytes]]:
    """Yield cases, values, and their unusual packets: at most `MOST_OF_A_KIND` of each case."""
    for case, wires in UNUSUAL_CASES.items():
        if wire in wires.split():
            packets = ((value, unusual_packet(message, wire, value, case)) for value in values)
            found = ((case, value, packet) for value, packet in packets if packet is not None)
            yield from islice(found, MOST_OF_A_KIND)


def unusual_packet(message: Message, wire: Wire, value: Plain, case: str) -> bytes | None:
    """Return the packet of a value with one case; `None` if there is no place for it."""
    plain = plain_packet(message, wire, value)
    if len(plain) > MOST_PACKET_BYTES:
        return None
    if case in _TAILS:
        packet = _TAILS[case](plain)
    else:
        writer = _Writer(wire=wire, case=case)
        writer.packet(message, value)
        packet = bytes(writer.data)
    return None if packet == plain else packet


_VALUE_CASES = ("nul-inside", "not-utf8", "bound-text", "bound-items")


def unusual_values(message: Message, values: Sequence[Plain]) -> Iterator[tuple[str, Plain]]:
    """Yield cases and unusual values to be written: at most `MOST_OF_A_KIND` of each case."""
    for case in _VALUE_CASES:
        found = (unusual_value(message, value, case) for value in values)
        yield from islice(((case, value) for value in found if value is not None), MOST_OF_A_KIND)


def unusual_value(message: Message, value: Plain, case: str) -> Plain | None:
    """Return a value with one case; `None` if there is no place for it."""
    writer = _Writer(wire="cdr", case=case)
    found = changed(message, value, writer.unusual_part)
    return found if writer.is_done else None


def plain_packet(message: Message, wire: Wire, value: Plain) -> bytes:
    """Return the packet of a value, without an unusual case."""
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
    case: str = ""
    is_done: bool = False
    data: bytearray = field(default_factory=bytearray)

    def takes_place(self, case: str) -> bool:
        """Return whether the case belongs at this place, the first one for it; mark it as done."""
        if case != self.case or self.is_done:
            return False
        self.is_done = True
        return True

    def packet(self, message: Message, value: Plain) -> None:
        if self.wire == "cdr":
            self.data += b"\0\0\0\0" if self.case == "big-endian" else b"\0\1\0\0"
        self.message(message, value)

    def number(self, value: int, size: int) -> None:
        if self.wire == "cdr":
            gap = -(len(self.data) - 4) % size
            self.data += bytes([0xFF if gap and self.takes_place("dirty-padding") else 0]) * gap
        order = ">" if self.case == "big-endian" else "<"
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
                self.number(2 if self.takes_place("bool-2") else value, 1)
            case Primitive():
                self.number(value, kind.bytes)
            case String(wide=True):
                value = self.unusual_items(kind.bound, value, 0x61, "bound-text")
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
        values = self.unusual_items(bound, values, more)
        self.number(TOO_LONG if self.takes_place("long-items") else len(values), 4)
        for each in values:
            write(each)

    def unusual_items(
        self, bound: int | None, values: Plain, more: Plain, case: str = "bound-items"
    ) -> Plain:
        if bound is not None and bound <= MOST_BOUND and self.takes_place(case):
            return [*values, *[more] * (bound + 1 - len(values))]
        return values

    def unusual_text(self, kind: String, value: bytes) -> bytes:
        if self.takes_place("not-utf8"):
            return b"\xc3("
        if self.takes_place("nul-inside"):
            return b"a\0b"
        if value and self.takes_place("no-nul"):
            return b"ab"
        if kind.bound is not None and kind.bound <= MOST_BOUND and self.takes_place("bound-text"):
            return value[: kind.bound].ljust(kind.bound + 1, b"x")
        return value

    def unusual_part(self, kind: FieldType, value: Plain) -> Plain:
        """Return a value with the case in the value itself, not in its parts."""
        match kind:
            case String(wide=False):
                return self.unusual_text(kind, value)
            case String(bound=bound):
                return self.unusual_items(bound, value, 0x61, "bound-text")
            case SequenceType(element=element):
                return self.unusual_items(kind.bound, value, zero(element))
            case _:
                return value

    def text(self, kind: String, value: bytes) -> None:
        had_nul = self.is_done
        value = self.unusual_text(kind, value)
        nul = b"\0" if self.wire == "cdr" else b""
        if not value and self.takes_place("bare-string"):
            nul = b""
        if self.case == "no-nul" and self.is_done and not had_nul:
            nul = b""
        size = len(value) + len(nul)
        self.number(TOO_LONG if self.takes_place("long-text") else size, 4)
        self.data += value + nul
