"""The score as a table, and what survived."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tests.mutation.explained import Explanation, explain
from tests.mutation.results import Record
from tests.mutation.systems import SYSTEMS
from tests.mutation.targets import TARGETS

__all__ = ["markdown"]

COLUMNS = (
    "target",
    "mutants",
    "killed",
    *SYSTEMS,
    "rest",
    "explained",
    "survived",
    "open",
    "score",
)


def markdown(records: Iterable[Record], explanations: Sequence[Explanation], tree: str) -> str:
    """Write a report on the tree of that name.

    The score is what was killed, of all that was judged. What is open, not noticed by those tests
    that were run, counts as not killed.
    """
    given = sorted(
        records, key=lambda each: (list(TARGETS).index(each.target), each.path, each.line)
    )
    rows = [
        _row(target, [each for each in given if each.target == target], explanations)
        for target in TARGETS
    ]
    rows.append(_row("all", given, explanations))
    lines = ["# Mutation score", "", _line(COLUMNS), _line(["---"] * len(COLUMNS))]
    lines += [_line(row) for row in rows]
    lines += [
        "",
        "Under each test system: how many mutants it killed. Without `--first` a mutant may",
    ]
    lines += ["be killed by several; with it, only the first one counts.", ""]
    other = sum(each.tree != tree for each in given)
    if other:
        lines += [f"{other} of these were found before files changed.", ""]
    for title, status, wanted in (
        ("Survivors without an explanation", "survived", False),
        ("Not noticed so far; not all tests were run", "open", False),
        ("Runs that were ended from outside, to be repeated", "error", False),
        ("Survivors with an explanation", None, True),
    ):
        chosen = [
            (each, explain(each, explanations))
            for each in given
            if each.status != "killed" and status in (None, each.status)
        ]
        lines += _section(title, [pair for pair in chosen if (pair[1] is not None) == wanted])
    return "\n".join(lines) + "\n"


def _row(name: str, records: list[Record], explanations: Sequence[Explanation]) -> list[str]:
    killed = [each for each in records if each.status == "killed"]
    alive = [each for each in records if each.status != "killed"]
    explained = [each for each in alive if explain(each, explanations)]
    rest = [each for each in alive if each not in explained]
    by = [sum(system in each.killers for each in killed) for system in (*SYSTEMS, "rest")]
    survived = sum(each.status == "survived" for each in rest)
    score = f"{100 * len(killed) / len(records):.1f} %" if records else "-"
    counts = [len(records), len(killed), *by, len(explained), survived, len(rest) - survived]
    return [name, *map(str, counts), score]


def _line(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _section(title: str, chosen: list[tuple[Record, Explanation | None]]) -> list[str]:
    if not chosen:
        return []
    lines = [f"## {title}", ""]
    for record, explanation in chosen:
        lines.append(f"* `{record.path}:{record.line}`, {record.rule}, in `{record.scope}`")
        if explanation:
            lines.append(f"  {explanation.kind}: {explanation.why}")
        lines += ["", "  ```diff", *(f"  - {line}" for line in record.old.split("\n"))]
        lines += [*(f"  + {line}" for line in record.new.split("\n")), "  ```", ""]
    return lines
