"""Replace a type's folder as a whole, and keep the user files in it.

A new folder is staged beside the old one, under a unique name. Then the two are exchanged in one
step. So other processes see either the old or the new folder, and a killed build leaves one of them
in place. The next build deletes other leftovers of a killed build, under a lock.

Only files that firm-hdl wrote are deleted; the manifest lists them. All other files are user files.
They are put into the new folder before the old one is deleted: as hard links if possible, else as
copies. User files that are written to the old folder after that are moved to the new one.
"""

from __future__ import annotations

import errno
import filecmp
import hashlib
import json
import os
import secrets
import shutil
import stat
from collections.abc import Iterator, Mapping
from contextlib import suppress
from itertools import count
from pathlib import Path
from typing import Any

from firm_hdl.export.exchange import exchange, locked
from firm_hdl.export.manifest import MANIFEST
from firm_hdl.files import read_file

__all__ = ["clear_up", "is_current", "is_empty", "read_manifest", "replace"]

_MOST_BYTES = 1 << 28
"""Files over this size are not read; firm-hdl writes no such files."""

_NEW, _OLD = "new", "old"


def read_manifest(folder: Path) -> dict[str, Any] | None:
    """Return a folder's manifest; `None` if firm-hdl did not make the folder."""
    try:
        found = json.loads(read_file(folder / MANIFEST, _MOST_BYTES))
    except (OSError, ValueError, RecursionError):
        return None
    needs = {"inputs_sha256": str, "inputs": dict, "files": dict}
    if not isinstance(found, dict):
        return None
    return found if all(isinstance(found.get(key), needs[key]) for key in needs) else None


def is_empty(folder: Path) -> bool:
    """Return whether a path is an empty folder."""
    return folder.is_dir() and next(folder.iterdir(), None) is None


def is_current(folder: Path, inputs: Mapping[str, Any]) -> bool:
    """Return whether a folder was made from these inputs and its files are unchanged."""
    found = read_manifest(folder)
    if found is None or found["inputs"] != inputs:
        return False
    try:
        return all(
            hashlib.sha256(read_file(folder / name, _MOST_BYTES)).hexdigest() == digest
            for name, digest in found["files"].items()
        )
    except (OSError, ValueError):
        return False


def replace(folder: Path, files: Mapping[str, str]) -> dict[str, str]:
    """Replace the generated files of a folder, and keep the user files in it.

    Returns
    -------
    dict of str to str
        New names of user files by their old names. The files are those that had the name of a
        generated file, and those that were written while the folder was replaced.

    Raises
    ------
    OSError
        If the folder cannot be replaced. It is unchanged.
    """
    folder = _resolve_link(folder)
    folder.parent.mkdir(parents=True, exist_ok=True)
    with locked(folder.parent) as alone:
        made: list[Path] = []
        renamed: dict[str, str] = {}
        if alone:
            _clear_up(folder, _leftovers(folder))
        try:
            staging = _make(folder, _NEW, made)
            _write_files(staging, files)
            if os.path.lexists(folder):
                renamed = _keep_user_files(folder, staging, files)
                _swap(folder, staging, made)
            else:
                staging.rename(folder)
        finally:
            # After an exchange, the old folder is at the path of the staging folder.
            late = _clear_up(folder, _leftovers(folder) if alone else made)
    return renamed | late


def clear_up(folder: Path) -> None:
    """Delete the leftovers of a killed build; put the old folder back if there is no folder."""
    folder = _resolve_link(folder)
    if folder.parent.is_dir() and _leftovers(folder):
        with locked(folder.parent) as alone:
            if alone:
                _clear_up(folder, _leftovers(folder))


def _resolve_link(folder: Path) -> Path:
    """Return the folder that a symbolic link leads to, so that the link stays in place."""
    return Path(os.path.realpath(folder)) if folder.is_symlink() else folder


