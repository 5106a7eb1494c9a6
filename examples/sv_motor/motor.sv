// The speed of a motor from geometry_msgs/msg/Twist: that of the last good packet.
//
// The fields of a damaged packet become valid like those of a good one; fields after the damage
// are 0. Only the status reports the damage. It comes once per packet, after all fields have become
// valid. So linear.x waits for the status, both are taken together, and the speed changes only if
// the status is OK.

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
