"""Where definitions come from: folders with ROS packages first, then the embedded types.

Folders are scanned once, for names only; a file is read when its type is asked for. Each type is
looked up for itself: a folder that has a package with some of its types adds to the embedded
package of that name and overrides type by type.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from functools import cached_property
from pathlib import Path
from xml.etree import ElementTree

from firm_hdl.errors import DefinitionError, Diagnostic, Source, Span
from firm_hdl.frontend.embedded import embedded_names, embedded_source

__all__ = ["Sources"]

# How colcon and catkin are told to leave a folder alone.
_IGNORE_MARKERS = frozenset({"AMENT_IGNORE", "CATKIN_IGNORE", "COLCON_IGNORE"})


class Sources:
    """All definitions that a name can mean.

    Parameters
    ----------
    distro : str
        A key of `DISTROS`.
    paths : iterable of str or path
        Folders to search, the first one first. A folder is a package, or contains packages at any
        depth, in source or in installed layout.

    Raises
    ------
    DefinitionError
        If one of the paths is not a folder. It has no span.
    """

    def __init__(self, distro: str, paths: Iterable[str | os.PathLike[str]] = ()) -> None:
        self._distro = distro
        self._files: dict[tuple[str, str], str] = {}
        wrong = []
        for given in paths:
            path = os.fspath(given)
            if os.path.isdir(path):
                for package, folder in _packages(path):
                    for file in _message_files(folder):
                        key = package, file.removesuffix(".msg")
                        self._files.setdefault(key, os.path.join(folder, "msg", file))
            else:
                wrong.append(Diagnostic(message=f"'{path}' is not a folder"))
        if wrong:
            raise DefinitionError(wrong)

    @cached_property
    def types(self) -> dict[str, list[str]]:
        """Names of the types of every package, both sorted."""
        found: dict[str, list[str]] = {}
        for package, name in sorted({*self._files, *embedded_names(self._distro)}):
            found.setdefault(package, []).append(name)
        return found

    @cached_property
    def packages_of(self) -> dict[str, list[str]]:
        """Packages that have a type of a given name, those of the distribution first."""
        found: dict[str, dict[str, None]] = {}
        for package, name in [*embedded_names(self._distro), *sorted(self._files)]:
            found.setdefault(name, {})[package] = None
        return {name: list(packages) for name, packages in found.items()}

    def find(self, package: str, name: str) -> Source | None:
        """Read the definition of a type.

        Returns
        -------
        Source or None
            `None` if there is no such type.

        Raises
        ------
        DefinitionError
            If there is, but its file cannot be read.
        """
        file = self._files.get((package, name))
        return embedded_source(self._distro, package, name) if file is None else _read(file)


def _packages(root: str) -> Iterator[tuple[str, str]]:
    """Yield name and folder of every package at or below a folder, in order of their paths."""
    seen: set[tuple[int, int]] = set()
    pending = [root]
    while pending:
        folder = pending.pop()
        try:
            status = os.stat(folder)
            entries = sorted(os.scandir(folder), key=lambda entry: entry.name)
        except OSError:
            continue  # A folder that this user may not read has nothing to offer.
        names = {entry.name for entry in entries}
        # A link may lead back to a folder above it.
        if (status.st_dev, status.st_ino) in seen or names & _IGNORE_MARKERS:
            continue
        seen.add((status.st_dev, status.st_ino))
        if "msg" in names and _message_files(folder):
            yield _package_name(folder), folder
        if "package.xml" in names:
            continue  # As for colcon and catkin, a package contains no other.
        pending += [
            entry.path
            for entry in reversed(entries)
            if not entry.name.startswith(".") and entry.name != "msg" and os.path.isdir(entry.path)
        ]


def _message_files(package: str) -> list[str]:
    try:
        names = os.listdir(os.path.join(package, "msg"))
    except OSError:
        return []
    return sorted(name for name in names if name.endswith(".msg") and name != ".msg")


def _package_name(folder: str) -> str:
    try:
        name = ElementTree.parse(os.path.join(folder, "package.xml")).findtext("name")
    except (OSError, ElementTree.ParseError):
        name = None
    return (name or "").strip() or Path(folder).resolve().name


def _read(path: str) -> Source:
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        message = f"'{path}' cannot be read: {error.strerror}"
        raise DefinitionError([Diagnostic(message=message)]) from None
    try:
        return Source(name=path, text=data.decode("utf-8"))
    except UnicodeDecodeError as error:
        source = Source(name=path, text=data.decode("utf-8", "replace"))
        start = len(data[: error.start].decode("utf-8"))
        span = Span(source=source, start=start, end=start + 1)
        message = f"byte 0x{data[error.start]:02x} is not UTF-8 text"
        raise DefinitionError([Diagnostic(message=message, span=span)]) from None
