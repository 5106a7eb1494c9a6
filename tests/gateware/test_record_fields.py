"""Which fields a record has, and how many bits it may have."""

from __future__ import annotations

import pytest

from firm_hdl import load_message
from firm_hdl.gateware import record_layout
from tests.strategies import make


def test_a_name_stands_for_the_fields_of_fixed_size_inside_of_it() -> None:
    imu = load_message("sensor_msgs/msg/Imu")
    layout = record_layout(imu, fields=["header", "orientation.y"])
    assert list(layout.members) == ["header", "orientation"]
    assert list(layout.members["header"].members) == ["stamp"]
    assert list(layout.members["orientation"].members) == ["y"]


def test_each_unknown_name_is_refused_also_beside_known_ones() -> None:
    imu = load_message("sensor_msgs/msg/Imu")
    names = r"'header\.frame_id', 'up'; it has header\.stamp, orientation, .*"
    with pytest.raises(ValueError, match=f"has no field of fixed size {names}$"):
        record_layout(imu, fields=["orientation", "up", "header.frame_id"])


def test_a_record_has_at_most_65535_bits() -> None:
    most = {"items": "uint8[8191]", **{f"flag_{k}": "bool" for k in range(7)}}
    assert record_layout(make("ros2", most)).size == 65_535
    with pytest.raises(ValueError, match=r"is too wide: record has .* bits"):
        record_layout(make("ros2", {**most, "more": "uint8"}))
    with pytest.raises(ValueError, match=r"is too wide: items has 65536 bits"):
        record_layout(make("ros2", {"items": "uint8[8192]"}))
