"""The command `firm-hdl bench`: its output, its files, and its exit status."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from amaranth.hdl import Fragment

from firm_hdl.bench import DEVICES, Device, command, run
from firm_hdl.bench.cycles import Stated
from firm_hdl.bench.results import Converted, read_results
from firm_hdl.bench.run import BenchTask, run_task, run_tasks
from firm_hdl.cli import main
from firm_hdl.jobs import ProgramMissingError
from tests.bench.results import result
from tests.frontend.workspace import make_files

TWIST = "geometry_msgs/msg/Twist"


def bench(*words: str) -> int:
    return main(["bench", *words])


def test_cycles_need_no_tools(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "a.json"
    words = ["--device", "none", "--bus-bytes", "4", "--bus-bytes", "8", "--messages", "3"]
    words += ["--jobs", "1"]
    assert bench(TWIST, *words, "--json", str(file)) == 0
    out = capsys.readouterr().out.splitlines()
    assert [line.split()[:5] for line in out[1:5]] == [
        [TWIST, "cdr", "deserializer", "4", "1.000"],
        [TWIST, "cdr", "serializer", "4", "1.000"],
        [TWIST, "cdr", "deserializer", "8", "1.000"],
        [TWIST, "cdr", "serializer", "8", "1.000"],
    ]
    assert out[5].startswith("simulated with 3 messages, strings of 4 to 10")
    assert [each.cycles.beats for each in read_results(file) if each.cycles] == [39, 39, 21, 21]


def test_a_circuit_is_measured_and_compared(
    ecp5: Device, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, cache = tmp_path / "a.json", tmp_path / "cache"
    words = ["std_msgs/msg/Bool", "--direction", "deserializer", "--seeds", "1"]
    words += ["--cache", str(cache), "--json", str(file)]
    assert bench(*words) == 0
    (first,) = read_results(file)
    assert first.measured is not None and first.measured.device == ecp5
    assert 20 < first.measured.area.lut < 300 and (first.mhz or 0) > 50
    assert len(list(cache.iterdir())) == 1
    text = file.read_text()
    capsys.readouterr()
    # An earlier result with a smaller circuit. The second time, figures are those of the cache.
    found = json.loads(text)
    found["results"][0]["circuit"]["lut"] //= 2
    file.write_text(json.dumps(found))
    assert bench(*words, "--compare", str(file)) == 1
    assert "worse  std_msgs/msg/Bool (lyrical, cdr, 8 bytes) deserializer: LUT" in (
        capsys.readouterr().out
    )
    assert file.read_text() == text


def test_without_tools_nothing_is_measured(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def missing(device: Device, *, with_placer: bool) -> dict[str, str]:
        raise ProgramMissingError(f"nothing is installed for {device.name} {with_placer}")

    monkeypatch.setattr(command, "versions", missing)
    assert bench(TWIST, "--seeds", "") == 1
    assert capsys.readouterr() == ("", "error: nothing is installed for ecp5 False\n")


def test_a_figure_that_is_missing_is_a_failure(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(command, "versions", lambda device, *, with_placer: {})
    monkeypatch.setattr(command, "run_tasks", lambda tasks, jobs: [result(problem="too large")])
    assert bench(TWIST) == 1
    assert "    no figures: too large\n" in capsys.readouterr().out
    monkeypatch.setattr(command, "run_tasks", lambda tasks, jobs: [])
    assert bench(TWIST) == 1


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--seeds", "a", TWIST], "argument --seeds: 'a' is not a number"),
        (["--seeds", "1,-1", TWIST], "argument --seeds: must be from 0 to 2147483647, not -1"),
        (["--device", "abacus", TWIST], "argument --device: invalid choice: 'abacus'"),
    ],
)
def test_wrong_arguments(
    words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        bench(*words)
    assert ended.value.code == 2
    assert f"firm-hdl bench: error: {message}" in capsys.readouterr().err


def test_a_type_that_no_circuit_can_have_is_a_problem_of_its_own(tmp_path: Path) -> None:
    fields = "".join(f"float64 f{number}\n" for number in range(1100))
    make_files(tmp_path, {"p/msg/Wide.msg": fields, "p/msg/Small.msg": "bool x"})
    tasks = [
        BenchTask(
            converter=replace(result(f"p/msg/{name}").converter, direction="serializer"),
            paths=(str(tmp_path),),
            device=None,
        )
        for name in ("Wide", "Missing", "Small")
    ]
    found = [each.problem for each in run_tasks(tasks, 1)]
    assert found[0].startswith("p/msg/Wide: its serializer has 7")
    assert "type 'Missing' is not defined in package 'p'" in found[1]
    assert found[2] == ""


def test_a_task_has_the_figures_of_its_converter(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[object] = []
    plans: list[Any] = []
    cycles, measured = result().cycles, result(problem="").measured
    assert measured is not None

    def count(converter: Any, message: Any, stated: Stated) -> Any:
        seen.append(stated)
        plans.append((type(converter).__name__, converter.plan))
        # Amaranth warns of a component that nothing elaborates.
        Fragment.get(converter, None)
        return cycles

    def measure(rtlil: str, *given: object, **options: object) -> Any:
        seen.append((*given, options))
        assert "attribute \\top 1" in rtlil and "\\src" not in rtlil
        return replace(measured, problem="no room")

    monkeypatch.setattr(run, "count_cycles", count)
    monkeypatch.setattr(run, "measure_once", measure)
    what = Converted(
        distro="noetic",
        type="std_msgs/Bool",
        wire="cdr",
        bus_bytes=2,
        max_message_bytes=777,
        direction="serializer",
    )
    task = BenchTask(
        converter=what,
        device="ice40",
        seeds=(4, 5),
        mapping="tee",
        stated=Stated(count=3),
        cache="c",
    )
    found = run_task(task)
    assert (found.converter, found.cycles, found.problem) == (what, cycles, "no room")
    assert found.measured == replace(measured, problem="no room")
    options = {"mapping": "tee", "folder": Path("c")}
    assert seen == [Stated(count=3), (DEVICES["ice40"], (4, 5), options)]
    ((kind, plan),) = plans
    assert (kind, plan.wire, plan.bus_bytes, plan.max_message_bytes) == (
        "Serializer",
        "cdr",
        2,
        777,
    )
    assert run_task(replace(task, stated=None)).cycles is None
    assert run_task(replace(task, device=None)).measured is None and len(seen) == 4


def test_a_process_that_failed_is_a_problem_of_its_converter(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tasks = [BenchTask(converter=result(name).converter) for name in ("p/msg/A", "p/msg/B")]

    def run_each(work: Any, given: Any, jobs: int) -> Any:
        (one, _), (other, _) = given
        assert (work, jobs) == (run_task, 3)
        yield other, result("p/msg/B")
        yield one, RuntimeError("it was killed")

    monkeypatch.setattr(run, "run_each", run_each)
    found = list(run_tasks(tasks, 3))
    assert [each.converter for each in found] == [tasks[1].converter, tasks[0].converter]
    assert [each.problem for each in found] == ["", "it was killed"]


def test_options_are_those_of_the_tasks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    make_files(tmp_path, {"src/p/msg/A.msg": "q/B b", "more/q/msg/B.msg": "int8 b"})
    src, more = str(tmp_path / "src"), str(tmp_path / "more")
    seen = []
    monkeypatch.setattr(command, "versions", lambda device, *, with_placer: {})

    def run_tasks(tasks: list[object], jobs: int | None) -> list[object]:
        seen.append((tasks, jobs))
        return []

    monkeypatch.setattr(command, "run_tasks", run_tasks)
    words = ["--distro", "humble", "--path", src, "--depends", more, "--wire", "ros1"]
    # A width or a direction that is given twice is one.
    words += ["--bus-bytes", "8", "--bus-bytes", "2", "--bus-bytes", "8", "--seeds", "0,2147483647"]
    words += ["--direction", "serializer", "--direction", "serializer"]
    words += ["--mapping", "tee", "--messages", "1", "--message-seed", "9", "--cache", "c"]
    assert bench("p/A", *words, "--jobs", "3") == 1
    ((tasks, jobs),) = seen
    converter = Converted(
        distro="humble",
        type="p/msg/A",
        wire="ros1",
        bus_bytes=8,
        max_message_bytes=tasks[0].converter.max_message_bytes,
        direction="serializer",
    )
    task = BenchTask(
        converter=converter,
        paths=(src,),
        depends=(more,),
        device="ecp5",
        seeds=(0, 2147483647),
        mapping="tee",
        stated=Stated(count=1, seed=9),
        cache="c",
    )
    other = replace(task, converter=replace(converter, bus_bytes=2))
    assert (tasks, jobs) == ([task, other], 3)
