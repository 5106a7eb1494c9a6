"""Messages: their fields and constants."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TypeAlias

from firm_hdl.errors import Span
from firm_hdl.model.types import (
    WIRE_OF,
    Array,
    Dialect,
    FieldType,
    Primitive,
    Sequence,
    String,
    Value,
    Wire,
    element_of,
)

__all__ = [
    "Action",
    "Constant",
    "Field",
    "Interface",
    "Message",
    "Service",
    "closure",
    "is_fixed_size",
    "map_messages",
]

_LENGTH = re.compile(r"\[(0\d{1,18})\]\s*\Z")


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """One member of a message."""

    name: str
    type: FieldType
    default: Value | None = None  # ROS 2 only; never on the wire.
    # The comments above the field and in its line, without the `#`, joined by newlines.
    comment: str = field(default="", compare=False)
    # A comment's `[unit]`, as rosidl reads it.
    unit: str | None = field(default=None, compare=False)
    # The field's name in the text. Not compared.
    span: Span | None = field(default=None, compare=False, repr=False)

    @property
    def element_type(self) -> Primitive | String | Message:
        """The type; for an array or a sequence, the type of its elements."""
        return element_of(self.type)

    @property
    def type_text(self) -> str:
        """The type as genmsg writes it, which keeps leading zeros of an array's length."""
        text = str(self.type)
        if not isinstance(self.type, Array) or self.span is None:
            return text
        written = _LENGTH.search(self.span.line_text[: self.span.column - 1])
        if written is None:
            return text
        return f"{text[: text.rindex('[')]}[{written[1]}]"


@dataclass(frozen=True, slots=True, kw_only=True)
class Constant:
    """A named value of a message type; never on the wire.

    Attributes
    ----------
    text : str
        The value as the definition writes it (for ROS 1 strings: all that follows ``=``).
    """

    name: str
    type: Primitive | String
    value: Value
    text: str = field(default="", compare=False)
    comment: str = field(default="", compare=False)
    unit: str | None = field(default=None, compare=False)
    span: Span | None = field(default=None, compare=False, repr=False)


# No slots: cached attributes live in the instance's dictionary.
@dataclass(frozen=True, kw_only=True)
class Message:
    """A message type."""

    # Full name: `sensor_msgs/msg/Imu` in ROS 2, `sensor_msgs/Imu` in ROS 1; plain `time` and
    # `duration` for the built-in types of ROS 1.
    name: str
    dialect: Dialect
    # In wire order. Empty for an empty message, whose bytes depend on the wire format.
    fields: tuple[Field, ...]
    constants: tuple[Constant, ...] = ()
    comment: str = field(default="", compare=False)  # The comment at the head of the file.
    text: str = field(default="", compare=False, repr=False)  # The definition as it was read.

    def __hash__(self) -> int:
        # Equal messages have equal names; hashing the tree at every level would be quadratic.
        return hash((self.dialect, self.name))

    def __str__(self) -> str:
        return self.name

    @property
    def messages(self) -> tuple[Message, ...]:
        """The message itself, as the only one; services and actions have several."""
        return (self,)

    @property
    def package(self) -> str:
        """Name of the package; empty for a built-in type."""
        return self.name.partition("/")[0] if "/" in self.name else ""

    @property
    def base_name(self) -> str:
        """Last part of the name."""
        return self.name.rpartition("/")[2]

    @property
    def wire(self) -> Wire:
        """Wire format that the dialect's own middleware uses."""
        return WIRE_OF[self.dialect]

    @cached_property
    def children(self) -> tuple[Message, ...]:
        """Distinct message types that fields name directly, in order of appearance."""
        found: dict[str, Message] = {}
        for item in self.fields:
            if isinstance(kind := item.element_type, Message):
                found.setdefault(kind.name, kind)
        return tuple(found.values())

    @cached_property
    def depth(self) -> int:
        """Levels of messages: 1 for a message without message fields."""
        self._evaluate_children("depth")
        return 1 + max((child.depth for child in self.children), default=0)

    @cached_property
    def leaf_count(self) -> int:
        """Number of fields of all levels that are not messages.

        An array or a sequence counts as one element, and a message without fields counts as one.
        The number can grow exponentially with the number of types. Therefore, each type is counted
        only once.
        """
        self._evaluate_children("leaf_count")

        def count(kind: FieldType) -> int:
            return kind.leaf_count if isinstance(kind, Message) else 1

        return sum(count(item.element_type) for item in self.fields) or 1

    @cached_property
    def is_fixed_size(self) -> bool:
        """Whether every value of the message has the same number of bytes on a given wire."""
        self._evaluate_children("is_fixed_size")
        return all(is_fixed_size(item.type) for item in self.fields)

    def _evaluate_children(self, attribute: str) -> None:
        """Evaluate an attribute of all messages below, deepest first.

        Nesting may be deeper than Python's recursion limit. Unlike :func:`closure`, this stops at
        messages that have the attribute, so a type is not walked again for each type with it.
        """
        pending = list(self.children)
        while pending:
            missing = [c for c in pending[-1].children if attribute not in vars(c)]
            pending += missing
            if not missing:
                getattr(pending.pop(), attribute)


