"""The syntax trees of definitions: the content of a text with its positions, without its meaning.

Each construct of the language has a class. Names are not resolved, and sizes and values are not
checked against their types; :mod:`firm_hdl.frontend.resolve` does that. Every node has its span, so
that an error can point at it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from firm_hdl.errors import Source, Span
from firm_hdl.model import Dialect

__all__ = [
    "ConstantSyntax",
    "FieldSyntax",
    "ListSyntax",
    "MemberSyntax",
    "MessageSyntax",
    "NameSyntax",
    "SizeSyntax",
    "TypeSyntax",
    "ValueSyntax",
]


@dataclass(frozen=True, slots=True)
class NameSyntax:
    """A name that a text declares, such as that of a field."""

    text: str
    span: Span


@dataclass(frozen=True, slots=True)
class SizeSyntax:
    """A number of elements or of characters."""

    value: int
    span: Span


@dataclass(frozen=True, slots=True, kw_only=True)
class TypeSyntax:
    """The type of a field or a constant."""

    package: str | None = None  # The package, if the text has one: the word before the slash.
    name: str  # Name of a builtin type or of a message type.
    is_builtin: bool = True  # Whether `name` is a builtin type of the dialect.
    bound: SizeSyntax | None = None  # The bound of a string: the number after `string<=`.
    # Whether brackets follow, and whether they fix the number of elements.
    array: Literal["one", "array", "sequence"] = "one"
    # The number in the brackets: the length of an array, the bound of a sequence.
    size: SizeSyntax | None = None
    span: Span
    # The namespace of a message type, if the text has it (in IDL `pkg::action::X_Goal`). `None`
    # means "msg", as everywhere in `.msg`, `.srv` and `.action` files.
    kind: Literal["msg", "srv", "action"] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ValueSyntax:
    """A constant's value, a default, or an element of one; quotes and escapes are undone."""

    value: bool | int | float | str
    text: str
    span: Span


@dataclass(frozen=True, slots=True, kw_only=True)
class ListSyntax:
    """The default of an array or a sequence."""

    items: tuple[ValueSyntax, ...]
    span: Span


@dataclass(frozen=True, slots=True, kw_only=True)
class FieldSyntax:
    """One line that declares a field."""

    type: TypeSyntax
    name: NameSyntax
    default: ValueSyntax | ListSyntax | None = None
    comment: str = ""
    unit: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ConstantSyntax:
    """One line that declares a constant."""

    type: TypeSyntax
    name: NameSyntax
    value: ValueSyntax
    comment: str = ""
    unit: str | None = None


MemberSyntax: TypeAlias = FieldSyntax | ConstantSyntax


@dataclass(frozen=True, slots=True, kw_only=True)
class MessageSyntax:
    """A whole ``.msg`` text, or the part of another that defines one message."""

    source: Source  # The whole file, to which all spans refer.
    dialect: Dialect
    members: tuple[MemberSyntax, ...]  # In the order of the text.
    comment: str = ""  # The comment at the head of the text.
    text: str | None = None  # The text of this message alone; `None` means all of the source.
    # Language of the names of builtin types: `char` is another type in IDL.
    language: Literal["msg", "idl"] = "msg"
