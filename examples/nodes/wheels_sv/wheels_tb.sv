// Sends commands to the wheels, and compares the speeds. Both sides stall.
module wheels_tb;
  localparam int CASES = 6;
  real forward[CASES] = '{1.0, 0.5, 0.0, -1.5, 1.0e9, -1.0e9};
  real turn[CASES] = '{0.0, -1.0, 1.0 / 65536, 4.0, 0.0, 0.0};
  real left_want[CASES] = '{1.0, 0.75, 0.0, -2.5, 32768.0 - 1.0 / 65536, -32768.0};
  real right_want[CASES] = '{1.0, 0.25, 0.0, -0.5, 32768.0 - 1.0 / 65536, -32768.0};

  logic aclk = 0, aresetn = 0;
  logic [63:0] x = 0, z = 0, left, right;
  logic x_valid = 0, z_valid = 0, x_ready, z_ready;
  logic left_valid, right_valid, left_ready = 0, right_ready = 0;
  int cycle = 0, lefts = 0, rights = 0, sent = 0;

  always #5 aclk = !aclk;

  wheels dut (
    .aclk, .aresetn,
    .subscribe_cmd_vel_linear_x_data(x), .subscribe_cmd_vel_linear_x_valid(x_valid),
    .subscribe_cmd_vel_linear_x_ready(x_ready),
    .subscribe_cmd_vel_linear_y_data(64'd1), .subscribe_cmd_vel_linear_y_valid(1'b1),
    .subscribe_cmd_vel_linear_y_ready(),
    .subscribe_cmd_vel_linear_z_data(64'd1), .subscribe_cmd_vel_linear_z_valid(1'b1),
    .subscribe_cmd_vel_linear_z_ready(),
    .subscribe_cmd_vel_angular_x_data(64'd1), .subscribe_cmd_vel_angular_x_valid(1'b1),
    .subscribe_cmd_vel_angular_x_ready(),
    .subscribe_cmd_vel_angular_y_data(64'd1), .subscribe_cmd_vel_angular_y_valid(1'b1),
    .subscribe_cmd_vel_angular_y_ready(),
    .subscribe_cmd_vel_angular_z_data(z), .subscribe_cmd_vel_angular_z_valid(z_valid),
    .subscribe_cmd_vel_angular_z_ready(z_ready),
    .publish_wheel_left_data_data(left), .publish_wheel_left_data_valid(left_valid),
    .publish_wheel_left_data_ready(left_ready),
    .publish_wheel_right_data_data(right), .publish_wheel_right_data_valid(right_valid),
    .publish_wheel_right_data_ready(right_ready)
  );

  always @(posedge aclk) begin
    cycle       <= cycle + 1;
    aresetn     <= cycle > 2;
    left_ready  <= cycle % 3 != 0;
    right_ready <= cycle % 4 == 0;
    if (x_valid && x_ready) begin
      x_valid <= 0;
      z_valid <= 0;
      sent    <= sent + 1;
    end else if (aresetn && sent < CASES) begin
      // The fields of a message may come at different times.
      x       <= $realtobits(forward[sent]);
      x_valid <= 1;
      if (x_valid && !z_valid) begin
        z       <= $realtobits(turn[sent]);
        z_valid <= 1;
      end
    end
    if (left_valid && left_ready) begin
      if ($bitstoreal(left) != left_want[lefts]) $fatal(1, "left %f", $bitstoreal(left));
      lefts <= lefts + 1;
    end
    if (right_valid && right_ready) begin
      if ($bitstoreal(right) != right_want[rights]) $fatal(1, "right %f", $bitstoreal(right));
      rights <= rights + 1;
    end
    if (lefts == CASES && rights == CASES) begin
      $display("PASS: %0d commands", CASES);
      $finish;
    end
    if (cycle > 1000) $fatal(1, "speeds are missing");
  end

  initial begin
    if ($test$plusargs("wave")) begin
      $dumpfile("wheels.vcd");
      $dumpvars;
    end
  end
endmodule
