"""Generated benches of many types in GHDL, and the comparison of all that they write."""

from __future__ import annotations

import pytest

import firm_hdl.verify.generated_benches as benches
from firm_hdl.cases.make import Case
from firm_hdl.export.vhdl.bench import RUN_SCRIPT
from firm_hdl.frontend import Library
from firm_hdl.plan import build_plan
from firm_hdl.verify.generated_benches import _check_transfers, _compare
from firm_hdl.verify.references.clients import client
from firm_hdl.verify.results.records import Test
from firm_hdl.verify.systems.options import Request
from firm_hdl.wire import lay_out
from tests.depth import THOROUGH
from tests.strategies import make
from tests.tools import need
from tests.verify.judged import assert_passed
from tests.verify.samples import own_package

HEADER = "std_msgs/msg/Header"
# It has one bench, without the record view.
STRING = "std_msgs/msg/String"


def judge_bench(ghdl, name, distro="lyrical", bus_bytes=8, **options):
    test = Test(system="bench", distro=distro, type=name, bus_bytes=bus_bytes)
    return benches.judge_bench((Request(**options), ghdl), test)


def thorough(*values):
    return pytest.param(*values, marks=pytest.mark.thorough)


# The types of tests/export/vhdl/test_bench.py have no loops, and arrays of floats only.
SAMPLE = [
    # Two levels of loops over strings.
    thorough("lyrical", "diagnostic_msgs/msg/DiagnosticArray", 8),
    # Sequences of every kind, `bool` and `byte` among them.
    thorough("lyrical", "rcl_interfaces/msg/ParameterValue", 8),
    # Runs of a constant length in a loop, and structures in another.
    ("noetic", "shape_msgs/Mesh", 8),
    # A leaf without bytes between other leaves.
    thorough("noetic", "nav_msgs/GetMapActionGoal", 8),
    # Bounds, and strings of one character a lane.
    thorough("lyrical", "shape_msgs/msg/SolidPrimitive", 2),
]


@pytest.mark.parametrize(("distro", "name", "bus_bytes"), SAMPLE)
def test_bench_passes_with_the_bytes_and_transfers_of_rosbags(ghdl, distro, name, bus_bytes):
    result = judge_bench(ghdl, name, distro, bus_bytes)
    assert assert_passed(result) == result.packets >= 3
    assert result.metrics["transfers"] >= result.packets


def wide(folder, ghdl):
    """Run the bench of a type with wide text."""
    own_package(folder)
    (folder / "own_msgs" / "msg" / "Wide.msg").write_text("wstring[] text\nuint8 x\n")
    return judge_bench(ghdl, "own_msgs/msg/Wide", paths=(str(folder),))


@pytest.mark.thorough
def test_wide_text_is_confirmed(ghdl, tmp_path, monkeypatch):
    if (missing := client("fastcdr").missing()) is not None:
        need(f"fastcdr ({missing})", None)
    result = wide(tmp_path, ghdl)
    assert assert_passed(result) == result.packets >= 3
    assert result.metrics["transfers"] > result.packets
    codec = client("fastcdr").open(Library("lyrical").message("std_msgs/msg/Bool"), "cdr")
    monkeypatch.setattr(type(codec), "encode_all", lambda self, values: [b"\0"] * len(values))
    (failure,) = wide(tmp_path, ghdl).verdict.failures
    assert "fastcdr writes 00, rosbags writes 00010000" in failure


FALSIFY = "trap 'sed -i s/00/01/ results.txt' EXIT"


def change(monkeypatch, file: str, before: str, after: str) -> None:
    """Replace the first `before` in one of the written files."""
    build = benches.build

    def built(names, folder, **options):
        done = build(names, folder, **options)
        paths = list(done[0].folder.rglob(f"*{file}"))
        assert len(paths) == 1
        text = paths[0].read_text()
        assert before in text
        paths[0].write_text(text.replace(before, after, 1))
        return done

    monkeypatch.setattr(benches, "build", built)


@pytest.mark.parametrize(
    ("file", "before", "after", "output"),
    [
        # A warning and an error of GHDL; a bench that fails; different bytes; different transfers.
        ("8_tb.vhd", "\nbegin\n", "\n  signal unused : bit;\nbegin\n", "unused"),
        ("_deserializer.vhd", "architecture", "architektur", "_deserializer.vhd:"),
        ("_serializer_flat.vhd", "m_axis_tdata <= ", "m_axis_tdata <= not ", "FAIL packet 0"),
        (RUN_SCRIPT, 'exec "$ghdl"', f'{FALSIFY}\n"$ghdl"', "packets that came out: number"),
        ("8_tb.vhd", "stamp.sec.data)", "stamp.nanosec.data)", "transfers of stamp.sec: number 1"),
        (RUN_SCRIPT, 'exec "$ghdl"', 'echo nothing; exit 0\nexec "$ghdl"', "nothing"),
    ],
)
@pytest.mark.sampled(6)
def test_faults_are_found(ghdl, monkeypatch, file, before, after, output):
    change(monkeypatch, file, before, after)
    result = judge_bench(ghdl, HEADER)
    (failure,) = result.verdict.failures
    assert output in failure
    assert not result.packets


