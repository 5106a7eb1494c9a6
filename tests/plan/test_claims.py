"""What lengths claim: no packet within `max_message_bytes` is refused, and padding is claimed."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import pytest

from firm_hdl import load_message
from firm_hdl.plan import build_plan, check, decode
from firm_hdl.wire import LengthField, LoopNode, lay_out
from tests.plan.lengths import header_of, next_length, with_charges
from tests.strategies import make


def packet_of(plan, lengths):
    """Return a packet of zeros with these lengths in wire order; further lengths are 0."""
    packet = header_of(plan)
    for number in lengths:
        at, _ = next_length(plan, packet)
        packet = packet.ljust(at, b"\0") + number.to_bytes(4, "little")
    return packet.ljust(decode(plan, packet).steps[-1].end, b"\0")


@pytest.mark.parametrize(
    ("name", "distro"),
    [
        ("diagnostic_msgs/msg/DiagnosticArray", "lyrical"),
        ("diagnostic_msgs/DiagnosticArray", "noetic"),
        ("sensor_msgs/msg/PointCloud2", "lyrical"),
        ("geometry_msgs/msg/Polygon", "lyrical"),
        ("tf2_msgs/msg/TFMessage", "lyrical"),
        ("nav_msgs/msg/Path", "lyrical"),
        ("sensor_msgs/msg/BatteryState", "lyrical"),
        ("trajectory_msgs/msg/JointTrajectory", "lyrical"),
        ("visualization_msgs/msg/MarkerArray", "lyrical"),
        ("rcl_interfaces/msg/ParameterEvent", "lyrical"),
    ],
)
def test_elements_claim_the_bytes_that_the_interpreter_steps_over(name, distro):
    layout = lay_out(load_message(name, distro=distro))
    plan = build_plan(layout)
    counted = [node for node in layout.nodes if hasattr(node, "length")]
    counted = [node for node in counted if isinstance(node.length, LengthField)]
    for place, node in enumerate(counted):
        if isinstance(node, LoopNode):
            sizes = [len(packet_of(plan, [0] * place + [n])) for n in (2, 3, 4, 5)]
            assert [b - a for a, b in pairwise(sizes)] == [node.repeated_bytes] * 3


# In both, the items of a string may take the place of padding: 7 bytes of each element.
FIELDS = {"b": "uint32", "s": "string", "a": "uint8", "x": "float64"}
ELEMENT = make("ros2", FIELDS, "Element")
ROW = make("ros2", {"e": (ELEMENT, "[]"), "y": "uint8"}, "Row")


def messages():
    yield (
        make("ros2", {"e": (ELEMENT, "[]"), "z": "float64"}),
        lambda letters: [12] + [letters] * 12,
    )
    yield (
        make("ros2", {"r": (ROW, "[]")}),
        lambda letters: [3] + 3 * [8, *[letters] * 8],
    )


def refused(change=None):
    """Return how many of the largest legal packets are refused."""
    count = 0
    for message, lengths in messages():
        layout = lay_out(message)
        largest = build_plan(layout)
        for letters in range(300, 308):
            packet = packet_of(largest, lengths(letters))
            plan = build_plan(layout, max_message_bytes=len(packet))
            assert any(
                length.charge and length.charge.charged_from <= letters
                for length in plan.lengths.values()
            )
            for each in (plan, change and change(plan)):
                status = decode(each, packet).status if each else "OK"
                assert status in ("OK", "STRING", "LENGTH")
                count += status == "LENGTH"
    return count


def test_no_packet_within_the_largest_size_is_refused():
    assert refused() == 0
    # A twin: padding that items save is claimed.
    assert refused(lambda plan: with_charges(plan, lambda c: replace(c, padding_credit=0)))


def test_padding_is_only_saved_where_it_is_claimed():
    for fields, saved in (({"s": "string"}, 0), ({"s": "string", "x": "uint8"}, 14)):
        message = make("ros2", {"e": (make("ros2", fields, "Element"), "[]")})
        plan = build_plan(lay_out(message))
        assert {length.charge.padding_credit for length in plan.lengths.values()} == {saved}


PAIR = make("ros1", {"x": "uint16", "y": "uint16"}, "Pair")


def rows(*counts, size=1):
    """Return a sequence of rows in ROS 1: each is a sequence of items of `size` bytes."""
    parts = [count.to_bytes(4, "little") + bytes(count * size) for count in counts]
    return len(counts).to_bytes(4, "little") + b"".join(parts)


@pytest.mark.parametrize(("more", "status"), [(0, "TRUNCATED"), (1, "LENGTH")])
def test_a_budget_is_spent_to_its_last_byte_and_renewed_by_each_sequence(more, status):
    row = make("ros1", {"a": "uint8[]"}, "Row")
    layout = lay_out(make("ros1", {"one": (row, "[]"), "other": (row, "[]")}))
    plan = build_plan(layout, max_message_bytes=8 + 8192)
    # 1,024 rows claim 4 bytes each, and the first row as many bytes as are left.
    packet = (1024).to_bytes(4, "little") + (4096 + more).to_bytes(4, "little")
    assert decode(plan, packet).status == status
    # What the first sequence has claimed is left to the second one.
    second = (1024).to_bytes(4, "little") + (4096 + more).to_bytes(4, "little")
    assert decode(plan, rows(5000) + second).status == status
    # Lengths below a 16th of the packet are not counted, however many there are.
    assert decode(plan, rows(*[511] * 20) + rows()).status == "OK"
    assert decode(plan, rows(*[512] * 16) + rows()).status == "OK"
    assert decode(plan, rows(*[512] * 17) + rows()).status == "LENGTH"


ROOM = (1 << 24) - 4
PADDED = make("ros2", {"x": "uint32", "y": "uint8"}, "Padded")
NAMED = make("ros2", {"s": "string", "y": "uint8"}, "Named")
LIST = make("ros2", {"a": "uint8[]"}, "List")


@pytest.mark.parametrize(
    ("wire", "fields", "claims"),
    [
        # A sequence in an array is as much an outermost one as another.
        (
            "ros1",
            {"g": (make("ros2", {"l": (LIST, "[]")}, "G"), "[2]"), "l": (LIST, "[]")},
            {
                "g.item.l": (4, 1024, 0, ROOM - 8),
                "g.item.l.item.a": (1, 4096, 0, None),
                "l": (4, 1024, 0, ROOM - 8),
                "l.item.a": (1, 4096, 0, None),
            },
        ),
        # What is not in a sequence of messages, or has no length inside, shares no budget.
        ("ros1", {"a": "uint8[]", "p": (PAIR, "[]"), "s": "string"}, {}),
        # A sequence beside another one, in the same message, is not in it.
        (
            "ros1",
            {"h": make("ros2", {"l": (LIST, "[]"), "b": "uint8[]"}, "H")},
            {"h.l": (4, 1024, 0, ROOM - 4), "h.l.item.a": (1, 4096, 0, None)},
        ),
        # A bound that is too small, and one that is just large enough: 4,096 bytes.
        ("ros1", {"l": (make("ros2", {"a": "float64[<=511]"}, "L"), "[]")}, {}),
        (
            "ros1",
            {"l": (make("ros2", {"a": "float64[<=512]"}, "L"), "[]")},
            {"l": (4, 1024, 0, ROOM), "l.item.a": (8, 512, 0, None)},
        ),
        # Padding is claimed by the inner sequence alone; all lengths of the message save it.
        (
            "cdr",
            {"r": (make("ros2", {"e": (NAMED, "[]")}, "R"), "[]")},
            {
                "r": (4, 1024, 14, ROOM - 4),
                "r.item.e": (8, 512, 14, None),
                "r.item.e.item.s": (1, 4096, 14, None),
            },
        ),
        # The elements of an array have padding, but no length claims any.
        (
            "cdr",
            {"c": (PADDED, "[2]"), "l": (LIST, "[]")},
            {"l": (4, 1024, 0, ROOM - 4 - 10), "l.item.a": (1, 4096, 0, None)},
        ),
    ],
)
def test_claims_by_hand(wire, fields, claims):
    layout = lay_out(make("ros2", fields), wire)
    plan = build_plan(layout)
    # The check comes to the same, also where only some of the sequences have padding.
    assert check(plan, layout) == []
    found = {
        ".".join(plan.leaves[leaf].path[:-1]): length.charge
        for leaf, length in plan.lengths.items()
    }
    assert {
        path: (charge.bytes, charge.charged_from, charge.padding_credit, charge.budget)
        for path, charge in found.items()
        if charge is not None
    } == claims


@pytest.mark.parametrize(
    ("size", "least"),
    [(1 << 10, 256), (4111, 256), (4112, 257), (65_535, 4095), (65_536, 4096), (1 << 30, 4096)],
)
def test_a_length_is_counted_from_a_16th_of_the_largest_packet(size, least):
    plan = build_plan(lay_out(make("ros1", {"l": (LIST, "[]")})), max_message_bytes=size)
    assert [length.charge.charged_from for length in plan.lengths.values()] == [
        -(-least // 4),
        least,
    ]
