"""What a definition may say and no wire can carry.

IDL has a `long double`. rosidl reads it, so that a type with one can be looked at; but systems do
not agree about its bytes, so no layout has one (:attr:`firm_hdl.model.Primitive.has_wire_format`).
"""

from __future__ import annotations

from firm_hdl.errors import Diagnostic
from firm_hdl.model import Array, Message, Primitive, Sequence

__all__ = ["refusals"]


def refusals(message: Message) -> list[Diagnostic]:
    """Find the fields that no wire has, in a message and in all messages in it.

    Returns
    -------
    list of Diagnostic
        One for each field, at its name, in the order in which the types are first named; empty if
        the message can be laid out.
    """
    found: list[Diagnostic] = []
    seen = {message.name}
    # Nesting may be deeper than Python's recursion limit.
    pending = [message]
    while pending:
        owner = pending.pop()
        for item in owner.fields:
            kind = item.type.element if isinstance(item.type, Array | Sequence) else item.type
            if isinstance(kind, Primitive) and not kind.has_wire_format:
                what = f"field '{item.name}' of {owner.name} is of type '{kind}'"
                why = "systems do not agree about its bytes, so it cannot be put on a wire"
                found.append(Diagnostic(message=f"{what}: {why}", span=item.span))
        new = [child for child in owner.children if child.name not in seen]
        seen.update(child.name for child in new)
        pending += reversed(new)
    return found
