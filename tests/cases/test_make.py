"""Cases have every relevant length, and depend on the seed only."""

from __future__ import annotations

from collections import defaultdict

import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from firm_hdl.cases.make import make_cases, run_lengths
from firm_hdl.cases.oracle import RosbagsOracle, distro_oracle

DEEP = """
string[] names
string<=5 short
float64[<=3] few
test_msgs/Point[] points
test_msgs/Point[<=5] bounded
"""
POINT = "float32[] values\nstring label\n"


@pytest.fixture(scope="module")
def deep():
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(POINT, "test_msgs/msg/Point"))
    store.register(get_types_from_msg(DEEP, "test_msgs/msg/Deep"))
    return RosbagsOracle(store, "ros2")


@pytest.mark.parametrize("bus_bytes", [1, 2, 4, 8, 16, 32, 64])
@pytest.mark.parametrize("item_bytes", [1, 2, 4, 8])
def test_run_lengths_have_every_residue(bus_bytes, item_bytes):
    lanes = max(1, bus_bytes // item_bytes)
    lengths = run_lengths(item_bytes, bus_bytes, None)
    assert {0, 1, 2} <= set(lengths)
    assert {length % lanes for length in lengths} == set(range(lanes))
    assert max(lengths) > 2 * lanes
    assert len(set(lengths)) == len(lengths)


def test_run_lengths_reach_the_bound_and_stay_below():
    assert run_lengths(1, 8, 5) == [0, 1, 2, 3, 4, 5]
    assert run_lengths(1, 4, 100)[-1] == 100
    assert max(run_lengths(8, 8, 1 << 20)) == 3


@pytest.mark.parametrize("bus_bytes", [1, 4, 8, 16])
def test_every_place_takes_every_length(deep, bus_bytes):
    taken = defaultdict(set)
    cases = list(make_cases(deep, "test_msgs/msg/Deep", wire="cdr", bus_bytes=bus_bytes))
    for case in cases:
        for path, payloads in case.transfers.items():
            if path[-1] == "length":
                taken[path[:-1]].update(payloads)
    text = set(run_lengths(1, bus_bytes, None))
    assert taken["names", "item"] >= text
    assert taken["points", "item", "label"] >= text
    assert taken["points", "item", "values"] >= set(run_lengths(4, bus_bytes, None))
    assert taken["short",] == set(run_lengths(1, bus_bytes, 5))
    assert taken["few",] == {0, 1, 2, 3}
    assert taken["points",] >= {0, 1, 2, 3}
    assert taken["bounded",] == {0, 1, 2, 3, 5}


def test_the_modes_come_first_and_mixed_values_stay():
    cases = list(make_cases(distro_oracle("humble"), "std_msgs/msg/Header", wire="cdr", seed=4))
    modes = ["zero", "high", "low", "special"]
    modes += ["mixed"] * (len(cases) - 4)
    assert len(cases) > 8
    for number, (case, mode) in enumerate(zip(cases, modes, strict=True)):
        assert case.what == f"case {number} of std_msgs/msg/Header, seed 4: {mode} values"
    assert [case.transfers["stamp", "sec"] for case in cases[:3]] == [[0], [2**31 - 1], [-(2**31)]]


@pytest.mark.parametrize("distro", ["lyrical", pytest.param("noetic", marks=pytest.mark.thorough)])
def test_every_length_of_every_type_has_every_residue(distro):
    oracle = distro_oracle(distro)
    wire = "ros1" if distro == "noetic" else "cdr"
    missing = []
    for name in oracle.names():
        taken, lanes = defaultdict(set), {}
        for case in make_cases(oracle, name, wire=wire):
            for path, payloads in case.transfers.items():
                if path[-1] == "length":
                    taken[path[:-1]].update(payloads)
                elif path[-1] == "items":
                    lanes[path[:-1]] = len(payloads[0][0])
        for path, lengths in taken.items():
            # Bounds of 1 are the only small ones among the embedded types.
            if lengths == {0, 1} and "range" in path[-1]:
                continue
            count = lanes.get(path, 1)
            if {n % count for n in lengths} != set(range(count)) or not {0, 1, 2} <= lengths:
                missing.append((name, path, lengths))
    assert not missing


def test_cases_follow_from_the_seed():
    oracle = distro_oracle("humble")

    def packets(seed):
        return [c.packet for c in make_cases(oracle, "std_msgs/msg/Header", wire="cdr", seed=seed)]

    assert packets(1) == packets(1) != packets(2)
    # Types with the same fields have different values.
    point, vector = (
        [c.packet for c in make_cases(oracle, f"geometry_msgs/msg/{name}", wire="cdr")]
        for name in ("Point", "Vector3")
    )
    assert len(point) == len(vector) and point[3:] != vector[3:]


def test_extremes_are_among_the_cases():
    oracle = distro_oracle("humble")
    for name, bits in (("Float32", 32), ("Float64", 64), ("Int8", 8), ("UInt64", 64), ("Byte", 8)):
        cases = list(make_cases(oracle, f"std_msgs/msg/{name}", wire="cdr"))
        seen = {payload for case in cases for payload in case.transfers["data",]}
        if name.startswith("Int"):
            assert {-(1 << bits - 1), (1 << bits - 1) - 1, 0} <= seen
        elif name == "Byte":
            assert {0, 127, 128} <= seen
        else:
            assert 0 in seen and max(seen) >= (1 << bits) - (1 << bits - 8)


def test_transfers_are_what_rosbags_reads_in_its_own_packet(monkeypatch):
    """Not what was given to its writer, which may write something else."""
    read, asked = RosbagsOracle.read, []

    def another(self, packet, name, wire):
        asked.append(packet)
        return read(self, packet[:-1] + b"\x2a", name, wire)

    monkeypatch.setattr(RosbagsOracle, "read", another)
    cases = list(make_cases(distro_oracle("humble"), "std_msgs/msg/UInt8", wire="cdr"))
    assert asked == [case.packet for case in cases]
    assert [case.transfers for case in cases] == [{("data",): [42]}] * len(cases)
