"""The four possible verdicts of a test system, and how many tests have each.

Only `Passed` is a pass. Each verdict needs its evidence, and cannot be made without it. A pass
counts what was judged. A failure has a text. A missing judgement has a reason. A known difference
has a key, and counts what was compared without the known difference.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import ClassVar, TypeAlias

__all__ = [
    "Counts",
    "Failed",
    "KnownDifference",
    "NotJudged",
    "NotRun",
    "Passed",
    "Verdict",
    "clipped",
    "first_difference",
]

SILENT = "failed without saying why"
"""The text of a failure whose own text is blank."""


@dataclass(frozen=True, slots=True)
class Passed:
    """Everything that was judged is right.

    Raises `ValueError` if nothing was judged.
    """

    name: ClassVar[str] = "passed"
    details: ClassVar[tuple[str, ...]] = ()

    cases: int  # Number of packets, definitions or plans that were judged; at least 1.

    def __post_init__(self) -> None:
        _check_cases(self.cases)


@dataclass(frozen=True, slots=True)
class Failed:
    """Something is wrong, or the judge failed.

    Raises `ValueError` if there is no failure.
    """

    name: ClassVar[str] = "failed"

    # At least one text. A blank text becomes `SILENT`, because a tool that fails without a message
    # has failed, too.
    failures: tuple[str, ...]

    def __post_init__(self) -> None:
        if not self.failures:
            raise ValueError("A failure must have at least one text")
        texts = tuple(text if text.strip() else SILENT for text in self.failures)
        object.__setattr__(self, "failures", texts)

    @property
    def details(self) -> tuple[str, ...]:
        """The failures."""
        return self.failures


@dataclass(frozen=True, slots=True)
class NotJudged:
    """No oracle could judge the test.

    Raises `ValueError` if the reason is blank.
    """

    name: ClassVar[str] = "not judged"

    reason: str

    def __post_init__(self) -> None:
        if not self.reason.strip():
            raise ValueError("What was not judged must have a reason")

    @property
    def details(self) -> tuple[str, ...]:
        """The reason."""
        return (self.reason,)


@dataclass(frozen=True, slots=True)
class KnownDifference:
    """The readings or packets differ only as documented.

    Raises `ValueError` if there is no key, a blank one, or nothing was compared.
    """

    name: ClassVar[str] = "known difference"

    # Keys of the documented differences that explain the verdict; at least one.
    keys: tuple[str, ...]
    cases: int  # Number of cases that were compared without the known difference; at least 1.

    def __post_init__(self) -> None:
        if not self.keys or not all(key.strip() for key in self.keys):
            raise ValueError("A known difference must have the key that explains it")
        _check_cases(self.cases)

    @property
    def details(self) -> tuple[str, ...]:
        """The keys."""
        return self.keys


Verdict: TypeAlias = Passed | Failed | NotJudged | KnownDifference


@dataclass(frozen=True, slots=True)
class NotRun:
    """A test has no result, so it has no verdict."""

    name: ClassVar[str] = "not run"

    reason: str = "there is no result of it"


@dataclass(frozen=True, slots=True, kw_only=True)
class Counts:
    """The number of tests of each outcome. Tests with a known difference do not count as passed."""

    passed: int = 0
    known: int = 0
    failed: int = 0
    not_judged: int = 0
    not_run: int = 0

    @classmethod
    def of(cls, verdicts: Iterable[Verdict | NotRun]) -> Counts:
        """Count verdicts."""
        found = Counter(type(each) for each in verdicts)
        return cls(
            passed=found[Passed],
            known=found[KnownDifference],
            failed=found[Failed],
            not_judged=found[NotJudged],
            not_run=found[NotRun],
        )

    @property
    def total(self) -> int:
        """The number of all tests."""
        return self.passed + self.known + self.failed + self.not_judged + self.not_run

    @property
    def verdict(self) -> str:
        """The name of the worst outcome; ``not judged`` only if nothing was judged."""
        if self.failed:
            return Failed.name
        if self.not_run or not self.total:
            return NotRun.name
        if self.passed:
            return Passed.name
        return KnownDifference.name if self.known else NotJudged.name


def _check_cases(cases: int) -> None:
    if type(cases) is not int or cases < 1:
        raise ValueError(f"A verdict must rest on at least 1 case, not {cases!r}")


def clipped(text: str, most: int) -> str:
    """Return at most `most` characters of a text, and its length if it is longer."""
    return text if len(text) <= most else f"{text[:most]}... ({len(text)} characters)"


def first_difference(received: Sequence[object], expected: Sequence[object]) -> int:
    """Return the index of the first item that differs; their common length if none does."""
    pairs = enumerate(zip(received, expected, strict=False))
    return next((n for n, (a, b) in pairs if a != b), min(len(received), len(expected)))
