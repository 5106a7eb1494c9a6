"""AXI4-Lite (Arm IHI 0022, chapter B1): the slave's side of a bus of registers.

The slave takes one write and one read at a time. It registers all of its outputs, so there is no
combinational path between its ports (A3.1.1 allows none between inputs and outputs).
"""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware.component import Component
from firm_hdl.gateware.limits import check_integer

__all__ = ["OKAY", "SLVERR", "AxiLiteSignature", "AxiLiteSlave", "WordBusSignature"]

OKAY, SLVERR = 0b00, 0b10
"""Responses (A3.4.4)."""


class AxiLiteSignature(wiring.Signature):
    """AXI4-Lite with words of 32 bits, seen from the master.

    AWPROT and ARPROT are left out: a slave may ignore them, and so may the one who connects it.

    Parameters
    ----------
    address_bits : int
        Addresses are in bytes.

    Members
    -------
    awaddr, awvalid : Out
    awready : In(1)
    wdata, wstrb, wvalid : Out
    wready : In(1)
    bresp, bvalid : In
    bready : Out(1)
    araddr, arvalid : Out
    arready : In(1)
    rdata, rresp, rvalid : In
    rready : Out(1)
    """

    def __init__(self, address_bits: int):
        check_integer("Number of address bits", address_bits)
        if not 2 <= address_bits <= 64:
            raise ValueError(f"Number of address bits must be from 2 to 64, not {address_bits}")
        self.address_bits = address_bits
        super().__init__(
            {
                "awaddr": Out(address_bits),
                "awvalid": Out(1),
                "awready": In(1),
                "wdata": Out(32),
                "wstrb": Out(4),
                "wvalid": Out(1),
                "wready": In(1),
                "bresp": In(2),
                "bvalid": In(1),
                "bready": Out(1),
                "araddr": Out(address_bits),
                "arvalid": Out(1),
                "arready": In(1),
                "rdata": In(32),
                "rresp": In(2),
                "rvalid": In(1),
                "rready": Out(1),
            }
        )

    def __eq__(self, other: object) -> bool:
        return type(other) is AxiLiteSignature and self.address_bits == other.address_bits

    def __hash__(self) -> int:
        return hash(self.address_bits)

    def __repr__(self) -> str:
        return f"AxiLiteSignature({self.address_bits})"


def WordBusSignature(address_bits: int) -> wiring.Signature:
    """Return the plain bus behind a slave, seen from it: a word is read or written in one cycle.

    Parameters
    ----------
    address_bits : int
        Of an address in bytes; the bus has addresses of words.

    Members
    -------
    writes : Out(1)
        In this cycle, a word is written. What cannot be written stays.
    write_word, write_data, write_bytes : Out
        Its address, its value, and which of its bytes are written.
    reads : Out(1)
        In this cycle, a word is read.
    read_word : Out
    read_data, read_fails : In
        Follow from `read_word` in the same cycle.
    """
    return wiring.Signature(
        {
            "writes": Out(1),
            "write_word": Out(address_bits - 2),
            "write_data": Out(32),
            "write_bytes": Out(4),
            "reads": Out(1),
            "read_word": Out(address_bits - 2),
            "read_data": In(32),
            "read_fails": In(1),
        }
    )


class AxiLiteSlave(Component):
    """Answer AXI4-Lite from a plain bus of words.

    The two lowest bits of an address are ignored: an access uses the whole width of the bus (B1.1),
    and WSTRB names the bytes that are written. A word that cannot be read is answered with SLVERR.
    A write is always answered with OKAY: on a Cortex-A53, an error of a write comes too late for
    the program that wrote, and stops the whole system. Address and data of a write may come in any
    order. The response is valid 2 cycles after the request, and there is at most one write and one
    read in 2 cycles.

    Parameters
    ----------
    address_bits : int

    Members
    -------
    axi : In(AxiLiteSignature(address_bits))
    bus : Out(WordBusSignature(address_bits))
    """

    axi: Any
    bus: Any

    def __init__(self, address_bits: int):
        signature = AxiLiteSignature(address_bits)
        super().__init__({"axi": In(signature), "bus": Out(WordBusSignature(address_bits))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        axi, bus = self.axi, self.bus
        # High in reset, too: only a slave's BVALID and RVALID have to be low there (A3.1.2).
        has_address, has_data, has_read = Signal(), Signal(), Signal()
        may_write = has_address & has_data & (~axi.bvalid | axi.bready)
        may_read = has_read & (~axi.rvalid | axi.rready)
        m.d.comb += [
            axi.awready.eq(~has_address),
            axi.wready.eq(~has_data),
            axi.arready.eq(~has_read),
            bus.writes.eq(may_write),
            bus.reads.eq(may_read),
            axi.bresp.eq(OKAY),
        ]
        with m.If(axi.awvalid & axi.awready):
            m.d.sync += [bus.write_word.eq(axi.awaddr[2:]), has_address.eq(1)]
        with m.If(axi.wvalid & axi.wready):
            m.d.sync += [
                bus.write_data.eq(axi.wdata),
                bus.write_bytes.eq(axi.wstrb),
                has_data.eq(1),
            ]
        with m.If(axi.arvalid & axi.arready):
            m.d.sync += [bus.read_word.eq(axi.araddr[2:]), has_read.eq(1)]
        with m.If(axi.bready):
            m.d.sync += axi.bvalid.eq(0)
        with m.If(may_write):
            m.d.sync += [has_address.eq(0), has_data.eq(0), axi.bvalid.eq(1)]
        with m.If(axi.rready):
            m.d.sync += axi.rvalid.eq(0)
        with m.If(may_read):
            m.d.sync += [
                has_read.eq(0),
                axi.rvalid.eq(1),
                axi.rresp.eq(Mux(bus.read_fails, SLVERR, OKAY)),
                axi.rdata.eq(Mux(bus.read_fails, 0, bus.read_data)),
            ]
        return m
