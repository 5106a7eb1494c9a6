"""Estimates from the nearest converter that was measured."""

from __future__ import annotations

import json
from importlib import resources
from typing import Any

import pytest

from firm_hdl.estimates import estimate_text, estimates_of, features_of, nearest
from firm_hdl.frontend import Library
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out


def plan_of(name: str, **options: Any) -> Any:
    return build_plan(lay_out(Library("lyrical").message(name)), **{"bus_bytes": 8, **options})


def entry(type_: str, **changes: Any) -> dict[str, Any]:
    """Return an entry with a type's own features, or with others."""
    return {
        "type": type_,
        "wire": "cdr",
        "bus_bytes": 8,
        "direction": "deserializer",
        "part": "P",
        "lut": 1273,
        "ff": 1585,
        "mhz": 83.6,
        **features_of(plan_of(type_)),
        **changes,
    }


POSE, TWIST = "geometry_msgs/msg/Pose", "geometry_msgs/msg/Twist"
IMU, STRING = "sensor_msgs/msg/Imu", "std_msgs/msg/String"


def test_features_are_of_the_plan() -> None:
    assert features_of(plan_of(TWIST)) == {"bits": 384, "steps": 6, "lengths": 0}
    found = features_of(plan_of(STRING))
    assert (found["bits"], found["lengths"]) == (32 + 64, 1)
    # Two strings.
    found = features_of(plan_of("diagnostic_msgs/msg/KeyValue"))
    assert (found["bits"], found["lengths"]) == (2 * (32 + 64), 2)


def test_measured_type_is_its_own_estimate() -> None:
    measured = [entry(IMU), entry(TWIST, lut=7), entry(POSE)]
    found = estimates_of(plan_of(TWIST), measured)
    assert list(found) == ["deserializer"]
    assert (found["deserializer"].lut, found["deserializer"].is_same) == (7, True)


def test_other_features_are_no_longer_the_same_type() -> None:
    found = estimates_of(plan_of(TWIST), [entry(TWIST, steps=9)])
    assert found["deserializer"].type == TWIST and not found["deserializer"].is_same
    found = estimates_of(plan_of(TWIST), [entry(TWIST, wire="ros1")])
    assert not found["deserializer"].is_same


def test_the_nearest_is_taken() -> None:
    measured = [entry(IMU), entry(TWIST), entry(STRING)]
    assert estimates_of(plan_of(POSE), measured)["deserializer"].type == TWIST
    assert estimates_of(plan_of("std_msgs/msg/Header"), measured)["deserializer"].type == STRING
    assert estimates_of(plan_of("nav_msgs/msg/Odometry"), measured)["deserializer"].type == IMU
    # Of two equally near entries, the first by name is taken, in any order of the file.
    both = [entry(TWIST, type="b/msg/B"), entry(TWIST, type="a/msg/A")]
    assert estimates_of(plan_of(POSE), both)["deserializer"].type == "a/msg/A"
    # An entry of another wire is further away than one of the same wire.
    both = [entry(TWIST, type="a/msg/A", wire="ros1"), entry(TWIST, type="b/msg/B")]
    assert estimates_of(plan_of(POSE), both)["deserializer"].type == "b/msg/B"


def far(**factors: float) -> dict[str, Any]:
    """Return features of `POSE` that are further away by these factors."""
    own = features_of(plan_of(POSE))
    return {name: (1 + own[name]) * factor - 1 for name, factor in factors.items()}


@pytest.mark.parametrize(
    ("near", "distant"),
    [
        # Distances are 1 and 2, and those of different features add up.
        (far(bits=2), far(bits=4)),
        (far(bits=2), far(steps=4)),
        (far(steps=2), far(lengths=4)),
        (far(lengths=2), far(bits=4)),
        # More of one does not make up for less of another.
        (far(bits=2), far(bits=4, steps=1 / 4)),
        (far(bits=4), far(bits=2, steps=2, lengths=2)),
        (far(steps=4), far(bits=2, steps=2, lengths=2)),
        # Fewer bits are as far away as more of them.
        (far(steps=2), {"bits": far(bits=1)["bits"] // 4}),
        # Another wire counts as much as a factor of 2.
        (far(lengths=2), {**far(steps=2), "wire": "ros1"}),
        ({"wire": "ros1"}, far(steps=4)),
        ({**far(steps=2), "wire": "ros1"}, far(bits=8)),
    ],
)
def test_distances_by_hand(near: dict[str, Any], distant: dict[str, Any]) -> None:
    # The second name would be taken of two that are equally near.
    measured = [entry(POSE, type="b/msg/Near", **near), entry(POSE, type="a/msg/Far", **distant)]
    assert estimates_of(plan_of(POSE), measured)["deserializer"].type == "b/msg/Near"


def test_another_type_with_the_same_features_is_not_the_same() -> None:
    found = estimates_of(plan_of(POSE), [entry(POSE, type="a/msg/Twin")])["deserializer"]
    assert (found.type, found.is_same) == ("a/msg/Twin", False)


def test_other_buses_and_directions_say_nothing() -> None:
    assert estimates_of(plan_of(TWIST, bus_bytes=4), [entry(TWIST)]) == {}
    assert list(estimates_of(plan_of(TWIST), [entry(TWIST, direction="serializer")])) == [
        "serializer"
    ]


def test_text_names_the_source_of_the_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    measured = [entry(IMU, mhz=99.6), entry(TWIST, direction="serializer", part="Q")]
    monkeypatch.setattr(nearest, "_measured", lambda: measured)
    assert estimate_text(plan_of(TWIST)).splitlines() == [
        "    deserializer on P: 1,273 look-up tables, 1,585 flip-flops, 100 MHz (that of "
        f"{IMU}, the nearest measured type)",
        "    serializer on Q: 1,273 look-up tables, 1,585 flip-flops, 84 MHz (measured)",
    ]
    measured.clear()
    assert estimate_text(plan_of(TWIST)) == ""


def test_the_file_of_the_package_has_all_that_is_read() -> None:
    file = resources.files("firm_hdl.estimates").joinpath(nearest.DATA)
    entries = json.loads(file.read_text(encoding="utf-8"))
    assert len({(e["type"], e["bus_bytes"], e["direction"]) for e in entries}) == len(entries)
    assert {e["direction"] for e in entries} == {"deserializer", "serializer"}
    for each in entries:
        assert set(each) == set(entry(TWIST))
        assert each["lut"] > 0 and each["ff"] > 0 and 10 < each["mhz"] < 1000
    assert estimates_of(plan_of(TWIST))["deserializer"].type == TWIST
