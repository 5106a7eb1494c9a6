-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_Twist_cdr_8_deserializer.core.queue of the Amaranth design.
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
    i_payload : in  unsigned(41 downto 0);
    oldest    : in  unsigned(3 downto 0);
    o_valid   : out std_logic;
    o_payload : out unsigned(41 downto 0)
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_queue is

  -- Registers.
  signal o_valid_q   : std_logic := '0';
  signal o_payload_q : unsigned(41 downto 0) := (others => '0');
  signal has_second  : std_logic := '0';
  signal second      : unsigned(41 downto 0) := (others => '0');
begin

  i_ready <= not has_second;
  freed <= o_payload_q(37 downto 34) when o_valid_q = '1' else mux(has_second, second(37 downto 34),
      oldest);

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
      if has_second = '0' then
        second <= i_payload;
      end if;
    end if;
  end process;

  o_valid <= o_valid_q;
  o_payload <= o_payload_q;

end architecture;
