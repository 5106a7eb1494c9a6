-- Takes pairs of a LaserScan and a PointCloud2, and gives the cloud the header of the scan.
--
-- A header has a string, and a cloud has any size: neither can wait in registers until the status of
-- its packet is known. So the new packet waits in a buffer, and leaves only if the statuses of the
-- scan, the cloud and the new message are all OK. Otherwise it is dropped.

library ieee;
use ieee.std_logic_1164.all;

use work.firm_hdl_types_pkg.all;
use work.sensor_msgs_msg_laserscan_cdr_4_pkg.all;
use work.sensor_msgs_msg_pointcloud2_cdr_4_pkg.all;

entity restamp is
  port (
    aclk         : in  std_logic;
    aresetn      : in  std_logic;
    scan_tdata   : in  std_logic_vector(31 downto 0);
    scan_tkeep   : in  std_logic_vector(3 downto 0);
    scan_tlast   : in  std_logic;
    scan_tvalid  : in  std_logic;
    scan_tready  : out std_logic;
    cloud_tdata  : in  std_logic_vector(31 downto 0);
    cloud_tkeep  : in  std_logic_vector(3 downto 0);
    cloud_tlast  : in  std_logic;
    cloud_tvalid : in  std_logic;
    cloud_tready : out std_logic;
    m_axis_tdata  : out std_logic_vector(31 downto 0);
    m_axis_tkeep  : out std_logic_vector(3 downto 0);
    m_axis_tlast  : out std_logic;
    m_axis_tvalid : out std_logic;
    m_axis_tready : in  std_logic
  );
end entity;

architecture rtl of restamp is

  signal scan      : laser_scan_t;
  signal scan_rdy  : laser_scan_ready_t;
  signal cloud     : point_cloud2_t;
  signal cloud_rdy : point_cloud2_ready_t;
  signal made      : point_cloud2_t;
  signal made_rdy  : point_cloud2_ready_t;

  subtype status_t is std_logic_vector(7 downto 0);
  signal scan_status, cloud_status, made_status : status_t;
  signal scan_ended, cloud_ended, made_ended    : std_logic;

  -- The new packet on its way to the buffer, and the verdict on it.
  signal tdata                : std_logic_vector(31 downto 0);
  signal tkeep                : std_logic_vector(3 downto 0);
  signal tlast, tvalid, tready : std_logic;
  signal good, all_ended, judge, judged : std_logic;

begin

  scan_rx : entity work.sensor_msgs_msg_laserscan_cdr_4_deserializer
    port map (
      aclk => aclk, aresetn => aresetn, s_axis_tdata => scan_tdata, s_axis_tkeep => scan_tkeep,
      s_axis_tlast => scan_tlast, s_axis_tvalid => scan_tvalid, s_axis_tready => scan_tready,
      msg => scan, rdy => scan_rdy, m_axis_status_tdata => scan_status,
      m_axis_status_tvalid => scan_ended, m_axis_status_tready => judged
    );

  cloud_rx : entity work.sensor_msgs_msg_pointcloud2_cdr_4_deserializer
    port map (
      aclk => aclk, aresetn => aresetn, s_axis_tdata => cloud_tdata, s_axis_tkeep => cloud_tkeep,
      s_axis_tlast => cloud_tlast, s_axis_tvalid => cloud_tvalid, s_axis_tready => cloud_tready,
      msg => cloud, rdy => cloud_rdy, m_axis_status_tdata => cloud_status,
      m_axis_status_tvalid => cloud_ended, m_axis_status_tready => judged
    );

  -- The scan's header and the cloud's other fields go into the new message. The other fields of the
  -- scan and the header of the cloud are taken and dropped.
  process (all)
  begin
    made <= cloud;
    made.header <= scan.header;
    cloud_rdy <= made_rdy;
    cloud_rdy.header <= POINT_CLOUD2_ALL_READY.header;
    scan_rdy <= LASER_SCAN_ALL_READY;
    scan_rdy.header <= made_rdy.header;
  end process;

  tx : entity work.sensor_msgs_msg_pointcloud2_cdr_4_serializer
    port map (
      aclk => aclk, aresetn => aresetn, m_axis_tdata => tdata, m_axis_tkeep => tkeep,
      m_axis_tlast => tlast, m_axis_tuser => open, m_axis_tvalid => tvalid,
      m_axis_tready => tready, msg => made, rdy => made_rdy, m_axis_status_tdata => made_status,
      m_axis_status_tvalid => made_ended, m_axis_status_tready => judged
    );

  -- Each message has one status. All three are taken together, when the buffer has the whole packet.
  all_ended <= scan_ended and cloud_ended and made_ended;
  judged <= all_ended and judge;
  good <= '1' when scan_status = STATUS_OK and cloud_status = STATUS_OK and
    made_status = STATUS_OK else '0';

  held : entity work.packet_buffer
    generic map (bus_bytes => 4, address_bits => 8)
    port map (
      aclk => aclk, aresetn => aresetn, s_axis_tdata => tdata, s_axis_tkeep => tkeep,
      s_axis_tlast => tlast, s_axis_tvalid => tvalid, s_axis_tready => tready,
      verdict_good => good, verdict_valid => all_ended, verdict_ready => judge,
      m_axis_tdata => m_axis_tdata, m_axis_tkeep => m_axis_tkeep, m_axis_tlast => m_axis_tlast,
      m_axis_tvalid => m_axis_tvalid, m_axis_tready => m_axis_tready
    );

end architecture;
