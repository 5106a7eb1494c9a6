# amaranth: UnusedElaboratable=no
"""The VHDL text of small designs that show one construct each, and its names."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from amaranth.hdl import Cat, Const, Module, Mux, Signal, unsigned
from amaranth.lib import enum, wiring
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

from firm_hdl.vhdl.convert import convert
from tests.vhdl.ghdl import analyse


class State(enum.Enum, shape=unsigned(2)):
    IDLE = 0
    BUSY = 1
    DONE = 2


class Counter(wiring.Component):
    """Count while enabled."""

    def __init__(self) -> None:
        super().__init__({"enable": In(1), "limit": In(4), "count": Out(4), "state": Out(State)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        with m.If(self.enable):
            m.d.sync += self.count.eq(self.count + 1)
            with m.If(self.count == self.limit):
                m.d.sync += [self.count.eq(0), self.state.eq(State.DONE)]
        with m.Switch(self.state):
            with m.Case(State.BUSY, State.IDLE):
                m.d.sync += self.state.eq(State.BUSY)
            with m.Case(State.DONE):
                m.d.sync += self.state.eq(State.IDLE)
        return m


COUNTER = """\
-- Module counter of the Amaranth design.
-- 2 registers at rising_edge(clk), synchronous reset rst = '1'.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity counter is
  port (
    clk    : in  std_logic;
    rst    : in  std_logic;
    enable : in  std_logic;
    limit  : in  std_logic_vector(3 downto 0);
    count  : out std_logic_vector(3 downto 0);
    state  : out std_logic_vector(1 downto 0)  -- 0 IDLE, 1 BUSY, 2 DONE
  );
end entity;

architecture rtl of counter is

  -- Registers.
  signal count_q : unsigned(3 downto 0) := (others => '0');
  signal state_q : unsigned(1 downto 0) := (others => '0');  -- 0 IDLE, 1 BUSY, 2 DONE
begin

  p_clk : process (clk)
  begin
    if rising_edge(clk) then
      if rst = '1' then
        count_q <= (others => '0');
        state_q <= (others => '0');
      else
        if enable = '1' then
          count_q <= count_q + 1;
          if count_q = unsigned(limit) then
            count_q <= (others => '0');
            state_q <= "10";
          end if;
        end if;
        case state_q is
          when "00" | "01" =>  -- IDLE or BUSY
            state_q <= "01";
          when "10" =>  -- DONE
            state_q <= (others => '0');
          when others =>
            null;
        end case;
      end if;
    end if;
  end process;

  count <= std_logic_vector(count_q);
  state <= std_logic_vector(state_q);

