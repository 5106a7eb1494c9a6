"""Newer releases of ROS 2 than Debian has, from PyPI: their rosidl and their Fast CDR.

Each release is in an environment of its own, which `make oracles-ros2` makes: packages of two
releases have the same names, and those of ROS may run code of theirs when Python starts. What is in
it stands in ``ros2_wheels/RELEASE.txt``.
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
    """A release of ROS 2.

    Attributes
    ----------
    name : str
        As that of the distribution.
    rosidl, fastcdr : str
        Versions, as far as names of oracles have them.
    """

    name: str
    rosidl: str
    fastcdr: str

    @property
    def folder(self) -> Path:
        """Where its environment is: in the one that runs this, or where the user says."""
        return Path(os.environ.get(_FOLDER) or os.path.join(sys.prefix, "ros2")) / self.name

    @property
    def python(self) -> Path:
        """The Python of its environment, which need not be there."""
        return self.folder / "bin" / "python"

    @property
    def how(self) -> str:
        """How to get it, in a few words."""
        return (
            f"(make oracles-ros2, or {_FOLDER}=DIR where DIR/{self.name} is an environment of "
            f"Python with it)"
        )


RELEASES = (
    Release(name="jazzy", rosidl="4.6", fastcdr="2.2"),
    Release(name="kilted", rosidl="4.9", fastcdr="2.3"),
)
"""Oldest first."""
