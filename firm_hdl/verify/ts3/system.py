"""TS3 for the command: runs types with a progress bar, and prints failures and a summary."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from firm_hdl.verify.references.clients import find_references
from firm_hdl.verify.results.file import ResultsWriter
from firm_hdl.verify.results.records import Record, Test
from firm_hdl.verify.results.verdict import Failed
from firm_hdl.verify.simulators.programs import simulator
from firm_hdl.verify.systems.options import Options, Request
from firm_hdl.verify.systems.system import (
    Made,
    System,
    counted,
    failure_of,
    kept,
    print_passes,
    run_tests,
    wire_of,
)
from firm_hdl.verify.systems.tasks import TypeUnderTest
from firm_hdl.verify.ts3.acceptance import accepted
from firm_hdl.verify.ts3.replay import replay
from firm_hdl.verify.ts3.task import command_of, same_circuits, test_of

__all__ = ["Ts3"]


class Ts3(System):
    """The test system of TS3. A test is one type with one set of options.

    Raises `ProgramMissingError` or `ClientMissingError`: when the system is entered.
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
        """The simulator and its version."""
        return {"simulator": f"{self._request.simulator} {self._version}".strip()}

    def run(self, writer: ResultsWriter | None) -> list[Record]:
        """Run all tasks with each of the options.

        Raises `ExecutorError`.
        """
        began = time.perf_counter()
        found = [each for one in self._options for each in self._run(one, writer)]
        failures = sum(isinstance(each.verdict, Failed) for each in found)
        print(f"{time.perf_counter() - began:.0f} s, {failures} failures")
        return found

    def _run(self, options: Options, writer: ResultsWriter | None) -> list[Record]:
        """Run all tasks with one set of options."""
        tests = {task: test_of(task, options) for task in self._tasks}
        same: dict[Test, Test] = {}
        if self._request.shares_circuits:
            pairs = same_circuits(self._tasks, options).items()
            same = {tests[task]: tests[other] for task, other in pairs}
        notes: Counter[str] = Counter()

        def lines_of(record: Record) -> Iterator[str]:
            notes[record.note] += 1
            yield from failure_of(f"{record.test.type} ({', '.join(record.test.distros)})", record)
            # The note of a replay has the number of messages, so it is always printed.
            if record.note and (notes[record.note] == 1 or options.bags):
                yield f"note: {record.test.type} ({record.test.distro}): {record.note}"

        def run(left: Sequence[Test]) -> Made:
            for is_shared in (False, True):
                made = run_tests(
                    replay if options.bags else accepted,
                    replace(options, simulated=not is_shared),
                    [test for test in left if (test in same) == is_shared],
                    lambda test: command_of(options, test.type, distro=test.distro),
                    jobs=self._request.jobs,
                )
                for share in made:
                    for record in share:
                        record.same_as = same[record.test].key if is_shared else ""
                    yield share

        label = f"{options.bus_bytes}-byte bus"
        records = kept(list(tests.values()), writer, run, lines_of, label=label)
        if not options.bags:
            _repeat(notes)
        print_passes(records, "types pass")
        if shared := sum(bool(record.same_as) for record in records):
            print(
                f"{shared} of {len(records)} types have the circuit of another, which was simulated"
            )
        _summarize([record for record in records if record.cycles], options)
        return counted(records)


def _repeat(notes: Mapping[str, int]) -> None:
    """Print for each note how many further types have it."""
    for note, count in notes.items():
        if note and count > 1:
            print(f"note: {count - 1} more types: {note}")


def _summarize(records: Sequence[Record], options: Options) -> None:
    """Print figures of the types that were simulated."""
    if not records:
        return
    seconds = sorted(record.seconds.total for record in records)
    cycles = sum(record.cycles for record in records)
    print(
        f"{len(records)} different types, {sum(r.packets for r in records)} packets, "
        f"{cycles} cycles; seconds per type: median {seconds[len(seconds) // 2]:.2f}, "
        f"most {seconds[-1]:.1f}, {sum(seconds):.0f} in total"
    )
    slowest = sorted(records, key=lambda record: -record.seconds.total)[:5]
    print("slowest:", ", ".join(f"{each.test.type} {each.seconds.total:.1f} s" for each in slowest))
    writers = Counter(name for record in records for name in record.written_by)
    text = ", ".join(f"{name} {count} types" for name, count in writers.items())
    print("wire bytes:", text or "no library wrote any")
    if options.simulator != "python":
        passed = sum(not record.failures for record in records)
        print(f"{options.simulator}: replayed every cycle of {len(records)} types, {passed} pass")
