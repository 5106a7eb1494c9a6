"""Message types in the form of rosbags, to compare them with its types."""

from __future__ import annotations

from typing import Any

from rosbags.interfaces import Nodetype

from firm_hdl.model import Array, Message, Sequence, String

__all__ = ["field_descriptions"]

_BUILTINS = {"time": "builtin_interfaces/msg/Time", "duration": "builtin_interfaces/msg/Duration"}


def field_descriptions(message: Message) -> list[tuple[str, Any]]:
    """Describe a type's fields in the form of rosbags' `fielddefs`."""
    return [(item.name, _describe(item.type)) for item in message.fields]


def _name(message: Message) -> str:
    return _BUILTINS.get(message.name) or f"{message.package}/msg/{message.base_name}"


def _describe(kind: Any) -> Any:
    match kind:
        case Message():
            return Nodetype.NAME, _name(kind)
        case String():
            return Nodetype.BASE, ("wstring" if kind.wide else "string", kind.bound or 0)
        case Array():
            return Nodetype.ARRAY, (_describe(kind.element), kind.count)
        case Sequence():
            return Nodetype.SEQUENCE, (_describe(kind.element), kind.bound or 0)
    return Nodetype.BASE, (kind.name, 0)
