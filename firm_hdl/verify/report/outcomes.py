"""What became of every test that was planned: the input of all that a report says.

A test counts as passed only if there is a record that says so. One without a record was not run,
and one that rests on the circuit of another type is worth what that type's own record is worth.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal, get_args

from firm_hdl.verify.records import Record, Test
from firm_hdl.verify.results import Results

__all__ = ["VERDICTS", "Counts", "Outcome", "Verdict", "count", "outcomes_of"]

Verdict = Literal["pass", "fail", "skipped", "not run"]
VERDICTS: tuple[Verdict, ...] = get_args(Verdict)


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What became of a test.

    Attributes
    ----------
    verdict : str
        One of `VERDICTS`.
    record : Record or None
    failures : tuple of str
    circuit_of : str
        Name of the type whose circuit was simulated in place of this one's, which is the same.
    """

    test: Test
    verdict: Verdict
    record: Record | None
    failures: tuple[str, ...] = ()
    circuit_of: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Counts:
    """How many tests became what."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0
    not_run: int = 0

    @property
    def total(self) -> int:
        """All tests."""
        return self.passed + self.failed + self.skipped + self.not_run

    @property
    def verdict(self) -> Verdict:
        """The worst of them."""
        if self.failed:
            return "fail"
        if self.not_run or not self.total:
            return "not run"
        return "pass" if self.passed else "skipped"


def count(outcomes: Iterable[Outcome]) -> Counts:
    """Count outcomes."""
    found = dict.fromkeys(VERDICTS, 0)
    for outcome in outcomes:
        found[outcome.verdict] += 1
    return Counts(
        passed=found["pass"],
        failed=found["fail"],
        skipped=found["skipped"],
        not_run=found["not run"],
    )


def outcomes_of(files: Sequence[Results]) -> list[Outcome]:
    """Return the outcome of every test of some files, sorted by key.

    A test that is in several files failed if it failed in one.
    """
    tests: dict[str, Test] = {}
    records: dict[str, Record] = {}
    for file in files:
        tests.update((test.key, test) for test in file.planned)
        for key, record in file.records.items():
            tests.setdefault(key, record.test)
            if key not in records or records[key].status != "fail":
                records[key] = record
    return [_outcome(tests[key], records.get(key), records) for key in sorted(tests)]


def _outcome(test: Test, record: Record | None, records: dict[str, Record]) -> Outcome:
    if record is None:
        return Outcome(test=test, verdict="not run", record=None)
    if record.status != "pass" or not record.same_as:
        return Outcome(test=test, verdict=record.status, record=record, failures=record.failures)
    other = records.get(record.same_as)
    verdict: Verdict = "fail"
    why = ""
    if other is None or other.status == "skipped":
        verdict = "not run"
    elif other.shape != record.shape:
        why = f"not the circuit of '{record.same_as}', as its record says"
    elif other.status == "fail":
        why = f"has the circuit of '{record.same_as}', which failed"
    else:
        verdict = "pass"
    return Outcome(
        test=test,
        verdict=verdict,
        record=record,
        failures=(why,) if why else (),
        circuit_of=record.same_as if other is None else other.test.type,
    )
