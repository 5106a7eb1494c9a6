# amaranth: UnusedElaboratable=no
"""Operators: the size of expressions, and the form of numbers, bits and literals."""

from __future__ import annotations

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value, signed
from amaranth.lib import data

from tests.vhdl.gallery import Design, shows, signals


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
def operands() -> Design:
    """An expression has at most six operands; a longer one gets a signal."""
    m, inputs, (y, z) = Module(), signals("a b c d e f g"), signals("y z")
    a, b, c, d, e, f, g = inputs
    m.d.comb += [y.eq((a ^ b ^ c ^ d ^ e ^ f) | g), z.eq(((a ^ b ^ c ^ d ^ e ^ f) | g) & a)]
    return m, [*inputs, y, z]


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
def divisions() -> Design:
    """The check for a divisor of zero is part of the function; other choices stay."""
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
def widths() -> Design:
    """An operator has only the bits that are read, without an unused carry."""
    m, (p, q, sum_), (part,) = Module(), signals("p q s", 8), signals("part", 4)
    whole = Signal(9, name="whole")
    m.d.comb += [sum_.eq(p + q), whole.eq(p + q), part.eq((p * q)[2:6])]
    return m, [p, q, sum_, part]


@shows(
    """\

  -- Signals that no logic reads, for simulation.
  signal whole : unsigned(4 downto 0);
  signal seen  : unsigned(2 downto 0);
begin

  o <= std_logic_vector(unsigned(p(1 downto 0)));

  whole <= unsigned(p);
  seen <= unsigned(p(4 downto 2));
"""
)
def fields() -> Design:
    """A field is written as a slice of its signal."""
    m, (p,), (o,) = Module(), signals("p", 5), signals("o", 2)
    whole = Signal(data.StructLayout({"x": 2, "y": 3}), name="whole")
    seen = Signal(3, name="seen")
    m.d.comb += [whole.eq(p), o.eq(whole.x), seen.eq(whole.y)]
    return m, [p, o]


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
def arithmetic() -> Design:
    """Operands are extended to the width of the result, according to their sign."""
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
def bits() -> Design:
    """Concatenation, reduction, selection and comparison of bits."""
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
def comparisons() -> Design:
    """Comparisons and inverted comparisons use the matching VHDL operator."""
    m, (p, q), (a,) = Module(), signals("p q", 4), signals("a")
    outputs, (v,), (w,) = signals("o0 o1 o2 o3 o4"), signals("v", 4), signals("w", 2)
    values = [p == 0, ~(p == q), (p != 3) & ~a, p >= q, p[1:3] == q[2:], p & ~q | 12, Cat(a, ~a)]
    m.d.comb += [o.eq(value) for o, value in zip([*outputs, v, w], values, strict=True)]
    return m, [p, q, a, *outputs, v, w]


@shows(
    """\
begin

  o0 <= '1' when unsigned(p) = x"FFFFFFFFFF" else '0';
  o1 <= '1' when unsigned(p) < x"0200000000" else '0';
  o2 <= '1' when unsigned(p) = 5 else '0';
  o3 <= '1' when unsigned(s) = x"FFFFFFFFFF" else '0';
  o4 <= '1' when unsigned(q) > 5 else '0';
  o5 <= '1' when signed(unsigned(s)) < signed(unsigned'(x"F800000000")) else '0';
  o6 <= '1' when unsigned(p) >= 2147483647 else '0';
  o7 <= '1' when unsigned(p) > x"80000000" else '0';
  o8 <= '1' when unsigned(q) <= 3 else '0';
"""
)
def limits() -> Design:
    """Constants in the range of a VHDL integer are decimal; larger ones are bit strings."""
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
def sums() -> Design:
    """A constant in a sum or difference is decimal, on either side."""
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
def single_bits() -> Design:
    """Bits are compared as std_logic, unless their order is compared."""
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
