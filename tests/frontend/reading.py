"""Readers of single lines of definitions: their members, or their errors."""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError, Source
from firm_hdl.frontend.parse import parse_message
from firm_hdl.frontend.syntax import ConstantSyntax, FieldSyntax


def parse(text, dialect):
    return parse_message(Source(name="T.msg", text=text), dialect)


def member(line, dialect):
    (only,) = parse(line, dialect).members
    return only


def field(line, dialect="ros2"):
    only = member(line, dialect)
    assert isinstance(only, FieldSyntax)
    return only


def constant(line, dialect="ros2"):
    only = member(line, dialect)
    assert isinstance(only, ConstantSyntax)
    return only


def refused(line, dialect):
    with pytest.raises(DefinitionError) as error:
        parse(line, dialect)
    (diagnostic,) = error.value.diagnostics
    # Every error is shown within its line, or right after it.
    assert diagnostic.span is not None
    assert 0 <= diagnostic.span.start <= diagnostic.span.end <= len(line) + 1
    return diagnostic.message


def spelled(line, dialect="ros2"):
    """Return the text of a field's type, with all properties in the tree."""
    type_ = field(line, dialect).type
    text = f"{type_.package}/" * (type_.package is not None) + type_.name
    if type_.bound:
        text += f"<={type_.bound.value}"
    match type_.array:
        case "array":
            text += f"[{type_.size.value}]"
        case "sequence":
            text += f"[<={type_.size.value}]" if type_.size else "[]"
    return text
