"""What the oracles of definitions said in the records of many tests."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

from firm_hdl.verify.results.records import Record
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed

__all__ = ["OracleSum", "Remark", "oracle_sums", "remarks_of", "without_names"]


@dataclass(frozen=True, slots=True, kw_only=True)
class OracleSum:
    """The verdicts of an oracle on the definitions of a distribution."""

    distro: str
    oracle: str
    # Numbers of definitions. `refused` are those among `agree` that firm-hdl and the oracle refuse.
    agree: int = 0
    refused: int = 0
    known: int = 0
    differ: int = 0
    not_judged: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Remark:
    """A known difference from an oracle, or a reason why the oracle did not judge."""

    oracle: str
    verdict: str  # `known difference` or `not judged`.
    what: str  # Key of a known difference, or a reason.
    count: int  # The number of definitions.
    example: str  # Name of one of these definitions.


def oracle_sums(records: Iterable[Record]) -> tuple[OracleSum, ...]:
    """Count verdicts by distribution and oracle."""
    counts: dict[tuple[str, str], Counter[str]] = defaultdict(Counter)
    for record in records:
        for each in record.verdicts:
            found = counts[record.test.distro, each.oracle]
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


def remarks_of(records: Iterable[Record]) -> tuple[Remark, ...]:
    """List known differences and reasons not to judge, the most frequent of an oracle first."""
    names: dict[tuple[str, str, str], list[str]] = defaultdict(list)
    texts: dict[tuple[str, str, str], str] = {}
    for record in records:
        for each in record.verdicts:
            for detail in () if isinstance(each.verdict, Failed) else each.verdict.details:
                key = (each.oracle, each.verdict.name, without_names(detail))
                texts.setdefault(key, detail)
                names[key].append(record.test.type)
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


def without_names(text: str) -> str:
    """Return a text without the parts that differ between types: names with ``/``, and numbers."""
    return re.sub(r"\d[\d,.]*", "0", re.sub(r"[^\s'\"]*/[^\s'\",;:]*", "...", text))
