"""The type hash of ROS 2, version RIHS01.

REP 2011: SHA-256 of a type's description as JSON. The description lists the fields with their
types, and the descriptions of all referenced types, sorted by name. Default values, constants and
comments do not count. rosidl_generator_type_description is the reference (iron and later);
``type_description_interfaces/msg/FieldType`` fixes the numbers.
"""

from __future__ import annotations

import hashlib
import json
from typing import Any, TypeAlias

from firm_hdl.model import (
    EMPTY_MEMBER,
    Action,
    Array,
    FieldType,
    Interface,
    Message,
    Primitive,
    Sequence,
    Service,
    closure,
)

__all__ = ["type_description", "type_hash"]

_NESTED_TYPE = 1
_INTEGERS = ("int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64")
_TYPE_IDS = {
    **{name: number for number, name in enumerate(_INTEGERS, start=2)},
    "float32": 10,
    "float64": 11,
    "long double": 12,
    "wchar": 14,
    "bool": 15,
    "byte": 16,
}
# ``char`` of a ``.msg`` is a uint8 to rosidl, and ``char`` of an IDL is a character.
_CHAR_OF_IDL = 13
_STRING, _BOUNDED_STRING = 17, 21  # Plus one for `wstring`.
_ARRAY, _BOUNDED_SEQUENCE, _UNBOUNDED_SEQUENCE = 48, 96, 144

# The member that rosidl adds to an empty message.
_EMPTY = (EMPTY_MEMBER, "uint8")

_Member: TypeAlias = "tuple[str, FieldType | Service]"


def type_hash(interface: Interface) -> str:
    """Compute the type hash of a message, a service or an action of ROS 2.

    Returns ``RIHS01_`` and 64 hexadecimal digits.

    Raises `ValueError`: as `type_description` does.
    """
    text = json.dumps(type_description(interface))
    return f"RIHS01_{hashlib.sha256(text.encode()).hexdigest()}"


def type_description(interface: Interface) -> dict[str, Any]:
    """Describe a type in the form of ``type_description_interfaces/msg/TypeDescription``.

    Raises `ValueError` if the definition is of ROS 1, or if it is or has a service without an event
    message. Services have event messages and hashes since iron.
    """
    if interface.dialect != "ros2":
        raise ValueError(f"Only types of ROS 2 have type hashes, and {interface} is of ROS 1")
    described: dict[str, dict[str, Any]] = {}
    for message in closure(interface.messages):
        described[message.name] = _individual(message.name, _members(message))
    services = interface.services if isinstance(interface, Action) else ()
    for service in services:
        described[service.name] = _individual(service.name, _service_members(service))
    match interface:
        case Message():
            top = described.pop(interface.name)
        case Service():
            top = _individual(interface.name, _service_members(interface))
        case Action():
            top = _individual(interface.name, _action_members(interface))
    return {
        "type_description": top,
        "referenced_type_descriptions": [described[name] for name in sorted(described)],
    }


def _members(message: Message) -> list[_Member]:
    return [(field.name, field.type) for field in message.fields]


def _service_members(service: Service) -> list[_Member]:
    if service.event is None:
        raise ValueError(
            f"{service} has no type hash: services have hashes from iron on, where they have an "
            "event message, too"
        )
    return [
        ("request_message", service.request),
        ("response_message", service.response),
        ("event_message", service.event),
    ]


def _action_members(action: Action) -> list[_Member]:
    send_goal, get_result = action.services
    (feedback_message,) = action.wrappers
    return [
        ("goal", action.goal),
        ("result", action.result),
        ("feedback", action.feedback),
        ("send_goal_service", send_goal),
        ("get_result_service", get_result),
        ("feedback_message", feedback_message),
    ]


def _individual(name: str, members: list[_Member]) -> dict[str, Any]:
    fields = [{"name": member, "type": _field_type(kind)} for member, kind in members]
    if not fields:
        member, kind = _EMPTY
        fields = [{"name": member, "type": _described(_TYPE_IDS[kind])}]
    return {"type_name": name, "fields": fields}


def _field_type(kind: FieldType | Service) -> dict[str, Any]:
    match kind:
        case Array(element=element, count=count):
            return _element(element, _ARRAY, count)
        case Sequence(element=element, bound=None):
            return _element(element, _UNBOUNDED_SEQUENCE, 0)
        case Sequence(element=element, bound=int(bound)):
            return _element(element, _BOUNDED_SEQUENCE, bound)
        case _:
            return _element(kind, 0, 0)


def _element(kind: Any, offset: int, capacity: int) -> dict[str, Any]:
    match kind:
        case Primitive(name="char", signed=signed):
            return _described(offset + (_CHAR_OF_IDL if signed else _TYPE_IDS["uint8"]), capacity)
        case Primitive(name=name):
            return _described(offset + _TYPE_IDS[name], capacity)
        case Message() | Service():
            return _described(offset + _NESTED_TYPE, capacity, nested=kind.name)
        case _:
            number = (_STRING if kind.bound is None else _BOUNDED_STRING) + kind.wide
            return _described(offset + number, capacity, text=kind.bound or 0)


def _described(
    number: int, capacity: int = 0, *, text: int = 0, nested: str = ""
) -> dict[str, Any]:
    # The hash depends on the order of the keys.
    return {
        "type_id": number,
        "capacity": capacity,
        "string_capacity": text,
        "nested_type_name": nested,
    }
