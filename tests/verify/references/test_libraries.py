"""What single libraries do in their own way: numbers of arrays, bounds, and what they print."""

from __future__ import annotations

import pytest

from firm_hdl.verify.references.client import Refusal


def data(text):
    return bytes.fromhex(text)


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
