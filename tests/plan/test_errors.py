"""Results of bad packets and bad transfers: docs/reference/status.md, "Status"."""

from __future__ import annotations

import pytest

from firm_hdl.plan import build_plan, decode, encode
from firm_hdl.sim.values import from_transfers, to_transfers
from firm_hdl.wire import lay_out
from tests.strategies import make, on_every_bus

POINT = make("ros2", {"x": "uint16", "y": "uint16"}, "Point")
MESSAGE = make(
    "ros2",
    {
        "a": "uint32",
        "s": "string<=6",
        "ps": (POINT, "[<=3]"),
        "q": "uint16[]",
        "f": "uint8[3]",
        "z": "uint8",
    },
)
VALUE = {
    "a": 1,
    "s": "abcd",
    "ps": [{"x": 1, "y": 2}, {"x": 3, "y": 4}],
    "q": [5, 6, 7],
    "f": [8, 9, 10],
    "z": 11,
}
PACKET = bytes.fromhex(
    "00010000010000000500000061626364000000000200000001000200030004000300000005000600070008090a0b"
)


def plan_for(bus_bytes, message=MESSAGE):
    return build_plan(lay_out(message), bus_bytes=bus_bytes)


def read(packet, bus_bytes, message=MESSAGE):
    plan = plan_for(bus_bytes, message)
    decoded = decode(plan, packet)
    return decoded.status, from_transfers(plan, message, decoded.streams)


def changed(value=VALUE, /, **fields):
    return {**value, **fields}


ZERO = {"a": 0, "s": "", "ps": [], "q": [], "f": [0, 0, 0], "z": 0}


@on_every_bus
def test_the_packet_under_test_is_good(bus_bytes):
    assert read(PACKET, bus_bytes) == ("OK", VALUE)


@on_every_bus
@pytest.mark.parametrize(
    ("size", "value"),
    [
        (0, ZERO),
        (3, ZERO),
        (7, ZERO),
        (8, changed(ZERO, a=1)),
        (11, changed(ZERO, a=1)),
        (12, changed(ZERO, a=1, s="\0\0\0\0")),
        (14, changed(ZERO, a=1, s="ab\0\0")),
        (16, changed(ZERO, a=1, s="abcd")),
        (17, changed(ZERO, a=1, s="abcd")),
        (20, changed(ZERO, a=1, s="abcd")),
        (24, changed(ZERO, a=1, s="abcd", ps=[{"x": 0, "y": 0}] * 2)),
        (27, changed(ZERO, a=1, s="abcd", ps=[{"x": 1, "y": 0}, {"x": 0, "y": 0}])),
        (30, changed(ZERO, a=1, s="abcd", ps=[{"x": 1, "y": 2}, {"x": 3, "y": 0}])),
        (36, changed(ZERO, a=1, s="abcd", ps=VALUE["ps"], q=[0, 0, 0])),
        (39, changed(ZERO, a=1, s="abcd", ps=VALUE["ps"], q=[5, 0, 0])),
        (43, changed(VALUE, f=[8, 0, 0], z=0)),
        (45, changed(VALUE, z=0)),
    ],
)
def test_cut_packet_keeps_whole_values_and_completes_with_zeros(bus_bytes, size, value):
    assert read(PACKET[:size], bus_bytes) == ("TRUNCATED", value)


@on_every_bus
@pytest.mark.parametrize("count", [4, 5, 100])
def test_more_trailing_bytes_than_padding_are_an_error(bus_bytes, count):
    assert read(PACKET + bytes(count), bus_bytes) == ("TRAILING", VALUE)


@on_every_bus
def test_ros1_takes_no_trailing_byte(bus_bytes):
    message = make("ros1", {"a": "uint8"})
    assert read(b"\1", bus_bytes, message) == ("OK", {"a": 1})
    assert read(b"\1\0", bus_bytes, message) == ("TRAILING", {"a": 1})


@on_every_bus
@pytest.mark.parametrize("header", ["0000", "0101", "0003", "0100", "ff01"])
def test_another_representation_gives_zeros(bus_bytes, header):
    packet = bytes.fromhex(header) + PACKET[2:]
    assert read(packet, bus_bytes) == ("ENCAPSULATION", ZERO)


@on_every_bus
def test_the_first_error_counts(bus_bytes):
    assert read(b"\1", bus_bytes) == ("ENCAPSULATION", ZERO)
    assert read(b"\0", bus_bytes) == ("TRUNCATED", ZERO)
    assert read(b"\0\1", bus_bytes) == ("TRUNCATED", ZERO)
    assert read(PACKET[:20] + b"\x04\0\0\0", bus_bytes)[0] == "LENGTH"
    assert read(PACKET[:16] + b"x", bus_bytes)[0] == "STRING"


