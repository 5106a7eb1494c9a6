"""Generated benches of many types, run in GHDL and compared with rosbags."""

from __future__ import annotations

import re

import pytest

import firm_hdl.verify.bench.run as benches
import firm_hdl.verify.references.choice as references
from firm_hdl.cli import main
from firm_hdl.export.vhdl.bench import RUN_SCRIPT
from firm_hdl.frontend import Library
from firm_hdl.verify.bench import system
from firm_hdl.verify.bench.system import Benches, _lines_of, _table
from firm_hdl.verify.references.clients import client
from firm_hdl.verify.results.file import read_results
from firm_hdl.verify.results.records import Record, Seconds, Test
from firm_hdl.verify.results.verdict import Failed, NotJudged, Passed
from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.systems.system import Recorder
from firm_hdl.verify.systems.tasks import TypeUnderTest, collect_tasks
from tests.depth import THOROUGH
from tests.tools import need
from tests.verify.judged import assert_passed
from tests.verify.samples import own_package

HEADER = "std_msgs/msg/Header"
# It has one bench, without the record view.
STRING = "std_msgs/msg/String"


def run_bench(ghdl, name, distro="lyrical", bus_bytes=8, **options):
    test = Test(system="bench", distro=distro, type=name, bus_bytes=bus_bytes)
    return benches.run_bench((Request(**options), ghdl), test)


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
    ("lyrical", "shape_msgs/msg/SolidPrimitive", 2),
]


@pytest.mark.parametrize(("distro", "name", "bus_bytes"), SAMPLE)
def test_bench_passes_with_the_bytes_and_transfers_of_rosbags(ghdl, distro, name, bus_bytes):
    result = run_bench(ghdl, name, distro, bus_bytes)
    assert assert_passed(result) == result.packets >= 3
    assert result.metrics["transfers"] >= result.packets


@pytest.mark.parametrize("name", [thorough("own_msgs/msg/Deep"), "own_msgs/srv/Ask_Response"])
def test_types_of_ones_own_pass_as_well(ghdl, tmp_path, name):
    result = run_bench(ghdl, name, paths=(str(own_package(tmp_path)),))
    assert assert_passed(result) == result.packets


def wide(folder, ghdl):
    """Run the bench of a type with wide text."""
    own_package(folder)
    (folder / "own_msgs" / "msg" / "Wide.msg").write_text("wstring[] text\nuint8 x\n")
    return run_bench(ghdl, "own_msgs/msg/Wide", paths=(str(folder),))


def test_wide_text_is_not_judged_without_a_reference(ghdl, tmp_path, monkeypatch):
    monkeypatch.setattr(references, "usable_references", lambda wanted=None: ())
    result = wide(tmp_path, ghdl)
    assert result.verdict == NotJudged("rosbags has no wstring, which own_msgs/msg/Wide.text is")


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
@pytest.mark.sampled(2)
def test_faults_are_found(ghdl, monkeypatch, file, before, after, output):
    change(monkeypatch, file, before, after)
    result = run_bench(ghdl, HEADER)
    (failure,) = result.verdict.failures
    assert output in failure
    assert not result.packets


def test_bench_of_the_record_view_is_run_as_well(ghdl, monkeypatch):
    both = run_bench(ghdl, "geometry_msgs/msg/Vector3")
    assert assert_passed(both) == both.packets
    if THOROUGH:
        assert assert_passed(run_bench(ghdl, HEADER))
    # Three leaves, in the first bench; each packet is sent in both.
    assert 2 * both.metrics["transfers"] == 3 * both.packets
    change(monkeypatch, "8_serializer_record.vhd", "<= to_slv(msg", "<= not to_slv(msg")
    (failure,) = run_bench(ghdl, "geometry_msgs/msg/Vector3").verdict.failures
    assert "FAIL packet 0" in failure


def test_table_and_status_have_failures_and_the_command_to_repeat(ghdl, monkeypatch, capsys):
    tasks = collect_tasks(["lyrical"], [STRING])
    (found,) = Benches(tasks, Request(jobs=1)).run(Recorder())
    assert_passed(found)
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert rows[0][:4] == ["8-byte", "bus", "types", "pass"]
    assert rows[1][:5] == ["lyrical", "1", "1", "0", "0"]
    change(monkeypatch, "_serializer_flat.vhd", "m_axis_tdata <= ", "m_axis_tdata <= not ")
    (found,) = Benches(tasks, Request(wire="ros1", widths=(4,), jobs=1)).run(Recorder())
    assert isinstance(found.verdict, Failed)
    output = capsys.readouterr().out
    assert f"FAIL {STRING} (lyrical)\n" in output
    again = "firm-hdl verify --systems bench --distro lyrical --wire ros1 --bus-bytes 4"
    assert f"again: {again} {STRING}\n" in output


