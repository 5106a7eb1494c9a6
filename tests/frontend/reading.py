"""Lines of definitions, read: what stands in them, or what is said of them."""

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
    # Whatever is wrong is shown where it stands, or right after what stands there.
    assert diagnostic.span is not None
    assert 0 <= diagnostic.span.start <= diagnostic.span.end <= len(line) + 1
    return diagnostic.message


def spelled(line, dialect="ros2"):
    """Write a field's type down again, with all that the tree knows."""
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