def is_fixed_size(kind: FieldType) -> bool:
    """Whether every value of a type has the same number of bytes on a given wire."""
    match element_of(kind):
        case Message() as message:
            return message.is_fixed_size and not isinstance(kind, Sequence)
        case Primitive():
            return not isinstance(kind, Sequence)
        case String():
            return False


def closure(roots: Iterable[Message], *, parts_first: bool = True) -> list[Message]:
    """List messages and all messages in them, each once and after those in its fields.

    The stack is explicit, because definitions may nest deeper than Python's recursion limit.
    Messages of the same name count as the same type, as in one library.

    * `parts_first`: if not, list each message when it is first met: a message before those in its
      fields, depth first, in the order of the fields.
    """
    met: dict[str, Message] = {}
    done: list[Message] = []
    for root in roots:
        stack: list[tuple[Message, Iterator[Message]]] = []
        if root.name not in met:
            met[root.name] = root
            stack.append((root, iter(root.children)))
        while stack:
            message, children = stack[-1]
            child = next((c for c in children if c.name not in met), None)
            if child is None:
                stack.pop()
                done.append(message)
            else:
                met[child.name] = child
                stack.append((child, iter(child.children)))
    return done if parts_first else list(met.values())


def map_messages(message: Message, change: Callable[[Message], Message]) -> Message:
    """Return a message type with every message in it changed: each once, nested messages first.

    * `change`: returns the changed message. Messages in its argument have been changed already.
    """
    made: dict[str, Message] = {}

    def changed(kind: FieldType) -> FieldType:
        inner = element_of(kind)
        if not isinstance(inner, Message):
            return kind
        new = made[inner.name]
        return replace(kind, element=new) if isinstance(kind, Array | Sequence) else new

    for part in closure([message]):
        fields = tuple(replace(item, type=changed(item.type)) for item in part.fields)
        made[part.name] = change(replace(part, fields=fields))
    return made[message.name]


@dataclass(frozen=True, kw_only=True)
class Service:
    """A service type.

    Attributes
    ----------
    name : str
        Full name: ``std_srvs/srv/SetBool`` in ROS 2, ``std_srvs/SetBool`` in ROS 1.
    dialect : "ros1" or "ros2"
    request, response : Message
        Named ``<name>_Request`` and ``<name>_Response`` in ROS 2; in ROS 1, without underscore.
    event : Message or None
        ``<name>_Event``, which ROS 2 publishes for introspection since iron.
    comment : str
        The comment at the head of the file.
    text : str
        The definition as it was read.
    """

    name: str
    dialect: Dialect
    request: Message
    response: Message
    event: Message | None = None
    comment: str = field(default="", compare=False)
    text: str = field(default="", compare=False, repr=False)

    def __str__(self) -> str:
        return self.name

    @property
    def messages(self) -> tuple[Message, ...]:
        """All messages that the service has on a wire."""
        return (self.request, self.response, *(() if self.event is None else (self.event,)))


@dataclass(frozen=True, kw_only=True)
class Action:
    """An action type."""

    # Full name: `tf2_msgs/action/LookupTransform` in ROS 2, `tf2_msgs/LookupTransform` in ROS 1.
    name: str
    dialect: Dialect
    # What the definition declares.
    goal: Message
    result: Message
    feedback: Message
    # In ROS 2 `<name>_SendGoal` and `<name>_GetResult`; none in ROS 1.
    services: tuple[Service, ...] = ()
    # In ROS 2 `<name>_FeedbackMessage`; in ROS 1 `<name>ActionGoal`, `<name>ActionResult`,
    # `<name>ActionFeedback` and `<name>Action`.
    wrappers: tuple[Message, ...] = ()
    comment: str = field(default="", compare=False)  # The comment at the head of the file.
    text: str = field(default="", compare=False, repr=False)  # The definition as it was read.

    def __str__(self) -> str:
        return self.name

    @property
    def messages(self) -> tuple[Message, ...]:
        """All messages that the action has on a wire."""
        served = (message for service in self.services for message in service.messages)
        return (self.goal, self.result, self.feedback, *served, *self.wrappers)


Interface: TypeAlias = "Message | Service | Action"
"""What a definition file declares."""
