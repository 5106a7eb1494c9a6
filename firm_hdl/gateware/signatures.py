"""Signatures of the streams of converters.

The packet side carries serialized messages, the message side one stream per leaf. All are streams
of `amaranth.lib.stream`, whose rules hold: a transfer happens when `valid` and `ready` are both
high; `valid` does not wait for `ready`; once `valid` is high, it and the payload stay unchanged
until the transfer.

A signature is called, with its parameters or without: ``PacketSignature(8)``,
``MessageSignature(twist)``, ``StatusSignature()``.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any
from weakref import WeakKeyDictionary

from amaranth.hdl import Module, Shape, ShapeLike, signed, unsigned
from amaranth.lib import data, enum, stream, wiring
from amaranth.lib.wiring import Out

from firm_hdl.gateware.members import MemberTree, member_tree
from firm_hdl.model import Message
from firm_hdl.plan import Leaf, Plan, build_plan, check_bus_bytes
from firm_hdl.wire import Wire, lay_out

__all__ = [
    "LATENCY_CYCLES",
    "FixedStreamSignature",
    "MessageSignature",
    "PacketSignature",
    "PartSignature",
    "Status",
    "StatusSignature",
    "bus_bytes_of",
    "leaf_shape",
    "leaf_streams",
    "packet_layout",
    "signature_of",
]

LATENCY_CYCLES = {"deserializer": 5, "serializer": 4}
"""Latency by direction, as in ``docs/reference/streams.md``: from the last beat of a step to
`valid` of the step's leaves, and from a step's last leaf to `valid` of the beat that it fills.
``tests/gateware/test_latency.py`` measures both."""


class Status(enum.Enum, shape=3):  # type: ignore[call-arg]
    """The result of a packet. The first error of a packet, in wire order, counts.

    Members
    -------
    OK
        No error.
    TRUNCATED
        The packet ended before the end of the message (deserializer).
    TRAILING
        More bytes follow the message than the wire format allows (deserializer).
    LENGTH
        A length exceeds its declared bound, or what fits into `max_message_bytes`.
    ENCAPSULATION
        The encapsulation header names a representation that is not supported (deserializer).
    STRING
        A string has no terminator (deserializer).
    ITEMS
        `items.last` is not set in the transfer that `length` implies (serializer).
    """

    OK = 0
    TRUNCATED = 1
    TRAILING = 2
    LENGTH = 3
    ENCAPSULATION = 4
    STRING = 5
    ITEMS = 6


class FixedStreamSignature(wiring.Signature):
    """The signature of a stream that needs no parameters; it is called like all others.

    ``StatusSignature()`` is a signature of Amaranth. ``StatusSignature`` alone can be used in its
    place, as in designs that were written when it could not be called.
    """

    def __init__(self, shape: ShapeLike):
        self._stream = stream.Signature(shape)
        super().__init__(self._stream.members)

    def __call__(self) -> stream.Signature:
        return self._stream

    def create(self, *, path: Any = None, src_loc_at: int = 0) -> Any:
        return self._stream.create(path=path, src_loc_at=1 + src_loc_at)


StatusSignature = FixedStreamSignature(Status)
"""``StatusSignature()`` is the stream of statuses: one transfer per packet."""


def packet_layout(bus_bytes: int) -> data.StructLayout:
    """Return the payload of a packet stream.

    Members
    -------
    data : ArrayLayout(8, bus_bytes)
        Bytes; the first one on the wire is in lane 0.
    count : range(bus_bytes + 1)
        Number of valid lanes: `bus_bytes` in every beat but the last of a packet; 0 only in the
        single beat of an empty packet.
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


def bus_bytes_of(payload: Any) -> int:
    """Return the bytes of a beat, given the payload of a packet stream; 0 for any other payload.

    The number of bytes may be one that no converter has.
    """
    shape = payload.shape()
    if not isinstance(shape, data.StructLayout) or list(shape.members) != ["data", "count", "last"]:
        return 0
    lanes = shape.members["data"]
    if not isinstance(lanes, data.ArrayLayout) or Shape.cast(lanes.elem_shape).width != 8:
        return 0
    counts = Shape.cast(shape.members["count"]).width
    fits = counts == lanes.length.bit_length() and Shape.cast(shape.members["last"]).width == 1
    return lanes.length if fits else 0


def PacketSignature(bus_bytes: int) -> stream.Signature:
    """Return the stream of packets, `bus_bytes` bytes a beat. See :func:`packet_layout`."""
    # A function, because Amaranth's stream signature cannot be subclassed.
    return stream.Signature(packet_layout(bus_bytes))


def leaf_shape(leaf: Leaf) -> Shape | data.StructLayout:
    """Return the payload's shape of a leaf's stream.

    An integer has its own width and sign, a `bool` is one bit, and a float is its bits as an
    unsigned number. `items` is a structure of `data` and `last`. `data` is an array of `lanes`
    items, the first one in lane 0; lanes past the last item are 0.
    """
    bits = leaf.primitive.bits
    shape = signed(bits) if leaf.signed else unsigned(bits)
    if leaf.kind == "items":
        return data.StructLayout({"data": data.ArrayLayout(shape, leaf.lanes), "last": 1})
    return shape


