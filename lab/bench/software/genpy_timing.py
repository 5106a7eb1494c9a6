"""Time genpy, in the Python for which it is installed. So this file imports nothing of firm-hdl.

The request is a file with JSON: ``name``, ``text`` (the type's definition), and ``packets``
as text in Latin-1. The answer has ``deserialize`` and ``serialize`` in ns per message, and
``versions``. Otherwise it has ``missing`` or ``wrong`` with the reason.
"""

from __future__ import annotations

import io
import json
import platform
import sys
from importlib import metadata
from typing import Any

from timing import best_ns  # type: ignore[import-not-found]

__all__ = ["main"]


def main() -> dict[str, Any]:
    """Answer the request; if it has no name, the answer has only the versions."""
    with open(sys.argv[1], encoding="ascii") as file:
        request = json.load(file)
    del sys.path[0]  # Our other modules have names that others may use, too.
    try:
        import genpy.dynamic  # type: ignore[import-not-found]

        version = metadata.version("genpy")
    except ImportError as error:
        return {"missing": str(error)}
    found: dict[str, Any] = {
        "versions": {"genpy": version, "its Python": platform.python_version()}
    }
    if request.get("name"):
        made = genpy.dynamic.generate_dynamic(request["name"], request["text"])
        packets = [packet.encode("latin-1") for packet in request["packets"]]
        found.update(_timed(made[request["name"]], packets))
    return found


def _timed(kind: Any, packets: list[bytes]) -> dict[str, Any]:
    # As in rospy, make an object for each message, and use one buffer for all messages.
    def read(packet: bytes) -> Any:
        message = kind()
        message.deserialize(packet)
        return message

    buffer = io.BytesIO()

    def write(message: Any) -> None:
        buffer.seek(0)
        buffer.truncate()
        message.serialize(buffer)

    messages = [read(packet) for packet in packets]
    for message, packet in zip(messages, packets):  # noqa: B905 - a Python of before 3.10.
        write(message)
        if buffer.getvalue() != packet:
            return {"wrong": "what it writes is not the packet that it has read"}
    return {"deserialize": best_ns(read, packets), "serialize": best_ns(write, messages)}


if __name__ == "__main__":
    print(json.dumps(main()))
