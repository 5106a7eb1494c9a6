"""Convert IDL trees to the syntax that all languages share: one message per struct of a file.

The checks are those of rosidl_parser and those of a C++ compiler on the code that ROS 2 generates.
``docs/reference/errata.md`` lists the differences. All errors are reported, and the parts with
errors are left out.

Annotations give comments, units and defaults. Others are ignored, as in rosidl_parser, unless they
change the bytes on the wire in the standard. ROS 2 ignores these, too, but the author of the
definition does not expect this. Therefore they are errors.
"""

from __future__ import annotations

import ast
import math
import re
import warnings
from collections.abc import Callable, Iterator
from functools import partial
from typing import Literal

from firm_hdl.errors import MAX_DIAGNOSTICS, Diagnostic, Source, Span
from firm_hdl.frontend.idl.names import CONSTANTS, Names, Path, definitions, included
from firm_hdl.frontend.idl.parse import parse_file
from firm_hdl.frontend.idl.tree import (
    Annotation,
    BasicType,
    Constant,
    Declarator,
    Expression,
    FileSyntax,
    FixedType,
    LiteralSyntax,
    Member,
    Module,
    ScopedName,
    StringType,
    Struct,
    Typedef,
    words_of,
)
from firm_hdl.frontend.idl.types import Expander
from firm_hdl.frontend.idl.values import (
    AlreadyReportedError,
    IdlError,
    Lookup,
    UnknownNameError,
    Value,
    evaluate,
    fit,
)
from firm_hdl.frontend.names import PARTS, Kind
from firm_hdl.frontend.syntax import (
    ConstantSyntax,
    FieldSyntax,
    ListSyntax,
    MemberSyntax,
    MessageSyntax,
    NameSyntax,
    TypeSyntax,
    ValueSyntax,
)
from firm_hdl.model import EMPTY_MEMBER, IDL_PRIMITIVES

__all__ = ["read_idl"]

# What a file declares, by the number of its structs.
_DECLARED: dict[int, tuple[str, Kind]] = {
    1: ("a message", "msg"),
    2: ("a service", "srv"),
    3: ("an action", "action"),
}


def read_idl(
    source: Source, include: Callable[[str], Source | None], *, folder: str = ""
) -> tuple[dict[str, MessageSyntax], list[Diagnostic]]:
    """Read an IDL file of a ROS 2 package.

    * `include`: gives the text of an included file, by the path between the quotes or angle
      brackets.
    * `folder`: the folder of the file, as included paths name it, such as ``sensor_msgs/msg/``.

    Returns: the structs by their names, such as ``Imu`` or ``SetBool_Request``, and the errors in
    the order of the text. In the structs, typedefs are expanded and constants are evaluated.
    """
    file = parse_file(source)
    if isinstance(file, Diagnostic):
        return {}, [file]
    reader = _Reader(file, included(file, include, folder))
    messages = reader.messages()
    # Errors of included files come first.
    wrong = sorted(reader.wrong, key=lambda d: (_place(d, source), d.message))
    wrong = list(dict.fromkeys(wrong))
    if len(wrong) > MAX_DIAGNOSTICS:
        del wrong[MAX_DIAGNOSTICS:]
        wrong.append(Diagnostic("too many errors; the others are not listed"))
    return messages, wrong


def _place(diagnostic: Diagnostic, source: Source) -> int:
    span = diagnostic.span
    return -1 if span is None or span.source.name != source.name else span.start


