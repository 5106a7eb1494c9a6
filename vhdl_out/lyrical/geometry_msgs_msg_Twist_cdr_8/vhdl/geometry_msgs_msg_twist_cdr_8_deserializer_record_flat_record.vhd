-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_twist_cdr_8_deserializer_record_flat.record of the Amaranth design.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_record is
  port (
    record_ready              : in  std_logic;
    record_valid              : out std_logic;
    message_linear_x_ready    : out std_logic;
    message_linear_x_valid    : in  std_logic;
    message_linear_y_valid    : in  std_logic;
    message_linear_z_valid    : in  std_logic;
    message_angular_x_valid   : in  std_logic;
    message_angular_y_valid   : in  std_logic;
    message_angular_z_valid   : in  std_logic;
    message_linear_x_payload  : in  unsigned(63 downto 0);
    message_linear_y_payload  : in  unsigned(63 downto 0);
    message_linear_z_payload  : in  unsigned(63 downto 0);
    message_angular_x_payload : in  unsigned(63 downto 0);
    message_angular_y_payload : in  unsigned(63 downto 0);
    message_angular_z_payload : in  unsigned(63 downto 0)
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_record is

  -- Signals that no logic reads, for simulation.
  signal taken                   : std_logic;
  signal message_linear_y_ready  : std_logic;
  signal message_linear_z_ready  : std_logic;
  signal message_angular_x_ready : std_logic;
  signal message_angular_y_ready : std_logic;
  signal message_angular_z_ready : std_logic;
  signal record_payload          : unsigned(383 downto 0);
begin

  record_valid <= and unsigned'(message_angular_z_valid & message_angular_y_valid &
      message_angular_x_valid & message_linear_z_valid & message_linear_y_valid &
      message_linear_x_valid);
  message_linear_x_ready <= record_valid and record_ready;

  taken <= message_linear_x_ready;
  message_linear_y_ready <= message_linear_x_ready;
  message_linear_z_ready <= message_linear_x_ready;
  message_angular_x_ready <= message_linear_x_ready;
  message_angular_y_ready <= message_linear_x_ready;
  message_angular_z_ready <= message_linear_x_ready;
  record_payload <= message_angular_z_payload & message_angular_y_payload &
      message_angular_x_payload & message_linear_z_payload & message_linear_y_payload &
      message_linear_x_payload;

end architecture;
