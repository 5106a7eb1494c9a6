"""Packets of genpy: the module for ``ros_python/worker_script.py``, and for mcap's copy of genpy.

This file is also run by the Python that ROS's modules are installed for, so it imports nothing of
firm-hdl. Plain values are described in `firm_hdl.cases.values`; bytes may be text in Latin-1. A
table lists the fields of each message type. Each field has its name, whether it is an array or a
sequence, and the name of its type.

A request to ``open`` has the name of a type, the ``text`` of its definition, and its ``table`` of
fields. Later requests have ``items``: plain values to ``encode``, or packets to ``decode``. Bytes
are always text in Latin-1. An answer has one entry for each item: ``{"item": ...}`` or
``{"refused": "why"}``.
"""

import io
import struct
import sys
from typing import Any

__all__ = ["Objects", "readers", "to_json"]

FLOATS = {"float32": ("<I", "<f"), "float64": ("<Q", "<d")}


class Objects:
    """Writer and reader of the types of one table.

    * `classes`: message classes by name.
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


def readers(folder):
    """Load genpy; return the functions that answer requests, and the names of its modules."""
    import genpy
    import genpy.dynamic

    worker = _Genpy(genpy)
    return {"open": worker.open, "encode": worker.encode, "decode": worker.decode}, ("genpy",)


class _Genpy:
    def __init__(self, genpy):
        self.genpy = genpy
        self.objects = None
        self.name = ""

    def open(self, request):
        before = list(sys.path)
        classes = self.genpy.dynamic.generate_dynamic(request["name"], request["text"])
        # genpy generates a module for each type, and adds its folder to the search path.
        sys.path[:] = before
        self.objects = Objects(self.genpy, classes, request["table"])
        self.name = request["name"]

    def encode(self, request):
        return [self._each(self._encode, value) for value in request["items"]]

    def decode(self, request):
        return [self._each(self._decode, value) for value in request["items"]]

    def _encode(self, value):
        return self.objects.encode(self.name, value).decode("latin-1")

    def _decode(self, packet):
        return to_json(self.objects.decode(self.name, packet.encode("latin-1")))

    def _each(self, work, item):
        try:
            return {"item": work(item)}
        except Exception as error:
            return {"refused": f"{type(error).__name__}: {error}"[:300]}
