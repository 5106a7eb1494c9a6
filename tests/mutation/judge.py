"""Lets test systems at a mutant."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from threading import Lock

from tests.mutation.mutants import Mutant
from tests.mutation.results import Record
from tests.mutation.systems import ORDER, SYSTEMS, rest, stages
from tests.mutation.workshop import Run, Workshop

__all__ = ["BrokenTreeError", "Judge"]

# A fault may make tests slower, but not by so much.
LEAST_CPU_SECONDS = 30
FACTOR = 5


class BrokenTreeError(Exception):
    """Tests fail without any fault."""


class Judge:
    """Runs test systems, and knows how long their stages take without a fault.

    Parameters
    ----------
    first : bool
        Stop at the first system that notices, and leave out those that hardly can.
    with_rest : bool
        If no system noticed, run all other tests.
    depth : int or None
        Run only so many stages of each system.
    trusted_cpu_seconds : int or None
        Do not find out what a stage takes without a fault, and whether it passes: it does, and a
        run may take so long.
    """

    def __init__(
        self,
        *,
        first: bool,
        with_rest: bool,
        depth: int | None = None,
        trusted_cpu_seconds: int | None = None,
    ) -> None:
        self._first = first
        self._with_rest = with_rest
        self._depth = depth
        self._trusted = trusted_cpu_seconds
        self._seconds: dict[frozenset[str], float] = {}
        self._lock = Lock()

    def judge(self, workshop: Workshop, mutant: Mutant) -> Record:
        """Return what test systems say of a mutant."""
        runs: dict[str, Run] = {}
        done: set[str] = set()
        for system in ORDER[mutant.target] if self._first else SYSTEMS:
            groups = stages(workshop.root, system, mutant.path)[: self._depth]
            runs[system] = self._run(workshop, mutant, groups)
            done.update(file for group in groups for file in group)
            if self._first and runs[system].status != "passed":
                break
        if self._with_rest and all(run.status == "passed" for run in runs.values()):
            others = rest(workshop.root, mutant.path, done)
            runs["rest"] = self._run(workshop, mutant, [others] if others else [])
        return Record.of(mutant, runs)

    def _run(self, workshop: Workshop, mutant: Mutant, groups: Iterable[Sequence[str]]) -> Run:
        """Run stages until one of them notices."""
        seconds = 0.0
        for group in groups:
            most = self._trusted or max(LEAST_CPU_SECONDS, FACTOR * self._usual(workshop, group))
            with workshop.with_fault(mutant):
                run = workshop.run(group, most)
            seconds += run.cpu_seconds
            if run.status != "passed":
                return Run(status=run.status, by=run.by, cpu_seconds=round(seconds, 1))
        return Run(status="passed", by="", cpu_seconds=round(seconds, 1))

    def _usual(self, workshop: Workshop, group: Sequence[str]) -> float:
        """Run a stage without a fault, once; return its processor time."""
        key = frozenset(group)
        if key not in self._seconds:
            with self._lock:
                if key not in self._seconds:
                    run = workshop.run(group, 3600)
                    if run.status != "passed":
                        raise BrokenTreeError(f"fails without a fault: {run.by}")
                    self._seconds[key] = run.cpu_seconds
        return self._seconds[key]
