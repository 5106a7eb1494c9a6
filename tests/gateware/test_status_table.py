# amaranth: UnusedElaboratable=no
"""A deserializer's errors and transfers, in tables made by hand from docs/reference/status.md.

The tables use no plan and no interpreter. Every wrong packet or message is between good ones, which
it must not affect; ignored lanes carry noise.
"""

from __future__ import annotations

import pytest

from firm_hdl import Deserializer
from firm_hdl.sim import Harness, RunOptions, Stalls, from_transfers
from firm_hdl.sim.transfers import split_transfers, transfer_table
from tests.depth import by_depth
from tests.strategies import BUS_WIDTHS, make

some_buses = pytest.mark.parametrize("bus_bytes", by_depth([1, 16], [1, 4, 16]))
every_bus = pytest.mark.parametrize("bus_bytes", by_depth([1, 16], BUS_WIDTHS))
# No stalls; then stalls on all streams, longest on `status`.
SLOW = Stalls(0.3, 1, 2, seed=5)
OTHERS = {"message": SLOW, "status": Stalls.bits("0" * 9 + "1")}
STALLS = (None, {"packets_in": SLOW, **OTHERS})


def packet(text):
    return bytes.fromhex(text)


# Deserializer, CDR. The parts of a good packet, and wrong parts in their place.

MESSAGE = make(
    "ros2", {"a": "uint8", "s": "string<=3", "t": "string", "q": "uint16[<=2]", "z": "uint8"}
)
HEAD, A = "00010000 ", "01a5a5a5 "
S, T = "03000000 616200 a5 ", "02000000 6300 a5a5 "
Q, Z = "02000000 0a000b00 ", "07"
WRONG, FOREIGN = "00020000 ", "01010000 "
S_LONG, S_OPEN = "05000000 616263 64 ", "03000000 616278 a5 "
T_OPEN, Q_LONG = "02000000 6378 a5a5 ", "03000000 0a000b00 "
MORE = "a5" * 4
GOOD = HEAD + A + S + T + Q + Z

ZERO = {"a": 0, "s": "", "t": "", "q": [], "z": 0}
TO_A = {**ZERO, "a": 1}
TO_S = {**TO_A, "s": "ab"}
TO_T = {**TO_S, "t": "c"}
WHOLE = {**TO_T, "q": [10, 11], "z": 7}

