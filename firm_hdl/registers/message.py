"""A message as registers: its fields of fixed size as a block of words, laid out as a struct of C.

A value of n bytes is at a multiple of n bytes, and the lowest byte comes first. So a processor
copies words, and has the struct. What has no fixed size, such as a string, is left out.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from amaranth.lib import data

from firm_hdl.gateware.record_layout import record_layout
from firm_hdl.model import Array, FieldType, Message, Primitive
from firm_hdl.names.identifiers import first_free, identifier
from firm_hdl.plan import Direction, Plan
from firm_hdl.registers.head import (
    BODY_ADDRESS,
    LATCHED,
    bits,
    control_register,
    identity_registers,
    interrupt_registers,
    word,
)
from firm_hdl.registers.table import WORD_BYTES, Field, Kind, Register, RegisterMap

__all__ = ["MAX_BYTES", "Item", "MessageMap", "message_map"]

MAX_BYTES = 4096
"""Largest block of a message. Each of its bits is a register, and is read through a multiplexer."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Item:
    """A value of the message.

    Attributes
    ----------
    path : tuple of str and int
        Names of fields and indexes of arrays.
    type : Primitive
    address : int
        In bytes from the begin of the block.
    bit : int
        Its lowest bit in the record of :func:`.record_layout`.
    """

    path: tuple[str | int, ...]
    type: Primitive
    address: int
    bit: int


@dataclass(frozen=True, slots=True, kw_only=True)
class MessageMap:
    """The registers of a message type."""

    name: str  # Of the type, as a word of C; the same for both directions.
    message: Message
    direction: Direction  # `deserializer`: software reads messages that come.
    items: tuple[Item, ...]
    shape: data.StructLayout  # The record, with the fields that the registers have.
    size: int  # Bytes of the block, and of the struct.
    # By the name of a field of the table: the bits of the record that it has.
    pieces: dict[str, tuple[int, int]]
    table: RegisterMap


