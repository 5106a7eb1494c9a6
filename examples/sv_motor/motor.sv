// The speed of a motor from geometry_msgs/msg/Twist: that of the last packet that was in order.
//
// The fields of a damaged packet are offered like those of a good one; what is behind the damage is
// 0. Only the status tells them apart. It comes once per packet, when all fields are there. So the
// field waits for it, both are taken together, and the speed changes on OK alone.

module motor (
  input  logic        aclk,
  input  logic        aresetn,
  input  logic [31:0] s_axis_tdata,
  input  logic [3:0]  s_axis_tkeep,
  input  logic        s_axis_tlast,
  input  logic        s_axis_tvalid,
  output logic        s_axis_tready,
  output logic [63:0] speed  // m/s, a float64's bits
);

  localparam logic [7:0] OK = 8'd0;

  logic [63:0] linear_x;
  logic [7:0]  status;
  logic        status_valid;

  geometry_msgs_msg_Twist_cdr_4_deserializer_verilog rx (
    .aclk, .aresetn,
    .s_axis_tdata, .s_axis_tkeep, .s_axis_tlast, .s_axis_tvalid, .s_axis_tready,
    .linear_x_data(linear_x), .linear_x_valid(), .linear_x_ready(status_valid),
    .linear_y_data(), .linear_y_valid(), .linear_y_ready(1'b1),
    .linear_z_data(), .linear_z_valid(), .linear_z_ready(1'b1),
    .angular_x_data(), .angular_x_valid(), .angular_x_ready(1'b1),
    .angular_y_data(), .angular_y_valid(), .angular_y_ready(1'b1),
    .angular_z_data(), .angular_z_valid(), .angular_z_ready(1'b1),
    .m_axis_status_tdata(status), .m_axis_status_tvalid(status_valid), .m_axis_status_tready(1'b1)
  );

  always_ff @(posedge aclk) begin
    if (!aresetn) speed <= '0;
    else if (status_valid && status == OK) speed <= linear_x;
  end

endmodule
