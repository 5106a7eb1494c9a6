"""What single libraries do in their own way: numbers of arrays, bounds, and what they print."""

from __future__ import annotations

import pytest

from firm_hdl.cases.user_oracle import judge_of
from firm_hdl.cases.values import bits_of
from firm_hdl.verify.references.client import Refusal


def data(text):
    return bytes.fromhex(text)


NUMBERS = "float32[] a\nfloat64[2] b\nint16[] c\nbool[2] d\nfloat32 e\nuint64[] f\n"
NUMBER_VALUE = {
    "a": [bits_of(1.5, 4), 0x7FA00001],
    "b": [bits_of(-2.0, 8), 1],
    "c": [-2, 3],
    "d": [True, False],
    "e": bits_of(0.5, 4),
    "f": [(1 << 64) - 2],
}


@pytest.mark.parametrize("name", ["rosbags", "fastcdr"])
def test_arrays_of_big_endian_packets_have_the_same_numbers(library_here, make_message, name):
    codec = library_here(name).open(make_message(NUMBERS), "cdr")
    packet = data(
        "00000000 00000002 3fc00000 7fa00001 00000000 c000000000000000 0000000000000001 "
        "00000002 fffe 0003 01 00 0000 3f000000 00000001 00000000 fffffffffffffffe"
    )
    found = codec.decode(packet)
    assert found == NUMBER_VALUE and repr(found) == repr(NUMBER_VALUE)
    # Written again, they are little-endian.
    again = codec.encode(NUMBER_VALUE)
    assert again[:4] == data("00010000") and codec.decode(again) == NUMBER_VALUE


def test_bytes_of_arrays_have_the_sign_of_ros1_there(library_here, make_message):
    text = "byte[2] a\nbyte[] b\nuint8[] u\nint8[] i\n"
    codec = library_here("rosbags").open(make_message(text, "noetic"), "ros1")
    packet = data("c801 01000000 c8 01000000 c8 01000000 c8")
    value = {"a": [-56, 1], "b": [-56], "u": [200], "i": [-56]}
    assert codec.decode(packet) == value and codec.encode(value) == packet
    # In ROS 2, they have none, and rosbags writes them.
    codec = library_here("rosbags").open(make_message(text), "cdr")
    packet = data("00010000 c801 0000 01000000 c8 000000 01000000 c8 000000 01000000 c8")
    assert codec.encode({"a": [200, 1], "b": [200], "u": [200], "i": [-56]}) == packet
    found = codec.decode(packet)
    assert (found["u"], found["i"]) == ([200], [-56])
    assert [each & 0xFF for each in found["a"] + found["b"]] == [200, 1, 200]


@pytest.mark.parametrize(
    ("text", "good", "long"),
    [
        ("string<=2 a\n", b"xy", b"xyz"),
        ("uint8[<=2] a\n", [1, 2], [1, 2, 3]),
        ("string<=2[] a\n", [b"xy"], [b"xy", b"xyz"]),
        ("uint8[2] a\n", [1, 2], [1, 2, 3]),
    ],
)
def test_cyclone_dds_writes_nothing_that_exceeds_a_bound(
    library_here, make_message, text, good, long
):
    codec = library_here("cyclonedds").open(make_message(text), "cdr")
    assert codec.decode(codec.encode({"a": good})) == {"a": good}
    with pytest.raises(Refusal):
        codec.encode({"a": long})


@pytest.mark.parametrize(
    ("name", "wire", "packet"),
    [
        ("mcap-ros1", "ros1", "c8 02000000 6162"),
        ("mcap-ros2", "cdr", "00010000 c8000000 03000000 616200"),
        ("rosbags", "ros1", "c8 02000000 6162"),
        ("rosbags", "cdr", "00010000 c8000000 03000000 616200"),
    ],
)
def test_what_a_library_cannot_read_or_write_is_refused(
    library_here, make_message, name, wire, packet
):
    distro = "noetic" if wire == "ros1" else "lyrical"
    codec = library_here(name).open(make_message("uint8 a\nstring s\n", distro), wire)
    whole = data(packet)
    assert codec.decode(whole) == {"a": 200, "s": b"ab"}
    # mcap-ros2 takes a text that is cut, so the length is cut.
    for end in (whole.index(b"ab") - 1, 0):
        with pytest.raises(Refusal):
            codec.decode(whole[:end])
    assert codec.encode({"a": 200, "s": b"ab"}) == whole
    for value in ({"a": 300, "s": b""}, {"a": "x", "s": b""}, {"a": 1, "s": [1]}, {"a": 1}):
        with pytest.raises(Refusal):
            codec.encode(value)


def test_fields_whose_names_are_words_of_python_are_found(make_message):
    message = make_message("uint16 from\nB class\n", B="string import\n")
    judge = judge_of(message)
    packet = data("00010000 0102 0000 02000000 6100")
    value = judge.oracle.read(packet, judge.name, "cdr")
    assert judge.oracle.transfers(value, judge.name, "cdr", 8) == {
        ("from",): [0x0201],
        ("class", "import", "length"): [1],
        ("class", "import", "items"): [((0x61, 0, 0, 0, 0, 0, 0, 0), True)],
    }


@pytest.mark.parametrize(
    ("files", "is_read"),
    [
        # A list of Header is one of the package's own; rosbags takes it for that of std_msgs.
        ({"A": "Header[] h\n", "Header": "int8 x\n"}, False),
        ({"A": "B b\n", "B": "int8 x\r\n"}, False),
        ({"A": "B b\n", "B": "int8 x\n"}, True),
    ],
)
def test_a_needed_definition_that_rosbags_cannot_read_is_noted(make_message, files, is_read):
    others = {name: text for name, text in files.items() if name != "A"}
    judge = judge_of(make_message(files["A"], "noetic", **others))
    given = "rosbags cannot read the definition, and was given the fields as they were resolved"
    assert judge.note == ("" if is_read else given)


@pytest.mark.parametrize(
    ("name", "wire", "packet"),
    [
        ("rosbags", "ros1", "01"),
        ("mcap-ros1", "ros1", "01"),
        # ROS 2 gives a message without fields one of a byte.
        ("rosbags", "cdr", "00010000 00 01"),
        ("cyclonedds", "cdr", "00010000 00 01"),
        ("mcap-ros2", "cdr", "00010000 00 01"),
    ],
)
def test_a_message_without_fields_has_a_byte_in_ros2_alone(
    library_here, make_message, name, wire, packet
):
    distro = "noetic" if wire == "ros1" else "lyrical"
    message = make_message("B b\nuint8 c\n", distro, B="")
    codec = library_here(name).open(message, wire)
    assert codec.encode({"b": {}, "c": 1}) == data(packet)
    assert codec.decode(data(packet)) == {"b": {}, "c": 1}
