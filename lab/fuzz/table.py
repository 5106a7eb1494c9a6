"""The table of a type: what the reference decoder of the fuzzer knows of it.

It is made from the message model alone, by the rules of ``docs/reference/streams.md``. It shares
no code with the layout, the plan and the circuits: it has its own walk over the fields, its own
names of leaves, and its own limits of lengths.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from firm_hdl.model import Array, FieldType, Message, Primitive, Sequence, String, Wire

__all__ = ["Table", "table_of"]

_LENGTH_BYTES = 4
_HEADER_BYTES = 4
# On CDR, a sequence may lose this much of its padding, and save as much after it.
_SAVED_BYTES = 14
# A nested length that claims fewer bytes than a 16th of the largest packet is not counted.
_LEAST_UNCOUNTED, _MOST_UNCOUNTED = 256, 4096
_EMPTY = "structure_needs_at_least_one_member"


@dataclass(frozen=True, slots=True, kw_only=True)
class TableLeaf:
    """A stream of the message side.

    Attributes
    ----------
    path : tuple of str
    bits : int
        Bits of the scalar, or of an item.
    lanes : int
        Items of a transfer.
    has_last : bool
        Whether it has items, and so a `last`.
    """

    path: tuple[str, ...]
    bits: int
    lanes: int = 1
    has_last: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """The leaves of a type in wire order, and its fields as lines of text for the decoder.

    Attributes
    ----------
    least_bytes : int
        Size of the shortest packet, without padding.
    room : int
        Bytes that nested lengths may claim together.
    claim_bytes : int
        Least bytes that the items of a nested length must have to be counted.
    saved_bytes : int
        Bytes of its items that such a length does not claim.
    """

    wire: Wire
    bus_bytes: int
    least_bytes: int
    room: int
    claim_bytes: int
    saved_bytes: int
    leaves: tuple[TableLeaf, ...]
    lines: tuple[str, ...]

    def text(self) -> str:
        """Return what the harness reads."""
        head = f"table {int(self.wire == 'cdr')} {self.bus_bytes} {len(self.leaves)}"
        head += f" {self.room} {self.claim_bytes} {self.saved_bytes}"
        leaves = (f"{'.'.join(leaf.path)} {leaf.bits} {leaf.lanes}" for leaf in self.leaves)
        return "".join(f"{line}\n" for line in (head, *leaves, *self.lines))


def table_of(message: Message, *, wire: Wire, bus_bytes: int, max_message_bytes: int) -> Table:
    """Make the table of a type."""
    walk = _Walk(wire, bus_bytes)
    least = _HEADER_BYTES * walk.is_cdr + walk.least_bytes(message)
    walk.room = max_message_bytes - least
    lines = tuple(walk.message(message, ()))
    return Table(
        wire=wire,
        bus_bytes=bus_bytes,
        least_bytes=least,
        room=max(0, walk.room),
        claim_bytes=min(_MOST_UNCOUNTED, max(_LEAST_UNCOUNTED, max_message_bytes // 16)),
        saved_bytes=_SAVED_BYTES if walk.has_padding else 0,
        leaves=tuple(walk.leaves),
        lines=lines,
    )


@dataclass
class _Walk:
    """The walk over the fields of a type.

    Attributes
    ----------
    room : int
        Bytes that the shortest packet leaves of `max_message_bytes`.
    has_padding : bool
        Whether the shortest elements of a sequence have padding.
    leaves : list of TableLeaf
    """

    wire: Wire
    bus_bytes: int
    room: int = 0
    has_padding: bool = False
    leaves: list[TableLeaf] = field(default_factory=list)

    @property
    def is_cdr(self) -> bool:
        return self.wire == "cdr"

    def least_bytes(self, kind: FieldType) -> int:
        """Return the size of the shortest value, without padding."""
        match kind:
            case Primitive():
                return kind.bytes
            case String() | Sequence():
                return _LENGTH_BYTES
            case Array():
                return kind.count * self.least_bytes(kind.element)
            case Message(fields=()):
                return int(self.is_cdr)
            case Message():
                return sum(self.least_bytes(item.type) for item in kind.fields)

    def end(self, kind: FieldType, at: int) -> int:
        """Return where the shortest value that starts at an offset ends, padding included."""
        match kind:
            case Primitive():
                return at + (-at % kind.bytes if self.is_cdr else 0) + kind.bytes
            case String() | Sequence():
                return at + (-at % _LENGTH_BYTES if self.is_cdr else 0) + _LENGTH_BYTES
            case Array(count=0):
                return at
            case Array(element=element, count=count):
                first = self.end(element, at)
                return first + (count - 1) * (self.end(element, first) - first)
            case Message(fields=()):
                return at + self.is_cdr
            case Message():
                for item in kind.fields:
                    at = self.end(item.type, at)
                return at

    def repeated_bytes(self, element: FieldType) -> int:
        """Return the least bytes of an element from the end of the element before it."""
        first = self.end(element, 0)
        return self.end(element, first) - first

    def limit(self, item_bytes: int, bound: int | None, nul_bytes: int = 0) -> str:
        """Return the declared bound (0: none), and the largest length that is no error."""
        return self.limits((self.room - nul_bytes) // item_bytes, bound)

    def limits(self, most: int, bound: int | None) -> str:
        return f"{bound or 0} {max(0, most if bound is None else min(bound, most))}"

    def elements_limit(self, element: FieldType, bound: int | None) -> str:
        """Return the same as `limit` for a sequence of any elements."""
        least, repeated = self.least_bytes(element), self.repeated_bytes(element)
        # An element without bytes still has a transfer, and counts as one byte.
        most = self.room // max(1, least)
        if repeated > least and not isinstance(element, Primitive):
            self.has_padding = True
            most = min(most, (self.room + _SAVED_BYTES) // repeated)
        return self.limits(most, bound)

    def leaf(self, *path: str, bits: int, lanes: int = 1, has_last: bool = False) -> int:
        self.leaves.append(TableLeaf(path=path, bits=bits, lanes=lanes, has_last=has_last))
        return len(self.leaves) - 1

    def message(self, message: Message, path: tuple[str, ...]) -> Iterator[str]:
        if not message.fields and self.is_cdr:
            yield f"scalar {self.leaf(*path, _EMPTY, bits=8)} 1 0"
        elif not message.fields:
            yield f"trigger {self.leaf(*path, 'trigger', bits=1)}"
        for item in message.fields:
            yield from self.value(item.type, (*path, item.name))

    def value(self, kind: FieldType, path: tuple[str, ...]) -> Iterator[str]:
        match kind:
            case Primitive():
                is_bool = kind.kind == "bool"
                leaf = self.leaf(*path, bits=1 if is_bool else 8 * kind.bytes)
                yield f"scalar {leaf} {kind.bytes} {int(is_bool)}"
            case Message():
                yield from self.message(kind, path)
            case String(bound=bound, wide=wide):
                has_nul = self.is_cdr and not wide
                limit = self.limit(4 if wide else 1, bound, int(has_nul))
                length = self.leaf(*path, "length", bits=32)
                yield self.run(path, length, 4 if wide else 1, False, f"{int(has_nul)} 0 {limit}")
            case Array(element=element, count=count):
                yield from self.elements(element, path, -1, f"{count} 0 0")
            case Sequence(element=element, bound=bound):
                length = self.leaf(*path, "length", bits=32)
                limit = self.elements_limit(element, bound)
                yield from self.elements(element, path, length, f"0 {limit}")

    def elements(
        self, element: FieldType, path: tuple[str, ...], length: int, counts: str
    ) -> Iterator[str]:
        if isinstance(element, Primitive):
            yield self.run(path, length, element.bytes, element.kind == "bool", f"0 {counts}")
            return
        # An element without bytes claims one.
        yield f"loop {length} {max(1, self.repeated_bytes(element))} {counts}"
        yield from self.value(element, (*path, "item"))
        yield "end"

    def run(
        self, path: tuple[str, ...], length: int, item_bytes: int, is_bool: bool, rest: str
    ) -> str:
        leaf = self.leaf(
            *path,
            "items",
            bits=1 if is_bool else 8 * item_bytes,
            lanes=max(1, self.bus_bytes // item_bytes),
            has_last=True,
        )
        return f"run {length} {leaf} {item_bytes} {int(is_bool)} {rest}"