def test_each_distribution_has_a_row_with_its_own_sums(capsys):
    def record(distro, verdict, packets):
        test = Test(system="bench", distro=distro, type=f"p/T{packets}")
        figures = {"transfers": 10.0 * packets}
        seconds = Seconds(simulation=packets)
        return Record(test=test, verdict=verdict, packets=packets, metrics=figures, seconds=seconds)

    records = [
        record("lyrical", Passed(1), 1),
        record("lyrical", Passed(1), 2),
        record("noetic", Passed(1), 3),
        record("lyrical", Failed(("no",)), 4),
        record("noetic", NotJudged("nobody knows"), 5),
        record("noetic", NotJudged("nobody knows"), 6),
    ]
    _table(records, "4-byte bus")
    assert [line.split()[-8:] for line in capsys.readouterr().out.splitlines()[1:]] == [
        ["noetic", "3", "1", "0", "2", "14", "140", "14"],
        ["lyrical", "3", "2", "1", "0", "7", "70", "7"],
    ]
    assert [len(_lines_of(each)) for each in records] == [0, 0, 0, 1, 0, 0]


def test_each_distribution_and_each_bus_has_a_bench(monkeypatch):
    monkeypatch.setattr(system, "find_ghdl", lambda: "ghdl")
    task = TypeUnderTest(distro="jazzy", name="p/A", same=("humble", "jazzy"))
    tests = Benches([task], Request(widths=(2, 8))).tests
    assert [(test.distro, test.same, test.bus_bytes, test.simulator) for test in tests] == [
        (name, (name,), width, "ghdl") for width in (2, 8) for name in ("humble", "jazzy")
    ]


def test_each_bus_is_run_by_itself_with_the_options_of_the_user(monkeypatch, capsys):
    asked = []

    def run_tests(work, context, tests, command, lines_of, **options):
        asked.append((context, [test.bus_bytes for test in tests], options))
        for test in tests:
            verdict = Passed(3) if test.distro == "humble" else Failed(("no", "not at all"))
            seconds = Seconds(simulation=1.6)
            record = Record(test=test, verdict=verdict, packets=3, seconds=seconds)
            yield [(test, record, lines_of(record))]

    monkeypatch.setattr(system, "find_ghdl", lambda: "own-ghdl")
    monkeypatch.setattr(system, "version_of", lambda path: f"the version of {path}")
    monkeypatch.setattr(system, "run_tests", run_tests)
    task = TypeUnderTest(distro="jazzy", name="p/A", same=("humble", "jazzy"))
    request = Request(widths=(2, 8), jobs=5)
    benches = Benches([task], request)
    assert benches.options == {"ghdl": "the version of own-ghdl"}
    found = benches.run(Recorder())
    assert asked == [((request, "own-ghdl"), [n, n], {"jobs": 5}) for n in (2, 8)]
    assert [(each.what, each.verdict.name) for each in found] == [
        (f"p/A ({distro}), bench, {width}-byte bus", name)
        for width in (2, 8)
        for distro, name in (("humble", "passed"), ("jazzy", "failed"))
    ]
    lines = capsys.readouterr().out.splitlines()
    titles = [line[:10] for line in lines if "types" in line]
    assert titles == ["2-byte bus", "8-byte bus"]
    rows = [line.split() for line in lines if line.startswith(("humble", "jazzy"))]
    one = [
        ["humble", "1", "1", "0", "0", "3", "0", "2"],
        ["jazzy", "1", "0", "1", "0", "3", "0", "2"],
    ]
    assert rows == one * 2


def test_a_long_failure_is_shortened_and_the_first_one_is_printed():
    test = Test(system="bench", distro="jazzy", type="p/A")
    texts = ("x" * 1999 + "yz", "another")
    (text,) = _lines_of(Record(test=test, verdict=Failed(texts), command="the command"))
    assert text == f"FAIL p/A (jazzy)\n    {'x' * 1999}y\n    again: the command"


def test_results_are_kept_and_not_repeated(ghdl, tmp_path, monkeypatch, capsys):
    file = tmp_path / "r.jsonl"
    names = ["std_msgs/msg/Empty", STRING]
    call = ["verify", "--systems", "bench", "--distro", "lyrical", "--jobs", "1", *names]
    call += ["--results", str(file)]
    assert main(call) == 0
    first = read_results(file)
    tests = [record.test for record in first.records.values()]
    assert sorted(test.type for test in tests) == names
    assert {(t.distro, t.same, t.wire, t.bus_bytes) for t in tests} == {
        ("lyrical", ("lyrical",), "cdr", 8)
    }
    assert all(record.packets and record.seconds.simulation for record in first.records.values())
    lines = file.read_text().splitlines(keepends=True)
    (last,) = [line for line in lines if "std_msgs/msg/Empty" in line and '"record"' in line]
    file.write_text("".join(line for line in lines if line != last))
    change(monkeypatch, "_serializer_flat.vhd", "m_axis_tdata <= ", "m_axis_tdata <= not ")
    assert main(call) == 1
    verdicts = {r.test.type: r.verdict.name for r in read_results(file).records.values()}
    assert verdicts == dict(zip(names, ("failed", "passed"), strict=True))
    assert "1 of 2 types" in capsys.readouterr().out
    # The verdicts of this GHDL are not those of another one.
    other = tmp_path / "other-ghdl"
    other.write_text(f'#!/bin/sh\n[ "$1" = --version ] && exec echo other\nexec {ghdl} "$@"\n')
    other.chmod(0o755)
    monkeypatch.setenv("GHDL", str(other))
    assert main(call) == 1
    assert re.search(r'ghdl was "GHDL \d.*", and is "other"', capsys.readouterr().err)
