# amaranth: UnusedElaboratable=no
"""Instances, pads, memories, assertions and our own converters in VHDL, read by GHDL."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from amaranth.hdl import (
    Assert,
    Cat,
    ClockDomain,
    Const,
    Cover,
    Elaboratable,
    Format,
    Instance,
    IOBufferInstance,
    IOPort,
    Module,
    Print,
    Signal,
    Value,
)
from amaranth.lib import wiring
from amaranth.lib.memory import Memory

from firm_hdl import Deserializer, Parser, Serializer, load_message
from firm_hdl.vhdl.convert import convert
from tests.depth import by_depth
from tests.vhdl.ghdl import analyse, difference, expected, run, simulate, synthesize, vectors


@pytest.mark.usefixtures("ghdl")
def test_keeps_hierarchy_and_instances(tmp_path: Path) -> None:
    top, inner = Module(), Module()
    a, b, c = Signal(4, name="a"), Signal(4, name="b"), Signal(name="c")
    inner.d.sync += b.eq(a)
    top.submodules.inner = inner
    top.submodules.pll = Instance(
        "PLL_2__x", p_RATIO=3, p_MODE="fast", p_MASK=Const(5, 4), i_A=Cat(a[:2], b[2:]), o_Q=c
    )
    vhdl = convert(top, ports=[a, b, c])
    assert list(vhdl.files) == ["firm_hdl_pkg.vhd", "top_inner.vhd", "top.vhd"]
    assert vhdl.entities["top"].instances == {"inner": "inner", "pll": "pll"}
    text = vhdl.files["top.vhd"]
    assert "inner : entity work.top_inner" in text
    assert "component \\PLL_2__x\\ is" in text and 'MODE  => "fast"' in text
    assert "A(1 downto 0) => a(1 downto 0)" in text
    analyse(vhdl, tmp_path)


@pytest.mark.usefixtures("ghdl")
def test_connects_foreign_components_of_all_directions(tmp_path: Path) -> None:
    top, inner = Module(), Module()
    a, b, c = Signal(4, name="a"), Signal(4, name="b"), Signal(6, name="c")
    x, pad = Signal(4, name="x"), IOPort(4, name="pad")
    inner.submodules.u = Instance("one", i_A=Cat(a, Const(2, 2), b[1]), o_Q=x, io_P=pad[1:3])
    top.submodules.inner = inner
    top.submodules.v = Instance("two", o_Q=c, i_B=x + 1, io_P=pad[0])
    top.d.comb += b.eq(~x)
    vhdl = convert(top, ports=[a, b, c])
    inside, outside = vhdl.files["top_inner.vhd"], vhdl.files["top.vhd"]
    assert "Q : out std_logic_vector(3 downto 0);" in inside and "P : inout" in inside
    assert 'A(5 downto 4) => "10",' in inside and "x <= unsigned(x_i);" in inside
    assert "=> pad(2 downto 1)" in outside and "Q => c," in outside
    analyse(vhdl, tmp_path)


@pytest.mark.usefixtures("ghdl")
def test_memories_without_words_read_as_zero(tmp_path: Path) -> None:
    module, out = Module(), Signal(4, name="out_value")
    module.submodules.memory = memory = Memory(shape=4, depth=0, init=[])
    module.d.comb += out.eq(memory.read_port(domain="comb").data + 1)
    vhdl = convert(module, ports=[out])
    assert simulate(vhdl, [{}], {}, {"out_value": 4}, tmp_path) == [{"out_value": 1}]


class Pads(Elaboratable):
    """A pad of each direction, one level down."""

    def __init__(self) -> None:
        self.pads = [IOPort(3, name="pin_i"), IOPort(3, name="pin_o"), IOPort(3, name="pin_io")]
        self.out, self.enable, self.seen = Signal(3), Signal(), Signal(3)
        self.out.name, self.enable.name, self.seen.name = "out_value", "enable", "seen"

    def elaborate(self, platform: object) -> Module:
        m, inner = Module(), Module()
        m.submodules.inner = inner
        into, back = Signal(3), Signal(3)
        inner.submodules.i = IOBufferInstance(self.pads[0], i=into)
        inner.submodules.o = IOBufferInstance(self.pads[1], o=self.out)
        inner.submodules.io = IOBufferInstance(self.pads[2], i=back, o=self.out, oe=self.enable)
        m.d.comb += self.seen.eq(into ^ back)
        return m


@pytest.mark.usefixtures("ghdl")
def test_drives_and_reads_pads(tmp_path: Path) -> None:
    design = Pads()
    vhdl = convert(design, name="pads", ports=[design.out, design.enable, design.seen])
    analyse(vhdl, tmp_path)
    assert "pin_io    : inout std_logic_vector(2 downto 0)" in vhdl.files["pads.vhd"]
    assert 'else "ZZZ";' in "".join(vhdl.files.values())


@pytest.mark.usefixtures("ghdl")
def test_asserts_and_prints_in_simulation(tmp_path: Path) -> None:
    module = Module()
    value = Signal(8, name="value", init=250)
    module.d.sync += value.eq(value + 1)
    with module.If(value == 254):
        module.d.sync += Print(Format("value {} {:x} {:s} {{}}", value, value, Const(0x4241, 16)))
    module.d.sync += Assert(value != 255, "too far")
    module.d.comb += Cover(value == 3)
    vhdl = convert(module, name="dut", ports=[value])
    analyse(vhdl, tmp_path)
    (tmp_path / "bench.vhd").write_text("""\
