// geometry_msgs_msg_Twist_cdr_8_deserializer_verilog: the deserializer of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
// lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
// definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
// What each port means: manifest.json.

module geometry_msgs_msg_Twist_cdr_8_deserializer_verilog(aresetn, s_axis_tdata, s_axis_tkeep, s_axis_tlast, s_axis_tvalid, linear_x_ready, linear_y_ready, linear_z_ready, angular_x_ready, angular_y_ready, angular_z_ready, m_axis_status_tready, s_axis_tready, linear_x_data, linear_x_valid, linear_y_data, linear_y_valid, linear_z_data, linear_z_valid, angular_x_data, angular_x_valid
, angular_y_data, angular_y_valid, angular_z_data, angular_z_valid, m_axis_status_tdata, m_axis_status_tvalid, aclk);
  wire \$10 ;
  wire \$11 ;
  wire \$12 ;
  wire \$13 ;
  wire \$14 ;
  wire \$15 ;
  wire \$16 ;
  wire \$17 ;
  wire \$18 ;
  wire \$19 ;
  wire \$2 ;
  wire \$20 ;
  wire \$21 ;
  wire \$22 ;
  wire \$23 ;
  wire \$24 ;
  wire \$25 ;
  wire \$26 ;
  wire \$27 ;
  wire \$28 ;
  wire \$29 ;
  wire \$3 ;
  wire \$30 ;
  wire \$31 ;
  wire \$32 ;
  wire \$33 ;
  wire \$34 ;
  wire \$35 ;
  wire \$36 ;
  wire \$37 ;
  wire \$38 ;
  wire \$39 ;
  wire \$4 ;
  wire \$40 ;
  wire [3:0] \$42 ;
  wire \$5 ;
  wire \$6 ;
  wire \$7 ;
  wire \$8 ;
  wire \$9 ;
  input aclk;
  wire aclk;
  output [63:0] angular_x_data;
  wire [63:0] angular_x_data;
  input angular_x_ready;
  wire angular_x_ready;
  output angular_x_valid;
  wire angular_x_valid;
  output [63:0] angular_y_data;
  wire [63:0] angular_y_data;
  input angular_y_ready;
  wire angular_y_ready;
  output angular_y_valid;
  wire angular_y_valid;
  output [63:0] angular_z_data;
  wire [63:0] angular_z_data;
  input angular_z_ready;
  wire angular_z_ready;
  output angular_z_valid;
  wire angular_z_valid;
  input aresetn;
  wire aresetn;
  output [63:0] linear_x_data;
  wire [63:0] linear_x_data;
  input linear_x_ready;
  wire linear_x_ready;
  output linear_x_valid;
  wire linear_x_valid;
  output [63:0] linear_y_data;
  wire [63:0] linear_y_data;
  input linear_y_ready;
  wire linear_y_ready;
  output linear_y_valid;
  wire linear_y_valid;
  output [63:0] linear_z_data;
  wire [63:0] linear_z_data;
  input linear_z_ready;
  wire linear_z_ready;
  output linear_z_valid;
  wire linear_z_valid;
  output [7:0] m_axis_status_tdata;
  wire [7:0] m_axis_status_tdata;
  input m_axis_status_tready;
  wire m_axis_status_tready;
  output m_axis_status_tvalid;
  wire m_axis_status_tvalid;
  wire [63:0] message__angular__x__payload;
  wire message__angular__x__ready;
  wire message__angular__x__valid;
  wire [63:0] message__angular__y__payload;
  wire message__angular__y__ready;
  wire message__angular__y__valid;
  wire [63:0] message__angular__z__payload;
  wire message__angular__z__ready;
  wire message__angular__z__valid;
  wire [63:0] message__linear__x__payload;
  wire message__linear__x__ready;
  wire message__linear__x__valid;
  wire [63:0] message__linear__y__payload;
  wire message__linear__y__ready;
  wire message__linear__y__valid;
  wire [63:0] message__linear__z__payload;
  wire message__linear__z__ready;
  wire message__linear__z__valid;
  wire [68:0] packets__payload;
  wire [3:0] \packets__payload.count ;
  wire [63:0] \packets__payload.data ;
  wire [7:0] \packets__payload.data_0 ;
  wire [7:0] \packets__payload.data_1 ;
  wire [7:0] \packets__payload.data_2 ;
  wire [7:0] \packets__payload.data_3 ;
  wire [7:0] \packets__payload.data_4 ;
  wire [7:0] \packets__payload.data_5 ;
  wire [7:0] \packets__payload.data_6 ;
  wire [7:0] \packets__payload.data_7 ;
  wire \packets__payload.last ;
  wire packets__ready;
  wire packets__valid;
  wire rst;
  input [63:0] s_axis_tdata;
  wire [63:0] s_axis_tdata;
  input [7:0] s_axis_tkeep;
  wire [7:0] s_axis_tkeep;
  input s_axis_tlast;
  wire s_axis_tlast;
  output s_axis_tready;
  wire s_axis_tready;
  input s_axis_tvalid;
  wire s_axis_tvalid;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] status__payload;
  wire status__ready;
  wire status__valid;
  assign rst = ~ aresetn;
  assign \$2  = ~ s_axis_tkeep[1];
  assign \$3  = s_axis_tkeep[0] & \$2 ;
  assign \$4  = & s_axis_tkeep[2:0];
  assign \$5  = ~ s_axis_tkeep[3];
  assign \$6  = \$4  & \$5 ;
  assign \$7  = & s_axis_tkeep[4:0];
  assign \$8  = ~ s_axis_tkeep[5];
  assign \$9  = \$7  & \$8 ;
  assign \$10  = & s_axis_tkeep[6:0];
  assign \$11  = ~ s_axis_tkeep[7];
  assign \$12  = \$10  & \$11 ;
  assign \$13  = | { \$12 , \$9 , \$6 , \$3  };
  assign \$14  = & s_axis_tkeep[1:0];
  assign \$15  = ~ s_axis_tkeep[2];
  assign \$16  = \$14  & \$15 ;
  assign \$17  = & s_axis_tkeep[2:0];
  assign \$18  = ~ s_axis_tkeep[3];
  assign \$19  = \$17  & \$18 ;
  assign \$20  = & s_axis_tkeep[5:0];
  assign \$21  = ~ s_axis_tkeep[6];
  assign \$22  = \$20  & \$21 ;
  assign \$23  = & s_axis_tkeep[6:0];
  assign \$24  = ~ s_axis_tkeep[7];
  assign \$25  = \$23  & \$24 ;
  assign \$26  = | { \$25 , \$22 , \$19 , \$16  };
  assign \$27  = & s_axis_tkeep[3:0];
  assign \$28  = ~ s_axis_tkeep[4];
  assign \$29  = \$27  & \$28 ;
  assign \$30  = & s_axis_tkeep[4:0];
  assign \$31  = ~ s_axis_tkeep[5];
  assign \$32  = \$30  & \$31 ;
  assign \$33  = & s_axis_tkeep[5:0];
  assign \$34  = ~ s_axis_tkeep[6];
  assign \$35  = \$33  & \$34 ;
  assign \$36  = & s_axis_tkeep[6:0];
  assign \$37  = ~ s_axis_tkeep[7];
  assign \$38  = \$36  & \$37 ;
  assign \$39  = | { \$38 , \$35 , \$32 , \$29  };
  assign \$40  = & s_axis_tkeep;
  assign \$42  = s_axis_tlast ? { \$40 , \$39 , \$26 , \$13  } : 4'h8;
  assign packets__payload = { s_axis_tlast, \$42 , s_axis_tdata };
  assign m_axis_status_tdata = { 5'h00, status__payload };
  \geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.core  core (
    .aclk(aclk),
    .message__angular__x__payload(angular_x_data),
    .message__angular__x__ready(angular_x_ready),
    .message__angular__x__valid(angular_x_valid),
    .message__angular__y__payload(angular_y_data),
    .message__angular__y__ready(angular_y_ready),
    .message__angular__y__valid(angular_y_valid),
    .message__angular__z__payload(angular_z_data),
    .message__angular__z__ready(angular_z_ready),
    .message__angular__z__valid(angular_z_valid),
    .message__linear__x__payload(linear_x_data),
    .message__linear__x__ready(linear_x_ready),
    .message__linear__x__valid(linear_x_valid),
    .message__linear__y__payload(linear_y_data),
    .message__linear__y__ready(linear_y_ready),
    .message__linear__y__valid(linear_y_valid),
    .message__linear__z__payload(linear_z_data),
    .message__linear__z__ready(linear_z_ready),
    .message__linear__z__valid(linear_z_valid),
    .packets__payload(packets__payload),
    .packets__ready(s_axis_tready),
    .packets__valid(s_axis_tvalid),
    .rst(rst),
    .status__payload(status__payload),
    .status__ready(m_axis_status_tready),
    .status__valid(m_axis_status_tvalid)
  );
  assign \packets__payload.data_7  = packets__payload[63:56];
  assign \packets__payload.data_6  = packets__payload[55:48];
  assign \packets__payload.data_5  = packets__payload[47:40];
  assign \packets__payload.data_4  = packets__payload[39:32];
  assign \packets__payload.data_3  = packets__payload[31:24];
  assign \packets__payload.data_2  = packets__payload[23:16];
  assign \packets__payload.data_1  = packets__payload[15:8];
  assign \packets__payload.data_0  = packets__payload[7:0];
  assign \packets__payload.data  = packets__payload[63:0];
  assign \packets__payload.count  = packets__payload[67:64];
  assign \packets__payload.last  = packets__payload[68];
  assign message__angular__z__ready = angular_z_ready;
  assign message__angular__z__valid = angular_z_valid;
  assign message__angular__z__payload = angular_z_data;
  assign message__angular__y__ready = angular_y_ready;
  assign message__angular__y__valid = angular_y_valid;
  assign message__angular__y__payload = angular_y_data;
  assign message__angular__x__ready = angular_x_ready;
  assign message__angular__x__valid = angular_x_valid;
  assign message__angular__x__payload = angular_x_data;
  assign message__linear__z__ready = linear_z_ready;
  assign message__linear__z__valid = linear_z_valid;
  assign message__linear__z__payload = linear_z_data;
  assign message__linear__y__ready = linear_y_ready;
  assign message__linear__y__valid = linear_y_valid;
  assign message__linear__y__payload = linear_y_data;
  assign message__linear__x__ready = linear_x_ready;
  assign message__linear__x__valid = linear_x_valid;
  assign message__linear__x__payload = linear_x_data;
  assign status__ready = m_axis_status_tready;
  assign status__valid = m_axis_status_tvalid;
  assign packets__ready = s_axis_tready;
  assign packets__valid = s_axis_tvalid;
endmodule

module \geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.core (packets__valid, message__linear__x__ready, message__linear__y__ready, message__linear__z__ready, message__angular__x__ready, message__angular__y__ready, message__angular__z__ready, status__ready, rst, packets__payload, packets__ready, message__linear__x__valid, message__linear__y__valid, message__linear__z__valid, message__angular__x__valid, message__angular__y__valid, message__angular__z__valid, status__valid, status__payload, message__linear__x__payload, message__linear__y__payload
, message__linear__z__payload, message__angular__x__payload, message__angular__y__payload, message__angular__z__payload, aclk);
  input aclk;
  wire aclk;
  wire [73:0] beat;
  wire [73:0] \beat$28 ;
  wire [3:0] \beat$28.at ;
  wire [3:0] \beat$28.count ;
  wire [63:0] \beat$28.data ;
  wire \beat$28.last ;
  wire \beat$28.valid ;
  wire [73:0] \beat$7 ;
  wire [3:0] \beat$7.at ;
  wire [3:0] \beat$7.count ;
  wire [63:0] \beat$7.data ;
  wire \beat$7.last ;
  wire \beat$7.valid ;
  wire [3:0] \beat.at ;
  wire [3:0] \beat.count ;
  wire [63:0] \beat.data ;
  wire \beat.last ;
  wire \beat.valid ;
  wire ended;
  wire \ended$11 ;
  wire [3:0] following;
  wire [3:0] \following$13 ;
  wire [3:0] freed;
  wire [3:0] \freed$32 ;
  wire [41:0] i__payload;
  wire \i__payload.blank ;
  wire \i__payload.ends ;
  wire \i__payload.final ;
  wire [3:0] \i__payload.first ;
  wire \i__payload.items ;
  wire [5:0] \i__payload.items_at ;
  wire [3:0] \i__payload.items_bytes ;
  wire [2:0] \i__payload.items_next ;
  wire \i__payload.last ;
  wire \i__payload.length_good ;
  wire [5:0] \i__payload.map_at ;
  wire [3:0] \i__payload.map_bytes ;
  wire [2:0] \i__payload.map_next ;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] \i__payload.status ;
  wire [2:0] \i__payload.step ;
  wire i__ready;
  wire i__valid;
  wire [6:0] limit;
  wire [6:0] \limit$9 ;
  output [63:0] message__angular__x__payload;
  wire [63:0] message__angular__x__payload;
  input message__angular__x__ready;
  wire message__angular__x__ready;
  output message__angular__x__valid;
  wire message__angular__x__valid;
  output [63:0] message__angular__y__payload;
  wire [63:0] message__angular__y__payload;
  input message__angular__y__ready;
  wire message__angular__y__ready;
  output message__angular__y__valid;
  wire message__angular__y__valid;
  output [63:0] message__angular__z__payload;
  wire [63:0] message__angular__z__payload;
  input message__angular__z__ready;
  wire message__angular__z__ready;
  output message__angular__z__valid;
  wire message__angular__z__valid;
  output [63:0] message__linear__x__payload;
  wire [63:0] message__linear__x__payload;
  input message__linear__x__ready;
  wire message__linear__x__ready;
  output message__linear__x__valid;
  wire message__linear__x__valid;
  output [63:0] message__linear__y__payload;
  wire [63:0] message__linear__y__payload;
  input message__linear__y__ready;
  wire message__linear__y__ready;
  output message__linear__y__valid;
  wire message__linear__y__valid;
  output [63:0] message__linear__z__payload;
  wire [63:0] message__linear__z__payload;
  input message__linear__z__ready;
  wire message__linear__z__ready;
  output message__linear__z__valid;
  wire message__linear__z__valid;
  wire \next$15 ;
  wire next_sig;
  wire [41:0] o__payload;
  wire \o__payload.blank ;
  wire \o__payload.ends ;
  wire \o__payload.final ;
  wire [3:0] \o__payload.first ;
  wire \o__payload.items ;
  wire [5:0] \o__payload.items_at ;
  wire [3:0] \o__payload.items_bytes ;
  wire [2:0] \o__payload.items_next ;
  wire \o__payload.last ;
  wire \o__payload.length_good ;
  wire [5:0] \o__payload.map_at ;
  wire [3:0] \o__payload.map_bytes ;
  wire [2:0] \o__payload.map_next ;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] \o__payload.status ;
  wire [2:0] \o__payload.step ;
  wire o__ready;
  wire o__valid;
  wire [3:0] oldest;
  wire [3:0] \oldest$30 ;
  wire [41:0] orders__payload;
  wire [41:0] \orders__payload$22 ;
  wire \orders__payload$22.blank ;
  wire \orders__payload$22.ends ;
  wire \orders__payload$22.final ;
  wire [3:0] \orders__payload$22.first ;
  wire \orders__payload$22.items ;
  wire [5:0] \orders__payload$22.items_at ;
  wire [3:0] \orders__payload$22.items_bytes ;
  wire [2:0] \orders__payload$22.items_next ;
  wire \orders__payload$22.last ;
  wire \orders__payload$22.length_good ;
  wire [5:0] \orders__payload$22.map_at ;
  wire [3:0] \orders__payload$22.map_bytes ;
  wire [2:0] \orders__payload$22.map_next ;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] \orders__payload$22.status ;
  wire [2:0] \orders__payload$22.step ;
  wire \orders__payload.blank ;
  wire \orders__payload.ends ;
  wire \orders__payload.final ;
  wire [3:0] \orders__payload.first ;
  wire \orders__payload.items ;
  wire [5:0] \orders__payload.items_at ;
  wire [3:0] \orders__payload.items_bytes ;
  wire [2:0] \orders__payload.items_next ;
  wire \orders__payload.last ;
  wire \orders__payload.length_good ;
  wire [5:0] \orders__payload.map_at ;
  wire [3:0] \orders__payload.map_bytes ;
  wire [2:0] \orders__payload.map_next ;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] \orders__payload.status ;
  wire [2:0] \orders__payload.step ;
  wire orders__ready;
  wire \orders__ready$27 ;
  wire orders__valid;
  wire \orders__valid$24 ;
  input [68:0] packets__payload;
  wire [68:0] packets__payload;
  wire [68:0] \packets__payload$1 ;
  wire [3:0] \packets__payload$1.count ;
  wire [63:0] \packets__payload$1.data ;
  wire [7:0] \packets__payload$1.data_0 ;
  wire [7:0] \packets__payload$1.data_1 ;
  wire [7:0] \packets__payload$1.data_2 ;
  wire [7:0] \packets__payload$1.data_3 ;
  wire [7:0] \packets__payload$1.data_4 ;
  wire [7:0] \packets__payload$1.data_5 ;
  wire [7:0] \packets__payload$1.data_6 ;
  wire [7:0] \packets__payload$1.data_7 ;
  wire \packets__payload$1.last ;
  wire [3:0] \packets__payload.count ;
  wire [63:0] \packets__payload.data ;
  wire [7:0] \packets__payload.data_0 ;
  wire [7:0] \packets__payload.data_1 ;
  wire [7:0] \packets__payload.data_2 ;
  wire [7:0] \packets__payload.data_3 ;
  wire [7:0] \packets__payload.data_4 ;
  wire [7:0] \packets__payload.data_5 ;
  wire [7:0] \packets__payload.data_6 ;
  wire [7:0] \packets__payload.data_7 ;
  wire \packets__payload.last ;
  output packets__ready;
  wire packets__ready;
  wire \packets__ready$5 ;
  input packets__valid;
  wire packets__valid;
  wire \packets__valid$3 ;
  input rst;
  wire rst;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  output [2:0] status__payload;
  wire [2:0] status__payload;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] \status__payload$34 ;
  input status__ready;
  wire status__ready;
  wire \status__ready$38 ;
  output status__valid;
  wire status__valid;
  wire \status__valid$36 ;
  \geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.core.buffer  buffer_sig (
    .aclk(aclk),
    .beat(beat),
    .ended(ended),
    .following(following),
    .freed(freed),
    .limit(limit),
    .next_sig(next_sig),
    .packets__payload(packets__payload),
    .packets__ready(packets__ready),
    .packets__valid(packets__valid),
    .rst(rst)
  );
  \geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.core.mover  mover (
    .aclk(aclk),
    .beat(beat),
    .message__angular__x__payload(message__angular__x__payload),
    .message__angular__x__ready(message__angular__x__ready),
    .message__angular__x__valid(message__angular__x__valid),
    .message__angular__y__payload(message__angular__y__payload),
    .message__angular__y__ready(message__angular__y__ready),
    .message__angular__y__valid(message__angular__y__valid),
    .message__angular__z__payload(message__angular__z__payload),
    .message__angular__z__ready(message__angular__z__ready),
    .message__angular__z__valid(message__angular__z__valid),
    .message__linear__x__payload(message__linear__x__payload),
    .message__linear__x__ready(message__linear__x__ready),
    .message__linear__x__valid(message__linear__x__valid),
    .message__linear__y__payload(message__linear__y__payload),
    .message__linear__y__ready(message__linear__y__ready),
    .message__linear__y__valid(message__linear__y__valid),
    .message__linear__z__payload(message__linear__z__payload),
    .message__linear__z__ready(message__linear__z__ready),
    .message__linear__z__valid(message__linear__z__valid),
    .orders__payload(\orders__payload$22 ),
    .orders__ready(o__ready),
    .orders__valid(\orders__valid$24 ),
    .rst(rst),
    .status__payload(status__payload),
    .status__ready(status__ready),
    .status__valid(status__valid)
  );
  \geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.core.queue  queue (
    .aclk(aclk),
    .freed(freed),
    .i__payload(i__payload),
    .i__ready(orders__ready),
    .i__valid(i__valid),
    .o__payload(\orders__payload$22 ),
    .o__ready(o__ready),
    .o__valid(\orders__valid$24 ),
    .oldest(oldest),
    .rst(rst)
  );
  \geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.core.sequencer  sequencer (
    .aclk(aclk),
    .beat(beat),
    .ended(ended),
    .following(following),
    .header_at(oldest),
    .limit(limit),
    .next_sig(next_sig),
    .orders__payload(i__payload),
    .orders__ready(orders__ready),
    .orders__valid(i__valid),
    .rst(rst)
  );
  assign \beat$28.valid  = beat[73];
  assign \beat$28.at  = beat[72:69];
  assign \beat$28.last  = beat[68];
  assign \beat$28.count  = beat[67:64];
  assign \beat$28.data  = beat[63:0];
  assign \o__payload.status  = \orders__payload$22 [41:39];
  assign \o__payload.ends  = \orders__payload$22 [38];
  assign \o__payload.first  = \orders__payload$22 [37:34];
  assign \o__payload.final  = \orders__payload$22 [33];
  assign \o__payload.length_good  = \orders__payload$22 [32];
  assign \o__payload.last  = \orders__payload$22 [31];
  assign \o__payload.items  = \orders__payload$22 [30];
  assign \o__payload.map_bytes  = \orders__payload$22 [29:26];
  assign \o__payload.items_bytes  = \orders__payload$22 [25:22];
  assign \o__payload.map_next  = \orders__payload$22 [21:19];
  assign \o__payload.items_next  = \orders__payload$22 [18:16];
  assign \o__payload.map_at  = \orders__payload$22 [15:10];
  assign \o__payload.items_at  = \orders__payload$22 [9:4];
  assign \o__payload.blank  = \orders__payload$22 [3];
  assign \o__payload.step  = \orders__payload$22 [2:0];
  assign \orders__payload$22.status  = \orders__payload$22 [41:39];
  assign \orders__payload$22.ends  = \orders__payload$22 [38];
  assign \orders__payload$22.first  = \orders__payload$22 [37:34];
  assign \orders__payload$22.final  = \orders__payload$22 [33];
  assign \orders__payload$22.length_good  = \orders__payload$22 [32];
  assign \orders__payload$22.last  = \orders__payload$22 [31];
  assign \orders__payload$22.items  = \orders__payload$22 [30];
  assign \orders__payload$22.map_bytes  = \orders__payload$22 [29:26];
  assign \orders__payload$22.items_bytes  = \orders__payload$22 [25:22];
  assign \orders__payload$22.map_next  = \orders__payload$22 [21:19];
  assign \orders__payload$22.items_next  = \orders__payload$22 [18:16];
  assign \orders__payload$22.map_at  = \orders__payload$22 [15:10];
  assign \orders__payload$22.items_at  = \orders__payload$22 [9:4];
  assign \orders__payload$22.blank  = \orders__payload$22 [3];
  assign \orders__payload$22.step  = \orders__payload$22 [2:0];
  assign \orders__payload.status  = i__payload[41:39];
  assign \orders__payload.ends  = i__payload[38];
  assign \orders__payload.first  = i__payload[37:34];
  assign \orders__payload.final  = i__payload[33];
  assign \orders__payload.length_good  = i__payload[32];
  assign \orders__payload.last  = i__payload[31];
  assign \orders__payload.items  = i__payload[30];
  assign \orders__payload.map_bytes  = i__payload[29:26];
  assign \orders__payload.items_bytes  = i__payload[25:22];
  assign \orders__payload.map_next  = i__payload[21:19];
  assign \orders__payload.items_next  = i__payload[18:16];
  assign \orders__payload.map_at  = i__payload[15:10];
  assign \orders__payload.items_at  = i__payload[9:4];
  assign \orders__payload.blank  = i__payload[3];
  assign \orders__payload.step  = i__payload[2:0];
  assign \i__payload.status  = i__payload[41:39];
  assign \i__payload.ends  = i__payload[38];
  assign \i__payload.first  = i__payload[37:34];
  assign \i__payload.final  = i__payload[33];
  assign \i__payload.length_good  = i__payload[32];
  assign \i__payload.last  = i__payload[31];
  assign \i__payload.items  = i__payload[30];
  assign \i__payload.map_bytes  = i__payload[29:26];
  assign \i__payload.items_bytes  = i__payload[25:22];
  assign \i__payload.map_next  = i__payload[21:19];
  assign \i__payload.items_next  = i__payload[18:16];
  assign \i__payload.map_at  = i__payload[15:10];
  assign \i__payload.items_at  = i__payload[9:4];
  assign \i__payload.blank  = i__payload[3];
  assign \i__payload.step  = i__payload[2:0];
  assign \beat$7.valid  = beat[73];
  assign \beat$7.at  = beat[72:69];
  assign \beat$7.last  = beat[68];
  assign \beat$7.count  = beat[67:64];
  assign \beat$7.data  = beat[63:0];
  assign \beat.valid  = beat[73];
  assign \beat.at  = beat[72:69];
  assign \beat.last  = beat[68];
  assign \beat.count  = beat[67:64];
  assign \beat.data  = beat[63:0];
  assign \packets__payload$1.last  = packets__payload[68];
  assign \packets__payload$1.count  = packets__payload[67:64];
  assign \packets__payload$1.data_7  = packets__payload[63:56];
  assign \packets__payload$1.data_6  = packets__payload[55:48];
  assign \packets__payload$1.data_5  = packets__payload[47:40];
  assign \packets__payload$1.data_4  = packets__payload[39:32];
  assign \packets__payload$1.data_3  = packets__payload[31:24];
  assign \packets__payload$1.data_2  = packets__payload[23:16];
  assign \packets__payload$1.data_1  = packets__payload[15:8];
  assign \packets__payload$1.data_0  = packets__payload[7:0];
  assign \packets__payload$1.data  = packets__payload[63:0];
  assign \packets__payload.last  = packets__payload[68];
  assign \packets__payload.count  = packets__payload[67:64];
  assign \packets__payload.data_7  = packets__payload[63:56];
  assign \packets__payload.data_6  = packets__payload[55:48];
  assign \packets__payload.data_5  = packets__payload[47:40];
  assign \packets__payload.data_4  = packets__payload[39:32];
  assign \packets__payload.data_3  = packets__payload[31:24];
  assign \packets__payload.data_2  = packets__payload[23:16];
  assign \packets__payload.data_1  = packets__payload[15:8];
  assign \packets__payload.data_0  = packets__payload[7:0];
  assign \packets__payload.data  = packets__payload[63:0];
  assign \status__ready$38  = status__ready;
  assign \status__valid$36  = status__valid;
  assign \status__payload$34  = status__payload;
  assign \freed$32  = freed;
  assign \oldest$30  = oldest;
  assign \beat$28  = beat;
  assign \orders__ready$27  = o__ready;
  assign o__valid = \orders__valid$24 ;
  assign o__payload = \orders__payload$22 ;
  assign i__ready = orders__ready;
  assign orders__valid = i__valid;
  assign orders__payload = i__payload;
  assign \next$15  = next_sig;
  assign \following$13  = following;
  assign \ended$11  = ended;
  assign \limit$9  = limit;
  assign \beat$7  = beat;
  assign \packets__ready$5  = packets__ready;
  assign \packets__valid$3  = packets__valid;
  assign \packets__payload$1  = packets__payload;
