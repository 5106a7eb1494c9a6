"""The stream between a node's core and its link, and the structures that both know."""

from __future__ import annotations

from typing import Any

from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import PacketSignature
from firm_hdl.gateware.signatures import packet_layout
from firm_hdl.node.control import IDENTITY, LINK_COUNTERS, counter_path, link_counters, registers
from firm_hdl.node.description import Description, Link
from firm_hdl.node.frame import HEADER

__all__ = [
    "LENGTH_BITS",
    "TAG_BITS",
    "TOPIC_BITS",
    "LinkSignature",
    "RequestSignature",
    "ResponseSignature",
    "header_layout",
    "link_counters_layout",
    "link_layout",
    "link_members",
    "node_counters_layout",
    "passes",
    "time_layout",
]

_BITS = {each.name: 8 * each.bytes for each in HEADER}
TOPIC_BITS, TAG_BITS, LENGTH_BITS = _BITS["topic"], _BITS["tag"], _BITS["length"]


def header_layout() -> data.StructLayout:
    """Return the header of a frame: its bytes, the first one in the lowest bits."""
    return data.StructLayout(_BITS)


def link_layout(bus_bytes: int) -> data.StructLayout:
    """Return the payload of the stream between core and link.

    Members
    -------
    beat : packet_layout(bus_bytes)
        A beat of the message.
    topic : unsigned(16)
    tag : unsigned(32)
    length : unsigned(32)
        Bytes of the message. `topic`, `tag` and `length` are the same in all its beats.
    """
    return data.StructLayout(
        {
            "beat": packet_layout(bus_bytes),
            "topic": TOPIC_BITS,
            "tag": TAG_BITS,
            "length": LENGTH_BITS,
        }
    )


def LinkSignature(bus_bytes: int) -> stream.Signature:
    """Return the stream between core and link. See :func:`link_layout`."""
    return stream.Signature(link_layout(bus_bytes))


def RequestSignature(bus_bytes: int) -> wiring.Signature:
    """Return the requests of a service: `packets`, and `tag`, the same in all beats of a packet."""
    return wiring.Signature({"packets": Out(PacketSignature(bus_bytes)), "tag": Out(TAG_BITS)})


def ResponseSignature(bus_bytes: int) -> wiring.Signature:
    """Return packets to the host: `packets`; `tag` of the request, and `abort`, with the last beat.

    A publication has no use for `tag`.
    """
    return wiring.Signature(
        {"packets": Out(PacketSignature(bus_bytes)), "tag": Out(TAG_BITS), "abort": Out(1)}
    )


def link_counters_layout(link: Link | None = None) -> data.StructLayout:
    """Return the counters of a link, 32 bits each; those that it has no use for stay 0.

    Without `link`, they are those that every link has.
    """
    return data.StructLayout(dict.fromkeys(link_counters(link) if link else LINK_COUNTERS, 32))


def node_counters_layout(description: Description) -> data.StructLayout:
    """Return all counters of a node as a structure, with the members of `counter_path`."""
    tree: dict[str, Any] = {}
    for each in registers(description)[len(IDENTITY) :]:
        owner, name = counter_path(description, each)
        tree.setdefault(owner, {})[name] = 32
    return data.StructLayout({owner: data.StructLayout(names) for owner, names in tree.items()})


def link_members(bus_bytes: int, link: Link | None = None) -> dict[str, Any]:
    """Return the members of a link that face the core."""
    return {
        "received": Out(LinkSignature(bus_bytes)),
        "sent": In(LinkSignature(bus_bytes)),
        "counters": Out(link_counters_layout(link)),
    }


def time_layout() -> data.StructLayout:
    """Return a time as ROS has it: `sec` and `nanosec`, 32 bits each."""
    return data.StructLayout({"sec": 32, "nanosec": 32})


def passes(source: Any, target: Any) -> list[Any]:
    """Return the statements that connect two streams with the same payload."""
    return [
        target.payload.eq(source.payload),
        target.valid.eq(source.valid),
        source.ready.eq(target.ready),
    ]
