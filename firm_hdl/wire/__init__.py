"""Wire formats: from a message model to its layout."""

from firm_hdl.model import Wire
from firm_hdl.wire.layout import (
    ConstantLength,
    Gap,
    Layout,
    LengthField,
    LoopNode,
    Node,
    Path,
    RunNode,
    Scalar,
    Trigger,
    lay_out,
    walk,
)
from firm_hdl.wire.refusals import MAX_LEAVES, MAX_LEVELS, refusals, too_large
from firm_hdl.wire.rules import CDR, ROS1, RULES, WireRules

__all__ = [
    "CDR",
    "MAX_LEAVES",
    "MAX_LEVELS",
    "ROS1",
    "RULES",
    "ConstantLength",
    "Gap",
    "Layout",
    "LengthField",
    "LoopNode",
    "Node",
    "Path",
    "RunNode",
    "Scalar",
    "Trigger",
    "Wire",
    "WireRules",
    "lay_out",
    "refusals",
    "too_large",
    "walk",
]
