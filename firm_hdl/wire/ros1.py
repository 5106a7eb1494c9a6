"""The ROS 1 wire format: packed, little-endian, no header, no padding.

The format is that of genpy and roscpp: a message body without the length that TCPROS puts first.
"""

from __future__ import annotations

from firm_hdl.wire.rules import WireRules

__all__ = ["ROS1"]

ROS1 = WireRules(
    wire="ros1",
    encapsulation=b"",
    option_bytes=0,
    max_align=1,
    terminated=False,
    empty_member=None,
    max_trailing_bytes=0,
)
