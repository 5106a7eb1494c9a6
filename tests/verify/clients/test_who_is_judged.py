"""Judges and judged libraries in contests, and the commands that repeat a contest."""

from __future__ import annotations

import argparse
import shlex
from collections import Counter

import pytest

from firm_hdl.model import PRIMITIVES
from firm_hdl.verify.clients.judge import LibraryComparison, LibraryResult
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


class DecodesWrongly(Same):
    """Decodes two kinds of packets incorrectly."""

    def decode(self, packet):
        value = super().decode(packet)
        return {**value, "f0": value["f0"] ^ 0x40} if "f0" in value else {"more": 1}


@pytest.mark.parametrize("wire", ["cdr", "ros1"])
def test_an_empty_packet_is_read_and_not_written(wire):
    dialect = "ros1" if wire == "ros1" else "ros2"
    message = a_message(dialect=dialect, name="p/A" if wire == "ros1" else "p/msg/A")
    contest = LibraryComparison(Twin(client("firm-hdl"), Same), client("firm-hdl"), wire)
    trial = contest.judge(message, [{}])
    assert trial.verdict.name == "passed" and trial.comparisons >= 2
    wrong = LibraryComparison(
        Twin(client("firm-hdl"), DecodesWrongly), client("firm-hdl"), wire
    ).judge(message, [{}])
    assert wrong.verdict.name == "failed"
    assert "decode" in {finding.what for finding in wrong.findings}


def test_refusing_a_correct_packet_is_a_difference():
    message = a_message(UINT8, ROS2["uint16"])
    trial = LibraryComparison(
        Twin(client("firm-hdl"), RefusesAll), client("firm-hdl"), "cdr"
    ).judge(message, [{"f0": 1, "f1": 2}])
    assert trial.verdict.name == "failed"
    kinds = {finding.what for finding in trial.findings}
    assert "decode" in kinds and "pad-1" in kinds and "cut-1" not in kinds


def test_the_first_of_each_kind_is_kept_and_all_are_counted():
    message = a_message(UINT8)
    values = [{"f0": n} for n in range(4)]
    own = client("firm-hdl")
    trial = LibraryComparison(Twin(own, DecodesWrongly), own, "cdr").judge(message, values)
    kinds = [finding.what for finding in trial.findings]
    assert len(kinds) == len({*kinds}) > 2 and kinds[0] == "decode"
    assert trial.findings[0].value == {"f0": 0}
    assert trial.unknown >= 4 + len(kinds) - 1
    assert trial.verdict.failures == tuple(f"{kind} differs from firm-hdl" for kind in kinds)


def test_byte_orders_are_asked_for_where_both_are_meant_to_read_them(monkeypatch):
    message = a_message(ROS2["uint16"])
    own = client("firm-hdl")
    for mine, theirs, is_asked in (
        (("little",), ("little",), False),
        (("little", "big"), ("little",), False),
        (("little",), ("little", "big"), False),
        (("little", "big"), ("little", "big"), True),
    ):
        monkeypatch.setattr(type(own), "byte_orders", theirs, raising=False)
        contest = LibraryComparison(Twin(client("firm-hdl"), Same, mine), own, "cdr")
        assert contest._reads("big-endian") is is_asked
        assert contest._reads("pad-1")
        assert contest.judge(message, [{"f0": 1}]).verdict.name == "passed"


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


def test_the_verdict_of_a_trial_follows_its_findings():
    known = {"library": "a", "reference": "b", "type": "t", "comparisons": 5, "answers": 5}
    assert LibraryResult(**known).verdict.name == "passed"
    assert LibraryResult(**known, known=Counter(k=1)).verdict.name == "known difference"
    assert LibraryResult(**known, known=Counter(k=1), unknown=1).verdict.name == "failed"
    assert LibraryResult(**{**known, "answers": 0}).verdict.name == "not judged"


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
