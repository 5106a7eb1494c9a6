"""The origins of definitions, searched in order: the first one that has a type wins.

An origin can list names and find a text. Origins are folders with ROS packages, the types of a
distribution, and recordings. Each type is looked up by itself: a package in a folder adds types to
the embedded package of that name, and overrides types of the same name.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Literal, Protocol, TypeAlias
from xml.etree import ElementTree

from firm_hdl.errors import DefinitionError, Diagnostic, Source, Span
from firm_hdl.files import read_file
from firm_hdl.frontend.embedded import embedded_names, embedded_source
from firm_hdl.frontend.names import KINDS, Kind, TypeName

__all__ = ["Definition", "EmbeddedOrigin", "FolderOrigin", "Language", "Origin", "Sources"]

Language: TypeAlias = Literal["msg", "srv", "action", "idl"]
"""The language of a definition's text."""

# Limit on a file: ten times the longest definition in a thousand packages.
_MAX_BYTES = 1 << 22

# Files that make colcon and catkin skip a folder.
_IGNORE_MARKERS = frozenset({"AMENT_IGNORE", "CATKIN_IGNORE", "COLCON_IGNORE"})


@dataclass(frozen=True, slots=True, kw_only=True)
class Definition:
    """A text that defines a message, a service or an action."""

    source: Source
    language: Language


class Origin(Protocol):
    """A place from which definitions are read."""

    def names(self) -> Iterable[tuple[str, Kind, str]]:
        """List package, kind and name of everything that is defined here."""

    def find(self, package: str, kind: Kind, name: str) -> Definition | None:
        """Read a definition; `None` if this origin does not have it.

        Raises
        ------
        DefinitionError
            If the origin has the definition, but cannot read it.
        """


class EmbeddedOrigin:
    """The types that come with firm-hdl.

    Parameters
    ----------
    distro : str
        A key of `DISTROS`.
    packages : collection of str or None
        `None`: all packages.
    """

    def __init__(self, distro: str, packages: Collection[str] | None = None) -> None:
        self._distro, self._packages = distro, packages

    def names(self) -> Iterator[tuple[str, Kind, str]]:
        """List every message type of the packages."""
        for package, name in embedded_names(self._distro):
            if self._packages is None or package in self._packages:
                yield package, "msg", name

    def find(self, package: str, kind: Kind, name: str) -> Definition | None:
        """Write out the definition of an embedded type."""
        if kind != "msg" or (self._packages is not None and package not in self._packages):
            return None
        source = embedded_source(self._distro, package, name)
        return None if source is None else Definition(source=source, language="msg")


class FolderOrigin:
    """A folder that is a package, or contains packages at any depth.

    The folder is scanned once, for names only; a file is read when its type is needed. A package
    has its files in ``msg/``, ``srv/`` and ``action/``, in source or in installed layout. An
    installation has each type in ROS's own language and in IDL; the file in ROS's language is read.

    Parameters
    ----------
    path : str or path

    Raises
    ------
    DefinitionError
        If the path is not a folder. It has no span.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        root = os.fspath(path)
        if not os.path.isdir(root):
            raise DefinitionError([Diagnostic(message=f"'{root}' is not a folder")])
        self._files: dict[tuple[str, Kind, str], str] = {}
        self._packages: dict[str, str] = {}
        self._refused: dict[str, str] = {}
        for package, folder, wrong in _packages(root):
            if self._packages.setdefault(package, folder) == folder and wrong:
                self._refused[package] = wrong
            for kind in KINDS:
                for file in _definition_files(folder, kind):
                    key = package, kind, os.path.splitext(file)[0]
                    self._files.setdefault(key, os.path.join(folder, kind, file))

    def names(self) -> Iterable[tuple[str, Kind, str]]:
        """List the types of all files."""
        return self._files

    def find(self, package: str, kind: Kind, name: str) -> Definition | None:
        """Read the file of a definition."""
        file = self._files.get((package, kind, name))
        if file is None:
            return None
        if package in self._refused:
            raise DefinitionError([Diagnostic(message=self._refused[package])])
        language: Language = "idl" if file.endswith(".idl") else kind
        return Definition(source=_read(file), language=language)

    def include(self, path: str) -> Source | None:
        """Read the file of an ``#include "package/folder/file.idl"``; `None` if it is not here."""
        package, _, rest = path.partition("/")
        folder = self._packages.get(package)
        if folder is None or rest.startswith("/") or ".." in rest.split("/"):
            return None
        file = os.path.join(folder, rest)
        return _read(file) if os.path.isfile(file) else None


