"""The request of a call of ``firm-hdl verify``, with the types to test."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

from firm_hdl.errors import Diagnostic
from firm_hdl.frontend import DEFAULT_DISTRO
from firm_hdl.frontend.search import workspace_folders
from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.systems.tasks import (
    TypeUnderTest,
    UnknownTypeError,
    collect_own,
    collect_tasks,
)

__all__ = ["Workload"]


class Workload:
    """A request and its types, which are looked up when a test system first needs them.

    Named types that no distribution has are looked up in the active workspace, as with ``--path``.
    If only TS1 runs, TS1 itself looks up the types.

    Attributes
    ----------
    request : Request
        Its `paths` are the folders of the workspace if the types are looked up there.
    problems : dict of str to Diagnostic
        Errors by their texts. Types without errors are tested nevertheless.
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
            If a type that is named does not exist.
        """
        request = self.request
        if request.bags:
            from firm_hdl.verify.ts3.recording import collect_recorded

            return collect_recorded(
                next(iter(request.distros), None),
                request.types,
                request.bags,
                wire=request.wire,
                problems=self.problems,
            )
        if request.paths:
            # An invalid type does not keep the others from being tested.
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
                # Some of the types may exist: these are tested.
                self.__dict__["tasks"] = collect_tasks(distros, types, problems=self.problems)
