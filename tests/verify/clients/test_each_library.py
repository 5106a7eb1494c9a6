"""Each known divergence occurs in each of its libraries, on each of its wires, in each case."""

from __future__ import annotations

import pytest

from firm_hdl.verify.clients.judge import LibraryComparison
from firm_hdl.verify.references.client import Codec
from tests.verify.clients.test_contest import CodecClient

NAN = ("float32 a\n", {"a": 0x7F800001})
EMPTY, TEXT = ("string a\n", {"a": b""}), ("string a\n", {"a": b"ab"})
LIST, LONG = ("uint8[] a\n", {"a": [1]}), ("uint8[] a\n", {"a": [1, 2, 3, 4]})
ARRAY, LONG_ARRAY = ("uint8[2] a\n", {"a": [1, 2]}), ("uint8[8] a\n", {"a": [1] * 8})
BOUNDED, BOUNDED_TEXT = ("uint8[<=1] a\n", {"a": [1]}), ("string<=1 a\n", {"a": b""})
NUL, WIDE_NUL = ("string a\n", {"a": b"a\0b"}), ("wstring a\n", {"a": [0x61, 0, 0x62]})
LATE = ("time a\n", {"a": {"secs": 1 << 31, "nsecs": 0}})
FULL = ("time a\n", {"a": {"secs": 1, "nsecs": 1_000_000_001}})
ONE, BYTE, CHAR = ("uint32 a\n", {"a": 1}), ("byte a\n", {"a": 254}), ("char a\n", {"a": 200})

BOTH = {"encode": NAN, "decode": NAN}
UTF8 = {"not-utf8": EMPTY, "encode not-utf8": EMPTY}
BOOLS, BOOL_ARRAY = ("bool[] a\n", {"a": [True]}), ("bool[1] a\n", {"a": [True]})
CUTS = {"cut-1": TEXT, "cut-half": LONG, "cut-all": ARRAY, "long-text": EMPTY, "long-items": LIST}
GENPY = "genpy mcap-ros1"
# A key, libraries, their reference, a wire, and cases with a type and a value.
ROWS = [
    ("python-signalling-nan", "rosbags cyclonedds mcap-ros2", "fastcdr", "cdr", BOTH),
    ("python-signalling-nan", f"rosbags {GENPY}", "exact", "ros1", {"encode": NAN}),
    ("python-not-utf8", "rosbags cyclonedds mcap-ros2", "fastcdr", "cdr", UTF8),
    ("python-not-utf8", "rosbags", "exact", "ros1", UTF8),
    ("rosbags-byte-signed", "rosbags", "fastcdr", "cdr", {"encode": BYTE, "decode": BYTE}),
    ("rosbags-time-signs", "rosbags", "genpy", "ros1", {"encode": LATE, "decode": LATE}),
    ("rosbags-time-signs", "rosbags", "fastcdr", "cdr", {"encode": LATE}),
    ("mcap-ros2-char-signed", "mcap-ros2", "fastcdr", "cdr", {"encode": CHAR, "decode": CHAR}),
    ("fastcdr-cut-at-nul", "fastcdr fastcdr-2.2", "rosbags", "cdr", {"encode": NUL}),
    ("fastcdr-cut-at-nul", "fastcdr", "fastcdr-2.2", "cdr", {"encode": WIDE_NUL}),
    ("fastcdr-no-nul-inside", "fastcdr-2.3", "fastcdr", "cdr", {"encode nul-inside": EMPTY}),
    ("fastcdr-options", "fastcdr-2.3", "fastcdr", "cdr", {"options": ONE}),
    ("fastcdr-bools", "fastcdr fastcdr-2.2 fastcdr-2.3", "rosbags", "cdr", {"bool-2": BOOLS}),
    (
        "fastcdr-bool-arrays",
        "fastcdr fastcdr-2.2 fastcdr-2.3",
        "rosbags",
        "cdr",
        {"bool-2": BOOL_ARRAY},
    ),
    ("genpy-time-normalized", GENPY, "rosbags", "ros1", {"decode": FULL}),
    ("genpy-not-utf8", GENPY, "exact", "ros1", {"not-utf8": EMPTY}),
    ("genpy-not-utf8-written", GENPY, "exact", "ros1", {"encode not-utf8": EMPTY}),
    ("genpy-cut", GENPY, "rosbags", "ros1", CUTS),
    ("genpy-trailing", GENPY, "rosbags", "ros1", {"trailing-1": TEXT, "trailing-4": TEXT}),
    ("rosbags-bare-string", "rosbags", "fastcdr", "cdr", {"bare-string": EMPTY}),
    ("rosbags-no-nul", "rosbags", "fastcdr", "cdr", {"no-nul": TEXT}),
    ("rosbags-trailing", "rosbags", "fastcdr", "cdr", {"trailing-4": LIST}),
    (
        "rosbags-bounds",
        "rosbags",
        "fastcdr",
        "cdr",
        {"bound-items": BOUNDED, "encode bound-items": BOUNDED},
    ),
    ("cyclonedds-no-nul", "cyclonedds", "fastcdr", "cdr", {"no-nul": TEXT}),
    (
        "cyclonedds-cut",
        "cyclonedds",
        "fastcdr",
        "cdr",
        {"cut-1": ARRAY, "cut-half": LONG_ARRAY, "cut-all": LIST},
    ),
    ("cyclonedds-bounds", "cyclonedds", "fastcdr", "cdr", {"bound-items": BOUNDED}),
    ("cyclonedds-text-bounds", "cyclonedds", "fastcdr", "cdr", {"encode bound-text": BOUNDED_TEXT}),
    ("mcap-ros2-no-nul", "mcap-ros2", "fastcdr", "cdr", {"no-nul": TEXT}),
    (
        "mcap-ros2-cut",
        "mcap-ros2",
        "fastcdr",
        "cdr",
        {"cut-1": EMPTY, "cut-half": LONG_ARRAY, "long-text": EMPTY, "long-items": LIST},
    ),
    (
        "mcap-ros2-bounds",
        "mcap-ros2",
        "fastcdr",
        "cdr",
        {"bound-items": BOUNDED, "encode bound-items": BOUNDED},
    ),
]


class Exact(Codec):
    """A float or a string of ROS 1, bit by bit, which no library of Python keeps."""

    def encode(self, value):
        number = value["a"]
        if isinstance(number, int):
            return number.to_bytes(4, "little")
        return len(number).to_bytes(4, "little") + number

    def decode(self, packet):
        assert len(packet) == 4 + packet[0]
        return {"a": packet[4:]}


@pytest.mark.parametrize(("key", "libraries", "reference", "wire", "cases"), ROWS)
def test_each_library_differs_in_each_case(
    library_here, make_message, key, libraries, reference, wire, cases
):
    is_own = reference == "exact"
    right = CodecClient("exact", Exact(), {"ros1"}) if is_own else library_here(reference)
    for what, (text, value) in cases.items():
        message = make_message(text, "noetic" if wire == "ros1" or text == LATE[0] else "lyrical")
        for name in libraries.split():
            library = library_here(name)
            finding, keys = LibraryComparison(library, right, wire).ask(message, what, value)
            assert (finding.what, list(keys)) == (what, [key]), (name, what)
