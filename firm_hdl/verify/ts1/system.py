"""TS1 as a test system: judges many definitions in several processes, and prints a summary."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from typing import Any

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import DEFAULT_DISTRO, DISTROS
from firm_hdl.frontend.search import workspace_folders
from firm_hdl.verify.results.file import ResultsWriter
from firm_hdl.verify.results.oracles import OracleSum, oracle_sums, remarks_of
from firm_hdl.verify.results.records import Record, Test
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed
from firm_hdl.verify.systems.options import Request, command_again
from firm_hdl.verify.systems.system import (
    Made,
    System,
    failure_of,
    run_and_record,
    run_tests,
    summary_of,
)
from firm_hdl.verify.systems.tasks import UnknownTypeError
from firm_hdl.verify.ts1.judge import judge_case
from firm_hdl.verify.ts1.oracles import ORACLES
from firm_hdl.verify.ts1.oracles.oracle import Oracle
from firm_hdl.verify.ts1.universe import DefinitionCase, Universe, write_definitions

__all__ = ["Ts1", "each_distro"]

_MOST_IN_A_SHARE = 32
_MOST_DETAILS = 8

_MOST_SHOWN = 20
"""The verdicts on at most this many definitions are printed one by one."""

_LABELS = {
    Passed.name: "agrees",
    KnownDifference.name: "known",
    Failed.name: "differs",
    NotJudged.name: "not judged",
}
"""Texts for the verdicts of an oracle."""


def each_distro(request: Request) -> list[Request]:
    """Return a request for each distribution of a request.

    If the request names none, the default distribution is used with paths. Without paths, all
    distributions that have the types are used.

    Raises `UnknownTypeError` if no distribution has the types. Raises `DefinitionError` if the
    active workspace has their packages without the types.
    """
    names = request.distros or (
        [DEFAULT_DISTRO] if request.paths else _distros_with_any_of(request.types)
    )
    return [replace(request, distros=(name,)) for name in names]


def _distros_with_any_of(types: Sequence[str]) -> list[str]:
    found = []
    for distro in DISTROS:
        try:
            Universe(distro).select(types)
        except DefinitionError:
            continue
        found.append(distro)
    if not found:
        packages = {name.partition("/")[0] for name in types}
        for distro in DISTROS:
            if workspace_folders(distro, packages):
                Universe(distro).select(types)  # Raises an error that says what is wrong.
        raise UnknownTypeError(f"No distribution has {', '.join(types)}")
    return found


@dataclass(frozen=True, slots=True)
class _Context:
    """What a process needs to judge definitions of a run."""

    request: Request
    folder: str
    oracles: tuple[str, ...]


class Ts1(System):
    """The test system of TS1: a test gives one definition to all oracles.

    Processes are always on this machine, because oracles read files.

    Parameters
    ----------
    request : Request
        A request for one distribution. `distros`, `paths`, `depends`, `types`, `oracles` and `jobs`
        are used. The oracles that are named all have to be installed.

    Attributes
    ----------
    cases : dict of Test to DefinitionCase
        The definitions to judge.

    Raises
    ------
    DefinitionError
        When the system is entered, if a path is not a folder, or a type does not exist.
    """

    name = "ts1"
    passes = "definitions agree"

    def __init__(self, request: Request) -> None:
        self.request = request
        (self.distro,) = request.distros
        self.versions: dict[str, str] = {}  # Releases of the oracles that are asked, by name.
        self.missing: dict[str, str] = {}  # Why the other oracles cannot be asked, by name.

    def __enter__(self) -> Ts1:
        request = self.request
        with ExitStack() as stack:
            folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="firm-hdl-ts1-"))
            universe = _universe(request, folder)
            write_definitions(universe)
            self.cases = _cases(request, universe)
            for name in request.oracles or ORACLES:
                if universe.dialect in ORACLES[name].languages:
                    self._find(ORACLES[name](universe))
            self._stack = stack.pop_all()
        self.context = _Context(request, folder, tuple(self.versions))
        return self

    def _find(self, oracle: Oracle) -> None:
        try:
            if (why := oracle.missing()) is None:
                self.versions[oracle.name] = oracle.version()
            else:
                self.missing[oracle.name] = why
        finally:
            oracle.close()

    def __exit__(self, *error: object) -> None:
        # The sessions of other processes end with the processes.
        if session := _sessions.pop(self.context, None):
            session.close()
        self._stack.close()

    @property
    def tests(self) -> Sequence[Test]:
        """The tests of all definitions."""
        return list(self.cases)

    @property
    def options(self) -> Mapping[str, Any]:
        """The oracles with their versions."""
        oracles = [f"{name} {version}".strip() for name, version in self.versions.items()]
        return {f"oracles of {self.distro}": sorted(oracles)}

    def records(self, writer: ResultsWriter | None) -> list[Record]:
        """Judge everything. A named oracle that is not installed is a failure."""
        label = f"ts1 {self.distro}"
        records = run_and_record(
            self.tests, writer, self.judged, self._lines_of, label=label, unit="definition"
        )
        for name, why in self.missing.items() if self.request.oracles else ():
            test = Test(system=self.name, distro=self.distro, type=f"oracle {name}")
            records.append(Record(test=test, verdict=Failed((f"is not available: {why}",))))
        return records

    def judged(self, tests: Sequence[Test]) -> Made:
        """Judge definitions; yield their records in shares."""
        return run_tests(
            _judge,
            self.context,
            # The longest first, so that none of them is left at the end.
            sorted(tests, key=lambda test: -len(self.cases[test].text)),
            lambda test: self.command(test, self.request.oracles),
            most=_MOST_IN_A_SHARE,
            jobs=self.request.jobs,
        )

    def command(self, test: Test, oracles: Sequence[str] = ()) -> str:
        """Return the command that judges one definition again."""
        request = self.request
        return command_again(
            test.type,
            systems="ts1",
            distro=request.distros,
            path=request.paths,
            depends=request.depends,
            oracle=tuple(oracles),
        )

    def _lines_of(self, record: Record) -> Iterator[str]:
        """Yield the text to print about a definition for each oracle that differs."""
        case = self.cases[record.test]
        failed = [each for each in record.verdicts if isinstance(each.verdict, Failed)]
        if not failed:
            yield from failure_of(case.full_name, record)
        for each in failed:
            lines = [f"DIFFERS {case.full_name}.{case.language}, {each.oracle}"]
            details = each.verdict.details
            lines += [f"    {detail}" for detail in details[:_MOST_DETAILS]]
            if len(details) > _MOST_DETAILS:
                lines.append(f"    and {len(details) - _MOST_DETAILS} more")
            yield "\n".join([*lines, f"    again: {self.command(record.test)}"])

    def summary(self, records: Sequence[Record], seconds: float) -> Iterator[str]:
        """Yield the verdicts on a few definitions, the numbers of each oracle, and all keys."""
        for record in records if len(records) <= _MOST_SHOWN else ():
            for each in record.verdicts:
                said = "; ".join(each.verdict.details) or "both refuse" * each.is_refused
                text = ": ".join(filter(None, [_LABELS[each.verdict.name], said]))
                yield f"{self.cases[record.test].full_name}  {each.oracle}  {text}"
        sums = {each.oracle: each for each in oracle_sums(records)}
        yield f"{'oracle':24} {'agree':>7} {'known':>7} {'differ':>7} {'not judged':>11}"
        for name, version in self.versions.items():
            found = sums.get(name, OracleSum(distro=self.distro, oracle=name))
            both = f"  ({found.refused} refused by both)" if found.refused else ""
            yield (
                f"{f'{name} {version}':24} {found.agree:7} {found.known:7} {found.differ:7} "
                f"{found.not_judged:11}{both}"
            )
        for name, why in self.missing.items():
            yield f"{name:24} is not available: {why}"
        for remark in remarks_of(records):
            yield f"{_LABELS[remark.verdict]}, {remark.oracle}: {remark.what}: {remark.count}"
        own = [record for record in records if record.test in self.cases]
        yield from summary_of(own, self.passes, seconds)


def _universe(request: Request, folder: str) -> Universe:
    return Universe(request.distros[0], request.paths, folder, depends=request.depends)


def _cases(request: Request, universe: Universe) -> dict[Test, DefinitionCase]:
    """Return the definitions to judge, by their tests."""
    options = ",".join([*request.folders, *(f"oracle={name}" for name in request.oracles)])
    return {
        Test(
            system="ts1",
            distro=request.distros[0],
            type=case.spelled_name,
            same=request.distros,
            options=options,
        ): case
        for case in universe.select(request.types)
    }


class _Session:
    """The objects of a process for a run: our reader, the definitions, and the oracles."""

    def __init__(self, context: _Context) -> None:
        self.universe = _universe(context.request, context.folder)
        self.cases = _cases(context.request, self.universe)
        self.oracles = [ORACLES[name](self.universe) for name in context.oracles]
        for oracle in self.oracles:
            # Start the oracle's process now, so that no definition is charged for the time.
            oracle.missing()

    def close(self) -> None:
        for oracle in self.oracles:
            oracle.close()


_sessions: dict[_Context, _Session] = {}


def _judge(context: _Context, test: Test) -> Record:
    if context not in _sessions:
        _sessions[context] = _Session(context)
    session = _sessions[context]
    return judge_case(session.universe, session.oracles, session.cases[test], test)
