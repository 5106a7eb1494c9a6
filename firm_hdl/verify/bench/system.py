"""A test system that runs the generated test benches of many types."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

from firm_hdl.frontend import DISTROS
from firm_hdl.jobs.programs import find_ghdl, version_of
from firm_hdl.verify.bench.run import run_bench
from firm_hdl.verify.results.records import Record, Test
from firm_hdl.verify.results.verdict import Failed, NotJudged, Passed
from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.systems.system import (
    Judged,
    Made,
    Recorder,
    TypesSystem,
    judged,
    kept,
    run_tests,
)
from firm_hdl.verify.systems.tasks import TypeUnderTest

__all__ = ["Benches"]

MOST_CHARACTERS = 2000
"""The most characters of a failure that are printed."""


class Benches(TypesSystem):
    """The test system of generated benches. A test is the bench of a type of one distribution.

    Parameters
    ----------
    tasks : sequence of TypeUnderTest
    request : Request
        `paths`, `wire`, `widths` and `jobs` are used.

    Raises
    ------
    ProgramMissingError
    """

    name = "bench"

    def __init__(self, tasks: Sequence[TypeUnderTest], request: Request):
        # Equal types of several distributions each have a bench, because the headers of the
        # generated files differ.
        each = [replace(task, distro=name, same=(name,)) for task in tasks for name in task.same]
        super().__init__(each, request)
        self._ghdl = find_ghdl()

    @cached_property
    def tests(self) -> Sequence[Test]:
        """The tests of all types on all buses."""
        return [each for width in self._request.widths for each in self._tests(width)]

    def _tests(self, bus_bytes: int) -> list[Test]:
        return [self._test(task, bus_bytes, "ghdl") for task in self._tasks]

    @property
    def options(self) -> Mapping[str, Any]:
        """What GHDL says of its version: results of another one are another run's."""
        return {"ghdl": version_of(self._ghdl)}

    def run(self, recorder: Recorder) -> list[Judged]:
        """Run all benches, and print a table for each bus."""
        return [each for width in self._request.widths for each in self._run(width, recorder)]

    def _run(self, bus_bytes: int, recorder: Recorder) -> list[Judged]:
        """Run the benches with one bus."""
        began = time.perf_counter()
        label = f"{bus_bytes}-byte bus"
        tests = {test: test for test in self._tests(bus_bytes)}
        records = kept(tests, recorder, self._records, label=label).values()
        _table(list(records), label)
        print(f"{time.perf_counter() - began:.0f} s")
        return judged(records)

    def _records(self, left: Sequence[Test]) -> Made[Test]:
        given = self._request, self._ghdl
        jobs = self._request.jobs
        return run_tests(run_bench, given, left, self._command, _lines_of, jobs=jobs)


def _lines_of(record: Record) -> list[str]:
    if not isinstance(record.verdict, Failed):
        return []
    return [
        f"FAIL {record.test.type} ({record.test.distro})\n"
        f"    {record.verdict.failures[0][:MOST_CHARACTERS]}\n    again: {record.command}"
    ]


def _table(records: Sequence[Record], label: str) -> None:
    columns = ("types", "pass", "fail", "not judged", "packets", "transfers", "seconds")
    print(f"{label:12} " + " ".join(f"{name:>10}" for name in columns))
    for distro in DISTROS:
        mine = [record for record in records if record.test.distro == distro]
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
