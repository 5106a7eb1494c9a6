"""TS3 for the command: runs types with a progress bar, and prints failures and a summary."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from firm_hdl.verify.references.clients import find_references
from firm_hdl.verify.results.file import ResultsWriter
from firm_hdl.verify.results.records import Record, Test
from firm_hdl.verify.simulators.programs import simulator
from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.verify.systems.system import (
    Made,
    TypesSystem,
    failure_of,
    run_and_record,
    run_tests,
    summary_of,
    wire_of,
)
from firm_hdl.verify.ts3.acceptance import accepted
from firm_hdl.verify.ts3.replay import replay
from firm_hdl.verify.ts3.task import as_test, command_of, same_circuits

__all__ = ["Ts3"]


class Ts3(TypesSystem):
    """The test system of TS3. A test is one type with one set of options.

    Raises `ProgramMissingError` or `ClientMissingError`: when the system is entered.
    """

    name = "ts3"
    _version = ""

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

    def _tests(self, options: CaseOptions) -> list[Test]:
        return [as_test(task, options) for task in self._tasks]

    @property
    def options(self) -> Mapping[str, Any]:
        """The simulator and its version."""
        return {"simulator": f"{self._request.simulator} {self._version}".strip()}

    def records(self, writer: ResultsWriter | None) -> list[Record]:
        """Run all types with each of the options, and print failures and notes.

        Raises `ExecutorError`.
        """
        return [each for one in self._request.each_width for each in self._records(one, writer)]

    def _records(self, options: CaseOptions, writer: ResultsWriter | None) -> list[Record]:
        """Run all types with one set of options."""
        tests = dict(zip(self._tasks, self._tests(options), strict=True))
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

        records = run_and_record(
            list(tests.values()), writer, run, lines_of, label=f"{options.bus_bytes}-byte bus"
        )
        for note, count in notes.items() if not options.bags else ():
            if note and count > 1:
                print(f"note: {count - 1} more types: {note}")
        return records

    def summary(self, records: Sequence[Record], seconds: float) -> Iterator[str]:
        """Yield lines about the types, and one about the simulator of exported text."""
        yield from summary_of(records, self.passes, seconds)
        simulated = [each for each in records if each.cycles]
        if self._request.simulator != "python" and simulated:
            passed = sum(not each.failures for each in simulated)
            yield (
                f"{self._request.simulator}: replayed every cycle of {len(simulated)} types, "
                f"{passed} pass"
            )