library ieee;
use ieee.std_logic_1164.all;
entity bench is end entity;
architecture sim of bench is
  signal clk : std_logic := '0';
begin
  dut : entity work.dut port map (clk => clk, rst => '0', value => open);
  process begin
    for i in 1 to 20 loop wait for 1 ns; clk <= not clk; end loop;
    wait;
  end process;
end architecture;
""")
    run(tmp_path, "-a", "--std=08", "bench.vhd")
    output = run(tmp_path, "--elab-run", "--std=08", "bench", "--ieee-asserts=disable-at-0")
    assert "(report note): value 254 FE AB {}" in output
    assert "(assertion error): too far" in output


def _ports(component: Any) -> tuple[dict[str, Value], dict[str, Value]]:
    inputs, outputs = {}, {}
    for path, member, value in component.signature.flatten(component):
        side = inputs if member.flow == wiring.In else outputs
        side["__".join(map(str, path))] = Value.cast(value)
    return inputs, outputs


@pytest.mark.usefixtures("ghdl")
@pytest.mark.parametrize("bus_bytes", by_depth([8], [1, 8, 64]))
@pytest.mark.parametrize("converter", [Deserializer, Serializer, Parser])
@pytest.mark.parametrize(
    "name",
    by_depth(
        ["std_msgs/msg/Header"],
        ["geometry_msgs/msg/Twist", "sensor_msgs/msg/PointCloud2", "std_msgs/msg/Empty"],
    ),
)
@pytest.mark.sampled(3)
def test_converters_behave_in_ghdl_as_in_amaranth(
    name: str, converter: Any, bus_bytes: int, tmp_path: Path
) -> None:
    message = load_message(name, distro="humble")
    vhdl = convert(converter(message, bus_bytes=bus_bytes), name="dut")
    component = converter(message, bus_bytes=bus_bytes)
    top, domain = Module(), ClockDomain("sync")
    top.domains.sync = domain
    top.submodules.dut = component
    inputs, outputs = _ports(component)
    inputs = {"clk": domain.clk, "rst": domain.rst, **inputs}
    widths = {port: len(value) for port, value in inputs.items()}
    steps = vectors(widths, ["clk"], steps=200, seed=1, rare=0.02)
    want = expected(top, inputs, outputs, steps)
    sizes = {port: len(value) for port, value in outputs.items()}
    assert difference(want, simulate(vhdl, steps, widths, sizes, tmp_path)) is None
    if bus_bytes == 8:
        assert "latch" not in synthesize(vhdl, tmp_path).lower()


def test_only_copies_of_the_top_bit_extend_a_sign() -> None:
    a, b = Signal(4, name="a"), Signal(5, name="b")

    def text(value: Value) -> str:
        m = Module()
        m.d.comb += b.eq(value)
        return convert(m, ports=[a, b]).files["top.vhd"]

    assert "sign_extend(" in text(Cat(a[:3], a[2], a[2]))
    # The upper two bits, of which the lower one is the top bit of the three.
    assert "sign_extend(" not in text(Cat(a[:3], a[2:4]))
