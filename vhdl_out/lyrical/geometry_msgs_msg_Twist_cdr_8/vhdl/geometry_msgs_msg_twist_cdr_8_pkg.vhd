-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- geometry_msgs/msg/Twist as records: twist_t has data and valid of every field, twist_ready_t has
-- ready, the other way.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_types_pkg.all;

package geometry_msgs_msg_twist_cdr_8_pkg is

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

  type twist_t is record
    linear  : vector3_t;  -- geometry_msgs/msg/Vector3
    angular : vector3_t;  -- geometry_msgs/msg/Vector3
  end record;

  type twist_ready_t is record
    linear  : vector3_ready_t;
    angular : vector3_ready_t;
  end record;

  -- The message as values, without handshakes; the entities ..._record have it.

  type vector3_value_t is record
    x : std_logic_vector(63 downto 0);  -- float64
    y : std_logic_vector(63 downto 0);  -- float64
    z : std_logic_vector(63 downto 0);  -- float64
  end record;

  type twist_value_t is record
    linear  : vector3_value_t;  -- geometry_msgs/msg/Vector3
    angular : vector3_value_t;  -- geometry_msgs/msg/Vector3
  end record;

  -- Between records and vectors, the first member lowest.
  constant VECTOR3_VALUE_BITS : positive := 192;
  function to_slv (value : vector3_value_t) return std_logic_vector;
  function to_vector3_value (bits : std_logic_vector) return vector3_value_t;

  constant TWIST_VALUE_BITS : positive := 384;
  function to_slv (value : twist_value_t) return std_logic_vector;
  function to_twist_value (bits : std_logic_vector) return twist_value_t;

  component geometry_msgs_msg_twist_cdr_8_deserializer is
    port (
      aclk                 : in  std_logic;
      aresetn              : in  std_logic;
      s_axis_tdata         : in  std_logic_vector(63 downto 0);
      s_axis_tkeep         : in  std_logic_vector(7 downto 0);
      s_axis_tlast         : in  std_logic;
      s_axis_tvalid        : in  std_logic;
      s_axis_tready        : out std_logic;
      msg                  : out twist_t;
      rdy                  : in  twist_ready_t;
      m_axis_status_tdata  : out std_logic_vector(7 downto 0);
      m_axis_status_tvalid : out std_logic;
      m_axis_status_tready : in  std_logic
    );
  end component;

  component geometry_msgs_msg_twist_cdr_8_serializer is
    port (
      aclk                 : in  std_logic;
      aresetn              : in  std_logic;
      m_axis_tdata         : out std_logic_vector(63 downto 0);
      m_axis_tkeep         : out std_logic_vector(7 downto 0);
      m_axis_tlast         : out std_logic;
      m_axis_tuser         : out std_logic;
      m_axis_tvalid        : out std_logic;
      m_axis_tready        : in  std_logic;
      msg                  : in  twist_t;
      rdy                  : out twist_ready_t;
      m_axis_status_tdata  : out std_logic_vector(7 downto 0);
      m_axis_status_tvalid : out std_logic;
      m_axis_status_tready : in  std_logic
    );
  end component;

  component geometry_msgs_msg_twist_cdr_8_deserializer_record is
    port (
      aclk                 : in  std_logic;
      aresetn              : in  std_logic;
      s_axis_tdata         : in  std_logic_vector(63 downto 0);
      s_axis_tkeep         : in  std_logic_vector(7 downto 0);
      s_axis_tlast         : in  std_logic;
      s_axis_tvalid        : in  std_logic;
      s_axis_tready        : out std_logic;
      msg                  : out twist_value_t;
      msg_valid            : out std_logic;
      msg_ready            : in  std_logic;
      m_axis_status_tdata  : out std_logic_vector(7 downto 0);
      m_axis_status_tvalid : out std_logic;
      m_axis_status_tready : in  std_logic
    );
  end component;

  component geometry_msgs_msg_twist_cdr_8_serializer_record is
    port (
      aclk                 : in  std_logic;
      aresetn              : in  std_logic;
      m_axis_tdata         : out std_logic_vector(63 downto 0);
      m_axis_tkeep         : out std_logic_vector(7 downto 0);
      m_axis_tlast         : out std_logic;
      m_axis_tuser         : out std_logic;
      m_axis_tvalid        : out std_logic;
      m_axis_tready        : in  std_logic;
      msg                  : in  twist_value_t;
      msg_valid            : in  std_logic;
      msg_ready            : out std_logic;
      m_axis_status_tdata  : out std_logic_vector(7 downto 0);
      m_axis_status_tvalid : out std_logic;
      m_axis_status_tready : in  std_logic
    );
  end component;

end package geometry_msgs_msg_twist_cdr_8_pkg;

package body geometry_msgs_msg_twist_cdr_8_pkg is

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

  function to_slv (value : twist_value_t) return std_logic_vector is
    variable bits : std_logic_vector(TWIST_VALUE_BITS - 1 downto 0);
  begin
    bits(191 downto 0) := to_slv(value.linear);
    bits(383 downto 192) := to_slv(value.angular);
    return bits;
  end function;

  function to_twist_value (bits : std_logic_vector) return twist_value_t is
    alias all_bits : std_logic_vector(TWIST_VALUE_BITS - 1 downto 0) is bits;
    variable value : twist_value_t;
  begin
    value.linear := to_vector3_value(all_bits(191 downto 0));
    value.angular := to_vector3_value(all_bits(383 downto 192));
    return value;
  end function;

end package body geometry_msgs_msg_twist_cdr_8_pkg;
