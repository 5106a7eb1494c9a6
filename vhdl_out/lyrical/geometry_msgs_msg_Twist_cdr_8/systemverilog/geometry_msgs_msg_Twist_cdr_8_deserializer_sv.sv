// geometry_msgs_msg_Twist_cdr_8_deserializer_sv: the deserializer of geometry_msgs/msg/Twist, made
// by firm-hdl 0.1.0.
// lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
// definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
// What each port means: manifest.json.
// The deserializer of geometry_msgs/msg/Twist with structs.
// geometry_msgs_msg_Twist_cdr_8_deserializer_verilog has plain ports.

module geometry_msgs_msg_Twist_cdr_8_deserializer_sv (
  // Clock; the rising edge is active.
  input  logic aclk,
  // Synchronous reset, active low.
  input  logic aresetn,
  // Packets.
  input  firm_hdl_bus_8_sv_pkg::packet_beat_t s_axis,
  // beat: ready.
  output logic s_axis_tready,
  // Data and valid of geometry_msgs/msg/Twist.
  output geometry_msgs_msg_twist_cdr_8_sv_pkg::twist_t msg,
  // Ready of the fields.
  input  geometry_msgs_msg_twist_cdr_8_sv_pkg::twist_ready_t rdy,
  // Status of each packet.
  output firm_hdl_sv_pkg::packet_status_stream_t m_axis_status,
  // status: ready.
  input  logic m_axis_status_tready
);

  logic [7:0] status;

  assign m_axis_status.tdata = firm_hdl_sv_pkg::packet_status_t'(status);

  wire unused = &{1'b0, s_axis.tuser};

  geometry_msgs_msg_Twist_cdr_8_deserializer_verilog core (
    .aclk                 (aclk),
    .aresetn              (aresetn),
    .s_axis_tdata         (s_axis.tdata),
    .s_axis_tkeep         (s_axis.tkeep),
    .s_axis_tlast         (s_axis.tlast),
    .s_axis_tvalid        (s_axis.tvalid),
    .s_axis_tready        (s_axis_tready),
    .linear_x_data        (msg.linear.x.data),
    .linear_x_valid       (msg.linear.x.valid),
    .linear_x_ready       (rdy.linear.x),
    .linear_y_data        (msg.linear.y.data),
    .linear_y_valid       (msg.linear.y.valid),
    .linear_y_ready       (rdy.linear.y),
    .linear_z_data        (msg.linear.z.data),
    .linear_z_valid       (msg.linear.z.valid),
    .linear_z_ready       (rdy.linear.z),
    .angular_x_data       (msg.angular.x.data),
    .angular_x_valid      (msg.angular.x.valid),
    .angular_x_ready      (rdy.angular.x),
    .angular_y_data       (msg.angular.y.data),
    .angular_y_valid      (msg.angular.y.valid),
    .angular_y_ready      (rdy.angular.y),
    .angular_z_data       (msg.angular.z.data),
    .angular_z_valid      (msg.angular.z.valid),
    .angular_z_ready      (rdy.angular.z),
    .m_axis_status_tdata  (status),
    .m_axis_status_tvalid (m_axis_status.tvalid),
    .m_axis_status_tready (m_axis_status_tready)
  );

endmodule : geometry_msgs_msg_Twist_cdr_8_deserializer_sv