class Sources:
    """The definitions of several origins.

    Parameters
    ----------
    origins : iterable of Origin
        The first one that has a type wins.
    implied : iterable of Origin
        Origins after these, whose types are found but not listed.

    Attributes
    ----------
    has_implied : bool
        Whether there are such origins, as behind a recording.
    """

    def __init__(self, origins: Iterable[Origin], implied: Iterable[Origin] = ()) -> None:
        listed, more = tuple(origins), tuple(implied)
        self._origins, self._listed = listed + more, len(listed)
        self.has_implied = bool(more)

    @cached_property
    def _names(self) -> tuple[frozenset[tuple[str, Kind, str]], ...]:
        return tuple(frozenset(origin.names()) for origin in self._origins)

    @cached_property
    def names(self) -> frozenset[tuple[str, Kind, str]]:
        """Package, kind and name of every definition that is listed."""
        return frozenset().union(*self._names[: self._listed])

    def by_origin(self, names: Iterable[TypeName]) -> list[TypeName]:
        """Sort names by the first origin that defines them; leave out those without one."""
        found: dict[TypeName, None] = {}
        candidates = list(names)
        for names_of_origin in self._names:
            for name in candidates:
                if (name.package, name.kind, name.name) in names_of_origin:
                    found[name] = None
        return list(found)

    @cached_property
    def types(self) -> dict[str, list[tuple[Kind, str]]]:
        """Kinds and names of the definitions of every package, both sorted; messages first."""
        found: dict[str, list[tuple[Kind, str]]] = {}
        order = {kind: index for index, kind in enumerate(KINDS)}
        names = frozenset[tuple[str, Kind, str]]().union(*self._names)
        for package, kind, name in sorted(names, key=lambda n: (n[0], order[n[1]], n[2])):
            found.setdefault(package, []).append((kind, name))
        return found

    @cached_property
    def packages_of(self) -> dict[tuple[Kind, str], list[str]]:
        """Packages that have a definition of a kind and name, those of the last origin first.

        The last origin is the distribution, and a user most probably means one of its types.
        """
        found: dict[tuple[Kind, str], dict[str, None]] = {}
        for names in reversed(self._names):
            for package, kind, name in sorted(names):
                found.setdefault((kind, name), {})[package] = None
        return {key: list(packages) for key, packages in found.items()}

    def find(self, package: str, kind: Kind, name: str) -> Definition | None:
        """Read a definition.

        Returns
        -------
        Definition or None
            `None` if no origin has one of that name.

        Raises
        ------
        DefinitionError
            If the definition exists but cannot be read.
        """
        for origin in self._origins:
            found = origin.find(package, kind, name)
            if found is not None:
                return found
        return None

    def include(self, path: str) -> Source | None:
        """Read a file that an IDL file includes.

        Returns
        -------
        Source or None
            `None` if the file does not exist. Empty if the file is one that ROS generates from a
            definition in another language, because its types are found by name.
        """
        for origin in self._origins:
            if isinstance(origin, FolderOrigin):
                source = origin.include(path)
                if source is not None:
                    return source
        match path.removesuffix(".idl").split("/"):
            case [package, ("msg" | "srv" | "action") as kind, name] if path.endswith(".idl"):
                found = self.find(package, kind, name)
                if found is not None:
                    text = found.source.text if found.language == "idl" else ""
                    return Source(name=found.source.name, text=text)
        return None


def _packages(root: str) -> Iterator[tuple[str, str, str]]:
    """Yield name and folder of every package at or below a folder, in order of their paths.

    The third item is the reason why the package cannot be used; empty if it can be used.
    """
    seen: set[tuple[int, int]] = set()
    pending = [root]
    while pending:
        folder = pending.pop()
        try:
            status = os.stat(folder)
            entries = sorted(os.scandir(folder), key=lambda entry: entry.name)
        except OSError:
            continue  # This user may not read the folder.
        names = {entry.name for entry in entries}
        # A link may lead back to a folder above it.
        if (status.st_dev, status.st_ino) in seen or names & _IGNORE_MARKERS:
            continue
        seen.add((status.st_dev, status.st_ino))
        kinds = {kind for kind in KINDS if kind in names and _definition_files(folder, kind)}
        if kinds:
            name, wrong = _package_name(folder, "package.xml" in names)
            yield name, folder, wrong
        if "package.xml" in names:
            continue  # As in colcon and catkin, a package contains no other packages.
        pending += [
            entry.path
            for entry in reversed(entries)
            if not entry.name.startswith(".")
            and entry.name not in kinds
            and os.path.isdir(entry.path)
        ]


def _definition_files(package: str, kind: Kind) -> list[str]:
    """List the files of one kind, the preferred one of each type first."""
    try:
        names = os.listdir(os.path.join(package, kind))
    except OSError:
        return []
    endings = f".{kind}", ".idl"
    found = [name for name in names if name.endswith(endings) and name not in endings]
    return sorted(found, key=lambda name: (name.endswith(".idl"), name))


def _package_name(folder: str, is_named: bool) -> tuple[str, str]:
    """Read a package's name; also return the reason if it cannot be read."""
    name, wrong = None, ""
    if is_named:
        path = os.path.join(folder, "package.xml")
        try:
            name = ElementTree.fromstring(read_file(path, _MAX_BYTES)).findtext("name")
        except ElementTree.ParseError:
            pass  # Use the folder's name, which is nearly always that of the package.
        except OSError as error:
            wrong = f"'{path}' cannot be read: {error.strerror}"
        except (LookupError, ValueError):
            wrong = f"'{path}' is in an encoding that is not known"
    return (name or "").strip() or Path(folder).resolve().name, wrong


def _read(path: str) -> Source:
    try:
        data = read_file(path, _MAX_BYTES)
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
