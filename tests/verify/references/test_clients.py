"""Codecs of client libraries against known bytes, and libraries that are not installed."""

from __future__ import annotations

import os
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import pytest
import yaml

from firm_hdl.cases.values import bits_of
from firm_hdl.frontend import Library
from firm_hdl.model import PRIMITIVES, Field, Message
from firm_hdl.verify.references.client import Refusal, UnsupportedError
from firm_hdl.verify.references.clients import CLIENTS, client
from firm_hdl.verify.references.fastcdr import FastCdr
from tests.verify.references.plain import plain

TEXT = "string s\nfloat64[2] d\nB[] b\nuint16 from\nbool t\n"
VALUE = {
    "s": "é".encode(),
    "d": [bits_of(1.0, 8), 1 << 63],
    "b": [{"x": -1, "y": [1, 2]}],
    "from": 0x1234,
    "t": True,
}
PACKETS = {
    "ros1": "02000000c3a9 000000000000f03f 0000000000000080 01000000 ff 02000000 0102 3412 01",
    "cdr": "00010000 03000000c3a900 00 000000000000f03f 0000000000000080 01000000 ff 000000 "
    "02000000 0102 3412 01",
}
SPOKEN = [(name, wire) for name, kind in CLIENTS.items() for wire in sorted(kind.wires)]


# Our own converters are slower, and have tests of all kinds of fields elsewhere.
OTHERS = [(name, wire) for name, wire in SPOKEN if name != "firm-hdl"]


def packet_of(wire):
    return bytes.fromhex(PACKETS[wire])


@pytest.fixture
def message_of(make_message):
    def get(wire):
        # Each ROS 1 type gets an int8; `char` is another type there.
        return make_message(
            TEXT, "noetic" if wire == "ros1" else "lyrical", B="int8 x\nuint8[] y\n"
        )

    return get


