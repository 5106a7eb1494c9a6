"""TS2: the plans of types are sound and, where golden ones are kept, unchanged."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from firm_hdl import load_message
from firm_hdl.cli import main
from firm_hdl.export.build import plan_of
from firm_hdl.frontend import DEFAULT_DISTRO
from firm_hdl.plan.tree import Step
from firm_hdl.verify.results.records import Test
from firm_hdl.verify.systems.system import Trial
from firm_hdl.verify.ts2 import system as ts2
from tests.frontend.workspace import make_files
from tests.verify.judged import assert_passed

GOLDEN = Path(__file__).parents[1] / "golden"


def checked(name, distro=DEFAULT_DISTRO, *, wire=None, bus_bytes=8):
    test = Test(system="ts2", distro=distro, type=name, bus_bytes=bus_bytes)
    message = load_message(name, distro=distro)
    with Trial.of(test) as trial:
        ts2.check_plan(message, wire, trial)
    return trial.end()


@pytest.mark.parametrize("bus_bytes", [1, 8, 64])
def test_plans_of_real_types_are_sound(bus_bytes):
    for name in ("sensor_msgs/msg/Imu", "rcl_interfaces/msg/ParameterEvent", "std_msgs/msg/Empty"):
        found = checked(name, bus_bytes=bus_bytes)
        assert assert_passed(found) == 1
        assert found.metrics["steps"] > 0


def test_a_plan_that_breaks_an_invariant_is_found(monkeypatch):
    def misaligned(*arguments):
        plan = plan_of(*arguments)
        steps = (replace(i, align=1) if isinstance(i, Step) else i for i in plan.items)
        return replace(plan, items=tuple(steps))

    monkeypatch.setattr(ts2, "plan_of", misaligned)
    (problem, *_) = checked("sensor_msgs/msg/JointState").verdict.failures
    assert "bytes of padding before it" in problem


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
    assert "plan[orientation.x].align: 4 -> 8" in out
    assert out.endswith("golden plans: 1 compared, 1 differ\n")


def test_a_folder_that_has_no_plans_is_an_error(tmp_path, capsys):
    (tmp_path / "mars").mkdir()
    (tmp_path / "mars" / "x.yaml").write_text("")
    arguments = ["verify", "--systems", "ts2", "--golden", str(tmp_path), "std_msgs/msg/Int8"]
    assert main(arguments) == 1
    assert "is not below a distribution's name" in capsys.readouterr().err


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
