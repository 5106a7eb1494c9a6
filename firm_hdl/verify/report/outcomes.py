"""What became of every test that was planned: the input of all that a report says.

A test counts as passed only if there is a record that says so. One without a record was not run,
and one that rests on the circuit of another type is worth what that type's own record is worth.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

from firm_hdl.verify.results.file import Results
from firm_hdl.verify.results.records import Record, Test, settled
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed, Verdict

__all__ = ["VERDICTS", "Counts", "NotRun", "Outcome", "count", "failures_of", "outcomes_of"]


@dataclass(frozen=True, slots=True)
class NotRun:
    """There is no result of a test.

    Attributes
    ----------
    reason : str
    """

    name: ClassVar[str] = "not run"

    reason: str = "there is no result of it"


VERDICTS = (Passed.name, KnownDifference.name, Failed.name, NotJudged.name, NotRun.name)
"""Names of all that may become of a test."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What became of a test.

    Attributes
    ----------
    verdict : Verdict or NotRun
    record : Record or None
    circuit_of : str
        Name of the type whose circuit was simulated in place of this one's, which is the same.
    """

    test: Test
    verdict: Verdict | NotRun
    record: Record | None
    circuit_of: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Counts:
    """How many tests became what; those with a known difference alone are none that passed."""

    passed: int = 0
    known: int = 0
    failed: int = 0
    not_judged: int = 0
    not_run: int = 0

    @property
    def total(self) -> int:
        """All tests."""
        return self.passed + self.known + self.failed + self.not_judged + self.not_run

    @property
    def verdict(self) -> str:
        """The worst of them, one of `VERDICTS`; what nobody can judge counts if it is all."""
        if self.failed:
            return Failed.name
        if self.not_run or not self.total:
            return NotRun.name
        if self.passed:
            return Passed.name
        return KnownDifference.name if self.known else NotJudged.name


def count(outcomes: Iterable[Outcome]) -> Counts:
    """Count outcomes."""
    found = Counter(outcome.verdict.name for outcome in outcomes)
    return Counts(
        passed=found[Passed.name],
        known=found[KnownDifference.name],
        failed=found[Failed.name],
        not_judged=found[NotJudged.name],
        not_run=found[NotRun.name],
    )


def failures_of(outcome: Outcome) -> tuple[str, ...]:
    """Return what is wrong; nothing if nobody found anything."""
    return outcome.verdict.failures if isinstance(outcome.verdict, Failed) else ()


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
            if key not in records or not isinstance(records[key].verdict, Failed):
                records[key] = record
    return [_outcome(tests[key], records.get(key), records) for key in sorted(tests)]


def _outcome(test: Test, record: Record | None, records: Mapping[str, Record]) -> Outcome:
    if record is None:
        return Outcome(test=test, verdict=NotRun(), record=None)
    verdict: Verdict | NotRun = settled(record, records)
    if isinstance(record.verdict, Failed | NotJudged) or not record.same_as:
        return Outcome(test=test, verdict=verdict, record=record)
    other = records.get(record.same_as)
    circuit_of = record.same_as if other is None else other.test.type
    if other is None:
        verdict = NotRun(f"has the circuit of {circuit_of}, which was not run")
    return Outcome(test=test, verdict=verdict, record=record, circuit_of=circuit_of)
