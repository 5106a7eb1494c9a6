"""Complete runs of TS1: judged definitions, printed output, and exit status."""

from __future__ import annotations

import os
import re
import shlex
from dataclasses import replace

import pytest

from firm_hdl.cli import main
from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import DISTROS
from firm_hdl.verify.results.verdict import Failed
from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.systems.tasks import UnknownTypeError
from firm_hdl.verify.ts1.oracles import ORACLES
from firm_hdl.verify.ts1.oracles.oracle import Refused
from firm_hdl.verify.ts1.system import Ts1, each_distro
from tests.frontend.workspace import make_files
from tests.verify.ts1.conftest import judged_by, need

FILES = {
    "src/p/msg/A.msg": "q/B b\n",
    "src/p/msg/Bad.msg": "int8[ x\n",
    "src/p/srv/S.srv": "int8 a\n---\n",
    "src/q/msg/B.msg": "int8 x\n",
}


@pytest.fixture
def source(tmp_path):
    return str(make_files(tmp_path, FILES) / "src")


def run_ts1(request, oracles):
    """Judge definitions as the command does; return the records."""
    with Ts1(replace(request, oracles=tuple(oracles), jobs=1)) as system:
        return system.run(None)


def judged(request, oracles=(), jobs=1):
    """Run all tests; return what `judged_by` returns, and the run."""
    with Ts1(replace(request, oracles=tuple(oracles), jobs=jobs)) as run:
        for name in oracles:
            need(name, run.missing.get(name))
        return *judged_by(run), run


# The types of the distributions of ROS 2 differ little. Each is read, and hashed, in other tests.
@pytest.mark.parametrize(
    "distro",
    [pytest.param(name, marks=[pytest.mark.thorough] * (name != "noetic")) for name in DISTROS],
)
def test_embedded_types_agree_with_fast_oracles(distro):
    oracles = ["genmsg", "rosbags"] if distro == "noetic" else ["rosidl_adapter", "rosbags"]
    verdicts, refused, wrong, run = judged(Request(distros=(distro,)), oracles)
    assert (refused, wrong) == (0, [])
    assert verdicts[oracles[0], "passed"] == len(run.cases) > 140
    # rosbags hashes `char` differently, in a few types of each distribution.
    known = verdicts["rosbags", "known difference"]
    messages = [case for case in run.cases.values() if case.language == "msg"]
    assert known <= 5 and verdicts["rosbags", "passed"] == len(messages) - known


def test_the_report_names_oracles_verdicts_and_types(source, capsys):
    found = run_ts1(Request(distros=("noetic",), paths=(source,)), ["rosbags"])
    assert not [each for each in found if isinstance(each.verdict, Failed)]
    out = capsys.readouterr().out
    assert "p/A  rosbags  agrees\n" in out
    assert "p/Bad  rosbags  agrees: both refuse\n" in out
    assert re.search(r"^rosbags \S+ +3 +0 +0 +0  \(1 refused by both\)$", out, re.MULTILINE)
    assert re.search(r"^noetic +3 of +3 definitions agree$", out, re.MULTILINE)


def test_a_difference_is_printed_with_the_command_that_repeats_it(source, capsys, monkeypatch):
    monkeypatch.setattr(ORACLES["rosbags"], "judge", lambda self, case: Refused("I do not like it"))
    words = ["verify", "--systems", "ts1", "--distro", "noetic", "--path", source, "--jobs", "1"]
    assert main([*words, "--oracle", "rosbags", "q/B"]) == 1
    said = capsys.readouterr()
    text = said.out + said.err
    assert "DIFFERS q/B.msg, rosbags" in text
    assert "verdict: firm-hdl accepts; oracle refuses: I do not like it" in text
    again = re.search(r"again: (.*)", text)
    assert shlex.split(again[1]) == ["firm-hdl", *words[:-2], "q/msg/B"]


