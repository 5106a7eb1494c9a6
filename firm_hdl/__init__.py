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
        MessageSignature,
        PacketArbiter,
        PacketCrossing,
        PacketFifo,
        PacketGate,
        PacketRouter,
        PacketSignature,
        PacketsToAxiStream,
        PacketWidth,
        Parser,
        RecordReader,
        RecordWriter,
        Serializer,
        Status,
        StatusSignature,
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
    "MessageSignature",
    "PacketArbiter",
    "PacketCrossing",
    "PacketFifo",
    "PacketGate",
    "PacketRouter",
    "PacketSignature",
    "PacketWidth",
    "PacketsToAxiStream",
    "Parser",
    "RecordReader",
    "RecordWriter",
    "Serializer",
    "Status",
    "StatusSignature",
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
    "MessageSignature": "gateware",
    "PacketArbiter": "gateware",
    "PacketCrossing": "gateware",
    "PacketFifo": "gateware",
    "PacketGate": "gateware",
    "PacketRouter": "gateware",
    "PacketSignature": "gateware",
    "PacketWidth": "gateware",
    "PacketsToAxiStream": "gateware",
    "Parser": "gateware",
    "RecordReader": "gateware",
    "RecordWriter": "gateware",
    "Serializer": "gateware",
    "Status": "gateware",
    "StatusSignature": "gateware",
    "load_message": "frontend",
    "record_layout": "gateware",
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
