# amaranth: UnusedElaboratable=no
"""A serializer's errors and packets, in tables made by hand from docs/reference/status.md.

The tables use no plan and no interpreter. Every wrong message is between good ones, which it must
not affect; ignored lanes carry noise.
"""

from __future__ import annotations

import random

import pytest

from firm_hdl import Serializer
from firm_hdl.sim import Harness, RunOptions, Stalls
from tests.gateware.test_status_table import OTHERS, SLOW, every_bus, packet, some_buses, stalls_on
from tests.strategies import make

# Serializer. A leaf is given by its items and by the place of a wrong `last`.

SENT = make("ros1", {"a": "uint8[<=2]", "b": "uint8[3]", "c": "uint8[<=1]", "z": "uint8"})
NO, EARLY, LATE = "right", "early", "late"
# Items and end of a, end of b, items and end of c; status and packet.
WRITE = [
    (b"ab", NO, NO, b"c", NO, "OK", "02000000 6162 010203 01000000 63 07"),
    (b"", NO, NO, b"", NO, "OK", "00000000 010203 00000000 07"),
    # One error.
    (b"abc", NO, NO, b"c", NO, "LENGTH", "03000000 616263 010203 01000000 63 07"),
    (b"ab", LATE, NO, b"c", NO, "ITEMS", "02000000 6162 010203 01000000 63 07"),
    (b"ab", NO, LATE, b"c", NO, "ITEMS", "02000000 6162 010203 01000000 63 07"),
    (b"ab", NO, NO, b"cd", NO, "LENGTH", "02000000 6162 010203 02000000 6364 07"),
    (b"ab", NO, NO, b"c", LATE, "ITEMS", "02000000 6162 010203 01000000 63 07"),
    # Two errors, of the same and of different leaves: the first in wire order is reported.
    (b"abc", LATE, NO, b"c", NO, "LENGTH", "03000000 616263 010203 01000000 63 07"),
    (b"abc", NO, LATE, b"c", NO, "LENGTH", "03000000 616263 010203 01000000 63 07"),
    (b"abc", NO, NO, b"cd", NO, "LENGTH", "03000000 616263 010203 02000000 6364 07"),
    (b"abc", NO, NO, b"", NO, "LENGTH", "03000000 616263 010203 00000000 07"),
    (b"abc", NO, NO, b"c", LATE, "LENGTH", "03000000 616263 010203 01000000 63 07"),
    (b"ab", LATE, LATE, b"c", NO, "ITEMS", "02000000 6162 010203 01000000 63 07"),
    (b"ab", LATE, NO, b"cd", NO, "ITEMS", "02000000 6162 010203 02000000 6364 07"),
    (b"ab", NO, LATE, b"cd", NO, "ITEMS", "02000000 6162 010203 02000000 6364 07"),
    (b"ab", NO, LATE, b"c", LATE, "ITEMS", "02000000 6162 010203 01000000 63 07"),
    (b"ab", NO, NO, b"cd", LATE, "LENGTH", "02000000 6162 010203 02000000 6364 07"),
    (b"abc", LATE, LATE, b"cd", LATE, "LENGTH", "03000000 616263 010203 02000000 6364 07"),
    # `last` too early, where there is more than one transfer.
    (
        b"abc" * 9,
        EARLY,
        NO,
        b"c",
        NO,
        "LENGTH",
        "1b000000" + "616263" * 9 + "010203 01000000 63 07",
    ),
    (
        b"ab",
        NO,
        NO,
        b"cdef" * 20,
        EARLY,
        "LENGTH",
        "02000000 6162 010203 50000000" + "63646566" * 20 + "07",
    ),
]


def lanes_of(items, lanes, last, noise):
    """Return the transfers of items; lanes that are not used carry noise."""
    found = []
    for at in range(0, len(items), lanes):
        part = [*items[at : at + lanes]]
        is_end = at + lanes >= len(items)
        part += [noise.randrange(256) for _ in range(lanes - len(part))]
        found.append((tuple(part), is_end if last == NO else not is_end))
        if last == LATE and not is_end:
            found[-1] = (found[-1][0], False)
    return found


@every_bus
def test_first_error_of_a_message_is_reported_and_marks_its_packet(bus_bytes):
    tx = Serializer(SENT, bus_bytes=bus_bytes)
    leaves = {str(leaf): number for number, leaf in enumerate(tx.plan.leaves)}
    noise = random.Random(bus_bytes)
    rows = [row for each in WRITE for row in (each, WRITE[0])]
    messages = [
        {
            leaves["a.length"]: [len(a)],
            leaves["a.items"]: lanes_of(a, bus_bytes, a_last, noise),
            leaves["b.items"]: lanes_of(b"\1\2\3", bus_bytes, b_last, noise),
            leaves["c.length"]: [len(c)],
            leaves["c.items"]: lanes_of(c, bus_bytes, c_last, noise),
            leaves["z"]: [7],
        }
        for a, a_last, b_last, c, c_last, _, _ in rows
    ]
    harness = Harness(None, tx, message=SENT)
    for stalls in stalls_on(bus_bytes, (None, {"packets_out": SLOW, **OTHERS})):
        seen = harness.run_messages(messages, RunOptions(stalls=stalls))
        assert seen.packets == [packet(text) for *_, text in rows]
        assert [status.name for status in seen.statuses] == [row[5] for row in rows]
        assert seen.packet_errors == [row[5] != "OK" for row in rows]
        assert not seen.not_taken


