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
-- deserializer: start 0, items from lane 0, unit 8, map from lane 0, unit 4
--   0 linear_x: map of 8; begins linear.x; checks 0=00 1=01; to 1 (+8)
--   1 linear_x_2: map of 8; linear.x; begins linear.y; to 2 (+8)
--   2 linear_y: map of 8; linear.y; begins linear.z; to 3 (+8)
--   3 linear_z: map of 8; linear.z; begins angular.x; to 4 (+8)
--   4 angular_x: map of 8; angular.x; begins angular.y; to 5 (+12)
--   5 angular_y: map of 12 in two words; angular.y angular.z; to end (+0)
--   6 packet_end: end of the packet
-- A status has 3 bits inside, and 8 at its ports, as the constants of firm_hdl_types_pkg.
-- Module geometry_msgs_msg_Twist_cdr_8_deserializer.core.buffer of the Amaranth design.
-- Buffer: Give each beat a position in the ring; tell how many bytes of the current packet
-- arrived.
--
-- The buffer itself stores no bytes: its readers write `beat` to memories of their own, and read
-- it from the next cycle on. The sequencer stores decoded lengths and flags, the mover the bytes.
--
-- Latency 1 cycle from `packets` to `arrival.beat`, and 2 cycles to `arrival.limit`.
-- 11 registers at rising_edge(aclk), synchronous reset rst = '1'.
-- 1 register at rising_edge(aclk), no reset.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_buffer is
  port (
    rst               : in  std_logic;
    aclk              : in  std_logic;
    packets_valid     : in  std_logic;
    arrival_next      : in  std_logic;
    freed             : in  unsigned(3 downto 0);
    packets_payload   : in  unsigned(68 downto 0);  -- bits: data(63:0) count(67:64) last(68)
    -- bits: data(63:0) count(67:64) last(68) at(72:69) valid(73)
    arrival_beat      : out unsigned(73 downto 0);
    packets_ready     : out std_logic;
    arrival_limit     : out unsigned(6 downto 0);
    arrival_following : out unsigned(3 downto 0);
    arrival_ended     : out std_logic
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_buffer is

  -- Registers.
  signal room                : std_logic := '1';
  signal arrival_limit_q     : unsigned(6 downto 0) := (others => '0');
  signal arrival_following_q : unsigned(3 downto 0) := (others => '0');
  signal arrival_ended_q     : std_logic := '0';
  signal full                : std_logic := '0';
  -- bits as of packets_payload
  signal payload             : unsigned(68 downto 0) := (others => '0');
  signal arrived             : unsigned(3 downto 0) := (others => '0');
  signal at                  : unsigned(3 downto 0) := (others => '0');
  -- the end of the packet after the current one; bits: limit(6:0) following(10:7)
  signal second              : unsigned(10 downto 0) := (others => '0');
  signal has_second          : std_logic := '0';
  -- ends stored in the memory, modulo 2 laps
  signal pushed              : unsigned(3 downto 0) := (others => '0');
  -- ends taken out of it, modulo 2 laps
  signal popped              : unsigned(3 downto 0) := (others => '0');

  -- Combinational signals.
  signal arrives         : std_logic;
  signal used            : unsigned(3 downto 0);
  signal end_following   : unsigned(3 downto 0);
  signal ends_now        : std_logic;
  signal end_limit       : unsigned(6 downto 0);
  signal newest_limit    : unsigned(6 downto 0);
  signal stored          : std_logic;
  signal first           : unsigned(10 downto 0);
  signal more            : std_logic;
  signal follows         : std_logic;
  signal takes_first     : std_logic;
  signal has_second_next : std_logic;
  signal ends_read_data  : unsigned(10 downto 0);
  signal payload_count   : unsigned(3 downto 0);
  signal payload_last    : std_logic;
  signal first_limit     : unsigned(6 downto 0);
  signal first_following : unsigned(3 downto 0);

  type ends_array is array (0 to 7) of unsigned(10 downto 0);
  signal ends : ends_array := (others => (others => '0'));
begin

  arrives <= packets_valid and room;
  used <= arrived - freed;
  end_following <= at + 1;
  ends_now <= full and payload_last;
  end_limit <= unsigned'(at & "000") + payload_count;
  newest_limit <= end_limit when ends_now = '1' else mux(full, end_following, at) & "000";
  stored <= '1' when pushed /= popped else '0';
  first <= second when has_second = '1' else end_following & newest_limit;
  more <= stored or ends_now;
  follows <= arrival_ended_q and ends_now;
  takes_first <= arrival_next or not arrival_ended_q;
  has_second_next <= not arrival_next or more when has_second = '1' else not arrival_next and
      follows;

  process (aclk)
  begin
    if rising_edge(aclk) then
      ends(to_integer(pushed(2 downto 0))) <= end_following & end_limit;
    end if;
  end process;

  ends_read_data <= ends(to_integer(popped(2 downto 0)));

  p_aclk : process (aclk)
  begin
    if rising_edge(aclk) then
      if rst = '1' then
        full <= '0';
        arrived <= (others => '0');
        at <= (others => '0');
        room <= '1';
        arrival_limit_q <= (others => '0');
        arrival_following_q <= (others => '0');
        arrival_ended_q <= '0';
        second <= (others => '0');
        has_second <= '0';
        pushed <= (others => '0');
        popped <= (others => '0');
      else
        full <= arrives;
        arrived <= arrived + arrives;
        at <= at + full;
        room <= not used(3) and not (to_std_logic(used = 7) and arrives);
        if takes_first = '1' then
          arrival_limit_q <= first_limit;
          arrival_following_q <= first_following;
          arrival_ended_q <= has_second or ends_now;
        end if;
        if arrival_next = '1' or has_second = '0' then
          if stored = '1' then
            second <= ends_read_data;
          else
            second <= end_following & end_limit;
          end if;
        end if;
        has_second <= has_second_next;
        if has_second = '1' and ends_now = '1' then
          pushed <= pushed + 1;
        end if;
        if arrival_next = '1' and has_second = '1' and more = '1' then
          popped <= popped + 1;
        end if;
      end if;
    end if;
  end process;

  p_aclk_2 : process (aclk)
  begin
    if rising_edge(aclk) then
      payload <= packets_payload;
    end if;
  end process;

  payload_count <= payload(67 downto 64);
  payload_last <= payload(68);
  first_limit <= first(6 downto 0);
  first_following <= first(10 downto 7);
  arrival_beat <= full & at & payload;

  packets_ready <= room;
  arrival_limit <= arrival_limit_q;
  arrival_following <= arrival_following_q;
  arrival_ended <= arrival_ended_q;

end architecture;

-- Module geometry_msgs_msg_Twist_cdr_8_deserializer.core.sequencer.byte_flags of the Amaranth design.
-- ByteFlags: Flags of the packet buffer: one for each byte, and those of headers for each beat.
--
-- Whether a beat is that of a header is not known as it arrives. So every beat is compared with
-- the checked bytes of each header state, and the sequencer reads the flag of the right beat.
--
-- Flags are written together with their beat, and read combinationally.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_sequencer_byte_flags is
  port (
    rst       : in  std_logic;
    aclk      : in  std_logic;
    mismatch  : out std_logic;
    -- bits: data(63:0) count(67:64) last(68) at(72:69) valid(73)
    beat      : in  unsigned(73 downto 0);
    header_at : in  unsigned(3 downto 0)
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_sequencer_byte_flags is

  -- Combinational signals.
  signal headers_table_write_data : std_logic;
  signal beat_data                : unsigned(63 downto 0);
  signal beat_count               : unsigned(3 downto 0);
  signal beat_last                : std_logic;
  signal beat_at                  : unsigned(3 downto 0);
  signal beat_valid               : std_logic;

  type headers_table_array is array (0 to 7) of unsigned(0 downto 0);
  signal headers_table : headers_table_array := (others => (others => '0'));
begin

  headers_table_write_data <= (to_std_logic(beat_data(7 downto 0) /= 0) and (not beat_last or
      to_std_logic(beat_count > 0))) or (to_std_logic(beat_data(15 downto 8) /= 1) and
      (not beat_last or to_std_logic(beat_count > 1)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat_valid = '1' then
        headers_table(to_integer(beat_at(2 downto 0))) <= (0 => headers_table_write_data);
      end if;
    end if;
  end process;

  mismatch <= headers_table(to_integer(header_at(2 downto 0)))(0);

  beat_data <= beat(63 downto 0);
  beat_count <= beat(67 downto 64);
  beat_last <= beat(68);
  beat_at <= beat(72 downto 69);
  beat_valid <= beat(73);

end architecture;

-- Module geometry_msgs_msg_Twist_cdr_8_deserializer.core.sequencer of the Amaranth design.
-- Sequencer: Run a program over the packets in the buffer: check them, and give orders to the
-- mover.
--
-- Each state gives one order, once all its bytes are in the buffer. The sequencer waits only for
-- bytes and for `orders.ready`. The last order of a packet carries its status. The page "How the
-- converters work" follows one packet through all cycles.
--
-- An error in the bytes of a state takes two cycles: one finds it, and one computes which bytes
-- are good. Then the state is ordered with its good bytes. All later states are ordered without
-- bytes and with lengths of 0, and the rest of the packet is dropped:
--
--     cycle         | 0        | 1         | 2            | 3
--     state         | s        | s         | s            | next one
--     found         | 1        |           |              |
--     bad           |          | 1         | 1            | 1
--     new_error     |          | 1         |              |
--     *_room        |          |           | good bytes   | 0
--     orders.valid  |          |           | s            | next one
--
-- A length over its limit takes no cycle: its state transfers it as 0.
--
-- A length that is charged to the Budget stalls the sequencer before the next state. Its
-- order waits, too. If the length claims too much, its order transfers it as 0, and the sequencer
-- goes back to the length's state, and leaves it with an order that has no state:
--
--     cycle         | 0        | 1         | 2         | 3         | 4           | 5
--     state         | length   | body      | body      | body      | body        | length
--     pending       |          | 1         | 1         | 1         | 1           |
--     zero_length   |          |           |           |           | 1           |
--     orders.valid  | length   |           |           |           |             | blank
-- 21 registers at rising_edge(aclk), synchronous reset rst = '1'.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_sequencer is
  port (
    rst               : in  std_logic;
    aclk              : in  std_logic;
    orders_valid      : out std_logic;
    arrival_next      : out std_logic;
    orders_ready      : in  std_logic;
    -- bits: data(63:0) count(67:64) last(68) at(72:69) valid(73)
    beat              : in  unsigned(73 downto 0);
    arrival_limit     : in  unsigned(6 downto 0);
    arrival_following : in  unsigned(3 downto 0);
    arrival_ended     : in  std_logic;
    -- bits: step(2:0) blank(3) items_at(9:4) map_at(15:10) items_next(18:16) map_next(21:19)
    -- items_bytes(25:22) map_bytes(29:26) items(30) last(31) length_good(32) final(33) first(37:34)
    -- ends(38) status(41:39)
    orders_payload    : out unsigned(41 downto 0);
    header_at         : out unsigned(3 downto 0)
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_sequencer is

  -- Values of enumerations.
  constant STATUS_OK : unsigned(2 downto 0) := "000";
  constant STATUS_TRUNCATED : unsigned(2 downto 0) := "001";
  constant STATUS_TRAILING : unsigned(2 downto 0) := "010";
  constant STATUS_LENGTH : unsigned(2 downto 0) := "011";
  constant STATUS_ENCAPSULATION : unsigned(2 downto 0) := "100";
  constant STATUS_STRING : unsigned(2 downto 0) := "101";

  -- Registers.
  signal bad             : std_logic := '0';
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal code            : unsigned(2 downto 0) := (others => '0');
  signal new_error       : std_logic := '0';
  signal items_room      : unsigned(3 downto 0) := (others => '0');
  signal map_room        : unsigned(3 downto 0) := (others => '0');
  signal rest            : std_logic := '0';  -- items in the rest of the run
  signal has_nul         : std_logic := '0';
  -- first byte after the step before
  signal first_at        : unsigned(6 downto 0) := (others => '0');
  -- last byte of the step's map or word
  signal last_at         : unsigned(6 downto 0) := "0000111";
  signal words_last      : std_logic := '1';  -- one is left
  signal step_linear_x   : std_logic := '1';  -- step 0: map of 8; begins linear.x
  signal step_linear_x_2 : std_logic := '0';  -- step 1: map of 8; linear.x; begins linear.y
  signal step_linear_y   : std_logic := '0';  -- step 2: map of 8; linear.y; begins linear.z
  signal step_linear_z   : std_logic := '0';  -- step 3: map of 8; linear.z; begins angular.x
  signal step_angular_x  : std_logic := '0';  -- step 4: map of 8; angular.x; begins angular.y
  signal step_angular_y  : std_logic := '0';  -- step 5: map of 12 in two words; angular.y angular.z
  signal step_packet_end : std_logic := '0';  -- step 6: end of the packet
  signal at_end          : std_logic := '0';  -- the message is over, but not the packet
  -- signed: first byte of the map's last word, relative to last_at
  signal map_offset      : unsigned(4 downto 0) := "11001";
  signal two_word_map    : std_logic := '0';  -- the map has two bus words
  -- bytes from last_at to the last byte of the step after it
  signal exit_add        : unsigned(5 downto 0) := "001000";

  -- Combinational signals.
  signal mismatch                   : std_logic;
  signal not_last_at                : unsigned(6 downto 0);  -- -1 - last_at
  signal step_end                   : unsigned(6 downto 0);
  signal left                       : unsigned(6 downto 0);
  signal present                    : std_logic;
  signal ends_message               : std_logic;
  signal ends_packet                : std_logic;
  signal header_error               : std_logic;
  signal cut                        : std_logic;
  signal trailing                   : std_logic;
  signal bytes_good                 : std_logic;
  signal stops                      : std_logic;
  signal drains                     : std_logic;
  signal length_accepted            : std_logic;
  signal allowed                    : std_logic;
  signal issue                      : std_logic;
  signal first_beat_of_map          : unsigned(3 downto 0);
  signal map_at                     : unsigned(6 downto 0);
  signal one_less_map_offset        : unsigned(5 downto 0);  -- 1 - map_offset, signed
  -- of the sum of three numbers, bit by bit; one addition is left
  signal map_left_carries           : unsigned(5 downto 0);
  signal map_left_without_carries   : unsigned(6 downto 0);
  signal map_left                   : unsigned(6 downto 0);  -- signed: limit - map_at
  signal map_room_if_cut            : unsigned(3 downto 0);
  signal items_left                 : unsigned(6 downto 0);
  signal rest_room_if_cut           : unsigned(3 downto 0);
  signal items_room_if_cut          : unsigned(3 downto 0);
  signal bad_drained                : std_logic;
  signal orders_payload_items_next  : unsigned(2 downto 0);
  signal orders_payload_map_next    : unsigned(2 downto 0);
  signal orders_payload_items_bytes : unsigned(3 downto 0);
  signal orders_payload_map_bytes   : unsigned(3 downto 0);
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal orders_payload_status      : unsigned(2 downto 0);
  signal exit_sum                   : unsigned(6 downto 0);
  -- its first step ends 7 bytes after its first byte
  signal last_at_of_next_packet     : unsigned(6 downto 0);
  signal early_last_at              : unsigned(6 downto 0);
  signal first_at_if_bad            : unsigned(6 downto 0);
  signal moves_on                   : std_logic;
  signal map_offset_next_3          : std_logic;  -- also map_offset_next_4
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal good_status                : unsigned(2 downto 0);
  signal orders_payload_map_at      : unsigned(5 downto 0);
begin

  byte_flags : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_sequencer_byte_flags
    port map (
      aclk      => aclk,
      rst       => rst,
      mismatch  => mismatch,
      beat      => beat,
      header_at => first_at(6 downto 3)
    );

  not_last_at <= not last_at;
  step_end <= last_at + 1;
  left <= arrival_limit + not_last_at;
  present <= not left(6);
  ends_message <= at_end or step_angular_y;
  ends_packet <= ends_message and arrival_ended;
  header_error <= '1' when step_linear_x = '1' and mismatch = '1' and arrival_limit /= first_at else
      '0';
  cut <= arrival_ended and not present;
  trailing <= present and (or left(5 downto 2));
  bytes_good <= present and not (step_linear_x and mismatch);
  stops <= header_error or cut or (ends_message and not arrival_ended and trailing);
  drains <= bad and not new_error and (not at_end or arrival_ended);
  length_accepted <= not bad;
  allowed <= length_accepted and (not ends_message or arrival_ended);
  orders_valid <= drains or (allowed and bytes_good);
  issue <= (drains and orders_ready) or (allowed and orders_ready and bytes_good);
  arrival_next <= (drains and orders_ready and ends_packet) or (allowed and orders_ready and
      ends_packet and bytes_good);
  first_beat_of_map <= map_at(6 downto 3) - two_word_map;
  map_at <= last_at + sign_extend(map_offset, 7);
  one_less_map_offset <= unsigned'("000001") - sign_extend(map_offset, 6);
  map_left_carries <= (arrival_limit(5 downto 0) and not_last_at(5 downto 0)) or
      (arrival_limit(5 downto 0) and one_less_map_offset) or (not_last_at(5 downto 0) and
      one_less_map_offset);
  map_left_without_carries <= arrival_limit xor not_last_at xor sign_extend(one_less_map_offset, 7);
  map_left <= map_left_without_carries + unsigned'(map_left_carries & '0');
  map_room_if_cut <= (others => '0') when map_left(6) = '1' else mux(to_std_logic(map_left >= 8),
      "1000", map_left(3 downto 0));
  items_left <= arrival_limit - first_at;
  rest_room_if_cut <= (others => '0') when items_left(6) = '1' else
      mux(to_std_logic(items_left >= 8), "1000", items_left(3 downto 0));
  items_room_if_cut <= mux(map_left(6), resize(mux(and map_left(6 downto 3), map_left(2 downto 0),
      "000"), 4), "1000") when two_word_map = '1' else map_room_if_cut;
  bad_drained <= bad and drains and orders_ready;
  orders_payload_items_next <= first_beat_of_map(2 downto 0) + 1;
  orders_payload_map_next <= orders_payload_map_at(5 downto 3) + 1;
  orders_payload_items_bytes <= items_room when bad = '1' and items_room < 8 else "1000";
  orders_payload_map_bytes <= map_room when bad = '1' else "1000";
  orders_payload_status <= code when bad = '1' else good_status;
  exit_sum <= last_at + exit_add;
  last_at_of_next_packet <= unsigned'(arrival_following & "000") + 7;
  early_last_at <= last_at_of_next_packet when ends_packet = '1' else exit_sum;
  first_at_if_bad <= arrival_limit when at_end = '1' else first_at;
  moves_on <= issue and not ends_packet;
  map_offset_next_3 <= step_linear_x or step_linear_x_2 or step_linear_y or step_linear_z or
      step_angular_x;

  good_status <= STATUS_TRAILING when trailing = '1' else
                 STATUS_OK;

  p_aclk : process (aclk)
  begin
    if rising_edge(aclk) then
      if rst = '1' then
        bad <= '0';
        code <= (others => '0');
        new_error <= '0';
        items_room <= (others => '0');
        map_room <= (others => '0');
        rest <= '0';
        has_nul <= '0';
        first_at <= (others => '0');
        last_at <= "0000111";
        words_last <= '1';
        step_linear_x <= '1';
        step_linear_x_2 <= '0';
        step_linear_y <= '0';
        step_linear_z <= '0';
        step_angular_x <= '0';
        step_angular_y <= '0';
        step_packet_end <= '0';
        at_end <= '0';
        map_offset <= "11001";
        two_word_map <= '0';
        exit_add <= "001000";
      else
        if issue = '1' and ends_packet = '1' then
          bad <= '0';
        elsif length_accepted = '1' then
          bad <= stops;
          if ends_message = '1' then
            code <= STATUS_TRAILING;
          else
            code <= STATUS_LENGTH;
          end if;
          if header_error = '1' then
            code <= STATUS_ENCAPSULATION;
          elsif cut = '1' then
            code <= STATUS_TRUNCATED;
          end if;
        end if;
        new_error <= stops and length_accepted;
        if bad = '1' and new_error = '1' then
          if code = STATUS_TRAILING or code = STATUS_STRING then
            items_room <= "1000";
          else
            items_room <= (others => '0');
          end if;
          if code = STATUS_TRUNCATED then
            items_room <= items_room_if_cut;
          end if;
          if code = STATUS_TRAILING then
            map_room <= "1000";
          else
            map_room <= (others => '0');
          end if;
          if code = STATUS_TRUNCATED then
            map_room <= map_room_if_cut;
          end if;
        elsif bad_drained = '1' then
          items_room <= (others => '0');
          map_room <= (others => '0');
        end if;
        if issue = '1' then
          if ends_packet = '1' then
            rest <= '0';
            has_nul <= '0';
          end if;
          last_at <= early_last_at;
          if ends_packet = '1' then
            step_linear_x <= '1';
            step_linear_x_2 <= '0';
            step_linear_y <= '0';
            step_linear_z <= '0';
            step_angular_x <= '0';
            step_angular_y <= '0';
            step_packet_end <= '0';
            at_end <= '0';
            map_offset <= "11001";
            two_word_map <= '0';
            exit_add <= "001000";
          else
            step_linear_x <= '0';
            step_linear_x_2 <= step_linear_x;
            step_linear_y <= step_linear_x_2;
            step_linear_z <= step_linear_y;
            step_angular_x <= step_linear_z;
            step_angular_y <= step_angular_x;
            step_packet_end <= step_angular_y;
            at_end <= step_angular_y;
            map_offset <= repeat_bit(map_offset_next_3, 2) & step_angular_x & '0' &
                (step_linear_x or step_linear_x_2 or step_linear_y or step_linear_z or
                step_angular_x or step_angular_y);
            two_word_map <= step_angular_x;
            exit_add <= resize(unsigned'((step_linear_x or step_linear_x_2 or step_linear_y or
                step_linear_z) & step_linear_z & "00"), 6);
          end if;
        end if;
        if issue = '1' or (bad = '1' and at_end = '1') then
          if ends_packet = '1' then
            first_at <= arrival_following & "000";
          else
            if bad = '1' then
              first_at <= first_at_if_bad;
            else
              first_at <= step_end;
            end if;
          end if;
        end if;
        words_last <= words_last;
      end if;
    end if;
  end process;

  header_at <= first_at(6 downto 3);
  orders_payload_map_at <= map_at(5 downto 0);
  orders_payload <= orders_payload_status & ends_packet & first_at(6 downto 3) & '0' &
      length_accepted & words_last & '0' & orders_payload_map_bytes & orders_payload_items_bytes &
      orders_payload_map_next & orders_payload_items_next & map_at(5 downto 0) &
      first_beat_of_map(2 downto 0) & map_at(2 downto 0) & at_end & (step_angular_x or
      step_angular_y) & (step_linear_y or step_linear_z) & (step_linear_x_2 or step_linear_z or
      step_angular_y);

end architecture;

-- Module geometry_msgs_msg_Twist_cdr_8_deserializer.core.queue of the Amaranth design.
-- OrderQueue: A queue of two orders, so that `i.ready` is a register.
-- 3 registers at rising_edge(aclk), synchronous reset rst = '1'.
-- 1 register at rising_edge(aclk), no reset.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_queue is
  port (
    rst       : in  std_logic;
    aclk      : in  std_logic;
    i_valid   : in  std_logic;
    i_ready   : out std_logic;
    freed     : out unsigned(3 downto 0);
    o_ready   : in  std_logic;
    -- bits: step(2:0) blank(3) items_at(9:4) map_at(15:10) items_next(18:16) map_next(21:19)
    -- items_bytes(25:22) map_bytes(29:26) items(30) last(31) length_good(32) final(33) first(37:34)
    -- ends(38) status(41:39)
    i_payload : in  unsigned(41 downto 0);
    oldest    : in  unsigned(3 downto 0);
    o_valid   : out std_logic;
    o_payload : out unsigned(41 downto 0)  -- bits as of i_payload
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_queue is

  -- Registers.
  signal o_valid_q   : std_logic := '0';
  signal o_payload_q : unsigned(41 downto 0) := (others => '0');  -- bits as of i_payload
  signal has_second  : std_logic := '0';
  -- the order that came while o was waiting; bits as of i_payload
  signal second      : unsigned(41 downto 0) := (others => '0');

  -- Combinational signals.
  signal second_first    : unsigned(3 downto 0);
  signal o_payload_first : unsigned(3 downto 0);
begin

  i_ready <= not has_second;
  freed <= o_payload_first when o_valid_q = '1' else mux(has_second, second_first, oldest);

  p_aclk : process (aclk)
  begin
    if rising_edge(aclk) then
      if rst = '1' then
        o_valid_q <= '0';
        o_payload_q <= (others => '0');
        has_second <= '0';
      else
        if o_ready = '1' then
          o_valid_q <= i_valid or has_second;
          if has_second = '1' then
            o_payload_q <= second;
          else
            o_payload_q <= i_payload;
          end if;
        end if;
        if o_ready = '1' then
          has_second <= '0';
        elsif i_valid = '1' then
          has_second <= '1';
        end if;
      end if;
    end if;
  end process;

  p_aclk_2 : process (aclk)
  begin
    if rising_edge(aclk) then
      if i_ready = '1' then
        second <= i_payload;
      end if;
    end if;
  end process;

  second_first <= second(37 downto 34);
  o_payload_first <= o_payload_q(37 downto 34);

  o_valid <= o_valid_q;
  o_payload <= o_payload_q;

end architecture;

-- Module geometry_msgs_msg_Twist_cdr_8_deserializer.core.mover of the Amaranth design.
-- Mover: Read two words of the packet buffer per order, and write leaves from their lanes.
--
-- One cycle reads the words and rotates their first bytes to lane 0; the next cycle writes the
-- leaves. So a leaf is valid 2 cycles after its order. Leaves of a state become valid in wire
-- order, each as soon as its register is free. A leaf whose register is full delays only later
-- leaves:
--
--     cycle           | 0        | 1             | 2
--     orders          | a        | b             | c
--     words           |          | of a          | of b
--     leaves of a     |          | are written   | valid
-- 24 registers at rising_edge(aclk), synchronous reset rst = '1'.
-- 11 registers at rising_edge(aclk), no reset.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_mover is
  port (
    rst                       : in  std_logic;
    aclk                      : in  std_logic;
    message_linear_x_ready    : in  std_logic;
    message_linear_y_ready    : in  std_logic;
    message_linear_z_ready    : in  std_logic;
    message_angular_x_ready   : in  std_logic;
    message_angular_y_ready   : in  std_logic;
    message_angular_z_ready   : in  std_logic;
    status_ready              : in  std_logic;
    orders_ready              : out std_logic;
    -- bits: data(63:0) count(67:64) last(68) at(72:69) valid(73)
    beat                      : in  unsigned(73 downto 0);
    orders_valid              : in  std_logic;
    -- bits: step(2:0) blank(3) items_at(9:4) map_at(15:10) items_next(18:16) map_next(21:19)
    -- items_bytes(25:22) map_bytes(29:26) items(30) last(31) length_good(32) final(33) first(37:34)
    -- ends(38) status(41:39)
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

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_mover is

  -- Values of enumerations.
  constant STEP_LINEAR_X : unsigned(2 downto 0) := "000";
  constant STEP_LINEAR_X_2 : unsigned(2 downto 0) := "001";
  constant STEP_LINEAR_Y : unsigned(2 downto 0) := "010";
  constant STEP_LINEAR_Z : unsigned(2 downto 0) := "011";
  constant STEP_ANGULAR_X : unsigned(2 downto 0) := "100";
  constant STEP_ANGULAR_Y : unsigned(2 downto 0) := "101";

  -- Registers.
  signal message_linear_x_valid_q  : std_logic := '0';
  signal message_linear_y_valid_q  : std_logic := '0';
  signal message_linear_z_valid_q  : std_logic := '0';
  signal message_angular_x_valid_q : std_logic := '0';
  signal message_angular_y_valid_q : std_logic := '0';
  signal message_angular_z_valid_q : std_logic := '0';
  signal status_valid_q            : std_logic := '0';
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal status_payload_q          : unsigned(2 downto 0) := (others => '0');
  signal payload_linear_x          : unsigned(63 downto 0) := (others => '0');
  signal payload_linear_y          : unsigned(63 downto 0) := (others => '0');
  signal payload_linear_z          : unsigned(63 downto 0) := (others => '0');
  signal payload_angular_x         : unsigned(63 downto 0) := (others => '0');
  signal payload_angular_y         : unsigned(63 downto 0) := (others => '0');
  signal payload_angular_z         : unsigned(63 downto 0) := (others => '0');
  signal length_good               : std_logic := '0';
  signal last                      : std_logic := '0';
  signal items_word                : unsigned(63 downto 0) := (others => '0');
  -- bit k: byte k of the word is good; else its value is written as 0
  signal items_good                : unsigned(7 downto 0) := (others => '0');
  signal map_word                  : unsigned(63 downto 0) := (others => '0');
  -- bit k: byte k of the word is good; else its value is written as 0
  signal map_good                  : unsigned(7 downto 0) := (others => '0');
  signal begins_linear_x           : std_logic := '0';
  signal carried                   : unsigned(31 downto 0) := (others => '0');
  signal begins_linear_x_2         : std_logic := '0';
  signal begins_linear_y           : std_logic := '0';
  signal begins_linear_z           : std_logic := '0';
  signal begins_angular_x          : std_logic := '0';
  signal active_linear_x           : std_logic := '0';
  signal active_linear_y           : std_logic := '0';
  signal active_linear_z           : std_logic := '0';
  signal active_angular_x          : std_logic := '0';
  signal active_angular_y          : std_logic := '0';
  signal active_angular_z          : std_logic := '0';
  signal ends_now                  : std_logic := '0';
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal status_now                : unsigned(2 downto 0) := (others => '0');
  -- a leaf of the order that is executed, or the status, is full
  signal slow                      : std_logic := '0';

  -- Combinational signals.
  signal full_linear_x              : std_logic;
  signal full_linear_y              : std_logic;
  signal full_linear_z              : std_logic;
  signal full_angular_x             : std_logic;
  signal full_angular_y             : std_logic;
  signal full_angular_z             : std_logic;
  signal status_full                : std_logic;
  signal has_step                   : std_logic;
  signal chosen_step_linear_x_2     : std_logic;
  signal blocked_linear_x           : std_logic;
  signal go_linear_x                : std_logic;
  signal chosen_step_linear_y       : std_logic;
  signal blocked_linear_y           : std_logic;
  signal go_linear_y                : std_logic;
  signal chosen_step_linear_z       : std_logic;
  signal blocked_linear_z           : std_logic;
  signal go_linear_z                : std_logic;
  signal chosen_step_angular_x      : std_logic;
  signal blocked_angular_x          : std_logic;
  signal go_angular_x               : std_logic;
  signal chosen_step_angular_y      : std_logic;
  signal blocked_angular_y          : std_logic;
  signal go_angular_y               : std_logic;
  signal blocked_angular_z          : std_logic;
  signal go_angular_z               : std_logic;
  signal ends                       : std_logic;
  signal next_order_is_slow         : std_logic;
  signal order_stays_slow           : std_logic;
  signal carried_part               : std_logic;
  signal carried_part_2             : std_logic;
  signal carried_part_3             : std_logic;
  signal carried_part_4             : std_logic;
  signal carried_part_5             : std_logic;
  signal lane_0_items_data          : unsigned(7 downto 0);
  signal lane_0_map_data            : unsigned(7 downto 0);
  signal lane_1_items_data          : unsigned(7 downto 0);
  signal lane_1_map_data            : unsigned(7 downto 0);
  signal lane_2_items_data          : unsigned(7 downto 0);
  signal lane_2_map_data            : unsigned(7 downto 0);
  signal lane_3_items_data          : unsigned(7 downto 0);
  signal lane_3_map_data            : unsigned(7 downto 0);
  signal lane_4_items_data          : unsigned(7 downto 0);
  signal lane_4_map_data            : unsigned(7 downto 0);
  signal lane_5_items_data          : unsigned(7 downto 0);
  signal lane_5_map_data            : unsigned(7 downto 0);
  signal lane_6_items_data          : unsigned(7 downto 0);
  signal lane_6_map_data            : unsigned(7 downto 0);
  signal lane_7_items_data          : unsigned(7 downto 0);
  signal lane_7_map_data            : unsigned(7 downto 0);
  signal beat_data                  : unsigned(63 downto 0);
  signal beat_at                    : unsigned(3 downto 0);
  signal beat_valid                 : std_logic;
  -- 0 LINEAR_X, 1 LINEAR_X_2, 2 LINEAR_Y, 3 LINEAR_Z, 4 ANGULAR_X, 5 ANGULAR_Y
  signal orders_payload_step        : unsigned(2 downto 0);
  signal orders_payload_blank       : std_logic;
  signal orders_payload_items_at    : unsigned(5 downto 0);
  signal orders_payload_map_at      : unsigned(5 downto 0);
  signal orders_payload_items_bytes : unsigned(3 downto 0);
  signal orders_payload_map_bytes   : unsigned(3 downto 0);
  signal orders_payload_last        : std_logic;
  signal orders_payload_length_good : std_logic;
  signal orders_payload_ends        : std_logic;
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal orders_payload_status      : unsigned(2 downto 0);

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

  full_linear_x <= message_linear_x_valid_q and not message_linear_x_ready;
  full_linear_y <= message_linear_y_valid_q and not message_linear_y_ready;
  full_linear_z <= message_linear_z_valid_q and not message_linear_z_ready;
  full_angular_x <= message_angular_x_valid_q and not message_angular_x_ready;
  full_angular_y <= message_angular_y_valid_q and not message_angular_y_ready;
  full_angular_z <= message_angular_z_valid_q and not message_angular_z_ready;
  status_full <= status_valid_q and not status_ready;
  has_step <= orders_valid and not orders_payload_blank;
  chosen_step_linear_x_2 <= '1' when has_step = '1' and orders_payload_step = STEP_LINEAR_X_2 else
      '0';
  blocked_linear_x <= active_linear_x and message_linear_x_valid_q;
  go_linear_x <= active_linear_x and not blocked_linear_x;
  chosen_step_linear_y <= '1' when has_step = '1' and orders_payload_step = STEP_LINEAR_Y else '0';
  blocked_linear_y <= active_linear_y and message_linear_y_valid_q;
  go_linear_y <= active_linear_y and not blocked_linear_y;
  chosen_step_linear_z <= '1' when has_step = '1' and orders_payload_step = STEP_LINEAR_Z else '0';
  blocked_linear_z <= active_linear_z and message_linear_z_valid_q;
  go_linear_z <= active_linear_z and not blocked_linear_z;
  chosen_step_angular_x <= '1' when has_step = '1' and orders_payload_step = STEP_ANGULAR_X else
      '0';
  blocked_angular_x <= active_angular_x and message_angular_x_valid_q;
  go_angular_x <= active_angular_x and not blocked_angular_x;
  chosen_step_angular_y <= '1' when has_step = '1' and orders_payload_step = STEP_ANGULAR_Y else
      '0';
  blocked_angular_y <= active_angular_y and message_angular_y_valid_q;
  go_angular_y <= active_angular_y and not blocked_angular_y;
  blocked_angular_z <= active_angular_z and message_angular_z_valid_q;
  go_angular_z <= active_angular_z and not blocked_angular_z and not blocked_angular_y;
  ends <= orders_valid and orders_payload_ends;
  next_order_is_slow <= (chosen_step_linear_x_2 and full_linear_x) or (chosen_step_linear_y and
      full_linear_y) or (chosen_step_linear_z and full_linear_z) or (chosen_step_angular_x and
      full_angular_x) or (chosen_step_angular_y and full_angular_y) or (chosen_step_angular_y and
      full_angular_z) or (ends and status_full);
  order_stays_slow <= (blocked_linear_x and not message_linear_x_ready) or (blocked_linear_y and
      not message_linear_y_ready) or (blocked_linear_z and not message_linear_z_ready) or
      (blocked_angular_x and not message_angular_x_ready) or (blocked_angular_y and
      not message_angular_y_ready) or (blocked_angular_z and not message_angular_z_ready) or
      (ends_now and status_full);
  orders_ready <= not slow;
  carried_part <= orders_ready and begins_linear_x;
  carried_part_2 <= orders_ready and begins_linear_x_2;
  carried_part_3 <= orders_ready and begins_linear_y;
  carried_part_4 <= orders_ready and begins_linear_z;
  carried_part_5 <= orders_ready and begins_angular_x;

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat_valid = '1' then
        lane_0(to_integer(beat_at(2 downto 0))) <= beat_data(7 downto 0);
      end if;
    end if;
  end process;

  lane_0_items_data <= lane_0(to_integer(orders_payload_items_at(5 downto 3)));

  lane_0_map_data <= lane_0(to_integer(orders_payload_map_at(5 downto 3)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat_valid = '1' then
        lane_1(to_integer(beat_at(2 downto 0))) <= beat_data(15 downto 8);
      end if;
    end if;
  end process;

  lane_1_items_data <= lane_1(to_integer(orders_payload_items_at(5 downto 3)));

  lane_1_map_data <= lane_1(to_integer(orders_payload_map_at(5 downto 3)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat_valid = '1' then
        lane_2(to_integer(beat_at(2 downto 0))) <= beat_data(23 downto 16);
      end if;
    end if;
  end process;

  lane_2_items_data <= lane_2(to_integer(orders_payload_items_at(5 downto 3)));

  lane_2_map_data <= lane_2(to_integer(orders_payload_map_at(5 downto 3)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat_valid = '1' then
        lane_3(to_integer(beat_at(2 downto 0))) <= beat_data(31 downto 24);
      end if;
    end if;
  end process;

  lane_3_items_data <= lane_3(to_integer(orders_payload_items_at(5 downto 3)));

  lane_3_map_data <= lane_3(to_integer(orders_payload_map_at(5 downto 3)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat_valid = '1' then
        lane_4(to_integer(beat_at(2 downto 0))) <= beat_data(39 downto 32);
      end if;
    end if;
  end process;

  lane_4_items_data <= lane_4(to_integer(orders_payload_items_at(5 downto 3)));

  lane_4_map_data <= lane_4(to_integer(orders_payload_map_at(5 downto 3)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat_valid = '1' then
        lane_5(to_integer(beat_at(2 downto 0))) <= beat_data(47 downto 40);
      end if;
    end if;
  end process;

  lane_5_items_data <= lane_5(to_integer(orders_payload_items_at(5 downto 3)));

  lane_5_map_data <= lane_5(to_integer(orders_payload_map_at(5 downto 3)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat_valid = '1' then
        lane_6(to_integer(beat_at(2 downto 0))) <= beat_data(55 downto 48);
      end if;
    end if;
  end process;

  lane_6_items_data <= lane_6(to_integer(orders_payload_items_at(5 downto 3)));

  lane_6_map_data <= lane_6(to_integer(orders_payload_map_at(5 downto 3)));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat_valid = '1' then
        lane_7(to_integer(beat_at(2 downto 0))) <= beat_data(63 downto 56);
      end if;
    end if;
  end process;

  lane_7_items_data <= lane_7(to_integer(orders_payload_items_at(5 downto 3)));

  lane_7_map_data <= lane_7(to_integer(orders_payload_map_at(5 downto 3)));

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
        length_good <= '0';
        last <= '0';
        begins_linear_x <= '0';
        begins_linear_x_2 <= '0';
        begins_linear_y <= '0';
        begins_linear_z <= '0';
        begins_angular_x <= '0';
        active_linear_x <= '0';
        active_linear_y <= '0';
        active_linear_z <= '0';
        active_angular_x <= '0';
        active_angular_y <= '0';
        active_angular_z <= '0';
        ends_now <= '0';
        status_now <= (others => '0');
        status_payload_q <= (others => '0');
        slow <= '0';
      else
        if message_linear_x_ready = '1' then
          message_linear_x_valid_q <= '0';
        end if;
        if go_linear_x = '1' then
          message_linear_x_valid_q <= '1';
        end if;
        if message_linear_y_ready = '1' then
          message_linear_y_valid_q <= '0';
        end if;
        if go_linear_y = '1' then
          message_linear_y_valid_q <= '1';
        end if;
        if message_linear_z_ready = '1' then
          message_linear_z_valid_q <= '0';
        end if;
        if go_linear_z = '1' then
          message_linear_z_valid_q <= '1';
        end if;
        if message_angular_x_ready = '1' then
          message_angular_x_valid_q <= '0';
        end if;
        if go_angular_x = '1' then
          message_angular_x_valid_q <= '1';
        end if;
        if message_angular_y_ready = '1' then
          message_angular_y_valid_q <= '0';
        end if;
        if go_angular_y = '1' then
          message_angular_y_valid_q <= '1';
        end if;
        if message_angular_z_ready = '1' then
          message_angular_z_valid_q <= '0';
        end if;
        if go_angular_z = '1' then
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
          length_good <= orders_payload_length_good;
          last <= orders_payload_last;
          begins_linear_x <= orders_valid and not orders_payload_blank and
              to_std_logic(orders_payload_step = STEP_LINEAR_X);
          begins_linear_x_2 <= orders_valid and not orders_payload_blank and
              to_std_logic(orders_payload_step = STEP_LINEAR_X_2);
          begins_linear_y <= orders_valid and not orders_payload_blank and
              to_std_logic(orders_payload_step = STEP_LINEAR_Y);
          begins_linear_z <= orders_valid and not orders_payload_blank and
              to_std_logic(orders_payload_step = STEP_LINEAR_Z);
          begins_angular_x <= orders_valid and not orders_payload_blank and
              to_std_logic(orders_payload_step = STEP_ANGULAR_X);
          ends_now <= ends;
          status_now <= orders_payload_status;
        end if;
        if orders_ready = '1' then
          active_linear_x <= chosen_step_linear_x_2;
        else
          active_linear_x <= active_linear_x and not go_linear_x;
        end if;
        if orders_ready = '1' then
          active_linear_y <= chosen_step_linear_y;
        else
          active_linear_y <= active_linear_y and not go_linear_y;
        end if;
        if orders_ready = '1' then
          active_linear_z <= chosen_step_linear_z;
        else
          active_linear_z <= active_linear_z and not go_linear_z;
        end if;
        if orders_ready = '1' then
          active_angular_x <= chosen_step_angular_x;
        else
          active_angular_x <= active_angular_x and not go_angular_x;
        end if;
        if orders_ready = '1' then
          active_angular_y <= chosen_step_angular_y;
        else
          active_angular_y <= active_angular_y and not go_angular_y;
        end if;
        if orders_ready = '1' then
          active_angular_z <= chosen_step_angular_y;
        else
          active_angular_z <= active_angular_z and not go_angular_z;
        end if;
        if orders_ready = '1' then
          slow <= next_order_is_slow;
        else
          slow <= order_stays_slow;
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
        items_good <= to_std_logic(orders_payload_items_bytes > 7) &
            to_std_logic(orders_payload_items_bytes > 6) &
            to_std_logic(orders_payload_items_bytes > 5) &
            to_std_logic(orders_payload_items_bytes > 4) &
            to_std_logic(orders_payload_items_bytes > 3) &
            to_std_logic(orders_payload_items_bytes > 2) &
            to_std_logic(orders_payload_items_bytes > 1) &
            to_std_logic(orders_payload_items_bytes > 0);
        map_word <= lane_7_map_data & lane_6_map_data & lane_5_map_data & lane_4_map_data &
            lane_3_map_data & lane_2_map_data & lane_1_map_data & lane_0_map_data;
        map_good <= to_std_logic(orders_payload_map_bytes > 7) &
            to_std_logic(orders_payload_map_bytes > 6) &
            to_std_logic(orders_payload_map_bytes > 5) &
            to_std_logic(orders_payload_map_bytes > 4) &
            to_std_logic(orders_payload_map_bytes > 3) &
            to_std_logic(orders_payload_map_bytes > 2) &
            to_std_logic(orders_payload_map_bytes > 1) & to_std_logic(orders_payload_map_bytes > 0);
      end if;
      if carried_part = '1' then
        carried(7 downto 0) <= map_word(39 downto 32);
      end if;
      if carried_part = '1' then
        carried(15 downto 8) <= map_word(47 downto 40);
      end if;
      if carried_part = '1' then
        carried(23 downto 16) <= map_word(55 downto 48);
      end if;
      if carried_part = '1' then
        carried(31 downto 24) <= map_word(63 downto 56);
      end if;
      if carried_part_2 = '1' then
        carried(7 downto 0) <= map_word(39 downto 32);
      end if;
      if carried_part_2 = '1' then
        carried(15 downto 8) <= map_word(47 downto 40);
      end if;
      if carried_part_2 = '1' then
        carried(23 downto 16) <= map_word(55 downto 48);
      end if;
      if carried_part_2 = '1' then
        carried(31 downto 24) <= map_word(63 downto 56);
      end if;
      if carried_part_3 = '1' then
        carried(7 downto 0) <= map_word(39 downto 32);
      end if;
      if carried_part_3 = '1' then
        carried(15 downto 8) <= map_word(47 downto 40);
      end if;
      if carried_part_3 = '1' then
        carried(23 downto 16) <= map_word(55 downto 48);
      end if;
      if carried_part_3 = '1' then
        carried(31 downto 24) <= map_word(63 downto 56);
      end if;
      if carried_part_4 = '1' then
        carried(7 downto 0) <= map_word(39 downto 32);
      end if;
      if carried_part_4 = '1' then
        carried(15 downto 8) <= map_word(47 downto 40);
      end if;
      if carried_part_4 = '1' then
        carried(23 downto 16) <= map_word(55 downto 48);
      end if;
      if carried_part_4 = '1' then
        carried(31 downto 24) <= map_word(63 downto 56);
      end if;
      if carried_part_5 = '1' then
        carried(7 downto 0) <= map_word(39 downto 32);
      end if;
      if carried_part_5 = '1' then
        carried(15 downto 8) <= map_word(47 downto 40);
      end if;
      if carried_part_5 = '1' then
        carried(23 downto 16) <= map_word(55 downto 48);
      end if;
      if carried_part_5 = '1' then
        carried(31 downto 24) <= map_word(63 downto 56);
      end if;
      if go_linear_x = '1' then
        payload_linear_x <= mux(map_good(3), map_word(31 downto 0) & carried, x"0000000000000000");
      end if;
      if go_linear_y = '1' then
        payload_linear_y <= mux(map_good(3), map_word(31 downto 0) & carried, x"0000000000000000");
      end if;
      if go_linear_z = '1' then
        payload_linear_z <= mux(map_good(3), map_word(31 downto 0) & carried, x"0000000000000000");
      end if;
      if go_angular_x = '1' then
        payload_angular_x <= mux(map_good(3), map_word(31 downto 0) & carried, x"0000000000000000");
      end if;
      if go_angular_y = '1' then
        payload_angular_y <= mux(items_good(3), items_word(31 downto 0) & carried,
            x"0000000000000000");
      end if;
      if go_angular_z = '1' then
        payload_angular_z <= mux(map_good(3), map_word(31 downto 0) & items_word(63 downto 32),
            x"0000000000000000");
      end if;
    end if;
  end process;

  beat_data <= beat(63 downto 0);
  beat_at <= beat(72 downto 69);
  beat_valid <= beat(73);
  orders_payload_step <= orders_payload(2 downto 0);
  orders_payload_blank <= orders_payload(3);
  orders_payload_items_at <= orders_payload(9 downto 4);
  orders_payload_map_at <= orders_payload(15 downto 10);
  orders_payload_items_bytes <= orders_payload(25 downto 22);
  orders_payload_map_bytes <= orders_payload(29 downto 26);
  orders_payload_last <= orders_payload(31);
  orders_payload_length_good <= orders_payload(32);
  orders_payload_ends <= orders_payload(38);
  orders_payload_status <= orders_payload(41 downto 39);

  message_linear_x_valid <= message_linear_x_valid_q;
  message_linear_y_valid <= message_linear_y_valid_q;
  message_linear_z_valid <= message_linear_z_valid_q;
  message_angular_x_valid <= message_angular_x_valid_q;
  message_angular_y_valid <= message_angular_y_valid_q;
  message_angular_z_valid <= message_angular_z_valid_q;
  status_valid <= status_valid_q;
  status_payload <= status_payload_q;
  message_linear_x_payload <= payload_linear_x;
  message_linear_y_payload <= payload_linear_y;
  message_linear_z_payload <= payload_linear_z;
  message_angular_x_payload <= payload_angular_x;
  message_angular_y_payload <= payload_angular_y;
  message_angular_z_payload <= payload_angular_z;

end architecture;

-- Module geometry_msgs_msg_Twist_cdr_8_deserializer.core of the Amaranth design.
-- Deserializer: Turn packets into messages.
--
-- A packet advances one step of the plan per cycle, as soon as the bytes of the step have arrived.
-- Each step gives an order to a queue of two, and every leaf has one register. Leaves that are not
-- taken hold the packet only when the queue is full. Most leaves cost one cycle more if they are
-- still full when their next value comes.
--
-- Leaves become valid in wire order, `LATENCY_CYCLES["deserializer"]` cycles after the last beat
-- of their step. All outputs are registers. One clock domain, `sync`; its reset discards all
-- packets and messages inside.
--
-- Each packet ends in one transfer on `status`. After the first error in a packet, the remaining
-- scalars and lengths transfer as 0, the current sequence is completed with zeros, and the rest of
-- the packet is dropped. The next packet is decoded normally.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_flat_core is
  port (
    rst                       : in  std_logic;
    aclk                      : in  std_logic;
    packets_valid             : in  std_logic;
    message_linear_x_ready    : in  std_logic;
    message_linear_y_ready    : in  std_logic;
    message_linear_z_ready    : in  std_logic;
    message_angular_x_ready   : in  std_logic;
    message_angular_y_ready   : in  std_logic;
    message_angular_z_ready   : in  std_logic;
    status_ready              : in  std_logic;
    -- bits: data(63:0) count(67:64) last(68)
    packets_payload           : in  unsigned(68 downto 0);
    packets_ready             : out std_logic;
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

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_flat_core is

  -- Combinational signals.
  signal beat              : unsigned(73 downto 0);
  signal arrival_limit     : unsigned(6 downto 0);
  signal arrival_following : unsigned(3 downto 0);
  signal arrival_ended     : std_logic;
  signal orders_valid      : std_logic;
  signal arrival_next      : std_logic;
  signal orders_payload    : unsigned(41 downto 0);
  signal oldest            : unsigned(3 downto 0);
  signal i_ready           : std_logic;
  signal freed             : unsigned(3 downto 0);
  signal o_valid           : std_logic;
  signal o_payload         : unsigned(41 downto 0);
  signal orders_ready_25   : std_logic;
begin

  buffer_sig : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_buffer
    port map (
      aclk              => aclk,
      packets_valid     => packets_valid,
      rst               => rst,
      arrival_next      => arrival_next,
      freed             => freed,
      packets_payload   => packets_payload,
      arrival_beat      => beat,
      packets_ready     => packets_ready,
      arrival_limit     => arrival_limit,
      arrival_following => arrival_following,
      arrival_ended     => arrival_ended
    );

  sequencer : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_sequencer
    port map (
      aclk              => aclk,
      rst               => rst,
      orders_valid      => orders_valid,
      arrival_next      => arrival_next,
      orders_ready      => i_ready,
      beat              => beat,
      arrival_limit     => arrival_limit,
      arrival_following => arrival_following,
      arrival_ended     => arrival_ended,
      orders_payload    => orders_payload,
      header_at         => oldest
    );

  queue : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_queue
    port map (
      aclk      => aclk,
      rst       => rst,
      i_valid   => orders_valid,
      i_ready   => i_ready,
      freed     => freed,
      o_ready   => orders_ready_25,
      i_payload => orders_payload,
      oldest    => oldest,
      o_valid   => o_valid,
      o_payload => o_payload
    );

  mover : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_mover
    port map (
      aclk                      => aclk,
      message_linear_x_ready    => message_linear_x_ready,
      message_linear_y_ready    => message_linear_y_ready,
      message_linear_z_ready    => message_linear_z_ready,
      message_angular_x_ready   => message_angular_x_ready,
      message_angular_y_ready   => message_angular_y_ready,
      message_angular_z_ready   => message_angular_z_ready,
      status_ready              => status_ready,
      rst                       => rst,
      orders_ready              => orders_ready_25,
      beat                      => beat,
      orders_valid              => o_valid,
      orders_payload            => o_payload,
      message_linear_x_valid    => message_linear_x_valid,
      message_linear_y_valid    => message_linear_y_valid,
      message_linear_z_valid    => message_linear_z_valid,
      message_angular_x_valid   => message_angular_x_valid,
      message_angular_y_valid   => message_angular_y_valid,
      message_angular_z_valid   => message_angular_z_valid,
      status_valid              => status_valid,
      status_payload            => status_payload,
      message_linear_x_payload  => message_linear_x_payload,
      message_linear_y_payload  => message_linear_y_payload,
      message_linear_z_payload  => message_linear_z_payload,
      message_angular_x_payload => message_angular_x_payload,
      message_angular_y_payload => message_angular_y_payload,
      message_angular_z_payload => message_angular_z_payload
    );

end architecture;

-- Module geometry_msgs_msg_Twist_cdr_8_deserializer of the Amaranth design.
-- Top: A converter with AXI4-Stream on its packet side and named ports on its message side.
--
-- The top level adds neither registers nor latency. `aresetn` is active low and synchronous to the
-- rising edge of `aclk`; one cycle of reset discards all packets and messages inside. A last beat
-- without any ones in ``tkeep`` adds no bytes, so it can end an empty packet.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_flat is
  port (
    aclk                 : in  std_logic;
    aresetn              : in  std_logic;
    s_axis_tdata         : in  std_logic_vector(63 downto 0);
    s_axis_tkeep         : in  std_logic_vector(7 downto 0);
    s_axis_tlast         : in  std_logic;
    s_axis_tvalid        : in  std_logic;
    linear_x_ready       : in  std_logic;
    linear_y_ready       : in  std_logic;
    linear_z_ready       : in  std_logic;
    angular_x_ready      : in  std_logic;
    angular_y_ready      : in  std_logic;
    angular_z_ready      : in  std_logic;
    m_axis_status_tready : in  std_logic;
    s_axis_tready        : out std_logic;
    linear_x_data        : out std_logic_vector(63 downto 0);
    linear_x_valid       : out std_logic;
    linear_y_data        : out std_logic_vector(63 downto 0);
    linear_y_valid       : out std_logic;
    linear_z_data        : out std_logic_vector(63 downto 0);
    linear_z_valid       : out std_logic;
    angular_x_data       : out std_logic_vector(63 downto 0);
    angular_x_valid      : out std_logic;
    angular_y_data       : out std_logic_vector(63 downto 0);
    angular_y_valid      : out std_logic;
    angular_z_data       : out std_logic_vector(63 downto 0);
    angular_z_valid      : out std_logic;
    m_axis_status_tdata  : out std_logic_vector(7 downto 0);
    m_axis_status_tvalid : out std_logic
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_flat is

  -- Combinational signals.
  signal message_linear_x_payload  : unsigned(63 downto 0);
  signal message_linear_y_payload  : unsigned(63 downto 0);
  signal message_linear_z_payload  : unsigned(63 downto 0);
  signal message_angular_x_payload : unsigned(63 downto 0);
  signal message_angular_y_payload : unsigned(63 downto 0);
  signal message_angular_z_payload : unsigned(63 downto 0);
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal status_payload            : unsigned(2 downto 0);
  signal rst                       : std_logic;
  signal tkeep_begins_with_1       : std_logic;
  signal tkeep_begins_with_2       : std_logic;
  signal tkeep_begins_with_3       : std_logic;
  signal tkeep_begins_with_4       : std_logic;
  signal tkeep_begins_with_5       : std_logic;
  signal tkeep_begins_with_6       : std_logic;
  signal tkeep_begins_with_7       : std_logic;
  signal packets_payload_count     : unsigned(3 downto 0);
begin

  core : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_flat_core
    port map (
      aclk                          => aclk,
      packets_valid                 => s_axis_tvalid,
      message_linear_x_ready        => linear_x_ready,
      message_linear_y_ready        => linear_y_ready,
      message_linear_z_ready        => linear_z_ready,
      message_angular_x_ready       => angular_x_ready,
      message_angular_y_ready       => angular_y_ready,
      message_angular_z_ready       => angular_z_ready,
      status_ready                  => m_axis_status_tready,
      rst                           => rst,
      packets_payload(63 downto 0)  => unsigned(s_axis_tdata),
      packets_payload(67 downto 64) => packets_payload_count,
      packets_payload(68)           => s_axis_tlast,
      packets_ready                 => s_axis_tready,
      message_linear_x_valid        => linear_x_valid,
      message_linear_y_valid        => linear_y_valid,
      message_linear_z_valid        => linear_z_valid,
      message_angular_x_valid       => angular_x_valid,
      message_angular_y_valid       => angular_y_valid,
      message_angular_z_valid       => angular_z_valid,
      status_valid                  => m_axis_status_tvalid,
      status_payload                => status_payload,
      message_linear_x_payload      => message_linear_x_payload,
      message_linear_y_payload      => message_linear_y_payload,
      message_linear_z_payload      => message_linear_z_payload,
      message_angular_x_payload     => message_angular_x_payload,
      message_angular_y_payload     => message_angular_y_payload,
      message_angular_z_payload     => message_angular_z_payload
    );

  rst <= not aresetn;
  tkeep_begins_with_1 <= s_axis_tkeep(0) and not s_axis_tkeep(1);
  tkeep_begins_with_2 <= (and unsigned(s_axis_tkeep(1 downto 0))) and not s_axis_tkeep(2);
  tkeep_begins_with_3 <= (and unsigned(s_axis_tkeep(2 downto 0))) and not s_axis_tkeep(3);
  tkeep_begins_with_4 <= (and unsigned(s_axis_tkeep(3 downto 0))) and not s_axis_tkeep(4);
  tkeep_begins_with_5 <= (and unsigned(s_axis_tkeep(4 downto 0))) and not s_axis_tkeep(5);
  tkeep_begins_with_6 <= (and unsigned(s_axis_tkeep(5 downto 0))) and not s_axis_tkeep(6);
  tkeep_begins_with_7 <= (and unsigned(s_axis_tkeep(6 downto 0))) and not s_axis_tkeep(7);
  packets_payload_count <= (and unsigned(s_axis_tkeep)) & (tkeep_begins_with_4 or
      tkeep_begins_with_5 or tkeep_begins_with_6 or tkeep_begins_with_7) & (tkeep_begins_with_2 or
      tkeep_begins_with_3 or tkeep_begins_with_6 or tkeep_begins_with_7) & (tkeep_begins_with_1 or
      tkeep_begins_with_3 or tkeep_begins_with_5 or tkeep_begins_with_7) when s_axis_tlast =
      '1' else "1000";

  m_axis_status_tdata <= std_logic_vector(resize(status_payload, 8));

  linear_x_data <= std_logic_vector(message_linear_x_payload);
  linear_y_data <= std_logic_vector(message_linear_y_payload);
  linear_z_data <= std_logic_vector(message_linear_z_payload);
  angular_x_data <= std_logic_vector(message_angular_x_payload);
  angular_y_data <= std_logic_vector(message_angular_y_payload);
  angular_z_data <= std_logic_vector(message_angular_z_payload);

end architecture;
