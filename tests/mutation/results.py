"""Results as JSON lines: one per mutant, the last one of a mutant counts."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from tests.mutation.mutants import Mutant
from tests.mutation.workshop import Run

__all__ = ["Record", "append", "read"]


@dataclass(frozen=True)
class Record:
    """What happened to a mutant.

    Attributes
    ----------
    key, target, path, line, rule, scope, old, new
        As in `Mutant`.
    runs : mapping of str to Run
        Test system to what it said, in the order in which they were run.
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

    @classmethod
    def of(cls, mutant: Mutant, runs: Mapping[str, Run]) -> Record:
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
        )

    @property
    def killers(self) -> list[str]:
        """The test systems that noticed."""
        return [system for system, run in self.runs.items() if run.status != "passed"]

    @property
    def status(self) -> str:
        """``killed``; ``survived`` all of the tests; ``open`` if some of them were not run."""
        if self.killers:
            return "killed"
        return "survived" if "rest" in self.runs else "open"


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
    """Add a record to a file, behind what an interrupted run has left there."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a+b") as file:
        if file.tell():
            file.seek(-1, 2)
            if file.read(1) != b"\n":
                file.write(b"\n")
        file.write(json.dumps(asdict(record)).encode() + b"\n")
