-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_Twist_cdr_8_deserializer.core of the Amaranth design.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_flat_core is
  port (
    rst                       : in  std_logic;
    aclk                      : in  std_logic;
    packets_valid             : in  std_logic;
    message_linear_x_ready    : in  std_logic;
    message_linear_y_ready    : in  std_logic;
    message_linear_z_ready    : in  std_logic;
    message_angular_x_ready   : in  std_logic;
    message_angular_y_ready   : in  std_logic;
    message_angular_z_ready   : in  std_logic;
    status_ready              : in  std_logic;
    packets_payload           : in  unsigned(68 downto 0);
    packets_ready             : out std_logic;
    message_linear_x_valid    : out std_logic;
    message_linear_y_valid    : out std_logic;
    message_linear_z_valid    : out std_logic;
    message_angular_x_valid   : out std_logic;
    message_angular_y_valid   : out std_logic;
    message_angular_z_valid   : out std_logic;
    status_valid              : out std_logic;
    -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
    status_payload            : out unsigned(2 downto 0);
    message_linear_x_payload  : out unsigned(63 downto 0);
    message_linear_y_payload  : out unsigned(63 downto 0);
    message_linear_z_payload  : out unsigned(63 downto 0);
    message_angular_x_payload : out unsigned(63 downto 0);
    message_angular_y_payload : out unsigned(63 downto 0);
    message_angular_z_payload : out unsigned(63 downto 0)
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_flat_core is

  -- Combinational signals.
  signal beat              : unsigned(73 downto 0);
  signal limit_sig         : unsigned(6 downto 0);
  signal following         : unsigned(3 downto 0);
  signal ended             : std_logic;
  signal i_valid           : std_logic;
  signal next_sig          : std_logic;
  signal i_payload         : unsigned(41 downto 0);
  signal oldest            : unsigned(3 downto 0);
  signal orders_ready      : std_logic;
  signal freed             : unsigned(3 downto 0);
  signal orders_valid_24   : std_logic;
  signal orders_payload_22 : unsigned(41 downto 0);
  signal o_ready           : std_logic;

  -- Signals that no logic reads, for simulation.
  signal orders_payload  : unsigned(41 downto 0);
  signal orders_valid    : std_logic;
  signal i_ready         : std_logic;
  signal o_payload       : unsigned(41 downto 0);
  signal o_valid         : std_logic;
  signal orders_ready_27 : std_logic;
begin

  buffer_sig : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_buffer
    port map (
      aclk            => aclk,
      packets_valid   => packets_valid,
      rst             => rst,
      next_sig        => next_sig,
      freed           => freed,
      packets_payload => packets_payload,
      beat            => beat,
      packets_ready   => packets_ready,
      limit_sig       => limit_sig,
      following       => following,
      ended           => ended
    );

  sequencer : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_sequencer
    port map (
      aclk           => aclk,
      rst            => rst,
      orders_valid   => i_valid,
      next_sig       => next_sig,
      orders_ready   => orders_ready,
      beat           => beat,
      limit_sig      => limit_sig,
      following      => following,
      ended          => ended,
      orders_payload => i_payload,
      header_at      => oldest
    );

  queue : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_queue
    port map (
      aclk      => aclk,
      rst       => rst,
      i_valid   => i_valid,
      i_ready   => orders_ready,
      freed     => freed,
      o_ready   => o_ready,
      i_payload => i_payload,
      oldest    => oldest,
      o_valid   => orders_valid_24,
      o_payload => orders_payload_22
    );

  mover : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_mover
    port map (
      aclk                      => aclk,
      message_linear_x_ready    => message_linear_x_ready,
      message_linear_y_ready    => message_linear_y_ready,
      message_linear_z_ready    => message_linear_z_ready,
      message_angular_x_ready   => message_angular_x_ready,
      message_angular_y_ready   => message_angular_y_ready,
      message_angular_z_ready   => message_angular_z_ready,
      status_ready              => status_ready,
      rst                       => rst,
      orders_ready              => o_ready,
      beat                      => beat,
      orders_valid              => orders_valid_24,
      orders_payload            => orders_payload_22,
      message_linear_x_valid    => message_linear_x_valid,
      message_linear_y_valid    => message_linear_y_valid,
      message_linear_z_valid    => message_linear_z_valid,
      message_angular_x_valid   => message_angular_x_valid,
      message_angular_y_valid   => message_angular_y_valid,
      message_angular_z_valid   => message_angular_z_valid,
      status_valid              => status_valid,
      status_payload            => status_payload,
      message_linear_x_payload  => message_linear_x_payload,
      message_linear_y_payload  => message_linear_y_payload,
      message_linear_z_payload  => message_linear_z_payload,
      message_angular_x_payload => message_angular_x_payload,
      message_angular_y_payload => message_angular_y_payload,
      message_angular_z_payload => message_angular_z_payload
    );

  orders_payload <= i_payload;
  orders_valid <= i_valid;
  i_ready <= orders_ready;
  o_payload <= orders_payload_22;
  o_valid <= orders_valid_24;
  orders_ready_27 <= o_ready;

end architecture;
