"""Plain values: the common form of messages in which all client libraries are compared.

A plain value says exactly what a packet contains, independent of any library's types:

=====================  ============================================================
message                `dict`, by the fields' ROS names in order; empty if it has none
integer                `int`, signed as the model says
``bool``               `bool`
float                  `int`: the bits. So NaN payloads, signalling NaN and -0 survive
``string``             `bytes`, without the NUL of CDR; they need not be UTF-8
``wstring``            `list` of `int`, its UTF-16 units
array, sequence        `list`
=====================  ============================================================

Two messages are the same if their plain values are equal. In JSON, a string is text whose
characters are its bytes (Latin-1). :func:`packed` is a form without names for programs that know
the type.
"""

from __future__ import annotations

import keyword
import struct
from collections.abc import Callable, Iterator
from typing import Any, TypeAlias

import numpy as np

from firm_hdl.cases.wide_oracle import WIDE_MEMBER, fit_units
from firm_hdl.model import Array, FieldType, Message, Primitive, Sequence, String

__all__ = [
    "Change",
    "Plain",
    "as_float",
    "bits_of",
    "changed",
    "from_json",
    "from_objects",
    "is_nan",
    "packed",
    "shown",
    "to_numbers",
    "unpacked",
]

Plain: TypeAlias = "Any"
"""A value in the form that this module describes."""

Change: TypeAlias = "Callable[[FieldType, Plain], Plain]"
"""A function that returns the replacement of a value of a type."""

_FLOATS = {4: ("<I", "<f"), 8: ("<Q", "<d")}
_CODES = {(1, False): "B", (2, False): "H", (4, False): "I", (8, False): "Q"}
_CODES |= {(size, True): code.lower() for (size, _), code in _CODES.items()}
# rosbags has the names of ROS 2 for the members of ROS 1's time and duration. On purpose not those
# of `firm_hdl.sim.values`, which makes the transfers that references judge.
_ALIASES = {"secs": "sec", "nsecs": "nanosec"}


def bits_of(number: float, size: int) -> int:
    """Return the bits of a Python float as a float of `size` bytes.

    Raises `OverflowError` if the number is too large for that size.
    """
    bits, code = _FLOATS[size]
    return int(struct.unpack(bits, struct.pack(code, number))[0])


def as_float(bits: int, size: int) -> float:
    """Return the Python float of some bits. A signalling NaN of 4 bytes becomes a quiet one."""
    code, number = _FLOATS[size]
    return float(struct.unpack(number, struct.pack(code, bits))[0])


def is_nan(bits: int, size: int) -> bool:
    """Return whether some bits are a NaN."""
    fraction = 23 if size == 4 else 52
    exponent = (1 << 8 * size - 1) - (1 << fraction)
    return bits & exponent == exponent and bool(bits & ((1 << fraction) - 1))


def from_objects(kind: FieldType, value: Any) -> Plain:
    """Return the plain value of rosbags' form of a value: objects, NumPy arrays and texts."""
    match kind:
        case Message():
            return {
                item.name: from_objects(item.type, _member(value, item.name))
                for item in kind.fields
            }
        case String(wide=False):
            return value.encode("utf-8", "surrogateescape")
        case String():
            # A wide text is an object with the numbers of its units in it.
            return list(fit_units(getattr(value, WIDE_MEMBER)).tolist())
        case Primitive():
            return _plain_number(kind, value)
        case Array(element=Primitive() as item) | Sequence(element=Primitive() as item):
            if item.kind == "float" and value.dtype == f"float{8 * item.bytes}":
                return value.view(f"u{item.bytes}").tolist()
            return [_plain_number(item, each) for each in value.tolist()]
        case Array() | Sequence():
            return [from_objects(kind.element, each) for each in value]


def _member(value: Any, name: str) -> Any:
    for spelling in (name, _ALIASES.get(name, name), name + "_"):
        if hasattr(value, spelling) and not (keyword.iskeyword(name) and spelling == name):
            return getattr(value, spelling)
    raise ValueError(f"{type(value).__name__} has no {name}")


def _plain_number(kind: Primitive, value: Any) -> int:
    if kind.kind == "bool":
        return bool(value)
    if kind.kind == "float":
        return bits_of(float(value), kind.bytes)
    bits = int(value) & ((1 << 8 * kind.bytes) - 1)
    sign = 1 << (8 * kind.bytes - 1) if kind.signed else 0
    return (bits ^ sign) - sign


def from_json(value: Any) -> Plain:
    """Return the plain value that the `json` module has read."""
    match value:
        case str():
            return value.encode("latin-1")
        case dict():
            return {name: from_json(each) for name, each in value.items()}
        case list():
            return [from_json(each) for each in value]
        case _:
            return value


def changed(kind: FieldType, value: Plain, change: Change) -> Plain:
    """Return a value with `change` applied to each part: to a whole first, and then to its parts.

    Fields that `change` removes from a message are not visited.
    """
    value = change(kind, value)
    match kind:
        case Message():
            kept = [item for item in kind.fields if item.name in value]
            return {item.name: changed(item.type, value[item.name], change) for item in kept}
        case Array(element=element) | Sequence(element=element):
            return [changed(element, each, change) for each in value]
        case _:
            return value


