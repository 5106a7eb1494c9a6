"""Readers of single lines of definitions: their members, or their errors."""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError, Source
from firm_hdl.frontend.parse import read_message
from firm_hdl.frontend.syntax import ConstantSyntax, FieldSyntax


def parse(text, dialect):
    syntax, diagnostics = read_message(Source(name="T.msg", text=text), dialect)
    if diagnostics:
        raise DefinitionError(diagnostics)
    return syntax


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
