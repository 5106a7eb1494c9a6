"""Streams of whole packets: stored, checked, merged, routed, and carried to other buses."""

from firm_hdl.gateware.packets.arbiter import PacketArbiter
from firm_hdl.gateware.packets.crossing import PacketCrossing
from firm_hdl.gateware.packets.fifo import PacketFifo
from firm_hdl.gateware.packets.gate import PacketGate
from firm_hdl.gateware.packets.memory import Outcome
from firm_hdl.gateware.packets.router import PacketRouter
from firm_hdl.gateware.packets.status import GateStatus, GateStatusSignature
from firm_hdl.gateware.packets.width import PacketWidth

__all__ = [
    "GateStatus",
    "GateStatusSignature",
    "Outcome",
    "PacketArbiter",
    "PacketCrossing",
    "PacketFifo",
    "PacketGate",
    "PacketRouter",
    "PacketWidth",
]
