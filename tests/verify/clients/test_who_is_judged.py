"""Judges and judged libraries in contests."""

from __future__ import annotations

from firm_hdl.model import PRIMITIVES, Field, Message
from firm_hdl.verify.clients.system import reference_of
from firm_hdl.verify.references.client import Refusal
from firm_hdl.verify.references.clients import client
from tests.verify.clients.twins import Same, Twin, compared

ROS2 = PRIMITIVES["ros2"]


class RefusesAll(Same):
    def decode(self, packet):
        raise Refusal("never")


def test_refusing_a_correct_packet_is_a_difference():
    kinds = {"f0": ROS2["uint8"], "f1": ROS2["uint16"]}
    fields = tuple(Field(name=name, type=kind) for name, kind in kinds.items())
    message = Message(name="p/msg/A", dialect="ros2", fields=fields)
    library, values = Twin(client("firm-hdl"), RefusesAll), [{"f0": 1, "f1": 2}]
    trial = compared(library, client("firm-hdl"), message, values)
    kinds = {text.partition(" ")[0] for text in trial.failures}
    assert "decode" in kinds and "pad-1" in kinds and "cut-1" not in kinds


def test_no_library_judges_itself():
    here = ("genpy", "rosbags", "fastcdr")
    assert reference_of("rosbags", "cdr", here) == "fastcdr"
    assert reference_of("fastcdr", "cdr", here) == "rosbags"
    assert reference_of("firm-hdl", "cdr", here) == "fastcdr"
    assert reference_of("firm-hdl", "ros1", here) == "genpy"
    assert reference_of("genpy", "ros1", here) == "rosbags"
    assert reference_of("rosbags", "ros1", ("rosbags",)) is None
    assert reference_of("fastcdr", "cdr", ("fastcdr",)) is None


def test_ros_s_own_is_judged_by_rosbags_first_and_others_by_the_newest_release():
    here = ("rosbags", "fastcdr-2.2", "fastcdr-2.3", "fastcdr", "genpy")
    without_rosbags, without_own = here[1:], [name for name in here if name != "fastcdr"]
    assert reference_of("fastcdr", "cdr", here) == "rosbags"
    assert reference_of("fastcdr", "cdr", without_rosbags) == "fastcdr-2.2"
    assert reference_of("fastcdr-2.3", "cdr", here) == "fastcdr"
    assert reference_of("fastcdr-2.3", "cdr", without_own) == "fastcdr-2.2"
    assert reference_of("rosbags", "cdr", without_own) == "fastcdr-2.3"
    assert reference_of("mcap-ros1", "ros1", ("rosbags", "fastcdr")) == "rosbags"
