"""The status of a packet at a gate."""

from __future__ import annotations

from amaranth.lib import enum

from firm_hdl.gateware.signatures import FixedStreamSignature

__all__ = ["GateStatus", "GateStatusSignature"]


class GateStatus(enum.Enum, shape=4):  # type: ignore[call-arg]
    """What a :class:`PacketGate` did with a packet.

    Codes up to 7 are those of :class:`Status`, and have their meaning. With codes from 8 on, the
    gate dropped a packet that was `OK`, or that was not judged.

    Members
    -------
    OK
        The packet is or was forwarded.
    TRUNCATED, TRAILING, LENGTH, ENCAPSULATION, STRING
        As in :class:`Status`.
    FULL
        There was no room for the packet (`"drop"` only).
    LARGE
        The packet is larger than the memory.
    OVERRUN
        The packet came while the gate was not ready, because short strings, sequences or elements
        take the parser more cycles than beats, or because statuses were not taken (`"drop"` only).
    """

    OK = 0
    TRUNCATED = 1
    TRAILING = 2
    LENGTH = 3
    ENCAPSULATION = 4
    STRING = 5
    FULL = 8
    LARGE = 9
    OVERRUN = 10


GateStatusSignature = FixedStreamSignature(GateStatus)
"""``GateStatusSignature()`` is the stream of a gate's statuses: one transfer per packet."""
