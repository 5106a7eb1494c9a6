"""Easily missed facts about definitions, each with a test that fails without it.

``tests/plan/test_wire_facts.py`` has the facts of the wire. The rules are those of genmsg 0.6.0
(ROS 1) and of rosidl_adapter 3.3.1 (ROS 2).
"""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library
from firm_hdl.model import Array, Message, Sequence
from tests.frontend.workspace import make_files

DISTROS = {"ros1": "noetic", "ros2": "lyrical"}


def load(root, text, dialect, **others):
    """Load ``p/T``, which the text defines, beside other messages of the package."""
    files = {f"p/msg/{name}.msg": content for name, content in {"T": text, **others}.items()}
    return Library(DISTROS[dialect], [make_files(root, files)]).message("p/T")


def refused(root, text, dialect):
    with pytest.raises(DefinitionError):
        load(root, text, dialect)
    return True


def only(message):
    (field,) = message.fields
    return field


# ROS 1 and ROS 2.


def test_byte_is_int8_in_ros1_and_an_octet_in_ros2(tmp_path):
    assert only(load(tmp_path, "byte b", "ros1")).type.signed
    assert not only(load(tmp_path, "byte b", "ros2")).type.signed


@pytest.mark.parametrize("dialect", DISTROS)
def test_char_is_uint8(tmp_path, dialect):
    kind = only(load(tmp_path, "char c", dialect)).type
    assert (kind.bytes, kind.signed, kind.kind) == (1, False, "int")


@pytest.mark.parametrize("dialect", DISTROS)
def test_crlf_is_accepted(tmp_path, dialect):
    message = load(tmp_path, "# c\r\nint8 X=1 # d\r\n\r\nstring s\r\nstring T=e\r\n", dialect)
    assert [f.name for f in message.fields] == ["s"]
    assert [c.value for c in message.constants] == [1, "e"]


@pytest.mark.parametrize("dialect", DISTROS)
def test_010_is_ten(tmp_path, dialect):
    assert load(tmp_path, "int8 X=010", dialect).constants[0].value == 10


@pytest.mark.parametrize("dialect", DISTROS)
def test_blanks_inside_a_type_are_refused(tmp_path, dialect):
    assert refused(tmp_path, "int32[ 3 ] x", dialect)


# ROS 1.


def test_ros1_header_is_that_of_std_msgs(tmp_path):
    own = {"Header": "int8 mine"}
    assert only(load(tmp_path, "Header h", "ros1", **own)).type.name == "std_msgs/Header"


@pytest.mark.parametrize("suffix", ["[]", "[2]"])
def test_ros1_headers_in_an_array_are_the_packages_own(tmp_path, suffix):
    kind = only(load(tmp_path, f"Header{suffix} h", "ros1", Header="int8 mine")).type
    assert isinstance(kind, Array | Sequence)
    assert kind.element.name == "p/Header"


def test_ros1_string_constant_takes_all_that_follows(tmp_path):
    (constant,) = load(tmp_path, "string X= \"a\" # 'b' = c  ", "ros1").constants
    assert constant.value == constant.text == "\"a\" # 'b' = c"


def test_ros1_0x10_is_no_integer(tmp_path):
    assert refused(tmp_path, "int8 X=0x10", "ros1")


@pytest.mark.parametrize("name", ["a__b", "a_", "A"])
def test_ros1_field_names_that_ros2_refuses(tmp_path, name):
    assert only(load(tmp_path, f"int8 {name}", "ros1")).name == name
    assert refused(tmp_path, f"int8 {name}", "ros2")


def test_ros1_tabs_do_not_separate(tmp_path):
    assert refused(tmp_path, "int8\tx", "ros1")
    assert only(load(tmp_path, "int8 \tx", "ros1")).name == "x"


def test_ros1_time_and_duration_are_messages_of_two_numbers(tmp_path):
    time, duration = (f.type for f in load(tmp_path, "time t\nduration d", "ros1").fields)
    assert isinstance(time, Message) and isinstance(duration, Message)
    assert [(f.name, str(f.type)) for f in time.fields] == [("secs", "uint32"), ("nsecs", "uint32")]
    assert [str(f.type) for f in duration.fields] == ["int32", "int32"]


# ROS 2.


def test_ros2_number_sign_ends_the_line_even_inside_quotes(tmp_path):
    (constant,) = load(tmp_path, 'string X="a # b"', "ros2").constants
    assert constant.value == '"a'
    assert only(load(tmp_path, 'string s "a # b"', "ros2")).default == '"a'


def test_ros2_0x10_is_sixteen(tmp_path):
    assert load(tmp_path, "int8 X=0x10", "ros2").constants[0].value == 16


@pytest.mark.parametrize("name", ["a", "a1", "a_b", "a1_2b"])
def test_ros2_field_names(tmp_path, name):
    assert only(load(tmp_path, f"int8 {name}", "ros2")).name == name


@pytest.mark.parametrize("name", ["A", "aB", "a__b", "a_", "_a", "1a"])
def test_ros2_refuses_other_field_names(tmp_path, name):
    assert refused(tmp_path, f"int8 {name}", "ros2")


def test_ros2_header_is_the_packages_own(tmp_path):
    assert refused(tmp_path / "1", "Header h", "ros2")
    kind = only(load(tmp_path / "2", "Header h", "ros2", Header="")).type
    assert kind.name == "p/msg/Header"


def test_ros2_has_no_time(tmp_path):
    assert refused(tmp_path, "time t", "ros2")


def test_ros2_defaults_and_bounds_are_in_the_model(tmp_path):
    message = load(tmp_path, 'string<=5 a "x"\nint8[<=3] b [1, 2]\nwstring<=4 c', "ros2")
    assert [str(f.type) for f in message.fields] == ["string<=5", "int8[<=3]", "wstring<=4"]
    assert [f.default for f in message.fields] == ["x", (1, 2), None]


def test_empty_messages_have_no_fields(tmp_path):
    # The byte of an empty message in ROS 2 belongs to the wire, not to the definition.
    for dialect in DISTROS:
        assert load(tmp_path, "# nothing\n", dialect).fields == ()


def test_comments_and_units_are_kept(tmp_path):
    for dialect in DISTROS:
        text = "# A type.\n\n# Speed\nfloat32 v # of it [m/s]\n# Most.\nint8 X=1\n"
        message = load(tmp_path, text, dialect)
        assert message.comment == "A type."
        assert (only(message).comment, only(message).unit) == ("Speed\nof it", "m/s")
        assert message.constants[0].comment == "Most."
