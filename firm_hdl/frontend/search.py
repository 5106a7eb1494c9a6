"""Search for definitions in the places that options of a command and the environment name.

ROS's tools find packages by environment variables that a ROS setup file sets. The command reads the
same variables, so that it finds the packages of the active workspace. As in ROS, the first folder
that has a package hides those in later ones.
"""

from __future__ import annotations

import os
from collections.abc import Container, Iterable, Iterator, Mapping
from contextlib import suppress

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.frontend.embedded import DEFAULT_DISTRO, DISTROS
from firm_hdl.frontend.library import Library
from firm_hdl.frontend.recordings import RecordingOrigin
from firm_hdl.frontend.sources import EmbeddedOrigin, FolderOrigin, Origin
from firm_hdl.model import Dialect, Message
from firm_hdl.wire import refusals

__all__ = [
    "ENVIRONMENT",
    "all_names",
    "environment_origins",
    "load_all",
    "open_library",
    "workspace_folders",
]

ENVIRONMENT: dict[Dialect, str] = {"ros1": "ROS_PACKAGE_PATH", "ros2": "AMENT_PREFIX_PATH"}
"""The variable that says where packages are."""

# What the messages that ROS adds to services and actions are made of.
_IMPLIED = frozenset({"builtin_interfaces", "service_msgs", "unique_identifier_msgs"})


def open_library(
    distro: str | None = None,
    paths: Iterable[str | os.PathLike[str]] = (),
    bags: Iterable[str | os.PathLike[str]] = (),
    *,
    depends: Iterable[str | os.PathLike[str]] = (),
    environment: Mapping[str, str] | None = None,
) -> Library:
    """Open a library of all definitions that a command uses.

    * `distro`: `None` is the distribution that the recordings name, else the newest one of their
      dialect. Without recordings, the default distribution.
    * `paths`: folders with ROS packages. They are searched first, then those of the environment,
      then the distribution's own types.
    * `bags`: recordings. If there are any, the types of the library are theirs. What they lack
      comes from folders, from the distribution if it is named, and what ROS itself adds to services
      and actions from any distribution.
    * `depends`: folders with packages that others depend on, searched after `paths` or the
      recordings.
    * `environment`: variables to read (by default those of the process).

    Raises `DefinitionError` if a folder or a recording cannot be used. It has no span.
    """
    folders, files, needed = list(paths), list(bags), [FolderOrigin(path) for path in depends]
    if files:
        return _of_recordings(distro, files, [*map(FolderOrigin, folders), *needed])
    distro = distro or DEFAULT_DISTRO
    found = environment_origins(
        DISTROS[distro].dialect, os.environ if environment is None else environment
    )
    return Library(distro, folders, origins=[*needed, *found, EmbeddedOrigin(distro)])


def all_names(
    distro: str | None,
    paths: Iterable[str | os.PathLike[str]],
    bags: Iterable[str | os.PathLike[str]],
    *,
    depends: Iterable[str | os.PathLike[str]] = (),
) -> list[str]:
    """List all types: those of the folders or recordings, or else those of all origins.

    Parameters and errors are those of `open_library`.
    """
    folders = list(paths)
    if folders:
        return Library(distro or DEFAULT_DISTRO, folders, origins=()).interfaces()
    return open_library(distro, (), bags, depends=depends).interfaces()


def environment_origins(dialect: Dialect, environment: Mapping[str, str]) -> Iterator[FolderOrigin]:
    """Give the folders that the environment names; as in ROS, unusable entries are skipped."""
    for place in environment.get(ENVIRONMENT[dialect], "").split(os.pathsep):
        if os.path.isdir(place) and os.access(place, os.R_OK | os.X_OK):
            yield FolderOrigin(place, is_prefix=dialect == "ros2")


def workspace_folders(
    distro: str, packages: Container[str], environment: Mapping[str, str] | None = None
) -> list[str]:
    """List folders with the given packages, as options for a command: those that count in ROS.

    * `environment`: variables to read (by default those of the process).
    """
    variables = os.environ if environment is None else environment
    found: dict[str, str] = {}
    for origin in environment_origins(DISTROS[distro].dialect, variables):
        for package, place in origin.packages.items():
            if package in packages:
                # The folder itself would hide why the package cannot be used.
                found.setdefault(package, origin.path if place.wrong else place.where)
    return [folder for folder in dict.fromkeys(found.values()) if os.path.isdir(folder)]


def _of_recordings(
    distro: str | None, paths: Iterable[str | os.PathLike[str]], needed: list[FolderOrigin]
) -> Library:
    # A distribution is asked for more only if it is named: a recording need not say which it is of.
    others: list[Origin] = [*needed, *([] if distro is None else [EmbeddedOrigin(distro)])]
    files, alone = list(paths), []
    for path in files:
        # Others may have what it lacks.
        with suppress(DefinitionError):
            alone.append(RecordingOrigin(path))
    recordings = []
    for path in files:
        whole = [each for each in alone if each.path == os.fspath(path) and not each.unusable]
        more = [each for each in alone if each.path != os.fspath(path)]
        recordings += whole[:1] or [RecordingOrigin(path, [*more, *others])]
    first = recordings[0]
    for other in recordings:
        if other.dialect != first.dialect:
            raise DefinitionError.of(
                f"'{first.path}' is a recording of {_ros(first.dialect)}, and '{other.path}' of "
                f"{_ros(other.dialect)}; read them one at a time"
            )
    if distro is None:
        known = [recording.distro for recording in recordings if recording.distro is not None]
        distro = known[0] if known else _newest(first.dialect)
    if DISTROS[distro].dialect != first.dialect:
        raise DefinitionError.of(
            f"'{first.path}' is a recording of {_ros(first.dialect)}, and {distro} is "
            f"{_ros(DISTROS[distro].dialect)}"
        )
    implied: list[Origin] = [*others, EmbeddedOrigin(distro, _IMPLIED)]
    library = Library(distro, origins=recordings, implied=implied)
    for recording in recordings:
        library.unusable |= recording.unusable
    return library


def _newest(dialect: Dialect) -> str:
    if DISTROS[DEFAULT_DISTRO].dialect == dialect:
        return DEFAULT_DISTRO
    return [name for name, distro in DISTROS.items() if distro.dialect == dialect][-1]


def _ros(dialect: Dialect) -> str:
    return "ROS 1" if dialect == "ros1" else "ROS 2"


def load_all(library: Library, types: Iterable[str]) -> list[Message]:
    """Load the messages of types, each once, and check that they can be laid out.

    A service or an action gives all of its messages.

    Raises `DefinitionError`: with the errors of all types, including fields without a wire format.
    """
    messages: dict[str, Message] = {}
    problems: dict[str, Diagnostic] = {}
    for name in types:
        try:
            found = library.interface(name).messages
        except DefinitionError as error:
            wrong = list(error.diagnostics)
        else:
            wrong = [each for message in found for each in refusals(message)]
            messages.update((message.name, message) for message in found)
        problems.update((str(problem), problem) for problem in wrong)
    if problems:
        raise DefinitionError(problems.values())
    return list(messages.values())