end architecture;
"""


def test_reads_like_written_by_hand() -> None:
    assert convert(Counter(), name="counter").files["counter.vhd"] == COUNTER


def test_is_the_same_each_time_and_has_no_paths() -> None:
    first, second = convert(Counter(), name="counter"), convert(Counter(), name="counter")
    assert first == second
    assert "test_vhdl" not in "".join(first.files.values())


def test_gives_a_header_and_unsigned_ports() -> None:
    text = convert(Counter(), name="c", unsigned_ports=True, header="Hello.\n\nYou.").files["c.vhd"]
    assert text.startswith("-- Hello.\n--\n-- You.\n")
    assert "limit  : in  unsigned(3 downto 0);" in text


def test_each_entity_has_the_header_and_only_ports_outside_are_unsigned_by_option() -> None:
    top = Module()
    top.submodules.inner = inner = Counter()
    a = Signal(4, name="a")
    top.d.comb += inner.limit.eq(a)
    for option, kind in ((False, "std_logic_vector"), (True, "unsigned")):
        files = convert(top, ports=[a], unsigned_ports=option, header="Mine.").files
        assert list(files) == ["firm_hdl_pkg.vhd", "top_inner.vhd", "top.vhd"]
        heads = [text.startswith("-- Mine.\n-- Module ") for text in files.values()]
        assert heads == [False, True, True]
        assert re.search(rf"\ba +: in +{kind}\(3 downto 0\)", files["top.vhd"])
        assert re.search(r" : in +unsigned\(3 downto 0\)", files["top_inner.vhd"])


class AssignedInElse(wiring.Component):
    """A register that is assigned in an `else` branch only."""

    def __init__(self) -> None:
        super().__init__({"hold": In(1), "a": In(2), "o": Out(2)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        with m.If(self.hold):
            pass
        with m.Else():
            m.d.sync += self.o.eq(self.a)
        return m


def test_an_empty_if_with_an_else_is_inverted() -> None:
    text = convert(AssignedInElse(), name="unless").files["unless.vhd"]
    assert "if hold = '0' then\n          o_q <= unsigned(a);\n        end if;" in text
    assert "null" not in text


def test_a_switch_on_a_comparison_is_a_conditional_assignment() -> None:
    m = Module()
    a, b, o = (Signal(4, name=name) for name in "abo")
    with m.Switch(a == b):
        with m.Case(0):
            m.d.comb += o.eq(a)
        with m.Case(1):
            m.d.comb += o.eq(~b)
    text = convert(m, name="arms", ports=[a, b, o]).files["arms.vhd"]
    assert "when unsigned(a) /= unsigned(b) else" in text
    assert "signal" not in text


def test_the_first_of_two_equal_choices_counts() -> None:
    m = Module()
    a, o = Signal(2, name="a"), Signal(4, name="o")
    with m.Switch(a):
        for value, choices in enumerate([(0, 1), (1, 2), (2, 3)]):
            with m.Case(*choices):
                m.d.comb += o.eq(5 + value)
    text = convert(m, name="twice", ports=[a, o]).files["twice.vhd"]
    # In VHDL, a repeated choice is an error.
    assert re.findall(r'when (.*) =>\n *o <= "(.*)";', text) == [
        ('"00" | "01"', "0101"),
        ('"10"', "0110"),
        ('"11"', "0111"),
    ]


def test_an_expression_read_only_by_a_port_is_written_in_place() -> None:
    m = Module()
    a, b = (Signal(4, name=name) for name in "ab")
    o = Signal(8)
    m.d.comb += o.eq(Cat(a & b, b))
    text = convert(m, name="place", ports=[a, b, o]).files["place.vhd"]
    assert "unsigned(b) & (unsigned(a) and unsigned(b))" in text
    assert "signal" not in text


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_an_operator_has_all_bits_that_are_read_and_no_more(order: tuple[int, ...]) -> None:
    connections = (r"connect \l $1 [3:0]", r"connect \h $1 [6:5]")
    text = rf"""
attribute \top 1
module \top
  wire width 9 input 0 \a
  wire width 9 input 1 \b
  wire width 4 output 2 \l
  wire width 2 output 3 \h
  wire width 9 $1
  cell $add $2
    parameter \A_SIGNED 0
    parameter \B_SIGNED 0
    parameter \A_WIDTH 9
    parameter \B_WIDTH 9
    parameter \Y_WIDTH 9
    connect \A \a [8:0]
    connect \B \b [8:0]
    connect \Y $1
  end
  {connections[order[0]]}
  {connections[order[1]]}
