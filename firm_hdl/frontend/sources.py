"""The origins of definitions, searched in order: the first one that has a package hides others.

An origin can list names and find a text. Origins are folders with ROS packages, the types of a
distribution, and recordings. Folders and distributions have whole packages. As in ROS, only the
first copy of a package is used, even if it lacks a type that another copy has. A recording has
single types, which hide no others.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, Protocol, TypeAlias

from firm_hdl.errors import DefinitionError, Diagnostic, Source, Span
from firm_hdl.files import read_file
from firm_hdl.frontend.embedded import embedded_names, embedded_source
from firm_hdl.frontend.names import KINDS, Kind, TypeName, owners
from firm_hdl.frontend.scan import MAX_BYTES, PackageFolder, Scan

__all__ = [
    "Definition",
    "EmbeddedOrigin",
    "FolderOrigin",
    "Language",
    "Origin",
    "PackagePlace",
    "Sources",
    "distro_of",
]

Language: TypeAlias = Literal["msg", "srv", "action", "idl"]
"""The language of a definition's text."""

# A name of a type in some dialect.
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")

# How many copies of a package or of a type an error lists.
_MOST_PLACES = 4


@dataclass(frozen=True, slots=True, kw_only=True)
class Definition:
    """A text that defines a message, a service or an action."""

    source: Source
    language: Language


@dataclass(frozen=True, slots=True, kw_only=True)
class PackagePlace:
    """The place of a package."""

    where: str  # Its folder, or the distribution that it comes with.
    wrong: str = ""  # The reason why the package cannot be used; empty if it can be used.


class Origin(Protocol):
    """A place from which definitions are read."""

    @property
    def packages(self) -> Mapping[str, PackagePlace]:
        """The packages that are here as a whole, so that they hide those of later origins."""

    def names(self) -> Iterable[tuple[str, Kind, str]]:
        """List package, kind and name of everything that is defined here."""

    def find(self, package: str, kind: Kind, name: str) -> Definition | None:
        """Read a definition; `None` if this origin does not have it.

        Raises `DefinitionError` if the origin has the definition, but cannot read it.
        """


class EmbeddedOrigin:
    """The types that come with firm-hdl.

    * `distro`: a key of `DISTROS`.
    * `packages`: `None` is all packages.
    """

    def __init__(self, distro: str, packages: Collection[str] | None = None) -> None:
        self._distro, self._packages = distro, packages
        # The name of the distribution, if all of it is here.
        self.distro = distro if packages is None else ""

    @cached_property
    def packages(self) -> Mapping[str, PackagePlace]:
        """The packages of the distribution."""
        place = PackagePlace(where=self._distro)
        return {package: place for package, _, _ in self.names()}

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


def distro_of(origins: Iterable[Origin]) -> str:
    """Return the distribution that is among origins as a whole; empty if none is."""
    names = (each.distro for each in origins if isinstance(each, EmbeddedOrigin))
    return next((name for name in names if name), "")


class FolderOrigin:
    """A folder that is a package, or contains packages at any depth.

    The folder is scanned once, for names only; a file is read when its type is needed. A package
    has its files in ``msg/``, ``srv/`` and ``action/`` and in folders below, in source or in
    installed layout. An installation has each type in ROS's own language and in IDL; the file in
    ROS's language is read.

    * `path`: it is scanned even if it has a file such as ``COLCON_IGNORE``.
    * `is_prefix`: whether the folder is an installation of ROS 2: packages are the folders in
      ``share/``, and what the index of ament lists.

    Raises `DefinitionError` if the path is not a folder, cannot be read or has too many folders. It
    has no span.
    """

    def __init__(self, path: str | os.PathLike[str], *, is_prefix: bool = False) -> None:
        root = os.fspath(path)
        if not os.path.isdir(root):
            raise DefinitionError.of(f"'{root}' is not a folder")
        self.path = root
        scan = Scan(root)
        # Folders that this user may not read. They may have more packages or definitions.
        self.unreadable = scan.unreadable
        self._folders: dict[str, list[PackageFolder]] = {}
        for folder in scan.prefix() if is_prefix else scan.packages():
            self._folders.setdefault(folder.package, []).append(folder)
        for folders in self._folders.values():
            folders.sort(key=lambda folder: folder.is_part)
        self.packages: Mapping[str, PackagePlace] = {
            package: PackagePlace(where=folders[0].path, wrong=_wrong(root, package, folders))
            for package, folders in self._folders.items()
            if not folders[0].is_part
        }

    def names(self) -> Iterable[tuple[str, Kind, str]]:
        """List the types of all files but those like ``Name (copy).msg``."""
        for package, folders in self._folders.items():
            for kind, name in dict.fromkeys(key for folder in folders for key in folder.files):
                if _NAME.fullmatch(name):
                    yield package, kind, name

    def find(self, package: str, kind: Kind, name: str) -> Definition | None:
        """Read the file of a definition."""
        files = self._files(package, kind, name)
        if not files:
            return None
        if wrong := self.problem(package, kind, name):
            raise DefinitionError.of(wrong)
        language: Language = "idl" if files[0].endswith(".idl") else kind
        return Definition(source=_read(files[0]), language=language)

    def problem(self, package: str, kind: Kind, name: str) -> str:
        """Return why it is not clear which file has a definition; empty if it is clear."""
        place = self.packages.get(package)
        if place is not None and place.wrong:
            return place.wrong
        files = self._files(package, kind, name)
        # The same file may be linked from several folders.
        if len(files) > 1 and len(set(map(os.path.realpath, files))) > 1:
            return f"'{package}/{kind}/{name}' has {len(files)} definitions: {_listed(files)}"
        return ""

    def _files(self, package: str, kind: Kind, name: str) -> list[str]:
        for folder in self._folders.get(package, ()):
            if files := folder.files.get((kind, name)):
                return [file for file in files if not file.endswith(".idl")] or files
        return []

    def include(self, path: str) -> Source | None:
        """Read the file of an ``#include "package/folder/file.idl"``; `None` if it is not here."""
        package, _, rest = path.partition("/")
        if package not in self._folders or rest.startswith("/") or ".." in rest.split("/"):
            return None
        if package in self.packages and self.packages[package].wrong:
            raise DefinitionError.of(self.packages[package].wrong)
        file = os.path.join(self._folders[package][0].path, rest)
        return _read(file) if os.path.isfile(file) else None


