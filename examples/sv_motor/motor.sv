// The speed of a motor from geometry_msgs/msg/Twist: that of the last packet that was in order.
//
// The fields of a damaged packet are offered like those of a good one; what is behind the damage is
// 0. Only the status tells them apart. It comes once per packet, when all fields are there. So the
// field waits for it, both are taken together, and the speed changes on OK alone.

module motor
  import firm_hdl_sv_pkg::*;
  import geometry_msgs_msg_twist_cdr_4_sv_pkg::*;
(
  input  logic                                aclk,
  input  logic                                aresetn,
  input  firm_hdl_bus_4_sv_pkg::packet_beat_t s_axis,
  output logic                                s_axis_tready,
  output float64_data_t                       speed  // m/s
);

  twist_t                msg;
  twist_ready_t          rdy;
  packet_status_stream_t status;

  geometry_msgs_msg_Twist_cdr_4_deserializer_sv rx (
    .aclk, .aresetn, .s_axis, .s_axis_tready, .msg, .rdy,
    .m_axis_status(status), .m_axis_status_tready(1'b1)
  );

  always_comb begin
    rdy = TWIST_ALL_READY;
    rdy.linear.x = status.tvalid;
  end

  always_ff @(posedge aclk) begin
    if (!aresetn) speed <= '0;
    else if (status.tvalid && status.tdata == STATUS_OK) speed <= msg.linear.x.data;
  end

endmodule