class _Reader:
    """Reads one file; collects its errors in `wrong`."""

    def __init__(self, file: FileSyntax, includes: list[FileSyntax]) -> None:
        self.wrong: list[Diagnostic] = []
        self._file = file
        self._names = Names()
        self._spans: dict[Path, Span] = {}
        self._constants: dict[str, list[ConstantSyntax]] = {}
        for other in includes:
            self._names.add_types(other)
            for path, node in definitions(other):
                if isinstance(node, Constant):
                    self._included_constant(node, path)
        self.wrong += self._names.add_types(file)
        self._expander = Expander(self._names)

    def messages(self) -> dict[str, MessageSyntax]:
        """Read everything that the file declares."""
        structs: list[tuple[Path, Struct]] = []
        for path, node in definitions(self._file):
            match node:
                case Module():
                    self.wrong += _refusals(node.annotations)
                case Constant():
                    self._constant(node, path)
                case Typedef():
                    self._typedef(node)
                case Struct(members=members) if members is not None:
                    structs.append((path, node))
        self.wrong += _check_structs(self._file, structs)
        messages = {node.name.text: self._struct(node, path) for path, node in structs}
        for _, node in definitions(self._file):
            if isinstance(node, Typedef):
                self._check_alias(node)
        return messages

    def _included_constant(self, node: Constant, path: Path) -> None:
        try:
            value, *_ = self._value(node, path)
        except IdlError:
            return  # The error belongs to the included file. A use of the constant is reported.
        self._names.add_constant((*path, node.name.text), value)

    def _constant(self, node: Constant, path: Path) -> None:
        """Declare a constant, and keep it for the struct to which it belongs."""
        full = (*path, node.name.text)
        name = node.name
        self.wrong += _refusals(node.annotations)
        if not path:
            self.wrong.append(Diagnostic("a constant must be declared in a module", name.span))
        if full in self._spans:
            line = self._spans[full].line
            message = f"constant '{name.text}' is already declared in line {line}"
            self.wrong.append(Diagnostic(message, name.span))
            return
        self._spans[full] = name.span
        try:
            value, type_, fitting = self._value(node, path)
        except IdlError as error:
            self._note(error)
            self._names.add_constant(full, None)
            return
        self._names.add_constant(full, value)
        if not path:
            return
        span = node.value.span
        self._constants.setdefault(path[-1], []).append(
            ConstantSyntax(
                type=type_,
                name=name,
                value=ValueSyntax(value=fitting, text=words_of(span), span=span),
                comment=_comment_of(node.annotations),
                unit=_unit_of(node.annotations),
            )
        )

    def _value(
        self, node: Constant, path: Path
    ) -> tuple[Value, TypeSyntax, bool | int | float | str]:
        """Evaluate a constant: its value in expressions, its type, and its value of that type."""
        type_ = self._constant_type(node)
        lookup = partial(self._names.constant, path=path)
        value = evaluate(node.value, lookup, _unsigned_bits(type_.name))
        fitting = fit(value, type_.name, node.value.span)
        if type_.name not in ("char", "wchar"):
            value = Value(_KINDS[type_.name], fitting)
        return value, type_, fitting

    def _constant_type(self, node: Constant) -> TypeSyntax:
        match node.type:
            case StringType():
                # ROS 2 ignores the bound.
                name = "wstring" if node.type.wide else "string"
            case BasicType():
                name = node.type.name
            case FixedType():
                raise IdlError("type 'fixed' is not supported", node.type.span)
            case _:
                message = "the type of a constant must be a builtin one"
                raise IdlError(message, node.type.span)
        return TypeSyntax(name=name, span=node.type.span)

    def _typedef(self, node: Typedef) -> None:
        for declarator in node.declarators[1:]:
            message = f"a typedef declares one name in ROS 2; '{declarator.name.text}' is too many"
            self.wrong.append(Diagnostic(message, declarator.name.span))

    def _check_alias(self, node: Typedef) -> None:
        """Check a typedef even if no member uses it, except for the names in it, as rosidl does."""
        for declarator in node.declarators:
            try:
                self._expander.alias(declarator.name.text)
            except UnknownNameError:
                pass
            except IdlError as error:
                self._note(error)

    def _struct(self, node: Struct, path: Path) -> MessageSyntax:
        assert node.members is not None
        self.wrong += _refusals(node.annotations)
        fields = [field for member in node.members for field in self._fields(member, path, node)]
        match fields:
            case [FieldSyntax(name=NameSyntax(text=name), type=type_)] if (
                name == EMPTY_MEMBER and type_.name == "uint8" and type_.array == "one"
            ):
                fields = []
        members: list[MemberSyntax] = [
            *self._constants.get(node.name.text + CONSTANTS, []),
            *fields,
        ]
        members.sort(key=lambda member: member.name.span.start)
        return MessageSyntax(
            source=self._file.source,
            dialect="ros2",
            members=tuple(members),
            comment=_comment_of(node.annotations),
            language="idl",
        )

    def _fields(self, node: Member, path: Path, struct: Struct) -> Iterator[FieldSyntax]:
        self.wrong += _refusals(node.annotations)
        comment, unit = _comment_of(node.annotations), _unit_of(node.annotations)
        array: Declarator | None = None
        # Several names share a type and a default, which are read once for plain names and once
        # for an array.
        known: dict[bool, tuple[TypeSyntax, ValueSyntax | ListSyntax | None]] = {}
        for declarator in node.declarators:
            name = declarator.name
            if array is not None:
                message = (
                    f"'{name.text}' follows array '{array.name.text}', and ROS 2 gives both the "
                    "same size; declare it in a line of its own"
                )
                self.wrong.append(Diagnostic(message, name.span))
                return
            if declarator.sizes:
                array = declarator
            is_array = array is not None
            if is_array not in known:
                try:
                    type_ = self._expander.member(node.type, declarator, path, struct.name.text)
                except IdlError as error:
                    self._note(error)
                    return
                known[is_array] = type_, self._default(node, type_, path, struct)
            type_, default = known[is_array]
            yield FieldSyntax(type=type_, name=name, default=default, comment=comment, unit=unit)

    def _default(
        self, node: Member, type_: TypeSyntax, path: Path, struct: Struct
    ) -> ValueSyntax | ListSyntax | None:
        lookup = partial(self._names.constant, path=path, struct=struct.name.text)
        try:
            return _default_of(node.annotations, type_, lookup)
        except IdlError as error:
            self._note(error)
            return None

    def _note(self, error: IdlError) -> None:
        if not isinstance(error, AlreadyReportedError):
            self.wrong.append(error.diagnostic)


