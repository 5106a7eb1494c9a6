"""The request of a call of ``firm-hdl verify``, with the types to test."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from firm_hdl.errors import Diagnostic
from firm_hdl.frontend import DEFAULT_DISTRO
from firm_hdl.frontend.search import workspace_folders
from firm_hdl.node import Description
from firm_hdl.verify.board.description import described_board
from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.systems.tasks import (
    TypeUnderTest,
    UnknownTypeError,
    collect_own,
    collect_tasks,
)

__all__ = ["Workload", "resolve"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Workload:
    """A request and its types.

    Attributes
    ----------
    request : Request
        Its `paths` are the folders of the workspace if the types were found there.
    tasks : sequence of TypeUnderTest
        The types that are tested; empty if only TS1 runs, which looks up the types itself.
    problems : mapping of str to Diagnostic
        Errors by their texts. Types without errors are tested nevertheless.
    board : Description or None
        The node of the board, if there is one.
    """

    request: Request
    tasks: Sequence[TypeUnderTest]
    problems: Mapping[str, Diagnostic]
    board: Description | None = None


def resolve(request: Request) -> Workload:
    """Look up the types of a request.

    Named types that no distribution has are looked up in the active workspace, as with ``--path``.

    Raises
    ------
    DefinitionError
        If a definition that is named cannot be used.
    UnknownTypeError
        If a type that is named does not exist.
    UserError
        If the board or its node cannot be used.
    """
    problems: dict[str, Diagnostic] = {}
    if request.is_ts1_alone:
        return Workload(request=request, tasks=(), problems=problems)
    if request.node is not None:
        # The types are those of the node.
        node = described_board(request, ())
        return Workload(request=request, tasks=(), problems=problems, board=node)
    try:
        tasks = _collect(request, problems)
    except UnknownTypeError:
        # With `paths`, the workspace was searched, too, and what is missing is another error.
        if request.bags:
            raise
        if folders := _workspace(request):
            request = replace(request, paths=folders)
            tasks = _collect(request, problems)
        else:
            # Some of the types may exist: these are tested.
            tasks = collect_tasks(request.distros, request.types, problems=problems)
    board = None
    if request.board is not None:
        board = described_board(request, [task.name for task in tasks])
    return Workload(request=request, tasks=tasks, problems=problems, board=board)


def _collect(request: Request, problems: dict[str, Diagnostic]) -> list[TypeUnderTest]:
    """Return the types from where the request says; add errors to `problems`."""
    if request.bags:
        from firm_hdl.verify.ts3.recording import collect_recorded

        return collect_recorded(
            next(iter(request.distros), None),
            request.types,
            request.bags,
            wire=request.wire,
            problems=problems,
            depends=request.depends,
        )
    if request.paths:
        # An invalid type does not keep the others from being tested.
        return collect_own(
            request.distros or [DEFAULT_DISTRO],
            request.types,
            request.paths,
            depends=request.depends,
            problems=problems,
        )
    return collect_tasks(request.distros, request.types)


def _workspace(request: Request) -> tuple[str, ...]:
    """Return the folders of the active workspace with the packages of the named types."""
    packages = {name.partition("/")[0] for name in request.types}
    return tuple(
        folder
        for distro in request.distros or [DEFAULT_DISTRO]
        for folder in workspace_folders(distro, packages)
    )
