-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_twist_cdr_8_serializer_record_flat.core.collector of the Amaranth design.
-- 13 registers at rising_edge(aclk), synchronous reset rst = '1'.
-- 4 registers at rising_edge(aclk), no reset.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core_collector is
  port (
    rst                       : in  std_logic;
    aclk                      : in  std_logic;
    status_ready              : in  std_logic;
    message_linear_x_ready    : out std_logic;
    message_linear_y_ready    : out std_logic;
    message_linear_z_ready    : out std_logic;
    message_angular_x_ready   : out std_logic;
    message_angular_y_ready   : out std_logic;
    message_angular_z_ready   : out std_logic;
    message_linear_x_valid    : in  std_logic;
    message_linear_y_valid    : in  std_logic;
    message_linear_z_valid    : in  std_logic;
    message_angular_x_valid   : in  std_logic;
    message_angular_y_valid   : in  std_logic;
    message_angular_z_valid   : in  std_logic;
    port_635_0                : out unsigned(127 downto 0);
    port_639_0                : out unsigned(32 downto 0);
    status_valid              : out std_logic;
    -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
    status_payload            : out unsigned(2 downto 0);
    words_valid               : out std_logic;
    words_ready               : in  std_logic;
    message_linear_x_payload  : in  unsigned(63 downto 0);
    message_linear_y_payload  : in  unsigned(63 downto 0);
    message_linear_z_payload  : in  unsigned(63 downto 0);
    message_angular_x_payload : in  unsigned(63 downto 0);
    message_angular_y_payload : in  unsigned(63 downto 0);
    message_angular_z_payload : in  unsigned(63 downto 0)
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core_collector is

  -- Registers.
  signal port_639_0_q     : unsigned(32 downto 0) := (others => '0');
  signal status_valid_q   : std_logic := '0';
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal status_payload_q : unsigned(2 downto 0) := (others => '0');
  signal words_valid_q    : std_logic := '0';
  signal served_0         : std_logic := '0';
  signal served_1         : std_logic := '0';
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal error_sig        : unsigned(2 downto 0) := (others => '0');
  signal map_0            : unsigned(31 downto 0) := (others => '0');
  signal map_4            : unsigned(31 downto 0) := (others => '0');
  signal items_0          : unsigned(31 downto 0) := (others => '0');
  signal items_4          : unsigned(31 downto 0) := (others => '0');
  signal begun            : std_logic := '0';
  signal words_last       : std_logic := '1';
  signal words_less       : std_logic := '0';
  signal state            : unsigned(26 downto 0) := 27x"0800201";
  signal rest             : std_logic := '0';
  signal has_nul          : std_logic := '0';

  -- Combinational signals.
  signal done         : std_logic;
  signal ends         : std_logic;
  signal left_1_0     : std_logic;
  signal lacks_1_0    : std_logic;
  signal left_2_0     : std_logic;
  signal lacks_2_0    : std_logic;
  signal left_3_0     : std_logic;
  signal lacks_3_0    : std_logic;
  signal left_4_0     : std_logic;
  signal lacks_4_0    : std_logic;
  signal left_5_0     : std_logic;
  signal lacks_5_0    : std_logic;
  signal left_5_1     : std_logic;
  signal lacks_5_1    : std_logic;
  signal go_5_1       : std_logic;
  signal free         : std_logic;
  signal or_60        : std_logic;
  signal complete     : std_logic;
  signal items_size   : unsigned(3 downto 0);
  signal map_size     : unsigned(4 downto 0);
  signal nul_now      : std_logic;
  signal begins       : std_logic;
  signal to_map       : unsigned(4 downto 0);
  signal step_to_exit : std_logic;
  signal step_to_body : std_logic;
  signal and_94       : std_logic;
  signal and_99       : std_logic;
  signal or_118       : unsigned(31 downto 0);
  signal or_124       : unsigned(31 downto 0);
  signal or_137       : unsigned(31 downto 0);
  signal add_154      : unsigned(5 downto 0);
  signal mux_194      : unsigned(26 downto 0);
  signal to_end       : unsigned(5 downto 0);
  signal end_mask     : unsigned(2 downto 0);

  -- Signals that no logic reads, for simulation.
  signal default_0     : std_logic;
  signal default_1     : std_logic;
  signal default_2     : std_logic;
  signal default_3     : std_logic;
  signal default_4     : std_logic;
  signal default_5     : std_logic;
  signal words_payload : unsigned(160 downto 0);
  signal words_loads   : std_logic;
  signal go_1_0        : std_logic;
  signal go_2_0        : std_logic;
  signal go_3_0        : std_logic;
  signal go_4_0        : std_logic;
  signal go_5_0        : std_logic;
  signal words_down    : std_logic;
  signal words_keeps   : std_logic;
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal found         : unsigned(2 downto 0);
  signal words_pending : std_logic;
  signal words_value   : unsigned(2 downto 0);
begin

  done <= state(23) or (state(22) and words_last);
  ends <= done and state(5);
  left_1_0 <= state(1) and not served_0;
  lacks_1_0 <= left_1_0 and not message_linear_x_valid;
  message_linear_x_ready <= left_1_0 and message_linear_x_valid and free;
  left_2_0 <= state(2) and not served_0;
  lacks_2_0 <= left_2_0 and not message_linear_y_valid;
  message_linear_y_ready <= left_2_0 and message_linear_y_valid and free;
  left_3_0 <= state(3) and not served_0;
  lacks_3_0 <= left_3_0 and not message_linear_z_valid;
  message_linear_z_ready <= left_3_0 and message_linear_z_valid and free;
  left_4_0 <= state(4) and not served_0;
  lacks_4_0 <= left_4_0 and not message_angular_x_valid;
  message_angular_x_ready <= left_4_0 and message_angular_x_valid and free;
  left_5_0 <= state(5) and not served_0;
  lacks_5_0 <= left_5_0 and not message_angular_y_valid;
  message_angular_y_ready <= left_5_0 and message_angular_y_valid and free;
  left_5_1 <= state(5) and not served_1;
  lacks_5_1 <= left_5_1 and not message_angular_z_valid;
  go_5_1 <= left_5_1 and message_angular_z_valid and free and not lacks_5_0;
  free <= not words_valid_q or words_ready;
  or_60 <= or unsigned'(lacks_5_1 & lacks_5_0 & (state(4) and not message_angular_y_valid) &
      lacks_4_0 & (state(3) and not message_angular_x_valid) & lacks_3_0 & (state(2) and
      not message_linear_z_valid) & lacks_2_0 & (state(1) and not message_linear_y_valid) &
      lacks_1_0 & (state(0) and not message_linear_x_valid));
  complete <= free and not or_60 and (not ends or not status_valid_q or status_ready);
  items_size <= (others => '0') when state(24) = '1' else state(13 downto 10);
  map_size <= resize(state(9 downto 6), 5) + mux(state(26), "1000", "0000");
  nul_now <= has_nul and state(24);
  begins <= begun or (or items_size) or nul_now or (or state(9 downto 6));
  to_map <= resize(mux(state(26), "0000", items_size), 5) + nul_now + state(19 downto 17);
  step_to_exit <= complete and not ends and done;
  step_to_body <= complete and not ends and not done;
  and_94 <= (served_0 or (or unsigned'(message_angular_y_ready & message_angular_x_ready &
      message_linear_z_ready & message_linear_y_ready & message_linear_x_ready))) and not complete;
  and_99 <= complete and ends;
  or_118 <= mux(state(0), x"00000100", x"00000000") or mux(state(1),
      message_linear_x_payload(63 downto 32), x"00000000") or mux(state(2),
      message_linear_y_payload(63 downto 32), x"00000000") or mux(state(3),
      message_linear_z_payload(63 downto 32), x"00000000");
  or_124 <= or_118 or mux(state(4), message_angular_x_payload(63 downto 32), x"00000000") or
      mux(state(5), message_angular_z_payload(63 downto 32), x"00000000");
  or_137 <= mux(state(0), message_linear_x_payload(31 downto 0), x"00000000") or mux(state(1),
      message_linear_y_payload(31 downto 0), x"00000000") or mux(state(2),
      message_linear_z_payload(31 downto 0), x"00000000") or mux(state(3),
      message_angular_x_payload(31 downto 0), x"00000000");
  add_154 <= to_map + to_end + 7;
  mux_194 <= state(4) & "00" & (or state(4 downto 0)) & 9x"000" & state(4) & "000" &
      (or state(3 downto 0)) & state(4) & "00" & state(4 downto 0) & '0' when done = '1' else
      (others => '0');

  to_end <= mux(begins, resize(map_size, 6) + 7, "001000") when ends = '1' else
            resize(map_size, 6);

  end_mask <= "111" when ends = '1' else
              (others => '0');

  p_aclk : process (aclk)
  begin
    if rising_edge(aclk) then
      if rst = '1' then
        port_639_0_q <= (others => '0');
        served_0 <= '0';
        served_1 <= '0';
        error_sig <= (others => '0');
        status_valid_q <= '0';
        status_payload_q <= (others => '0');
        begun <= '0';
        words_valid_q <= '0';
        words_last <= '1';
        words_less <= '0';
        state <= 27x"0800201";
        rest <= '0';
        has_nul <= '0';
      else
        if free = '1' then
          port_639_0_q(32) <= to_std_logic(error_sig /= 0);
          words_valid_q <= complete;
        end if;
        if free = '1' then
          port_639_0_q(13 downto 0) <= to_map & state(26) & state(9 downto 6) & items_size;
          port_639_0_q(28 downto 26) <= add_154(5 downto 3);
          port_639_0_q(25 downto 14) <= end_mask & to_end & state(16 downto 14);
          port_639_0_q(31 downto 29) <= resize(unsigned'(not begins & ends), 3);
        end if;
        served_0 <= and_94;
        served_1 <= (served_1 or go_5_1) and not complete;
        if and_99 = '1' then
          error_sig <= (others => '0');
          status_payload_q <= error_sig;
        end if;
        if status_ready = '1' then
          status_valid_q <= '0';
        end if;
        if and_99 = '1' then
          status_valid_q <= '1';
        end if;
        if complete = '1' then
          begun <= begins and not ends;
          if ends = '1' then
            state <= 27x"0800201";
          else
            state <= mux_194;
          end if;
          if ends = '1' then
            rest <= '0';
            has_nul <= '0';
          else
            if state(20) = '1' then
              rest <= '0';
              has_nul <= state(25);
            elsif state(24) = '1' then
              rest <= '0';
              has_nul <= '0';
            end if;
          end if;
        end if;
        words_last <= words_last;
        words_less <= words_less;
      end if;
    end if;
  end process;

  p_aclk_2 : process (aclk)
  begin
    if rising_edge(aclk) then
      if free = '1' and unsigned'((state(5) and served_1) & ((or state(4 downto 1)) and
          served_0)) = 0 then
        map_0 <= or_124;
      end if;
      if free = '1' then
        map_4 <= or_137 or mux(state(4), message_angular_y_payload(31 downto 0), x"00000000");
      end if;
      if free = '1' and (state(5) = '0' or served_0 = '0') then
        items_0 <= message_angular_y_payload(63 downto 32);
      end if;
      if free = '1' and (state(5) = '0' or served_1 = '0') then
        items_4 <= message_angular_z_payload(31 downto 0);
      end if;
    end if;
  end process;

  port_635_0 <= map_4 & map_0 & items_4 & items_0;
  message_angular_z_ready <= go_5_1;

  port_639_0 <= port_639_0_q;
  status_valid <= status_valid_q;
  status_payload <= status_payload_q;
  words_valid <= words_valid_q;

  default_0 <= state(0);
  default_1 <= state(1);
  default_2 <= state(2);
  default_3 <= state(3);
  default_4 <= state(4);
  default_5 <= state(5);
  words_payload <= port_639_0_q & map_4 & map_0 & items_4 & items_0;
  words_loads <= '0';
  go_1_0 <= message_linear_x_ready;
  go_2_0 <= message_linear_y_ready;
  go_3_0 <= message_linear_z_ready;
  go_4_0 <= message_angular_x_ready;
  go_5_0 <= message_angular_y_ready;
  words_down <= '0';
  words_keeps <= '1';
  found <= error_sig;
  words_pending <= '0';
  words_value <= (others => '0');

end architecture;
