-- Records of geometry_msgs/msg/Twist: twist_t has data and valid of every field, twist_ready_t has
-- ready, in the opposite direction. TWIST_ALL_READY takes every transfer; TWIST_IDLE offers none.
-- Made by firm-hdl. All converters with wire cdr and a bus of 8 bytes share this file: compile it
-- once.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_types_pkg.all;
use work.firm_hdl_bus_8_pkg.all;
use work.geometry_msgs_msg_vector3_cdr_8_pkg;

package geometry_msgs_msg_twist_cdr_8_pkg is

  type twist_t is record
    linear  : work.geometry_msgs_msg_vector3_cdr_8_pkg.vector3_t;  -- geometry_msgs/msg/Vector3
    angular : work.geometry_msgs_msg_vector3_cdr_8_pkg.vector3_t;  -- geometry_msgs/msg/Vector3
  end record;

  type twist_ready_t is record
    linear  : work.geometry_msgs_msg_vector3_cdr_8_pkg.vector3_ready_t;
    angular : work.geometry_msgs_msg_vector3_cdr_8_pkg.vector3_ready_t;
  end record;

  constant TWIST_IDLE : twist_t := (
    linear  => work.geometry_msgs_msg_vector3_cdr_8_pkg.VECTOR3_IDLE,
    angular => work.geometry_msgs_msg_vector3_cdr_8_pkg.VECTOR3_IDLE);

  constant TWIST_ALL_READY : twist_ready_t := (
    linear  => work.geometry_msgs_msg_vector3_cdr_8_pkg.VECTOR3_ALL_READY,
    angular => work.geometry_msgs_msg_vector3_cdr_8_pkg.VECTOR3_ALL_READY);

  -- Sequences and arrays: all elements use the same streams, one after the other.

  type twist_sequence_t is record
    length : uint32_stream_t;  -- number of elements
    item   : twist_t;
  end record;

  type twist_sequence_ready_t is record
    length : std_logic;
    item   : twist_ready_t;
  end record;

  constant TWIST_SEQUENCE_IDLE : twist_sequence_t := (
    length => UINT32_STREAM_IDLE,
    item   => TWIST_IDLE);

  constant TWIST_SEQUENCE_ALL_READY : twist_sequence_ready_t := (
    length => '1',
    item   => TWIST_ALL_READY);

  type twist_array_t is record
    item : twist_t;
  end record;

  type twist_array_ready_t is record
    item : twist_ready_t;
  end record;

  constant TWIST_ARRAY_IDLE : twist_array_t := (
    item => TWIST_IDLE);

  constant TWIST_ARRAY_ALL_READY : twist_array_ready_t := (
    item => TWIST_ALL_READY);

  -- The message as plain values, for the ports of the entities ..._record.

  type twist_value_t is record
    -- geometry_msgs/msg/Vector3
    linear  : work.geometry_msgs_msg_vector3_cdr_8_pkg.vector3_value_t;
    -- geometry_msgs/msg/Vector3
    angular : work.geometry_msgs_msg_vector3_cdr_8_pkg.vector3_value_t;
  end record;

  type twist_values_t is array (natural range <>) of twist_value_t;

  -- Conversion between records and vectors, first member in the lowest bits.
  constant TWIST_VALUE_BITS : positive := 384;
  function to_slv (value : twist_value_t) return std_logic_vector;
  function to_twist_value (bits : std_logic_vector) return twist_value_t;
  function to_slv (values : twist_values_t) return std_logic_vector;
  function to_twist_values (bits : std_logic_vector) return twist_values_t;

end package geometry_msgs_msg_twist_cdr_8_pkg;

package body geometry_msgs_msg_twist_cdr_8_pkg is

  function to_slv (value : twist_value_t) return std_logic_vector is
    variable bits : std_logic_vector(TWIST_VALUE_BITS - 1 downto 0);
  begin
    bits(191 downto 0) := work.geometry_msgs_msg_vector3_cdr_8_pkg.to_slv(value.linear);
    bits(383 downto 192) := work.geometry_msgs_msg_vector3_cdr_8_pkg.to_slv(value.angular);
    return bits;
  end function;

  function to_twist_value (bits : std_logic_vector) return twist_value_t is
    alias all_bits : std_logic_vector(TWIST_VALUE_BITS - 1 downto 0) is bits;
    variable value : twist_value_t;
  begin
    value.linear := work.geometry_msgs_msg_vector3_cdr_8_pkg.to_vector3_value(all_bits(191 downto
        0));
    value.angular := work.geometry_msgs_msg_vector3_cdr_8_pkg.to_vector3_value(all_bits(383 downto
        192));
    return value;
  end function;

  function to_slv (values : twist_values_t) return std_logic_vector is
    alias all_values : twist_values_t(0 to values'length - 1) is values;
    variable bits : std_logic_vector(TWIST_VALUE_BITS * values'length - 1 downto 0);
  begin
    for k in all_values'range loop
      bits(TWIST_VALUE_BITS * (k + 1) - 1 downto TWIST_VALUE_BITS * k) := to_slv(all_values(k));
    end loop;
    return bits;
  end function;

  function to_twist_values (bits : std_logic_vector) return twist_values_t is
    alias all_bits : std_logic_vector(bits'length - 1 downto 0) is bits;
    variable values : twist_values_t(0 to bits'length / TWIST_VALUE_BITS - 1);
  begin
    for k in values'range loop
      values(k) := to_twist_value(all_bits(TWIST_VALUE_BITS * (k + 1) - 1 downto TWIST_VALUE_BITS *
          k));
    end loop;
    return values;
  end function;

end package body geometry_msgs_msg_twist_cdr_8_pkg;
