// geometry_msgs_msg_Twist_cdr_8_serializer_verilog: the serializer of geometry_msgs/msg/Twist, made
// by firm-hdl 0.1.0.
// lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
// definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
// What each port means: manifest.json.
//
// Copy what follows into a module that has aclk and aresetn. Leave out the declarations of nets
// that your module has as ports.
//
// Every field is tied off: it is 0 in all packets, and strings and sequences are empty. To use a
// field, change its line: drive data and valid, and connect ready.

wire [63:0] m_axis_tdata;
wire [7:0] m_axis_tkeep;
wire m_axis_tlast;
wire m_axis_tuser;
wire m_axis_tvalid;
wire m_axis_tready;
wire [7:0] m_axis_status_tdata;
wire m_axis_status_tvalid;

geometry_msgs_msg_Twist_cdr_8_serializer_verilog serializer (
  .aclk(aclk),
  .aresetn(aresetn),
  .m_axis_tdata(m_axis_tdata),
  .m_axis_tkeep(m_axis_tkeep),
  .m_axis_tlast(m_axis_tlast),
  .m_axis_tuser(m_axis_tuser),
  .m_axis_tvalid(m_axis_tvalid),
  .m_axis_tready(m_axis_tready),
  // linear.x: float64
  .linear_x_data(64'd0), .linear_x_valid(1'b1), .linear_x_ready(),
  // linear.y: float64
  .linear_y_data(64'd0), .linear_y_valid(1'b1), .linear_y_ready(),
  // linear.z: float64
  .linear_z_data(64'd0), .linear_z_valid(1'b1), .linear_z_ready(),
  // angular.x: float64
  .angular_x_data(64'd0), .angular_x_valid(1'b1), .angular_x_ready(),
  // angular.y: float64
  .angular_y_data(64'd0), .angular_y_valid(1'b1), .angular_y_ready(),
  // angular.z: float64
  .angular_z_data(64'd0), .angular_z_valid(1'b1), .angular_z_ready(),
  .m_axis_status_tdata(m_axis_status_tdata),
  .m_axis_status_tvalid(m_axis_status_tvalid),
  .m_axis_status_tready(1'b1)
);
