"""Facts about a definition as plain data, so that readers of any kind can be compared.

Facts are a dictionary. Each reader gives the parts that it knows:

``structure``
    Each message that the definition declares or that is derived from the definition, by full name.
    A message has ``fields`` and ``constants``, lists in the order of the text, and a ``comment``. A
    field has a ``name``, a ``type`` as ROS 2 writes it with the full names of messages
    (``string<=8[<=3]``, ``std_msgs/msg/Header``), a ``default``, a ``comment`` and a ``unit``. A
    constant has a ``value`` instead of a default, and in ROS 1 the ``text`` of the value.
``scope``
    The modules of a text in IDL around its messages.
``line ends``
    "refused" if the oracle refuses the line ends of the text.
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

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from firm_hdl.identity import md5sum, proto, type_hash
from firm_hdl.model import (
    Action,
    Constant,
    Field,
    FieldType,
    Interface,
    Message,
    Value,
    element_of,
    type_text,
)

__all__ = ["Difference", "Facts", "Said", "count_facts", "differences", "facts_of"]

Facts: TypeAlias = "dict[str, Any]"

MOST_CHARACTERS = 300
"""The most characters of a value in a difference."""


class Said(str):
    """A text that a difference shows without quotes."""

    __slots__ = ()
    __repr__ = str.__str__


@dataclass(frozen=True, slots=True, kw_only=True)
class Difference:
    """One fact that differs between two readers."""

    path: str  # The place of the difference: `verdict`, or a path through the facts.
    # Our fact and the oracle's. Lists of members are lists of their names.
    ours: Any
    theirs: Any

    def __str__(self) -> str:
        return f"{self.path}: firm-hdl {_shown(self.ours)}; oracle {_shown(self.theirs)}"


def facts_of(
    interface: Interface,
    wanted: Iterable[str],
    alike: Mapping[str, str] | None = None,
    show: Callable[[], str] = str,
) -> Facts:
    """Return facts about a model.

    * `wanted`: names of the facts. The text of an error that occurs stands for its fact.
    * `alike`: primitives that the oracle cannot tell from others: their names, and those of the
      others.
    * `show`: returns the definition as ``firm-hdl show`` prints it.
    """
    services = interface.services if isinstance(interface, Action) else ()
    makers: dict[str, Callable[[], Any]] = {
        "structure": lambda: {m.name: _message(m, alike or {}) for m in interface.messages},
        "scope": lambda: interface.name.rpartition("/")[0],
        "line ends": lambda: "accepted",
        "show": show,
        "md5": lambda: {
            each.name: md5sum(each)
            for each in (interface.messages if isinstance(interface, Action) else [interface])
        },
        "hash": lambda: {
            each.name: type_hash(each) for each in (interface, *interface.messages, *services)
        },
        "proto": lambda: proto(interface),
    }
    return {name: _made(makers[name]) for name in wanted}


def _made(make: Callable[[], Any]) -> Any:
    try:
        return make()
    except Exception as error:  # An error of our code is a difference, too.
        return f"raises {type(error).__name__}: {error}"


def differences(ours: Any, theirs: Any, path: str = "") -> Iterator[Difference]:
    """Yield the facts in `theirs` that differ. Facts that `theirs` lacks are not compared."""
    if isinstance(theirs, dict) and isinstance(ours, dict):
        for key, value in theirs.items():
            step = f"{path}/{key}" if path else key
            if key in ours:
                yield from differences(ours[key], value, step)
            else:
                yield Difference(path=step, ours=Said("has none"), theirs=value)
    elif _is_members(ours) and _is_members(theirs):
        names = [[item["name"] for item in items] for items in (ours, theirs)]
        if names[0] != names[1]:
            yield Difference(path=path, ours=names[0], theirs=names[1])
            return
        for label, our, their in zip(names[0], ours, theirs, strict=True):
            yield from differences(our, their, f"{path}/{label}")
    elif not _same(ours, theirs):
        yield Difference(path=path, ours=ours, theirs=theirs)


def count_facts(facts: Any) -> int:
    """Return the number of single facts. An empty list counts as one fact."""
    if isinstance(facts, dict):
        return sum(map(count_facts, facts.values()))
    if _is_members(facts):
        return max(1, sum(map(count_facts, facts)))
    return 1


def _is_members(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(item, dict) for item in value)


def _same(ours: Any, theirs: Any) -> bool:
    # Compare texts: NaN equals NaN, zeros differ by their signs, and True is not 1.
    return type(ours) is type(theirs) and repr(ours) == repr(theirs)


def _shown(value: Any) -> str:
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
    return type_text(kind, alike.get(name, name))


def _value(value: Value) -> Any:
    """Convert a value to one that JSON can represent."""
    if isinstance(value, tuple):
        return [_value(item) for item in value]
    return list(value) if isinstance(value, bytes) else value