def to_numbers(kind: FieldType, value: Plain) -> Any:
    """Return a plain value in the form that :func:`firm_hdl.sim.values.to_transfers` takes."""
    match kind:
        case Message():
            return {item.name: to_numbers(item.type, value[item.name]) for item in kind.fields}
        case Primitive(kind="float", bytes=size):
            # A NumPy scalar, because it keeps the bits.
            return np.array([value], f"u{size}").view(f"f{size}")[0]
        case (
            Array(element=Primitive(kind="float", bytes=size))
            | Sequence(element=Primitive(kind="float", bytes=size))
        ):
            return np.array(value, f"u{size}").view(f"f{size}")
        case Array(element=Message() as element) | Sequence(element=Message() as element):
            return [to_numbers(element, each) for each in value]
        case _:
            return value


def packed(kind: FieldType, value: Plain) -> bytes:
    """Write a plain value without names, padding and headers, all numbers little-endian.

    A number has its own size. A text has its length in 4 bytes, and then its bytes; a wide text has
    units of 4 bytes each. A sequence has its length in 4 bytes, and then its elements. An array has
    its elements, and a message has its fields.
    """
    parts: list[bytes] = []
    _pack(kind, value, parts)
    return b"".join(parts)


def _pack(kind: FieldType, value: Plain, parts: list[bytes]) -> None:
    match kind:
        case Message():
            for item in kind.fields:
                _pack(item.type, value[item.name], parts)
        case Primitive():
            parts.append(struct.pack("<" + _code(kind), value))
        case String(wide=wide):
            count = struct.pack("<I", len(value))
            parts.append(count + (struct.pack(f"<{len(value)}I", *value) if wide else value))
        case Array(element=element) | Sequence(element=element):
            if isinstance(kind, Sequence):
                parts.append(struct.pack("<I", len(value)))
            if isinstance(element, Primitive):
                parts.append(struct.pack(f"<{len(value)}{_code(element)}", *value))
            else:
                for each in value:
                    _pack(element, each, parts)


def unpacked(kind: FieldType, data: bytes) -> Plain:
    """Read what :func:`packed` writes.

    Raises `ValueError` if the data is too short or too long.
    """
    reader = _Reader(data)
    try:
        value = reader.read(kind)
    except (struct.error, IndexError):
        raise ValueError("A packed value is too short") from None
    if reader.at != len(data):
        raise ValueError("A packed value is too long")
    return value


class _Reader:
    def __init__(self, data: bytes):
        self.data = data
        self.at = 0

    def numbers(self, count: int, code: str, size: int) -> list[Any]:
        numbers = struct.unpack_from(f"<{count}{code}", self.data, self.at)
        self.at += count * size
        return list(numbers)

    def read(self, kind: FieldType) -> Plain:
        match kind:
            case Message():
                return {item.name: self.read(item.type) for item in kind.fields}
            case Primitive():
                return self.numbers(1, _code(kind), kind.bytes)[0]
            case String(wide=wide):
                (count,) = self.numbers(1, "I", 4)
                if wide:
                    return self.numbers(count, "I", 4)
                self.at += count
                if self.at > len(self.data):
                    raise IndexError
                return self.data[self.at - count : self.at]
            case Array(element=element) | Sequence(element=element):
                count = kind.count if isinstance(kind, Array) else self.numbers(1, "I", 4)[0]
                if isinstance(element, Primitive):
                    return self.numbers(count, _code(element), element.bytes)
                return [self.read(element) for _ in range(count)]


def _code(kind: Primitive) -> str:
    """Return the code of a number in `struct`; for a float, the code of its bits."""
    if kind.kind == "bool":
        return "?"
    return _CODES[kind.bytes, kind.signed and kind.kind == "int"]


def shown(kind: FieldType, value: Plain) -> str:
    """Return a plain value as text for people. Floats are numbers; NaNs also have their bits."""
    return ", ".join(_lines(kind, value))


def _lines(kind: FieldType, value: Plain) -> Iterator[str]:
    if isinstance(kind, Message):
        for item in kind.fields:
            yield f"{item.name}: {_shown(item.type, value[item.name])}"
    else:
        yield _shown(kind, value)


def _shown(kind: FieldType, value: Plain) -> str:
    match kind:
        case Message():
            return "{" + ", ".join(_lines(kind, value)) + "}"
        case Array(element=element) | Sequence(element=element):
            return "[" + ", ".join(_shown(element, each) for each in value) + "]"
        case Primitive(kind="float", bytes=size):
            text = repr(as_float(value, size))
            return f"{text} (0x{value:0{2 * size}x})" if is_nan(value, size) else text
        case String(wide=False):
            return repr(value)[1:] if value.isascii() else repr(value)
        case _:
            return repr(value)