end
"""
    written = convert(text).files["top.vhd"]
    assert "signal add_1 : unsigned(6 downto 0);" in written
    assert "add_1 <= unsigned(a(6 downto 0)) + unsigned(b(6 downto 0));" in written
    assert "l <= std_logic_vector(add_1(3 downto 0));" in written
    assert "h <= std_logic_vector(add_1(6 downto 5));" in written


def test_a_choice_beside_a_division_stays() -> None:
    """Only the choice that Amaranth adds for divisor 0 is part of the division."""
    m = Module()
    a, b, c = (Signal(4, name=name) for name in "abc")
    plain, chosen, other = Signal(4, name="o"), Signal(4, name="p"), Signal(4, name="q")
    m.d.comb += [plain.eq(a // b), chosen.eq(Mux(c, a // 3, 0)), other.eq(Mux(c, a // b, 0))]
    text = convert(m, name="division", ports=[a, b, c, plain, chosen, other]).files["division.vhd"]
    lines = [line for line in text.splitlines() if line.startswith("  ") and "<=" in line]
    assert ["unsigned(c) /= 0" in line for line in lines] == [False, True, True], lines


def test_a_quotient_has_the_width_of_the_dividend_and_a_remainder_of_the_divisor() -> None:
    """As in `numeric_std`; a target of another width takes a `resize`."""
    m = Module()
    a, b = Signal(8, name="a"), Signal(3, name="b")
    values = {"q": a // b, "r": a % b, "s": b // a, "t": b % a}
    outputs = [Signal(8, name=name) for name in values]
    m.d.comb += [output.eq(value) for output, value in zip(outputs, values.values(), strict=True)]
    text = convert(m, name="widths", ports=[a, b, *outputs]).files["widths.vhd"]
    for line in (
        "q <= std_logic_vector(floor_div(unsigned(a), unsigned(b)));",
        "r <= std_logic_vector(resize(floor_mod(unsigned(a), unsigned(b)), 8));",
        "s <= std_logic_vector(resize(floor_div(unsigned(b), unsigned(a)), 8));",
        "t <= std_logic_vector(floor_mod(unsigned(b), unsigned(a)));",
    ):
        assert line in text, line


def test_copies_of_a_bit_and_of_a_word() -> None:
    m = Module()
    a, b, o = Signal(4, name="a"), Signal(4, name="b"), Signal(15, name="o")
    m.d.comb += o.eq(Cat(a, a, b[1].replicate(3), b[0], b[2:4], b[0]))
    text = " ".join(convert(m, name="copies", ports=[a, b, o]).files["copies.vhd"].split())
    assert "(b(0) & unsigned(b(3 downto 2)) & b(0) & repeat_bit(b(1), 3) & unsigned(a) &" in text
    assert "unsigned(a) & unsigned(a))" in text


def test_only_copies_of_the_top_bit_and_zeros_extend_a_word() -> None:
    m = Module()
    a, b = Signal(4, name="a"), Signal(4, name="b")
    values = {
        "own": Cat(a, a[3].replicate(2)),
        "other": Cat(a, b[3].replicate(2)),
        "lower": Cat(a, a[2].replicate(2)),
        "zeros": Cat(a, Const(0, 2)),
        "ones": Cat(a, Const(0b10, 2)),
    }
    outputs = [Signal(6, name=name) for name in values]
    m.d.comb += [output.eq(value) for output, value in zip(outputs, values.values(), strict=True)]
    text = convert(m, ports=[a, b, *outputs], unsigned_ports=True).files["top.vhd"]
    assert dict(re.findall(r"^  (\w+) <= (.*);$", text, re.MULTILINE)) == {
        "own": "sign_extend(a, 6)",
        "other": "repeat_bit(b(3), 2) & a",
        "lower": "repeat_bit(a(2), 2) & a",
        "zeros": "resize(a, 6)",
        "ones": '"10" & a',
    }


def test_assigns_to_several_wires_at_once() -> None:
    # Amaranth 0.5 writes no such connection, but RTLIL allows it.
    rtlil = r"""
attribute \top 1
module \top
  wire width 8 input 0 \i
  wire width 1 output 1 \a
  wire width 3 output 2 \b
  wire width 4 output 3 \c
  connect { \c \b \a } \i
end
"""
    text = list(convert(rtlil).files.values())[-1]
    assert "a <= i(0);" in text
    assert "b <= std_logic_vector(unsigned(i(3 downto 1)));" in text
    assert "c <= std_logic_vector(unsigned(i(7 downto 4)));" in text


def test_a_wire_read_only_by_a_connection_is_a_signal() -> None:
    # A wire without readers stays visible in a simulation.
    rtlil = r"""
