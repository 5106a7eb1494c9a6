"""The syntax tree of an IDL file: its content with positions, without its meaning.

In the tree, typedefs are not expanded, expressions not evaluated, and names not resolved. Three
modules do this: :mod:`firm_hdl.frontend.idl.names`, :mod:`~firm_hdl.frontend.idl.values` and
:mod:`~firm_hdl.frontend.idl.types`. The result is the syntax that all languages share
(:mod:`firm_hdl.frontend.syntax`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from firm_hdl.errors import Source, Span
from firm_hdl.frontend.syntax import NameSyntax

__all__ = [
    "Annotation",
    "BasicType",
    "Chain",
    "Constant",
    "Declarator",
    "Definition",
    "Enum",
    "Expression",
    "FileSyntax",
    "FixedType",
    "Include",
    "LiteralSyntax",
    "Member",
    "Module",
    "ScopedName",
    "SequenceType",
    "StringType",
    "Struct",
    "TypeNode",
    "Typedef",
    "Unary",
    "words_of",
]


@dataclass(frozen=True, slots=True)
class ScopedName:
    """A reference, such as ``sensor_msgs::msg::Imu``."""

    parts: tuple[str, ...]
    is_absolute: bool  # Whether the reference starts with `::`.
    span: Span

    def __str__(self) -> str:
        return ("::" if self.is_absolute else "") + "::".join(self.parts)


@dataclass(frozen=True, slots=True)
class LiteralSyntax:
    """A literal."""

    kind: Literal["integer", "float", "fixed", "character", "boolean", "string", "wstring"]
    parts: tuple[str, ...]  # The tokens of the literal; only a string can have several.
    span: Span


@dataclass(frozen=True, slots=True)
class Unary:
    """A sign, or ``~``, in front of an operand."""

    operator: str
    operand: Expression
    span: Span


@dataclass(frozen=True, slots=True)
class Chain:
    """Operands joined by operators of one precedence, evaluated from the left.

    A sum of a thousand numbers is one node, so that only parentheses make the tree deep.
    """

    operands: tuple[Expression, ...]
    operators: tuple[str, ...]
    span: Span


Expression: TypeAlias = "ScopedName | LiteralSyntax | Unary | Chain"


@dataclass(frozen=True, slots=True)
class Annotation:
    """``@name``, ``@name(value)`` or ``@name(key=value, ...)``."""

    name: ScopedName
    # A value without a key has `None` for its name.
    arguments: tuple[tuple[NameSyntax | None, Expression], ...]
    span: Span


@dataclass(frozen=True, slots=True)
class BasicType:
    """A type of fixed size."""

    name: str  # The name in ROS. `long double` has its name in IDL, because only IDL has this type.
    span: Span


@dataclass(frozen=True, slots=True)
class StringType:
    """``string`` or ``wstring``."""

    wide: bool
    bound: Expression | None
    span: Span


@dataclass(frozen=True, slots=True)
class SequenceType:
    """``sequence<element>`` or ``sequence<element, bound>``."""

    element: TypeNode
    bound: Expression | None
    span: Span


@dataclass(frozen=True, slots=True)
class FixedType:
    """``fixed<digits, scale>``, or ``fixed`` as the type of a constant."""

    span: Span


TypeNode: TypeAlias = "BasicType | StringType | SequenceType | FixedType | ScopedName"


@dataclass(frozen=True, slots=True)
class Declarator:
    """A name and the dimensions that follow it."""

    name: NameSyntax
    sizes: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Include:
    """``#include "path"`` or ``#include <path>``."""

    path: str


@dataclass(frozen=True, slots=True)
class Constant:
    """``const type name = value``."""

    annotations: tuple[Annotation, ...]
    type: TypeNode
    name: NameSyntax
    value: Expression


@dataclass(frozen=True, slots=True)
class Typedef:
    """``typedef type name, name``."""

    type: TypeNode
    declarators: tuple[Declarator, ...]


@dataclass(frozen=True, slots=True)
class Enum:
    """``enum name { ... }``."""

    name: NameSyntax


@dataclass(frozen=True, slots=True)
class Member:
    """A line of a struct."""

    annotations: tuple[Annotation, ...]
    type: TypeNode
    declarators: tuple[Declarator, ...]


@dataclass(frozen=True, slots=True)
class Struct:
    """A struct; a forward declaration has `None` for members."""

    annotations: tuple[Annotation, ...]
    name: NameSyntax
    members: tuple[Member, ...] | None


@dataclass(frozen=True, slots=True)
class Module:
    """``module name { ... }``."""

    annotations: tuple[Annotation, ...]
    name: NameSyntax
    definitions: tuple[Definition, ...]


Definition: TypeAlias = "Include | Constant | Typedef | Enum | Struct | Module"


@dataclass(frozen=True, slots=True)
class FileSyntax:
    """A whole file."""

    source: Source
    definitions: tuple[Definition, ...]


def words_of(span: Span) -> str:
    """Give the text of a span, on one line."""
    return " ".join(span.source.text[span.start : span.end].split())
