"""The serializer: one stream per leaf of the message in, packets out."""

from __future__ import annotations

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.control import Control
from firm_hdl.gateware.members import member_tree
from firm_hdl.gateware.packer import Packer
from firm_hdl.gateware.signatures import (
    MessageSignature,
    PacketSignature,
    Status,
    StatusSignature,
    leaf_streams,
)
from firm_hdl.gateware.slots import Slots
from firm_hdl.model import Message
from firm_hdl.plan import (
    DEFAULT_MAX_MESSAGE_BYTES,
    BeginArray,
    CountedBegin,
    Fixed,
    Part,
    Plan,
    Step,
    Take,
    build_plan,
)
from firm_hdl.wire import Wire, lay_out

__all__ = ["Serializer"]


class Serializer(wiring.Component):
    """Turn messages into packets.

    Leaves are taken in wire order, several in one cycle if they are valid. No leaf waits for a
    later one. The serializer adds the lengths on the wire, padding and terminators. Latency from
    the last leaf of a step to its beat: 2 cycles. The `ready` of a leaf depends combinationally on
    `packets.ready` and on the `valid` of the earlier leaves of the same step. One clock domain,
    `sync`; its reset discards all messages and packets inside.

    Each packet ends in one transfer on `status`. A length over its bound is written unchanged, and
    as many items are taken as it says. The packet is marked with an error, so that the receiver can
    drop it. `length` decides how many items are taken; an `items.last` that disagrees marks the
    packet with an error.

    Parameters
    ----------
    message, wire, bus_bytes, max_message_bytes, window_words
        As for :class:`Deserializer`.

    Members
    -------
    message : In(MessageSignature(message, bus_bytes))
    packets : Out(PacketSignature(bus_bytes))
    packet_error : Out(1)
        Set with the last beat of a packet whose status is not `OK`.
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
                "message": In(MessageSignature.of_plan(message, self.plan, self.tree)),
                "packets": Out(PacketSignature(bus_bytes)),
                "packet_error": Out(1),
                "status": Out(StatusSignature),
            }
        )

    def elaborate(self, platform: object) -> Module:
        return _Circuit(self).module


class _Circuit:
    """The serializer's logic, built by one method for each part of it."""

    def __init__(self, component: Serializer):
        self.plan: Plan = component.plan
        self.status = component.status
        self.streams = leaf_streams(component.message, component.tree)

        self.module = m = Module()
        m.submodules.packer = self.packer = Packer(self.plan)
        # A length has 32 bits, and a terminator may add one to it.
        self.control = Control(self.plan, count_bits=33)
        steps = self.plan.steps
        self.slots = Slots(max(len(step.parts) + (step.take is not None) for step in steps))
        self.error = Signal(Status)
        self.raised = Signal(Status)
        self.writable = Signal()
        self.complete = Signal()
        # The step (`leads`), or the word that it made (`led`), consists only of the constant bytes
        # that every packet begins with.
        self.leads = Signal()
        self.led = Signal()
        self.held_count = Signal(self.control.bits)
        lanes = self.packer.geometry.window_bytes
        self.lanes = [Signal(8, name=f"lane_{k}") for k in range(lanes)]
        self.next_lanes = [Signal(8, name=f"next_lane_{k}") for k in range(lanes)]

        m.d.comb += [
            component.packets.payload.eq(self.packer.packets.payload),
            component.packets.valid.eq(self.packer.packets.valid),
            self.packer.packets.ready.eq(component.packets.ready),
            component.packet_error.eq(self.packer.error),
        ]
        with m.If(self.status.ready):
            m.d.sync += self.status.valid.eq(0)
        self._steps()
        self.control.add_run_logic(m)
        self.slots.add_logic(m, self.writable, self.complete)
        self._word()

    # Steps.

    def _steps(self) -> None:
        m = self.module
        for lane, now in zip(self.next_lanes, self.lanes, strict=True):
            m.d.comb += lane.eq(Mux(self.slots.fresh, 0, now))
        with m.Switch(self.control.step):
            for index, step in enumerate(self.plan.steps):
                with m.Case(index):
                    self._step(step)
                    with m.If(self.complete):
                        self.control.add_counters(m, step)

    def _step(self, step: Step) -> None:
        for item in step.slices:
            if isinstance(item, Fixed):
                self.write(item.at, Const(int.from_bytes(item.data, "little"), 8 * item.bytes))
                if not step.parts:
                    self.module.d.comb += self.leads.eq(1)
        if isinstance(step.begin, BeginArray):
            self.module.d.comb += [self.control.count.eq(step.begin.count), self.control.some.eq(1)]
        # The error of the first slot counts: it is assigned last, and so overrides the others.
        slots = len(step.parts)
        if step.take is not None:
            self._run(step.take, slots)
        for slot, part in reversed(list(enumerate(step.parts))):
            self._part(part, slot, step)
        self.control.add_step(self.module, step)

    def write(self, at: int, value: Value) -> None:
        """Put bytes into the word, in a cycle in which the enclosing condition holds."""
        for k in range(len(value) // 8):
            self.module.d.comb += self.next_lanes[at + k].eq(value[8 * k : 8 * (k + 1)])

    def _part(self, part: Part, slot: int, step: Step) -> None:
        m = self.module
        leaf = self.plan.leaves[part.leaf]
        interface = self.streams[part.leaf]
        go = self.slots.go[slot]
        m.d.comb += self.slots.able[slot].eq(interface.valid)
        if part.completes:
            m.d.comb += interface.ready.eq(go)
        if leaf.kind == "length" and part.completes:
            value = self._length(interface.payload, slot, step)
        elif leaf.kind == "length":
            value = self._wire_length(interface.payload, part.leaf)
        elif leaf.kind == "items":
            last: Value = Const(part.last)
            if part.last_level is not None:
                last = self.control.levels[part.last_level] <= 1
            if part.completes:
                with m.If(go & (interface.payload.last != last)):
                    m.d.comb += self.raised.eq(Status.ITEMS)
            value = Cat(_wire_bits(item) for item in interface.payload.data)
        else:
            value = _wire_bits(interface.payload)
        with m.If(go):
            self.write(part.at, value[8 * part.first : 8 * (part.first + part.bytes)])

    def _wire_length(self, length: Value, leaf: int) -> Value:
        """Return a length as on the wire, which counts a terminator."""
        path = self.plan.leaves[leaf].path[:-1]
        terminated = any(
            run.terminated and self.plan.leaves[run.items].path[:-1] == path
            for run in self.plan.runs
        )
        return (length + terminated)[:32]

    def _length(self, length: Value, slot: int, step: Step) -> Value:
        m, begin = self.module, step.begin
        assert isinstance(begin, CountedBegin)
        count = Signal(33)
        m.d.comb += count.eq(length + self.plan.has_nul(begin))
        # The length may be taken from its stream while the step still waits for items.
        m.d.comb += [
            self.control.count.eq(Mux(self.slots.served[slot], self.held_count, count)),
            self.control.some.eq(self.control.count.any()),
        ]
        with m.If(self.slots.go[slot]):
            m.d.sync += self.held_count.eq(count)
            with m.If(length > begin.limit):
                m.d.comb += self.raised.eq(Status.LENGTH)
        return count[:32]

    def _run(self, take: Take, slot: int) -> None:
        m, control = self.module, self.control
        info, at = self.plan.runs[take.run], take.at
        interface = self.streams[info.items]
        size = self.plan.leaves[info.items].item_bytes
        go = self.slots.go[slot] & control.has_items
        m.d.comb += [
            self.slots.able[slot].eq(~control.has_items | interface.valid),
            interface.ready.eq(go),
        ]
        with m.If(go):
            for lane, item in enumerate(interface.payload.data):
                used = control.lane_used[lane]
                self.write(at + lane * size, Mux(used, _wire_bits(item), 0))
            with m.If(interface.payload.last != (control.last_items & info.last)):
                m.d.comb += self.raised.eq(Status.ITEMS)

    # Between steps.

    def _word(self) -> None:
        m, control, packer = self.module, self.control, self.packer
        word = Signal(packer.word.payload.shape())
        error = Signal(Status)
        full = Signal()
        free = ~self.status.valid | self.status.ready
        m.d.comb += [
            packer.word.payload.eq(word),
            Value.cast(packer.word.payload.data).eq(Cat(self.lanes)),
            # A packet begins only when the first leaf of its message is valid.

            packer.word.valid.eq(full & (~self.led | self.streams[0].valid)),
            self.writable.eq(~full | (packer.word.valid & packer.word.ready)),
            self.complete.eq(self.writable & self.slots.all_served & (~control.ends | free)),
            error.eq(Mux(self.error == Status.OK, self.raised, self.error)),
        ]
        with m.If(self.writable):
            m.d.sync += [full.eq(self.complete), self.led.eq(self.leads), self.error.eq(error)]
            m.d.sync += [
                lane.eq(next_lane)
                for lane, next_lane in zip(self.lanes, self.next_lanes, strict=True)
            ]
        with m.If(self.complete):
            m.d.sync += [
                word.count.eq(control.base + control.run_bytes),
                word.align.eq(control.align),
                word.last.eq(control.ends),
                word.error.eq(error != Status.OK),
                control.step.eq(control.next_step),
            ]
            with m.If(control.ends):
                m.d.sync += [
                    self.status.payload.eq(error),
                    self.status.valid.eq(1),
                    self.error.eq(Status.OK),
                ]


def _wire_bits(item: Value) -> Value:
    """Return an item's bits on the wire; a bool takes a whole byte."""
    value = Value.cast(item)
    return Cat(value, Const(0, -len(value) % 8))