_WORDS: dict[str, Literal["integer", "float", "boolean"]] = {
    "bool": "boolean",
    "int": "integer",
    "float": "float",
}
_KINDS: dict[str, Literal["integer", "float", "boolean", "text"]] = {
    **{name: _WORDS[primitive.kind] for name, primitive in IDL_PRIMITIVES.items()},
    **dict.fromkeys(("string", "wstring"), "text"),
}


def _check_structs(file: FileSyntax, structs: list[tuple[Path, Struct]]) -> Iterator[Diagnostic]:
    """Check that a file declares one message, one service or one action."""
    if not structs:
        start = Span(file.source, 0, 0)
        yield Diagnostic("this file declares no struct", start)
        return
    for _, struct in structs[len(_DECLARED) :]:
        message = (
            "a file has one struct for a message, two for a service, three for an action; "
            f"'{struct.name.text}' is too many"
        )
        yield Diagnostic(message, struct.name.span)
    what, kind = _DECLARED[min(len(structs), len(_DECLARED))]
    suffixes = PARTS["ros2", kind]
    names = [struct.name.text for _, struct in structs]
    if len(structs) == 2 and not any(name.endswith(suffixes) for name in names):
        # Two structs with such names are two messages, not a service.
        message = f"'{names[1]}' is a second struct beside '{names[0]}'; one message per file"
        yield Diagnostic(message, structs[1][1].name.span)
        return
    first_path, first = structs[0]
    base = first.name.text.removesuffix(suffixes[0])
    for (path, struct), suffix in zip(structs, suffixes, strict=False):
        name = struct.name.text
        if not name.endswith(suffix):
            message = f"'{name}' must end with '{suffix}', as the file declares {what}"
            yield Diagnostic(message, struct.name.span)
        elif name.removesuffix(suffix) != base and first.name.text.endswith(suffixes[0]):
            message = f"'{name}' must be called '{base}{suffix}', to match '{first.name.text}'"
            yield Diagnostic(message, struct.name.span)
        elif path != first_path:
            message = f"'{name}' must be in the same module as '{first.name.text}'"
            yield Diagnostic(message, struct.name.span)


_REFUSED = ("optional", "mutable")


def _refusals(annotations: tuple[Annotation, ...]) -> Iterator[Diagnostic]:
    """Find annotations that would change the bytes on the wire."""
    for annotation in annotations:
        name = annotation.name.parts[0]
        values = [v for _, v in annotation.arguments if isinstance(v, ScopedName)]
        if name in _REFUSED:
            yield Diagnostic(f"annotation '@{name}' is not supported", annotation.span)
        elif name == "extensibility" and any(v.parts[-1] == "MUTABLE" for v in values):
            message = "annotation '@extensibility(MUTABLE)' is not supported"
            yield Diagnostic(message, annotation.span)


