"""Answers of each oracle for small definitions, and for definitions that make it fail."""

from __future__ import annotations

import os
import signal
import stat
from pathlib import Path

import pytest

from firm_hdl.verify.results.records import Test as Tested
from firm_hdl.verify.results.verdict import Failed
from firm_hdl.verify.ros_python.worker import Worker
from firm_hdl.verify.ts1.judge import judge_case
from firm_hdl.verify.ts1.oracles import debian, ros2_oracle
from firm_hdl.verify.ts1.oracles.debian import Genmsg
from firm_hdl.verify.ts1.oracles.oracle import Accepted, NotJudged, Refused
from tests.verify.judged import assert_passed
from tests.verify.ts1.conftest import need

MODULES = Path(debian.__file__).parent
FILES = {
    "p/msg/A.msg": "int8 N=010\nq/B[2] bs\nHeader header\nHeader[] headers\n",
    "p/msg/Header.msg": "string x\n",
    "p/srv/S.srv": "int8 a\n---\nq/B b\n",
    "p/action/Do.action": "int8 g\n---\n---\nq/B f\n",
    "q/msg/B.msg": "float32 x\n",
}


def test_genmsg_gives_structure_text_and_sum(court):
    answer = court("noetic", FILES).answer("genmsg", "p/A")
    assert isinstance(answer, Accepted)
    message = answer.facts["structure"]["p/A"]
    assert message["constants"] == [{"name": "N", "type": "int8", "value": 10, "text": "010"}]
    assert message["fields"] == [
        {"name": "bs", "type": "q/B[2]"},
        {"name": "header", "type": "std_msgs/Header"},
        {"name": "headers", "type": "p/Header[]"},
    ]
    assert answer.facts["show"].splitlines()[:3] == ["int8 N=010", "q/B[2] bs", "  float32 x"]
    assert len(answer.facts["md5"]["p/A"]) == 32


@pytest.mark.parametrize("type_", ["p/A", "p/S", "p/Do"])
def test_genmsg_and_we_agree(court, type_):
    assert_passed(court("noetic", FILES).outcome("genmsg", type_))


def test_messages_that_are_yet_to_be_made_from_an_action_are_refused_by_both(court):
    files = FILES | {"r/msg/M.msg": "p/DoGoal goal\n", "p/msg/M.msg": "DoActionFeedback feedback\n"}
    here = court("noetic", files)
    assert here.outcome("genmsg", "r/M").is_refused
    assert here.outcome("genmsg", "p/M").is_refused


ROS2 = FILES | {
    "p/msg/A.msg": 'string<=5[<=3] names ["a", "b"]  # Names [m].\nint8 N=0x10\nq/B[] bs\n'
}


def test_rosidl_adapter_gives_structure_defaults_and_comments(court):
    answer = court("lyrical", ROS2).answer("rosidl_adapter", "p/A")
    assert answer.facts["structure"]["p/msg/A"] == {
        "comment": "",
        "constants": [{"name": "N", "type": "int8", "value": 16, "comment": "", "unit": None}],
        "fields": [
            {
                "name": "names",
                "type": "string<=5[<=3]",
                "default": ["a", "b"],
                "comment": "Names.",
                "unit": "m",
            },
            {"name": "bs", "type": "q/msg/B[]", "default": None, "comment": "", "unit": None},
        ],
    }


def test_rosidl_parser_gives_derived_messages_too(court):
    facts = court("lyrical", ROS2).answer("rosidl_parser", "p/Do").facts["structure"]
    assert list(facts)[:3] == ["p/action/Do_Goal", "p/action/Do_Result", "p/action/Do_Feedback"]
    assert "p/action/Do_SendGoal_Request" in facts and "p/action/Do_FeedbackMessage" in facts


@pytest.mark.parametrize("oracle", ["rosidl_adapter", "rosidl_parser"])
@pytest.mark.parametrize("type_", ["p/A", "p/S", "p/Do", "q/B"])
def test_rosidl_and_we_agree(court, oracle, type_):
    assert_passed(court("lyrical", ROS2).outcome(oracle, type_))