endmodule

module \geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.core.buffer (packets__valid, rst, next_sig, freed, packets__payload, beat, packets__ready, limit, following, ended, aclk);
  (* unused_bits = "4" *)
  wire [4:0] \$1 ;
  wire \$10 ;
  wire \$11 ;
  wire \$12 ;
  wire \$13 ;
  wire \$14 ;
  wire [10:0] \$15 ;
  wire \$16 ;
  wire \$17 ;
  wire \$18 ;
  wire [10:0] \$19 ;
  (* unused_bits = "4" *)
  wire [4:0] \$2 ;
  wire \$20 ;
  wire \$21 ;
  wire \$22 ;
  wire \$23 ;
  (* unused_bits = "4" *)
  wire [4:0] \$24 ;
  wire \$25 ;
  wire \$26 ;
  (* unused_bits = "4" *)
  wire [4:0] \$27 ;
  wire \$28 ;
  wire [3:0] \$29 ;
  (* unused_bits = "7" *)
  wire [7:0] \$3 ;
  wire [3:0] \$30 ;
  wire \$31 ;
  wire [6:0] \$32 ;
  wire [3:0] \$33 ;
  wire \$34 ;
  wire [10:0] \$35 ;
  wire \$36 ;
  wire [3:0] \$37 ;
  wire [3:0] \$38 ;
  wire [3:0] \$4 ;
  wire [6:0] \$5 ;
  (* unused_bits = "4" *)
  wire [4:0] \$6 ;
  (* unused_bits = "4" *)
  wire [4:0] \$7 ;
  wire \$8 ;
  wire \$9 ;
  wire [3:0] choice_302_Y ;
  wire [3:0] choice_306_Y ;
  wire [10:0] choice_312_Y ;
  wire choice_316_Y ;
  wire [3:0] choice_320_Y ;
  wire [6:0] choice_324_Y ;
  input aclk;
  wire aclk;
  reg [3:0] arrived = 4'h0;
  wire arrives;
  reg [3:0] at = 4'h0;
  output [73:0] beat;
  wire [73:0] beat;
  wire [3:0] \beat.at ;
  wire [3:0] \beat.count ;
  wire [63:0] \beat.data ;
  wire \beat.last ;
  wire \beat.valid ;
  wire [3:0] \end.following ;
  wire [6:0] \end.limit ;
  wire [10:0] end_sig;
  output ended;
  reg ended = 1'h0;
  wire [2:0] ends__read__addr;
  wire [10:0] ends__read__data;
  wire [3:0] \ends__read__data.following ;
  wire [6:0] \ends__read__data.limit ;
  wire [2:0] ends__write__addr;
  wire [10:0] ends__write__data;
  wire [3:0] \ends__write__data.following ;
  wire [6:0] \ends__write__data.limit ;
  wire ends__write__en;
  wire ends_now;
  output [3:0] following;
  reg [3:0] following = 4'h0;
  wire follows;
  input [3:0] freed;
  wire [3:0] freed;
  reg full = 1'h0;
  reg has_second = 1'h0;
  output [6:0] limit;
  reg [6:0] limit = 7'h00;
  wire more;
  wire [10:0] newest;
  wire [3:0] \newest.following ;
  wire [6:0] \newest.limit ;
  wire [3:0] next_beat;
  input next_sig;
  wire next_sig;
  input [68:0] packets__payload;
  wire [68:0] packets__payload;
  wire [3:0] \packets__payload.count ;
  wire [63:0] \packets__payload.data ;
  wire [7:0] \packets__payload.data_0 ;
  wire [7:0] \packets__payload.data_1 ;
  wire [7:0] \packets__payload.data_2 ;
  wire [7:0] \packets__payload.data_3 ;
  wire [7:0] \packets__payload.data_4 ;
  wire [7:0] \packets__payload.data_5 ;
  wire [7:0] \packets__payload.data_6 ;
  wire [7:0] \packets__payload.data_7 ;
  wire \packets__payload.last ;
  output packets__ready;
  reg packets__ready = 1'h1;
  input packets__valid;
  wire packets__valid;
  reg [68:0] payload = 69'h000000000000000000;
  wire [3:0] \payload.count ;
  wire [63:0] \payload.data ;
  wire [7:0] \payload.data_0 ;
  wire [7:0] \payload.data_1 ;
  wire [7:0] \payload.data_2 ;
  wire [7:0] \payload.data_3 ;
  wire [7:0] \payload.data_4 ;
  wire [7:0] \payload.data_5 ;
  wire [7:0] \payload.data_6 ;
  wire [7:0] \payload.data_7 ;
  wire \payload.last ;
  reg [3:0] popped = 4'h0;
  reg [3:0] pushed = 4'h0;
  wire room;
  input rst;
  wire rst;
  reg [10:0] second = 11'h000;
  wire [3:0] \second.following ;
  wire [6:0] \second.limit ;
  wire stored;
  wire [3:0] used;
  reg [10:0] ends [7:0];
  initial begin
    ends[0] = 11'h000;
    ends[1] = 11'h000;
    ends[2] = 11'h000;
    ends[3] = 11'h000;
    ends[4] = 11'h000;
    ends[5] = 11'h000;
    ends[6] = 11'h000;
    ends[7] = 11'h000;
  end
  always @(posedge aclk) begin
    ends[pushed[2:0]] <= end_sig;
  end
  assign ends__read__data = ends[popped[2:0]];
  assign arrives = packets__valid & packets__ready;
  assign { \$1 [4], used } = arrived - freed;
  assign { \$2 [4], next_beat } = at + 1'h1;
  assign ends_now = beat[73] & beat[68];
  assign \$3  = { at, 3'h0 } + beat[67:64];
  assign \$4  = beat[73] ? next_beat : at;
  assign \$5  = ends_now ? end_sig[6:0] : { \$4 , 3'h0 };
  assign stored = pushed != popped;
  assign more = stored | ends_now;
  assign follows = ended & ends_now;
  assign \$6  = arrived + arrives;
  assign \$7  = at + full;
  assign \$8  = ~ used[3];
  assign \$9  = used == 3'h7;
  assign \$10  = \$9  & arrives;
  assign \$11  = ~ \$10 ;
  assign \$12  = \$8  & \$11 ;
  assign \$13  = ~ ended;
  assign \$14  = next_sig | \$13 ;
  assign \$15  = has_second ? second : newest;
  assign \$16  = has_second | ends_now;
  assign \$17  = ~ has_second;
  assign \$18  = next_sig | \$17 ;
  assign \$19  = stored ? ends__read__data : end_sig;
  assign \$20  = next_sig ? more : 1'h1;
  assign \$21  = next_sig ? 1'h0 : follows;
  assign \$22  = has_second ? \$20  : \$21 ;
  assign \$23  = has_second & ends_now;
  assign \$24  = pushed + 1'h1;
  assign \$25  = next_sig & has_second;
  assign \$26  = \$25  & more;
  assign \$27  = popped + 1'h1;
  always @(posedge aclk)
    full <= \$28 ;
  always @(posedge aclk)
    payload <= packets__payload;
  always @(posedge aclk)
    arrived <= \$29 ;
  always @(posedge aclk)
    at <= \$30 ;
  always @(posedge aclk)
    packets__ready <= \$31 ;
  always @(posedge aclk)
    limit <= \$32 ;
  always @(posedge aclk)
    following <= \$33 ;
  always @(posedge aclk)
    ended <= \$34 ;
  always @(posedge aclk)
    second <= \$35 ;
  always @(posedge aclk)
    has_second <= \$36 ;
  always @(posedge aclk)
    pushed <= \$37 ;
  always @(posedge aclk)
    popped <= \$38 ;
  assign choice_302_Y  = \$26  ? \$27 [3:0] : popped;
  assign \$38  = rst ? 4'h0 : choice_302_Y ;
  assign choice_306_Y  = \$23  ? \$24 [3:0] : pushed;
  assign \$37  = rst ? 4'h0 : choice_306_Y ;
  assign \$36  = rst ? 1'h0 : \$22 ;
  assign choice_312_Y  = \$18  ? \$19  : second;
  assign \$35  = rst ? 11'h000 : choice_312_Y ;
  assign choice_316_Y  = \$14  ? \$16  : ended;
  assign \$34  = rst ? 1'h0 : choice_316_Y ;
  assign choice_320_Y  = \$14  ? \$15 [10:7] : following;
  assign \$33  = rst ? 4'h0 : choice_320_Y ;
  assign choice_324_Y  = \$14  ? \$15 [6:0] : limit;
  assign \$32  = rst ? 7'h00 : choice_324_Y ;
  assign \$31  = rst ? 1'h1 : \$12 ;
  assign \$30  = rst ? 4'h0 : \$7 [3:0];
  assign \$29  = rst ? 4'h0 : \$6 [3:0];
  assign \$28  = rst ? 1'h0 : arrives;
  assign beat = { full, at, payload };
  assign end_sig = { next_beat, \$3 [6:0] };
  assign newest = { next_beat, \$5  };
  assign \ends__read__data.following  = ends__read__data[10:7];
  assign \ends__read__data.limit  = ends__read__data[6:0];
  assign \second.following  = second[10:7];
  assign \second.limit  = second[6:0];
  assign \packets__payload.last  = packets__payload[68];
  assign \packets__payload.count  = packets__payload[67:64];
  assign \packets__payload.data_7  = packets__payload[63:56];
  assign \packets__payload.data_6  = packets__payload[55:48];
  assign \packets__payload.data_5  = packets__payload[47:40];
  assign \packets__payload.data_4  = packets__payload[39:32];
  assign \packets__payload.data_3  = packets__payload[31:24];
  assign \packets__payload.data_2  = packets__payload[23:16];
  assign \packets__payload.data_1  = packets__payload[15:8];
  assign \packets__payload.data_0  = packets__payload[7:0];
  assign \packets__payload.data  = packets__payload[63:0];
  assign \ends__write__data.following  = end_sig[10:7];
  assign \ends__write__data.limit  = end_sig[6:0];
  assign \newest.following  = newest[10:7];
  assign \newest.limit  = newest[6:0];
  assign \end.following  = end_sig[10:7];
  assign \end.limit  = end_sig[6:0];
  assign \payload.last  = payload[68];
  assign \payload.count  = payload[67:64];
  assign \payload.data_7  = payload[63:56];
  assign \payload.data_6  = payload[55:48];
  assign \payload.data_5  = payload[47:40];
  assign \payload.data_4  = payload[39:32];
  assign \payload.data_3  = payload[31:24];
  assign \payload.data_2  = payload[23:16];
  assign \payload.data_1  = payload[15:8];
  assign \payload.data_0  = payload[7:0];
  assign \payload.data  = payload[63:0];
  assign \beat.valid  = beat[73];
  assign \beat.at  = beat[72:69];
  assign \beat.last  = beat[68];
  assign \beat.count  = beat[67:64];
  assign \beat.data  = beat[63:0];
  assign \$2 [3:0] = next_beat;
  assign \$1 [3:0] = used;
  assign ends__read__addr = popped[2:0];
  assign ends__write__en = 1'h1;
  assign ends__write__data = end_sig;
  assign ends__write__addr = pushed[2:0];
  assign room = packets__ready;
endmodule

module \geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.core.mover (message__linear__x__ready, message__linear__y__ready, message__linear__z__ready, message__angular__x__ready, message__angular__y__ready, message__angular__z__ready, status__ready, rst, orders__ready, beat, orders__valid, orders__payload, message__linear__x__valid, message__linear__y__valid, message__linear__z__valid, message__angular__x__valid, message__angular__y__valid, message__angular__z__valid, status__valid, status__payload, message__linear__x__payload
, message__linear__y__payload, message__linear__z__payload, message__angular__x__payload, message__angular__y__payload, message__angular__z__payload, aclk);
  wire \$1 ;
  wire \$10 ;
  wire \$100 ;
  wire \$101 ;
  wire \$102 ;
  wire \$103 ;
  wire \$104 ;
  wire \$105 ;
  wire \$106 ;
  wire \$107 ;
  wire \$108 ;
  wire \$109 ;
  wire \$110 ;
  wire \$111 ;
  wire \$112 ;
  wire \$113 ;
  wire \$114 ;
  wire \$115 ;
  wire \$116 ;
  wire \$117 ;
  wire \$118 ;
  wire \$119 ;
  wire \$120 ;
  wire \$121 ;
  wire \$122 ;
  wire \$123 ;
  wire \$124 ;
  wire \$125 ;
  wire \$126 ;
  wire \$127 ;
  wire \$128 ;
  wire \$129 ;
  wire \$13 ;
  wire \$130 ;
  wire \$131 ;
  wire \$132 ;
  wire \$133 ;
  wire \$134 ;
  wire \$135 ;
  wire \$136 ;
  wire \$137 ;
  wire \$138 ;
  wire \$139 ;
  wire \$140 ;
  wire \$141 ;
  wire \$142 ;
  wire \$143 ;
  wire \$144 ;
  wire \$145 ;
  wire \$146 ;
  wire \$147 ;
  wire \$148 ;
  wire \$149 ;
  wire \$150 ;
  wire \$151 ;
  wire \$152 ;
  wire \$153 ;
  wire \$154 ;
  wire \$155 ;
  wire \$156 ;
  wire \$157 ;
  wire \$158 ;
  wire \$159 ;
  wire \$16 ;
  wire \$160 ;
  wire \$161 ;
  wire \$162 ;
  wire \$163 ;
  wire \$164 ;
  wire \$165 ;
  wire \$166 ;
  wire \$167 ;
  wire \$168 ;
  wire \$169 ;
  wire \$17 ;
  wire \$170 ;
  wire \$171 ;
  wire \$172 ;
  wire \$173 ;
  wire \$174 ;
  wire \$175 ;
  wire \$176 ;
  wire \$177 ;
  wire \$178 ;
  wire \$179 ;
  wire \$180 ;
  wire \$181 ;
  wire \$182 ;
  wire \$183 ;
  wire \$184 ;
  wire \$185 ;
  wire \$186 ;
  wire \$187 ;
  wire \$188 ;
  wire \$189 ;
  wire \$19 ;
  wire \$190 ;
  wire \$191 ;
  wire [63:0] \$192 ;
  wire [7:0] \$193 ;
  wire [63:0] \$194 ;
  wire [7:0] \$195 ;
  wire \$199 ;
  wire \$200 ;
  wire \$201 ;
  wire \$202 ;
  wire \$203 ;
  wire \$204 ;
  wire \$205 ;
  wire [2:0] \$206 ;
  wire \$207 ;
  wire [2:0] \$208 ;
  wire \$209 ;
  wire [31:0] \$210 ;
  wire \$211 ;
  wire \$212 ;
  wire \$213 ;
  wire \$214 ;
  wire [63:0] \$215 ;
  wire [63:0] \$216 ;
  wire [63:0] \$217 ;
  wire [63:0] \$218 ;
  wire [63:0] \$219 ;
  wire \$22 ;
  wire [63:0] \$220 ;
  wire \$23 ;
  wire \$24 ;
  wire \$25 ;
  wire \$26 ;
  wire \$27 ;
  wire \$28 ;
  wire \$29 ;
  wire \$30 ;
  wire \$31 ;
  wire \$32 ;
  wire \$33 ;
  wire \$34 ;
  wire \$35 ;
  wire \$36 ;
  wire \$37 ;
  wire \$38 ;
  wire \$39 ;
  wire \$4 ;
  wire \$40 ;
  wire \$41 ;
  wire \$42 ;
  wire \$43 ;
  wire \$44 ;
  wire \$45 ;
  wire \$46 ;
  wire \$47 ;
  wire \$48 ;
  wire \$49 ;
  wire \$50 ;
  wire \$51 ;
  wire \$52 ;
  wire \$53 ;
  wire \$54 ;
  wire \$55 ;
  wire \$56 ;
  wire \$57 ;
  wire \$58 ;
  wire \$59 ;
  wire \$60 ;
  wire \$61 ;
  wire \$62 ;
  wire \$63 ;
  wire \$64 ;
  wire \$65 ;
  wire \$66 ;
  wire \$67 ;
  wire \$68 ;
  wire \$69 ;
  wire \$7 ;
  wire \$70 ;
  wire \$71 ;
  wire \$72 ;
  wire \$73 ;
  wire \$74 ;
  wire \$75 ;
  wire \$76 ;
  wire \$77 ;
  wire \$78 ;
  wire \$79 ;
  wire \$80 ;
  wire \$81 ;
  wire \$82 ;
  wire \$83 ;
  wire \$84 ;
  wire \$85 ;
  wire \$86 ;
  wire \$87 ;
  wire \$88 ;
  wire \$89 ;
  wire \$90 ;
  wire \$91 ;
  wire \$92 ;
  wire \$93 ;
  wire \$94 ;
  wire \$95 ;
  wire \$96 ;
  wire \$97 ;
  wire \$98 ;
  wire \$99 ;
  wire [2:0] choice_101_Y ;
  wire [63:0] choice_12_Y ;
  wire choice_139_Y ;
  wire choice_141_Y ;
  wire choice_143_Y ;
  wire choice_147_Y ;
  wire choice_149_Y ;
  wire choice_153_Y ;
  wire choice_155_Y ;
  wire choice_159_Y ;
  wire choice_161_Y ;
  wire choice_165_Y ;
  wire choice_167_Y ;
  wire choice_171_Y ;
  wire choice_173_Y ;
  wire choice_177_Y ;
  wire choice_179_Y ;
  wire [63:0] choice_17_Y ;
  wire [63:0] choice_22_Y ;
  wire [63:0] choice_27_Y ;
  wire [63:0] choice_2_Y ;
  wire choice_31_Y ;
  wire choice_35_Y ;
  wire choice_39_Y ;
  wire choice_43_Y ;
  wire [7:0] choice_47_Y ;
  wire [7:0] choice_49_Y ;
  wire [7:0] choice_51_Y ;
  wire [7:0] choice_53_Y ;
  wire [7:0] choice_57_Y ;
  wire [7:0] choice_59_Y ;
  wire [7:0] choice_61_Y ;
  wire [7:0] choice_63_Y ;
  wire [7:0] choice_67_Y ;
  wire [7:0] choice_69_Y ;
  wire [7:0] choice_71_Y ;
  wire [7:0] choice_73_Y ;
  wire [7:0] choice_77_Y ;
  wire [7:0] choice_79_Y ;
  wire [63:0] choice_7_Y ;
  wire [7:0] choice_81_Y ;
  wire [7:0] choice_83_Y ;
  wire choice_87_Y ;
  wire [2:0] choice_91_Y ;
  wire [2:0] choice_93_Y ;
  wire choice_97_Y ;
  input aclk;
  wire aclk;
  reg active_0 = 1'h0;
  reg active_1 = 1'h0;
  reg active_2 = 1'h0;
  reg active_3 = 1'h0;
  reg active_4 = 1'h0;
  reg active_5 = 1'h0;
  input [73:0] beat;
  wire [73:0] beat;
  (* unused_bits = "3" *)
  wire [3:0] \beat.at ;
  (* unused_bits = "0 1 2 3" *)
  wire [3:0] \beat.count ;
  wire [63:0] \beat.data ;
  (* unused_bits = "0" *)
  wire \beat.last ;
  wire \beat.valid ;
  wire blocked_0;
  wire blocked_1;
  wire blocked_2;
  wire blocked_3;
  wire blocked_4;
  wire blocked_5;
  reg [31:0] carried = 32'd0;
  reg cut_0 = 1'h0;
  reg cut_1 = 1'h0;
  reg cut_2 = 1'h0;
  reg cut_3 = 1'h0;
  reg cut_4 = 1'h0;
  reg ends_now = 1'h0;
  wire go_0;
  wire go_1;
  wire go_2;
  wire go_3;
  wire go_4;
  wire go_5;
  reg [7:0] items_good = 8'h00;
  reg [63:0] items_word = 64'h0000000000000000;
  wire [2:0] lane_0__items__addr;
  wire [7:0] lane_0__items__data;
  wire [2:0] lane_0__map__addr;
  wire [7:0] lane_0__map__data;
  wire [2:0] lane_0__write__addr;
  wire [7:0] lane_0__write__data;
  wire lane_0__write__en;
  wire [2:0] lane_1__items__addr;
  wire [7:0] lane_1__items__data;
  wire [2:0] lane_1__map__addr;
  wire [7:0] lane_1__map__data;
  wire [2:0] lane_1__write__addr;
  wire [7:0] lane_1__write__data;
  wire lane_1__write__en;
  wire [2:0] lane_2__items__addr;
  wire [7:0] lane_2__items__data;
  wire [2:0] lane_2__map__addr;
  wire [7:0] lane_2__map__data;
  wire [2:0] lane_2__write__addr;
  wire [7:0] lane_2__write__data;
  wire lane_2__write__en;
  wire [2:0] lane_3__items__addr;
  wire [7:0] lane_3__items__data;
  wire [2:0] lane_3__map__addr;
  wire [7:0] lane_3__map__data;
  wire [2:0] lane_3__write__addr;
  wire [7:0] lane_3__write__data;
  wire lane_3__write__en;
  wire [2:0] lane_4__items__addr;
  wire [7:0] lane_4__items__data;
  wire [2:0] lane_4__map__addr;
  wire [7:0] lane_4__map__data;
  wire [2:0] lane_4__write__addr;
  wire [7:0] lane_4__write__data;
  wire lane_4__write__en;
  wire [2:0] lane_5__items__addr;
  wire [7:0] lane_5__items__data;
  wire [2:0] lane_5__map__addr;
  wire [7:0] lane_5__map__data;
  wire [2:0] lane_5__write__addr;
  wire [7:0] lane_5__write__data;
  wire lane_5__write__en;
  wire [2:0] lane_6__items__addr;
  wire [7:0] lane_6__items__data;
  wire [2:0] lane_6__map__addr;
  wire [7:0] lane_6__map__data;
  wire [2:0] lane_6__write__addr;
  wire [7:0] lane_6__write__data;
  wire lane_6__write__en;
  wire [2:0] lane_7__items__addr;
  wire [7:0] lane_7__items__data;
  wire [2:0] lane_7__map__addr;
  wire [7:0] lane_7__map__data;
  wire [2:0] lane_7__write__addr;
  wire [7:0] lane_7__write__data;
  wire lane_7__write__en;
  reg [7:0] map_good = 8'h00;
  reg [63:0] map_word = 64'h0000000000000000;
  output [63:0] message__angular__x__payload;
  reg [63:0] message__angular__x__payload = 64'h0000000000000000;
  input message__angular__x__ready;
  wire message__angular__x__ready;
  output message__angular__x__valid;
  reg message__angular__x__valid = 1'h0;
  output [63:0] message__angular__y__payload;
  reg [63:0] message__angular__y__payload = 64'h0000000000000000;
  input message__angular__y__ready;
  wire message__angular__y__ready;
  output message__angular__y__valid;
  reg message__angular__y__valid = 1'h0;
  output [63:0] message__angular__z__payload;
  reg [63:0] message__angular__z__payload = 64'h0000000000000000;
  input message__angular__z__ready;
  wire message__angular__z__ready;
  output message__angular__z__valid;
  reg message__angular__z__valid = 1'h0;
  output [63:0] message__linear__x__payload;
  reg [63:0] message__linear__x__payload = 64'h0000000000000000;
  input message__linear__x__ready;
  wire message__linear__x__ready;
  output message__linear__x__valid;
  reg message__linear__x__valid = 1'h0;
  output [63:0] message__linear__y__payload;
  reg [63:0] message__linear__y__payload = 64'h0000000000000000;
  input message__linear__y__ready;
  wire message__linear__y__ready;
  output message__linear__y__valid;
  reg message__linear__y__valid = 1'h0;
  output [63:0] message__linear__z__payload;
  reg [63:0] message__linear__z__payload = 64'h0000000000000000;
  input message__linear__z__ready;
  wire message__linear__z__ready;
  output message__linear__z__valid;
  reg message__linear__z__valid = 1'h0;
  input [41:0] orders__payload;
  wire [41:0] orders__payload;
  wire \orders__payload.blank ;
  wire \orders__payload.ends ;
  (* unused_bits = "0" *)
  wire \orders__payload.final ;
  (* unused_bits = "0 1 2 3" *)
  wire [3:0] \orders__payload.first ;
  (* unused_bits = "0" *)
  wire \orders__payload.items ;
  (* unused_bits = "0 1 2" *)
  wire [5:0] \orders__payload.items_at ;
  wire [3:0] \orders__payload.items_bytes ;
  (* unused_bits = "0 1 2" *)
  wire [2:0] \orders__payload.items_next ;
  (* unused_bits = "0" *)
  wire \orders__payload.last ;
  (* unused_bits = "0" *)
  wire \orders__payload.length_good ;
  (* unused_bits = "0 1 2" *)
  wire [5:0] \orders__payload.map_at ;
  wire [3:0] \orders__payload.map_bytes ;
  (* unused_bits = "0 1 2" *)
  wire [2:0] \orders__payload.map_next ;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] \orders__payload.status ;
  wire [2:0] \orders__payload.step ;
  output orders__ready;
  wire orders__ready;
  input orders__valid;
  wire orders__valid;
  wire [63:0] payload_0;
  wire [63:0] payload_1;
  wire [63:0] payload_2;
  wire [63:0] payload_3;
  wire [63:0] payload_4;
  wire [63:0] payload_5;
  input rst;
  wire rst;
  reg slow = 1'h0;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  output [2:0] status__payload;
  reg [2:0] status__payload = 3'h0;
  input status__ready;
  wire status__ready;
  output status__valid;
  reg status__valid = 1'h0;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  reg [2:0] status_now = 3'h0;
  wire take;
  reg [7:0] lane_0 [7:0];
  initial begin
    lane_0[0] = 8'h00;
    lane_0[1] = 8'h00;
    lane_0[2] = 8'h00;
    lane_0[3] = 8'h00;
    lane_0[4] = 8'h00;
    lane_0[5] = 8'h00;
    lane_0[6] = 8'h00;
    lane_0[7] = 8'h00;
  end
  always @(posedge aclk) begin
    if (beat[73])
      lane_0[beat[71:69]] <= beat[7:0];
  end
  assign lane_0__map__data = lane_0[orders__payload[15:13]];
  assign lane_0__items__data = lane_0[orders__payload[9:7]];
  reg [7:0] lane_1 [7:0];
  initial begin
    lane_1[0] = 8'h00;
    lane_1[1] = 8'h00;
    lane_1[2] = 8'h00;
    lane_1[3] = 8'h00;
    lane_1[4] = 8'h00;
    lane_1[5] = 8'h00;
    lane_1[6] = 8'h00;
    lane_1[7] = 8'h00;
  end
  always @(posedge aclk) begin
    if (beat[73])
      lane_1[beat[71:69]] <= beat[15:8];
  end
  assign lane_1__map__data = lane_1[orders__payload[15:13]];
  assign lane_1__items__data = lane_1[orders__payload[9:7]];
  reg [7:0] lane_2 [7:0];
  initial begin
    lane_2[0] = 8'h00;
    lane_2[1] = 8'h00;
    lane_2[2] = 8'h00;
    lane_2[3] = 8'h00;
    lane_2[4] = 8'h00;
    lane_2[5] = 8'h00;
    lane_2[6] = 8'h00;
    lane_2[7] = 8'h00;
  end
  always @(posedge aclk) begin
    if (beat[73])
      lane_2[beat[71:69]] <= beat[23:16];
  end
  assign lane_2__map__data = lane_2[orders__payload[15:13]];
  assign lane_2__items__data = lane_2[orders__payload[9:7]];
  reg [7:0] lane_3 [7:0];
  initial begin
    lane_3[0] = 8'h00;
    lane_3[1] = 8'h00;
    lane_3[2] = 8'h00;
    lane_3[3] = 8'h00;
    lane_3[4] = 8'h00;
    lane_3[5] = 8'h00;
    lane_3[6] = 8'h00;
    lane_3[7] = 8'h00;
  end
  always @(posedge aclk) begin
    if (beat[73])
      lane_3[beat[71:69]] <= beat[31:24];
  end
  assign lane_3__map__data = lane_3[orders__payload[15:13]];
  assign lane_3__items__data = lane_3[orders__payload[9:7]];
  reg [7:0] lane_4 [7:0];
  initial begin
    lane_4[0] = 8'h00;
    lane_4[1] = 8'h00;
    lane_4[2] = 8'h00;
    lane_4[3] = 8'h00;
    lane_4[4] = 8'h00;
    lane_4[5] = 8'h00;
    lane_4[6] = 8'h00;
    lane_4[7] = 8'h00;
  end
  always @(posedge aclk) begin
    if (beat[73])
      lane_4[beat[71:69]] <= beat[39:32];
  end
  assign lane_4__map__data = lane_4[orders__payload[15:13]];
  assign lane_4__items__data = lane_4[orders__payload[9:7]];
  reg [7:0] lane_5 [7:0];
  initial begin
    lane_5[0] = 8'h00;
    lane_5[1] = 8'h00;
    lane_5[2] = 8'h00;
    lane_5[3] = 8'h00;
    lane_5[4] = 8'h00;
    lane_5[5] = 8'h00;
    lane_5[6] = 8'h00;
    lane_5[7] = 8'h00;
  end
  always @(posedge aclk) begin
    if (beat[73])
      lane_5[beat[71:69]] <= beat[47:40];
  end
  assign lane_5__map__data = lane_5[orders__payload[15:13]];
  assign lane_5__items__data = lane_5[orders__payload[9:7]];
  reg [7:0] lane_6 [7:0];
  initial begin
    lane_6[0] = 8'h00;
    lane_6[1] = 8'h00;
    lane_6[2] = 8'h00;
    lane_6[3] = 8'h00;
    lane_6[4] = 8'h00;
    lane_6[5] = 8'h00;
    lane_6[6] = 8'h00;
    lane_6[7] = 8'h00;
  end
  always @(posedge aclk) begin
    if (beat[73])
      lane_6[beat[71:69]] <= beat[55:48];
  end
  assign lane_6__map__data = lane_6[orders__payload[15:13]];
  assign lane_6__items__data = lane_6[orders__payload[9:7]];
  reg [7:0] lane_7 [7:0];
  initial begin
    lane_7[0] = 8'h00;
    lane_7[1] = 8'h00;
    lane_7[2] = 8'h00;
    lane_7[3] = 8'h00;
    lane_7[4] = 8'h00;
    lane_7[5] = 8'h00;
    lane_7[6] = 8'h00;
    lane_7[7] = 8'h00;
  end
  always @(posedge aclk) begin
    if (beat[73])
      lane_7[beat[71:69]] <= beat[63:56];
  end
  assign lane_7__map__data = lane_7[orders__payload[15:13]];
  assign lane_7__items__data = lane_7[orders__payload[9:7]];
  assign \$1  = ~ blocked_0;
  assign go_0 = active_0 & \$1 ;
  assign blocked_0 = active_0 & message__linear__x__valid;
  assign \$4  = ~ blocked_1;
  assign go_1 = active_1 & \$4 ;
  assign blocked_1 = active_1 & message__linear__y__valid;
  assign \$7  = ~ blocked_2;
  assign go_2 = active_2 & \$7 ;
  assign blocked_2 = active_2 & message__linear__z__valid;
  assign \$10  = ~ blocked_3;
  assign go_3 = active_3 & \$10 ;
  assign blocked_3 = active_3 & message__angular__x__valid;
  assign \$13  = ~ blocked_4;
  assign go_4 = active_4 & \$13 ;
  assign blocked_4 = active_4 & message__angular__y__valid;
  assign \$16  = ~ blocked_5;
  assign \$17  = active_5 & \$16 ;
  assign \$19  = ~ blocked_4;
  assign go_5 = \$17  & \$19 ;
  assign blocked_5 = active_5 & message__angular__z__valid;
  assign orders__ready = ~ slow;
  assign \$22  = orders__payload[25:22] > 1'h0;
  assign \$23  = orders__payload[25:22] > 1'h1;
  assign \$24  = orders__payload[25:22] > 2'h2;
  assign \$25  = orders__payload[25:22] > 2'h3;
  assign \$26  = orders__payload[25:22] > 3'h4;
  assign \$27  = orders__payload[25:22] > 3'h5;
  assign \$28  = orders__payload[25:22] > 3'h6;
  assign \$29  = orders__payload[25:22] > 3'h7;
  assign \$30  = orders__payload[29:26] > 1'h0;
  assign \$31  = orders__payload[29:26] > 1'h1;
  assign \$32  = orders__payload[29:26] > 2'h2;
  assign \$33  = orders__payload[29:26] > 2'h3;
  assign \$34  = orders__payload[29:26] > 3'h4;
  assign \$35  = orders__payload[29:26] > 3'h5;
  assign \$36  = orders__payload[29:26] > 3'h6;
  assign \$37  = orders__payload[29:26] > 3'h7;
  assign \$38  = ~ orders__payload[3];
  assign \$39  = orders__valid & \$38 ;
  assign \$40  = orders__payload[2:0] == 1'h1;
  assign \$41  = \$39  & \$40 ;
  assign \$42  = ~ go_0;
  assign \$43  = active_0 & \$42 ;
  assign \$44  = slow ? \$43  : \$41 ;
  assign \$45  = ~ orders__payload[3];
  assign \$46  = orders__valid & \$45 ;
  assign \$47  = orders__payload[2:0] == 2'h2;
  assign \$48  = \$46  & \$47 ;
  assign \$49  = ~ go_1;
  assign \$50  = active_1 & \$49 ;
  assign \$51  = slow ? \$50  : \$48 ;
  assign \$52  = ~ orders__payload[3];
  assign \$53  = orders__valid & \$52 ;
  assign \$54  = orders__payload[2:0] == 2'h3;
  assign \$55  = \$53  & \$54 ;
  assign \$56  = ~ go_2;
  assign \$57  = active_2 & \$56 ;
  assign \$58  = slow ? \$57  : \$55 ;
  assign \$59  = ~ orders__payload[3];
  assign \$60  = orders__valid & \$59 ;
  assign \$61  = orders__payload[2:0] == 3'h4;
  assign \$62  = \$60  & \$61 ;
  assign \$63  = ~ go_3;
  assign \$64  = active_3 & \$63 ;
  assign \$65  = slow ? \$64  : \$62 ;
  assign \$66  = ~ orders__payload[3];
  assign \$67  = orders__valid & \$66 ;
  assign \$68  = orders__payload[2:0] == 3'h5;
  assign \$69  = \$67  & \$68 ;
  assign \$70  = ~ go_4;
  assign \$71  = active_4 & \$70 ;
  assign \$72  = slow ? \$71  : \$69 ;
  assign \$73  = ~ orders__payload[3];
  assign \$74  = orders__valid & \$73 ;
  assign \$75  = orders__payload[2:0] == 3'h5;
  assign \$76  = \$74  & \$75 ;
  assign \$77  = ~ go_5;
  assign \$78  = active_5 & \$77 ;
  assign \$79  = slow ? \$78  : \$76 ;
  assign \$80  = ~ orders__payload[3];
  assign \$81  = orders__valid & \$80 ;
  assign \$82  = orders__payload[2:0] == 1'h1;
  assign \$83  = \$81  & \$82 ;
  assign \$84  = ~ message__linear__x__ready;
  assign \$85  = message__linear__x__valid & \$84 ;
  assign \$86  = \$83  & \$85 ;
  assign \$87  = ~ orders__payload[3];
  assign \$88  = orders__valid & \$87 ;
  assign \$89  = orders__payload[2:0] == 2'h2;
  assign \$90  = \$88  & \$89 ;
  assign \$91  = ~ message__linear__y__ready;
  assign \$92  = message__linear__y__valid & \$91 ;
  assign \$93  = \$90  & \$92 ;
  assign \$94  = ~ orders__payload[3];
  assign \$95  = orders__valid & \$94 ;
  assign \$96  = orders__payload[2:0] == 2'h3;
  assign \$97  = \$95  & \$96 ;
  assign \$98  = ~ message__linear__z__ready;
  assign \$99  = message__linear__z__valid & \$98 ;
  assign \$100  = \$97  & \$99 ;
  assign \$101  = ~ orders__payload[3];
  assign \$102  = orders__valid & \$101 ;
  assign \$103  = orders__payload[2:0] == 3'h4;
  assign \$104  = \$102  & \$103 ;
  assign \$105  = ~ message__angular__x__ready;
  assign \$106  = message__angular__x__valid & \$105 ;
  assign \$107  = \$104  & \$106 ;
  assign \$108  = ~ orders__payload[3];
  assign \$109  = orders__valid & \$108 ;
  assign \$110  = orders__payload[2:0] == 3'h5;
  assign \$111  = \$109  & \$110 ;
  assign \$112  = ~ message__angular__y__ready;
  assign \$113  = message__angular__y__valid & \$112 ;
  assign \$114  = \$111  & \$113 ;
  assign \$115  = ~ orders__payload[3];
  assign \$116  = orders__valid & \$115 ;
  assign \$117  = orders__payload[2:0] == 3'h5;
  assign \$118  = \$116  & \$117 ;
  assign \$119  = ~ message__angular__z__ready;
  assign \$120  = message__angular__z__valid & \$119 ;
  assign \$121  = \$118  & \$120 ;
  assign \$122  = orders__valid & orders__payload[38];
  assign \$123  = ~ status__ready;
  assign \$124  = status__valid & \$123 ;
  assign \$125  = \$122  & \$124 ;
  assign \$126  = | { \$125 , \$121 , \$114 , \$107 , \$100 , \$93 , \$86  };
  assign \$127  = ~ message__linear__x__ready;
  assign \$128  = blocked_0 & \$127 ;
  assign \$129  = ~ message__linear__y__ready;
  assign \$130  = blocked_1 & \$129 ;
  assign \$131  = ~ message__linear__z__ready;
  assign \$132  = blocked_2 & \$131 ;
  assign \$133  = ~ message__angular__x__ready;
  assign \$134  = blocked_3 & \$133 ;
  assign \$135  = ~ message__angular__y__ready;
  assign \$136  = blocked_4 & \$135 ;
  assign \$137  = ~ message__angular__z__ready;
  assign \$138  = blocked_5 & \$137 ;
  assign \$139  = ~ status__ready;
  assign \$140  = status__valid & \$139 ;
  assign \$141  = ends_now & \$140 ;
  assign \$142  = | { \$141 , \$138 , \$136 , \$134 , \$132 , \$130 , \$128  };
  assign \$143  = slow ? \$142  : \$126 ;
  assign \$144  = orders__valid & orders__payload[38];
  assign \$145  = ~ orders__payload[3];
  assign \$146  = ! orders__payload[2:0];
  assign \$147  = \$145  & \$146 ;
  assign \$148  = orders__valid & \$147 ;
  assign \$149  = orders__ready & cut_0;
  assign \$150  = orders__ready & cut_0;
  assign \$151  = orders__ready & cut_0;
  assign \$152  = orders__ready & cut_0;
  assign \$153  = ~ orders__payload[3];
  assign \$154  = orders__payload[2:0] == 1'h1;
  assign \$155  = \$153  & \$154 ;
  assign \$156  = orders__valid & \$155 ;
  assign \$157  = orders__ready & cut_1;
  assign \$158  = orders__ready & cut_1;
  assign \$159  = orders__ready & cut_1;
  assign \$160  = orders__ready & cut_1;
  assign \$161  = ~ orders__payload[3];
  assign \$162  = orders__payload[2:0] == 2'h2;
  assign \$163  = \$161  & \$162 ;
  assign \$164  = orders__valid & \$163 ;
  assign \$165  = orders__ready & cut_2;
  assign \$166  = orders__ready & cut_2;
  assign \$167  = orders__ready & cut_2;
  assign \$168  = orders__ready & cut_2;
  assign \$169  = ~ orders__payload[3];
  assign \$170  = orders__payload[2:0] == 2'h3;
  assign \$171  = \$169  & \$170 ;
  assign \$172  = orders__valid & \$171 ;
  assign \$173  = orders__ready & cut_3;
  assign \$174  = orders__ready & cut_3;
  assign \$175  = orders__ready & cut_3;
  assign \$176  = orders__ready & cut_3;
  assign \$177  = ~ orders__payload[3];
  assign \$178  = orders__payload[2:0] == 3'h4;
  assign \$179  = \$177  & \$178 ;
  assign \$180  = orders__valid & \$179 ;
  assign \$181  = orders__ready & cut_4;
  assign \$182  = orders__ready & cut_4;
  assign \$183  = orders__ready & cut_4;
  assign \$184  = orders__ready & cut_4;
  always @(posedge aclk)
    message__linear__x__valid <= \$185 ;
  always @(posedge aclk)
    message__linear__y__valid <= \$186 ;
  always @(posedge aclk)
    message__linear__z__valid <= \$187 ;
  always @(posedge aclk)
    message__angular__x__valid <= \$188 ;
  always @(posedge aclk)
    message__angular__y__valid <= \$189 ;
  always @(posedge aclk)
    message__angular__z__valid <= \$190 ;
  always @(posedge aclk)
    status__valid <= \$191 ;
  always @(posedge aclk)
    items_word <= \$192 ;
  always @(posedge aclk)
    items_good <= \$193 ;
  always @(posedge aclk)
    map_word <= \$194 ;
  always @(posedge aclk)
    map_good <= \$195 ;
  always @(posedge aclk)
    active_0 <= \$199 ;
  always @(posedge aclk)
    active_1 <= \$200 ;
  always @(posedge aclk)
    active_2 <= \$201 ;
  always @(posedge aclk)
    active_3 <= \$202 ;
  always @(posedge aclk)
    active_4 <= \$203 ;
  always @(posedge aclk)
    active_5 <= \$204 ;
  always @(posedge aclk)
    slow <= \$205 ;
  always @(posedge aclk)
    status_now <= \$206 ;
  always @(posedge aclk)
    ends_now <= \$207 ;
  always @(posedge aclk)
    status__payload <= \$208 ;
  always @(posedge aclk)
    cut_0 <= \$209 ;
  always @(posedge aclk)
    carried <= \$210 ;
  always @(posedge aclk)
    cut_1 <= \$211 ;
  always @(posedge aclk)
    cut_2 <= \$212 ;
  always @(posedge aclk)
    cut_3 <= \$213 ;
  always @(posedge aclk)
    cut_4 <= \$214 ;
  always @(posedge aclk)
    message__linear__x__payload <= \$215 ;
  always @(posedge aclk)
    message__linear__y__payload <= \$216 ;
  always @(posedge aclk)
    message__linear__z__payload <= \$217 ;
  always @(posedge aclk)
    message__angular__x__payload <= \$218 ;
  always @(posedge aclk)
    message__angular__y__payload <= \$219 ;
  always @(posedge aclk)
    message__angular__z__payload <= \$220 ;
  assign choice_101_Y  = slow ? status_now : orders__payload[41:39];
  assign \$206  = rst ? 3'h0 : choice_101_Y ;
  assign \$205  = rst ? 1'h0 : \$143 ;
  assign \$204  = rst ? 1'h0 : \$79 ;
  assign \$203  = rst ? 1'h0 : \$72 ;
  assign \$202  = rst ? 1'h0 : \$65 ;
  assign \$201  = rst ? 1'h0 : \$58 ;
  assign \$200  = rst ? 1'h0 : \$51 ;
  assign \$199  = rst ? 1'h0 : \$44 ;
  assign choice_12_Y  = map_good[3] ? (* full_case = 32'd1 *) { map_word[31:0], carried } : 64'h0000000000000000;
  assign \$195  = slow ? map_good : { \$37 , \$36 , \$35 , \$34 , \$33 , \$32 , \$31 , \$30  };
  assign \$194  = slow ? map_word : { lane_7__map__data, lane_6__map__data, lane_5__map__data, lane_4__map__data, lane_3__map__data, lane_2__map__data, lane_1__map__data, lane_0__map__data };
  assign \$193  = slow ? items_good : { \$29 , \$28 , \$27 , \$26 , \$25 , \$24 , \$23 , \$22  };
  assign \$192  = slow ? items_word : { lane_7__items__data, lane_6__items__data, lane_5__items__data, lane_4__items__data, lane_3__items__data, lane_2__items__data, lane_1__items__data, lane_0__items__data };
  assign choice_139_Y  = status__ready ? 1'h0 : status__valid;
  assign \$218  = go_3 ? choice_12_Y  : message__angular__x__payload;
  assign choice_141_Y  = ends_now ? 1'h1 : choice_139_Y ;
  assign choice_143_Y  = slow ? choice_139_Y  : choice_141_Y ;
  assign \$191  = rst ? 1'h0 : choice_143_Y ;
  assign choice_147_Y  = message__angular__z__ready ? 1'h0 : message__angular__z__valid;
  assign choice_149_Y  = go_5 ? 1'h1 : choice_147_Y ;
  assign \$190  = rst ? 1'h0 : choice_149_Y ;
  assign choice_153_Y  = message__angular__y__ready ? 1'h0 : message__angular__y__valid;
  assign choice_155_Y  = go_4 ? 1'h1 : choice_153_Y ;
  assign \$189  = rst ? 1'h0 : choice_155_Y ;
  assign choice_159_Y  = message__angular__x__ready ? 1'h0 : message__angular__x__valid;
  assign choice_161_Y  = go_3 ? 1'h1 : choice_159_Y ;
  assign \$188  = rst ? 1'h0 : choice_161_Y ;
  assign choice_165_Y  = message__linear__z__ready ? 1'h0 : message__linear__z__valid;
  assign choice_167_Y  = go_2 ? 1'h1 : choice_165_Y ;
  assign \$187  = rst ? 1'h0 : choice_167_Y ;
  assign choice_17_Y  = map_good[3] ? (* full_case = 32'd1 *) { map_word[31:0], carried } : 64'h0000000000000000;
  assign choice_171_Y  = message__linear__y__ready ? 1'h0 : message__linear__y__valid;
  assign choice_173_Y  = go_1 ? 1'h1 : choice_171_Y ;
  assign \$186  = rst ? 1'h0 : choice_173_Y ;
  assign choice_177_Y  = message__linear__x__ready ? 1'h0 : message__linear__x__valid;
  assign choice_179_Y  = go_0 ? 1'h1 : choice_177_Y ;
  assign \$185  = rst ? 1'h0 : choice_179_Y ;
  assign \$217  = go_2 ? choice_17_Y  : message__linear__z__payload;
  assign choice_2_Y  = map_good[3] ? (* full_case = 32'd1 *) { map_word[31:0], items_word[63:32] } : 64'h0000000000000000;
  assign choice_22_Y  = map_good[3] ? (* full_case = 32'd1 *) { map_word[31:0], carried } : 64'h0000000000000000;
  assign \$216  = go_1 ? choice_22_Y  : message__linear__y__payload;
  assign choice_27_Y  = map_good[3] ? (* full_case = 32'd1 *) { map_word[31:0], carried } : 64'h0000000000000000;
  assign \$215  = go_0 ? choice_27_Y  : message__linear__x__payload;
  assign choice_31_Y  = slow ? cut_4 : \$180 ;
  assign \$214  = rst ? 1'h0 : choice_31_Y ;
  assign choice_35_Y  = slow ? cut_3 : \$172 ;
  assign \$213  = rst ? 1'h0 : choice_35_Y ;
  assign choice_39_Y  = slow ? cut_2 : \$164 ;
  assign \$220  = go_5 ? choice_2_Y  : message__angular__z__payload;
  assign \$212  = rst ? 1'h0 : choice_39_Y ;
  assign choice_43_Y  = slow ? cut_1 : \$156 ;
  assign \$211  = rst ? 1'h0 : choice_43_Y ;
  assign choice_47_Y  = \$152  ? map_word[63:56] : carried[31:24];
  assign choice_49_Y  = \$160  ? map_word[63:56] : choice_47_Y ;
  assign choice_51_Y  = \$168  ? map_word[63:56] : choice_49_Y ;
  assign choice_53_Y  = \$176  ? map_word[63:56] : choice_51_Y ;
  assign \$210 [31:24] = \$184  ? map_word[63:56] : choice_53_Y ;
  assign choice_57_Y  = \$151  ? map_word[55:48] : carried[23:16];
  assign choice_59_Y  = \$159  ? map_word[55:48] : choice_57_Y ;
  assign choice_61_Y  = \$167  ? map_word[55:48] : choice_59_Y ;
  assign choice_63_Y  = \$175  ? map_word[55:48] : choice_61_Y ;
  assign \$210 [23:16] = \$183  ? map_word[55:48] : choice_63_Y ;
  assign choice_67_Y  = \$150  ? map_word[47:40] : carried[15:8];
  assign choice_69_Y  = \$158  ? map_word[47:40] : choice_67_Y ;
  assign choice_7_Y  = items_good[3] ? (* full_case = 32'd1 *) { items_word[31:0], carried } : 64'h0000000000000000;
  assign choice_71_Y  = \$166  ? map_word[47:40] : choice_69_Y ;
  assign choice_73_Y  = \$174  ? map_word[47:40] : choice_71_Y ;
  assign \$210 [15:8] = \$182  ? map_word[47:40] : choice_73_Y ;
  assign choice_77_Y  = \$149  ? map_word[39:32] : carried[7:0];
  assign choice_79_Y  = \$157  ? map_word[39:32] : choice_77_Y ;
  assign choice_81_Y  = \$165  ? map_word[39:32] : choice_79_Y ;
  assign choice_83_Y  = \$173  ? map_word[39:32] : choice_81_Y ;
  assign \$210 [7:0] = \$181  ? map_word[39:32] : choice_83_Y ;
  assign choice_87_Y  = slow ? cut_0 : \$148 ;
  assign \$209  = rst ? 1'h0 : choice_87_Y ;
  assign \$219  = go_4 ? choice_7_Y  : message__angular__y__payload;
  assign choice_91_Y  = ends_now ? status_now : status__payload;
  assign choice_93_Y  = slow ? status__payload : choice_91_Y ;
  assign \$208  = rst ? 3'h0 : choice_93_Y ;
  assign choice_97_Y  = slow ? ends_now : \$144 ;
  assign \$207  = rst ? 1'h0 : choice_97_Y ;
  assign \orders__payload.status  = orders__payload[41:39];
  assign \orders__payload.ends  = orders__payload[38];
  assign \orders__payload.first  = orders__payload[37:34];
  assign \orders__payload.final  = orders__payload[33];
  assign \orders__payload.length_good  = orders__payload[32];
  assign \orders__payload.last  = orders__payload[31];
  assign \orders__payload.items  = orders__payload[30];
  assign \orders__payload.map_bytes  = orders__payload[29:26];
  assign \orders__payload.items_bytes  = orders__payload[25:22];
  assign \orders__payload.map_next  = orders__payload[21:19];
  assign \orders__payload.items_next  = orders__payload[18:16];
  assign \orders__payload.map_at  = orders__payload[15:10];
  assign \orders__payload.items_at  = orders__payload[9:4];
  assign \orders__payload.blank  = orders__payload[3];
  assign \orders__payload.step  = orders__payload[2:0];
  assign \beat.valid  = beat[73];
  assign \beat.at  = beat[72:69];
  assign \beat.last  = beat[68];
  assign \beat.count  = beat[67:64];
  assign \beat.data  = beat[63:0];
  assign lane_7__map__addr = orders__payload[15:13];
  assign lane_7__items__addr = orders__payload[9:7];
  assign lane_7__write__en = beat[73];
  assign lane_7__write__data = beat[63:56];
  assign lane_7__write__addr = beat[71:69];
  assign lane_6__map__addr = orders__payload[15:13];
  assign lane_6__items__addr = orders__payload[9:7];
  assign lane_6__write__en = beat[73];
  assign lane_6__write__data = beat[55:48];
  assign lane_6__write__addr = beat[71:69];
  assign lane_5__map__addr = orders__payload[15:13];
  assign lane_5__items__addr = orders__payload[9:7];
  assign lane_5__write__en = beat[73];
  assign lane_5__write__data = beat[47:40];
  assign lane_5__write__addr = beat[71:69];
  assign lane_4__map__addr = orders__payload[15:13];
  assign lane_4__items__addr = orders__payload[9:7];
  assign lane_4__write__en = beat[73];
  assign lane_4__write__data = beat[39:32];
  assign lane_4__write__addr = beat[71:69];
  assign lane_3__map__addr = orders__payload[15:13];
  assign lane_3__items__addr = orders__payload[9:7];
  assign lane_3__write__en = beat[73];
  assign lane_3__write__data = beat[31:24];
  assign lane_3__write__addr = beat[71:69];
  assign lane_2__map__addr = orders__payload[15:13];
  assign lane_2__items__addr = orders__payload[9:7];
  assign lane_2__write__en = beat[73];
  assign lane_2__write__data = beat[23:16];
  assign lane_2__write__addr = beat[71:69];
  assign lane_1__map__addr = orders__payload[15:13];
  assign lane_1__items__addr = orders__payload[9:7];
  assign lane_1__write__en = beat[73];
  assign lane_1__write__data = beat[15:8];
  assign lane_1__write__addr = beat[71:69];
  assign lane_0__map__addr = orders__payload[15:13];
  assign lane_0__items__addr = orders__payload[9:7];
  assign lane_0__write__en = beat[73];
  assign lane_0__write__data = beat[7:0];
  assign lane_0__write__addr = beat[71:69];
  assign payload_5 = message__angular__z__payload;
  assign payload_4 = message__angular__y__payload;
  assign payload_3 = message__angular__x__payload;
  assign payload_2 = message__linear__z__payload;
  assign payload_1 = message__linear__y__payload;
  assign payload_0 = message__linear__x__payload;
  assign take = orders__ready;
endmodule

module \geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.core.queue (rst, i__valid, i__ready, freed, o__ready, i__payload, oldest, o__valid, o__payload, aclk);
  wire [3:0] \$1 ;
  wire \$2 ;
  wire [41:0] \$3 ;
  wire \$5 ;
  wire [41:0] \$6 ;
  wire \$7 ;
  wire [41:0] \$8 ;
  wire choice_185_Y ;
  wire choice_187_Y ;
  wire [41:0] choice_191_Y ;
  wire choice_195_Y ;
  input aclk;
  wire aclk;
  output [3:0] freed;
  wire [3:0] freed;
  reg has_second = 1'h0;
  input [41:0] i__payload;
  wire [41:0] i__payload;
  wire \i__payload.blank ;
  wire \i__payload.ends ;
  wire \i__payload.final ;
  wire [3:0] \i__payload.first ;
  wire \i__payload.items ;
  wire [5:0] \i__payload.items_at ;
  wire [3:0] \i__payload.items_bytes ;
  wire [2:0] \i__payload.items_next ;
  wire \i__payload.last ;
  wire \i__payload.length_good ;
  wire [5:0] \i__payload.map_at ;
  wire [3:0] \i__payload.map_bytes ;
  wire [2:0] \i__payload.map_next ;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] \i__payload.status ;
  wire [2:0] \i__payload.step ;
  output i__ready;
  wire i__ready;
  input i__valid;
  wire i__valid;
  output [41:0] o__payload;
  reg [41:0] o__payload = 42'h00000000000;
  wire \o__payload.blank ;
  wire \o__payload.ends ;
  wire \o__payload.final ;
  wire [3:0] \o__payload.first ;
  wire \o__payload.items ;
  wire [5:0] \o__payload.items_at ;
  wire [3:0] \o__payload.items_bytes ;
  wire [2:0] \o__payload.items_next ;
  wire \o__payload.last ;
  wire \o__payload.length_good ;
  wire [5:0] \o__payload.map_at ;
  wire [3:0] \o__payload.map_bytes ;
  wire [2:0] \o__payload.map_next ;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] \o__payload.status ;
  wire [2:0] \o__payload.step ;
  input o__ready;
  wire o__ready;
  output o__valid;
  reg o__valid = 1'h0;
  input [3:0] oldest;
  wire [3:0] oldest;
  input rst;
  wire rst;
  reg [41:0] second = 42'h00000000000;
  wire \second.blank ;
  wire \second.ends ;
  wire \second.final ;
  wire [3:0] \second.first ;
  wire \second.items ;
  wire [5:0] \second.items_at ;
  wire [3:0] \second.items_bytes ;
  wire [2:0] \second.items_next ;
  wire \second.last ;
  wire \second.length_good ;
  wire [5:0] \second.map_at ;
  wire [3:0] \second.map_bytes ;
  wire [2:0] \second.map_next ;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] \second.status ;
  wire [2:0] \second.step ;
  assign \$1  = has_second ? second[37:34] : oldest;
  assign freed = o__valid ? o__payload[37:34] : \$1 ;
  assign \$2  = i__valid | has_second;
  assign \$3  = has_second ? second : i__payload;
  always @(posedge aclk)
    o__valid <= \$5 ;
  always @(posedge aclk)
    o__payload <= \$6 ;
  always @(posedge aclk)
    has_second <= \$7 ;
  always @(posedge aclk)
    second <= \$8 ;
  assign i__ready = ~ has_second;
  assign \$8  = has_second ? second : i__payload;
  assign choice_185_Y  = i__valid ? 1'h1 : has_second;
  assign choice_187_Y  = o__ready ? 1'h0 : choice_185_Y ;
  assign \$7  = rst ? 1'h0 : choice_187_Y ;
  assign choice_191_Y  = o__ready ? \$3  : o__payload;
  assign \$6  = rst ? 42'h00000000000 : choice_191_Y ;
  assign choice_195_Y  = o__ready ? \$2  : o__valid;
  assign \$5  = rst ? 1'h0 : choice_195_Y ;
  assign \i__payload.status  = i__payload[41:39];
  assign \i__payload.ends  = i__payload[38];
  assign \i__payload.first  = i__payload[37:34];
  assign \i__payload.final  = i__payload[33];
  assign \i__payload.length_good  = i__payload[32];
  assign \i__payload.last  = i__payload[31];
  assign \i__payload.items  = i__payload[30];
  assign \i__payload.map_bytes  = i__payload[29:26];
  assign \i__payload.items_bytes  = i__payload[25:22];
  assign \i__payload.map_next  = i__payload[21:19];
  assign \i__payload.items_next  = i__payload[18:16];
  assign \i__payload.map_at  = i__payload[15:10];
  assign \i__payload.items_at  = i__payload[9:4];
  assign \i__payload.blank  = i__payload[3];
  assign \i__payload.step  = i__payload[2:0];
  assign \o__payload.status  = o__payload[41:39];
  assign \o__payload.ends  = o__payload[38];
  assign \o__payload.first  = o__payload[37:34];
  assign \o__payload.final  = o__payload[33];
  assign \o__payload.length_good  = o__payload[32];
  assign \o__payload.last  = o__payload[31];
  assign \o__payload.items  = o__payload[30];
  assign \o__payload.map_bytes  = o__payload[29:26];
  assign \o__payload.items_bytes  = o__payload[25:22];
  assign \o__payload.map_next  = o__payload[21:19];
  assign \o__payload.items_next  = o__payload[18:16];
  assign \o__payload.map_at  = o__payload[15:10];
  assign \o__payload.items_at  = o__payload[9:4];
  assign \o__payload.blank  = o__payload[3];
  assign \o__payload.step  = o__payload[2:0];
  assign \second.status  = second[41:39];
  assign \second.ends  = second[38];
  assign \second.first  = second[37:34];
  assign \second.final  = second[33];
  assign \second.length_good  = second[32];
  assign \second.last  = second[31];
  assign \second.items  = second[30];
  assign \second.map_bytes  = second[29:26];
  assign \second.items_bytes  = second[25:22];
  assign \second.map_next  = second[21:19];
  assign \second.items_next  = second[18:16];
  assign \second.map_at  = second[15:10];
  assign \second.items_at  = second[9:4];
  assign \second.blank  = second[3];
  assign \second.step  = second[2:0];
endmodule

module \geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.core.sequencer (rst, orders__valid, next_sig, orders__ready, beat, limit, following, ended, orders__payload, header_at, aclk);
  (* unused_bits = "7" *)
  wire [7:0] \$1 ;
  wire \$100 ;
  wire \$101 ;
  wire \$102 ;
  wire \$103 ;
  wire \$104 ;
  wire \$105 ;
  wire \$106 ;
  wire \$107 ;
  wire \$108 ;
  wire \$109 ;
  (* unused_bits = "7 8" *)
  wire [8:0] \$11 ;
  wire \$110 ;
  (* unused_bits = "3" *)
  wire [3:0] \$111 ;
  (* unused_bits = "3" *)
  wire [3:0] \$112 ;
  wire \$113 ;
  wire \$114 ;
  wire \$115 ;
  wire [3:0] \$116 ;
  wire [3:0] \$117 ;
  (* unused_bits = "4" *)
  wire [4:0] \$12 ;
  wire \$124 ;
  wire [2:0] \$129 ;
  wire [2:0] \$130 ;
  wire \$14 ;
  (* unused_bits = "7" *)
  wire [7:0] \$140 ;
  wire [7:0] \$146 ;
  (* unused_bits = "7" *)
  wire [7:0] \$154 ;
  wire \$159 ;
  wire \$167 ;
  wire \$168 ;
  wire \$169 ;
  wire \$170 ;
  wire \$171 ;
  wire \$18 ;
  wire \$181 ;
  wire \$182 ;
  wire \$183 ;
  wire \$184 ;
  wire \$185 ;
  wire [2:0] \$191 ;
  wire [2:0] \$192 ;
  wire [2:0] \$194 ;
  wire \$195 ;
  wire \$196 ;
  wire \$197 ;
  wire [2:0] \$198 ;
  wire [3:0] \$199 ;
  wire [6:0] \$2 ;
  wire \$20 ;
  wire \$206 ;
  wire [3:0] \$207 ;
  wire [3:0] \$208 ;
  wire [3:0] \$210 ;
  wire \$211 ;
  wire \$212 ;
  wire \$213 ;
  wire [3:0] \$214 ;
  wire [3:0] \$215 ;
  wire \$216 ;
  wire \$217 ;
  wire [3:0] \$218 ;
  wire [3:0] \$219 ;
  wire \$220 ;
  wire [3:0] \$221 ;
  wire [3:0] \$222 ;
  wire \$23 ;
  wire \$25 ;
  wire \$256 ;
  wire \$258 ;
  wire \$259 ;
  wire \$263 ;
  wire \$274 ;
  wire \$275 ;
  wire [6:0] \$276 ;
  wire [6:0] \$277 ;
  wire [6:0] \$278 ;
  wire \$279 ;
  wire \$280 ;
  wire [2:0] \$281 ;
  wire [3:0] \$282 ;
  wire [3:0] \$283 ;
  wire \$284 ;
  wire [6:0] \$286 ;
  wire [4:0] \$287 ;
  wire \$288 ;
  wire \$289 ;
  wire [6:0] \$29 ;
  wire [5:0] \$290 ;
  wire [6:0] \$293 ;
  wire [6:0] \$294 ;
  (* unused_bits = "0 1 7" *)
  wire [7:0] \$3 ;
  wire [6:0] \$37 ;
  wire [5:0] \$38 ;
  (* unused_bits = "0 1 2 3 4" *)
  wire [5:0] \$39 ;
  wire [6:0] \$46 ;
  wire [6:0] \$47 ;
  wire [6:0] \$55 ;
  wire [5:0] \$56 ;
  (* unused_bits = "0 1 2 3 4" *)
  wire [5:0] \$57 ;
  wire [6:0] \$64 ;
  wire [6:0] \$65 ;
  wire [6:0] \$66 ;
  wire [5:0] \$74 ;
  (* unused_bits = "0 1 2 3 4" *)
  wire [5:0] \$75 ;
  wire [6:0] \$82 ;
  (* unused_bits = "6" *)
  wire [6:0] \$83 ;
  (* unused_bits = "7" *)
  wire [7:0] \$84 ;
  wire \$85 ;
  wire \$86 ;
  wire \$87 ;
  wire \$88 ;
  wire \$89 ;
  wire \$90 ;
  wire \$91 ;
  wire \$99 ;
  wire [6:0] choice_199_Y ;
  wire [6:0] choice_203_Y ;
  wire [5:0] choice_224_Y ;
  wire [5:0] choice_226_Y ;
  wire choice_233_Y ;
  wire choice_235_Y ;
  wire choice_242_Y ;
  wire choice_244_Y ;
  wire [4:0] choice_251_Y ;
  wire [4:0] choice_253_Y ;
  wire [6:0] choice_260_Y ;
  wire [6:0] choice_262_Y ;
  wire [3:0] choice_270_Y ;
  wire [3:0] choice_272_Y ;
  wire [3:0] choice_274_Y ;
  wire [3:0] choice_278_Y ;
  wire [3:0] choice_280_Y ;
  wire [3:0] choice_282_Y ;
  wire [2:0] choice_286_Y ;
  wire choice_290_Y ;
  wire choice_292_Y ;
  wire choice_296_Y ;
  wire choice_298_Y ;
  input aclk;
  wire aclk;
  wire allowed;
  reg at_end = 1'h0;
  reg bad = 1'h0;
  input [73:0] beat;
  wire [73:0] beat;
  wire [73:0] \beat$26 ;
  wire [3:0] \beat$26.at ;
  wire [3:0] \beat$26.count ;
  wire [63:0] \beat$26.data ;
  wire \beat$26.last ;
  wire \beat$26.valid ;
  wire [3:0] \beat.at ;
  wire [3:0] \beat.count ;
  wire [63:0] \beat.data ;
  wire \beat.last ;
  wire \beat.valid ;
  wire begins;
  wire [5:0] body_amount;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  reg [2:0] code = 3'h0;
  wire cut;
  wire default_0;
  wire default_1;
  wire default_2;
  wire default_3;
  wire default_4;
  wire default_5;
  wire done;
  wire drains;
  wire [6:0] early_last;
  input ended;
  wire ended;
  wire ends_message;
  wire ends_packet;
  reg [5:0] exit_add = 6'h08;
  wire [5:0] exit_amount;
  wire [6:0] exit_sum;
  wire exits_always;
  reg [6:0] first_at = 7'h00;
  input [3:0] following;
  wire [3:0] following;
  wire good;
  output [3:0] header_at;
  wire [3:0] header_at;
  wire issue;
  (* unused_bits = "0 1 2 3 4 5 6" *)
  wire [6:0] items_at;
  reg [3:0] items_room = 4'h0;
  wire [3:0] items_wanted;
  reg [6:0] last_at = 7'h07;
  (* unused_bits = "0 1" *)
  wire [6:0] left;
  input [6:0] limit;
  wire [6:0] limit;
  wire [6:0] map_at;
  wire [6:0] map_left;
  reg [4:0] map_offset = 5'h19;
  reg [3:0] map_room = 4'h0;
  wire mismatch;
  wire \mismatch$36 ;
  reg new_error = 1'h0;
  wire [6:0] next_last;
  (* unused_bits = "0 1 2 3 4 5 6" *)
  wire [6:0] next_packet;
  output next_sig;
  wire next_sig;
  wire nonzero;
  wire [6:0] nul_at;
  wire [6:0] \nul_at$28 ;
  wire [3:0] oldest;
  output [41:0] orders__payload;
  wire [41:0] orders__payload;
  wire \orders__payload.blank ;
  wire \orders__payload.ends ;
  wire \orders__payload.final ;
  wire [3:0] \orders__payload.first ;
  wire \orders__payload.items ;
  wire [5:0] \orders__payload.items_at ;
  wire [3:0] \orders__payload.items_bytes ;
  wire [2:0] \orders__payload.items_next ;
  wire \orders__payload.last ;
  wire \orders__payload.length_good ;
  wire [5:0] \orders__payload.map_at ;
  wire [3:0] \orders__payload.map_bytes ;
  wire [2:0] \orders__payload.map_next ;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] \orders__payload.status ;
  wire [2:0] \orders__payload.step ;
  input orders__ready;
  wire orders__ready;
  output orders__valid;
  wire orders__valid;
  wire present;
  input rst;
  wire rst;
  reg [6:0] step = 7'h01;
  wire [6:0] step_end;
  wire step_to_body;
  wire [5:0] tail;
  (* unused_bits = "0 1 2 3 4 5 6" *)
  wire [6:0] to_body_low;
  (* unused_bits = "0 1 2" *)
  wire [2:0] to_body_mask;
  wire to_body_rest;
  (* unused_bits = "0 1 2 3 4 5 6" *)
  wire [6:0] to_exit_low;
  wire [2:0] to_exit_mask;
  wire to_exit_rest;
  (* unused_bits = "0 1" *)
  wire [1:0] trailing;
  wire \trailing$34 ;
  reg two_word_map = 1'h0;
  wire words_down;
  wire words_keeps;
  reg words_last = 1'h1;
  wire words_loads;
  wire wrong_nul;
  assign { \$1 [7], step_end } = last_at + 1'h1;
  assign \$2  = ~ last_at;
  assign { \$3 [7], left } = limit + \$2 ;
  assign present = ~ left[6];
  assign ends_message = at_end | step[5];
  assign ends_packet = ends_message & ended;
  assign { \$11 [8:7], map_at } = $signed({ 1'h0, last_at }) + $signed(map_offset);
  assign \$12  = map_at[6:3] - two_word_map;
  assign \$14  = | left[5:2];
  assign \trailing$34  = present & \$14 ;
  assign \$18  = step[0] & \mismatch$36 ;
  assign \$20  = limit != first_at;
  assign mismatch = \$18  & \$20 ;
  assign \$23  = step[0] & \mismatch$36 ;
  assign \$25  = ~ \$23 ;
  assign good = present & \$25 ;
  assign cut = ended & left[6];
  assign \$29  = ~ last_at;
  assign \$37  = limit ^ \$29 ;
  assign \$38  = $signed(2'h1) - $signed(map_offset);
  assign \$39  = $signed(2'h1) - $signed(map_offset);
  assign \$46  = \$37  ^ { \$39 [5], \$38  };
  assign \$47  = ~ last_at;
  assign \$55  = limit & \$47 ;
  assign \$56  = $signed(2'h1) - $signed(map_offset);
  assign \$57  = $signed(2'h1) - $signed(map_offset);
  assign \$64  = limit & { \$57 [5], \$56  };
  assign \$65  = \$55  | \$64 ;
  assign \$66  = ~ last_at;
  assign \$74  = $signed(2'h1) - $signed(map_offset);
  assign \$75  = $signed(2'h1) - $signed(map_offset);
  assign \$82  = \$66  & { \$75 [5], \$74  };
  assign \$83  = \$65  | \$82 ;
  assign { \$84 [7], map_left } = \$46  + { \$83 [5:0], 1'h0 };
  assign \$85  = ~ new_error;
  assign \$86  = bad & \$85 ;
  assign \$87  = ~ at_end;
  assign \$88  = \$87  | ended;
  assign drains = \$86  & \$88 ;
  assign \$89  = ~ bad;
  assign \$90  = ~ ends_message;
  assign \$91  = \$90  | ended;
  assign allowed = \$89  & \$91 ;
  assign \$99  = allowed & good;
  assign orders__valid = drains | \$99 ;
  assign \$100  = drains & orders__ready;
  assign \$101  = allowed & orders__ready;
  assign \$102  = \$101  & good;
  assign issue = \$100  | \$102 ;
  assign \$103  = drains & orders__ready;
  assign \$104  = \$103  & ends_packet;
  assign \$105  = allowed & orders__ready;
  assign \$106  = \$105  & ends_packet;
  assign \$107  = \$106  & good;
  assign next_sig = \$104  | \$107 ;
  assign \$108  = | { step[5], step[3], step[1] };
  assign \$109  = | step[3:2];
  assign \$110  = | step[5:4];
  assign \$111  = \$12 [2:0] + 1'h1;
  assign \$112  = map_at[5:3] + 1'h1;
  assign \$113  = items_room >= 4'h8;
  assign \$114  = ~ \$113 ;
  assign \$115  = bad & \$114 ;
  assign \$116  = \$115  ? items_room : 4'h8;
  assign \$117  = bad ? map_room : 4'h8;
  assign \$124  = ~ bad;
  assign \$129  = \trailing$34  ? 3'h2 : 3'h0;
  assign \$130  = bad ? code : \$129 ;
  assign { \$140 [7], exit_sum } = last_at + exit_add;
  assign \$146  = { following, 3'h0 } + 3'h7;
  assign { \$154 [7], next_last } = ends_packet ? \$146  : { 1'h0, exit_sum };
  assign \$159  = issue & ends_packet;
  assign \$167  = mismatch | cut;
  assign \$168  = ~ ended;
  assign \$169  = ends_message & \$168 ;
  assign \$170  = \$169  & \trailing$34 ;
  assign \$171  = \$167  | \$170 ;
  assign \$181  = mismatch | cut;
  assign \$182  = ~ ended;
  assign \$183  = ends_message & \$182 ;
  assign \$184  = \$183  & \trailing$34 ;
  assign \$185  = \$181  | \$184 ;
  assign \$191  = ends_message ? 3'h2 : 3'h3;
  assign \$192  = cut ? 3'h1 : \$191 ;
  assign \$194  = mismatch ? 3'h4 : \$192 ;
  assign \$195  = drains & orders__ready;
  assign \$196  = code == 1'h1;
  assign \$197  = & map_left[6:3];
  assign \$198  = \$197  ? map_left[2:0] : 3'h0;
  assign \$199  = map_left[6] ? { 1'h0, \$198  } : 4'h8;
  assign \$206  = map_left >= 4'h8;
  assign \$207  = \$206  ? 4'h8 : map_left[3:0];
  assign \$208  = map_left[6] ? 4'h0 : \$207 ;
  assign \$210  = two_word_map ? \$199  : \$208 ;
  assign \$211  = code == 2'h2;
  assign \$212  = code == 3'h5;
  assign \$213  = \$211  | \$212 ;
  assign \$214  = \$213  ? 4'h8 : 4'h0;
  assign \$215  = \$196  ? \$210  : \$214 ;
  assign \$216  = code == 1'h1;
  assign \$217  = map_left >= 4'h8;
  assign \$218  = \$217  ? 4'h8 : map_left[3:0];
  assign \$219  = map_left[6] ? 4'h0 : \$218 ;
  assign \$220  = code == 2'h2;
  assign \$221  = \$220  ? 4'h8 : 4'h0;
  assign \$222  = \$216  ? \$219  : \$221 ;
  assign \$256  = | step[5:0];
  assign \$258  = | step[4:0];
  assign \$259  = | step[4:0];
  assign \$263  = | step[3:0];
  assign \$274  = bad & at_end;
  assign \$275  = issue | \$274 ;
  assign \$276  = at_end ? limit : first_at;
  assign \$277  = bad ? \$276  : step_end;
  assign \$278  = ends_packet ? { following, 3'h0 } : \$277 ;
  always @(posedge aclk)
    bad <= \$279 ;
  always @(posedge aclk)
    new_error <= \$280 ;
  always @(posedge aclk)
    code <= \$281 ;
  always @(posedge aclk)
    items_room <= \$282 ;
  always @(posedge aclk)
    map_room <= \$283 ;
  always @(posedge aclk)
    words_last <= \$284 ;
  always @(posedge aclk)
    step <= \$286 ;
  always @(posedge aclk)
    map_offset <= \$287 ;
  always @(posedge aclk)
    two_word_map <= \$288 ;
  always @(posedge aclk)
    at_end <= \$289 ;
  always @(posedge aclk)
    exit_add <= \$290 ;
  always @(posedge aclk)
    first_at <= \$293 ;
  always @(posedge aclk)
    last_at <= \$294 ;
  assign choice_199_Y  = issue ? next_last : last_at;
  assign \$294  = rst ? 7'h07 : choice_199_Y ;
  assign choice_203_Y  = \$275  ? \$278  : first_at;
  assign \$293  = rst ? 7'h00 : choice_203_Y ;
  assign choice_224_Y  = ends_packet ? (* full_case = 32'd1 *) 6'h08 : { 2'h0, \$263 , step[3], 2'h0 };
  assign choice_226_Y  = issue ? choice_224_Y  : exit_add;
  assign \$290  = rst ? 6'h08 : choice_226_Y ;
  assign choice_233_Y  = ends_packet ? (* full_case = 32'd1 *) 1'h0 : step[5];
  assign choice_235_Y  = issue ? choice_233_Y  : at_end;
  assign \$289  = rst ? 1'h0 : choice_235_Y ;
  assign choice_242_Y  = ends_packet ? (* full_case = 32'd1 *) 1'h0 : step[4];
  assign choice_244_Y  = issue ? choice_242_Y  : two_word_map;
  assign \$288  = rst ? 1'h0 : choice_244_Y ;
  assign choice_251_Y  = ends_packet ? (* full_case = 32'd1 *) 5'h19 : { \$259 , \$258 , step[4], 1'h0, \$256  };
  assign choice_253_Y  = issue ? choice_251_Y  : map_offset;
  assign \$287  = rst ? 5'h19 : choice_253_Y ;
  assign choice_260_Y  = ends_packet ? (* full_case = 32'd1 *) 7'h01 : { step[5:0], 1'h0 };
  assign choice_262_Y  = issue ? choice_260_Y  : step;
  assign \$286  = rst ? 7'h01 : choice_262_Y ;
  assign \$284  = rst ? 1'h1 : words_last;
  assign choice_270_Y  = \$195  ? 4'h0 : map_room;
  assign choice_272_Y  = new_error ? \$222  : choice_270_Y ;
  assign choice_274_Y  = bad ? choice_272_Y  : map_room;
  assign \$283  = rst ? 4'h0 : choice_274_Y ;
  assign choice_278_Y  = \$195  ? 4'h0 : items_room;
  assign choice_280_Y  = new_error ? \$215  : choice_278_Y ;
  assign choice_282_Y  = bad ? choice_280_Y  : items_room;
  assign \$282  = rst ? 4'h0 : choice_282_Y ;
  assign choice_286_Y  = bad ? code : \$194 ;
  assign \$281  = rst ? 3'h0 : choice_286_Y ;
  assign choice_290_Y  = bad ? new_error : \$185 ;
  assign choice_292_Y  = bad ? 1'h0 : choice_290_Y ;
  assign \$280  = rst ? 1'h0 : choice_292_Y ;
  assign choice_296_Y  = bad ? bad : \$171 ;
  assign choice_298_Y  = \$159  ? 1'h0 : choice_296_Y ;
  assign \$279  = rst ? 1'h0 : choice_298_Y ;
  assign orders__payload = { \$130 , ends_packet, first_at[6:3], 1'h0, \$124 , words_last, 1'h0, \$117 , \$116 , \$112 [2:0], \$111 [2:0], map_at[5:0], \$12 [2:0], map_at[2:0], at_end, \$110 , \$109 , \$108  };
  assign items_at = { \$12 [3:0], map_at[2:0] };
  assign next_packet = { following, 3'h0 };
  assign to_exit_low = 7'h00;
  assign to_body_mask = 3'h0;
  assign to_body_low = 7'h00;
  \geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.core.sequencer.marks  marks (
    .aclk(aclk),
    .beat(beat),
    .header_at(first_at[6:3]),
    .mismatch(\mismatch$36 ),
    .rst(rst)
  );
  assign \orders__payload.items_bytes  = orders__payload[25:22];
  assign \orders__payload.map_bytes  = orders__payload[29:26];
  assign \$154 [6:0] = next_last;
  assign \orders__payload.items  = orders__payload[30];
  assign \orders__payload.last  = orders__payload[31];
  assign \orders__payload.length_good  = orders__payload[32];
  assign \orders__payload.final  = orders__payload[33];
  assign \orders__payload.first  = orders__payload[37:34];
  assign \orders__payload.ends  = orders__payload[38];
  assign \orders__payload.status  = orders__payload[41:39];
  assign \$140 [6:0] = exit_sum;
  assign \$84 [6:0] = map_left;
  assign \beat.data  = beat[63:0];
  assign \beat.count  = beat[67:64];
  assign \beat.last  = beat[68];
  assign \beat.at  = beat[72:69];
  assign \beat.valid  = beat[73];
  assign \beat$26.data  = beat[63:0];
  assign \beat$26.count  = beat[67:64];
  assign \$11 [6:0] = map_at;
  assign \beat$26.last  = beat[68];
  assign \beat$26.at  = beat[72:69];
  assign \beat$26.valid  = beat[73];
  assign \orders__payload.step  = orders__payload[2:0];
  assign \$3 [6:0] = left;
  assign \$1 [6:0] = step_end;
  assign header_at = first_at[6:3];
  assign \orders__payload.blank  = orders__payload[3];
  assign \orders__payload.items_at  = orders__payload[9:4];
  assign \orders__payload.map_at  = orders__payload[15:10];
  assign early_last = next_last;
  assign body_amount = 6'h00;
  assign to_body_rest = 1'h0;
  assign to_exit_mask = 3'h0;
  assign tail = 6'h00;
  assign exit_amount = exit_add;
  assign to_exit_rest = 1'h0;
  assign words_keeps = 1'h1;
  assign words_down = 1'h0;
  assign words_loads = 1'h0;
  assign step_to_body = 1'h0;
  assign oldest = first_at[6:3];
  assign items_wanted = 4'h8;
  assign begins = 1'h0;
  assign \orders__payload.items_next  = orders__payload[18:16];
  assign nonzero = 1'h0;
  assign \orders__payload.map_next  = orders__payload[21:19];
  assign wrong_nul = 1'h0;
  assign \nul_at$28  = 7'h00;
  assign nul_at = 7'h00;
  assign \beat$26  = beat;
  assign done = 1'h1;
  assign exits_always = 1'h1;
  assign trailing = left[1:0];
  assign default_5 = step[5];
  assign default_4 = step[4];
  assign default_3 = step[3];
  assign default_2 = step[2];
  assign default_1 = step[1];
  assign default_0 = step[0];
endmodule

module \geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.core.sequencer.marks (rst, mismatch, beat, header_at, aclk);
  wire \$1 ;
  wire \$10 ;
  wire \$2 ;
  wire \$3 ;
  wire \$4 ;
  wire \$5 ;
  wire \$6 ;
  wire \$7 ;
  wire \$8 ;
  wire \$9 ;
  input aclk;
  wire aclk;
  input [73:0] beat;
  wire [73:0] beat;
  (* unused_bits = "3" *)
  wire [3:0] \beat.at ;
  wire [3:0] \beat.count ;
  (* unused_bits = "16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32 33 34 35 36 37 38 39 40 41 42 43 44 45 46 47 48 49 50 51 52 53 54 55 56 57 58 59 60 61 62 63" *)
  wire [63:0] \beat.data ;
  wire \beat.last ;
  wire \beat.valid ;
  input [3:0] header_at;
  wire [3:0] header_at;
  wire [2:0] headers__read__addr;
  wire headers__read__data;
  wire [2:0] headers__write__addr;
  wire headers__write__data;
  wire headers__write__en;
  output mismatch;
  wire mismatch;
  input rst;
  wire rst;
  reg [0:0] headers [7:0];
  initial begin
    headers[0] = 1'h0;
    headers[1] = 1'h0;
    headers[2] = 1'h0;
    headers[3] = 1'h0;
    headers[4] = 1'h0;
    headers[5] = 1'h0;
    headers[6] = 1'h0;
    headers[7] = 1'h0;
  end
  always @(posedge aclk) begin
    if (beat[73])
      headers[beat[71:69]] <= headers__write__data;
  end
  assign mismatch = headers[header_at[2:0]];
  assign \$1  = | beat[7:0];
  assign \$2  = ~ beat[68];
  assign \$3  = beat[67:64] > 1'h0;
  assign \$4  = \$2  | \$3 ;
  assign \$5  = \$1  & \$4 ;
  assign \$6  = beat[15:8] != 1'h1;
  assign \$7  = ~ beat[68];
  assign \$8  = beat[67:64] > 1'h1;
  assign \$9  = \$7  | \$8 ;
  assign \$10  = \$6  & \$9 ;
  assign headers__write__data = | { \$10 , \$5  };
  assign \beat.valid  = beat[73];
  assign \beat.at  = beat[72:69];
  assign \beat.last  = beat[68];
  assign \beat.count  = beat[67:64];
  assign \beat.data  = beat[63:0];
  assign headers__read__data = mismatch;
  assign headers__read__addr = header_at[2:0];
  assign headers__write__en = beat[73];
  assign headers__write__addr = beat[71:69];
endmodule
