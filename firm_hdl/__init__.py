"""firm-hdl: from ROS interface definitions to hardware that reads and writes them.

    from firm_hdl import Deserializer, Serializer, load_message

    imu = load_message("sensor_msgs/msg/Imu", distro="humble")
    rx = Deserializer(imu, bus_bytes=8)
"""

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library, load_message
from firm_hdl.gateware import (
    Deserializer,
    MessageSignature,
    PacketSignature,
    RecordReader,
    RecordWriter,
    Serializer,
    Status,
    StatusSignature,
    record_layout,
)

__version__ = "0.1.0"

__all__ = [
    "DefinitionError",
    "Deserializer",
    "Library",
    "MessageSignature",
    "PacketSignature",
    "RecordReader",
    "RecordWriter",
    "Serializer",
    "Status",
    "StatusSignature",
    "__version__",
    "load_message",
    "record_layout",
]
