"""The interface of test systems, and functions that run tests and keep their records.

A system lists all its tests before it runs one, so that a file of results can say what is missing.
:func:`run_and_record` takes the records of earlier sessions from the file, runs the other tests,
says how many are done, and writes each record to the file at once. All systems have one summary.
"""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections import Counter, defaultdict
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, TypeAlias

from firm_hdl.cases import NotJudgedError
from firm_hdl.errors import described
from firm_hdl.frontend import DISTROS
from firm_hdl.jobs.executors import ExecutorError, run_each
from firm_hdl.jobs.processes import cpu_seconds
from firm_hdl.model import WIRE_OF
from firm_hdl.terminal import stage
from firm_hdl.verify.results.file import ResultsWriter
from firm_hdl.verify.results.records import STAGES, Record, Seconds, Test, clipped_verdict, settled
from firm_hdl.verify.results.verdict import (
    Counts,
    Failed,
    KnownDifference,
    NotJudged,
    NotRun,
    Passed,
    Verdict,
    clipped,
)
from firm_hdl.verify.systems.options import CaseOptions, Request, command_again
from firm_hdl.verify.systems.tasks import TypeUnderTest

__all__ = [
    "Made",
    "Stopwatch",
    "System",
    "Trial",
    "TypesSystem",
    "as_test",
    "counted",
    "failure_of",
    "run_and_record",
    "run_tests",
    "summary_of",
    "wire_of",
]

MOST_SHOWN = 8
MOST_CHARACTERS = 1000
"""So many failures of a test are printed, each of at most so many characters."""

SHARES = 64
"""There are at least so many shares of tests, if there are so many tests."""

Made: TypeAlias = "Generator[Sequence[Record], None, None]"
"""Yields records of tests; those that come together are written together."""


def counted(records: Iterable[Record]) -> list[Record]:
    """Return the records of one system with the verdicts that count."""
    by_key = {record.test.key: record for record in records}
    found = []
    for record in by_key.values():
        verdict = settled(record, by_key)
        if isinstance(verdict, NotRun):
            verdict = NotJudged(verdict.reason)
        found.append(replace(record, verdict=verdict))
    return found


class System(ABC):
    """A test system with all its tests; a context manager."""

    name: ClassVar[str]  # The name that `--systems` takes.
    passes: ClassVar[str] = "types pass"  # What its tests are, and what they do if all is well.

    def __enter__(self) -> System:
        return self

    def __exit__(self, *error: object) -> None:
        return None

    @property
    @abstractmethod
    def tests(self) -> Sequence[Test]:
        """All tests, in the order in which they start."""

    @property
    def options(self) -> Mapping[str, Any]:
        """What results depend on besides the request, such as versions, as JSON values."""
        return {}

    def run(self, writer: ResultsWriter | None) -> list[Record]:
        """Run the tests that `writer` has no record of; print a summary of all, and return them.

        The records have the verdicts that count.
        """
        began = time.perf_counter()
        records = counted(self.records(writer))
        for line in self.summary(records, time.perf_counter() - began):
            print(line)
        return records

    @abstractmethod
    def records(self, writer: ResultsWriter | None) -> list[Record]:
        """Run the tests that `writer` has no record of, and print failures; return all records."""

    def summary(self, records: Sequence[Record], seconds: float) -> Iterator[str]:
        """Yield lines about all records of a run that took so long."""
        return summary_of(records, self.passes, seconds)


class TypesSystem(System):
    """A test system whose tests are types, each with each of the options of a request."""

    def __init__(self, tasks: Sequence[TypeUnderTest], request: Request):
        self._tasks, self._request = tasks, request

    @property
    def tests(self) -> Sequence[Test]:
        """The tests of all types on all buses."""
        return [each for options in self._request.each_width for each in self._tests(options)]

    def _tests(self, options: CaseOptions) -> list[Test]:
        """Return the tests of all types with some options."""
        return [as_test(self.name, task, options) for task in self._tasks]

    def _command(self, test: Test, **more: object) -> str:
        """Return the command that runs one test again, with its bus unless `more` is given."""
        return command_again(
            test.type,
            systems=self.name,
            distro=test.distro,
            path=self._request.paths,
            depends=self._request.depends,
            wire=self._request.wire,
            **(more or {"bus_bytes": test.bus_bytes}),
        )


