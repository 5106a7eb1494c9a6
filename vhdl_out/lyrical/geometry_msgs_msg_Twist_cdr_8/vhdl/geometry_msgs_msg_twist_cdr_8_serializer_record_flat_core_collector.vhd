-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_twist_cdr_8_serializer_record_flat.core.collector of the Amaranth design.
-- 16 registers at rising_edge(aclk), synchronous reset rst = '1'.
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
  signal step             : unsigned(5 downto 0) := "000001";
  signal map_bytes        : unsigned(3 downto 0) := "1000";
  signal items_bytes      : unsigned(3 downto 0) := (others => '0');
  signal two_word_map     : std_logic := '0';
  signal rest             : std_logic := '0';
  signal has_nul          : std_logic := '0';

  -- Combinational signals.
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
  signal map_size     : unsigned(4 downto 0);
  signal begins       : std_logic;
  signal to_map_0     : unsigned(3 downto 0);
  signal step_to_exit : std_logic;
  signal and_94       : std_logic;
  signal and_99       : std_logic;
  signal or_118       : unsigned(31 downto 0);
  signal or_124       : unsigned(31 downto 0);
  signal or_137       : unsigned(31 downto 0);
  signal add_154      : unsigned(5 downto 0);
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
  signal to_map        : unsigned(4 downto 0);
  signal words_loads   : std_logic;
  signal done          : std_logic;
  signal ends          : std_logic;
  signal go_1_0        : std_logic;
  signal go_2_0        : std_logic;
  signal go_3_0        : std_logic;
  signal go_4_0        : std_logic;
  signal go_5_0        : std_logic;
  signal items_size    : unsigned(3 downto 0);
  signal nul_now       : std_logic;
  signal step_to_body  : std_logic;
  signal words_down    : std_logic;
  signal words_keeps   : std_logic;
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal found         : unsigned(2 downto 0);
  signal words_pending : std_logic;
  signal words_value   : unsigned(2 downto 0);
