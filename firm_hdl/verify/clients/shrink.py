"""Reduces a type and a value to the smallest ones that still show a difference."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace

from firm_hdl.cases.values import Plain, changed, packed
from firm_hdl.model import (
    Array,
    Field,
    FieldType,
    Message,
    Primitive,
    String,
    closure,
    map_messages,
)
from firm_hdl.model import Sequence as SequenceType
from firm_hdl.verify.clients.finding import Finding
from firm_hdl.verify.references.objects import full_text

__all__ = ["shrunk"]

MOST_SECONDS = 10.0


def shrunk(
    finding: Finding,
    again: Callable[[Message, str, Plain], Finding | None],
    *,
    seconds: float = MOST_SECONDS,
) -> Finding:
    """Return a minimal difference of the same kind.

    Parameters
    ----------
    again : callable
        Repeats the question with another type and value; see `LibraryComparison.again`.
    seconds : float
        The time limit; after it, the smallest difference so far is returned.
    """
    until = time.monotonic() + seconds
    is_smaller = True
    while is_smaller:
        is_smaller = False
        for message, value in _smaller(finding.message, finding.value):
            if time.monotonic() > until:
                return finding
            found = again(message, finding.what, value)
            # The unusual case may be put back into the value, which is no smaller then.
            if found is not None and _size(found) < _size(finding):
                finding, is_smaller = found, True
                break
    return finding


def _size(finding: Finding) -> tuple[int, int, int]:
    """Return the sizes of definition and value, and the number of bytes other than NUL and x."""
    data = packed(finding.message, finding.value)
    return len(full_text(finding.message)), len(data), sum(byte not in b"\0x" for byte in data)


def _smaller(message: Message, value: Plain) -> Iterator[tuple[Message, Plain]]:
    """Yield smaller types and values, the smallest first."""
    for item in message.fields:
        yield from _inside(item.type, value[item.name])
    fields = message.fields
    for size in dict.fromkeys((len(fields) // 2, len(fields) // 4, 1)):
        if not 0 < size < len(fields):
            continue
        for first in range(0, len(fields), size):
            kept = fields[:first] + fields[first + size :]
            yield replace(message, fields=kept), {f.name: value[f.name] for f in kept}
    for item in message.fields:
        for kind, inner in _smaller_field(item.type, value[item.name]):
            other = tuple(replace(f, type=kind) if f is item else f for f in fields)
            yield replace(message, fields=other), {**value, item.name: inner}
    for nested in closure([message])[:-1]:
        for item in nested.fields if nested.package else ():
            yield _without(message, value, nested, item)


def _inside(kind: FieldType, value: Plain) -> Iterator[tuple[Message, Plain]]:
    match kind:
        case Message() if kind.package:
            yield kind, value
        case Array(element=Message() as element) | SequenceType(element=Message() as element):
            if element.package:
                yield from ((element, each) for each in value[:4])


def _smaller_field(kind: FieldType, value: Plain) -> Iterator[tuple[FieldType, Plain]]:
    match kind:
        case Primitive() if value:
            yield kind, type(value)(0)
        case String() | SequenceType() if value:
            yield kind, value[:0]
            yield kind, value[: len(value) // 2]
            yield kind, value[len(value) // 2 :]
            yield kind, value[1:]
        case Array() if kind.count > 1:
            yield replace(kind, count=1), value[:1]
            half = kind.count // 2
            yield replace(kind, count=half), value[:half]
            yield replace(kind, count=kind.count - half), value[half:]
    match kind:
        case String(wide=False) if value.strip(b"x"):
            yield kind, b"x" * len(value)
        case Array(element=element) | SequenceType(element=element) if value:
            # One element at a time, so that each becomes as small as it can be.
            for n, each in enumerate(value[:8]):
                for inner, less in _smaller_field(element, each):
                    if inner == element:
                        yield kind, [*value[:n], less, *value[n + 1 :]]
        case Message() if kind.package:
            for item in kind.fields:
                for inner, less in _smaller_field(item.type, value[item.name]):
                    if inner == item.type:
                        yield kind, {**value, item.name: less}


def _without(message: Message, value: Plain, owner: Message, item: Field) -> tuple[Message, Plain]:
    """Take a field out of a nested message type, wherever the type occurs."""

    def is_kept(kind: Message, name: str) -> bool:
        return kind.name != owner.name or name != item.name

    def without(kind: FieldType, given: Plain) -> Plain:
        if not isinstance(kind, Message):
            return given
        return {name: each for name, each in given.items() if is_kept(kind, name)}

    def change(kind: Message) -> Message:
        return replace(kind, fields=tuple(f for f in kind.fields if is_kept(kind, f.name)))

    return map_messages(message, change), changed(message, value, without)
