"""Comments: their definitions, and the units that they name."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from firm_hdl.frontend.parse import condense

from .reading import parse


def comments(text, dialect="ros2"):
    syntax = parse(text, dialect)
    return syntax.comment, {m.name.text: m.comment for m in syntax.members}


def test_head_comment_ends_at_the_first_line_without_a_comment():
    text = "# one\n#  two\n\n# of a\nint32 a\n"
    assert comments(text) == ("one\n two", {"a": "of a"})


def test_comment_above_and_after_are_joined():
    assert comments("\n# above\nint32 a # after\n") == ("", {"a": "above\nafter"})


def test_signs_in_front_of_a_comment_are_not_of_it():
    text = "## head #1\n#\n##\n### more\n\n## of a\nint32 a ## after #2\n    ### on\n"
    assert comments(text) == ("head #1\n\nmore", {"a": "of a\nafter #2\non"})


def test_blanks_after_a_comment_are_not_of_it():
    text = "# head \t\n#  \nint32 a # one  \n  # two \n\n# of b \nint32 b\n"
    assert comments(text) == ("head", {"a": "one\ntwo", "b": "of b"})
    assert comments(text, "ros1") == comments(text)


def test_an_indented_comment_ends_the_head():
    assert comments("# head\n  # lost\n# of a\nint32 a\n") == ("head", {"a": "of a"})


@pytest.mark.parametrize("dialect", ["ros1", "ros2"])
@pytest.mark.parametrize("type_", ["int8", "bool[]", "float32[2]", "string", "q/Foo", "q/Foo[]"])
def test_comment_may_begin_right_after_a_name(type_, dialect):
    text = f"\n{type_} a# of a\n{type_} b#\n{type_} c ## of c\n"
    assert comments(text, dialect) == ("", {"a": "of a", "b": "", "c": "of c"})


def test_indented_comment_continues_the_definition_before_it():
    text = "int32 a # one\n        # two\n# of b\nint32 b\n"
    assert comments(text)[1] == {"a": "one\ntwo", "b": "of b"}


def test_indented_comment_before_all_definitions_is_dropped():
    assert comments("\n  # lost\nint32 a\n") == ("", {"a": ""})


def test_comment_after_the_last_definition_is_dropped():
    assert comments("int32 a\n# lost\n") == ("", {"a": ""})


def test_hash_in_a_ros1_text_constant_is_no_comment():
    assert comments("string A=x # y\n", "ros1")[1] == {"A": ""}
    assert comments("string A=x # y\n", "ros2")[1] == {"A": "y"}


@pytest.mark.parametrize(
    ("lines", "comment", "unit"),
    [
        (["speed [m/s]"], "speed", "m/s"),
        (["[m/s] speed"], "speed", "m/s"),
        (["a [m]", "b [s]"], "a [m]\nb [s]", None),
        (["range [0, 1]"], "range [0, 1]", None),
        (["range [0, 1] [m]"], "range [0, 1]", "m"),
        (["empty []"], "empty []", None),
        (["open [m"], "open [m", None),
        (["", "a", "", "", "b", ""], "a\n\nb", None),
        (["  a", "   b"], "a\n b", None),
        (["  a", "b"], "  a\nb", None),
        (["a [m]", "b [m]"], "a [m]\nb [m]", None),
        (["a  [m] b", "c [s, t]"], "a b\nc [s, t]", "m"),
        ([], "", None),
        ([" [m]"], "", "m"),
    ],
)
def test_units_and_empty_lines(lines, comment, unit):
    assert condense(lines) == (comment, unit)


@given(st.text(alphabet="[],a \n\t"))
def test_unit_is_what_the_expression_of_rosidl_finds(text):
    found = re.findall(r"\s*\[([^,\]]+)\]", text)
    assert condense(text.split("\n"))[1] == (found[0] if len(found) == 1 else None)


def test_brackets_by_the_thousand_take_no_time():
    # A backtracking regular expression with this meaning would take minutes.
    assert condense(["[" * 1_000_000 + " " * 1_000_000 + "x"])[1] is None
