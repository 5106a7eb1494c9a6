"""The messages that come out of a node, and go into it.

A node without accelerator has its message ports outside.
"""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.export.message_ports import FoundMessage
from firm_hdl.node.description import Description
from firm_hdl.plan import Direction

__all__ = ["found_messages"]


def found_messages(description: Description) -> Iterator[FoundMessage]:
    """Yield the messages at the top level of a node without accelerator."""
    for topic in description.topics:
        for way, store in topic.stores:
            direction: Direction = "deserializer" if way == "in" else "serializer"
            yield FoundMessage(topic.path(way), direction, store.message, description.plan(store))
