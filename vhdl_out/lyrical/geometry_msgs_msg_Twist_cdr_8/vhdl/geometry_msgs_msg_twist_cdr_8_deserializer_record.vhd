-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- The deserializer of geometry_msgs/msg/Twist: whole messages, as a record of values.
-- geometry_msgs_msg_twist_cdr_8_deserializer_record_flat has flat ports.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_types_pkg.all;
use work.geometry_msgs_msg_twist_cdr_8_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_record is
  port (
    aclk                 : in  std_logic;                      -- Clock; the rising edge is active.
    aresetn              : in  std_logic;                      -- Synchronous reset, active low.
    -- Bytes of the packet, the first one in bits 7 to 0.
    s_axis_tdata         : in  std_logic_vector(63 downto 0);
    -- Valid bytes, from lane 0 on; all ones except in the last beat.
    s_axis_tkeep         : in  std_logic_vector(7 downto 0);
    s_axis_tlast         : in  std_logic;                      -- Last beat of the packet.
    s_axis_tvalid        : in  std_logic;                      -- beat: valid.
    s_axis_tready        : out std_logic;                      -- beat: ready.
    -- The fields of geometry_msgs/msg/Twist.
    msg                  : out twist_value_t;
    -- Valid: the whole message is offered.
    msg_valid            : out std_logic;
    msg_ready            : in  std_logic;                      -- Ready: the message is taken.
    -- Status of a packet, one transfer per packet; 0 is OK.
    m_axis_status_tdata  : out std_logic_vector(7 downto 0);
    m_axis_status_tvalid : out std_logic;                      -- status: valid.
    m_axis_status_tready : in  std_logic                       -- status: ready.
  );
end entity;

architecture wrapper of geometry_msgs_msg_twist_cdr_8_deserializer_record is

  signal msg_data : std_logic_vector(383 downto 0);

begin

  core : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_record_flat
    port map (
      aclk                 => aclk,
      aresetn              => aresetn,
      s_axis_tdata         => s_axis_tdata,
      s_axis_tkeep         => s_axis_tkeep,
      s_axis_tlast         => s_axis_tlast,
      s_axis_tvalid        => s_axis_tvalid,
      s_axis_tready        => s_axis_tready,
      msg_data             => msg_data,
      msg_valid            => msg_valid,
      msg_ready            => msg_ready,
      m_axis_status_tdata  => m_axis_status_tdata,
      m_axis_status_tvalid => m_axis_status_tvalid,
      m_axis_status_tready => m_axis_status_tready
    );

  msg <= to_twist_value(msg_data);

end architecture;
