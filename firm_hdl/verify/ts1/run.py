"""TS1 over many definitions, in several processes."""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Generator, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass, replace
from functools import cached_property

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import DEFAULT_DISTRO, DISTROS
from firm_hdl.frontend.search import workspace_folders
from firm_hdl.jobs.executors import ExecutorError
from firm_hdl.verify.results.records import OracleVerdict, Record, Test
from firm_hdl.verify.results.verdict import Failed
from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.systems.system import run_shares, shares_of
from firm_hdl.verify.systems.tasks import UnknownTypeError
from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.judge import judge_case, record_of
from firm_hdl.verify.ts1.mutate import mutation
from firm_hdl.verify.ts1.oracles import ORACLES
from firm_hdl.verify.ts1.oracles.oracle import Oracle
from firm_hdl.verify.ts1.universe import Universe, write_definitions

__all__ = ["Ts1Run", "each_distro"]

# A share has at most this many definitions, and ends as soon as it has this many characters.
_MOST_CASES = 32
_MOST_CHARACTERS = 30_000
_LEAST_SHARES = 64


def each_distro(request: Request) -> list[Request]:
    """Return a request for each distribution of a request.

    If the request names none, the default distribution is used with paths. Without paths, all
    distributions that have the types are used.

    Raises
    ------
    UnknownTypeError
        If no distribution has the types.
    DefinitionError
        If the active workspace has their packages without the types.
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


class Ts1Run:
    """One run; a context manager, because a run keeps definitions in a temporary folder.

    Parameters
    ----------
    request : Request
        A request for one distribution. `distros`, `paths`, `depends`, `types`, `mutations`, `seed`,
        `oracles` and `jobs` are used. Mutations are made from the definitions of the types. `seed`
        is the number of the first mutation.

    Attributes
    ----------
    distro : str
    cases : list of DefinitionCase
        The definitions of the types.
    versions : dict of str to str
        Releases of the oracles that are asked, by name.
    missing : dict of str to str
        Why the other oracles cannot be asked, by name.

    Raises
    ------
    DefinitionError
        If a path is not a folder, or a type does not exist.
    """

    def __init__(self, request: Request) -> None:
        self.request = request
        (self.distro,) = request.distros
        self._stack = ExitStack()
        with ExitStack() as stack:
            folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="firm-hdl-ts1-"))
            universe = _universe(request, folder)
            write_definitions(universe)
            self.cases = universe.select(request.types)
            self.versions: dict[str, str] = {}
            self.missing: dict[str, str] = {}
            self._find_oracles(universe, request.oracles or tuple(ORACLES))
            self._stack = stack.pop_all()
        self._key = _Key(request, folder, tuple(self.versions))

    def __enter__(self) -> Ts1Run:
        return self

    def __exit__(self, *error: object) -> None:
        _end_session(self._key)
        self._stack.close()

    def _find_oracles(self, universe: Universe, names: Sequence[str]) -> None:
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
        """Number of definitions or mutations to judge."""
        return self.request.mutations or len(self.cases)

    @cached_property
    def digest(self) -> str:
        """A digest of the definitions that mutations are made from."""
        digest = hashlib.sha256()
        for case in self.cases:
            digest.update(f"{case.spelled_name} {case.language} {len(case.text)}\n".encode())
            digest.update(case.text.encode("utf-8", "surrogatepass"))
        return digest.hexdigest()[:16]

    def case(self, number: int) -> DefinitionCase:
        """Return the definition or the mutation with a number."""
        return _case(self.request, self.cases, number)

    def test(self, number: int) -> Test:
        """Return the test of the definition or of the mutation with a number."""
        return _test(self.request, self.case(number), number)

    @property
    def numbers(self) -> range:
        """Numbers of all definitions or mutations to judge."""
        first = self.request.seed if self.request.mutations else 0
        return range(first, first + self.total)

    def judgements(
        self, numbers: Sequence[int] | None = None
    ) -> Generator[list[tuple[int, Record]], None, None]:
        """Judge definitions; yield their numbers and records in shares, as these are ready.

        Parameters
        ----------
        numbers : sequence of int or None
            Those of the property `numbers` to judge; `None`: all.
        """
        left = self.numbers if numbers is None else numbers
        if self.request.mutations:
            shares = shares_of(left, _MOST_CASES, 8)
        else:
            shares = _shares(self.cases, left)
        jobs = self.request.jobs or os.cpu_count()
        with closing(run_shares(_judge_share, self._key, shares, jobs=jobs)) as run:
            for share, result in run:
                if isinstance(result, ExecutorError):
                    # The process died although it had only one definition.
                    result = [self._died(share[0], str(result))]
                if isinstance(result, Exception):
                    raise result
                yield list(zip(share, result, strict=True))

    def _died(self, number: int, why: str) -> Record:
        verdict = OracleVerdict(oracle="its process", verdict=Failed((why,)))
        return record_of(self.test(number), self.case(number).language, [verdict])


def _universe(request: Request, folder: str) -> Universe:
    return Universe(request.distros[0], request.paths, folder, depends=request.depends)


def _case(request: Request, cases: Sequence[DefinitionCase], number: int) -> DefinitionCase:
    return mutation(cases, number) if request.mutations else cases[number]


def _test(request: Request, case: DefinitionCase, number: int) -> Test:
    own = request.folders
    own += [f"oracle={name}" for name in request.oracles]
    if request.mutations:
        own += [f"of={name}" for name in request.types]
        own.append(f"mutation={number}")
    return Test(
        system="ts1",
        distro=request.distros[0],
        type=case.spelled_name,
        same=request.distros,
        options=",".join(own),
    )


@dataclass(frozen=True, slots=True)
class _Key:
    request: Request
    folder: str
    oracles: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class _Session:
    """The objects of a process for a run: our reader, all cases in order, and the oracles."""

    universe: Universe
    cases: list[DefinitionCase]
    oracles: list[Oracle]


_sessions: dict[_Key, _Session] = {}


def _session(key: _Key) -> _Session:
    if key not in _sessions:
        universe = _universe(key.request, key.folder)
        cases = universe.select(key.request.types)
        oracles = [ORACLES[name](universe) for name in key.oracles]
        for oracle in oracles:
            # Start the oracle's process now, so that no definition is charged for the time.
            oracle.missing()
        _sessions[key] = _Session(universe, cases, oracles)
    return _sessions[key]


def _end_session(key: _Key) -> None:
    # The sessions of other processes end with the processes.
    if key in _sessions:
        for oracle in _sessions.pop(key).oracles:
            oracle.close()


def _judge_share(key: _Key, share: tuple[int, ...]) -> list[Record]:
    session = _session(key)
    cases = [(number, _case(key.request, session.cases, number)) for number in share]
    return [
        judge_case(session.universe, session.oracles, case, _test(key.request, case, number))
        for number, case in cases
    ]


def _shares(cases: Sequence[DefinitionCase], numbers: Sequence[int]) -> list[tuple[int, ...]]:
    """Divide cases into shares, the longest first, so that no long case is left at the end."""
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
