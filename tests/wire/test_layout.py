"""The layout, compared with packets: its padding and sizes hold for every value."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from firm_hdl.model import (
    IDL_PRIMITIVES,
    PRIMITIVES,
    Array,
    Field,
    Message,
    Sequence,
    String,
)
from firm_hdl.plan import build_plan, encode
from firm_hdl.sim.values import to_transfers
from firm_hdl.wire import (
    RULES,
    ConstantLength,
    Gap,
    LengthField,
    LoopNode,
    RunNode,
    Scalar,
    Trigger,
    lay_out,
    walk,
)
from tests.depth import by_depth
from tests.plan.reference import Reference
from tests.strategies import definitions, make, values

slow = settings(
    max_examples=by_depth(20, 100),
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
P = PRIMITIVES["ros2"]
# Up to iron, the default middleware wrote four bytes.
WCHAR4 = replace(IDL_PRIMITIVES["wchar"], bytes=4)


def gaps_of(layout):
    """Return the layout's gaps by path, as the reference decoder names them."""
    result = {}
    for node in walk(layout.nodes):
        match node:
            case Scalar():
                result[node.path] = node.gap
            case RunNode() | LoopNode():
                if isinstance(node.length, LengthField):
                    result[(*node.path, "length")] = node.length.gap
                if isinstance(node, RunNode):
                    result[(*node.path, "items")] = node.item_gap
    return result


@pytest.mark.parametrize("wire", ["ros1", "cdr"])
@slow
@given(data=st.data())
def test_static_gaps_are_those_of_every_packet(wire, data):
    definition = data.draw(definitions(wide=True))
    message = definition.message
    layout = lay_out(message, wire)
    plan = build_plan(layout)
    gaps = gaps_of(layout)
    value = data.draw(values(message))
    packet, _ = encode(plan, to_transfers(plan, message, value))
    assert len(packet) >= layout.least_bytes
    reference = Reference(plan, message, packet)
    assert reference.status == "OK"
    for path, found in reference.gaps:
        assert gaps[path].bytes in (None, found)
        assert found < gaps[path].align


@pytest.mark.parametrize(
    ("fields", "path", "gap"),
    [
        ({"a": "uint8", "b": "uint16"}, "b", 1),
        ({"a": "uint8", "b": "uint64"}, "b", 7),
        ({"a": "string", "b": "uint8"}, "b", 0),
        ({"a": "string", "b": "uint16"}, "b", None),
        ({"a": "wstring", "b": "uint32"}, "b", 0),
        ({"a": "wstring", "b": "uint64"}, "b", None),
        ({"a": "uint64[]", "b": "uint64"}, "b", None),
        ({"a": "uint32[]", "b": "uint32"}, "b", 0),
        ({"a": "uint16[3]", "b": "uint64"}, "b", 2),
        ({"a": "uint64[]", "b": "uint32", "c": "uint64"}, "c", None),
        ({"a": "string", "b": "uint64", "c": "uint16", "d": "uint64"}, "d", 6),
    ],
)
def test_gap_is_static_exactly_when_types_decide_it(fields, path, gap):
    layout = lay_out(make("ros2", fields))
    assert gaps_of(layout)[(path,)].bytes == gap


def test_a_loop_body_is_laid_out_for_all_of_its_elements():
    element = make("ros2", {"x": "uint8", "y": "uint16"}, "E")
    layout = lay_out(make("ros2", {"a": (element, "[]")}))
    # The first element is at 4, where y has a gap of 1; all others start at even offsets, too.
    assert gaps_of(layout)[("a", "item", "y")].bytes == 1
    odd = make("ros2", {"y": "uint16", "x": "uint8"}, "E")
    layout = lay_out(make("ros2", {"a": (odd, "[]")}))
    assert gaps_of(layout)[("a", "item", "y")] == Gap(align=2, bytes=None)


def test_ros1_has_no_gaps_at_all():
    fields = {"a": "uint8", "b": "float64", "s": "string", "q": "uint16[]", "c": "int64[2]"}
    gaps = gaps_of(lay_out(make("ros1", fields)))
    assert set(gaps.values()) == {Gap(align=1, bytes=0)}


def test_an_empty_message_is_nothing_on_ros1_and_an_octet_on_cdr():
    assert lay_out(make("ros1", {})).nodes == (Trigger(path=()),)
    (node,) = lay_out(make("ros2", {})).nodes
    assert node.path == ("structure_needs_at_least_one_member",)
    assert node.type == P["uint8"]


@pytest.mark.parametrize(
    ("wire", "fields", "size"),
    [
        ("ros1", {}, 0),
        ("cdr", {}, 5),
        ("cdr", {"a": "string", "b": "uint8[]", "c": "float64[3]"}, 4 + 4 + 4 + 24),
        ("ros1", {"a": "string", "b": "uint8[]", "c": "float64[3]"}, 4 + 4 + 24),
    ],
)
def test_least_bytes_is_the_size_of_the_emptiest_packet_without_padding(wire, fields, size):
    assert lay_out(make("ros2", fields), wire).least_bytes == size


WORD = Gap(align=4, bytes=0)


@pytest.mark.parametrize(
    ("kind", "length", "item_gap", "item", "terminated"),
    [
        (String(), LengthField(gap=WORD, bound=None), 0, "uint8", True),
        (String(bound=5), LengthField(gap=WORD, bound=5), 0, "uint8", True),
        # A unit of a wide string has four bytes; its number has no NUL.
        (String(bound=6, wide=True), LengthField(gap=WORD, bound=6), 0, "uint32", False),
        (
            Sequence(element=P["float64"], bound=7),
            LengthField(gap=WORD, bound=7),
            4,
            "float64",
            False,
        ),
        (Array(element=P["int16"], count=8), ConstantLength(count=8), 0, "int16", False),
        # The numbers of a `wchar` are those of an integer.
        (
            Sequence(element=IDL_PRIMITIVES["wchar"]),
            LengthField(gap=WORD, bound=None),
            0,
            "uint16",
            False,
        ),
        (Array(element=WCHAR4, count=2), ConstantLength(count=2), 0, "uint32", False),
    ],
)
def test_runs_have_the_length_and_items_of_their_type(kind, length, item_gap, item, terminated):
    message = Message(name="p/msg/T", dialect="ros2", fields=(Field(name="f", type=kind),))
    (node,) = lay_out(message).nodes
    assert (node.path, node.length, node.terminated) == (("f",), length, terminated)
    assert (node.item, node.item_gap.bytes) == (P[item], item_gap)


def test_loops_have_the_sizes_of_their_elements():
    element = make("ros2", {"x": "uint32", "y": "uint8"}, "E")
    message = make("ros2", {"a": (element, "[<=9]"), "b": (element, "[3]")})
    one, two = lay_out(message).nodes
    assert (one.length, two.length) == (LengthField(gap=WORD, bound=9), ConstantLength(count=3))
    for node in (one, two):
        # 5 bytes, and 3 of padding between two of them.
        assert (node.min_body_bytes, node.repeated_bytes) == (5, 8)
        assert [(each.path[-2:], each.type) for each in node.body] == [
            (("item", "x"), P["uint32"]), (("item", "y"), P["uint8"])
        ]  # fmt: skip


def test_an_unknown_wire_is_refused():
    wires = ", ".join(map(repr, RULES))
    with pytest.raises(ValueError, match=rf"^Wire must be one of {wires}, not 'can'$"):
        lay_out(make("ros2", {}), "can")
