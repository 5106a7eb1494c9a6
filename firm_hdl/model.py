"""The message model: what a ROS interface definition means, with every name resolved.

A model is a tree of frozen values, equal when the definitions mean the same. It knows nothing of
bytes on a wire beyond the size of each primitive; that is the business of :mod:`firm_hdl.wire`.
Analyses are cached attributes, computed when first read (reference attribute grammars are the model
of that: each attribute is an equation over the node and its children).
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, TypeAlias

from firm_hdl.errors import Span

__all__ = [
    "IDL_PRIMITIVES",
    "PRIMITIVES",
    "PRIMITIVE_OF",
    "Action",
    "Array",
    "Constant",
    "Dialect",
    "Field",
    "FieldType",
    "Interface",
    "Message",
    "Primitive",
    "Sequence",
    "Service",
    "Text",
    "Value",
    "idl_primitives",
]

_LENGTH = re.compile(r"\[(0\d{1,18})\]\s*\Z")

Dialect: TypeAlias = Literal["ros1", "ros2"]
"""Whose rules a definition follows: ROS 1 (genmsg) or ROS 2 (rosidl)."""

Value: TypeAlias = "bool | int | float | str | bytes | tuple[Value, ...]"
"""A constant's or a default's value."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Primitive:
    """A number of fixed size.

    Attributes
    ----------
    name : str
        As ROS writes it: ``bool``, ``byte``, ``char``, ``int8`` ... ``uint64``, ``float32``,
        ``float64``; from IDL also ``wchar`` and ``long double``.
    bytes : int
        Size on every wire, in bytes: 1, 2, 4 or 8; of `wchar`, that of a distribution. For `long
        double` 16, which is that of the standard; it is on no wire, see `has_wire_format`.
    signed : bool
        Whether an integer is two's complement. `byte` is signed in ROS 1 only, `char` in IDL only.
    kind : "bool", "int" or "float"
        How the bits are to be read.
    """

    name: str
    bytes: int
    signed: bool
    kind: Literal["bool", "int", "float"]

    def __str__(self) -> str:
        return self.name

    @property
    def has_wire_format(self) -> bool:
        """Whether all systems agree about its bytes; of `long double` they do not.

        By OMG CDR it is an IEEE quadruple. ROS 2 leaves it to the compiler's type of that name,
        and Fast CDR warns that Windows and Unix do not understand each other's.
        """
        return self.name != "long double"


def _primitives(dialect: Dialect) -> dict[str, Primitive]:
    sizes = {"int8": 1, "int16": 2, "int32": 4, "int64": 8}
    table = {
        "bool": Primitive(name="bool", bytes=1, signed=False, kind="bool"),
        # genmsg: byte is a deprecated int8, char a deprecated uint8; rosidl: byte is an octet.
        "byte": Primitive(name="byte", bytes=1, signed=dialect == "ros1", kind="int"),
        "char": Primitive(name="char", bytes=1, signed=False, kind="int"),
        "float32": Primitive(name="float32", bytes=4, signed=True, kind="float"),
        "float64": Primitive(name="float64", bytes=8, signed=True, kind="float"),
    }
    for name, size in sizes.items():
        table[name] = Primitive(name=name, bytes=size, signed=True, kind="int")
        table["u" + name] = Primitive(name="u" + name, bytes=size, signed=False, kind="int")
    return table


PRIMITIVES: dict[Dialect, dict[str, Primitive]] = {
    "ros1": _primitives("ros1"),
    "ros2": _primitives("ros2"),
}
"""Every primitive by name, for each dialect."""


def idl_primitives(wchar_bytes: int) -> dict[str, Primitive]:
    """List every primitive that a definition in OMG IDL can name.

    Parameters
    ----------
    wchar_bytes : 2 or 4
        Size of a `wchar` on the wire, which changed from one distribution to the next.
    """
    return PRIMITIVES["ros2"] | {
        # A C `signed char`, unlike the `char` of .msg files.
        "char": Primitive(name="char", bytes=1, signed=True, kind="int"),
        "wchar": Primitive(name="wchar", bytes=wchar_bytes, signed=False, kind="int"),
        "long double": Primitive(name="long double", bytes=16, signed=True, kind="float"),
    }


