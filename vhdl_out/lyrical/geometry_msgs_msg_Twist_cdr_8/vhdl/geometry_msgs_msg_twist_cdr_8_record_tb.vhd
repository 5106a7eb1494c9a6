-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Test bench of the converters of geometry_msgs/msg/Twist record, cdr, bus of 8 bytes. Simulation
-- only.
--
-- The bench ends by itself: it prints a line that starts with PASS, or ends with a failure.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use std.textio.all;

use work.firm_hdl_bench_pkg.all;
use work.firm_hdl_types_pkg.all;
use work.geometry_msgs_msg_twist_cdr_8_pkg;
use work.geometry_msgs_msg_twist_cdr_8_components_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_record_tb is
  generic (
    stimuli   : string  := "stimuli.txt";    -- packets to send, one per line, in hexadecimal
    expected  : string  := "stimuli.txt";    -- packets that must come out
    results   : string  := "results_record.txt";    -- packets that came out
    transfers : string  := "transfers_record.txt";  -- cycle, leaf and data of each leaf's transfer
    seed      : natural := 1;
    stalls    : natural range 0 to 99 := 40; -- percent of the cycles in which a stream stalls
    patience  : positive := 100_000          -- cycles without a beat after which the bench fails
  );
  port (
    over : out boolean := false  -- the bench has passed
  );
end entity;

architecture sim of geometry_msgs_msg_twist_cdr_8_record_tb is

  constant BUS_BYTES : positive := 8;
  constant LEAVES    : positive := 1;

  signal aclk    : std_logic := '0';
  signal aresetn : std_logic := '0';
  signal cycle   : natural := 0;

  signal i_tdata, o_tdata   : std_logic_vector(8 * BUS_BYTES - 1 downto 0);
  signal i_tkeep, o_tkeep   : std_logic_vector(BUS_BYTES - 1 downto 0);
  signal i_tlast, o_tlast   : std_logic;
  signal i_tvalid, o_tvalid : std_logic;
  signal i_tready, o_tready : std_logic;
  signal o_tuser            : std_logic;
  signal i_done             : boolean;
  signal i_packets          : natural;
  signal o_packets          : natural;
  signal o_bytes            : natural;
  signal o_total            : natural;

  signal rx_tdata, tx_tdata   : std_logic_vector(7 downto 0);
  signal rx_tvalid, tx_tvalid : std_logic;
  signal rx_tready, tx_tready : std_logic := '0';
  signal rx_count, tx_count   : natural := 0;

  -- One bit per leaf. gate: transfers may pass; offered: valid of the deserializer; taken: ready of
  -- the serializer.
  signal gate    : std_logic_vector(LEAVES - 1 downto 0) := (others => '1');
  signal offered : std_logic_vector(LEAVES - 1 downto 0);
  signal taken   : std_logic_vector(LEAVES - 1 downto 0);

  -- Message of the deserializer (rx) and of the serializer (tx).
  signal rx_msg, tx_msg     : work.geometry_msgs_msg_twist_cdr_8_pkg.twist_value_t;
  signal rx_valid, tx_valid : std_logic;
  signal rx_ready, tx_ready : std_logic;

