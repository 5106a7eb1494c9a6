"""Time of software libraries for the same messages for which cycles are counted.

rosbags and genpy are the libraries for Python. Fast CDR, called as in ROS 2's type support, is the
library for C++.
"""

from __future__ import annotations

from lab.bench.software.run import (
    CLOCK_MHZ,
    Compared,
    compare_software,
    library_versions,
    machine,
)
from lab.bench.software.table import made_on, software_rows, software_table

__all__ = [
    "CLOCK_MHZ",
    "Compared",
    "compare_software",
    "library_versions",
    "machine",
    "made_on",
    "software_rows",
    "software_table",
]
