"""The deserializer: packets in, one stream per leaf of the message out."""

from __future__ import annotations

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.component import Component
from firm_hdl.gateware.interfaces import MessageInterface, PacketStream, StatusStream
from firm_hdl.gateware.members import member_tree
from firm_hdl.gateware.mover import Mover
from firm_hdl.gateware.parse import Buffer, OrderQueue, Sequencer
from firm_hdl.gateware.signatures import (
    MessageSignature,
    PacketSignature,
    StatusSignature,
    leaf_streams,
)
from firm_hdl.model import Message
from firm_hdl.plan import (
    DEFAULT_MAX_MESSAGE_BYTES,
    Plan,
    build_plan,
)
from firm_hdl.program import deserializer_program
from firm_hdl.wire import Wire, lay_out

__all__ = ["Deserializer"]


class Deserializer(Component):
    """Turn packets into messages.

    A packet advances one step of the plan per cycle, as soon as the bytes of the step have arrived.
    Each step gives an order to a queue of two, and every leaf has one register. Leaves that are not
    taken hold the packet only when the queue is full. Most leaves cost one cycle more if they are
    still full when their next value comes.

    Leaves become valid in wire order, `LATENCY_CYCLES["deserializer"]` cycles after the last beat
    of their step. All outputs are registers. One clock domain, `sync`; its reset discards all
    packets and messages inside.

    Each packet ends in one transfer on `status`. After the first error in a packet, the remaining
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
    plan : Plan or None
        The plan, if it is made already. Then the parameters other than `message` have no effect.

    Members
    -------
    packets : In(PacketSignature(bus_bytes))
    message : Out(MessageSignature(message, bus_bytes))
    status : Out(StatusSignature())

    Attributes
    ----------
    plan : Plan
    tree : MemberTree
        The members of the message, with their leaves.
    """

    packets: PacketStream
    message: MessageInterface
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
                "packets": In(PacketSignature(self.plan.bus_bytes)),
                "message": Out(MessageSignature(message, plan=self.plan)),
                "status": Out(StatusSignature()),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        plan = self.plan
        program = deserializer_program(plan)
        m.submodules.buffer = buffer = Buffer(plan)
        m.submodules.sequencer = sequencer = Sequencer(program)
        m.submodules.queue = queue = OrderQueue(plan)
        m.submodules.mover = mover = Mover(program, leaf_streams(self.message, self.tree))
        wiring.connect(m, wiring.flipped(self.packets), buffer.packets)
        wiring.connect(m, buffer.arrival, sequencer.arrival)
        wiring.connect(m, sequencer.orders, queue.i)
        wiring.connect(m, queue.o, mover.orders)
        wiring.connect(m, mover.status, wiring.flipped(self.status))
        m.d.comb += [
            mover.beat.eq(buffer.arrival.beat),
            queue.oldest.eq(sequencer.oldest),
            queue.stall_newest.eq(sequencer.stall_newest),
            queue.zero_length.eq(sequencer.zero_length),
            buffer.freed.eq(queue.freed),
        ]
        return m
