-- A robot with two wheels, 0.5 m apart: Twist comes in, the speeds of both wheels go out.
-- Ports are those that `firm-hdl node info wheels.yaml --members` lists.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use work.float_fixed_pkg.all;

entity wheels is
  port (
    aclk    : in std_logic;
    aresetn : in std_logic;

    subscribe_cmd_vel_linear_x_data   : in  std_logic_vector(63 downto 0);
    subscribe_cmd_vel_linear_x_valid  : in  std_logic;
    subscribe_cmd_vel_linear_x_ready  : out std_logic;
    subscribe_cmd_vel_linear_y_data   : in  std_logic_vector(63 downto 0);
    subscribe_cmd_vel_linear_y_valid  : in  std_logic;
    subscribe_cmd_vel_linear_y_ready  : out std_logic;
    subscribe_cmd_vel_linear_z_data   : in  std_logic_vector(63 downto 0);
    subscribe_cmd_vel_linear_z_valid  : in  std_logic;
    subscribe_cmd_vel_linear_z_ready  : out std_logic;
    subscribe_cmd_vel_angular_x_data  : in  std_logic_vector(63 downto 0);
    subscribe_cmd_vel_angular_x_valid : in  std_logic;
    subscribe_cmd_vel_angular_x_ready : out std_logic;
    subscribe_cmd_vel_angular_y_data  : in  std_logic_vector(63 downto 0);
    subscribe_cmd_vel_angular_y_valid : in  std_logic;
    subscribe_cmd_vel_angular_y_ready : out std_logic;
    subscribe_cmd_vel_angular_z_data  : in  std_logic_vector(63 downto 0);
    subscribe_cmd_vel_angular_z_valid : in  std_logic;
    subscribe_cmd_vel_angular_z_ready : out std_logic;

    publish_wheel_left_data_data   : out std_logic_vector(63 downto 0);
    publish_wheel_left_data_valid  : out std_logic;
    publish_wheel_left_data_ready  : in  std_logic;
    publish_wheel_right_data_data  : out std_logic_vector(63 downto 0);
    publish_wheel_right_data_valid : out std_logic;
    publish_wheel_right_data_ready : in  std_logic
  );
end entity;

architecture rtl of wheels is
  signal left_valid, right_valid : std_logic := '0';
  signal left, right             : signed(BITS downto 0);
  signal take                    : std_logic;
begin

  -- Fields that are not used have to be taken, too.
  subscribe_cmd_vel_linear_y_ready  <= '1';
  subscribe_cmd_vel_linear_z_ready  <= '1';
  subscribe_cmd_vel_angular_x_ready <= '1';
  subscribe_cmd_vel_angular_y_ready <= '1';

  -- Both numbers of a command are taken together, when the speeds of the last one are gone.
  take <= subscribe_cmd_vel_linear_x_valid and subscribe_cmd_vel_angular_z_valid
          and (not left_valid or publish_wheel_left_data_ready)
          and (not right_valid or publish_wheel_right_data_ready);
  subscribe_cmd_vel_linear_x_ready  <= take;
  subscribe_cmd_vel_angular_z_ready <= take;

  process (aclk)
    variable forward, turn : signed(BITS downto 0);
  begin
    if rising_edge(aclk) then
      if publish_wheel_left_data_ready = '1' then
        left_valid <= '0';
      end if;
      if publish_wheel_right_data_ready = '1' then
        right_valid <= '0';
      end if;
      if take = '1' then
        forward := resize(to_fixed(subscribe_cmd_vel_linear_x_data), BITS + 1);
        turn    := resize(to_fixed(subscribe_cmd_vel_angular_z_data), BITS + 1);
        left        <= forward - shift_right(turn, 2);
        right       <= forward + shift_right(turn, 2);
        left_valid  <= '1';
        right_valid <= '1';
      end if;
      if aresetn = '0' then
        left_valid  <= '0';
        right_valid <= '0';
      end if;
    end if;
  end process;

  publish_wheel_left_data_data   <= to_float(left);
  publish_wheel_left_data_valid  <= left_valid;
  publish_wheel_right_data_data  <= to_float(right);
  publish_wheel_right_data_valid <= right_valid;

end architecture;
