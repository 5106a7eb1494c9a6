-- Sends commands to the wheels, and compares the speeds. Both sides stall.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use std.env.finish;

entity wheels_tb is
end entity;

architecture sim of wheels_tb is
  subtype float64 is std_logic_vector(63 downto 0);
  type row is record
    forward, turn, left, right : float64;
  end record;
  type rows is array (natural range <>) of row;

  constant HALF : float64 := x"3fe0000000000000";
  constant ONE  : float64 := x"3ff0000000000000";
  constant INF  : float64 := x"7ff0000000000000";
  constant NAN  : float64 := x"7ff8000000000001";
  constant ZERO : float64 := x"0000000000000000";

  constant CASES : rows := (
    (ONE, ZERO, ONE, ONE),
    (HALF, x"bff0000000000000", x"3fe8000000000000", x"3fd0000000000000"),  -- 0.75, 0.25
    (ZERO, x"3ef0000000000000", ZERO, ZERO),                                -- 2**-16
    (x"bff8000000000000", x"4010000000000000", x"c004000000000000", x"bfe0000000000000"),
    (INF, ZERO, x"40dfffffffc00000", x"40dfffffffc00000"),                  -- 32,768 - 2**-16
    (x"fff0000000000000", NAN, x"c0e0000000000000", x"c0e0000000000000")    -- -32,768
  );

  signal aclk, aresetn : std_logic := '0';
  signal x, z : float64 := ZERO;
  signal x_valid, z_valid, x_ready, z_ready : std_logic := '0';
  signal left, right : float64;
  signal left_valid, left_ready, right_valid, right_ready : std_logic := '0';
  signal cycle, lefts, rights : natural := 0;
begin

  aclk    <= not aclk after 5 ns;
  aresetn <= '1' after 22 ns;

  dut : entity work.wheels
    port map (
      aclk => aclk, aresetn => aresetn,
      subscribe_cmd_vel_linear_x_data => x, subscribe_cmd_vel_linear_x_valid => x_valid,
      subscribe_cmd_vel_linear_x_ready => x_ready,
      subscribe_cmd_vel_linear_y_data => ONE, subscribe_cmd_vel_linear_y_valid => '1',
      subscribe_cmd_vel_linear_y_ready => open,
      subscribe_cmd_vel_linear_z_data => ONE, subscribe_cmd_vel_linear_z_valid => '1',
      subscribe_cmd_vel_linear_z_ready => open,
      subscribe_cmd_vel_angular_x_data => ONE, subscribe_cmd_vel_angular_x_valid => '1',
      subscribe_cmd_vel_angular_x_ready => open,
      subscribe_cmd_vel_angular_y_data => ONE, subscribe_cmd_vel_angular_y_valid => '1',
      subscribe_cmd_vel_angular_y_ready => open,
      subscribe_cmd_vel_angular_z_data => z, subscribe_cmd_vel_angular_z_valid => z_valid,
      subscribe_cmd_vel_angular_z_ready => z_ready,
      publish_wheel_left_data_data => left, publish_wheel_left_data_valid => left_valid,
      publish_wheel_left_data_ready => left_ready,
      publish_wheel_right_data_data => right, publish_wheel_right_data_valid => right_valid,
      publish_wheel_right_data_ready => right_ready
    );

  source : process
  begin
    wait until aresetn = '1';
    for n in CASES'range loop
      -- The fields of a message may come at different times.
      x       <= CASES(n).forward;
      x_valid <= '1';
      for wait_cycles in 1 to n mod 3 loop
        wait until rising_edge(aclk);
      end loop;
      z       <= CASES(n).turn;
      z_valid <= '1';
      wait until rising_edge(aclk) and x_ready = '1' and z_ready = '1';
      x_valid <= '0';
      z_valid <= '0';
    end loop;
    wait;
  end process;

  cycle       <= cycle + 1 when rising_edge(aclk);
  left_ready  <= '1' when cycle mod 3 /= 0 else '0';
  right_ready <= '1' when cycle mod 4 = 0 else '0';

  sink : process (aclk)
  begin
    if rising_edge(aclk) then
      if left_valid = '1' and left_ready = '1' then
        assert left = CASES(lefts).left report "left " & to_hstring(left) severity failure;
        lefts <= lefts + 1;
      end if;
      if right_valid = '1' and right_ready = '1' then
        assert right = CASES(rights).right report "right " & to_hstring(right) severity failure;
        rights <= rights + 1;
      end if;
      if lefts = CASES'length and rights = CASES'length then
        report "PASS: " & to_string(CASES'length) & " commands";
        finish;
      end if;
      assert cycle < 1000 report "speeds are missing" severity failure;
    end if;
  end process;

end architecture;
