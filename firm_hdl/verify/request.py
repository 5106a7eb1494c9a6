"""What ``firm-hdl verify`` is asked for, and the types that this is about."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from firm_hdl.errors import Diagnostic
from firm_hdl.frontend import DEFAULT_DISTRO
from firm_hdl.frontend.search import workspace_folders
from firm_hdl.jobs.executors import PROCESSES
from firm_hdl.verify.choices import LONGEST
from firm_hdl.verify.systems.tasks import (
    TypeUnderTest,
    UnknownTypeError,
    collect_own,
    collect_tasks,
)
from firm_hdl.wire import Wire

__all__ = ["Request", "Workload"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """The arguments of the command, which go together.

    Attributes
    ----------
    types : tuple of str
        Empty: all types.
    distros : tuple of str
        Empty: see ``--distro``.
    paths : tuple of str
        Folders with ROS packages, those of `depends` at the end.
    depends : tuple of str
        Those of `paths` whose types are not meant by all.
    systems : tuple of str
        Names of test systems, in the order in which they run.
    libraries : tuple of str
        Client libraries under test; then no test system runs.
    wire : Wire or None
        `None`: that of the distribution.
    widths : tuple of int
        Buses, in bytes.
    seed : int
    jobs : int or None
        Processes; `None`: one per processor.
    executor : str
        See :func:`firm_hdl.jobs.executors.run_each`.
    oracles : tuple of str
        Oracles of TS1; empty: all that are here.
    mutations : int
        How many changed texts TS1 judges instead of the types' own; 0: none.
    golden : str or None
        Folder of golden plans.
    simulator, most_cases, stalled, broken, references, vcd
        See :class:`firm_hdl.verify.ts3.options.Options`.
    bags : tuple of str
        Recordings.
    longest : int
        Longest recorded message to replay, in bytes.
    share_circuits : bool or None
        `None`: if all types are tested, and no recording.
    results, report : str or None
        Files to write.
    """

    types: tuple[str, ...] = ()
    distros: tuple[str, ...] = ()
    paths: tuple[str, ...] = ()
    depends: tuple[str, ...] = ()
    systems: tuple[str, ...] = ("ts3",)
    libraries: tuple[str, ...] = ()
    wire: Wire | None = None
    widths: tuple[int, ...] = (8,)
    seed: int = 0
    jobs: int | None = None
    executor: str = PROCESSES
    oracles: tuple[str, ...] = ()
    mutations: int = 0
    golden: str | None = None
    simulator: str = "python"
    most_cases: int | None = None
    stalled: bool = True
    broken: bool = True
    references: tuple[str, ...] | None = None
    vcd: str | None = None
    bags: tuple[str, ...] = ()
    longest: int = LONGEST
    share_circuits: bool | None = None
    results: str | None = None
    report: str | None = None

    @property
    def is_ts1_alone(self) -> bool:
        """Whether TS1 alone is to run, which looks types up by itself."""
        return self.systems == ("ts1",) and not self.libraries

    @property
    def is_named(self) -> bool:
        """Whether what is tested was asked for by name: changed texts are nobody's by name."""
        return bool(self.types) and not self.mutations


class Workload:
    """A request, and its types, which are looked up when the first test system needs them.

    Types that are named and that no distribution has are looked up in the active workspace, as if
    by ``--path``. TS1 alone does so anyway.

    Attributes
    ----------
    request : Request
        With the folders of the workspace, if they are needed.
    problems : dict of str to Diagnostic
        What is wrong with definitions that do not keep the others from being tested, by its text.
    """

    def __init__(self, request: Request):
        self.request = request
        self.problems: dict[str, Diagnostic] = {}
        if request.types and not (request.paths or request.bags or request.is_ts1_alone):
            self._search_workspace()

    @cached_property
    def tasks(self) -> list[TypeUnderTest]:
        """The types that are tested.

        Raises
        ------
        DefinitionError
            If a definition that is named cannot be used.
        UnknownTypeError
            If nobody has a type that is named.
        """
        request = self.request
        if request.bags:
            from firm_hdl.verify.ts3.recorded_tasks import collect_recorded

            return collect_recorded(
                next(iter(request.distros), None),
                request.types,
                request.bags,
                wire=request.wire,
                problems=self.problems,
            )
        if request.paths:
            # A type that is wrong does not keep the others from being tested.
            own = [path for path in request.paths if path not in request.depends]
            distros: Sequence[str] = request.distros or [DEFAULT_DISTRO]
            return collect_own(
                distros, request.types, request.paths, own=own, problems=self.problems
            )
        return collect_tasks(request.distros, request.types)

    def _search_workspace(self) -> None:
        types, distros = self.request.types, self.request.distros
        try:
            _ = self.tasks
        except UnknownTypeError:
            packages = {name.partition("/")[0] for name in types}
            found = [
                folder
                for distro in distros or [DEFAULT_DISTRO]
                for folder in workspace_folders(distro, packages)
            ]
            if found:
                self.request = replace(self.request, paths=tuple(found))
            else:
                # Some of the types may be there.
                self.__dict__["tasks"] = collect_tasks(distros, types, problems=self.problems)
