-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_twist_cdr_8_serializer_flat.core.packer of the Amaranth design.
-- 7 registers at rising_edge(aclk), synchronous reset rst = '1'.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_serializer_flat_core_packer is
  port (
    rst             : in  std_logic;
    aclk            : in  std_logic;
    packets_ready   : in  std_logic;
    word_valid      : in  std_logic;
    packets_valid   : out std_logic;
    error_sig       : out std_logic;
    word_ready      : out std_logic;
    word_payload    : in  unsigned(72 downto 0);
    packets_payload : out unsigned(68 downto 0)
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_serializer_flat_core_packer is

  -- Registers.
  signal store      : unsigned(63 downto 0) := (others => '0');
  signal level      : unsigned(4 downto 0) := (others => '0');
  signal ending     : std_logic := '0';
  signal end_beats  : unsigned(1 downto 0) := (others => '0');
  signal inside_sig : std_logic := '0';
  signal end_count  : unsigned(3 downto 0) := (others => '0');
  signal marked     : std_logic := '0';

  -- Combinational signals.
  signal is_last      : std_logic;
  signal leaves       : std_logic;
  signal rest         : unsigned(4 downto 0);
  signal kept         : unsigned(63 downto 0);
  signal still_ending : std_logic;
  signal pad          : unsigned(2 downto 0);
  signal and_15       : std_logic;
  signal add_17       : unsigned(5 downto 0);
  signal and_24       : std_logic;
  signal choice_like  : unsigned(4 downto 0);
  signal beats        : unsigned(4 downto 0);

  -- Signals that no logic reads, for simulation.
  signal position : unsigned(2 downto 0);
begin

  packets_valid <= '1' when ending = '1' or level >= 8 else '0';
  is_last <= '1' when ending = '1' and end_beats = 1 else '0';
  error_sig <= is_last and marked;
  leaves <= packets_valid and packets_ready;
  rest <= level - 8 when leaves = '1' else level;
  kept <= (others => '0') when leaves = '1' else store;
  still_ending <= ending and not (leaves and is_last);
  word_ready <= '1' when rest <= 0 and (still_ending = '0' or word_payload(71) = '0') else '0';
  pad <= 0 - word_payload(66 downto 64) and word_payload(70 downto 68);
  and_15 <= word_valid and word_ready;
  add_17 <= resize(choice_like, 6) + 7;
  and_24 <= word_valid and word_ready;

  choice_like <= rest + word_payload(67 downto 64) when and_15 = '1' and word_payload(71) = '1' else
                 (others => '0');

  beats <= resize(add_17(5 downto 3), 5) + (not inside_sig and
      to_std_logic(word_payload(67 downto 64) = 0)) when and_15 = '1' and
      word_payload(71) = '1' else
           (others => '0');

  p_aclk : process (aclk)
  begin
    if rising_edge(aclk) then
      if rst = '1' then
        store <= (others => '0');
        level <= (others => '0');
        ending <= '0';
        end_beats <= (others => '0');
        inside_sig <= '0';
        end_count <= (others => '0');
        marked <= '0';
      else
        store <= kept;
        if and_24 = '1' then
          store <= kept or word_payload(63 downto 0);
          inside_sig <= not word_payload(71) and (inside_sig or
              to_std_logic(word_payload(67 downto 64) /= 0));
          if word_payload(71) = '1' then
            if inside_sig = '0' and word_payload(67 downto 64) = 0 then
              end_count <= (others => '0');
            else
              end_count <= resize(choice_like(2 downto 0) - 1, 4) + 1;
            end if;
            marked <= word_payload(72);
          end if;
        end if;
        level <= rest;
        if and_24 = '1' then
          level <= rest + word_payload(67 downto 64) + pad;
          if word_payload(71) = '1' then
            level <= beats(1 downto 0) & "000";
          end if;
        end if;
        ending <= still_ending;
        if and_24 = '1' and word_payload(71) = '1' then
          ending <= '1';
        end if;
        if leaves = '1' then
          end_beats <= end_beats - 1;
        end if;
        if and_24 = '1' and word_payload(71) = '1' then
          end_beats <= beats(1 downto 0);
        end if;
      end if;
    end if;
  end process;

  packets_payload <= is_last & mux(is_last, end_count, "1000") & store;

  position <= (others => '0');

end architecture;
