"""No graph: messages as lines of JSON, for scripts, tests, and a look at a board."""

from __future__ import annotations

import json
import threading
from typing import Any, TextIO

from firm_hdl.node.description import Description, Topic
from firm_hdl.node.graphs.graph import Graph, OnMessage

__all__ = ["LinesGraph"]


class _LineError(Exception):
    """A line is no message; the text is the cause that is counted."""


class LinesGraph(Graph):
    """Lines from standard input go to the board, and what it publishes goes to standard output.

    A line is an object with `topic`, the complete name, and `packet`, the serialized message in
    hexadecimal; of a request and its response also `call`, any value of JSON. Other lines are
    counted by what is wrong with them. The end of the input ends the bridge, also without a board.

    * `source`, `sink`: in place of standard input and output.
    """

    ends = True

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
            if not line.strip():
                continue
            try:
                on_message(*self._parsed(line))
            except _LineError as error:
                self.counters[str(error)] += 1

    def _parsed(self, line: str) -> tuple[Topic, bytes, object]:
        """Return topic, packet and caller of a line."""
        try:
            found: Any = json.loads(line)
        except (ValueError, RecursionError):
            found = None
        if not isinstance(found, dict):
            raise _LineError("a line that is no object of JSON")
        name, packet = found.get("topic"), found.get("packet")
        topic = self._topics.get(name) if isinstance(name, str) else None
        if topic is None:
            raise _LineError("a line without the name of a subscription or a service")
        try:
            text = packet if isinstance(packet, str) else "none"
            return topic, bytes.fromhex(text), found.get("call")
        except ValueError:
            raise _LineError("a line without a packet in hexadecimal") from None

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
