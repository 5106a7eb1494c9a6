"""The generated test benches of many types, as a test system."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Generator, Iterable, Mapping, Sequence
from contextlib import closing
from functools import cached_property
from typing import Any

from tqdm import tqdm

from firm_hdl.frontend import DISTROS
from firm_hdl.jobs.executors import run_each
from firm_hdl.jobs.programs import find_ghdl
from firm_hdl.verify.bench.run import BenchResult, BenchRun, run_bench
from firm_hdl.verify.results.records import Record, Seconds, Test, clipped_verdict
from firm_hdl.verify.results.verdict import Failed, NotJudged, Passed
from firm_hdl.verify.systems.system import Judged, Recorder, System, judged, wire_of
from firm_hdl.verify.systems.tasks import TypeUnderTest
from firm_hdl.wire import Wire

__all__ = ["Benches"]


class Benches(System):
    """Generated benches; a test is the bench of a type of one distribution.

    Parameters
    ----------
    tasks : sequence of Task
    paths : iterable of str
        Folders with ROS packages, searched first.
    wire : "ros1", "cdr" or None
    widths : iterable of int
        Buses, in bytes.
    jobs : int or None
        Processes; `None`: one per processor.

    Raises
    ------
    ProgramMissingError
    """

    name = "bench"

    def __init__(
        self,
        tasks: Sequence[TypeUnderTest],
        *,
        paths: Iterable[str] = (),
        wire: Wire | None = None,
        widths: Iterable[int] = (8,),
        jobs: int | None = None,
    ):
        ghdl = find_ghdl()
        # Each distribution's bench of its own, even if another has the same type: its header
        # differs.
        self._work = [(distro, task.name) for task in tasks for distro in task.same]
        self._runs = [
            BenchRun(paths=tuple(paths), wire=wire, bus_bytes=width, ghdl=ghdl) for width in widths
        ]
        self._jobs = jobs

    @cached_property
    def tests(self) -> Sequence[Test]:
        """All types with all buses."""
        return [_test(run, *work) for run in self._runs for work in self._work]

    @property
    def options(self) -> Mapping[str, Any]:
        """Nothing but what all systems have."""
        return {}

    def run(self, recorder: Recorder) -> list[Judged]:
        """Run all benches, and print a table for each bus."""
        return [each for run in self._runs for each in self._run(run, recorder)]

    def _run(self, run: BenchRun, recorder: Recorder) -> list[Judged]:
        """Run the benches with one bus."""
        began = time.perf_counter()
        records = recorder.resume({work: _test(run, *work) for work in self._work}, "types")
        left = [work for work in self._work if work not in records]
        total, known = len(self._work), len(records)
        label = f"{run.bus_bytes}-byte bus"
        bar = tqdm(total=total, initial=known, unit="type", desc=label, disable=None)
        with bar, closing(_results(left, run, self._jobs)) as results:
            for (distro, name), result in results:
                records[distro, name] = record = _record(run, distro, name, result)
                recorder.add(record)
                if isinstance(result.verdict, Failed):
                    tqdm.write(
                        f"FAIL {name} ({distro})\n    {result.verdict.failures[0][:2000]}\n"
                        f"    again: {record.command}"
                    )
                bar.update()
        _table(records, run.bus_bytes)
        print(f"{time.perf_counter() - began:.0f} s")
        return judged(records.values())


def _test(run: BenchRun, distro: str, name: str) -> Test:
    return Test(
        system=Benches.name,
        simulator="ghdl",
        distro=distro,
        type=name,
        same=(distro,),
        wire=wire_of(distro, run.wire),
        bus_bytes=run.bus_bytes,
        options=",".join(f"path={path}" for path in run.paths),
    )


def _record(run: BenchRun, distro: str, name: str, result: BenchResult) -> Record:
    testing = result.seconds - result.setup_seconds - result.simulation_seconds
    return Record(
        test=_test(run, distro, name),
        verdict=clipped_verdict(result.verdict),
        seconds=Seconds(
            generation=result.setup_seconds,
            simulation=result.simulation_seconds,
            testing=max(0.0, testing),
        ),
        cpu_seconds=result.cpu_seconds,
        packets=result.packets,
        metrics={"transfers": float(result.transfers)},
        command=run.command(distro, name),
    )


def _results(
    work: Sequence[tuple[str, str]], run: BenchRun, jobs: int | None
) -> Generator[tuple[tuple[str, str], BenchResult], None, None]:
    tasks = [((distro, name), (distro, name, run)) for distro, name in work]
    for key, result in run_each(run_bench, tasks, jobs=jobs):
        if isinstance(result, Exception):
            result = BenchResult(verdict=Failed((f"{type(result).__name__}: {result}",)))
        yield key, result


def _table(records: Mapping[tuple[str, str], Record], bus_bytes: int) -> None:
    columns = ("types", "pass", "fail", "not judged", "packets", "transfers", "seconds")
    print(f"{f'{bus_bytes}-byte bus':12} " + " ".join(f"{name:>10}" for name in columns))
    for distro in DISTROS:
        mine = [record for key, record in records.items() if key[0] == distro]
        if not mine:
            continue
        counts = Counter(each.verdict.name for each in mine)
        row = [
            len(mine),
            counts[Passed.name],
            counts[Failed.name],
            counts[NotJudged.name],
            sum(each.packets for each in mine),
            round(sum(each.metrics.get("transfers", 0) for each in mine)),
            round(sum(each.seconds.total for each in mine)),
        ]
        print(f"{distro:12} " + " ".join(f"{number:>10}" for number in row))
