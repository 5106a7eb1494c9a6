"""Records of streams for both languages: VHDL has them as records, SystemVerilog as structs.

A record has a stem, such as ``twist``. Each language declares ``twist_t`` with data and valid of
the members, ``twist_ready_t`` with ready in the opposite direction, and two constants:
``TWIST_IDLE``, which offers no transfer, and ``TWIST_ALL_READY``, which takes every transfer.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from firm_hdl.export.primitives import FORMS, PRIMITIVE_BYTES, TEXTS
from firm_hdl.export.remarks import origin, quoted, remark
from firm_hdl.export.tree import Node, Package
from firm_hdl.plan import Plan

__all__ = ["Member", "Record", "head_of", "message_records", "shared_records"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Member:
    """A member of a record."""

    name: str
    stem: str  # Stem of its type.
    is_leaf: bool = False  # Whether the member is a stream, so that its ready is a single bit.
    # The other message type's package that declares the type; empty if there is no such package.
    package: str = ""
    comment: str = ""  # The comment of the definition.
    remark: str = ""  # Text for a comment after the member.


@dataclass(frozen=True, slots=True, kw_only=True)
class Record:
    """A record of streams."""

    stem: str
    members: tuple[Member, ...]


_LENGTH = Member(name="length", stem="uint32_stream", is_leaf=True, remark="number of elements")


def shared_records() -> Iterator[Record]:
    """Yield the records that the package of a bus width declares, each after those it contains."""
    for text, primitive in TEXTS.items():
        yield Record(stem=f"{text}_stream", members=(_LENGTH, _items(primitive)))
    for primitive in PRIMITIVE_BYTES:
        yield from _sequence_and_array(primitive, _items(primitive), suffix="_stream")
    for text in TEXTS:
        item = Member(name="item", stem=f"{text}_stream")
        yield from _sequence_and_array(text, item, suffix="_stream")


def message_records(package: Package) -> list[Record]:
    """List the records of a message type: of a message, a sequence and an array of messages."""
    members = tuple(_member(child, package) for child in package.node.children)
    item = Member(name="item", stem=package.base)
    return [
        Record(stem=package.base, members=members),
        *_sequence_and_array(package.base, item),
    ]


def _sequence_and_array(stem: str, item: Member, *, suffix: str = "") -> Iterator[Record]:
    for form in FORMS:
        members = (_LENGTH, item) if form == "sequence" else (item,)
        yield Record(stem=f"{stem}_{form}{suffix}", members=members)


def _items(primitive: str) -> Member:
    return Member(name="items", stem=f"{primitive}_items_stream", is_leaf=True)


def _member(node: Node, package: Package) -> Member:
    # Write the package's name: with use clauses, equal names in two packages hide each other.
    foreign = node.package != package.name
    return Member(
        name=node.name,
        stem=node.type.removesuffix("_t"),
        is_leaf=node.leaf is not None,
        package=node.package if foreign else "",
        comment=node.source.comment if node.source is not None else "",
        remark=origin(node.source, node.name) if node.source is not None else "",
    )


def head_of(package: Package, plan: Plan, *, what: str, advice: str, mark: str) -> Iterator[str]:
    """Yield the comment at the head of a message type's package.

    * `what`: name of records in the language.
    * `advice`: end of the sentence that says that all converters share the file.
    * `mark`: the comment mark of the language.
    """
    base, message = package.base, package.message
    yield from remark(
        f"{what} of {message.name}: {base}_t has data and valid of every field, {base}_ready_t "
        f"has ready, in the opposite direction. {base.upper()}_ALL_READY takes every transfer; "
        f"{base.upper()}_IDLE offers none.",
        "",
        mark,
    )
    yield from remark(
        f"Made by firm-hdl. All converters with wire {plan.wire} and a bus of "
        f"{plan.bus_bytes} bytes share this file{advice}.",
        "",
        mark,
    )
    if message.comment:
        yield f"{mark}\n"
        yield from quoted(message.comment, "", mark)
