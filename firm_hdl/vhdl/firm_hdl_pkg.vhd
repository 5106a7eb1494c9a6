-- Functions that the circuits written by firm-hdl use, beside those of IEEE 1076-2008.
-- All are synthesizable, except to_decimal and to_characters, which only messages use.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

package firm_hdl_pkg is

  -- A bit as a number of n bits.
  function resize(value : std_ulogic; n : positive) return unsigned;

  -- A bit as 0 or 1.
  function to_integer(value : std_ulogic) return natural;

  -- Two's complement: extended with copies of the most significant bit.
  function sign_extend(value : unsigned; n : positive) return unsigned;

  -- n copies of a bit.
  function repeat_bit(value : std_ulogic; n : positive) return unsigned;

  -- '1' for true.
  function to_std_logic(condition : boolean) return std_ulogic;

  -- A multiplexer as an expression.
  function mux(sel, if_true, if_false : std_ulogic) return std_ulogic;
  function mux(sel : std_ulogic; if_true, if_false : unsigned) return unsigned;

  -- The least significant bit.
  function lsb(value : unsigned) return std_ulogic;

  -- The n low bits, or all ones if the value needs more.
  function saturate(value : unsigned; n : positive) return unsigned;

  -- Quotient rounded towards minus infinity, and the remainder that goes with it; 0 if the divisor
  -- is 0. The signed remainder has the sign of the divisor.
  function floor_div(dividend, divisor : unsigned) return unsigned;
  function floor_div(dividend, divisor : signed) return signed;
  function floor_mod(dividend, divisor : unsigned) return unsigned;
  function floor_mod(dividend, divisor : signed) return signed;

  -- Numbers and bytes (the first one in the most significant bits) for messages.
  function to_decimal(value : unsigned) return string;
  function to_decimal(value : signed) return string;
  function to_characters(value : unsigned) return string;

end package;

package body firm_hdl_pkg is

  -- Bit by bit, as GHDL 2.0 cannot synthesize a constant compared with a number.
  function is_zero(value : unsigned) return boolean is
  begin
    for i in value'range loop
      if value(i) = '1' then
        return false;
      end if;
    end loop;
    return true;
  end function;

  function resize(value : std_ulogic; n : positive) return unsigned is
    variable result : unsigned(n - 1 downto 0) := (others => '0');
  begin
    result(0) := value;
    return result;
  end function;

  function to_integer(value : std_ulogic) return natural is
  begin
    if value = '1' then
      return 1;
    end if;
    return 0;
  end function;

  function sign_extend(value : unsigned; n : positive) return unsigned is
  begin
    return unsigned(resize(signed(value), n));
  end function;

  function repeat_bit(value : std_ulogic; n : positive) return unsigned is
    variable result : unsigned(n - 1 downto 0);
  begin
    result := (others => value);
    return result;
  end function;

  function to_std_logic(condition : boolean) return std_ulogic is
  begin
    if condition then
      return '1';
    end if;
    return '0';
  end function;

  function mux(sel, if_true, if_false : std_ulogic) return std_ulogic is
  begin
    if sel = '1' then
      return if_true;
    end if;
    return if_false;
  end function;

  function mux(sel : std_ulogic; if_true, if_false : unsigned) return unsigned is
    variable result : unsigned(if_true'length - 1 downto 0);
  begin
    if sel = '1' then
      result := if_true;
    else
      result := if_false;
    end if;
    return result;
  end function;

  function lsb(value : unsigned) return std_ulogic is
  begin
    return value(value'right);
  end function;

  function saturate(value : unsigned; n : positive) return unsigned is
    variable bits   : unsigned(value'length - 1 downto 0);
    variable result : unsigned(n - 1 downto 0);
  begin
    bits := value;
    result := bits(n - 1 downto 0);
    if not is_zero(bits(value'length - 1 downto n)) then
      result := (others => '1');
    end if;
    return result;
  end function;

  function floor_div(dividend, divisor : unsigned) return unsigned is
    variable result : unsigned(dividend'length - 1 downto 0) := (others => '0');
  begin
    if not is_zero(divisor) then
      result := dividend / divisor;
    end if;
    return result;
  end function;

  -- One bit more than the operands have: the lowest number divided by -1 needs it.
  function floor_div(dividend, divisor : signed) return signed is
    constant n : positive := maximum(dividend'length, divisor'length) + 1;
    variable a, b, quotient : signed(n - 1 downto 0);
    variable result : signed(n - 1 downto 0) := (others => '0');
  begin
    a := resize(dividend, n);
    b := resize(divisor, n);
    if not is_zero(unsigned(b)) then
      quotient := a / b;
      result := quotient;
      if (a(n - 1) /= b(n - 1)) and not is_zero(unsigned(a mod b)) then
        result := quotient - 1;
      end if;
    end if;
    return result;
  end function;

  function floor_mod(dividend, divisor : unsigned) return unsigned is
    variable result : unsigned(divisor'length - 1 downto 0) := (others => '0');
  begin
    if not is_zero(divisor) then
      result := dividend mod divisor;
    end if;
    return result;
  end function;

  function floor_mod(dividend, divisor : signed) return signed is
    variable result : signed(divisor'length - 1 downto 0) := (others => '0');
  begin
    if not is_zero(unsigned(divisor)) then
      result := dividend mod divisor;
    end if;
    return result;
  end function;

  function to_decimal(value : unsigned) return string is
    variable digits : string(1 to value'length + 1);
    variable left   : unsigned(value'length + 3 downto 0);
    variable place  : natural := digits'high;
  begin
    left := resize(value, left'length);
    for i in digits'reverse_range loop
      place := i;
      digits(i) := character'val(character'pos('0') + to_integer(left mod 10));
      left := left / 10;
      exit when left = 0;
    end loop;
    return digits(place to digits'high);
  end function;

  function to_decimal(value : signed) return string is
  begin
    if value < 0 then
      return '-' & to_decimal(unsigned(-resize(value, value'length + 1)));
    end if;
    return to_decimal(unsigned(value));
  end function;

  function to_characters(value : unsigned) return string is
    variable bits   : unsigned(value'length - 1 downto 0);
    variable result : string(1 to value'length / 8);
  begin
    bits := value;
    for i in result'range loop
      result(i) := character'val(
        to_integer(bits(bits'length - 8 * i + 7 downto bits'length - 8 * i)));
    end loop;
    return result;
  end function;

end package body;