def as_test(
    system: str,
    task: TypeUnderTest,
    options: CaseOptions,
    *words: str,
    simulator: str = "",
    bus_bytes: int | None = None,
) -> Test:
    """Return the test of a type.

    * `*words`: what results depend on besides the folders.
    * `bus_bytes`: 0 if no circuit is tested; `None`: that of the options.
    """
    return Test(
        system=system,
        simulator=simulator,
        distro=task.distro,
        type=task.name,
        same=task.same,
        wire=wire_of(task.distro, options.wire),
        bus_bytes=options.bus_bytes if bus_bytes is None else bus_bytes,
        options=",".join([*words, *options.folders]),
    )


def wire_of(distro: str, wire: str | None) -> str:
    """Return the name of a wire format; `None`: that of the distribution."""
    return wire or WIRE_OF[DISTROS[distro].dialect]


class Stopwatch:
    """Measures the stages of a test in wall-clock time, and the whole test in processor time."""

    def __init__(self) -> None:
        self._began_cpu = cpu_seconds()
        self._spent: dict[str, float] = defaultdict(float)
        self._stage, self._began = "generation", time.perf_counter()

    def enter(self, stage: str) -> None:
        """End the current stage and begin another one of `STAGES`. The first is ``generation``."""
        now = time.perf_counter()
        self._spent[self._stage] += now - self._began
        self._stage, self._began = stage, now

    def stop(self) -> tuple[Seconds, float]:
        """End the test; return the times of its stages, and its processor time in seconds."""
        self.enter("")
        seconds = Seconds(**{stage: self._spent[stage] for stage in STAGES})
        return seconds, cpu_seconds() - self._began_cpu


@dataclass(slots=True, kw_only=True)
class Trial:
    """A test that runs, and what it has found so far."""

    # Receives figures and notes. Its verdict, its times and nothing else are set at the end.
    record: Record
    # Failures in the order in which they were found.
    failures: list[str] = field(default_factory=list)
    judged: int = 0  # The number of cases that were compared with an oracle.
    known: tuple[str, ...] = ()  # Keys of the known differences that were found.
    obstacle: NotJudged | None = None  # Why the test cannot be judged.
    watch: Stopwatch = field(default_factory=Stopwatch)

    @classmethod
    def of(cls, test: Test) -> Trial:
        """Begin a test."""
        return cls(record=Record(test=test, verdict=NotJudged("it has not ended")))

    @property
    def verdict(self) -> Verdict:
        """The worst that was found; nothing judged is no pass."""
        if self.failures:
            return Failed(tuple(self.failures))
        if self.obstacle is not None:
            return self.obstacle
        if not self.judged:
            return NotJudged("nothing was compared with an oracle")
        if self.known:
            return KnownDifference(self.known, self.judged)
        return Passed(self.judged)

    def stop(self, error: Exception) -> None:
        """Add what ended the test. The other tests run in any case."""
        if isinstance(error, NotJudgedError):
            self.obstacle = NotJudged(str(error) or type(error).__name__)
        else:
            self.failures.append(described(error))

    def end(self) -> Record:
        """Return the record of the test, which ends here."""
        seconds, processor = self.watch.stop()
        verdict = clipped_verdict(self.verdict)
        return replace(self.record, verdict=verdict, seconds=seconds, cpu_seconds=processor)

    def __enter__(self) -> Trial:
        return self

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> bool:
        """End the test if there was an error, which goes into the record."""
        if isinstance(error, Exception):
            self.stop(error)
        return isinstance(error, Exception)


def failure_of(what: str, record: Record) -> Iterator[str]:
    """Yield the text to print if a test failed: what it tests, its failures, and its command."""
    if not record.failures:
        return
    shown = [clipped(text, MOST_CHARACTERS) for text in record.failures[:MOST_SHOWN]]
    if (left := len(record.failures) - MOST_SHOWN) > 0:
        shown.append(f"and {left} more")
    if record.command:
        shown.append(f"again: {record.command}")
    lines = [line for text in shown for line in text.splitlines()]
    yield "\n".join([f"FAIL {what}", *(f"    {line}" for line in lines)])


