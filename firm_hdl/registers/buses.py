"""A block of registers behind a bus: AXI4-Lite, or the CSR bus of amaranth-soc."""

from __future__ import annotations

from typing import Any, Literal, TypeAlias

from amaranth.hdl import Cat, Module, Mux, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out, connect

from firm_hdl.gateware.component import Component
from firm_hdl.registers.axi_lite import AxiLiteSignature, AxiLiteSlave, WordBusSignature
from firm_hdl.registers.block import RegisterBlock
from firm_hdl.registers.table import RegisterMap

__all__ = ["BUSES", "BusKind", "CsrSignature", "CsrSlave", "add_registers", "bus_member"]

BusKind: TypeAlias = Literal["axi4lite", "csr"]

BUSES: tuple[BusKind, ...] = ("axi4lite", "csr")
"""The buses, as a description of a node has them."""


def CsrSignature(address_bits: int) -> wiring.Signature:
    """Return the bus of amaranth-soc's `csr.Signature` with words of 32 bits, seen from the master.

    Parameters
    ----------
    address_bits : int
        Of an address in bytes; `addr` has addresses of words.

    Members
    -------
    addr : Out(address_bits - 2)
    r_stb : Out(1)
        In this cycle, a word is read.
    r_data : In(32)
        Its value one cycle later, and 0 at all other times: a decoder joins buses by OR.
    w_stb : Out(1)
        In this cycle, a word is written.
    w_data : Out(32)
    """
    return wiring.Signature(
        {
            "addr": Out(address_bits - 2),
            "r_data": In(32),
            "r_stb": Out(1),
            "w_data": Out(32),
            "w_stb": Out(1),
        }
    )


class CsrSlave(Component):
    """Answer a CSR bus from a plain bus of words. A word that cannot be read is 0.

    Parameters
    ----------
    address_bits : int

    Members
    -------
    csr : In(CsrSignature(address_bits))
    bus : Out(WordBusSignature(address_bits))
    """

    csr: Any
    bus: Any

    def __init__(self, address_bits: int):
        signature = CsrSignature(address_bits)
        super().__init__({"csr": In(signature), "bus": Out(WordBusSignature(address_bits))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        csr, bus = self.csr, self.bus
        m.d.comb += [
            bus.writes.eq(csr.w_stb),
            bus.write_word.eq(csr.addr),
            bus.write_data.eq(csr.w_data),
            bus.write_bytes.eq(0b1111),
            bus.reads.eq(csr.r_stb),
            bus.read_word.eq(csr.addr),
        ]
        m.d.sync += csr.r_data.eq(Mux(csr.r_stb & ~bus.read_fails, bus.read_data, 0))
        return m


def bus_member(table: RegisterMap, bus: BusKind) -> dict[str, Any]:
    """Return the member of a component for the bus of its registers.

    Members
    -------
    axi : In(AxiLiteSignature(table.address_bits))
        With `axi4lite`.
    csr : In(CsrSignature(table.address_bits))
        With `csr`.
    """
    if bus not in BUSES:
        raise ValueError(f"Bus must be one of {', '.join(BUSES)}, not {bus!r}")
    signature = {"axi4lite": AxiLiteSignature, "csr": CsrSignature}[bus](table.address_bits)
    return {"axi" if bus == "axi4lite" else "csr": In(signature)}


def add_registers(m: Module, port: Any, table: RegisterMap, interrupt: Value) -> Any:
    """Add registers; return their block.

    * `port`: a bus of :func:`bus_member`, seen from its master.
    * `table`: begins with the registers of :mod:`firm_hdl.registers.head`. What ``control.reset``
      clears besides the block is up to the caller.
    * `interrupt`: a register that is high while an event is set whose interrupt is enabled.
    """
    slave: AxiLiteSlave | CsrSlave
    if hasattr(port, "awvalid"):
        m.submodules.slave = slave = AxiLiteSlave(table.address_bits)
        connect(m, port, slave.axi)
    else:
        m.submodules.slave = slave = CsrSlave(table.address_bits)
        connect(m, port, slave.csr)
    m.submodules.registers = block = RegisterBlock(table)
    connect(m, slave.bus, block.bus)
    events = Cat(block.interrupt_message, block.interrupt_error)
    enabled = Cat(block.interrupt_enable_message, block.interrupt_enable_error)
    m.d.comb += block.clears.eq(block.control_reset)
    m.d.sync += interrupt.eq((events & enabled).any())
    return block
