"""Static figures of a message type: how deep, how large and how regular it is.

The paper explains test results by such figures. Each figure is an attribute of a type, computed
from the attributes of its parts. It is computed once per type; sizes and alignment are computed
once per type and start offset modulo 8. Nothing is unrolled and nothing recurses, so that neither
arrays of millions of elements nor deep nesting take long.

In the shortest message, every part is as short as possible; in the longest, as long as possible.
This holds on any wire, because a part that starts later never ends earlier. The output is a table,
CSV or JSON.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field, fields

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library
from firm_hdl.identity.command import of_each
from firm_hdl.model import (
    WIRE_OF,
    Array,
    Field,
    FieldType,
    Interface,
    Message,
    Primitive,
    Sequence,
    String,
    closure,
    element_of,
)
from firm_hdl.wire import RULES, Wire, WireRules, refusals
from firm_hdl.wire import residues as rs
from firm_hdl.wire.alignment import LENGTH, OCTET, Alignment

__all__ = ["FEATURES", "FORMATS", "Analyses", "Metrics", "metrics_of", "metrics_text", "report"]


FEATURES: dict[str, str] = {
    "constants": "a constant",
    "defaults": "a field with a default value",
    "messages": "a field that is a message",
    "empty_messages": "a message without fields",
    "long_doubles": "a long double, so that there are no sizes",
    "strings": "a string",
    "bounded_strings": "a string with a bound",
    "wstrings": "a wstring",
    "bounded_wstrings": "a wstring with a bound",
    "arrays_of_primitives": "a fixed array of primitives",
    "arrays_of_strings": "a fixed array of strings or wstrings",
    "arrays_of_messages": "a fixed array of messages",
    "sequences_of_primitives": "a sequence of primitives",
    "sequences_of_strings": "a sequence of strings or wstrings",
    "sequences_of_messages": "a sequence of messages",
    "bounded_sequences": "a sequence with a bound",
    "nested_sequences": "a sequence of messages that have sequences themselves",
}
"""Every feature, with the construct that has it."""


def features_of(message: Message, parts: Mapping[Message, frozenset[str]]) -> frozenset[str]:
    """List the features of a type, given those of the messages in it."""
    found = set().union(*parts.values())
    if message.constants:
        found.add("constants")
    if not message.fields:
        found.add("empty_messages")
    for item in message.fields:
        found.update(_features_of_field(item, parts))
    return frozenset(found)


def _features_of_field(item: Field, parts: Mapping[Message, frozenset[str]]) -> Iterator[str]:
    if item.default is not None:
        yield "defaults"
    kind = item.type
    element = element_of(kind)
    match element:
        case Primitive():
            of = "primitives"
            if not element.has_wire_format:
                yield "long_doubles"
        case String(bound=bound, wide=wide):
            of = "strings"
            yield (
                ("wstrings" if wide else "strings")
                if bound is None
                else ("bounded_wstrings" if wide else "bounded_strings")
            )
        case Message():
            of = "messages"
            if element.package:
                yield "messages"
    if isinstance(kind, Array):
        yield f"arrays_of_{of}"
    if isinstance(kind, Sequence):
        yield f"sequences_of_{of}"
        if kind.bound is not None:
            yield "bounded_sequences"
        if isinstance(element, Message) and any(f.startswith("sequences_") for f in parts[element]):
            yield "nested_sequences"


# Python refuses to print numbers of some thousand digits.
_MAX_LEAVES = 10**100

_RESIDUES = range(rs.MODULUS)


@dataclass(frozen=True, slots=True, kw_only=True)
class Metrics:
    """Figures of a message type on a wire."""

    name: str
    wire: Wire
    depth: int  # Levels of messages; 1 if the type has no message fields.
    types: int  # Different message types in it, itself included.
    constants: int  # Constants of the type itself.
    fields: int  # Fields of the type itself.
    # Fields of all levels that are not messages. An array or a sequence counts as one element, and
    # so does a message without fields.
    leaves: int
    # Leaves that have the same number of bytes in each message, and the others: strings, sequences,
    # and all leaves in sequences of messages.
    fixed_leaves: int
    dynamic_leaves: int
    # Size of the shortest message, encapsulation header included, as encoders write it.
    min_bytes: int | None
    max_bytes: int | None  # Size of the longest message; `None` if sizes are not limited.
    # Number of values on the wire (lengths of sequences and strings included) by their padding:
    # those that never have padding before them, those that have the same padding in each message,
    # and those whose padding differs.
    aligned: int | None
    padded: int | None
    shifting: int | None
    features: tuple[str, ...]  # Keys of `FEATURES` that occur in the type or in any message in it.
    # Size of the text that defines the type; that of the whole file for a message of a service or
    # an action.
    definition_bytes: int
    # Why sizes and alignment are `None`: the type has a field without a wire format
    # (`firm_hdl.wire.refusals`). Empty for all other types.
    unsized: str


def metrics_of(message: Message, wire: Wire | None = None) -> Metrics:
    """Analyse one type on a wire (by default that of its dialect)."""
    return Analyses(wire or message.wire).metrics(message)


@dataclass(slots=True, kw_only=True)
class _Type:
    """Attributes of a type, for each residue of the offset where it starts."""

    min_bytes: list[int]  # Bytes of the shortest value, by the residue where it starts.
    max_bytes: list[int] | None  # Bytes of the longest value, likewise.
    # Number of leaves.
    fixed: int
    dynamic: int
    features: frozenset[str]


_Key = tuple[Message, int]
_Counts = tuple[int, int, int]


@dataclass(slots=True)
class Analyses:
    """Analyses of many types on one wire; a type that several of them use is analysed once."""

    wire: Wire
    _rules: WireRules = field(init=False)
    _alignment: Alignment = field(init=False)
    _types: dict[Message, _Type] = field(default_factory=dict)
    _places: dict[_Key, _Counts] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._rules = RULES[self.wire]
        self._alignment = Alignment(self._rules)

    def metrics(self, message: Message) -> Metrics:
        """Give the figures of a type.

        Raises `DefinitionError` if the figures have too many digits to be printed.
        """
        if message.leaf_count > _MAX_LEAVES:
            problem = f"{message.name} has more than 10^100 fields when it is written out"
            raise DefinitionError.of(problem)
        parts = closure([message])
        for part in parts:
            if part not in self._types:
                self._types[part] = self._analyse(part)
        known = self._types[message]
        wrong = refusals(message) if "long_doubles" in known.features else []
        sizes = self._sizes(message) if not wrong else (None,) * 5
        min_bytes, max_bytes, aligned, padded, shifting = sizes
        return Metrics(
            name=message.name,
            wire=self.wire,
            depth=message.depth,
            types=sum(part.package != "" for part in parts),
            constants=len(message.constants),
            fields=len(message.fields),
            leaves=known.fixed + known.dynamic,
            fixed_leaves=known.fixed,
            dynamic_leaves=known.dynamic,
            min_bytes=min_bytes,
            max_bytes=max_bytes,
            aligned=aligned,
            padded=padded,
            shifting=shifting,
            features=tuple(name for name in FEATURES if name in known.features),
            definition_bytes=len(message.text.encode()),
            unsized=wrong[0].message if wrong else "",
        )

    def _sizes(self, message: Message) -> tuple[int | None, ...]:
        known, header = self._types[message], self._rules.header_bytes
        largest = None if known.max_bytes is None else header + known.max_bytes[0]
        return header + known.min_bytes[0], largest, *self._paddings(message)

    # The attributes of a type are computed after those of its parts.

    def _analyse(self, message: Message) -> _Type:
        kinds = [item.type for item in message.fields]
        parts = {child: self._types[child].features for child in message.children}
        self._alignment.after(message, rs.ALL)
        shortest = [self._size_all(kinds, r, False) for r in _RESIDUES]
        longest = [self._size_all(kinds, r, True) for r in _RESIDUES]
        leaves = [self._leaves(kind) for kind in kinds] or [(1, 0)]
        return _Type(
            min_bytes=[size for size in shortest if size is not None],
            max_bytes=[size for size in longest if size is not None] or None,
            fixed=sum(fixed for fixed, _ in leaves),
            dynamic=sum(dynamic for _, dynamic in leaves),
            features=features_of(message, parts),
        )

    def _leaves(self, kind: FieldType) -> tuple[int, int]:
        match kind:
            case Primitive():
                return 1, 0
            case String():
                return 0, 1
            case Message():
                return self._types[kind].fixed, self._types[kind].dynamic
            case Array(element=element):
                return self._leaves(element)
            case Sequence(element=element):
                return 0, sum(self._leaves(element))

    # Sizes.

    def _size_all(self, kinds: list[FieldType], start: int, longest: bool) -> int | None:
        at = start
        for kind in kinds:
            size = self._size(kind, at % rs.MODULUS, longest)
            if size is None:
                return None
            at += size
        if not kinds and self._rules.empty_member is not None:
            at += 1
        return at - start

    def _size(self, kind: FieldType, start: int, longest: bool) -> int | None:
        """Return the bytes of the shortest or of the longest value, padding before it included."""
        match kind:
            case Primitive():
                return -start % self._alignment.of(kind) + kind.bytes
            case Message():
                attributes = self._types[kind]
                sizes = attributes.max_bytes if longest else attributes.min_bytes
                return None if sizes is None else sizes[start]
            case String(bound=bound, wide=wide):
                if longest and bound is None:
                    return None
                units = bound or 0 if longest else 0
                nul = self._rules.terminated and not wide
                return self._prefix(start) + units * (4 if wide else 1) + nul
            case Array(element=element, count=count):
                return self._repeated(element, start, count, longest)
            case Sequence(element=element, bound=bound):
                if longest and bound is None:
                    return None
                prefix = self._prefix(start)
                count = bound or 0 if longest else 0
                at = (start + prefix) % rs.MODULUS
                size = self._repeated(element, at, count, longest)
                return None if size is None else prefix + size

    def _prefix(self, start: int) -> int:
        return -start % self._alignment.of(LENGTH) + LENGTH.bytes

    def _repeated(self, kind: FieldType, start: int, count: int, longest: bool) -> int | None:
        """Add up the sizes of elements; compute few of them, because starts recur modulo 8."""
        seen: dict[int, tuple[int, int]] = {}
        at, done = start, 0
        while done < count:
            residue = at % rs.MODULUS
            if residue in seen:
                before, at_before = seen[residue]
                rounds = (count - done) // (done - before)
                at += rounds * (at - at_before)
                done += rounds * (done - before)
                seen.clear()
                continue
            seen[residue] = done, at
            size = self._size(kind, residue, longest)
            if size is None:
                return None
            at += size
            done += 1
        return at - start

    # Padding.

    def _paddings(self, message: Message) -> _Counts:
        root = (message, rs.single(0))
        stack = [root]
        while stack:
            key = stack[-1]
            if key in self._places:
                stack.pop()
                continue
            counts, parts = self._direct_places(key)
            missing = [part for part in parts if part not in self._places]
            stack += missing
            if not missing:
                for part in parts:
                    counts = [a + b for a, b in zip(counts, self._places[part], strict=True)]
                self._places[stack.pop()] = counts[0], counts[1], counts[2]
        return self._places[root]

    def _direct_places(self, key: _Key) -> tuple[list[int], list[_Key]]:
        """Count the values of a type except its message fields; list those fields and starts."""
        message, at = key
        counts = [0, 0, 0]
        parts: list[_Key] = []

        def place(primitive: Primitive, at: int) -> None:
            pad = self._alignment.pad(primitive, at)
            counts[2 if pad is None else 1 if pad else 0] += 1

        for item in message.fields:
            kind, now = item.type, at
            if isinstance(kind, String | Sequence):
                place(LENGTH, now)
            if isinstance(kind, Array | Sequence):
                now = self._alignment.entry(kind, now)
            match item.element_type:
                case Message() as part:
                    parts.append((part, now))
                case Primitive() as number:
                    place(number, now)
                case String() if not isinstance(kind, String):
                    place(LENGTH, now)
            at = self._alignment.after(kind, at)
        if not message.fields and self._rules.empty_member is not None:
            place(OCTET, at)
        return counts, parts


_COLUMNS = tuple(item.name for item in fields(Metrics))

# Columns of the table with their headings. The table does not have all figures.
_HEADINGS = {
    "name": "name",
    "depth": "depth",
    "types": "types",
    "leaves": "leaves",
    "fixed_leaves": "fixed",
    "dynamic_leaves": "dynamic",
    "min_bytes": "min",
    "max_bytes": "max",
    "aligned": "aligned",
    "padded": "padded",
    "shifting": "shifting",
    "features": "features",
}


def report(rows: Iterable[Metrics], form: str) -> str:
    """Write figures in one of the formats.

    * `form`: a key of `FORMATS`.
    """
    return FORMATS[form](list(rows))


def _table(rows: list[Metrics]) -> str:
    lines = [[*_HEADINGS.values()], *([_cell(row, name) for name in _HEADINGS] for row in rows)]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    text = ""
    for line in lines:
        cells = [
            cell.ljust(width) if name in ("name", "features") else cell.rjust(width)
            for name, cell, width in zip(_HEADINGS, line, widths, strict=True)
        ]
        text += "  ".join(cells).rstrip() + "\n"
    unsized = (f"{row.name} has no sizes: {row.unsized}\n" for row in rows if row.unsized)
    return text + "".join(unsized)


def _cell(row: Metrics, name: str) -> str:
    value = getattr(row, name)
    if isinstance(value, tuple):
        return ",".join(value) or "-"
    return "-" if value is None else str(value)


def _csv(rows: list[Metrics]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(_COLUMNS)
    for row in rows:
        values = asdict(row) | {"features": " ".join(row.features)}
        # `None` gives an empty cell: the type has no maximum, or no size at all.
        writer.writerow([values[name] for name in _COLUMNS])
    return text.getvalue()


def _json(rows: list[Metrics]) -> str:
    return json.dumps([asdict(row) for row in rows], indent=2) + "\n"


FORMATS: dict[str, Callable[[list[Metrics]], str]] = {"table": _table, "csv": _csv, "json": _json}
"""The writers of figures, by format."""


def metrics_text(
    library: Library,
    names: Iterable[str],
    form: str,
    wire: Wire | None,
) -> tuple[str, DefinitionError | None]:
    """Write the figures of types. A service or an action gives the figures of its messages.

    * `form`: a key of `FORMATS`.
    * `wire`: `None` is the wire format of the library's dialect.

    Returns the text, and the errors of the types that are not in it.
    """
    analyses = Analyses(wire or WIRE_OF[library.dialect])
    rows: dict[str, Metrics] = {}

    def analyse(interface: Interface) -> None:
        for message in interface.messages:
            if message.name not in rows:
                rows[message.name] = analyses.metrics(message)

    _, wrong = of_each(library, names, analyse)
    return report(rows.values(), form), wrong
