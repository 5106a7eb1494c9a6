"""The transfers of the oracle against transfers written by hand."""

from __future__ import annotations

import numpy as np
import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.oracle import RosbagsOracle, distro_oracle

INNER = "string name\nuint16[] numbers\n"
OUTER = """
int8 a
byte b
float32 f
bool[3] flags
test_msgs/Inner[2] pair
test_msgs/Inner[] more
"""


@pytest.fixture(scope="module")
def oracle():
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(INNER, "test_msgs/msg/Inner"))
    store.register(get_types_from_msg(OUTER, "test_msgs/msg/Outer"))
    return RosbagsOracle(store, "ros2")


def test_every_kind_of_field_transfers_as_the_interface_says(oracle):
    inner, outer = (oracle.store.types[f"test_msgs/msg/{name}"] for name in ("Inner", "Outer"))
    numbers = [((1, 65535), False), ((3, 4), False), ((5, 0), True)]
    first = inner(name="é", numbers=np.array([1, 65535, 3, 4, 5], dtype=np.uint16))
    empty = inner(name="", numbers=np.array([], dtype=np.uint16))
    flags = np.array([True, False, True])
    value = outer(a=-1, b=-2, f=-0.0, flags=flags, pair=[first, empty], more=[first])
    assert oracle.transfers(value, "test_msgs/msg/Outer", "cdr", 4) == {
        ("a",): [-1],
        ("b",): [254],
        ("f",): [0x80000000],
        ("flags", "items"): [((1, 0, 1, 0), True)],
        ("pair", "item", "name", "length"): [2, 0],
        ("pair", "item", "name", "items"): [((0xC3, 0xA9, 0, 0), True)],
        ("pair", "item", "numbers", "length"): [5, 0],
        ("pair", "item", "numbers", "items"): numbers,
        ("more", "length"): [1],
        ("more", "item", "name", "length"): [2],
        ("more", "item", "name", "items"): [((0xC3, 0xA9, 0, 0), True)],
        ("more", "item", "numbers", "length"): [5],
        ("more", "item", "numbers", "items"): numbers,
    }


@pytest.mark.parametrize(("dialect", "right"), [("ros1", -2), ("ros2", 254)])
def test_byte_has_a_sign_in_ros1_alone(dialect, right):
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg("byte b\nbyte[] more\nuint8 u\n", "test_msgs/msg/Bytes"))
    more = np.array([254], dtype=np.uint8)
    value = store.types["test_msgs/msg/Bytes"](b=-2, more=more, u=254)
    found = RosbagsOracle(store, dialect).transfers(value, "test_msgs/msg/Bytes", "ros1", 1)
    assert (found[("b",)], found[("u",)]) == ([right], [254])
    assert found[("more", "items")] == [((right,), True)]


def test_times_of_ros1_have_their_own_names_and_signs():
    oracle = distro_oracle("noetic")
    time = oracle.store.types["builtin_interfaces/msg/Time"](sec=-1, nanosec=0xFFFFFFFF)
    duration = oracle.store.types["builtin_interfaces/msg/Duration"](sec=-1, nanosec=0xFFFFFFFF)
    for name, value, sign in (("Time", time, 1), ("Duration", duration, -1)):
        outer = oracle.store.types[f"std_msgs/msg/{name}"](data=value)
        high = 0xFFFFFFFF if sign > 0 else -1
        found = oracle.transfers(outer, f"std_msgs/msg/{name}", "ros1", 8)
        assert found == {("data", "secs"): [high], ("data", "nsecs"): [high]}


@pytest.mark.parametrize(
    ("distro", "wire", "path", "payload"),
    [
        ("noetic", "ros1", ("trigger",), 1),
        ("humble", "ros1", ("trigger",), 1),
        ("noetic", "cdr", ("structure_needs_at_least_one_member",), 0),
        ("humble", "cdr", ("structure_needs_at_least_one_member",), 0),
    ],
)
def test_empty_messages_transfer_once(distro, wire, path, payload):
    # What is transferred depends on the wire format, not on the dialect.
    oracle = distro_oracle(distro)
    name = "std_msgs/msg/Empty"
    value = oracle.store.types[name](*[0] * len(oracle.fields(name)))
    assert oracle.transfers(value, name, wire, 8) == {path: [payload]}


