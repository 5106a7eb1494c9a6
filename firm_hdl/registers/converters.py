"""Converters with registers: software on AXI4-Lite reads and writes messages, without a DMA."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Cat, Const, Module, ResetInserter, Signal, Value, unsigned
from amaranth.lib.wiring import In, Out, connect, flipped

from firm_hdl.accelerator.messages import offer_message, take_message
from firm_hdl.gateware import Deserializer, PacketSignature, Serializer, Status
from firm_hdl.gateware.component import Component
from firm_hdl.gateware.interfaces import PacketStream
from firm_hdl.gateware.packets.counters import add_counters, counters_layout
from firm_hdl.plan import Direction, Plan
from firm_hdl.registers.buses import BusKind, add_registers, bus_member
from firm_hdl.registers.message import MessageMap

__all__ = ["RegisterReceiver", "RegisterSender"]


class _Registers(Component):
    """A converter behind the registers of a message.

    * `layout`: made with `plan`, and with the direction of the class.
    * `plan`: the plan of the converter.
    """

    axi: Any
    csr: Any
    interrupt: Value
    packets: PacketStream

    _direction: Direction

    def __init__(self, layout: MessageMap, plan: Plan, bus: BusKind = "axi4lite"):
        if layout.direction != self._direction:
            raise ValueError(f"The registers are those of a {layout.direction}")
        self.layout, self.plan, self.bus = layout, plan, bus
        flow = In if self._direction == "deserializer" else Out
        super().__init__(
            {
                **bus_member(layout.table, bus),
                "packets": flow(PacketSignature(plan.bus_bytes)),
                "interrupt": Out(1),
            }
        )

    def _block(self, m: Module) -> Any:
        """Add the registers; return their block."""
        port = flipped(self.axi if self.bus == "axi4lite" else self.csr)
        return add_registers(m, port, self.layout.table, self.interrupt)

    def _count(self, m: Module, block: Any, status: Any, ends: Value, skips: Value) -> None:
        """Count packets when they end with a status, and what is skipped; keep the status."""
        good = ends & (status.payload == Status.OK)
        bad = ends & (status.payload != Status.OK)
        inside = Module()
        counters = Signal(counters_layout("messages", "errors", "skipped"))
        add_counters(inside, counters, {"messages": good, "errors": bad, "skipped": skips})
        code = Signal(8)
        with inside.If(ends):
            inside.d.sync += code.eq(Value.cast(status.payload))
        with inside.If(block.control_latch):
            # All in one cycle, so that their sums are right.
            inside.d.sync += [
                block.messages.eq(counters.messages),
                block.errors.eq(counters.errors),
                block.skipped.eq(counters.skipped),
            ]
        m.d.comb += [
            block.status_code.eq(code),
            block.sets_interrupt_message.eq(good),
            block.sets_interrupt_error.eq(bad),
        ]
        m.submodules.counts = ResetInserter(block.control_reset)(inside)


class RegisterReceiver(_Registers):
    """Show messages that come as packets in registers.

    A good message that comes becomes the newest one, whether the one before was read or not: the
    packets never wait for software. ``control.commit`` shows the newest one in the words, all of it
    in one cycle, and only then do the words change. Fields without a fixed size are ignored.

    ``control.reset`` ends no packet: the rest of one that is under way still becomes a message.

    Members
    -------
    axi or csr
        As :func:`.bus_member` has it.
    packets : In(PacketSignature(bus_bytes))
    interrupt : Out(1)
        High while an event is set whose interrupt is enabled. A register.
    """

    _direction = "deserializer"

    def elaborate(self, platform: object) -> Module:
        m = Module()
        block = self._block(m)
        m.submodules.rx = rx = Deserializer(self.layout.message, plan=self.plan)
        connect(m, flipped(self.packets), rx.packets)
        record, status = take_message(m, rx.message), rx.status
        # Each packet gives one record and one status.
        ends = record.valid & status.valid
        comes = ends & (status.payload == Status.OK)
        m.d.comb += [record.ready.eq(ends), status.ready.eq(ends)]
        vector = Value.cast(record.payload)
        newest, shown = Signal(len(vector)), Signal(len(vector))
        is_new, has_come, is_shown = Signal(), Signal(), Signal()
        with m.If(block.control_commit):
            m.d.sync += [shown.eq(newest), is_shown.eq(has_come), is_new.eq(0)]
        with m.If(comes):
            m.d.sync += [newest.eq(vector), has_come.eq(1), is_new.eq(1)]
        with m.If(block.control_reset):
            m.d.sync += [
                *(flag.eq(0) for flag in (is_new, has_come, is_shown)),
                newest.eq(0),
                shown.eq(0),
            ]
        m.d.comb += [block.status_new.eq(is_new), block.status_shown.eq(is_shown)]
        for name, (bit, bits) in self.layout.pieces.items():
            m.d.comb += getattr(block, name).eq(shown[bit : bit + bits])
        self._count(m, block, status, ends, comes & is_new & ~block.control_commit)
        return m


class RegisterSender(_Registers):
    """Send messages that software writes to registers.

    ``control.commit`` sends what the words are in one cycle; they may be written anew at once.
    While ``status.busy``, a commit does nothing, and is counted. Fields without a fixed size are
    empty.

    ``control.reset`` ends no packet: a message that is under way is still sent.

    Members
    -------
    axi or csr
        As :func:`.bus_member` has it.
    packets : Out(PacketSignature(bus_bytes))
    interrupt : Out(1)
        High while an event is set whose interrupt is enabled. A register.
    """

    _direction = "serializer"

    def elaborate(self, platform: object) -> Module:
        m = Module()
        block = self._block(m)
        m.submodules.tx = tx = Serializer(self.layout.message, plan=self.plan)
        connect(m, tx.packets, flipped(self.packets))
        record, status = offer_message(m, tx.message), tx.status
        m.d.comb += status.ready.eq(1)
        vector = Value.cast(record.payload)
        offered, busy = Signal(len(vector)), Signal()
        places = {bit: getattr(block, name) for name, (bit, _) in self.layout.pieces.items()}
        # Between them are messages without fields: a trigger, which is 1, or a byte.
        filler = -1 if self.plan.wire == "ros1" else 0
        parts: list[Value] = []
        end = 0
        for bit in [*sorted(places), len(vector)]:
            parts.append(Const(filler, unsigned(bit - end)))
            parts += [places[bit]] if bit in places else []
            end = bit + len(parts[-1])
        with m.If(busy & record.ready):
            m.d.sync += busy.eq(0)
        with m.If(block.control_commit & ~busy):
            m.d.sync += [offered.eq(Cat(parts)), busy.eq(1)]
        m.d.comb += [
            vector.eq(offered),
            record.valid.eq(busy),
            block.status_busy.eq(busy),
        ]
        self._count(m, block, status, status.valid, block.control_commit & busy)
        return m
