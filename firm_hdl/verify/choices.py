"""What the arguments of ``firm-hdl verify`` can say: names, and limits.

Names only, so that a command which is called wrongly, or about a type that cannot be used, need not
wait for the imports of those modules. Where the things themselves are, a test compares the names.
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

SYSTEM_NAMES = ("ts1", "ts2", "ts3", "bench")
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
"""Simulators of exported text: :data:`firm_hdl.verify.simulators.SIMULATORS`."""

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
"""Those that can be references of TS3: :data:`firm_hdl.verify.references.choice.WRITERS`."""

NO_REFERENCE = "none"
"""Says that no library has to confirm rosbags' bytes."""

MOST_MESSAGES = 100
"""Most messages of each type in a recording to replay, if nobody says otherwise."""

LONGEST = 1 << 18
"""Longest recorded message to replay, if nobody says otherwise: it takes a minute or so."""
