"""Each kind of damage by itself: which bytes it changes, adds and takes away."""

from __future__ import annotations

import random

import pytest

from firm_hdl.cases import damage
from firm_hdl.cases.damage import broken_packets, stalls_for
from firm_hdl.cases.make import Case
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.strategies import make

SEEDS = 300
BUS_BYTES = 4


def plan_of(dialect, **fields):
    return build_plan(lay_out(make(dialect, fields)), bus_bytes=BUS_BYTES)


CDR, ROS1 = (plan_of(dialect, a="uint32[5]") for dialect in ("ros2", "ros1"))
PACKETS = {
    "cdr": (CDR, bytes([0, 1, 0, 0, *range(40, 60)])),
    "ros1": (ROS1, bytes(range(40, 60))),
}
BOTH = pytest.mark.parametrize("wire", PACKETS)


def damaged(name, plan, packet):
    """All results of one kind of damage."""
    work = getattr(damage, f"_{name}")
    return {work(plan, packet, random.Random(seed)) for seed in range(SEEDS)}


@BOTH
def test_a_cut_packet_is_any_beginning_of_the_whole_one(wire):
    plan, packet = PACKETS[wire]
    assert damaged("cut", plan, packet) == {packet[:size] for size in range(len(packet))}
    # Nothing can be cut from an empty packet, so something is added.
    assert all(damaged("cut", plan, b""))


@BOTH
def test_a_shorter_packet_lacks_its_last_bytes(wire):
    plan, packet = PACKETS[wire]
    assert damaged("shorter", plan, packet) == {packet[:-less] for less in (1, 2, BUS_BYTES)}


@pytest.mark.parametrize(("wire", "allowed"), [("cdr", 3), ("ros1", 0)])
def test_bytes_are_added_beyond_those_that_are_allowed(wire, allowed):
    plan, packet = PACKETS[wire]
    longer = damaged("longer", plan, packet)
    trailing = damaged("trailing", plan, packet)
    assert {each[: len(packet)] for each in longer | trailing} == {packet}
    more = [{len(each) - len(packet) - allowed for each in some} for some in (longer, trailing)]
    assert more == [{*range(1, 4 * BUS_BYTES + 1)}, {0, 1}]
    assert len(longer) > SEEDS // 2  # The added bytes are random.


def test_another_representation_is_announced_before_the_same_bytes():
    found = damaged("header", *PACKETS["cdr"])
    assert {each[4:] for each in found} == {PACKETS["cdr"][1][4:]}
    announced = {each[:2] for each in found}
    assert b"\0\1" not in announced
    # Each of the two bytes is wrong with the other one right.
    assert {b"\0\0", b"\1\1"} < announced and len(announced) == 7
    assert len({each[2:4] for each in found}) > 100
    # Without a header, the packet is damaged in another way.
    assert all(len(each) > 20 for each in damaged("header", *PACKETS["ros1"]))


def places(packet, found):
    """The indices of the bytes that differ, for each packet."""
    return [{n for n, byte in enumerate(packet) if each[n] != byte} for each in found]


@pytest.mark.parametrize(("wire", "first"), [("cdr", 4), ("ros1", 0)])
def test_changed_bytes_are_anywhere_after_the_header(wire, first):
    plan, packet = PACKETS[wire]
    changed = places(packet, damaged("change", plan, packet))
    assert set.union(*changed) == {*range(first, len(packet))}
    assert max(map(len, changed)) == 6 and min(map(len, changed)) <= 1
    filled = places(packet, damaged("fill", plan, packet))
    assert set.union(*filled) == {*range(first, len(packet))}
    assert max(max(each) - min(each) for each in filled if each) == 2 * BUS_BYTES + 1
    # Only a byte that is drawn as it was leaves a packet as it was.
    each = [damage._change(plan, packet, random.Random(seed)) for seed in range(SEEDS)]
    assert each.count(packet) < 5
    cut = damaged("change_and_cut", plan, packet)
    assert {len(each) for each in cut} == {*range(len(packet))}
    assert any(each != packet[: len(each)] for each in cut)


def test_filled_bytes_are_zeros_ones_or_random():
    found = damaged("fill", ROS1, bytes([0x55]) * 20)
    runs = [each.strip(b"\x55") for each in found]
    zeros, ones = ({run for run in runs if run and {*run} == {byte}} for byte in (0, 0xFF))
    assert len(zeros) > 3 and len(ones) > 3 and any(len({*run}) > 2 for run in runs)


def test_a_packet_that_is_only_a_header_is_not_changed_but_extended():
    header = b"\0\1\0\0"
    assert damaged("change", CDR, header) == {header}
    assert all(each[:4] == header and len(each) > 4 for each in damaged("fill", CDR, header))
    assert all(len(each) > 0 for each in damaged("fill", ROS1, b""))


@pytest.mark.parametrize(("items", "is_kept"), [(503, True), (504, False)])
def test_a_length_that_takes_too_many_steps_is_not_simulated(monkeypatch, items, is_kept):
    plan = plan_of("ros1", a="uint32[]")
    intact = bytes([1, 0, 0, 0, 7, 0, 0, 0])
    # One step for the length, and one for each of the items, which the deserializer fills up. 500
    # steps are allowed, and two for each beat of the intact packet.
    long = items.to_bytes(4, "little") + bytes(4)
    monkeypatch.setattr(damage, "DAMAGES", (lambda *_: long,))
    cases = [Case(what="", value=None, packet=intact, transfers={})] * 99
    found = {*broken_packets(plan, cases, random.Random(1))}
    if is_kept:
        assert found == {long}
    else:
        assert found == {intact[:size] for size in range(len(intact))}


def test_stalls_are_rare_and_long_or_frequent_and_short():
    drawn = [stalls_for(seed) for seed in range(60)]
    assert {(each.probability, each.min_cycles, each.max_cycles) for each in drawn} == {
        (0.05, 1, 30),
        (0.2, 1, 6),
        (0.5, 1, 2),
        (0.8, 1, 1),
        (0.3, 1, 12),
    }
    assert len({each.seed for each in drawn}) == 60
    assert stalls_for("p/A") == stalls_for("p/A") != stalls_for("p/B")
