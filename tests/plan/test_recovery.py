# amaranth: UnusedElaboratable=no
"""Bounds of the time of recovery, compared with packets that claim as much as they can."""

from __future__ import annotations

import random

import pytest

from firm_hdl import Deserializer, load_message
from firm_hdl.gateware.signatures import LATENCY_CYCLES
from firm_hdl.plan import Fixed, build_plan, decode
from firm_hdl.plan.recovery import Recovery, recovery
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.gateware.test_throughput import measure_deserializer
from tests.strategies import make

AFTER = 4
"""Cycles of an error and of the end, beside those of steps."""


def bomb(plan, wanted):
    """Return a short packet in which lengths, in wire order, have wanted values as they are legal.

    Each value is put where the interpreter finds the next length, and the packet ends behind it.
    """
    packet = b"".join(s.data for step in plan.steps for s in step.slices if isinstance(s, Fixed))
    for number in wanted:
        place = next(
            (
                (visit.end - 4, plan.steps[visit.step].begin)
                for visit in decode(plan, packet).steps
                if plan.steps[visit.step].begin is not None and visit.end > len(packet)
            ),
            None,
        )
        if place is None:
            break
        at, begin = place
        value = min(number, plan.max_count(begin))
        packet = packet.ljust(at, b"\0") + value.to_bytes(4, "little")
    return packet


def steps_after(plan, packet):
    """Return the number of steps of a packet after its own bytes."""
    return sum(visit.end > len(packet) for visit in decode(plan, packet).steps)


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
def test_no_packet_takes_longer_than_the_bound(distro, name, bus_bytes):
    most = by_depth(4096, 8192)
    layout = lay_out(load_message(name, distro=distro))
    plan = build_plan(layout, bus_bytes=bus_bytes, max_message_bytes=most)
    bound = recovery(plan, 1).cycles
    rng = random.Random(name)
    for _ in range(by_depth(8, 100)):
        values = [0, 0, 1, 1, 2, rng.randrange(most), rng.randrange(most // 8), most]
        packet = bomb(plan, rng.choices(values, k=rng.randrange(1, 12)))
        assert steps_after(plan, packet) + AFTER <= bound, packet.hex()


def check_diagnostics(distro, bound_of):
    """Compare a bound with a packet that claims the most in each level: statuses, values, a key."""
    name = "diagnostic_msgs/msg/DiagnosticArray"
    most = by_depth(1 << 14, 1 << 20)
    plan = build_plan(lay_out(load_message(name, distro=distro)), max_message_bytes=most)
    taken = steps_after(plan, bomb(plan, [0, most, 0, 0, 0, most, most])) + AFTER
    assert 0.99 * bound_of(plan) <= taken <= bound_of(plan)


@pytest.mark.parametrize("distro", ["lyrical", "noetic"])
def test_the_bound_for_diagnostics_is_close(distro):
    check_diagnostics(distro, lambda plan: recovery(plan, 1).cycles)
    # A twin: the longest legal packet is no bound, because three levels add up.
    with pytest.raises(AssertionError):
        check_diagnostics(distro, lambda plan: recovery(plan, 1).longest_packet)


def test_types_of_fixed_size_recover_at_once():
    plan = build_plan(lay_out(load_message("geometry_msgs/msg/Twist")))
    assert recovery(plan, 7) == Recovery(cycles=len(plan.steps) + AFTER, longest_packet=7)


def test_a_string_takes_a_cycle_for_each_word():
    plan = build_plan(lay_out(make("ros1", {"s": "string"})), max_message_bytes=804)
    # 800 characters in 100 words, besides the steps of the length and of the rest.
    assert recovery(plan, 2) == Recovery(cycles=2 + 100 + AFTER, longest_packet=102)


def test_the_longest_packet_has_the_padding_of_its_elements():
    element = make("ros2", {"a": "uint8", "s": "string"}, "Element")
    plan = build_plan(lay_out(make("ros2", {"e": (element, "[]")})), max_message_bytes=8008)
    # 8 bytes, and 8 for each element; a deserializer takes 2 steps for each.
    assert recovery(plan, 2).longest_packet == pytest.approx(2 + 2 * 1000, abs=2)


def test_elements_without_bytes_count_as_one_byte_each():
    empty = make("ros1", {}, "Empty")
    plan = build_plan(lay_out(make("ros1", {"e": (empty, "[]")})), max_message_bytes=1004)
    assert recovery(plan, 1).cycles == pytest.approx(1000, abs=9)
    assert steps_after(plan, bomb(plan, [1000])) + AFTER <= recovery(plan, 1).cycles


def test_arrays_of_constant_count_are_part_of_an_element():
    inner = make("ros1", {"t": "string"}, "Inner")
    outer = make("ros1", {"i": (inner, "[5]"), "x": "float64[40]"}, "Outer")
    message = make("ros1", {"o": (outer, "[]"), "z": (inner, "[3]")})
    plan = build_plan(lay_out(message), max_message_bytes=10_000)
    for wanted in ([28], [10, 0, 5000], [1, 0, 0, 9000], [27, 1, 2, 3]):
        packet = bomb(plan, wanted)
        assert steps_after(plan, packet) + AFTER <= recovery(plan, 1).cycles


def test_a_deserializer_recovers_within_the_bound():
    inner = make("ros1", {"s": "string", "x": "uint8"}, "Inner")
    outer = make("ros1", {"x": "uint32", "i": (inner, "[]")}, "Outer")
    rx = Deserializer(make("ros1", {"o": (outer, "[]")}), bus_bytes=8, max_message_bytes=1024)
    packet = bomb(rx.plan, [1024, 1024, 1024])
    beats = -(-len(packet) // 8)
    status, after = measure_deserializer(rx, [packet, b"\0\0\0\0"])
    bound = recovery(rx.plan, 1).cycles
    # Both statuses come a latency after the last step; the next packet has a beat, and a step for
    # its length and one for its end.
    latency = LATENCY_CYCLES["deserializer"]
    assert 0.99 * bound <= status - latency <= bound + beats
    assert after - status <= 2
