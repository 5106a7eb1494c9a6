"""The registers of a node on a bus of its chip."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Cat, Const, Module, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out, flipped

from firm_hdl.gateware.component import Component
from firm_hdl.node.control import counter_path, is_loss, registers
from firm_hdl.node.description import Description
from firm_hdl.node.gateware.clock import SECOND
from firm_hdl.node.gateware.streams import node_counters_layout, time_layout
from firm_hdl.node.register_map import counter_registers, register_map
from firm_hdl.registers.axi_lite import AxiLiteSignature
from firm_hdl.registers.buses import add_registers, bus_member

__all__ = ["CoreSideSignature", "NodeRegisters", "node_register_members"]


def CoreSideSignature() -> wiring.Signature:
    """Return what the registers of a node have to do with its core, seen from the core.

    Members
    -------
    moves : Out(1)
        A message has left its gate or its FIFO, a cycle ago.
    rate : Out(32)
    sets, to, sets_rate, to_rate : In
        As for :class:`.NodeClock`.
    """
    return wiring.Signature(
        {
            "moves": Out(1),
            "rate": Out(32),
            "sets": In(1),
            "to": In(time_layout()),
            "sets_rate": In(1),
            "to_rate": In(32),
        }
    )


def node_register_members(description: Description) -> dict[str, Any]:
    """Return the members of a node that has registers; none for others.

    Members
    -------
    axi or csr
        As :func:`.bus_member` has it.
    interrupt : Out(1)
        High while an event is set whose interrupt is enabled. A register.
    soft_reset : Out(1)
        Software asks for a reset. Whoever makes the reset of `sync` has to let it reset, too.
    """
    if not description.registers:
        return {}
    bus = bus_member(register_map(description), description.registers)
    return {**bus, "interrupt": Out(1), "soft_reset": Out(1)}


class NodeRegisters(Component):
    """Let software on the same chip read and set what a node has.

    ``control.reset`` first lets the transfers end that are under way, and takes no other. Then
    `soft_reset` is high for a cycle, and resets all of the node, these registers included.

    Parameters
    ----------
    description : Description
        With `registers`.

    Members
    -------
    axi or csr, interrupt, soft_reset
        As :func:`node_register_members` has them.
    core : In(CoreSideSignature())
    time : In(time_layout())
    counters : In(node_counters_layout(description))
    """

    axi: Any
    csr: Any
    interrupt: Value
    core: Any
    time: Any
    counters: Any
    soft_reset: Value

    def __init__(self, description: Description):
        assert description.registers
        self.description = description
        self.table = register_map(description)
        super().__init__(
            {
                **node_register_members(description),
                "core": In(CoreSideSignature()),
                "time": In(time_layout()),
                "counters": In(node_counters_layout(description)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        is_axi = self.description.registers == "axi4lite"
        waits, closed = Signal(), Signal()
        port, is_idle = _closable(m, self.axi, closed) if is_axi else (flipped(self.csr), Const(1))
        block = add_registers(m, port, self.table, self.interrupt)
        m.d.comb += closed.eq(block.control_reset | waits | self.soft_reset)
        m.d.sync += [
            waits.eq((block.control_reset | waits) & ~self.soft_reset),
            self.soft_reset.eq(waits & is_idle & ~self.soft_reset),
        ]
        self._latch(m, block)
        self._set_clock(m, block)
        m.d.comb += [
            block.rate.eq(self.core.rate),
            block.sets_interrupt_message.eq(self.core.moves),
            block.sets_interrupt_error.eq(self._loses(m)),
        ]
        return m

    def _latch(self, m: Module, block: Any) -> None:
        """Show clock and counters as they are in one cycle."""
        later = Signal()
        m.d.sync += later.eq(block.control_latch)
        for name, (part, counter) in counter_registers(self.description).items():
            # The upper half of bytes changes a cycle after the lower one.
            with m.If(later if counter == "bytes_high" else block.control_latch):
                m.d.sync += getattr(block, name).eq(self.counters[part][counter])
        with m.If(block.control_latch):
            m.d.sync += [block.time_sec.eq(self.time.sec), block.time_nanosec.eq(self.time.nanosec)]

    def _set_clock(self, m: Module, block: Any) -> None:
        core = self.core
        m.d.comb += [
            core.to.sec.eq(block.new_sec),
            core.to.nanosec.eq(block.new_nanosec),
            core.to_rate.eq(block.new_rate),
            core.sets_rate.eq(block.control_set_rate),
            core.sets.eq(block.control_set_time & (block.new_nanosec < SECOND)),
        ]

    def _loses(self, m: Module) -> Value:
        """Return whether a counter of losses has just changed."""
        changing: list[Value] = []
        for each in registers(self.description):
            if is_loss(each):
                part, name = counter_path(self.description, each)
                # All count one at a time, but for messages that a gap of 16 bits skips.
                bits = 16 if each.part == "link" and name == "lost" else 1
                changing.append(self.counters[part][name][:bits])
        now, before = Cat(changing), Signal(len(Cat(changing)))
        m.d.sync += before.eq(now)
        return now != before


def _closable(m: Module, outer: Any, closed: Value) -> tuple[Any, Value]:
    """Return a bus behind another one, without new transfers while `closed`; and whether it rests.

    A transfer that has begun goes on. A write that begins with its address alone has to get its
    data; a slave that has just ended a write is between two of them.
    """
    inner = AxiLiteSignature(len(outer.awaddr)).create()
    for (name,), member, value in outer.signature.flatten(outer):
        other = getattr(inner, name)
        source, target = (value, other) if member.flow == In else (other, value)
        begins = name in _BEGINS
        m.d.comb += target.eq(source & ~closed if begins else source)
    # A slave is ready unless it has taken a read.
    return inner, ~inner.bvalid & ~inner.rvalid & inner.arready


_BEGINS = ("awvalid", "awready", "wvalid", "wready", "arvalid", "arready")
"""What a transfer begins with."""
