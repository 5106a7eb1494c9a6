# amaranth: UnusedElaboratable=no
"""Conditions: repeated in place, or a signal; written as an `if`, a `case` or an assignment."""

from __future__ import annotations

from amaranth.hdl import Module

from tests.vhdl.gallery import Design, shows, signals


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
def one_condition_for_three() -> Design:
    """A comparison with three readers is repeated for each reader."""
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
def one_condition_for_four() -> Design:
    """A comparison with four readers gets a signal."""
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
def a_longer_condition_for_two() -> Design:
    """A comparison with an operator in it gets a signal for two readers already."""
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
def an_inverted_bit() -> Design:
    """An inverted bit never gets a signal: the comparison is as short as a name."""
    m, (a,), outputs = Module(), signals("a"), signals("o0 o1 o2 o3")
    with m.If(~a):
        m.d.comb += [each.eq(1) for each in outputs]
    return m, [a, *outputs]


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
def conditions() -> Design:
    """Nested `if` statements are joined; an empty branch assigns the default value."""
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
def choices() -> Design:
    """Choices by value become a `case`, or one condition if all have the same value.

    Don't-care bits are not compared.
    """
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


def _ways(count: int) -> Design:
    m, (o,) = Module(), signals("o", 3)
    inputs = signals(" ".join(f"a{n}" for n in range(count)))
    for n, each in enumerate(inputs):
        with m.If(each) if n == 0 else m.Elif(each):
            m.d.comb += o.eq(n + 1)
    return m, [*inputs, o]


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
def six_ways() -> Design:
    """A choice of six values is one conditional assignment."""
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
def seven_ways() -> Design:
    """A choice of seven values is a process."""
    return _ways(6)


@shows(
    """\
begin

  o <= "001" when a = '1' else
       "010" when b = '1' else
       (others => '0');
"""
)
def ways_to_the_same() -> Design:
    """A branch that assigns the default value is left out."""
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
def one_bit_of_many() -> Design:
    """A conditional assignment to a part of a signal is a process."""
    m, (a,), (i, o) = Module(), signals("a"), signals("i o", 3)
    m.d.comb += o.eq(i)
    with m.If(a):
        m.d.comb += o[1].eq(1)
    return m, [a, i, o]


@shows(
    """\
begin

  o <= "01" when s(2) = '1' else
       "10";

  z <= "10" when (s(0) = '0' and s(2) = '0') or unsigned(s(2 downto 1)) = "11" else
       (others => '0');
"""
)
def always_and_never() -> Design:
    """A pattern that always matches ends a choice; a choice without patterns is left out."""
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
