"""CDR as ROS 2 middlewares write it: XCDR version 1, little-endian, plain (no parameter list).

OMG DDS-XTypes 1.3 defines the format: clause 7.4.1 defines XCDR1, and 7.6.2.1.2 the encapsulation.
The encapsulation is the identifier ``00 01`` and two bytes of options. The low two bits of the
options may hold the number of bytes that pad the packet to a multiple of four. The one octet of an
empty message is a rule of rosidl.
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
    max_trailing_bytes=3,
)