class MessageSignature(wiring.Signature):
    """A message as one stream per leaf, seen from the side that sends it.

    Two signatures are equal if their messages, bus widths and wire formats are equal.

    Parameters
    ----------
    message : Message
    bus_bytes : int
        Bytes per beat of the packets on the other side of the converter. This width decides the
        number of lanes of `items`.
    wire : "ros1", "cdr" or None
        Wire format; it decides the leaf of an empty message. `None`: that of the message's dialect.
    plan : Plan or None
        A plan of the message, if there is one; its bus width and wire format count then.

    Attributes
    ----------
    message : Message
    bus_bytes : int
    wire : Wire
    """

    def __init__(
        self,
        message: Message,
        bus_bytes: int = 8,
        wire: Wire | None = None,
        *,
        plan: Plan | None = None,
    ):
        if plan is None:
            layout, longest = lay_out(message, wire), (1 << 32) - 1
            plan = build_plan(layout, bus_bytes=bus_bytes, max_message_bytes=longest)
        tree = member_tree(leaf.path for leaf in plan.leaves)
        self.message, self.bus_bytes, self.wire = message, plan.bus_bytes, plan.wire
        super().__init__(_members(plan.leaves, tree))

    def create(self, *, path: Any = None, src_loc_at: int = 0) -> Any:
        return _Interface(self, path=path, src_loc_at=1 + src_loc_at)

    def is_compliant(self, obj: Any, *, reasons: Any = None, path: Any = ("obj",)) -> bool:
        is_compliant = super().is_compliant(obj, reasons=reasons, path=path)
        # `connect` has no other hook, and asks each of its arguments here before it compares them.
        caller = sys._getframe(1)
        if is_compliant and caller.f_code is wiring.connect.__code__:
            _check_connection(caller.f_locals["m"], list(caller.f_locals["objects"].values()))
        return bool(is_compliant)

    def __eq__(self, other: object) -> bool:
        # `isinstance` would also accept a flipped signature.
        return type(other) is MessageSignature and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    @property
    def _key(self) -> tuple[Message, int, str]:
        return self.message, self.bus_bytes, self.wire

    def __repr__(self) -> str:
        return f"MessageSignature({self.message}, bus_bytes={self.bus_bytes}, wire={self.wire!r})"


_connected: WeakKeyDictionary[Module, dict[tuple[int, bool], Any]] = WeakKeyDictionary()
"""Message interfaces that a module has connected, by `id` and whether they are flipped."""


def _check_connection(m: Module, objects: list[Any]) -> None:
    """Check that the messages to connect are of one type, and that none is connected twice.

    Without the second check, the last connection would silently count.
    """
    messages = [each for each in objects if isinstance(each.signature, MessageSignature)]
    first = messages[0].signature
    widths = [_widths(each.signature) for each in messages]
    for each, width in zip(messages, widths, strict=True):
        if width != widths[0]:
            raise wiring.ConnectionError(
                f"Cannot connect the messages {_described(first)} and "
                f"{_described(each.signature)}: their leaves differ"
            )
    connected = _connected.setdefault(m, {})
    for each in messages:
        is_flipped = isinstance(each, wiring.FlippedInterface)
        plain = wiring.flipped(each) if is_flipped else each
        if (id(plain), is_flipped) in connected:
            raise wiring.ConnectionError(
                f"The message {_described(each.signature)} is connected twice in one module: "
                "only the last connection would count"
            )
        connected[id(plain), is_flipped] = plain


def _widths(signature: wiring.Signature) -> dict[tuple[str, ...], int]:
    members = signature.members.flatten()
    return {path: Shape.cast(member.shape).width for path, member in members if member.is_port}


def _described(signature: Any) -> str:
    name, bus_bytes, wire = signature.message.name, signature.bus_bytes, signature.wire
    return f"{name} (bus_bytes={bus_bytes}, wire={wire!r})"


class _Interface(wiring.PureInterface):
    """A message, or a part of one, that names its members if another one is asked for."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        message = getattr(self.signature, "message", None)
        what = f"Message {message.name}" if message else "This part of a message"
        raise AttributeError(
            f"{what} has no member {name!r}; it has {', '.join(self.signature.members)}"
        )


class PartSignature(wiring.Signature):
    """A part of a message: a field that is a message, an array, or a text."""

    def create(self, *, path: Any = None, src_loc_at: int = 0) -> Any:
        return _Interface(self, path=path, src_loc_at=1 + src_loc_at)

    def __eq__(self, other: Any) -> bool:
        # As for any signature without a name of its own, the members decide.
        is_plain = type(other) in (PartSignature, wiring.Signature)
        return is_plain and bool(self.members == other.members)

    def __hash__(self) -> int:
        return hash(tuple(self.members))


def signature_of(leaves: Sequence[Leaf], tree: MemberTree) -> wiring.Signature:
    """Return the signature that has exactly the leaves of a tree."""
    return PartSignature(_members(leaves, tree))


def _members(leaves: Sequence[Leaf], node: MemberTree) -> dict[str, wiring.Member]:
    return {
        child.member: Out(
            PartSignature(_members(leaves, child))
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
