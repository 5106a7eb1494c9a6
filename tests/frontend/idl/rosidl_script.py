"""Read IDL texts with rosidl_parser; run by Debian's Python, which has it.

The script reads a list of texts as JSON, and writes for each text a list of messages, or the error
of rosidl_parser. It imports nothing of firm-hdl.
"""

import json
import sys

from rosidl_parser import definition, parser


def type_text(kind):
    """Write a type in one line."""
    if isinstance(kind, definition.BasicType):
        return kind.typename
    if isinstance(kind, definition.NamedType):
        return "unknown " + kind.name
    if isinstance(kind, definition.NamespacedType):
        return "::".join([*map(str, kind.namespaces), str(kind.name)])
    if isinstance(kind, definition.AbstractGenericString):
        word = "wstring" if isinstance(kind, definition.AbstractWString) else "string"
        return word + (f"<{kind.maximum_size}>" if kind.has_maximum_size() else "")
    element = type_text(kind.value_type)
    if isinstance(kind, definition.Array):
        return f"{element}[{kind.size}]"
    bound = f", {kind.maximum_size}" if kind.has_maximum_size() else ""
    return f"sequence<{element}{bound}>"


def annotation(member, name):
    """Return the text after ``value=``."""
    values = member.get_annotation_values(name)
    return values[0].get("value") if values and isinstance(values[0], dict) else None


def message(found):
    """Describe a message."""
    return {
        "name": str(found.structure.namespaced_type.name),
        "comment": found.structure.get_comment_lines(),
        "fields": [
            {
                "name": str(member.name),
                "type": type_text(member.type),
                "default": annotation(member, "default"),
                "unit": annotation(member, "unit"),
                "comment": member.get_comment_lines(),
            }
            for member in found.structure.members
        ],
        "constants": [
            {
                "name": str(constant.name),
                "type": type_text(constant.type).partition("<")[0],
                "value": constant.value,
                "comment": constant.get_comment_lines(),
            }
            for constant in found.constants
        ],
    }


def messages(text):
    """List the messages that a text declares."""
    for element in parser.parse_idl_string(text).elements:
        if isinstance(element, definition.Message):
            yield message(element)
        elif isinstance(element, definition.Service):
            yield message(element.request_message)
            yield message(element.response_message)
        elif isinstance(element, definition.Action):
            for part in (element.goal, element.result, element.feedback):
                yield message(part)


def answer(text):
    """Return the messages of a text, or the text of the exception."""
    try:
        return list(messages(text))
    except Exception as error:
        return f"{type(error).__name__}: {error}".partition("\n")[0]


json.dump([answer(text) for text in json.load(sys.stdin)], sys.stdout)
