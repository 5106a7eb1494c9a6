"""Signatures of the streams between converters and the world.

The packet side carries serialized messages, the message side one stream per leaf. All are streams
of `amaranth.lib.stream`, whose four rules hold: a transfer happens when `valid` and `ready` are
both high; `valid` does not wait for `ready`; once high, `valid` and the payload stay until the
transfer.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from amaranth.hdl import Shape, signed, unsigned
from amaranth.lib import data, enum, stream, wiring
from amaranth.lib.wiring import Out

from firm_hdl.gateware.members import MemberTree, member_tree
from firm_hdl.model import Message
from firm_hdl.plan import Leaf, Plan, build_plan, check_bus_bytes
from firm_hdl.wire import Wire, lay_out

__all__ = [
    "LATENCY_CYCLES",
    "MessageSignature",
    "PacketSignature",
    "Status",
    "StatusSignature",
    "leaf_shape",
    "leaf_streams",
    "packet_layout",
    "signature_of",
]

LATENCY_CYCLES = 2
"""From what comes in to what goes out: from the beat that completes a leaf to the leaf, and from
the leaf that fills a beat, or ends a packet, to the beat. ``tests/gateware/test_latency.py``
measures it."""


class Status(enum.Enum, shape=3):  # type: ignore[call-arg]
    """How a packet ended. The first error of a packet counts.

    Members
    -------
    OK
        Without an error.
    TRUNCATED
        The packet ended before the message (deserializer).
    TRAILING
        The message ended before the packet, by more than the wire allows (deserializer).
    LENGTH
        A length over its declared bound, or over what `max_message_bytes` leaves room for.
    ENCAPSULATION
        A representation that the converter was not built for (deserializer).
    STRING
        A string without its terminator (deserializer).
    ITEMS
        `items.last` not where `length` says (serializer).
    """

    OK = 0
    TRUNCATED = 1
    TRAILING = 2
    LENGTH = 3
    ENCAPSULATION = 4
    STRING = 5
    ITEMS = 6


StatusSignature = stream.Signature(Status)
"""One transfer per packet."""


def packet_layout(bus_bytes: int) -> data.StructLayout:
    """Return the payload of a packet stream.

    Members
    -------
    data : ArrayLayout(8, bus_bytes)
        Bytes, the first one on the wire in lane 0.
    count : range(bus_bytes + 1)
        Valid lanes. `bus_bytes` in every beat but the last of a packet; 0 only in the one beat of
        an empty packet.
    last : unsigned(1)
        Set in the last beat of a packet.

    Raises
    ------
    TypeError, ValueError
        If no converter has a bus of that width.
    """
    check_bus_bytes(bus_bytes)
    return data.StructLayout(
        {"data": data.ArrayLayout(8, bus_bytes), "count": range(bus_bytes + 1), "last": 1}
    )


def PacketSignature(bus_bytes: int) -> stream.Signature:
    """Return the stream of packets, `bus_bytes` bytes a beat. See :func:`packet_layout`."""
    # A function, as Amaranth's stream signature is final.
    return stream.Signature(packet_layout(bus_bytes))


def leaf_shape(leaf: Leaf) -> Shape | data.StructLayout:
    """Return the payload's shape of a leaf's stream.

    An integer has its own shape, a `bool` is one bit, a float is its bits, unsigned. `items` is a
    structure of `data`, an array of `lanes` items with the first one in lane 0 and lanes past the
    end 0, and `last`.
    """
    primitive = leaf.primitive
    bits = 1 if primitive.kind == "bool" else 8 * primitive.bytes
    shape = signed(bits) if leaf.signed else unsigned(bits)
    if leaf.kind == "items":
        return data.StructLayout({"data": data.ArrayLayout(shape, leaf.lanes), "last": 1})
    return shape


class MessageSignature(wiring.Signature):
    """A message as one stream per leaf, seen from where it comes from.

    Two signatures are equal if their message, bus width and wire format are.

    Parameters
    ----------
    message : Message
    bus_bytes : int
        Width of the packets on the other side of the converter; it decides the lanes of `items`.
    wire : "ros1", "cdr" or None
        Decides what an empty message is; `None`: the wire of the message's own dialect.

    Attributes
    ----------
    message : Message
    bus_bytes : int
    wire : "ros1" or "cdr"
    """

    def __init__(self, message: Message, bus_bytes: int = 8, wire: Wire | None = None):
        longest = (1 << 32) - 1
        plan = build_plan(lay_out(message, wire), bus_bytes=bus_bytes, max_message_bytes=longest)
        self._init(message, plan, member_tree(leaf.path for leaf in plan.leaves))

    @classmethod
    def of_plan(cls, message: Message, plan: Plan, tree: MemberTree) -> MessageSignature:
        """Make the signature of a message whose plan and names of members are known."""
        signature = cls.__new__(cls)
        signature._init(message, plan, tree)
        return signature

    def _init(self, message: Message, plan: Plan, tree: MemberTree) -> None:
        self.message, self.bus_bytes, self.wire = message, plan.bus_bytes, plan.wire
        super().__init__(_members(plan.leaves, tree))

    def __eq__(self, other: object) -> bool:
        # To `isinstance`, a flipped signature is of the class that it flips.
        return type(other) is MessageSignature and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    @property
    def _key(self) -> tuple[Message, int, str]:
        return self.message, self.bus_bytes, self.wire

    def __repr__(self) -> str:
        return f"MessageSignature({self.message}, bus_bytes={self.bus_bytes}, wire={self.wire!r})"


def signature_of(leaves: Sequence[Leaf], tree: MemberTree) -> wiring.Signature:
    """Return the signature with the leaves that are in a tree."""
    return wiring.Signature(_members(leaves, tree))


def _members(leaves: Sequence[Leaf], node: MemberTree) -> dict[str, wiring.Member]:
    return {
        child.member: Out(
            wiring.Signature(_members(leaves, child))
            if child.leaf is None
            else stream.Signature(leaf_shape(leaves[child.leaf]))
        )
        for child in node.children.values()
    }


def leaf_streams(interface: Any, tree: MemberTree) -> dict[int, stream.Interface]:
    """Return the streams of a message interface by the index of their leaf, in wire order."""
    streams = {}
    for leaf, path in tree.leaves():
        port = interface
        for name in path:
            port = getattr(port, name)
        streams[leaf] = port
    return dict(sorted(streams.items()))
