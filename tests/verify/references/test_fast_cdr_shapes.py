"""Every kind of field in every shape through the program that calls Fast CDR, against known bytes.

The bytes are put together here, as OMG DDS-XTypes 1.3, clause 7.4, says. So neither our layout nor
our plans are asked.
"""

from __future__ import annotations

import struct

import pytest

from firm_hdl.model import Array, Field, Message, Primitive, Sequence
from firm_hdl.verify.references.client import Refusal
from tests.strategies import make

RELEASES = ("fastcdr", "fastcdr-2.2", "fastcdr-2.3")
HEADER = bytes.fromhex("00010000")
INNER = make("ros2", {"a": "uint8", "b": "int16"}, "Inner")
NUMBERS = dict(
    zip(
        "bool byte char float32 float64 int8 uint8 int16 uint16 int32 uint32 int64 uint64".split(),
        "?BBfdbBhHiIqQ",
        strict=True,
    )
)


def aligned(packet, size):
    """Add padding to a packet; its alignment counts from the end of the header."""
    return packet + bytes(-(len(packet) - len(HEADER)) % size)


def written(packet, kind, value):
    """Add a value to a packet."""
    if kind is INNER:
        return written(written(packet, "uint8", value["a"]), "int16", value["b"])
    if kind == "string":
        data = value + b"\0"
        return aligned(packet, 4) + struct.pack("<I", len(data)) + data
    if kind == "wstring":
        return aligned(packet, 4) + struct.pack(f"<{len(value) + 1}I", len(value), *value)
    code = NUMBERS[kind]
    return aligned(packet, struct.calcsize(code)) + struct.pack(f"<{code}", value)


def samples(kind):
    """Three values that differ in every byte, and the values as the codec takes them."""
    if kind is INNER:
        values = [{"a": 1, "b": -2}, {"a": 255, "b": 0x0304}, {"a": 5, "b": -0x0607}]
    elif kind == "string":
        values = [b"", b"abcd", "é".encode()]
    elif kind == "wstring":
        values = [[], [0x61, 0xFFFF], [0x1234]]
    elif kind == "bool":
        values = [True, False, True]
    elif kind in ("float32", "float64"):
        values = [-1.5, 0.1, 3e30]
        size = NUMBERS[kind]
        whole = {"f": "I", "d": "Q"}[size]
        return values, [struct.unpack(f"<{whole}", struct.pack(f"<{size}", v))[0] for v in values]
    else:
        size = struct.calcsize(NUMBERS[kind])
        bits = [bytes(range(n, n + size)) for n in (0xF1, 0x01, 0x71)]
        values = [struct.unpack(f"<{NUMBERS[kind]}", each)[0] for each in bits]
    return values, values


def message_of(kind, shape):
    """A type with an octet, a field of that kind and shape, and another octet."""
    (element,) = (each.type for each in make("ros2", {"x": kind}).fields)
    made = {
        "one": element,
        "array": Array(element=element, count=3),
        "sequence": Sequence(element=element),
        "bounded": Sequence(element=element, bound=3),
    }[shape]
    octet = Primitive(name="uint8", bytes=1, kind="int", signed=False)
    fields = (("p", octet), ("x", made), ("z", octet))
    fields = tuple(Field(name=name, type=each) for name, each in fields)
    return Message(name="p/msg/Shape", dialect="ros2", fields=fields)


def packet_of(kind, shape, values):
    packet = HEADER + b"\x09"
    if shape in ("sequence", "bounded"):
        packet = aligned(packet, 4) + struct.pack("<I", len(values))
    for value in values:
        packet = written(packet, kind, value)
    return packet + b"\x07"


KINDS = (*NUMBERS, "string", "wstring", INNER)
SHAPES = {"one": (1,), "array": (3,), "sequence": (0, 1, 3), "bounded": (0, 1, 3)}


@pytest.mark.parametrize("release", RELEASES)
def test_every_kind_has_its_bytes_in_every_shape(library_here, release):
    library = library_here(release)
    for kind in KINDS:
        values, given = samples(kind)
        for shape, counts in SHAPES.items():
            codec = library.open(message_of(kind, shape), "cdr")
            asked = [{"p": 9, "x": given[:n], "z": 7} for n in counts]
            if shape == "one":
                asked = [{"p": 9, "x": each, "z": 7} for each in given]
                packets = [packet_of(kind, shape, [each]) for each in values]
            else:
                packets = [packet_of(kind, shape, values[:n]) for n in counts]
            assert [each.hex() for each in codec.encode_all(asked)] == [
                each.hex() for each in packets
            ], (kind, shape)
            assert codec.decode_all(packets) == asked, (kind, shape)


@pytest.mark.parametrize("release", RELEASES)
def test_more_elements_than_the_bound_are_neither_written_nor_read(library_here, release):
    library = library_here(release)
    for kind in KINDS:
        values, given = samples(kind)
        four, last = [*values, values[0]], [*given, given[0]]
        codec = library.open(message_of(kind, "bounded"), "cdr")
        answers = [
            *codec.encode_all([{"p": 9, "x": last, "z": 7}]),
            *codec.decode_all([packet_of(kind, "bounded", four)]),
        ]
        assert all(isinstance(each, Refusal) for each in answers), (kind, answers)
        assert all("bound" in str(each) for each in answers), (kind, answers)


@pytest.mark.parametrize("release", RELEASES)
def test_a_packet_that_is_cut_anywhere_is_refused(library_here, release):
    library = library_here(release)
    for kind in ("uint16", "bool", "string", "wstring", INNER):
        values, _ = samples(kind)
        for shape, count in (("one", 1), ("array", 3), ("sequence", 3), ("bounded", 3)):
            whole = packet_of(kind, shape, values[-count:])
            codec = library.open(message_of(kind, shape), "cdr")
            answers = codec.decode_all([whole[:size] for size in range(len(whole))])
            assert all(isinstance(each, Refusal) for each in answers), (kind, shape)
