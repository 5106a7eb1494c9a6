"""What a bridge passed on and what it lost, and how much the way to the board carries."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

from firm_hdl.node.capacity import bytes_on_link
from firm_hdl.node.description import Description, Topic, Way

__all__ = ["CAUSES", "BridgeCounters", "Load"]

CAUSES = {
    "no board": "messages for the board while it was not there for longer than a moment",
    "queue full": "messages for the board that found no room in the bridge",
    "board full": "messages for the board that waited for room for longer than a moment",
    "too large": "messages for the board that are larger than the memories on their way",
    "board lost": "messages sent before the board was lost, which it may not have passed on",
    "unconfirmed": "messages whose arrival the board had not confirmed when the bridge ended",
    "bridge ended": "messages for the board that still waited when the bridge ended",
    "graph full": "messages that the graph did not take",
    "no graph": "messages for the graph while it was not there",
    "unanswered": "requests that the board did not answer",
    "unknown call": "responses to no request that waits",
    "unknown topic": "messages of topics that the board does not have to send",
}
"""Why a bridge drops a message."""


@dataclass(slots=True)
class BridgeCounters:
    """Messages by the names of their topics."""

    # Messages that were handed over.
    to_board: Counter[str] = field(default_factory=Counter)
    to_graph: Counter[str] = field(default_factory=Counter)
    # Messages that were not, by topic and cause; see `CAUSES`.
    dropped: Counter[tuple[str, str]] = field(default_factory=Counter)

    def drop(self, topic: str, cause: str, count: int = 1) -> None:
        """Count messages that are dropped."""
        assert cause in CAUSES
        if count:
            self.dropped[topic, cause] += count


_SECONDS = 2.0
"""How long is measured. What comes faster for so long waits for longer than the bridge lets it."""

_FULL = 0.95
"""A way that carries so much of what it can has no more room."""


class Load:
    """Measure both directions.

    * `bytes_per_second`: what the way carries; `None` if that is not known, and nothing is
      measured.
    """

    def __init__(self, description: Description, bytes_per_second: float | None) -> None:
        self._description, self._carries = description, bytes_per_second
        self._bytes: dict[Way, Counter[str]] = {"in": Counter(), "out": Counter()}
        self._since: float | None = None
        self._said: set[Way] = set()

    def add(self, direction: Way, topic: Topic, packet: bytes) -> None:
        """Count a message: `in` is the way to the board."""
        self._bytes[direction][topic.name] += bytes_on_link(self._description, len(packet))

    def judge(self, now: float) -> Iterator[str]:
        """Yield a line for each direction in which there is too much, once."""
        if self._carries is None or (self._since is not None and now - self._since < _SECONDS):
            return
        seconds, self._since = now - (self._since or now), now
        for direction, counted in self._bytes.items():
            rate = counted.total() / seconds if seconds else 0.0
            most = ", ".join(name for name, _ in counted.most_common(1))
            counted.clear()
            limit = self._carries * (_FULL if direction == "out" else 1)
            if rate <= limit or direction in self._said:
                continue
            self._said.add(direction)
            amount = f"{rate:,.0f} bytes/s, most of them of {most}"
            if direction == "in":
                yield (
                    f"messages for the board have {amount}, and the link carries "
                    f"{self._carries:,.0f}; what has no room is dropped"
                )
            else:
                yield (
                    f"messages of the board have {amount}, which is all that the link carries; "
                    "what has no room waits on the board, or is dropped there"
                )
