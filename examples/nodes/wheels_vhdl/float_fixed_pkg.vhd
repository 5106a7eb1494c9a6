-- Floats of messages and numbers in fixed point: signed, with 16 of 32 bits after the point.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

package float_fixed_pkg is

  constant BITS          : positive := 32;
  constant FRACTION_BITS : natural  := 16;

  -- The float64 as a fixed-point number, cut towards 0. What is too large becomes the largest or
  -- the smallest number, and NaN becomes 0.
  function to_fixed(number : std_logic_vector(63 downto 0)) return signed;

  -- The float64 that is equal to a fixed-point number of at most 53 bits.
  function to_float(fixed : signed) return std_logic_vector;

end package;

package body float_fixed_pkg is

  function to_fixed(number : std_logic_vector(63 downto 0)) return signed is
    -- A float64 is 1.mantissa * 2**(exponent - 1023). The exponent of the highest bit below the
    -- sign of the result is TOP.
    constant TOP      : natural := 1023 + BITS - 2 - FRACTION_BITS;
    variable exponent : unsigned(10 downto 0);
    variable mantissa : unsigned(51 downto 0);
    variable value    : unsigned(52 downto 0);
    variable result   : signed(BITS - 1 downto 0);
  begin
    exponent := unsigned(number(62 downto 52));
    mantissa := unsigned(number(51 downto 0));
    value    := '1' & mantissa;
    if exponent + 63 < TOP then
      value := (others => '0');
    else
      value := shift_right(value, to_integer(resize(TOP - exponent, 6)));
    end if;
    result := signed('0' & value(52 downto 54 - BITS));
    if exponent > TOP then
      result := (BITS - 1 => '0', others => '1');
    end if;
    if number(63) = '1' then
      if exponent > TOP then
        result := (BITS - 1 => '1', others => '0');
      else
        result := -result;
      end if;
    end if;
    if exponent = 2047 and mantissa /= 0 then
      result := (others => '0');
    end if;
    return result;
  end function;

  function to_float(fixed : signed) return std_logic_vector is
    constant VALUE     : signed(fixed'length - 1 downto 0) := fixed;
    variable magnitude : unsigned(fixed'length - 1 downto 0);
    variable exponent  : unsigned(10 downto 0);
    variable mantissa  : unsigned(51 downto 0);
  begin
    magnitude := unsigned(VALUE);
    if VALUE(VALUE'high) = '1' then
      magnitude := unsigned(-VALUE);
    end if;
    exponent := (others => '0');
    mantissa := (others => '0');
    -- The highest bit that is set decides: it is the last one of the loop.
    for place in 0 to fixed'length - 1 loop
      if magnitude(place) = '1' then
        exponent := to_unsigned(1023 - FRACTION_BITS + place, 11);
        mantissa := (others => '0');
        for below in 0 to place - 1 loop
          mantissa(52 - place + below) := magnitude(below);
        end loop;
      end if;
    end loop;
    return VALUE(VALUE'high) & std_logic_vector(exponent) & std_logic_vector(mantissa);
  end function;

end package body;
