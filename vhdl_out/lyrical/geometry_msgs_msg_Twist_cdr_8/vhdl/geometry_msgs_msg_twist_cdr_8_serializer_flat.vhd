-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Steps, as `firm-hdl plan --program` prints them.
-- One line a step: its number and name, what it takes, and where it leads. A step is one cycle.
-- "map": bytes at fixed places, at most two bus words. "items": a bus word of a string or an
-- array, which is a run of them. "rest": the last items of a run, which the next step takes
-- before its map; "rest x 8": of 8 bytes each. "lanes": the bytes of the bus, from 0 on. "unit
-- 4": bytes start and end at multiples of 4. "body": the step after a length that more than a
-- rest follows. "level 0": the outermost sequence of elements; "while level 0": while it has
-- elements left. "to 2 (+8)": the last byte of step 2 is 8 bytes after that of this step; with
-- "align 4 | 3", then down to a multiple of 4, and 3 more: from byte 21, "+6, align 4 | 3" leads
-- to byte 27. "a.length:0..3": bytes 0 to 3 of a leaf, from the first lane on.
-- serializer: start 0, items from lane 0, unit 8, map from lane 0, unit 4, at most 3 beats a
--       state
--   0 linear_x: map of 8; begins linear.x; map = 00 01 00 00 linear.x:0..3; to 1
--   1 linear_x_2: map of 8; linear.x; begins linear.y; map = linear.x:4..7 linear.y:0..3; to 2
--   2 linear_y: map of 8; linear.y; begins linear.z; map = linear.y:4..7 linear.z:0..3; to 3
--   3 linear_z: map of 8; linear.z; begins angular.x; map = linear.z:4..7 angular.x:0..3; to 4
--   4 angular_x: map of 8; angular.x; begins angular.y; map = angular.x:4..7 angular.y:0..3; to 5
--   5 angular_y: map of 12 in two words; angular.y angular.z; items = angular.y:4..7
--       angular.z:0..3; map = angular.z:4..7; to end
-- A status has 3 bits inside, and 8 at its ports, as the constants of firm_hdl_types_pkg.
-- Module geometry_msgs_msg_Twist_cdr_8_serializer.core.collector of the Amaranth design.
-- Collector: Take the leaves of each state of a program, and put them into two words.
--
-- Leaves are taken in wire order, each as soon as it is offered. A length is decoded in the cycle
-- before it is taken, so it is taken one cycle after it is offered at the earliest. Latency 1
-- cycle from the last leaf of a state to the state's words. Throughput one state per cycle:
--
--     cycle              | 0        | 1         | 2
--     length.valid       | 1        | 1         |
--     known              |          | 1         |
--     length.ready       |          | 1         |
--     complete           |          | 1         |
--     words.valid        |          |           | 1
-- 20 registers at rising_edge(aclk), synchronous reset rst = '1'.
-- 4 registers at rising_edge(aclk), no reset.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_serializer_flat_core_collector is
  port (
    rst                       : in  std_logic;
    aclk                      : in  std_logic;
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
    message_linear_x_ready    : out std_logic;
    message_linear_y_ready    : out std_logic;
    message_linear_z_ready    : out std_logic;
    message_angular_x_ready   : out std_logic;
    message_angular_y_ready   : out std_logic;
    message_angular_z_ready   : out std_logic;
    words_payload_0           : out unsigned(127 downto 0);  -- bits: items(63:0) map(127:64)
    -- bits: items_bytes(3:0) map_bytes(7:4) two_word_map(8) to_map(13:9) map_mask(16:14)
    -- to_end(22:17) end_mask(25:23) max_beats(28:26) last(29) empty(30) waits(31) error(32)
    words_payload_128         : out unsigned(32 downto 0);
    status_valid              : out std_logic;
    -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
    status_payload            : out unsigned(2 downto 0);
    words_valid               : out std_logic;
    words_ready               : in  std_logic
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_serializer_flat_core_collector is

  -- Values of enumerations.
  constant STATUS_OK : unsigned(2 downto 0) := "000";

  -- Registers.
  -- bits as of words_payload_128_q
  signal words_payload_128_q : unsigned(32 downto 0) := (others => '0');
  signal status_valid_q      : std_logic := '0';
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal status_payload_q    : unsigned(2 downto 0) := (others => '0');
  signal words_valid_q       : std_logic := '0';
  signal served_0            : std_logic := '0';
  signal served_1            : std_logic := '0';
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal error_sig           : unsigned(2 downto 0) := (others => '0');
  signal items_0             : unsigned(31 downto 0) := (others => '0');
  signal items_4             : unsigned(31 downto 0) := (others => '0');
  signal map_0               : unsigned(31 downto 0) := (others => '0');
  signal map_4               : unsigned(31 downto 0) := (others => '0');
  signal begun               : std_logic := '0';
  signal words_last          : std_logic := '1';  -- one is left
  signal step_linear_x       : std_logic := '1';  -- step 0: map of 8; begins linear.x
  signal step_linear_x_2     : std_logic := '0';  -- step 1: map of 8; linear.x; begins linear.y
  signal step_linear_y       : std_logic := '0';  -- step 2: map of 8; linear.y; begins linear.z
  signal step_linear_z       : std_logic := '0';  -- step 3: map of 8; linear.z; begins angular.x
  signal step_angular_x      : std_logic := '0';  -- step 4: map of 8; angular.x; begins angular.y
  -- step 5: map of 12 in two words; angular.y angular.z
  signal step_angular_y      : std_logic := '0';
  signal map_bytes           : unsigned(3 downto 0) := "1000";
  signal items_bytes         : unsigned(3 downto 0) := (others => '0');
  signal two_word_map        : std_logic := '0';
  signal rest                : std_logic := '0';
  signal has_nul             : std_logic := '0';

  -- Combinational signals.
  signal left_linear_x     : std_logic;
  signal lacks_linear_x    : std_logic;
  signal left_linear_y     : std_logic;
  signal lacks_linear_y    : std_logic;
  signal left_linear_z     : std_logic;
  signal lacks_linear_z    : std_logic;
  signal left_angular_x    : std_logic;
  signal lacks_angular_x   : std_logic;
  signal left_angular_y    : std_logic;
  signal lacks_angular_y   : std_logic;
  signal left_angular_z    : std_logic;
  signal lacks_angular_z   : std_logic;
  signal go_angular_z      : std_logic;
  signal lacks_any         : std_logic;
  signal free              : std_logic;
  signal complete          : std_logic;
  signal serves_0          : std_logic;
  signal items_0_writes    : std_logic;
  signal items_4_writes    : std_logic;
  signal map_0_writes_part : std_logic;
  signal map_0_writes      : std_logic;
  signal map_size          : unsigned(4 downto 0);
  signal begins            : std_logic;
  signal to_map_0          : unsigned(3 downto 0);
  signal most_bytes        : unsigned(7 downto 0);
  signal moves_on          : std_logic;
  signal to_end            : unsigned(5 downto 0);
  signal end_mask          : unsigned(2 downto 0);
begin

  left_linear_x <= step_linear_x_2 and not served_0;
  lacks_linear_x <= left_linear_x and not message_linear_x_valid;
  message_linear_x_ready <= left_linear_x and message_linear_x_valid and free;
  left_linear_y <= step_linear_y and not served_0;
  lacks_linear_y <= left_linear_y and not message_linear_y_valid;
  message_linear_y_ready <= left_linear_y and message_linear_y_valid and free;
  left_linear_z <= step_linear_z and not served_0;
  lacks_linear_z <= left_linear_z and not message_linear_z_valid;
  message_linear_z_ready <= left_linear_z and message_linear_z_valid and free;
  left_angular_x <= step_angular_x and not served_0;
  lacks_angular_x <= left_angular_x and not message_angular_x_valid;
  message_angular_x_ready <= left_angular_x and message_angular_x_valid and free;
  left_angular_y <= step_angular_y and not served_0;
  lacks_angular_y <= left_angular_y and not message_angular_y_valid;
  message_angular_y_ready <= left_angular_y and message_angular_y_valid and free;
  left_angular_z <= step_angular_y and not served_1;
  lacks_angular_z <= left_angular_z and not message_angular_z_valid;
  go_angular_z <= left_angular_z and message_angular_z_valid and free and not lacks_angular_y;
  lacks_any <= lacks_linear_x or lacks_linear_y or lacks_linear_z or lacks_angular_x or
      lacks_angular_y or lacks_angular_z or (step_linear_x and not message_linear_x_valid) or
      (step_linear_x_2 and not message_linear_y_valid) or (step_linear_y and
      not message_linear_z_valid) or (step_linear_z and not message_angular_x_valid) or
      (step_angular_x and not message_angular_y_valid);
  free <= not words_valid_q or words_ready;
  complete <= free and not lacks_any and (not step_angular_y or not status_valid_q or status_ready);
  serves_0 <= message_linear_x_ready or message_linear_y_ready or message_linear_z_ready or
      message_angular_x_ready or message_angular_y_ready;
  items_0_writes <= free and not (step_angular_y and served_0);
  items_4_writes <= free and not (step_angular_y and served_1);
  map_0_writes_part <= ((step_linear_x_2 or step_linear_y or step_linear_z or step_angular_x) and
      served_0) or (step_angular_y and served_1);
  map_0_writes <= free and not map_0_writes_part;
  map_size <= resize(map_bytes, 5) + mux(two_word_map, "1000", "0000");
  begins <= begun or (or items_bytes) or (or map_bytes);
  to_map_0 <= (others => '0') when two_word_map = '1' else items_bytes;
  most_bytes <= resize(resize(to_map_0, 7) + to_end, 8) + 7;
  moves_on <= complete and not step_angular_y;

  to_end <= mux(begins, resize(map_size, 6) + 7, "001000") when step_angular_y = '1' else
            resize(map_size, 6);

  end_mask <= "111" when step_angular_y = '1' else
              (others => '0');

  p_aclk : process (aclk)
  begin
    if rising_edge(aclk) then
      if rst = '1' then
        words_payload_128_q <= (others => '0');
        served_0 <= '0';
        served_1 <= '0';
        error_sig <= (others => '0');
        status_valid_q <= '0';
        status_payload_q <= (others => '0');
        begun <= '0';
        words_valid_q <= '0';
        words_last <= '1';
        step_linear_x <= '1';
        step_linear_x_2 <= '0';
        step_linear_y <= '0';
        step_linear_z <= '0';
        step_angular_x <= '0';
        step_angular_y <= '0';
        map_bytes <= "1000";
        items_bytes <= (others => '0');
        two_word_map <= '0';
        rest <= '0';
        has_nul <= '0';
      else
        if free = '1' then
          words_payload_128_q(13 downto 0) <= resize(unsigned'(to_map_0 & two_word_map & map_bytes &
              items_bytes), 14);
          words_payload_128_q(28 downto 26) <= most_bytes(5 downto 3);
          words_payload_128_q(25 downto 14) <= end_mask & to_end & "000";
          words_payload_128_q(30) <= not begins;
          words_valid_q <= complete;
        end if;
        if free = '1' then
          words_payload_128_q(29) <= step_angular_y;
          words_payload_128_q(32 downto 31) <= to_std_logic(error_sig /= STATUS_OK) & '0';
        end if;
        served_0 <= (served_0 or serves_0) and not complete;
        served_1 <= (served_1 or go_angular_z) and not complete;
        if complete = '1' and step_angular_y = '1' then
          error_sig <= STATUS_OK;
          status_payload_q <= error_sig;
        end if;
        if status_ready = '1' then
          status_valid_q <= '0';
        end if;
        if complete = '1' and step_angular_y = '1' then
          status_valid_q <= '1';
        end if;
        if complete = '1' then
          begun <= begins and not step_angular_y;
          if step_angular_y = '1' then
            step_linear_x <= '1';
            step_linear_x_2 <= '0';
            step_linear_y <= '0';
            step_linear_z <= '0';
            step_angular_x <= '0';
            step_angular_y <= '0';
            map_bytes <= "1000";
            items_bytes <= (others => '0');
            two_word_map <= '0';
          else
            step_linear_x <= '0';
            step_linear_x_2 <= step_linear_x;
            step_linear_y <= step_linear_x_2;
            step_linear_z <= step_linear_y;
            step_angular_x <= step_linear_z;
            step_angular_y <= step_angular_x;
            map_bytes <= (step_linear_x or step_linear_x_2 or step_linear_y or step_linear_z) &
                step_angular_x & "00";
            items_bytes <= step_angular_x & "000";
            two_word_map <= step_angular_x;
          end if;
          if step_angular_y = '1' then
            rest <= '0';
            has_nul <= '0';
          end if;
        end if;
        words_last <= words_last;
      end if;
    end if;
  end process;

  p_aclk_2 : process (aclk)
  begin
    if rising_edge(aclk) then
      if items_0_writes = '1' then
        items_0 <= message_angular_y_payload(63 downto 32);
      end if;
      if items_4_writes = '1' then
        items_4 <= message_angular_z_payload(31 downto 0);
      end if;
      if map_0_writes = '1' then
        map_0 <= mux(step_linear_x, x"00000100", x"00000000") or mux(step_linear_x_2,
            message_linear_x_payload(63 downto 32), x"00000000") or mux(step_linear_y,
            message_linear_y_payload(63 downto 32), x"00000000") or mux(step_linear_z,
            message_linear_z_payload(63 downto 32), x"00000000") or mux(step_angular_x,
            message_angular_x_payload(63 downto 32), x"00000000") or mux(step_angular_y,
            message_angular_z_payload(63 downto 32), x"00000000");
      end if;
      if free = '1' then
        map_4 <= mux(step_linear_x, message_linear_x_payload(31 downto 0), x"00000000") or
            mux(step_linear_x_2, message_linear_y_payload(31 downto 0), x"00000000") or
            mux(step_linear_y, message_linear_z_payload(31 downto 0), x"00000000") or
            mux(step_linear_z, message_angular_x_payload(31 downto 0), x"00000000") or
            mux(step_angular_x, message_angular_y_payload(31 downto 0), x"00000000");
      end if;
    end if;
  end process;

  words_payload_0 <= map_4 & map_0 & items_4 & items_0;
  message_angular_z_ready <= go_angular_z;

  words_payload_128 <= words_payload_128_q;
  status_valid <= status_valid_q;
  status_payload <= status_payload_q;
  words_valid <= words_valid_q;