def summary_of(records: Sequence[Record], passes: str, seconds: float) -> Iterator[str]:
    """Yield lines about tests whose verdicts count: those of each distribution and bus, and all.

    * `passes`: what the tests are, and what they do if all is well, such as ``types pass``.
    * `seconds`: how long the run took.
    """
    groups: dict[tuple[int, int], list[Verdict]] = defaultdict(list)
    names = [*DISTROS]
    for record in records:
        for distro in record.test.distros:
            groups[record.test.bus_bytes, names.index(distro)].append(record.verdict)
    for (bus_bytes, number), verdicts in sorted(groups.items()):
        counts = Counts.of(verdicts)
        if judged := counts.total - counts.not_judged:
            bus = f" ({bus_bytes}-byte bus)" if bus_bytes else ""
            passed = counts.passed + counts.known
            yield f"{names[number]:8} {passed:4} of {judged:4} {passes}{bus}"
    known = [each.verdict for each in records if isinstance(each.verdict, KnownDifference)]
    if known:
        keys = ", ".join(sorted({key for verdict in known for key in verdict.keys}))
        yield f"{len(known)} of them with a known difference between libraries: {keys}"
    counts, what = Counts.of(each.verdict for each in records), passes.split()[0]
    if counts.not_judged:
        yield f"{counts.not_judged} of {counts.total} {what} not judged"
    good = [each for each in records if isinstance(each.verdict, Passed | KnownDifference)]
    if shapes := {each.shape for each in good if each.shape}:
        yield f"{len(shapes)} different circuits"
    if shared := sum(bool(each.same_as) for each in records):
        yield (
            f"{shared} of {counts.total} {what} have the circuit of another, which was simulated"
        )
    if not (ran := [each for each in records if each.packets]):
        return
    figures = {
        "packets": sum(each.packets for each in ran),
        "cycles": sum(each.cycles for each in ran),
        "transfers of leaves": round(sum(each.metrics.get("transfers", 0) for each in ran)),
    }
    text = ", ".join(f"{figure} {name}" for name, figure in figures.items() if figure)
    yield f"{text}, {counts.failed} failures in {seconds:.0f} s"
    slowest = sorted(ran, key=lambda each: -each.seconds.total)
    median = slowest[len(ran) // 2].seconds.total
    text = ", ".join(f"{each.test.type} {each.seconds.total:.1f} s" for each in slowest[:5])
    yield f"median of a test {median:.2f} s; slowest: {text}"
    writers = Counter(name for each in ran for name in each.written_by)
    if writers:
        text = ", ".join(f"{name} {count} tests" for name, count in writers.items())
        yield f"wire bytes: {text}"


def run_and_record(
    tests: Sequence[Test],
    writer: ResultsWriter | None,
    run: Callable[[list[Test]], Made],
    lines_of: Callable[[Record], Iterable[str]],
    *,
    label: str,
    unit: str = "type",
) -> list[Record]:
    """Run the tests that have no record, and write their records; return all records, in order.

    * `writer`: the file of results, with the records of earlier sessions; `None`: there is none.
    * `run`: takes the tests to run.
    * `lines_of`: returns the lines to print about a new record.
    * `label`, `unit`: what the line of progress says, and the name of a test there.
    """
    records: dict[Test, Record] = {}
    if writer is not None:
        before = writer.before.records
        records = {test: before[test.key] for test in tests if test.key in before}
        if records:
            print(f"{len(records)} of {len(tests)} {unit}s have a result in {writer.path}")
    left = [test for test in tests if test not in records]
    what = f"verify, {label}: {unit}s"
    stage(what, len(records), len(tests))
    with closing(run(left)) as shares:
        for share in shares:
            if writer is not None:
                writer.add(*share)
            for record in share:
                records[record.test] = record
                for line in lines_of(record):
                    print(line)
            stage(what, len(records), len(tests))
    return [records[test] for test in tests]


def run_tests(
    work: Callable[[Any, Test], Record],
    context: object,
    tests: Sequence[Test],
    command: Callable[[Test], str],
    *,
    most: int = 1,
    jobs: int | None = None,
) -> Made:
    """Call ``work(context, test)`` for each test, and yield records when they are ready.

    A process gets a share of the tests at once, and their records come together: to sync a file
    takes some milliseconds. If it dies, the tests of the share run again one by one, to find the
    one at fault.

    * `command`: returns the command that repeats a test.
    * `most`: the largest number of tests of a share.

    Raises `ExecutorError`: see :func:`firm_hdl.jobs.executors.run_each`.
    """
    size = min(most, max(1, len(tests) // SHARES))
    shares = [tuple(tests[at : at + size]) for at in range(0, len(tests), size)]
    while shares:
        again: list[tuple[Test, ...]] = []
        tasks = [(share, (work, context, share)) for share in shares]
        with closing(run_each(_work_share, tasks, jobs=jobs)) as results:
            for share, result in results:
                if isinstance(result, ExecutorError) and len(share) > 1:
                    again += [(test,) for test in share]
                    continue
                if isinstance(result, Exception):
                    died = Failed((f"{type(result).__name__}: {result}",))
                    result = [Record(test=test, verdict=died) for test in share]
                yield [replace(each, command=command(each.test)) for each in result]
        shares = again


def _work_share(
    work: Callable[[Any, Test], Record], context: object, share: Sequence[Test]
) -> list[Record]:
    return [work(context, test) for test in share]
