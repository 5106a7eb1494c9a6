"""Where values may start and end on a wire, modulo 8.

Alignment is decided here and nowhere else: layouts and figures of types ask the same
:class:`Alignment`. It is an abstract interpretation of types over :mod:`firm_hdl.wire.residues`.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from firm_hdl.model import PRIMITIVES, Array, FieldType, Message, Primitive, Sequence, String
from firm_hdl.wire import residues as rs
from firm_hdl.wire.rules import WireRules

__all__ = ["LENGTH", "MAX_LENGTH", "OCTET", "Alignment"]

LENGTH = PRIMITIVES["ros2"]["uint32"]
"""The length of a string or a sequence."""

MAX_LENGTH = (1 << LENGTH.bits) - 1
"""Largest length of a string or a sequence on every wire."""

OCTET = PRIMITIVES["ros2"]["uint8"]
"""A byte of a string, and the one member of a message without fields."""


@dataclass(slots=True)
class Alignment:
    """The alignment of values on a wire. Offsets are sets of residues modulo 8.

    The end of a type is computed once for each residue where the type may start. Nesting may be
    deeper than Python's recursion limit. Then call `after` for the parts of a type before the type.
    """

    rules: WireRules
    _after: dict[tuple[FieldType, int], int] = field(default_factory=dict)
    _shortest: dict[tuple[FieldType, int], int] = field(default_factory=dict)

    def of(self, primitive: Primitive) -> int:
        """Return the number of bytes to a multiple of which a primitive is aligned."""
        return min(primitive.bytes, self.rules.max_align)

    def pad(self, primitive: Primitive, at: int) -> int | None:
        """Return the padding before a primitive, or `None` if it depends on the offset."""
        return rs.pad_of(at, self.of(primitive))

    def past(self, primitive: Primitive, at: int) -> int:
        """Return the offsets where a primitive may end, by those before its padding."""
        return rs.advance(rs.aligned(at, self.of(primitive)), primitive.bytes)

    def entry(self, kind: Array | Sequence, at: int) -> int:
        """Return the offsets where an element may start, before its padding."""
        start = at if isinstance(kind, Array) else self.past(LENGTH, at)
        if isinstance(kind.element, Primitive):
            return start  # Later elements follow without padding.
        count = kind.count if isinstance(kind, Array) else None
        return rs.repeat(start, lambda now: self.after(kind.element, now), count)[0]

    def after(self, kind: FieldType, at: int) -> int:
        """Return the offsets where a value may end, by those where it may start."""
        result = 0
        for r in rs.members(at):
            key = (kind, r)
            if key not in self._after:
                self._after[key] = self._after_one(kind, rs.single(r))
            result |= self._after[key]
        return result

    def shortest(self, kind: FieldType, start: int) -> int:
        """Return the bytes of the shortest value, padding before it included.

        Strings and sequences have a length of 0 and nothing else; CDR strings have no NUL.

        * `start`: offset where the value may start.
        """
        key = (kind, start % rs.MODULUS)
        if key not in self._shortest:
            self._shortest[key] = self._shortest_one(*key)
        return self._shortest[key]

    def repeated(self, element: FieldType) -> int:
        """Return the bytes of the shortest element that follows another shortest one.

        Each later one has as many bytes. Let the strictest alignment in an element be to a bytes.
        Then each element ends at the same offset modulo a, wherever the first one started, and
        the size of the next one depends on this offset only.
        """
        return self.shortest(element, self.shortest(element, 0))

    def _shortest_one(self, kind: FieldType, start: int) -> int:
        match kind:
            case Primitive():
                return -start % self.of(kind) + kind.bytes
            case Message(fields=()):
                return 0 if self.rules.empty_member is None else OCTET.bytes
            case Message():
                at = start
                for item in kind.fields:
                    at += self.shortest(item.type, at)
                return at - start
            case Array(count=0):
                return 0
            case Array(element=element, count=count):
                first = self.shortest(element, start)
                return first + (count - 1) * self.shortest(element, start + first)
            case String() | Sequence():
                return self.shortest(LENGTH, start)

    def _after_one(self, kind: FieldType, at: int) -> int:
        match kind:
            case Primitive():
                return self.past(kind, at)
            case Message(fields=()):
                return at if self.rules.empty_member is None else self.past(OCTET, at)
            case Message():
                for item in kind.fields:
                    at = self.after(item.type, at)
                return at
            case String(wide=wide):
                return rs.spread(self.past(LENGTH, at), 4 if wide else 1)
            case Array(element=Primitive() as item, count=count):
                return rs.advance(rs.aligned(at, self.of(item)), count * item.bytes)
            case Sequence(element=Primitive() as item):
                at = self.past(LENGTH, at)
                return at | rs.spread(self.past(item, at), item.bytes)
            case Array(element=element, count=count):
                return rs.repeat(at, lambda now: self.after(element, now), count)[1]
            case Sequence(element=element):
                start = self.past(LENGTH, at)
                return rs.repeat(start, lambda now: self.after(element, now), None)[1]
