# amaranth: UnusedElaboratable=no
"""The VHDL text of small designs that show one construct each, and its names."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from amaranth.hdl import Module, Signal, unsigned
from amaranth.lib import enum, wiring
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
-- Counter: Count while enabled.
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

  -- Values of enumerations.
  constant STATE_IDLE : unsigned(1 downto 0) := "00";
  constant STATE_BUSY : unsigned(1 downto 0) := "01";
  constant STATE_DONE : unsigned(1 downto 0) := "10";

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
            state_q <= STATE_DONE;
          end if;
        end if;
        case state_q is
          when STATE_IDLE | STATE_BUSY =>
            state_q <= STATE_BUSY;
          when STATE_DONE =>
            state_q <= STATE_IDLE;
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


def test_each_entity_has_the_header_and_ports_outside_are_vectors() -> None:
    top = Module()
    top.submodules.inner = inner = Counter()
    a = Signal(4, name="a")
    top.d.comb += inner.limit.eq(a)
    files = convert(top, ports=[a], header="Mine.\n\nYours.").files
    assert list(files) == ["firm_hdl_pkg.vhd", "top_inner.vhd", "top.vhd"]
    head = "-- Mine.\n--\n-- Yours.\n-- Module "
    assert [text.startswith(head) for text in files.values()] == [False, True, True]
    assert re.search(r"\ba +: in +std_logic_vector\(3 downto 0\)", files["top.vhd"])
    assert re.search(r" : in +unsigned\(3 downto 0\)", files["top_inner.vhd"])


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
    top.d.comb += [through.eq(limit + 1), across.eq(through + 1)]
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
