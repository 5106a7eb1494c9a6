"""TS1 over many definitions, in several processes."""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections import Counter
from collections.abc import Generator, Iterable, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass, field
from functools import cached_property

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import DEFAULT_DISTRO, DISTROS
from firm_hdl.jobs.executors import ExecutorError
from firm_hdl.verify.results.records import OracleVerdict
from firm_hdl.verify.results.verdict import Failed
from firm_hdl.verify.systems.options import command_again
from firm_hdl.verify.systems.system import run_shares, shares_of
from firm_hdl.verify.systems.tasks import UnknownTypeError
from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.judge import Judgement, Outcome, judge_case
from firm_hdl.verify.ts1.mutate import mutation
from firm_hdl.verify.ts1.oracles import ORACLES
from firm_hdl.verify.ts1.oracles.oracle import Oracle
from firm_hdl.verify.ts1.universe import Universe, write_definitions

__all__ = ["Selection", "Tally", "Ts1Run", "selections_of"]

# What one process is given at a time: so many definitions, or so many characters of them.
_MOST_CASES = 32
_MOST_CHARACTERS = 30_000
_LEAST_SHARES = 64
_MOST_SHOWN = 20


@dataclass(frozen=True, slots=True, kw_only=True)
class Selection:
    """What to judge.

    Attributes
    ----------
    distro : str
    paths : tuple of str
        As for `Library`.
    types : tuple of str
        Names of types; none: all.
    mutations : int
        So many changed definitions, made from those of the types, are judged instead of these.
    seed : int
        Number of the first mutation.
    """

    distro: str
    paths: tuple[str, ...] = ()
    types: tuple[str, ...] = ()
    mutations: int = 0
    seed: int = 0

    def command(
        self, case: DefinitionCase, number: int | None = None, oracles: Sequence[str] = ()
    ) -> str:
        """Write the command that judges one definition, or one mutation, again."""
        names = [case.spelled_name] if number is None else self.types or ["--all"]
        return command_again(
            *names,
            systems="ts1",
            distro=self.distro,
            path=self.paths,
            oracle=tuple(oracles),
            mutations=None if number is None else 1,
            seed=number,
        )


def selections_of(
    distros: Sequence[str] | None,
    paths: Sequence[str] = (),
    types: Sequence[str] = (),
    *,
    mutations: int = 0,
    seed: int = 0,
) -> list[Selection]:
    """List what a command asks for, which may be several distributions.

    Where none is named, it is the default one if there are paths, else all that have the types.

    Raises
    ------
    UnknownTypeError
        If no distribution has them.
    """
    names = list(distros or ([DEFAULT_DISTRO] if paths else _having(types)))
    return [
        Selection(
            distro=name, paths=tuple(paths), types=tuple(types), mutations=mutations, seed=seed
        )
        for name in names
    ]


def _having(types: Sequence[str]) -> list[str]:
    found = []
    for distro in DISTROS:
        try:
            Universe(distro).select(types)
        except DefinitionError:
            continue
        found.append(distro)
    if not found:
        raise UnknownTypeError(f"No distribution has {', '.join(types)}")
    return found


@dataclass(slots=True)
class Tally:
    """What came of a number of definitions.

    Attributes
    ----------
    verdicts : counter of (oracle, name of the verdict)
    refused : counter of oracle
        How often both refuse; among those that agree.
    details : counter of (oracle, name of the verdict, text)
        Keys of known differences, and reasons for what was not judged.
    differing : list of (Outcome, int or None)
        Those that differ, and the number of the mutation.
    shown : list of Outcome
        All outcomes, if only a few definitions were judged.
    """

    verdicts: Counter[tuple[str, str]] = field(default_factory=Counter)
    refused: Counter[str] = field(default_factory=Counter)
    details: Counter[tuple[str, str, str]] = field(default_factory=Counter)
    differing: list[tuple[Outcome, int | None]] = field(default_factory=list)
    shown: list[Outcome] = field(default_factory=list)

    def add(self, outcome: Outcome, number: int | None = None) -> None:
        """Count an outcome."""
        verdict = outcome.verdict
        self.verdicts[outcome.oracle, verdict.name] += 1
        self.refused[outcome.oracle] += outcome.is_refused
        if isinstance(verdict, Failed):
            self.differing.append((outcome, number))
        else:
            for detail in verdict.details:
                self.details[outcome.oracle, verdict.name, detail] += 1


