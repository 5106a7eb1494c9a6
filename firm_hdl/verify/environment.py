"""What a run ran on: versions of all that results may depend on."""

from __future__ import annotations

import hashlib
import os
import platform
from datetime import datetime, timezone
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import firm_hdl

__all__ = ["code_digest", "environment"]

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


def environment(**more: str) -> dict[str, str]:
    """Return names and versions, none of which tells one user or one machine from another.

    Parameters
    ----------
    **more
        What else is to be in it.
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
    """Return a digest of the package's own files: results of other code are other results."""
    root = Path(firm_hdl.__file__).parent
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*")):
        if path.suffix in (".py", ".lark", ".cpp", ".h"):
            digest.update(f"{path.relative_to(root).as_posix()}\0".encode())
            digest.update(path.read_bytes() + b"\0")
    return digest.hexdigest()[:12]
