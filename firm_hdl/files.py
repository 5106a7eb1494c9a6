"""Reading files that somebody else made: regular ones of a sensible size, and no others.

A FIFO or a terminal would be waited for, a device may never end, and a sparse file of a gigabyte
costs nothing to make and much to read.
"""

from __future__ import annotations

import errno
import os
import stat

__all__ = ["check_file", "read_file"]

_KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a FIFO"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
    (stat.S_ISSOCK, "a socket"),
)


def read_file(path: str | os.PathLike[str], most_bytes: int) -> bytes:
    """Read a file.

    Raises
    ------
    OSError
        If it cannot be read, is no regular file, or has more than `most_bytes`.
    """
    check_file(path, most_bytes)
    # It may have become something else since: then nobody waits for it, either.
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    with open(os.open(path, flags), "rb") as file:
        _check(os.fstat(file.fileno()), path, most_bytes)
        # Some files, such as those of /proc, do not tell their size.
        data = file.read(most_bytes + 1)
    if len(data) > most_bytes:
        raise _too_large(path, f"more than {most_bytes}", most_bytes)
    return data


def check_file(path: str | os.PathLike[str], most_bytes: int | None = None) -> None:
    """Check that a path is a regular file of a sensible size, without opening it.

    Raises
    ------
    OSError
        If it is not, or is not there.
    """
    _check(os.stat(path), path, most_bytes)


def _check(status: os.stat_result, path: str | os.PathLike[str], most_bytes: int | None) -> None:
    if not stat.S_ISREG(status.st_mode):
        kinds = [what for is_one, what in _KINDS if is_one(status.st_mode)]
        reason = f"it is {kinds[0] if kinds else 'something else'}, not a regular file"
        raise OSError(errno.EINVAL, reason, os.fspath(path))
    if most_bytes is not None and status.st_size > most_bytes:
        raise _too_large(path, str(status.st_size), most_bytes)


def _too_large(path: str | os.PathLike[str], size: str, most_bytes: int) -> OSError:
    reason = f"it has {size} bytes, and at most {most_bytes} are read"
    return OSError(errno.EFBIG, reason, os.fspath(path))
