"""Streams of whole packets: stored, checked, merged, routed, and carried to other buses."""

from firm_hdl.gateware.packets.fifo import PacketFifo
from firm_hdl.gateware.packets.gate import PacketGate
from firm_hdl.gateware.packets.memory import Outcome
from firm_hdl.gateware.packets.status import GateStatus, GateStatusSignature

__all__ = ["GateStatus", "GateStatusSignature", "Outcome", "PacketFifo", "PacketGate"]
