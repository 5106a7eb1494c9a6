-- Sends the packets of a file, with random stalls, and compares each new speed of the motor with
-- another file: one speed per line, in hexadecimal.

library ieee;
use ieee.std_logic_1164.all;
use std.env.all;
use std.textio.all;

entity motor_tb is
  generic (
    packets : string  := "packets.txt";
    speeds  : string  := "speeds.txt";
    seed    : natural := 1
  );
end entity;

architecture sim of motor_tb is

  signal aclk, aresetn          : std_logic := '0';
  signal tdata                  : std_logic_vector(31 downto 0);
  signal tkeep                  : std_logic_vector(3 downto 0);
  signal tlast, tvalid, tready  : std_logic;
  signal speed                  : std_logic_vector(63 downto 0);
  signal sent                   : natural;
  signal all_sent               : boolean;

begin

  aclk <= not aclk after 5 ns;
  aresetn <= '1' after 22 ns;

  -- `firm-hdl build` writes this entity next to its own test benches.
  source : entity work.firm_hdl_axis_source
    generic map (bus_bytes => 4, stimuli => packets, seed => seed, stalls => 40)
    port map (
      aclk => aclk, aresetn => aresetn, tdata => tdata, tkeep => tkeep, tlast => tlast,
      tvalid => tvalid, tready => tready, packets => sent, done => all_sent
    );

  dut : entity work.motor
    port map (
      aclk => aclk, aresetn => aresetn, s_axis_tdata => tdata, s_axis_tkeep => tkeep,
      s_axis_tlast => tlast, s_axis_tvalid => tvalid, s_axis_tready => tready, speed => speed
    );

  watch : process
    file wanted : text open read_mode is speeds;
    variable row : line;
    variable want : std_logic_vector(63 downto 0);
    variable count : natural := 0;
  begin
    wait until rising_edge(aclk) and aresetn = '1';
    while not endfile(wanted) loop
      readline(wanted, row);
      hread(row, want);
      wait on speed for 10 us;
      assert speed = want
        report "FAIL after " & integer'image(sent) & " packets: the speed is " &
          to_hstring(speed) & " instead of " & to_hstring(want)
        severity failure;
      count := count + 1;
    end loop;
    wait until all_sent for 10 us;
    wait on speed for 1 us;
    assert all_sent and speed = want
      report "FAIL in the end the speed is " & to_hstring(speed) severity failure;
    write(output, "PASS " & integer'image(sent) & " packets, " & integer'image(count) &
      " speeds" & LF);
    finish;
  end process;

end architecture;
