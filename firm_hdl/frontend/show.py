"""Definitions printed the way ROS's own tools print them.

For ROS 1, the tools are ``rosmsg show`` and ``rossrv show``. They print the parsed definition,
constants first. For ROS 2, the tool is ``ros2 interface show``. It prints the text as it is
written, with the definitions of nested types under each field. Here, comments of nested types are
left out completely; released versions of ros2cli leave a stray ``#`` (ros2cli issue 769). A
definition in IDL is shown as an equivalent ``.msg`` text.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend.library import Library
from firm_hdl.frontend.parse import lines_of
from firm_hdl.model import (
    Action,
    Constant,
    Field,
    Interface,
    Message,
    Service,
    Value,
    closure,
)

__all__ = ["MOST_CHARACTERS", "show"]

MOST_CHARACTERS = 1 << 26
"""Limit on a shown text. Its length can grow exponentially with the number of types."""

_SEPARATOR = "---"

# What ends a line, as `str.splitlines` says. A ``.msg`` cannot have it in a value.
_LINE_END = re.compile("[\n\r\v\f\x1c-\x1e\x85\u2028\u2029]")


def show(library: Library, name: str) -> str:
    """Print a type and the types in it.

    * `name`: as for `Library.interface`.

    Returns: lines, each with its line end. ``rosmsg show`` itself prints one empty line more.

    Raises `DefinitionError`: as `Library.interface` does, or if the text would be too long.
    """
    interface = library.interface(name)
    printer = _Ros1() if library.dialect == "ros1" else _Ros2(library)
    _check_characters(printer, interface)
    lines: list[str] = []
    stack = [printer.root(interface)]
    while stack:
        for line, nested in stack[-1]:
            lines.append(printer.indent * (len(stack) - 1) + line)
            if nested is not None:
                stack.append(printer.nested(nested))
                break
        else:
            stack.pop()
    return "".join(f"{line}\n" for line in lines)


_Entries = Iterator[tuple[str, "Message | None"]]


def _check_characters(printer: _Ros1 | _Ros2, interface: Interface) -> None:
    """Refuse a text that would be too long; count its characters instead of writing it."""
    # Lines and characters of each type's text without indentation.
    lines: dict[str, int] = {}
    characters: dict[str, int] = {}

    def note(name: str, entries: _Entries) -> None:
        lines[name] = characters[name] = 0
        for line, nested in entries:
            lines[name] += 1
            characters[name] += len(line) + 1
            if nested is not None:
                lines[name] += lines[nested.name]
                indents = len(printer.indent) * lines[nested.name]
                characters[name] += characters[nested.name] + indents
        if characters[name] > MOST_CHARACTERS:
            message = (
                f"{name} is shown in {characters[name]} characters, which is more than "
                f"{MOST_CHARACTERS}"
            )
            raise DefinitionError.of(message)

    for part in _parts(interface):
        for message in closure(part.children):
            if message.name not in lines:
                note(message.name, printer.nested(message))
    note(interface.name, printer.root(interface))


def _parts(interface: Interface) -> tuple[Message, ...]:
    """List the messages that a definition declares itself."""
    match interface:
        case Service():
            return interface.request, interface.response
        case Action():
            return interface.goal, interface.result, interface.feedback
    return (interface,)


def _message_in(item: Field) -> Message | None:
    kind = item.element_type
    # ROS 1's builtin types have no package.
    return kind if isinstance(kind, Message) and kind.package else None


class _Ros1:
    indent = "  "

    def root(self, interface: Interface) -> _Entries:
        for index, part in enumerate(_parts(interface)):
            if index:
                yield _SEPARATOR, None
            yield from self.nested(part)

    def nested(self, message: Message) -> _Entries:
        for constant in message.constants:
            yield f"{constant.type} {constant.name}={constant.text}", None
        for item in message.fields:
            yield f"{item.type_text} {item.name}", _message_in(item)


class _Ros2:
    indent = "\t"

    def __init__(self, library: Library) -> None:
        self._library = library

    def root(self, interface: Interface) -> _Entries:
        parts = _parts(interface)
        if self._library.is_idl(interface.name):
            for index, part in enumerate(parts):
                if index:
                    yield _SEPARATOR, None
                yield from _as_msg(part)
            return
        fields = (item for part in parts for item in part.fields)
        for line, nested in _lines(interface.text, fields):
            yield line.rstrip(), nested

    def nested(self, message: Message) -> _Entries:
        if self._library.is_idl(message.name):
            yield from _as_msg(message, with_comments=False)
            return
        for line, nested in _lines(message.text, message.fields):
            shown = line.partition("#")[0].strip()
            if shown:
                yield shown, nested


def _lines(text: str, fields: Iterable[Field]) -> _Entries:
    """Yield the lines of a ROS 2 text, each with the message type of its field."""
    remaining = iter(fields)
    lines = [text[start : start + len(line)] for start, line in lines_of(text, "ros2")]
    if not lines[-1]:
        lines.pop()  # The empty text after the last line end is not a line.
    for line in lines:
        type_, _, rest = line.replace("\t", " ").partition("#")[0].rstrip().partition(" ")
        is_field = type_ and rest and "=" not in rest
        item = next(remaining, None) if is_field else None
        yield line, None if item is None else _message_in(item)


def _as_msg(message: Message, *, with_comments: bool = True) -> _Entries:
    """Write a message in the form of a ``.msg`` file."""
    if with_comments:
        yield from _comment(message.comment)
    members: Iterable[Constant | Field] = (*message.constants, *message.fields)
    for member in members:
        unit = ""
        if with_comments:
            yield from _comment(member.comment)
            unit = f"  # [{_in_a_line(member.unit)}]" if member.unit is not None else ""
        if isinstance(member, Constant):
            value = _literal(member.value)
            yield f"{member.type} {member.name}={value}{unit}", None
        else:
            default = "" if member.default is None else f" {_literal(member.default)}"
            type_ = str(member.type).replace("/msg/", "/")
            yield f"{type_} {member.name}{default}{unit}", _message_in(member)


def _comment(text: str) -> _Entries:
    for line in text.splitlines():
        yield f"# {line.strip()}".rstrip(), None


def _literal(value: Value) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str():
            return '"' + _in_a_line(value.replace('"', '\\"')) + '"'
        case tuple():
            return f"[{', '.join(map(_literal, value))}]"
    return repr(value)


def _in_a_line(text: str) -> str:
    """Write line ends as escapes, so that a text in IDL does not break its line."""
    return _LINE_END.sub(lambda end: ascii(end[0])[1:-1], text)
