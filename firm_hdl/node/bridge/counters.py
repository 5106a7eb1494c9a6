"""What a bridge passed on and what it lost, and how people read this."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

from firm_hdl.node.description import Description

__all__ = ["CAUSES", "BridgeCounters", "summary_lines"]

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
    """Messages by the names of their topics.

    Attributes
    ----------
    to_board, to_graph : Counter of str
        Messages that were handed over.
    dropped : Counter of pairs of str
        Messages that were not, by topic and cause; see `CAUSES`.
    """

    to_board: Counter[str] = field(default_factory=Counter)
    to_graph: Counter[str] = field(default_factory=Counter)
    dropped: Counter[tuple[str, str]] = field(default_factory=Counter)

    def drop(self, topic: str, cause: str, count: int = 1) -> None:
        """Count messages that are dropped."""
        assert cause in CAUSES
        if count:
            self.dropped[topic, cause] += count


def summary_lines(description: Description, counters: BridgeCounters) -> Iterator[str]:
    """Yield a table of what passed, a line per topic, and lines of what was dropped."""
    rows = [
        [topic.name, topic.kind, counters.to_board[topic.name], counters.to_graph[topic.name]]
        for topic in description.topics
    ]
    head: list[object] = ["topic", "", "to board", "to graph"]
    table = [[str(cell) for cell in row] for row in (head, *rows)]
    widths = [max(len(row[column]) for row in table) for column in range(len(head))]
    for row in table:
        cells = [row[0].ljust(widths[0]), row[1].ljust(widths[1])]
        cells += [row[n].rjust(widths[n]) for n in (2, 3)]
        yield "  ".join(cells)
    for (name, cause), count in sorted(counters.dropped.items()):
        yield f"dropped: {count} of {name}: {cause}"
