"""Results as JSON lines: one per mutant, the last one of a mutant counts."""

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

# In place of a test system: Python itself refused the mutant.
LOADING = "loading"


@dataclass(frozen=True)
class Record:
    """What happened to a mutant.

    Attributes
    ----------
    key, target, path, line, rule, scope, old, new
        As in `Mutant`.
    runs : mapping of str to Run
        Test system to what it said, of those that had anything to say.
    tests : int
        How many tests may notice it.
    complete : bool
        Whether these are all, and all were run as far as nobody noticed.
    tree : str
        Names the program and the tests that it was found with.
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
        """The test systems that noticed; snapshots are one."""
        return [name for name, run in self.runs.items() if run.status in ("failed", "timeout")]

    @property
    def status(self) -> str:
        """What it came to.

        ``killed`` by a test of behaviour; by a ``snapshot`` alone; ``survived`` all tests;
        ``unloaded`` if Python does not load it, so that it is no fault that somebody would leave;
        ``open`` if some tests were not run, or ``error``.
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
    """Return the records of a file by key. A line that is not whole does not count."""
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
    """Add a record to a file, after what an interrupted run has left there."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a+b") as file:
        if file.tell():
            file.seek(-1, 2)
            if file.read(1) != b"\n":
                file.write(b"\n")
        file.write(json.dumps(asdict(record)).encode() + b"\n")
