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

    -- Lanes with tkeep = '0' carry random bytes, which the receiver has to ignore.
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
