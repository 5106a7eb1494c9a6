"""PHYs: from their pins to symbols, and into the node's clock domain (IEEE 802.3, clauses 22, 35).

A PHY has a clock of its own for what it receives. Its symbols cross into the node's domain in a
FIFO, where the two clocks may differ by what Ethernet allows (100 ppm each) during a frame.
"""

from __future__ import annotations

from typing import Any, ClassVar

from amaranth.hdl import Cat, ClockDomain, ClockSignal, Const, Instance, Module, Mux, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.fifo import AsyncFIFO
from amaranth.lib.wiring import In, Out

from firm_hdl.ethernet.streams import SymbolSignature

__all__ = [
    "PHYS",
    "GmiiPhy",
    "GmiiSignature",
    "MiiPhy",
    "MiiSignature",
    "RgmiiPhy",
    "RgmiiSignature",
]

_SYMBOLS = 16


def GmiiSignature() -> wiring.Signature:
    """Return the pins of a GMII (clause 35), seen from the MAC."""
    return wiring.Signature(
        {
            "rx_clk": In(1),
            "rxd": In(8),
            "rx_dv": In(1),
            "rx_er": In(1),
            "gtx_clk": Out(1),
            "txd": Out(8),
            "tx_en": Out(1),
            "tx_er": Out(1),
        }
    )


def MiiSignature() -> wiring.Signature:
    """Return the pins of an MII (clause 22), seen from the MAC."""
    return wiring.Signature(
        {
            "rx_clk": In(1),
            "rxd": In(4),
            "rx_dv": In(1),
            "rx_er": In(1),
            "tx_clk": In(1),
            "txd": Out(4),
            "tx_en": Out(1),
            "tx_er": Out(1),
        }
    )


def RgmiiSignature() -> wiring.Signature:
    """Return the pins of an RGMII (version 2.0), seen from the MAC."""
    return wiring.Signature(
        {
            "rxc": In(1),
            "rxd": In(4),
            "rx_ctl": In(1),
            "txc": Out(1),
            "txd": Out(4),
            "tx_ctl": Out(1),
        }
    )