@pytest.mark.thorough
def test_bench_of_the_record_view_is_run_as_well(ghdl, monkeypatch):
    both = judge_bench(ghdl, "geometry_msgs/msg/Vector3")
    assert assert_passed(both) == both.packets
    if THOROUGH:
        assert assert_passed(judge_bench(ghdl, HEADER))
    # Three leaves, in the first bench; each packet is sent in both.
    assert 2 * both.metrics["transfers"] == 3 * both.packets
    change(monkeypatch, "8_serializer_record.vhd", "<= to_slv(msg", "<= not to_slv(msg")
    (failure,) = judge_bench(ghdl, "geometry_msgs/msg/Vector3").verdict.failures
    assert "FAIL packet 0" in failure


MESSAGE = make("ros1", {"x": "int16", "b": "bool", "s": "string"})
PLAN = build_plan(lay_out(MESSAGE), bus_bytes=2)
CASES = [
    Case(
        what=what,
        value=None,
        packet=b"",
        transfers={
            ("x",): [x],
            ("b",): [1],
            ("s", "length"): [3],
            ("s", "items"): [((97, 98), False), ((99, 0), True)],
        },
    )
    for what, x in (("one", -2), ("two", 5))
]
LINES = [
    "4 x FFFE",
    "4 b 1",
    "5 s.length 00000003",
    "6 s.items 6261",
    "7 s.items 0063 *",
    "9 x 0005",
    "9 b 1",
    "9 s.length 00000003",
    "12 s.items 6261",
    "17 s.items 0063 *",
]


def check(lines):
    return _check_transfers(PLAN, CASES, "".join(f"{line}\n" for line in lines))


def test_correct_output_is_counted():
    assert check(LINES) == 10


@pytest.mark.parametrize(
    ("change", "output"),
    [
        ({0: "4 x FFFF"}, "transfers of x: number 0 of 2 is ['FFFF'] instead of ['FFFE']"),
        ({1: "4 b 0"}, "transfers of b: number 0 of 2 "),
        ({1: "4 b X"}, "transfers of b: number 0 of 2 is ['X'] instead of ['1']"),
        ({9: "17 s.items 0063"}, "transfers of s.items: number 3 of 4 is ['0063'] instead of"),
        ({8: "12 s.items 6261 *"}, "transfers of s.items: number 2 of 4 is ['6261 *'] instead"),
        # A byte in a lane that the string does not use.
        ({9: "17 s.items A563 *"}, "transfers of s.items: number 3 of 4 "),
        ({7: None}, "transfers of s.length: number 1 of 2 is [] instead of ['00000003']"),
        ({9: None}, "transfers of s.items: number 3 of 4 is [] instead of ['0063 *']"),
        ({0: "4 x FFFE\n5 x FFFE"}, "transfers of x: number 1 of 2 is ['FFFE'] instead of"),
        ({9: "17 s.items 0063 *\n18 s.items 0000"}, "transfers of s.items: number 4 of 4 is ["),
        ({9: "17 s.items 0063 *\n18 y 00"}, "transfers of leaves that there are not: y"),
        # The right data on another leaf.
        ({0: "4 y FFFE"}, "transfers of x: number 0 of 2 is ['0005'] instead of ['FFFE']"),
    ],
)
def test_transfers(change, output):
    lines = [change.get(number, line) for number, line in enumerate(LINES)]
    with pytest.raises(AssertionError) as caught:
        check([line for line in lines if line is not None])
    assert str(caught.value).startswith(output)


@pytest.mark.parametrize(
    ("got", "output"),
    [
        ("00\n0101\n", "number 1 of 2 is ['0101'] instead of ['01']"),
        ("00\n", "number 1 of 2 is [] instead of ['01']"),
        ("00\n01\n02\n", "number 2 of 2 is ['02'] instead of []"),
        ("00\n01\n\n", "number 2 of 2 is [''] instead of []"),
        ("01\n00\n", "number 0 of 2 is ['01'] instead of ['00']"),
        ("00\n0X\n", "number 1 of 2 is ['0X'] instead of ['01']"),
        ("", "number 0 of 2 is [] instead of ['00']"),
    ],
)
def test_packets(got, output):
    with pytest.raises(AssertionError) as caught:
        _compare("packets", got, "00\n01\n")
    assert str(caught.value) == f"packets: {output}"
    _compare("packets", "00\n01\n", "00\n01\n")