@on_every_bus
@pytest.mark.parametrize("length", [8, 9, 255, 0xFFFFFFFF])
def test_a_length_over_the_bound_is_zero_and_ends_it(bus_bytes, length):
    packet = PACKET[:8] + length.to_bytes(4, "little") + PACKET[12:]
    assert read(packet, bus_bytes) == ("LENGTH", changed(ZERO, a=1))


@on_every_bus
def test_a_length_of_the_bound_is_legal(bus_bytes):
    text = VALUE["s"] + "ef"
    body = b"\7\0\0\0" + text.encode() + b"\0" + b"\0"
    assert read(PACKET[:8] + body + PACKET[20:], bus_bytes) == ("OK", changed(s=text))


@on_every_bus
def test_a_sequence_over_its_bound_leaves_what_was_before(bus_bytes):
    packet = PACKET[:20] + b"\4\0\0\0" + PACKET[24:]
    assert read(packet, bus_bytes) == ("LENGTH", changed(ZERO, a=1, s="abcd"))


@on_every_bus
def test_a_missing_nul_keeps_the_string_and_ends_the_rest(bus_bytes):
    packet = PACKET[:16] + b"e" + PACKET[17:]
    assert read(packet, bus_bytes) == ("STRING", changed(ZERO, a=1, s="abcd"))


@on_every_bus
def test_a_string_of_length_zero_is_the_empty_string_without_nul(bus_bytes):
    message = make("ros2", {"s": "string", "x": "uint32"})
    packet = bytes.fromhex("000100000000000005000000")
    assert read(packet, bus_bytes, message) == ("OK", {"s": "", "x": 5})
    assert decode(plan_for(bus_bytes, message), packet).streams == {0: [0], 2: [5]}


@on_every_bus
def test_max_message_bytes_bounds_every_length(bus_bytes):
    message = make("ros2", {"s": "string", "q": "float64[]"})
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes, max_message_bytes=40)
    # 12 bytes are the header and both lengths; 28 are left, 1 of them for the NUL.
    lengths = {str(plan.leaves[leaf]): length.limit for leaf, length in plan.lengths.items()}
    assert lengths == {"s.length": 27, "q.length": 3}
    over = bytes.fromhex("000100001d000000") + bytes(40)
    assert decode(plan, over).status == "LENGTH"


@pytest.mark.parametrize(
    ("fields", "limits"),
    [
        # Bounds above and below the available room: 28 bytes besides header and lengths.
        ({"s": "string<=50", "q": "float64[]"}, {"s.length": 27, "q.length": 3}),
        ({"s": "string<=26", "q": "float64[<=2]"}, {"s.length": 26, "q.length": 2}),
        ({"s": "string<=27", "q": "float64[<=4]"}, {"s.length": 27, "q.length": 3}),
        ({"s": "string<=28", "q": "float64[<=3]"}, {"s.length": 27, "q.length": 3}),
    ],
)
def test_of_a_bound_and_the_room_the_smaller_counts(fields, limits):
    plan = build_plan(lay_out(make("ros2", fields)), bus_bytes=8, max_message_bytes=40)
    assert {str(plan.leaves[n]): length.limit for n, length in plan.lengths.items()} == limits


@on_every_bus
def test_a_trigger_transfers_as_one_even_after_an_error(bus_bytes):
    message = make("ros1", {"a": "uint16", "e": make("ros1", {}, "E")})
    plan = plan_for(bus_bytes, message)
    assert decode(plan, b"\1").streams == {0: [0], 1: [1]}


# Serializer.


def write(streams, bus_bytes, message=MESSAGE):
    return encode(plan_for(bus_bytes, message), streams)


@on_every_bus
def test_a_length_over_the_bound_is_written_as_promised(bus_bytes):
    plan = plan_for(bus_bytes)
    value = changed(s="abcdefgh")
    streams = to_transfers(plan, MESSAGE, value, check_bounds=False)
    packet, status = encode(plan, streams)
    assert status == "LENGTH"
    body = b"\x09\0\0\0abcdefgh\0" + bytes(3)
    assert packet == PACKET[:8] + body + PACKET[20:]


@on_every_bus
def test_lengths_of_the_bound_are_written_without_an_error(bus_bytes):
    plan = plan_for(bus_bytes)
    value = changed(s="abcdef", ps=[{"x": 1, "y": 2}] * 3)
    packet, status = encode(plan, to_transfers(plan, MESSAGE, value))
    assert status == "OK" and read(packet, bus_bytes) == ("OK", value)