class _SymbolsIn(wiring.Component):
    """Carry symbols from the domain `phy_rx` to `sync`: those of frames, and one after each.

    Members
    -------
    data, enable, error : In(8), In(1), In(1)
        A symbol in `phy_rx`, if `valid`.
    valid : In(1)
    symbols : Out(SymbolSignature())
        In `sync`. May not be held.
    """

    def __init__(self) -> None:
        super().__init__(
            {
                "data": In(8),
                "enable": In(1),
                "error": In(1),
                "valid": In(1),
                "symbols": Out(SymbolSignature()),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.fifo = fifo = AsyncFIFO(
            width=10, depth=_SYMBOLS, w_domain="phy_rx", r_domain="sync"
        )
        before = Signal()
        with m.If(self.valid):
            m.d.phy_rx += before.eq(self.enable)
        m.d.comb += [
            fifo.w_data.eq(Cat(self.data, self.enable, self.error)),
            fifo.w_en.eq(self.valid & (self.enable | before)),
            fifo.r_en.eq(1),
        ]
        # It is a long way from the positions of the FIFO to whether there is a symbol.
        m.d.sync += [
            Value.cast(self.symbols.payload).eq(fifo.r_data),
            self.symbols.valid.eq(fifo.r_rdy),
        ]
        return m


def _add_domain(m: Module, name: str, clock: Any) -> None:
    """Add the domain of a clock of the PHY. It has no reset, because the clock may stand still."""
    domain = ClockDomain(name, local=True, reset_less=True)
    domain.clk = clock
    m.domains += domain


class _Phy(wiring.Component):
    """What all PHYs have: the pins, and symbols in both directions, in `sync`.

    A symbol that comes is on `received` 6 to 7 cycles later. What is sent is on the pins one cycle
    after its transfer, with a GMII or an RGMII.

    Members
    -------
    pins : Out(the signature of the pins)
    received : Out(SymbolSignature())
        May not be held.
    sent : In(SymbolSignature())
    """

    pin_signature: ClassVar[Any]
    received_clock: ClassVar[str] = "rx_clk"
    """The pin with the clock of what is received."""

    def __init__(self) -> None:
        super().__init__(
            {
                "pins": Out(self.pin_signature()),
                "received": Out(SymbolSignature()),
                "sent": In(SymbolSignature()),
            }
        )


class GmiiPhy(_Phy):
    """A GMII: 1 Gbit/s, a byte per cycle. `sync` has 125 MHz, and is the clock of what is sent."""

    pin_signature = staticmethod(GmiiSignature)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pins, sent = self.pins, self.sent
        _add_domain(m, "phy_rx", pins.rx_clk)
        m.submodules.symbols = symbols = _SymbolsIn()
        wiring.connect(m, symbols.symbols, wiring.flipped(self.received))
        m.d.phy_rx += [
            symbols.data.eq(pins.rxd),
            symbols.enable.eq(pins.rx_dv),
            symbols.error.eq(pins.rx_er),
        ]
        m.d.comb += [symbols.valid.eq(1), sent.ready.eq(1), pins.gtx_clk.eq(ClockSignal())]
        m.d.sync += [
            pins.txd.eq(sent.payload.data),
            pins.tx_en.eq(sent.valid & sent.payload.enable),
            pins.tx_er.eq(sent.valid & sent.payload.error),
        ]
        return m


class MiiPhy(_Phy):
    """An MII: 100 or 10 Mbit/s, 4 bits per cycle of the PHY's clocks. `sync` has 25 MHz or more.

    A byte that is cut at the end of a frame is dropped, as clause 4.2.4.2.1 has it.
    """

    pin_signature = staticmethod(MiiSignature)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pins, sent = self.pins, self.sent
        _add_domain(m, "phy_rx", pins.rx_clk)
        _add_domain(m, "phy_tx", pins.tx_clk)
        m.submodules.symbols = symbols = _SymbolsIn()
        wiring.connect(m, symbols.symbols, wiring.flipped(self.received))
        # The preamble may have an odd number of nibbles; its end, 0xD, shows where bytes begin.
        started, upper, error = Signal(), Signal(), Signal()
        lower = Signal(4)
        begins = ~started & (pins.rxd == 0xD)
        m.d.phy_rx += [
            symbols.valid.eq(~pins.rx_dv | (upper | begins | (~started & (pins.rxd != 5)))),
            symbols.data.eq(Cat(Mux(upper, lower, 5), pins.rxd)),
            symbols.enable.eq(pins.rx_dv),
            symbols.error.eq(pins.rx_er | error),
            started.eq(pins.rx_dv & (started | begins)),
            upper.eq(pins.rx_dv & started & ~upper),
            lower.eq(pins.rxd),
            # An error of any nibble is one of the next symbol.
            error.eq(pins.rx_dv & pins.rx_er),
        ]
        m.submodules.fifo = fifo = AsyncFIFO(
            width=9, depth=_SYMBOLS, w_domain="sync", r_domain="phy_tx"
        )
        m.d.comb += [
            fifo.w_data.eq(Cat(sent.payload.data, sent.payload.enable)),
            fifo.w_en.eq(sent.valid),
            sent.ready.eq(fifo.w_rdy),
        ]
        second, rest = Signal(), Signal(4)
        m.d.comb += fifo.r_en.eq(~second)
        m.d.phy_tx += [
            pins.txd.eq(Mux(second, rest, fifo.r_data[:4])),
            pins.tx_en.eq(Mux(second, pins.tx_en, fifo.r_rdy & fifo.r_data[8])),
            second.eq(fifo.r_rdy & ~second),
            rest.eq(fifo.r_data[4:8]),
        ]
        return m


class RgmiiPhy(_Phy):
    """An RGMII: 1 Gbit/s, 4 bits at each edge. `sync` has 125 MHz.

    The cells at the pins are those of Lattice's ECP5. `txc` has the edges of the data, delayed by
    `tx_delay_ns`; what comes is delayed by `rx_delay_ns`. A PHY may delay by itself (RGMII-ID).

    * `rx_delay_ns`, `tx_delay_ns`: 0 to 3; a step is 0.025 ns.
    """

    pin_signature = staticmethod(RgmiiSignature)
    received_clock = "rxc"

    def __init__(self, rx_delay_ns: float = 2.0, tx_delay_ns: float = 2.0) -> None:
        self.rx_delay_ns, self.tx_delay_ns = rx_delay_ns, tx_delay_ns
        super().__init__()

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pins, sent = self.pins, self.sent
        _add_domain(m, "phy_rx", pins.rxc)
        m.submodules.symbols = symbols = _SymbolsIn()
        wiring.connect(m, symbols.symbols, wiring.flipped(self.received))
        # At the rising edge the lower half and RX_DV, at the falling one the upper half and RX_DV
        # xor RX_ER.
        first, second = Signal(5), Signal(5)
        for bit, pin in enumerate(Cat(pins.rxd, pins.rx_ctl)):
            late = _delayed(m, f"rx_delay_{bit}", pin, self.rx_delay_ns)
            m.submodules[f"rx_{bit}"] = Instance(
                "IDDRX1F",
                i_D=late,
                i_SCLK=ClockSignal("phy_rx"),
                i_RST=Const(0),
                o_Q0=first[bit],
                o_Q1=second[bit],
            )
        m.d.comb += symbols.valid.eq(1)
        m.d.phy_rx += [
            symbols.data.eq(Cat(first[:4], second[:4])),
            symbols.enable.eq(first[4]),
            symbols.error.eq(first[4] ^ second[4]),
        ]
        enable, error = sent.valid & sent.payload.enable, sent.valid & sent.payload.error
        rising, falling = Signal(5), Signal(5)
        m.d.comb += sent.ready.eq(1)
        m.d.sync += [
            rising.eq(Cat(sent.payload.data[:4], enable)),
            falling.eq(Cat(sent.payload.data[4:], enable ^ error)),
        ]
        outputs = Cat(pins.txd, pins.tx_ctl)
        for bit, pin in enumerate(outputs):
            out = _double(m, f"tx_{bit}", rising[bit], falling[bit])
            m.d.comb += pin.eq(_delayed(m, f"tx_delay_{bit}", out, 0))
        clock = _double(m, "txc", Const(1, 1), Const(0, 1))
        m.d.comb += pins.txc.eq(_delayed(m, "txc_delay", clock, self.tx_delay_ns))
        return m


def _double(m: Module, name: str, first: Value, second: Value) -> Signal:
    """Add a cell that sends a bit at each edge of `sync`."""
    out = Signal(name=name)
    m.submodules[name] = Instance(
        "ODDRX1F", i_D0=first, i_D1=second, i_SCLK=ClockSignal(), i_RST=Const(0), o_Q=out
    )
    return out


def _delayed(m: Module, name: str, pin: Value, ns: float) -> Signal:
    """Add a cell that delays a pin."""
    out = Signal(name=name)
    m.submodules[name] = Instance(
        "DELAYG",
        p_DEL_MODE="SCLK_ALIGNED",
        p_DEL_VALUE=round(ns / 0.025),
        i_A=pin,
        o_Z=out,
    )
    return out


PHYS: dict[str, type[_Phy]] = {"gmii": GmiiPhy, "rgmii": RgmiiPhy, "mii": MiiPhy}
