"""Compiled programs that are kept for the next time, in folders that nobody else can write.

What lies in such a folder is run. So the folder has to belong to this user, no other user may be
able to write it or to replace it, and no link leads to it. A file counts only if it is a regular
one of this user. Only files with names of this module are removed.

The folder of the user is ``~/.cache/firm-hdl/programs`` (or below ``XDG_CACHE_HOME``). If it cannot
be used, programs are kept in a temporary folder until this process ends.
"""

from __future__ import annotations

import atexit
import errno
import functools
import hashlib
import logging
import os
import re
import shutil
import stat
import tempfile
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path

__all__ = ["cache_folder", "kept_program", "private_folder"]

_KEPT_SECONDS = 30 * 24 * 3600.0
# Programs, and those that were being written when a process was killed.
_NAME = re.compile(r"[a-z]+-[0-9a-f]{64}(\.[a-z0-9_]+)?")
# Folders of tools that keep what they have compiled, and run it, where we say.
_OF_OTHERS = "wasmtime", "zig"
_OTHERS = stat.S_IWGRP | stat.S_IWOTH
_log = logging.getLogger(__name__)


def private_folder(folder: Path) -> Path:
    """Make a folder that this user alone can write, or check that a folder is one.

    Its path is absolute, and without links.

    Raises `OSError` if the folder cannot be made, is a link, or belongs to another user, or if
    other users can write it or replace it.
    """
    folder = Path(os.path.abspath(folder))
    folder = Path(os.path.realpath(folder.parent), folder.name)
    for each in reversed([folder, *folder.parents]):
        if not os.path.lexists(each):
            with suppress(FileExistsError):  # Another process may do the same.
                os.mkdir(each, 0o700)
        status = os.lstat(each)
        owners, writers = {os.geteuid()}, _OTHERS
        if each != folder:
            owners.add(0)
            if status.st_mode & stat.S_ISVTX:
                # Nobody else can replace what belongs to this user.
                writers = 0
            elif status.st_gid == status.st_uid:
                # Many systems give each user a group of the same number, and let it write.
                writers = stat.S_IWOTH
        if not stat.S_ISDIR(status.st_mode):
            what = "a link" if stat.S_ISLNK(status.st_mode) else "not a folder"
            raise NotADirectoryError(errno.ENOTDIR, f"it is {what}", str(each))
        if status.st_uid not in owners:
            raise PermissionError(errno.EPERM, "it belongs to another user", str(each))
        if status.st_mode & writers:
            raise PermissionError(
                errno.EPERM, "other users can write it (see chmod go-w)", str(each)
            )
    return folder


def cache_folder() -> Path:
    """Return the user's folder of compiled programs, or a temporary one if it cannot be used."""
    base = os.environ.get("XDG_CACHE_HOME", "")
    try:
        # By the specification of XDG, a relative path does not count.
        if not os.path.isabs(base):
            home = os.environ.get("HOME", os.path.expanduser("~"))
            if not (os.path.isabs(home) and os.path.isdir(home)):
                # A home is never made.
                raise FileNotFoundError(errno.ENOENT, "there is no such folder", home or "HOME")
            base = os.path.join(home, ".cache")
        folder = private_folder(Path(base, "firm-hdl", "programs"))
        for name in _OF_OTHERS:
            if os.path.lexists(folder / name):
                private_folder(folder / name)
        return folder
    except OSError as error:
        return _temporary_folder(f"{error.filename}: {error.strerror}")


@functools.cache
def _temporary_folder(why: str) -> Path:
    """Make a folder that is removed at the end of this process, and tell the user why."""
    _log.warning("There is no folder for compiled programs, which are made each time: %s", why)
    folder = tempfile.mkdtemp(prefix="firm-hdl-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)


def kept_program(
    kind: str, parts: Iterable[str], make: Callable[[Path], Path], folder: Path | None = None
) -> Path:
    """Return a compiled program; compile it unless it is kept.

    Programs that were not used for 30 days are removed when another one is kept.

    * `kind`: lower-case letters, with which the name of the file begins.
    * `parts`: all that the program depends on.
    * `make`: compiles the program in an empty folder, and returns its file.
    * `folder`: where programs are kept; `None`: :func:`cache_folder`.

    Raises `OSError` if the folder was named and cannot be used; what `make` raises.
    """
    digest = hashlib.sha256()
    for part in parts:
        data = part.encode("utf-8", "surrogateescape")
        digest.update(len(data).to_bytes(8, "little") + data)
    place = cache_folder() if folder is None else private_folder(folder)
    program = place / f"{kind}-{digest.hexdigest()}"
    if _is_ours(program):
        with suppress(OSError):
            os.utime(program)
        return program
    with tempfile.TemporaryDirectory(prefix="firm-hdl-") as scratch:
        made = make(Path(scratch))
        try:
            _keep(made, program)
        except OSError as error:
            if folder is not None:
                raise OSError(error.errno, error.strerror, str(place)) from None
            program = _temporary_folder(f"{place}: {error.strerror}") / program.name
            _keep(made, program)
    return program


def _is_ours(program: Path) -> bool:
    try:
        status = os.lstat(program)
    except FileNotFoundError:
        return False
    is_private = status.st_uid == os.geteuid() and not status.st_mode & _OTHERS
    return stat.S_ISREG(status.st_mode) and is_private


def _keep(made: Path, program: Path) -> None:
    """Copy a program to its place. Another process may do the same, with an equal file."""
    for entry in os.scandir(program.parent):
        with suppress(OSError):
            age = time.time() - entry.stat(follow_symlinks=False).st_mtime
            is_file = entry.is_file(follow_symlinks=False)
            if is_file and age > _KEPT_SECONDS and _NAME.fullmatch(entry.name):
                os.unlink(entry.path)
    descriptor, new = tempfile.mkstemp(prefix=f"{program.name}.", dir=program.parent)
    try:
        with open(descriptor, "wb") as file, made.open("rb") as source:
            shutil.copyfileobj(source, file)
            os.fchmod(file.fileno(), 0o700)
        os.replace(new, program)
    except BaseException:
        os.unlink(new)
        raise
