-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_twist_cdr_8_serializer_record_flat.record of the Amaranth design.
-- RecordWriter: Split a stream of records into leaves of a message: the inverse of
-- :class:`RecordReader`.
--
-- All leaves are offered at the same time. The record is taken in the cycle in which the last of
-- them is taken. Latency 0; `record.ready` depends combinationally on the leaves' `ready`.
-- 6 registers at rising_edge(aclk), synchronous reset rst = '1'.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_serializer_record_flat_record is
  port (
    rst                       : in  std_logic;
    aclk                      : in  std_logic;
    record_payload            : in  unsigned(383 downto 0);  -- bits: linear(191:0) angular(383:192)
    record_valid              : in  std_logic;
    message_linear_x_valid    : out std_logic;
    message_linear_y_valid    : out std_logic;
    message_linear_z_valid    : out std_logic;
    message_angular_x_valid   : out std_logic;
    message_angular_y_valid   : out std_logic;
    message_angular_z_valid   : out std_logic;
    taken                     : out std_logic;
    message_linear_x_ready    : in  std_logic;
    message_linear_y_ready    : in  std_logic;
    message_linear_z_ready    : in  std_logic;
    message_angular_x_ready   : in  std_logic;
    message_angular_y_ready   : in  std_logic;
    message_angular_z_ready   : in  std_logic;
    message_linear_x_payload  : out unsigned(63 downto 0);
    message_linear_y_payload  : out unsigned(63 downto 0);
    message_linear_z_payload  : out unsigned(63 downto 0);
    message_angular_x_payload : out unsigned(63 downto 0);
    message_angular_y_payload : out unsigned(63 downto 0);
    message_angular_z_payload : out unsigned(63 downto 0)
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_serializer_record_flat_record is

  -- Registers.
  signal index    : std_logic := '0';
  signal index_6  : std_logic := '0';
  signal index_9  : std_logic := '0';
  signal index_12 : std_logic := '0';
  signal index_15 : std_logic := '0';
  signal index_18 : std_logic := '0';

  -- Combinational signals.
  signal taken_part               : std_logic;
  signal record_payload_linear_x  : unsigned(63 downto 0);
  signal record_payload_linear_y  : unsigned(63 downto 0);
  signal record_payload_linear_z  : unsigned(63 downto 0);
  signal record_payload_angular_x : unsigned(63 downto 0);
  signal record_payload_angular_y : unsigned(63 downto 0);
  signal record_payload_angular_z : unsigned(63 downto 0);
begin

  message_linear_x_valid <= record_valid and not index;
  message_linear_y_valid <= record_valid and not index_6;
  message_linear_z_valid <= record_valid and not index_9;
  message_angular_x_valid <= record_valid and not index_12;
  message_angular_y_valid <= record_valid and not index_15;
  message_angular_z_valid <= record_valid and not index_18;
  taken_part <= (index or (to_std_logic(resize(index, 1) = 0) and message_linear_x_valid and
      message_linear_x_ready)) and (index_6 or (to_std_logic(resize(index_6, 1) = 0) and
      message_linear_y_valid and message_linear_y_ready)) and (index_9 or
      (to_std_logic(resize(index_9, 1) = 0) and message_linear_z_valid and
      message_linear_z_ready)) and (index_12 or (to_std_logic(resize(index_12, 1) = 0) and
      message_angular_x_valid and message_angular_x_ready)) and (index_15 or
      (to_std_logic(resize(index_15, 1) = 0) and message_angular_y_valid and
      message_angular_y_ready)) and (index_18 or (to_std_logic(resize(index_18, 1) = 0) and
      message_angular_z_valid and message_angular_z_ready));
  taken <= record_valid and taken_part;

  message_linear_x_payload <= record_payload_linear_x when index = '0' else
                              (others => '0');

  message_linear_y_payload <= record_payload_linear_y when index_6 = '0' else
                              (others => '0');

  message_linear_z_payload <= record_payload_linear_z when index_9 = '0' else
                              (others => '0');

  message_angular_x_payload <= record_payload_angular_x when index_12 = '0' else
                               (others => '0');

  message_angular_y_payload <= record_payload_angular_y when index_15 = '0' else
                               (others => '0');

  message_angular_z_payload <= record_payload_angular_z when index_18 = '0' else
                               (others => '0');

  p_aclk : process (aclk)
  begin
    if rising_edge(aclk) then
      if rst = '1' then
        index <= '0';
        index_6 <= '0';
        index_9 <= '0';
        index_12 <= '0';
        index_15 <= '0';
        index_18 <= '0';
      else
        if taken = '1' then
          index <= '0';
        elsif message_linear_x_valid = '1' and message_linear_x_ready = '1' then
          index <= index xor '1';
        end if;
        if taken = '1' then
          index_6 <= '0';
        elsif message_linear_y_valid = '1' and message_linear_y_ready = '1' then
          index_6 <= index_6 xor '1';
        end if;
        if taken = '1' then
          index_9 <= '0';
        elsif message_linear_z_valid = '1' and message_linear_z_ready = '1' then
          index_9 <= index_9 xor '1';
        end if;
        if taken = '1' then
          index_12 <= '0';
        elsif message_angular_x_valid = '1' and message_angular_x_ready = '1' then
          index_12 <= index_12 xor '1';
        end if;
        if taken = '1' then
          index_15 <= '0';
        elsif message_angular_y_valid = '1' and message_angular_y_ready = '1' then
          index_15 <= index_15 xor '1';
        end if;
        if taken = '1' then
          index_18 <= '0';
        elsif message_angular_z_valid = '1' and message_angular_z_ready = '1' then
          index_18 <= index_18 xor '1';
        end if;
      end if;
    end if;
  end process;

  record_payload_linear_x <= record_payload(63 downto 0);
  record_payload_linear_y <= record_payload(127 downto 64);
  record_payload_linear_z <= record_payload(191 downto 128);
  record_payload_angular_x <= record_payload(255 downto 192);
  record_payload_angular_y <= record_payload(319 downto 256);
  record_payload_angular_z <= record_payload(383 downto 320);

end architecture;

-- Module geometry_msgs_msg_twist_cdr_8_serializer_record_flat of the Amaranth design.
-- RecordTop: An instance of a converter, with AXI4-Stream and one vector on its message side.
--
-- The latency is the converter's; see `RecordReader` and `RecordWriter` for the paths between
-- ``msg_valid`` and ``msg_ready``. Clock and reset are those of Top.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_serializer_record_flat is
  port (
    aclk                 : in  std_logic;
    aresetn              : in  std_logic;
    m_axis_tready        : in  std_logic;
    msg_data             : in  std_logic_vector(383 downto 0);
    msg_valid            : in  std_logic;
    m_axis_status_tready : in  std_logic;
    m_axis_tdata         : out std_logic_vector(63 downto 0);
    m_axis_tkeep         : out std_logic_vector(7 downto 0);
    m_axis_tlast         : out std_logic;
    m_axis_tuser         : out std_logic;
    m_axis_tvalid        : out std_logic;
    msg_ready            : out std_logic;
    m_axis_status_tdata  : out std_logic_vector(7 downto 0);
    m_axis_status_tvalid : out std_logic
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_serializer_record_flat is

  -- Combinational signals.
  signal message_linear_x_valid    : std_logic;
  signal message_linear_y_valid    : std_logic;
  signal message_linear_z_valid    : std_logic;
  signal message_angular_x_valid   : std_logic;
  signal message_angular_y_valid   : std_logic;
  signal message_angular_z_valid   : std_logic;
  signal message_linear_x_payload  : unsigned(63 downto 0);
  signal message_linear_y_payload  : unsigned(63 downto 0);
  signal message_linear_z_payload  : unsigned(63 downto 0);
  signal message_angular_x_payload : unsigned(63 downto 0);
  signal message_angular_y_payload : unsigned(63 downto 0);
  signal message_angular_z_payload : unsigned(63 downto 0);
  signal rst                       : std_logic;
  signal message_linear_x_ready    : std_logic;
  signal message_linear_y_ready    : std_logic;
  signal message_linear_z_ready    : std_logic;
  signal message_angular_x_ready   : std_logic;
  signal message_angular_y_ready   : std_logic;
  signal message_angular_z_ready   : std_logic;

  component geometry_msgs_msg_twist_cdr_8_serializer_flat is
    port (
      aclk : in std_logic;
      aresetn : in std_logic;
      m_axis_tready : in std_logic;
      linear_x_data : in std_logic_vector(63 downto 0);
      linear_x_valid : in std_logic;
      linear_y_data : in std_logic_vector(63 downto 0);
      linear_y_valid : in std_logic;
      linear_z_data : in std_logic_vector(63 downto 0);
      linear_z_valid : in std_logic;
      angular_x_data : in std_logic_vector(63 downto 0);
      angular_x_valid : in std_logic;
      angular_y_data : in std_logic_vector(63 downto 0);
      angular_y_valid : in std_logic;
      angular_z_data : in std_logic_vector(63 downto 0);
      angular_z_valid : in std_logic;
      m_axis_status_tready : in std_logic;
      m_axis_tdata : out std_logic_vector(63 downto 0);
      m_axis_tkeep : out std_logic_vector(7 downto 0);
      m_axis_tlast : out std_logic;
      m_axis_tuser : out std_logic;
      m_axis_tvalid : out std_logic;
      linear_x_ready : out std_logic;
      linear_y_ready : out std_logic;
      linear_z_ready : out std_logic;
      angular_x_ready : out std_logic;
      angular_y_ready : out std_logic;
      angular_z_ready : out std_logic;
      m_axis_status_tdata : out std_logic_vector(7 downto 0);
      m_axis_status_tvalid : out std_logic
    );
  end component;
begin

  record_sig : entity work.geometry_msgs_msg_twist_cdr_8_serializer_record_flat_record
    port map (
      aclk                      => aclk,
      record_payload            => unsigned(msg_data),
      record_valid              => msg_valid,
      rst                       => rst,
      message_linear_x_valid    => message_linear_x_valid,
      message_linear_y_valid    => message_linear_y_valid,
      message_linear_z_valid    => message_linear_z_valid,
      message_angular_x_valid   => message_angular_x_valid,
      message_angular_y_valid   => message_angular_y_valid,
      message_angular_z_valid   => message_angular_z_valid,
      taken                     => msg_ready,
      message_linear_x_ready    => message_linear_x_ready,
      message_linear_y_ready    => message_linear_y_ready,
      message_linear_z_ready    => message_linear_z_ready,
      message_angular_x_ready   => message_angular_x_ready,
      message_angular_y_ready   => message_angular_y_ready,
      message_angular_z_ready   => message_angular_z_ready,
      message_linear_x_payload  => message_linear_x_payload,
      message_linear_y_payload  => message_linear_y_payload,
      message_linear_z_payload  => message_linear_z_payload,
      message_angular_x_payload => message_angular_x_payload,
      message_angular_y_payload => message_angular_y_payload,
      message_angular_z_payload => message_angular_z_payload
    );

  core : geometry_msgs_msg_twist_cdr_8_serializer_flat
    port map (
      aclk                 => aclk,
      aresetn              => aresetn,
      m_axis_tready        => m_axis_tready,
      linear_x_data        => std_logic_vector(message_linear_x_payload),
      linear_x_valid       => message_linear_x_valid,
      linear_y_data        => std_logic_vector(message_linear_y_payload),
      linear_y_valid       => message_linear_y_valid,
      linear_z_data        => std_logic_vector(message_linear_z_payload),
      linear_z_valid       => message_linear_z_valid,
      angular_x_data       => std_logic_vector(message_angular_x_payload),
      angular_x_valid      => message_angular_x_valid,
      angular_y_data       => std_logic_vector(message_angular_y_payload),
      angular_y_valid      => message_angular_y_valid,
      angular_z_data       => std_logic_vector(message_angular_z_payload),
      angular_z_valid      => message_angular_z_valid,
      m_axis_status_tready => m_axis_status_tready,
      m_axis_tdata         => m_axis_tdata,
      m_axis_tkeep         => m_axis_tkeep,
      m_axis_tlast         => m_axis_tlast,
      m_axis_tuser         => m_axis_tuser,
      m_axis_tvalid        => m_axis_tvalid,
      linear_x_ready       => message_linear_x_ready,
      linear_y_ready       => message_linear_y_ready,
      linear_z_ready       => message_linear_z_ready,
      angular_x_ready      => message_angular_x_ready,
      angular_y_ready      => message_angular_y_ready,
      angular_z_ready      => message_angular_z_ready,
      m_axis_status_tdata  => m_axis_status_tdata,
      m_axis_status_tvalid => m_axis_status_tvalid
    );

  rst <= not aresetn;

end architecture;
