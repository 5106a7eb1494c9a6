"""Terminals of the grammars, on all short words of characters at borders of classes.

The rules of ROS are restated here, independently of the grammars: Python's `int` and `float`, and
the regular expressions of genmsg and rosidl.
"""

from __future__ import annotations

import re
from itertools import product

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend.parse import is_type_name
from tests.frontend.reading import parse

# Types of both dialects.
BUILTIN = "bool byte char float32 float64 string " + " ".join(
    f"{u}int{bits}" for u in ("", "u") for bits in (8, 16, 32, 64)
)
# `A` to `Z`, `a` to `z`, `0` to `9`, and the characters just outside of them.
BORDERS = "AZ@[az`{09:_"
NAME = r"[A-Za-z][A-Za-z0-9_]*"
ROS2_NAME = r"(?!.*__)(?!.*_$)[a-z][a-z0-9_]*"
ROS2_MESSAGE = r"[A-Z][A-Za-z0-9]*"
ROS2_CONSTANT = r"[A-Z]([A-Z0-9_]?[A-Z0-9]+)*"


def words(alphabet, longest):
    for length in range(1, longest + 1):
        yield from map("".join, product(alphabet, repeat=length))


def member(line, dialect):
    """Return the only member of a line, or `None` if it is refused."""
    try:
        (only,) = parse(line, dialect).members
    except DefinitionError:
        return None
    return only


@pytest.mark.parametrize(
    ("dialect", "line", "rule"),
    [
        ("ros1", "int8 {}", NAME),
        ("ros1", "int8 {}=1", r"[A-Za-z_][A-Za-z0-9_]*"),
        ("ros1", "{}/Foo x", NAME),
        ("ros2", "int8 {}", ROS2_NAME),
        ("ros2", "int8 {}=1", ROS2_CONSTANT),
        ("ros2", "{} x", ROS2_MESSAGE),
        ("ros2", "{}/Foo x", ROS2_NAME),
        ("ros2", "foo/{} x", ROS2_MESSAGE),
    ],
)
def test_names(dialect, line, rule):
    for word in (*words(BORDERS, 2), *words("aA09_", 4)):
        legal = re.fullmatch(rule, word) is not None
        assert (member(line.format(word), dialect) is not None) == legal, word


def test_type_names_of_ros1():
    for word in (*words(BORDERS, 2), *words("aA09_", 3)):
        for name in (word, f"foo/{word}"):
            assert is_type_name(name, "ros1") == (re.fullmatch(NAME, word) is not None), name


@pytest.mark.parametrize("dialect", ["ros1", "ros2"])
def test_integers(dialect):
    tails = (*words("09afg78_", 2), *words("19_", 3))
    others = (f"{sign}0{base}{tail}" for sign in ("", "-") for base in "xXoObB" for tail in tails)
    for word in (*words("09_+-", 4), *others):
        try:
            want = int(word)
        except ValueError:
            try:
                want = int(word, 0) if dialect == "ros2" else None
            except ValueError:
                want = None
        found = member(f"int64 X={word}", dialect)
        assert (found and found.value.value) == want, word


@pytest.mark.parametrize("dialect", ["ros1", "ros2"])
def test_numbers(dialect):
    for word in (*words("09._e", 4), *words("9+-.e", 4), *words("9._", 5), "9e9_9", "1e0_0"):
        try:
            want = float(word)
        except ValueError:
            want = None
        found = member(f"float64 X={word}", dialect)
        assert (found and found.value.value) == want, word


@pytest.mark.parametrize("word", "time duration".split())
def test_words_that_go_on_after_a_builtin_type_of_ros1(word):
    for letter in "AZaz09_":
        found = member(f"{word}{letter} x", "ros1")
        assert found is not None and found.type.name == word + letter
        assert not found.type.is_builtin
    assert member(f"{word}/Foo x", "ros1").type.package == word


@pytest.mark.parametrize("word", BUILTIN.split())
def test_words_that_go_on_after_a_builtin_type(word):
    for letter in "AZaz09_":
        found = member(f"{word}{letter} x", "ros1")
        assert found is not None and found.type.name == word + letter
        assert not found.type.is_builtin
        assert member(f"{word}{letter} x", "ros2") is None
        # The error marks the whole word.
        with pytest.raises(DefinitionError, match=f"'{word}{letter}'"):
            parse(f"{word}{letter} x", "ros2")
    for dialect in ("ros1", "ros2"):
        assert member(f"{word}/x", dialect) is None
        assert member(f"{word}/Foo x", dialect).type.package == word


@pytest.mark.parametrize(
    ("dialect", "words"),
    [
        ("ros1", "bool byte char int8 int16 int32 int64 uint8 uint16 uint32 uint64"),
        ("ros1", "float32 float64 string time duration"),
        ("ros2", "bool byte char int8 int16 int32 int64 uint8 uint16 uint32 uint64"),
        ("ros2", "float32 float64 string wstring"),
    ],
)
def test_builtin_types(dialect, words):
    for word in words.split():
        for line in (f"{word} x", f"{word}[] x", f"{word}[12] x"):
            found = member(line, dialect)
            assert found is not None and found.type.is_builtin, line
        if word not in ("time", "duration"):
            value = "1" if word != "string" else "a"
            assert member(f"{word} X={value}", dialect) is not None


def test_sizes_and_bounds():
    for word in words("09_+", 3):
        legal = re.fullmatch(r"\+?[0-9]+(_[0-9]+)*", word) is not None
        for line in (f"int8[<={word}] x", f"string<={word} x"):
            found = member(line, "ros2")
            size = found and (found.type.size or found.type.bound).value
            assert size == (int(word) if legal else None), line
        found = member(f"int8[{word}] x", "ros1")
        want = int(word) if re.fullmatch("[0-9]+", word) else None
        assert (found and found.type.size.value) == want, word
