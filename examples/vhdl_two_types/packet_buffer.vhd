-- Holds packets back until their verdict is known, and drops those that are not good.
--
-- Each packet has one verdict, which is taken after its last beat. A packet that is longer than the
-- memory is dropped, too.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity packet_buffer is
  generic (
    bus_bytes    : positive;
    address_bits : positive := 8  -- the memory has 2 ** address_bits beats
  );
  port (
    aclk          : in  std_logic;
    aresetn       : in  std_logic;
    s_axis_tdata  : in  std_logic_vector(8 * bus_bytes - 1 downto 0);
    s_axis_tkeep  : in  std_logic_vector(bus_bytes - 1 downto 0);
    s_axis_tlast  : in  std_logic;
    s_axis_tvalid : in  std_logic;
    s_axis_tready : out std_logic;
    verdict_good  : in  std_logic;
    verdict_valid : in  std_logic;
    verdict_ready : out std_logic;
    m_axis_tdata  : out std_logic_vector(8 * bus_bytes - 1 downto 0);
    m_axis_tkeep  : out std_logic_vector(bus_bytes - 1 downto 0);
    m_axis_tlast  : out std_logic;
    m_axis_tvalid : out std_logic;
    m_axis_tready : in  std_logic
  );
end entity;

architecture rtl of packet_buffer is

  subtype beat_t is std_logic_vector(9 * bus_bytes downto 0);
  type memory_t is array (0 to 2 ** address_bits - 1) of beat_t;
  signal memory : memory_t;

  -- Pointers have one bit more than an address, so that full and empty differ. Beats from `taken` to
  -- `good` may leave; beats from `good` to `written` wait for their verdict.
  subtype place_t is unsigned(address_bits downto 0);
  signal taken, good, written : place_t;

  signal is_full  : std_logic;
  signal too_long : std_logic;  -- the packet does not fit; its rest is dropped
  signal is_over  : std_logic;  -- the packet's last beat was taken, but not yet its verdict
  signal accept   : std_logic;

  signal beat       : beat_t;
  signal beat_valid : std_logic;

begin

  is_full <= '1' when written - taken = 2 ** address_bits else '0';
  accept <= not is_over and (too_long or not is_full);
  s_axis_tready <= accept;
  verdict_ready <= is_over;

  m_axis_tdata <= beat(8 * bus_bytes - 1 downto 0);
  m_axis_tkeep <= beat(9 * bus_bytes - 1 downto 8 * bus_bytes);
  m_axis_tlast <= beat(9 * bus_bytes);
  m_axis_tvalid <= beat_valid;

  process (aclk)
  begin
    if rising_edge(aclk) then
      if (s_axis_tvalid and accept) = '1' then
        if too_long = '0' then
          memory(to_integer(written(address_bits - 1 downto 0))) <=
            s_axis_tlast & s_axis_tkeep & s_axis_tdata;
          written <= written + 1;
        end if;
        is_over <= s_axis_tlast;
      end if;

      -- The memory is full of one packet that has not ended: the packet does not fit.
      if (is_full and not is_over) = '1' and taken = good then
        too_long <= '1';
      end if;

      if (is_over and verdict_valid) = '1' then
        if (verdict_good and not too_long) = '1' then
          good <= written;
        else
          written <= good;
        end if;
        is_over <= '0';
        too_long <= '0';
      end if;

      if (m_axis_tready or not beat_valid) = '1' then
        beat <= memory(to_integer(taken(address_bits - 1 downto 0)));
        beat_valid <= '0';
        if taken /= good then
          beat_valid <= '1';
          taken <= taken + 1;
        end if;
      end if;

      if aresetn = '0' then
        taken <= (others => '0');
        good <= (others => '0');
        written <= (others => '0');
        too_long <= '0';
        is_over <= '0';
        beat_valid <= '0';
      end if;
    end if;
  end process;

end architecture;
