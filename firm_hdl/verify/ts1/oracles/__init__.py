"""All oracles of definitions."""

from __future__ import annotations

from firm_hdl.verify.ts1.oracles.oracle import Oracle
from firm_hdl.verify.ts1.oracles.ros import NEWER, Genmsg, Ros2Proto, RosidlAdapter, RosidlParser
from firm_hdl.verify.ts1.oracles.rosbags_oracle import Rosbags

__all__ = ["ORACLES"]

_ALL: tuple[type[Oracle], ...] = (
    Genmsg,
    RosidlAdapter,
    RosidlParser,
    *NEWER,
    Rosbags,
    Ros2Proto,
)

ORACLES: dict[str, type[Oracle]] = {oracle.name: oracle for oracle in _ALL}
"""Every oracle by name, in the order of reports."""
