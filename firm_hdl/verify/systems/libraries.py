"""Which definitions TS2 and what follows see."""

from __future__ import annotations

from functools import cache

from firm_hdl.frontend import Library, open_library

__all__ = ["library_of"]


@cache
def library_of(distro: str, paths: tuple[str, ...], bags: tuple[str, ...] = ()) -> Library:
    """Return a library, which is opened once in a process.

    Without folders and recordings it has the distribution's own types, whatever workspace is
    active: rosbags knows these without being told. Behind folders comes the workspace.
    """
    return open_library(distro, paths, bags) if paths or bags else Library(distro)
