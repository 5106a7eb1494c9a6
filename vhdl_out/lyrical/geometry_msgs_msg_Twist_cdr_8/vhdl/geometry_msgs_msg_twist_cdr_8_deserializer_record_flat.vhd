-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_twist_cdr_8_deserializer_record_flat.record of the Amaranth design.
-- RecordReader: Join the leaves of a message that have a fixed size into one stream of records.
--
-- A record is offered when all of its leaves are valid; latency 0. `record.valid` depends
-- combinationally on the leaves' `valid`, and their `ready` on `record.ready`. Arrays of more than
-- one transfer are collected in registers. Such an array of the next message waits until the
-- record is taken.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_record is
  port (
    record_ready              : in  std_logic;
    record_valid              : out std_logic;
    message_linear_x_ready    : out std_logic;
    message_linear_x_payload  : in  unsigned(63 downto 0);
    message_linear_x_valid    : in  std_logic;
    message_linear_y_payload  : in  unsigned(63 downto 0);
    message_linear_y_valid    : in  std_logic;
    message_linear_z_payload  : in  unsigned(63 downto 0);
    message_linear_z_valid    : in  std_logic;
    message_angular_x_payload : in  unsigned(63 downto 0);
    message_angular_x_valid   : in  std_logic;
    message_angular_y_payload : in  unsigned(63 downto 0);
    message_angular_y_valid   : in  std_logic;
    message_angular_z_payload : in  unsigned(63 downto 0);
    message_angular_z_valid   : in  std_logic
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_record is
begin

  record_valid <= message_linear_x_valid and message_linear_y_valid and message_linear_z_valid and
      message_angular_x_valid and message_angular_y_valid and message_angular_z_valid;
  message_linear_x_ready <= record_valid and record_ready;

end architecture;

-- Module geometry_msgs_msg_twist_cdr_8_deserializer_record_flat of the Amaranth design.
-- RecordTop: An instance of a converter, with AXI4-Stream and one vector on its message side.
--
-- The latency is the converter's; see `RecordReader` and `RecordWriter` for the paths between
-- ``msg_valid`` and ``msg_ready``. Clock and reset are those of Top.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_record_flat is
  port (
    aclk                 : in  std_logic;
    aresetn              : in  std_logic;
    s_axis_tdata         : in  std_logic_vector(63 downto 0);
    s_axis_tkeep         : in  std_logic_vector(7 downto 0);
    s_axis_tlast         : in  std_logic;
    s_axis_tvalid        : in  std_logic;
    msg_ready            : in  std_logic;
    m_axis_status_tready : in  std_logic;
    s_axis_tready        : out std_logic;
    msg_data             : out std_logic_vector(383 downto 0);
    msg_valid            : out std_logic;
    m_axis_status_tdata  : out std_logic_vector(7 downto 0);
    m_axis_status_tvalid : out std_logic
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_record_flat is

  -- Combinational signals.
  signal message_linear_y_ready   : std_logic;
  signal rst                      : std_logic;
  signal record_payload_linear_x  : std_logic_vector(63 downto 0);
  signal message_linear_x_valid   : std_logic;
  signal record_payload_linear_y  : std_logic_vector(63 downto 0);
  signal message_linear_y_valid   : std_logic;
  signal record_payload_linear_z  : std_logic_vector(63 downto 0);
  signal message_linear_z_valid   : std_logic;
  signal record_payload_angular_x : std_logic_vector(63 downto 0);
  signal message_angular_x_valid  : std_logic;
  signal record_payload_angular_y : std_logic_vector(63 downto 0);
  signal message_angular_y_valid  : std_logic;
  signal record_payload_angular_z : std_logic_vector(63 downto 0);
  signal message_angular_z_valid  : std_logic;

  component geometry_msgs_msg_twist_cdr_8_deserializer_flat is
    port (
      aclk : in std_logic;
      aresetn : in std_logic;
      s_axis_tdata : in std_logic_vector(63 downto 0);
      s_axis_tkeep : in std_logic_vector(7 downto 0);
      s_axis_tlast : in std_logic;
      s_axis_tvalid : in std_logic;
      linear_x_ready : in std_logic;
      linear_y_ready : in std_logic;
      linear_z_ready : in std_logic;
      angular_x_ready : in std_logic;
      angular_y_ready : in std_logic;
      angular_z_ready : in std_logic;
      m_axis_status_tready : in std_logic;
      s_axis_tready : out std_logic;
      linear_x_data : out std_logic_vector(63 downto 0);
      linear_x_valid : out std_logic;
      linear_y_data : out std_logic_vector(63 downto 0);
      linear_y_valid : out std_logic;
      linear_z_data : out std_logic_vector(63 downto 0);
      linear_z_valid : out std_logic;
      angular_x_data : out std_logic_vector(63 downto 0);
      angular_x_valid : out std_logic;
      angular_y_data : out std_logic_vector(63 downto 0);
      angular_y_valid : out std_logic;
      angular_z_data : out std_logic_vector(63 downto 0);
      angular_z_valid : out std_logic;
      m_axis_status_tdata : out std_logic_vector(7 downto 0);
      m_axis_status_tvalid : out std_logic
    );
  end component;
begin

  record_sig : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_record
    port map (
      record_ready              => msg_ready,
      record_valid              => msg_valid,
      message_linear_x_ready    => message_linear_y_ready,
      message_linear_x_payload  => unsigned(record_payload_linear_x),
      message_linear_x_valid    => message_linear_x_valid,
      message_linear_y_payload  => unsigned(record_payload_linear_y),
      message_linear_y_valid    => message_linear_y_valid,
      message_linear_z_payload  => unsigned(record_payload_linear_z),
      message_linear_z_valid    => message_linear_z_valid,
      message_angular_x_payload => unsigned(record_payload_angular_x),
      message_angular_x_valid   => message_angular_x_valid,
      message_angular_y_payload => unsigned(record_payload_angular_y),
      message_angular_y_valid   => message_angular_y_valid,
      message_angular_z_payload => unsigned(record_payload_angular_z),
      message_angular_z_valid   => message_angular_z_valid
    );

  core : geometry_msgs_msg_twist_cdr_8_deserializer_flat
    port map (
      aclk                 => aclk,
      aresetn              => aresetn,
      s_axis_tdata         => s_axis_tdata,
      s_axis_tkeep         => s_axis_tkeep,
      s_axis_tlast         => s_axis_tlast,
      s_axis_tvalid        => s_axis_tvalid,
      linear_x_ready       => message_linear_y_ready,
      linear_y_ready       => message_linear_y_ready,
      linear_z_ready       => message_linear_y_ready,
      angular_x_ready      => message_linear_y_ready,
      angular_y_ready      => message_linear_y_ready,
      angular_z_ready      => message_linear_y_ready,
      m_axis_status_tready => m_axis_status_tready,
      s_axis_tready        => s_axis_tready,
      linear_x_data        => record_payload_linear_x,
      linear_x_valid       => message_linear_x_valid,
      linear_y_data        => record_payload_linear_y,
      linear_y_valid       => message_linear_y_valid,
      linear_z_data        => record_payload_linear_z,
      linear_z_valid       => message_linear_z_valid,
      angular_x_data       => record_payload_angular_x,
      angular_x_valid      => message_angular_x_valid,
      angular_y_data       => record_payload_angular_y,
      angular_y_valid      => message_angular_y_valid,
      angular_z_data       => record_payload_angular_z,
      angular_z_valid      => message_angular_z_valid,
      m_axis_status_tdata  => m_axis_status_tdata,
      m_axis_status_tvalid => m_axis_status_tvalid
    );

  rst <= not aresetn;

  msg_data <= std_logic_vector(unsigned'(unsigned(record_payload_angular_z) &
      unsigned(record_payload_angular_y) & unsigned(record_payload_angular_x) &
      unsigned(record_payload_linear_z) & unsigned(record_payload_linear_y) &
      unsigned(record_payload_linear_x)));

end architecture;
