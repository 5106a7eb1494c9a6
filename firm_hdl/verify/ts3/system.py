"""TS3 for the command: runs types with a progress bar, and prints failures and a summary."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Container, Generator, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from typing import Any

from firm_hdl.errors import described
from firm_hdl.frontend import DISTROS
from firm_hdl.jobs.executors import PROCESSES, run_each
from firm_hdl.verify.references.choice import find_references
from firm_hdl.verify.results.records import Record, Test, settled
from firm_hdl.verify.results.texts import clipped
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed
from firm_hdl.verify.simulators import simulator
from firm_hdl.verify.systems.options import Options, Request
from firm_hdl.verify.systems.system import (
    Judged,
    Made,
    Recorder,
    System,
    judged,
    kept,
    wire_of,
)
from firm_hdl.verify.systems.tasks import TypeUnderTest
from firm_hdl.verify.ts3.acceptance import accept
from firm_hdl.verify.ts3.replay import replay
from firm_hdl.verify.ts3.result import Result, command_of, record_of, same_circuits, test_of

__all__ = ["Ts3", "run_tasks"]

MOST_CHARACTERS = 600
"""The most characters of a failure that are printed."""


class Ts3(System):
    """The test system of TS3. A test is one type with one set of options.

    Parameters
    ----------
    tasks : sequence of TypeUnderTest
    request : Request

    Raises
    ------
    ProgramMissingError, ClientMissingError
        When the system is entered.
    """

    name = "ts3"

    def __init__(self, tasks: Sequence[TypeUnderTest], request: Request):
        self._tasks, self._request, self._options = tasks, request, request.each_width
        self._version = ""

    def __enter__(self) -> Ts3:
        request = self._request
        # Look for programs and libraries once, before the first type runs.
        if (other := simulator(request.simulator)) is not None:
            self._version = other.version
        if not request.bags:
            wires = [wire_of(task.distro, request.wire) for task in self._tasks]
            for line in find_references(request.references, wires):
                print(line)
        return self

    @property
    def tests(self) -> Sequence[Test]:
        """The tests of all types with all sets of options."""
        return [test_of(task, each) for each in self._options for task in self._tasks]

    @property
    def options(self) -> Mapping[str, Any]:
        """The options that determine the cases, and how the cases are tested."""
        request = self._request
        return {
            "simulator": f"{request.simulator} {self._version}".strip(),
            "seed": request.seed,
            "cases": request.most_cases,
            "stalls": request.stalled,
            "broken": request.broken,
            "share_circuits": request.shares_circuits,
            "bags": list(request.bags),
            "longest": request.longest,
            "references": None if request.references is None else list(request.references),
        }

    def run(self, recorder: Recorder) -> list[Judged]:
        """Run all tasks with each of the options.

        Raises
        ------
        ExecutorError
        """
        began = time.perf_counter()
        found = [each for one in self._options for each in self._run(one, recorder)]
        failures = sum(isinstance(each.verdict, Failed) for each in found)
        print(f"{time.perf_counter() - began:.0f} s, {failures} failures")
        return found

    def _run(self, options: Options, recorder: Recorder) -> list[Judged]:
        """Run all tasks with one set of options."""
        tasks = {task: test_of(task, options) for task in self._tasks}
        same = same_circuits(self._tasks, options) if self._request.shares_circuits else {}
        results: list[Result] = []
        notes: Counter[str] = Counter()

        def run(left: Sequence[TypeUnderTest]) -> Made[TypeUnderTest]:
            jobs, executor = self._request.jobs, self._request.executor
            found = run_tasks(left, options, jobs, executor=executor, golden_only=same)
            with closing(found):
                for task, result in found:
                    results.append(result)
                    same_as = tasks[same[task]].key if task in same else ""
                    notes[result.note] += 1
                    # The note of a replay has the number of messages, so it is always printed.
                    is_new = notes[result.note] == 1 or bool(options.bags)
                    record = record_of(task, result, options, same_as)
                    yield [(task, record, _lines_of(task, result, is_new=is_new))]

        records = kept(tasks, recorder, run, label=f"{options.bus_bytes}-byte bus")
        if not options.bags:
            _repeat(notes)
        _count(records, options)
        _summarize([result for result in results if result.simulated_cycles], options)
        return judged(records.values())


def run_tasks(
    tasks: Sequence[TypeUnderTest],
    options: Options,
    jobs: int | None = None,
    *,
    executor: str = PROCESSES,
    golden_only: Container[TypeUnderTest] = (),
) -> Generator[tuple[TypeUnderTest, Result], None, None]:
    """Run tasks in `jobs` processes (`None`: one per processor); yield results as they are ready.

    Parameters
    ----------
    executor : str
        See :func:`firm_hdl.jobs.executors.run_each`.
    golden_only : container of TypeUnderTest
        Tasks whose circuit is not to be simulated.
    """
    without = replace(options, simulated=False)
    work = [
        (task, (task.distro, task.name, without if task in golden_only else options))
        for task in tasks
    ]
    run = replay if options.bags else accept
    for task, result in run_each(run, work, executor=executor, jobs=jobs):
        if isinstance(result, Exception):
            failed = Result(distro=task.distro, name=task.name)
            failed.failures.append(described(result))
            failed.command = command_of(options, task.distro, task.name)
            yield task, failed
        else:
            yield task, result


def _lines_of(task: TypeUnderTest, result: Result, *, is_new: bool) -> Iterator[str]:
    """Yield the failure and the note of a type; a note only if it is new."""
    if isinstance(result.verdict, Failed):
        yield _describe(task, result, result.verdict)
    if result.note and is_new:
        yield f"note: {task.name} ({task.distro}): {result.note}"


def _repeat(notes: Mapping[str, int]) -> None:
    """Print for each note how many further types have it."""
    for note, count in notes.items():
        if note and count > 1:
            print(f"note: {count - 1} more types: {note}")


def _count(records: Mapping[TypeUnderTest, Record], options: Options) -> None:
    """Print how many types of each distribution pass."""
    by_key = {record.test.key: record for record in records.values()}
    verdicts = {task: settled(record, by_key) for task, record in records.items()}
    passed: Counter[str] = Counter()
    total: Counter[str] = Counter()
    for task, verdict in verdicts.items():
        if not isinstance(verdict, NotJudged):
            total.update(task.same)
        if isinstance(verdict, Passed | KnownDifference):
            passed.update(task.same)
    for distro in DISTROS:
        if distro in total:
            print(f"{distro:8} {passed[distro]:4} of {total[distro]:4} types pass", end="")
            print(f" ({options.bus_bytes}-byte bus)")
    known = [verdict for verdict in verdicts.values() if isinstance(verdict, KnownDifference)]
    if known:
        keys = ", ".join(sorted({key for verdict in known for key in verdict.keys}))
        print(f"{len(known)} of them with a known difference between libraries: {keys}")
    if not_judged := sum(isinstance(verdict, NotJudged) for verdict in verdicts.values()):
        print(f"{not_judged} of {len(records)} types not judged")
    if shared := sum(bool(record.same_as) for record in records.values()):
        print(f"{shared} of {len(records)} types have the circuit of another, which was simulated")


def _summarize(results: Sequence[Result], options: Options) -> None:
    if not results:
        return
    seconds = sorted(result.seconds.total for result in results)
    cycles = sum(result.simulated_cycles for result in results)
    print(
        f"{len(results)} different types, {sum(r.packets for r in results)} packets, "
        f"{cycles} cycles; seconds per type: median {seconds[len(seconds) // 2]:.2f}, "
        f"most {seconds[-1]:.1f}, {sum(seconds):.0f} in total"
    )
    slowest = sorted(results, key=lambda result: -result.seconds.total)[:5]
    print("slowest:", ", ".join(f"{each.name} {each.seconds.total:.1f} s" for each in slowest))
    writers = Counter(
        name for result in results if result.cases for name in ("rosbags", *result.written_by)
    )
    text = ", ".join(f"{name} {count} types" for name, count in writers.items())
    print("wire bytes:", text or "no library wrote any")
    compared = [result.comparison for result in results if result.comparison is not None]
    if compared:
        same = sum(isinstance(each.verdict, Passed) for each in compared)
        print(
            f"{options.simulator}: {same} of {len(compared)} types the same in every cycle; "
            f"{sum(each.cycles for each in compared)} cycles, "
            f"{sum(each.packets for each in compared)} packets, "
            f"{sum(each.transfers for each in compared)} leaf transfers and "
            f"{sum(each.statuses for each in compared)} statuses seen there, "
            f"in {sum(each.seconds for each in compared):.0f} s"
        )


def _describe(task: TypeUnderTest, result: Result, failed: Failed) -> str:
    lines = [f"FAIL {task.name} ({', '.join(task.same)})"]
    lines += [f"    {clipped(failure, MOST_CHARACTERS)}" for failure in failed.failures[:8]]
    if len(failed.failures) > 8:
        lines.append(f"    and {len(failed.failures) - 8} more")
    return "\n".join([*lines, f"    again: {result.command}"])
