"""Read files from unknown sources: only regular files of limited size. Write files as a whole.

Reading a FIFO or a terminal may block, a device may never end, and a sparse file of a gigabyte is
cheap to create and expensive to read. A file that is written is either the old or the new one at
any time, also if the disk is full, or the process is killed.
"""

from __future__ import annotations

import errno
import os
import secrets
import stat
import sys
from contextlib import suppress

__all__ = ["check_file", "read_file", "write_file", "write_new"]

_KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a FIFO"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
    (stat.S_ISSOCK, "a socket"),
)


def read_file(path: str | os.PathLike[str], max_bytes: int) -> bytes:
    """Read a file.

    Raises `OSError` if the file cannot be read, is not a regular file, or has more than
    `max_bytes`.
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

    Raises `OSError` if the path does not exist, or is another kind of file, or the file is too
    large.
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


def write_file(path: str | os.PathLike[str], text: str) -> None:
    """Write a text, as UTF-8, to a path that the user named. Missing folders are made.

    A link stays, and the file that it leads to is replaced. A device, standard output, and a FIFO
    that somebody reads, are written to. Bytes of a file's name that are not UTF-8 are written as in
    JSON, ``\\udcff``.

    Raises `OSError` if the file cannot be written. A regular file is then unchanged.
    """
    data = text.encode("utf-8", "backslashreplace")
    status = os.stat(path) if os.path.exists(path) else None
    if status is not None and _is_standard_output(status):
        sys.stdout.write(data.decode())
        return
    if status is not None and not stat.S_ISREG(status.st_mode):
        # A FIFO would wait for a reader, which may never come.
        try:
            number = os.open(path, os.O_WRONLY | getattr(os, "O_NONBLOCK", 0))
        except OSError as error:
            if error.errno != errno.ENXIO or not stat.S_ISFIFO(status.st_mode):
                raise
            raise OSError(errno.ENXIO, "nobody reads it", os.fspath(path)) from None
        os.set_blocking(number, True)
        with open(number, "wb") as file:
            file.write(data)
        return
    target = os.path.realpath(path)
    temporary = os.path.join(os.path.dirname(target), f".firm-hdl-{secrets.token_hex(8)}.part")
    try:
        with suppress(FileExistsError):
            os.makedirs(os.path.dirname(target))
        write_new(temporary, data)
        if status is not None:
            # A file that may not be written may be replaced nevertheless.
            os.close(os.open(target, os.O_WRONLY))
            os.chmod(temporary, stat.S_IMODE(status.st_mode))
        os.replace(temporary, target)
    except OSError as error:
        raise OSError(error.errno, error.strerror, os.fspath(path)) from None
    finally:
        with suppress(OSError):
            os.unlink(temporary)


def write_new(
    path: str | os.PathLike[str], data: bytes, mode: int = 0o666, *, folder: int | None = None
) -> None:
    """Write a file that does not exist yet.

    * `mode`: rights, before the process's mask.
    * `folder`: descriptor of the folder that a relative path is in; `None`: the current folder.

    Raises `OSError` if something exists at the path, a link included, or the file cannot be
    written. There is no new file.
    """
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW
    number = os.open(path, flags, mode, dir_fd=folder)
    try:
        with open(number, "wb") as file:
            file.write(data)
    except BaseException:
        os.unlink(path, dir_fd=folder)
        raise


def _is_standard_output(status: os.stat_result) -> bool:
    # What else is printed comes before and after it, also if `/dev/stdout` is a regular file.
    with suppress(OSError, ValueError):
        return os.path.samestat(status, os.fstat(sys.stdout.fileno()))
    return False
