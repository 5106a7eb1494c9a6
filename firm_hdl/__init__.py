"""firm-hdl: from ROS interface definitions to hardware that reads and writes them.

from firm_hdl import Deserializer, Serializer, load_message

imu = load_message("sensor_msgs/msg/Imu", distro="humble")
rx = Deserializer(imu, bus_bytes=8)
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from firm_hdl.errors import DefinitionError
    from firm_hdl.frontend import Library, load_message
    from firm_hdl.gateware import (
        AxiStreamSignature,
        AxiStreamToPackets,
        Deserializer,
        GateStatus,
        GateStatusSignature,
        MessageBuffer,
        MessageInterface,
        MessageSignature,
        PacketArbiter,
        PacketBeat,
        PacketCrossing,
        PacketFifo,
        PacketGate,
        PacketRouter,
        PacketSignature,
        PacketsToAxiStream,
        PacketStream,
        PacketWidth,
        Parser,
        RecordReader,
        RecordWriter,
        Serializer,
        Status,
        StatusSignature,
        StatusStream,
        Stream,
        record_layout,
    )

__version__ = "0.1.0"

__all__ = [
    "AxiStreamSignature",
    "AxiStreamToPackets",
    "DefinitionError",
    "Deserializer",
    "GateStatus",
    "GateStatusSignature",
    "Library",
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
    "__version__",
    "load_message",
    "record_layout",
]

# Import lazily: Amaranth takes seconds to import, and much of firm-hdl does not need it.
_HOME = {
    "AxiStreamSignature": "gateware",
    "AxiStreamToPackets": "gateware",
    "DefinitionError": "errors",
    "Deserializer": "gateware",
    "GateStatus": "gateware",
    "GateStatusSignature": "gateware",
    "Library": "frontend",
    "MessageBuffer": "gateware",
    "load_message": "frontend",
    "MessageInterface": "gateware",
    "MessageSignature": "gateware",
    "PacketArbiter": "gateware",
    "PacketBeat": "gateware",
    "PacketCrossing": "gateware",
    "PacketFifo": "gateware",
    "PacketGate": "gateware",
    "PacketRouter": "gateware",
    "PacketSignature": "gateware",
    "PacketsToAxiStream": "gateware",
    "PacketStream": "gateware",
    "PacketWidth": "gateware",
    "Parser": "gateware",
    "record_layout": "gateware",
    "RecordReader": "gateware",
    "RecordWriter": "gateware",
    "Serializer": "gateware",
    "Status": "gateware",
    "StatusSignature": "gateware",
    "StatusStream": "gateware",
    "Stream": "gateware",
}


def __getattr__(name: str) -> Any:
    """Import an exported name at its first use."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
