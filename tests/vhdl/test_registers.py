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


def test_one_register_with_a_reset() -> None:
    text = vhdl_of(lambda d, m: m.d.sync.__iadd__(d.q.eq(d.a)), a=In(4), q=Out(4, init=5))
    assert "-- 1 register at rising_edge(clk), synchronous reset rst = '1'." in text
    (lines,) = processes(text)
    assert lines == [
        "(clk)",
        "begin",
        "if rising_edge(clk) then",
        "if rst = '1' then",
        'q_q <= "0101";',
        "else",
        "q_q <= unsigned(a);",
        "end if;",
        "end if;",
    ]


def test_registers_without_reset_have_a_process_of_their_own() -> None:
    def fill(d: FilledComponent, m: Module) -> None:
        bare = Signal(4, reset_less=True)
        m.d.sync += [bare.eq(d.a), d.q.eq(bare)]

    text = vhdl_of(fill, a=In(4), q=Out(4))
    assert "-- 1 register at rising_edge(clk), synchronous reset rst = '1'." in text
    assert "-- 1 register at rising_edge(clk), no reset." in text
    found = sorted(processes(text), key=len)
    assert found[0] == [
        "(clk)",
        "begin",
        "if rising_edge(clk) then",
        "bare <= unsigned(a);",
        "end if;",
    ]
    assert found[1][3:6] == ["if rst = '1' then", "q_q <= (others => '0');", "else"]


def test_an_asynchronous_reset_is_tested_first() -> None:
    def fill(d: FilledComponent, m: Module) -> None:
        m.domains.fast = fast = ClockDomain(async_reset=True)
        m.d.comb += [fast.clk.eq(d.ck), fast.rst.eq(d.clear)]
        m.d.fast += d.q.eq(d.a)
        m.d.fast += d.p.eq(~d.a)

    text = vhdl_of(fill, ck=In(1), clear=In(1), a=In(4), q=Out(4, init=3), p=Out(4))
    assert "-- 2 registers at rising_edge(ck), asynchronous reset clear = '1'." in text
    (lines,) = processes(text)
    assert lines[:3] == ["(ck, clear)", "begin", "if clear = '1' then"]
    assert set(lines[3:5]) == {'q_q <= "0011";', "p_q <= (others => '0');"}
    assert lines[5] == "elsif rising_edge(ck) then"
    assert set(lines[6:8]) == {"q_q <= unsigned(a);", "p_q <= not unsigned(a);"}
    assert lines[8:] == ["end if;"]


def test_a_falling_edge_is_another_process() -> None:
    def fill(d: FilledComponent, m: Module) -> None:
        m.domains.down = down = ClockDomain(clk_edge="neg", reset_less=True)
        m.d.comb += down.clk.eq(d.ck)
        m.d.down += d.q.eq(d.a)
        m.d.sync += d.p.eq(d.a)

    text = vhdl_of(fill, ck=In(1), a=In(4), q=Out(4), p=Out(4))
    assert "-- 1 register at falling_edge(ck), no reset." in text
    assert "-- 1 register at rising_edge(clk), synchronous reset rst = '1'." in text
    assert len(processes(text)) == 2


def test_a_register_that_only_holds_its_value_is_assigned_to_itself() -> None:
    def fill(d: FilledComponent, m: Module) -> None:
        m.d.sync += d.q.eq(d.q)

    (lines,) = processes(vhdl_of(fill, q=Out(4, init=9)))
    assert "q_q <= q_q;" in lines


def test_a_conditional_assignment_needs_no_else_branch() -> None:
    def fill(d: FilledComponent, m: Module) -> None:
        with m.If(d.en):
            m.d.sync += d.q.eq(d.a)

    (lines,) = processes(vhdl_of(fill, en=In(1), a=In(4), q=Out(4)))
    assert lines[6:10] == ["if en = '1' then", "q_q <= unsigned(a);", "end if;", "end if;"]
    assert not [line for line in lines if line == "q_q <= q_q;"]


def test_an_assignment_of_rotated_bits_or_another_register_stays() -> None:
    # The first assignment is not of the register to itself.
    def moved(d: FilledComponent, m: Module) -> None:
        m.d.sync += d.q.eq(d.q.rotate_left(4))

    text = " ".join(processes(vhdl_of(moved, q=Out(8, init=1)))[0])
    assert "q_q(3 downto 0)" in text and "q_q(7 downto 4)" in text

    def other(d: FilledComponent, m: Module) -> None:
        m.d.sync += [d.q.eq(d.p), d.p.eq(d.q)]

    (lines,) = processes(vhdl_of(other, q=Out(4, init=1), p=Out(4)))
    assert {"q_q <= p_q;", "p_q <= q_q;"} <= set(lines)


