-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_twist_cdr_8_deserializer_record_flat.core of the Amaranth design.
-- 20 registers at rising_edge(aclk), synchronous reset rst = '1'.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core is
  port (
    rst                       : in  std_logic;
    aclk                      : in  std_logic;
    packets_valid             : in  std_logic;
    status_ready              : in  std_logic;
    packets_ready             : out std_logic;
    message_linear_x_ready    : in  std_logic;
    packets_payload           : in  unsigned(68 downto 0);
    message_linear_x_valid    : out std_logic;
    message_linear_y_valid    : out std_logic;
    message_linear_z_valid    : out std_logic;
    message_angular_x_valid   : out std_logic;
    message_angular_y_valid   : out std_logic;
    message_angular_z_valid   : out std_logic;
    status_valid              : out std_logic;
    message_linear_x_payload  : out unsigned(63 downto 0);
    message_linear_y_payload  : out unsigned(63 downto 0);
    message_linear_z_payload  : out unsigned(63 downto 0);
    message_angular_x_payload : out unsigned(63 downto 0);
    message_angular_y_payload : out unsigned(63 downto 0);
    message_angular_z_payload : out unsigned(63 downto 0);
    -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
    status_payload            : out unsigned(2 downto 0)
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core is

  -- Registers.
  signal message_linear_x_valid_q    : std_logic := '0';
  signal message_linear_y_valid_q    : std_logic := '0';
  signal message_linear_z_valid_q    : std_logic := '0';
  signal message_angular_x_valid_q   : std_logic := '0';
  signal message_angular_y_valid_q   : std_logic := '0';
  signal message_angular_z_valid_q   : std_logic := '0';
  signal status_valid_q              : std_logic := '0';
  signal message_linear_x_payload_q  : unsigned(63 downto 0) := (others => '0');
  signal message_linear_y_payload_q  : unsigned(63 downto 0) := (others => '0');
  signal message_linear_z_payload_q  : unsigned(63 downto 0) := (others => '0');
  signal message_angular_x_payload_q : unsigned(63 downto 0) := (others => '0');
  signal message_angular_y_payload_q : unsigned(63 downto 0) := (others => '0');
  signal message_angular_z_payload_q : unsigned(63 downto 0) := (others => '0');
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal status_payload_q            : unsigned(2 downto 0) := (others => '0');
  signal carry                       : unsigned(31 downto 0) := (others => '0');
  signal served_0                    : std_logic := '0';
  signal step                        : unsigned(2 downto 0) := (others => '0');
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal error_sig                   : unsigned(2 downto 0) := (others => '0');
  signal draining                    : std_logic := '0';
  signal extra                       : unsigned(2 downto 0) := (others => '0');

  -- Combinational signals.
  signal data          : unsigned(63 downto 0);
  signal first_last    : std_logic;
  signal have_0        : unsigned(7 downto 0);
  signal ended         : std_logic;
  signal held          : std_logic;
  signal first_bytes   : unsigned(3 downto 0);
  signal go_0          : std_logic;
  signal all_served    : std_logic;
  signal fresh         : std_logic;
  signal enable        : std_logic;
  signal promised      : std_logic;
  signal complete      : std_logic;
  signal take          : std_logic;
  signal finish        : std_logic;
  signal total         : unsigned(3 downto 0);
  signal and_167       : std_logic;
  signal or_170        : std_logic;
  signal map_there     : std_logic;
  signal behind        : unsigned(3 downto 0);
  signal mismatch      : std_logic;
  signal base          : unsigned(3 downto 0);
  signal done          : std_logic;
  signal next_step     : unsigned(2 downto 0);
  signal able_0        : std_logic;
  signal ends          : std_logic;
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal choice_signal : unsigned(2 downto 0);
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal finished      : unsigned(2 downto 0);
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal status        : unsigned(2 downto 0);
  signal drop          : std_logic;

  -- Signals that no logic reads, for simulation.
  signal have                    : unsigned(11 downto 0);
  signal message_linear_y_ready  : std_logic;
  signal message_linear_z_ready  : std_logic;
  signal message_angular_x_ready : std_logic;
  signal message_angular_y_ready : std_logic;
  signal message_angular_z_ready : std_logic;
  signal small_sig               : unsigned(3 downto 0);
  signal left                    : std_logic;
  signal most_items              : unsigned(3 downto 0);
  signal allowed                 : std_logic;
  signal terminated              : std_logic;
  signal running                 : std_logic;
  signal unit_log2               : unsigned(2 downto 0);
  signal run_have                : unsigned(12 downto 0);
  signal run_bytes_54            : unsigned(71 downto 0);
  signal over                    : std_logic;
  signal count                   : unsigned(3 downto 0);
  signal align_64                : unsigned(2 downto 0);
  signal final_sig               : std_logic;
  signal has_items               : std_logic;
  signal reached_0               : std_logic;
  signal align                   : unsigned(2 downto 0);
  signal run_bytes               : unsigned(3 downto 0);
  signal last_items              : std_logic;
  signal lane_used               : unsigned(7 downto 0);
  signal nul_missing             : std_logic;
begin

  window : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_window
    port map (
      aclk            => aclk,
      packets_valid   => packets_valid,
      rst             => rst,
      count           => base,
      take            => take,
      finish          => finish,
      packets_ready   => packets_ready,
      data            => data,
      ends_0          => first_last,
      port_341_0      => have_0,
      ended           => ended,
      held            => held,
      first_bytes     => first_bytes,
      packets_payload => packets_payload,
      drop            => drop
    );

  go_0 <= enable and not served_0 and able_0;
  all_served <= served_0 or able_0;
  fresh <= not served_0;
  enable <= '1' when draining = '0' and (error_sig /= 0 or (held = '1' and (map_there = '1' or
      ended = '1'))) else '0';
  promised <= '1' when error_sig /= 0 or map_there = '1' or ended = '1' else '0';
  complete <= enable and all_served and (not ends or not status_valid_q or status_ready);
  take <= '1' when complete = '1' and error_sig = 0 and ends = '0' else '0';
  finish <= complete and ends;
  total <= extra + first_bytes;
  and_167 <= draining and held;
  or_170 <= not status_valid_q or status_ready;

  p_map_there : process (all)
  begin
    map_there <= '0';
    case step is
      when "000" | "001" | "010" | "011" | "100" | "101" =>
        map_there <= have_0(7);
      when "110" =>
        map_there <= have_0(3);
      when others =>
        null;
    end case;
  end process;

  behind <= have_0(7 downto 4) when step = "110" else
            (others => '0');

  mismatch <= or unsigned'((have_0(1) and to_std_logic(data(15 downto 8) /= 1)) & (have_0(0) and
      to_std_logic(data(7 downto 0) /= 0))) when step = "000" else
              '0';

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

  p_able_0 : process (all)
  begin
    able_0 <= '1';
    case step is
      when "001" =>
        able_0 <= not message_linear_x_valid_q or message_linear_x_ready;
      when "010" =>
        able_0 <= not message_linear_y_valid_q or message_linear_x_ready;
      when "011" =>
        able_0 <= not message_linear_z_valid_q or message_linear_x_ready;
      when "100" =>
        able_0 <= not message_angular_x_valid_q or message_linear_x_ready;
      when "101" =>
        able_0 <= not message_angular_y_valid_q or message_linear_x_ready;
      when "110" =>
        able_0 <= not message_angular_z_valid_q or message_linear_x_ready;
      when others =>
        null;
    end case;
  end process;

  ends <= '1' when step = "110" and done = '1' else
          '0';

  p_choice_signal : process (all)
  begin
    choice_signal <= error_sig;
    if error_sig = 0 then
      if mismatch = '1' then
        choice_signal <= "100";
      elsif map_there = '0' then
        choice_signal <= "001";
      end if;
    end if;
  end process;

  finished <= "010" when choice_signal = 0 and behind(3) = '1' else
              choice_signal;

  status <= "010" when error_sig = 0 and total > 3 else
            error_sig;

  drop <= '1' when draining = '1' and held = '1' and (first_last = '0' or status_valid_q = '0' or
      status_ready = '1') else
          '0';

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
        carry <= (others => '0');
        message_linear_x_payload_q <= (others => '0');
        message_linear_y_payload_q <= (others => '0');
        message_linear_z_payload_q <= (others => '0');
        message_angular_x_payload_q <= (others => '0');
        message_angular_y_payload_q <= (others => '0');
        message_angular_z_payload_q <= (others => '0');
        served_0 <= '0';
        step <= (others => '0');
        error_sig <= (others => '0');
        status_payload_q <= (others => '0');
        draining <= '0';
        extra <= (others => '0');
      else
        if message_linear_x_ready = '1' then
          message_linear_x_valid_q <= '0';
          message_linear_y_valid_q <= '0';
          message_linear_z_valid_q <= '0';
          message_angular_x_valid_q <= '0';
          message_angular_y_valid_q <= '0';
          message_angular_z_valid_q <= '0';
        end if;
        case step is
          when "001" =>
            if go_0 = '1' then
              message_linear_x_valid_q <= '1';
              if have_0(3) = '1' and error_sig = 0 and mismatch = '0' then
                message_linear_x_payload_q <= data(31 downto 0) & carry;
              else
                message_linear_x_payload_q <= (others => '0');
              end if;
            end if;
            if complete = '1' then
              carry <= data(63 downto 32);
            end if;
          when "010" =>
            if go_0 = '1' then
              message_linear_y_valid_q <= '1';
              if have_0(3) = '1' and error_sig = 0 and mismatch = '0' then
                message_linear_y_payload_q <= data(31 downto 0) & carry;
              else
                message_linear_y_payload_q <= (others => '0');
              end if;
            end if;
            if complete = '1' then
              carry <= data(63 downto 32);
            end if;
          when "011" =>
            if go_0 = '1' then
              message_linear_z_valid_q <= '1';
              if have_0(3) = '1' and error_sig = 0 and mismatch = '0' then
                message_linear_z_payload_q <= data(31 downto 0) & carry;
              else
                message_linear_z_payload_q <= (others => '0');
              end if;
            end if;
            if complete = '1' then
              carry <= data(63 downto 32);
            end if;
          when "100" =>
            if go_0 = '1' then
              message_angular_x_valid_q <= '1';
              if have_0(3) = '1' and error_sig = 0 and mismatch = '0' then
                message_angular_x_payload_q <= data(31 downto 0) & carry;
              else
                message_angular_x_payload_q <= (others => '0');
              end if;
            end if;
            if complete = '1' then
              carry <= data(63 downto 32);
            end if;
          when "101" =>
            if go_0 = '1' then
              message_angular_y_valid_q <= '1';
              if have_0(3) = '1' and error_sig = 0 and mismatch = '0' then
                message_angular_y_payload_q <= data(31 downto 0) & carry;
              else
                message_angular_y_payload_q <= (others => '0');
              end if;
            end if;
            if complete = '1' then
              carry <= data(63 downto 32);
            end if;
          when "110" =>
            if go_0 = '1' then
              message_angular_z_valid_q <= '1';
              if have_0(3) = '1' and error_sig = 0 and mismatch = '0' then
                message_angular_z_payload_q <= data(31 downto 0) & carry;
              else
                message_angular_z_payload_q <= (others => '0');
              end if;
            end if;
          when "000" =>
            if complete = '1' then
              carry <= data(63 downto 32);
            end if;
          when others =>
            null;
        end case;
        if status_ready = '1' then
          status_valid_q <= '0';
        end if;
        if complete = '1' then
          if ends = '1' then
            if ended = '1' then
              status_valid_q <= '1';
              status_payload_q <= finished;
            end if;
            if ended = '0' then
              draining <= '1';
              extra <= resize(resize(behind(0), 2) + behind(1), 3) + behind(2) + behind(3);
            end if;
          end if;
          step <= next_step;
          error_sig <= choice_signal;
          if ends = '1' and ended = '1' then
            error_sig <= (others => '0');
          end if;
        end if;
        if and_167 = '1' then
          if first_last = '0' then
            null;
          elsif or_170 = '1' then
            status_valid_q <= '1';
            error_sig <= (others => '0');
            status_payload_q <= status;
            draining <= '0';
          end if;
          if first_last = '0' then
            if total > 3 then
              extra <= "100";
            else
              extra <= total(2 downto 0);
            end if;
          end if;
        end if;
        served_0 <= (served_0 or go_0) and not complete;
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
  message_linear_x_payload <= message_linear_x_payload_q;
  message_linear_y_payload <= message_linear_y_payload_q;
  message_linear_z_payload <= message_linear_z_payload_q;
  message_angular_x_payload <= message_angular_x_payload_q;
  message_angular_y_payload <= message_angular_y_payload_q;
  message_angular_z_payload <= message_angular_z_payload_q;
  status_payload <= status_payload_q;

  have <= resize(have_0, 12);
  message_linear_y_ready <= message_linear_x_ready;
  message_linear_z_ready <= message_linear_x_ready;
  message_angular_x_ready <= message_linear_x_ready;
  message_angular_y_ready <= message_linear_x_ready;
  message_angular_z_ready <= message_linear_x_ready;
  small_sig <= (others => '0');
  left <= '0';
  most_items <= (others => '0');
  allowed <= '0';
  terminated <= '0';
  running <= '0';
  unit_log2 <= (others => '0');
  run_have <= (others => '0');
  run_bytes_54 <= (others => '0');
  over <= '0';
  count <= base;
  align_64 <= (others => '0');
  final_sig <= '1';
  has_items <= '0';
  reached_0 <= all_served;
  align <= (others => '0');
  run_bytes <= (others => '0');
  last_items <= '1';
  lane_used <= (others => '0');
  nul_missing <= '0';

end architecture;
