"""What `firm-hdl bench` measures and prints if nothing is said, and which types it takes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from firm_hdl.bench import command, run
from firm_hdl.bench.cycles import STATED
from firm_hdl.bench.results import Result
from firm_hdl.bench.run import BenchTask
from firm_hdl.cli import main
from firm_hdl.errors import UserError
from tests.bench.results import result
from tests.frontend.recordings import make_recording
from tests.frontend.workspace import make_files

BOOL = "std_msgs/msg/Bool"


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """What the command asks for; it gets the entry `results`."""
    seen: dict[str, Any] = {"results": [result()]}

    def run_tasks(tasks: Sequence[BenchTask], jobs: int | None) -> list[Result]:
        seen.update(tasks=tasks, jobs=jobs)
        return list(seen["results"])

    monkeypatch.setattr(command, "versions", lambda device, *, with_placer: {})
    monkeypatch.setattr(command, "run_tasks", run_tasks)
    return seen


def test_both_converters_are_measured_with_three_seeds(asked: dict[str, Any]) -> None:
    assert main(["bench", BOOL, "--jobs", "3"]) == 0
    converter = asked["tasks"][0].converter
    assert [task.converter for task in asked["tasks"]] == [
        replace(converter, direction="deserializer"),
        replace(converter, direction="serializer"),
    ]
    assert (converter.type, converter.distro, converter.wire, converter.bus_bytes) == (
        BOOL,
        "lyrical",
        "cdr",
        8,
    )
    for task in asked["tasks"]:
        assert task == BenchTask(
            converter=task.converter, device="ecp5", seeds=(1, 2, 3), mapping="", stated=STATED
        )
    assert asked["jobs"] == 3
    # One task needs no other process.
    assert main(["bench", BOOL, "--direction", "serializer", "--jobs", "3"]) == 0
    assert asked["jobs"] == 1


@pytest.mark.parametrize("words", [["--seeds", "2147483648"], ["--message-seed", "-1"]])
def test_numbers_out_of_range_are_refused(words: list[str], asked: dict[str, Any]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["bench", BOOL, *words])
    assert ended.value.code == 2 and "tasks" not in asked


@pytest.mark.parametrize(("lut", "status"), [(102, 0), (103, 1)])
def test_two_percent_more_are_not_worse(
    lut: int, status: int, asked: dict[str, Any], tmp_path: Path
) -> None:
    file = tmp_path / "old.json"
    assert main(["bench", BOOL, "--json", str(file)]) == 0
    asked["results"] = [result(lut=lut)]
    assert main(["bench", BOOL, "--compare", str(file)]) == status


def test_all_are_the_types_of_the_folders_listed_without_paths(
    asked: dict[str, Any], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = {
        "src/p/msg/A.msg": "q/B b\n",
        "src/p/srv/S.srv": "---\n",
        "more/q/msg/B.msg": "int8 c\n",
    }
    src, more = (str(make_files(tmp_path, files) / name) for name in ("src", "more"))
    words = ["--distro", "humble", "--path", src, "--depends", more]
    assert main(["bench", "--all", *words]) == 0
    # Neither types of the distribution, nor those on which others depend.
    names = ["p/msg/A", "p/srv/S_Request", "p/srv/S_Response"]
    assert [task.converter.type for task in asked["tasks"]] == [n for n in names for _ in "rw"]
    for task in asked["tasks"]:
        assert (task.paths, task.bags, task.depends) == ((src,), (), (more,))
        assert task.converter.distro == "humble"
    assert "12.5 ns" not in capsys.readouterr().out
    assert main(["bench", "q/B", *words]) == 0
    assert [task.converter.type for task in asked["tasks"]] == ["q/msg/B"] * 2
    assert "    12.5 ns, 8.0 of them routing" in capsys.readouterr().out


def test_all_of_a_recording_are_its_types(asked: dict[str, Any], tmp_path: Path) -> None:
    bag = str(make_recording(tmp_path, "bag"))
    assert main(["bench", "--all", "--bag", bag, "--direction", "serializer"]) == 0
    assert {(task.converter.distro, task.bags) for task in asked["tasks"]} == {("noetic", (bag,))}
    assert sorted(task.converter.type for task in asked["tasks"]) == [
        "my_msgs/Spot",
        "my_msgs/Wheel",
        "std_msgs/Header",
        "std_msgs/String",
    ]


def test_a_folder_without_types_has_no_figures(asked: dict[str, Any], tmp_path: Path) -> None:
    asked["results"] = []
    assert main(["bench", "--all", "--path", str(tmp_path)]) == 1
    assert asked["tasks"] == []


def test_a_task_takes_its_type_from_its_own_folders(monkeypatch: pytest.MonkeyPatch) -> None:
    def open_library(*origins: object, depends: object) -> object:
        raise UserError(f"only {origins}, {depends}")

    monkeypatch.setattr(run, "open_library", open_library)
    task = BenchTask(converter=result().converter, paths=("a",), bags=("b",), depends=("c",))
    assert run.run_task(task).problem == "only ('lyrical', ('a',), ('b',)), ('c',)"