class Sources:
    """The definitions of several origins.

    * `origins`: the first one that has a package hides the package in those after it.
    * `implied`: origins after these, whose types are found but not listed.
    """

    def __init__(self, origins: Iterable[Origin], implied: Iterable[Origin] = ()) -> None:
        listed, more = tuple(origins), tuple(implied)
        self._origins, self._listed = listed + more, len(listed)
        # The distribution that is one of them as a whole; empty if none is.
        # Whether there are such origins, as behind a recording.
        self.has_implied, self.implied_distro = bool(more), distro_of(more)

    def _having(self, package: str) -> Iterator[Origin]:
        """Yield the origins that may have types of a package: all without the hidden copies."""
        is_taken = False
        for origin in self._origins:
            has_package = package in origin.packages
            if not (has_package and is_taken):
                yield origin
            is_taken |= has_package

    @cached_property
    def _all_names(self) -> tuple[frozenset[tuple[str, Kind, str]], ...]:
        return tuple(frozenset(origin.names()) for origin in self._origins)

    @cached_property
    def _names(self) -> tuple[frozenset[tuple[str, Kind, str]], ...]:
        """What is defined in each origin, without hidden packages."""
        found: list[frozenset[tuple[str, Kind, str]]] = []
        taken: set[str] = set()
        for origin, names in zip(self._origins, self._all_names, strict=True):
            hidden = taken & origin.packages.keys()
            found.append(frozenset(name for name in names if name[0] not in hidden))
            taken |= origin.packages.keys()
        return tuple(found)

    def place(self, package: str) -> PackagePlace | None:
        """Return where a package is taken from; `None` if no origin has the whole package."""
        places = (origin.packages.get(package) for origin in self._having(package))
        return next((place for place in places if place is not None), None)

    def hidden_place(self, names: Iterable[TypeName]) -> PackagePlace | None:
        """Return the place of a hidden package that has one of some types, or its interface."""
        wanted = {(n.package, n.kind, n.name) for name in names for n in (name, *owners(name))}
        for origin, names_of_all, shown in zip(
            self._origins, self._all_names, self._names, strict=True
        ):
            for package, _, _ in wanted & (names_of_all - shown):
                return origin.packages[package]
        return None

    @cached_property
    def unreadable(self) -> list[str]:
        """Folders that this user may not read."""
        folders = (origin for origin in self._origins if isinstance(origin, FolderOrigin))
        return [path for folder in folders for path in folder.unreadable]

    @cached_property
    def problems(self) -> list[Diagnostic]:
        """Why some definitions cannot be used although they are listed, each reason once."""
        found: dict[str, None] = {}
        for origin, names in zip(self._origins, self._names, strict=True):
            if isinstance(origin, FolderOrigin):
                found |= dict.fromkeys(origin.problem(*name) for name in sorted(names))
        return [Diagnostic(message) for message in found if message]

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

        Returns: `None` if no origin has one of that name.

        Raises `DefinitionError` if the definition exists but cannot be read.
        """
        for origin in self._having(package):
            found = origin.find(package, kind, name)
            if found is not None:
                return found
        return None

    def include(self, path: str) -> Source | None:
        """Read a file that an IDL file includes.

        Returns: `None` if the file does not exist. Empty if the file is one that ROS generates from
        a definition in another language, because its types are found by name.
        """
        for origin in self._having(path.partition("/")[0]):
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


def _wrong(root: str, package: str, folders: Iterable[PackageFolder]) -> str:
    """Return why a package cannot be used; empty if it can be used."""
    copies = [folder for folder in folders if not folder.is_part]
    if len(copies) > 1:
        places = _listed([folder.path for folder in copies])
        return (
            f"package '{package}' has {len(copies)} folders below '{root}': {places}; name one of "
            "them, or put a file COLCON_IGNORE into the others"
        )
    return copies[0].wrong


def _listed(paths: Sequence[str]) -> str:
    shown = ", ".join(f"'{path}'" for path in paths[:_MOST_PLACES])
    return shown + (", ..." if len(paths) > _MOST_PLACES else "")


def _read(path: str) -> Source:
    try:
        data = read_file(path, MAX_BYTES)
    except OSError as error:
        raise DefinitionError.of(f"'{path}' cannot be read: {error.strerror}") from None
    try:
        return Source(name=path, text=data.decode("utf-8"))
    except UnicodeDecodeError as error:
        source = Source(name=path, text=data.decode("utf-8", "replace"))
        start = len(data[: error.start].decode("utf-8"))
        span = Span(source, start, start + 1)
        message = f"byte 0x{data[error.start]:02x} is not UTF-8 text"
        raise DefinitionError.of(message, span) from None
