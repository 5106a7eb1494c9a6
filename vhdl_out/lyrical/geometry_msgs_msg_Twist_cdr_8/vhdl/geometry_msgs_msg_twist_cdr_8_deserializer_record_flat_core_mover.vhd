-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_twist_cdr_8_deserializer_record_flat.core.mover of the Amaranth design.
-- 25 registers at rising_edge(aclk), synchronous reset rst = '1'.
-- 11 registers at rising_edge(aclk), no reset.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_mover is
  port (
    rst                       : in  std_logic;
    aclk                      : in  std_logic;
    status_ready              : in  std_logic;
    orders_ready              : out std_logic;
    message_linear_x_ready    : in  std_logic;
    beat                      : in  unsigned(73 downto 0);
    orders_valid              : in  std_logic;
    orders_payload            : in  unsigned(41 downto 0);
    message_linear_x_valid    : out std_logic;
    message_linear_y_valid    : out std_logic;
    message_linear_z_valid    : out std_logic;
    message_angular_x_valid   : out std_logic;
    message_angular_y_valid   : out std_logic;
    message_angular_z_valid   : out std_logic;
    status_valid              : out std_logic;
    -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
    status_payload            : out unsigned(2 downto 0);
    message_linear_x_payload  : out unsigned(63 downto 0);
    message_linear_y_payload  : out unsigned(63 downto 0);
    message_linear_z_payload  : out unsigned(63 downto 0);
    message_angular_x_payload : out unsigned(63 downto 0);
    message_angular_y_payload : out unsigned(63 downto 0);
    message_angular_z_payload : out unsigned(63 downto 0)
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_mover is

  -- Registers.
  signal message_linear_x_valid_q    : std_logic := '0';
  signal message_linear_y_valid_q    : std_logic := '0';
  signal message_linear_z_valid_q    : std_logic := '0';
  signal message_angular_x_valid_q   : std_logic := '0';
  signal message_angular_y_valid_q   : std_logic := '0';
  signal message_angular_z_valid_q   : std_logic := '0';
  signal status_valid_q              : std_logic := '0';
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal status_payload_q            : unsigned(2 downto 0) := (others => '0');
  signal message_linear_x_payload_q  : unsigned(63 downto 0) := (others => '0');
  signal message_linear_y_payload_q  : unsigned(63 downto 0) := (others => '0');
  signal message_linear_z_payload_q  : unsigned(63 downto 0) := (others => '0');
  signal message_angular_x_payload_q : unsigned(63 downto 0) := (others => '0');
  signal message_angular_y_payload_q : unsigned(63 downto 0) := (others => '0');
  signal message_angular_z_payload_q : unsigned(63 downto 0) := (others => '0');
  signal items_word                  : unsigned(63 downto 0) := (others => '0');
  signal items_good                  : unsigned(7 downto 0) := (others => '0');
  signal map_word                    : unsigned(63 downto 0) := (others => '0');
  signal map_good                    : unsigned(7 downto 0) := (others => '0');
  signal length_good_now             : std_logic := '0';
  signal last_now                    : std_logic := '0';
  signal final_now                   : std_logic := '0';
  signal active_0                    : std_logic := '0';
  signal active_1                    : std_logic := '0';
  signal active_2                    : std_logic := '0';
  signal active_3                    : std_logic := '0';
  signal active_4                    : std_logic := '0';
  signal active_5                    : std_logic := '0';
  signal slow                        : std_logic := '0';
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal status_now                  : unsigned(2 downto 0) := (others => '0');
  signal ends_now                    : std_logic := '0';
  signal cut_0                       : std_logic := '0';
  signal carried                     : unsigned(31 downto 0) := (others => '0');
  signal cut_1                       : std_logic := '0';
  signal cut_2                       : std_logic := '0';
  signal cut_3                       : std_logic := '0';
  signal cut_4                       : std_logic := '0';

  -- Combinational signals.
  signal go_0              : std_logic;
  signal blocked_0         : std_logic;
  signal go_1              : std_logic;
  signal blocked_1         : std_logic;
  signal go_2              : std_logic;
  signal blocked_2         : std_logic;
  signal go_3              : std_logic;
  signal blocked_3         : std_logic;
  signal go_4              : std_logic;
  signal blocked_4         : std_logic;
  signal go_5              : std_logic;
  signal blocked_5         : std_logic;
  signal mux_44            : std_logic;
  signal mux_51            : std_logic;
  signal mux_58            : std_logic;
  signal mux_65            : std_logic;
  signal mux_72            : std_logic;
  signal mux_79            : std_logic;
  signal or_126            : std_logic;
  signal or_142            : std_logic;
  signal lane_0_items_data : unsigned(7 downto 0);
  signal lane_0_map_data   : unsigned(7 downto 0);
  signal lane_1_items_data : unsigned(7 downto 0);
  signal lane_1_map_data   : unsigned(7 downto 0);
  signal lane_2_items_data : unsigned(7 downto 0);
  signal lane_2_map_data   : unsigned(7 downto 0);
  signal lane_3_items_data : unsigned(7 downto 0);
  signal lane_3_map_data   : unsigned(7 downto 0);
  signal lane_4_items_data : unsigned(7 downto 0);
  signal lane_4_map_data   : unsigned(7 downto 0);
  signal lane_5_items_data : unsigned(7 downto 0);
  signal lane_5_map_data   : unsigned(7 downto 0);
  signal lane_6_items_data : unsigned(7 downto 0);
  signal lane_6_map_data   : unsigned(7 downto 0);
  signal lane_7_items_data : unsigned(7 downto 0);
  signal lane_7_map_data   : unsigned(7 downto 0);

  -- Signals that no logic reads, for simulation.
  signal take                    : std_logic;
  signal payload_0               : unsigned(63 downto 0);
  signal payload_1               : unsigned(63 downto 0);
  signal payload_2               : unsigned(63 downto 0);
  signal payload_3               : unsigned(63 downto 0);
  signal payload_4               : unsigned(63 downto 0);
  signal payload_5               : unsigned(63 downto 0);
  signal lane_0_write_addr       : unsigned(2 downto 0);
  signal lane_0_write_data       : unsigned(7 downto 0);
  signal lane_0_write_en         : std_logic;
  signal lane_0_items_addr       : unsigned(2 downto 0);
  signal lane_0_map_addr         : unsigned(2 downto 0);
  signal lane_1_write_addr       : unsigned(2 downto 0);
  signal lane_1_write_data       : unsigned(7 downto 0);
  signal lane_1_write_en         : std_logic;
  signal lane_1_items_addr       : unsigned(2 downto 0);
  signal lane_1_map_addr         : unsigned(2 downto 0);
  signal lane_2_write_addr       : unsigned(2 downto 0);
  signal lane_2_write_data       : unsigned(7 downto 0);
  signal lane_2_write_en         : std_logic;
  signal lane_2_items_addr       : unsigned(2 downto 0);
  signal lane_2_map_addr         : unsigned(2 downto 0);
  signal lane_3_write_addr       : unsigned(2 downto 0);
  signal lane_3_write_data       : unsigned(7 downto 0);
  signal lane_3_write_en         : std_logic;
  signal lane_3_items_addr       : unsigned(2 downto 0);
  signal lane_3_map_addr         : unsigned(2 downto 0);
  signal lane_4_write_addr       : unsigned(2 downto 0);
  signal lane_4_write_data       : unsigned(7 downto 0);
  signal lane_4_write_en         : std_logic;
  signal lane_4_items_addr       : unsigned(2 downto 0);
  signal lane_4_map_addr         : unsigned(2 downto 0);
  signal lane_5_write_addr       : unsigned(2 downto 0);
  signal lane_5_write_data       : unsigned(7 downto 0);
  signal lane_5_write_en         : std_logic;
  signal lane_5_items_addr       : unsigned(2 downto 0);
  signal lane_5_map_addr         : unsigned(2 downto 0);
  signal lane_6_write_addr       : unsigned(2 downto 0);
  signal lane_6_write_data       : unsigned(7 downto 0);
  signal lane_6_write_en         : std_logic;
  signal lane_6_items_addr       : unsigned(2 downto 0);
  signal lane_6_map_addr         : unsigned(2 downto 0);
  signal lane_7_write_addr       : unsigned(2 downto 0);
  signal lane_7_write_data       : unsigned(7 downto 0);
  signal lane_7_write_en         : std_logic;
  signal lane_7_items_addr       : unsigned(2 downto 0);
  signal lane_7_map_addr         : unsigned(2 downto 0);
  signal message_linear_y_ready  : std_logic;
  signal message_linear_z_ready  : std_logic;
  signal message_angular_x_ready : std_logic;
  signal message_angular_y_ready : std_logic;
  signal message_angular_z_ready : std_logic;

  type lane_0_array is array (0 to 7) of unsigned(7 downto 0);
  signal lane_0 : lane_0_array := (others => (others => '0'));

  type lane_1_array is array (0 to 7) of unsigned(7 downto 0);
  signal lane_1 : lane_1_array := (others => (others => '0'));

  type lane_2_array is array (0 to 7) of unsigned(7 downto 0);
  signal lane_2 : lane_2_array := (others => (others => '0'));

  type lane_3_array is array (0 to 7) of unsigned(7 downto 0);
  signal lane_3 : lane_3_array := (others => (others => '0'));

  type lane_4_array is array (0 to 7) of unsigned(7 downto 0);
  signal lane_4 : lane_4_array := (others => (others => '0'));

  type lane_5_array is array (0 to 7) of unsigned(7 downto 0);
  signal lane_5 : lane_5_array := (others => (others => '0'));

  type lane_6_array is array (0 to 7) of unsigned(7 downto 0);
  signal lane_6 : lane_6_array := (others => (others => '0'));

  type lane_7_array is array (0 to 7) of unsigned(7 downto 0);
  signal lane_7 : lane_7_array := (others => (others => '0'));
begin

  go_0 <= active_0 and not blocked_0;
  blocked_0 <= active_0 and message_linear_x_valid_q;
  go_1 <= active_1 and not blocked_1;
  blocked_1 <= active_1 and message_linear_y_valid_q;
  go_2 <= active_2 and not blocked_2;
  blocked_2 <= active_2 and message_linear_z_valid_q;
  go_3 <= active_3 and not blocked_3;
  blocked_3 <= active_3 and message_angular_x_valid_q;
  go_4 <= active_4 and not blocked_4;
  blocked_4 <= active_4 and message_angular_y_valid_q;
  go_5 <= active_5 and not blocked_5 and not blocked_4;
  blocked_5 <= active_5 and message_angular_z_valid_q;
  orders_ready <= not slow;
  mux_44 <= orders_valid and not orders_payload(3) and
      to_std_logic(orders_payload(2 downto 0) = 1) when orders_ready = '1' else active_0 and
      not go_0;
  mux_51 <= orders_valid and not orders_payload(3) and
      to_std_logic(orders_payload(2 downto 0) = 2) when orders_ready = '1' else active_1 and
      not go_1;
  mux_58 <= orders_valid and not orders_payload(3) and
      to_std_logic(orders_payload(2 downto 0) = 3) when orders_ready = '1' else active_2 and
      not go_2;
  mux_65 <= orders_valid and not orders_payload(3) and
      to_std_logic(orders_payload(2 downto 0) = 4) when orders_ready = '1' else active_3 and
      not go_3;
  mux_72 <= orders_valid and not orders_payload(3) and
      to_std_logic(orders_payload(2 downto 0) = 5) when orders_ready = '1' else active_4 and
      not go_4;
  mux_79 <= orders_valid and not orders_payload(3) and
      to_std_logic(orders_payload(2 downto 0) = 5) when orders_ready = '1' else active_5 and
      not go_5;
  or_126 <= or unsigned'((orders_valid and orders_payload(38) and status_valid_q and
      not status_ready) & (orders_valid and not orders_payload(3) and
      to_std_logic(orders_payload(2 downto 0) = 5) and message_angular_z_valid_q and
      not message_linear_x_ready) & (orders_valid and not orders_payload(3) and
      to_std_logic(orders_payload(2 downto 0) = 5) and message_angular_y_valid_q and
      not message_linear_x_ready) & (orders_valid and not orders_payload(3) and
      to_std_logic(orders_payload(2 downto 0) = 4) and message_angular_x_valid_q and
      not message_linear_x_ready) & (orders_valid and not orders_payload(3) and
      to_std_logic(orders_payload(2 downto 0) = 3) and message_linear_z_valid_q and
      not message_linear_x_ready) & (orders_valid and not orders_payload(3) and
      to_std_logic(orders_payload(2 downto 0) = 2) and message_linear_y_valid_q and
      not message_linear_x_ready) & (orders_valid and not orders_payload(3) and
      to_std_logic(orders_payload(2 downto 0) = 1) and message_linear_x_valid_q and
      not message_linear_x_ready));
  or_142 <= or unsigned'((ends_now and status_valid_q and not status_ready) & (blocked_5 and
      not message_linear_x_ready) & (blocked_4 and not message_linear_x_ready) & (blocked_3 and
      not message_linear_x_ready) & (blocked_2 and not message_linear_x_ready) & (blocked_1 and
      not message_linear_x_ready) & (blocked_0 and not message_linear_x_ready));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat(73) = '1' then
        lane_0(to_integer(beat(71 downto 69))) <= beat(7 downto 0);
      end if;
    end if;
  end process;

  lane_0_items_data <= lane_0(to_integer(orders_payload(9 downto 7)));

  lane_0_map_data <= lane_0(to_integer(orders_payload(15 downto 13)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat(73) = '1' then
        lane_1(to_integer(beat(71 downto 69))) <= beat(15 downto 8);
      end if;
    end if;
  end process;

  lane_1_items_data <= lane_1(to_integer(orders_payload(9 downto 7)));

  lane_1_map_data <= lane_1(to_integer(orders_payload(15 downto 13)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat(73) = '1' then
        lane_2(to_integer(beat(71 downto 69))) <= beat(23 downto 16);
      end if;
    end if;
  end process;

  lane_2_items_data <= lane_2(to_integer(orders_payload(9 downto 7)));

  lane_2_map_data <= lane_2(to_integer(orders_payload(15 downto 13)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat(73) = '1' then
        lane_3(to_integer(beat(71 downto 69))) <= beat(31 downto 24);
      end if;
    end if;
  end process;

  lane_3_items_data <= lane_3(to_integer(orders_payload(9 downto 7)));

  lane_3_map_data <= lane_3(to_integer(orders_payload(15 downto 13)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat(73) = '1' then
        lane_4(to_integer(beat(71 downto 69))) <= beat(39 downto 32);
      end if;
    end if;
  end process;

  lane_4_items_data <= lane_4(to_integer(orders_payload(9 downto 7)));

  lane_4_map_data <= lane_4(to_integer(orders_payload(15 downto 13)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat(73) = '1' then
        lane_5(to_integer(beat(71 downto 69))) <= beat(47 downto 40);
      end if;
    end if;
  end process;

  lane_5_items_data <= lane_5(to_integer(orders_payload(9 downto 7)));

  lane_5_map_data <= lane_5(to_integer(orders_payload(15 downto 13)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat(73) = '1' then
        lane_6(to_integer(beat(71 downto 69))) <= beat(55 downto 48);
      end if;
    end if;
  end process;

  lane_6_items_data <= lane_6(to_integer(orders_payload(9 downto 7)));

  lane_6_map_data <= lane_6(to_integer(orders_payload(15 downto 13)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat(73) = '1' then
        lane_7(to_integer(beat(71 downto 69))) <= beat(63 downto 56);
      end if;
    end if;
  end process;

  lane_7_items_data <= lane_7(to_integer(orders_payload(9 downto 7)));

  lane_7_map_data <= lane_7(to_integer(orders_payload(15 downto 13)));

  p_aclk : process (aclk)
  begin
    if rising_edge(aclk) then
      if rst = '1' then
        message_linear_x_valid_q <= '0';
        message_linear_y_valid_q <= '0';
        message_linear_z_valid_q <= '0';
        message_angular_x_valid_q <= '0';
        message_angular_y_valid_q <= '0';
        message_angular_z_valid_q <= '0';
        status_valid_q <= '0';
        length_good_now <= '0';
        last_now <= '0';
        final_now <= '0';
        active_0 <= '0';
        active_1 <= '0';
        active_2 <= '0';
        active_3 <= '0';
        active_4 <= '0';
        active_5 <= '0';
        slow <= '0';
        status_now <= (others => '0');
        ends_now <= '0';
        status_payload_q <= (others => '0');
        cut_0 <= '0';
        cut_1 <= '0';
        cut_2 <= '0';
        cut_3 <= '0';
        cut_4 <= '0';
      else
        if message_linear_x_ready = '1' then
          message_linear_x_valid_q <= '0';
          message_linear_y_valid_q <= '0';
          message_linear_z_valid_q <= '0';
          message_angular_x_valid_q <= '0';
          message_angular_y_valid_q <= '0';
          message_angular_z_valid_q <= '0';
        end if;
        if go_0 = '1' then
          message_linear_x_valid_q <= '1';
        end if;
        if go_1 = '1' then
          message_linear_y_valid_q <= '1';
        end if;
        if go_2 = '1' then
          message_linear_z_valid_q <= '1';
        end if;
        if go_3 = '1' then
          message_angular_x_valid_q <= '1';
        end if;
        if go_4 = '1' then
          message_angular_y_valid_q <= '1';
        end if;
        if go_5 = '1' then
          message_angular_z_valid_q <= '1';
        end if;
        if status_ready = '1' then
          status_valid_q <= '0';
        end if;
        if orders_ready = '1' then
          if ends_now = '1' then
            status_valid_q <= '1';
            status_payload_q <= status_now;
          end if;
          length_good_now <= orders_payload(32);
          last_now <= orders_payload(31);
          final_now <= orders_payload(33);
          status_now <= orders_payload(41 downto 39);
          ends_now <= orders_valid and orders_payload(38);
          cut_0 <= orders_valid and not orders_payload(3) and
              to_std_logic(orders_payload(2 downto 0) = 0);
          cut_1 <= orders_valid and not orders_payload(3) and
              to_std_logic(orders_payload(2 downto 0) = 1);
          cut_2 <= orders_valid and not orders_payload(3) and
              to_std_logic(orders_payload(2 downto 0) = 2);
          cut_3 <= orders_valid and not orders_payload(3) and
              to_std_logic(orders_payload(2 downto 0) = 3);
          cut_4 <= orders_valid and not orders_payload(3) and
              to_std_logic(orders_payload(2 downto 0) = 4);
        end if;
        active_0 <= mux_44;
        active_1 <= mux_51;
        active_2 <= mux_58;
        active_3 <= mux_65;
        active_4 <= mux_72;
        active_5 <= mux_79;
        if orders_ready = '1' then
          slow <= or_126;
        else
          slow <= or_142;
        end if;
      end if;
    end if;
  end process;

  p_aclk_2 : process (aclk)
  begin
    if rising_edge(aclk) then
      if orders_ready = '1' then
        items_word <= lane_7_items_data & lane_6_items_data & lane_5_items_data &
            lane_4_items_data & lane_3_items_data & lane_2_items_data & lane_1_items_data &
            lane_0_items_data;
        items_good <= to_std_logic(orders_payload(25 downto 22) > 7) &
            to_std_logic(orders_payload(25 downto 22) > 6) &
            to_std_logic(orders_payload(25 downto 22) > 5) &
            to_std_logic(orders_payload(25 downto 22) > 4) &
            to_std_logic(orders_payload(25 downto 22) > 3) &
            to_std_logic(orders_payload(25 downto 22) > 2) &
            to_std_logic(orders_payload(25 downto 22) > 1) &
            to_std_logic(orders_payload(25 downto 22) > 0);
        map_word <= lane_7_map_data & lane_6_map_data & lane_5_map_data & lane_4_map_data &
            lane_3_map_data & lane_2_map_data & lane_1_map_data & lane_0_map_data;
        map_good <= to_std_logic(orders_payload(29 downto 26) > 7) &
            to_std_logic(orders_payload(29 downto 26) > 6) &
            to_std_logic(orders_payload(29 downto 26) > 5) &
            to_std_logic(orders_payload(29 downto 26) > 4) &
            to_std_logic(orders_payload(29 downto 26) > 3) &
            to_std_logic(orders_payload(29 downto 26) > 2) &
            to_std_logic(orders_payload(29 downto 26) > 1) &
            to_std_logic(orders_payload(29 downto 26) > 0);
      end if;
      if orders_ready = '1' and cut_0 = '1' then
        carried(7 downto 0) <= map_word(39 downto 32);
      end if;
      if orders_ready = '1' and cut_0 = '1' then
        carried(15 downto 8) <= map_word(47 downto 40);
      end if;
      if orders_ready = '1' and cut_0 = '1' then
        carried(23 downto 16) <= map_word(55 downto 48);
      end if;
      if orders_ready = '1' and cut_0 = '1' then
        carried(31 downto 24) <= map_word(63 downto 56);
      end if;
      if orders_ready = '1' and cut_1 = '1' then
        carried(7 downto 0) <= map_word(39 downto 32);
      end if;
      if orders_ready = '1' and cut_1 = '1' then
        carried(15 downto 8) <= map_word(47 downto 40);
      end if;
      if orders_ready = '1' and cut_1 = '1' then
        carried(23 downto 16) <= map_word(55 downto 48);
      end if;
      if orders_ready = '1' and cut_1 = '1' then
        carried(31 downto 24) <= map_word(63 downto 56);
      end if;
      if orders_ready = '1' and cut_2 = '1' then
        carried(7 downto 0) <= map_word(39 downto 32);
      end if;
      if orders_ready = '1' and cut_2 = '1' then
        carried(15 downto 8) <= map_word(47 downto 40);
      end if;
      if orders_ready = '1' and cut_2 = '1' then
        carried(23 downto 16) <= map_word(55 downto 48);
      end if;
      if orders_ready = '1' and cut_2 = '1' then
        carried(31 downto 24) <= map_word(63 downto 56);
      end if;
      if orders_ready = '1' and cut_3 = '1' then
        carried(7 downto 0) <= map_word(39 downto 32);
      end if;
      if orders_ready = '1' and cut_3 = '1' then
        carried(15 downto 8) <= map_word(47 downto 40);
      end if;
      if orders_ready = '1' and cut_3 = '1' then
        carried(23 downto 16) <= map_word(55 downto 48);
      end if;
      if orders_ready = '1' and cut_3 = '1' then
        carried(31 downto 24) <= map_word(63 downto 56);
      end if;
      if orders_ready = '1' and cut_4 = '1' then
        carried(7 downto 0) <= map_word(39 downto 32);
      end if;
      if orders_ready = '1' and cut_4 = '1' then
        carried(15 downto 8) <= map_word(47 downto 40);
      end if;
      if orders_ready = '1' and cut_4 = '1' then
        carried(23 downto 16) <= map_word(55 downto 48);
      end if;
      if orders_ready = '1' and cut_4 = '1' then
        carried(31 downto 24) <= map_word(63 downto 56);
      end if;
      if go_0 = '1' then
        if map_good(3) = '1' then
          message_linear_x_payload_q <= map_word(31 downto 0) & carried;
        else
          message_linear_x_payload_q <= (others => '0');
        end if;
      end if;
      if go_1 = '1' then
        if map_good(3) = '1' then
          message_linear_y_payload_q <= map_word(31 downto 0) & carried;
        else
          message_linear_y_payload_q <= (others => '0');
        end if;
      end if;
      if go_2 = '1' then
        if map_good(3) = '1' then
          message_linear_z_payload_q <= map_word(31 downto 0) & carried;
        else
          message_linear_z_payload_q <= (others => '0');
        end if;
      end if;
      if go_3 = '1' then
        if map_good(3) = '1' then
          message_angular_x_payload_q <= map_word(31 downto 0) & carried;
        else
          message_angular_x_payload_q <= (others => '0');
        end if;
      end if;
      if go_4 = '1' then
        if items_good(3) = '1' then
          message_angular_y_payload_q <= items_word(31 downto 0) & carried;
        else
          message_angular_y_payload_q <= (others => '0');
        end if;
      end if;
      if go_5 = '1' then
        if map_good(3) = '1' then
          message_angular_z_payload_q <= map_word(31 downto 0) & items_word(63 downto 32);
        else
          message_angular_z_payload_q <= (others => '0');
        end if;
      end if;
    end if;
  end process;

  message_linear_x_valid <= message_linear_x_valid_q;
  message_linear_y_valid <= message_linear_y_valid_q;
  message_linear_z_valid <= message_linear_z_valid_q;
  message_angular_x_valid <= message_angular_x_valid_q;
  message_angular_y_valid <= message_angular_y_valid_q;
  message_angular_z_valid <= message_angular_z_valid_q;
  status_valid <= status_valid_q;
  status_payload <= status_payload_q;
  message_linear_x_payload <= message_linear_x_payload_q;
  message_linear_y_payload <= message_linear_y_payload_q;
  message_linear_z_payload <= message_linear_z_payload_q;
  message_angular_x_payload <= message_angular_x_payload_q;
  message_angular_y_payload <= message_angular_y_payload_q;
  message_angular_z_payload <= message_angular_z_payload_q;

  take <= orders_ready;
  payload_0 <= message_linear_x_payload_q;
  payload_1 <= message_linear_y_payload_q;
  payload_2 <= message_linear_z_payload_q;
  payload_3 <= message_angular_x_payload_q;
  payload_4 <= message_angular_y_payload_q;
  payload_5 <= message_angular_z_payload_q;
  lane_0_write_addr <= beat(71 downto 69);
  lane_0_write_data <= beat(7 downto 0);
  lane_0_write_en <= beat(73);
  lane_0_items_addr <= orders_payload(9 downto 7);
  lane_0_map_addr <= orders_payload(15 downto 13);
  lane_1_write_addr <= beat(71 downto 69);
  lane_1_write_data <= beat(15 downto 8);
  lane_1_write_en <= beat(73);
  lane_1_items_addr <= orders_payload(9 downto 7);
  lane_1_map_addr <= orders_payload(15 downto 13);
  lane_2_write_addr <= beat(71 downto 69);
  lane_2_write_data <= beat(23 downto 16);
  lane_2_write_en <= beat(73);
  lane_2_items_addr <= orders_payload(9 downto 7);
  lane_2_map_addr <= orders_payload(15 downto 13);
  lane_3_write_addr <= beat(71 downto 69);
  lane_3_write_data <= beat(31 downto 24);
  lane_3_write_en <= beat(73);
  lane_3_items_addr <= orders_payload(9 downto 7);
  lane_3_map_addr <= orders_payload(15 downto 13);
  lane_4_write_addr <= beat(71 downto 69);
  lane_4_write_data <= beat(39 downto 32);
  lane_4_write_en <= beat(73);
  lane_4_items_addr <= orders_payload(9 downto 7);
  lane_4_map_addr <= orders_payload(15 downto 13);
  lane_5_write_addr <= beat(71 downto 69);
  lane_5_write_data <= beat(47 downto 40);
  lane_5_write_en <= beat(73);
  lane_5_items_addr <= orders_payload(9 downto 7);
  lane_5_map_addr <= orders_payload(15 downto 13);
  lane_6_write_addr <= beat(71 downto 69);
  lane_6_write_data <= beat(55 downto 48);
  lane_6_write_en <= beat(73);
  lane_6_items_addr <= orders_payload(9 downto 7);
  lane_6_map_addr <= orders_payload(15 downto 13);
  lane_7_write_addr <= beat(71 downto 69);
  lane_7_write_data <= beat(63 downto 56);
  lane_7_write_en <= beat(73);
  lane_7_items_addr <= orders_payload(9 downto 7);
  lane_7_map_addr <= orders_payload(15 downto 13);
  message_linear_y_ready <= message_linear_x_ready;
  message_linear_z_ready <= message_linear_x_ready;
  message_angular_x_ready <= message_linear_x_ready;
  message_angular_y_ready <= message_linear_x_ready;
  message_angular_z_ready <= message_linear_x_ready;

end architecture;