def test_a_clear_to_a_value_other_than_the_initial_one_is_no_reset() -> None:
    # The condition is one bit and the last assignment, but the value is not the initial one.
    def fill(d: FilledComponent, m: Module) -> None:
        m.d.sync += d.q.eq(d.a)
        with m.If(d.clear):
            m.d.sync += d.q.eq(1)

    def with_output(**more: object) -> str:
        def bare(d: FilledComponent, m: Module) -> None:
            m.domains.sync = sync = ClockDomain(reset_less=True)
            m.d.comb += sync.clk.eq(d.ck)
            fill(d, m)

        return vhdl_of(bare, ck=In(1), a=In(4), clear=In(1), **more)

    assert "no reset" in with_output(q=Out(4))
    assert "synchronous reset clear = '1'" in with_output(q=Out(4, init=1))


def test_a_partial_or_dependent_clear_is_no_reset() -> None:
    def text(fill: Callable[[FilledComponent, Module], object], **more: object) -> str:
        def bare(d: FilledComponent, m: Module) -> None:
            m.domains.sync = sync = ClockDomain(reset_less=True)
            m.d.comb += sync.clk.eq(d.ck)
            m.d.sync += d.q.eq(d.a)
            fill(d, m)

        return vhdl_of(bare, ck=In(1), a=In(4), clear=In(2), q=Out(4), **more)

    def part(d: FilledComponent, m: Module) -> None:
        with m.If(d.clear[0]):
            m.d.sync += d.q[:2].eq(0)

    def more(d: FilledComponent, m: Module) -> None:
        with m.If(d.clear[0]):
            m.d.sync += d.q.eq(0)
            m.d.sync += d.q[0].eq(1)

    def otherwise(d: FilledComponent, m: Module) -> None:
        with m.If(d.clear[0]):
            m.d.sync += d.q.eq(0)
        with m.Else():
            m.d.sync += d.q.eq(3)

    def wide(d: FilledComponent, m: Module) -> None:
        with m.Switch(d.clear), m.Case(1):
            m.d.sync += d.q.eq(0)

    def low(d: FilledComponent, m: Module) -> None:
        with m.Switch(d.clear[0]), m.Case(0):
            m.d.sync += d.q.eq(0)

    def from_signal(d: FilledComponent, m: Module) -> None:
        with m.If(d.clear[0]):
            m.d.sync += d.q.eq(d.clear)

    for fill in (part, more, otherwise, wide, low, from_signal):
        assert "no reset" in text(fill), fill.__name__


def test_a_clear_beside_an_asynchronous_reset_is_one_more_condition() -> None:
    def fill(d: FilledComponent, m: Module) -> None:
        m.domains.fast = fast = ClockDomain(async_reset=True)
        m.d.comb += [fast.clk.eq(d.ck), fast.rst.eq(d.rst)]
        m.d.fast += d.q.eq(d.a)
        with m.If(d.clear):
            m.d.fast += d.q.eq(3)

    ports = {"ck": In(1), "rst": In(1), "clear": In(1), "a": In(4), "q": Out(4, init=3)}
    (lines,) = processes(vhdl_of(fill, **ports))
    after = lines[lines.index("elsif rising_edge(ck) then") :]
    assert after[1:5] == [
        "q_q <= unsigned(a);",
        "if clear = '1' then",
        'q_q <= "0011";',
        "end if;",
    ]


def test_an_asynchronous_reset_may_be_an_expression() -> None:
    def fill(d: FilledComponent, m: Module) -> None:
        m.domains.fast = fast = ClockDomain(async_reset=True)
        m.d.comb += [fast.clk.eq(d.ck), fast.rst.eq(d.one & d.other)]
        m.d.fast += d.q.eq(d.a)

    text = vhdl_of(fill, ck=In(1), one=In(1), other=In(1), a=In(4), q=Out(4))
    assert "fast_rst <= one and other;" in text
    (lines,) = processes(text)
    assert lines[0] == "(ck, fast_rst)" and lines[2] == "if fast_rst = '1' then"


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