end architecture;

-- Module geometry_msgs_msg_Twist_cdr_8_serializer.core.packer of the Amaranth design.
-- Packer: Write words to a ring of beats, and send the beats that are complete.
--
-- Throughput two words in and one beat out per cycle; latency 3 cycles:
--
--     cycle          | 0                  | 1            | 2          | 3
--     words          | valid, ready       |              |            |
--     they are       | placed and rotated | written      |            |
--     beat           |                    | complete     | read       | packets.valid
-- 20 registers at rising_edge(aclk), synchronous reset rst = '1'.
-- 4 registers at rising_edge(aclk), no reset.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_serializer_flat_core_packer is
  port (
    rst               : in  std_logic;
    aclk              : in  std_logic;
    packets_ready     : in  std_logic;
    words_payload_0   : in  unsigned(127 downto 0);  -- bits: items(63:0) map(127:64)
    -- bits: items_bytes(3:0) map_bytes(7:4) two_word_map(8) to_map(13:9) map_mask(16:14)
    -- to_end(22:17) end_mask(25:23) max_beats(28:26) last(29) empty(30) waits(31) error(32)
    words_payload_128 : in  unsigned(32 downto 0);
    words_valid       : in  std_logic;
    words_ready       : out std_logic;
    packets_valid     : out std_logic;
    packets_payload   : out unsigned(68 downto 0);  -- bits: data(63:0) count(67:64) last(68)
    error_sig         : out std_logic
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_serializer_flat_core_packer is

  -- Registers.
  signal ready              : std_logic := '1';
  signal packets_valid_q    : std_logic := '0';
  -- bits: data(63:0) count(67:64) last(68)
  signal payload            : unsigned(68 downto 0) := (others => '0');
  signal error_sig_q        : std_logic := '0';
  signal writes             : std_logic := '0';
  signal items_0_write_data : unsigned(63 downto 0) := (others => '0');
  signal items_start        : unsigned(6 downto 0) := (others => '0');
  signal items_size         : unsigned(3 downto 0) := (others => '0');
  signal map_placed         : unsigned(63 downto 0) := (others => '0');
  signal map_start          : unsigned(6 downto 0) := (others => '0');
  signal map_size           : unsigned(3 downto 0) := (others => '0');
  signal at                 : unsigned(6 downto 0) := (others => '0');
  signal complete_next      : unsigned(3 downto 0) := (others => '0');
  signal ends_packet        : std_logic := '0';
  signal failed             : std_logic := '0';
  signal waits              : std_logic := '0';
  signal last_bytes         : unsigned(3 downto 0) := (others => '0');
  signal bound              : unsigned(3 downto 0) := "0101";
  signal complete           : unsigned(3 downto 0) := (others => '0');
  signal last               : unsigned(7 downto 0) := (others => '0');
  signal items_0_has        : unsigned(7 downto 0) := (others => '0');
  signal map_0_has          : unsigned(7 downto 0) := (others => '0');
  signal map_4_has          : unsigned(7 downto 0) := (others => '0');
  signal first              : unsigned(3 downto 0) := (others => '0');

  -- Combinational signals.
  signal takes                      : std_logic;
  signal map_beat                   : unsigned(3 downto 0);
  signal total                      : unsigned(6 downto 0);
  signal total_8                    : unsigned(6 downto 0);
  signal base                       : unsigned(6 downto 0);
  signal end_sig                    : unsigned(6 downto 0);
  signal map_end                    : unsigned(6 downto 0);
  signal items_at                   : unsigned(6 downto 0);
  signal newest                     : unsigned(3 downto 0);
  signal room                       : unsigned(3 downto 0);
  signal ends_write_addr            : unsigned(2 downto 0);
  signal ends_write_en              : std_logic;
  signal commits                    : std_logic;
  signal frees_slot_0               : std_logic;
  signal frees_slot_1               : std_logic;
  signal frees_slot_2               : std_logic;
  signal frees_slot_3               : std_logic;
  signal frees_slot_4               : std_logic;
  signal frees_slot_5               : std_logic;
  signal frees_slot_6               : std_logic;
  signal frees_slot_7               : std_logic;
  signal items_used_0               : std_logic;
  signal items_0_written            : std_logic;
  signal map_used_0                 : std_logic;
  signal map_0_written              : std_logic;
  signal map_used_4                 : std_logic;
  signal map_4_written              : std_logic;
  signal reads                      : std_logic;
  signal is_last                    : std_logic;
  signal ends_read_data             : unsigned(4 downto 0);
  signal items_0_read_data          : unsigned(63 downto 0);
  signal map_0_read_data            : unsigned(31 downto 0);
  signal map_4_read_data            : unsigned(31 downto 0);
  signal words_payload_items        : unsigned(63 downto 0);
  signal words_payload_map          : unsigned(63 downto 0);
  signal words_payload_items_bytes  : unsigned(3 downto 0);
  signal words_payload_map_bytes    : unsigned(3 downto 0);
  signal words_payload_two_word_map : std_logic;
  signal words_payload_to_map       : unsigned(4 downto 0);
  signal words_payload_map_mask     : unsigned(2 downto 0);
  signal words_payload_to_end       : unsigned(5 downto 0);
  signal words_payload_end_mask     : unsigned(2 downto 0);
  signal words_payload_max_beats    : unsigned(2 downto 0);
  signal words_payload_last         : std_logic;
  signal words_payload_empty        : std_logic;
  signal words_payload_waits        : std_logic;
  signal words_payload_error        : std_logic;
  signal ends_read_data_count       : unsigned(3 downto 0);
  signal ends_read_data_error       : std_logic;

  type ends_array is array (0 to 7) of unsigned(4 downto 0);
  signal ends : ends_array := (others => (others => '0'));

  type items_0_array is array (0 to 7) of unsigned(63 downto 0);
  signal items_0 : items_0_array := (others => (others => '0'));

  type map_0_array is array (0 to 7) of unsigned(31 downto 0);
  signal map_0 : map_0_array := (others => (others => '0'));

  type map_4_array is array (0 to 7) of unsigned(31 downto 0);
  signal map_4 : map_4_array := (others => (others => '0'));
begin

  takes <= words_valid and ready;
  map_beat <= base(6 downto 3) + words_payload_two_word_map;
  total <= at + words_payload_to_map;
  total_8 <= base + words_payload_to_end;
  base <= (total and not resize(words_payload_map_mask, 7)) or resize(words_payload_map_mask and
      "100", 7);
  end_sig <= (total_8 and not resize(words_payload_end_mask, 7)) or
      resize(words_payload_end_mask and mux(words_payload_last, "000", "100"), 7);
  map_end <= unsigned'(map_beat & base(2 downto 0)) + words_payload_map_bytes;
  items_at <= base when words_payload_two_word_map = '1' else at;
  newest <= at(6 downto 3) + mux(takes, words_payload_max_beats, "000");
  room <= bound - newest;
  ends_write_addr <= complete_next(2 downto 0) - 1;
  ends_write_en <= writes and ends_packet;
  commits <= writes and not waits;
  frees_slot_0 <= '1' when reads = '1' and first(2 downto 0) = 0 else '0';
  frees_slot_1 <= '1' when reads = '1' and first(2 downto 0) = 1 else '0';
  frees_slot_2 <= '1' when reads = '1' and first(2 downto 0) = 2 else '0';
  frees_slot_3 <= '1' when reads = '1' and first(2 downto 0) = 3 else '0';
  frees_slot_4 <= '1' when reads = '1' and first(2 downto 0) = 4 else '0';
  frees_slot_5 <= '1' when reads = '1' and first(2 downto 0) = 5 else '0';
  frees_slot_6 <= '1' when reads = '1' and first(2 downto 0) = 6 else '0';
  frees_slot_7 <= '1' when reads = '1' and first(2 downto 0) = 7 else '0';
  items_used_0 <= '1' when writes = '1' and items_size > 0 else '0';
  items_0_written <= lsb(resize(shift_right(items_0_has, to_integer(first(2 downto 0))), 1));
  map_used_0 <= '1' when writes = '1' and map_size > 0 else '0';
  map_0_written <= lsb(resize(shift_right(map_0_has, to_integer(first(2 downto 0))), 1));
  map_used_4 <= '1' when writes = '1' and map_size > 4 else '0';
  map_4_written <= lsb(resize(shift_right(map_4_has, to_integer(first(2 downto 0))), 1));
  reads <= '1' when complete /= first and (packets_valid_q = '0' or packets_ready = '1') else '0';
  is_last <= lsb(resize(shift_right(last, to_integer(first(2 downto 0))), 1));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if ends_write_en = '1' then
        ends(to_integer(ends_write_addr)) <= failed & last_bytes;
      end if;
    end if;
  end process;

  ends_read_data <= ends(to_integer(first(2 downto 0)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if items_used_0 = '1' then
        items_0(to_integer(items_start(5 downto 3))) <= items_0_write_data;
      end if;
    end if;
  end process;

  items_0_read_data <= items_0(to_integer(first(2 downto 0)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if map_used_0 = '1' then
        map_0(to_integer(map_start(5 downto 3))) <= map_placed(31 downto 0);
      end if;
    end if;
  end process;

  map_0_read_data <= map_0(to_integer(first(2 downto 0)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if map_used_4 = '1' then
        map_4(to_integer(map_start(5 downto 3))) <= map_placed(63 downto 32);
      end if;
    end if;
  end process;

  map_4_read_data <= map_4(to_integer(first(2 downto 0)));

  p_aclk : process (aclk)
  begin
    if rising_edge(aclk) then
      if rst = '1' then
        writes <= '0';
        items_start <= (others => '0');
        items_size <= (others => '0');
        map_start <= (others => '0');
        map_size <= (others => '0');
        at <= (others => '0');
        complete_next <= (others => '0');
        ends_packet <= '0';
        failed <= '0';
        waits <= '0';
        last_bytes <= (others => '0');
        ready <= '1';
        bound <= "0101";
        complete <= (others => '0');
        last <= (others => '0');
        items_0_has <= (others => '0');
        map_0_has <= (others => '0');
        map_4_has <= (others => '0');
        packets_valid_q <= '0';
        first <= (others => '0');
      else
        writes <= takes;
        if takes = '1' then
          items_start <= items_at;
          items_size <= words_payload_items_bytes;
          map_start <= map_beat & base(2 downto 0);
          map_size <= words_payload_map_bytes;
          at <= end_sig;
          complete_next <= end_sig(6 downto 3);
          ends_packet <= words_payload_last;
          failed <= words_payload_error;
          waits <= words_payload_waits;
          if words_payload_empty = '1' then
            last_bytes <= (others => '0');
          else
            last_bytes <= resize(map_end(2 downto 0) - 1, 4) + 1;
          end if;
        end if;
        ready <= not room(3);
        if reads = '1' then
          bound <= bound + 1;
          first <= first + 1;
        end if;
        if commits = '1' then
          complete <= complete_next;
          if ends_packet = '1' then
            case ends_write_addr is
              when "000" =>
                last(0) <= '1';
              when "001" =>
                last(1) <= '1';
              when "010" =>
                last(2) <= '1';
              when "011" =>
                last(3) <= '1';
              when "100" =>
                last(4) <= '1';
              when "101" =>
                last(5) <= '1';
              when "110" =>
                last(6) <= '1';
              when "111" =>
                last(7) <= '1';
              when others =>
                null;
            end case;
          end if;
        end if;
        if reads = '1' then
          case first(2 downto 0) is
            when "000" =>
              last(0) <= '0';
            when "001" =>
              last(1) <= '0';
            when "010" =>
              last(2) <= '0';
            when "011" =>
              last(3) <= '0';
            when "100" =>
              last(4) <= '0';
            when "101" =>
              last(5) <= '0';
            when "110" =>
              last(6) <= '0';
            when "111" =>
              last(7) <= '0';
            when others =>
              null;
          end case;
        end if;
        if frees_slot_0 = '1' then
          items_0_has(0) <= '0';
        elsif items_used_0 = '1' and items_start(5 downto 3) = 0 then
          items_0_has(0) <= '1';
        end if;
        if frees_slot_1 = '1' then
          items_0_has(1) <= '0';
        elsif items_used_0 = '1' and items_start(5 downto 3) = 1 then
          items_0_has(1) <= '1';
        end if;
        if frees_slot_2 = '1' then
          items_0_has(2) <= '0';
        elsif items_used_0 = '1' and items_start(5 downto 3) = 2 then
          items_0_has(2) <= '1';
        end if;
        if frees_slot_3 = '1' then
          items_0_has(3) <= '0';
        elsif items_used_0 = '1' and items_start(5 downto 3) = 3 then
          items_0_has(3) <= '1';
        end if;
        if frees_slot_4 = '1' then
          items_0_has(4) <= '0';
        elsif items_used_0 = '1' and items_start(5 downto 3) = 4 then
          items_0_has(4) <= '1';
        end if;
        if frees_slot_5 = '1' then
          items_0_has(5) <= '0';
        elsif items_used_0 = '1' and items_start(5 downto 3) = 5 then
          items_0_has(5) <= '1';
        end if;
        if frees_slot_6 = '1' then
          items_0_has(6) <= '0';
        elsif items_used_0 = '1' and items_start(5 downto 3) = 6 then
          items_0_has(6) <= '1';
        end if;
        if frees_slot_7 = '1' then
          items_0_has(7) <= '0';
        elsif items_used_0 = '1' and items_start(5 downto 3) = 7 then
          items_0_has(7) <= '1';
        end if;
        if frees_slot_0 = '1' then
          map_0_has(0) <= '0';
        elsif map_used_0 = '1' and map_start(5 downto 3) = 0 then
          map_0_has(0) <= '1';
        end if;
        if frees_slot_1 = '1' then
          map_0_has(1) <= '0';
        elsif map_used_0 = '1' and map_start(5 downto 3) = 1 then
          map_0_has(1) <= '1';
        end if;
        if frees_slot_2 = '1' then
          map_0_has(2) <= '0';
        elsif map_used_0 = '1' and map_start(5 downto 3) = 2 then
          map_0_has(2) <= '1';
        end if;
        if frees_slot_3 = '1' then
          map_0_has(3) <= '0';
        elsif map_used_0 = '1' and map_start(5 downto 3) = 3 then
          map_0_has(3) <= '1';
        end if;
        if frees_slot_4 = '1' then
          map_0_has(4) <= '0';
        elsif map_used_0 = '1' and map_start(5 downto 3) = 4 then
          map_0_has(4) <= '1';
        end if;
        if frees_slot_5 = '1' then
          map_0_has(5) <= '0';
        elsif map_used_0 = '1' and map_start(5 downto 3) = 5 then
          map_0_has(5) <= '1';
        end if;
        if frees_slot_6 = '1' then
          map_0_has(6) <= '0';
        elsif map_used_0 = '1' and map_start(5 downto 3) = 6 then
          map_0_has(6) <= '1';
        end if;
        if frees_slot_7 = '1' then
          map_0_has(7) <= '0';
        elsif map_used_0 = '1' and map_start(5 downto 3) = 7 then
          map_0_has(7) <= '1';
        end if;
        if frees_slot_0 = '1' then
          map_4_has(0) <= '0';
        elsif map_used_4 = '1' and map_start(5 downto 3) = 0 then
          map_4_has(0) <= '1';
        end if;
        if frees_slot_1 = '1' then
          map_4_has(1) <= '0';
        elsif map_used_4 = '1' and map_start(5 downto 3) = 1 then
          map_4_has(1) <= '1';
        end if;
        if frees_slot_2 = '1' then
          map_4_has(2) <= '0';
        elsif map_used_4 = '1' and map_start(5 downto 3) = 2 then
          map_4_has(2) <= '1';
        end if;
        if frees_slot_3 = '1' then
          map_4_has(3) <= '0';
        elsif map_used_4 = '1' and map_start(5 downto 3) = 3 then
          map_4_has(3) <= '1';
        end if;
        if frees_slot_4 = '1' then
          map_4_has(4) <= '0';
        elsif map_used_4 = '1' and map_start(5 downto 3) = 4 then
          map_4_has(4) <= '1';
        end if;
        if frees_slot_5 = '1' then
          map_4_has(5) <= '0';
        elsif map_used_4 = '1' and map_start(5 downto 3) = 5 then
          map_4_has(5) <= '1';
        end if;
        if frees_slot_6 = '1' then
          map_4_has(6) <= '0';
        elsif map_used_4 = '1' and map_start(5 downto 3) = 6 then
          map_4_has(6) <= '1';
        end if;
        if frees_slot_7 = '1' then
          map_4_has(7) <= '0';
        elsif map_used_4 = '1' and map_start(5 downto 3) = 7 then
          map_4_has(7) <= '1';
        end if;
        if packets_ready = '1' then
          packets_valid_q <= '0';
        end if;
        if reads = '1' then
          packets_valid_q <= '1';
        end if;
      end if;
    end if;
  end process;

  p_aclk_2 : process (aclk)
  begin
    if rising_edge(aclk) then
      if takes = '1' then
        items_0_write_data <= words_payload_items;
        map_placed <= words_payload_map;
      end if;
      if reads = '1' then
        payload(63 downto 0) <= (mux(items_0_written, items_0_read_data(63 downto 32),
            x"00000000") or mux(map_4_written, map_4_read_data, x"00000000")) &
            (mux(items_0_written, items_0_read_data(31 downto 0), x"00000000") or mux(map_0_written,
            map_0_read_data, x"00000000"));
        payload(68) <= is_last;
        if is_last = '1' then
          payload(67 downto 64) <= ends_read_data_count;
        else
          payload(67 downto 64) <= "1000";
        end if;
        error_sig_q <= is_last and ends_read_data_error;
      end if;
    end if;
  end process;

  words_payload_items <= words_payload_0(63 downto 0);
  words_payload_map <= words_payload_0(127 downto 64);
  words_payload_items_bytes <= words_payload_128(3 downto 0);
  words_payload_map_bytes <= words_payload_128(7 downto 4);
  words_payload_two_word_map <= words_payload_128(8);
  words_payload_to_map <= words_payload_128(13 downto 9);
  words_payload_map_mask <= words_payload_128(16 downto 14);
  words_payload_to_end <= words_payload_128(22 downto 17);
  words_payload_end_mask <= words_payload_128(25 downto 23);
  words_payload_max_beats <= words_payload_128(28 downto 26);
  words_payload_last <= words_payload_128(29);
  words_payload_empty <= words_payload_128(30);
  words_payload_waits <= words_payload_128(31);
  words_payload_error <= words_payload_128(32);
  ends_read_data_count <= ends_read_data(3 downto 0);
  ends_read_data_error <= ends_read_data(4);

  words_ready <= ready;
  packets_valid <= packets_valid_q;
  packets_payload <= payload;
  error_sig <= error_sig_q;

end architecture;

-- Module geometry_msgs_msg_Twist_cdr_8_serializer.core of the Amaranth design.
-- Serializer: Turn messages into packets.
--
-- Leaves are taken in wire order, several in one cycle if they are valid. No leaf waits for a
-- later one. A length is taken one cycle after it is offered at the earliest. The serializer adds
-- the lengths on the wire, padding and terminators. A beat is valid `LATENCY_CYCLES["serializer"]`
-- cycles after the last leaf of the step that fills it. The `ready` of a leaf depends
-- combinationally on its own `valid` and on that of the earlier leaves of the same step; all other
-- outputs are registers. One clock domain, `sync`; its reset discards all messages and packets
-- inside.
--
-- Each packet ends in one transfer on `status`. A length over its bound is written unchanged, and
-- as many items are taken as it says. The packet is marked with an error, so that the receiver can
-- drop it. `length` decides how many items are taken; an `items.last` that disagrees marks the
-- packet with an error.

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
    message_linear_x_ready    : out std_logic;
    message_linear_y_ready    : out std_logic;
    message_linear_z_ready    : out std_logic;
    message_angular_x_ready   : out std_logic;
    message_angular_y_ready   : out std_logic;
    message_angular_z_ready   : out std_logic;
    status_valid              : out std_logic;
    -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
    status_payload            : out unsigned(2 downto 0);
    packets_valid             : out std_logic;
    -- bits: data(63:0) count(67:64) last(68)
    packets_payload           : out unsigned(68 downto 0);
    packet_error              : out std_logic
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_serializer_flat_core is

  -- Combinational signals.
  signal words_payload_0   : unsigned(127 downto 0);
  signal words_payload_128 : unsigned(32 downto 0);
  signal words_valid       : std_logic;
  signal words_ready       : std_logic;
begin

  collector : entity work.geometry_msgs_msg_twist_cdr_8_serializer_flat_core_collector
    port map (
      aclk                      => aclk,
      message_linear_x_payload  => message_linear_x_payload,
      message_linear_x_valid    => message_linear_x_valid,
      message_linear_y_payload  => message_linear_y_payload,
      message_linear_y_valid    => message_linear_y_valid,
      message_linear_z_payload  => message_linear_z_payload,
      message_linear_z_valid    => message_linear_z_valid,
      message_angular_x_payload => message_angular_x_payload,
      message_angular_x_valid   => message_angular_x_valid,
      message_angular_y_payload => message_angular_y_payload,
      message_angular_y_valid   => message_angular_y_valid,
      message_angular_z_payload => message_angular_z_payload,
      message_angular_z_valid   => message_angular_z_valid,
      status_ready              => status_ready,
      rst                       => rst,
      message_linear_x_ready    => message_linear_x_ready,
      message_linear_y_ready    => message_linear_y_ready,
      message_linear_z_ready    => message_linear_z_ready,
      message_angular_x_ready   => message_angular_x_ready,
      message_angular_y_ready   => message_angular_y_ready,
      message_angular_z_ready   => message_angular_z_ready,
      words_payload_0           => words_payload_0,
      words_payload_128         => words_payload_128,
      status_valid              => status_valid,
      status_payload            => status_payload,
      words_valid               => words_valid,
      words_ready               => words_ready
    );

  packer : entity work.geometry_msgs_msg_twist_cdr_8_serializer_flat_core_packer
    port map (
      aclk              => aclk,
      packets_ready     => packets_ready,
      rst               => rst,
      words_payload_0   => words_payload_0,
      words_payload_128 => words_payload_128,
      words_valid       => words_valid,
      words_ready       => words_ready,
      packets_valid     => packets_valid,
      packets_payload   => packets_payload,
      error_sig         => packet_error
    );

end architecture;

-- Module geometry_msgs_msg_Twist_cdr_8_serializer of the Amaranth design.
-- Top: A converter with AXI4-Stream on its packet side and named ports on its message side.
--
-- The top level adds neither registers nor latency. `aresetn` is active low and synchronous to the
-- rising edge of `aclk`; one cycle of reset discards all packets and messages inside. A last beat
-- without any ones in ``tkeep`` adds no bytes, so it can end an empty packet.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_serializer_flat is
  port (
    aclk                 : in  std_logic;
    aresetn              : in  std_logic;
    m_axis_tready        : in  std_logic;
    linear_x_data        : in  std_logic_vector(63 downto 0);
    linear_x_valid       : in  std_logic;
    linear_y_data        : in  std_logic_vector(63 downto 0);
    linear_y_valid       : in  std_logic;
    linear_z_data        : in  std_logic_vector(63 downto 0);
    linear_z_valid       : in  std_logic;
    angular_x_data       : in  std_logic_vector(63 downto 0);
    angular_x_valid      : in  std_logic;
    angular_y_data       : in  std_logic_vector(63 downto 0);
    angular_y_valid      : in  std_logic;
    angular_z_data       : in  std_logic_vector(63 downto 0);
    angular_z_valid      : in  std_logic;
    m_axis_status_tready : in  std_logic;
    m_axis_tdata         : out std_logic_vector(63 downto 0);
    m_axis_tkeep         : out std_logic_vector(7 downto 0);
    m_axis_tlast         : out std_logic;
    m_axis_tuser         : out std_logic;
    m_axis_tvalid        : out std_logic;
    linear_x_ready       : out std_logic;
    linear_y_ready       : out std_logic;
    linear_z_ready       : out std_logic;
    angular_x_ready      : out std_logic;
    angular_y_ready      : out std_logic;
    angular_z_ready      : out std_logic;
    m_axis_status_tdata  : out std_logic_vector(7 downto 0);
    m_axis_status_tvalid : out std_logic
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_serializer_flat is

  -- Combinational signals.
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal status_payload        : unsigned(2 downto 0);
  signal packets_payload       : unsigned(68 downto 0);
  signal rst                   : std_logic;
  signal packets_payload_count : unsigned(3 downto 0);
begin

  core : entity work.geometry_msgs_msg_twist_cdr_8_serializer_flat_core
    port map (
      aclk                      => aclk,
      packets_ready             => m_axis_tready,
      message_linear_x_payload  => unsigned(linear_x_data),
      message_linear_x_valid    => linear_x_valid,
      message_linear_y_payload  => unsigned(linear_y_data),
      message_linear_y_valid    => linear_y_valid,
      message_linear_z_payload  => unsigned(linear_z_data),
      message_linear_z_valid    => linear_z_valid,
      message_angular_x_payload => unsigned(angular_x_data),
      message_angular_x_valid   => angular_x_valid,
      message_angular_y_payload => unsigned(angular_y_data),
      message_angular_y_valid   => angular_y_valid,
      message_angular_z_payload => unsigned(angular_z_data),
      message_angular_z_valid   => angular_z_valid,
      status_ready              => m_axis_status_tready,
      rst                       => rst,
      message_linear_x_ready    => linear_x_ready,
      message_linear_y_ready    => linear_y_ready,
      message_linear_z_ready    => linear_z_ready,
      message_angular_x_ready   => angular_x_ready,
      message_angular_y_ready   => angular_y_ready,
      message_angular_z_ready   => angular_z_ready,
      status_valid              => m_axis_status_tvalid,
      status_payload            => status_payload,
      packets_valid             => m_axis_tvalid,
      packets_payload           => packets_payload,
      packet_error              => m_axis_tuser
    );

  rst <= not aresetn;

  m_axis_tdata <= std_logic_vector(packets_payload(63 downto 0));
  m_axis_tkeep <= std_logic_vector(unsigned'(to_std_logic(packets_payload_count > 7) &
      to_std_logic(packets_payload_count > 6) & to_std_logic(packets_payload_count > 5) &
      to_std_logic(packets_payload_count > 4) & to_std_logic(packets_payload_count > 3) &
      to_std_logic(packets_payload_count > 2) & to_std_logic(packets_payload_count > 1) &
      to_std_logic(packets_payload_count > 0)));
  m_axis_tlast <= packets_payload(68);
  m_axis_status_tdata <= std_logic_vector(resize(status_payload, 8));
  packets_payload_count <= packets_payload(67 downto 64);

end architecture;
