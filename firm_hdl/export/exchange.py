"""Two things that the standard library lacks: folders that change places, and one build at a time.

Linux exchanges two paths in one step (``renameat2`` with ``RENAME_EXCHANGE``), on the file systems
that have it; nobody sees one of them missing. Elsewhere there is nothing of the kind.
"""

from __future__ import annotations

import ctypes
import errno
import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

__all__ = ["exchange", "locked"]

_AT_FDCWD = -100
_RENAME_EXCHANGE = 2
# What a kernel or a file system says that cannot do it.
_UNABLE = frozenset({errno.ENOSYS, errno.EINVAL, errno.ENOTSUP, errno.EPERM})

LOCK_SECONDS = 60.0
"""How long to wait for another build to write one folder, which takes a fraction of a second."""


def exchange(one: Path, other: Path) -> bool:
    """Make two paths change places, in one step.

    Returns
    -------
    bool
        Whether that was done; `False` if this system cannot do it.

    Raises
    ------
    OSError
        If it can, but not with these paths.
    """
    if not sys.platform.startswith("linux"):
        return False
    try:
        renameat2 = ctypes.CDLL(None, use_errno=True).renameat2
    except (OSError, AttributeError):
        return False
    paths = os.fsencode(one), os.fsencode(other)
    if renameat2(_AT_FDCWD, paths[0], _AT_FDCWD, paths[1], _RENAME_EXCHANGE) == 0:
        return True
    code = ctypes.get_errno()
    if code in _UNABLE:
        return False
    raise OSError(code, os.strerror(code), os.fspath(other))


@contextmanager
def locked(folder: Path) -> Iterator[bool]:
    """Keep others from writing in a folder meanwhile, as far as they ask.

    The lock is on the folder itself, so that it leaves no file, and it ends with the process. Where
    there are no such locks, there is none, and what is given is `False`.

    Raises
    ------
    OSError
        If another process holds it for a minute.
    """
    try:
        import fcntl
    except ImportError:
        yield False
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        end = time.monotonic() + LOCK_SECONDS
        alone = False
        while not alone:
            try:
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
                alone = True
            except BlockingIOError:
                if time.monotonic() > end:
                    reason = "another process has been writing there for a minute"
                    raise OSError(errno.EBUSY, reason, os.fspath(folder)) from None
                time.sleep(0.02)
            except OSError:
                break  # A file system without locks.
        yield alone
    finally:
        os.close(descriptor)
