-- Receives packets on AXI4-Stream with random stalls, writes them to a file, and compares each byte
-- with that of another file. Simulation only.

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

    -- tkeep is all ones except in the last beat, where it is a run of ones from lane 0. Only the
    -- last beat may have tuser set.

    procedure check_beat is
    begin
      for lane in 0 to bus_bytes - 1 loop
        assert tkeep(lane) = '1' or (tkeep(lane) = '0' and tlast = '1' and
            (place = 0 or lane > 0) and (lane = bus_bytes - 1 or tkeep(lane + 1) = '0'))
          report "FAIL packet " & integer'image(number) & ": tkeep is " & to_string(tkeep) &
            " with tlast " & to_string(tlast) & ", after " & integer'image(place) & " bytes"
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
