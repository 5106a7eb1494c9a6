-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_twist_cdr_8_serializer_record_flat.core.packer of the Amaranth design.
-- 20 registers at rising_edge(aclk), synchronous reset rst = '1'.
-- 4 registers at rising_edge(aclk), no reset.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core_packer is
  port (
    rst               : in  std_logic;
    aclk              : in  std_logic;
    packets_ready     : in  std_logic;
    words_payload_0   : in  unsigned(127 downto 0);
    words_payload_128 : in  unsigned(32 downto 0);
    words_valid       : in  std_logic;
    words_ready       : out std_logic;
    packets_valid     : out std_logic;
    packets_payload   : out unsigned(68 downto 0);
    error_sig         : out std_logic
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core_packer is

  -- Registers.
  signal words_ready_q      : std_logic := '1';
  signal packets_valid_q    : std_logic := '0';
  signal packets_payload_q  : unsigned(68 downto 0) := (others => '0');
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
  signal items_has_0        : unsigned(7 downto 0) := (others => '0');
  signal map_has_0          : unsigned(7 downto 0) := (others => '0');
  signal map_has_4          : unsigned(7 downto 0) := (others => '0');
  signal complete           : unsigned(3 downto 0) := (others => '0');
  signal last               : unsigned(7 downto 0) := (others => '0');
  signal first              : unsigned(3 downto 0) := (others => '0');

  -- Combinational signals.
  signal takes             : std_logic;
  signal total             : unsigned(6 downto 0);
  signal total_6           : unsigned(6 downto 0);
  signal base              : unsigned(6 downto 0);
  signal end_sig           : unsigned(6 downto 0);
  signal add_13            : unsigned(3 downto 0);
  signal map_end           : unsigned(6 downto 0);
  signal newest            : unsigned(3 downto 0);
  signal room              : unsigned(3 downto 0);
  signal items_used_0      : std_logic;
  signal items_written_0   : std_logic;
  signal map_used_0        : std_logic;
  signal map_written_0     : std_logic;
  signal map_used_4        : std_logic;
  signal map_written_4     : std_logic;
  signal ends_write_addr   : unsigned(2 downto 0);
  signal ends_write_en     : std_logic;
  signal reads             : std_logic;
  signal is_last           : std_logic;
  signal and_139           : std_logic;
  signal sub_140           : unsigned(2 downto 0);
  signal items_0_read_data : unsigned(63 downto 0);
  signal map_0_read_data   : unsigned(31 downto 0);
  signal map_4_read_data   : unsigned(31 downto 0);
  signal ends_read_data    : unsigned(4 downto 0);

  -- Signals that no logic reads, for simulation.
  signal words_payload      : unsigned(160 downto 0);
  signal map_at             : unsigned(6 downto 0);
  signal ready              : std_logic;
  signal items_index_0      : unsigned(2 downto 0);
  signal items_slot_0       : unsigned(2 downto 0);
  signal items_0_write_addr : unsigned(2 downto 0);
  signal items_placed       : unsigned(63 downto 0);
  signal items_0_write_en   : std_logic;
  signal items_0_read_addr  : unsigned(2 downto 0);
  signal map_index_0        : unsigned(2 downto 0);
  signal map_slot_0         : unsigned(2 downto 0);
  signal map_0_write_addr   : unsigned(2 downto 0);
  signal map_0_write_data   : unsigned(31 downto 0);
  signal map_0_write_en     : std_logic;
  signal map_0_read_addr    : unsigned(2 downto 0);
  signal map_index_4        : unsigned(2 downto 0);
  signal map_slot_4         : unsigned(2 downto 0);
  signal map_4_write_addr   : unsigned(2 downto 0);
  signal map_4_write_data   : unsigned(31 downto 0);
  signal map_4_write_en     : std_logic;
  signal map_4_read_addr    : unsigned(2 downto 0);
  signal ends_read_addr     : unsigned(2 downto 0);
  signal payload            : unsigned(68 downto 0);
  signal error_now          : std_logic;
  signal ends_write_data    : unsigned(4 downto 0);

  type items_0_array is array (0 to 7) of unsigned(63 downto 0);
  signal items_0 : items_0_array := (others => (others => '0'));

  type map_0_array is array (0 to 7) of unsigned(31 downto 0);
  signal map_0 : map_0_array := (others => (others => '0'));

  type map_4_array is array (0 to 7) of unsigned(31 downto 0);
  signal map_4 : map_4_array := (others => (others => '0'));

  type ends_array is array (0 to 7) of unsigned(4 downto 0);
  signal ends : ends_array := (others => (others => '0'));
begin

  takes <= words_valid and words_ready_q;
  total <= at + words_payload_128(13 downto 9);
  total_6 <= base + words_payload_128(22 downto 17);
  base <= (total and not resize(words_payload_128(16 downto 14), 7)) or
      resize(words_payload_128(16 downto 14) and "100", 7);
  end_sig <= (total_6 and not resize(words_payload_128(25 downto 23), 7)) or
      resize(words_payload_128(25 downto 23) and mux(words_payload_128(29), "000", "100"), 7);
  add_13 <= base(6 downto 3) + words_payload_128(8);
  map_end <= unsigned'(add_13 & base(2 downto 0)) + words_payload_128(7 downto 4);
  newest <= at(6 downto 3) + mux(takes, words_payload_128(28 downto 26), "000");
  room <= bound - newest;
  items_used_0 <= '1' when writes = '1' and items_size > 0 else '0';
  items_written_0 <= lsb(resize(shift_right(items_has_0, to_integer(first(2 downto 0))), 1));
  map_used_0 <= '1' when writes = '1' and map_size > 0 else '0';
  map_written_0 <= lsb(resize(shift_right(map_has_0, to_integer(first(2 downto 0))), 1));
  map_used_4 <= '1' when writes = '1' and map_size > 4 else '0';
  map_written_4 <= lsb(resize(shift_right(map_has_4, to_integer(first(2 downto 0))), 1));
  ends_write_addr <= complete_next(2 downto 0) - 1;
  ends_write_en <= writes and ends_packet;
  reads <= '1' when complete /= first and (packets_valid_q = '0' or packets_ready = '1') else '0';
  is_last <= lsb(resize(shift_right(last, to_integer(first(2 downto 0))), 1));
  and_139 <= writes and not waits;
  sub_140 <= complete_next(2 downto 0) - 1;

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

  process (aclk)
  begin
    if rising_edge(aclk) then
      if ends_write_en = '1' then
        ends(to_integer(ends_write_addr)) <= failed & last_bytes;
      end if;
    end if;
  end process;

  ends_read_data <= ends(to_integer(first(2 downto 0)));

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
        words_ready_q <= '1';
        bound <= "0101";
        items_has_0 <= (others => '0');
        map_has_0 <= (others => '0');
        map_has_4 <= (others => '0');
        complete <= (others => '0');
        last <= (others => '0');
        packets_valid_q <= '0';
        first <= (others => '0');
      else
        writes <= takes;
        if takes = '1' then
          if words_payload_128(8) = '1' then
            items_start <= base;
          else
            items_start <= at;
          end if;
          items_size <= words_payload_128(3 downto 0);
          map_start <= add_13 & base(2 downto 0);
          map_size <= words_payload_128(7 downto 4);
          at <= end_sig;
          complete_next <= end_sig(6 downto 3);
          ends_packet <= words_payload_128(29);
          failed <= words_payload_128(32);
          waits <= words_payload_128(31);
          if words_payload_128(30) = '1' then
            last_bytes <= (others => '0');
          else
            last_bytes <= resize(map_end(2 downto 0) - 1, 4) + 1;
          end if;
        end if;
        words_ready_q <= not room(3);
        if reads = '1' then
          bound <= bound + 1;
          first <= first + 1;
        end if;
        if reads = '1' and first(2 downto 0) = 0 then
          items_has_0(0) <= '0';
        elsif items_used_0 = '1' and items_start(5 downto 3) = 0 then
          items_has_0(0) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 1 then
          items_has_0(1) <= '0';
        elsif items_used_0 = '1' and items_start(5 downto 3) = 1 then
          items_has_0(1) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 2 then
          items_has_0(2) <= '0';
        elsif items_used_0 = '1' and items_start(5 downto 3) = 2 then
          items_has_0(2) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 3 then
          items_has_0(3) <= '0';
        elsif items_used_0 = '1' and items_start(5 downto 3) = 3 then
          items_has_0(3) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 4 then
          items_has_0(4) <= '0';
        elsif items_used_0 = '1' and items_start(5 downto 3) = 4 then
          items_has_0(4) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 5 then
          items_has_0(5) <= '0';
        elsif items_used_0 = '1' and items_start(5 downto 3) = 5 then
          items_has_0(5) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 6 then
          items_has_0(6) <= '0';
        elsif items_used_0 = '1' and items_start(5 downto 3) = 6 then
          items_has_0(6) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 7 then
          items_has_0(7) <= '0';
        elsif items_used_0 = '1' and items_start(5 downto 3) = 7 then
          items_has_0(7) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 0 then
          map_has_0(0) <= '0';
        elsif map_used_0 = '1' and map_start(5 downto 3) = 0 then
          map_has_0(0) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 1 then
          map_has_0(1) <= '0';
        elsif map_used_0 = '1' and map_start(5 downto 3) = 1 then
          map_has_0(1) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 2 then
          map_has_0(2) <= '0';
        elsif map_used_0 = '1' and map_start(5 downto 3) = 2 then
          map_has_0(2) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 3 then
          map_has_0(3) <= '0';
        elsif map_used_0 = '1' and map_start(5 downto 3) = 3 then
          map_has_0(3) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 4 then
          map_has_0(4) <= '0';
        elsif map_used_0 = '1' and map_start(5 downto 3) = 4 then
          map_has_0(4) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 5 then
          map_has_0(5) <= '0';
        elsif map_used_0 = '1' and map_start(5 downto 3) = 5 then
          map_has_0(5) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 6 then
          map_has_0(6) <= '0';
        elsif map_used_0 = '1' and map_start(5 downto 3) = 6 then
          map_has_0(6) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 7 then
          map_has_0(7) <= '0';
        elsif map_used_0 = '1' and map_start(5 downto 3) = 7 then
          map_has_0(7) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 0 then
          map_has_4(0) <= '0';
        elsif map_used_4 = '1' and map_start(5 downto 3) = 0 then
          map_has_4(0) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 1 then
          map_has_4(1) <= '0';
        elsif map_used_4 = '1' and map_start(5 downto 3) = 1 then
          map_has_4(1) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 2 then
          map_has_4(2) <= '0';
        elsif map_used_4 = '1' and map_start(5 downto 3) = 2 then
          map_has_4(2) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 3 then
          map_has_4(3) <= '0';
        elsif map_used_4 = '1' and map_start(5 downto 3) = 3 then
          map_has_4(3) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 4 then
          map_has_4(4) <= '0';
        elsif map_used_4 = '1' and map_start(5 downto 3) = 4 then
          map_has_4(4) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 5 then
          map_has_4(5) <= '0';
        elsif map_used_4 = '1' and map_start(5 downto 3) = 5 then
          map_has_4(5) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 6 then
          map_has_4(6) <= '0';
        elsif map_used_4 = '1' and map_start(5 downto 3) = 6 then
          map_has_4(6) <= '1';
        end if;
        if reads = '1' and first(2 downto 0) = 7 then
          map_has_4(7) <= '0';
        elsif map_used_4 = '1' and map_start(5 downto 3) = 7 then
          map_has_4(7) <= '1';
        end if;
        if and_139 = '1' then
          complete <= complete_next;
          if ends_packet = '1' then
            case sub_140 is
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
        items_0_write_data <= words_payload_0(63 downto 0);
        map_placed <= words_payload_0(127 downto 64);
      end if;
      if reads = '1' then
        packets_payload_q(63 downto 0) <= (mux(items_written_0, items_0_read_data(63 downto 32),
            x"00000000") or mux(map_written_4, map_4_read_data, x"00000000")) &
            (mux(items_written_0, items_0_read_data(31 downto 0), x"00000000") or mux(map_written_0,
            map_0_read_data, x"00000000"));
        packets_payload_q(68) <= is_last;
        if is_last = '1' then
          packets_payload_q(67 downto 64) <= ends_read_data(3 downto 0);
        else
          packets_payload_q(67 downto 64) <= "1000";
        end if;
        error_sig_q <= is_last and ends_read_data(4);
      end if;
    end if;
  end process;

  words_ready <= words_ready_q;
  packets_valid <= packets_valid_q;
  packets_payload <= packets_payload_q;
  error_sig <= error_sig_q;

  words_payload <= words_payload_128 & words_payload_0;
  map_at <= add_13 & base(2 downto 0);
  ready <= words_ready_q;
  items_index_0 <= (others => '0');
  items_slot_0 <= items_start(5 downto 3);
  items_0_write_addr <= items_start(5 downto 3);
  items_placed <= items_0_write_data;
  items_0_write_en <= items_used_0;
  items_0_read_addr <= first(2 downto 0);
  map_index_0 <= (others => '0');
  map_slot_0 <= map_start(5 downto 3);
  map_0_write_addr <= map_start(5 downto 3);
  map_0_write_data <= map_placed(31 downto 0);
  map_0_write_en <= map_used_0;
  map_0_read_addr <= first(2 downto 0);
  map_index_4 <= "100";
  map_slot_4 <= map_start(5 downto 3);
  map_4_write_addr <= map_start(5 downto 3);
  map_4_write_data <= map_placed(63 downto 32);
  map_4_write_en <= map_used_4;
  map_4_read_addr <= first(2 downto 0);
  ends_read_addr <= first(2 downto 0);
  payload <= packets_payload_q;
  error_now <= error_sig_q;
  ends_write_data <= failed & last_bytes;

end architecture;
