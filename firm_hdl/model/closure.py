"""The transitive closure of message types: the given types and all types in their fields."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from firm_hdl.model.message import Message

__all__ = ["closure"]


def closure(roots: Iterable[Message]) -> list[Message]:
    """List messages and all messages in them, each once and after those in its fields.

    The stack is explicit, because definitions may nest deeper than Python's recursion limit.
    Messages of the same name are taken for the same type, as in one library.
    """
    done: dict[str, Message] = {}
    for root in roots:
        stack: list[tuple[Message, Iterator[Message]]] = []
        if root.name not in done:
            stack.append((root, iter(root.children)))
        while stack:
            message, children = stack[-1]
            child = next((c for c in children if c.name not in done), None)
            if child is None:
                stack.pop()
                done[message.name] = message
            else:
                stack.append((child, iter(child.children)))
    return list(done.values())
