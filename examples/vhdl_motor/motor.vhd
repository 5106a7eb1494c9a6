-- The speed of a motor from geometry_msgs/msg/Twist: that of the last good packet.
--
-- The message of a damaged packet becomes valid like that of a good one; fields after the damage
-- are 0. Only the status reports the damage. It comes once per packet, not before the message. So
-- the message waits for the status, both are taken together, and the speed changes only if the
-- status is OK.

library ieee;
use ieee.std_logic_1164.all;

use work.firm_hdl_types_pkg.all;
use work.geometry_msgs_msg_twist_cdr_4_pkg.all;

entity motor is
  port (
    aclk          : in  std_logic;
    aresetn       : in  std_logic;
    s_axis_tdata  : in  std_logic_vector(31 downto 0);
    s_axis_tkeep  : in  std_logic_vector(3 downto 0);
    s_axis_tlast  : in  std_logic;
    s_axis_tvalid : in  std_logic;
    s_axis_tready : out std_logic;
    speed         : out std_logic_vector(63 downto 0) := (others => '0')  -- m/s, a float64's bits
  );
end entity;

architecture rtl of motor is

  signal msg       : twist_value_t;
  signal msg_valid : std_logic;

  signal status       : std_logic_vector(7 downto 0);
  signal status_valid : std_logic;

  signal take : std_logic;  -- the message and its status

begin

  rx : entity work.geometry_msgs_msg_twist_cdr_4_deserializer_record
    port map (
      aclk => aclk, aresetn => aresetn,
      s_axis_tdata => s_axis_tdata, s_axis_tkeep => s_axis_tkeep, s_axis_tlast => s_axis_tlast,
      s_axis_tvalid => s_axis_tvalid, s_axis_tready => s_axis_tready,
      msg => msg, msg_valid => msg_valid, msg_ready => take,
      m_axis_status_tdata => status, m_axis_status_tvalid => status_valid,
      m_axis_status_tready => take
    );

  take <= msg_valid and status_valid;

  process (aclk)
  begin
    if rising_edge(aclk) then
      if take = '1' and status = STATUS_OK then
        speed <= msg.linear.x;
      end if;
      if aresetn = '0' then
        speed <= (others => '0');
      end if;
    end if;
  end process;

end architecture;