@pytest.mark.sampled(3)
@pytest.mark.parametrize(("name", "wire"), SPOKEN)
def test_value_becomes_the_known_bytes_and_back(library_here, message_of, name, wire):
    library = library_here(name)
    assert library.version()
    codec = library.open(message_of(wire), wire)
    packet = packet_of(wire)
    assert codec.encode(VALUE) == packet
    assert codec.decode(packet) == VALUE
    # Many values at a time, one of which is refused.
    cut = packet[: len(packet) // 2]
    assert codec.encode_all([VALUE, VALUE]) == [packet] * 2
    first, second, third = codec.decode_all([packet, cut, packet])
    assert first == third == VALUE
    assert isinstance(second, Refusal) and str(second)
    with pytest.raises(Refusal):
        codec.decode(cut)


# All kinds of numbers, alone and in lists; lists of texts and of messages with lists.
NUMBERS = """\
int8 a
bool[2] b
int16[] c
uint32 d
int64[] e
float32[2] f
string[] g
uint64 h
float32 i
B[2] j
uint8[] k
float64[] l
"""
NUMBER_VALUE = {
    "a": -128,
    "b": [True, False],
    "c": [-2, 3],
    "d": 0xFFFFFFFE,
    "e": [-3],
    "f": [bits_of(1.5, 4), 1 << 31],
    "g": [b"x", b""],
    "h": (1 << 64) - 1,
    "i": bits_of(-2.0, 4),
    "j": [{"x": -1, "y": []}, {"x": 2, "y": [-5]}],
    "k": [],
    "l": [bits_of(-0.5, 8)],
}
NUMBER_PACKETS = {
    "ros1": "80 0100 02000000 feff 0300 feffffff 01000000 fdffffffffffffff 0000c03f 00000080 "
    "02000000 01000000 78 00000000 ffffffffffffffff 000000c0 ff 00000000 02 01000000 fbff "
    "00000000 01000000 000000000000e0bf",
    # Alignment counts from the end of the header.
    "cdr": "00010000 80 0100 00 02000000 feff 0300 feffffff 01000000 00000000 fdffffffffffffff "
    "0000c03f 00000080 02000000 02000000 7800 0000 01000000 00 00000000000000 ffffffffffffffff "
    "000000c0 ff 000000 00000000 02 000000 01000000 fbff 0000 00000000 01000000 000000000000e0bf",
}


@pytest.mark.parametrize(("name", "wire"), OTHERS)
def test_all_kinds_of_numbers_and_lists(library_here, make_message, name, wire):
    distro = "noetic" if wire == "ros1" else "lyrical"
    message = make_message(NUMBERS, distro, B="int8 x\nint16[] y\n")
    codec = library_here(name).open(message, wire)
    packet = bytes.fromhex(NUMBER_PACKETS[wire])
    assert codec.encode(NUMBER_VALUE).hex() == packet.hex()
    found = codec.decode(packet)
    assert found == NUMBER_VALUE
    # A number is not a bool, and a bool is not a number.
    assert repr(found) == repr(NUMBER_VALUE)


@pytest.mark.parametrize("name", [name for name, wire in OTHERS if wire == "ros1"])
def test_times_and_bytes_of_ros1(library_here, make_message, name):
    message = make_message("duration d\ntime[] t\nbyte b\nbyte[] l\nchar c\n", "noetic")
    value = {
        "d": {"secs": -3, "nsecs": 4},
        "t": [{"secs": 5, "nsecs": 6}],
        "b": -2,
        "l": [-1, 7],
        "c": 200,
    }
    packet = "fdffffff04000000 01000000 0500000006000000 fe 02000000 ff07 c8"
    codec = library_here(name).open(message, "ros1")
    assert codec.encode(value) == bytes.fromhex(packet)
    assert codec.decode(bytes.fromhex(packet)) == value


@pytest.mark.parametrize("name", [name for name, wire in OTHERS if wire == "cdr"])
def test_bounds_and_bytes_of_ros2(library_here, make_message, name):
    text = "string<=3 s\nuint16[<=2] l\nB[<=2] b\nbyte y\nchar c\nstring<=2[<=2] t\nbyte[] z\n"
    codec = library_here(name).open(make_message(text, B="uint8 x\n"), "cdr")
    value = {
        "s": b"abc",
        "l": [1, 2],
        "b": [{"x": 3}, {"x": 4}],
        "y": 5,
        "c": 6,
        "t": [b"d", b"ef"],
        "z": [127],
    }
    packet = bytes.fromhex(
        "00010000 04000000 61626300 02000000 0100 0200 02000000 03 04 05 06 02000000 02000000 6400 "
        "0000 03000000 656600 00 01000000 7f"
    )
    assert codec.encode(value) == packet
    assert codec.decode(packet) == value


@pytest.mark.parametrize(("name", "wire"), SPOKEN)
def test_messages_without_fields(library_here, make_message, name, wire):
    distro = "noetic" if wire == "ros1" else "lyrical"
    codec = library_here(name).open(make_message("B[2] b\nB one\n", distro, B=""), wire)
    packet = b"" if wire == "ros1" else bytes.fromhex("00010000000000")
    value = {"b": [{}, {}], "one": {}}
    assert codec.encode(value) == packet
    assert codec.decode(packet) == value


@pytest.mark.parametrize("name", ["fastcdr", "fastcdr-2.2", "fastcdr-2.3", "firm-hdl"])
def test_wide_text(library_here, make_message, name):
    codec = library_here(name).open(make_message("uint8 a\nwstring w\n"), "cdr")
    value = {"a": 1, "w": [0xD83D, 0xDE00]}
    packet = bytes.fromhex("0001000001000000020000003dd8000000de0000")
    assert codec.encode(value) == packet
    assert codec.decode(packet) == value


@pytest.mark.parametrize("name", ["rosbags", "cyclonedds", "mcap-ros2"])
def test_who_has_no_wide_text_says_so(library_here, make_message, name):
    with pytest.raises(UnsupportedError, match=r"wstring"):
        library_here(name).open(make_message("wstring w\n"), "cdr")


@pytest.mark.parametrize("release", ["fastcdr", "fastcdr-2.2", "fastcdr-2.3"])
def test_fast_cdr_writes_and_reads_packets_of_ros_2(library_here, release):
    corpus = os.environ.get("FIRM_HDL_CORPUS")
    if not corpus:
        assert not os.environ.get("CI")
        pytest.skip("FIRM_HDL_CORPUS is not set: no reference bytes")
    folder = Path(corpus).parent / "cdr_reference"
    rows = [line.split("\t") for line in (folder / "bytes.tsv").read_text().splitlines()]
    packets = {(name, order): bytes.fromhex(text) for name, order, text in rows}
    cases = yaml.safe_load((folder / "cases.yaml").read_text())
    assert len(cases) >= 23
    library = Library("humble", [folder])
    for name, case in cases.items():
        message = library.message(case["message"])
        value = plain(message, case["values"])
        codec = library_here(release).open(message, "cdr")
        if name == "str_nul" and release == "fastcdr-2.3":
            with pytest.raises(Refusal):
                codec.encode(value)
        else:
            assert codec.encode(value) == packets[name, "LE"], name
        if name == "str_nul":
            value = {"s": b"a"}
        for order in ("LE", "BE"):
            assert codec.decode(packets[name, order]) == value, (name, order)


def test_a_forked_process_has_libraries_of_its_own(library_here):
    library_here("fastcdr")
    with ProcessPoolExecutor(1, mp_context=get_context("fork")) as pool:
        assert pool.submit(_written).result() == b"\0\1\0\0\7"
        assert pool.submit(_program).result() != _program()


def _codec():
    uint8 = PRIMITIVES["ros2"]["uint8"]
    message = Message(name="p/msg/A", dialect="ros2", fields=(Field(name="a", type=uint8),))
    return client("fastcdr").open(message, "cdr")


def _written():
    return _codec().encode({"a": 7})


def _program():
    return _codec()._program._process.pid


@pytest.mark.parametrize("name", ["fastcdr", "genpy"])
def test_a_process_that_dies_is_replaced(make_message, library_here, name):
    library_here(name)
    wire = "cdr" if name == "fastcdr" else "ros1"
    library = CLIENTS[name]()
    try:
        assert library.missing() is None
        message = make_message("uint8 a\n", "noetic" if wire == "ros1" else "lyrical")
        codec = library.open(message, wire)
        far = library._program if name == "fastcdr" else library._worker
        far._process.kill()
        with pytest.raises(UnsupportedError):
            codec.decode(codec.encode({"a": 1}))
        codec = library.open(message, wire)
        assert codec.decode(codec.encode({"a": 1})) == {"a": 1}
    finally:
        library.close()


@pytest.mark.parametrize(
    ("compiler", "output"),
    [("/nowhere/c++", "there is no such command"), ("true", "apt install g++ libfastcdr-dev")],
)
def test_without_compiler_or_library_fast_cdr_is_missing(monkeypatch, compiler, output):
    monkeypatch.setenv("CXX", compiler)
    why = FastCdr().missing()
    assert output in why
