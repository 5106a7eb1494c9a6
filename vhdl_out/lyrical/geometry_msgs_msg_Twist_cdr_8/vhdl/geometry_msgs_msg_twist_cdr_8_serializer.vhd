-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- The serializer of geometry_msgs/msg/Twist with records.
-- geometry_msgs_msg_twist_cdr_8_serializer_flat has flat ports.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_types_pkg.all;
use work.geometry_msgs_msg_twist_cdr_8_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_serializer is
  port (
    aclk                 : in  std_logic;                      -- Clock; the rising edge is active.
    aresetn              : in  std_logic;                      -- Synchronous reset, active low.
    -- Bytes of the packet, the first one in bits 7 to 0.
    m_axis_tdata         : out std_logic_vector(63 downto 0);
    -- Valid bytes, from lane 0 on; all ones except in the last beat.
    m_axis_tkeep         : out std_logic_vector(7 downto 0);
    m_axis_tlast         : out std_logic;                      -- Last beat of the packet.
    -- With tlast: the packet's status is not OK; drop it.
    m_axis_tuser         : out std_logic;
    m_axis_tvalid        : out std_logic;                      -- beat: valid.
    m_axis_tready        : in  std_logic;                      -- beat: ready.
    -- Data and valid of geometry_msgs/msg/Twist.
    msg                  : in  twist_t;
    rdy                  : out twist_ready_t;                  -- Ready of the fields.
    -- Status of a packet, one transfer per packet; 0 is OK.
    m_axis_status_tdata  : out std_logic_vector(7 downto 0);
    m_axis_status_tvalid : out std_logic;                      -- status: valid.
    m_axis_status_tready : in  std_logic                       -- status: ready.
  );
end entity;

architecture wrapper of geometry_msgs_msg_twist_cdr_8_serializer is

begin

  core : entity work.geometry_msgs_msg_twist_cdr_8_serializer_flat
    port map (
      aclk                 => aclk,
      aresetn              => aresetn,
      m_axis_tdata         => m_axis_tdata,
      m_axis_tkeep         => m_axis_tkeep,
      m_axis_tlast         => m_axis_tlast,
      m_axis_tuser         => m_axis_tuser,
      m_axis_tvalid        => m_axis_tvalid,
      m_axis_tready        => m_axis_tready,
      linear_x_data        => msg.linear.x.data,
      linear_x_valid       => msg.linear.x.valid,
      linear_x_ready       => rdy.linear.x,
      linear_y_data        => msg.linear.y.data,
      linear_y_valid       => msg.linear.y.valid,
      linear_y_ready       => rdy.linear.y,
      linear_z_data        => msg.linear.z.data,
      linear_z_valid       => msg.linear.z.valid,
      linear_z_ready       => rdy.linear.z,
      angular_x_data       => msg.angular.x.data,
      angular_x_valid      => msg.angular.x.valid,
      angular_x_ready      => rdy.angular.x,
      angular_y_data       => msg.angular.y.data,
      angular_y_valid      => msg.angular.y.valid,
      angular_y_ready      => rdy.angular.y,
      angular_z_data       => msg.angular.z.data,
      angular_z_valid      => msg.angular.z.valid,
      angular_z_ready      => rdy.angular.z,
      m_axis_status_tdata  => m_axis_status_tdata,
      m_axis_status_tvalid => m_axis_status_tvalid,
      m_axis_status_tready => m_axis_status_tready
    );

end architecture;