begin

  left_1_0 <= step(1) and not served_0;
  lacks_1_0 <= left_1_0 and not message_linear_x_valid;
  message_linear_x_ready <= left_1_0 and message_linear_x_valid and free;
  left_2_0 <= step(2) and not served_0;
  lacks_2_0 <= left_2_0 and not message_linear_y_valid;
  message_linear_y_ready <= left_2_0 and message_linear_y_valid and free;
  left_3_0 <= step(3) and not served_0;
  lacks_3_0 <= left_3_0 and not message_linear_z_valid;
  message_linear_z_ready <= left_3_0 and message_linear_z_valid and free;
  left_4_0 <= step(4) and not served_0;
  lacks_4_0 <= left_4_0 and not message_angular_x_valid;
  message_angular_x_ready <= left_4_0 and message_angular_x_valid and free;
  left_5_0 <= step(5) and not served_0;
  lacks_5_0 <= left_5_0 and not message_angular_y_valid;
  message_angular_y_ready <= left_5_0 and message_angular_y_valid and free;
  left_5_1 <= step(5) and not served_1;
  lacks_5_1 <= left_5_1 and not message_angular_z_valid;
  go_5_1 <= left_5_1 and message_angular_z_valid and free and not lacks_5_0;
  free <= not words_valid_q or words_ready;
  or_60 <= or unsigned'(lacks_5_1 & lacks_5_0 & (step(4) and not message_angular_y_valid) &
      lacks_4_0 & (step(3) and not message_angular_x_valid) & lacks_3_0 & (step(2) and
      not message_linear_z_valid) & lacks_2_0 & (step(1) and not message_linear_y_valid) &
      lacks_1_0 & (step(0) and not message_linear_x_valid));
  complete <= free and not or_60 and (not step(5) or not status_valid_q or status_ready);
  map_size <= resize(map_bytes, 5) + mux(two_word_map, "1000", "0000");
  begins <= begun or (or items_bytes) or (or map_bytes);
  to_map_0 <= (others => '0') when two_word_map = '1' else items_bytes;
  step_to_exit <= complete and not step(5);
  and_94 <= (served_0 or (or unsigned'(message_angular_y_ready & message_angular_x_ready &
      message_linear_z_ready & message_linear_y_ready & message_linear_x_ready))) and not complete;
  and_99 <= complete and step(5);
  or_118 <= mux(step(0), x"00000100", x"00000000") or mux(step(1),
      message_linear_x_payload(63 downto 32), x"00000000") or mux(step(2),
      message_linear_y_payload(63 downto 32), x"00000000") or mux(step(3),
      message_linear_z_payload(63 downto 32), x"00000000");
  or_124 <= or_118 or mux(step(4), message_angular_x_payload(63 downto 32), x"00000000") or
      mux(step(5), message_angular_z_payload(63 downto 32), x"00000000");
  or_137 <= mux(step(0), message_linear_x_payload(31 downto 0), x"00000000") or mux(step(1),
      message_linear_y_payload(31 downto 0), x"00000000") or mux(step(2),
      message_linear_z_payload(31 downto 0), x"00000000") or mux(step(3),
      message_angular_x_payload(31 downto 0), x"00000000");
  add_154 <= resize(to_map_0, 5) + to_end + 7;

  to_end <= mux(begins, resize(map_size, 6) + 7, "001000") when step(5) = '1' else
            resize(map_size, 6);

  end_mask <= "111" when step(5) = '1' else
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
        step <= "000001";
        map_bytes <= "1000";
        items_bytes <= (others => '0');
        two_word_map <= '0';
        rest <= '0';
        has_nul <= '0';
      else
        if free = '1' then
          port_639_0_q(32) <= to_std_logic(error_sig /= 0);
          words_valid_q <= complete;
        end if;
        if free = '1' then
          port_639_0_q(13 downto 0) <= resize(unsigned'(to_map_0 & two_word_map & map_bytes &
              items_bytes), 14);
          port_639_0_q(28 downto 26) <= add_154(5 downto 3);
          port_639_0_q(25 downto 14) <= end_mask & to_end & "000";
          port_639_0_q(31 downto 29) <= resize(unsigned'(not begins & step(5)), 3);
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
          begun <= begins and not step(5);
          if step(5) = '1' then
            step <= "000001";
            map_bytes <= "1000";
            items_bytes <= (others => '0');
            two_word_map <= '0';
          else
            step <= step(4 downto 0) & '0';
            map_bytes <= (or step(3 downto 0)) & step(4) & "00";
            items_bytes <= step(4) & "000";
            two_word_map <= step(4);
          end if;
          if step(5) = '1' then
            rest <= '0';
            has_nul <= '0';
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
      if free = '1' and unsigned'((step(5) and served_1) & ((or step(4 downto 1)) and
          served_0)) = 0 then
        map_0 <= or_124;
      end if;
      if free = '1' then
        map_4 <= or_137 or mux(step(4), message_angular_y_payload(31 downto 0), x"00000000");
      end if;
      if free = '1' and (step(5) = '0' or served_0 = '0') then
        items_0 <= message_angular_y_payload(63 downto 32);
      end if;
      if free = '1' and (step(5) = '0' or served_1 = '0') then
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

  default_0 <= step(0);
  default_1 <= step(1);
  default_2 <= step(2);
  default_3 <= step(3);
  default_4 <= step(4);
  default_5 <= step(5);
  words_payload <= port_639_0_q & map_4 & map_0 & items_4 & items_0;
  to_map <= resize(to_map_0, 5);
  words_loads <= '0';
  done <= '1';
  ends <= step(5);
  go_1_0 <= message_linear_x_ready;
  go_2_0 <= message_linear_y_ready;
  go_3_0 <= message_linear_z_ready;
  go_4_0 <= message_angular_x_ready;
  go_5_0 <= message_angular_y_ready;
  items_size <= items_bytes;
  nul_now <= '0';
  step_to_body <= '0';
  words_down <= '0';
  words_keeps <= '1';
  found <= error_sig;
  words_pending <= '0';
  words_value <= (others => '0');

end architecture;