def _prefix(folder: Path) -> str:
    # Use a hash, because the folder's own name may already have the maximum length.
    return f".firm-hdl.{hashlib.sha256(os.fsencode(folder.name)).hexdigest()[:16]}."


def _make(folder: Path, what: str, made: list[Path]) -> Path:
    """Make a folder with a new name beside a folder; append it to `made`."""
    while True:
        path = folder.with_name(f"{_prefix(folder)}{secrets.token_hex(8)}.{what}")
        with suppress(FileExistsError):
            made.append(path)
            path.mkdir()
            return path


def _leftovers(folder: Path) -> list[Path]:
    prefix = _prefix(folder)
    endings = f".{_OLD}", f".{_NEW}"
    names = [n for n in os.listdir(folder.parent) if n.startswith(prefix) and n.endswith(endings)]
    # Old folders come first: one of them may be put back before user files are moved into it.
    return [folder.with_name(name) for name in sorted(names, key=lambda n: n.endswith(_NEW))]


def _write_files(staging: Path, files: Mapping[str, str]) -> None:
    """Write the files, the manifest first: if the build is killed, it lists the files to delete."""
    for name in sorted(files, key=lambda name: name != MANIFEST):
        (staging / name).parent.mkdir(exist_ok=True)
        (staging / name).write_text(files[name], encoding="utf-8", newline="\n")
        if name.endswith(".sh"):
            (staging / name).chmod(0o755)


def _swap(folder: Path, staging: Path, made: list[Path]) -> None:
    """Put the new folder in the place of the old one."""
    if exchange(staging, folder):
        return
    old = _make(folder, _OLD, made)
    # Between these two calls there is no folder. If the build is killed here, `_clear_up` puts the
    # old one back.
    folder.rename(old)
    staging.rename(folder)


# User files.


def _walk(root: Path) -> list[tuple[str, bool]]:
    """List the relative paths of all files and folders in a folder, and whether each is a folder.

    The content of a folder comes before the folder itself.
    """
    found: list[tuple[str, bool]] = []
    pending = [""]
    while pending:
        below = pending.pop()
        with os.scandir(root / below) as entries:
            for entry in sorted(entries, key=lambda entry: entry.name):
                is_folder = entry.is_dir(follow_symlinks=False)
                found.append((f"{below}{entry.name}", is_folder))
                if is_folder:
                    pending.append(f"{below}{entry.name}/")
    return found[::-1]


def _generated_files(folder: Path) -> set[str]:
    """Return the files of a folder that firm-hdl wrote or was about to write."""
    found = read_manifest(folder)
    return {MANIFEST, *(found["files"] if found is not None else ())}


def _keep_user_files(folder: Path, staging: Path, files: Mapping[str, str]) -> dict[str, str]:
    """Put all user files of the old folder into the new one.

    Returns the new names of renamed files by their old names.
    """
    renamed: dict[str, str] = {}
    ours = _generated_files(folder)
    folders = {os.path.dirname(name) for name in ours}
    copies: dict[Path, Path] = {}
    for name, is_folder in _walk(folder):
        if name in (folders if is_folder else ours):
            continue
        kept = staging / _free_name(name, files)
        if is_folder:
            kept.mkdir(parents=True, exist_ok=True)
            copies[folder / name] = kept
            continue
        kept.parent.mkdir(parents=True, exist_ok=True)
        for target in _candidate_paths(kept):
            if not os.path.lexists(target):
                _link(folder / name, target)
                if target != staging / name:
                    renamed[name] = target.relative_to(staging).as_posix()
                break
    for source, target in copies.items():
        shutil.copystat(source, target)
    return renamed


def _free_name(name: str, files: Mapping[str, str]) -> str:
    """Return the name for a user file or folder, in a folder that no generated file replaces."""
    path = ""
    for part in name.split("/"):
        path += part
        if path in files:
            path += ".kept"
        path += "/"
    return path.removesuffix("/")