attribute \top 1
module \top
  wire width 4 input 0 \i
  wire width 4 output 1 \o
  wire width 4 \x
  wire width 4 \seen
  connect \x \i
  connect \o \x
  connect \seen \i
end
"""
    text = list(convert(rtlil).files.values())[-1]
    named, _, more = text.partition("Signals that no logic reads")
    assert "signal x : unsigned(3 downto 0);" in named
    assert "signal seen : unsigned(3 downto 0);" in more
    for line in ("x <= unsigned(i);", "o <= std_logic_vector(x);", "seen <= unsigned(i);"):
        assert f"\n  {line}\n" in more


def test_names_are_legal_and_never_merged(tmp_path: Path) -> None:
    names = "signal a__b a_b A_B _a a_ range RANGE 0x a$b a.b resize work top rtl p_clk".split()
    # VHDL ignores case.
    names += ["Unsigned", "RESIZE", "Std_Logic", "Signal", "TOP"]
    module = Module()
    source = Signal(8, name="source")
    signals = [Signal(8, name=name) for name in names]
    for index, signal in enumerate(signals):
        module.d.sync += signal.eq(source + index)
    vhdl = convert(module, name="top", ports=[source, *signals])
    given = vhdl.entities["top"].ports
    assert len({name.lower() for name in given.values()}) == len(given) == len(names) + 3
    assert given["a_b"] == "a_b" and given["rtl"] != "rtl" and given["a__b"] != "a_b"
    # What the text itself uses stays visible.
    hidden = {"unsigned", "resize", "std_logic", "signal", "work", "top", "rtl"}
    assert not hidden & {name.lower() for name in given.values()}
    analyse(vhdl, tmp_path)


@pytest.mark.usefixtures("ghdl")
def test_words_of_vhdl_ams_are_names_of_outermost_ports_only(tmp_path: Path) -> None:
    top, inner = Module(), Module()
    noise, limit, across = (Signal(8, name=name) for name in ("noise", "limit", "across"))
    through = Signal(8, name="Through")
    inner.d.sync += limit.eq(noise)
    top.submodules.inner = inner
    top.d.comb += [through.eq(limit + 1), across.eq(through)]
    vhdl = convert(top, name="top", ports=[noise, across])
    outer = vhdl.entities["top"]
    assert outer.ports["noise"] == "noise" and outer.ports["across"] == "across"
    assert outer.signals["Through"] == "Through_sig" and outer.signals["limit"] == "limit_sig"
    (name,) = vhdl.entities.keys() - {"top"}
    ports = vhdl.entities[name].ports
    assert ports["limit"] == "limit_sig" and ports["noise"] == "noise_sig"
    analyse(vhdl, tmp_path)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        ("AnyConst", r"^module 'top' has AnyConst \(\$anyconst\), whose value only a formal"),
        ("AnySeq", r"^module 'top' has AnySeq \(\$anyseq\), whose value only a formal"),
    ],
)
def test_cells_of_formal_tools_are_refused(make: str, message: str) -> None:
    from amaranth import asserts

    module, out = Module(), Signal(4)
    module.d.comb += out.eq(getattr(asserts, make)(4))
    with pytest.raises(ValueError, match=message):
        convert(module, ports=[out])


def test_a_transparent_read_port_forwards_written_data() -> None:
    m = Module()
    m.submodules.memory = memory = Memory(shape=4, depth=4, init=[])
    write = memory.write_port()
    read = memory.read_port(transparent_for=[write])
    ports = [write.addr, write.data, write.en, read.addr, read.data, read.en]
    text = convert(m, name="bypass", ports=ports).files["bypass.vhd"]
    same = "if unsigned(read_addr) = unsigned(write_addr) and write_en = '1' then"
    assert f"{same}  -- transparent" in text
