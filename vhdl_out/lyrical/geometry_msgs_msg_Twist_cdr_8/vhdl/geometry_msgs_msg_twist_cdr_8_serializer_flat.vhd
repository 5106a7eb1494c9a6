-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_Twist_cdr_8_serializer of the Amaranth design.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_serializer_flat is
  port (
    aclk                 : in  std_logic;
    aresetn              : in  std_logic;
    m_axis_tready        : in  std_logic;
    linear_x_data        : in  std_logic_vector(63 downto 0);
    linear_x_valid       : in  std_logic;
    linear_y_data        : in  std_logic_vector(63 downto 0);
    linear_y_valid       : in  std_logic;
    linear_z_data        : in  std_logic_vector(63 downto 0);
    linear_z_valid       : in  std_logic;
    angular_x_data       : in  std_logic_vector(63 downto 0);
    angular_x_valid      : in  std_logic;
    angular_y_data       : in  std_logic_vector(63 downto 0);
    angular_y_valid      : in  std_logic;
    angular_z_data       : in  std_logic_vector(63 downto 0);
    angular_z_valid      : in  std_logic;
    m_axis_status_tready : in  std_logic;
    m_axis_tdata         : out std_logic_vector(63 downto 0);
    m_axis_tkeep         : out std_logic_vector(7 downto 0);
    m_axis_tlast         : out std_logic;
    m_axis_tuser         : out std_logic;
    m_axis_tvalid        : out std_logic;
    linear_x_ready       : out std_logic;
    linear_y_ready       : out std_logic;
    linear_z_ready       : out std_logic;
    angular_x_ready      : out std_logic;
    angular_y_ready      : out std_logic;
    angular_z_ready      : out std_logic;
    m_axis_status_tdata  : out std_logic_vector(7 downto 0);
    m_axis_status_tvalid : out std_logic
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_serializer_flat is

  -- Combinational signals.
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal status_payload  : unsigned(2 downto 0);
  signal packets_payload : unsigned(68 downto 0);
  signal rst             : std_logic;

  -- Signals that no logic reads, for simulation.
  signal packet_error              : std_logic;
  signal packets_valid             : std_logic;
  signal packets_ready             : std_logic;
  signal status_valid              : std_logic;
  signal status_ready              : std_logic;
  signal message_linear_x_payload  : unsigned(63 downto 0);
  signal message_linear_x_valid    : std_logic;
  signal message_linear_x_ready    : std_logic;
  signal message_linear_y_payload  : unsigned(63 downto 0);
  signal message_linear_y_valid    : std_logic;
  signal message_linear_y_ready    : std_logic;
  signal message_linear_z_payload  : unsigned(63 downto 0);
  signal message_linear_z_valid    : std_logic;
  signal message_linear_z_ready    : std_logic;
  signal message_angular_x_payload : unsigned(63 downto 0);
  signal message_angular_x_valid   : std_logic;
  signal message_angular_x_ready   : std_logic;
  signal message_angular_y_payload : unsigned(63 downto 0);
  signal message_angular_y_valid   : std_logic;
  signal message_angular_y_ready   : std_logic;
  signal message_angular_z_payload : unsigned(63 downto 0);
  signal message_angular_z_valid   : std_logic;
  signal message_angular_z_ready   : std_logic;
begin

  core : entity work.geometry_msgs_msg_twist_cdr_8_serializer_flat_core
    port map (
      aclk                      => aclk,
      packets_ready             => m_axis_tready,
      message_linear_x_payload  => unsigned(linear_x_data),
      message_linear_x_valid    => linear_x_valid,
      message_linear_y_payload  => unsigned(linear_y_data),
      message_linear_y_valid    => linear_y_valid,
      message_linear_z_payload  => unsigned(linear_z_data),
      message_linear_z_valid    => linear_z_valid,
      message_angular_x_payload => unsigned(angular_x_data),
      message_angular_x_valid   => angular_x_valid,
      message_angular_y_payload => unsigned(angular_y_data),
      message_angular_y_valid   => angular_y_valid,
      message_angular_z_payload => unsigned(angular_z_data),
      message_angular_z_valid   => angular_z_valid,
      status_ready              => m_axis_status_tready,
      rst                       => rst,
      message_linear_x_ready    => linear_x_ready,
      message_linear_y_ready    => linear_y_ready,
      message_linear_z_ready    => linear_z_ready,
      message_angular_x_ready   => angular_x_ready,
      message_angular_y_ready   => angular_y_ready,
      message_angular_z_ready   => angular_z_ready,
      status_valid              => m_axis_status_tvalid,
      status_payload            => status_payload,
      packets_valid             => m_axis_tvalid,
      packets_payload           => packets_payload,
      packet_error              => m_axis_tuser
    );

  rst <= not aresetn;

  m_axis_tdata <= std_logic_vector(packets_payload(63 downto 0));
  m_axis_tkeep <= std_logic_vector(unsigned'(to_std_logic(packets_payload(67 downto 64) > 7) &
      to_std_logic(packets_payload(67 downto 64) > 6) &
      to_std_logic(packets_payload(67 downto 64) > 5) &
      to_std_logic(packets_payload(67 downto 64) > 4) &
      to_std_logic(packets_payload(67 downto 64) > 3) &
      to_std_logic(packets_payload(67 downto 64) > 2) &
      to_std_logic(packets_payload(67 downto 64) > 1) &
      to_std_logic(packets_payload(67 downto 64) > 0)));
  m_axis_tlast <= packets_payload(68);
  m_axis_status_tdata <= std_logic_vector(resize(status_payload, 8));

  packet_error <= m_axis_tuser;
  packets_valid <= m_axis_tvalid;
  packets_ready <= m_axis_tready;
  status_valid <= m_axis_status_tvalid;
  status_ready <= m_axis_status_tready;
  message_linear_x_payload <= unsigned(linear_x_data);
  message_linear_x_valid <= linear_x_valid;
  message_linear_x_ready <= linear_x_ready;
  message_linear_y_payload <= unsigned(linear_y_data);
  message_linear_y_valid <= linear_y_valid;
  message_linear_y_ready <= linear_y_ready;
  message_linear_z_payload <= unsigned(linear_z_data);
  message_linear_z_valid <= linear_z_valid;
  message_linear_z_ready <= linear_z_ready;
  message_angular_x_payload <= unsigned(angular_x_data);
  message_angular_x_valid <= angular_x_valid;
  message_angular_x_ready <= angular_x_ready;
  message_angular_y_payload <= unsigned(angular_y_data);
  message_angular_y_valid <= angular_y_valid;
  message_angular_y_ready <= angular_y_ready;
  message_angular_z_payload <= unsigned(angular_z_data);
  message_angular_z_valid <= angular_z_valid;
  message_angular_z_ready <= angular_z_ready;

end architecture;
