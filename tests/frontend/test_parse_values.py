"""The grammar of each dialect: constants and defaults."""

from __future__ import annotations

import math

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend.interfaces import check_members
from firm_hdl.frontend.syntax import ListSyntax

from .reading import constant, field, parse, refused

# What may follow a value that is complete. Quotes and brackets in a comment mean nothing.
AFTER = ["", "  ", "#", "# c", " \t# 'c' \"d\" [1] = e]"]


@pytest.mark.parametrize("after", AFTER)
@pytest.mark.parametrize(
    ("type_", "text", "value"),
    [
        ("int32", "5", 5),
        ("uint8", "0x1F", 31),
        ("float64", "1.5", 1.5),
        ("float32", "-inf", -math.inf),
        ("bool", "1", True),
        ("bool", "False", False),
    ],
)
def test_values_end_where_a_comment_starts(type_, text, value, after):
    if not text.startswith("0x"):
        assert constant(f"{type_} X={text}{after}", "ros1").value.value == value
    found = constant(f"{type_} X = {text}{after}").value
    assert (found.value, found.text) == (value, text)
    assert field(f"{type_} x {text}{after}").default.value == value
    (item,) = field(f"{type_}[] x [{text}]{after}").default.items
    assert (item.value, item.text) == (value, text)


@pytest.mark.parametrize("text", ["010", "+1_0"])
@pytest.mark.parametrize("dialect", ["ros1", "ros2"])
def test_integers_are_decimal_even_with_a_leading_zero(dialect, text):
    assert constant(f"int32 X={text}", dialect).value.value == 10


@pytest.mark.parametrize(
    ("text", "value"), [("0x10", 16), ("-0xFf", -255), ("0b101", 5), ("0o17", 15), ("0X_1", 1)]
)
def test_other_bases_are_ros2_only(text, value):
    assert constant(f"int32 X={text}").value.value == value
    assert field(f"int32 x {text}").default.value == value
    assert refused(f"int32 X={text}", "ros1") == f"'{text}' is not a decimal integer"


@pytest.mark.parametrize("text", ["nan", "NaN", "-NAN"])
@pytest.mark.parametrize("dialect", ["ros1", "ros2"])
def test_numbers_that_are_none(dialect, text):
    assert math.isnan(constant(f"float64 X={text}", dialect).value.value)


@pytest.mark.parametrize(
    ("dialect", "text", "value"),
    [
        ("ros1", "True", True),
        ("ros1", "False", False),
        ("ros1", "1", True),
        ("ros1", "0", False),
        ("ros1", "00", False),
        ("ros1", "-2", True),
        ("ros1", "-0", False),
        ("ros1", "+00", False),
        ("ros1", "+10", True),
        ("ros2", "true", True),
        ("ros2", "TRUE", True),
        ("ros2", "False", False),
        ("ros2", "1", True),
        ("ros2", "0", False),
    ],
)
def test_truth_values(dialect, text, value):
    assert constant(f"bool X={text}", dialect).value.value is value


@pytest.mark.parametrize(
    ("line", "value"),
    [
        ("string X=abc", "abc"),
        ("string X =  a b  ", "a b"),
        ('string X="a # b" # c', '"a # b" # c'),
        ("string X=#", "#"),
        ("string X=a=b", "a=b"),
        ("string X='", "'"),
        ("string X=", ""),
        ("string X=   ", ""),
        ("\tstring  X=a", "a"),
        ("string X=\ta\t b\t", "a\t b"),
    ],
)
def test_ros1_text_constant_takes_all_that_follows(line, value):
    assert constant(line, "ros1").value.value == value


def test_ros1_comment_before_the_equals_sign_makes_no_constant():
    assert field("string x # = 5", "ros1").comment == "= 5"


@pytest.mark.parametrize(
    ("written", "value"),
    [
        ("abc", "abc"),
        ("a b  # c", "a b"),
        ('"a b "', "a b "),
        ("' a'", " a"),
        ('"a # b"', '"a'),
        (r'"a\"b"', 'a"b'),
        (r"'a\'b'", "a'b"),
        (r'"a\'b"', r"a\'b"),
        (r'"a\\b\n"', r"a\\b\n"),
        ('"a\'b"', "a'b"),
        ('"abc', '"abc'),
        ("a\"b'c", "a\"b'c"),
        ('""', ""),
        ("a\tb", "a b"),
        ("[1]", "[1]"),
        ("größe", "größe"),
    ],
)
def test_ros2_texts(written, value):
    for after in AFTER if "#" not in written else AFTER[:1]:
        assert constant(f"string X={written}{after}").value.value == value
        assert constant(f"wstring X = {written}{after}").value.value == value
        assert field(f"string x {written}{after}").default.value == value


