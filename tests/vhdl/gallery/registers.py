# amaranth: UnusedElaboratable=no
"""Names and attributes of registers and signals, and messages for simulators."""

from __future__ import annotations

from amaranth.hdl import Assert, Assume, Cover, Format, Module, Print, Signal, signed

from tests.vhdl.gallery import Design, shows, signals


@shows(
    """\

  -- Registers.
  signal r : unsigned(3 downto 0) := "0101";

  -- Combinational signals.
  signal total : unsigned(3 downto 0);
begin

  total <= r + unsigned(i);

  p_clk : process (clk)
  begin
    if rising_edge(clk) then
      if rst = '1' then
        r <= "0101";
      else
        r <= total xor unsigned(i);
      end if;
    end if;
  end process;

  o2 <= std_logic_vector(unsigned'(total(2 downto 0) & total(3)));

  o <= std_logic_vector(r);
"""
)
def names_of_signals() -> Design:
    """Signals keep their names; a port that is a copy of a register needs no more signals."""
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
def parts_of_registers() -> Design:
    """A reset restores the initial value; statements keep their order."""
    m, (i,) = Module(), signals("i", 4)
    o = Signal(4, name="o", init=9)
    with m.If(i[0]):
        m.d.sync += o.eq(i)
    with m.If(i[1]):
        m.d.sync += o[2:].eq(0)
    return m, [i, o]


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
def attributes() -> Design:
    """Attributes of a signal become VHDL attributes."""
    m, (i,) = Module(), signals("i", 4)
    kept = Signal(4, name="kept", attrs={"keep": "true", "n": 3})
    m.d.sync += kept.eq(i)
    return m, [i]


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
def messages() -> Design:
    """Messages are excluded from synthesis, and keep the number formats."""
    m, (a,), (d,) = Module(), signals("a"), signals("d", 8)
    sd = Signal(signed(8), name="sd")
    with m.If(a):
        text = Format('{{"{}" {:x} {:b} {:o}}}\t{:c}', d, d, sd, d, d)
        m.d.comb += [Print(text), Assume(a), Cover(d == 1)]
        m.d.sync += [Assert(d == sd, "no"), Print("")]
    return m, [a, d, sd]
