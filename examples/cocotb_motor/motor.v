// The speed of a motor from geometry_msgs/msg/Twist: that of the last good packet.
//
// The same as ../sv_motor/motor.sv, for tools without structs. The instance is a copy of the
// template ..._deserializer_verilog.veo, in which only the line of linear.x is changed.

module motor (
  input             aclk,
  input             aresetn,
  input      [31:0] s_axis_tdata,
  input      [3:0]  s_axis_tkeep,
  input             s_axis_tlast,
  input             s_axis_tvalid,
  output            s_axis_tready,
  output reg [63:0] speed  // m/s, a float64's bits
);

  localparam [7:0] OK = 8'd0;

  wire [63:0] linear_x;
  wire linear_x_valid;
  wire [7:0] m_axis_status_tdata;
  wire m_axis_status_tvalid;

  geometry_msgs_msg_Twist_cdr_4_deserializer_verilog deserializer (
    .aclk(aclk),
    .aresetn(aresetn),
    .s_axis_tdata(s_axis_tdata),
    .s_axis_tkeep(s_axis_tkeep),
    .s_axis_tlast(s_axis_tlast),
    .s_axis_tvalid(s_axis_tvalid),
    .s_axis_tready(s_axis_tready),
    // linear.x: float64
    .linear_x_data(linear_x), .linear_x_valid(linear_x_valid), .linear_x_ready(m_axis_status_tvalid),
    // linear.y: float64
    .linear_y_data(), .linear_y_valid(), .linear_y_ready(1'b1),
    // linear.z: float64
    .linear_z_data(), .linear_z_valid(), .linear_z_ready(1'b1),
    // angular.x: float64
    .angular_x_data(), .angular_x_valid(), .angular_x_ready(1'b1),
    // angular.y: float64
    .angular_y_data(), .angular_y_valid(), .angular_y_ready(1'b1),
    // angular.z: float64
    .angular_z_data(), .angular_z_valid(), .angular_z_ready(1'b1),
    .m_axis_status_tdata(m_axis_status_tdata),
    .m_axis_status_tvalid(m_axis_status_tvalid),
    .m_axis_status_tready(1'b1)
  );

  always @(posedge aclk) begin
    if (!aresetn) speed <= 64'd0;
    else if (m_axis_status_tvalid && m_axis_status_tdata == OK) speed <= linear_x;
  end

endmodule
