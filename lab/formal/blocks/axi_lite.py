"""Claims about registers on AXI4-Lite: the rules of the bus, and what is written and read.

The clauses are those of Arm IHI 0022E. The map has a setting, a status and a constant, and the rest
of its addresses have no register.
"""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Cat, Mux, Signal, Value
from amaranth.lib import stream

from firm_hdl.registers.axi_lite import OKAY, SLVERR, AxiLiteSlave
from firm_hdl.registers.block import RegisterBlock
from firm_hdl.registers.table import Field, Kind, Register, RegisterMap
from lab.formal.bugs import Bug
from lab.formal.catalog import Claim, Study
from lab.formal.scene import Scene
from lab.formal.streams import fires, progress, rules, sink, source

__all__ = ["studies"]

_CONSTANT = 0x1234_5678


def _register(name: str, address: int, kind: Kind, reset: int = 0) -> Register:
    field = Field(name=name, low=0, bits=32, kind=kind, meaning="", reset=reset)
    return Register(name=name, address=address, fields=(field,), meaning="")


_MAP = RegisterMap(
    name="small",
    registers=(
        _register("setting", 0, "setting"),
        _register("state", 4, "status"),
        _register("fixed", 8, "constant", _CONSTANT),
    ),
    meaning="",
)


def _stream(bits: int, name: str) -> Any:
    return stream.Signature(bits).create(path=(name,))


def _pending(scene: Scene, name: str, begins: Value, ends: Value) -> Signal:
    """Count what has begun before this cycle and has not ended."""
    count = Signal(3, name=f"{name}_pending")
    scene.m.d.sync += count.eq(count + begins - ends)
    return count


def _axi_lite(scene: Scene) -> None:
    """Let any master write and read registers."""
    m = scene.m
    bits = _MAP.address_bits
    m.submodules.slave = slave = AxiLiteSlave(bits)
    m.submodules.block = block = RegisterBlock(_MAP)
    axi, bus = slave.axi, slave.bus
    for name in ("writes", "write_word", "write_data", "write_bytes", "reads", "read_word"):
        m.d.comb += getattr(block.bus, name).eq(getattr(bus, name))
    for name in ("read_data", "read_fails"):
        m.d.comb += getattr(bus, name).eq(getattr(block.bus, name))
    m.d.comb += block.state.eq(scene.free(32, "state"))
    aw, w, ar = _stream(bits, "aw"), _stream(36, "w"), _stream(bits, "ar")
    b, r = _stream(2, "b"), _stream(34, "r")
    m.d.comb += [
        axi.awaddr.eq(aw.payload),
        axi.awvalid.eq(aw.valid),
        aw.ready.eq(axi.awready),
        Cat(axi.wdata, axi.wstrb).eq(w.payload),
        axi.wvalid.eq(w.valid),
        w.ready.eq(axi.wready),
        axi.araddr.eq(ar.payload),
        axi.arvalid.eq(ar.valid),
        ar.ready.eq(axi.arready),
        b.payload.eq(axi.bresp),
        b.valid.eq(axi.bvalid),
        axi.bready.eq(b.ready),
        r.payload.eq(Cat(axi.rdata, axi.rresp)),
        r.valid.eq(axi.rvalid),
        axi.rready.eq(r.ready),
    ]
    for port, name in ((aw, "aw"), (w, "w"), (ar, "ar")):
        source(scene, port, name)
    for port, name in ((b, "b"), (r, "r")):
        sink(scene, port, name)
        # A3.2.1: "When asserted, VALID must remain asserted until the handshake occurs."
        rules(scene, port, name)
    # A3.3.1: a response comes after address and data. One for each.
    address = _pending(scene, "aw", fires(aw), fires(b))
    data = _pending(scene, "w", fires(w), fires(b))
    read = _pending(scene, "ar", fires(ar), fires(r))
    scene.claim("one response", ~b.valid | ((address > 0) & (data > 0)))
    scene.claim("one response", ~r.valid | (read > 0))
    progress(scene, "responses come", (address > 0) & (data > 0) & ~b.valid, 1)
    progress(scene, "read responses come", (read > 0) & ~r.valid, 1)
    waits = aw.valid & ~aw.ready & b.ready & (w.valid | (data > b.valid))
    progress(scene, "input moves", waits, 2)
    progress(scene, "reads move", ar.valid & ~ar.ready & r.ready, 1)
    _values(scene, block, bus, (aw, w, ar), (b, r))


def _values(scene: Scene, block: Any, bus: Any, sent: Any, answers: Any) -> None:
    """Claim what is written, what is read, and which reads fail, for any one bit."""
    m = scene.m
    aw, w, ar = sent
    b, r = answers
    bit = scene.rigid(5, "bit")
    to, value, strobe = Signal(aw.payload.shape()), Signal(), Signal()
    with m.If(fires(aw)):
        m.d.sync += to.eq(aw.payload)
    with m.If(fires(w)):
        m.d.sync += [
            value.eq(w.payload.bit_select(bit, 1)),
            strobe.eq(w.payload[32:].bit_select(bit >> 3, 1)),
        ]
    held = Signal()
    with m.If(bus.writes & (to >> 2 == 0) & strobe):
        m.d.sync += held.eq(value)
    scene.claim("values", block.setting.bit_select(bit, 1) == held)
    scene.claim("answers", ~b.valid | (b.payload == OKAY))
    where, expected, good = Signal(ar.payload.shape()), Signal(), Signal()
    with m.If(fires(ar)):
        m.d.sync += where.eq(ar.payload)
    with m.If(bus.reads):
        m.d.sync += [good.eq(where < 12), expected.eq(0)]
        with m.Switch(where >> 2):
            with m.Case(0):
                m.d.sync += expected.eq(held)
            with m.Case(1):
                m.d.sync += expected.eq(block.state.bit_select(bit, 1))
            with m.Case(2):
                m.d.sync += expected.eq(Value.cast(_CONSTANT).bit_select(bit, 1))
    got = r.payload[:32].bit_select(bit, 1)
    right = (got == expected) & (r.payload[32:] == Mux(good, OKAY, SLVERR))
    scene.claim("answers", ~r.valid | right)


_SLAVE = AxiLiteSlave.elaborate
_BLOCK = RegisterBlock.elaborate


def studies() -> list[Study]:
    """Return the study of registers on AXI4-Lite."""
    claims = (
        Claim("valid stays", Bug(_SLAVE, "with m.If(axi.bready):", "with m.If(1):")),
        Claim(
            "payload stays",
            Bug(_SLAVE, "has_read & (~axi.rvalid | axi.rready)", "has_read"),
        ),
        Claim("one response", Bug(_SLAVE, "has_address & has_data & (", "has_address & (")),
        Claim("responses come", Bug(_SLAVE, "axi.bvalid.eq(1)", "axi.bvalid.eq(0)")),
        Claim("read responses come", Bug(_SLAVE, "axi.rvalid.eq(1)", "axi.rvalid.eq(0)")),
        Claim("input moves", Bug(_SLAVE, "axi.awready.eq(~has_address)", "axi.awready.eq(0)")),
        Claim("reads move", Bug(_SLAVE, "axi.arready.eq(~has_read)", "axi.arready.eq(0)")),
        Claim("values", Bug(_BLOCK, "(value & ~mask[bits]) | ones", "ones")),
        Claim("answers", Bug(_SLAVE, "Mux(bus.read_fails, SLVERR, OKAY)", "OKAY")),
    )
    return [Study("axi-lite", "`AxiLiteSlave`, `RegisterBlock` of 3 registers", _axi_lite, claims)]