def test_ros2_text_constant_may_be_empty_and_contain_equals():
    assert constant("string X=").value.value == ""
    assert constant("string X = a=b").value.value == "a=b"
    assert constant('string X="=" # c').value.value == "="
    assert constant("string X = 'a=b' # c").value.value == "a=b"
    assert constant("string X==").value.value == "="


def test_ros1_text_constants_are_not_indented_with_spaces():
    # genmsg would name the constant 'string X', which is no identifier in any language.
    for line in ("  string X=a", "\t string X=a", " string\t X = a"):
        assert refused(line, "ros1") == (
            "a string constant must start in the first column: genmsg would read 'string X' for "
            "its name"
        )
    # It takes the name from after the first space, and strips tabs.
    assert constant("\tstring X=a", "ros1").name.text == "X"


@pytest.mark.parametrize("quote", ["'", '"'])
def test_ros2_lone_quote_is_the_empty_text(quote):
    for line in (f"string x {quote}", f"string x {quote}  # c"):
        assert field(line).default.value == ""
    assert constant(f"string X={quote}").value.value == ""
    refused(f"string x {quote}#{quote}=", "ros1")


@pytest.mark.parametrize(
    ("line", "values"),
    [
        ("int32[] x []", ()),
        ("int32[] x [1]", (1,)),
        ("int32[3] x [1,0x10, 010]", (1, 16, 10)),
        ("int32[] x [ 1 , 2 ]", (1, 2)),
        ("float32[] x [1, .5,inf]", (1.0, 0.5, float("inf"))),
        ("bool[] x [true,0,False]", (True, False, False)),
        ("string[] x []", ()),
        ("string[] x [a, b c ,d]", ("a", "b c", "d")),
        ("""string[] x ["a,b", 'c"]']""", ("a,b", 'c"]')),
        (r"""string[] x ["H\"el'lo", 'Wo\'r"ld']""", ("H\"el'lo", "Wo'r\"ld")),
        ('string[] x ["a",]', ("a",)),
        ('string[] x [ "a" ,]', ("a",)),
        ('string[] x ["a",]b]', ("a", "]b")),
        ("""string[] x ["a" 'b',"c""d" e]""", ("a", "b", "c", "d", "e")),
        ("""string[] x [a "b", 'c' ]""", ('a "b"', "c")),
        ('string[] x [""]', ("",)),
        ('string[] x [" a "]', ("a",)),
        ("""string[] x ["'a", "'"]""", ("'a", "")),
        (r"""string[] x ["'a\'b'", '"']""", ("a'b", "")),
    ],
)
def test_ros2_defaults_of_arrays(line, values):
    for after in AFTER:
        default = field(line + after).default
        assert isinstance(default, ListSyntax)
        assert tuple(item.value for item in default.items) == values


@pytest.mark.parametrize(
    "line",
    [
        "int32[] x 1",
        "int32 x [1]",
        "int32[] x [1",
        "int32[] x 1]",
        "int32[] x [ ]",
        "int32[] x [1,]",
        "int32[] x [,]",
        "int32[] x [1 2]",
        "int32[] x [1,a]",
        "int32[] x [1.0]",
        "bool[] x [2]",
        "string[] x [a, ]b",
        'string[] x ["a]',
        """string[] x ["'a'b'"]""",
        r"""string[] x ["a\"]""",
        r"""string[] x ['b', 'a\']""",
        "Foo x 1",
        "Foo[] x []",
        # It would be a constant.
        "string x 'a=b'",
        "string[] x [a=b]",
        "string[] x [a, =]",
        "string[] x ['a=b']",
        'string[] x ["a=b"]',
    ],
)
def test_ros2_refuses_defaults(line):
    refused(line, "ros2")


@pytest.mark.parametrize(
    ("line", "dialect", "words"),
    [
        (" string A=x", "ros1", "string"),
        ("int8 A=300", "ros2", "300"),
        ("int8 A=x", "ros2", "x"),
        ("int8 a 300", "ros2", "300"),
        ("int8[2] a [1, 300]", "ros2", "300"),
        ("int8[2] a [1, 2, 3]", "ros2", "[1, 2, 3]"),
        ("string<=2 a 'xyz'", "ros2", "'xyz'"),
        ("int8[99999999999999999999] a", "ros2", "99999999999999999999"),
    ],
)
def test_error_in_a_value_is_marked(line, dialect, words):
    try:
        wrong = check_members(parse(line, dialect))
    except DefinitionError as error:
        wrong = error.diagnostics
    (diagnostic,) = wrong
    assert line[diagnostic.span.start : diagnostic.span.end] == words
