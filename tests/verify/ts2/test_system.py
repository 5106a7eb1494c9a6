"""TS2: the plans of types are sound and, where golden ones are kept, unchanged."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

from firm_hdl import load_message
from firm_hdl.cli import main
from firm_hdl.export.build import BuildError, plan_of
from firm_hdl.frontend import DEFAULT_DISTRO
from firm_hdl.plan import to_yaml
from firm_hdl.verify.results.file import read_results
from firm_hdl.verify.results.records import Test
from firm_hdl.verify.results.verdict import Failed
from firm_hdl.verify.systems.system import Stopwatch
from firm_hdl.verify.ts2 import golden
from firm_hdl.verify.ts2 import system as ts2
from tests.frontend.workspace import make_files
from tests.verify.judged import assert_passed

GOLDEN = Path(__file__).parents[1] / "golden"


def checked(name, distro=DEFAULT_DISTRO, *, wire=None, bus_bytes=8):
    test = Test(system="ts2", distro=distro, type=name, bus_bytes=bus_bytes)
    return ts2.check_plan(load_message(name, distro=distro), test, wire, Stopwatch())


@pytest.mark.parametrize("bus_bytes", [1, 8, 64])
def test_plans_of_real_types_are_sound(bus_bytes):
    for name in ("sensor_msgs/msg/Imu", "rcl_interfaces/msg/ParameterEvent", "std_msgs/msg/Empty"):
        found = checked(name, bus_bytes=bus_bytes)
        assert assert_passed(found) == 1
        assert found.metrics["steps"] > 0


def test_a_plan_that_breaks_an_invariant_is_found(monkeypatch):
    def misaligned(*arguments):
        plan = plan_of(*arguments)
        return replace(plan, steps=tuple(replace(step, align=1) for step in plan.steps))

    monkeypatch.setattr(ts2, "plan_of", misaligned)
    (problem, *_) = checked("sensor_msgs/msg/JointState").verdict.failures
    assert "bytes of padding before it" in problem


def test_a_printed_form_that_loses_something_is_found(monkeypatch):
    monkeypatch.setattr(ts2, "to_yaml", lambda plan: to_yaml(replace(plan, message="x/y")))
    found = checked("std_msgs/msg/Int8")
    assert found.verdict == Failed(("the plan in YAML, read back, is another one",))


def test_types_are_planned_for_either_wire():
    assert_passed(checked("sensor_msgs/msg/Imu", wire="ros1"))
    assert_passed(checked("sensor_msgs/Imu", "noetic", wire="cdr"))


@pytest.mark.snapshot
def test_the_command_counts_types_and_compares_golden_plans(capsys):
    arguments = ["verify", "--systems", "ts2", "--distro", "lyrical", "--golden", str(GOLDEN)]
    assert main([*arguments, "sensor_msgs/msg/Imu", "sensor_msgs/msg/Joy"]) == 0
    assert capsys.readouterr().out == (
        "lyrical     2 of    2 plans are sound (8-byte bus)\n"
        "2 different circuits\n"
        "golden plans: 1 compared, 0 differ\n"
    )


@pytest.mark.snapshot
def test_a_golden_plan_that_differs_fails_the_run(tmp_path, capsys):
    path = tmp_path / "lyrical" / "imu.yaml"
    path.parent.mkdir()
    text = (GOLDEN / "lyrical" / "sensor_msgs_msg_Imu_cdr_8.yaml").read_text()
    path.write_text(text.replace("align: 8", "align: 4"))
    arguments = ["verify", "--systems", "ts2", "--distro", "lyrical", "--golden", str(tmp_path)]
    assert main([*arguments, "sensor_msgs/msg/Imu"]) == 1
    out = capsys.readouterr().out
    assert "steps[orientation.x].align: 4 -> 8" in out
    assert out.endswith("golden plans: 1 compared, 1 differ\n")


def test_a_folder_that_has_no_plans_is_an_error(tmp_path, capsys):
    (tmp_path / "mars").mkdir()
    (tmp_path / "mars" / "x.yaml").write_text("")
    arguments = ["verify", "--systems", "ts2", "--golden", str(tmp_path), "std_msgs/msg/Int8"]
    assert main(arguments) == 1
    assert "is not below a distribution's name" in capsys.readouterr().err


def test_plans_are_counted_by_bus_and_only_if_they_are_judged(tmp_path, monkeypatch, capsys):
    """Of three types, one cannot be judged, and one has no plan for the wider bus."""

    def narrow(message, wire, bus_bytes, most):
        if message.name == "p/msg/B" and bus_bytes == 8:
            raise BuildError("too wide for B")
        return plan_of(message, wire, bus_bytes, most)

    monkeypatch.setattr(ts2, "plan_of", narrow)
    wide = "module p { module msg { struct C { long double x; }; }; };"
    texts = {"p/msg/A.msg": "int8 x\n", "p/msg/B.msg": "string s\n", "p/msg/C.idl": wide}
    source = str(make_files(tmp_path, texts))
    call = ["verify", "--systems", "ts2", "--all", "--path", source, "--jobs", "1"]
    assert main([*call, "--bus-bytes", "2", "--bus-bytes", "8"]) == 1
    out = capsys.readouterr().out
    assert (
        "lyrical     2 of    2 plans are sound (2-byte bus)\n"
        "lyrical     1 of    2 plans are sound (8-byte bus)\n"
        "2 of 6 plans not judged\n"
        "3 different circuits\n"
    ) in out
    assert "FAIL p/msg/B (lyrical), 8-byte bus\n    too wide for B\n" in out


def test_golden_plans_are_those_of_the_types_and_distributions_asked_for(
    tmp_path, monkeypatch, capsys
):
    folder, path = str(tmp_path / "golden"), str(tmp_path / "r.jsonl")
    for distro, name, width in (
        ("noetic", "std_msgs/String", "8"),
        ("lyrical", "std_msgs/msg/String", "8"),
        ("lyrical", "std_msgs/msg/String", "4"),
        # Not asked for: another type, and another distribution.
        ("lyrical", "std_msgs/msg/Int8", "8"),
        ("humble", "std_msgs/msg/String", "8"),
    ):
        options = ["--distro", distro, "--bus-bytes", width]
        assert main(["golden", "add", folder, name, *options]) == 0
    compared = []

    def noting(goldens, *more, **options):
        compared.extend((each.distro, each.plan.bus_bytes) for each in goldens)
        return golden.check_golden(goldens, *more, **options)

    monkeypatch.setattr(ts2, "check_golden", noting)
    call = ["verify", "--systems", "ts2", "--golden", folder, "--results", path, "--jobs", "1"]
    call += ["--distro", "noetic", "--distro", "lyrical", "std_msgs/msg/String"]
    for _ in range(2):
        capsys.readouterr()
        assert main(call) == 0
        assert "golden plans: 3 compared, 0 differ\n" in capsys.readouterr().out
        # The second run has all results in its file.
        assert sorted(compared) == [("lyrical", 4), ("lyrical", 8), ("noetic", 8)]
    assert len(read_results(path).records) == 2 + 3


def test_golden_plans_of_own_types_are_compared_with_their_folder(tmp_path, capsys):
    own = ["--path", str(make_files(tmp_path / "src", {"p/msg/A.msg": "int8 x\n"}))]
    folder = str(tmp_path / "golden")
    assert main(["golden", "add", folder, "p/msg/A", *own]) == 0
    call = ["verify", "--systems", "ts2", "--golden", folder, "p/msg/A", *own, "--jobs", "1"]
    assert main(call) == 0
    make_files(tmp_path / "src", {"p/msg/A.msg": "int16 x\n"})
    # The library of a folder is read once in a process.
    ts2.library_of.__globals__["_opened"].cache_clear()
    assert main(call) == 1
    out = capsys.readouterr().out
    assert "golden plans: 1 compared, 1 differ\n" in out
    (path,) = (tmp_path / "golden").glob("*/*.yaml")
    assert f"FAIL {path}\n    leaves.x: int8 -> int16\n" in out


def test_two_golden_plans_of_one_type_have_results_of_their_own(tmp_path, capsys):
    """They differ by their largest message; one of them is not that of today."""
    folder, path = tmp_path / "golden", str(tmp_path / "r.jsonl")
    small, name = ["--max-message-bytes", "999"], "std_msgs/msg/String"
    assert main(["golden", "add", str(folder), name, *small]) == 0
    (first,) = folder.glob("*/*.yaml")
    second = first.rename(first.with_name("small.yaml"))
    assert main(["golden", "add", str(folder), name]) == 0
    second.write_text(re.sub(r"limit: \d+", "limit: 9", second.read_text()))
    call = ["verify", "--systems", "ts2", "--distro", "lyrical", "--golden", str(folder)]
    call += ["--jobs", "1", "--results", path, name]
    for _ in range(2):
        capsys.readouterr()
        assert main(call) == 1
        assert "golden plans: 2 compared, 1 differ\n" in capsys.readouterr().out
    records = read_results(path).records.values()
    found = {each.test.options: each.verdict.name for each in records if each.test.options}
    assert found == {f"golden={first}": "passed", f"golden={second}": "failed"}


def test_the_time_of_the_checks_is_not_that_of_the_plan(monkeypatch):
    watch, entered = Stopwatch(), []
    monkeypatch.setattr(watch, "enter", entered.append)
    test = Test(system="ts2", distro="lyrical", type="std_msgs/msg/Int8", bus_bytes=8)
    seen = {}

    def noting(name, work):
        def noted(*given):
            seen[name] = list(entered)
            return work(*given)

        return noted

    monkeypatch.setattr(ts2, "plan_of", noting("plan", plan_of))
    monkeypatch.setattr(ts2, "check", noting("check", ts2.check))
    ts2.check_plan(load_message(test.type), test, None, watch)
    assert seen == {"plan": [], "check": ["testing"]}
