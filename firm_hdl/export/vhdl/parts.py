"""What all test benches share, in VHDL: a source and a sink of packets that stall at random.

Packets are in text files, one a line, their bytes in hexadecimal in the order of the wire; an empty
line is an empty packet, and lines that start with ``#`` are comments. Simulation only.
"""

from __future__ import annotations

__all__ = ["PARTS", "packets_text"]

_PACKAGE = """\
-- Helpers of the test benches. Simulation only.

library ieee;
use ieee.math_real.all;
use std.textio.all;

package firm_hdl_bench_pkg is

  -- The state of a random generator, never the same for two numbers.
  type random_t is record
    first  : positive;
    second : positive;
  end record;

  function random_from (seed : natural; number : natural) return random_t;

  -- Draw whether something happens that does so in some percent of all cases.
  procedure draw (variable random : inout random_t; percent : in natural; happens : out boolean);

  -- Draw a byte.
  procedure draw (variable random : inout random_t; octet : out natural);

  -- A line with a packet; a file may have been written on Windows.
  function packet_bytes (row : in string) return natural;
  function is_comment (row : string) return boolean;

  -- The byte at some place of a line with a packet; -1 if it is not hexadecimal.
  function byte_at (row : string; place : natural) return integer;

  -- A byte as two hexadecimal digits.
  function hex (octet : natural range 0 to 255) return string;

  procedure count_packets (name : in string; count : out natural);

end package firm_hdl_bench_pkg;

package body firm_hdl_bench_pkg is

  function random_from (seed : natural; number : natural) return random_t is
  begin
    -- What `uniform` takes: 1 to 2147483562 and 1 to 2147483398.
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
"""

_SOURCE = """\
-- Sends the packets of a file on AXI4-Stream, with random stalls. Simulation only.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use std.textio.all;

use work.firm_hdl_bench_pkg.all;

entity firm_hdl_axis_source is
  generic (
    bus_bytes : positive;
    stimuli   : string;
    seed      : natural;
    stalls    : natural range 0 to 99  -- percent
  );
  port (
    aclk    : in  std_logic;
    aresetn : in  std_logic;
    tdata   : out std_logic_vector(8 * bus_bytes - 1 downto 0) := (others => '0');
    tkeep   : out std_logic_vector(bus_bytes - 1 downto 0) := (others => '0');
    tlast   : out std_logic := '0';
    tvalid  : out std_logic := '0';
    tready  : in  std_logic;
    packets : out natural := 0;
    done    : out boolean := false
  );
end entity;

architecture sim of firm_hdl_axis_source is
begin

  sending : process
    file source : text;
    variable row : line;
    variable random : random_t := random_from(seed, 1);
    variable unkept : random_t := random_from(seed, 5);
    variable stall : boolean;
    variable size, place, sent : natural := 0;

    -- Lanes that are not kept carry noise, which nobody may look at.
    procedure offer is
      variable octet : integer;
    begin
      for lane in 0 to bus_bytes - 1 loop
        if place + lane >= size then
          draw(unkept, octet);
        else
          octet := byte_at(row.all, place + lane);
          assert octet >= 0
            report "FAIL packet " & integer'image(sent) & " of the stimuli is not hexadecimal"
            severity failure;
        end if;
        tdata(8 * lane + 7 downto 8 * lane) <= std_logic_vector(to_unsigned(octet, 8));
        tkeep(lane) <= '1' when place + lane < size else '0';
      end loop;
      tlast <= '1' when place + bus_bytes >= size else '0';
      tvalid <= '1';
    end procedure;
  begin
    file_open(source, stimuli, read_mode);
    wait until rising_edge(aclk) and aresetn = '1';
    while not endfile(source) loop
      readline(source, row);
      next when is_comment(row.all);
      size := packet_bytes(row.all);
      place := 0;
      loop
        draw(random, stalls, stall);
        while stall loop
          wait until rising_edge(aclk);
          draw(random, stalls, stall);
        end loop;
        offer;
        wait until rising_edge(aclk) and tready = '1';
        tvalid <= '0';
        place := place + bus_bytes;
        exit when place >= size;
      end loop;
      sent := sent + 1;
      packets <= sent;
    end loop;
    done <= true;
    wait;
  end process;

end architecture;
"""

