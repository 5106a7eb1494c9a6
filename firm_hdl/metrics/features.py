"""The features of the definition language that a message type uses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from firm_hdl.model import Array, Field, Message, Primitive, Sequence, String, element_of

__all__ = ["FEATURES", "features_of"]

FEATURES: dict[str, str] = {
    "constants": "a constant",
    "defaults": "a field with a default value",
    "messages": "a field that is a message",
    "empty_messages": "a message without fields",
    "long_doubles": "a long double, so that there are no sizes",
    "strings": "a string",
    "bounded_strings": "a string with a bound",
    "wstrings": "a wstring",
    "bounded_wstrings": "a wstring with a bound",
    "arrays_of_primitives": "a fixed array of primitives",
    "arrays_of_strings": "a fixed array of strings or wstrings",
    "arrays_of_messages": "a fixed array of messages",
    "sequences_of_primitives": "a sequence of primitives",
    "sequences_of_strings": "a sequence of strings or wstrings",
    "sequences_of_messages": "a sequence of messages",
    "bounded_sequences": "a sequence with a bound",
    "nested_sequences": "a sequence of messages that have sequences themselves",
}
"""Every feature, with the construct that has it."""


def features_of(message: Message, parts: Mapping[Message, frozenset[str]]) -> frozenset[str]:
    """List the features of a type, given those of the messages in it."""
    found = set().union(*parts.values())
    if message.constants:
        found.add("constants")
    if not message.fields:
        found.add("empty_messages")
    for item in message.fields:
        found.update(_features_of_field(item, parts))
    return frozenset(found)


def _features_of_field(item: Field, parts: Mapping[Message, frozenset[str]]) -> Iterator[str]:
    if item.default is not None:
        yield "defaults"
    kind = item.type
    element = element_of(kind)
    match element:
        case Primitive():
            of = "primitives"
            if not element.has_wire_format:
                yield "long_doubles"
        case String(bound=bound, wide=wide):
            of = "strings"
            yield (
                ("wstrings" if wide else "strings")
                if bound is None
                else ("bounded_wstrings" if wide else "bounded_strings")
            )
        case Message():
            of = "messages"
            if element.package:
                yield "messages"
    if isinstance(kind, Array):
        yield f"arrays_of_{of}"
    if isinstance(kind, Sequence):
        yield f"sequences_of_{of}"
        if kind.bound is not None:
            yield "bounded_sequences"
        if isinstance(element, Message) and any(f.startswith("sequences_") for f in parts[element]):
            yield "nested_sequences"