def _candidate_paths(path: Path) -> Iterator[Path]:
    """Yield a path, then alternative names in case it is taken."""
    name = path.name.removesuffix(".kept")
    yield path
    yield path.with_name(f"{name}.kept")
    for number in count(2):
        yield path.with_name(f"{name}.kept{number}")


def _link(source: Path, target: Path) -> None:
    try:
        os.link(source, target, follow_symlinks=False)
    except FileExistsError:
        raise
    except OSError:
        # No hard link is possible here: copy. A file that cannot be read makes the build fail.
        if os.path.lexists(target):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(target)) from None
        shutil.copy2(source, target, follow_symlinks=False)


# Leftovers of a build.


def _clear_up(folder: Path, leftovers: list[Path]) -> dict[str, str]:
    """Delete leftovers but keep user files; return new names of user files by their old names."""
    renamed: dict[str, str] = {}
    for leftover in leftovers:
        is_missing = leftover.name.endswith(_OLD) and not os.path.lexists(folder)
        if is_missing and read_manifest(leftover) is not None:
            leftover.rename(folder)
        else:
            # Leave what cannot be deleted to the next build. The folder in use is complete.
            with suppress(OSError):
                _discard(leftover, folder, renamed)
    return renamed


def _discard(leftover: Path, folder: Path, renamed: dict[str, str]) -> None:
    """Delete a leftover folder; move user files that exist only in it to the folder in use."""
    ours = _generated_files(leftover)
    linked = {_identity(folder / name) for name, _ in _walk(folder)} if folder.is_dir() else set()
    _permit(leftover)
    for name, is_folder in _walk(leftover):
        entry = leftover / name
        if is_folder:
            # A folder is not empty, and stays, if a file in it was not moved.
            with suppress(OSError):
                entry.rmdir()
        elif name == MANIFEST:
            continue  # The manifest is deleted last, because it lists our files.
        elif name in ours or _identity(entry) in linked or _is_copied(leftover, folder, name):
            entry.unlink()
        elif folder.is_dir():
            place = _move(entry, folder, name).relative_to(folder).as_posix()
            if place != name:
                renamed[name] = place
    rest = os.listdir(leftover)
    if rest == [MANIFEST]:
        (leftover / MANIFEST).unlink()
    if rest in ([], [MANIFEST]):
        leftover.rmdir()


def _permit(root: Path) -> None:
    """Make read-only folders writable, so that their content can be deleted."""
    for name, is_folder in [("", True), *_walk(root)]:
        mode = (root / name).lstat().st_mode
        if is_folder and mode & stat.S_IRWXU != stat.S_IRWXU:
            (root / name).chmod(stat.S_IMODE(mode) | stat.S_IRWXU)


def _identity(path: Path) -> tuple[int, int]:
    status = path.lstat()
    return status.st_dev, status.st_ino


def _is_copied(leftover: Path, folder: Path, name: str) -> bool:
    """Return whether the folder has a copy of a file, under its new or its original name."""
    names = name, name.removesuffix(".kept")
    return any(_is_same(leftover / name, folder / other) for other in names)


def _is_same(one: Path, other: Path) -> bool:
    """Return whether two files have the same content."""
    try:
        a, b = one.lstat(), other.lstat()
        if os.path.samestat(a, b):
            return True
        if stat.S_ISLNK(a.st_mode) and stat.S_ISLNK(b.st_mode):
            return os.readlink(one) == os.readlink(other)
        if not (stat.S_ISREG(a.st_mode) and stat.S_ISREG(b.st_mode)):
            return False
        return filecmp.cmp(one, other, shallow=False)
    except OSError:
        return False


def _move(entry: Path, folder: Path, name: str) -> Path:
    """Move a user file without overwriting anything; return its new path."""
    place = target = folder / name
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        target = folder / name.replace("/", "_")
    for place in _candidate_paths(target):
        # Unlike `rename`, a link never replaces anything.
        with suppress(FileExistsError):
            if not _is_same(entry, place):
                _link(entry, place)
            break
    entry.unlink()
    return place