_SINK = """\
-- Takes packets on AXI4-Stream with random stalls, writes them to a file, and compares each byte
-- with another. Simulation only.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use std.textio.all;

use work.firm_hdl_bench_pkg.all;

entity firm_hdl_axis_sink is
  generic (
    bus_bytes : positive;
    expected  : string;
    results   : string;
    seed      : natural;
    stalls    : natural range 0 to 99  -- percent
  );
  port (
    aclk    : in  std_logic;
    aresetn : in  std_logic;
    tdata   : in  std_logic_vector(8 * bus_bytes - 1 downto 0);
    tkeep   : in  std_logic_vector(bus_bytes - 1 downto 0);
    tlast   : in  std_logic;
    tuser   : in  std_logic;
    tvalid  : in  std_logic;
    tready  : out std_logic := '0';
    packets : out natural := 0;
    bytes   : out natural := 0;
    total   : out natural := 0
  );
end entity;

architecture sim of firm_hdl_axis_sink is
begin

  taking : process
    file wanted : text;
    file seen   : text;
    variable row : line;
    variable random : random_t := random_from(seed, 2);
    variable stall, comment : boolean;
    variable count, place, all_bytes, number : natural := 0;

    -- Bytes are kept from lane 0 on, in all lanes but of the last beat, which alone may be marked.
    procedure check_beat is
    begin
      for lane in 0 to bus_bytes - 1 loop
        assert tkeep(lane) = '1' or (tkeep(lane) = '0' and tlast = '1' and
            (place = 0 or lane > 0) and (lane = bus_bytes - 1 or tkeep(lane + 1) = '0'))
          report "FAIL packet " & integer'image(number) & ": tkeep is " & to_string(tkeep) &
            " with tlast " & to_string(tlast) & ", behind " & integer'image(place) & " bytes"
          severity failure;
      end loop;
      assert (tlast = '0' and tuser = '0') or tlast = '1'
        report "FAIL packet " & integer'image(number) & ": tuser is " & to_string(tuser) &
          " with tlast " & to_string(tlast)
        severity failure;
    end procedure;

    procedure begin_packet is
    begin
      comment := true;
      while comment loop
        assert not endfile(wanted)
          report "FAIL packet " & integer'image(number) & ": no such packet is expected"
          severity failure;
        readline(wanted, row);
        comment := is_comment(row.all);
      end loop;
      place := 0;
    end procedure;

    procedure check (octet : std_logic_vector(7 downto 0)) is
      variable got : natural;
    begin
      assert not is_x(octet) and place < packet_bytes(row.all)
        report "FAIL packet " & integer'image(number) & ": byte " & integer'image(place) & " is " &
          to_string(octet) & ", and " & integer'image(packet_bytes(row.all)) & " are expected"
        severity failure;
      got := to_integer(unsigned(octet));
      write(seen, hex(got));
      assert got = byte_at(row.all, place)
        report "FAIL packet " & integer'image(number) & ": byte " & integer'image(place) & " is " &
          hex(got) & " instead of " & row.all(row'left + 2 * place to row'left + 2 * place + 1)
        severity failure;
      place := place + 1;
      all_bytes := all_bytes + 1;
    end procedure;

    procedure end_packet is
    begin
      write(seen, "" & LF);
      assert place = packet_bytes(row.all)
        report "FAIL packet " & integer'image(number) & " has " & integer'image(place) &
          " bytes instead of " & integer'image(packet_bytes(row.all))
        severity failure;
      assert tuser = '0'
        report "FAIL packet " & integer'image(number) & " is marked by tuser" severity failure;
      number := number + 1;
      packets <= number;
      bytes <= all_bytes;
    end procedure;
  begin
    count_packets(expected, count);
    total <= count;
    file_open(wanted, expected, read_mode);
    file_open(seen, results, write_mode);
    wait until rising_edge(aclk) and aresetn = '1';
    loop
      loop
        draw(random, stalls, stall);
        exit when not stall;
        wait until rising_edge(aclk);
      end loop;
      tready <= '1';
      wait until rising_edge(aclk) and tvalid = '1';
      tready <= '0';
      if place = 0 then
        begin_packet;
      end if;
      check_beat;
      for lane in 0 to bus_bytes - 1 loop
        if tkeep(lane) = '1' then
          check(tdata(8 * lane + 7 downto 8 * lane));
        end if;
      end loop;
      if tlast = '1' then
        end_packet;
        place := 0;
      end if;
    end loop;
  end process;

end architecture;
"""

PARTS = {
    "firm_hdl_bench_pkg.vhd": _PACKAGE,
    "firm_hdl_axis_source.vhd": _SOURCE,
    "firm_hdl_axis_sink.vhd": _SINK,
}
"""Texts by file name, in compile order."""


def packets_text(packets: list[bytes], remark: str = "") -> str:
    """Write packets as the source and the sink read them.

    >>> packets_text([b"\\x00\\x1f", b""], "Two packets.")
    '# Two packets.\\n001f\\n\\n'
    """
    head = "".join(f"# {line}\n" for line in remark.splitlines())
    return head + "".join(f"{packet.hex()}\n" for packet in packets)