begin

  source : entity work.firm_hdl_axis_source
    generic map (bus_bytes => BUS_BYTES, stimuli => stimuli, seed => seed, stalls => stalls)
    port map (
      aclk => aclk, aresetn => aresetn, tdata => i_tdata, tkeep => i_tkeep, tlast => i_tlast,
      tvalid => i_tvalid, tready => i_tready, packets => i_packets, done => i_done
    );

  sink : entity work.firm_hdl_axis_sink
    generic map (
      bus_bytes => BUS_BYTES, expected => expected, results => results, seed => seed,
      stalls => stalls
    )
    port map (
      aclk => aclk, aresetn => aresetn, tdata => o_tdata, tkeep => o_tkeep, tlast => o_tlast,
      tuser => o_tuser, tvalid => o_tvalid, tready => o_tready, packets => o_packets,
      bytes => o_bytes, total => o_total
    );

  rx : geometry_msgs_msg_twist_cdr_8_deserializer_record
    port map (
      aclk                 => aclk,
      aresetn              => aresetn,
      s_axis_tdata         => i_tdata,
      s_axis_tkeep         => i_tkeep,
      s_axis_tlast         => i_tlast,
      s_axis_tvalid        => i_tvalid,
      s_axis_tready        => i_tready,
      msg                  => rx_msg,
      msg_valid            => rx_valid,
      msg_ready            => rx_ready,
      m_axis_status_tdata  => rx_tdata,
      m_axis_status_tvalid => rx_tvalid,
      m_axis_status_tready => rx_tready
    );

  tx : geometry_msgs_msg_twist_cdr_8_serializer_record
    port map (
      aclk                 => aclk,
      aresetn              => aresetn,
      m_axis_tdata         => o_tdata,
      m_axis_tkeep         => o_tkeep,
      m_axis_tlast         => o_tlast,
      m_axis_tuser         => o_tuser,
      m_axis_tvalid        => o_tvalid,
      m_axis_tready        => o_tready,
      msg                  => tx_msg,
      msg_valid            => tx_valid,
      msg_ready            => tx_ready,
      m_axis_status_tdata  => tx_tdata,
      m_axis_status_tvalid => tx_tvalid,
      m_axis_status_tready => tx_tready
    );

  -- The accelerator passes all data on, with stalls.

  tx_msg <= rx_msg;
  tx_valid <= rx_valid and gate(0);
  rx_ready <= tx_ready and gate(0);
  offered(0) <= rx_valid;
  taken(0) <= tx_ready;

  -- A gate that is open stays open while an offered transfer is not yet taken.
  stalling : process
    variable random : random_t := random_from(seed, 3);
    variable stall : boolean;
  begin
    wait until rising_edge(aclk);
    for k in gate'range loop
      if offered(k) = '1' and (gate(k) = '0' or taken(k) = '1') then
        draw(random, stalls, stall);
        gate(k) <= '0' when stall else '1';
      end if;
    end loop;
  end process;

  -- The first item of a transfer is rightmost; an asterisk marks a transfer with last set.
  logging : process (aclk)
    file record_of : text open write_mode is transfers;

    procedure note (leaf : string; data : string; last : std_logic := '0') is
    begin
      write(record_of, integer'image(cycle) & " " & leaf & " " & data);
      if last = '1' then
        write(record_of, " *");
      end if;
      write(record_of, "" & LF);
    end procedure;
  begin
    if rising_edge(aclk) and aresetn = '1' then
      if (offered(0) and gate(0) and taken(0)) = '1' then
        note("msg", to_hstring(work.geometry_msgs_msg_twist_cdr_8_pkg.to_slv(rx_msg)));
      end if;
    end if;
  end process;

  aclk <= not aclk after 5 ns when not over;

  control : process
    variable random : random_t := random_from(seed, 4);
    variable stall : boolean;
    variable idle, first, final : natural := 0;
    variable started : boolean := false;

    procedure check (what : string; status : std_logic_vector(7 downto 0); number : natural) is
    begin
      assert status = STATUS_OK
        report "FAIL packet " & integer'image(number) & ": the " & what & " reports " &
          status_name(status)
        severity failure;
    end procedure;
  begin
    wait until rising_edge(aclk) and not over;
    cycle <= cycle + 1;
    if cycle = 3 then
      aresetn <= '1';
    end if;

    if (rx_tvalid and rx_tready) = '1' then
      check("deserializer", rx_tdata, rx_count);
      rx_count <= rx_count + 1;
    end if;
    draw(random, stalls, stall);
    rx_tready <= '0' when stall else '1';
    if (tx_tvalid and tx_tready) = '1' then
      check("serializer", tx_tdata, tx_count);
      tx_count <= tx_count + 1;
    end if;
    draw(random, stalls, stall);
    tx_tready <= '0' when stall else '1';

    idle := idle + 1;
    if (i_tvalid and i_tready) = '1' then
      idle := 0;
      if not started then
        first := cycle;
        started := true;
      end if;
    end if;
    if (o_tvalid and o_tready) = '1' then
      idle := 0;
      final := cycle;
    end if;
    assert idle < patience
      report "FAIL no beat in " & integer'image(patience) & " cycles: " &
        integer'image(o_packets) & " of " & integer'image(o_total) & " packets came out, " &
        integer'image(i_packets) & " went in, with " & integer'image(rx_count) & " and " &
        integer'image(tx_count) & " statuses"
      severity failure;

    -- Wait 100 more cycles for unexpected transfers.
    if i_done and o_packets = o_total and i_packets = o_total and rx_count = o_total and
        tx_count = o_total and idle > 100 then
      assert o_total > 0 report "FAIL there are no packets" severity failure;
      assert (o_tvalid or rx_tvalid or tx_tvalid or (or offered)) = '0'
        report "FAIL unexpected transfers after the last packet" severity failure;
      write(output,
        "PASS geometry_msgs/msg/Twist record, cdr, bus of 8 bytes: " &
        integer'image(o_packets) & " packets, " & integer'image(o_bytes) & " bytes, " &
        integer'image(final - first + 1) & " cycles" & LF);
      over <= true;
    end if;
  end process;

end architecture sim;  -- of geometry_msgs_msg_twist_cdr_8_record_tb
