# amaranth: UnusedElaboratable=no
"""Small designs beside the VHDL that an engineer would write for them, each showing one rule.

Which operator gets a name, which condition is repeated, what becomes an `if`, a `case` or a
conditional assignment: all of it does the same in hardware, and decides whether anybody can read
it. The texts were read line by line before they came here, and nothing writes them anew.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from amaranth.hdl import (
    Assert,
    Assume,
    Cat,
    Const,
    Cover,
    Format,
    Module,
    Mux,
    Print,
    Signal,
    Value,
    signed,
)
from amaranth.lib import data, enum
from amaranth.lib.memory import Memory

from firm_hdl.vhdl.convert import convert

Made = tuple[Module, list[Any]]
GALLERY: dict[str, tuple[Callable[[], Made], str]] = {}


def shows(text: str) -> Callable[[Callable[[], Made]], Callable[[], Made]]:
    """Note what the architecture of a design is to be, without its first and last line."""

    def note(make: Callable[[], Made]) -> Callable[[], Made]:
        GALLERY[make.__name__] = make, text
        return make

    return note


def signals(names: str, width: int = 1) -> list[Any]:
    return [Signal(width, name=name) for name in names.split()]


def _members(port: Any) -> list[Any]:
    members = [getattr(port, name) for name in port.signature.members]
    return [each for each in members if isinstance(each, Signal)]


def _ways(count: int) -> Made:
    m, (o,) = Module(), signals("o", 3)
    inputs = signals(" ".join(f"a{n}" for n in range(count)))
    for n, each in enumerate(inputs):
        with m.If(each) if n == 0 else m.Elif(each):
            m.d.comb += o.eq(n + 1)
    return m, [*inputs, o]


@shows(
    """\

  -- Combinational signals.
  signal or_11 : std_logic;
begin

  y <= (a xor b xor c xor d xor e xor f) or g;
  or_11 <= (a xor b xor c xor d xor e xor f) or g;
  z <= or_11 and a;
"""
)
def operands() -> Made:
    """Up to six operands stand in one expression."""
    m, inputs, (y, z) = Module(), signals("a b c d e f g"), signals("y z")
    a, b, c, d, e, f, g = inputs
    m.d.comb += [y.eq((a ^ b ^ c ^ d ^ e ^ f) | g), z.eq(((a ^ b ^ c ^ d ^ e ^ f) | g) & a)]
    return m, [*inputs, y, z]


@shows(
    """\
begin

  o0 <= '1' when unsigned(p) < unsigned(q) else
        '0';

  o1 <= '1' when unsigned(p) < unsigned(q) else
        '0';

  o2 <= '1' when unsigned(p) < unsigned(q) else
        '0';
"""
)
def one_condition_for_three() -> Made:
    """A comparison that three read is written three times."""
    m, (p, q), outputs = Module(), signals("p q", 4), signals("o0 o1 o2")
    with m.If(p < q):
        m.d.comb += [each.eq(1) for each in outputs]
    return m, [p, q, *outputs]


@shows(
    """\

  -- Combinational signals.
  signal lt_1 : std_logic;
begin

  lt_1 <= '1' when unsigned(p) < unsigned(q) else '0';

  o0 <= '1' when lt_1 = '1' else
        '0';

  o1 <= '1' when lt_1 = '1' else
        '0';

  o2 <= '1' when lt_1 = '1' else
        '0';

  o3 <= '1' when lt_1 = '1' else
        '0';
"""
)
def one_condition_for_four() -> Made:
    """One that four read has a name."""
    m, (p, q), outputs = Module(), signals("p q", 4), signals("o0 o1 o2 o3")
    with m.If(p < q):
        m.d.comb += [each.eq(1) for each in outputs]
    return m, [p, q, *outputs]


@shows(
    """\

  -- Combinational signals.
  signal lt_2 : std_logic;
begin

  lt_2 <= '1' when unsigned(p) + unsigned(r) < unsigned(q) else '0';

  o0 <= '1' when lt_2 = '1' else
        '0';

  o1 <= '1' when lt_2 = '1' else
        '0';
