"""The names in an IDL file and in the files that it includes: constants, typedefs and types.

rosidl_parser does not read included files and has no scopes: the last part of its name identifies a
typedef in the whole file. Constants are looked up as the standard requires, from the inner module
to the outer, and then in the modules ``..._Constants``, which ROS 2 puts beside the struct.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from firm_hdl.errors import DefinitionError, Diagnostic, Source
from firm_hdl.frontend.explain import clip
from firm_hdl.frontend.idl.parse import parse_file
from firm_hdl.frontend.idl.tree import (
    BasicType,
    Declarator,
    Definition,
    Enum,
    FileSyntax,
    Include,
    Module,
    ScopedName,
    SequenceType,
    StringType,
    Struct,
    Typedef,
    TypeNode,
    words_of,
)
from firm_hdl.frontend.idl.values import AlreadyReportedError, UnknownNameError, Value

__all__ = ["CONSTANTS", "Declared", "Names", "Path", "definitions", "included"]

Path = tuple[str, ...]

CONSTANTS = "_Constants"
"""Suffix of the module with a struct's constants, after the struct's name."""


class Declared(NamedTuple):
    """A type as written in one place: that of a typedef, or of a member of a struct."""

    path: Path  # The modules around it.
    type: TypeNode
    declarator: Declarator
    struct: str | None = None

    @property
    def core(self) -> TypeNode:
        """The type without the sequences around it."""
        type_ = self.type
        while isinstance(type_, SequenceType):
            type_ = type_.element
        return type_

    @property
    def sequences(self) -> list[SequenceType]:
        """The sequences around the core, the inner one first."""
        found = []
        type_ = self.type
        while isinstance(type_, SequenceType):
            found.append(type_)
            type_ = type_.element
        return found[::-1]


def definitions(file: FileSyntax) -> Iterator[tuple[Path, Definition]]:
    """Yield everything that a file declares, with the names of the modules around it, in order."""
    pending: list[tuple[Path, Definition]] = [((), d) for d in reversed(file.definitions)]
    while pending:
        path, definition = pending.pop()
        yield path, definition
        if isinstance(definition, Module):
            inner = (*path, definition.name.text)
            pending += [(inner, d) for d in reversed(definition.definitions)]


def included(
    file: FileSyntax, include: Callable[[str], Source | None], folder: str
) -> list[FileSyntax]:
    """Read all files that a file includes, directly or not; each comes after its own includes.

    A path is searched for as written, then in the folder of the including file. A file that is not
    found, or has a syntax error, is left out, because rosidl_parser reads no included files at all.
    A missing name is reported where it is used.
    """
    found: list[FileSyntax] = []
    seen = {file.source.name}

    def children(parent: FileSyntax, folder: str) -> Iterator[tuple[FileSyntax, str]]:
        for _, definition in definitions(parent):
            if not isinstance(definition, Include):
                continue
            for path in dict.fromkeys((definition.path, f"{folder}{definition.path}")):
                source = _source(path, include)
                if source is not None and source.name not in seen:
                    seen.add(source.name)
                    child = parse_file(source)
                    if not isinstance(child, Diagnostic):
                        yield child, path[: path.rfind("/") + 1]
                if source is not None:
                    break

    pending = [(file, children(file, folder))]
    while pending:
        parent, others = pending[-1]
        child, place = next(others, (None, ""))
        if child is not None:
            pending.append((child, children(child, place)))
        else:
            found.append(parent)
            pending.pop()
    return found[:-1]


def _source(path: str, include: Callable[[str], Source | None]) -> Source | None:
    try:
        return include(path)
    except DefinitionError:
        return None  # The file exists but cannot be read.


@dataclass(slots=True)
class Names:
    """All names that a file can use."""

    # By full name; `None` for a constant with an error, which has been reported.
    constants: dict[Path, Value | None] = field(default_factory=dict)
    # What typedefs declare, by last name.
    aliases: dict[str, Declared] = field(default_factory=dict)
    # Full names, by last name.
    enums: dict[str, Path] = field(default_factory=dict)
    structs: dict[str, Path] = field(default_factory=dict)
    _by_last: dict[str, list[Path]] = field(default_factory=dict)

    def add_constant(self, full: Path, value: Value | None) -> None:
        """Declare a constant; one of the same name hides it."""
        if full not in self.constants:
            self._by_last.setdefault(full[-1], []).append(full)
        self.constants[full] = value

    def add_types(self, file: FileSyntax) -> list[Diagnostic]:
        """Declare all types of a file.

        Returns: errors of typedefs that give a name two meanings.
        """
        wrong = []
        meanings: dict[str, str] = {}
        for path, definition in definitions(file):
            match definition:
                case Typedef():
                    for declarator in definition.declarators:
                        name = declarator.name
                        meaning = _describe(definition.type, declarator)
                        if meanings.setdefault(name.text, meaning) != meaning:
                            message = f"typedef '{name.text}' is already declared as another type"
                            wrong.append(Diagnostic(message, name.span))
                        self.aliases[name.text] = Declared(path, definition.type, declarator)
                case Enum():
                    self.enums[definition.name.text] = (*path, definition.name.text)
                case Struct():
                    self.structs[definition.name.text] = (*path, definition.name.text)
        return wrong

    def constant(self, name: ScopedName, path: Path, struct: str | None = None) -> Value:
        """Give the value of a constant.

        * `path`: the modules around the reference.
        * `struct`: the struct around the reference.

        Raises `UnknownNameError` if no constant has that name.
        """
        full = self._find(name, path, struct)
        value = self.constants[full]
        if value is None:
            # The error was reported at the declaration. A dependent constant has no value, either.
            raise AlreadyReportedError(f"constant '{name}' is wrong", name.span)
        return value

    def _find(self, name: ScopedName, path: Path, struct: str | None) -> Path:
        for depth in range(0 if name.is_absolute else len(path), -1, -1):
            for module in ((), (f"{struct}{CONSTANTS}",)):
                full = (*path[:depth], *module, *name.parts)
                if full in self.constants:
                    return full
        places = self._by_last.get(name.parts[-1], [])
        if len(name.parts) == 1:
            of_structs = [p for p in places if len(p) > 1 and p[-2].endswith(CONSTANTS)]
            if len(of_structs) == 1:
                return of_structs[0]
        message = f"constant '{clip(str(name))}' is not declared above"
        if name.parts in (("true",), ("false",)):
            message = f"'{name}' is not a boolean: TRUE or FALSE"
        elif len(places) > 1:
            message += f"; there are {len(places)} of that name elsewhere"
        raise UnknownNameError(message, name.span)


def _describe(type_: TypeNode, declarator: Declarator) -> str:
    """Write a type, with equal texts for types that are equal in rosidl_parser."""
    text = "".join(f"[{words_of(size.span)}]" for size in declarator.sizes)
    while isinstance(type_, SequenceType):
        text += f"<{'' if type_.bound is None else words_of(type_.bound.span)}>"
        type_ = type_.element
    match type_:
        case BasicType():
            return text + type_.name
        case StringType():
            bound = "" if type_.bound is None else words_of(type_.bound.span)
            return f"{text}{'wstring' if type_.wide else 'string'} {bound}"
        case ScopedName():
            return text + str(type_)
    return text + "fixed"
