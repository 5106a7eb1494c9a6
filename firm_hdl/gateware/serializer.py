"""The serializer: one stream per leaf of the message in, packets out."""

from __future__ import annotations

from amaranth.hdl import Module, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.collector import Collector
from firm_hdl.gateware.component import Component
from firm_hdl.gateware.interfaces import MessageInterface, PacketStream, StatusStream
from firm_hdl.gateware.members import member_tree
from firm_hdl.gateware.packer import Packer
from firm_hdl.gateware.signatures import (
    MessageSignature,
    PacketSignature,
    StatusSignature,
    leaf_streams,
)
from firm_hdl.model import Message
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, Plan, build_plan
from firm_hdl.program import serializer_program
from firm_hdl.wire import Wire, lay_out

__all__ = ["Serializer"]


class Serializer(Component):
    """Turn messages into packets.

    Leaves are taken in wire order, several in one cycle if they are valid. No leaf waits for a
    later one. A length is taken one cycle after it is offered at the earliest. The serializer adds
    the lengths on the wire, padding and terminators. A beat is valid `LATENCY_CYCLES["serializer"]`
    cycles after the last leaf of the step that fills it. The `ready` of a leaf depends
    combinationally on its own `valid` and on that of the earlier leaves of the same step; all other
    outputs are registers. One clock domain, `sync`; its reset discards all messages and packets
    inside.

    Each packet ends in one transfer on `status`. A length over its bound is written unchanged, and
    as many items are taken as it says. The packet is marked with an error, so that the receiver can
    drop it. `length` decides how many items are taken; an `items.last` that disagrees marks the
    packet with an error.

    Parameters
    ----------
    message, wire, bus_bytes, max_message_bytes
        As for :class:`Deserializer`.
    plan : Plan or None
        The plan, if it is made already. Then the parameters other than `message` have no effect.

    Members
    -------
    message : In(MessageSignature(message, bus_bytes))
    packets : Out(PacketSignature(bus_bytes))
    packet_error : Out(1)
        Set with the last beat of a packet whose status is not `OK`.
    status : Out(StatusSignature())

    Attributes
    ----------
    plan : Plan
    tree : MemberTree
        The members of the message, with their leaves.
    """

    message: MessageInterface
    packets: PacketStream
    packet_error: Value
    status: StatusStream

    def __init__(
        self,
        message: Message,
        *,
        wire: Wire | None = None,
        bus_bytes: int = 8,
        max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES,
        plan: Plan | None = None,
    ):
        self.plan = plan or build_plan(
            lay_out(message, wire),
            bus_bytes=bus_bytes,
            max_message_bytes=max_message_bytes,
        )
        self.tree = member_tree(leaf.path for leaf in self.plan.leaves)
        super().__init__(
            {
                "message": In(MessageSignature(message, plan=self.plan)),
                "packets": Out(PacketSignature(self.plan.bus_bytes)),
                "packet_error": Out(1),
                "status": Out(StatusSignature()),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        program = serializer_program(self.plan)
        m.submodules.collector = collector = Collector(
            program, leaf_streams(self.message, self.tree)
        )
        m.submodules.packer = packer = Packer(program)
        wiring.connect(m, collector.words, packer.words)
        wiring.connect(m, packer.packets, wiring.flipped(self.packets))
        wiring.connect(m, collector.status, wiring.flipped(self.status))
        m.d.comb += self.packet_error.eq(packer.error)
        return m
