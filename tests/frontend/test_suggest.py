"""Suggestions for names that are not defined: which ones, and in which order."""

from __future__ import annotations

from typing import ClassVar

import pytest

from firm_hdl.frontend.names import TypeName
from firm_hdl.frontend.sources import Sources
from firm_hdl.frontend.suggest import did_you_mean, similar_types, unknown_type


class Names:
    """An origin of names without texts."""

    packages: ClassVar = {}

    def __init__(self, *names):
        self._names = [tuple(name.split("/")) for name in names]

    def names(self):
        return self._names

    def find(self, package, kind, name):
        return None


def similar(origins, package, name, **options):
    found = similar_types(Sources([Names(*each) for each in origins]), package, name, **options)
    return ["/".join(each) for each in found]


def unknown(origins, package, name):
    sources = Sources([Names(*each) for each in origins])
    return unknown_type(sources, [TypeName(package, "msg", name, "ros2")])


def test_the_same_name_in_a_similar_package_comes_first_then_in_others():
    own = ["ants/msg/Pose", "geo_msgs/msg/Pose", "zoo/msg/Pose", "zoo/msg/Posts"]
    assert similar([own], "geo_msg", "Pose") == [
        "geo_msgs/msg/Pose", "ants/msg/Pose", "zoo/msg/Pose",
    ]  # fmt: skip


def test_similar_names_of_the_same_package_come_after_the_same_name_elsewhere():
    origins = [["p/msg/Poses", "p/msg/Wheel", "q/msg/Pose", "q/msg/Poser"]]
    assert similar(origins, "p", "Pose") == ["q/msg/Pose", "p/msg/Poses"]


def test_only_the_kinds_that_may_be_meant_are_named():
    origins = [["p/srv/Stop", "p/action/Stop", "p/msg/Stops", "p/srv/Stops", "q/msg/Stop"]]
    everything = [
        "q/msg/Stop", "p/srv/Stop", "p/action/Stop", "p/msg/Stops", "p/srv/Stops",
    ]  # fmt: skip
    assert similar(origins, "p", "Stop") == everything
    assert similar(origins, "p", "Stop", kinds=("msg",)) == ["q/msg/Stop", "p/msg/Stops"]
    assert similar([["p/srv/Stops"]], "p", "Stop", kinds=("msg",)) == []
    # Others do not crowd them out.
    nearer = [f"p/srv/Stop{letter}" for letter in "abcd"]
    assert similar([[*nearer, "p/msg/Stopper"]], "p", "Stop", kinds=("msg",)) == ["p/msg/Stopper"]


@pytest.mark.parametrize(
    ("names", "ending"),
    [
        ([], ""),
        (["a"], "; did you mean 'a'?"),
        (["a", "b"], "; did you mean 'a' or 'b'?"),
        (["a", "b", "c"], "; did you mean 'a', 'b' or 'c'?"),
        (["a", "b", "c", "d"], "; did you mean 'a', 'b' or 'c'?"),
    ],
)
def test_at_most_three_names_are_suggested(names, ending):
    assert did_you_mean("it is wrong", names) == f"it is wrong{ending}"


@pytest.mark.parametrize(
    ("package", "name", "message"),
    [
        ("p", "Pose", "type 'Pose' is not defined in package 'p'"),
        ("q", "tf", "package 'q' is not found"),
        ("p", "x" * 61, f"type '{'x' * 57}...' is not defined in package 'p'"),
        ("q\x07", "A", "package 'q\\x07' is not found"),
    ],
)
def test_the_message_tells_what_is_missing(package, name, message):
    assert unknown([["p/msg/A"]], package, name) == message


def test_a_package_of_ros_that_is_not_embedded_is_told_where_to_find():
    message = unknown([["p/msg/A"]], "tf", "A")
    assert message.startswith("package 'tf' is not found; this ROS package does not come with")
    assert "--path" in message
    # It may well be in the user's folders.
    assert unknown([["tf/msg/A"]], "tf", "B") == "type 'B' is not defined in package 'tf'"
