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


@pytest.fixture(scope="module")
def verdicts():
    texts = {}
    for group in (AGREED, ALLOWED_HERE, REFUSED_HERE, OTHERWISE):
        assert not texts.keys() & group.keys()
        texts |= group
    return dict(zip(texts, rosidl([*texts.values()]), strict=True))


def test_there_are_many_variations():
    assert len(AGREED) + len(ALLOWED_HERE) + len(REFUSED_HERE) + len(OTHERWISE) > 150


@pytest.mark.parametrize("name", AGREED)
def test_agrees_with_rosidl(name, verdicts):
    messages, wrong = read(AGREED[name])
    theirs = verdicts[name]
    if isinstance(theirs, str):
        assert wrong, theirs
        assert all(d.span is not None for d in wrong)
    else:
        assert wrong == []
        assert describe(messages) == theirs


@pytest.mark.parametrize("name", ALLOWED_HERE)
def test_accepts_what_rosidl_cannot_evaluate(name, verdicts):
    assert isinstance(verdicts[name], str)
    assert read(ALLOWED_HERE[name])[1] == []


@pytest.mark.parametrize("name", REFUSED_HERE)
def test_refuses_what_rosidl_lets_through(name, verdicts):
    assert isinstance(verdicts[name], list)
    assert read(REFUSED_HERE[name])[1]


@pytest.mark.parametrize("name", OTHERWISE)
def test_reads_what_the_standard_says_where_rosidl_does_not(name, verdicts):
    messages, wrong = read(OTHERWISE[name])
    assert wrong == []
    assert isinstance(verdicts[name], list)
    assert describe(messages) != verdicts[name]


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
