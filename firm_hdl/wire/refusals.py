"""Legal definitions that cannot be laid out on any wire.

IDL has a `long double`. rosidl reads it, so such a type can be shown. But systems do not agree
about its bytes, so it cannot be laid out (:attr:`firm_hdl.model.Primitive.has_wire_format`).

A layout writes out every nested message. A few small files can describe a type with more fields
than a computer can hold, so the fields are counted before they are written out.
"""

from __future__ import annotations

from firm_hdl.errors import Diagnostic
from firm_hdl.model import Message, Primitive, closure

__all__ = ["MAX_LEAVES", "MAX_LEVELS", "refusals", "too_large"]

MAX_LEAVES = 32_767
"""Largest number of fields of a message with all nested messages written out.

A serializer has at least two input bits for each field, and Amaranth elaborates at most 65,535.
"""

MAX_LEVELS = 32
"""Largest nesting depth of messages: layouts, plans and circuits are built recursively."""


def refusals(message: Message) -> list[Diagnostic]:
    """Find why a message cannot be laid out on any wire: its fields or its size.

    Returns: one for each field without a wire format, in the message and in all messages in it. The
    types are walked depth first, and the span is the field's name. If there is no such field, at
    most one for the size, without a span. Empty if the message can be laid out.
    """
    return _without_bytes(message) or too_large(message)


def too_large(message: Message) -> list[Diagnostic]:
    """Check whether a message has too many levels or fields to be laid out.

    Returns: at most one, with the count and the limit.
    """
    if message.depth > MAX_LEVELS:
        text = f"{message.depth} levels of messages, and at most {MAX_LEVELS}"
    elif message.leaf_count > MAX_LEAVES:
        text = (
            f"{message.leaf_count} fields when all messages in it are written out, and at most "
            f"{MAX_LEAVES}"
        )
    else:
        return []
    return [Diagnostic(f"{message.name} has {text} can be laid out")]


def _without_bytes(message: Message) -> list[Diagnostic]:
    found: list[Diagnostic] = []
    for owner in closure([message], parts_first=False):
        for item in owner.fields:
            kind = item.element_type
            if isinstance(kind, Primitive) and not kind.has_wire_format:
                what = f"field '{item.name}' of {owner.name} is of type '{kind}'"
                why = "systems do not agree about its bytes, so it cannot be put on a wire"
                found.append(Diagnostic(f"{what}: {why}", item.span))
    return found
