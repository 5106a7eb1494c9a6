"""Texts with small mistakes: how they are made, and that oracles and we agree on them."""

from __future__ import annotations

import pytest

from firm_hdl.verify.ts1 import Selection, Ts1Run
from firm_hdl.verify.ts1.mutate import mutation
from tests.frontend.workspace import make_files
from tests.verify.ts1.conftest import need

ROS1 = {
    "p/msg/A.msg": "# All.\nint8 LOW=-5\nfloat32 F = 1.5  # f\nbool ON=True\nstring S= x # y \n"
    "Header header\nuint16[3] codes\nstring[] names\nB b\ntime t\n",
    "p/msg/B.msg": "byte b\nchar c\nq/C[] cs\n",
    "p/srv/S.srv": "int8 a\n---\nB b  # b\n",
    "p/action/Do.action": "int8 g\n---\nint8 r\n---\nfloat32 f\n",
    "q/msg/C.msg": "duration d\nbool x\n",
}
ROS2 = {
    "p/msg/A.msg": "# All.\n\nint8 LOW=-5\nfloat32 F = 1.5  # [m]\nbool ON=true\nstring S='x y'\n"
    "std_msgs/Header header\nuint16[3] codes [1, 2, 3]\nstring<=5[<=2] names [\"a\", 'b']\n"
    'B b\nwstring w "x"\nbool ok true\n',
    "p/msg/B.msg": "byte b 1\nchar c 65\nq/C[] cs\nfloat64[<=4] xs\n",
    "p/srv/S.srv": "int8 a 3\n---\nB b  # b\n",
    "p/action/Do.action": "int8 g\n---\nint8 r\n---\nfloat32 f\n",
    "q/msg/C.msg": "bool x\n",
}


@pytest.mark.parametrize(
    ("distro", "oracle", "count"),
    [
        ("noetic", "genmsg", 250),
        ("lyrical", "rosidl_adapter", 250),
        ("lyrical", "rosidl_parser", 100),
    ],
)
def test_oracles_and_we_agree_on_mistakes(tmp_path, distro, oracle, count):
    root = make_files(tmp_path, ROS1 if distro == "noetic" else ROS2)
    selection = Selection(distro=distro, paths=(str(root),), mutations=count)
    with Ts1Run(selection, [oracle], 1) as run:
        need(oracle, run.missing.get(oracle))
        differing, judged, refused = [], 0, 0
        for _, tally in run.tallies():
            differing += [(number, outcome.verdict.details) for outcome, number in tally.differing]
            judged += sum(tally.verdicts.values()) - tally.verdicts[oracle, "not judged"]
            refused += tally.refused[oracle]
    assert differing == []
    assert judged == count
    # Neither are all mistakes, nor none.
    assert count / 5 < refused < count * 9 / 10


def test_a_mutation_is_decided_by_its_number(court):
    cases = court("lyrical", ROS2).universe.select([])
    texts = [mutation(cases, number) for number in range(200)]
    assert texts == [mutation(cases, number) for number in range(200)]
    assert len({case.text for case in texts}) > 150
    assert all(case.text != case.before for case in texts)


def test_changes_are_told_line_by_line(court):
    cases = court("lyrical", {"p/msg/A.msg": "int8 a\n"}).universe.select([])
    changed = mutation(cases, 1)
    assert changed.changes and all(line[0] in "+-" for line in changed.changes)


def test_an_empty_text_can_be_mutated(court):
    cases = court("lyrical", {"p/msg/A.msg": ""}).universe.select([])
    assert all(mutation(cases, number).is_changed for number in range(50))
