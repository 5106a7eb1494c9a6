"""The wire formats, as data: their differences in a few numbers."""

from __future__ import annotations

from dataclasses import dataclass

from firm_hdl.model import EMPTY_MEMBER, Wire

__all__ = ["CDR", "ROS1", "RULES", "WireRules"]


@dataclass(frozen=True, slots=True, kw_only=True)
class WireRules:
    """Rules of a wire format."""

    wire: Wire
    # Representation identifier at the start of every packet; empty if the format has none. A packet
    # that starts with other bytes is an error.
    encapsulation: bytes
    # Number of bytes after the identifier that a receiver ignores and a sender sets to zero.
    option_bytes: int
    # A primitive of n bytes starts at a multiple of min(n, max_align) bytes, counted from the end
    # of the encapsulation header.
    max_align: int
    terminated: bool  # Whether a string ends in a NUL, which its length on the wire counts.
    # Name of the uint8 that represents a message without fields; `None`: such a message has no
    # bytes.
    empty_member: str | None
    max_trailing_bytes: int  # Largest number of bytes that may follow a message in its packet.

    @property
    def header_bytes(self) -> int:
        """Bytes of the encapsulation header; alignment counts from its end."""
        return len(self.encapsulation) + self.option_bytes


# ROS 1: packed, little-endian. The format is that of genpy and roscpp: a message body without the
# length that TCPROS puts first.
ROS1 = WireRules(
    wire="ros1",
    encapsulation=b"",
    option_bytes=0,
    max_align=1,
    terminated=False,
    empty_member=None,
    max_trailing_bytes=0,
)

# CDR as ROS 2 middlewares write it: XCDR version 1, little-endian, plain (no parameter list). OMG
# DDS-XTypes 1.3: clause 7.4.1 defines XCDR1, and 7.6.2.1.2 the encapsulation. It is the identifier
# ``00 01`` and two bytes of options. The low two bits of the options may hold the number of bytes
# that pad the packet to a multiple of four. The one octet of an empty message is a rule of rosidl.
CDR = WireRules(
    wire="cdr",
    encapsulation=b"\x00\x01",
    option_bytes=2,
    max_align=8,
    terminated=True,
    empty_member=EMPTY_MEMBER,
    max_trailing_bytes=3,
)

RULES: dict[Wire, WireRules] = {rules.wire: rules for rules in (ROS1, CDR)}
"""The rules of each wire format, by its name."""
