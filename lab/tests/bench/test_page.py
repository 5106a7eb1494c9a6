"""The page of figures, its plots, and their update by `make -C lab bench`."""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace
from pathlib import Path

import pytest

from firm_hdl.bench.results import Result, read_results
from firm_hdl.bench.run import BenchTask
from lab.bench import __main__ as bench
from lab.bench.parts import PARTS, PartResult
from lab.bench.software import Compared
from lab.bench.software.sample import Timed
from lab.bench.standard import MEASURED, covering_group, group_tasks
from tests.bench.results import result

ROOT = Path(__file__).parents[3]
COVERING = ROOT / "tests" / "verify" / "covering"
SVG = "{http://www.w3.org/2000/svg}"


def parse_svg(text: str) -> ElementTree.Element:
    root = ElementTree.fromstring(text)
    assert root.tag == f"{SVG}svg"
    return root


@pytest.fixture
def page_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a copy of the page; measurements give invented figures."""
    (tmp_path / "page.md").write_text((ROOT / "lab" / "notes" / "performance.md").read_text())

    def run(tasks: Sequence[BenchTask], jobs: int | None) -> Iterator[Result]:
        assert jobs == 3
        assert {task.cache for task in tasks} == {"build/bench" if tasks[0].device else None}
        for task in reversed(tasks):
            found = result(mhz=tuple(80.0 + seed for seed in task.seeds))
            yield replace(
                found if task.device else replace(found, measured=None), converter=task.converter
            )

    def run_parts(*, cache: str | None, jobs: int | None) -> Iterator[PartResult]:
        assert (cache, jobs) == ("build/bench", 3)
        yield from (PartResult(part=part, measured=result().measured) for part in reversed(PARTS))

    monkeypatch.setattr(bench, "run_tasks", run)
    monkeypatch.setattr(bench, "run_parts", run_parts)
    monkeypatch.setattr(bench, "versions", lambda device: {})
    monkeypatch.setattr(bench, "library_versions", lambda: {"rosbags": {"rosbags": "0.11"}})
    monkeypatch.setattr(bench, "compare_software", compare_libraries)
    return tmp_path


def compare_libraries(task: BenchTask, results: Sequence[Result]) -> Compared:
    assert {each.converter.type for each in results} == {task.converter.type}
    return Compared(
        bytes=100.0,
        times={"rosbags": Timed(deserialize=1000.0, serialize=50.0)},
        missing={"genpy": "it is not here"},
        results=tuple(results),
    )


def run_bench(page_folder: Path, *words: str) -> int:
    where = ["--page", str(page_folder / "page.md"), "--figures", str(page_folder / "figures")]
    where += ["--covering", str(COVERING)]
    where += ["--estimates", str(page_folder / "e.json"), "--jobs", "3"]
    return bench.main([*where, *words])


@pytest.mark.thorough
def test_all_parts_of_the_page_are_written(
    page_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_bench(page_folder) == 0
    text = (page_folder / "page.md").read_text()
    for name in bench.GROUPS:
        assert len(text.split(f"<!-- {name} -->")[1].split("<!-- end")[0]) > 100
    assert "| sensor_msgs/msg/Imu | cdr | 8 | serializer | 100 | 50 |" in text
    assert "| sensor_msgs/Imu | ros1 | 100 | serializer | 50 (16.0) |  |  | 40 (7.50) |" in text
    assert "* rosbags: rosbags 0.11\n" in text
    files = {file.name for file in (page_folder / "figures").iterdir()}
    assert files == {
        "bench_area.svg",
        "bench_beats.svg",
        "bench_clock.svg",
        "covering.json",
        "parts.json",
        "performance.json",
    }
    # The plots that the page shows exist.
    assert all(f"figures/{name}" in text for name in files if name.endswith(".svg"))
    marks = {
        "covering": "| Converters | Number | 156.25 MHz or more |",
        "devices": "| Device | Type |",
        "narrow": "| Type | Wire | Bus |",
    }
    for name, heading in marks.items():
        assert text.split(f"<!-- {name} -->\n\n")[1].startswith(heading)
    assert text.split("<!-- software -->")[1].split("<!-- end")[0].count("\n|") == 2 + 2 * 21
    check_kept(page_folder)
    entries = json.loads((page_folder / "e.json").read_text())
    assert {entry["bus_bytes"] for entry in entries} == {1, 2, 4, 8}
    assert {entry["part"] for entry in entries} == {"ECP5 LFE5U-45F-8"}
    # All invented results name one device, so they replace those of other devices.
    assert "figures changed" not in capsys.readouterr().out
    assert run_bench(page_folder) == 0
    assert (page_folder / "page.md").read_text() == text
    assert "0 figures changed by more than 2 %" in capsys.readouterr().out
    check_kept(page_folder)


def check_kept(page_folder: Path) -> None:
    """Check that each file of figures has those of its groups, once for each group.

    All invented results name one device, so converters on several devices count once, too.
    """
    for file, groups in (
        (bench.KEPT, list(MEASURED.values())),
        (bench.KEPT_COVERING, [covering_group(COVERING)]),
    ):
        found = [str(each.converter) for each in read_results(page_folder / "figures" / file)]
        names = [{str(task.converter) for task in group_tasks(group)} for group in groups]
        assert sorted(found) == sorted(name for each in names for name in each)


def test_one_part_leaves_the_others_alone(page_folder: Path) -> None:
    before = (page_folder / "page.md").read_text()
    assert run_bench(page_folder, "--group", "narrow") == 0
    after = (page_folder / "page.md").read_text()
    head, marks, tail = before.partition("<!-- narrow -->")
    assert marks and after.startswith(head)
    assert after.endswith(tail.partition("<!-- end narrow: made with -->")[2])
    assert [file.name for file in (page_folder / "figures").iterdir()] == ["performance.json"]
    assert len(read_results(page_folder / "figures" / "performance.json")) == 24
    assert run_bench(page_folder, "--group", "figures") == 0
    assert len(read_results(page_folder / "figures" / "performance.json")) == 24 + 22


def test_without_all_figures_nothing_is_written(
    page_folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    before = (page_folder / "page.md").read_text()
    monkeypatch.setattr(bench, "run_tasks", lambda tasks, jobs: [result(problem="too large")])
    assert run_bench(page_folder, "--group", "narrow") == 1
    assert "p/msg/A (lyrical, cdr, 8 bytes) deserializer: too large" in capsys.readouterr().err
    assert (page_folder / "page.md").read_text() == before
    assert not (page_folder / "e.json").exists()


def test_the_committed_page_has_all_parts_and_plots() -> None:
    text = (ROOT / "lab" / "notes" / "performance.md").read_text()
    groups = [*MEASURED, "covering"]
    for name in [*groups, *(f"{name}: made with" for name in groups), "beats", "parts"]:
        part = text.split(f"<!-- {name} -->\n")[1].split(f"<!-- end {name} -->")[0]
        assert part.count("\n| ") > 4 or part.count("\n* ") > 0, name
    plots = re.findall(r"\]\((figures/\w+\.svg)\)", text)
    assert len(plots) == 3
    for plot in plots:
        parse_svg((ROOT / "lab" / "notes" / plot).read_text())
    figures = ROOT / "lab" / "notes" / "figures"
    for file, groups_of_file in (
        (bench.KEPT, list(MEASURED.values())),
        (bench.KEPT_COVERING, [covering_group(COVERING)]),
    ):
        kept = read_results(figures / file)
        expected = {
            (*map(str, asdict(task.converter).values()), task.device)
            for group in groups_of_file
            for task in group_tasks(group)
        }
        found = {each.key for each in kept}
        assert found <= expected
        # This type has joined the covering set since then. The next run of the page measures it.
        assert {key for key in expected - found if "sensor_msgs/CameraInfo" not in key} == set()
        assert not any(each.problem for each in kept)
