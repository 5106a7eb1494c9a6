-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_Twist_cdr_8_deserializer.core.sequencer of the Amaranth design.
-- 12 registers at rising_edge(aclk), synchronous reset rst = '1'.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_sequencer is
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

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_sequencer is

  -- Registers.
  signal bad        : std_logic := '0';
  signal new_error  : std_logic := '0';
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal code       : unsigned(2 downto 0) := (others => '0');
  signal items_room : unsigned(3 downto 0) := (others => '0');
  signal map_room   : unsigned(3 downto 0) := (others => '0');
  signal words_last : std_logic := '1';
  signal words_less : std_logic := '0';
  signal state      : unsigned(33 downto 0) := 34x"200840C81";
  signal rest       : std_logic := '0';
  signal has_nul    : std_logic := '0';
  signal first_at   : unsigned(6 downto 0) := (others => '0');
  signal last_at    : unsigned(6 downto 0) := "0000111";

  -- Combinational signals.
  signal mismatch_33  : std_logic;
  signal step_end     : unsigned(6 downto 0);
  signal left         : unsigned(6 downto 0);
  signal present      : std_logic;
  signal exits_always : std_logic;
  signal done         : std_logic;
  signal ends_message : std_logic;
  signal ends_packet  : std_logic;
  signal map_at       : unsigned(6 downto 0);
  signal items_at     : unsigned(6 downto 0);
  signal trailing_31  : std_logic;
  signal mismatch     : std_logic;
  signal good         : std_logic;
  signal cut          : std_logic;
  signal begins       : std_logic;
  signal sub_40       : unsigned(5 downto 0);
  signal or_84        : unsigned(5 downto 0);
  signal map_left     : unsigned(6 downto 0);
  signal drains       : std_logic;
  signal allowed      : std_logic;
  signal issue        : std_logic;
  signal items_wanted : unsigned(3 downto 0);
  signal mux_148      : unsigned(33 downto 0);
  signal next_state   : unsigned(33 downto 0);
  signal step_to_exit : std_logic;
  signal step_to_body : std_logic;
  signal exit_amount  : unsigned(5 downto 0);
  signal exit_sum     : unsigned(6 downto 0);
  signal mux_171      : unsigned(6 downto 0);
  signal early_last   : unsigned(6 downto 0);
  signal mux_212      : unsigned(2 downto 0);
  signal and_213      : std_logic;
  signal sub_218      : unsigned(6 downto 0);
  signal mux_223      : unsigned(3 downto 0);
  signal mux_227      : unsigned(3 downto 0);
  signal mux_228      : unsigned(3 downto 0);
  signal mux_233      : unsigned(3 downto 0);
  signal mux_240      : unsigned(3 downto 0);
  signal mux_282      : unsigned(6 downto 0);

  -- Signals that no logic reads, for simulation.
  signal default_0     : std_logic;
  signal default_1     : std_logic;
  signal default_2     : std_logic;
  signal default_3     : std_logic;
  signal default_4     : std_logic;
  signal default_5     : std_logic;
  signal trailing      : unsigned(1 downto 0);
  signal nul_at        : unsigned(6 downto 0);
  signal nul_at_26     : unsigned(6 downto 0);
  signal nonzero       : std_logic;
  signal nul_within    : unsigned(6 downto 0);
  signal oldest        : unsigned(3 downto 0);
  signal words_loads   : std_logic;
  signal next_packet   : unsigned(6 downto 0);
  signal tail          : unsigned(5 downto 0);
  signal exit_low      : unsigned(6 downto 0);
  signal body_sum      : unsigned(6 downto 0);
  signal body_mask     : unsigned(2 downto 0);
  signal body_low      : unsigned(6 downto 0);
  signal wrong_nul     : std_logic;
  signal words_down    : std_logic;
  signal words_keeps   : std_logic;
  signal exit_rest     : std_logic;
  signal exit_mask     : unsigned(2 downto 0);
  signal body_rest     : std_logic;
  signal body_amount   : unsigned(5 downto 0);
  signal next_last     : unsigned(6 downto 0);
  signal words_pending : std_logic;
  signal words_value   : unsigned(2 downto 0);
