"""Read files from unknown sources: only regular files of limited size.

Reading a FIFO or a terminal may block, a device may never end, and a sparse file of a gigabyte is
cheap to create and expensive to read.
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


def read_file(path: str | os.PathLike[str], max_bytes: int) -> bytes:
    """Read a file.

    Raises
    ------
    OSError
        If the file cannot be read, is not a regular file, or has more than `max_bytes`.
    """
    check_file(path, max_bytes)
    # Open without blocking, because the file may have been replaced since the check.
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    with open(os.open(path, flags), "rb") as file:
        _check(os.fstat(file.fileno()), path, max_bytes)
        # Some files, such as those of /proc, report a size of 0.
        data = file.read(max_bytes + 1)
    if len(data) > max_bytes:
        raise _too_large(path, f"more than {max_bytes}", max_bytes)
    return data


def check_file(path: str | os.PathLike[str], max_bytes: int | None = None) -> None:
    """Check that a path is a regular file of a sensible size, without opening it.

    Raises
    ------
    OSError
        If the path does not exist, or is another kind of file, or the file is too large.
    """
    _check(os.stat(path), path, max_bytes)


def _check(status: os.stat_result, path: str | os.PathLike[str], max_bytes: int | None) -> None:
    if not stat.S_ISREG(status.st_mode):
        kinds = [what for is_one, what in _KINDS if is_one(status.st_mode)]
        reason = f"it is {kinds[0] if kinds else 'something else'}, not a regular file"
        raise OSError(errno.EINVAL, reason, os.fspath(path))
    if max_bytes is not None and status.st_size > max_bytes:
        raise _too_large(path, str(status.st_size), max_bytes)


def _too_large(path: str | os.PathLike[str], size: str, max_bytes: int) -> OSError:
    reason = f"it has {size} bytes, and at most {max_bytes} are read"
    return OSError(errno.EFBIG, reason, os.fspath(path))
