"""Layout: a message on a wire, field by field, with the statically known part of its offsets.

The layout is a tree in wire order. Each node has a :class:`Gap`, the padding before it.
:mod:`firm_hdl.wire.alignment` finds the possible sizes of a gap by abstract interpretation. If
there is only one, the gap has this number of bytes. Otherwise the circuit must pad to the alignment
at run time.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import TypeAlias

from firm_hdl.errors import DefinitionError
from firm_hdl.model import (
    PRIMITIVES,
    Array,
    Field,
    FieldType,
    Message,
    Primitive,
    Sequence,
    String,
    Wire,
)
from firm_hdl.wire import residues as rs
from firm_hdl.wire.alignment import LENGTH, OCTET, Alignment
from firm_hdl.wire.refusals import refusals
from firm_hdl.wire.rules import RULES, WireRules

__all__ = [
    "ConstantLength",
    "Gap",
    "Layout",
    "LengthField",
    "LoopNode",
    "Node",
    "Path",
    "RunNode",
    "Scalar",
    "Trigger",
    "lay_out",
    "walk",
]

Path: TypeAlias = "tuple[str, ...]"


@dataclass(frozen=True, slots=True, kw_only=True)
class Gap:
    """Padding before a value that starts at a multiple of `align` bytes."""

    align: int  # 1, 2, 4 or 8.
    bytes: int | None  # Size of the padding if it is the same in every packet, else `None`.


@dataclass(frozen=True, slots=True, kw_only=True)
class Scalar:
    """One primitive."""

    path: Path
    gap: Gap
    type: Primitive


@dataclass(frozen=True, slots=True, kw_only=True)
class Trigger:
    """A message without fields and without bytes."""

    path: Path


@dataclass(frozen=True, slots=True, kw_only=True)
class LengthField:
    """The length of a string or a sequence: a number on the wire, before the items."""

    gap: Gap  # Padding before the number.
    bound: int | None  # Largest number of items, if the type bounds it.


@dataclass(frozen=True, slots=True, kw_only=True)
class ConstantLength:
    """The length of an array: the type fixes the number of items, which is not on the wire."""

    count: int


Length: TypeAlias = "LengthField | ConstantLength"


@dataclass(frozen=True, slots=True, kw_only=True)
class RunNode:
    """Primitives in a row: a string, or an array or a sequence of primitives."""

    path: Path
    length: Length
    item_gap: Gap  # Padding before the first item. An empty run does not have it (CDR).
    item: Primitive
    terminated: bool  # Whether a NUL follows the items. The length on the wire counts the NUL.


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopNode:
    """Elements in a row that are not primitives."""

    path: Path
    length: Length
    body: tuple[Node, ...]  # One element, laid out for all offsets where any element may start.
    min_body_bytes: int  # Lower bound of the size of an element in bytes, without padding.
    # Size of the shortest element after another shortest one in bytes, with padding.
    repeated_bytes: int


Node: TypeAlias = "Scalar | Trigger | RunNode | LoopNode"


@dataclass(frozen=True, kw_only=True)
class Layout:
    """A message type on a wire."""

    message: Message
    rules: WireRules
    # Everything after the encapsulation header, with nested messages written out.
    nodes: tuple[Node, ...]
    least_bytes: int  # Lower bound of the size of a packet in bytes, header included.


def lay_out(message: Message, wire: Wire | None = None) -> Layout:
    """Lay a message out on a wire (by default that of its dialect).

    Raises `DefinitionError` if a field of the message, or of a message in it, has no wire format
    (`refusals`). Raises `ValueError` if `wire` is not the name of a wire format. Raises `TypeError`
    if `message` is not a Message.
    """
    if not isinstance(message, Message):
        raise TypeError(f"Message must be a Message, as load_message gives it, not {message!r}")
    if wire is not None and wire not in RULES:
        raise ValueError(f"Wire must be one of {', '.join(map(repr, RULES))}, not {wire!r}")
    if wrong := refusals(message):
        raise DefinitionError(wrong)
    rules = RULES[wire or message.wire]
    builder = _Builder(rules)
    nodes = builder.message(message, (), rs.single(0))
    return Layout(
        message=message,
        rules=rules,
        nodes=nodes,
        least_bytes=rules.header_bytes + builder.unpadded.shortest(message, 0),
    )


def walk(nodes: tuple[Node, ...]) -> Iterator[Node]:
    """Yield all nodes in wire order, a loop before its body."""
    for node in nodes:
        yield node
        if isinstance(node, LoopNode):
            yield from walk(node.body)


def _number(primitive: Primitive) -> Primitive:
    """Return the primitive on the wire: for a `wchar`, an integer of its size."""
    if primitive.name != "wchar":
        return primitive
    return PRIMITIVES["ros2"][f"uint{8 * primitive.bytes}"]


@dataclass(slots=True)
class _Builder:
    rules: WireRules
    alignment: Alignment = field(init=False)
    # Padding depends on the offset. So lower bounds of sizes are those without any.
    unpadded: Alignment = field(init=False)

    def __post_init__(self) -> None:
        self.alignment = Alignment(self.rules)
        self.unpadded = Alignment(replace(self.rules, max_align=1))

    def gap(self, primitive: Primitive, at: int) -> Gap:
        return Gap(align=self.alignment.of(primitive), bytes=self.alignment.pad(primitive, at))

    def message(self, message: Message, path: Path, at: int) -> tuple[Node, ...]:
        if not message.fields:
            if self.rules.empty_member is None:
                return (Trigger(path=path),)
            member = Field(name=self.rules.empty_member, type=OCTET)
            return self.field(member.type, (*path, member.name), at)
        nodes: list[Node] = []
        for item in message.fields:
            nodes.extend(self.field(item.type, (*path, item.name), at))
            at = self.alignment.after(item.type, at)
        return tuple(nodes)

    def field(self, kind: FieldType, path: Path, at: int) -> tuple[Node, ...]:
        match kind:
            case Primitive():
                return (Scalar(path=path, gap=self.gap(kind, at), type=_number(kind)),)
            case Message():
                return self.message(kind, path, at)
            case String():
                return (self.text(kind, path, at),)
            case Array(element=Primitive() as item) | Sequence(element=Primitive() as item):
                return (self.run(kind, item, path, at),)
            case Array() | Sequence():
                return (self.loop(kind, path, at),)

    def text(self, kind: String, path: Path, at: int) -> RunNode:
        # wstring: each UTF-16 unit in four bytes, without a NUL, in today's ROS 2 middlewares.
        return RunNode(
            path=path,
            length=LengthField(gap=self.gap(LENGTH, at), bound=kind.bound),
            item_gap=Gap(align=1, bytes=0),
            item=LENGTH if kind.wide else OCTET,
            terminated=self.rules.terminated and not kind.wide,
        )

    def length(self, kind: Array | Sequence, at: int) -> Length:
        if isinstance(kind, Array):
            return ConstantLength(count=kind.count)
        return LengthField(gap=self.gap(LENGTH, at), bound=kind.bound)

    def run(self, kind: Array | Sequence, item: Primitive, path: Path, at: int) -> RunNode:
        return RunNode(
            path=path,
            length=self.length(kind, at),
            item_gap=self.gap(item, self.alignment.entry(kind, at)),
            item=_number(item),
            terminated=False,
        )

    def loop(self, kind: Array | Sequence, path: Path, at: int) -> LoopNode:
        return LoopNode(
            path=path,
            length=self.length(kind, at),
            body=self.field(kind.element, (*path, "item"), self.alignment.entry(kind, at)),
            min_body_bytes=self.unpadded.shortest(kind.element, 0),
            repeated_bytes=self.alignment.repeated(kind.element),
        )
