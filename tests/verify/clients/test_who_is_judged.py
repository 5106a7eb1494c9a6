"""Judges and judged libraries in contests, and the commands that repeat a contest."""

from __future__ import annotations

import argparse
import shlex

import pytest

from firm_hdl.model import PRIMITIVES
from firm_hdl.verify.clients.judge import LibraryComparison
from firm_hdl.verify.clients.run import command_of, reference_of
from firm_hdl.verify.command import add_verify_arguments
from firm_hdl.verify.references.client import Refusal
from firm_hdl.verify.references.clients import client
from firm_hdl.verify.systems.options import Request
from tests.verify.clients.test_clauses import UINT8, a_message
from tests.verify.clients.twins import Same, Twin

ROS2 = PRIMITIVES["ros2"]


class RefusesAll(Same):
    def decode(self, packet):
        raise Refusal("never")


def test_refusing_a_correct_packet_is_a_difference():
    message = a_message(UINT8, ROS2["uint16"])
    trial = LibraryComparison(
        Twin(client("firm-hdl"), RefusesAll), client("firm-hdl"), "cdr"
    ).judge(message, [{"f0": 1, "f1": 2}])
    assert trial.verdict.name == "failed"
    kinds = {finding.what for finding in trial.findings}
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


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"wire": "ros1"},
        {"seed": 3},
        {"most_cases": 1},
        {"most_cases": 7, "paths": ("a b", "c")},
    ],
)
def test_the_repeating_command_has_all_options(options):
    made = Request(libraries=("rosbags",), **options)
    words = shlex.split(command_of(made, "humble", "p/msg/A", "rosbags"))
    assert words[:2] == ["firm-hdl", "verify"]
    parser = argparse.ArgumentParser()
    add_verify_arguments(parser)
    again = parser.parse_args(words[2:])
    assert (again.types, again.distro, again.sut) == (["p/msg/A"], ["humble"], ["rosbags"])
    assert tuple(again.path or ()) == made.paths
    assert (again.wire, again.cases) == (made.wire, made.most_cases)
    assert (again.seed or 0) == made.seed
