"""What the link and the memories of a node carry, and what its topics may need beyond that."""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.metrics import metrics_of
from firm_hdl.node.bytestream import CRC_BYTES
from firm_hdl.node.description import Description, Store, Way
from firm_hdl.node.frame import HEADER_BYTES
from firm_hdl.node.rtps.templates import Job, templates_of

__all__ = [
    "assembly_bytes",
    "bytes_on_link",
    "largest_bytes",
    "link_bytes_per_second",
    "most_bytes",
    "rate_problems",
    "size_problems",
]

_WAYS: dict[Way, str] = {"in": "to the node", "out": "from the node"}
_MOST_NAMED = 8
_GIGABIT_BYTES_PER_SECOND = 125e6
_MII_BYTES_PER_SECOND = 12.5e6
_MOST_FRAGMENTS = 1 << 16
# Bytes of an RTPS datagram of a peer besides the payload, at most.
_RTPS_RECEIVED = 256
# What a datagram has besides a sample, at most. With 1,472 bytes, peers cut samples of more than
# 1,280 bytes: first those of firm-hdl, then Cyclone DDS, at 1,344.
_RTPS_HEADS = 192


def largest_bytes(description: Description, store: Store) -> int:
    """Return the size of the largest message that a topic has in a direction."""
    most = metrics_of(store.message, description.wire).max_bytes
    sizes = (store.memory_bytes, store.max_message_bytes)
    return min(*sizes, most) if most is not None else min(sizes)


def assembly_bytes(datagram_bytes: int, largest: int) -> int:
    """Return the memory in which a topic puts a sample together that comes in fragments.

    It is a power of two, or 0 if the largest message fits into a datagram.
    """
    is_cut = largest > datagram_bytes - _RTPS_HEADS
    return 1 << (largest - 1).bit_length() if is_cut else 0


def most_bytes(description: Description, direction: Way, store: Store) -> int:
    """Return the size of the largest message that has room in all memories on its way."""
    link, most = description.link, store.memory_bytes
    if link.kind == "rtps":
        return min(most, link.memory_bytes - _RTPS_RECEIVED) if direction == "in" else most
    if direction == "in" and link.kind != "stream":
        most = min(most, link.memory_bytes - HEADER_BYTES)
    if link.frame_bytes is not None:
        most = min(most, _MOST_FRAGMENTS * (link.frame_bytes - HEADER_BYTES))
    return most


def bytes_on_link(description: Description, packet_bytes: int) -> int:
    """Return how many bytes a message takes on the link, at least."""
    link = description.link
    if link.kind == "rtps":
        # A reply with a heartbeat, and up to three bytes of padding.
        heads = templates_of(description).every[Job.REPLY].size + 3
        room = max(1, link.datagram_bytes - heads)
        return packet_bytes + heads * max(1, -(-packet_bytes // room))
    if link.kind == "uart":
        # A byte of COBS, and a byte 0 before and after.
        return HEADER_BYTES + packet_bytes + CRC_BYTES + 3
    room = max(1, packet_bytes) if link.frame_bytes is None else link.frame_bytes - HEADER_BYTES
    return packet_bytes + HEADER_BYTES * max(1, -(-packet_bytes // room))


def link_bytes_per_second(description: Description) -> float:
    """Return what the link carries in each direction at most."""
    link = description.link
    if link.kind == "uart":
        # A byte has a start bit and a stop bit.
        return link.baud / 10
    if link.ethernet == "mii":
        return _MII_BYTES_PER_SECOND
    if link.has_ethernet:
        return min(description.clock_hz, _GIGABIT_BYTES_PER_SECOND)
    words = link.kind in ("udp", "rtps")
    return description.clock_hz * (link.data_bytes if words else description.bus_bytes)


def rate_problems(description: Description) -> Iterator[str]:
    """Yield a line for each direction whose stated rates the link cannot carry."""
    link, carries = description.link, link_bytes_per_second(description)
    cycle = f"{carries / description.clock_hz:g} bytes per cycle"
    why = f"{link.baud} baud" if link.kind == "uart" else cycle
    if link.ethernet == "mii":
        why = "100 Mbit/s"
    for direction, way in _WAYS.items():
        least, most, names = 0.0, 0.0, []
        for topic in description.topics:
            if topic.rate_hz is None or not topic.has(direction):
                continue
            store = topic.store(direction)
            sizes = metrics_of(store.message, description.wire)
            shortest = sizes.min_bytes or 0
            longest = min(most_bytes(description, direction, store), sizes.max_bytes or shortest)
            least += topic.rate_hz * bytes_on_link(description, shortest)
            most += topic.rate_hz * bytes_on_link(description, longest)
            names.append(f"{topic.name} at {topic.rate_hz:g} Hz")
        if most > carries:
            needs = f"at least {least:,.0f}" if least > carries else f"up to {most:,.0f}"
            yield (
                f"{_some(names)}: {needs} bytes/s {way}, and the link carries {carries:,.0f} "
                f"({why})"
            )


def size_problems(description: Description) -> Iterator[str]:
    """Yield lines about messages that may be larger than the memories on their way."""
    endless = []
    for topic in description.topics:
        for direction, store in topic.stores:
            room = most_bytes(description, direction, store)
            most = metrics_of(store.message, description.wire).max_bytes
            name = topic.name if topic.kind != "serve" else f"{topic.name} ({direction})"
            if most is None:
                endless.append(f"{name} over {room} bytes")
            elif most > room:
                place = "memory" if room == store.memory_bytes else "link"
                yield (
                    f"{name}: a message has up to {most} bytes, and the {place} has room for "
                    f"{room}; larger ones are dropped"
                )
    if endless:
        yield f"larger messages are dropped, and the types set no limit: {_some(endless)}"


def _some(names: list[str]) -> str:
    more = len(names) - _MOST_NAMED
    return ", ".join(names[:_MOST_NAMED]) + (f" and {more} more" if more > 0 else "")
