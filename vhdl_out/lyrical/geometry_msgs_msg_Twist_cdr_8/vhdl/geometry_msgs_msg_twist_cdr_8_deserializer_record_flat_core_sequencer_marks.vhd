-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_twist_cdr_8_deserializer_record_flat.core.sequencer.marks of the Amaranth design.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_sequencer_marks is
  port (
    rst       : in  std_logic;
    aclk      : in  std_logic;
    mismatch  : out std_logic;
    beat      : in  unsigned(73 downto 0);
    header_at : in  unsigned(3 downto 0)
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_sequencer_marks is

  -- Combinational signals.
  signal headers_write_data : std_logic;

  -- Signals that no logic reads, for simulation.
  signal headers_write_addr : unsigned(2 downto 0);
  signal headers_write_en   : std_logic;
  signal headers_read_addr  : unsigned(2 downto 0);
  signal headers_read_data  : std_logic;

  type headers_array is array (0 to 7) of unsigned(0 downto 0);
  signal headers : headers_array := (others => (others => '0'));
begin

  headers_write_data <= or unsigned'((to_std_logic(beat(15 downto 8) /= 1) and (not beat(68) or
      to_std_logic(beat(67 downto 64) > 1))) & (to_std_logic(beat(7 downto 0) /= 0) and
      (not beat(68) or to_std_logic(beat(67 downto 64) > 0))));

  process (aclk)
  begin
    if rising_edge(aclk) then
      if beat(73) = '1' then
        headers(to_integer(beat(71 downto 69))) <= (0 => headers_write_data);
      end if;
    end if;
  end process;

  mismatch <= headers(to_integer(header_at(2 downto 0)))(0);

  headers_write_addr <= beat(71 downto 69);
  headers_write_en <= beat(73);
  headers_read_addr <= header_at(2 downto 0);
  headers_read_data <= mismatch;

end architecture;
