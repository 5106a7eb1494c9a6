"""Codecs of libraries whose messages are Python objects, and texts of definitions in ROS's syntax.

All of these libraries represent text as `str`. Bytes that are not UTF-8 become lone surrogates,
which a library refuses to write with its own error.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import replace
from itertools import count
from typing import Any

from firm_hdl.cases.values import Plain, as_float, bits_of
from firm_hdl.model import (
    Array,
    FieldType,
    Message,
    Primitive,
    Sequence,
    String,
    closure,
    element_of,
    map_messages,
    type_text,
)
from firm_hdl.verify.references.client import Codec, Refusal, UnsupportedError

__all__ = [
    "ObjectCodec",
    "definition_text",
    "first_line",
    "full_text",
    "plainly_named",
    "refuse_wide",
]


class ObjectCodec(Codec):
    """A codec of one type that converts plain values to and from objects of the library."""

    def __init__(self, message: Message):
        self.message = message

    @abstractmethod
    def write(self, value: Any) -> bytes:
        """Serialize an object. Any exception is a refusal."""

    @abstractmethod
    def read(self, packet: bytes) -> Any:
        """Deserialize a packet. Any exception is a refusal."""

    @abstractmethod
    def made(self, kind: Message, members: dict[str, Any]) -> Any:
        """Make an object of a message type."""

    def member(self, value: Any, kind: Message, name: str) -> Any:
        """Take a field from an object."""
        return getattr(value, name)

    def array(self, kind: Primitive, numbers: list[Any]) -> Any:
        """Return the library's form of an array or a sequence of numbers."""
        return [_number(kind, each) for each in numbers]

    def items(self, kind: Primitive, values: Any) -> list[Plain]:
        """Return the numbers of the library's form of an array or a sequence."""
        return [_plain_number(kind, each) for each in values]

    def encode(self, value: Plain) -> bytes:
        try:
            return self.write(self._built(self.message, value))
        # The exceptions of libraries that refuse a value have no common base class.
        except Exception as error:
            raise Refusal(first_line(error)) from None

    def decode(self, packet: bytes) -> Plain:
        try:
            return self._plain(self.message, self.read(packet))
        except Exception as error:
            raise Refusal(first_line(error)) from None

    def _built(self, kind: FieldType, value: Plain) -> Any:
        match kind:
            case Message():
                members = {
                    item.name: self._built(item.type, value[item.name]) for item in kind.fields
                }
                return self.made(kind, members)
            case String():
                return value.decode("utf-8", "surrogateescape")
            case Primitive():
                return _number(kind, value)
            case Array(element=Primitive() as item) | Sequence(element=Primitive() as item):
                return self.array(item, value)
            case Array() | Sequence():
                return [self._built(kind.element, each) for each in value]

    def _plain(self, kind: FieldType, value: Any) -> Plain:
        match kind:
            case Message():
                return {
                    item.name: self._plain(item.type, self.member(value, kind, item.name))
                    for item in kind.fields
                }
            case String():
                return value.encode("utf-8", "surrogateescape")
            case Primitive():
                return _plain_number(kind, value)
            case Array(element=Primitive() as item) | Sequence(element=Primitive() as item):
                return self.items(item, value)
            case Array() | Sequence():
                return [self._plain(kind.element, each) for each in value]


def _number(kind: Primitive, value: int) -> Any:
    return as_float(value, kind.bytes) if kind.kind == "float" else value


def _plain_number(kind: Primitive, value: Any) -> Plain:
    if kind.kind == "float":
        return bits_of(float(value), kind.bytes)
    return bool(value) if kind.kind == "bool" else int(value)


def first_line(error: Exception) -> str:
    """Return the type and the first line of a library's exception."""
    lines = str(error).strip().splitlines()
    return f"{type(error).__name__}: {lines[0][:300]}" if lines else type(error).__name__


def definition_text(message: Message) -> str:
    """Write the fields of a message type as a ``.msg`` file has them."""
    return "".join(f"{_spelled(item.type)} {item.name}\n" for item in message.fields)


def _spelled(kind: FieldType) -> str:
    inner = element_of(kind)
    if isinstance(inner, Message) and inner.package:
        return type_text(kind, f"{inner.package}/{inner.base_name}")
    return str(kind)


def plainly_named(message: Message) -> Message:
    """Return a type whose messages of services and actions have names without ``_``.

    Some parsers do not accept ``_``. Names may be changed, because packets do not contain them.
    """
    numbers = count()

    def renamed(kind: Message) -> Message:
        number = next(numbers)
        head, _, base = kind.name.rpartition("/")
        plain = base if "_" not in base else f"T{number}{base.replace('_', '')}"
        return replace(kind, name=f"{head}/{plain}" if head else base)

    return map_messages(message, renamed)


def full_text(message: Message) -> str:
    """Write the definitions of a type and of its nested types in the form that recordings have."""
    # genpy needs an empty line in a definition without fields.
    parts = [definition_text(message) or "\n"]
    for kind in closure([message])[:-1]:
        if kind.package:
            parts.append(f"MSG: {_spelled(kind)}\n" + (definition_text(kind) or "\n"))
    return ("=" * 80 + "\n").join(parts)


def refuse_wide(message: Message, library: str) -> None:
    """Refuse a type with wide text, for a library that does not support it.

    Raises `UnsupportedError`.
    """
    for kind in closure([message]):
        for item in kind.fields:
            inner = item.element_type
            if isinstance(inner, String) and inner.wide:
                raise UnsupportedError(f"{library} has no wstring")
            if isinstance(inner, Primitive) and inner.name == "wchar":
                raise UnsupportedError(f"{library} is not asked about wchar")