begin

  marks : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_sequencer_marks
    port map (
      aclk      => aclk,
      rst       => rst,
      mismatch  => mismatch_33,
      beat      => beat,
      header_at => first_at(6 downto 3)
    );

  step_end <= last_at + 1;
  left <= limit_sig + not last_at;
  present <= not left(6);
  exits_always <= state(18) or (state(14) and words_last);
  done <= exits_always or ((state(12) or state(13)) and bad);
  ends_message <= state(19) or (state(5) and exits_always);
  ends_packet <= ends_message and ended;
  map_at <= last_at + sign_extend(state(11 downto 7), 7);
  items_at <= first_at when state(16) = '1' else (map_at(6 downto 3) - state(17)) &
      map_at(2 downto 0);
  trailing_31 <= present and (or left(5 downto 2));
  mismatch <= '1' when state(0) = '1' and mismatch_33 = '1' and limit_sig /= first_at else '0';
  good <= present and not (state(0) and mismatch_33);
  cut <= ended and not present;
  begins <= issue and (state(12) or state(13));
  sub_40 <= unsigned'("000001") - sign_extend(state(11 downto 7), 6);
  or_84 <= (limit_sig(5 downto 0) and not last_at(5 downto 0)) or (limit_sig(5 downto 0) and
      unsigned'("000001") - sign_extend(state(11 downto 7), 6)) or (not last_at(5 downto 0) and
      unsigned'("000001") - sign_extend(state(11 downto 7), 6));
  map_left <= (limit_sig xor not last_at xor unsigned'(sub_40(5) &
      (unsigned'("000001") - sign_extend(state(11 downto 7), 6)))) + unsigned'(or_84 & '0');
  drains <= bad and not new_error and (not state(19) or ended);
  allowed <= not bad and (not ends_message or ended);
  orders_valid <= drains or (allowed and good);
  issue <= (drains and orders_ready) or (allowed and orders_ready and good);
  next_sig <= (drains and orders_ready and ends_packet) or (allowed and orders_ready and
      ends_packet and good);
  items_wanted <= (others => '0') when state(16) = '1' else "1000";
  mux_148 <= (or state(4 downto 0)) & 9x"000" & (or state(3 downto 0)) & state(3) & "00" &
      state(5) & (or state(4 downto 0)) & state(4) & "00000" & (or state(4 downto 0)) &
      (or state(4 downto 0)) & state(4) & '0' & (or state(5 downto 0)) & state(5 downto 0) &
      '0' when done = '1' else (others => '0');
  next_state <= 34x"200840C81" when ends_packet = '1' else mux_148;
  step_to_exit <= issue and not ends_packet and done;
  step_to_body <= issue and not ends_packet and not done;
  exit_amount <= (others => '0') when state(32) = '1' else state(25 downto 20);
  exit_sum <= last_at + exit_amount;
  mux_171 <= (exit_sum and not resize(state(28 downto 26), 7)) or resize(state(31 downto 29),
      7) when exits_always = '1' else last_at;
  early_last <= unsigned'(following & "000") + 7 when ends_packet = '1' else mux_171;
  mux_212 <= "100" when mismatch = '1' else mux(cut, "001", mux(ends_message, "010", "011"));
  and_213 <= drains and orders_ready;
  sub_218 <= limit_sig - first_at;
  mux_223 <= (others => '0') when sub_218(6) = '1' else mux(to_std_logic(limit_sig - first_at >= 8),
      "1000", limit_sig(3 downto 0) - first_at(3 downto 0));
  mux_227 <= mux_223 when state(16) = '1' else mux(map_left(6), "0000",
      mux(to_std_logic(map_left >= 8), "1000", map_left(3 downto 0)));
  mux_228 <= mux(map_left(6), resize(mux(and map_left(6 downto 3), map_left(2 downto 0), "000"), 4),
      "1000") when state(17) = '1' else mux_227;
  mux_233 <= mux_228 when code = 1 else mux(to_std_logic(code = 2) or to_std_logic(code = 5),
      "1000", "0000");
  mux_240 <= mux(map_left(6), "0000", mux(to_std_logic(map_left >= 8), "1000",
      map_left(3 downto 0))) when code = 1 else mux(to_std_logic(code = 2), "1000", "0000");
  mux_282 <= following & "000" when ends_packet = '1' else mux(bad, mux(state(19), limit_sig,
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
        state <= 34x"200840C81";
        rest <= '0';
        has_nul <= '0';
        first_at <= (others => '0');
        last_at <= "0000111";
      else
        if issue = '1' and ends_packet = '1' then
          bad <= '0';
        elsif bad = '0' then
          bad <= mismatch or cut or (ends_message and not ended and trailing_31);
        end if;
        if bad = '0' then
          new_error <= mismatch or cut or (ends_message and not ended and trailing_31);
          code <= mux_212;
        end if;
        if bad = '1' then
          new_error <= '0';
          if new_error = '1' then
            items_room <= mux_233;
            map_room <= mux_240;
          elsif and_213 = '1' then
            items_room <= (others => '0');
            map_room <= (others => '0');
          end if;
        end if;
        words_last <= words_last;
        words_less <= words_less;
        if issue = '1' then
          state <= next_state;
          if ends_packet = '1' then
            rest <= '0';
            has_nul <= '0';
          else
            if state(12) = '1' or state(16) = '1' then
              rest <= '0';
              has_nul <= '0';
            end if;
          end if;
          last_at <= early_last;
        end if;
        if issue = '1' or (bad = '1' and state(19) = '1') then
          first_at <= mux_282;
        end if;
      end if;
    end if;
  end process;

  header_at <= first_at(6 downto 3);
  orders_payload <= mux(bad, code, mux(trailing_31, "010", "000")) & ends_packet &
      first_at(6 downto 3) & '0' & not bad & (state(16) or (words_last and not state(15))) &
      ((state(16) and rest) or state(15)) & mux(bad, map_room, "1000") & mux(bad and
      not to_std_logic(items_room >= items_wanted), items_room, items_wanted) &
      (map_at(5 downto 3) + 1) & (items_at(5 downto 3) + 1) & map_at(5 downto 0) &
      items_at(5 downto 0) & state(19) & (or state(5 downto 4)) & (or state(3 downto 2)) &
      (or unsigned'(state(5) & state(3) & state(1)));

  default_0 <= state(0);
  default_1 <= state(1);
  default_2 <= state(2);
  default_3 <= state(3);
  default_4 <= state(4);
  default_5 <= state(5);
  trailing <= left(1 downto 0);
  nul_at <= (others => '0');
  nul_at_26 <= (others => '0');
  nonzero <= '0';
  nul_within <= limit_sig;
  oldest <= first_at(6 downto 3);
  words_loads <= '0';
  next_packet <= following & "000";
  tail <= (others => '0');
  exit_low <= resize(state(31 downto 29), 7);
  body_sum <= last_at;
  body_mask <= (others => '0');
  body_low <= (others => '0');
  wrong_nul <= '0';
  words_down <= '0';
  words_keeps <= '1';
  exit_rest <= state(32);
  exit_mask <= state(28 downto 26);
  body_rest <= '0';
  body_amount <= (others => '0');
  next_last <= early_last;
  words_pending <= '0';
  words_value <= (others => '0');

end architecture;