IDL_PRIMITIVES: dict[str, Primitive] = idl_primitives(2)
"""Those of the newest distribution. In C++ and Python a `wchar` has 16 bits in every one."""

PRIMITIVE_OF: dict[tuple[str, bool], Primitive] = {
    (item.name, item.signed and item.kind == "int"): item
    for table in (*PRIMITIVES.values(), IDL_PRIMITIVES)
    for item in table.values()
    # On a wire, a wchar is an unsigned integer.
    if item.has_wire_format and item.name != "wchar"
}
"""Every primitive that a leaf can have, by its name and whether it is a signed integer."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Text:
    """A string.

    Attributes
    ----------
    bound : int or None
        Most characters that it may have (bytes for `string`, UTF-16 units for `wstring`).
    wide : bool
        True for `wstring`.
    """

    bound: int | None = None
    wide: bool = False

    def __str__(self) -> str:
        return ("wstring" if self.wide else "string") + (
            "" if self.bound is None else f"<={self.bound}"
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Array:
    """A fixed number of elements, at least one."""

    element: Primitive | Text | Message
    count: int

    def __str__(self) -> str:
        return f"{self.element}[{self.count}]"


@dataclass(frozen=True, slots=True, kw_only=True)
class Sequence:
    """A number of elements that each message says anew; at most `bound`, unless that is `None`."""

    element: Primitive | Text | Message
    bound: int | None = None

    def __str__(self) -> str:
        return f"{self.element}[{'' if self.bound is None else f'<={self.bound}'}]"


FieldType: TypeAlias = "Primitive | Text | Array | Sequence | Message"


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """One member of a message.

    Attributes
    ----------
    default : Value or None
        ROS 2 only; never on the wire.
    comment : str
        Comment lines above and behind it, without the `#`, joined by newlines.
    unit : str or None
        A comment's ``[unit]``, as rosidl reads it.
    span : Span or None
        The field's name in the text. Not compared.
    """

    name: str
    type: FieldType
    default: Value | None = None
    comment: str = field(default="", compare=False)
    unit: str | None = field(default=None, compare=False)
    span: Span | None = field(default=None, compare=False, repr=False)

    @property
    def type_text(self) -> str:
        """The type as genmsg has it, which keeps zeros in front of an array's length."""
        text = str(self.type)
        if not isinstance(self.type, Array) or self.span is None:
            return text
        written = _LENGTH.search(self.span.line_text[: self.span.column - 1])
        if written is None or int(written[1]) != self.type.count:
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
    type: Primitive | Text
    value: Value
    text: str = field(default="", compare=False)
    comment: str = field(default="", compare=False)
    unit: str | None = field(default=None, compare=False)
    span: Span | None = field(default=None, compare=False, repr=False)


