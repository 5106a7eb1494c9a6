-- Records of geometry_msgs/msg/Vector3: vector3_t has data and valid of every field,
-- vector3_ready_t has ready, in the opposite direction. VECTOR3_ALL_READY takes every transfer;
-- VECTOR3_IDLE offers none.
-- Made by firm-hdl. All converters with wire cdr and a bus of 8 bytes share this file: compile it
-- once.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_types_pkg.all;
use work.firm_hdl_bus_8_pkg.all;

package geometry_msgs_msg_vector3_cdr_8_pkg is

  type vector3_t is record
    x : float64_stream_t;  -- float64
    y : float64_stream_t;  -- float64
    z : float64_stream_t;  -- float64
  end record;

  type vector3_ready_t is record
    x : std_logic;
    y : std_logic;
    z : std_logic;
  end record;

  constant VECTOR3_IDLE : vector3_t := (
    x => FLOAT64_STREAM_IDLE,
    y => FLOAT64_STREAM_IDLE,
    z => FLOAT64_STREAM_IDLE);

  constant VECTOR3_ALL_READY : vector3_ready_t := (
    x => '1',
    y => '1',
    z => '1');

  -- Sequences and arrays: all elements use the same streams, one after the other.

  type vector3_sequence_t is record
    length : uint32_stream_t;  -- number of elements
    item   : vector3_t;
  end record;

  type vector3_sequence_ready_t is record
    length : std_logic;
    item   : vector3_ready_t;
  end record;

  constant VECTOR3_SEQUENCE_IDLE : vector3_sequence_t := (
    length => UINT32_STREAM_IDLE,
    item   => VECTOR3_IDLE);

  constant VECTOR3_SEQUENCE_ALL_READY : vector3_sequence_ready_t := (
    length => '1',
    item   => VECTOR3_ALL_READY);

  type vector3_array_t is record
    item : vector3_t;
  end record;

  type vector3_array_ready_t is record
    item : vector3_ready_t;
  end record;

  constant VECTOR3_ARRAY_IDLE : vector3_array_t := (
    item => VECTOR3_IDLE);

  constant VECTOR3_ARRAY_ALL_READY : vector3_array_ready_t := (
    item => VECTOR3_ALL_READY);

  -- The message as plain values, for the ports of the entities ..._record.

  type vector3_value_t is record
    x : std_logic_vector(63 downto 0);  -- float64
    y : std_logic_vector(63 downto 0);  -- float64
    z : std_logic_vector(63 downto 0);  -- float64
  end record;

  type vector3_values_t is array (natural range <>) of vector3_value_t;

  -- Conversion between records and vectors, first member in the lowest bits.
  constant VECTOR3_VALUE_BITS : positive := 192;
  function to_slv (value : vector3_value_t) return std_logic_vector;
  function to_vector3_value (bits : std_logic_vector) return vector3_value_t;
  function to_slv (values : vector3_values_t) return std_logic_vector;
  function to_vector3_values (bits : std_logic_vector) return vector3_values_t;

end package geometry_msgs_msg_vector3_cdr_8_pkg;

package body geometry_msgs_msg_vector3_cdr_8_pkg is

  function to_slv (value : vector3_value_t) return std_logic_vector is
    variable bits : std_logic_vector(VECTOR3_VALUE_BITS - 1 downto 0);
  begin
    bits(63 downto 0) := value.x;
    bits(127 downto 64) := value.y;
    bits(191 downto 128) := value.z;
    return bits;
  end function;

  function to_vector3_value (bits : std_logic_vector) return vector3_value_t is
    alias all_bits : std_logic_vector(VECTOR3_VALUE_BITS - 1 downto 0) is bits;
    variable value : vector3_value_t;
  begin
    value.x := all_bits(63 downto 0);
    value.y := all_bits(127 downto 64);
    value.z := all_bits(191 downto 128);
    return value;
  end function;

  function to_slv (values : vector3_values_t) return std_logic_vector is
    alias all_values : vector3_values_t(0 to values'length - 1) is values;
    variable bits : std_logic_vector(VECTOR3_VALUE_BITS * values'length - 1 downto 0);
  begin
    for k in all_values'range loop
      bits(VECTOR3_VALUE_BITS * (k + 1) - 1 downto VECTOR3_VALUE_BITS * k) := to_slv(all_values(k));
    end loop;
    return bits;
  end function;

  function to_vector3_values (bits : std_logic_vector) return vector3_values_t is
    alias all_bits : std_logic_vector(bits'length - 1 downto 0) is bits;
    variable values : vector3_values_t(0 to bits'length / VECTOR3_VALUE_BITS - 1);
  begin
    for k in values'range loop
      values(k) := to_vector3_value(all_bits(VECTOR3_VALUE_BITS * (k + 1) - 1 downto
          VECTOR3_VALUE_BITS * k));
    end loop;
    return values;
  end function;

end package body geometry_msgs_msg_vector3_cdr_8_pkg;
