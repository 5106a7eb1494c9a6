"""TS1 as a test system: records the verdicts on each definition, and prints them."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import replace
from functools import cached_property
from typing import Any

from firm_hdl.verify.results.records import OracleVerdict, Record, Test, clipped_verdict
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed
from firm_hdl.verify.systems.options import Request, command_again
from firm_hdl.verify.systems.system import Judged, Made, Recorder, System, kept
from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.run import Ts1Run

__all__ = ["Tally", "Ts1", "command_of"]

_MOST_DETAILS = 8

_MOST_SHOWN = 20
"""The verdicts on at most this many definitions are printed one by one."""

VERDICT_LABELS = {
    Passed.name: "agrees",
    KnownDifference.name: "known",
    Failed.name: "differs",
    NotJudged.name: "not judged",
}
"""Texts for the verdicts of an oracle, in the order of the columns."""


def command_of(
    request: Request,
    case: DefinitionCase,
    number: int | None = None,
    oracles: Sequence[str] = (),
) -> str:
    """Return the command that judges one definition, or the mutation with a number, again."""
    names = [case.spelled_name] if number is None else request.types or ["--all"]
    return command_again(
        *names,
        systems="ts1",
        distro=request.distros,
        path=request.paths,
        depends=request.depends,
        oracle=tuple(oracles),
        mutations=None if number is None else 1,
        seed=number,
    )


class Tally:
    """Counts the verdicts of each oracle.

    Attributes
    ----------
    verdicts : counter of (oracle, name of the verdict)
    refused : counter of oracle
        How often both firm-hdl and the oracle refuse. These verdicts count as agreement, too.
    details : counter of (oracle, name of the verdict, text)
        Keys of known differences, and reasons why a definition was not judged.
    """

    def __init__(self, found: Iterable[OracleVerdict]) -> None:
        self.verdicts: Counter[tuple[str, str]] = Counter()
        self.refused: Counter[str] = Counter()
        self.details: Counter[tuple[str, str, str]] = Counter()
        for each in found:
            verdict = each.verdict
            self.verdicts[each.oracle, verdict.name] += 1
            self.refused[each.oracle] += each.is_refused
            if not isinstance(verdict, Failed):
                self.details.update((each.oracle, verdict.name, text) for text in verdict.details)

    @property
    def differences(self) -> int:
        """The number of unknown differences from all oracles."""
        return sum(n for (_, name), n in self.verdicts.items() if name == Failed.name)


class Ts1(System):
    """The test system of TS1. A test gives one definition, or one mutation, to all oracles.

    Parameters
    ----------
    requests : sequence of Request
        One for each distribution, as for `Ts1Run`. Processes are always on this machine, because
        oracles read files. The oracles that are named all have to be installed.

    Raises
    ------
    DefinitionError
        When the system is entered, as from `Ts1Run`.
    """

    name = "ts1"

    def __init__(self, requests: Sequence[Request]):
        self._requests = requests
        self._stack = ExitStack()
        self._runs: list[Ts1Run] = []

    def __enter__(self) -> Ts1:
        with ExitStack() as stack:
            self._runs += [stack.enter_context(Ts1Run(each)) for each in self._requests]
            self._stack = stack.pop_all()
        return self

    def __exit__(self, *error: object) -> None:
        self._stack.close()

    @cached_property
    def tests(self) -> Sequence[Test]:
        """The tests of all definitions of all distributions, or of their mutations."""
        return [run.test(number) for run in self._runs for number in run.numbers]

    @property
    def options(self) -> Mapping[str, Any]:
        """The oracles with their versions, and a digest of the definitions to mutate."""
        oracles = {f"{name} {v}".strip() for run in self._runs for name, v in run.versions.items()}
        mutated = {run.distro: run.digest for run in self._runs if run.request.mutations}
        return {"oracles": sorted(oracles), **({"mutated": mutated} if mutated else {})}

    def run(self, recorder: Recorder) -> list[Judged]:
        """Judge everything."""
        return [each for run in self._runs for each in self.judge(run, recorder)]

    def judge(self, run: Ts1Run, recorder: Recorder) -> list[Judged]:
        """Judge the definitions of one run. A named oracle that is not installed is a failure."""
        began = time.perf_counter()
        what = "mutation" if run.request.mutations else "definition"
        tests = {number: run.test(number) for number in run.numbers}

        def work(left: Sequence[int]) -> Made[int]:
            with closing(run.judgements(left)) as shares:
                for share in shares:
                    yield [
                        (number, _kept(run, number, record), _differences(run, number, record))
                        for number, record in share
                    ]

        records = kept(tests, recorder, work, label=f"ts1 {run.distro}", unit=what)
        tally = Tally(each for record in records.values() for each in record.verdicts)
        for line in _summary(run, records, tally):
            print(line)
        what += "s" * (run.total != 1)
        seconds = time.perf_counter() - began
        print(f"{run.total} {what}, {seconds:.0f} s, {tally.differences} differences")
        asked = run.missing.items() if run.request.oracles else ()
        named = not run.request.mutations
        return [
            *(
                Judged(what=each.test.title, verdict=each.verdict, has_name=named)
                for each in records.values()
            ),
            *(
                Judged(what=f"oracle {n}", verdict=Failed((f"is not available: {w}",)))
                for n, w in asked
            ),
        ]


def _again(run: Ts1Run, number: int, oracles: Sequence[str] = ()) -> str:
    mutated = number if run.request.mutations else None
    return command_of(run.request, run.case(number), mutated, oracles)


def _kept(run: Ts1Run, number: int, record: Record) -> Record:
    """Return a record with its command, and with long texts shortened."""
    verdicts = [replace(v, verdict=clipped_verdict(v.verdict)) for v in record.verdicts]
    return replace(
        record,
        verdict=clipped_verdict(record.verdict),
        verdicts=tuple(verdicts),
        command=_again(run, number, run.request.oracles),
    )


def _differences(run: Ts1Run, number: int, record: Record) -> Iterator[str]:
    """Yield the text to print about a definition for each oracle that differs."""
    case = run.case(number)
    for each in record.verdicts:
        if not isinstance(each.verdict, Failed):
            continue
        lines = [f"DIFFERS {case.full_name}.{case.language}, {each.oracle}"]
        if run.request.mutations:
            lines += [f"    {line}" for line in case.changes]
        details = each.verdict.details
        lines += [f"    {detail}" for detail in details[:_MOST_DETAILS]]
        if len(details) > _MOST_DETAILS:
            lines.append(f"    and {len(details) - _MOST_DETAILS} more")
        yield "\n".join([*lines, f"    again: {_again(run, number)}"])


def _summary(run: Ts1Run, records: Mapping[int, Record], tally: Tally) -> Iterator[str]:
    is_short = not run.request.mutations and len(run.cases) <= _MOST_SHOWN
    for number, record in records.items() if is_short else ():
        for each in record.verdicts:
            details = "both refuse" if each.is_refused else "; ".join(each.verdict.details)
            text = ": ".join(filter(None, [VERDICT_LABELS[each.verdict.name], details]))
            yield f"{run.case(number).full_name}  {each.oracle}  {text}"
    yield f"{'oracle':24} {'agree':>7} {'known':>7} {'differ':>7} {'not judged':>11}"
    for name, version in run.versions.items():
        counts = [tally.verdicts[name, verdict] for verdict in VERDICT_LABELS]
        refused = f"  ({tally.refused[name]} refused by both)" if tally.refused[name] else ""
        yield (
            f"{f'{name} {version}':24} {counts[0]:7} {counts[1]:7} {counts[2]:7} {counts[3]:11}"
            f"{refused}"
        )
    for name, why in run.missing.items():
        yield f"{name:24} is not available: {why}"
    for (name, verdict, text), count in sorted(tally.details.items()):
        yield f"{VERDICT_LABELS[verdict]}, {name}: {text}: {count}"
