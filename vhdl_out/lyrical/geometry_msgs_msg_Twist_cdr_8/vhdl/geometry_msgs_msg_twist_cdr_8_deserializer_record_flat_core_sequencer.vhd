-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_twist_cdr_8_deserializer_record_flat.core.sequencer of the Amaranth design.
-- 16 registers at rising_edge(aclk), synchronous reset rst = '1'.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_sequencer is
  port (
    rst            : in  std_logic;
    aclk           : in  std_logic;
    orders_valid   : out std_logic;
    next_sig       : out std_logic;
    orders_ready   : in  std_logic;
    beat           : in  unsigned(73 downto 0);
    limit_sig      : in  unsigned(6 downto 0);
    following      : in  unsigned(3 downto 0);
    ended          : in  std_logic;
    orders_payload : out unsigned(41 downto 0);
    header_at      : out unsigned(3 downto 0)
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_sequencer is

  -- Registers.
  signal bad          : std_logic := '0';
  signal new_error    : std_logic := '0';
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal code         : unsigned(2 downto 0) := (others => '0');
  signal items_room   : unsigned(3 downto 0) := (others => '0');
  signal map_room     : unsigned(3 downto 0) := (others => '0');
  signal words_last   : std_logic := '1';
  signal words_less   : std_logic := '0';
  signal step         : unsigned(6 downto 0) := "0000001";
  signal map_offset   : unsigned(4 downto 0) := "11001";
  signal two_word_map : std_logic := '0';
  signal at_end       : std_logic := '0';
  signal exit_add     : unsigned(5 downto 0) := "001000";
  signal rest         : std_logic := '0';
  signal has_nul      : std_logic := '0';
  signal first_at     : unsigned(6 downto 0) := (others => '0');
  signal last_at      : unsigned(6 downto 0) := "0000111";

  -- Combinational signals.
  signal mismatch_36  : std_logic;
  signal step_end     : unsigned(6 downto 0);
  signal left         : unsigned(6 downto 0);
  signal present      : std_logic;
  signal ends_message : std_logic;
  signal ends_packet  : std_logic;
  signal map_at       : unsigned(6 downto 0);
  signal sub_12       : unsigned(3 downto 0);
  signal trailing_34  : std_logic;
  signal mismatch     : std_logic;
  signal good         : std_logic;
  signal cut          : std_logic;
  signal sub_39       : unsigned(5 downto 0);
  signal or_83        : unsigned(5 downto 0);
  signal map_left     : unsigned(6 downto 0);
  signal drains       : std_logic;
  signal allowed      : std_logic;
  signal issue        : std_logic;
  signal step_to_exit : std_logic;
  signal exit_sum     : unsigned(6 downto 0);
  signal early_last   : unsigned(6 downto 0);
  signal mux_194      : unsigned(2 downto 0);
  signal and_195      : std_logic;
  signal mux_210      : unsigned(3 downto 0);
  signal mux_215      : unsigned(3 downto 0);
  signal mux_222      : unsigned(3 downto 0);
  signal mux_278      : unsigned(6 downto 0);

  -- Signals that no logic reads, for simulation.
  signal default_0     : std_logic;
  signal default_1     : std_logic;
  signal default_2     : std_logic;
  signal default_3     : std_logic;
  signal default_4     : std_logic;
  signal default_5     : std_logic;
  signal trailing      : unsigned(1 downto 0);
  signal items_at      : unsigned(6 downto 0);
  signal nul_at        : unsigned(6 downto 0);
  signal nul_at_28     : unsigned(6 downto 0);
  signal nonzero       : std_logic;
  signal nul_within    : unsigned(6 downto 0);
  signal oldest        : unsigned(3 downto 0);
  signal words_loads   : std_logic;
  signal next_packet   : unsigned(6 downto 0);
  signal tail          : unsigned(5 downto 0);
  signal to_exit_low   : unsigned(6 downto 0);
  signal body_sum      : unsigned(6 downto 0);
  signal to_body_mask  : unsigned(2 downto 0);
  signal to_body_low   : unsigned(6 downto 0);
  signal exits_always  : std_logic;
  signal done          : std_logic;
  signal wrong_nul     : std_logic;
  signal begins        : std_logic;
  signal items_wanted  : unsigned(3 downto 0);
  signal step_to_body  : std_logic;
  signal words_down    : std_logic;
  signal words_keeps   : std_logic;
  signal to_exit_rest  : std_logic;
  signal exit_amount   : unsigned(5 downto 0);
  signal to_exit_mask  : unsigned(2 downto 0);
  signal to_body_rest  : std_logic;
  signal body_amount   : unsigned(5 downto 0);
  signal next_last     : unsigned(6 downto 0);
  signal words_pending : std_logic;
  signal words_value   : unsigned(2 downto 0);
begin

  marks : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_sequencer_marks
    port map (
      aclk      => aclk,
      rst       => rst,
      mismatch  => mismatch_36,
      beat      => beat,
      header_at => first_at(6 downto 3)
    );

  step_end <= last_at + 1;
  left <= limit_sig + not last_at;
  present <= not left(6);
  ends_message <= at_end or step(5);
  ends_packet <= ends_message and ended;
  map_at <= last_at + sign_extend(map_offset, 7);
  sub_12 <= map_at(6 downto 3) - two_word_map;
  trailing_34 <= present and (or left(5 downto 2));
  mismatch <= '1' when step(0) = '1' and mismatch_36 = '1' and limit_sig /= first_at else '0';
  good <= present and not (step(0) and mismatch_36);
  cut <= ended and not present;
  sub_39 <= unsigned'("000001") - sign_extend(map_offset, 6);
  or_83 <= (limit_sig(5 downto 0) and not last_at(5 downto 0)) or (limit_sig(5 downto 0) and
      unsigned'("000001") - sign_extend(map_offset, 6)) or (not last_at(5 downto 0) and
      unsigned'("000001") - sign_extend(map_offset, 6));
  map_left <= (limit_sig xor not last_at xor unsigned'(sub_39(5) &
      (unsigned'("000001") - sign_extend(map_offset, 6)))) + unsigned'(or_83 & '0');
  drains <= bad and not new_error and (not at_end or ended);
  allowed <= not bad and (not ends_message or ended);
  orders_valid <= drains or (allowed and good);
  issue <= (drains and orders_ready) or (allowed and orders_ready and good);
  next_sig <= (drains and orders_ready and ends_packet) or (allowed and orders_ready and
      ends_packet and good);
  step_to_exit <= issue and not ends_packet;
  exit_sum <= last_at + exit_add;
  early_last <= unsigned'(following & "000") + 7 when ends_packet = '1' else exit_sum;
  mux_194 <= "100" when mismatch = '1' else mux(cut, "001", mux(ends_message, "010", "011"));
  and_195 <= drains and orders_ready;
  mux_210 <= mux(map_left(6), resize(mux(and map_left(6 downto 3), map_left(2 downto 0), "000"), 4),
      "1000") when two_word_map = '1' else mux(map_left(6), "0000", mux(to_std_logic(map_left >= 8),
      "1000", map_left(3 downto 0)));
  mux_215 <= mux_210 when code = 1 else mux(to_std_logic(code = 2) or to_std_logic(code = 5),
      "1000", "0000");
  mux_222 <= mux(map_left(6), "0000", mux(to_std_logic(map_left >= 8), "1000",
      map_left(3 downto 0))) when code = 1 else mux(to_std_logic(code = 2), "1000", "0000");
  mux_278 <= following & "000" when ends_packet = '1' else mux(bad, mux(at_end, limit_sig,
      first_at), step_end);

  p_aclk : process (aclk)
  begin
    if rising_edge(aclk) then
      if rst = '1' then
        bad <= '0';
        new_error <= '0';
        code <= (others => '0');
        items_room <= (others => '0');
        map_room <= (others => '0');
        words_last <= '1';
        words_less <= '0';
        step <= "0000001";
        map_offset <= "11001";
        two_word_map <= '0';
        at_end <= '0';
        exit_add <= "001000";
        rest <= '0';
        has_nul <= '0';
        first_at <= (others => '0');
        last_at <= "0000111";
      else
        if issue = '1' and ends_packet = '1' then
          bad <= '0';
        elsif bad = '0' then
          bad <= mismatch or cut or (ends_message and not ended and trailing_34);
        end if;
        if bad = '0' then
          new_error <= mismatch or cut or (ends_message and not ended and trailing_34);
          code <= mux_194;
        end if;
        if bad = '1' then
          new_error <= '0';
          if new_error = '1' then
            items_room <= mux_215;
            map_room <= mux_222;
          elsif and_195 = '1' then
            items_room <= (others => '0');
            map_room <= (others => '0');
          end if;
        end if;
        words_last <= words_last;
        words_less <= words_less;
        if issue = '1' then
          if ends_packet = '1' then
            step <= "0000001";
            map_offset <= "11001";
            two_word_map <= '0';
            at_end <= '0';
            exit_add <= "001000";
          else
            step <= step(5 downto 0) & '0';
            map_offset <= (or step(4 downto 0)) & (or step(4 downto 0)) & step(4) & '0' &
                (or step(5 downto 0));
            two_word_map <= step(4);
            at_end <= step(5);
            exit_add <= resize(unsigned'((or step(3 downto 0)) & step(3) & "00"), 6);
          end if;
          if ends_packet = '1' then
            rest <= '0';
            has_nul <= '0';
          end if;
          last_at <= early_last;
        end if;
        if issue = '1' or (bad = '1' and at_end = '1') then
          first_at <= mux_278;
        end if;
      end if;
    end if;
  end process;

  header_at <= first_at(6 downto 3);
  orders_payload <= mux(bad, code, mux(trailing_34, "010", "000")) & ends_packet &
      first_at(6 downto 3) & '0' & not bad & words_last & '0' & mux(bad, map_room, "1000") &
      mux(bad and not to_std_logic(items_room >= 8), items_room, "1000") &
      (map_at(5 downto 3) + 1) & (sub_12(2 downto 0) + 1) & map_at(5 downto 0) &
      sub_12(2 downto 0) & map_at(2 downto 0) & at_end & (or step(5 downto 4)) &
      (or step(3 downto 2)) & (or unsigned'(step(5) & step(3) & step(1)));

  default_0 <= step(0);
  default_1 <= step(1);
  default_2 <= step(2);
  default_3 <= step(3);
  default_4 <= step(4);
  default_5 <= step(5);
  trailing <= left(1 downto 0);
  items_at <= sub_12 & map_at(2 downto 0);
  nul_at <= (others => '0');
  nul_at_28 <= (others => '0');
  nonzero <= '0';
  nul_within <= limit_sig;
  oldest <= first_at(6 downto 3);
  words_loads <= '0';
  next_packet <= following & "000";
  tail <= (others => '0');
  to_exit_low <= (others => '0');
  body_sum <= last_at;
  to_body_mask <= (others => '0');
  to_body_low <= (others => '0');
  exits_always <= '1';
  done <= '1';
  wrong_nul <= '0';
  begins <= '0';
  items_wanted <= "1000";
  step_to_body <= '0';
  words_down <= '0';
  words_keeps <= '1';
  to_exit_rest <= '0';
  exit_amount <= exit_add;
  to_exit_mask <= (others => '0');
  to_body_rest <= '0';
  body_amount <= (others => '0');
  next_last <= early_last;
  words_pending <= '0';
  words_value <= (others => '0');

end architecture;