@pytest.mark.parametrize(
    ("distro", "oracle"),
    [("noetic", "genmsg"), ("lyrical", "rosidl_adapter"), ("lyrical", "rosbags")],
)
def test_an_unknown_type_is_refused(court, distro, oracle):
    files = {"p/msg/A.msg": "B b\n", "p/msg/B.msg": "C[] c\n"}
    here = court(distro, files)
    for type_ in ("p/A", "p/B"):
        assert isinstance(here.answer(oracle, type_), Refused)
        assert here.outcome(oracle, type_).is_refused


@pytest.mark.parametrize(
    ("distro", "oracle"), [("noetic", "genmsg"), ("lyrical", "rosidl_adapter")]
)
def test_a_type_that_contains_itself_is_refused_by_both(court, distro, oracle):
    here = court(distro, {"p/msg/A.msg": "B b\n", "p/msg/B.msg": "A[] a\n"})
    assert here.outcome(oracle, "p/A").is_refused


@pytest.mark.parametrize(
    ("distro", "oracle"), [("noetic", "genmsg"), ("lyrical", "rosidl_adapter")]
)
def test_a_file_that_is_no_text_is_refused_by_both(court, distro, oracle, tmp_path):
    folder = tmp_path / "0" / "src" / "p" / "msg"
    folder.mkdir(parents=True)
    (folder / "A.msg").write_bytes(b"int8 x # \xff\n")
    assert court(distro, {}).outcome(oracle, "p/A").is_refused


def test_rosbags_gives_structure_and_hash(court):
    facts = court("lyrical", ROS2).answer("rosbags", "q/B").facts
    assert facts["structure"]["q/msg/B"]["fields"] == [{"name": "x", "type": "float32"}]
    assert facts["hash"]["q/msg/B"].startswith("RIHS01_")


def worker(court, distro, family):
    found = Worker(family, court(distro, FILES).universe.folder, modules=MODULES)
    need(family, found.missing)
    return found


def request(**changes):
    asked = {"oracle": "genmsg", "package": "q", "kind": "msg", "name": "B", "file": "B.msg"}
    return {**asked, "text": None, "has_events": False, **changes}


def test_a_worker_that_dies_is_replaced(court):
    mine = worker(court, "noetic", "genmsg")
    assert "facts" in mine.ask(request())
    os.kill(mine._process.pid, signal.SIGKILL)
    assert mine.ask(request()) == {"failed": "the process that was asked died"}
    assert "facts" in mine.ask(request())
    mine.close()


def test_a_worker_ends_when_it_is_closed_and_may_be_asked_again(court):
    mine = worker(court, "noetic", "genmsg")
    process = mine._process
    mine.close()
    assert process.returncode == 0
    assert "facts" in mine.ask(request())
    mine.close()


def test_whatever_a_definition_is_the_worker_answers(court):
    mine = worker(court, "lyrical", "rosidl")
    for text in ["\0", "string X='\\", "]", "int8[", "x" * 100_000, "#" * 5000, "\ud800", "@{x}\n"]:
        answer = mine.ask(request(oracle="rosidl_parser", text=text))
        assert set(answer) < {"facts", "refused", "failed"}, text
    assert "facts" in mine.ask(request(oracle="rosidl_parser"))
    mine.close()


@pytest.mark.parametrize("python", ["/nowhere/python", "/bin/false", "/bin/cat"])
def test_a_python_without_the_needed_packages(tmp_path, python):
    assert Worker("genmsg", str(tmp_path), modules=MODULES, python=python).missing


def test_a_failure_of_the_worker_is_an_answer(court):
    class FailedOracle(Genmsg):
        _worker = type("W", (), {"ask": lambda self, request: {"failed": "too slow"}})()

    here = court("noetic", FILES)
    (case,) = here.universe.select(["q/B"])
    assert FailedOracle(here.universe).judge(case) == NotJudged("too slow")


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


def test_ros2_is_missing_where_it_is_not_installed(court, monkeypatch):
    monkeypatch.setenv("PATH", "/nowhere")
    universe = court("lyrical", {}).universe
    from firm_hdl.verify.ts1.oracles.ros2_oracle import Ros2Proto

    assert Ros2Proto(universe).missing() == "there is no command 'ros2'; source ROS 2's setup"


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
