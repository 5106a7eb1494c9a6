-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_twist_cdr_8_serializer_flat.core of the Amaranth design.
-- 17 registers at rising_edge(aclk), synchronous reset rst = '1'.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_serializer_flat_core is
  port (
    rst                       : in  std_logic;
    aclk                      : in  std_logic;
    packets_ready             : in  std_logic;
    message_linear_x_payload  : in  unsigned(63 downto 0);
    message_linear_x_valid    : in  std_logic;
    message_linear_y_payload  : in  unsigned(63 downto 0);
    message_linear_y_valid    : in  std_logic;
    message_linear_z_payload  : in  unsigned(63 downto 0);
    message_linear_z_valid    : in  std_logic;
    message_angular_x_payload : in  unsigned(63 downto 0);
    message_angular_x_valid   : in  std_logic;
    message_angular_y_payload : in  unsigned(63 downto 0);
    message_angular_y_valid   : in  std_logic;
    message_angular_z_payload : in  unsigned(63 downto 0);
    message_angular_z_valid   : in  std_logic;
    status_ready              : in  std_logic;
    packets_valid             : out std_logic;
    packet_error              : out std_logic;
    message_linear_x_ready    : out std_logic;
    message_linear_y_ready    : out std_logic;
    message_linear_z_ready    : out std_logic;
    message_angular_x_ready   : out std_logic;
    message_angular_y_ready   : out std_logic;
    message_angular_z_ready   : out std_logic;
    status_valid              : out std_logic;
    -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
    status_payload            : out unsigned(2 downto 0);
    packets_payload           : out unsigned(68 downto 0)
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_serializer_flat_core is

  -- Registers.
  signal status_valid_q   : std_logic := '0';
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal status_payload_q : unsigned(2 downto 0) := (others => '0');
  signal served_0         : std_logic := '0';
  signal served_1         : std_logic := '0';
  signal full             : std_logic := '0';
  signal led              : std_logic := '0';
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal error_81         : unsigned(2 downto 0) := (others => '0');
  signal lane_0           : unsigned(7 downto 0) := (others => '0');
  signal lane_1           : unsigned(7 downto 0) := (others => '0');
  signal lane_2           : unsigned(7 downto 0) := (others => '0');
  signal lane_3           : unsigned(7 downto 0) := (others => '0');
  signal lane_4           : unsigned(7 downto 0) := (others => '0');
  signal lane_5           : unsigned(7 downto 0) := (others => '0');
  signal lane_6           : unsigned(7 downto 0) := (others => '0');
  signal lane_7           : unsigned(7 downto 0) := (others => '0');
  signal word             : unsigned(72 downto 0) := (others => '0');
  signal step             : unsigned(2 downto 0) := (others => '0');

  -- Combinational signals.
  signal word_ready  : std_logic;
  signal go_0        : std_logic;
  signal reached_0   : std_logic;
  signal go_1        : std_logic;
  signal reached_1   : std_logic;
  signal fresh       : std_logic;
  signal word_valid  : std_logic;
  signal writable    : std_logic;
  signal complete    : std_logic;
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal error_80    : unsigned(2 downto 0);
  signal next_lane_0 : unsigned(7 downto 0);
  signal next_lane_1 : unsigned(7 downto 0);
  signal next_lane_2 : unsigned(7 downto 0);
  signal next_lane_3 : unsigned(7 downto 0);
  signal next_lane_4 : unsigned(7 downto 0);
  signal next_lane_5 : unsigned(7 downto 0);
  signal next_lane_6 : unsigned(7 downto 0);
  signal next_lane_7 : unsigned(7 downto 0);
  signal able_0      : std_logic;
  signal base        : unsigned(3 downto 0);
  signal done        : std_logic;
  signal next_step   : unsigned(2 downto 0);
  signal able_1      : std_logic;
  signal ends        : std_logic;

  -- Signals that no logic reads, for simulation.
  signal error_sig    : std_logic;
  signal small_sig    : unsigned(3 downto 0);
  signal left         : std_logic;
  signal most_items   : unsigned(3 downto 0);
  signal allowed      : std_logic;
  signal terminated   : std_logic;
  signal running      : std_logic;
  signal unit_log2    : unsigned(2 downto 0);
  signal all_served   : std_logic;
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal raised       : unsigned(2 downto 0);
  signal leads        : std_logic;
  signal final_sig    : std_logic;
  signal has_items    : std_logic;
  signal align        : unsigned(2 downto 0);
  signal run_bytes    : unsigned(3 downto 0);
  signal last_items   : std_logic;
  signal lane_used    : unsigned(7 downto 0);
  signal word_payload : unsigned(72 downto 0);
begin

  packer : entity work.geometry_msgs_msg_twist_cdr_8_serializer_flat_core_packer
    port map (
      aclk                       => aclk,
      packets_ready              => packets_ready,
      rst                        => rst,
      word_valid                 => word_valid,
      packets_valid              => packets_valid,
      error_sig                  => packet_error,
      word_ready                 => word_ready,
      word_payload(7 downto 0)   => lane_0,
      word_payload(15 downto 8)  => lane_1,
      word_payload(23 downto 16) => lane_2,
      word_payload(31 downto 24) => lane_3,
      word_payload(39 downto 32) => lane_4,
      word_payload(47 downto 40) => lane_5,
      word_payload(55 downto 48) => lane_6,
      word_payload(63 downto 56) => lane_7,
      word_payload(72 downto 64) => word(72 downto 64),
      packets_payload            => packets_payload
    );

  go_0 <= writable and not served_0 and able_0;
  reached_0 <= served_0 or able_0;
  go_1 <= writable and not served_1 and reached_0 and able_1;
  reached_1 <= reached_0 and (served_1 or able_1);
  fresh <= not served_0;
  word_valid <= full and (not led or message_linear_x_valid);
  writable <= not full or (word_valid and word_ready);
  complete <= writable and reached_1 and (not ends or not status_valid_q or status_ready);
  error_80 <= (others => '0') when error_81 = 0 else error_81;

  p_next_lane_0 : process (all)
  begin
    if fresh = '1' then
      next_lane_0 <= (others => '0');
    else
      next_lane_0 <= lane_0;
    end if;
    case step is
      when "000" =>
        next_lane_0 <= (others => '0');
      when "001" =>
        if go_0 = '1' then
          next_lane_0 <= message_linear_x_payload(39 downto 32);
        end if;
      when "010" =>
        if go_0 = '1' then
          next_lane_0 <= message_linear_y_payload(39 downto 32);
        end if;
      when "011" =>
        if go_0 = '1' then
          next_lane_0 <= message_linear_z_payload(39 downto 32);
        end if;
      when "100" =>
        if go_0 = '1' then
          next_lane_0 <= message_angular_x_payload(39 downto 32);
        end if;
      when "101" =>
        if go_0 = '1' then
          next_lane_0 <= message_angular_y_payload(39 downto 32);
        end if;
      when "110" =>
        if go_0 = '1' then
          next_lane_0 <= message_angular_z_payload(39 downto 32);
        end if;
      when others =>
        null;
    end case;
  end process;

  p_next_lane_1 : process (all)
  begin
    if fresh = '1' then
      next_lane_1 <= (others => '0');
    else
      next_lane_1 <= lane_1;
    end if;
    case step is
      when "000" =>
        next_lane_1 <= "00000001";
      when "001" =>
        if go_0 = '1' then
          next_lane_1 <= message_linear_x_payload(47 downto 40);
        end if;
      when "010" =>
        if go_0 = '1' then
          next_lane_1 <= message_linear_y_payload(47 downto 40);
        end if;
      when "011" =>
        if go_0 = '1' then
          next_lane_1 <= message_linear_z_payload(47 downto 40);
        end if;
      when "100" =>
        if go_0 = '1' then
          next_lane_1 <= message_angular_x_payload(47 downto 40);
        end if;
      when "101" =>
        if go_0 = '1' then
          next_lane_1 <= message_angular_y_payload(47 downto 40);
        end if;
      when "110" =>
        if go_0 = '1' then
          next_lane_1 <= message_angular_z_payload(47 downto 40);
        end if;
      when others =>
        null;
    end case;
  end process;

  p_next_lane_2 : process (all)
  begin
    if fresh = '1' then
      next_lane_2 <= (others => '0');
    else
      next_lane_2 <= lane_2;
    end if;
    case step is
      when "000" =>
        next_lane_2 <= (others => '0');
      when "001" =>
        if go_0 = '1' then
          next_lane_2 <= message_linear_x_payload(55 downto 48);
        end if;
      when "010" =>
        if go_0 = '1' then
          next_lane_2 <= message_linear_y_payload(55 downto 48);
        end if;
      when "011" =>
        if go_0 = '1' then
          next_lane_2 <= message_linear_z_payload(55 downto 48);
        end if;
      when "100" =>
        if go_0 = '1' then
          next_lane_2 <= message_angular_x_payload(55 downto 48);
        end if;
      when "101" =>
        if go_0 = '1' then
          next_lane_2 <= message_angular_y_payload(55 downto 48);
        end if;
      when "110" =>
        if go_0 = '1' then
          next_lane_2 <= message_angular_z_payload(55 downto 48);
        end if;
      when others =>
        null;
    end case;
  end process;

  p_next_lane_3 : process (all)
  begin
    if fresh = '1' then
      next_lane_3 <= (others => '0');
    else
      next_lane_3 <= lane_3;
    end if;
    case step is
      when "000" =>
        next_lane_3 <= (others => '0');
      when "001" =>
        if go_0 = '1' then
          next_lane_3 <= message_linear_x_payload(63 downto 56);
        end if;
      when "010" =>
        if go_0 = '1' then
          next_lane_3 <= message_linear_y_payload(63 downto 56);
        end if;
      when "011" =>
        if go_0 = '1' then
          next_lane_3 <= message_linear_z_payload(63 downto 56);
        end if;
      when "100" =>
        if go_0 = '1' then
          next_lane_3 <= message_angular_x_payload(63 downto 56);
        end if;
      when "101" =>
        if go_0 = '1' then
          next_lane_3 <= message_angular_y_payload(63 downto 56);
        end if;
      when "110" =>
        if go_0 = '1' then
          next_lane_3 <= message_angular_z_payload(63 downto 56);
        end if;
      when others =>
        null;
    end case;
  end process;

  p_next_lane_4 : process (all)
  begin
    if fresh = '1' then
      next_lane_4 <= (others => '0');
    else
      next_lane_4 <= lane_4;
    end if;
    case step is
      when "000" =>
        if go_0 = '1' then
          next_lane_4 <= message_linear_x_payload(7 downto 0);
        end if;
      when "001" =>
        if go_1 = '1' then
          next_lane_4 <= message_linear_y_payload(7 downto 0);
        end if;
      when "010" =>
        if go_1 = '1' then
          next_lane_4 <= message_linear_z_payload(7 downto 0);
        end if;
      when "011" =>
        if go_1 = '1' then
          next_lane_4 <= message_angular_x_payload(7 downto 0);
        end if;
      when "100" =>
        if go_1 = '1' then
          next_lane_4 <= message_angular_y_payload(7 downto 0);
        end if;
      when "101" =>
        if go_1 = '1' then
          next_lane_4 <= message_angular_z_payload(7 downto 0);
        end if;
      when others =>
        null;
    end case;
  end process;

  p_next_lane_5 : process (all)
  begin
    if fresh = '1' then
      next_lane_5 <= (others => '0');
    else
      next_lane_5 <= lane_5;
    end if;
    case step is
      when "000" =>
        if go_0 = '1' then
          next_lane_5 <= message_linear_x_payload(15 downto 8);
        end if;
      when "001" =>
        if go_1 = '1' then
          next_lane_5 <= message_linear_y_payload(15 downto 8);
        end if;
      when "010" =>
        if go_1 = '1' then
          next_lane_5 <= message_linear_z_payload(15 downto 8);
        end if;
      when "011" =>
        if go_1 = '1' then
          next_lane_5 <= message_angular_x_payload(15 downto 8);
        end if;
      when "100" =>
        if go_1 = '1' then
          next_lane_5 <= message_angular_y_payload(15 downto 8);
        end if;
      when "101" =>
        if go_1 = '1' then
          next_lane_5 <= message_angular_z_payload(15 downto 8);
        end if;
      when others =>
        null;
    end case;
  end process;

  p_next_lane_6 : process (all)
  begin
    if fresh = '1' then
      next_lane_6 <= (others => '0');
    else
      next_lane_6 <= lane_6;
    end if;
    case step is
      when "000" =>
        if go_0 = '1' then
          next_lane_6 <= message_linear_x_payload(23 downto 16);
        end if;
      when "001" =>
        if go_1 = '1' then
          next_lane_6 <= message_linear_y_payload(23 downto 16);
        end if;
      when "010" =>
        if go_1 = '1' then
          next_lane_6 <= message_linear_z_payload(23 downto 16);
        end if;
      when "011" =>
        if go_1 = '1' then
          next_lane_6 <= message_angular_x_payload(23 downto 16);
        end if;
      when "100" =>
        if go_1 = '1' then
          next_lane_6 <= message_angular_y_payload(23 downto 16);
        end if;
      when "101" =>
        if go_1 = '1' then
          next_lane_6 <= message_angular_z_payload(23 downto 16);
        end if;
      when others =>
        null;
    end case;
  end process;

  p_next_lane_7 : process (all)
  begin
    if fresh = '1' then
      next_lane_7 <= (others => '0');
    else
      next_lane_7 <= lane_7;
    end if;
    case step is
      when "000" =>
        if go_0 = '1' then
          next_lane_7 <= message_linear_x_payload(31 downto 24);
        end if;
      when "001" =>
        if go_1 = '1' then
          next_lane_7 <= message_linear_y_payload(31 downto 24);
        end if;
      when "010" =>
        if go_1 = '1' then
          next_lane_7 <= message_linear_z_payload(31 downto 24);
        end if;
      when "011" =>
        if go_1 = '1' then
          next_lane_7 <= message_angular_x_payload(31 downto 24);
        end if;
      when "100" =>
        if go_1 = '1' then
          next_lane_7 <= message_angular_y_payload(31 downto 24);
        end if;
      when "101" =>
        if go_1 = '1' then
          next_lane_7 <= message_angular_z_payload(31 downto 24);
        end if;
      when others =>
        null;
    end case;
  end process;

  p_able_0 : process (all)
  begin
    able_0 <= '1';
    case step is
      when "000" | "001" =>
        able_0 <= message_linear_x_valid;
      when "010" =>
        able_0 <= message_linear_y_valid;
      when "011" =>
        able_0 <= message_linear_z_valid;
      when "100" =>
        able_0 <= message_angular_x_valid;
      when "101" =>
        able_0 <= message_angular_y_valid;
      when "110" =>
        able_0 <= message_angular_z_valid;
      when others =>
        null;
    end case;
  end process;

  p_base : process (all)
  begin
    base <= (others => '0');
    case step is
      when "000" | "001" | "010" | "011" | "100" | "101" =>
        base <= "1000";
      when "110" =>
        base <= "0100";
      when others =>
        null;
    end case;
  end process;

  p_done : process (all)
  begin
    done <= '0';
    case step is
      when "000" | "001" | "010" | "011" | "100" | "101" | "110" =>
        done <= '1';
      when others =>
        null;
    end case;
  end process;

  p_next_step : process (all)
  begin
    next_step <= (others => '0');
    case step is
      when "000" =>
        if done = '1' then
          next_step <= "001";
        end if;
      when "001" =>
        if done = '1' then
          next_step <= "010";
        end if;
      when "010" =>
        if done = '1' then
          next_step <= "011";
        end if;
      when "011" =>
        if done = '1' then
          next_step <= "100";
        end if;
      when "100" =>
        if done = '1' then
          next_step <= "101";
        end if;
      when "101" =>
        if done = '1' then
          next_step <= "110";
        end if;
      when others =>
        null;
    end case;
  end process;

  p_able_1 : process (all)
  begin
    able_1 <= '1';
    case step is
      when "001" =>
        able_1 <= message_linear_y_valid;
      when "010" =>
        able_1 <= message_linear_z_valid;
      when "011" =>
        able_1 <= message_angular_x_valid;
      when "100" =>
        able_1 <= message_angular_y_valid;
      when "101" =>
        able_1 <= message_angular_z_valid;
      when others =>
        null;
    end case;
  end process;

  message_linear_x_ready <= go_0 when step = "001" else
                            '0';

  message_linear_y_ready <= go_0 when step = "010" else
                            '0';

  message_linear_z_ready <= go_0 when step = "011" else
                            '0';

  message_angular_x_ready <= go_0 when step = "100" else
                             '0';

  message_angular_y_ready <= go_0 when step = "101" else
                             '0';

  message_angular_z_ready <= go_0 when step = "110" else
                             '0';

  ends <= '1' when step = "110" and done = '1' else
          '0';

  p_aclk : process (aclk)
  begin
    if rising_edge(aclk) then
      if rst = '1' then
        status_valid_q <= '0';
        served_0 <= '0';
        served_1 <= '0';
        full <= '0';
        led <= '0';
        error_81 <= (others => '0');
        lane_0 <= (others => '0');
        lane_1 <= (others => '0');
        lane_2 <= (others => '0');
        lane_3 <= (others => '0');
        lane_4 <= (others => '0');
        lane_5 <= (others => '0');
        lane_6 <= (others => '0');
        lane_7 <= (others => '0');
        word <= (others => '0');
        step <= (others => '0');
        status_payload_q <= (others => '0');
      else
        if status_ready = '1' then
          status_valid_q <= '0';
        end if;
        if complete = '1' then
          if ends = '1' then
            status_valid_q <= '1';
            status_payload_q <= error_80;
          end if;
          word(72 downto 64) <= to_std_logic(error_80 /= 0) & ends & "000" & base;
          step <= next_step;
        end if;
        served_0 <= (served_0 or go_0) and not complete;
        served_1 <= (served_1 or go_1) and not complete;
        if writable = '1' then
          full <= complete;
          led <= '0';
          error_81 <= error_80;
          lane_0 <= next_lane_0;
          lane_1 <= next_lane_1;
          lane_2 <= next_lane_2;
          lane_3 <= next_lane_3;
          lane_4 <= next_lane_4;
          lane_5 <= next_lane_5;
          lane_6 <= next_lane_6;
          lane_7 <= next_lane_7;
        end if;
        if complete = '1' and ends = '1' then
          error_81 <= (others => '0');
        end if;
      end if;
    end if;
  end process;

  status_valid <= status_valid_q;
  status_payload <= status_payload_q;

  error_sig <= packet_error;
  small_sig <= (others => '0');
  left <= '0';
  most_items <= (others => '0');
  allowed <= '0';
  terminated <= '0';
  running <= '0';
  unit_log2 <= (others => '0');
  all_served <= reached_1;
  raised <= (others => '0');
  leads <= '0';
  final_sig <= '1';
  has_items <= '0';
  align <= (others => '0');
  run_bytes <= (others => '0');
  last_items <= '1';
  lane_used <= (others => '0');
  word_payload <= word(72 downto 64) & lane_7 & lane_6 & lane_5 & lane_4 & lane_3 & lane_2 &
      lane_1 & lane_0;

end architecture;
