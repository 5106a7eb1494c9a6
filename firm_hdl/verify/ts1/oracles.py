"""All oracles, and those that are here."""

from __future__ import annotations

from firm_hdl.verify.ts1.debian import Genmsg, RosidlAdapter, RosidlParser
from firm_hdl.verify.ts1.oracle import Oracle
from firm_hdl.verify.ts1.ros2_oracle import Ros2Proto
from firm_hdl.verify.ts1.rosbags_oracle import Rosbags

__all__ = ["ORACLES"]

ORACLES: dict[str, type[Oracle]] = {
    oracle.name: oracle for oracle in (Genmsg, RosidlAdapter, RosidlParser, Rosbags, Ros2Proto)
}
"""Every oracle by name, in the order of reports."""