SCALARS = {
    "bool": (True, 1),
    "int8": (-128, -128),
    "uint8": (255, 255),
    "int16": (-2, -2),
    "uint32": (0xFFFFFFFF, 0xFFFFFFFF),
    "int64": (-(1 << 63), -(1 << 63)),
    "uint64": ((1 << 64) - 1, (1 << 64) - 1),
    "char": (200, 200),
    "float32": (-1.5, 0xBFC00000),
    "float64": (-1.5, 0xBFF8000000000000),
}


@pytest.mark.parametrize("name", SCALARS)
def test_numbers_and_lists_of_them_transfer_their_bits(name):
    given, payload = SCALARS[name]
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(f"{name} a\n{name}[2] b\n{name}[] c\n", "p/msg/A"))
    oracle = RosbagsOracle(store, "ros2")
    dtype = {"char": "uint8"}.get(name, name)
    value = store.types["p/msg/A"](
        a=given, b=np.array([0, given], dtype), c=np.array([given], dtype)
    )
    for wire in ("cdr", "ros1"):
        read = oracle.read(oracle.write(value, "p/msg/A", wire), "p/msg/A", wire)
        found = oracle.transfers(read, "p/msg/A", wire, 16)
        assert found["a",] == [payload] and found["c", "length"] == [1]
        (((first, second, *_), last),) = found["b", "items"]
        assert (first, second, last) == (0, payload, True)
        assert found["c", "items"][0][0][0] == payload
        assert ("b", "length") not in found


def test_packets_are_those_of_the_wire_and_little_endian():
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg("uint8 a\nuint32 b\n", "p/msg/A"))
    for dialect in ("ros1", "ros2"):
        oracle = RosbagsOracle(store, dialect)
        value = store.types["p/msg/A"](a=1, b=2)
        for wire, text in (("ros1", "01 02000000"), ("cdr", "00010000 01 000000 02000000")):
            packet = oracle.write(value, "p/msg/A", wire)
            assert packet == bytes.fromhex(text) and type(packet) is bytes
            assert oracle.read(packet, "p/msg/A", wire) == value


STRUCTURES = [
    "uint8 a\np/B b\n",
    "uint8 c\np/B b\n",
    "p/B b\nuint8 a\n",
    "int8 a\np/B b\n",
    "uint8[] a\np/B b\n",
    "uint8[2] a\np/B b\n",
    "uint8[3] a\np/B b\n",
    "uint8[<=3] a\np/B b\n",
    "string a\np/B b\n",
    "string<=3 a\np/B b\n",
    "uint8 a\np/C b\n",
    "uint8 a\np/B[] b\n",
    "uint8 a\n",
]


def test_a_structure_is_all_that_determines_the_bytes():
    def structure(text, inner="uint8 x\n", dialect="ros2", innermost="uint8 x\n"):
        store = get_typestore(Stores.EMPTY)
        for name, each in (("A", text), ("B", inner), ("C", inner), ("D", innermost)):
            store.register(get_types_from_msg(each, f"p/msg/{name}"))
        return RosbagsOracle(store, dialect).structure("p/msg/A")

    first = structure(STRUCTURES[0])
    assert first == structure(STRUCTURES[0].replace("\n", "  # A comment\n"))
    others = [
        structure(STRUCTURES[0], "int8 x\n"),
        structure(STRUCTURES[0], dialect="ros1"),
        structure(STRUCTURES[0], "p/D x\n"),
        structure(STRUCTURES[0], "p/D x\n", innermost="int8 x\n"),
    ]
    assert len({*map(structure, STRUCTURES), *others}) == len(STRUCTURES) + len(others)


def test_a_wire_that_rosbags_does_not_have_is_not_judged():
    output = "^rosbags does not write can$"
    oracle = distro_oracle("lyrical")
    value = oracle.store.types["std_msgs/msg/Bool"](data=True)
    with pytest.raises(NotJudgedError, match=output):
        oracle.write(value, "std_msgs/msg/Bool", "can")
    with pytest.raises(NotJudgedError, match=output):
        oracle.read(b"\0\1\0\0\1", "std_msgs/msg/Bool", "can")
