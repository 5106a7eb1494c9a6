"""Answers of each oracle for small definitions, and for definitions that make it fail."""

from __future__ import annotations

import os
import stat

import pytest

from firm_hdl.verify.results.records import Test as Tested
from firm_hdl.verify.results.verdict import Failed
from firm_hdl.verify.ts1.judge import judge_case
from firm_hdl.verify.ts1.oracles import ros as ros2_oracle
from firm_hdl.verify.ts1.oracles.oracle import Accepted, NotJudged
from firm_hdl.verify.ts1.oracles.ros import Genmsg
from tests.verify.judged import assert_passed

FILES = {
    "p/msg/A.msg": "int8 N=010\nq/B[2] bs\nHeader header\nHeader[] headers\n",
    "p/msg/Header.msg": "string x\n",
    "p/srv/S.srv": "int8 a\n---\nq/B b\n",
    "p/action/Do.action": "int8 g\n---\n---\nq/B f\n",
    "q/msg/B.msg": "float32 x\n",
}


def test_messages_that_are_yet_to_be_made_from_an_action_are_refused_by_both(court):
    files = FILES | {"r/msg/M.msg": "p/DoGoal goal\n", "p/msg/M.msg": "DoActionFeedback feedback\n"}
    here = court("noetic", files)
    assert here.outcome("genmsg", "r/M").is_refused
    assert here.outcome("genmsg", "p/M").is_refused


ROS2 = FILES | {
    "p/msg/A.msg": 'string<=5[<=3] names ["a", "b"]  # Names [m].\nint8 N=0x10\nq/B[] bs\n'
}


@pytest.mark.parametrize(
    ("distro", "oracle"), [("noetic", "genmsg"), ("lyrical", "rosidl_adapter")]
)
def test_a_file_that_is_no_text_is_refused_by_both(court, distro, oracle, tmp_path):
    folder = tmp_path / "0" / "src" / "p" / "msg"
    folder.mkdir(parents=True)
    (folder / "A.msg").write_bytes(b"int8 x # \xff\n")
    assert court(distro, {}).outcome(oracle, "p/A").is_refused


def test_an_invalid_answer_of_a_worker_fails(court):
    class SilentOracle(Genmsg):
        cpu_seconds = lambda self: 0.0  # noqa: E731
        _worker = type("W", (), {"ask": lambda self, request: {}})()

    here = court("noetic", FILES)
    (case,) = here.universe.select(["q/B"])
    test = Tested(system="ts1", distro="noetic", type="q/B")
    (output,) = judge_case(here.universe, [SilentOracle(here.universe)], case, test).verdicts
    assert isinstance(output.verdict, Failed) and "answered {}" in output.verdict.failures[0]


ROS2_COMMAND = """#!/bin/sh
case "$1 $2 $3" in
  "interface proto q/msg/B") printf '"x: 0.0\\n"\\n' ;;
  "interface proto p/msg/Header") printf '"y: 0\\n"\\n' ;;
  *) echo "Traceback" >&2; echo "Unknown package 'p'" >&2; exit 1 ;;
esac
"""


@pytest.fixture
def ros2_command(tmp_path, monkeypatch):
    folder = tmp_path / "bin"
    folder.mkdir()
    (folder / "ros2").write_text(ROS2_COMMAND)
    (folder / "ros2").chmod(stat.S_IRWXU)
    monkeypatch.setenv("PATH", f"{folder}:{os.environ['PATH']}")
    return folder


def test_ros2_interface_proto_is_compared_with_ours(court, ros2_command):
    here = court("lyrical", ROS2)
    assert_passed(here.outcome("ros2", "q/B"))
    outcome = here.outcome("ros2", "p/Header")
    assert isinstance(outcome.verdict, Failed)
    assert "oracle '\"y: 0\\n\"'" in outcome.verdict.details[0]
    outcome = here.outcome("ros2", "p/S")
    assert outcome.verdict == NotJudged("ros2 does not have it: Unknown package 'p'")


@pytest.mark.parametrize(
    ("script", "answer"),
    [
        (r"printf '\nx \n\n'", Accepted({"proto": "\nx \n"})),
        ("echo a; echo b >&2; exit 1", NotJudged("ros2 does not have it: b")),
        ("echo a; echo b; exit 3", NotJudged("ros2 does not have it: b")),
        ("exit 1", NotJudged("ros2 does not have it: exit status 1")),
        ("exit 0", NotJudged("ros2 says nothing of it")),
        ("echo ' '", NotJudged("ros2 says nothing of it")),
    ],
)
def test_an_answer_of_ros2_is_its_text_or_its_last_line(court, ros2_command, script, answer):
    (ros2_command / "ros2").write_text(f"#!/bin/sh\n{script}\n")
    assert court("lyrical", ROS2).answer("ros2", "q/B") == answer


def test_a_ros2_that_is_too_slow_or_cannot_be_run_has_not_judged(court, ros2_command, monkeypatch):
    monkeypatch.setattr(ros2_oracle, "_MOST_SECONDS", 0.1)
    (ros2_command / "ros2").write_text("#!/bin/sh\nexec sleep 60\n")
    answer = court("lyrical", ROS2).answer("ros2", "p/A")
    assert isinstance(answer, NotJudged) and answer.reason.startswith("ros2 failed: ")
    (ros2_command / "ros2").write_text("#!/nowhere/sh\n")
    monkeypatch.setenv("PATH", str(ros2_command))
    answer = court("lyrical", ROS2).answer("ros2", "p/A")
    assert isinstance(answer, NotJudged) and answer.reason.startswith("ros2 failed: [Errno 2]")


@pytest.mark.parametrize("oracle", ["rosidl_parser", "rosidl_adapter"])
@pytest.mark.parametrize(
    ("text", "count"),
    [("uint8 {}\n", 1), ("uint8 {}\nint8 x\n", 2), ("int32 {}\n", 1), ("uint8 {} 3\n", 1), ("", 0)],
)
def test_a_field_called_as_the_placeholder_of_empty_messages_is_one(court, oracle, text, count):
    text = text.format("structure_needs_at_least_one_member")
    here = court("lyrical", {"p/msg/A.msg": text})
    assert_passed(here.outcome(oracle, "p/A"))
    answer = here.answer(oracle, "p/A")
    assert len(answer.facts["structure"]["p/msg/A"]["fields"]) == count


@pytest.mark.parametrize(
    ("members", "count"),
    [("uint8 {};", 0), ("uint8 {}; long x;", 2), ("long {};", 1), ("long x;", 1)],
)
def test_the_placeholder_of_empty_messages_is_no_field_in_idl_if_it_is_alone(court, members, count):
    members = members.format("structure_needs_at_least_one_member")
    text = f"module p {{ module msg {{ struct A {{ {members} }}; }}; }};"
    here = court("lyrical", {"p/msg/A.idl": text})
    assert_passed(here.outcome("rosidl_parser", "p/A"))
    answer = here.answer("rosidl_parser", "p/A")
    assert len(answer.facts["structure"]["p/msg/A"]["fields"]) == count
