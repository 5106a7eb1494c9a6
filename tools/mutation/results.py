"""Results as JSON lines, one per mutant; if a mutant has several lines, the last one counts."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from tools.mutation.mutants import Mutant
from tools.mutation.systems import SNAPSHOT
from tools.mutation.workshop import Run

__all__ = ["LOADING", "Record", "append", "read"]

# Used instead of a test system if Python itself could not load the mutant.
LOADING = "loading"


@dataclass(frozen=True)
class Record:
    """The results of a mutant.

    Attributes
    ----------
    key, target, path, line, rule, scope, old, new
        As in `Mutant`.
    runs : mapping of str to Run
        Results by test system, for the systems that have tests for the mutant.
    tests : int
        Number of tests that may notice the mutant.
    complete : bool
        Whether no test of behaviour that may notice the mutant was left out.
    tree : str
        Digest of the program and the tests that gave the results.
    """

    key: str
    target: str
    path: str
    line: int
    rule: str
    scope: str
    old: str
    new: str
    runs: Mapping[str, Run] = field(default_factory=dict)
    tests: int = 0
    complete: bool = False
    tree: str = ""

    @classmethod
    def of(
        cls, mutant: Mutant, runs: Mapping[str, Run], *, tests: int, complete: bool, tree: str
    ) -> Record:
        """Make the record of a mutant."""
        return cls(
            key=mutant.key,
            target=mutant.target,
            path=mutant.path,
            line=mutant.line,
            rule=mutant.change.rule,
            scope=mutant.change.scope,
            old=mutant.place.old,
            new=mutant.place.new,
            runs=runs,
            tests=tests,
            complete=complete,
            tree=tree,
        )

    @property
    def killers(self) -> list[str]:
        """The test systems that noticed the mutant; snapshots are one of them."""
        return [name for name, run in self.runs.items() if run.status in ("failed", "timeout")]

    @property
    def status(self) -> str:
        """The result of all runs.

        ``killed`` by a test of behaviour; ``snapshot`` if only a snapshot noticed the mutant;
        ``survived`` all tests; ``unloaded`` if Python cannot load it, so that the author would
        notice the fault at once; ``open`` if some tests were not run; or ``error``.
        """
        if LOADING in self.runs:
            return "unloaded"
        if set(self.killers) - {SNAPSHOT}:
            return "killed"
        if any(run.status == "error" for run in self.runs.values()):
            return "error"
        if self.killers:
            return "snapshot"
        return "survived" if self.complete else "open"


def read(path: Path) -> dict[str, Record]:
    """Return the records of a file by key. Incomplete lines are ignored."""
    records: dict[str, Record] = {}
    if not path.exists():
        return records
    for line in path.read_text(encoding="utf-8").split("\n"):
        try:
            given: dict[str, Any] = json.loads(line)
            runs = {system: Run(**run) for system, run in given.pop("runs").items()}
            record = Record(**given, runs=runs)
        except (ValueError, KeyError, TypeError, AttributeError):
            continue
        records[record.key] = record
    return records


def append(path: Path, record: Record) -> None:
    """Add a record to a file, even if an interrupted run has left an incomplete line."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a+b") as file:
        if file.tell():
            file.seek(-1, 2)
            if file.read(1) != b"\n":
                file.write(b"\n")
        file.write(json.dumps(asdict(record)).encode() + b"\n")
