"""Atomic exchange of two folders, which the standard library lacks, and a lock on a folder.

Linux exchanges two paths in one step (``renameat2`` with ``RENAME_EXCHANGE``) on file systems that
support this; both paths exist at any time. Other systems have no such call.
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
# Errors of a kernel or a file system that does not support the exchange.
_UNSUPPORTED = frozenset({errno.ENOSYS, errno.EINVAL, errno.ENOTSUP, errno.EPERM})

LOCK_SECONDS = 60.0
"""Longest wait for another build that writes the folder. Writing takes less than a second."""


def exchange(one: Path, other: Path) -> bool:
    """Exchange two paths in one step.

    Returns
    -------
    bool
        `False` if this system or file system does not support the call; nothing was changed.

    Raises
    ------
    OSError
        If the call exists and fails for these paths.
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
    if code in _UNSUPPORTED:
        return False
    raise OSError(code, os.strerror(code), os.fspath(other))


@contextmanager
def locked(folder: Path) -> Iterator[bool]:
    """Hold an advisory lock on a folder: only one build at a time writes there.

    The lock is on the folder itself. So it leaves no file, and it ends with the process. Yields
    `False` on systems without such locks, else `True`.

    Raises
    ------
    OSError
        If another process holds the lock for a minute.
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
