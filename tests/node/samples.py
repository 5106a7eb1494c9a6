"""Descriptions of nodes, and packages with the types that they name."""

from __future__ import annotations

from pathlib import Path

from firm_hdl.frontend import Library
from firm_hdl.node import Description, read_description_text

__all__ = ["LIBRARY", "PACKAGES", "RELAY", "WHEELS", "read"]

PACKAGES = Path(__file__).parents[2] / "docs" / "packages"

WHEELS = """\
node: wheels
namespace: /robot
distro: jazzy
subscribe:
  /cmd_vel: {type: geometry_msgs/msg/Twist, rate_hz: 50}
  names: {type: std_msgs/msg/String, reliability: best_effort, depth: 5, memory_bytes: 256}
publish:
  odom: {type: geometry_msgs/msg/Vector3}
serve:
  ~/calibrate: {type: robot_msgs/srv/Calibrate, memory_bytes: 256}
"""

RELAY = """\
node: relay
distro: jazzy
bus_bytes: 4
subscribe:
  /in_1: {type: std_msgs/msg/UInt16}
  /alone: {type: std_msgs/msg/UInt8}
publish:
  /out_1: {type: std_msgs/msg/UInt16}
"""
"""A node without accelerator, one of whose subscriptions has a publication of the same type."""

LIBRARY = Library("jazzy", [PACKAGES])
"""The library of all descriptions of tests: it is opened once."""


def read(text: str = WHEELS, **changes: str) -> Description:
    """Read a description, after lines of it were replaced by `changes`: `link` for ``link: ``."""
    lines = [line for line in text.splitlines() if line.partition(":")[0] not in changes]
    lines += [f"{key}: {value}" for key, value in changes.items()]
    return read_description_text("\n".join(lines) + "\n", library=LIBRARY)
