"""Checks of one well-formed text: sizes, values and duplicate names.

The limits are those of genmsg for ROS 1 and of rosidl_adapter for ROS 2. Each check yields
diagnostics; none of them raises, so that all mistakes of a text are found.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from firm_hdl.errors import Diagnostic, Source, Span
from firm_hdl.frontend.explain import NAME_RULES
from firm_hdl.frontend.names import TypeName, owners
from firm_hdl.frontend.parse import is_type_name
from firm_hdl.frontend.syntax import (
    ConstantSyntax,
    FieldSyntax,
    ListSyntax,
    MessageSyntax,
    SizeSyntax,
    TypeSyntax,
    ValueSyntax,
)
from firm_hdl.model import IDL_PRIMITIVES, PRIMITIVES, Primitive
from firm_hdl.wire.alignment import MAX_LENGTH

__all__ = ["check_members", "check_type_name"]


def check_type_name(
    source: Source, name: TypeName, messages: Iterable[str]
) -> Iterator[Diagnostic]:
    """Check the names of a file and of its messages; errors point at the start of the text."""
    start = Span(source=source, start=0, end=0)
    dialect, any_name = name.dialect, "Name" if name.dialect == "ros2" else "name"
    if not is_type_name(f"{name.package}/{any_name}", dialect):
        rule = NAME_RULES["FIELD_NAME" if dialect == "ros2" else "NAME"]
        message = f"'{name.package}' is not a legal package name: {rule}"
        yield Diagnostic(message=message, span=start)
    # In a recording, each message of a service or an action has a definition of its own.
    bases = [next((o.name for o in owners(name)), m) if m == name.name else m for m in messages]
    if not all(is_type_name(base, dialect) for base in bases):
        rule = NAME_RULES["MESSAGE_NAME" if dialect == "ros2" else "NAME"]
        what = {"msg": "message", "srv": "service", "action": "action"}[name.kind]
        yield Diagnostic(message=f"'{name.name}' is not a legal {what} name: {rule}", span=start)


def check_members(syntax: MessageSyntax) -> Iterator[Diagnostic]:
    """Check every line of a text by itself, then the names against each other."""
    primitives = IDL_PRIMITIVES if syntax.language == "idl" else PRIMITIVES[syntax.dialect]
    checked: ListSyntax | None = None
    for member in syntax.members:
        yield from _check_sizes(member.type)
        if isinstance(member, ConstantSyntax):
            yield from _check_value(member.value, member.type, primitives)
        elif isinstance(member.default, ValueSyntax):
            yield from _check_value(member.default, member.type, primitives)
        elif isinstance(member.default, ListSyntax) and member.default is not checked:
            checked = member.default  # In IDL, several fields of one line share a default.
            yield from _check_list(member.default, member.type, primitives)
    yield from _check_names(syntax)


def _check_names(syntax: MessageSyntax) -> Iterator[Diagnostic]:
    """Find names that are declared twice.

    In ``.msg`` files of ROS 2, constants are in upper case and fields in lower case, so they never
    clash. genmsg checks fields only: a constant may be declared twice, or have a field's name.
    """
    seen: dict[str, Span] = {}
    for member in syntax.members:
        is_field = isinstance(member, FieldSyntax)
        if syntax.dialect == "ros1" and not is_field:
            continue
        name = member.name
        if name.text in seen:
            what = "field" if is_field else "constant"
            message = f"{what} '{name.text}' is already declared in line {seen[name.text].line}"
            yield Diagnostic(message=message, span=name.span)
        seen.setdefault(name.text, name.span)


def _check_sizes(type_: TypeSyntax) -> Iterator[Diagnostic]:
    array = "length of an array" if type_.array == "array" else "bound of a sequence"
    yield from _check_size(type_.bound, "bound of a string")
    yield from _check_size(type_.size, array)


def _check_size(size: SizeSyntax | None, what: str) -> Iterator[Diagnostic]:
    if size is None:
        return
    if size.value < 1:
        yield Diagnostic(message=f"the {what} must be at least 1, not 0", span=size.span)
    elif size.value > MAX_LENGTH:
        yield Diagnostic(message=f"the {what} must be at most {MAX_LENGTH}", span=size.span)


def _check_list(
    syntax: ListSyntax, type_: TypeSyntax, primitives: Mapping[str, Primitive]
) -> Iterator[Diagnostic]:
    count = len(syntax.items)
    if type_.size is not None:
        size = type_.size.value
        if type_.array == "array" and count != size:
            message = f"the default must have {size} elements, not {count}"
            yield Diagnostic(message=message, span=syntax.span)
        elif count > size:
            message = f"the default must have at most {size} elements, not {count}"
            yield Diagnostic(message=message, span=syntax.span)
    for item in syntax.items:
        yield from _check_value(item, type_, primitives)


def _check_value(
    syntax: ValueSyntax, type_: TypeSyntax, primitives: Mapping[str, Primitive]
) -> Iterator[Diagnostic]:
    value = syntax.value
    if isinstance(value, str):
        if type_.bound is not None and len(value) > type_.bound.value:
            message = f"a string of {len(value)} characters does not fit {type_.name}"
            yield Diagnostic(message=f"{message}<={type_.bound.value}", span=syntax.span)
        return
    primitive = primitives[type_.name]
    if primitive.kind == "int":
        bits = 8 * primitive.bytes - primitive.signed
        low, high = -(2**bits) if primitive.signed else 0, 2**bits - 1
        if not low <= value <= high:
            message = f"the value of {primitive} must be in {low}..{high}"
            yield Diagnostic(message=message, span=syntax.span)
