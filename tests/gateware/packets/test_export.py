"""All parts in all output languages: Verilog, and VHDL that agrees with Amaranth in GHDL."""

from __future__ import annotations

import pytest
from amaranth.hdl import ClockDomain, Module, Value
from amaranth.lib import wiring

from firm_hdl import (
    PacketArbiter,
    PacketCrossing,
    PacketFifo,
    PacketGate,
    PacketRouter,
    PacketWidth,
    load_message,
)
from firm_hdl.vhdl.convert import convert
from tests.tools import need
from tests.vhdl.ghdl import GHDL, difference, expected, simulate, synthesize, vectors

HEADER = load_message("std_msgs/msg/Header")
PARTS = {
    "fifo": lambda: PacketFifo(8, 64, 3),
    "fifo_drop": lambda: PacketFifo(2, 16, 1, when_full="drop"),
    "gate": lambda: PacketGate(HEADER, bus_bytes=4, memory_bytes=64, packets=4),
    "gate_drop": lambda: PacketGate(HEADER, memory_bytes=64, packets=4, when_full="drop"),
    "arbiter": lambda: PacketArbiter(4, 3),
    "arbiter_of_one": lambda: PacketArbiter(1, 1),
    "router": lambda: PacketRouter(4, 3, topic_bits=2),
    "up": lambda: PacketWidth(1, 8),
    "down": lambda: PacketWidth(8, 1),
    "same": lambda: PacketWidth(1, 1),
    "crossing": lambda: PacketCrossing(4, 8),
}
one_clock = [name for name in PARTS if name != "crossing"]


def usual(names, *thorough):
    """Return parameters; parts whose logic others have, too, are left to thorough tests."""
    mark = pytest.mark.thorough
    return [pytest.param(name, marks=[mark] if name in thorough else []) for name in names]


def meaningful_steps(steps):
    """Return steps without payloads that have no meaning, because `valid` is low.

    In Amaranth's simulator, a reset clears the register of a memory's read port, in RTLIL it does
    not. So after a reset, the payload of `status` differs while it has no meaning.
    """
    for step in steps:
        for name in step:
            if name.endswith("__payload") and not step[name.replace("payload", "valid")]:
                step[name] = 0
    return steps


@pytest.mark.parametrize("part", usual(one_clock, "gate_drop", "arbiter_of_one", "same"))
@pytest.mark.sampled(8)
def test_vhdl_in_ghdl_equals_the_part_in_python(part, tmp_path):
    need("ghdl", GHDL)
    vhdl, component = convert(PARTS[part](), name="dut"), PARTS[part]()
    top, domain = Module(), ClockDomain("sync")
    top.domains.sync = domain
    top.submodules.dut = component
    inputs, outputs = {"clk": domain.clk, "rst": domain.rst}, {}
    for path, member, value in component.signature.flatten(component):
        side = inputs if member.flow == wiring.In else outputs
        side["__".join(map(str, path))] = Value.cast(value)
    widths = {port: len(value) for port, value in inputs.items()}
    steps = vectors(widths, ["clk"], steps=400, seed=1, rare=0.02)
    want = expected(top, inputs, outputs, steps)
    sizes = {port: len(value) for port, value in outputs.items()}
    seen = simulate(vhdl, steps, widths, sizes, tmp_path)
    assert difference(meaningful_steps(want), meaningful_steps(seen)) is None
    if part in ("fifo", "gate"):
        assert "latch" not in synthesize(vhdl, tmp_path).lower()
