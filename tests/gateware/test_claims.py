# amaranth: UnusedElaboratable=no
"""What nested lengths claim together: statuses by hand, transfers and cycles by the interpreter."""

from __future__ import annotations

import struct
from dataclasses import replace
from functools import cache

import pytest

from firm_hdl import Deserializer, Parser
from firm_hdl.gateware.signatures import LATENCY_CYCLES
from firm_hdl.plan import build_plan, decode
from firm_hdl.sim import RunOptions, Stalls
from firm_hdl.timing.recovery import recovery
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.gateware import test_parser
from tests.gateware.test_throughput import harness_of, measure_deserializer
from tests.plan.lengths import with_charges
from tests.strategies import make

MOST = 1024
"""Largest packet. Lengths that claim 256 bytes or more are counted."""

# The shortest element has 4 + 4 + 4 bytes, the shortest inner element 5.
INNER = make("ros1", {"s": "string", "x": "uint8"}, "Inner")
ELEMENT = make("ros1", {"x": "uint32", "s": "uint8[]", "i": (INNER, "[]")}, "Element")
MESSAGE = make("ros1", {"e": (ELEMENT, "[]"), "z": "uint8"})
ROOM = MOST - 4 - 1


def numbers(*values):
    return struct.pack(f"<{len(values)}I", *values)


def bomb(elements, items=0, inner=0, letters=0):
    """Return a packet that ends after lengths of sequences inside each other."""
    if items:
        return numbers(elements, 7, items)
    return numbers(elements, 7, 0, inner, letters) if inner else numbers(elements)


# Lengths, and the status: `LENGTH`, or what ends the packet.
CASES = [
    # One counted length: its own limit is the budget.
    ((84,), "TRUNCATED"),
    ((85,), "LENGTH"),
    # Elements and items: 60 * 12 + 299 bytes are all there are.
    ((60, 299), "TRUNCATED"),
    ((60, 300), "LENGTH"),
    # What claims fewer than 256 bytes is not counted: 255 items, 21 elements.
    ((80, 255), "TRUNCATED"),
    ((80, 256), "LENGTH"),
    ((21, ROOM), "TRUNCATED"),
    ((22, ROOM), "LENGTH"),
    # Three levels: 30 * 12 + 60 * 5 + 359 bytes.
    ((30, 0, 60, 359), "TRUNCATED"),
    ((30, 0, 60, 360), "LENGTH"),
    ((30, 0, 131, 0), "TRUNCATED"),
    ((30, 0, 132), "LENGTH"),
    # The inner elements are not counted, the letters are.
    ((30, 0, 51, 659), "TRUNCATED"),
    ((30, 0, 51, 660), "LENGTH"),
]


def bombs():
    return [(bomb(*lengths), status) for lengths, status in CASES]


def good(plan):
    """Return a packet in which two lengths are counted: 300 items, and 260 letters."""
    element = numbers(1, 300) + bytes(range(256)) + bytes(44) + numbers(1, 260) + bytes(261)
    packet = numbers(1) + element + b"\5"
    assert decode(plan, packet).status == "OK"
    return packet


def with_good(plan, rows):
    """Return rows with a good packet after each; most of these are short in `make test`."""
    short, every = numbers(0) + b"\5", by_depth(3, 1)
    goods = [good(plan) if number % every == 0 else short for number in range(len(rows))]
    return [each for row, ok in zip(rows, goods, strict=True) for each in (row, (ok, "OK"))]


def check_statuses(plan, rows):
    for packet, status in rows:
        assert decode(plan, packet).status == status, packet[:20]


@pytest.mark.parametrize("bus_bytes", [1, 4, 8, 64])
def test_the_interpreter_gives_the_statuses_of_the_table(bus_bytes):
    plan = build_plan(lay_out(MESSAGE), bus_bytes=bus_bytes, max_message_bytes=MOST)
    check_statuses(plan, bombs())
    # A twin: lengths that are only judged by themselves.
    with pytest.raises(AssertionError):
        check_statuses(with_charges(plan, lambda charge: None), bombs())


@cache
def reader(bus_bytes):
    return Deserializer(MESSAGE, bus_bytes=bus_bytes, max_message_bytes=MOST)


def check_transfers(rx, packets, stalls=None):
    """Send packets through a deserializer; compare all transfers and statuses with the plan."""
    seen = harness_of(rx).run_packets(packets, RunOptions(stalls=stalls))
    decoded = [decode(rx.plan, packet) for packet in packets]
    assert [status.name for status in seen.statuses] == [each.status for each in decoded]
    want = {}
    for each in decoded:
        for leaf, payloads in each.streams.items():
            want.setdefault(leaf, []).extend(payloads)
    for leaf, payloads in want.items():
        assert list(seen.transfers[leaf]) == payloads, str(rx.plan.leaves[leaf])