"""
)
def a_longer_condition_for_two() -> Made:
    """So has one with an operator in it that two read."""
    m, (p, q, r), outputs = Module(), signals("p q r", 4), signals("o0 o1")
    with m.If((p + r)[:4] < q):
        m.d.comb += [each.eq(1) for each in outputs]
    return m, [p, q, r, *outputs]


@shows(
    """\
begin

  o0 <= '1' when a = '0' else
        '0';

  o1 <= '1' when a = '0' else
        '0';

  o2 <= '1' when a = '0' else
        '0';

  o3 <= '1' when a = '0' else
        '0';
"""
)
def an_inverted_bit() -> Made:
    """The opposite of a bit is as short as any name, however many read it."""
    m, (a,), outputs = Module(), signals("a"), signals("o0 o1 o2 o3")
    with m.If(~a):
        m.d.comb += [each.eq(1) for each in outputs]
    return m, [a, *outputs]


@shows(
    """\
begin

  o0 <= std_logic_vector(floor_div(unsigned(p), unsigned(q)));
  o1 <= std_logic_vector(floor_mod(unsigned(p), unsigned(q)));
  o2 <= std_logic_vector(unsigned(s)) when unsigned(q) /= 0 else (others => '0');
  o3 <= std_logic_vector(floor_div(unsigned(p), unsigned(q))) when unsigned(p) /= 0 else
      (others => '0');
"""
)
def divisions() -> Made:
    """Dividing by zero gives 0 without a word; other choices stay."""
    m, (p, q, s), outputs = Module(), signals("p q s", 4), signals("o0 o1 o2 o3", 4)
    values = [p // q, p % q, Mux(q.any(), s, 0), Mux(p.any(), p // q, 0)]
    m.d.comb += [output.eq(value) for output, value in zip(outputs, values, strict=True)]
    return m, [p, q, s, *outputs]


@shows(
    """\

  -- Combinational signals.
  signal whole : unsigned(8 downto 0);
  signal mul_2 : unsigned(5 downto 0);
begin

  s <= std_logic_vector(unsigned(p) + unsigned(q));
  whole <= resize(unsigned(p), 9) + unsigned(q);
  mul_2 <= resize(unsigned(p(5 downto 0)) * unsigned(q(5 downto 0)), 6);

  part <= std_logic_vector(mul_2(5 downto 2));
"""
)
def widths() -> Made:
    """An operator has the bits that are read, and no carry besides."""
    m, (p, q, sum_), (part,) = Module(), signals("p q s", 8), signals("part", 4)
    whole = Signal(9, name="whole")
    m.d.comb += [sum_.eq(p + q), whole.eq(p + q), part.eq((p * q)[2:6])]
    return m, [p, q, sum_, part]


@shows(
    """\

  -- More names of values, for whoever looks at a simulation.
  signal whole : unsigned(4 downto 0);
  signal seen  : unsigned(2 downto 0);
begin

  o <= std_logic_vector(unsigned(p(1 downto 0)));

  whole <= unsigned(p);
  seen <= unsigned(p(4 downto 2));
"""
)
def fields() -> Made:
    """A field is a part of its signal, and has no name beside it."""
    m, (p,), (o,) = Module(), signals("p", 5), signals("o", 2)
    whole = Signal(data.StructLayout({"x": 2, "y": 3}), name="whole")
    seen = Signal(3, name="seen")
    m.d.comb += [whole.eq(p), o.eq(whole.x), seen.eq(whole.y)]
    return m, [p, o]


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
def memory_of_an_odd_size() -> Made:
    """Beyond the last word is nothing; bytes are written one by one."""
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

  type mem_array is array (0 to 1) of std_logic;
  signal mem : mem_array := (
    0 => '1',
    1 => '1'
  );
begin

  process (clk)
  begin
    if rising_edge(clk) then
      if write_en = '1' then
        mem(to_integer(write_addr)) <= write_data;
      end if;
    end if;
  end process;

  process (clk)
  begin
    if rising_edge(clk) then
      read_data_q <= mem(to_integer(read_addr));
      if read_addr = write_addr and write_en = '1' then  -- being written
        read_data_q <= write_data;
      end if;
    end if;
  end process;

  read_data <= read_data_q;
"""
)
def memory_of_bits() -> Made:
    """All words are used, and what is being written is read at once."""
    m = Module()
    m.submodules.mem = memory = Memory(shape=1, depth=2, init=[1, 1])
    write = memory.write_port()
    read = memory.read_port(transparent_for=[write])
    return m, [read.addr, read.data, *_members(write)]


