"""Conversion between plain values and genpy's objects, for ROS's own genpy and for mcap's.

This file is also run by the Python that ROS's modules are installed for, so it imports nothing of
firm-hdl. Plain values are described in `firm_hdl.cases.values`; bytes may be text in
Latin-1. A table lists the fields of each message type. Each field has its name, whether it is an
array or a sequence, and the name of its type.
"""

import io
import struct
from typing import Any

__all__ = ["Objects", "to_json"]

FLOATS = {"float32": ("<I", "<f"), "float64": ("<Q", "<d")}


class Objects:
    """Writer and reader of the types of one table.

    Parameters
    ----------
    genpy : module
    classes : dict
        Message classes by name.
    table : dict
    """

    def __init__(self, genpy: Any, classes: Any, table: Any) -> None:
        self.times = {"time": genpy.Time, "duration": genpy.Duration}
        self.classes = classes
        self.table = table

    def encode(self, name: str, value: Any) -> bytes:
        """Return the packet of a plain value."""
        buffer = io.BytesIO()
        self.made(name, value).serialize(buffer)
        return buffer.getvalue()

    def decode(self, name: str, packet: bytes) -> Any:
        """Return the plain value of a packet."""
        message = self.classes[name]()
        message.deserialize(packet)
        return self.plain(name, message)

    def made(self, name: str, value: Any) -> Any:
        """Return genpy's object for a plain value of a type."""
        if name in FLOATS:
            bits, number = FLOATS[name]
            return struct.unpack(number, struct.pack(bits, value))[0]
        if name == "string":
            data = value.encode("latin-1") if isinstance(value, str) else value
            return data.decode("utf-8", "surrogateescape")
        if name in self.times:
            found = self.times[name]()
            # Set the attributes, because the constructor would normalize them.
            found.secs, found.nsecs = value["secs"], value["nsecs"]
            return found
        if name not in self.table:
            return value
        message = self.classes[name]()
        for field, is_array, kind in self.table[name]:
            given = value[field]
            made = [self.made(kind, each) for each in given] if is_array else self.made(kind, given)
            setattr(message, _attribute(message, field), made)
        return message

    def plain(self, name: str, value: Any) -> Any:
        """Return the plain value of genpy's object of a type."""
        if name in FLOATS:
            bits, number = FLOATS[name]
            return struct.unpack(bits, struct.pack(number, value))[0]
        if name == "string":
            return value.encode("utf-8", "surrogateescape")
        if name in self.times:
            return {"secs": value.secs, "nsecs": value.nsecs}
        if name not in self.table:
            return bool(value) if name == "bool" else int(value)
        found = {}
        for field, is_array, kind in self.table[name]:
            member = getattr(value, _attribute(value, field))
            found[field] = (
                [self.plain(kind, each) for each in member]
                if is_array
                else self.plain(kind, member)
            )
        return found


def _attribute(message: Any, field: str) -> str:
    """Return genpy's name of a field, with a trailing `_` if Python reserves the ROS name."""
    return field if field in message.__slots__ else field + "_"


def to_json(value: Any) -> Any:
    """Turn a plain value into one that the `json` module can write."""
    if isinstance(value, bytes):
        return value.decode("latin-1")
    if isinstance(value, dict):
        return {name: to_json(each) for name, each in value.items()}
    return [to_json(each) for each in value] if isinstance(value, list) else value
