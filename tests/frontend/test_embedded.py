"""The types of every distribution, against rosbags, which they come from."""

from __future__ import annotations

import pytest
from rosbags.typesys import get_typestore

from firm_hdl.frontend import DEFAULT_DISTRO, DISTROS, Library

from .structure import field_descriptions


def test_distributions():
    assert [*DISTROS] == ["noetic", "foxy", "humble", "iron", "jazzy", "kilted", "lyrical"]
    assert {d.name for d in DISTROS.values() if d.dialect == "ros1"} == {"noetic"}
    assert DEFAULT_DISTRO == "lyrical"


@pytest.mark.parametrize("distro", DISTROS)
def test_every_type_is_what_rosbags_has(distro):
    library = Library(distro)
    ours = {}
    for name in library.names():
        message = library.message(name)
        assert message.name == name
        constants = [(c.name, str(c.type), c.value) for c in message.constants]
        ours[f"{message.package}/msg/{message.base_name}"] = constants, field_descriptions(message)
    theirs = dict(get_typestore(DISTROS[distro].store).fielddefs)
    if library.dialect == "ros1":
        # In ROS 1 these two are builtin.
        del theirs["builtin_interfaces/msg/Time"], theirs["builtin_interfaces/msg/Duration"]
    padding = "structure_needs_at_least_one_member"
    assert ours == {
        name: (list(constants), [field for field in fields if field[0] != padding])
        for name, (constants, fields) in theirs.items()
    }
    assert len(ours) > 140


def test_texts_are_in_the_dialect_of_the_distribution():
    ros1 = Library("noetic").source("std_msgs/Header")
    assert ros1.name == "<rosbags noetic>/std_msgs/msg/Header.msg"
    assert ros1.text == "uint32 seq\ntime stamp\nstring frame_id\n"
    ros2 = Library("lyrical").source("std_msgs/Header")
    assert ros2.name == "<rosbags lyrical>/std_msgs/msg/Header.msg"
    assert ros2.text == "builtin_interfaces/Time stamp\nstring frame_id\n"


def test_bounds_and_constants_are_kept():
    library = Library("lyrical")
    assert "float64[<=3] dimensions\n" in library.source("shape_msgs/SolidPrimitive").text
    assert "uint8 PRISM=5\n" in library.source("shape_msgs/SolidPrimitive").text
    assert "string<=256 node_name\n" in library.source("rmw_dds_common/NodeEntitiesInfo").text
    text = Library("noetic").source("bond/Constants").text
    assert "float32 DEAD_PUBLISH_PERIOD=0.05\n" in text
    assert "string DISABLE_HEARTBEAT_TIMEOUT_PARAM=/bond_disable_heartbeat_timeout\n" in text


def test_empty_messages_have_no_fields():
    for distro in DISTROS:
        assert Library(distro).message("std_msgs/Empty").fields == ()
        assert Library(distro).source("std_msgs/Empty").text == ""
