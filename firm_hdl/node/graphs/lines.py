"""No graph: messages as lines of JSON, for scripts, tests, and a look at a board."""

from __future__ import annotations

import json
import threading
from typing import Any, TextIO

from firm_hdl.node.description import Description, Topic
from firm_hdl.node.graphs.graph import Graph, OnMessage

__all__ = ["LinesGraph"]


class LinesGraph(Graph):
    """Lines from standard input go to the board, and what it publishes goes to standard output.

    A line is an object with `topic`, the complete name, and `packet`, the serialized message in
    hexadecimal; of a request and its response also `call`, any value of JSON. A line that is none
    of these is counted as ``malformed``. The end of the input ends the bridge.

    Parameters
    ----------
    description : Description
    source, sink : text files
        In place of standard input and output.
    """

    def __init__(self, description: Description, source: TextIO, sink: TextIO) -> None:
        super().__init__("none")
        self._topics = {
            topic.name: topic for topic in description.topics if topic.kind != "publish"
        }
        self._source, self._sink = source, sink
        self._thread: threading.Thread | None = None

    def open(self, on_message: OnMessage) -> None:
        if self._thread is None:
            self._thread = threading.Thread(target=self._read, args=[on_message], daemon=True)
            self._thread.start()

    @property
    def has_ended(self) -> bool:
        return self._thread is not None and not self._thread.is_alive()

    def _read(self, on_message: OnMessage) -> None:
        for line in self._source:
            try:
                found: Any = json.loads(line)
                topic = self._topics[found["topic"]]
                packet = bytes.fromhex(found["packet"])
                caller = found.get("call")
            except (ValueError, KeyError, TypeError, AttributeError):
                self.counters["malformed"] += bool(line.strip())
                continue
            on_message(topic, packet, caller)

    def publish(self, topic: Topic, packet: bytes) -> bool:
        self._write({"topic": topic.name, "packet": packet.hex()})
        return True

    def respond(self, topic: Topic, caller: object, packet: bytes) -> bool:
        self._write({"topic": topic.name, "packet": packet.hex(), "call": caller})
        return True

    def _write(self, line: dict[str, object]) -> None:
        print(json.dumps(line), file=self._sink, flush=True)

    def close(self) -> None:
        return
