"""A type's folder: whole or not at all, and with what users have put there.

A new folder is staged beside the old one, under a name that nothing else has, and then the two are
exchanged in one step. So whoever looks sees the old one or the new one, and a build that is killed
leaves one of them in place. What it leaves besides is cleared away by the next build, which holds a
lock meanwhile.

Nothing is deleted that firm-hdl did not write: the manifest says what it did. All else is in the
new folder, too, as a hard link where the file system has them, before the old one goes; what turns
up in the old one after that is moved over.
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
"""No file of a folder that firm-hdl wrote is larger."""

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
    """Tell whether there is a folder, with nothing in it."""
    return folder.is_dir() and next(folder.iterdir(), None) is None


def is_current(folder: Path, inputs: Mapping[str, Any]) -> bool:
    """Tell whether a folder was made of these inputs and has all its files as they were written."""
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
    """Make a folder have these files, and what users have put there.

    Returns
    -------
    dict of str to str
        What a user's files are called now: those that have the name of one of these, and those that
        were written while the folder was replaced.

    Raises
    ------
    OSError
        If that is not possible. The folder is as it was.
    """
    folder = _behind_link(folder)
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
                renamed = _keep_others(folder, staging, files)
                _swap(folder, staging, made)
            else:
                staging.rename(folder)
        finally:
            # Of the two, the one that is not in use, whichever that is.
            late = _clear_up(folder, _leftovers(folder) if alone else made)
    return renamed | late


def clear_up(folder: Path) -> None:
    """Clear away what a killed build left of a folder; put the old one back if none is there."""
    folder = _behind_link(folder)
    if folder.parent.is_dir() and _leftovers(folder):
        with locked(folder.parent) as alone:
            if alone:
                _clear_up(folder, _leftovers(folder))


def _behind_link(folder: Path) -> Path:
    """Where a link stands for a folder, it goes on to do so."""
    return Path(os.path.realpath(folder)) if folder.is_symlink() else folder


def _prefix(folder: Path) -> str:
    # A name of its own length may be as long as the file system lets it.
    return f".firm-hdl.{hashlib.sha256(os.fsencode(folder.name)).hexdigest()[:16]}."


def _make(folder: Path, what: str, made: list[Path]) -> Path:
    """Make a folder beside a folder, of a name that nothing has; append it to those made."""
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
    # An old folder is put back before anything is moved there.
    return [folder.with_name(name) for name in sorted(names, key=lambda n: n.endswith(_NEW))]


def _write_files(staging: Path, files: Mapping[str, str]) -> None:
    """Write the manifest first: it says what may be deleted if this is as far as it goes."""
    for name in sorted(files, key=lambda name: name != MANIFEST):
        (staging / name).parent.mkdir(exist_ok=True)
        (staging / name).write_text(files[name], encoding="utf-8", newline="\n")
        if name.endswith(".sh"):
            (staging / name).chmod(0o755)


def _swap(folder: Path, staging: Path, made: list[Path]) -> None:
    """Put the new folder where the old one is."""
    if exchange(staging, folder):
        return
    old = _make(folder, _OLD, made)
    # Here, for a moment, there is no folder; `_clear_up` puts it back if it stays so.
    folder.rename(old)
    staging.rename(folder)


# What users have put there.


def _walk(root: Path) -> list[tuple[str, bool]]:
    """List what is in a folder, by its path there, and whether it is a folder.

    What is in a folder comes before the folder.
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


def _ours(folder: Path) -> set[str]:
    """List what firm-hdl wrote, or was about to write, in a folder."""
    found = read_manifest(folder)
    return {MANIFEST, *(found["files"] if found is not None else ())}


