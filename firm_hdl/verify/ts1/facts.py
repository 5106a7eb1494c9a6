"""Facts about a definition as plain data, so that readers of any kind can be compared.

Facts are a dictionary. Each reader gives the parts that it knows:

``structure``
    Each message that the definition declares or that is derived from the definition, by full name.
    A message has ``fields`` and ``constants``, lists in the order of the text, and a ``comment``. A
    field has a ``name``, a ``type`` as ROS 2 writes it with the full names of messages
    (``string<=8[<=3]``, ``std_msgs/msg/Header``), a ``default``, a ``comment`` and a ``unit``. A
    constant has a ``value`` instead of a default, and in ROS 1 the ``text`` of the value.
``names``
    The name that a text in IDL itself declares for its message.
``show``
    The output of ``rosmsg show`` or ``rossrv show``.
``md5``
    The md5sum of ROS 1 of each message and service, by full name.
``hash``
    The type hash of ROS 2 (RIHS01).
``proto``
    The output of ``ros2 interface proto``.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from firm_hdl.model import (
    Constant,
    Field,
    FieldType,
    Interface,
    Message,
    Value,
    element_of,
    spelled,
)

__all__ = ["Difference", "Facts", "count_facts", "differences", "structure"]

Facts: TypeAlias = "dict[str, Any]"

MOST_CHARACTERS = 300
"""The most characters of a value in a difference."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Difference:
    """One fact that differs between two readers.

    Attributes
    ----------
    path : str
        The place of the difference: ``verdict``, or a path through the facts.
    ours, theirs : str
        Our fact and the oracle's, in one line each.
    """

    path: str
    ours: str
    theirs: str

    def __str__(self) -> str:
        return f"{self.path}: firm-hdl {self.ours}; oracle {self.theirs}"


def structure(interface: Interface, alike: Mapping[str, str] | None = None) -> dict[str, Any]:
    """Describe a model.

    Parameters
    ----------
    interface : Message, Service or Action
    alike : mapping of str to str
        Primitives that the oracle cannot tell from others: their names, and those of the others.
    """
    return {each.name: _message(each, alike or {}) for each in interface.messages}


def differences(ours: Any, theirs: Any, path: str = "") -> Iterator[Difference]:
    """Yield the facts in `theirs` that differ. Facts that `theirs` lacks are not compared."""
    if isinstance(theirs, dict) and isinstance(ours, dict):
        for key, value in theirs.items():
            step = f"{path}/{key}" if path else key
            if key in ours:
                yield from differences(ours[key], value, step)
            else:
                yield Difference(path=step, ours="has none", theirs=_show(value))
    elif _is_members(ours) and _is_members(theirs):
        names = [[item["name"] for item in items] for items in (ours, theirs)]
        if names[0] != names[1]:
            yield _differ(path, *names)
            return
        for label, our, their in zip(names[0], ours, theirs, strict=True):
            yield from differences(our, their, f"{path}/{label}")
    elif not _same(ours, theirs):
        yield _differ(path, ours, theirs)


def count_facts(facts: Any) -> int:
    """Return the number of single facts. An empty list counts as one fact."""
    if isinstance(facts, dict):
        return sum(map(count_facts, facts.values()))
    if _is_members(facts):
        return max(1, sum(map(count_facts, facts)))
    return 1


def _differ(path: str, ours: Any, theirs: Any) -> Difference:
    return Difference(path=path, ours=_show(ours), theirs=_show(theirs))


def _is_members(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(item, dict) for item in value)


def _same(ours: Any, theirs: Any) -> bool:
    # Compare texts: NaN equals NaN, zeros differ by their signs, and True is not 1.
    return type(ours) is type(theirs) and repr(ours) == repr(theirs)


def _show(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= MOST_CHARACTERS else f"{text[:MOST_CHARACTERS]}..."


def _message(message: Message, alike: Mapping[str, str]) -> dict[str, Any]:
    return {
        "fields": [_field(each, alike) for each in message.fields],
        "constants": [_constant(each, alike) for each in message.constants],
        "comment": message.comment,
    }


def _field(field: Field, alike: Mapping[str, str]) -> dict[str, Any]:
    default = None if field.default is None else _value(field.default)
    return {**_member(field, alike), "default": default}


def _constant(constant: Constant, alike: Mapping[str, str]) -> dict[str, Any]:
    return {**_member(constant, alike), "value": _value(constant.value), "text": constant.text}


def _member(member: Field | Constant, alike: Mapping[str, str]) -> dict[str, Any]:
    kind = _type(member.type, alike)
    return {"name": member.name, "type": kind, "comment": member.comment, "unit": member.unit}


def _type(kind: FieldType, alike: Mapping[str, str]) -> str:
    name = str(element_of(kind))
    return spelled(kind, alike.get(name, name))


def _value(value: Value) -> Any:
    """Convert a value to one that JSON can represent."""
    if isinstance(value, tuple):
        return [_value(item) for item in value]
    return list(value) if isinstance(value, bytes) else value
