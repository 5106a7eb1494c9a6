"""Packages of the folders that a design may compile into one library."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from contextlib import suppress
from pathlib import Path

from firm_hdl.export.backend import BuildError, Converters
from firm_hdl.export.folder import read_manifest
from firm_hdl.export.tree import tree_of

__all__ = ["FOLDER", "SECTION", "check_packages"]

FOLDER = "vhdl"
"""Subfolder of a type's folder."""

SECTION = "vhdl"
"""Key of the manifest's entry about the subfolder."""


def check_packages(folders: Mapping[Path, Converters]) -> None:
    """Refuse messages in neighbouring folders that use one package name for two ROS types.

    Within a message, the second of two equal names gets a number. A design with both messages
    compiles each file name once, so a name must belong to the same type in all folders.

    Raises
    ------
    BuildError
    """
    owners: dict[Path, tuple[str, Path]] = {}
    for folder, converters in folders.items():
        if converters.options.ports != "records":
            continue
        for package in tree_of(converters.message, converters.plan).packages:
            file, owner = folder.parent / package.name, package.message.name
            if file not in owners:
                owners[file] = _owner(file, folders) or (owner, folder)
            other, other_folder = owners[file]
            if other != owner:
                raise BuildError(
                    f"{converters.message.name}: the VHDL package '{package.name}' would be that "
                    f"of {owner}, but in '{other_folder}' it is that of {other}; build one of them "
                    "into another folder (--out), and compile it into another library"
                )


def _owner(file: Path, made_anew: Collection[Path]) -> tuple[str, Path] | None:
    """Return the type that owns a package in a folder that is not built now, and that folder."""
    for path in sorted(file.parent.glob(f"[!.]*/{FOLDER}/{file.name}.vhd")):
        folder = path.parent.parent
        found = None if folder in made_anew else read_manifest(folder)
        # The manifest may be damaged.
        with suppress(AttributeError, KeyError, TypeError):
            for each in (found or {SECTION: {"shared_packages": []}})[SECTION]["shared_packages"]:
                if each["name"] == file.name and each["message"]:
                    return str(each["message"]), folder
    return None