# The end of b's items and the length of c are in one step, except on a bus of 1 byte.
FUSED = [
    (NO, b"c", NO, "OK"),
    (LATE, b"c", NO, "ITEMS"),
    (NO, b"cd", NO, "LENGTH"),
    (LATE, b"cd", NO, "ITEMS"),
    (NO, b"cd", LATE, "LENGTH"),
    (LATE, b"cd", LATE, "ITEMS"),
    (NO, b"c", LATE, "ITEMS"),
]


@every_bus
def test_first_error_of_a_step_is_reported(bus_bytes):
    b = bytes(range(1, 3 if bus_bytes == 2 else 5))
    fields = {"x": "uint8", "b": f"uint8[{len(b)}]", "c": "uint8[<=1]", "z": "uint8"}
    tx = Serializer(make("ros1", fields), bus_bytes=bus_bytes)
    leaves = {str(leaf): number for number, leaf in enumerate(tx.plan.leaves)}
    noise = random.Random(bus_bytes)
    rows = [row for each in FUSED for row in (each, FUSED[0])]
    messages = [
        {
            leaves["x"]: [9],
            leaves["b.items"]: lanes_of(b, bus_bytes, b_last, noise),
            leaves["c.length"]: [len(c)],
            leaves["c.items"]: lanes_of(c, bus_bytes, c_last, noise),
            leaves["z"]: [7],
        }
        for b_last, c, c_last, _ in rows
    ]
    harness = Harness(None, tx)
    for stalls in stalls_on(bus_bytes):
        seen = harness.run_messages(messages, RunOptions(stalls=stalls and {"status": SLOW}))
        assert seen.packets == [
            b"\x09" + b + bytes((len(c), 0, 0, 0)) + c + b"\7" for _, c, _, _ in rows
        ]
        assert [status.name for status in seen.statuses] == [row[3] for row in rows]
        assert seen.packet_errors == [row[3] != "OK" for row in rows]


# An error in the last word of a message, or in its only one.
@pytest.mark.parametrize("wire", ["ros1", "cdr"])
@some_buses
@pytest.mark.sampled(4)
def test_error_in_the_last_word_of_a_message_marks_it(bus_bytes, wire):
    tx = Serializer(make("ros2", {"s": "string<=2"}), wire=wire, bus_bytes=bus_bytes)
    noise = random.Random(bus_bytes)
    rows = [
        (b"ab", NO, "OK"),
        (b"abc", NO, "LENGTH"),
        (b"ab", NO, "OK"),
        (b"ab", LATE, "ITEMS"),
        (b"", NO, "OK"),
        (b"abc", LATE, "LENGTH"),
        (b"ab", NO, "OK"),
    ]
    seen = Harness(None, tx).run_messages(
        [{0: [len(text)], 1: lanes_of(text, bus_bytes, last, noise)} for text, last, _ in rows]
    )
    head, nul = (b"\0\1\0\0", b"\0") if wire == "cdr" else (b"", b"")
    assert seen.packets == [
        head + bytes((len(text) + len(nul), 0, 0, 0)) + text + nul for text, _, _ in rows
    ]
    assert [each.name for each in seen.statuses] == [status for _, _, status in rows]
    assert seen.packet_errors == [status != "OK" for _, _, status in rows]


# Lengths that `max_message_bytes` has room for; the shortest message has 9 bytes.
@pytest.mark.parametrize(("count", "status"), [(7, "OK"), (8, "LENGTH"), (9, "LENGTH")])
@some_buses
@pytest.mark.sampled(6)
def test_limit_of_a_serializer_is_exact(bus_bytes, count, status):
    message = make("ros1", {"s": "string", "t": "string", "z": "uint8"})
    tx = Serializer(message, bus_bytes=bus_bytes, max_message_bytes=16)
    noise = random.Random(count)
    text = bytes(range(count))
    messages = [
        {
            0: [len(each)],
            1: lanes_of(each, bus_bytes, NO, noise),
            2: [1],
            3: lanes_of(b"t", bus_bytes, NO, noise),
            4: [7],
        }
        for each in (text, b"ab")
    ]
    seen = Harness(None, tx, message=message).run_messages(messages)
    rest = b"\1\0\0\0t\7"
    assert seen.packets == [
        bytes((count, 0, 0, 0)) + text + rest,
        b"\2\0\0\0ab" + rest,
    ]
    assert [each.name for each in seen.statuses] == [status, "OK"]
    assert seen.packet_errors == [status != "OK", False]


@pytest.mark.parametrize("bus_bytes", [2, 8, 64])
@pytest.mark.sampled(2)
def test_packets_shorter_than_a_beat_stay_apart_while_none_is_taken(bus_bytes):
    message = make("ros1", {"x": "uint8"})
    tx = Serializer(message, bus_bytes=bus_bytes)
    stalls = {"packets_out": Stalls.bits("0" * 9 + "1"), "status": Stalls.bits("001")}
    messages = [{0: [number]} for number in range(20)]
    seen = Harness(None, tx).run_messages(messages, RunOptions(stalls=stalls))
    assert seen.packets == [bytes((number,)) for number in range(20)]
    assert not any(seen.packet_errors) and {each.name for each in seen.statuses} == {"OK"}
