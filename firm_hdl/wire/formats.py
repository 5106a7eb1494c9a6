"""The table of all wire formats."""

from __future__ import annotations

from firm_hdl.model import Wire
from firm_hdl.wire.cdr import CDR
from firm_hdl.wire.ros1 import ROS1
from firm_hdl.wire.rules import WireRules

__all__ = ["RULES"]

RULES: dict[Wire, WireRules] = {rules.wire: rules for rules in (ROS1, CDR)}
"""The rules of each wire format, by its name."""
