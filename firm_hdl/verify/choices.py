"""Names and limits that the arguments of ``firm-hdl verify`` accept.

This module imports nothing. So a call with a wrong argument or an unusable type fails without
waiting for slow imports. A test compares the names with the objects that they stand for.
"""

from __future__ import annotations

__all__ = [
    "CLIENT_NAMES",
    "LONGEST",
    "MOST_MESSAGES",
    "NO_REFERENCE",
    "ORACLE_NAMES",
    "SIMULATOR_NAMES",
    "SYSTEM_NAMES",
    "WRITER_NAMES",
]

SYSTEM_NAMES = ("ts1", "ts2", "ts3", "bench", "board")
"""Test systems: :data:`firm_hdl.verify.run.SYSTEMS`."""

ORACLE_NAMES = (
    "genmsg",
    "rosidl_adapter",
    "rosidl_parser",
    "rosidl_adapter-4.6",
    "rosidl_parser-4.6",
    "rosidl_adapter-4.9",
    "rosidl_parser-4.9",
    "rosbags",
    "ros2",
)
"""Oracles of TS1: :data:`firm_hdl.verify.ts1.oracles.ORACLES`."""

SIMULATOR_NAMES = ("ghdl", "iverilog", "verilator")
"""Simulators of exported text: :data:`firm_hdl.verify.simulators.programs.SIMULATORS`."""

CLIENT_NAMES = (
    "firm-hdl",
    "rosbags",
    "genpy",
    "fastcdr",
    "fastcdr-2.2",
    "fastcdr-2.3",
    "cyclonedds",
    "mcap-ros1",
    "mcap-ros2",
)
"""Client libraries: :data:`firm_hdl.verify.references.clients.CLIENTS`."""

WRITER_NAMES = ("genpy", "fastcdr", "fastcdr-2.2", "fastcdr-2.3", "cyclonedds")
"""Client libraries that can be references of TS3.

They are the keys of :data:`firm_hdl.verify.references.clients.WRITERS`.
"""

NO_REFERENCE = "none"
"""The value of ``--reference`` for which no library has to confirm rosbags' bytes."""

MOST_MESSAGES = 100
"""Default limit for the messages of each type that are replayed from recordings."""

LONGEST = 1 << 18
"""Default size in bytes of the longest recorded message to replay, which takes about a minute."""
