"""Bounds of the time of recovery, compared with packets that claim as much as they can."""

from __future__ import annotations

import random

import pytest

from firm_hdl import load_message
from firm_hdl.plan import build_plan, decode
from firm_hdl.timing.recovery import Recovery, recovery
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.plan.lengths import header_of, next_length, with_charges
from tests.strategies import make

AFTER = 4
"""Cycles of an error and of the end, beside those of steps."""


def bomb(plan, wanted):
    """Return a short packet in which lengths, in wire order, have wanted values as they are legal.

    Each value is put where the interpreter finds the next length, and the packet ends behind it.
    """
    packet = header_of(plan)
    for number in wanted:
        if (place := next_length(plan, packet)) is None:
            break
        at, length = place
        value = min(number, length.most)
        packet = packet.ljust(at, b"\0") + value.to_bytes(4, "little")
    return packet


def steps_after(plan, packet):
    """Return the steps of a packet after its own bytes, held ones included."""
    return sum(1 + visit.held for visit in decode(plan, packet).steps if visit.end > len(packet))


@pytest.mark.parametrize(
    ("distro", "name"),
    [
        ("lyrical", "diagnostic_msgs/msg/DiagnosticArray"),
        ("noetic", "diagnostic_msgs/DiagnosticArray"),
        ("lyrical", "trajectory_msgs/msg/JointTrajectory"),
        ("lyrical", "visualization_msgs/msg/InteractiveMarkerUpdate"),
        ("lyrical", "rcl_interfaces/msg/ParameterEvent"),
        ("lyrical", "sensor_msgs/msg/JointState"),
        ("lyrical", "std_msgs/msg/Float64MultiArray"),
    ],
)
@pytest.mark.parametrize("bus_bytes", by_depth([8], [1, 8, 64]))
@pytest.mark.sampled(3)
def test_no_packet_takes_longer_than_the_bound(distro, name, bus_bytes):
    most = 8192
    layout = lay_out(load_message(name, distro=distro))
    plan = build_plan(layout, bus_bytes=bus_bytes, max_message_bytes=most)
    bound = recovery(plan, 1).cycles
    rng = random.Random(name)
    for _ in range(by_depth(5, 100)):
        values = [0, 0, 1, 1, 2, rng.randrange(most), rng.randrange(most // 8), most]
        packet = bomb(plan, rng.choices(values, k=rng.randrange(1, 12)))
        assert steps_after(plan, packet) + AFTER <= bound, packet.hex()


def diagnostics(distro, most):
    name = "diagnostic_msgs/msg/DiagnosticArray"
    return build_plan(lay_out(load_message(name, distro=distro)), max_message_bytes=most)


@pytest.mark.parametrize("distro", ["lyrical", "noetic"])
@pytest.mark.parametrize("most", [by_depth(1 << 17, 1 << 24)])
@pytest.mark.sampled(2)
def test_the_bound_for_diagnostics_is_close(distro, most):
    plan = diagnostics(distro, most)
    bound = recovery(plan, 1).cycles
    # `frame_id`, then as many statuses as the budget has.
    taken = max(steps_after(plan, bomb(plan, [1, most])), steps_after(plan, bomb(plan, [0, most])))
    assert 0.9 * bound <= taken + AFTER <= bound


@pytest.mark.parametrize(
    "name", ["diagnostic_msgs/msg/DiagnosticArray", "visualization_msgs/msg/InteractiveMarkerInit"]
)
def test_a_bad_packet_costs_hardly_more_than_the_longest_legal_packet(name):
    plan = build_plan(lay_out(load_message(name)))
    found = recovery(plan, 1)
    assert found.longest_packet > 2_500_000
    assert found.cycles - found.longest_packet < 2000


def test_without_a_budget_a_packet_takes_longer_than_the_bound():
    # A twin: the largest claims of both levels, in a plan that does not check them together.
    plan = diagnostics("lyrical", 1 << 14)
    free = with_charges(plan, lambda charge: None)
    packet = bomb(free, [0, 1 << 14, 0, 0, 0, 1 << 14])
    bound = recovery(plan, 1).cycles
    assert steps_after(free, packet) > 1.4 * bound
    assert steps_after(free, packet) + AFTER <= recovery(free, 1).cycles
    assert decode(plan, packet).status == "LENGTH"
    assert steps_after(plan, packet) + AFTER <= bound


def test_types_of_fixed_size_recover_at_once():
    plan = build_plan(lay_out(load_message("geometry_msgs/msg/Twist")))
    assert recovery(plan, 7) == Recovery(cycles=len(plan.steps) + AFTER, longest_packet=7)
    # A run, and a loop of a run and another step, from the first byte on.
    row = make("ros1", {"b": "uint8[40]", "c": "uint8"}, "Row")
    for fields, steps in (({"b": "uint8[40]"}, 5), ({"rows": (row, "[7]")}, 7 * (5 + 1))):
        plan = build_plan(lay_out(make("ros1", fields)))
        assert recovery(plan, 7) == Recovery(cycles=steps + AFTER, longest_packet=7)


@pytest.mark.parametrize(("characters", "words"), [(793, 100), (800, 100), (801, 101)])
def test_a_string_takes_a_cycle_for_each_word(characters, words):
    layout = lay_out(make("ros1", {"s": "string"}))
    plan = build_plan(layout, max_message_bytes=4 + characters)
    # Besides the steps of the length and of the rest.
    assert recovery(plan, 2) == Recovery(cycles=2 + words + AFTER, longest_packet=2 + words)


def test_the_worst_packet_claims_what_has_the_most_steps_per_byte():
    """Rows of a byte array: a row is a step in 4 bytes, and a word of bytes a step in 8."""
    row = make("ros1", {"a": "uint8[]"}, "Row")
    plan = build_plan(lay_out(make("ros1", {"rows": (row, "[]")})), max_message_bytes=10_000)
    # All that is left of 10,000 bytes for rows. Then 624 bytes, one less than are counted.
    claimed = 9996 // 4 + 624 // 8
    assert recovery(plan, 1).cycles == 2 + claimed + AFTER


def test_what_padding_may_save_is_claimed_beside_the_budget():
    named = make("ros2", {"s": "string", "y": "uint8"}, "Named")
    plan = build_plan(lay_out(make("ros2", {"e": (named, "[]")})), max_message_bytes=8 + 8000)
    # Each of two levels may have claimed 14 bytes more than the 8,000 of the budget. An element has
    # 8 bytes and 2 steps: 1,001 of them. Texts take the other 20 bytes, and 499 uncounted ones.
    rest = -(-(20 + 499) // 8)
    assert recovery(plan, 1).cycles == 1 + 2 * 1001 + rest + AFTER
