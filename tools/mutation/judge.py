"""Run tests on a mutant."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tools.mutation.map.coverage_map import CoverageMap, Test
from tools.mutation.map.selection import FOREIGN, batches, judges
from tools.mutation.mutants import Mutant
from tools.mutation.results import LOADING, Record
from tools.mutation.systems import REST, SNAPSHOT, SYSTEMS, system_of
from tools.mutation.workshop import Run, Workshop

__all__ = ["Judge"]

# A run of tests is stopped at so many times its usual processor time.
FACTOR = 5
# The limit on elapsed time is higher, because other programs may use the machine.
WALL_FACTOR = 20
WALL_SECONDS = 120
# Number of runs if something from outside ends a run: its result means nothing.
ATTEMPTS = 2


class Judge:
    """Runs the tests that may notice a mutant.

    Parameters
    ----------
    found : CoverageMap
    first : bool
        Stop at the first test that notices the mutant. Otherwise run all test systems, one by one.
        Snapshots run only if nothing else notices the mutant.
    least_cpu_seconds : float
        Smallest time limit of a run of tests.
    most_cpu_seconds : float or None
        Largest total time of the tests of a mutant. If the tests take longer, the mutant stays
        open.
    """

    def __init__(
        self,
        found: CoverageMap,
        *,
        first: bool,
        least_cpu_seconds: float = 30,
        most_cpu_seconds: float | None = None,
    ) -> None:
        self._found = found
        self._first = first
        self._least = least_cpu_seconds
        self._most = most_cpu_seconds

    def judge(self, workshop: Workshop, mutant: Mutant) -> Record:
        """Return the results of the tests of a mutant."""
        if not self._loads(workshop, mutant):
            runs = {LOADING: Run(status="failed", by=mutant.path, cpu_seconds=0)}
            return Record.of(mutant, runs, tests=0, complete=True, tree=self._found.tree)
        tests = judges(workshop.root, self._found, mutant)
        behaviour = [test for test in tests if not test.snapshot]
        asked = affordable(behaviour, self._most)
        runs = {}
        for system in [None] if self._first else [*SYSTEMS, REST]:
            mine = [test for test in asked if system in (None, system_of(test.name))]
            run = self._run(workshop, mutant, mine)
            # If all tests pass, each of their systems gets this result.
            names = {system_of(test.name) for test in mine}
            if run.status != "passed":
                names = {system or system_of(run.by)}
            runs.update(dict.fromkeys(sorted(names), run))
        snapshots = affordable([test for test in tests if test.snapshot], self._most)
        if snapshots and all(run.status == "passed" for run in runs.values()):
            runs[SNAPSHOT] = self._run(workshop, mutant, snapshots)
        complete = self._found.complete and len(asked) == len(behaviour)
        return Record.of(mutant, runs, tests=len(tests), complete=complete, tree=self._found.tree)

    def _loads(self, workshop: Workshop, mutant: Mutant) -> bool:
        if not mutant.path.endswith(".py") or Path(mutant.path).name.startswith(FOREIGN):
            return True
        with workshop.with_fault(mutant):
            return workshop.loads(mutant.path)

    def _run(self, workshop: Workshop, mutant: Mutant, tests: Sequence[Test]) -> Run:
        """Run batches until one test notices the mutant."""
        seconds = 0.0
        status, by = "passed", ""
        for batch in batches(tests):
            run = self._batch(workshop, mutant, batch)
            seconds += run.cpu_seconds
            if run.status != "passed":
                status, by = run.status, run.by
                break
        return Run(status=status, by=by, cpu_seconds=round(seconds, 1))

    def _batch(self, workshop: Workshop, mutant: Mutant, batch: Sequence[Test]) -> Run:
        usual = sum(test.cpu_seconds for test in batch)
        most = max(self._least, FACTOR * usual)
        for _ in range(ATTEMPTS):
            with workshop.with_fault(mutant):
                run = workshop.run_tests(
                    [test.name for test in batch], most, WALL_SECONDS + WALL_FACTOR * usual
                )
            if run.status != "error":
                break
        return run


def affordable(tests: Sequence[Test], cpu_seconds: float | None) -> list[Test]:
    """Return the first tests that together fit in a time; at least one."""
    if cpu_seconds is None:
        return list(tests)
    result: list[Test] = []
    for test in tests:
        cpu_seconds -= test.cpu_seconds
        if cpu_seconds < 0 and result:
            break
        result.append(test)
    return result
