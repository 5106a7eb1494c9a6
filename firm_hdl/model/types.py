"""Types of fields: numbers, strings, arrays and sequences."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

if TYPE_CHECKING:
    from firm_hdl.model.message import Message

__all__ = [
    "EMPTY_MEMBER",
    "IDL_PRIMITIVES",
    "PRIMITIVES",
    "PRIMITIVE_OF",
    "WIRE_OF",
    "Array",
    "Dialect",
    "FieldType",
    "Primitive",
    "Sequence",
    "String",
    "Value",
    "Wire",
    "element_of",
    "idl_primitives",
    "type_text",
]

Dialect: TypeAlias = Literal["ros1", "ros2"]
"""The rules that a definition follows: those of ROS 1 (genmsg) or of ROS 2 (rosidl)."""

Wire: TypeAlias = Literal["ros1", "cdr"]
"""Names of the wire formats; :mod:`firm_hdl.wire` has their rules."""

WIRE_OF: dict[Dialect, Wire] = {"ros1": "ros1", "ros2": "cdr"}
"""The wire format that a dialect's own middleware uses."""

Value: TypeAlias = "bool | int | float | str | bytes | tuple[Value, ...]"
"""A constant's or a default's value."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Primitive:
    """A number of fixed size."""

    # As ROS writes it: `bool`, `byte`, `char`, `int8` ... `uint64`, `float32`, `float64`; from IDL
    # also `wchar` and `long double`.
    name: str
    # Size on every wire, in bytes: 1, 2, 4 or 8. The size of `wchar` depends on the distribution.
    # The 16 bytes of `long double` are those of the standard; see `has_wire_format`.
    bytes: int
    # Whether an integer is two's complement. `byte` is signed in ROS 1 only, `char` in IDL only.
    signed: bool
    kind: Literal["bool", "int", "float"]  # How to interpret the bits.

    def __str__(self) -> str:
        return self.name

    @property
    def bits(self) -> int:
        """Bits of a value in a circuit: 1 for a `bool`, and all of its bytes for other types."""
        return 1 if self.kind == "bool" else 8 * self.bytes

    @property
    def has_wire_format(self) -> bool:
        """Whether all systems write the type with the same bytes; false for `long double` only.

        In OMG CDR, a `long double` is an IEEE 754 quadruple. ROS 2 uses the compiler's type of that
        name. Fast CDR warns that Windows and Unix cannot exchange such values.
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

    * `wchar_bytes`: size of a `wchar` on the wire, which changed from one distribution to the next.
    """
    return PRIMITIVES["ros2"] | {
        # A C `signed char`, unlike the `char` of .msg files.
        "char": Primitive(name="char", bytes=1, signed=True, kind="int"),
        "wchar": Primitive(name="wchar", bytes=wchar_bytes, signed=False, kind="int"),
        "long double": Primitive(name="long double", bytes=16, signed=True, kind="float"),
    }


IDL_PRIMITIVES: dict[str, Primitive] = idl_primitives(2)
"""IDL's primitives in the newest distribution. In C++ and Python, a `wchar` always has 16 bits."""

PRIMITIVE_OF: dict[tuple[str, bool], Primitive] = {
    (item.name, item.signed and item.kind == "int"): item
    for table in (*PRIMITIVES.values(), IDL_PRIMITIVES)
    for item in table.values()
    # On a wire, a wchar is an unsigned integer.
    if item.has_wire_format and item.name != "wchar"
}
"""Every primitive that a leaf can have, by its name and whether it is a signed integer."""


@dataclass(frozen=True, slots=True, kw_only=True)
class String:
    """A string."""

    # Largest number of characters (bytes for `string`, UTF-16 units for `wstring`).
    bound: int | None = None
    wide: bool = False  # True for `wstring`.

    def __str__(self) -> str:
        return ("wstring" if self.wide else "string") + (
            "" if self.bound is None else f"<={self.bound}"
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Array:
    """A fixed number of elements, at least one."""

    element: Primitive | String | Message
    count: int

    def __str__(self) -> str:
        return type_text(self, str(self.element))


@dataclass(frozen=True, slots=True, kw_only=True)
class Sequence:
    """A variable number of elements: at most `bound`, or any number if `bound` is `None`."""

    element: Primitive | String | Message
    bound: int | None = None

    def __str__(self) -> str:
        return type_text(self, str(self.element))


FieldType: TypeAlias = "Primitive | String | Array | Sequence | Message"


EMPTY_MEMBER = "structure_needs_at_least_one_member"
"""The `uint8` that rosidl adds to a message without fields. No definition declares it."""


def element_of(kind: FieldType) -> Primitive | String | Message:
    """Give the type of an array's or a sequence's elements, and any other type as it is."""
    return kind.element if isinstance(kind, Array | Sequence) else kind


def type_text(kind: FieldType, name: str) -> str:
    """Write a type as ``.msg`` files do, with `name` for the type of its elements."""
    match kind:
        case Array(count=count):
            return f"{name}[{count}]"
        case Sequence(bound=bound):
            return f"{name}[{'' if bound is None else f'<={bound}'}]"
        case _:
            return name
