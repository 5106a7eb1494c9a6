"""Counts of the verdicts of oracles, and groups of tests that were not judged or not run."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from firm_hdl.verify.report.outcomes import NotRun, Outcome
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed

__all__ = ["OracleSum", "Remark", "oracle_sums", "reason_groups", "remarks_of"]


@dataclass(frozen=True, slots=True, kw_only=True)
class OracleSum:
    """The verdicts of an oracle on the definitions of a distribution.

    Attributes
    ----------
    distro, oracle : str
    agree, refused, known, differ, not_judged : int
        Numbers of definitions. `refused` are those among `agree` that firm-hdl and the oracle
        refuse.
    """

    distro: str
    oracle: str
    agree: int = 0
    refused: int = 0
    known: int = 0
    differ: int = 0
    not_judged: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Remark:
    """A known difference from an oracle, or a reason why the oracle did not judge.

    Attributes
    ----------
    oracle : str
    verdict : str
        ``known difference`` or ``not judged``.
    what : str
        Key of a known difference, or a reason.
    count : int
        The number of definitions.
    example : str
        Name of one of these definitions.
    """

    oracle: str
    verdict: str
    what: str
    count: int
    example: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Reason:
    """Tests with the same text, apart from names and numbers.

    Attributes
    ----------
    text : str
        The text of the first of these tests.
    outcomes : tuple of Outcome
    """

    text: str
    outcomes: tuple[Outcome, ...]


def oracle_sums(outcomes: Iterable[Outcome]) -> tuple[OracleSum, ...]:
    """Count verdicts by distribution and oracle."""
    counts: dict[tuple[str, str], Counter[str]] = defaultdict(Counter)
    for outcome in outcomes:
        for each in outcome.record.verdicts if outcome.record is not None else ():
            found = counts[outcome.test.distro, each.oracle]
            found[each.verdict.name] += 1
            found["refused"] += each.is_refused
    return tuple(
        OracleSum(
            distro=distro,
            oracle=oracle,
            agree=found[Passed.name],
            refused=found["refused"],
            known=found[KnownDifference.name],
            differ=found[Failed.name],
            not_judged=found[NotJudged.name],
        )
        for (distro, oracle), found in sorted(counts.items())
    )


def remarks_of(outcomes: Iterable[Outcome]) -> tuple[Remark, ...]:
    """List known differences and reasons not to judge, the most frequent of an oracle first."""
    names: dict[tuple[str, str, str], list[str]] = defaultdict(list)
    texts: dict[tuple[str, str, str], str] = {}
    for outcome in outcomes:
        for each in outcome.record.verdicts if outcome.record is not None else ():
            for detail in () if isinstance(each.verdict, Failed) else each.verdict.details:
                key = (each.oracle, each.verdict.name, _without_names(detail))
                texts.setdefault(key, detail)
                names[key].append(outcome.test.type)
    ordered = sorted(names, key=lambda key: (key[0], key[1], -len(names[key]), key[2]))
    return tuple(
        Remark(
            oracle=key[0],
            verdict=key[1],
            what=texts[key],
            count=len(names[key]),
            example=names[key][0],
        )
        for key in ordered
    )


def reason_groups(
    outcomes: Iterable[Outcome], text_of: Callable[[Outcome], str] | None = None
) -> list[Reason]:
    """Group tests that were not judged for the same reason, the largest group first.

    Parameters
    ----------
    text_of : callable or None
        Returns the text to group a test by; `None`: why a test was not judged or not run.
    """
    groups: dict[str, list[Outcome]] = defaultdict(list)
    texts: dict[str, str] = {}
    for outcome in outcomes:
        text = (text_of or _reason_of)(outcome)
        key = _without_names(text)
        texts.setdefault(key, text)
        groups[key].append(outcome)
    found = [Reason(text=texts[key], outcomes=tuple(own)) for key, own in groups.items()]
    return sorted(found, key=lambda reason: -len(reason.outcomes))


def _reason_of(outcome: Outcome) -> str:
    """Return why a test was not judged or not run; empty if it was judged."""
    return outcome.verdict.reason if isinstance(outcome.verdict, NotJudged | NotRun) else ""


def _without_names(text: str) -> str:
    """Return a text without the parts that differ between types: names with ``/``, and numbers."""
    return re.sub(r"\d[\d,.]*", "0", re.sub(r"[^\s'\"]*/[^\s'\",;:]*", "...", text))
