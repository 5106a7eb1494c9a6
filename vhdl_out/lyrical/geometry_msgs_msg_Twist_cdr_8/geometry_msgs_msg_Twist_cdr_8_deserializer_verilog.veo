// geometry_msgs_msg_Twist_cdr_8_deserializer_verilog: the deserializer of geometry_msgs/msg/Twist,
// made by firm-hdl 0.1.0.
// lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
// definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
// What each port means: manifest.json.
//
// Copy what follows into a module that has aclk and aresetn. Leave out the declarations of nets
// that your module has as ports.
//
// Every field is tied off: its transfers are taken at once. To use a field, change its line:
// connect data and valid, and drive ready.

wire [63:0] s_axis_tdata;
wire [7:0] s_axis_tkeep;
wire s_axis_tlast;
wire s_axis_tvalid;
wire s_axis_tready;
wire [7:0] m_axis_status_tdata;
wire m_axis_status_tvalid;

geometry_msgs_msg_Twist_cdr_8_deserializer_verilog deserializer (
  .aclk(aclk),
  .aresetn(aresetn),
  .s_axis_tdata(s_axis_tdata),
  .s_axis_tkeep(s_axis_tkeep),
  .s_axis_tlast(s_axis_tlast),
  .s_axis_tvalid(s_axis_tvalid),
  .s_axis_tready(s_axis_tready),
  // linear.x: float64
  .linear_x_data(), .linear_x_valid(), .linear_x_ready(1'b1),
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