def message_map(message: Message, plan: Plan, direction: Direction) -> MessageMap:
    """Lay out the registers of a message type.

    The table has the name of the type, with ``_rx`` if software reads messages, else ``_tx``.

    Raises `ValueError` if the message has no fields of fixed size, or more than 4,096 bytes of
    them.
    """
    shape = record_layout(message, wire=plan.wire)
    size, _ = size_of(message, shape)
    if size > MAX_BYTES:
        raise ValueError(
            f"Fields of fixed size of {message.name} take {size} bytes, and registers have at most "
            f"{MAX_BYTES}"
        )
    items = tuple(_items(message, shape, (), 0, 0))
    if not items:
        raise ValueError(f"Message {message.name} has no values for registers")
    words, pieces = _words(items, direction, -(-size // WORD_BYTES))
    lines = [f"{message.name} {plan.wire} {direction} {size}"]
    lines += [f"{item.path} {item.type} {item.address}" for item in items]
    digest = hashlib.sha256("\n".join(lines).encode()).digest()
    common = _common(direction, int.from_bytes(digest[:8], "little"))
    what = {
        "deserializer": "messages that come as packets, for software to read",
        "serializer": "messages that software writes, and that leave as packets",
    }[direction]
    name = identifier(message.name)
    end = {"deserializer": "rx", "serializer": "tx"}[direction]
    table = RegisterMap(
        name=f"{name}_{end}", registers=(*common, *words), meaning=f"{message.name}: {what}."
    )
    return MessageMap(
        name=name,
        message=message,
        direction=direction,
        items=items,
        shape=shape,
        size=size,
        pieces=pieces,
        table=table,
    )


def size_of(kind: FieldType, shape: Any) -> tuple[int, int]:
    """Return bytes and alignment of a value in C; 0 and 1 of a message without values."""
    match kind:
        case Primitive(bytes=count):
            return count, count
        case Array(element=element, count=count):
            size, alignment = size_of(element, shape.elem_shape)
            return size * count, alignment
        case Message():
            end, most = 0, 1
            for _, inner, part in members_of(kind, shape):
                size, alignment = size_of(inner, part)
                end = -(-end // alignment) * alignment + size
                most = max(most, alignment)
            return -(-end // most) * most, most
    raise AssertionError(kind)


def members_of(message: Message, shape: Any) -> Iterator[tuple[str, FieldType, Any]]:
    """Yield name, type and shape of the members that the registers have, in order."""
    kinds: dict[str, FieldType] = {field.name: field.type for field in message.fields}
    for name, part in shape.members.items():
        # A message without fields has a byte or a trigger, which software does not need.
        if name in kinds and _has_values(kinds[name], part):
            yield name, kinds[name], part


def _has_values(kind: FieldType, shape: Any) -> bool:
    if isinstance(kind, Array):
        return _has_values(kind.element, shape.elem_shape)
    if isinstance(kind, Message):
        return any(True for _ in members_of(kind, shape))
    return True


def _items(
    kind: FieldType, shape: Any, path: tuple[str | int, ...], address: int, bit: int
) -> Iterator[Item]:
    match kind:
        case Primitive():
            yield Item(path=path, type=kind, address=address, bit=bit)
        case Array(element=element, count=count):
            size, _ = size_of(element, shape.elem_shape)
            for index in range(count if size else 0):
                here = bit + shape[index].offset
                place = address + size * index
                yield from _items(element, shape.elem_shape, (*path, index), place, here)
        case Message():
            for name, inner, part in members_of(kind, shape):
                size, alignment = size_of(inner, part)
                address = -(-address // alignment) * alignment
                here = bit + shape[name].offset
                yield from _items(inner, part, (*path, name), address, here)
                address += size


def _words(
    items: tuple[Item, ...], direction: Direction, count: int
) -> tuple[list[Register], dict[str, tuple[int, int]]]:
    """Return the registers of the block, and the bits of the record that each field has."""
    kind: Kind = "setting" if direction == "serializer" else "status"
    # No name may be that of a half of another one, or of a word.
    taken: set[str] = set()
    # By word: name, lowest bit in the word, and bits of the record.
    found: dict[int, list[tuple[str, int, int, int, str]]] = {}
    for run in _runs(items):
        item, end = run[0], f"_to_{run[-1].path[-1]}" if len(run) > 1 else ""
        name = first_free(
            identifier("_".join(["message", *map(str, item.path)]) + end), taken, _with_halves
        )
        taken |= {each.lower() for each in _with_halves(name)}
        more = f" to {_dotted(run[-1])}" if len(run) > 1 else ""
        what = f"{_dotted(item)}{more}: {item.type}"
        bits = item.type.bits * len(run)
        for part in range(-(-bits // 32)):
            half = f"{name}_{('low', 'high')[part]}" if bits > 32 else name
            word, byte = divmod(item.address + WORD_BYTES * part, WORD_BYTES)
            place = (half, 8 * byte, item.bit + 32 * part, min(bits, 32), what)
            found.setdefault(word, []).append(place)
    registers, pieces = [], {}
    unused: Kind = "unused" if direction == "serializer" else "constant"
    padding = Field(name="padding", low=0, bits=32, kind=unused, meaning="No value has it.")
    for word in range(count):
        places = found.get(word, [])
        alone = places[0][0] if len(places) == 1 else first_free(f"message_word_{word}", taken)
        taken.add(alone.lower())
        fields = [] if places else [padding]
        for name, low, bit, bits, what in places:
            full = name if len(places) == 1 else f"{alone}_{name}"
            pieces[full] = (bit, bits)
            fields.append(Field(name=name, low=low, bits=bits, kind=kind, meaning=f"{what}."))
        registers.append(
            Register(
                name=alone,
                address=BODY_ADDRESS + WORD_BYTES * word,
                fields=tuple(fields),
                meaning=fields[0].meaning if len(fields) == 1 else "Several values.",
            )
        )
    return registers, pieces


def _runs(items: tuple[Item, ...]) -> Iterator[list[Item]]:
    """Join the elements of an array that share a word, without gaps: thousands of bytes are many.

    A single one is a list of its own.
    """
    run: list[Item] = []
    for item in items:
        if run and not _continues(run[-1], item):
            yield run
            run = []
        run.append(item)
    yield run


def _continues(before: Item, item: Item) -> bool:
    return (
        isinstance(item.path[-1], int)
        and before.path[:-1] == item.path[:-1]
        and item.type.bits == 8 * item.type.bytes
        and item.bit == before.bit + item.type.bits
        and item.address % WORD_BYTES != 0
    )


def _with_halves(name: str) -> tuple[str, ...]:
    return name, f"{name}_low", f"{name}_high"


def _dotted(item: Item) -> str:
    parts = [f"[{part}]" if isinstance(part, int) else f".{part}" for part in item.path]
    return "".join(parts).removeprefix(".")


def _common(direction: Direction, fingerprint: int) -> tuple[Register, ...]:
    """Return the registers before the message."""
    comes = direction == "deserializer"
    event, error = ("A good message came.", "A packet had an error.")
    skipped = "Good messages that a newer one replaced before a commit."
    commit = "Show the newest message in the words."
    state = [
        bits("status", "new", 0, 1, "A good message came after the last commit."),
        bits("status", "shown", 1, 1, "The words are a message."),
    ]
    if not comes:
        event, skipped = "A message was sent.", "Commits while busy, which did nothing."
        commit = "Send the words as a message, unless the one before is still busy."
        taken = "The serializer takes the message of the last commit."
        state = [bits("status", "busy", 0, 1, taken)]
    good = "Good messages" if comes else "Messages sent"
    return (
        *identity_registers(fingerprint, "Of type, wire format, direction and layout."),
        control_register(
            bits("pulse", "commit", 0, 1, commit),
            reset="Reset all registers; cuts no packet.",
        ),
        Register(
            name="status",
            address=0x14,
            meaning="The state of the converter.",
            fields=(*state, bits("status", "code", 8, 8, "Status of the last packet; 0 is OK.")),
        ),
        *interrupt_registers(event, error),
        word(0x20, "messages", "status", f"{good}.{LATCHED}"),
        word(0x24, "errors", "status", f"Packets with an error.{LATCHED}"),
        word(0x28, "skipped", "status", f"{skipped}{LATCHED}"),
    )
