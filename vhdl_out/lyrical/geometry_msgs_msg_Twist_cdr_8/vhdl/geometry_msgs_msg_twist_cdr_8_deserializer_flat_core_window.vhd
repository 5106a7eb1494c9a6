-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_twist_cdr_8_deserializer_flat.core.window of the Amaranth design.
-- 6 registers at rising_edge(aclk), synchronous reset rst = '1'.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_window is
  port (
    rst             : in  std_logic;
    aclk            : in  std_logic;
    packets_valid   : in  std_logic;
    count           : in  unsigned(3 downto 0);
    take            : in  std_logic;
    finish          : in  std_logic;
    packets_ready   : out std_logic;
    data            : out unsigned(63 downto 0);
    ends_0          : out std_logic;
    port_341_0      : out unsigned(7 downto 0);
    ended           : out std_logic;
    held            : out std_logic;
    first_bytes     : out unsigned(3 downto 0);
    packets_payload : in  unsigned(68 downto 0);
    drop            : in  std_logic
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_window is

  -- Registers.
  signal free   : std_logic := '0';
  signal slot_0 : unsigned(72 downto 0) := (others => '0');
  signal slot_1 : unsigned(72 downto 0) := (others => '0');
  signal fill   : unsigned(1 downto 0) := (others => '0');
  signal first  : std_logic := '0';
  signal offset : unsigned(4 downto 0) := (others => '0');

  -- Combinational signals.
  signal valid_0       : std_logic;
  signal and_11        : unsigned(7 downto 0);
  signal add_21        : unsigned(3 downto 0);
  signal taken         : unsigned(5 downto 0);
  signal pops          : std_logic;
  signal and_34        : std_logic;
  signal beat_0        : unsigned(72 downto 0);
  signal pops_taken    : std_logic;
  signal pops_idle     : std_logic;
  signal pops_finished : std_logic;

  -- Signals that no logic reads, for simulation.
  signal have       : unsigned(11 downto 0);
  signal first_last : std_logic;
  signal past       : unsigned(5 downto 0);
begin

  packets_ready <= '1' when fill < 2 else '0';
  valid_0 <= '1' when fill > 0 else '0';
  ends_0 <= valid_0 and beat_0(72);
  and_11 <= beat_0(71 downto 64) and unsigned'(to_std_logic(offset(4 downto 3) = 0) &
      to_std_logic(offset(4 downto 3) = 0) & to_std_logic(offset(4 downto 3) = 0) &
      to_std_logic(offset(4 downto 3) = 0) & to_std_logic(offset(4 downto 3) = 0) &
      to_std_logic(offset(4 downto 3) = 0) & to_std_logic(offset(4 downto 3) = 0) &
      to_std_logic(offset(4 downto 3) = 0));
  port_341_0 <= and_11 and repeat_bit(valid_0, 8);
  held <= '1' when valid_0 = '1' and (offset(4 downto 3) = 0 or beat_0(72) = '1') else '0';
  add_21 <= resize(resize(resize(beat_0(64), 2) + beat_0(65), 3) + beat_0(66),
      4) + beat_0(67) + beat_0(68) + beat_0(69) + beat_0(70);
  first_bytes <= add_21 + beat_0(71) when offset(4 downto 3) = 0 else (others => '0');
  taken <= resize(offset, 6) + count;
  pops <= pops_finished when finish = '1' else mux(drop, '1', mux(take, pops_taken, pops_idle));
  and_34 <= packets_valid and packets_ready;

  beat_0 <= slot_0 when first = '0' else
            slot_1;

  pops_taken <= '1' when valid_0 = '1' and ends_0 = '0' and taken(5 downto 3) > 0 else
                '0';

  pops_idle <= '1' when valid_0 = '1' and ends_0 = '0' and offset(4 downto 3) > 0 else
               '0';

  pops_finished <= '1' when valid_0 = '1' else
                   '0';

  p_aclk : process (aclk)
  begin
    if rising_edge(aclk) then
      if rst = '1' then
        free <= '0';
        slot_0 <= (others => '0');
        slot_1 <= (others => '0');
        fill <= (others => '0');
        first <= '0';
        offset <= (others => '0');
      else
        if and_34 = '1' then
          free <= free xor '1';
          if resize(free, 1) = 0 then
            slot_0 <= packets_payload(68) & (not packets_payload(68) or
                to_std_logic(packets_payload(67 downto 64) > 7)) & (not packets_payload(68) or
                to_std_logic(packets_payload(67 downto 64) > 6)) & (not packets_payload(68) or
                to_std_logic(packets_payload(67 downto 64) > 5)) & (not packets_payload(68) or
                to_std_logic(packets_payload(67 downto 64) > 4)) & (not packets_payload(68) or
                to_std_logic(packets_payload(67 downto 64) > 3)) & (not packets_payload(68) or
                to_std_logic(packets_payload(67 downto 64) > 2)) & (not packets_payload(68) or
                to_std_logic(packets_payload(67 downto 64) > 1)) & (not packets_payload(68) or
                to_std_logic(packets_payload(67 downto 64) > 0)) & packets_payload(63 downto 0);
          end if;
          if free = '1' then
            slot_1 <= packets_payload(68) & (not packets_payload(68) or
                to_std_logic(packets_payload(67 downto 64) > 7)) & (not packets_payload(68) or
                to_std_logic(packets_payload(67 downto 64) > 6)) & (not packets_payload(68) or
                to_std_logic(packets_payload(67 downto 64) > 5)) & (not packets_payload(68) or
                to_std_logic(packets_payload(67 downto 64) > 4)) & (not packets_payload(68) or
                to_std_logic(packets_payload(67 downto 64) > 3)) & (not packets_payload(68) or
                to_std_logic(packets_payload(67 downto 64) > 2)) & (not packets_payload(68) or
                to_std_logic(packets_payload(67 downto 64) > 1)) & (not packets_payload(68) or
                to_std_logic(packets_payload(67 downto 64) > 0)) & packets_payload(63 downto 0);
          end if;
        end if;
        fill <= fill - pops + resize(packets_valid and packets_ready, 2);
        first <= first xor pops;
        if finish = '1' or drop = '1' then
          offset <= (others => '0');
        elsif take = '1' then
          offset <= (taken(4 downto 3) - pops) & "000";
        else
          offset(4 downto 3) <= offset(4 downto 3) - pops;
        end if;
      end if;
    end if;
  end process;

  data <= beat_0(63 downto 0);
  ended <= ends_0;

  have <= resize(port_341_0, 12);
  first_last <= ends_0;
  past <= taken;

end architecture;
