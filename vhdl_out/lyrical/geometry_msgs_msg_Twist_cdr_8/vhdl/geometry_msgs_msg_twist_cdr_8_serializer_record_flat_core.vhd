-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_twist_cdr_8_serializer_record_flat.core of the Amaranth design.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core is
  port (
    rst                       : in  std_logic;
    aclk                      : in  std_logic;
    packets_ready             : in  std_logic;
    status_ready              : in  std_logic;
    message_linear_x_ready    : out std_logic;
    message_linear_y_ready    : out std_logic;
    message_linear_z_ready    : out std_logic;
    message_angular_x_ready   : out std_logic;
    message_angular_y_ready   : out std_logic;
    message_angular_z_ready   : out std_logic;
    message_linear_x_valid    : in  std_logic;
    message_linear_y_valid    : in  std_logic;
    message_linear_z_valid    : in  std_logic;
    message_angular_x_valid   : in  std_logic;
    message_angular_y_valid   : in  std_logic;
    message_angular_z_valid   : in  std_logic;
    status_valid              : out std_logic;
    -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
    status_payload            : out unsigned(2 downto 0);
    packets_valid             : out std_logic;
    packets_payload           : out unsigned(68 downto 0);
    packet_error              : out std_logic;
    message_linear_x_payload  : in  unsigned(63 downto 0);
    message_linear_y_payload  : in  unsigned(63 downto 0);
    message_linear_z_payload  : in  unsigned(63 downto 0);
    message_angular_x_payload : in  unsigned(63 downto 0);
    message_angular_y_payload : in  unsigned(63 downto 0);
    message_angular_z_payload : in  unsigned(63 downto 0)
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core is

  -- Combinational signals.
  signal words_payload_0   : unsigned(127 downto 0);
  signal words_payload_128 : unsigned(32 downto 0);
  signal words_valid       : std_logic;
  signal words_ready       : std_logic;

  -- Signals that no logic reads, for simulation.
  signal words_payload   : unsigned(160 downto 0);
  signal words_payload_1 : unsigned(160 downto 0);
  signal error_sig       : std_logic;
begin

  collector : entity work.geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core_collector
    port map (
      aclk                      => aclk,
      status_ready              => status_ready,
      rst                       => rst,
      message_linear_x_ready    => message_linear_x_ready,
      message_linear_y_ready    => message_linear_y_ready,
      message_linear_z_ready    => message_linear_z_ready,
      message_angular_x_ready   => message_angular_x_ready,
      message_angular_y_ready   => message_angular_y_ready,
      message_angular_z_ready   => message_angular_z_ready,
      message_linear_x_valid    => message_linear_x_valid,
      message_linear_y_valid    => message_linear_y_valid,
      message_linear_z_valid    => message_linear_z_valid,
      message_angular_x_valid   => message_angular_x_valid,
      message_angular_y_valid   => message_angular_y_valid,
      message_angular_z_valid   => message_angular_z_valid,
      port_635_0                => words_payload_0,
      port_639_0                => words_payload_128,
      status_valid              => status_valid,
      status_payload            => status_payload,
      words_valid               => words_valid,
      words_ready               => words_ready,
      message_linear_x_payload  => message_linear_x_payload,
      message_linear_y_payload  => message_linear_y_payload,
      message_linear_z_payload  => message_linear_z_payload,
      message_angular_x_payload => message_angular_x_payload,
      message_angular_y_payload => message_angular_y_payload,
      message_angular_z_payload => message_angular_z_payload
    );

  packer : entity work.geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core_packer
    port map (
      aclk              => aclk,
      packets_ready     => packets_ready,
      rst               => rst,
      words_payload_0   => words_payload_0,
      words_payload_128 => words_payload_128,
      words_valid       => words_valid,
      words_ready       => words_ready,
      packets_valid     => packets_valid,
      packets_payload   => packets_payload,
      error_sig         => packet_error
    );

  words_payload <= words_payload_128 & words_payload_0;
  words_payload_1 <= words_payload_128 & words_payload_0;
  error_sig <= packet_error;

end architecture;
