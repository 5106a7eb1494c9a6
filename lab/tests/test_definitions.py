"""Smoke tests of changed definitions that ROS's readers judge."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.verify.ts1 import judge as judging
from firm_hdl.verify.ts1.oracles import ORACLES
from firm_hdl.verify.ts1.universe import Universe
from lab.definitions import main, mutation
from tests.depth import by_depth
from tests.frontend.workspace import make_files
from tests.verify.ts1.conftest import need

FILES = {
    "p/msg/A.msg": "# All.\nint8 LOW=-5\nfloat32 F = 1.5  # f\nbool ON=True\nstring S= x # y \n"
    "Header header\nuint16[3] codes\nstring[] names\nB b\ntime t\n",
    "p/msg/B.msg": "byte b\nchar c\nq/C[] cs\n",
    "p/srv/S.srv": "int8 a\n---\nB b  # b\n",
    "q/msg/C.msg": "duration d\nbool x\n",
}


@pytest.fixture
def words(tmp_path):
    root = make_files(tmp_path, FILES)
    need("genmsg", ORACLES["genmsg"](Universe("noetic", (), str(tmp_path / "all"))).missing())
    return ["--distro", "noetic", "--path", str(root), "--oracle", "genmsg", "p/A", "p/B", "p/S"]


def test_a_reader_and_we_agree_on_mistakes(words, capsys):
    count = by_depth(40, 400)
    assert main([*words, "-n", str(count)]) == 0
    lines = [line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines()]
    counts = {what: int(number) for number, what in lines}
    # Some are invalid, and some are valid.
    assert count / 5 < counts.pop("refused by both, genmsg") < count * 9 / 10
    assert sum(counts.values()) == count


def test_a_mistake_that_we_miss_is_told_with_its_change(words, capsys, monkeypatch):
    """Must-fail twin: as if firm-hdl took the original for each text."""
    original = judging.read
    monkeypatch.setattr(
        "lab.definitions.read",
        lambda universe, case: original(
            universe, replace(case, name=case.name.rstrip("0123456789"))
        ),
    )
    assert main([*words, "-n", "20"]) == 1
    out = capsys.readouterr().out
    assert "--seed " in out and "verdict: firm-hdl accepts; oracle refuses: " in out


def test_a_change_depends_on_its_number_alone(tmp_path):
    root = make_files(tmp_path, {"p/msg/A.msg": "int8 a 5\n", "p/msg/B.msg": "bool[2] b\n"})
    cases = Universe("lyrical", [str(root)]).select([])
    assert [mutation(cases, number)[1].text for number in range(4)] == [
        *("int8 ]a 5\n", "B{ool[2] b\n", "int8 a 5=[1]\n", "int8  a5\r"),
    ]
