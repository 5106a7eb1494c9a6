-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Components of the converters of geometry_msgs/msg/Twist.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_types_pkg.all;
use work.geometry_msgs_msg_twist_cdr_8_pkg.all;

package geometry_msgs_msg_twist_cdr_8_components_pkg is

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

end package geometry_msgs_msg_twist_cdr_8_components_pkg;
