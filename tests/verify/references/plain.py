"""Plain values from Python values."""

from __future__ import annotations

from typing import Any

from firm_hdl.cases.values import Plain, bits_of
from firm_hdl.model import FieldType, Message, Primitive, String

__all__ = ["plain"]


def plain(kind: FieldType, value: Any) -> Plain:
    """Turn a value into a plain one: floats into bits, texts into bytes or units."""
    match kind:
        case Message():
            return {item.name: plain(item.type, value[item.name]) for item in kind.fields}
        case String(wide=True):
            units = value.encode("utf-16-le")
            return [int.from_bytes(units[n : n + 2], "little") for n in range(0, len(units), 2)]
        case String():
            return value.encode()
        case Primitive():
            return bits_of(value, kind.bytes) if kind.kind == "float" else value
        case _:
            return [plain(kind.element, each) for each in value]
