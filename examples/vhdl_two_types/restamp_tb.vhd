-- Sends scans and clouds from two files, with random stalls, and compares the packets that come out
-- with a third file, byte by byte.

library ieee;
use ieee.std_logic_1164.all;
use std.env.all;
use std.textio.all;

entity restamp_tb is
  generic (
    folder : string  := ".";
    seed   : natural := 1
  );
end entity;

architecture sim of restamp_tb is

  signal aclk, aresetn : std_logic := '0';

  subtype data_t is std_logic_vector(31 downto 0);
  subtype keep_t is std_logic_vector(3 downto 0);
  signal scan_tdata, cloud_tdata, made_tdata    : data_t;
  signal scan_tkeep, cloud_tkeep, made_tkeep    : keep_t;
  signal scan_tlast, cloud_tlast, made_tlast    : std_logic;
  signal scan_tvalid, cloud_tvalid, made_tvalid : std_logic;
  signal scan_tready, cloud_tready, made_tready : std_logic;
  signal scans, clouds, came, bytes, total      : natural;
  signal scans_sent, clouds_sent                : boolean;

begin

  aclk <= not aclk after 5 ns;
  aresetn <= '1' after 22 ns;

  -- `firm-hdl build` writes these entities next to its own test benches. The sink fails at a packet
  -- that it does not expect.
  scan_source : entity work.firm_hdl_axis_source
    generic map (bus_bytes => 4, stimuli => folder & "/scans.txt", seed => seed, stalls => 40)
    port map (
      aclk => aclk, aresetn => aresetn, tdata => scan_tdata, tkeep => scan_tkeep,
      tlast => scan_tlast, tvalid => scan_tvalid, tready => scan_tready, packets => scans,
      done => scans_sent
    );

  cloud_source : entity work.firm_hdl_axis_source
    generic map (bus_bytes => 4, stimuli => folder & "/clouds.txt", seed => seed + 1, stalls => 20)
    port map (
      aclk => aclk, aresetn => aresetn, tdata => cloud_tdata, tkeep => cloud_tkeep,
      tlast => cloud_tlast, tvalid => cloud_tvalid, tready => cloud_tready, packets => clouds,
      done => clouds_sent
    );

  sink : entity work.firm_hdl_axis_sink
    generic map (
      bus_bytes => 4, expected => folder & "/expected.txt", results => folder & "/results.txt",
      seed => seed, stalls => 60
    )
    port map (
      aclk => aclk, aresetn => aresetn, tdata => made_tdata, tkeep => made_tkeep,
      tlast => made_tlast, tuser => '0', tvalid => made_tvalid, tready => made_tready,
      packets => came, bytes => bytes, total => total
    );

  dut : entity work.restamp
    port map (
      aclk => aclk, aresetn => aresetn,
      scan_tdata => scan_tdata, scan_tkeep => scan_tkeep, scan_tlast => scan_tlast,
      scan_tvalid => scan_tvalid, scan_tready => scan_tready,
      cloud_tdata => cloud_tdata, cloud_tkeep => cloud_tkeep, cloud_tlast => cloud_tlast,
      cloud_tvalid => cloud_tvalid, cloud_tready => cloud_tready,
      m_axis_tdata => made_tdata, m_axis_tkeep => made_tkeep, m_axis_tlast => made_tlast,
      m_axis_tvalid => made_tvalid, m_axis_tready => made_tready
    );

  watch : process
  begin
    wait until scans_sent and clouds_sent for 200 us;
    -- Wait 20 us more, in case that an unexpected packet comes.

    wait for 20 us;
    assert scans_sent and clouds_sent and came = total
      report "FAIL " & integer'image(scans) & " scans and " & integer'image(clouds) &
        " clouds went in, and " & integer'image(came) & " of " & integer'image(total) &
        " packets came out"
      severity failure;
    write(output, "PASS " & integer'image(scans) & " scans and clouds, " & integer'image(came) &
      " clouds with new headers" & LF);
    finish;
  end process;

end architecture;
