"""The page of figures, its plots, and their update by `make bench`."""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, replace
from pathlib import Path

import pytest

from firm_hdl.bench import BenchError
from firm_hdl.bench import __main__ as bench
from firm_hdl.bench.page import (
    area_table,
    beats_table,
    below_table,
    converter_table,
    covering_table,
    made_with,
    path_list,
    write_page,
)
from firm_hdl.bench.parts import PARTS, PartResult
from firm_hdl.bench.plots import area_plot, beats_plot, clock_plot
from firm_hdl.bench.results import Result, read_results
from firm_hdl.bench.run import BenchTask
from firm_hdl.bench.software import Compared
from firm_hdl.bench.software.sample import Timed
from firm_hdl.bench.standard import ALL_TYPES, MEASURED, Group, covering_group, group_tasks
from firm_hdl.jobs import ProgramMissingError
from tests.bench.results import result

ROOT = Path(__file__).parents[2]
COVERING = ROOT / "tests" / "verify" / "covering"
SVG = "{http://www.w3.org/2000/svg}"


def test_parts_of_a_page_are_replaced_and_the_rest_stays(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("# A\n\n<!-- b -->\nold\n<!-- end b -->\n\nmore\n<!-- c -->\n<!-- end c -->\n")
    write_page(page, {"b": "new \\1\n", "c": "1\n"})
    text = "# A\n\n<!-- b -->\n\nnew \\1\n\n<!-- end b -->\n"
    text += "\nmore\n<!-- c -->\n\n1\n\n<!-- end c -->\n"
    assert page.read_text() == text
    write_page(page, {"b": "new \\1\n"})
    assert page.read_text() == text
    with pytest.raises(BenchError, match=r"page\.md' has not one part 'd'$"):
        write_page(page, {"b": "newer\n", "d": ""})
    assert page.read_text() == text
    page.write_text(twice := text + "<!-- b -->\n<!-- end b -->\n")
    with pytest.raises(BenchError, match=r"page\.md' has not one part 'b'$"):
        write_page(page, {"b": "newer\n"})
    assert page.read_text() == twice


def test_tables_have_the_figures() -> None:
    ser = result(direction="serializer", lut=1234, mhz=(99.0,))
    assert converter_table([result(), ser]).splitlines()[2:] == [
        "| p/msg/A | cdr | 8 | deserializer | 100 | 50 | 0 | 0 | 82.5 (80, 90, 82) | 0.800 | 2 | "
        "3.96 |",
        "| p/msg/A | cdr | 8 | serializer | 1,234 | 50 | 0 | 0 | 99.0 | 0.800 | 2 | 4.75 |",
    ]
    assert area_table([ser]).splitlines()[2:] == [
        "| ECP5 LFE5U-45F-8 | p/msg/A | serializer | 1,234 | 50 | 0 | 0 | 99.0 |"
    ]
    assert area_table([result(mhz=(80.0, 90.0))]).splitlines()[2].endswith("| 85.0 (80, 90) |")
    bare = replace(result(), measured=None, cycles=None)
    assert converter_table([bare]).splitlines()[2].count("|") == 13
    assert area_table([bare]).count("\n") == 2
    not_placed = result(mhz=())
    assert path_list([result(), not_placed, bare]) == (
        "* `p/msg/A` cdr deserializer: `12.5 ns, 8.0 of them routing, 9 cells: step 0.5 > & fill, "
        "offset 12.0 > run 12.5`\n"
    )
    assert made_with([result(), ser, result(mhz=(1.0, 2.0, 3.0)), bare]) == (
        "* ECP5 LFE5U-45F-8: Yosys 0.70, nextpnr-ecp5 0.11.1; `synth_ecp5 -top top`; `--45k`; "
        "seeds 1 (1 converters)\n"
        "* ECP5 LFE5U-45F-8: Yosys 0.70, nextpnr-ecp5 0.11.1; `synth_ecp5 -top top`; `--45k`; "
        "seeds 1, 2, 3 (2 converters)\n"
    )


def test_the_mean_of_beats_is_geometric() -> None:
    both = [result(beats=50), result("p/msg/B", beats=100)]
    limit = [result(beats=84), result("p/msg/B", beats=85), result("p/msg/C", beats=86)]
    assert beats_table({"some": both, "none": [], "limit": limit}).splitlines()[2:] == [
        "| some | 2 | 0.707 | 1 | 0.500, p/msg/A deserializer |",
        "| limit | 3 | 0.850 | 1 | 0.840, p/msg/A deserializer |",
    ]


def test_converters_below_the_clock_of_ten_gigabit_have_a_line_with_their_path() -> None:
    rates = {"p/msg/A": (156.2,), "p/msg/B": (156.25,), "p/msg/C": (99.0, 130.0, 110.0)}
    found = [result(name, mhz=mhz) for name, mhz in rates.items()]
    found += [result(direction="serializer", mhz=()), replace(result("p/msg/D"), measured=None)]
    assert below_table(found).splitlines()[2:] == [
        f"| p/msg/{name} | deserializer | 100 | {mhz} | `12.5 ns, 8.0 of them routing, 9 cells: "
        "step 0.5 > & fill, offset 12.0 > run 12.5` |"
        for name, mhz in (("C", 110.0), ("A", 156.2))
    ]
    assert covering_table(found).splitlines()[2:] == [
        "| lyrical, deserializers | 3 | 1 | 156 | 110 |"
    ]


def test_covering_sets_are_read_from_the_files_of_the_cover_command(tmp_path: Path) -> None:
    with pytest.raises(BenchError, match=r"has no covering sets$"):
        covering_group(tmp_path)
    (tmp_path / "noetic.txt").write_text("# chosen\nstd_msgs/Bool\n")
    (tmp_path / "lyrical.txt").write_text("std_msgs/msg/Bool\nstd_msgs/msg/Char\n")
    tasks = list(group_tasks(covering_group(tmp_path)))
    assert [(task.converter.distro, task.converter.type) for task in tasks[::2]] == [
        ("lyrical", "std_msgs/msg/Bool"),
        ("lyrical", "std_msgs/msg/Char"),
        ("noetic", "std_msgs/Bool"),
    ]
    assert {(task.device, task.stated) for task in tasks} == {("ecp5", None)}


def parse_svg(text: str) -> ElementTree.Element:
    root = ElementTree.fromstring(text)
    assert root.tag == f"{SVG}svg"
    return root


@pytest.mark.parametrize(
    ("plot", "titles"),
    [
        (clock_plot, ["deserializer: 82.5 MHz", "serializer: 99.0 MHz"]),
        (area_plot, ["deserializer: 100 LUT, 50 FF", "serializer: 100 LUT, 50 FF"]),
    ],
)
def test_each_converter_has_a_bar(
    plot: Callable[[Sequence[Result]], str], titles: list[str]
) -> None:
    root = parse_svg(plot([result(), result(direction="serializer", mhz=(99.0,))]))
    bars = root.findall(f"{SVG}rect[@class='bar c1']") + root.findall(f"{SVG}rect[@class='bar c3']")
    tooltips = [title.text for bar in bars for title in bar.findall(f"{SVG}title")]
    assert tooltips == [f"p/msg/A (lyrical, cdr, 8 bytes) {title}" for title in titles]
    assert float(root.get("height") or 0) > 60


def test_the_line_of_the_goal_is_at_its_clock_rate() -> None:
    root = parse_svg(clock_plot([result()]))
    (goal,) = root.findall(f"{SVG}line[@class='goal']")
    (bar,) = [bar for bar in root.findall(f"{SVG}rect") if bar.findall(f"{SVG}title")]
    start, width = float(bar.get("x") or 0), float(bar.get("width") or 0)
    assert float(goal.get("x1") or 0) == pytest.approx(start + width * 156.25 / 82.5, abs=0.3)


def test_curves_of_beats_reach_their_ends() -> None:
    root = parse_svg(beats_plot({"some": [result(beats=50), result("p/msg/B", beats=100)]}))
    (curve,) = root.findall(f"{SVG}path")
    assert (curve.get("d") or "").endswith("H730.0V34.0")


def test_a_plot_without_figures_is_empty() -> None:
    bare = replace(result(), measured=None)
    for text in (clock_plot([bare]), area_plot([bare])):
        assert not parse_svg(text).findall(f".//{SVG}title")


def test_groups_have_both_directions_on_all_buses_and_devices() -> None:
    group = Group(
        title="",
        types={"lyrical": ("std_msgs/msg/Bool",), "noetic": ("std_msgs/Bool",)},
        bus_bytes=(1, 8),
        devices=("ecp5", "xc7"),
        seeds=(7,),
    )
    tasks = list(group_tasks(group, cache="c"))
    assert len(tasks) == len({(task.converter, task.device) for task in tasks}) == 16
    assert {(task.seeds, task.cache, task.converter.wire) for task in tasks} == {
        ((7,), "c", "cdr"),
        ((7,), "c", "ros1"),
    }
    assert len(list(group_tasks(replace(ALL_TYPES["lyrical, 64-byte bus"])))) == 2 * 171
    assert {task.device for task in group_tasks(Group(title="", types=group.types))} == {None}


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


@pytest.mark.parametrize("group", ["parts", "software", "beats"])
def test_a_figure_that_is_missing_in_any_group_is_a_failure(
    group: str,
    page_folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    before = (page_folder / "page.md").read_text()
    problems = [result(), result("p/msg/B", problem="too large"), result()]
    parts = [PartResult(part=part, measured=result().measured) for part in PARTS]
    parts[-1] = replace(parts[-1], problem="too large")
    monkeypatch.setattr(bench, "run_tasks", lambda tasks, jobs: problems)
    monkeypatch.setattr(bench, "run_parts", lambda *, cache, jobs: parts)
    assert run_bench(page_folder, "--group", group) == 1
    lines = {line for line in capsys.readouterr().err.splitlines() if "too large" in line}
    what = PARTS[-1].name if group == "parts" else str(problems[1].converter)
    assert lines == {f"{what}: too large"}
    assert (page_folder / "page.md").read_text() == before


@pytest.mark.parametrize("group", ["devices", "parts", "software"])
@pytest.mark.parametrize("kind", [BenchError, ProgramMissingError])
def test_a_missing_tool_is_an_error_before_anything_is_measured(
    group: str,
    kind: type[Exception],
    page_folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def missing(*_: object) -> dict[str, str]:
        raise kind("nothing is installed")

    for name in ("versions", "library_versions"):
        monkeypatch.setattr(bench, name, missing)
    for name in ("run_tasks", "run_parts"):
        monkeypatch.setattr(bench, name, lambda *_, **__: pytest.fail("too early"))
    assert run_bench(page_folder, "--group", group) == 1
    assert capsys.readouterr().err == "error: nothing is installed\n"


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
        assert {each.key for each in kept} == {
            (*map(str, asdict(task.converter).values()), task.device)
            for group in groups_of_file
            for task in group_tasks(group)
        }
        assert not any(each.problem for each in kept)


def test_results_of_a_group_are_in_one_order(monkeypatch: pytest.MonkeyPatch) -> None:
    """By type, width as a number, and direction, however their tasks end."""
    group = Group(title="", types={"lyrical": ("p/msg/A", "p/msg/B")}, bus_bytes=(16, 2))
    found = [
        result(name, bus_bytes=bus, direction=direction)
        for name in ("p/msg/A", "p/msg/B")
        for bus in (2, 8, 16)
        for direction in ("deserializer", "serializer")
    ]
    mixed = [found[number * 5 % len(found)] for number in range(len(found))]
    assert mixed != found
    monkeypatch.setattr(bench, "group_tasks", lambda group, *, cache: [])
    monkeypatch.setattr(bench, "run_tasks", lambda tasks, jobs: mixed)
    assert bench._run("", group, None, None) == found


def test_estimates_take_the_figures_with_the_most_seeds(page_folder: Path) -> None:
    def mhz() -> dict[tuple[str, str], float]:
        entries = json.loads((page_folder / "e.json").read_text())
        return {(entry["type"], entry["direction"]): entry["mhz"] for entry in entries}

    # Invented figures: 81 MHz with one seed, a median of 82 MHz with three.
    assert run_bench(page_folder, "--group", "covering") == 0
    assert set(mhz().values()) == {81.0}
    assert run_bench(page_folder, "--group", "figures") == 0
    three = {name for group in MEASURED["figures"].types.values() for name in group}
    assert {name for (name, _), rate in mhz().items() if rate == 82.0} == three
    assert run_bench(page_folder, "--group", "covering") == 0
    assert {name for (name, _), rate in mhz().items() if rate == 82.0} == three
