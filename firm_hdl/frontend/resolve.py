"""Resolve syntax to the model: names become types, and all errors are found.

A message is resolved once, after the messages that it names. Errors are kept with the text that
has them, so that an error in a dependency is reported once, at its own place. Dependencies are
walked with an explicit stack, because they may nest deeper than Python's recursion limit.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TypeAlias

from firm_hdl.errors import DefinitionError, Diagnostic, Source, Span
from firm_hdl.frontend.explain import similar_builtin
from firm_hdl.frontend.interfaces import Unit, read_unit
from firm_hdl.frontend.names import TypeName, owners
from firm_hdl.frontend.sources import Sources
from firm_hdl.frontend.suggest import did_you_mean, similar_types, unknown_type
from firm_hdl.frontend.syntax import (
    ConstantSyntax,
    FieldSyntax,
    ListSyntax,
    MessageSyntax,
    TypeSyntax,
    ValueSyntax,
)
from firm_hdl.model import (
    PRIMITIVES,
    Array,
    Constant,
    Dialect,
    Field,
    FieldType,
    Message,
    Primitive,
    Sequence,
    String,
    Value,
    idl_primitives,
)

__all__ = ["Resolver"]

_MOST_SUGGESTIONS = 20

_Primitives: TypeAlias = Mapping[str, Primitive]


def _time(name: str, element: str) -> Message:
    kind = PRIMITIVES["ros1"][element]
    fields = tuple(Field(name=part, type=kind) for part in ("secs", "nsecs"))
    return Message(name=name, dialect="ros1", fields=fields)


# genmsg calls these builtin, and defines their fields: time is unsigned, duration signed.
_TIMES = {"time": _time("time", "uint32"), "duration": _time("duration", "int32")}


@dataclass(slots=True)
class _Entry:
    """State of one message: its syntax, its errors and its dependencies."""

    name: TypeName
    syntax: MessageSyntax
    diagnostics: list[Diagnostic]
    needs: list[tuple[TypeName, Span]]
    message: Message | None = None
    is_done: bool = False
    failed_needs: list[TypeName] = field(default_factory=list)


class Resolver:
    """Resolves the messages of one set of sources, each of them once.

    * `has_events`: whether services have a message for introspection.
    * `wchar_bytes`: size of a ``wchar`` of IDL.
    """

    def __init__(
        self, sources: Sources, dialect: Dialect, *, has_events: bool, wchar_bytes: int
    ) -> None:
        self._sources = sources
        self._dialect = dialect
        self._has_events = has_events
        self._idl_primitives = idl_primitives(wchar_bytes)
        self._entries: dict[TypeName, _Entry | None] = {}
        self._units: dict[TypeName, Unit | None] = {}

    def resolve(self, name: TypeName) -> Message | None:
        """Resolve a message and all that it depends on.

        Returns: `None` if no message has that name.

        Raises `DefinitionError`: with all errors in its text, then those in its dependencies.
        """
        entry = self._enter(name)
        if entry is None:
            return None
        if not entry.is_done:
            self._walk(entry)
        if entry.message is None:
            raise DefinitionError(self._collect(entry))
        return entry.message

    def unit(self, name: TypeName) -> Unit | None:
        """Read the file that declares a message, a service or an action, once.

        Returns: `None` if no file has that name.

        Raises `DefinitionError` if the file exists but cannot be read. Errors in its text are in
        the unit.
        """
        if name not in self._units:
            definition = self._sources.find(name.package, name.kind, name.name)
            unit = None
            if definition is not None:
                include, has_events = self._sources.include, self._has_events
                unit = read_unit(name, definition, include, has_events=has_events)
            self._units[name] = unit
        return self._units[name]

    def unit_of(self, name: TypeName) -> Unit | None:
        """Read the file that declares a message or its interface; errors are those of `unit`."""
        for owner in self._sources.by_origin([name, *owners(name)]):
            unit = self.unit(owner)
            if unit is not None and (name.name in unit.messages or unit.diagnostics):
                return unit
        return None

    def _walk(self, root: _Entry) -> None:
        """Finish a type after the types that it needs, depth first."""
        path: dict[TypeName, Iterator[tuple[TypeName, Span]]] = {root.name: iter(root.needs)}
        while path:
            name = next(reversed(path))
            entry = self._entries[name]
            assert entry is not None
            for need, span in path[name]:
                if need in path:
                    entry.diagnostics.append(_cycle([*path], need, span))
                    continue
                needed = self._enter(need)
                if needed is None:
                    entry.diagnostics.append(self._unknown(entry, need, span))
                elif not needed.is_done:
                    path[need] = iter(needed.needs)
                    break
                elif needed.message is None:
                    entry.failed_needs.append(need)
            else:
                del path[name]
                self._finish(entry)
                if path and entry.message is None:
                    parent = self._entries[next(reversed(path))]
                    assert parent is not None
                    parent.failed_needs.append(name)

    def _unknown(self, entry: _Entry, name: TypeName, span: Span) -> Diagnostic:
        """Make the diagnostic for the name of a type that is not defined."""
        message = unknown_type(self._sources, [name])
        actions = self._sources.by_origin(owners(replace(name, kind="action")))
        if actions and self._dialect == "ros1":
            action = f"the action '{actions[0].name}'"
            message += f"; the build of the package makes it from {action}: name the built folder"
        # Searching for similar names is slow, and so many errors have one common cause.
        if len(entry.diagnostics) < _MOST_SUGGESTIONS:
            builtins: list[str] = []
            if name.package == entry.name.package:
                builtins = similar_builtin(name.name, self._dialect)
            similar = similar_types(self._sources, name.package, name.name, kinds=("msg",))
            # In a definition, types are written without ``/msg/``.
            names = [base if p == entry.name.package else f"{p}/{base}" for p, _, base in similar]
            message = did_you_mean(message, [*builtins, *names])
        return Diagnostic(message, span)

    def _enter(self, name: TypeName) -> _Entry | None:
        """Read a type's text, once."""
        if name not in self._entries:
            self._entries[name] = self._load(name)
        return self._entries[name]

    def _load(self, name: TypeName) -> _Entry | None:
        try:
            unit = self.unit_of(name)
        except DefinitionError as error:
            return self._failed(name, error.diagnostics)
        if unit is None:
            return None
        syntax = unit.messages.get(name.name)
        if syntax is None:
            # The file lacks this part because of an error.
            return self._failed(name, unit.diagnostics)
        needs: dict[TypeName, Span] = {}
        for member in syntax.members:
            need = self._need(member.type, name.package)
            if need is not None:
                needs.setdefault(need, member.type.span)
        return _Entry(name, syntax, [*unit.diagnostics], list(needs.items()))

    def _failed(self, name: TypeName, diagnostics: Iterable[Diagnostic]) -> _Entry:
        source = Source(name=str(name), text="")
        nothing = MessageSyntax(source=source, dialect=self._dialect, members=())
        return _Entry(name, nothing, list(diagnostics), [], is_done=True)

    def _need(self, type_: TypeSyntax, package: str) -> TypeName | None:
        if type_.is_builtin:
            return None
        # REP 100; as in genmsg, only for the bare word: ``Header[]`` is a type of the package.
        is_header = type_.name == "Header" and type_.package is None and type_.array == "one"
        if is_header and self._dialect == "ros1":
            return TypeName("std_msgs", "msg", "Header", self._dialect)
        return TypeName(type_.package or package, type_.kind or "msg", type_.name, self._dialect)

    def _finish(self, entry: _Entry) -> None:
        entry.is_done = True
        entry.diagnostics.sort(key=lambda d: _place(d, entry.syntax.source))
        if entry.diagnostics or entry.failed_needs:
            return
        syntax, package = entry.syntax, entry.name.package
        fields = [m for m in syntax.members if isinstance(m, FieldSyntax)]
        constants = [m for m in syntax.members if isinstance(m, ConstantSyntax)]
        is_idl = syntax.language == "idl"
        primitives = self._idl_primitives if is_idl else PRIMITIVES[self._dialect]
        entry.message = Message(
            name=str(entry.name),
            dialect=self._dialect,
            fields=tuple(self._field(m, package, primitives) for m in fields),
            constants=tuple(self._constant(m, primitives) for m in constants),
            comment=syntax.comment,
            text=syntax.source.text if syntax.text is None else syntax.text,
        )

    def _field(self, syntax: FieldSyntax, package: str, primitives: _Primitives) -> Field:
        return Field(
            name=syntax.name.text,
            type=self._type(syntax.type, package, primitives),
            default=None if syntax.default is None else _value(syntax.default),
            comment=syntax.comment,
            unit=syntax.unit,
            span=syntax.name.span,
        )

    def _constant(self, syntax: ConstantSyntax, primitives: _Primitives) -> Constant:
        kind = self._element(syntax.type, "", primitives)
        assert isinstance(kind, Primitive | String)
        return Constant(
            name=syntax.name.text,
            type=kind,
            value=syntax.value.value,
            text=syntax.value.text,
            comment=syntax.comment,
            unit=syntax.unit,
            span=syntax.name.span,
        )

    def _type(self, syntax: TypeSyntax, package: str, primitives: _Primitives) -> FieldType:
        element = self._element(syntax, package, primitives)
        match syntax.array:
            case "one":
                return element
            case "array":
                assert syntax.size is not None
                return Array(element=element, count=syntax.size.value)
            case "sequence":
                bound = None if syntax.size is None else syntax.size.value
                return Sequence(element=element, bound=bound)

    def _element(
        self, syntax: TypeSyntax, package: str, primitives: _Primitives
    ) -> Primitive | String | Message:
        need = self._need(syntax, package)
        if need is not None:
            entry = self._entries[need]
            assert entry is not None and entry.message is not None
            return entry.message
        if syntax.name in ("string", "wstring"):
            bound = None if syntax.bound is None else syntax.bound.value
            return String(bound=bound, wide=syntax.name == "wstring")
        return _TIMES.get(syntax.name) or primitives[syntax.name]

    def _collect(self, entry: _Entry) -> list[Diagnostic]:
        """Collect the errors of a type and of its dependencies, each text once."""
        found: list[Diagnostic] = []
        seen = {entry.name}
        pending = [entry]
        while pending:
            current = pending.pop()
            found += current.diagnostics
            for name in reversed(current.failed_needs):
                needed = self._entries[name]
                if name not in seen and needed is not None:
                    seen.add(name)
                    pending.append(needed)
        # All messages of one file share its errors.
        return list(dict.fromkeys(found))


def _value(syntax: ValueSyntax | ListSyntax) -> Value:
    if isinstance(syntax, ListSyntax):
        return tuple(item.value for item in syntax.items)
    return syntax.value


def _place(diagnostic: Diagnostic, source: Source) -> tuple[int, int]:
    """Return where an error is listed: included files first, then the text, then notes on it."""
    span = diagnostic.span
    if span is None:
        return 2, 0
    return int(span.source.name == source.name), span.start


def _cycle(path: list[TypeName], name: TypeName, span: Span) -> Diagnostic:
    steps = " -> ".join(map(str, [*path[path.index(name) :], name]))
    return Diagnostic(f"type '{name}' contains itself: {steps}", span)
