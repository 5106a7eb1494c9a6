"""The environment of a run: versions of the software that results may depend on."""

from __future__ import annotations

import hashlib
import os
import platform
from collections.abc import Iterable, Iterator
from datetime import datetime, timezone
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import firm_hdl
from firm_hdl.files import read_file

__all__ = ["code_digest", "environment", "inputs_digest"]

PACKAGES = (
    "amaranth",
    "rosbags",
    "cyclonedds",
    "mcap-ros1-support",
    "mcap-ros2-support",
    "numpy",
    "lark",
    "distributed",
)

_INPUTS = (".msg", ".srv", ".action", ".idl", ".xml", ".yaml")
"""Suffixes of the files that definitions, packages and golden plans are read from."""

_MOST_BYTES = 1 << 22
"""No definition is larger (`firm_hdl.frontend.sources`). Of a larger file, only the size counts."""


def environment(**more: str) -> dict[str, str]:
    """Return names and versions, none of which identifies a user or a machine.

    Parameters
    ----------
    **more
        Further entries.
    """
    found = {
        "started": datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
        "firm-hdl": firm_hdl.__version__,
        "Python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        "processors": str(os.cpu_count()),
    }
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return {**found, **more}


def code_digest() -> str:
    """Return a digest of the package's own files. Results of other code cannot be continued."""
    root = Path(firm_hdl.__file__).parent
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*")):
        if path.suffix in (".py", ".lark", ".cpp", ".h", ".j2", ".vhd"):
            digest.update(f"{path.relative_to(root).as_posix()}\0".encode())
            digest.update(path.read_bytes() + b"\0")
    return digest.hexdigest()[:12]


def inputs_digest(paths: Iterable[str]) -> str:
    """Return a digest of the files that a run reads. Results of other inputs cannot be continued.

    In folders, the names and texts of definitions, ``package.xml`` and golden plans count. Of any
    other file, such as a recording, the size and the time of the last change count.
    """
    digest = hashlib.sha256()
    for path in paths:
        for name in _files(path):
            digest.update(f"{os.path.relpath(name, path)}\0".encode(errors="surrogateescape"))
            digest.update(_content(name) + b"\0")
    return digest.hexdigest()[:12]


def _files(path: str) -> Iterator[str]:
    """Yield a file itself, or the relevant files of a folder in order; links are followed."""
    if not os.path.isdir(path):
        yield path
    seen: set[str] = set()
    for folder, folders, names in os.walk(path, followlinks=True):
        real = os.path.realpath(folder)
        if real in seen:
            folders.clear()
            continue
        seen.add(real)
        folders.sort()
        is_bag = "metadata.yaml" in names
        yield from (
            os.path.join(folder, name) for name in sorted(names) if is_bag or name.endswith(_INPUTS)
        )


def _content(path: str) -> bytes:
    try:
        if path.endswith(_INPUTS):
            return read_file(path, _MOST_BYTES)
        status = os.stat(path)
    except OSError as error:
        return str(error.strerror).encode()
    return f"{status.st_size} {status.st_mtime_ns}".encode()
