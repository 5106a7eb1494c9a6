"""Convert IDL trees to the syntax that all languages share: one message per struct of a file.

The checks are those of rosidl_parser and those of a C++ compiler on the code that ROS 2 generates.
``docs/reference/errata.md`` lists the differences. All errors are reported, and the parts with
errors are left out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Literal

from firm_hdl.errors import MAX_DIAGNOSTICS, Diagnostic, Source, Span
from firm_hdl.frontend.idl.annotations import (
    comment_of,
    default_of,
    refusals,
    unit_of,
    unsigned_bits,
    words_of,
)
from firm_hdl.frontend.idl.names import CONSTANTS, Names, Path, definitions, included
from firm_hdl.frontend.idl.parse import parse_file
from firm_hdl.frontend.idl.tree import (
    BasicType,
    Constant,
    Declarator,
    FileSyntax,
    FixedType,
    Member,
    Module,
    StringType,
    Struct,
    Typedef,
)
from firm_hdl.frontend.idl.types import Expander
from firm_hdl.frontend.idl.values import (
    AlreadyReportedError,
    IdlError,
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
from firm_hdl.model import EMPTY_MEMBER

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

    Parameters
    ----------
    include : callable
        Gives the text of an included file, by the path between the quotes or angle brackets.
    folder : str
        The folder of the file, as included paths name it, such as ``sensor_msgs/msg/``.

    Returns
    -------
    tuple of (dict of str to MessageSyntax) and list of Diagnostic
        The structs by their names, such as ``Imu`` or ``SetBool_Request``, and the errors in the
        order of the text. In the structs, typedefs are expanded and constants are evaluated.
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
        wrong.append(Diagnostic(message="too many errors; the others are not listed"))
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
                    self.wrong += refusals(node.annotations)
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
        name = NameSyntax(text=node.name.text, span=node.name.span)
        self.wrong += refusals(node.annotations)
        if not path:
            message = "a constant must be declared in a module"
            self.wrong.append(Diagnostic(message=message, span=name.span))
        if full in self._spans:
            line = self._spans[full].line
            message = f"constant '{name.text}' is already declared in line {line}"
            self.wrong.append(Diagnostic(message=message, span=name.span))
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
                comment=comment_of(node.annotations),
                unit=unit_of(node.annotations),
            )
        )

    def _value(
        self, node: Constant, path: Path
    ) -> tuple[Value, TypeSyntax, bool | int | float | str]:
        """Evaluate a constant: its value in expressions, its type, and its value of that type."""
        type_ = self._constant_type(node)
        lookup = partial(self._names.constant, path=path)
        value = evaluate(node.value, lookup, unsigned_bits(type_.name))
        fitting = fit(value, type_.name, node.value.span)
        if type_.name not in ("char", "wchar"):
            value = Value(_KINDS.get(type_.name, "integer"), fitting)
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
        return TypeSyntax(
            package=None,
            name=name,
            is_builtin=True,
            bound=None,
            array="one",
            size=None,
            span=node.type.span,
        )

    def _typedef(self, node: Typedef) -> None:
        for declarator in node.declarators[1:]:
            message = f"a typedef declares one name in ROS 2; '{declarator.name.text}' is too many"
            self.wrong.append(Diagnostic(message=message, span=declarator.name.span))

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
        self.wrong += refusals(node.annotations)
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
            comment=comment_of(node.annotations),
            language="idl",
        )

    def _fields(self, node: Member, path: Path, struct: Struct) -> Iterator[FieldSyntax]:
        self.wrong += refusals(node.annotations)
        comment, unit = comment_of(node.annotations), unit_of(node.annotations)
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
                self.wrong.append(Diagnostic(message=message, span=name.span))
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
            yield FieldSyntax(
                type=type_,
                name=NameSyntax(text=name.text, span=name.span),
                default=default,
                comment=comment,
                unit=unit,
            )

    def _default(
        self, node: Member, type_: TypeSyntax, path: Path, struct: Struct
    ) -> ValueSyntax | ListSyntax | None:
        lookup = partial(self._names.constant, path=path, struct=struct.name.text)
        try:
            return default_of(node.annotations, type_, lookup)
        except IdlError as error:
            self._note(error)
            return None

    def _note(self, error: IdlError) -> None:
        if not isinstance(error, AlreadyReportedError):
            self.wrong.append(error.diagnostic)


_KINDS: dict[str, Literal["integer", "float", "boolean", "text"]] = {
    "bool": "boolean",
    "float32": "float",
    "float64": "float",
    "long double": "float",
    "string": "text",
    "wstring": "text",
}


def _check_structs(file: FileSyntax, structs: list[tuple[Path, Struct]]) -> Iterator[Diagnostic]:
    """Check that a file declares one message, one service or one action."""
    if not structs:
        start = Span(source=file.source, start=0, end=0)
        yield Diagnostic(message="this file declares no struct", span=start)
        return
    for _, struct in structs[len(_DECLARED) :]:
        message = (
            "a file has one struct for a message, two for a service, three for an action; "
            f"'{struct.name.text}' is too many"
        )
        yield Diagnostic(message=message, span=struct.name.span)
    what, kind = _DECLARED[min(len(structs), len(_DECLARED))]
    suffixes = PARTS["ros2", kind]
    names = [struct.name.text for _, struct in structs]
    if len(structs) == 2 and not any(name.endswith(suffixes) for name in names):
        # Two structs with such names are two messages, not a service.
        message = f"'{names[1]}' is a second struct beside '{names[0]}'; one message per file"
        yield Diagnostic(message=message, span=structs[1][1].name.span)
        return
    first_path, first = structs[0]
    base = first.name.text.removesuffix(suffixes[0])
    for (path, struct), suffix in zip(structs, suffixes, strict=False):
        name = struct.name.text
        if not name.endswith(suffix):
            message = f"'{name}' must end with '{suffix}', as the file declares {what}"
            yield Diagnostic(message=message, span=struct.name.span)
        elif name.removesuffix(suffix) != base and first.name.text.endswith(suffixes[0]):
            message = f"'{name}' must be called '{base}{suffix}', to match '{first.name.text}'"
            yield Diagnostic(message=message, span=struct.name.span)
        elif path != first_path:
            message = f"'{name}' must be in the same module as '{first.name.text}'"
            yield Diagnostic(message=message, span=struct.name.span)
