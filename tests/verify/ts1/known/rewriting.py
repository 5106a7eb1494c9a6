"""Helpers for tests of single entries of the table of known differences."""

from __future__ import annotations

import pytest

from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.known import KNOWN

BY_KEY = {entry.key: entry for entry in KNOWN}


def case_of(text, *, dialect="ros2", language="msg", kind=None, name="A", before=None, included=()):
    return DefinitionCase(
        dialect=dialect,
        package="p",
        kind=kind or ("msg" if language == "idl" else language),
        name=name,
        language=language,
        text=text,
        before=before,
        included=included,
    )


APART = {"idl-includes", "idl-short-annotations", "idl-unseen-bounds", "idl-values"}
"""Keys of rewritings that have tests of their own."""


def rewritten(key, text, **more):
    rewrite = BY_KEY[key].rewrite
    assert rewrite is not None
    return rewrite(case_of(text, **more))


def hidden(text):
    """Replace characters by their placeholders in the private use area."""
    return "".join(chr(0xE000 + ord(each)) for each in text)


def numbered(rows):
    return [pytest.param(*row, id=f"{number}-{row[0]}") for number, row in enumerate(rows)]
