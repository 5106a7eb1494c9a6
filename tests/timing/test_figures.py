"""Figures of plans, computed by hand: bytes, beats, cycles, clocks, and the hardest packet."""

from __future__ import annotations

import pytest

from firm_hdl.plan import build_plan
from firm_hdl.timing import Cost, Timing, clock_mhz, timing
from firm_hdl.timing.recovery import Recovery
from firm_hdl.wire import lay_out
from tests.steps import calls_at_most
from tests.strategies import make

PAIR = make("ros1", {"x": "uint16", "y": "uint16"}, "Pair")
WIDE = make("ros1", {"x": "uint64", "y": "uint64"}, "Wide")
TEXT = make("ros1", {"s": "string"}, "Text")
ROW = make("ros1", {"texts": (TEXT, "[]")}, "Row")
TABLE = make("ros1", {"rows": (ROW, "[]")}, "Table")


def plan_of(fields, bus_bytes, dialect="ros1"):
    return build_plan(lay_out(make(dialect, fields)), bus_bytes=bus_bytes)


def cost(size, beats, steps, cycles=None):
    """Return a cost; `cycles` is by default the larger number of beats and steps."""
    cycles = max(beats, steps) if cycles is None else cycles
    return Cost(bytes=size, beats=beats, steps=steps, cycles=cycles)


def test_figures_of_a_type_of_one_size():
    figures = timing(plan_of({"a": "uint32"}, 4, "ros2"))
    # Header and field are two words, which one step takes.
    only = cost(8, 2, 1)
    found = Recovery(cycles=5, longest_packet=2)
    assert figures == Timing(bus_bytes=4, steps=1, shortest=only, hardest=only, recovery=found)


@pytest.mark.parametrize(
    ("fields", "bus_bytes", "shortest", "hardest"),
    [
        # A length in one cycle; the end of the packet, which takes the rest, in another one.
        ({"s": "string"}, 8, cost(4, 1, 2), cost(4, 1, 2)),
        # Longer texts are easier: they keep the bus busy.
        ({"s": "string"}, 1, cost(4, 4, 4), cost(4, 4, 4)),
        # In loops, 16 elements. Each is a length in a step, and a cycle more for the serializer, as
        # the same length follows. The serializer leaves out the last step, which finds no rest.
        ({"d": "uint64[3]", "t": (TEXT, "[]")}, 8, cost(28, 4, 5), cost(92, 12, 21, 20 + 15)),
        # No more elements than the bound.
        ({"d": "uint64[3]", "t": (TEXT, "[<=3]")}, 8, cost(28, 4, 5), cost(43, 6, 8, 8 + 2)),
        # Nested loops have 4 of each: the length of a row is between the lengths of texts.
        ({"d": "uint64[3]", "rows": (ROW, "[]")}, 8, cost(28, 4, 5), cost(108, 14, 25, 24 + 4 * 3)),
        # With one more level, 2 of each: 2 tables and 4 rows, with 2 texts each.
        ({"d": "uint64[3]", "ts": (TABLE, "[]")}, 8, cost(28, 4, 5), cost(84, 11, 19, 18 + 4)),
        # The deserializer knows too late that the length of `w` ends the packet.
        ({"s": "string", "w": (WIDE, "[]")}, 8, cost(8, 1, 2, 3), cost(8, 1, 2, 3)),
        # So elements that fill the bus are easier than no elements.
        ({"pairs": (PAIR, "[]")}, 4, cost(4, 1, 1, 2), cost(4, 1, 1, 2)),
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
        # One element without text: its NUL has its own beat.
        ({"t": (TEXT, "[]")}, 2, cost(13, 7, 5)),
        # One item has its own beat, too.
        ({"a": "uint8[]"}, 2, cost(9, 5, 4)),
        # No items, because the end of the packet takes its own cycle.
        ({"a": "uint8[]"}, 8, cost(8, 1, 2)),
        # Half a word of text, a NUL and padding: the last field starts a beat.
        ({"s": "string", "b": "uint16"}, 4, cost(14, 4, 2)),
    ],
)
def test_lengths_up_to_half_a_bus_word_are_tried(fields, bus_bytes, hardest):
    assert timing(plan_of(fields, bus_bytes, "ros2")).hardest == hardest


@pytest.mark.parametrize(("count", "searched"), [(2046, True), (2047, True), (2048, False)])
@pytest.mark.sampled(3)
def test_nothing_is_searched_where_short_texts_are_a_small_part(count, searched):
    figures = timing(plan_of({"d": f"float64[{count}]", "t": (TEXT, "[]")}, 8))
    assert figures.shortest.bytes == 8 * count + 4
    assert (figures.hardest.bytes > figures.shortest.bytes) == searched


def test_clock_follows_from_the_bit_rate_of_the_line():
    # 125 million bytes a second: a packet of 5 bytes each 40 ns, in 3 cycles.
    assert clock_mhz(cost(5, 2, 3), 1e9) == pytest.approx(75)
    assert clock_mhz(cost(0, 1, 1), 1e9) == pytest.approx(125)


def test_hundreds_of_fields_of_variable_length_take_no_minutes():
    item = make("ros2", {"a": "string", "b": "float64[]"}, "Item")
    kinds = ["string", "uint8[]", (item, "[]"), "uint8"]
    message = make("ros2", {f"f{n}": kinds[n % 4] for n in range(200)})
    plan = build_plan(lay_out(message))
    # Ten packets are followed, 451 steps each.
    with calls_at_most(3_000_000):
        timing(plan)
