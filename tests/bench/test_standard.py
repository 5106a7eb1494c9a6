"""The converters on the page of figures."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.bench import standard
from firm_hdl.bench.messages import STATED
from firm_hdl.bench.standard import ALL_TYPES, MEASURED, SOFTWARE, Group, group_tasks


def test_images_have_the_size_that_their_title_says() -> None:
    (images,) = [group for group in SOFTWARE if group.title == "images of 64 KiB"]
    assert images.stated is not None and images.stated.elements == (65536, 65536)
    assert images.types == {
        "lyrical": ("sensor_msgs/msg/Image",),
        "noetic": ("sensor_msgs/Image",),
    }


def test_libraries_are_timed_with_the_types_of_the_first_table() -> None:
    messages = SOFTWARE[0].types
    assert messages["lyrical"] == MEASURED["figures"].types["lyrical"]
    # rosbags has no tf2_msgs of ROS 1.
    assert {name.replace("/", "/msg/") for name in messages["noetic"]} == {
        name for name in messages["lyrical"] if not name.startswith("tf2_msgs/")
    }
    assert SOFTWARE[0].stated == STATED


def test_all_types_are_simulated_on_the_bus_of_their_name() -> None:
    assert [(name, group.bus_bytes, list(group.types)) for name, group in ALL_TYPES.items()] == [
        ("lyrical, 8-byte bus", (8,), ["lyrical"]),
        ("noetic, 8-byte bus", (8,), ["noetic"]),
        ("lyrical, 64-byte bus", (64,), ["lyrical"]),
        ("noetic, 64-byte bus", (64,), ["noetic"]),
    ]
    assert not any(group.devices for group in ALL_TYPES.values())


@pytest.mark.parametrize("stated", [None, replace(STATED, count=3)])
def test_tasks_have_the_messages_and_seeds_of_their_group(stated: standard.Stated | None) -> None:
    group = Group(title="", types={"lyrical": ("std_msgs/msg/Bool",)}, seeds=(4, 2), stated=stated)
    tasks = list(group_tasks(group))
    assert [(task.converter.direction, task.seeds, task.stated) for task in tasks] == [
        ("deserializer", (4, 2), stated),
        ("serializer", (4, 2), stated),
    ]