def test_a_requested_oracle_that_is_not_installed_fails(source, capsys, monkeypatch):
    monkeypatch.setenv("PATH", "/nowhere")
    request = Request(distros=("lyrical",), paths=(source,), types=("q/B",))
    assert isinstance(run_ts1(request, ["ros2"])[-1].verdict, Failed)
    assert "is not available: there is no command 'ros2'" in capsys.readouterr().out


def test_a_message_of_a_service_has_no_definition_of_its_own(source):
    with pytest.raises(DefinitionError) as error:
        Ts1(Request(distros=("lyrical",), paths=(source,), types=("p/srv/S_Request",))).__enter__()
    assert str(error.value) == "error: 'p/srv/S_Request' has no definition of its own"


def distros_of(**asked):
    found = [request.distros for request in each_distro(Request(**asked))]
    assert {len(distros) for distros in found} == {1}
    return [distro for (distro,) in found]


def test_distributions_that_have_the_types_are_chosen():
    assert distros_of(types=("sensor_msgs/Imu",)) == list(DISTROS)
    # Some types are missing in a distribution before or after; some are in the last one only.
    for name, distros in {
        "actionlib/msg/TestAction": ["noetic"],
        "libstatistics_collector/DummyMessage": ["foxy"],
        "geometry_msgs/PolygonInstance": ["jazzy", "kilted", "lyrical"],
    }.items():
        assert distros_of(types=("std_msgs/Header", name)) == distros
    assert distros_of(paths=("x",)) == ["lyrical"]
    assert distros_of(distros=("foxy",), paths=("x",)) == ["foxy"]
    with pytest.raises(UnknownTypeError, match=r"^No distribution has std_msgs/Header, p/None$"):
        each_distro(Request(types=("std_msgs/Header", "p/None")))


def test_a_type_in_a_hidden_package_of_the_workspace_is_told(tmp_path, monkeypatch):
    make_files(tmp_path, {"over/share/p/package.xml": "", "under/share/p/msg/A.msg": ""})
    prefixes = os.pathsep.join(str(tmp_path / name) for name in ("over", "under"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", prefixes)
    with pytest.raises(DefinitionError, match=r"over/share/p' and hides that of .*under/share/p'"):
        each_distro(Request(types=("p/A",)))


@pytest.mark.parametrize(
    ("asked", "oracles", "command"),
    [
        ({}, (), "p/srv/S"),
        ({"types": ("p/S", "q/B")}, ("genmsg", "rosbags"),
         "--oracle genmsg --oracle rosbags p/srv/S"),
    ],
)  # fmt: skip
def test_the_command_that_repeats_a_test(source, asked, oracles, command):
    words = f"firm-hdl verify --systems ts1 --distro iron --path {source}"
    # The others take seconds to start.
    request = Request(distros=("iron",), paths=(source,), oracles=("rosbags",), **asked)
    with Ts1(request) as run:
        tests = [test for test in run.cases if test.type == "p/srv/S"]
        assert run.command(tests[0], oracles) == f"{words} {command}"


def test_oracles_read_the_text_that_we_take(tmp_path):
    # The first copy of a package hides the others.
    files = {"one/std_msgs/msg/Header.msg": "int8 x\n", "two/p/msg/A.msg": "std_msgs/Header h\n"}
    files |= {"two/p/srv/io/S.srv": "A a\n---\nq/B b\n", "three/p/msg/C.msg": "int8 x\n"}
    files |= {"more/q/msg/B.msg": "p/A a\ngeometry_msgs/Point p\n", "more/std_msgs/msg/A.msg": ""}
    # What cannot be read counts only if it is judged.
    files |= {"more/x/r/msg/A.msg": "", "more/y/r/msg/A.msg": ""}
    make_files(tmp_path, files)
    paths = tuple(str(tmp_path / name) for name in ("one", "two", "three"))
    request = Request(distros=("noetic",), paths=paths, depends=(str(tmp_path / "more"),))
    verdicts, _, _, run = judged(request, ["genmsg"])
    assert [case.full_name for case in run.cases.values()] == ["p/A", "p/S", "std_msgs/Header"]
    assert verdicts == {("genmsg", "passed"): 3}
