"""Figures of plans by hand: bytes, beats, cycles, clocks, and which packet is the hardest."""

from __future__ import annotations

import pytest

from firm_hdl.plan import build_plan
from firm_hdl.plan.timing import Cost, Timing, clock_mhz, describe, timing
from firm_hdl.wire import lay_out
from tests.strategies import make

PAIR = make("ros1", {"x": "uint16", "y": "uint16"}, "Pair")
WIDE = make("ros1", {"x": "uint64", "y": "uint64"}, "Wide")
TEXT = make("ros1", {"s": "string"}, "Text")
ROW = make("ros1", {"texts": (TEXT, "[]")}, "Row")


def plan_of(fields, bus_bytes, dialect="ros1"):
    return build_plan(lay_out(make(dialect, fields)), bus_bytes=bus_bytes)


def cost(size, beats, steps):
    return Cost(bytes=size, beats=beats, steps=steps)


def test_figures_of_a_type_of_one_size():
    figures = timing(plan_of({"a": "uint32"}, 4, "ros2"))
    only = cost(8, 2, 2)
    assert figures == Timing(
        bus_bytes=4, steps=2, window_bytes=4, window_beats=1, shortest=only, hardest=only
    )


def test_window_of_steps_that_stand_anywhere():
    figures = timing(plan_of({"s": "string", "d": "uint64"}, 8))
    assert (figures.window_bytes, figures.window_beats) == (8, 2)


@pytest.mark.parametrize(
    ("fields", "bus_bytes", "shortest", "hardest"),
    [
        # A length in one cycle; one character takes another one.
        ({"s": "string"}, 8, cost(4, 1, 1), cost(5, 1, 2)),
        # Longer texts are easier: the bus is busy all the time.
        ({"s": "string"}, 1, cost(4, 4, 4), cost(4, 4, 4)),
        # In loops, 16 elements, each a length and a character in two cycles.
        ({"d": "uint64[3]", "t": (TEXT, "[]")}, 8, cost(28, 4, 4), cost(108, 14, 36)),
        # Not more than the bound allows.
        ({"d": "uint64[3]", "t": (TEXT, "[<=3]")}, 8, cost(28, 4, 4), cost(43, 6, 10)),
        # In loops in loops 4 of each: a cycle for each length but the first, and each character.
        ({"d": "uint64[3]", "rows": (ROW, "[]")}, 8, cost(28, 4, 4), cost(124, 16, 40)),
        # Texts make it harder, and elements that fill the bus easier: a character, and no element.
        ({"s": "string", "w": (WIDE, "[]")}, 8, cost(8, 1, 2), cost(9, 2, 3)),
        # Elements that fill the bus are no harder than none.
        ({"pairs": (PAIR, "[]")}, 4, cost(4, 1, 1), cost(4, 1, 1)),
    ],
)
def test_shortest_and_hardest_packets(fields, bus_bytes, shortest, hardest):
    dialect = "ros2" if "<=" in str(fields) else "ros1"
    plan = build_plan(lay_out(make(dialect, fields), "ros1"), bus_bytes=bus_bytes)
    figures = timing(plan)
    assert (figures.shortest, figures.hardest) == (shortest, hardest)


@pytest.mark.parametrize(
    ("fields", "bus_bytes", "hardest"),
    [
        # No text at all in one element: its NUL is a cycle of its own.
        ({"t": (TEXT, "[]")}, 2, cost(13, 7, 7)),
        # Items that fill a word and one more, or just a word, so that the next field starts anew.
        ({"t": (TEXT, "[]"), "a": "uint8", "b": "uint16[]"}, 2, cost(24, 12, 13)),
        ({"s": "string", "a": "uint8[]", "b": "uint8"}, 2, cost(20, 10, 11)),
        ({"a": "uint8[]", "b": "uint16", "c": "float64[]"}, 4, cost(60, 15, 16)),
    ],
)
def test_lengths_around_the_bus_width_are_tried(fields, bus_bytes, hardest):
    assert timing(plan_of(fields, bus_bytes, "ros2")).hardest == hardest


def test_packets_with_too_many_transfers_are_left_out(monkeypatch):
    fields = {"d": "uint64[3]", "t": (TEXT, "[]")}
    # 3 transfers, a length, and two for each element.
    hardest = {
        36: cost(108, 14, 36),
        35: cost(92, 12, 20),
        20: cost(92, 12, 20),
        19: cost(33, 5, 6),
    }
    for most, found in hardest.items():
        monkeypatch.setattr("firm_hdl.plan.timing.MAX_TRANSFERS", most)
        assert timing(plan_of(fields, 8)).hardest == found


@pytest.mark.parametrize(("count", "searched"), [(2046, True), (2047, True), (2048, False)])
def test_nothing_is_searched_where_short_texts_are_a_small_part(count, searched):
    figures = timing(plan_of({"d": f"float64[{count}]", "s": "string"}, 8))
    assert figures.shortest.bytes == 8 * count + 4
    assert (figures.hardest.bytes > figures.shortest.bytes) == searched


def test_cycles_are_beats_or_steps_whichever_are_more():
    assert (cost(9, 3, 2).cycles, cost(9, 2, 3).cycles) == (3, 3)


def test_clock_is_what_the_bits_of_the_line_ask_for():
    # 125 million bytes a second: a packet of 5 bytes each 40 ns, in 3 cycles.
    assert clock_mhz(cost(5, 2, 3), 1e9) == pytest.approx(75)
    assert clock_mhz(cost(0, 1, 1), 1e9) == pytest.approx(125)


ONE_SIZE = """\
N on ros1, 32-bit bus: 1 step; packet 4 bytes, 1 beat, 1 cycle
    clock for every packet: 100 Mbit/s 3.1 MHz, 1 Gbit/s 31.2 MHz, 10 Gbit/s 312.5 MHz"""
LONG = """\
N on ros1, 64-bit bus: 2 steps; shortest packet 4 bytes, 1 beat, 1 cycle
    clock for long strings or arrays: 100 Mbit/s 1.6 MHz, 1 Gbit/s 15.6 MHz, 10 Gbit/s 156.2 MHz
    clock for the hardest packet tried (5 bytes, 1 beat, 2 cycles): 100 Mbit/s 5.0 MHz, \
1 Gbit/s 50.0 MHz, 10 Gbit/s 500.0 MHz"""
# Its array is of one size, and its sequence is of messages.
MANY = """\
N on ros1, 32-bit bus: 3 steps; shortest packet 7 bytes, 2 beats, 2 cycles
    clock for the hardest packet tried (the shortest): 100 Mbit/s 3.6 MHz, 1 Gbit/s 35.7 MHz, \
10 Gbit/s 357.1 MHz"""


@pytest.mark.parametrize(
    ("fields", "bus_bytes", "text"),
    [
        ({"a": "uint32"}, 4, ONE_SIZE),
        ({"s": "string"}, 8, LONG),
        ({"f": "uint8[3]", "ps": (PAIR, "[]")}, 4, MANY),
    ],
)
def test_figures_in_words(fields, bus_bytes, text):
    plan = plan_of(fields, bus_bytes)
    assert describe("N", plan, timing(plan)) == text