def _comment_of(annotations: tuple[Annotation, ...]) -> str:
    """Join the texts of ``@verbatim(language="comment", text="...")``."""
    lines: list[str] = []
    for annotation in _named(annotations, "verbatim"):
        texts = {}
        for name, value in annotation.arguments:
            if name is not None and isinstance(value, LiteralSyntax):
                texts[name.text] = _literal_text(value)
        if texts.get("language") == "comment" and texts.get("text"):
            lines += (texts["text"] or "").splitlines()
    return "\n".join(lines)


def _unit_of(annotations: tuple[Annotation, ...]) -> str | None:
    """Give the text of ``@unit(value="...")``."""
    for annotation in _named(annotations, "unit"):
        for name, value in annotation.arguments:
            if name is None or name.text == "value":
                return _literal_text(value) if isinstance(value, LiteralSyntax) else None
    return None


def _default_of(
    annotations: tuple[Annotation, ...], type_: TypeSyntax, lookup: Lookup
) -> ValueSyntax | ListSyntax | None:
    """Give the value of ``@default(value=...)``, converted to a type.

    Raises `IdlError` if there are two defaults, if the default has no value, or if it does not fit
    the type.
    """
    found = list(_named(annotations, "default"))
    if not found:
        return None
    if len(found) > 1:
        raise IdlError("a member can have only one default", found[1].span)
    if not type_.is_builtin:
        raise IdlError("only a builtin type can have a default", found[0].span)
    expression = _default_expression(found[0])
    span = expression.span
    value = evaluate(expression, lookup, _unsigned_bits(type_.name))
    if type_.array != "one":
        return _list(value, type_, span)
    return ValueSyntax(value=fit(value, type_.name, span), text=words_of(span), span=span)


def _unsigned_bits(name: str) -> int | None:
    """Give the bits of an unsigned integer type; `None` for any other type."""
    primitive = IDL_PRIMITIVES.get(name)
    if primitive is None or primitive.kind != "int" or primitive.signed:
        return None
    return 8 * primitive.bytes


def _named(annotations: tuple[Annotation, ...], name: str) -> Iterator[Annotation]:
    # rosidl_parser compares only the first word of a name with a scope.
    return (a for a in annotations if a.name.parts[0] == name)


def _literal_text(literal: LiteralSyntax) -> str | None:
    try:
        value = evaluate(literal, _no_names).value
    except IdlError:
        return None
    return value if isinstance(value, str) else None


def _no_names(name: ScopedName) -> Value:
    raise AssertionError(name)


def _default_expression(annotation: Annotation) -> Expression:
    for name, value in annotation.arguments:
        if name is None or name.text == "value":
            return value
    raise IdlError("a default needs a value: '@default(value=...)'", annotation.span)


# An element of a Python list: a single token, so that lists cannot nest.
_ITEM = re.compile(
    r"""\s*(?P<item>[+-]?[\w.]+(?:(?<=[eE])[+-]\d+)?|'(?:[^'\\]|\\.)*'|"(?:[^"\\]|\\.)*")\s*(?:,|$)"""
)


def _list(value: Value, type_: TypeSyntax, span: Span) -> ListSyntax:
    """Read a default of several elements, which rosidl_adapter writes like a Python tuple."""
    text = value.value.strip() if isinstance(value.value, str) else ""
    if text[:1] + text[-1:] not in ("()", "[]"):
        raise _no_list(type_, span)
    items = []
    inside = text[1:-1].rstrip()
    position = 0
    while position < len(inside):
        match = _ITEM.match(inside, position)
        if match is None or (element := _python_value(match["item"])) is None:
            raise _no_list(type_, span)
        fitting = fit(element, type_.name, span)
        items.append(ValueSyntax(value=fitting, text=match["item"], span=span))
        position = match.end()
    return ListSyntax(items=tuple(items), span=span)


def _no_list(type_: TypeSyntax, span: Span) -> IdlError:
    return IdlError(f'expected a list of {type_.name} as a string, such as "(1, 2)"', span)


def _python_value(text: str) -> Value | None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # Unknown escapes stay as they are, as in rosidl.
        try:
            value = ast.literal_eval(text)
        except (ValueError, SyntaxError):
            return None
    match value:
        case bool():
            return Value("boolean", value)
        case int():
            return Value("integer", value)
        case float() if math.isfinite(value):
            return Value("float", value)
        case str():
            return Value("text", value)
    return None
