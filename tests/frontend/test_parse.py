"""The grammar of each dialect: accepted lines, and their trees."""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend.parse import is_type_name

from .reading import field, member, parse, refused


def test_time_and_duration_are_builtin_in_ros1_only():
    assert field("time t", "ros1").type.is_builtin
    assert field("duration[2] t", "ros1").type.is_builtin
    assert refused("time t", "ros2") == (
        "'time' is not a type of ROS 2; use 'builtin_interfaces/Time'"
    )


def test_ros1_names_with_an_underscore_first_are_those_of_constants_alone():
    rule = "letters, digits and underscores"
    refusal = f"'_a' is not a legal name: {rule}, a letter first"
    for line in ("int32 _a", "time _a", "foo/Bar _a", "int32[] _a", "string _a # ="):
        assert refused(line, "ros1") == refusal
    assert refused("int32 1a=1", "ros1") == f"'1a' is not a legal name: {rule}, no digit first"
    for line in ("time _a=1", "int32[] _a=1", "foo/Bar _a = 1"):
        assert refused(line, "ros1").startswith("a constant must have a builtin type")


def test_tabs_alone_separate_in_ros2_only():
    assert field("int32\t\tx").name.text == "x"
    assert refused("int32\tx", "ros1") == "a space must separate type and name; tabs alone do not"


@pytest.mark.parametrize("indent", ["  ", "\t", " \t", "\xa0"])
@pytest.mark.parametrize("line", ["int32 x", "string x", "pkg/Foo x", "int32 X=1"])
def test_ros1_lines_may_be_indented(indent, line):
    # Constants of strings are an exception; see test_parse_values.py.
    assert member(indent + line, "ros1").name.text == member(line, "ros1").name.text


@pytest.mark.parametrize("indent", ["  ", "\t", "\xa0"])
@pytest.mark.parametrize("line", ["int32 x", "pkg/Foo x", "int32 X=1", "string X=a"])
def test_ros2_lines_may_not_be_indented(indent, line):
    assert refused(indent + line, "ros2") == "a definition must start in the first column"


@pytest.mark.parametrize(
    "type_",
    ["int32[ 3 ]", "int32 [3]", "int32[3][4]", "int32[", "int32]", "int32[-1]", "int32[x]", "a/b/C",
     "a//B", "/B", "a/", "int32[3", "int32[]]", "p /B", "int-32"],
)  # fmt: skip
@pytest.mark.parametrize("dialect", ["ros1", "ros2"])
def test_malformed_types_are_refused(dialect, type_):
    refused(f"{type_} x", dialect)


@pytest.mark.parametrize(
    "type_",
    ["string<= 5", "string <=5", "string<=", "string<5", "int8<=5", "Foo<=5", "int8[<=]",
     "int8[<= 3]", "int8[<3]", "pkg/msg/Foo", "foo", "Pkg/Foo", "p__q/Foo", "p_/Foo", "Foo_Bar"],
)  # fmt: skip
def test_malformed_types_of_ros2_are_refused(type_):
    refused(f"{type_} x", "ros2")


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("dialect", ["ros1", "ros2"])
def test_line_ends(dialect, end):
    text = f"# c{end}int32 a{end}string B=x{end}{end}int32 c # d{end}"
    members = parse(text, dialect).members
    assert [m.name.text for m in members] == ["a", "B", "c"]
    assert members[1].value.value == "x"
    assert members[2].comment == "d"


@pytest.mark.parametrize("end", "\v\f\x1c\x1d\x1e\x85\u2028\u2029")
def test_line_ends_of_python_are_those_of_ros2_alone(end):
    text = f"string A=x{end}string B=y"
    assert [m.value.value for m in parse(text, "ros2").members] == ["x", "y"]
    assert [m.value.value for m in parse(text, "ros1").members] == [f"x{end}string B=y"]


def test_tabs_are_blanks_in_ros2_alone():
    text = "string A=x\ty"
    assert [parse(text, d).members[0].value.value for d in ("ros1", "ros2")] == ["x\ty", "x y"]