READ = [
    # One error, or none.
    (GOOD, "OK", WHOLE),
    (GOOD + "a5a5a5", "OK", WHOLE),
    (GOOD + MORE, "TRAILING", WHOLE),
    (GOOD + 40 * MORE, "TRAILING", WHOLE),
    (WRONG + A + S + T + Q + Z, "ENCAPSULATION", ZERO),
    (FOREIGN + A + S + T + Q + Z, "ENCAPSULATION", ZERO),
    (HEAD + A + S_LONG + T + Q + Z, "LENGTH", TO_A),
    (HEAD + A + S + T + Q_LONG + Z, "LENGTH", TO_T),
    (HEAD + A + S_OPEN + T + Q + Z, "STRING", TO_S),
    (HEAD + A + S + T_OPEN + Q + Z, "STRING", TO_T),
    (HEAD + A + S + T + Q, "TRUNCATED", {**WHOLE, "z": 0}),
    (HEAD + A + S + T + Q[:-3], "TRUNCATED", {**WHOLE, "q": [10, 0], "z": 0}),
    # Lengths at their bounds.
    (HEAD + A + "04000000 61626300" + T + Q + Z, "OK", {**WHOLE, "s": "abc"}),
    (HEAD + A + "00000000 " + T + Q + Z, "OK", {**WHOLE, "s": ""}),
    (HEAD + A + S + T + "00000000 " + Z, "OK", {**WHOLE, "q": []}),
    (HEAD + A + S + T + "01000000 0a00 " + Z, "OK", {**WHOLE, "q": [10]}),
    # Lengths with high bytes that are not 0.
    (HEAD + A + "03000001 616200 a5" + T + Q + Z, "LENGTH", TO_A),
    (HEAD + A + S + T + "02000080 0a000b00" + Z, "LENGTH", TO_T),
    # The header is checked byte by byte.
    ("", "TRUNCATED", ZERO),
    ("00", "TRUNCATED", ZERO),
    ("0001", "TRUNCATED", ZERO),
    ("000100", "TRUNCATED", ZERO),
    ("00010000", "TRUNCATED", ZERO),
    ("0001ffff" + A + S + T + Q + Z, "OK", WHOLE),
    ("01", "ENCAPSULATION", ZERO),
    ("0002", "ENCAPSULATION", ZERO),
    # Two errors: first the encapsulation,
    (WRONG + A, "ENCAPSULATION", ZERO),
    (WRONG + A + S_LONG + T + Q + Z, "ENCAPSULATION", ZERO),
    (WRONG + A + S_OPEN + T + Q + Z, "ENCAPSULATION", ZERO),
    (WRONG + A + S + T + Q + Z + MORE, "ENCAPSULATION", ZERO),
    # then a length,
    (HEAD + A + S_LONG + T_OPEN + Q + Z, "LENGTH", TO_A),
    (HEAD + A + S_LONG + T + Q_LONG + Z, "LENGTH", TO_A),
    (HEAD + A + "05000000", "LENGTH", TO_A),
    (HEAD + A + S + T + "03000000", "LENGTH", TO_T),
    (HEAD + A + S_LONG + T + Q + Z + MORE, "LENGTH", TO_A),
    # a string,
    (HEAD + A + S_OPEN + T + Q_LONG + Z, "STRING", TO_S),
    (HEAD + A + S_OPEN + T_OPEN + Q + Z, "STRING", TO_S),
    (HEAD + A + "03000000 616278", "STRING", TO_S),
    (HEAD + A + S + "02000000 6378", "STRING", TO_T),
    (HEAD + A + S_OPEN + T + Q + Z + MORE, "STRING", TO_S),
    # and the end of the packet.
    (HEAD + A + "050000", "TRUNCATED", TO_A),
    (HEAD + A + "03000000 6162", "TRUNCATED", TO_S),
    (HEAD + A + "03000000 61", "TRUNCATED", {**TO_A, "s": "a\0"}),
    (HEAD + A + S + T + "030000", "TRUNCATED", TO_T),
]

# A string at the end of the message, with bytes after it.
LAST = make("ros2", {"t": "string<=2"})
READ_LAST = [
    (HEAD + "02000000 6300", "OK", {"t": "c"}),
    (HEAD + "02000000 6300 a5a5a5", "OK", {"t": "c"}),
    (HEAD + "02000000 6300 a5a5a5a5", "TRAILING", {"t": "c"}),
    (HEAD + "02000000 6378", "STRING", {"t": "c"}),
    (HEAD + "02000000 6378 a5a5a5a5", "STRING", {"t": "c"}),
    (HEAD + "00000000 a5a5a5", "OK", {"t": ""}),
    (HEAD + "00000000 a5a5a5a5", "TRAILING", {"t": ""}),
    (HEAD + "01000000 00", "OK", {"t": ""}),
    (HEAD + "01000000 78", "STRING", {"t": ""}),
    (HEAD + "01000000", "TRUNCATED", {"t": ""}),
    (HEAD + "04000000 63646500", "LENGTH", {"t": ""}),
    (HEAD + "04000000 63646578 a5a5a5a5", "LENGTH", {"t": ""}),
]

# ROS 1: no alignment, no header, no NUL. The only bounds follow from the largest packet, of 20
# bytes: the shortest packet has 10, so 10 characters or 5 numbers have room.
PLAIN = make("ros1", {"a": "uint8", "s": "string", "q": "uint16[]", "z": "uint8"})
PLAIN_MOST = 20
NOTHING = {"a": 0, "s": "", "q": [], "z": 0}
READ_PLAIN = [
    ("01 02000000 6162 01000000 0a00 07", "OK", {"a": 1, "s": "ab", "q": [10], "z": 7}),
    (
        "01 0a000000 61626162616261626162 00000000 07",
        "OK",
        {**NOTHING, "a": 1, "s": "ab" * 5, "z": 7},
    ),
    ("01 0b000000 6162616261626162616261 00000000 07", "LENGTH", {**NOTHING, "a": 1}),
    (
        "01 00000000 05000000 01000200030004000500 07",
        "OK",
        {"a": 1, "s": "", "q": [1, 2, 3, 4, 5], "z": 7},
    ),
    ("01 00000000 06000000 010002000300040005000600 07", "LENGTH", {**NOTHING, "a": 1}),
    ("01 0b000000", "LENGTH", {**NOTHING, "a": 1}),
    ("01 0b000000 a5a5a5a5 06000000 a5a5a5a5a5a5a5a5a5a5a5a5", "LENGTH", {**NOTHING, "a": 1}),
    ("01 02000000 61", "TRUNCATED", {**NOTHING, "a": 1, "s": "a\0"}),
    ("01 02000000 6162 06000000", "LENGTH", {**NOTHING, "a": 1, "s": "ab"}),
    ("01 02000000 6162 060000", "TRUNCATED", {**NOTHING, "a": 1, "s": "ab"}),
    ("01 00000000 00000000 07a5", "TRAILING", {**NOTHING, "a": 1, "z": 7}),
    ("01 00000000 00000000", "TRUNCATED", {**NOTHING, "a": 1}),
    ("", "TRUNCATED", NOTHING),
]


