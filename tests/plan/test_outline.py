"""The outline of a layout: its plan gives every packet the same status as the full plan."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from firm_hdl.frontend import load_message
from firm_hdl.model import PRIMITIVES, Array, Field, Message, Sequence
from firm_hdl.plan import build_plan, check, decode, encode
from firm_hdl.plan.outline import outline
from firm_hdl.plan.tree import Run
from firm_hdl.sim.values import to_transfers
from firm_hdl.wire import lay_out, walk
from firm_hdl.wire.layout import LoopNode, RunNode, Scalar, Trigger
from tests.depth import by_depth
from tests.plan.test_random_messages import damaged, typed_values
from tests.strategies import BUS_WIDTHS, make, on_every_bus

slow = settings(
    max_examples=by_depth(25, 100),
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)


UINT8 = PRIMITIVES["ros1"]["uint8"]


def plans_of(message, wire, bus_bytes, **options):
    layout = lay_out(message, wire)
    plan = build_plan(layout, bus_bytes=bus_bytes, **options)
    return plan, build_plan(outline(layout, bus_bytes), bus_bytes=bus_bytes, **options)


def message_of(name, **fields):
    members = tuple(Field(name=key, type=kind) for key, kind in fields.items())
    return Message(name=name, dialect="ros1", fields=members)


@pytest.mark.parametrize("wire", ["ros1", "cdr"])
@slow
@given(data=st.data(), case=typed_values(wide=True), bus_bytes=st.sampled_from(BUS_WIDTHS))
@pytest.mark.sampled(2)
def test_both_plans_give_the_same_status(wire, data, case, bus_bytes):
    definition, value = case
    plan, short = plans_of(definition.message, wire, bus_bytes, max_message_bytes=100_000)
    assert check(short) == []
    good = encode(plan, to_transfers(plan, definition.message, value))[0]
    for packet in [good, *data.draw(st.lists(damaged(good), min_size=1, max_size=6))]:
        assert decode(short, packet).status == decode(plan, packet).status


@on_every_bus
@pytest.mark.parametrize("wire", ["ros1", "cdr"])
def test_lengths_and_their_limits_stay(wire, bus_bytes):
    message = load_message("visualization_msgs/msg/InteractiveMarker")
    plan, short = plans_of(message, wire, bus_bytes)
    names = [
        {
            (p.leaves[leaf].path[:-1], length.limit, length.charge)
            for leaf, length in p.lengths.items()
        }
        for p in (plan, short)
    ]
    # A sequence of numbers that are wider than the bus is a loop in both.
    assert names[0] == names[1]


@on_every_bus
def test_padding_within_the_first_element_of_a_loop(bus_bytes):
    element = make("ros2", {"a": "float32", "b": "string"}, "Element")
    _, short = plans_of(
        message_of("p/msg/T", a=UINT8, b=Array(element=element, count=1)), "cdr", bus_bytes
    )
    assert check(short) == []


@pytest.mark.parametrize(
    ("name", "bus_bytes", "steps", "short"),
    [
        ("geometry_msgs/msg/Twist", 8, 6, 2),
        ("sensor_msgs/msg/Imu", 8, 16, 6),
        ("sensor_msgs/msg/Imu", 1, 115, 21),
        ("sensor_msgs/msg/PointCloud2", 8, 12, 12),
        ("visualization_msgs/msg/InteractiveMarker", 8, 73, 59),
    ],
)
def test_bytes_between_lengths_take_few_steps(name, bus_bytes, steps, short):
    plans = plans_of(load_message(name), "cdr", bus_bytes)
    assert [len(plan.steps) for plan in plans] == [steps, short]


def test_an_array_of_messages_is_bytes_if_its_padding_is_fixed():
    pair = message_of("p/Pair", a=PRIMITIVES["ros1"]["uint32"], b=UINT8)
    message = message_of("p/Many", x=UINT8, pairs=Array(element=pair, count=1000), y=UINT8)
    layout = lay_out(message, "ros1")
    assert [type(node) for node in outline(layout, 8).nodes] == [RunNode, RunNode]
    assert sum(node.length.count for node in outline(layout, 8).nodes) == 1 + 1000 * 5 + 1
    # 3 bytes of padding before the first element, and 3 between two elements.
    layout = lay_out(message, "cdr")
    assert sum(node.length.count for node in outline(layout, 8).nodes) == 1 + 1000 * 8 + 1
    _, short = plans_of(message, "cdr", 8)
    assert sum(isinstance(item, Run) for item in short.items) == 1
    assert decode(short, b"\0\1\0\0" + bytes(8002)).status == "OK"
    assert decode(short, b"\0\1\0\0" + bytes(8001)).status == "TRUNCATED"


AHEAD = make("ros2", {"x": "uint32", "y": "uint8"}, "Ahead")


INSIDE = make("ros2", {"y": "uint8", "x": "uint32"}, "Inside")


@pytest.mark.parametrize(
    ("element", "count", "kinds"),
    [
        # Only the padding before the one element differs: a number that has it, and a byte.
        (AHEAD, 1, [RunNode, Scalar, RunNode]),
        # The padding before the second element is another one.
        (AHEAD, 2, [RunNode, LoopNode]),
        # The padding inside an element differs.
        (INSIDE, 1, [RunNode, LoopNode]),
        (INSIDE, 2, [RunNode, LoopNode]),
    ],
)
def test_padding_that_differs_stays_where_it_is(element, count, kinds):
    message = make("ros2", {"s": "string", "p": (element, f"[{count}]")})
    nodes = outline(lay_out(message), 8).nodes
    assert [type(node) for node in nodes] == kinds
    _, short = plans_of(message, "cdr", 8)
    assert check(short) == []


def test_four_bus_words_of_bytes_share_a_step_with_the_length_after_them():
    """A run would take a cycle for its last word, and the length another one."""
    element = make("ros1", {"x": "uint64[4]", "t": "string"}, "Element")
    _, short = plans_of(make("ros1", {"e": (element, "[]")}), "ros1", 8)
    visits = decode(short, b"\1\0\0\0" + bytes(32 + 4)).steps
    # The number of elements, the four words with the length, and the end with the rest of `t`.
    assert [visit.bytes for visit in visits] == [4, 8, 8, 8, 12, 0]


def test_elements_without_bytes_are_only_counted():
    empty = message_of("p/Nothing")
    twice = message_of("p/Twice", a=empty, b=Array(element=empty, count=7))
    message = message_of(
        "p/Many", fixed=Array(element=twice, count=1 << 20), counted=Sequence(element=twice)
    )
    plan, short = plans_of(message, "ros1", 8, max_message_bytes=1000)
    nodes = list(walk(outline(lay_out(message, "ros1"), 8).nodes))
    assert [type(node) for node in nodes] == [LoopNode, Trigger]
    assert len(short.steps) == 2
    assert decode(short, (996).to_bytes(4, "little")).status == "OK"
    assert decode(short, (997).to_bytes(4, "little")).status == "LENGTH"
    assert next(iter(plan.lengths.values())).limit == 996


def test_a_message_without_bytes_has_one_step():
    _, short = plans_of(message_of("p/Nothing"), "ros1", 8)
    assert len(short.steps) == 1
    assert decode(short, b"").status == "OK"
    assert decode(short, b"\0").status == "TRAILING"
