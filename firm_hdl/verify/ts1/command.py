"""What ``firm-hdl verify --systems ts1`` prints."""

from __future__ import annotations

import time
from collections.abc import Sequence

from tqdm import tqdm

from firm_hdl.verify.ts1.judge import Outcome
from firm_hdl.verify.ts1.run import Selection, Tally, Ts1Run

__all__ = ["run_ts1"]

_MOST_DETAILS = 8


def run_ts1(selection: Selection, oracles: Sequence[str] = (), jobs: int | None = None) -> int:
    """Judge definitions, and print what came of it.

    Returns
    -------
    int
        How many definitions differ, plus one for each oracle that was asked for by name and is not
        here.

    Raises
    ------
    DefinitionError
        As `Ts1Run` does.
    """
    began = time.perf_counter()
    tally = Tally()
    with Ts1Run(selection, oracles, jobs) as run:
        label = f"ts1 {selection.distro}"
        with tqdm(total=run.total, unit="definition", desc=label, disable=None) as bar:
            for count, part in run.tallies():
                for outcome, number in part.differing:
                    tqdm.write(_difference(selection, outcome, number))
                tally.update(part)
                bar.update(count)
        for line in _summary(run, tally):
            print(line)
        what = ("mutation" if selection.mutations else "definition") + "s" * (run.total != 1)
        seconds = time.perf_counter() - began
        print(f"{run.total} {what}, {seconds:.0f} s, {len(tally.differing)} differences")
        return len(tally.differing) + (len(run.missing) if oracles else 0)


def _difference(selection: Selection, outcome: Outcome, number: int | None) -> str:
    lines = [f"DIFFERS {outcome.case.full_name}.{outcome.case.language}, {outcome.oracle}"]
    if number is not None:
        lines += [f"    {line}" for line in outcome.case.changes]
    lines += [f"    {detail}" for detail in outcome.details[:_MOST_DETAILS]]
    if len(outcome.details) > _MOST_DETAILS:
        lines.append(f"    and {len(outcome.details) - _MOST_DETAILS} more")
    return "\n".join([*lines, f"    again: {selection.command(outcome.case, number)}"])


def _summary(run: Ts1Run, tally: Tally) -> list[str]:
    lines = []
    for outcome in tally.shown:
        details = "both refuse" if outcome.is_refused else "; ".join(outcome.details)
        said = f"{outcome.verdict}: {details}" if details else outcome.verdict
        words = [outcome.case.full_name, outcome.oracle, said]
        lines.append("  ".join(words))
    lines.append(f"{'oracle':24} {'agree':>7} {'known':>7} {'differ':>7} {'not judged':>11}")
    for name, version in run.versions.items():
        counts = [tally.verdicts[name, v] for v in ("agrees", "known", "differs", "not judged")]
        refused = f"  ({tally.refused[name]} refused by both)" if tally.refused[name] else ""
        lines.append(
            f"{f'{name} {version}':24} {counts[0]:7} {counts[1]:7} {counts[2]:7} {counts[3]:11}"
            f"{refused}"
        )
    lines += [f"{name:24} is not here: {why}" for name, why in run.missing.items()]
    for (name, verdict, text), count in sorted(tally.details.items()):
        lines.append(f"{verdict}, {name}: {text}: {count}")
    return lines
