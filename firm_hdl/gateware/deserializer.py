"""The deserializer: packets in, one stream per leaf of the message out."""

from __future__ import annotations

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.deserializer_circuit import DeserializerCircuit
from firm_hdl.gateware.members import member_tree
from firm_hdl.gateware.signatures import (
    MessageSignature,
    PacketSignature,
    StatusSignature,
)
from firm_hdl.model import Message
from firm_hdl.plan import (
    DEFAULT_MAX_MESSAGE_BYTES,
    build_plan,
)
from firm_hdl.wire import Wire, lay_out

__all__ = ["Deserializer"]


class Deserializer(wiring.Component):
    """Turn packets into messages.

    Every leaf has one register. A packet advances one step of the plan per cycle, while its bytes
    are present and the registers of the step's leaves are free or being read. Leaves become valid
    in wire order. Latency from the beat that completes a leaf to its `valid`: 2 cycles.
    `packets.ready` is a function of registers; all other outputs are registers. One clock domain,
    `sync`; its reset discards all packets and messages inside.

    Each packet ends in one transfer on `status`. After the first error in a packet, remaining
    scalars and lengths transfer as 0, the current sequence is completed with zeros, and the rest of
    the packet is dropped. The next packet is decoded normally.

    Parameters
    ----------
    message : Message
    wire : "ros1", "cdr" or None
        `None`: the wire of the message's dialect.
    bus_bytes : int
        Bytes per beat: 1, 2, 4, 8, 16, 32 or 64.
    max_message_bytes : int
        A length that does not fit into a packet of this many bytes is an error.
    window_words : 1 or 2
        Most bus words per step, hence per cycle. 2 saves about one cycle for each string or
        sequence, and makes the circuit larger and slower.

    Members
    -------
    packets : In(PacketSignature(bus_bytes))
    message : Out(MessageSignature(message, bus_bytes))
    status : Out(StatusSignature)

    Attributes
    ----------
    plan : Plan
    tree : MemberTree
        The members of the message, with their leaves.
    """

    def __init__(
        self,
        message: Message,
        *,
        wire: Wire | None = None,
        bus_bytes: int = 8,
        max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES,
        window_words: int = 1,
    ):
        self.plan = build_plan(
            lay_out(message, wire),
            bus_bytes=bus_bytes,
            max_message_bytes=max_message_bytes,
            window_words=window_words,
        )
        self.tree = member_tree(leaf.path for leaf in self.plan.leaves)
        super().__init__(
            {
                "packets": In(PacketSignature(bus_bytes)),
                "message": Out(MessageSignature.of_plan(message, self.plan, self.tree)),
                "status": Out(StatusSignature),
            }
        )

    def elaborate(self, platform: object) -> Module:
        return DeserializerCircuit(self).module