@on_every_bus
@pytest.mark.parametrize(("text", "packet"), [("", "00000000"), ("a", "020000006100|0000")])
def test_an_empty_string_may_be_written_without_its_nul(bus_bytes, text, packet):
    message = make("ros2", {"s": "string", "x": "uint32"})
    plan = plan_for(bus_bytes, message)
    streams = to_transfers(plan, message, {"s": text, "x": 5})
    want = bytes.fromhex(f"00010000{packet}05000000".replace("|", ""))
    assert encode(plan, streams, bare_strings=True) == (want, "OK")
    # Without the option, the NUL is always there.
    assert len(encode(plan, streams)[0]) == 16


@on_every_bus
@pytest.mark.parametrize("name", ["s.items", "q.items", "f.items"])
@pytest.mark.parametrize("which", [0, -1])
def test_last_that_disagrees_is_reported_and_the_length_rules(bus_bytes, name, which):
    plan = plan_for(bus_bytes)
    streams = to_transfers(plan, MESSAGE, VALUE)
    leaf = [str(each) for each in plan.leaves].index(name)
    lanes, last = streams[leaf][which]
    streams[leaf][which] = (lanes, not last)
    assert encode(plan, streams) == (PACKET, "ITEMS")


@on_every_bus
def test_the_serializer_reports_its_first_error(bus_bytes):
    message = make("ros2", {"a": "uint8[]", "b": "uint8[<=1]"})
    plan = plan_for(bus_bytes, message)
    value = {"a": [1], "b": [1, 2]}
    streams = to_transfers(plan, message, value, check_bounds=False)
    assert encode(plan, streams)[1] == "LENGTH"
    streams[1] = [(lanes, not last) for lanes, last in streams[1]]
    assert encode(plan, streams)[1] == "ITEMS"


@on_every_bus
def test_lanes_past_the_end_do_not_reach_the_wire(bus_bytes):
    message = make("ros2", {"s": "string", "q": "uint16[]", "f": "uint8[3]"})
    plan = plan_for(bus_bytes, message)
    streams = to_transfers(plan, message, {"s": "abc", "q": [1, 2, 3], "f": [4, 5, 6]})
    want = encode(plan, streams)
    counts = {1: 3, 3: 3, 4: 3}
    for leaf, count in counts.items():
        lanes = plan.leaves[leaf].lanes
        filled = []
        for n, (items, last) in enumerate(streams[leaf]):
            there = min(lanes, count - n * lanes)
            filled.append((items[:there] + (99,) * (lanes - there), last))
        streams[leaf] = filled
    assert encode(plan, streams) == want


@on_every_bus
def test_numbers_are_cut_to_the_width_of_their_leaf(bus_bytes):
    plan = plan_for(bus_bytes, make("ros1", {"a": "bool", "b": "uint8", "c": "int16", "d": "bool"}))
    streams = {0: [2], 1: [0x1FE], 2: [-0x18002], 3: [3]}
    assert encode(plan, streams) == (bytes.fromhex("00 fe fe7f 01"), "OK")


def test_iterators_give_one_packet_per_call():
    message = make("ros2", {"a": "uint8[]"})
    plan = plan_for(8, message)
    one, two = ({"a": [1, 2]}, {"a": [3] * 9})
    streams = [to_transfers(plan, message, value) for value in (one, two)]
    joined = {leaf: iter(streams[0][leaf] + streams[1][leaf]) for leaf in streams[0]}
    assert encode(plan, joined) == encode(plan, streams[0])
    assert encode(plan, joined) == encode(plan, streams[1])
    with pytest.raises(ValueError, match=r"^Leaf a\.length has fewer transfers than are needed$"):
        encode(plan, joined)


def test_visits_count_the_bytes_of_every_cycle():
    plan = plan_for(8, make("ros2", {"x": "uint8", "s": "string", "d": "float64"}))
    packet = bytes.fromhex("00010000 01000000 0a000000 616263646566676869 00 0000")
    packet += bytes(-(len(packet) - 4) % 8) + bytes(8)
    decoded = decode(plan, packet)
    assert decoded.status == "OK"
    padding = 2 + 4
    assert sum(visit.bytes for visit in decoded.steps) == len(packet) - padding
    assert [visit.step for visit in decoded.steps] == sorted(v.step for v in decoded.steps)


@pytest.mark.parametrize(
    ("leaf", "given", "refusal"),
    [
        (0, ((1,), True), "Leaf s.length takes a number, not ((1,), True)"),
        (1, 5, "Leaf s.items takes at least 3 lanes and last, not 5"),
        (1, ((97,), True), "Leaf s.items takes at least 3 lanes and last, not ((97,), True)"),
    ],
)
def test_transfers_of_another_form_are_refused(leaf, given, refusal):
    message = make("ros2", {"s": "string"})
    plan = plan_for(8, message)
    streams = to_transfers(plan, message, {"s": "abc"})
    streams[leaf][0] = given
    with pytest.raises(ValueError) as caught:
        encode(plan, streams)
    assert str(caught.value) == refusal
