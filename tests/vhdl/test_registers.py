# amaranth: UnusedElaboratable=no
"""Registers: the processes that they share, their resets, and assignments that are left out."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from amaranth.hdl import ClockDomain, Module, Print, Signal
from amaranth.lib import wiring
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

from firm_hdl.rtlil.ir import Bits, Wire
from firm_hdl.vhdl.convert import convert
from firm_hdl.vhdl.declare import initial_value


class FilledComponent(wiring.Component):
    """A component whose module is filled by a function."""

    def __init__(self, fill: Callable[[FilledComponent, Module], object], **ports: object) -> None:
        self.fill = fill
        super().__init__(ports)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        self.fill(self, m)
        return m


def vhdl_of(fill: Callable[[FilledComponent, Module], object], **ports: object) -> str:
    return convert(FilledComponent(fill, **ports), name="t").files["t.vhd"]


def processes(text: str) -> list[list[str]]:
    """Return the lines of each process, without its first and last words."""
    parts = text.split(" : process ")[1:]
    bodies = [part.partition("end process;")[0].strip() for part in parts]
    return [[line.strip() for line in body.splitlines()] for body in bodies]


@pytest.mark.parametrize("level", [None, 0, 1])
def test_nothing_happens_without_an_edge_of_the_clock(level: int | None) -> None:
    """VHDL has no process that waits for a constant."""

    def fill(d: FilledComponent, m: Module) -> None:
        m.domains.idle = idle = ClockDomain(async_reset=True)
        # What nothing drives is 0.
        m.d.comb += [idle.rst.eq(d.clear), *([] if level is None else [idle.clk.eq(level)])]
        m.submodules.memory = memory = Memory(shape=4, depth=4, init=[3])
        write, read = memory.write_port(domain="idle"), memory.read_port(domain="idle")
        at_once = memory.read_port(domain="comb")
        m.d.comb += [write.data.eq(d.a), write.en.eq(1), read.en.eq(1), d.p.eq(read.data)]
        m.d.comb += [at_once.addr.eq(d.a), d.r.eq(at_once.data)]
        m.d.idle += [d.q.eq(d.a), Print("an edge")]
        m.d.sync += d.s.eq(d.a)

    outputs = {"q": Out(4, init=5), "p": Out(4), "r": Out(4), "s": Out(4)}
    text = vhdl_of(fill, clear=In(1), a=In(4), **outputs)
    assert [lines[0] for lines in processes(text)] == ["(clk)"]
    assert "process ('" not in text and "report" not in text
    for line in (
        'q <= "0101";',
        "p <= (others => '0');",
        "r <= std_logic_vector(memory(to_integer(unsigned(a(1 downto 0)))));",
        "s <= std_logic_vector(s_q);",
    ):
        assert f"\n  {line}\n" in text, line


def wire_with(**attributes: Bits) -> Wire:
    return Wire(name="q", width=2, signed=False, direction=None, attributes=attributes)


@pytest.mark.parametrize(
    ("wire", "width", "value"),
    [
        (wire_with(init=Bits("1")), 1, "'1'"),
        (wire_with(init=Bits("0")), 1, "'0'"),
        # As in Amaranth's simulator, a register without an initial value starts at 0.
        (wire_with(init=Bits("x")), 1, "'0'"),
        (wire_with(), 1, "'0'"),
        (None, 1, "'0'"),
        (wire_with(init=Bits("10")), 2, '"10"'),
        (wire_with(init=Bits("01")), 2, '"01"'),
        (wire_with(init=Bits("00")), 2, "(others => '0')"),
        (wire_with(), 2, "(others => '0')"),
    ],
)
def test_a_register_starts_at_its_initial_value(wire: Wire | None, width: int, value: str) -> None:
    assert initial_value(wire, width) == value


def test_a_register_that_a_zero_clears_is_no_register_with_that_reset() -> None:
    def fill(d: FilledComponent, m: Module) -> None:
        r = Signal(4, reset_less=True)
        m.d.sync += r.eq(d.a)
        with m.Switch(d.s), m.Case(0):
            m.d.sync += r.eq(0)
        m.d.comb += d.q.eq(r)

    assert "if s = '0'" in vhdl_of(fill, a=In(4), s=In(1), q=Out(4))