# No slots: cached attributes live in the instance's dictionary.
@dataclass(frozen=True, kw_only=True)
class Message:
    """A message type.

    Attributes
    ----------
    name : str
        Full name: ``sensor_msgs/msg/Imu`` in ROS 2, ``sensor_msgs/Imu`` in ROS 1; plain ``time``
        and ``duration`` for the built-in types of ROS 1.
    dialect : "ros1" or "ros2"
    fields : tuple of Field
        In wire order. Empty for an empty message: what stands on the wire then depends on the wire.
    constants : tuple of Constant
    comment : str
        The comment at the head of the file.
    text : str
        The definition as it was read.
    """

    name: str
    dialect: Dialect
    fields: tuple[Field, ...]
    constants: tuple[Constant, ...] = ()
    comment: str = field(default="", compare=False)
    text: str = field(default="", compare=False, repr=False)

    def __hash__(self) -> int:
        # Equal messages have equal names; hashing the tree at every level would be quadratic.
        return hash((self.dialect, self.name))

    def __str__(self) -> str:
        return self.name

    @property
    def messages(self) -> tuple[Message, ...]:
        """The message alone: what services and actions have several of."""
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
    def wire(self) -> Literal["ros1", "cdr"]:
        """Wire format that the dialect's own middleware uses."""
        return "ros1" if self.dialect == "ros1" else "cdr"

    @cached_property
    def children(self) -> tuple[Message, ...]:
        """Distinct message types that fields name directly, in order of appearance."""
        found: dict[str, Message] = {}
        for item in self.fields:
            kind = item.type.element if isinstance(item.type, Array | Sequence) else item.type
            if isinstance(kind, Message):
                found.setdefault(kind.name, kind)
        return tuple(found.values())

    @cached_property
    def depth(self) -> int:
        """Levels of messages: 1 for a message without message fields."""
        self._settle("depth")
        return 1 + max((child.depth for child in self.children), default=0)

    @cached_property
    def leaf_count(self) -> int:
        """Fields of all levels that are no messages; an array or a sequence counts one element.

        A message without fields counts as one. Types that use each other many times have numbers
        that nobody could count out.
        """
        self._settle("leaf_count")

        def count(kind: FieldType) -> int:
            element = kind.element if isinstance(kind, Array | Sequence) else kind
            return element.leaf_count if isinstance(element, Message) else 1

        return sum(count(item.type) for item in self.fields) or 1

    @cached_property
    def is_fixed_size(self) -> bool:
        """Whether every value of the message has the same number of bytes on a given wire."""
        self._settle("is_fixed_size")

        def fixed(kind: FieldType) -> bool:
            match kind:
                case Primitive():
                    return True
                case Message():
                    return kind.is_fixed_size
                case Array():
                    return fixed(kind.element)
                case _:
                    return False

        return all(fixed(item.type) for item in self.fields)

    def _settle(self, attribute: str) -> None:
        """Evaluate an attribute of all messages below, deepest first.

        Nesting may be deeper than Python's recursion limit.
        """
        pending = list(self.children)
        while pending:
            missing = [c for c in pending[-1].children if attribute not in vars(c)]
            pending += missing
            if not missing:
                getattr(pending.pop(), attribute)


@dataclass(frozen=True, kw_only=True)
class Service:
    """A service type.

    Attributes
    ----------
    name : str
        Full name: ``std_srvs/srv/SetBool`` in ROS 2, ``std_srvs/SetBool`` in ROS 1.
    dialect : "ros1" or "ros2"
    request, response : Message
        Named ``<name>_Request`` and ``<name>_Response`` in ROS 2, without the underscore in ROS 1.
    event : Message or None
        ``<name>_Event``, which ROS 2 publishes for introspection from iron on.
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
    """An action type.

    Attributes
    ----------
    name : str
        Full name: ``tf2_msgs/action/LookupTransform`` in ROS 2, ``tf2_msgs/LookupTransform`` in
        ROS 1.
    dialect : "ros1" or "ros2"
    goal, result, feedback : Message
        What the definition declares.
    services : tuple of Service
        In ROS 2 ``<name>_SendGoal`` and ``<name>_GetResult``; none in ROS 1.
    wrappers : tuple of Message
        In ROS 2 ``<name>_FeedbackMessage``; in ROS 1 ``<name>ActionGoal``, ``<name>ActionResult``,
        ``<name>ActionFeedback`` and ``<name>Action``.
    comment : str
        The comment at the head of the file.
    text : str
        The definition as it was read.
    """

    name: str
    dialect: Dialect
    goal: Message
    result: Message
    feedback: Message
    services: tuple[Service, ...] = ()
    wrappers: tuple[Message, ...] = ()
    comment: str = field(default="", compare=False)
    text: str = field(default="", compare=False, repr=False)

    def __str__(self) -> str:
        return self.name

    @property
    def messages(self) -> tuple[Message, ...]:
        """All messages that the action has on a wire."""
        served = (message for service in self.services for message in service.messages)
        return (self.goal, self.result, self.feedback, *served, *self.wrappers)


Interface: TypeAlias = "Message | Service | Action"
"""Whatever a definition file declares."""
