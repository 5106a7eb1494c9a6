"""The score as a table, and the survivors."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tools.mutation.explained import Explanation, explain
from tools.mutation.results import Record
from tools.mutation.systems import REST, SYSTEMS
from tools.mutation.targets import TARGETS

__all__ = ["markdown"]

COLUMNS = (
    "mutants",
    "behaviour",
    *SYSTEMS,
    REST,
    "snapshot alone",
    "explained",
    "survived",
    "open",
    "score",
    "without explained",
)


def markdown(records: Iterable[Record], explanations: Sequence[Explanation], tree: str) -> str:
    """Write a report on the tree with that digest.

    The score is the share of judged mutants that tests of behaviour killed. Open mutants, which the
    tests that were run did not notice, count as not killed. So do mutants that only a snapshot
    noticed. The last column is the score without the survivors that have an explanation.
    """
    given = sorted(
        records, key=lambda each: (list(TARGETS).index(each.target), each.path, each.line)
    )
    judged = [each for each in given if each.status not in ("unloaded", "error")]
    rules = sorted({each.rule for each in judged})
    lines = ["# Mutation score", ""]
    for title, names in (("target", list(TARGETS)), ("rule", rules)):
        lines += [_line((title, *COLUMNS)), _line(["---"] * (len(COLUMNS) + 1))]
        for name in names:
            mine = [each for each in judged if getattr(each, title) == name]
            lines += [_line(_row(name, mine, explanations))] if mine else []
        lines += [_line(_row("all", judged, explanations)), ""]
    lines += [
        "`behaviour`: killed by a test that compares with what is right, not with what was",
        "written before; then, by which test system. Without `--first` a mutant may be killed by",
        "several; with it, only the first one counts.",
        "",
    ]
    unloaded = sum(each.status == "unloaded" for each in given)
    if unloaded:
        lines += [f"{unloaded} more are not counted: Python does not load them.", ""]
    other = sum(each.tree != tree for each in given)
    if other:
        lines += [f"{other} of these were found before files changed.", ""]
    for heading, status, wanted in (
        ("Survivors without an explanation", "survived", False),
        ("Noticed by snapshots alone", "snapshot", False),
        ("Not noticed so far; not all tests were run", "open", False),
        ("Runs that were ended from outside, to be repeated", "error", False),
        ("Survivors with an explanation", None, True),
    ):
        chosen = [
            (each, explain(each, explanations))
            for each in given
            if each.status not in ("killed", "unloaded") and status in (None, each.status)
        ]
        lines += _section(heading, [pair for pair in chosen if (pair[1] is not None) == wanted])
    return "\n".join(lines) + "\n"


def _row(name: str, records: list[Record], explanations: Sequence[Explanation]) -> list[str]:
    killed = [each for each in records if each.status == "killed"]
    snapshot = [each for each in records if each.status == "snapshot"]
    alive = [each for each in records if each.status in ("survived", "open")]
    explained = [each for each in alive if explain(each, explanations)]
    rest = [each for each in alive if each not in explained]
    by = [sum(system in each.killers for each in killed) for system in (*SYSTEMS, REST)]
    survived = sum(each.status == "survived" for each in rest)
    counts = [len(records), len(killed), *by, len(snapshot), len(explained), survived]
    scores = [_share(len(killed), len(records) - without) for without in (0, len(explained))]
    return [name, *map(str, counts), str(len(rest) - survived), *scores]


def _share(part: int, whole: int) -> str:
    return f"{100 * part / whole:.1f} %" if whole else "-"


def _line(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _section(title: str, chosen: list[tuple[Record, Explanation | None]]) -> list[str]:
    if not chosen:
        return []
    lines = [f"## {title}", ""]
    for record, explanation in chosen:
        by = ", ".join(record.runs[name].by for name in record.killers)
        place = f"* `{record.path}:{record.line}`, {record.rule}, in `{record.scope}`"
        lines.append(f"{place}, by {by}" if by else place)
        if explanation:
            lines.append(f"  {explanation.kind}: {explanation.why}")
        lines += ["", "  ```diff", *(f"  - {line}" for line in record.old.split("\n"))]
        lines += [*(f"  + {line}" for line in record.new.split("\n")), "  ```", ""]
    return lines
