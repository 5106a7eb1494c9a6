"""``python -m lab.bench``: the figures of ``lab/notes/performance.md``, with their plots.

``make -C lab bench`` runs this. ``firm-hdl bench`` is the command for chosen types. Figures of
circuits that did not change are taken from ``build/bench``.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from firm_hdl.arguments import add_jobs
from firm_hdl.bench.compare import compared
from firm_hdl.bench.devices import DEVICES
from firm_hdl.bench.results import Converted, Result, read_results, results_text
from firm_hdl.bench.run import BenchTask, run_tasks
from firm_hdl.bench.tables import row
from firm_hdl.bench.tools import BenchError, versions
from firm_hdl.files import write_file
from firm_hdl.jobs import ProgramMissingError
from firm_hdl.plan import DIRECTIONS
from firm_hdl.terminal import printable_streams, progress, stage
from lab.bench.estimates import estimates_json
from lab.bench.page import (
    area_table,
    beats_table,
    below_table,
    converter_table,
    covering_table,
    made_with,
    path_list,
    write_page,
)
from lab.bench.parts import PART_DEVICE, PARTS, PartResult, part_table, parts_text, run_parts
from lab.bench.plots import area_plot, beats_plot, clock_plot
from lab.bench.software import (
    Compared,
    compare_software,
    library_versions,
    machine,
    made_on,
    software_rows,
    software_table,
)
from lab.bench.standard import (
    ALL_TYPES,
    MEASURED,
    SOFTWARE,
    Group,
    covering_group,
    group_tasks,
)

GROUPS = (*MEASURED, "covering", "parts", "beats", "software")
"""Groups of figures, by their names on the command line."""

KEPT = "performance.json"
"""File of all measured figures of converters, beside the page's plots."""

KEPT_COVERING = "covering.json"
"""File of the figures of covering sets."""

KEPT_PARTS = "parts.json"
"""File of the figures of packet parts."""


