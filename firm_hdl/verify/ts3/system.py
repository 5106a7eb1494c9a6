"""TS3 for the command: acceptance of types, with a bar, a table, and how to repeat what failed."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from typing import Any

from tqdm import tqdm

from firm_hdl.frontend import DISTROS
from firm_hdl.jobs.executors import PROCESSES
from firm_hdl.verify.references.choice import find_references
from firm_hdl.verify.results.records import Record, Test, settled
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed
from firm_hdl.verify.simulators import simulator
from firm_hdl.verify.systems.system import Judged, Recorder, System, judged, wire_of
from firm_hdl.verify.systems.tasks import TypeUnderTest
from firm_hdl.verify.ts3.options import Options, Result
from firm_hdl.verify.ts3.recorded import record_of, same_circuits, test_of
from firm_hdl.verify.ts3.runner import run_tasks

__all__ = ["How", "Ts3"]


@dataclass(frozen=True, slots=True, kw_only=True)
class How:
    """Where tests run.

    Attributes
    ----------
    jobs : int or None
        Processes; `None`: one per processor.
    executor : str
        See :func:`firm_hdl.jobs.executors.run_each`.
    share_circuits : bool
        Whether types with the same circuit are simulated once.
    """

    jobs: int | None = None
    executor: str = PROCESSES
    share_circuits: bool = False


class Ts3(System):
    """Acceptance; a test is one type with one set of options.

    Parameters
    ----------
    tasks : sequence of Task
    options : sequence of Options
        Which differ in the width of the bus.

    Raises
    ------
    ProgramMissingError, ClientMissingError
        When it is entered.
    """

    name = "ts3"

    def __init__(
        self, tasks: Sequence[TypeUnderTest], options: Sequence[Options], how: How | None = None
    ):
        self._tasks, self._options, self._how = tasks, options, how or How()

    def __enter__(self) -> Ts3:
        for each in self._options:
            # Before the first type is run, and once: not by each type.
            simulator(each.simulator)
        first = self._options[0]
        if not first.bags:
            wires = [wire_of(task.distro, first.wire) for task in self._tasks]
            for line in find_references(first.references, wires):
                print(line)
        return self

    @property
    def tests(self) -> Sequence[Test]:
        """All types with all options."""
        return [test_of(task, each) for each in self._options for task in self._tasks]

    @property
    def options(self) -> Mapping[str, Any]:
        """What cases there are, and what becomes of them."""
        first = self._options[0]
        return {
            "simulator": first.simulator,
            "seed": first.seed,
            "cases": first.most_cases,
            "stalls": first.stalled,
            "broken": first.broken,
            "share_circuits": self._how.share_circuits,
            "bags": list(first.bags),
            "longest": first.longest,
            "references": None if first.references is None else list(first.references),
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
        tasks, how = self._tasks, self._how
        records = recorder.resume({task: test_of(task, options) for task in tasks}, "types")
        left = [task for task in tasks if task not in records]
        same = same_circuits(tasks, options) if how.share_circuits else {}
        results: list[Result] = []
        notes: Counter[str] = Counter()
        label = f"{options.bus_bytes}-byte bus"
        bar = tqdm(total=len(tasks), initial=len(records), unit="type", desc=label, disable=None)
        run = run_tasks(left, options, how.jobs, executor=how.executor, golden_only=same)
        with bar, closing(run):
            for task, result in run:
                results.append(result)
                other = same.get(task)
                same_as = "" if other is None else test_of(other, options).key
                records[task] = record = record_of(task, result, options, same_as)
                recorder.add(record)
                notes[result.note] += 1
                # A replay says of each type how many messages there were.
                is_new = notes[result.note] == 1 or bool(options.bags)
                for line in _said(task, result, is_new=is_new):
                    tqdm.write(line)
                bar.update()
        if not options.bags:
            _repeat(notes)
        records = {task: records[task] for task in tasks}
        _count(records, options)
        _summarize([result for result in results if result.simulated_cycles], options)
        return judged(records.values())


def _said(task: TypeUnderTest, result: Result, *, is_new: bool) -> Iterator[str]:
    """Say what is to be known of a type; what is said of many types, of the first one only."""
    if isinstance(result.verdict, Failed):
        yield _describe(task, result, result.verdict)
    if result.note and is_new:
        yield f"note: {task.name} ({task.distro}): {result.note}"


def _repeat(notes: Mapping[str, int]) -> None:
    """Print how many types a note was left out of."""
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
    if silent := sum(isinstance(verdict, NotJudged) for verdict in verdicts.values()):
        print(f"{silent} of {len(records)} types not judged")
    if shared := sum(bool(record.same_as) for record in records.values()):
        print(f"{shared} of {len(records)} types have the circuit of another, which was simulated")


def _summarize(results: Sequence[Result], options: Options) -> None:
    if not results:
        return
    seconds = sorted(result.seconds for result in results)
    cycles = sum(result.simulated_cycles for result in results)
    print(
        f"{len(results)} different types, {sum(r.packets for r in results)} packets, "
        f"{cycles} cycles; seconds per type: median {seconds[len(seconds) // 2]:.2f}, "
        f"most {seconds[-1]:.1f}, {sum(seconds):.0f} in total"
    )
    slowest = sorted(results, key=lambda result: -result.seconds)[:5]
    print("slowest:", ", ".join(f"{each.name} {each.seconds:.1f} s" for each in slowest))
    writers = Counter(
        name for result in results if result.cases for name in ("rosbags", *result.written_by)
    )
    said = ", ".join(f"{name} {count} types" for name, count in writers.items())
    print("wire bytes:", said or "nobody wrote any")
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
    lines += [f"    {_clip(failure)}" for failure in failed.failures[:8]]
    if len(failed.failures) > 8:
        lines.append(f"    and {len(failed.failures) - 8} more")
    return "\n".join([*lines, f"    again: {result.command}"])


def _clip(text: str, most: int = 600) -> str:
    return text if len(text) <= most else f"{text[:most]}... ({len(text)} characters)"
