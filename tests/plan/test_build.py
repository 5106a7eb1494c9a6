"""The promises of the planner: legal parameters, few steps, limits of lengths."""

from __future__ import annotations

import re

import pytest

from firm_hdl.plan import build_plan, check, decode, encode
from firm_hdl.plan.tree import Run, Step, walk
from firm_hdl.sim.values import to_transfers
from firm_hdl.wire import lay_out
from tests.strategies import make, on_every_bus

BLOB = make("ros2", {"x": "uint32", "data": "uint8[]"})


@pytest.mark.parametrize("width", [0, 3, 128, -8])
def test_bus_widths_are_powers_of_two_up_to_64(width):
    message = f"Bus width must be one of 1, 2, 4, 8, 16, 32, 64 bytes, not {width}"
    with pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        build_plan(lay_out(BLOB), bus_bytes=width)


@pytest.mark.parametrize("size", [0, 11, 1 << 32])
def test_the_largest_message_has_room_for_the_smallest(size):
    message = (
        "Maximum message size must be from 12 bytes, the least that a p/msg/T has, "
        f"to 4294967295, not {size}"
    )
    with pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        build_plan(lay_out(BLOB), max_message_bytes=size)


@pytest.mark.parametrize("number", [True, False, 8.0, "8", None])
def test_numbers_are_integers_and_no_flags(number):
    with pytest.raises(TypeError, match=f"^Bus width must be an integer, not {number!r}$"):
        build_plan(lay_out(BLOB), bus_bytes=number)
    layout = lay_out(make("ros1", {}))
    with pytest.raises(TypeError, match=f"^Maximum message size must be .*, not {number!r}$"):
        build_plan(layout, max_message_bytes=number)


def test_message_beyond_every_limit_is_refused_by_its_size():
    layout = lay_out(make("ros1", {"a": "uint8[4294967295]"}))
    assert build_plan(layout, max_message_bytes=(1 << 32) - 1).max_message_bytes == (1 << 32) - 1
    layout = lay_out(make("ros1", {"a": "uint8[4294967295]", "b": "uint8"}))
    message = "Each message has at least 4294967296 bytes, and at most 4294967295 are possible"
    with pytest.raises(ValueError, match=f"^{message}$"):
        build_plan(layout)


def test_the_smallest_message_is_the_largest_if_so_wished():
    plan = build_plan(lay_out(BLOB), max_message_bytes=12)
    packet = bytes.fromhex("00010000 05000000 00000000")
    assert decode(plan, packet).status == "OK"
    assert decode(plan, packet[:8] + b"\1\0\0\0x").status == "LENGTH"


@on_every_bus
def test_bulk_data_takes_a_bus_word_per_cycle(bus_bytes):
    plan = build_plan(lay_out(BLOB), bus_bytes=bus_bytes)
    value = {"x": 1, "data": bytes(range(256)) * 16}
    packet, _ = encode(plan, to_transfers(plan, BLOB, value))
    beats = -(-len(packet) // bus_bytes)
    assert len(decode(plan, packet).steps) <= beats + 2


@on_every_bus
def test_fixed_fields_take_no_more_cycles_than_beats(bus_bytes):
    kinds = ["uint8", "float64", "uint16", "uint32", "float64[9]", "uint8[21]"]
    message = make("ros2", {f"f{n}": kinds[n % len(kinds)] for n in range(40)})
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    packet = bytes.fromhex("00010000") + bytes(10000)
    visits = decode(plan, packet).steps
    size = sum(visit.bytes for visit in visits)
    assert len(visits) <= -(-size // bus_bytes) * 1.5 + 2


PAIR = make("ros1", {"x": "uint16", "y": "uint16"}, "Pair")
TEXT = make("ros1", {"s": "string"}, "Text")
NAMED = make("ros1", {"s": "string", "x": "uint32"}, "Named")


@pytest.mark.parametrize(
    ("fields", "sizes"),
    [
        # Two words in the last step save one if all packets are alike.
        ({"p": (PAIR, "[2]")}, [4, 8]),
        # Otherwise, short packets end with a step of one word, wherever a length is.
        ({"p": (PAIR, "[]")}, [4, 4, 4, 4]),
        ({"p": (TEXT, "[2]")}, [4, 4, 4]),
        ({"p": (NAMED, "[2]")}, [4, 4, 4, 4]),
        ({"s": "string"}, [4, 4, 4]),
    ],
)
def test_the_last_step_takes_two_words_if_no_length_is_in_the_message(fields, sizes):
    message = make("ros1", {**fields, "a": "uint32", "b": "uint32"})
    plan = build_plan(lay_out(message), bus_bytes=4)
    steps = [item for item in walk(plan.items) if isinstance(item, Step)]
    assert [step.bytes for step in steps if step.bytes] == sizes


@pytest.mark.parametrize(("more", "sizes"), [(56, [8]), (57, [4, 4])])
def test_the_first_length_of_a_short_packet_is_in_a_step_of_two_words(more, sizes):
    """The shortest packet has up to 16 bus words."""
    message = make("ros1", {"a": "uint32", "s": "string", "m": f"uint8[{more}]"})
    plan = build_plan(lay_out(message), bus_bytes=4)
    first = next(n for n, item in enumerate(plan.items) if isinstance(item, Run))
    assert [step.bytes for step in plan.items[:first]] == sizes


@pytest.mark.parametrize(
    ("kind", "bus_bytes", "runs", "levels"),
    [
        # Up to two transfers are as static as other values.
        ("uint8[16]", 8, 0, 0),
        ("uint8[17]", 8, 1, 0),
        ("uint64[2]", 8, 0, 0),
        ("uint64[3]", 8, 1, 0),
        # Items wider than the bus are a loop, unless there is one.
        ("uint64[1]", 4, 0, 0),
        ("uint64[2]", 4, 0, 1),
        ("uint64[<=1]", 4, 0, 1),
        ("uint64[<=1]", 8, 1, 0),
    ],
)
@pytest.mark.parametrize("wire", ["ros1", "cdr"])
def test_arrays_are_values_runs_or_loops(wire, kind, bus_bytes, runs, levels):
    # After a string, whose rest the first step takes, or a step of its own.
    for before in ({"a": "uint8"}, {"s": "string"}):
        layout = lay_out(make("ros2", {**before, "m": kind, "z": "uint16"}), wire)
        plan = build_plan(layout, bus_bytes=bus_bytes)
        found = sum(isinstance(item, Run) for item in walk(plan.items))
        assert (found - ("s" in before), plan.levels) == (runs, levels)
        assert check(plan, layout) == []


@on_every_bus
@pytest.mark.parametrize("wire", ["ros1", "cdr"])
@pytest.mark.parametrize(("inner", "outer"), [("[2]", "[]"), ("[]", "[2]"), ("[2]", "[3]")])
def test_a_step_takes_the_rest_of_one_run_only(wire, bus_bytes, inner, outer):
    """The first step of both loops may follow the text of either."""
    texts = make("ros2", {"ts": (TEXT, inner), "t": "string"}, "Texts")
    layout = lay_out(make("ros2", {"o": (texts, outer), "z": "uint8"}), wire)
    assert check(build_plan(layout, bus_bytes=bus_bytes), layout) == []
