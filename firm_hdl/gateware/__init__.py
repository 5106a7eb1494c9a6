"""Converters as Amaranth components."""

from firm_hdl.gateware.axi_stream import (
    AxiStreamSignature,
    AxiStreamToPackets,
    PacketsToAxiStream,
)
from firm_hdl.gateware.deserializer import Deserializer
from firm_hdl.gateware.interfaces import (
    MessageInterface,
    PacketBeat,
    PacketStream,
    StatusStream,
    Stream,
)
from firm_hdl.gateware.message_buffer import MessageBuffer
from firm_hdl.gateware.packets import (
    GateStatus,
    GateStatusSignature,
    PacketArbiter,
    PacketCrossing,
    PacketFifo,
    PacketGate,
    PacketRouter,
    PacketWidth,
)
from firm_hdl.gateware.parser import Parser
from firm_hdl.gateware.record import RecordReader, RecordWriter
from firm_hdl.gateware.record_layout import record_layout
from firm_hdl.gateware.serializer import Serializer
from firm_hdl.gateware.signatures import MessageSignature, PacketSignature, Status, StatusSignature

__all__ = [
    "AxiStreamSignature",
    "AxiStreamToPackets",
    "Deserializer",
    "GateStatus",
    "GateStatusSignature",
    "MessageBuffer",
    "MessageInterface",
    "MessageSignature",
    "PacketArbiter",
    "PacketBeat",
    "PacketCrossing",
    "PacketFifo",
    "PacketGate",
    "PacketRouter",
    "PacketSignature",
    "PacketStream",
    "PacketWidth",
    "PacketsToAxiStream",
    "Parser",
    "RecordReader",
    "RecordWriter",
    "Serializer",
    "Status",
    "StatusSignature",
    "StatusStream",
    "Stream",
    "record_layout",
]
