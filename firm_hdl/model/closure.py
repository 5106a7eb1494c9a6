"""The transitive closure of message types: the given types and all types in their fields."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

from firm_hdl.model.message import Message
from firm_hdl.model.types import Array, FieldType, Sequence, element_of

__all__ = ["closure", "rebuilt"]


def closure(roots: Iterable[Message], *, parts_first: bool = True) -> list[Message]:
    """List messages and all messages in them, each once and after those in its fields.

    The stack is explicit, because definitions may nest deeper than Python's recursion limit.
    Messages of the same name count as the same type, as in one library.

    Parameters
    ----------
    parts_first : bool
        False lists each message when it is first met: a message before those in its fields, depth
        first, in the order of the fields.
    """
    met: dict[str, Message] = {}
    done: list[Message] = []
    for root in roots:
        stack: list[tuple[Message, Iterator[Message]]] = []
        if root.name not in met:
            met[root.name] = root
            stack.append((root, iter(root.children)))
        while stack:
            message, children = stack[-1]
            child = next((c for c in children if c.name not in met), None)
            if child is None:
                stack.pop()
                done.append(message)
            else:
                met[child.name] = child
                stack.append((child, iter(child.children)))
    return done if parts_first else list(met.values())


def rebuilt(message: Message, change: Callable[[Message], Message]) -> Message:
    """Return a message type with every message in it changed: each once, nested messages first.

    Parameters
    ----------
    change : callable
        Returns the changed message. Messages in its argument have been changed already.
    """
    made: dict[str, Message] = {}

    def changed(kind: FieldType) -> FieldType:
        inner = element_of(kind)
        if not isinstance(inner, Message):
            return kind
        new = made[inner.name]
        return replace(kind, element=new) if isinstance(kind, Array | Sequence) else new

    for part in closure([message]):
        fields = tuple(replace(item, type=changed(item.type)) for item in part.fields)
        made[part.name] = change(replace(part, fields=fields))
    return made[message.name]
