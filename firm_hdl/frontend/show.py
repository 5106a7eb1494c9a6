"""Definitions printed the way ROS's own tools print them.

For ROS 1 that is ``rosmsg show``: what the definition means, constants first. For ROS 2 it is
``ros2 interface show``: the text as it stands, with the definitions of nested types under each
field. Comments of nested types are left out, all of each: released ros2cli versions leave stray
``#`` behind, which they call a bug (ros2cli issue 769).
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from firm_hdl.frontend.library import Library
from firm_hdl.model import Array, Field, Message, Sequence

__all__ = ["show"]

_LINE_END = re.compile(r"\r\n|\r|\n")


def show(library: Library, name: str) -> str:
    """Print a type and the types in it.

    Parameters
    ----------
    library : Library
    name : str
        As for `Library.message`.

    Returns
    -------
    str
        Lines, each with its line end. ``rosmsg show`` itself prints one empty line more.

    Raises
    ------
    DefinitionError
        As `Library.message` does.
    """
    message = library.message(name)
    entries = _ros1_entries if library.dialect == "ros1" else _ros2_entries
    indent = "  " if library.dialect == "ros1" else "\t"
    lines = []
    stack = [iter(entries(message, True))]
    while stack:
        for line, nested in stack[-1]:
            lines.append(indent * (len(stack) - 1) + line if line else "")
            if nested is not None:
                stack.append(iter(entries(nested, False)))
                break
        else:
            stack.pop()
    return "".join(f"{line}\n" for line in lines)


_Entry = tuple[str, "Message | None"]


def _nested(item: Field) -> Message | None:
    kind = item.type.element if isinstance(item.type, Array | Sequence) else item.type
    # ROS 1's builtin types have no package.
    return kind if isinstance(kind, Message) and kind.package else None


def _ros1_entries(message: Message, is_root: bool) -> Iterator[_Entry]:
    for constant in message.constants:
        yield f"{constant.type} {constant.name}={constant.text}", None
    for item in message.fields:
        yield f"{item.type} {item.name}", _nested(item)


def _ros2_entries(message: Message, is_root: bool) -> Iterator[_Entry]:
    fields = iter(message.fields)
    item = next(fields, None)
    start = 0
    lines = _LINE_END.split(message.text)
    if not lines[-1]:
        lines.pop()  # What follows the last line's end is no line.
    for line in lines:
        end = message.text.find(line, start) + len(line)
        nested = None
        if item is not None and item.span is not None and item.span.start < end:
            nested = _nested(item)
            item = next(fields, None)
        start = end
        shown = line.rstrip() if is_root else line.partition("#")[0].strip()
        if shown or is_root:
            yield shown, nested
