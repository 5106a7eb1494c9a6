"""Streams of whole packets: stored, checked, merged, routed, and carried to other buses."""

from firm_hdl.gateware.packets.fifo import PacketFifo
from firm_hdl.gateware.packets.memory import Outcome

__all__ = ["Outcome", "PacketFifo"]
