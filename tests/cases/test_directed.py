"""Cases that reach every decision of a plan."""

from __future__ import annotations

import pytest

from firm_hdl.cases.directed import bare_packets, more_cases
from firm_hdl.cases.make import make_cases
from firm_hdl.cases.oracle import distro_oracle
from firm_hdl.frontend import Library
from firm_hdl.plan import build_plan, decode
from firm_hdl.plan.edges import edges
from firm_hdl.wire import lay_out

ORACLE = distro_oracle("lyrical")
LIBRARY = Library("lyrical")


def plan(name, bus_bytes=8):
    layout = lay_out(LIBRARY.message(name))
    return build_plan(layout, bus_bytes=bus_bytes, max_message_bytes=1 << 16)


def cases_of(name, made, most=None):
    return list(make_cases(ORACLE, name, wire="cdr", bus_bytes=made.bus_bytes, most=most))


def not_taken(made, packets):
    """Return the decisions of the plan that no packet takes."""
    return edges(made).difference(*(decode(made, packet).edges for packet in packets))


@pytest.mark.parametrize("bus_bytes", [1, 8])
@pytest.mark.parametrize(
    "name",
    [
        "sensor_msgs/msg/JointState",
        "nav_msgs/msg/Trajectory",
        "rcl_interfaces/msg/ParameterEvent",
        "visualization_msgs/msg/InteractiveMarkerUpdate",
    ],
)
@pytest.mark.sampled(2)
def test_every_decision_is_taken(name, bus_bytes):
    made = plan(name, bus_bytes)
    cases = cases_of(name, made)
    cases += more_cases(ORACLE, name, made, cases)
    bare = bare_packets(made, cases)
    packets = [case.packet for case in cases] + [packet for _, packet in bare]
    assert not_taken(made, packets) == set()


def test_missing_decisions_are_named():
    name = "sensor_msgs/msg/JointState"
    made = plan(name)
    cases = cases_of(name, made, most=1)
    some = not_taken(made, [case.packet for case in cases])
    assert some
    more = more_cases(ORACLE, name, made, cases)
    assert more
    better = not_taken(made, [case.packet for case in cases + more])
    # Only the decisions that strings without a NUL take.
    assert len(better) < len(some)
    assert {edge.way for edge in better} <= {"no rest"}


def test_more_cases_are_the_same_for_the_same_seed():
    name = "nav_msgs/msg/Trajectory"
    made = plan(name)
    cases = cases_of(name, made, most=1)
    again = [more_cases(ORACLE, name, made, cases, seed=3) for _ in range(2)]
    assert [c.packet for c in again[0]] == [c.packet for c in again[1]] != []
    other = more_cases(ORACLE, name, made, cases, seed=4)
    assert [c.packet for c in other] != [c.packet for c in again[0]]


def test_each_further_packet_takes_a_new_decision():
    name = "nav_msgs/msg/Trajectory"
    made = plan(name)
    cases = cases_of(name, made, most=1)
    whole = cases_of(name, made)
    bare = [packet for _, packet in bare_packets(made, whole)]
    assert 0 < len(bare) < len(whole)
    twice = [case for case in whole for _ in range(2)]
    assert [packet for _, packet in bare_packets(made, twice)] == bare
    for given, more in (
        (cases, [case.packet for case in more_cases(ORACLE, name, made, cases)]),
        (whole, bare),
    ):
        packets = [case.packet for case in given]
        for packet in more:
            before = not_taken(made, packets)
            packets.append(packet)
            assert not_taken(made, packets) < before


def test_bare_strings_mean_the_same():
    name = "diagnostic_msgs/msg/DiagnosticStatus"
    made = plan(name)
    bare = bare_packets(made, cases_of(name, made))
    assert bare
    for case, packet in bare:
        assert len(packet) < len(case.packet)
        decoded = decode(made, packet)
        assert decoded.status == "OK"
        assert decoded.streams == decode(made, case.packet).streams


@pytest.mark.parametrize("name", ["geometry_msgs/msg/Polygon", "sensor_msgs/msg/LaserEcho"])
def test_types_without_strings_have_no_bare_packets(name):
    # The second one has a sequence of numbers: a run, as a string is, but without a NUL.
    made = plan(name)
    assert bare_packets(made, cases_of(name, made)) == []
