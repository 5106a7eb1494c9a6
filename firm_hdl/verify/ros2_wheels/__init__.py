"""rosidl and Fast CDR of ROS 2 releases that are newer than Debian's, from PyPI.

Each release has its own environment, which `make oracles-ros2` creates. Packages of two releases
have the same names, and packages of ROS may run code when Python starts. The packages of an
environment are listed beside this file, such as in ``jazzy.txt``.
"""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from pathlib import Path

__all__ = ["RELEASES", "Release"]

_FOLDER = "FIRM_HDL_ROS2_WHEELS"


@dataclass(frozen=True, slots=True, kw_only=True)
class Release:
    """A release of ROS 2."""

    name: str  # The name of the distribution.
    # Versions, as they occur in the names of oracles and client libraries.
    rosidl: str
    fastcdr: str

    @property
    def folder(self) -> Path:
        """The folder of its environment, by default inside the environment that runs this."""
        return Path(os.environ.get(_FOLDER) or os.path.join(sys.prefix, "ros2")) / self.name

    @property
    def python(self) -> Path:
        """The Python of its environment, which may not exist."""
        return self.folder / "bin" / "python"

    @property
    def how(self) -> str:
        """A short text that says how to install the release."""
        packages = Path(__file__).with_name(f"{self.name}.txt")
        return (
            f"(make oracles-ros2 in a clone; elsewhere: python3 -m venv {self.folder} && "
            f"{self.folder}/bin/pip install --no-deps -r {packages})"
        )


RELEASES = (
    Release(name="jazzy", rosidl="4.6", fastcdr="2.2"),
    Release(name="kilted", rosidl="4.9", fastcdr="2.3"),
)
"""Releases, oldest first."""
