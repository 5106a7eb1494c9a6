"""Mutated definitions: the mutation rules, and agreement with the oracles on the mutants."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.ts1.mutate import mutation
from firm_hdl.verify.ts1.system import Ts1
from tests.depth import by_depth
from tests.frontend.workspace import make_files
from tests.verify.ts1.conftest import judged_by, need

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


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("distro", "oracle", "count"),
    [
        ("noetic", "genmsg", by_depth(40, 250)),
        ("lyrical", "rosidl_adapter", by_depth(40, 250)),
        ("lyrical", "rosidl_parser", by_depth(30, 100)),
    ],
)
def test_oracles_and_we_agree_on_mistakes(tmp_path, distro, oracle, count):
    root = make_files(tmp_path, ROS1 if distro == "noetic" else ROS2)
    request = Request(distros=(distro,), paths=(str(root),), mutations=count)
    with Ts1(replace(request, oracles=(oracle,), jobs=1)) as run:
        need(oracle, run.missing.get(oracle))
        verdicts, refused, wrong = judged_by(run)
    assert wrong == []
    assert sum(verdicts.values()) - verdicts[oracle, "not judged"] == count
    # Some mutants are invalid, and some are valid.
    assert count / 5 < refused < count * 9 / 10


def test_later_versions_make_the_mutations_that_a_report_names(court):
    """If a text of this table changes, the numbers in earlier reports mean other mutations."""
    files = {"p/msg/A.msg": "int8 a 5\n", "p/msg/B.msg": "bool[2] b\n"}
    cases = court("lyrical", files).universe.select([])
    assert [mutation(cases, number).text for number in range(12)] == [
        *("int8 ]a 5\n", "B{ool[2] b\n", "int8 a 5=[1]\n", "int8  a5\r", "iint8 a 5\n"),
        *("bOol[2] b\n", "int5 a 5\n", "int8 a \x0b5\n", "bool[2]] b\n", "int 8 5\n"),
        *("bOol[2] b\n", "bool[2] b\nbool[2] b\n"),
    ]


def test_only_texts_of_some_length_are_changed(court):
    files = {"p/msg/A.msg": "int8 a\n", "p/msg/B.msg": "# " + "x" * 19_998, "p/msg/C.msg": "int8 c"}
    cases = court("lyrical", files).universe.select([])
    names = {mutation(cases, number).name for number in range(60)}
    assert names == {"A", "B", "C"}
    longer = [replace(case, text=case.text + "x" * (case.name == "B")) for case in cases]
    assert {mutation(longer, number).name for number in range(60)} == {"A", "C"}
    # If all texts are long, they are changed nevertheless.
    assert mutation(longer[1:2], 3).before == longer[1].text