@shows(
    """\

  -- More names of values, for whoever looks at a simulation.
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
def memory_at_fixed_places() -> Made:
    """A place that is there needs no test, and one that is not is 0."""
    m = Module()
    m.submodules.mem = memory = Memory(shape=4, depth=5, init=[])
    there = memory.read_port(domain="comb")
    beyond = memory.read_port(domain="comb")
    m.d.comb += [there.addr.eq(4), beyond.addr.eq(5)]
    return m, [there.data, beyond.data]


@shows(
    """\
begin

  o <= "01" when a = '1' and b = '1' else
       (others => '0');

  u <= (others => '0') when a = '1' else
       "01" when b = '1' else
       (others => '0');
"""
)
def conditions() -> Made:
    """An `if` in an `if` is one; what nothing happens in is left to the others."""
    m, (a, b), (o, u) = Module(), signals("a b"), signals("o u", 2)
    with m.If(a), m.If(b):
        m.d.comb += o.eq(1)
    with m.If(a):
        pass
    with m.Elif(b):
        m.d.comb += u.eq(1)
    return m, [a, b, o, u]


@shows(
    """\
begin

  o <= "001" when s(2) = '1' else
       "010" when s(1) = '1' or s(0) = '1' else
       (others => '0');

  k <= "001" when unsigned(s) = "001" or unsigned(s) = "010" else
       "101";

  p_h : process (all)
  begin
    h <= (others => '0');
    case unsigned(s) is
      when "001" =>
        h <= "001";
      when "010" =>
        h <= "010";
      when others =>
        null;
    end case;
  end process;

  p_v : process (all)
  begin
    v <= (others => '0');
    case unsigned(s) is
      when "000" =>
        v <= "011";
      when "001" | "110" =>
        v <= "010";
      when others =>
        null;
    end case;
  end process;
"""
)
def choices() -> Made:
    """Plain values make a `case`, unless all do the same; don't-care bits are not asked for."""
    m, (s,), outputs = Module(), signals("s", 3), signals("o k h v", 3)
    o, k, h, v = outputs
    with m.Switch(s):
        with m.Case("1--"):
            m.d.comb += o.eq(1)
        with m.Case("-1-", "--1"):
            m.d.comb += o.eq(2)
    with m.Switch(s):
        with m.Case(1, 2):
            m.d.comb += k.eq(1)
        with m.Case(3):
            m.d.comb += k.eq(5)
        with m.Default():
            m.d.comb += k.eq(5)
    with m.Switch(s):
        with m.Case(1):
            m.d.comb += h.eq(1)
        with m.Case(2):
            m.d.comb += h.eq(2)
    with m.Switch(s):
        with m.Case(0):
            m.d.comb += v.eq(3)
        with m.Case(1, 6):
            m.d.comb += v.eq(2)
    return m, [s, *outputs]


@shows(
    """\
begin

  o <= "001" when a0 = '1' else
       "010" when a1 = '1' else
       "011" when a2 = '1' else
       "100" when a3 = '1' else
       "101" when a4 = '1' else
       (others => '0');
"""
)
def six_ways() -> Made:
    """Six values fit in one assignment."""
    return _ways(5)


@shows(
    """\
begin

  p_o : process (all)
  begin
    o <= (others => '0');
    if a0 = '1' then
      o <= "001";
    elsif a1 = '1' then
      o <= "010";
    elsif a2 = '1' then
      o <= "011";
    elsif a3 = '1' then
      o <= "100";
    elsif a4 = '1' then
      o <= "101";
    elsif a5 = '1' then
      o <= "110";
    end if;
  end process;
"""
)
def seven_ways() -> Made:
    """Seven do not."""
    return _ways(6)


@shows(
    """\
begin

  o <= "001" when a = '1' else
       "010" when b = '1' else
       (others => '0');
"""
)
def ways_to_the_same() -> Made:
    """What would be the default anyway is not asked for."""
    m, inputs, (o,) = Module(), signals("a b c"), signals("o", 3)
    a, b, c = inputs
    with m.If(a):
        m.d.comb += o.eq(1)
    with m.Elif(b):
        m.d.comb += o.eq(2)
    with m.Elif(c):
        m.d.comb += o.eq(0)
    return m, [*inputs, o]


@shows(
    """\
begin

  p_o : process (all)
  begin
    o <= std_logic_vector(unsigned(i));
    if a = '1' then
      o(1) <= '1';
    end if;
  end process;
"""
)
def one_bit_of_many() -> Made:
    """A part of a signal needs a process."""
    m, (a,), (i, o) = Module(), signals("a"), signals("i o", 3)
    m.d.comb += o.eq(i)
    with m.If(a):
        m.d.comb += o[1].eq(1)
    return m, [a, i, o]


@shows(
    """\

  -- Combinational signals.
  signal o1_0 : unsigned(4 downto 0);
  signal o2_0 : unsigned(4 downto 0);
  signal o5_0 : unsigned(4 downto 0);
  signal o7_0 : unsigned(3 downto 0);
begin

  o1_0 <= resize(unsigned(p), 5) - unsigned(q);
  o2_0 <= sign_extend(unsigned(sp), 5) + sign_extend(unsigned(sq), 5);
  o3 <= std_logic_vector(unsigned(p) * unsigned(q));
  o4 <= std_logic_vector(unsigned(signed(unsigned(sp)) * signed(unsigned(sq))));
  o5_0 <= 0 - resize(unsigned(p), 5);
  o7_0 <= unsigned(shift_right(signed(unsigned(sp)), to_integer(unsigned(q(1 downto 0)))));

  o0 <= std_logic_vector(resize(resize(unsigned(p), 5) + unsigned(q), 8));
  o1 <= std_logic_vector(sign_extend(o1_0, 8));
  o2 <= std_logic_vector(sign_extend(o2_0, 8));
  o5 <= std_logic_vector(sign_extend(o5_0, 8));
  o6 <= std_logic_vector(resize(shift_left(resize(unsigned(p), 7),
      to_integer(unsigned(q(1 downto 0)))), 8));
  o7 <= std_logic_vector(sign_extend(o7_0, 8));
"""
)
def arithmetic() -> Made:
    """Operands are as wide as results ask for, by their sign."""
    m, (p, q), outputs = Module(), signals("p q", 4), signals("o0 o1 o2 o3 o4 o5 o6 o7", 8)
    sp, sq = Signal(signed(4), name="sp"), Signal(signed(4), name="sq")
    by = q[:2]
    values = [p + q, p - q, sp + sq, p * q, sp * sq, -p, p << by, sp >> by]
    m.d.comb += [output.eq(value) for output, value in zip(outputs, values, strict=True)]
    return m, [p, q, sp, sq, *outputs]


@shows(
    """\
begin

  o0 <= std_logic_vector(unsigned'(unsigned(q) & unsigned(p)));
  o1 <= std_logic_vector(resize(or unsigned(p), 8));
  o2 <= std_logic_vector(resize(and unsigned(p), 8));
  o3 <= std_logic_vector(resize(xor unsigned(p), 8));
  o4 <= std_logic_vector(resize(to_std_logic(signed(unsigned(sp)) < signed(unsigned(sq))), 8));
  o5 <= std_logic_vector(resize(mux(p(0), unsigned(p), unsigned(q)), 8));
  o6 <= std_logic_vector(resize(resize(shift_right(unsigned(p),
      to_integer(unsigned(q(1 downto 0)))), 2), 8));
"""
)
def bits() -> Made:
    """Bits are joined, reduced, chosen and compared."""
    m, (p, q), outputs = Module(), signals("p q", 4), signals("o0 o1 o2 o3 o4 o5 o6", 8)
    sp, sq = Signal(signed(4), name="sp"), Signal(signed(4), name="sq")
    values: list[Value] = [Cat(p, q), p.any(), p.all(), p.xor(), sp < sq, Mux(p[0], p, q)]
    values.append(p.bit_select(q[:2], 2))
    m.d.comb += [output.eq(value) for output, value in zip(outputs, values, strict=True)]
    return m, [p, q, sp, sq, *outputs]


@shows(
    """\
begin

  o0 <= '1' when unsigned(p) = 0 else '0';
  o1 <= '1' when unsigned(p) /= unsigned(q) else '0';
  o2 <= '1' when unsigned(p) /= 3 and a = '0' else '0';
  o3 <= '1' when unsigned(p) >= unsigned(q) else '0';
  o4 <= '1' when unsigned(p(2 downto 1)) = unsigned(q(3 downto 2)) else '0';
  v <= std_logic_vector((unsigned(p) and not unsigned(q)) or "1100");

  w <= std_logic_vector(unsigned'(not a & a));
"""
)
def comparisons() -> Made:
    """Each comparison is written as one says it, its opposite as well."""
    m, (p, q), (a,) = Module(), signals("p q", 4), signals("a")
    outputs, (v,), (w,) = signals("o0 o1 o2 o3 o4"), signals("v", 4), signals("w", 2)
    values = [p == 0, ~(p == q), (p != 3) & ~a, p >= q, p[1:3] == q[2:], p & ~q | 12, Cat(a, ~a)]
    m.d.comb += [o.eq(value) for o, value in zip([*outputs, v, w], values, strict=True)]
    return m, [p, q, a, *outputs, v, w]


@shows(
    """\

  -- Registers.
  signal o_q : unsigned(3 downto 0) := "0101";

  -- Combinational signals.
  signal total : unsigned(3 downto 0);

  -- More names of values, for whoever looks at a simulation.
  signal r : unsigned(3 downto 0);
begin

  total <= o_q + unsigned(i);

  p_clk : process (clk)
  begin
    if rising_edge(clk) then
      if rst = '1' then
        o_q <= "0101";
      else
        o_q <= total xor unsigned(i);
      end if;
    end if;
  end process;

  o2 <= std_logic_vector(unsigned'(total(2 downto 0) & total(3)));

  o <= std_logic_vector(o_q);

  r <= o_q;
"""
)
def names_of_signals() -> Made:
    """What has a name keeps it; a register's second name is one more."""
    m, (i, o, o2) = Module(), signals("i o o2", 4)
    r, total = Signal(4, name="r", init=5), Signal(4, name="total")
    m.d.comb += total.eq(r + i)
    m.d.sync += r.eq(total ^ i)
    m.d.comb += [o.eq(r), o2.eq(total.rotate_left(1))]
    return m, [i, o, o2]


@shows(
    """\

  -- Registers.
  signal o_q : unsigned(3 downto 0) := "1001";
begin

  p_clk : process (clk)
  begin
    if rising_edge(clk) then
      if rst = '1' then
        o_q <= "1001";
      else
        if i(0) = '1' then
          o_q <= unsigned(i);
        end if;
        if i(1) = '1' then
          o_q(3 downto 2) <= "00";
        end if;
      end if;
    end if;
  end process;

  o <= std_logic_vector(o_q);
"""
)
def parts_of_registers() -> Made:
    """A reset gives the first value; statements stay in their order."""
    m, (i,) = Module(), signals("i", 4)
    o = Signal(4, name="o", init=9)
    with m.If(i[0]):
        m.d.sync += o.eq(i)
    with m.If(i[1]):
        m.d.sync += o[2:].eq(0)
    return m, [i, o]


@shows(
    """\
begin

  o0 <= '1' when unsigned(p) = x"FFFFFFFFFF" else '0';
  o1 <= '1' when unsigned(p) < 34x"200000000" else '0';
  o2 <= '1' when unsigned(p) = 5 else '0';
  o3 <= '1' when unsigned(s) = x"FFFFFFFFFF" else '0';
  o4 <= '1' when unsigned(q) > 5 else '0';
  o5 <= '1' when signed(unsigned(s)) < signed(unsigned'(x"800000000")) else '0';
  o6 <= '1' when unsigned(p) >= 2147483647 else '0';
  o7 <= '1' when unsigned(p) > x"80000000" else '0';
  o8 <= '1' when unsigned(q) <= 3 else '0';
"""
)
def limits() -> Made:
    """Numbers are decimal up to what an integer of VHDL holds, and literals beyond it."""
    m, (p,), (q,) = Module(), signals("p", 40), signals("q", 4)
    s, outputs = Signal(signed(40), name="s"), signals("o0 o1 o2 o3 o4 o5 o6 o7 o8")
    values = [p == (1 << 40) - 1, p < (1 << 33), p == 5, s == -1, Const(5, 4) < q]
    values += [s < -(1 << 35), p >= (1 << 31) - 1, p > (1 << 31), Const(3, 4) >= q]
    m.d.comb += [output.eq(value) for output, value in zip(outputs, values, strict=True)]
    return m, [p, s, q, *outputs]


@shows(
    """\
begin

  o0 <= std_logic_vector(resize(unsigned(q), 5) + 3);
  o1 <= std_logic_vector(resize(unsigned(q), 5) + 3);
  o2 <= std_logic_vector(3 - resize(unsigned(q), 5));
  o3 <= std_logic_vector(resize(unsigned(q), 5) - 3);
  o4 <= std_logic_vector(sign_extend(unsigned(sq), 5) - 3);
  o5 <= std_logic_vector(sign_extend(unsigned(sq), 5) - 3);

  o6 <= std_logic_vector(resize(unsigned(q), 5));
"""
)
def sums() -> Made:
    """What is added to or taken from a signal is a number, on either side."""
    m, (q,), outputs = Module(), signals("q", 4), signals("o0 o1 o2 o3 o4 o5 o6", 5)
    sq = Signal(signed(4), name="sq")
    values: list[Value] = [q + 3, 3 + q, 3 - q, q - 3, sq - 3, sq + (-3), q + Const(0, 4)]
    m.d.comb += [output.eq(value) for output, value in zip(outputs, values, strict=True)]
    return m, [q, sq, *outputs]


@shows(
    """\
begin

  o0 <= not (a xor b);
  o1 <= a xor b;
  o2 <= a;
  o3 <= to_std_logic(resize(a, 1) = 0);
  o4 <= not (sa xor sb);
  o5 <= to_std_logic(resize(a, 1) < resize(b, 1));

  w <= "01" when a = b else
       "10" when a /= '1' else
       (others => '0');
"""
)
def single_bits() -> Made:
    """Bits are compared without a detour over numbers, but for their order."""
    m, (a, b), outputs = Module(), signals("a b"), signals("o0 o1 o2 o3 o4 o5")
    sa, sb = Signal(signed(1), name="sa"), Signal(signed(1), name="sb")
    w = Signal(2, name="w")
    values = [a == b, a != b, a == 1, a == 0, sa == sb, a < b]
    m.d.comb += [output.eq(value) for output, value in zip(outputs, values, strict=True)]
    with m.If(a == b):
        m.d.comb += w.eq(1)
    with m.Elif(a != 1):
        m.d.comb += w.eq(2)
    return m, [a, b, sa, sb, *outputs, w]


@shows(
    """\
begin

  o <= "01" when s(2) = '1' else
       "10";

  z <= "10" when (s(0) = '0' and s(2) = '0') or unsigned(s(2 downto 1)) = "11" else
       (others => '0');
"""
)
def always_and_never() -> Made:
    """What always matches ends a choice; what never does is not asked for."""
    m, (s,), (o, z) = Module(), signals("s", 3), signals("o z", 2)
    with m.Switch(s):
        with m.Case("1--"):
            m.d.comb += o.eq(1)
        with m.Case("-1-", "---"):
            m.d.comb += o.eq(2)
        with m.Case("--1"):
            m.d.comb += o.eq(3)
    with m.Switch(s):
        with m.Case():
            m.d.comb += z.eq(1)
        with m.Case("0-0", "11-"):
            m.d.comb += z.eq(2)
    return m, [s, o, z]


@shows(
    """\

  -- Combinational signals.
  signal choice_1 : std_logic;
  signal choice_2 : std_logic;
  signal choice_4 : std_logic;
  signal choice_6 : std_logic;
  signal choice_7 : std_logic;
begin

  choice_1 <= '1' when a = '1' else
              '0';

  choice_2 <= '1' when a = '1' else
              '0';

  choice_4 <= '1' when a = '1' else
              '0';

  choice_6 <= '1' when a = '1' else
              '0';

  choice_7 <= '1' when a = '1' else
              '0';

  -- synthesis translate_off
  postponed process (all)
  begin
    if choice_1 = '1' then
      report "{\"\"\" & to_decimal(unsigned(d)) & \"\"\" " & to_hstring(unsigned(d)) & " " &
          to_string(unsigned(sd)) & " " & to_ostring(unsigned(d)) & "}" & character'val(9) &
          to_characters(unsigned(d)) severity note;
    end if;
  end process;
  -- synthesis translate_on

  -- synthesis translate_off
  postponed process (all)
  begin
    if choice_2 = '1' then
      assert a = '1' report "assumption failed in t" severity error;
    end if;
  end process;
  -- synthesis translate_on

  -- Cover: to_std_logic(unsigned(d) = 1)

  -- synthesis translate_off
  process (clk)
  begin
    if rising_edge(clk) and (choice_6 = '1') then
      assert signed(resize(unsigned(d), 9)) = signed(unsigned(sd)) report "no" severity error;
    end if;
  end process;
  -- synthesis translate_on

  -- synthesis translate_off
  process (clk)
  begin
    if rising_edge(clk) and (choice_7 = '1') then
      report "" severity note;
    end if;
  end process;
  -- synthesis translate_on
"""
)
def messages() -> Made:
    """Messages are for simulators; of a format the kinds of numbers are kept."""
    m, (a,), (d,) = Module(), signals("a"), signals("d", 8)
    sd = Signal(signed(8), name="sd")
    with m.If(a):
        text = Format('{{"{}" {:x} {:b} {:o}}}\t{:c}', d, d, sd, d, d)
        m.d.comb += [Print(text), Assume(a), Cover(d == 1)]
        m.d.sync += [Assert(d == sd, "no"), Print("")]
    return m, [a, d, sd]


@shows(
    """\

  -- More names of values, for whoever looks at a simulation.
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
def a_memory_behind_an_empty_one() -> Made:
    """One without words is not there, and the next one is."""
    m, (o,) = Module(), signals("o", 4)
    m.submodules.none = Memory(shape=4, depth=0, init=[])
    m.submodules.some = memory = Memory(shape=4, depth=2, init=[1])
    port = memory.read_port(domain="comb")
    m.d.comb += o.eq(port.data)
    return m, [o, port.addr]


@shows(
    """\

  -- Registers.
  signal kept : unsigned(3 downto 0) := (others => '0');

  attribute keep : string;
  attribute n : integer;
  attribute keep of kept : signal is "true";
  attribute n of kept : signal is 3;
begin

  p_clk : process (clk)
  begin
    if rising_edge(clk) then
      if rst = '1' then
        kept <= (others => '0');
      else
        kept <= unsigned(i);
      end if;
    end if;
  end process;
"""
)
def attributes() -> Made:
    """What tools are told of a signal is told them here, too."""
    m, (i,) = Module(), signals("i", 4)
    kept = Signal(4, name="kept", attrs={"keep": "true", "n": 3})
    m.d.sync += kept.eq(i)
    return m, [i]


@pytest.mark.parametrize("name", GALLERY)
def test_a_design_reads_as_if_written_by_hand(name: str) -> None:
    make, text = GALLERY[name]
    module, ports = make()
    whole = convert(module, name="t", ports=ports).files["t.vhd"]
    head, _, body = whole.partition("architecture rtl of t is\n")
    assert head.endswith("end entity;\n\n")
    assert body == f"{text}\nend architecture;\n"


@pytest.mark.parametrize("count", [8, 9])
def test_eight_names_of_values_fit_behind_a_port_and_nine_do_not(count: int) -> None:
    kind = enum.Enum("Kind", {f"A{n}": n for n in range(count)})
    m, i, o = Module(), Signal(kind, name="i"), Signal(signed(4), name="o")
    m.d.comb += o.eq(i)
    text = convert(m, name="t", ports=[i, o]).files["t.vhd"]
    names = ", ".join(f"{n} A{n}" for n in range(count))
    assert (f";  -- {names}\n" in text) == (count == 8)
    assert ("A0" in text) == (count == 8)
    assert "o : out std_logic_vector(3 downto 0)" in text and "  -- signed" in text
