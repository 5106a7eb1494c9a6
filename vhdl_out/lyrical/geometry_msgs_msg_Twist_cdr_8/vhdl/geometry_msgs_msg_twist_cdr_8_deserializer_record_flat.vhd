-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_twist_cdr_8_deserializer_record_flat of the Amaranth design.

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
  signal message_linear_x_valid    : std_logic;
  signal message_linear_y_valid    : std_logic;
  signal message_linear_z_valid    : std_logic;
  signal message_angular_x_valid   : std_logic;
  signal message_angular_y_valid   : std_logic;
  signal message_angular_z_valid   : std_logic;
  -- 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  signal status_payload            : unsigned(2 downto 0);
  signal message_linear_x_payload  : unsigned(63 downto 0);
  signal message_linear_y_payload  : unsigned(63 downto 0);
  signal message_linear_z_payload  : unsigned(63 downto 0);
  signal message_angular_x_payload : unsigned(63 downto 0);
  signal message_angular_y_payload : unsigned(63 downto 0);
  signal message_angular_z_payload : unsigned(63 downto 0);
  signal message_angular_x_ready   : std_logic;
  signal rst                       : std_logic;
  signal or_13                     : std_logic;
  signal or_26                     : std_logic;
  signal or_39                     : std_logic;
  signal packets_payload_64        : unsigned(3 downto 0);

  -- Signals that no logic reads, for simulation.
  signal packets_valid              : std_logic;
  signal packets_ready              : std_logic;
  signal status_valid               : std_logic;
  signal status_ready               : std_logic;
  signal message_angular_y_ready    : std_logic;
  signal message_angular_y_ready_29 : std_logic;
  signal message_angular_z_ready    : std_logic;
  signal message_angular_z_ready_35 : std_logic;
  signal message_linear_x_ready     : std_logic;
  signal message_linear_x_ready_41  : std_logic;
  signal message_linear_y_ready     : std_logic;
  signal message_linear_y_ready_47  : std_logic;
  signal message_linear_z_ready     : std_logic;
  signal message_linear_z_ready_53  : std_logic;
  signal record_payload             : unsigned(383 downto 0);
  signal record_valid               : std_logic;
  signal record_ready               : std_logic;
  signal packets_payload            : unsigned(68 downto 0);
begin

  core : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core
    port map (
      aclk                          => aclk,
      packets_valid                 => s_axis_tvalid,
      status_ready                  => m_axis_status_tready,
      rst                           => rst,
      message_linear_x_ready        => message_angular_x_ready,
      packets_payload(63 downto 0)  => unsigned(s_axis_tdata),
      packets_payload(67 downto 64) => packets_payload_64,
      packets_payload(68)           => s_axis_tlast,
      packets_ready                 => s_axis_tready,
      message_linear_x_valid        => message_linear_x_valid,
      message_linear_y_valid        => message_linear_y_valid,
      message_linear_z_valid        => message_linear_z_valid,
      message_angular_x_valid       => message_angular_x_valid,
      message_angular_y_valid       => message_angular_y_valid,
      message_angular_z_valid       => message_angular_z_valid,
      status_valid                  => m_axis_status_tvalid,
      status_payload                => status_payload,
      message_linear_x_payload      => message_linear_x_payload,
      message_linear_y_payload      => message_linear_y_payload,
      message_linear_z_payload      => message_linear_z_payload,
      message_angular_x_payload     => message_angular_x_payload,
      message_angular_y_payload     => message_angular_y_payload,
      message_angular_z_payload     => message_angular_z_payload
    );

  record_sig : entity work.geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_record
    port map (
      record_ready              => msg_ready,
      record_valid              => msg_valid,
      message_linear_x_ready    => message_angular_x_ready,
      message_linear_x_valid    => message_linear_x_valid,
      message_linear_y_valid    => message_linear_y_valid,
      message_linear_z_valid    => message_linear_z_valid,
      message_angular_x_valid   => message_angular_x_valid,
      message_angular_y_valid   => message_angular_y_valid,
      message_angular_z_valid   => message_angular_z_valid,
      message_linear_x_payload  => message_linear_x_payload,
      message_linear_y_payload  => message_linear_y_payload,
      message_linear_z_payload  => message_linear_z_payload,
      message_angular_x_payload => message_angular_x_payload,
      message_angular_y_payload => message_angular_y_payload,
      message_angular_z_payload => message_angular_z_payload
    );

  rst <= not aresetn;
  or_13 <= or unsigned'(((and unsigned(s_axis_tkeep(6 downto 0))) and not s_axis_tkeep(7)) &
      ((and unsigned(s_axis_tkeep(4 downto 0))) and not s_axis_tkeep(5)) &
      ((and unsigned(s_axis_tkeep(2 downto 0))) and not s_axis_tkeep(3)) & (s_axis_tkeep(0) and
      not s_axis_tkeep(1)));
  or_26 <= or unsigned'(((and unsigned(s_axis_tkeep(6 downto 0))) and not s_axis_tkeep(7)) &
      ((and unsigned(s_axis_tkeep(5 downto 0))) and not s_axis_tkeep(6)) &
      ((and unsigned(s_axis_tkeep(2 downto 0))) and not s_axis_tkeep(3)) &
      ((and unsigned(s_axis_tkeep(1 downto 0))) and not s_axis_tkeep(2)));
  or_39 <= or unsigned'(((and unsigned(s_axis_tkeep(6 downto 0))) and not s_axis_tkeep(7)) &
      ((and unsigned(s_axis_tkeep(5 downto 0))) and not s_axis_tkeep(6)) &
      ((and unsigned(s_axis_tkeep(4 downto 0))) and not s_axis_tkeep(5)) &
      ((and unsigned(s_axis_tkeep(3 downto 0))) and not s_axis_tkeep(4)));
  packets_payload_64 <= (and unsigned(s_axis_tkeep)) & or_39 & or_26 &
      or_13 when s_axis_tlast = '1' else "1000";

  msg_data <= std_logic_vector(unsigned'(message_angular_z_payload & message_angular_y_payload &
      message_angular_x_payload & message_linear_z_payload & message_linear_y_payload &
      message_linear_x_payload));
  m_axis_status_tdata <= std_logic_vector(resize(status_payload, 8));

  packets_valid <= s_axis_tvalid;
  packets_ready <= s_axis_tready;
  status_valid <= m_axis_status_tvalid;
  status_ready <= m_axis_status_tready;
  message_angular_y_ready <= message_angular_x_ready;
  message_angular_y_ready_29 <= message_angular_x_ready;
  message_angular_z_ready <= message_angular_x_ready;
  message_angular_z_ready_35 <= message_angular_x_ready;
  message_linear_x_ready <= message_angular_x_ready;
  message_linear_x_ready_41 <= message_angular_x_ready;
  message_linear_y_ready <= message_angular_x_ready;
  message_linear_y_ready_47 <= message_angular_x_ready;
  message_linear_z_ready <= message_angular_x_ready;
  message_linear_z_ready_53 <= message_angular_x_ready;
  record_payload <= message_angular_z_payload & message_angular_y_payload &
      message_angular_x_payload & message_linear_z_payload & message_linear_y_payload &
      message_linear_x_payload;
  record_valid <= msg_valid;
  record_ready <= msg_ready;
  packets_payload <= s_axis_tlast & packets_payload_64 & unsigned(s_axis_tdata);

end architecture;