class Ts1Run:
    """One run; a context manager, because definitions lie in a folder while it lasts.

    Parameters
    ----------
    selection : Selection
    oracles : sequence of str
        Names of those to ask; none: all that are here.
    jobs : int or None
        Processes; `None`: one per processor.

    Raises
    ------
    DefinitionError
        If a path is no folder, or a type is not there.
    """

    def __init__(
        self, selection: Selection, oracles: Sequence[str] = (), jobs: int | None = None
    ) -> None:
        self.selection = selection
        self.jobs = jobs or os.cpu_count()
        self._stack = ExitStack()
        with ExitStack() as stack:
            folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="firm-hdl-ts1-"))
            universe = Universe(selection.distro, selection.paths, folder)
            write_definitions(universe)
            self.cases = universe.select(selection.types)
            self.versions: dict[str, str] = {}
            self.missing: dict[str, str] = {}
            self._ask_who_is_here(universe, oracles or tuple(ORACLES))
            self._stack = stack.pop_all()
        self._key = _Key(selection, folder, tuple(self.versions))

    def __enter__(self) -> Ts1Run:
        return self

    def __exit__(self, *error: object) -> None:
        _end_session(self._key)
        self._stack.close()

    def _ask_who_is_here(self, universe: Universe, names: Sequence[str]) -> None:
        for name in names:
            if universe.dialect not in ORACLES[name].languages:
                continue
            oracle = ORACLES[name](universe)
            try:
                why = oracle.missing()
                if why is None:
                    self.versions[name] = oracle.version()
                else:
                    self.missing[name] = why
            finally:
                oracle.close()

    @property
    def total(self) -> int:
        """Number of definitions that are to be judged."""
        return self.selection.mutations or len(self.cases)

    @cached_property
    def digest(self) -> str:
        """What tells the definitions that mutations are made from, which decide about these."""
        digest = hashlib.sha256()
        for case in self.cases:
            digest.update(f"{case.spelled_name} {case.language} {len(case.text)}\n".encode())
            digest.update(case.text.encode("utf-8", "surrogatepass"))
        return digest.hexdigest()[:16]

    def case(self, number: int) -> DefinitionCase:
        """Return the definition of a number, or the mutation."""
        if self.selection.mutations:
            return mutation(self.cases, number)
        return self.cases[number]

    @property
    def numbers(self) -> range:
        """Numbers of all that is to be judged."""
        first = self.selection.seed if self.selection.mutations else 0
        return range(first, first + self.total)

    def judgements(
        self, numbers: Sequence[int] | None = None
    ) -> Generator[list[tuple[int, Judgement]], None, None]:
        """Judge definitions; yield their numbers and what came of them, as they come, in shares.

        Parameters
        ----------
        numbers : sequence of int or None
            Which of `numbers`; `None`: all.
        """
        left = self.numbers if numbers is None else numbers
        if self.selection.mutations:
            shares = shares_of(left, _MOST_CASES, 8)
        else:
            shares = _shares(self.cases, left)
        with closing(run_shares(_judge_share, self._key, shares, jobs=self.jobs)) as run:
            for share, result in run:
                if isinstance(result, ExecutorError):
                    # One definition, alone in its process.
                    result = [_died(str(result))]
                if isinstance(result, Exception):
                    raise result
                yield list(zip(share, result, strict=True))

    def tally(self, judged: Iterable[tuple[int, Sequence[OracleVerdict]]]) -> Tally:
        """Count what oracles said of definitions."""
        is_mutated = self.selection.mutations > 0
        tally = Tally()
        for number, said in judged:
            case = self.case(number)
            for each in said:
                outcome = Outcome.of(case, each)
                tally.add(outcome, number if is_mutated else None)
                if not is_mutated and len(self.cases) <= _MOST_SHOWN:
                    tally.shown.append(outcome)
        return tally


@dataclass(frozen=True, slots=True)
class _Key:
    selection: Selection
    folder: str
    oracles: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class _Session:
    """What a process has for a run: our reader, the cases in the order of all, and oracles."""

    universe: Universe
    cases: list[DefinitionCase]
    oracles: list[Oracle]


_sessions: dict[_Key, _Session] = {}


def _session(key: _Key) -> _Session:
    if key not in _sessions:
        universe = Universe(key.selection.distro, key.selection.paths, key.folder)
        cases = universe.select(key.selection.types)
        oracles = [ORACLES[name](universe) for name in key.oracles]
        for oracle in oracles:
            # Starts its process: no definition is to be blamed for the time that takes.
            oracle.missing()
        _sessions[key] = _Session(universe, cases, oracles)
    return _sessions[key]


def _end_session(key: _Key) -> None:
    # Those of other processes end with these.
    if key in _sessions:
        for oracle in _sessions.pop(key).oracles:
            oracle.close()


def _died(why: str) -> Judgement:
    said = OracleVerdict(oracle="its process", verdict=Failed((why,)))
    return Judgement(said=(said,))


def _judge_share(key: _Key, share: tuple[int, ...]) -> list[Judgement]:
    session = _session(key)
    is_mutated = key.selection.mutations > 0
    return [
        judge_case(
            session.universe,
            session.oracles,
            mutation(session.cases, number) if is_mutated else session.cases[number],
        )
        for number in share
    ]


def _shares(cases: Sequence[DefinitionCase], numbers: Sequence[int]) -> list[tuple[int, ...]]:
    """Deal out cases, the longest first: none is to be left with one of those at the end."""
    shares: list[tuple[int, ...]] = []
    share: list[int] = []
    size = 0
    most = min(_MOST_CASES, max(1, len(numbers) // _LEAST_SHARES))
    for index in sorted(numbers, key=lambda i: (-len(cases[i].text), i)):
        share.append(index)
        size += len(cases[index].text)
        if len(share) >= most or size >= _MOST_CHARACTERS:
            shares.append(tuple(share))
            share, size = [], 0
    return [*shares, tuple(share)] if share else shares
