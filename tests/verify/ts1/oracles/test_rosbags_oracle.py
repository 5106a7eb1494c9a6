"""What rosbags, as an oracle, tells of messages, and of which it cannot tell anything."""

from __future__ import annotations

from itertools import count

import pytest
from rosbags.typesys import TypesysError

from firm_hdl.verify.ts1.oracles.oracle import Accepted, NotJudged, Refused
from firm_hdl.verify.ts1.oracles.rosbags_oracle import Rosbags
from firm_hdl.verify.ts1.universe import Universe
from tests.frontend.workspace import make_files


@pytest.fixture
def folder(tmp_path):
    """Return a function that makes the definitions of a distribution and of some files."""
    numbers = count()

    def make(distro, files):
        return Universe(distro, [str(make_files(tmp_path / str(next(numbers)), files))])

    return make


def answers(folder, distro, files, *types):
    """Return the answers of one oracle about types, in order."""
    universe = folder(distro, files)
    return list(map(Rosbags(universe).judge, universe.select(types)))


def test_line_ends_are_a_fact_of_their_own(folder):
    plain = {"p/msg/A.msg": "B b\nint8 x\n", "p/msg/B.msg": "int8 y\n"}
    (expected,) = answers(folder, "lyrical", plain, "p/A")
    for changed in plain:
        files = {**plain, changed: plain[changed].replace("\n", "\r\n")}
        (answer,) = answers(folder, "lyrical", files, "p/A")
        assert answer == Accepted({**expected.facts, "line ends": "refused"})


@pytest.mark.parametrize("language", ["msg", "idl"])
def test_a_message_that_needs_one_in_idl_is_not_judged(folder, language):
    idl = "module p { module msg { struct B { long x; }; }; };"
    texts = {"msg": "int32 x\n", "idl": idl}
    files = {"p/msg/A.msg": "int8 x\nC c\n", "p/msg/C.msg": "B b\n"}
    (answer,) = answers(folder, "lyrical", {**files, f"p/msg/B.{language}": texts[language]}, "p/A")
    if language == "idl":
        assert answer == NotJudged("it needs p/msg/B, which is written in IDL")
    else:
        assert isinstance(answer, Accepted)


def test_in_ros1_alone_a_time_of_ros2_is_one_that_rosbags_confuses(folder):
    files = {"p/msg/A.msg": "int8 x\n builtin_interfaces/Duration d\n"}
    (answer,) = answers(folder, "noetic", files, "p/A")
    assert answer == NotJudged("rosbags takes builtin_interfaces/Time for time of ROS 1")
    (answer,) = answers(folder, "lyrical", {"p/msg/A.msg": "builtin_interfaces/Time t\n"}, "p/A")
    assert isinstance(answer, Accepted)


@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
def test_a_circle_is_refused_and_what_is_needed_twice_is_none(folder, distro):
    files = {
        "p/msg/A.msg": "B b\nC c\n",
        "p/msg/B.msg": "D[] d\n",
        "p/msg/C.msg": "D d\nB[2] b\n",
        "p/msg/D.msg": "int8 x\n",
    }
    (answer,) = answers(folder, distro, files, "p/A")
    assert isinstance(answer, Accepted)
    files["p/msg/D.msg"] = "int8 x\nC[] c\n"
    found = answers(folder, distro, files, "p/A", "p/D")
    assert found == [Refused(f"p/msg/{name} contains itself") for name in "AD"]


@pytest.mark.parametrize(
    ("error", "answer"),
    [
        (RecursionError("deep"), NotJudged("it is nested too deeply for rosbags")),
        (TypesysError("no \n  such type"), Refused("no such type")),
        (AssertionError("no  such"), Refused("AssertionError no such")),
        (ValueError(f"no {'x' * 300} y"), Refused(f"ValueError no {'x' * 27} ... {'x' * 263} y")),
    ],
)
def test_whatever_rosbags_raises_is_an_answer(folder, monkeypatch, error, answer):
    def fails(self, case):
        raise error

    monkeypatch.setattr(Rosbags, "_judge", fails)
    assert answers(folder, "lyrical", {"p/msg/A.msg": "int8 x\n"}, "p/A") == [answer]
