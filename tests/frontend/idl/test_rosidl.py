"""The reader of IDL, compared with rosidl_parser on real files and on small variations.

``docs/reference/errata.md`` has the differences on purpose.
"""

from __future__ import annotations

import math

import pytest

from .rosidl import describe, read, rosidl
from .variations import AGREED, ALLOWED_HERE, OTHERWISE, REFUSED_HERE


@pytest.fixture(scope="module")
def files(corpus):
    found = sorted([*corpus.glob("ros2/**/*.idl"), *corpus.glob("rosidl_*/**/*.idl")])
    assert len(found) >= 50
    return {str(p.relative_to(corpus)): p.read_text(encoding="utf-8") for p in found}


def test_real_files_have_the_structure_that_rosidl_reads(files):
    for (path, text), theirs in zip(files.items(), rosidl([*files.values()]), strict=True):
        messages, wrong = read(text)
        ours = describe(messages)
        assert isinstance(theirs, list), theirs
        if path.endswith("MyMessage.idl"):
            # rosidl_parser keeps the name of a constant as the bound.
            assert "long double" in [f["type"] for f in theirs[0]["fields"]]
            (field,) = [f for f in theirs[0]["fields"] if "UNSIGNED_LONG_CONSTANT" in f["type"]]
            field["type"] = "wstring<42>"
        assert wrong == [], path
        for message in ours if len(ours) > 1 else []:
            message["comment"] = []  # rosidl_parser has none for parts of services and actions.
        assert ours == theirs, path


# All texts in one test, because rosidl takes seconds to start.
def test_variations_are_read_as_rosidl_reads_them_or_differ_on_purpose():
    texts = {}
    for group in (AGREED, ALLOWED_HERE, REFUSED_HERE, OTHERWISE):
        assert not texts.keys() & group.keys()
        texts |= group
    assert len(texts) > 150
    for (name, text), theirs in zip(texts.items(), rosidl([*texts.values()]), strict=True):
        messages, wrong = read(text)
        is_refused = isinstance(theirs, str)
        assert bool(wrong) == ((is_refused and name in AGREED) or name in REFUSED_HERE), name
        if name in AGREED:
            assert all(d.span is not None for d in wrong), name
            assert is_refused or describe(messages) == theirs, name
        else:
            # What rosidl cannot evaluate, lets through, or reads against the standard.
            assert is_refused == (name in ALLOWED_HERE), name
            assert name not in OTHERWISE or describe(messages) != theirs, name


def test_texts_are_those_of_rosidl():
    parts = [
        r"a\n\t\v\b\r\f\a", r"\"q\"", r"\\", r"\\\\", r"\\\"", r"\x41\x7e", r"\1\12\101\377",
        r"\u0041", r"\?", r"\q", "é", "\u2122", r"a\'b", "/* no */ // comment", "#", "",
    ]  # fmt: skip
    constants = "".join(
        f'const string S{i} = "{part}"; const wstring W{i} = L"{part}"; '
        for i, part in enumerate(parts)
    )
    text = f"module p {{ module T_Constants {{ {constants} }}; struct T {{ long a; }}; }};"
    messages, wrong = read(text)
    assert wrong == []
    assert describe(messages) == rosidl([text])[0]


def test_numbers_are_those_of_rosidl():
    values = "0 7 12 -23 +5 1.25 1. .5 -1e10 1.9e+10 9E-05 1e5 8.7d 4.d .3d 7d 1.5D 00.5 09.5"
    defaults = "".join(
        f"@default(value={value}) double d{i};" for i, value in enumerate(values.split())
    )
    text = f"module p {{ struct T {{ {defaults} }}; }};"
    messages, wrong = read(text)
    assert wrong == []
    theirs = rosidl([text])[0]
    for ours, field in zip(describe(messages)[0]["fields"], theirs[0]["fields"], strict=True):
        assert math.isclose(ours["default"], field["default"])
        assert isinstance(ours["default"], float)