SLOW = {"packets_in": Stalls(0.3, 1, 2, seed=5), "message": Stalls(0.4, 1, 3, seed=6)}


@pytest.mark.parametrize(
    ("bus_bytes", "stalls"),
    by_depth([(8, SLOW)], [(b, s) for b in (1, 8, 64) for s in (None, SLOW)]),
)
def test_a_deserializer_refuses_what_claims_too_much(bus_bytes, stalls):
    rx = reader(bus_bytes)
    rows = by_depth(bombs()[3:4] + bombs()[9:12], bombs())
    packets = [packet for packet, _ in with_good(rx.plan, rows)]
    check_transfers(rx, packets, stalls)


@pytest.mark.parametrize("bus_bytes", by_depth([8], [1, 8, 64]))
def test_a_parser_gives_the_same_statuses(bus_bytes):
    parser = Parser(MESSAGE, bus_bytes=bus_bytes, max_message_bytes=MOST)
    plan = build_plan(lay_out(MESSAGE), bus_bytes=bus_bytes, max_message_bytes=MOST)
    rows = with_good(plan, bombs())
    seen = test_parser.run(parser, [packet for packet, _ in rows])
    assert [status.name for status in seen.statuses] == [status for _, status in rows]


# Three lengths in a row, each in a step of its own.
LINE = make("ros1", {"s": "string"}, "Line")
PAGE = make("ros1", {"l": (LINE, "[]")}, "Page")
BOOK = make("ros1", {"p": (PAGE, "[]")})
# The shortest page and the shortest line have 4 bytes each; 1020 bytes are left for all.
BOOK_CASES = [
    ((100, 80, 300), "TRUNCATED"),
    ((100, 80, 301), "LENGTH"),
    ((100, 155, 0), "TRUNCATED"),
    ((100, 156, 0), "LENGTH"),
    ((100, 156, 5000), "LENGTH"),
    ((255, 63, 255), "TRUNCATED"),
    ((255, 64, 1), "LENGTH"),
    ((256, 1, 1), "LENGTH"),
]


@pytest.mark.sampled(2)
@pytest.mark.parametrize("bus_bytes", by_depth([1, 8], [1, 2, 4, 8, 16, 32, 64]))
def test_a_parser_finds_late_that_lengths_in_a_row_claim_too_much(bus_bytes):
    parser = Parser(BOOK, bus_bytes=bus_bytes, max_message_bytes=MOST)
    # Short, cut inside a string, and followed by a good packet at once.
    tails = (b"", b"\0" * 9, b"\0" * 90)
    rows = [(numbers(*each) + tail, status) for each, status in BOOK_CASES for tail in tails]
    rows = [each for row in rows for each in (row, (numbers(1, 1, 0), "OK"))]
    for packet, status in rows:
        assert decode(parser.plan, packet).status == status
    seen = test_parser.run(parser, [packet for packet, _ in rows])
    assert [status.name for status in seen.statuses] == [status for _, status in rows]
    # A packet takes its beats or its steps up to the error, and at most 6 cycles.
    most = 0
    for packet, status in rows:
        visits = decode(parser.plan, packet).steps
        steps = 3 if status == "LENGTH" else 1 + sum(each.end <= len(packet) for each in visits)
        most += max(-(-len(packet) // bus_bytes), steps) + 6 * (status != "OK")
    assert seen.times[-1] <= most + test_parser.LATENCY


def test_a_parser_with_a_larger_budget_is_found():
    plan = Parser(BOOK, bus_bytes=8, max_message_bytes=MOST).plan
    larger = with_charges(
        plan, lambda charge: replace(charge, budget=charge.budget and charge.budget + 1)
    )
    parser = Parser(BOOK, plan=larger)
    seen = test_parser.run(parser, [numbers(100, 80, 301), numbers(100, 80, 302)])
    assert [status.name for status in seen.statuses] == ["TRUNCATED", "LENGTH"]
    assert decode(plan, numbers(100, 80, 301)).status == "LENGTH"


@pytest.mark.sampled(3)
@pytest.mark.parametrize("lengths", [(60, 299), (60, 300), (30, 0, 60, 359)])
def test_recovery_takes_the_cycles_of_the_interpreter_and_at_most_the_bound(lengths):
    rx = reader(8)
    packet = bomb(*lengths)
    visits = decode(rx.plan, packet).steps
    (status,) = measure_deserializer(rx, [packet])
    (beats,) = {-(-len(packet) // 8)}
    assert 0 <= status - len(visits) - sum(visit.held for visit in visits) <= 5 + 4 + beats
    after = sum(visit.end > len(packet) for visit in visits)
    assert after <= recovery(rx.plan, 1).cycles
    assert status <= recovery(rx.plan, 1).cycles + LATENCY_CYCLES["deserializer"] + beats + 4
