"""What a run ran on: versions of all that results may depend on."""

from __future__ import annotations

import os
import platform
from datetime import datetime, timezone
from importlib.metadata import PackageNotFoundError, version

import firm_hdl

__all__ = ["environment"]

PACKAGES = ("amaranth", "rosbags", "numpy", "lark", "distributed")


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
