"""TS1 as a test system: what is recorded of each definition, and what is printed."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import replace
from functools import cached_property
from typing import Any

from firm_hdl.verify.results.records import (
    OracleVerdict,
    Record,
    Seconds,
    Test,
    clipped_verdict,
)
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed, Verdict
from firm_hdl.verify.systems.system import Judged, Made, Recorder, System, kept
from firm_hdl.verify.ts1.judge import Judgement
from firm_hdl.verify.ts1.run import Selection, Tally, Ts1Run

__all__ = ["Ts1"]

_MOST_DETAILS = 8

_SAID = {
    Passed.name: "agrees",
    KnownDifference.name: "known",
    Failed.name: "differs",
    NotJudged.name: "not judged",
}
"""What is printed of an oracle, in the order of the columns."""


class Ts1(System):
    """Definitions before oracles; a test is one definition, or one mutation, before all of them.

    Parameters
    ----------
    selections : sequence of Selection
    oracles : sequence of str
        Names of those to ask, all of which have to be here; none: all that are here.
    jobs : int or None
        Processes here; oracles read files, so it is never a cluster.

    Raises
    ------
    DefinitionError
        When it is entered: as `Ts1Run` does.
    """

    name = "ts1"

    def __init__(
        self, selections: Sequence[Selection], oracles: Sequence[str] = (), jobs: int | None = None
    ):
        self._selections, self._oracles, self._jobs = selections, tuple(oracles), jobs
        self._stack = ExitStack()
        self._runs: list[Ts1Run] = []

    def __enter__(self) -> Ts1:
        with ExitStack() as stack:
            for each in self._selections:
                run = stack.enter_context(Ts1Run(each, self._oracles, self._jobs))
                self._runs.append(run)
            self._stack = stack.pop_all()
        return self

    def __exit__(self, *error: object) -> None:
        self._stack.close()

    @cached_property
    def tests(self) -> Sequence[Test]:
        """All definitions of all distributions, or their mutations."""
        return [self._test(run, number) for run in self._runs for number in run.numbers]

    @property
    def options(self) -> Mapping[str, Any]:
        """The oracles that are asked, with their versions, and what mutations are made from."""
        here = {f"{name} {v}".strip() for run in self._runs for name, v in run.versions.items()}
        mutated = {
            run.selection.distro: run.digest for run in self._runs if run.selection.mutations
        }
        return {"oracles": sorted(here), **({"mutated": mutated} if mutated else {})}

    def run(self, recorder: Recorder) -> list[Judged]:
        """Judge everything."""
        return [each for run in self._runs for each in self.judge(run, recorder)]

    def judge(self, run: Ts1Run, recorder: Recorder) -> list[Judged]:
        """Judge the definitions of one run; an oracle that was asked for and is not here fails."""
        began = time.perf_counter()
        what = "mutation" if run.selection.mutations else "definition"
        tests = {number: self._test(run, number) for number in run.numbers}
        judged: dict[int, Sequence[OracleVerdict]] = {}

        def work(left: Sequence[int]) -> Made[int]:
            with closing(run.judgements(left)) as shares:
                for share in shares:
                    judged.update((number, each.said) for number, each in share)
                    yield [
                        (number, self._record(run, number, each), _differences(run, number, each))
                        for number, each in share
                    ]

        records = kept(tests, recorder, work, label=f"ts1 {run.selection.distro}", unit=what)
        tally = run.tally((n, judged.get(n, record.verdicts)) for n, record in records.items())
        for line in _summary(run, tally):
            print(line)
        what += "s" * (run.total != 1)
        seconds = time.perf_counter() - began
        print(f"{run.total} {what}, {seconds:.0f} s, {len(tally.differing)} differences")
        asked = run.missing.items() if self._oracles else ()
        return [
            *(Judged(what=each.test.title, verdict=each.verdict) for each in records.values()),
            *(Judged(what=f"oracle {n}", verdict=Failed((f"is not here: {w}",))) for n, w in asked),
        ]

    def _test(self, run: Ts1Run, number: int) -> Test:
        selection = run.selection
        own = [f"path={path}" for path in selection.paths]
        own += [f"oracle={name}" for name in self._oracles]
        if selection.mutations:
            own += [f"of={name}" for name in selection.types]
            own.append(f"mutation={number}")
        return Test(
            system=self.name,
            distro=selection.distro,
            type=run.case(number).spelled_name,
            same=(selection.distro,),
            options=",".join(own),
        )

    def _record(self, run: Ts1Run, number: int, found: Judgement) -> Record:
        case = run.case(number)
        again = number if run.selection.mutations else None
        known = [
            f"known difference from {each.oracle}: {key}"
            for each in found.said
            if isinstance(each.verdict, KnownDifference)
            for key in each.verdict.keys
        ]
        return Record(
            test=self._test(run, number),
            verdict=clipped_verdict(_verdict(case.language, found.said)),
            note="; ".join(known),
            seconds=Seconds(generation=found.reading_seconds, testing=found.asking_seconds),
            cpu_seconds=found.cpu_seconds,
            metrics=found.metrics,
            verdicts=tuple(_clipped(each) for each in found.said),
            command=run.selection.command(case, again, oracles=self._oracles),
        )


def _clipped(said: OracleVerdict) -> OracleVerdict:
    return replace(said, verdict=clipped_verdict(said.verdict))


def _verdict(language: str, said: Sequence[OracleVerdict]) -> Verdict:
    """Return what all oracles say together; those that did not judge count if nobody did."""
    details: dict[type[Verdict], list[str]] = {}
    for each in said:
        lines = details.setdefault(type(each.verdict), [])
        lines += [f"{each.oracle}: {detail}" for detail in each.verdict.details]
    if failures := details.get(Failed):
        return Failed(tuple(failures))
    found = [each.verdict for each in said if isinstance(each.verdict, Passed | KnownDifference)]
    cases = sum(each.cases for each in found)
    if keys := tuple(dict.fromkeys(key for each in found for key in each.details)):
        return KnownDifference(keys, cases)
    if cases:
        return Passed(cases)
    reasons = details.get(NotJudged) or [f"no oracle that was asked reads .{language} files"]
    return NotJudged("; ".join(reasons))


def _differences(run: Ts1Run, number: int, found: Judgement) -> Iterator[str]:
    """Yield what is printed of a definition, for each oracle that differs."""
    case, is_mutated = run.case(number), run.selection.mutations > 0
    for said in found.said:
        if not isinstance(said.verdict, Failed):
            continue
        lines = [f"DIFFERS {case.full_name}.{case.language}, {said.oracle}"]
        if is_mutated:
            lines += [f"    {line}" for line in case.changes]
        details = said.verdict.details
        lines += [f"    {detail}" for detail in details[:_MOST_DETAILS]]
        if len(details) > _MOST_DETAILS:
            lines.append(f"    and {len(details) - _MOST_DETAILS} more")
        again = run.selection.command(case, number if is_mutated else None)
        yield "\n".join([*lines, f"    again: {again}"])


def _summary(run: Ts1Run, tally: Tally) -> list[str]:
    lines = []
    for outcome in tally.shown:
        details = "both refuse" if outcome.is_refused else "; ".join(outcome.verdict.details)
        name = _SAID[outcome.verdict.name]
        said = f"{name}: {details}" if details else name
        words = [outcome.case.full_name, outcome.oracle, said]
        lines.append("  ".join(words))
    lines.append(f"{'oracle':24} {'agree':>7} {'known':>7} {'differ':>7} {'not judged':>11}")
    for name, version in run.versions.items():
        counts = [tally.verdicts[name, verdict] for verdict in _SAID]
        refused = f"  ({tally.refused[name]} refused by both)" if tally.refused[name] else ""
        lines.append(
            f"{f'{name} {version}':24} {counts[0]:7} {counts[1]:7} {counts[2]:7} {counts[3]:11}"
            f"{refused}"
        )
    lines += [f"{name:24} is not here: {why}" for name, why in run.missing.items()]
    for (name, verdict, text), count in sorted(tally.details.items()):
        lines.append(f"{_SAID[verdict]}, {name}: {text}: {count}")
    return lines