@printable_streams()
def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, and write the page; return 0 if no figure is missing, even if figures got worse."""
    parser = argparse.ArgumentParser(prog="python -m lab.bench", description=__doc__)
    parser.add_argument("--page", default="lab/notes/performance.md", help="default: %(default)s")
    parser.add_argument(
        "--figures",
        default="lab/notes/figures",
        help="folder of plots and JSON; default: %(default)s",
    )
    parser.add_argument(
        "--estimates",
        default="firm_hdl/estimates/figures.json",
        help="file of `firm-hdl info`; default: %(default)s",
    )
    parser.add_argument(
        "--covering",
        default="tests/verify/covering",
        help="folder of `firm-hdl cover`'s files; default: %(default)s",
    )
    parser.add_argument("--cache", default="build/bench", help="default: %(default)s")
    parser.add_argument(
        "--group",
        action="append",
        choices=GROUPS,
        help="parts of the page to write; repeatable; default: all",
    )
    add_jobs(parser)
    given = parser.parse_args(arguments)
    try:
        return _measure_all(given)
    except (BenchError, ProgramMissingError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1


def _measure_all(given: argparse.Namespace) -> int:
    names = given.group or GROUPS
    figures = Path(given.figures)
    groups = {name: group for name, group in MEASURED.items() if name in names}
    if "covering" in names:
        groups["covering"] = covering_group(Path(given.covering))
    devices = {device for group in groups.values() for device in group.devices}
    for device in devices | ({PART_DEVICE} if "parts" in names else set()):
        versions(DEVICES[device])
    if "software" in names:
        library_versions()
    results = {name: _run(name, group, given.jobs, given.cache) for name, group in groups.items()}
    parts = _run_parts(given.jobs, given.cache) if "parts" in names else []
    sets = {}
    if "beats" in names:
        sets = {name: _run(name, group, given.jobs, None) for name, group in ALL_TYPES.items()}
    groups_of_software = SOFTWARE if "software" in names else ()
    software = [_run(group.title, group, given.jobs, None) for group in groups_of_software]
    wrong = [
        each
        for found in (*results.values(), *sets.values(), *software)
        for each in found
        if each.problem
    ]
    problems = [f"{each.converter}: {each.problem}" for each in wrong]
    problems += [f"{each.part.name}: {each.problem}" for each in parts if each.problem]
    if problems:
        print(*problems, sep="\n", file=sys.stderr)
        return 1
    _write_plots(figures, results, sets)
    _write_parts(Path(given.page), results, sets, _compare_all(software))
    if parts:
        write_page(Path(given.page), {"parts": part_table(parts)})
        write_file(figures / KEPT_PARTS, parts_text(parts))
    if results:
        covering = results.pop("covering", [])
        measured = [each for found in results.values() for each in found]
        kept = _keep(figures / KEPT, measured) + _keep(figures / KEPT_COVERING, covering)
        _write_estimates(Path(given.estimates), kept)
    return 0


def _run(name: str, group: Group, jobs: int | None, cache: str | None) -> list[Result]:
    """Run a group; return the results in the order of its tasks."""
    tasks: list[BenchTask] = list(group_tasks(group, cache=cache))
    found: dict[tuple[str, ...], Result] = {}
    with progress(name):
        for result in run_tasks(tasks, jobs):
            if group.devices:
                print(row(result, path=False), flush=True)
            found[_order(result)] = result
            stage(f"{name}: converters", len(found), len(tasks))
    return [found[key] for key in sorted(found)]


def _run_parts(jobs: int | None, cache: str | None) -> list[PartResult]:
    """Measure the packet parts; return the results in the order of the page."""
    found: dict[str, PartResult] = {}
    with progress("parts"):
        for result in run_parts(cache=cache, jobs=jobs):
            found[f"{result.part.name}, {result.part.parameters}"] = result
            stage("parts", len(found), len(PARTS))
    return [found[f"{part.name}, {part.parameters}"] for part in PARTS]


def _order(result: Result) -> tuple[str, ...]:
    what = result.converter
    device = "" if result.measured is None else result.measured.device.name
    return (device, what.type, what.wire, f"{what.bus_bytes:02}", what.direction)


def _compare_all(software: list[list[Result]]) -> list[Compared]:
    """Time libraries with the messages of converters; run nothing else at the same time."""
    found: list[Compared] = []
    for group, results in zip(SOFTWARE, software, strict=False):
        for task in group_tasks(group):
            if task.converter.direction != DIRECTIONS[0]:
                continue
            what = _type_of(task.converter)
            same = [each for each in results if _type_of(each.converter) == what]
            found.append(compare_software(task, same))
            print(software_rows(found[-1]), flush=True)
    return found


def _type_of(what: Converted) -> tuple[str, str]:
    return what.type, what.wire


def _write_plots(
    folder: Path, results: Mapping[str, list[Result]], sets: Mapping[str, list[Result]]
) -> None:
    plots = {}
    if "figures" in results:
        plots["clock"] = clock_plot(results["figures"])
        plots["area"] = area_plot(results["figures"])
    if sets:
        plots["beats"] = beats_plot(sets)
    for name, text in plots.items():
        write_file(folder / f"bench_{name}.svg", text)


def _write_parts(
    page: Path,
    results: Mapping[str, list[Result]],
    sets: Mapping[str, list[Result]],
    software: list[Compared],
) -> None:
    parts = {}
    for name, found in results.items():
        table = {"devices": area_table, "covering": covering_table}.get(name, converter_table)
        parts[name] = table(found)
        parts[f"{name}: made with"] = made_with(found)
    if "figures" in results:
        parts["figures: paths"] = path_list(results["figures"])
    if "covering" in results:
        parts["covering: below"] = below_table(results["covering"])
    if sets:
        parts["beats"] = beats_table(sets)
    if software:
        parts["software"] = software_table(software)
        parts["software: made with"] = made_on(machine(), library_versions())
    write_page(page, parts)


def _keep(file: Path, results: list[Result]) -> list[Result]:
    """Print what changed since the file was written, and update it; return all that it has now.

    Figures of converters without a new result stay in the file.
    """
    old = read_results(file) if file.exists() else []
    if not results:
        return old
    new = {result.key: result for result in results}
    same = [result for result in old if result.key in new]
    if same:
        print(compared(same, results, 0.02)[0])
    everything = [*(result for result in old if result.key not in new), *results]
    write_file(file, results_text(everything))
    return everything


def _write_estimates(file: Path, results: list[Result]) -> None:
    """Write the estimates. The first result of a converter counts: those have the most seeds."""
    first: dict[tuple[str, ...], Result] = {}
    for result in results:
        first.setdefault(result.key, result)
    write_file(file, estimates_json(first[key] for key in sorted(first)))


if __name__ == "__main__":
    sys.exit(main())