def _keep_others(folder: Path, staging: Path, files: Mapping[str, str]) -> dict[str, str]:
    """Give a new folder all that the old one has and firm-hdl did not write.

    Returns new names by old ones where they differ.
    """
    renamed: dict[str, str] = {}
    ours = _ours(folder)
    folders = {os.path.dirname(name) for name in ours}
    copies: dict[Path, Path] = {}
    for name, is_folder in _walk(folder):
        if name in (folders if is_folder else ours):
            continue
        kept = staging / _free(name, is_folder, files)
        if is_folder:
            kept.mkdir(parents=True, exist_ok=True)
            copies[folder / name] = kept
            continue
        kept.parent.mkdir(parents=True, exist_ok=True)
        for target in _names(kept):
            if not os.path.lexists(target):
                _link(folder / name, target)
                if target != staging / name:
                    renamed[name] = target.relative_to(staging).as_posix()
                break
    for source, target in copies.items():
        shutil.copystat(source, target)
    return renamed


def _free(name: str, is_folder: bool, files: Mapping[str, str]) -> str:
    """Give what is a user's another name where firm-hdl now has a file or a folder of that name."""
    folders = {os.path.dirname(file) for file in files}
    path = ""
    for part in name.split("/"):
        path += part
        is_last = path.count("/") == name.count("/")
        if path in files or (is_last and not is_folder and path in folders):
            path += ".kept"
        path += "/"
    return path.removesuffix("/")


def _names(path: Path) -> Iterator[Path]:
    """Yield a path, then others for what cannot have it."""
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
        # No hard links here, or not of this file. What cannot be read cannot be kept.
        if os.path.lexists(target):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(target)) from None
        shutil.copy2(source, target, follow_symlinks=False)


# What a build leaves.


def _clear_up(folder: Path, leftovers: list[Path]) -> dict[str, str]:
    """Delete leftovers, but for what is a user's; return new names of that by old ones."""
    renamed: dict[str, str] = {}
    for leftover in leftovers:
        is_missing = leftover.name.endswith(_OLD) and not os.path.lexists(folder)
        if is_missing and read_manifest(leftover) is not None:
            leftover.rename(folder)
        else:
            # What cannot be deleted stays for the next time; the folder itself is whole.
            with suppress(OSError):
                _discard(leftover, folder, renamed)
    return renamed


def _discard(leftover: Path, folder: Path, renamed: dict[str, str]) -> None:
    """Delete a folder; move what is a user's, and is nowhere else, to the one that is in use."""
    ours = _ours(leftover)
    linked = {_identity(folder / name) for name, _ in _walk(folder)} if folder.is_dir() else set()
    _permit(leftover)
    for name, is_folder in _walk(leftover):
        entry = leftover / name
        if is_folder:
            # Of what was not moved, it still has something.
            with suppress(OSError):
                entry.rmdir()
        elif name == MANIFEST:
            continue  # To the last, it says what is ours.
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
    """Let us delete what is in folders that were made read-only."""
    for name, is_folder in [("", True), *_walk(root)]:
        mode = (root / name).lstat().st_mode
        if is_folder and mode & stat.S_IRWXU != stat.S_IRWXU:
            (root / name).chmod(stat.S_IMODE(mode) | stat.S_IRWXU)


def _identity(path: Path) -> tuple[int, int]:
    status = path.lstat()
    return status.st_dev, status.st_ino


def _is_copied(leftover: Path, folder: Path, name: str) -> bool:
    """Whether a file without hard links is in the folder, too, under its name or the user's."""
    names = name, name.removesuffix(".kept")
    return any(_is_same(leftover / name, folder / other) for other in names)


def _is_same(one: Path, other: Path) -> bool:
    """Whether nothing is lost if one of two files goes."""
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
    """Move a user's file, over nothing that is there; return where it is."""
    place = target = folder / name
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        target = folder / name.replace("/", "_")
    for place in _names(target):
        # Unlike `rename`, a link never replaces anything.
        with suppress(FileExistsError):
            if not _is_same(entry, place):
                _link(entry, place)
            break
    entry.unlink()
    return place
