"""The outcome of every planned test: the input of a report.

A test counts as passed only if a record says so. A test without a record was not run. A test that
relies on the circuit of another type passes only if the test of that type has passed, too.
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
    """A test has no result.

    Attributes
    ----------
    reason : str
    """

    name: ClassVar[str] = "not run"

    reason: str = "there is no result of it"


VERDICTS = (Passed.name, KnownDifference.name, Failed.name, NotJudged.name, NotRun.name)
"""Names of all outcomes of a test."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """The outcome of a test.

    Attributes
    ----------
    verdict : Verdict or NotRun
    record : Record or None
    circuit_of : str
        Name of the type whose equal circuit was simulated instead of the circuit of this type.
    """

    test: Test
    verdict: Verdict | NotRun
    record: Record | None
    circuit_of: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Counts:
    """The number of tests of each outcome. Tests with a known difference do not count as passed."""

    passed: int = 0
    known: int = 0
    failed: int = 0
    not_judged: int = 0
    not_run: int = 0

    @property
    def total(self) -> int:
        """The number of all tests."""
        return self.passed + self.known + self.failed + self.not_judged + self.not_run

    @property
    def verdict(self) -> str:
        """The worst outcome, one of `VERDICTS`; ``not judged`` only if nothing was judged."""
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
    """Return the failures of a test; none if it did not fail."""
    return outcome.verdict.failures if isinstance(outcome.verdict, Failed) else ()


def outcomes_of(files: Sequence[Results]) -> list[Outcome]:
    """Return the outcome of every test of some files, sorted by key.

    A test that is in several files counts as failed if it failed in one of them.
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
