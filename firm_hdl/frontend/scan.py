"""The search for ROS packages and their definition files in a folder. No definition is read.

A package is a folder with a ``package.xml``, or any folder with definitions. Its definitions are in
``msg/``, ``srv/`` and ``action/``, and in the folders in these: as in rosidl and genmsg, such a
folder is not part of a type's name.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias
from xml.etree import ElementTree

from firm_hdl.errors import DefinitionError
from firm_hdl.files import read_file
from firm_hdl.frontend.names import KINDS, Kind

__all__ = ["MAX_BYTES", "PackageFolder", "Scan", "package_name"]

MAX_BYTES = 1 << 22
"""Limit on a file: ten times the longest definition in a thousand packages."""

MAX_FOLDERS = 100_000
"""Limit on a search, which takes some seconds: a hundred times the folders of a large workspace."""

# Files that make colcon and catkin skip a folder.
_IGNORE_MARKERS = frozenset({"AMENT_IGNORE", "CATKIN_IGNORE", "COLCON_IGNORE"})

# Folders in which ROS 2, up to foxy, installs other texts of the same types, for DDS.
_OF_DDS = frozenset({"dds_connext", "dds_fastrtps", "dds_opensplice"})

_Identity: TypeAlias = tuple[int, int]


@dataclass(slots=True, kw_only=True)
class PackageFolder:
    """A folder that is a package, or a part of one."""

    package: str
    path: str
    # The paths of the files of each kind and name, which may be the name of no type.
    files: dict[tuple[Kind, str], list[str]] = field(default_factory=dict)
    wrong: str = ""  # The reason why the package cannot be used; empty if it can be used.
    # Whether catkin's build made the folder for messages that it adds to the package.
    is_part: bool = False


class Scan:
    """One search; links are followed, each folder is looked at once.

    * `root`: the folder. It is searched even if it has a file such as ``COLCON_IGNORE``.
    """

    def __init__(self, root: str) -> None:
        # Folders that this user may not read. They may have packages or definitions.
        self.unreadable: list[str] = []
        self._root = root
        self._left = MAX_FOLDERS

    def packages(self) -> Iterator[PackageFolder]:
        """Yield every package at or below the folder, in order of their paths.

        Raises `DefinitionError` if the folder cannot be read, or has too many folders. It has no
        span.
        """
        seen: set[_Identity] = set()
        pending = [self._root]
        while pending:
            path = pending.pop()
            try:
                names = self._names(path, seen)
            except OSError as error:
                if path == self._root:
                    raise DefinitionError.of(f"'{path}' cannot be read: {error.strerror}") from None
                self.unreadable.append(path)
                continue
            if path != self._root and not _IGNORE_MARKERS.isdisjoint(names):
                continue
            is_package = "package.xml" in names
            found = PackageFolder(package=os.path.basename(path), path=path)
            self._add_files(found, names, is_package=is_package)
            if is_package or found.files:
                found.package, found.wrong = package_name(path, is_package)
                config = os.path.join(path, "cmake", f"{found.package}Config.cmake")
                found.is_part = not is_package and os.path.isfile(config)
                yield found
            if is_package:
                continue  # As in colcon and catkin, a package contains no other packages.
            kinds = {kind for kind, _ in found.files}
            inside = [name for name in names if name not in kinds and not name.startswith(".")]
            pending += reversed(_folders(path, inside))

    def prefix(self) -> Iterator[PackageFolder]:
        """Yield the packages of an installation of ROS 2, in order of their names.

        These are the folders in ``share/`` that are packages, and all that the index of ament
        lists. Other folders are not searched, because the installation may be in ``/usr``.
        """
        share = os.path.join(self._root, "share")
        index = os.path.join(share, "ament_index", "resource_index", "packages")
        listed = set(_listed(index))
        for package in sorted(listed.union(_listed(share))):
            found = PackageFolder(package=package, path=os.path.join(share, package))
            inside = _listed(found.path)
            self._add_files(found, inside, is_package=True)
            if package in listed or "package.xml" in inside or found.files:
                yield found

    def _add_files(self, found: PackageFolder, names: Collection[str], *, is_package: bool) -> None:
        """Add the definitions in a folder whose entries are `names`."""
        for kind in KINDS:
            seen: set[_Identity] = set()
            top = _folders(found.path, [kind] if kind in names else [])
            pending = list(top)
            while pending:
                path = pending.pop()
                try:
                    inside = self._names(path, seen)
                except OSError:
                    self.unreadable.append(path)
                    continue
                if path not in top and not {*_IGNORE_MARKERS, "package.xml"}.isdisjoint(inside):
                    continue
                others = []
                for name in inside:
                    stem, ending = os.path.splitext(name)
                    if name.startswith("."):
                        continue  # Such as ``._Name.msg`` of archivers, ``.#Name.msg`` of editors.
                    if ending in (f".{kind}", ".idl"):
                        found.files.setdefault((kind, stem), []).append(os.path.join(path, name))
                    # A folder that is called like a kind may group packages, unless in a package.
                    elif name not in _OF_DDS and (is_package or name not in KINDS):
                        others.append(name)
                below = [each for each in _folders(path, others) if not _is_above(each, found.path)]
                pending += reversed(below)

    def _names(self, path: str, seen: set[_Identity]) -> list[str]:
        """List a folder, sorted; as empty if it was seen, because a link may lead back to it."""
        status = os.stat(path)
        identity = status.st_dev, status.st_ino
        if identity in seen:
            return []
        seen.add(identity)
        self._left -= 1
        if self._left < 0:
            few = "name a folder with fewer, such as that of a workspace"
            raise DefinitionError.of(f"'{self._root}' has more than {MAX_FOLDERS} folders: {few}")
        return sorted(os.listdir(path))


def _folders(path: str, names: Collection[str]) -> list[str]:
    paths = (os.path.join(path, name) for name in names)
    return [each for each in paths if os.path.isdir(each)]


def _is_above(path: str, folder: str) -> bool:
    """Tell whether a path is a link to a folder, or to one above it."""
    real = os.path.realpath(path)
    return os.path.islink(path) and os.path.commonpath([real, os.path.realpath(folder)]) == real


def _listed(path: str) -> list[str]:
    """List a folder; as empty if it cannot be read, because ROS's tools pass over it then."""
    try:
        return os.listdir(path)
    except OSError:
        return []


def package_name(folder: str, is_named: bool) -> tuple[str, str]:
    """Read a package's name; also return the reason if it cannot be read."""
    name, wrong = None, ""
    if is_named:
        path = os.path.join(folder, "package.xml")
        try:
            name = ElementTree.fromstring(read_file(path, MAX_BYTES)).findtext("name")
        except ElementTree.ParseError:
            pass  # Use the folder's name, which is nearly always that of the package.
        except OSError as error:
            wrong = f"'{path}' cannot be read: {error.strerror}"
        except (LookupError, ValueError):
            wrong = f"'{path}' is in an encoding that is not known"
    return (name or "").strip() or Path(folder).resolve().name, wrong