@pytest.mark.parametrize("text", ["", "\n", "   ", "\t\n \n", "#", "  # c", "# a\n# b"])
@pytest.mark.parametrize("dialect", ["ros1", "ros2"])
def test_texts_without_definitions(dialect, text):
    assert parse(text, dialect).members == ()


def test_spans_cover_the_words():
    text = '# c\r\nstring<=5[2] ab ["x", y] # d\r\nint8 CD = 0x7\r\n'
    one, two = parse(text, "ros2").members

    def words(node):
        return text[node.span.start : node.span.end]

    assert [words(n) for n in (one.type, one.type.bound, one.type.size, one.name, one.default)] == [
        "string<=5[2]", "5", "2", "ab", '["x", y]',
    ]  # fmt: skip
    assert [words(item) for item in one.default.items] == ['"x"', "y"]
    assert [words(n) for n in (two.type, two.name, two.value)] == ["int8", "CD", "0x7"]
    assert (two.name.span.line, two.name.span.column) == (3, 6)


@pytest.mark.parametrize("dialect", ["ros1", "ros2"])
def test_empty_text_of_a_constant_is_right_after_its_name(dialect):
    text = "int8 a\r\nstring AB=  \n"
    value = parse(text, dialect).members[1].value
    assert (value.value, value.span.start, value.span.end) == ("", 17, 17)
    assert (value.span.line, value.span.column) == (2, 10)


def test_file_full_of_errors_is_given_up():
    with pytest.raises(DefinitionError) as error:
        parse("?\n" * 5000, "ros1")
    *first, last = error.value.diagnostics
    assert len(first) == 1000
    assert last.message == "too many errors; the rest of this file was not checked"
    assert (last.span.line, last.span.line_text) == (1001, "?")
    with pytest.raises(DefinitionError) as error:
        parse("\n".join("?" * 1000), "ros1")
    assert {d.message for d in error.value.diagnostics} == {"'?' is not a type"}


@pytest.mark.parametrize("dialect", ["ros1", "ros2"])
def test_number_longer_than_python_reads_is_reported(dialect):
    digits = "9" * 5000
    for line in (f"int32 X={digits}", f"int32[{digits}] x"):
        assert refused(line, dialect) == "a number of 5000 digits is too long"


@pytest.mark.parametrize(
    ("dialect", "name", "is_legal"),
    [
        ("ros1", "a_b__/A_b_", True),
        ("ros1", "A/b", True),
        ("ros1", "a/1", False),
        ("ros1", "a-b/A", False),
        ("ros1", "a/b/C", False),
        ("ros2", "a_b/Ab1", True),
        ("ros2", "Ab1", True),
        ("ros2", "a/ab", False),
        ("ros2", "A/Ab", False),
        ("ros2", "a__b/Ab", False),
        ("ros2", "a/A_b", False),
        ("ros2", "a/Ab ", False),
        ("ros2", "a/Srv_Request", True),
        # rosidl_adapter takes each suffix off once: that of a request first, of feedback last.
        ("ros2", "a/Sample_A_Feedback_Result_Goal_Response_Request", True),
        ("ros2", "a/A_Result", True),
        ("ros2", "a/A_Request_Response", False),
        ("ros2", "a/A_Response_Goal", False),
        ("ros2", "a/A_Goal_Result", False),
        ("ros2", "a/A_Result_Feedback", False),
        ("ros2", "a/A_Request_Request", False),
        ("ros2", "a/A_Event", False),
        ("ros2", "a/Sample_a", False),
        ("ros2", "", False),
    ],
)
def test_names_of_types(dialect, name, is_legal):
    assert is_type_name(name, dialect) is is_legal


@pytest.mark.parametrize(
    ("size", "rest"), [("1__0", "__0"), ("1_", "_"), ("1_0_", "_"), ("0x1", "x1"), ("+1_+0", "_+0")]
)
@pytest.mark.parametrize("form", ["int8[{}]", "int8[<={}]"])
def test_sizes_end_where_python_would_not_go_on(form, size, rest):
    assert refused(f"{form.format(size)} x", "ros2") == f"expected ']', not '{rest}]'"
