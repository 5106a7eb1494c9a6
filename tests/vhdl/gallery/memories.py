# amaranth: UnusedElaboratable=no
"""Memories: their words, their initial values, and reads outside of them."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Module, Signal
from amaranth.lib.memory import Memory

from tests.vhdl.gallery import Design, shows, signals


def _members(port: Any) -> list[Any]:
    members = [getattr(port, name) for name in port.signature.members]
    return [each for each in members if isinstance(each, Signal)]


@shows(
    """\

  -- Registers.
  signal later_data_q : unsigned(7 downto 0) := (others => '0');

  type mem_array is array (0 to 4) of unsigned(7 downto 0);
  signal mem : mem_array := (
    1 => "00000011",
    3 => "11111111",
    others => (others => '0')
  );
begin

  process (clk)
  begin
    if rising_edge(clk) then
      if write_en(0) = '1' and unsigned(write_addr) < 5 then
        mem(to_integer(unsigned(write_addr)))(3 downto 0) <= unsigned(write_data(3 downto 0));
      end if;
      if write_en(1) = '1' and unsigned(write_addr) < 5 then
        mem(to_integer(unsigned(write_addr)))(7 downto 4) <= unsigned(write_data(7 downto 4));
      end if;
    end if;
  end process;

  now_data <= std_logic_vector(mem(to_integer(unsigned(now_addr)))) when unsigned(now_addr) < 5 else
      (others => '0');

  process (clk)
  begin
    if rising_edge(clk) then
      if later_en = '1' then
        if unsigned(later_addr) < 5 then
          later_data_q <= mem(to_integer(unsigned(later_addr)));
        else
          later_data_q <= (others => '0');
        end if;
      end if;
    end if;
  end process;

  later_data <= std_logic_vector(later_data_q);
"""
)
def memory_of_an_odd_size() -> Design:
    """Reads beyond the last word give 0; each lane has its own write enable."""
    m = Module()
    m.submodules.mem = memory = Memory(shape=8, depth=5, init=[0, 3, 0, 255])
    now = memory.read_port(domain="comb")
    later = memory.read_port()
    write = memory.write_port(granularity=4)
    return m, [*_members(now), *_members(later), *_members(write)]


@shows(
    """\

  -- Registers.
  signal read_data_q : std_logic := '0';

  type mem_array is array (0 to 1) of unsigned(0 downto 0);
  signal mem : mem_array := (
    0 => "1",
    1 => "1"
  );
begin

  process (clk)
  begin
    if rising_edge(clk) then
      if write_en = '1' then
        mem(to_integer(write_addr)) <= (0 => write_data);
      end if;
    end if;
  end process;

  process (clk)
  begin
    if rising_edge(clk) then
      read_data_q <= mem(to_integer(read_addr))(0);
      if read_addr = write_addr and write_en = '1' then  -- transparent
        read_data_q <= write_data;
      end if;
    end if;
  end process;

  read_data <= read_data_q;
"""
)
def memory_of_bits() -> Design:
    """A memory without unused addresses has no range checks.

    A transparent read port forwards the word that is being written.
    """
    m = Module()
    m.submodules.mem = memory = Memory(shape=1, depth=2, init=[1, 1])
    write = memory.write_port()
    read = memory.read_port(transparent_for=[write])
    return m, [read.addr, read.data, *_members(write)]


@shows(
    """\

  -- Signals that no logic reads, for simulation.
  signal there_addr  : unsigned(2 downto 0);
  signal beyond_addr : unsigned(2 downto 0);

  type mem_array is array (0 to 4) of unsigned(3 downto 0);
  signal mem : mem_array := (others => (others => '0'));
begin


  there_data <= std_logic_vector(mem(4));

  beyond_data <= std_logic_vector(mem(0)) when false else (others => '0');

  there_addr <= "100";
  beyond_addr <= "101";
"""
)
def memory_at_fixed_places() -> Design:
    """A constant address needs no range check; beyond the last word, the port reads 0."""
    m = Module()
    m.submodules.mem = memory = Memory(shape=4, depth=5, init=[])
    there = memory.read_port(domain="comb")
    beyond = memory.read_port(domain="comb")
    m.d.comb += [there.addr.eq(4), beyond.addr.eq(5)]
    return m, [there.data, beyond.data]


@shows(
    """\

  -- Signals that no logic reads, for simulation.
  signal port_data : unsigned(3 downto 0);

  type some_array is array (0 to 1) of unsigned(3 downto 0);
  signal some : some_array := (
    0 => "0001",
    others => (others => '0')
  );
begin


  o <= std_logic_vector(some(to_integer(port_addr)));

  port_data <= unsigned(o);
"""
)
def a_memory_after_an_empty_one() -> Design:
    """A memory without words is left out; the next memory is written as usual."""
    m, (o,) = Module(), signals("o", 4)
    m.submodules.none = Memory(shape=4, depth=0, init=[])
    m.submodules.some = memory = Memory(shape=4, depth=2, init=[1])
    port = memory.read_port(domain="comb")
    m.d.comb += o.eq(port.data)
    return m, [o, port.addr]