def stalls_on(bus_bytes, stalls=STALLS):
    """Return the stalls for runs on a bus: every second bus width has none."""
    return by_depth(stalls[BUS_WIDTHS.index(bus_bytes) % 2 :][:1], stalls)


def check_reading(message, table, bus_bytes, plans=STALLS, **options):
    """Send each packet of a table, and a good one after each, under each plan of stalls."""
    good = table[0]
    rows = [row for each in table for row in (each, good)]
    rx = Deserializer(message, bus_bytes=bus_bytes, **options)
    harness = Harness(rx, None, message=message)
    for stalls in plans:
        seen = harness.run_packets([packet(text) for text, _, _ in rows], RunOptions(stalls=stalls))
        messages, _ = split_transfers(transfer_table(rx.plan, message), seen.transfers)
        assert len(messages) == len(rows)
        for (text, status, value), got, reported in zip(rows, messages, seen.statuses, strict=True):
            assert (reported.name, from_transfers(rx.plan, message, got)) == (status, value), text


@every_bus
def test_first_error_of_a_packet_in_wire_order_is_reported(bus_bytes):
    check_reading(MESSAGE, READ, bus_bytes, stalls_on(bus_bytes))


@pytest.mark.sampled(2)
@every_bus
def test_string_at_the_end_of_a_message_is_checked_before_trailing_bytes(bus_bytes):
    check_reading(LAST, READ_LAST, bus_bytes, stalls_on(bus_bytes))


@pytest.mark.sampled(2)
@some_buses
def test_limits_are_exact_without_alignment(bus_bytes):
    plans = stalls_on(bus_bytes)
    check_reading(PLAIN, READ_PLAIN, bus_bytes, plans, max_message_bytes=PLAIN_MOST)


# A bool is 1 for any byte but 0.
ARRAYS = {"x": "bool", "a": "uint16[4]", "b": "bool[3]"}
WORDS = [0x1111, 0x2222, 0x3333, 0x4444]
# The offsets of x, a and b.
PLACES = {
    "ros1": ("02 1111222233334444 018002", (0, 1, 9)),
    "ros2": (HEAD + "80 a5 1111222233334444 ff0110", (4, 6, 14)),
}


@pytest.mark.parametrize("dialect", PLACES)
@every_bus
@pytest.mark.sampled(4)
def test_items_that_are_not_whole_are_zero_whatever_is_in_their_lanes(bus_bytes, dialect):
    text, (x, a, b) = PLACES[dialect]
    whole = packet(text)
    table = []
    for size in reversed(range(len(whole) + 1)):
        words, flags = min(4, max(0, size - a) // 2), max(0, size - b)
        value = {
            "x": size > x,
            "a": WORDS[:words] + [0] * (4 - words),
            "b": [True] * flags + [False] * (3 - flags),
        }
        status = "OK" if size == len(whole) else "TRUNCATED"
        table.append((whole[:size].hex(), status, value))
    if dialect == "ros2":
        # After an error, whole items are zero, too.
        nothing = {"x": False, "a": [0] * 4, "b": [False] * 3}
        table.append((WRONG + text.removeprefix(HEAD), "ENCAPSULATION", nothing))
    check_reading(make(dialect, ARRAYS), table, bus_bytes, stalls_on(bus_bytes))
