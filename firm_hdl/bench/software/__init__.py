"""Time that libraries on a processor take for the messages that cycles are counted with.

rosbags and genpy are what a user of Python has, and Fast CDR, called as ROS 2's type support calls
it, what one of C++ has.
"""

from __future__ import annotations

from firm_hdl.bench.software.run import (
    CLOCK_MHZ,
    Compared,
    compare_software,
    library_versions,
    machine,
)
from firm_hdl.bench.software.table import made_on, software_rows, software_table

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
