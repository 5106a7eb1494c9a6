"""CDR as ROS 2 middlewares write it: XCDR version 1, little-endian, plain (no parameter list).

OMG DDS-XTypes 1.3, clause 7.4.1 (XCDR1) and 7.6.2.1.2 (encapsulation: identifier ``00 01``, two
bytes of options whose low two bits a writer may use to say how many bytes pad the packet to a
multiple of four). That ROS 2 gives an empty message one octet is a rule of rosidl.
"""

from __future__ import annotations

from firm_hdl.model import EMPTY_MEMBER
from firm_hdl.wire.rules import WireRules

__all__ = ["CDR"]

CDR = WireRules(
    wire="cdr",
    encapsulation=b"\x00\x01",
    option_bytes=2,
    max_align=8,
    terminated=True,
    empty_member=EMPTY_MEMBER,
    slack_bytes=3,
)
