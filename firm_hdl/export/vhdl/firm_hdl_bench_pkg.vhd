-- Helpers of the test benches. Simulation only.

library ieee;
use ieee.math_real.all;
use std.textio.all;

package firm_hdl_bench_pkg is

  -- The state of a random generator; one seed gives different states for different numbers.
  type random_t is record
    first  : positive;
    second : positive;
  end record;

  function random_from (seed : natural; number : natural) return random_t;

  -- Draw an event that happens in the given percentage of all cases.
  procedure draw (variable random : inout random_t; percent : in natural; happens : out boolean);

  -- Draw a byte.
  procedure draw (variable random : inout random_t; octet : out natural);

  -- Size of the packet in a line. The line may end with CR, as files from Windows do.
  function packet_bytes (row : in string) return natural;
  function is_comment (row : string) return boolean;

  -- Byte number `place` of the packet in a line; -1 if it is not hexadecimal.
  function byte_at (row : string; place : natural) return integer;

  -- A byte as two hexadecimal digits.
  function hex (octet : natural range 0 to 255) return string;

  procedure count_packets (name : in string; count : out natural);

end package firm_hdl_bench_pkg;

package body firm_hdl_bench_pkg is

  function random_from (seed : natural; number : natural) return random_t is
  begin
    -- `uniform` accepts 1 to 2147483562 and 1 to 2147483398.

    return (first => (seed mod 1000003) * 2143 + 1, second => (number mod 1000003) * 2131 + 17);
  end function;

  procedure draw (variable random : inout random_t; percent : in natural; happens : out boolean) is
    variable value : real;
  begin
    uniform(random.first, random.second, value);
    happens := value * 100.0 < real(percent);
  end procedure;

  procedure draw (variable random : inout random_t; octet : out natural) is
    variable value : real;
  begin
    uniform(random.first, random.second, value);
    octet := natural(floor(value * 256.0));
  end procedure;

  function packet_bytes (row : in string) return natural is
  begin
    if row'length > 0 and row(row'right) = CR then
      return (row'length - 1) / 2;
    end if;
    return row'length / 2;
  end function;

  function is_comment (row : string) return boolean is
  begin
    return row'length > 0 and row(row'left) = '#';
  end function;

  function digit (char : character) return integer is
  begin
    case char is
      when '0' to '9' => return character'pos(char) - character'pos('0');
      when 'a' to 'f' => return character'pos(char) - character'pos('a') + 10;
      when 'A' to 'F' => return character'pos(char) - character'pos('A') + 10;
      when others => return -1;
    end case;
  end function;

  function byte_at (row : string; place : natural) return integer is
    constant at : positive := row'left + 2 * place;
  begin
    if digit(row(at)) < 0 or digit(row(at + 1)) < 0 then
      return -1;
    end if;
    return 16 * digit(row(at)) + digit(row(at + 1));
  end function;

  function hex (octet : natural range 0 to 255) return string is
    constant digits : string(1 to 16) := "0123456789abcdef";
  begin
    return digits(octet / 16 + 1) & digits(octet mod 16 + 1);
  end function;

  procedure count_packets (name : in string; count : out natural) is
    file packets : text;
    variable row : line;
    variable total : natural := 0;
  begin
    file_open(packets, name, read_mode);
    while not endfile(packets) loop
      readline(packets, row);
      if not is_comment(row.all) then
        total := total + 1;
      end if;
    end loop;
    file_close(packets);
    count := total;
  end procedure;

end package body firm_hdl_bench_pkg;
