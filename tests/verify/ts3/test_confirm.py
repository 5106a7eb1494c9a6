"""Confirmation of the packets of TS3 by other libraries, and disagreements with them."""

from __future__ import annotations

import pytest

from firm_hdl.cases.make import make_cases
from firm_hdl.cases.oracle import distro_oracle
from firm_hdl.cli import main
from firm_hdl.frontend import Library
from firm_hdl.verify.references.client import Refusal
from firm_hdl.verify.references.clients import (
    CLIENTS,
    WRITERS,
    client,
    find_references,
    usable_references,
)
from firm_hdl.verify.results.verdict import NotJudged
from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.verify.ts3.confirm import confirm
from tests.tools import need
from tests.verify.judged import accept, assert_passed

FAST_CDR = ("fastcdr", "fastcdr-2.2", "fastcdr-2.3")
CDR = (*FAST_CDR, "cyclonedds")
SMALL = CaseOptions(most_cases=4, stalled=False, broken=False)


@pytest.fixture(autouse=True)
def all_here():
    """Require all references in CI; otherwise skip without them."""
    for name in WRITERS:
        if client(name).missing() is not None:
            need(f"{name} ({client(name).missing()})", None)


def cases_of(distro, name):
    wire = "ros1" if distro == "noetic" else "cdr"
    return list(make_cases(distro_oracle(distro), name, wire=wire, most=8))


@pytest.mark.parametrize(
    ("distro", "name", "by"),
    [
        ("noetic", "sensor_msgs/msg/Imu", ("genpy",)),
        # Includes NaN values that a Python float does not keep.
        ("lyrical", "sensor_msgs/msg/Joy", CDR),
        ("lyrical", "rcl_interfaces/msg/ParameterValue", CDR),
    ],
)
def test_other_libraries_write_the_packets_of_rosbags(distro, name, by):
    message = Library(distro).message(name)
    found = confirm(message, message.wire, cases_of(distro, name))
    assert (found.by, found.failures) == (by, ())


@pytest.mark.sampled(2)
@pytest.mark.parametrize("answer", [b"\0\1\0\0\7", Refusal("no")])
def test_a_library_that_disagrees_is_a_failure_with_both_names(monkeypatch, answer):
    codec = client("fastcdr").open(Library("lyrical").message("std_msgs/msg/Bool"), "cdr")
    monkeypatch.setattr(type(codec), "encode_all", lambda self, values: [answer] * len(values))
    result = accept("lyrical", "std_msgs/msg/Bool", SMALL)
    assert len(result.failures) == 4 * len(FAST_CDR)
    assert all("fastcdr" in text and "rosbags writes 00010000" in text for text in result.failures)


def test_result_names_the_references():
    result = accept("lyrical", "std_msgs/msg/Bool", SMALL)
    assert_passed(result)
    assert result.written_by == ("rosbags", *CDR)
    none = accept("lyrical", "std_msgs/msg/Bool", CaseOptions(most_cases=2, references=()))
    assert none.written_by == ("rosbags",)
    assert none.command.endswith(" --reference none std_msgs/msg/Bool")


def test_known_divergence_hides_no_other(monkeypatch):
    codec = client("cyclonedds").open(Library("lyrical").message("sensor_msgs/msg/Joy"), "cdr")
    right = type(codec).encode_all

    def without_the_last_byte(self, values):
        return [answer[:-1] for answer in right(self, values)]

    monkeypatch.setattr(type(codec), "encode_all", without_the_last_byte)
    options = CaseOptions(simulated=False, references=("cyclonedds",))
    result = accept("lyrical", "sensor_msgs/msg/Joy", options)
    assert len(result.failures) > 6
    assert all("cyclonedds writes" in text for text in result.failures)


def test_named_reference_that_cannot_confirm_is_no_pass(capsys):
    arguments = ["verify", "--distro", "lyrical", "--jobs", "1", "--cases", "2"]
    assert main([*arguments, "--reference", "genpy", "std_msgs/msg/Bool"]) == 1
    shown = capsys.readouterr().out
    assert "not judged: std_msgs/msg/Bool (lyrical), ts3, 8-byte bus: " in shown
    assert "genpy has no wire 'cdr'" in shown and "genpy 1 types" not in shown


def test_wide_text_is_judged_with_a_reference(tmp_path, make_wide):
    options = CaseOptions(most_cases=6, paths=(str(make_wide),))
    result = accept("lyrical", "p/msg/Wide", options)
    assert_passed(result)
    assert result.written_by == ("rosbags", *FAST_CDR) and result.cases == 6
    alone = accept("lyrical", "p/msg/Wide", CaseOptions(paths=(str(make_wide),), references=()))
    assert alone.verdict == NotJudged("rosbags has no wstring, which p/msg/Wide.a is")


@pytest.fixture
def make_wide(tmp_path):
    (tmp_path / "p" / "msg").mkdir(parents=True)
    (tmp_path / "p" / "msg" / "Wide.msg").write_text(
        "wstring a\nwstring<=3[] b\nuint8 c\nwstring[2] d\nfloat64 e\n"
    )
    return tmp_path


def test_missing_references_are_reported_or_an_error(capsys, monkeypatch):
    monkeypatch.setattr(CLIENTS["cyclonedds"], "missing", lambda self: "cyclonedds is not there")
    assert usable_references() == ("genpy", *FAST_CDR)
    assert find_references(None, ["cdr"]) == [
        "cyclonedds does not confirm bytes: cyclonedds is not there"
    ]
    assert find_references(None, ["ros1"]) == []
    assert main(["verify", "--all", "--distro", "lyrical", "--reference", "cyclonedds"]) == 1
    assert capsys.readouterr().err == "error: cyclonedds is not there\n"
