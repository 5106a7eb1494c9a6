// geometry_msgs_msg_Twist_cdr_8_serializer: the serializer of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
// lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
// definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
// What each port means: manifest.json.

module geometry_msgs_msg_Twist_cdr_8_serializer(aresetn, m_axis_tready, linear_x_data, linear_x_valid, linear_y_data, linear_y_valid, linear_z_data, linear_z_valid, angular_x_data, angular_x_valid, angular_y_data, angular_y_valid, angular_z_data, angular_z_valid, m_axis_status_tready, m_axis_tdata, m_axis_tkeep, m_axis_tlast, m_axis_tuser, m_axis_tvalid, linear_x_ready
, linear_y_ready, linear_z_ready, angular_x_ready, angular_y_ready, angular_z_ready, m_axis_status_tdata, m_axis_status_tvalid, aclk);
  wire \$1 ;
  wire \$2 ;
  wire \$3 ;
  wire \$4 ;
  wire \$5 ;
  wire \$6 ;
  wire \$7 ;
  wire \$8 ;
  input aclk;
  wire aclk;
  input [63:0] angular_x_data;
  wire [63:0] angular_x_data;
  output angular_x_ready;
  wire angular_x_ready;
  input angular_x_valid;
  wire angular_x_valid;
  input [63:0] angular_y_data;
  wire [63:0] angular_y_data;
  output angular_y_ready;
  wire angular_y_ready;
  input angular_y_valid;
  wire angular_y_valid;
  input [63:0] angular_z_data;
  wire [63:0] angular_z_data;
  output angular_z_ready;
  wire angular_z_ready;
  input angular_z_valid;
  wire angular_z_valid;
  input aresetn;
  wire aresetn;
  input [63:0] linear_x_data;
  wire [63:0] linear_x_data;
  output linear_x_ready;
  wire linear_x_ready;
  input linear_x_valid;
  wire linear_x_valid;
  input [63:0] linear_y_data;
  wire [63:0] linear_y_data;
  output linear_y_ready;
  wire linear_y_ready;
  input linear_y_valid;
  wire linear_y_valid;
  input [63:0] linear_z_data;
  wire [63:0] linear_z_data;
  output linear_z_ready;
  wire linear_z_ready;
  input linear_z_valid;
  wire linear_z_valid;
  output [7:0] m_axis_status_tdata;
  wire [7:0] m_axis_status_tdata;
  input m_axis_status_tready;
  wire m_axis_status_tready;
  output m_axis_status_tvalid;
  wire m_axis_status_tvalid;
  output [63:0] m_axis_tdata;
  wire [63:0] m_axis_tdata;
  output [7:0] m_axis_tkeep;
  wire [7:0] m_axis_tkeep;
  output m_axis_tlast;
  wire m_axis_tlast;
  input m_axis_tready;
  wire m_axis_tready;
  output m_axis_tuser;
  wire m_axis_tuser;
  output m_axis_tvalid;
  wire m_axis_tvalid;
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
  wire packet_error;
  wire [68:0] packets__payload;
  wire [3:0] \packets__payload.count ;
  wire [63:0] \packets__payload.data ;
  wire [7:0] \packets__payload.data[0] ;
  wire [7:0] \packets__payload.data[1] ;
  wire [7:0] \packets__payload.data[2] ;
  wire [7:0] \packets__payload.data[3] ;
  wire [7:0] \packets__payload.data[4] ;
  wire [7:0] \packets__payload.data[5] ;
  wire [7:0] \packets__payload.data[6] ;
  wire [7:0] \packets__payload.data[7] ;
  wire \packets__payload.last ;
  wire packets__ready;
  wire packets__valid;
  wire rst;
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
  assign \$1  = packets__payload[67:64] > 1'h0;
  assign \$2  = packets__payload[67:64] > 1'h1;
  assign \$3  = packets__payload[67:64] > 2'h2;
  assign \$4  = packets__payload[67:64] > 2'h3;
  assign \$5  = packets__payload[67:64] > 3'h4;
  assign \$6  = packets__payload[67:64] > 3'h5;
  assign \$7  = packets__payload[67:64] > 3'h6;
  assign \$8  = packets__payload[67:64] > 3'h7;
  assign rst = ~ aresetn;
  \geometry_msgs_msg_Twist_cdr_8_serializer.core  core (
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
    .packet_error(m_axis_tuser),
    .packets__payload(packets__payload),
    .packets__ready(m_axis_tready),
    .packets__valid(m_axis_tvalid),
    .rst(rst),
    .status__payload(status__payload),
    .status__ready(m_axis_status_tready),
    .status__valid(m_axis_status_tvalid)
  );
  assign packet_error = m_axis_tuser;
  assign packets__valid = m_axis_tvalid;
  assign packets__ready = m_axis_tready;
  assign status__valid = m_axis_status_tvalid;
  assign status__ready = m_axis_status_tready;
  assign message__linear__x__payload = linear_x_data;
  assign message__linear__x__valid = linear_x_valid;
  assign message__linear__x__ready = linear_x_ready;
  assign message__linear__y__payload = linear_y_data;
  assign message__linear__y__valid = linear_y_valid;
  assign message__linear__y__ready = linear_y_ready;
  assign message__linear__z__payload = linear_z_data;
  assign message__linear__z__valid = linear_z_valid;
  assign message__linear__z__ready = linear_z_ready;
  assign message__angular__x__payload = angular_x_data;
  assign message__angular__x__valid = angular_x_valid;
  assign message__angular__x__ready = angular_x_ready;
  assign message__angular__y__payload = angular_y_data;
  assign message__angular__y__valid = angular_y_valid;
  assign message__angular__y__ready = angular_y_ready;
  assign message__angular__z__payload = angular_z_data;
  assign message__angular__z__valid = angular_z_valid;
  assign message__angular__z__ready = angular_z_ready;
  assign m_axis_tdata = packets__payload[63:0];
  assign m_axis_tkeep = { \$8 , \$7 , \$6 , \$5 , \$4 , \$3 , \$2 , \$1  };
  assign m_axis_tlast = packets__payload[68];
  assign m_axis_status_tdata = { 5'h00, status__payload };
  assign \packets__payload.data  = packets__payload[63:0];
  assign \packets__payload.data[0]  = packets__payload[7:0];
  assign \packets__payload.data[1]  = packets__payload[15:8];
  assign \packets__payload.data[2]  = packets__payload[23:16];
  assign \packets__payload.data[3]  = packets__payload[31:24];
  assign \packets__payload.data[4]  = packets__payload[39:32];
  assign \packets__payload.data[5]  = packets__payload[47:40];
  assign \packets__payload.data[6]  = packets__payload[55:48];
  assign \packets__payload.data[7]  = packets__payload[63:56];
  assign \packets__payload.count  = packets__payload[67:64];
  assign \packets__payload.last  = packets__payload[68];
endmodule

module \geometry_msgs_msg_Twist_cdr_8_serializer.core (packets__ready, message__linear__x__payload, message__linear__x__valid, message__linear__y__payload, message__linear__y__valid, message__linear__z__payload, message__linear__z__valid, message__angular__x__payload, message__angular__x__valid, message__angular__y__payload, message__angular__y__valid, message__angular__z__payload, message__angular__z__valid, status__ready, rst, packets__valid, packet_error, message__linear__x__ready, message__linear__y__ready, message__linear__z__ready, message__angular__x__ready
, message__angular__y__ready, message__angular__z__ready, status__valid, status__payload, packets__payload, aclk);
  reg \$auto$verilog_backend.cc:2355:dump_module$1  = 0;
  wire [7:0] \$1 ;
  wire \$10 ;
  wire \$11 ;
  wire \$12 ;
  wire [10:0] \$13 ;
  wire [10:0] \$14 ;
  wire \$15 ;
  wire [4:0] \$16 ;
  wire \$17 ;
  wire \$18 ;
  wire [3:0] \$19 ;
  wire [7:0] \$2 ;
  wire \$20 ;
  wire \$21 ;
  wire [2:0] \$22 ;
  wire \$23 ;
  wire \$24 ;
  wire [1:0] \$25 ;
  wire \$26 ;
  wire [1:0] \$27 ;
  wire \$28 ;
  wire [1:0] \$29 ;
  wire [7:0] \$3 ;
  wire \$30 ;
  wire [2:0] \$31 ;
  wire \$32 ;
  wire [2:0] \$33 ;
  wire \$34 ;
  wire [3:0] \$35 ;
  wire \$36 ;
  wire [3:0] \$37 ;
  wire \$38 ;
  wire [3:0] \$39 ;
  wire [7:0] \$4 ;
  wire \$40 ;
  wire [3:0] \$41 ;
  wire \$42 ;
  wire \$43 ;
  wire \$44 ;
  wire \$45 ;
  wire \$46 ;
  wire \$47 ;
  wire \$48 ;
  wire \$49 ;
  wire [7:0] \$5 ;
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
  wire [7:0] \$6 ;
  wire \$60 ;
  wire \$61 ;
  wire \$62 ;
  wire \$63 ;
  wire \$64 ;
  wire \$65 ;
  wire \$66 ;
  wire [4:0] \$67 ;
  wire \$68 ;
  reg \$69 ;
  wire [7:0] \$7 ;
  reg \$70 ;
  reg \$71 ;
  reg \$72 ;
  reg \$73 ;
  reg [2:0] \$74 ;
  reg [7:0] \$75 ;
  reg [7:0] \$76 ;
  reg [7:0] \$77 ;
  reg [7:0] \$78 ;
  reg [7:0] \$79 ;
  wire [7:0] \$8 ;
  reg [7:0] \$80 ;
  reg [7:0] \$81 ;
  reg [7:0] \$82 ;
  reg [72:0] \$83 ;
  reg [2:0] \$84 ;
  reg [2:0] \$85 ;
  wire \$9 ;
  reg able_0;
  reg able_1;
  input aclk;
  wire aclk;
  reg [2:0] align;
  wire all_served;
  wire allowed;
  reg [3:0] base;
  wire complete;
  reg done;
  reg ends;
  wire error;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] \error$80 ;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  reg [2:0] \error$81  = 3'h0;
  wire \final ;
  wire fresh;
  reg full = 1'h0;
  wire go_0;
  wire go_1;
  wire has_items;
  reg [7:0] lane_0 = 8'h00;
  reg [7:0] lane_1 = 8'h00;
  reg [7:0] lane_2 = 8'h00;
  reg [7:0] lane_3 = 8'h00;
  reg [7:0] lane_4 = 8'h00;
  reg [7:0] lane_5 = 8'h00;
  reg [7:0] lane_6 = 8'h00;
  reg [7:0] lane_7 = 8'h00;
  wire [7:0] lane_used;
  reg last_items;
  wire leads;
  reg led = 1'h0;
  wire left;
  input [63:0] message__angular__x__payload;
  wire [63:0] message__angular__x__payload;
  output message__angular__x__ready;
  reg message__angular__x__ready;
  input message__angular__x__valid;
  wire message__angular__x__valid;
  input [63:0] message__angular__y__payload;
  wire [63:0] message__angular__y__payload;
  output message__angular__y__ready;
  reg message__angular__y__ready;
  input message__angular__y__valid;
  wire message__angular__y__valid;
  input [63:0] message__angular__z__payload;
  wire [63:0] message__angular__z__payload;
  output message__angular__z__ready;
  reg message__angular__z__ready;
  input message__angular__z__valid;
  wire message__angular__z__valid;
  input [63:0] message__linear__x__payload;
  wire [63:0] message__linear__x__payload;
  output message__linear__x__ready;
  reg message__linear__x__ready;
  input message__linear__x__valid;
  wire message__linear__x__valid;
  input [63:0] message__linear__y__payload;
  wire [63:0] message__linear__y__payload;
  output message__linear__y__ready;
  reg message__linear__y__ready;
  input message__linear__y__valid;
  wire message__linear__y__valid;
  input [63:0] message__linear__z__payload;
  wire [63:0] message__linear__z__payload;
  output message__linear__z__ready;
  reg message__linear__z__ready;
  input message__linear__z__valid;
  wire message__linear__z__valid;
  wire [3:0] most_items;
  reg [7:0] next_lane_0;
  reg [7:0] next_lane_1;
  reg [7:0] next_lane_2;
  reg [7:0] next_lane_3;
  reg [7:0] next_lane_4;
  reg [7:0] next_lane_5;
  reg [7:0] next_lane_6;
  reg [7:0] next_lane_7;
  reg [2:0] next_step;
  output packet_error;
  wire packet_error;
  output [68:0] packets__payload;
  wire [68:0] packets__payload;
  wire [68:0] \packets__payload$1 ;
  wire [3:0] \packets__payload$1.count ;
  wire [63:0] \packets__payload$1.data ;
  wire [7:0] \packets__payload$1.data[0] ;
  wire [7:0] \packets__payload$1.data[1] ;
  wire [7:0] \packets__payload$1.data[2] ;
  wire [7:0] \packets__payload$1.data[3] ;
  wire [7:0] \packets__payload$1.data[4] ;
  wire [7:0] \packets__payload$1.data[5] ;
  wire [7:0] \packets__payload$1.data[6] ;
  wire [7:0] \packets__payload$1.data[7] ;
  wire \packets__payload$1.last ;
  wire [3:0] \packets__payload.count ;
  wire [63:0] \packets__payload.data ;
  wire [7:0] \packets__payload.data[0] ;
  wire [7:0] \packets__payload.data[1] ;
  wire [7:0] \packets__payload.data[2] ;
  wire [7:0] \packets__payload.data[3] ;
  wire [7:0] \packets__payload.data[4] ;
  wire [7:0] \packets__payload.data[5] ;
  wire [7:0] \packets__payload.data[6] ;
  wire [7:0] \packets__payload.data[7] ;
  wire \packets__payload.last ;
  input packets__ready;
  wire packets__ready;
  wire \packets__ready$5 ;
  output packets__valid;
  wire packets__valid;
  wire \packets__valid$3 ;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] raised;
  wire reached_0;
  wire reached_1;
  input rst;
  wire rst;
  wire [3:0] run_bytes;
  wire running;
  reg served_0 = 1'h0;
  reg served_1 = 1'h0;
  wire [3:0] \small ;
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
  reg [2:0] step = 3'h0;
  wire terminated;
  wire [2:0] unit_log2;
  reg [72:0] word = 73'h0000000000000000000;
  wire [2:0] \word.align ;
  wire [3:0] \word.count ;
  wire [63:0] \word.data ;
  wire [7:0] \word.data[0] ;
  wire [7:0] \word.data[1] ;
  wire [7:0] \word.data[2] ;
  wire [7:0] \word.data[3] ;
  wire [7:0] \word.data[4] ;
  wire [7:0] \word.data[5] ;
  wire [7:0] \word.data[6] ;
  wire [7:0] \word.data[7] ;
  wire \word.error ;
  wire \word.last ;
  wire [72:0] word__payload;
  wire [2:0] \word__payload.align ;
  wire [3:0] \word__payload.count ;
  wire [63:0] \word__payload.data ;
  wire [7:0] \word__payload.data[0] ;
  wire [7:0] \word__payload.data[1] ;
  wire [7:0] \word__payload.data[2] ;
  wire [7:0] \word__payload.data[3] ;
  wire [7:0] \word__payload.data[4] ;
  wire [7:0] \word__payload.data[5] ;
  wire [7:0] \word__payload.data[6] ;
  wire [7:0] \word__payload.data[7] ;
  wire \word__payload.error ;
  wire \word__payload.last ;
  wire word__ready;
  wire word__valid;
  wire writable;
  assign \$43  = ~ served_0;
  assign \$44  = writable & \$43 ;
  assign go_0 = \$45  & able_0;
  assign \$46  = served_0 | able_0;
  assign \$47  = ~ served_1;
  assign \$48  = writable & \$47 ;
  assign \$49  = \$48  & reached_0;
  assign go_1 = \$49  & able_1;
  assign \$50  = served_1 | able_1;
  assign reached_1 = reached_0 & \$50 ;
  assign fresh = ~ served_0;
  assign \$51  = ~ led;
  assign \$52  = \$51  | message__linear__x__valid;
  assign word__valid = full & \$52 ;
  assign \$53  = ~ full;
  assign \$54  = word__valid & word__ready;
  assign writable = \$53  | \$54 ;
  assign \$55  = writable & reached_1;
  assign \$56  = ~ ends;
  assign \$57  = ~ status__valid;
  assign \$58  = \$57  | status__ready;
  assign \$59  = \$56  | \$58 ;
  assign complete = \$55  & \$59 ;
  assign \$60  = ! \error$81 ;
  assign \error$80  = \$60  ? 3'h0 : \error$81 ;
  assign \$61  = served_0 | go_0;
  assign \$62  = ~ complete;
  assign \$63  = \$61  & \$62 ;
  assign \$64  = served_1 | go_1;
  assign \$65  = ~ complete;
  assign \$66  = \$64  & \$65 ;
  assign \$67  = base + 4'h0;
  assign \$68  = | \error$80 ;
  always @(posedge aclk)
    status__valid <= \$69 ;
  always @(posedge aclk)
    served_0 <= \$70 ;
  always @(posedge aclk)
    served_1 <= \$71 ;
  always @(posedge aclk)
    full <= \$72 ;
  always @(posedge aclk)
    led <= \$73 ;
  always @(posedge aclk)
    \error$81  <= \$74 ;
  always @(posedge aclk)
    lane_0 <= \$75 ;
  always @(posedge aclk)
    lane_1 <= \$76 ;
  always @(posedge aclk)
    lane_2 <= \$77 ;
  always @(posedge aclk)
    lane_3 <= \$78 ;
  always @(posedge aclk)
    lane_4 <= \$79 ;
  always @(posedge aclk)
    lane_5 <= \$80 ;
  always @(posedge aclk)
    lane_6 <= \$81 ;
  always @(posedge aclk)
    lane_7 <= \$82 ;
  always @(posedge aclk)
    word <= \$83 ;
  always @(posedge aclk)
    step <= \$84 ;
  always @(posedge aclk)
    status__payload <= \$85 ;
  assign \$1  = served_0 ? lane_0 : 8'h00;
  assign \$2  = served_0 ? lane_1 : 8'h00;
  assign \$3  = served_0 ? lane_2 : 8'h00;
  assign \$4  = served_0 ? lane_3 : 8'h00;
  assign \$5  = served_0 ? lane_4 : 8'h00;
  assign \$6  = served_0 ? lane_5 : 8'h00;
  assign \$7  = served_0 ? lane_6 : 8'h00;
  assign \$8  = served_0 ? lane_7 : 8'h00;
  \geometry_msgs_msg_Twist_cdr_8_serializer.core.packer  packer (
    .aclk(aclk),
    .error(packet_error),
    .packets__payload(packets__payload),
    .packets__ready(packets__ready),
    .packets__valid(packets__valid),
    .rst(rst),
    .word__payload(word__payload),
    .word__ready(word__ready),
    .word__valid(word__valid)
  );
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    next_lane_0 = \$1 ;
    casez (step)
      3'h0:
          next_lane_0 = 8'h00;
      3'h1:
          if (go_0) begin
            next_lane_0 = message__linear__x__payload[39:32];
          end
      3'h2:
          if (go_0) begin
            next_lane_0 = message__linear__y__payload[39:32];
          end
      3'h3:
          if (go_0) begin
            next_lane_0 = message__linear__z__payload[39:32];
          end
      3'h4:
          if (go_0) begin
            next_lane_0 = message__angular__x__payload[39:32];
          end
      3'h5:
          if (go_0) begin
            next_lane_0 = message__angular__y__payload[39:32];
          end
      3'h6:
          if (go_0) begin
            next_lane_0 = message__angular__z__payload[39:32];
          end
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    next_lane_1 = \$2 ;
    casez (step)
      3'h0:
          next_lane_1 = 8'h01;
      3'h1:
          if (go_0) begin
            next_lane_1 = message__linear__x__payload[47:40];
          end
      3'h2:
          if (go_0) begin
            next_lane_1 = message__linear__y__payload[47:40];
          end
      3'h3:
          if (go_0) begin
            next_lane_1 = message__linear__z__payload[47:40];
          end
      3'h4:
          if (go_0) begin
            next_lane_1 = message__angular__x__payload[47:40];
          end
      3'h5:
          if (go_0) begin
            next_lane_1 = message__angular__y__payload[47:40];
          end
      3'h6:
          if (go_0) begin
            next_lane_1 = message__angular__z__payload[47:40];
          end
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    next_lane_2 = \$3 ;
    casez (step)
      3'h0:
          next_lane_2 = 8'h00;
      3'h1:
          if (go_0) begin
            next_lane_2 = message__linear__x__payload[55:48];
          end
      3'h2:
          if (go_0) begin
            next_lane_2 = message__linear__y__payload[55:48];
          end
      3'h3:
          if (go_0) begin
            next_lane_2 = message__linear__z__payload[55:48];
          end
      3'h4:
          if (go_0) begin
            next_lane_2 = message__angular__x__payload[55:48];
          end
      3'h5:
          if (go_0) begin
            next_lane_2 = message__angular__y__payload[55:48];
          end
      3'h6:
          if (go_0) begin
            next_lane_2 = message__angular__z__payload[55:48];
          end
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    next_lane_3 = \$4 ;
    casez (step)
      3'h0:
          next_lane_3 = 8'h00;
      3'h1:
          if (go_0) begin
            next_lane_3 = message__linear__x__payload[63:56];
          end
      3'h2:
          if (go_0) begin
            next_lane_3 = message__linear__y__payload[63:56];
          end
      3'h3:
          if (go_0) begin
            next_lane_3 = message__linear__z__payload[63:56];
          end
      3'h4:
          if (go_0) begin
            next_lane_3 = message__angular__x__payload[63:56];
          end
      3'h5:
          if (go_0) begin
            next_lane_3 = message__angular__y__payload[63:56];
          end
      3'h6:
          if (go_0) begin
            next_lane_3 = message__angular__z__payload[63:56];
          end
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    next_lane_4 = \$5 ;
    casez (step)
      3'h0:
          if (go_0) begin
            next_lane_4 = message__linear__x__payload[7:0];
          end
      3'h1:
          if (go_1) begin
            next_lane_4 = message__linear__y__payload[7:0];
          end
      3'h2:
          if (go_1) begin
            next_lane_4 = message__linear__z__payload[7:0];
          end
      3'h3:
          if (go_1) begin
            next_lane_4 = message__angular__x__payload[7:0];
          end
      3'h4:
          if (go_1) begin
            next_lane_4 = message__angular__y__payload[7:0];
          end
      3'h5:
          if (go_1) begin
            next_lane_4 = message__angular__z__payload[7:0];
          end
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    next_lane_5 = \$6 ;
    casez (step)
      3'h0:
          if (go_0) begin
            next_lane_5 = message__linear__x__payload[15:8];
          end
      3'h1:
          if (go_1) begin
            next_lane_5 = message__linear__y__payload[15:8];
          end
      3'h2:
          if (go_1) begin
            next_lane_5 = message__linear__z__payload[15:8];
          end
      3'h3:
          if (go_1) begin
            next_lane_5 = message__angular__x__payload[15:8];
          end
      3'h4:
          if (go_1) begin
            next_lane_5 = message__angular__y__payload[15:8];
          end
      3'h5:
          if (go_1) begin
            next_lane_5 = message__angular__z__payload[15:8];
          end
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    next_lane_6 = \$7 ;
    casez (step)
      3'h0:
          if (go_0) begin
            next_lane_6 = message__linear__x__payload[23:16];
          end
      3'h1:
          if (go_1) begin
            next_lane_6 = message__linear__y__payload[23:16];
          end
      3'h2:
          if (go_1) begin
            next_lane_6 = message__linear__z__payload[23:16];
          end
      3'h3:
          if (go_1) begin
            next_lane_6 = message__angular__x__payload[23:16];
          end
      3'h4:
          if (go_1) begin
            next_lane_6 = message__angular__y__payload[23:16];
          end
      3'h5:
          if (go_1) begin
            next_lane_6 = message__angular__z__payload[23:16];
          end
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    next_lane_7 = \$8 ;
    casez (step)
      3'h0:
          if (go_0) begin
            next_lane_7 = message__linear__x__payload[31:24];
          end
      3'h1:
          if (go_1) begin
            next_lane_7 = message__linear__y__payload[31:24];
          end
      3'h2:
          if (go_1) begin
            next_lane_7 = message__linear__z__payload[31:24];
          end
      3'h3:
          if (go_1) begin
            next_lane_7 = message__angular__x__payload[31:24];
          end
      3'h4:
          if (go_1) begin
            next_lane_7 = message__angular__y__payload[31:24];
          end
      3'h5:
          if (go_1) begin
            next_lane_7 = message__angular__z__payload[31:24];
          end
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    able_0 = 1'h1;
    casez (step)
      3'h0:
          able_0 = message__linear__x__valid;
      3'h1:
          able_0 = message__linear__x__valid;
      3'h2:
          able_0 = message__linear__y__valid;
      3'h3:
          able_0 = message__linear__z__valid;
      3'h4:
          able_0 = message__angular__x__valid;
      3'h5:
          able_0 = message__angular__y__valid;
      3'h6:
          able_0 = message__angular__z__valid;
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    base = 4'h0;
    casez (step)
      3'h0:
          base = 4'h8;
      3'h1:
          base = 4'h8;
      3'h2:
          base = 4'h8;
      3'h3:
          base = 4'h8;
      3'h4:
          base = 4'h8;
      3'h5:
          base = 4'h8;
      3'h6:
          base = 4'h4;
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    done = 1'h0;
    casez (step)
      3'h0:
          done = 1'h1;
      3'h1:
          done = 1'h1;
      3'h2:
          done = 1'h1;
      3'h3:
          done = 1'h1;
      3'h4:
          done = 1'h1;
      3'h5:
          done = 1'h1;
      3'h6:
          done = 1'h1;
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    next_step = 3'h0;
    casez (step)
      3'h0:
          if (done) begin
            next_step = 3'h1;
          end
      3'h1:
          if (done) begin
            next_step = 3'h2;
          end
      3'h2:
          if (done) begin
            next_step = 3'h3;
          end
      3'h3:
          if (done) begin
            next_step = 3'h4;
          end
      3'h4:
          if (done) begin
            next_step = 3'h5;
          end
      3'h5:
          if (done) begin
            next_step = 3'h6;
          end
      3'h6:
          if (done) begin
            next_step = 3'h0;
          end
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    align = 3'h0;
    casez (step)
      3'h0:
          if (done) begin
            align = 3'h0;
          end
      3'h1:
          if (done) begin
            align = 3'h0;
          end
      3'h2:
          if (done) begin
            align = 3'h0;
          end
      3'h3:
          if (done) begin
            align = 3'h0;
          end
      3'h4:
          if (done) begin
            align = 3'h0;
          end
      3'h5:
          if (done) begin
            align = 3'h0;
          end
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    able_1 = 1'h1;
    casez (step)
      3'h0:
          /* empty */;
      3'h1:
          able_1 = message__linear__y__valid;
      3'h2:
          able_1 = message__linear__z__valid;
      3'h3:
          able_1 = message__angular__x__valid;
      3'h4:
          able_1 = message__angular__y__valid;
      3'h5:
          able_1 = message__angular__z__valid;
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    message__linear__x__ready = 1'h0;
    casez (step)
      3'h0:
          /* empty */;
      3'h1:
          message__linear__x__ready = go_0;
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    message__linear__y__ready = 1'h0;
    casez (step)
      3'h0:
          /* empty */;
      3'h1:
          /* empty */;
      3'h2:
          message__linear__y__ready = go_0;
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    message__linear__z__ready = 1'h0;
    casez (step)
      3'h0:
          /* empty */;
      3'h1:
          /* empty */;
      3'h2:
          /* empty */;
      3'h3:
          message__linear__z__ready = go_0;
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    message__angular__x__ready = 1'h0;
    casez (step)
      3'h0:
          /* empty */;
      3'h1:
          /* empty */;
      3'h2:
          /* empty */;
      3'h3:
          /* empty */;
      3'h4:
          message__angular__x__ready = go_0;
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    message__angular__y__ready = 1'h0;
    casez (step)
      3'h0:
          /* empty */;
      3'h1:
          /* empty */;
      3'h2:
          /* empty */;
      3'h3:
          /* empty */;
      3'h4:
          /* empty */;
      3'h5:
          message__angular__y__ready = go_0;
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    message__angular__z__ready = 1'h0;
    casez (step)
      3'h0:
          /* empty */;
      3'h1:
          /* empty */;
      3'h2:
          /* empty */;
      3'h3:
          /* empty */;
      3'h4:
          /* empty */;
      3'h5:
          /* empty */;
      3'h6:
          message__angular__z__ready = go_0;
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    ends = 1'h0;
    casez (step)
      3'h0:
          /* empty */;
      3'h1:
          /* empty */;
      3'h2:
          /* empty */;
      3'h3:
          /* empty */;
      3'h4:
          /* empty */;
      3'h5:
          /* empty */;
      3'h6:
          if (done) begin
            ends = 1'h1;
          end
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    last_items = 1'h0;
    if (\$15 ) begin
      last_items = \$17 ;
    end
    if (\$18 ) begin
      last_items = \$20 ;
    end
    if (\$21 ) begin
      last_items = \$23 ;
    end
    if (\$24 ) begin
      last_items = \$26 ;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$69  = status__valid;
    if (status__ready) begin
      \$69  = 1'h0;
    end
    if (complete) begin
      if (ends) begin
        \$69  = 1'h1;
      end
    end
    if (rst) begin
      \$69  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$70  = \$63 ;
    if (rst) begin
      \$70  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$71  = \$66 ;
    if (rst) begin
      \$71  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$72  = full;
    if (writable) begin
      \$72  = complete;
    end
    if (rst) begin
      \$72  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$73  = led;
    if (writable) begin
      \$73  = 1'h0;
    end
    if (rst) begin
      \$73  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$74  = \error$81 ;
    if (writable) begin
      \$74  = \error$80 ;
    end
    if (complete) begin
      if (ends) begin
        \$74  = 3'h0;
      end
    end
    if (rst) begin
      \$74  = 3'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$75  = lane_0;
    if (writable) begin
      \$75  = next_lane_0;
    end
    if (rst) begin
      \$75  = 8'h00;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$76  = lane_1;
    if (writable) begin
      \$76  = next_lane_1;
    end
    if (rst) begin
      \$76  = 8'h00;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$77  = lane_2;
    if (writable) begin
      \$77  = next_lane_2;
    end
    if (rst) begin
      \$77  = 8'h00;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$78  = lane_3;
    if (writable) begin
      \$78  = next_lane_3;
    end
    if (rst) begin
      \$78  = 8'h00;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$79  = lane_4;
    if (writable) begin
      \$79  = next_lane_4;
    end
    if (rst) begin
      \$79  = 8'h00;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$80  = lane_5;
    if (writable) begin
      \$80  = next_lane_5;
    end
    if (rst) begin
      \$80  = 8'h00;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$81  = lane_6;
    if (writable) begin
      \$81  = next_lane_6;
    end
    if (rst) begin
      \$81  = 8'h00;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$82  = lane_7;
    if (writable) begin
      \$82  = next_lane_7;
    end
    if (rst) begin
      \$82  = 8'h00;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$83  = word;
    if (complete) begin
      \$83 [67:64] = \$67 [3:0];
      \$83 [70:68] = align;
      \$83 [71] = ends;
      \$83 [72] = \$68 ;
    end
    if (rst) begin
      \$83  = 73'h0000000000000000000;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$84  = step;
    if (complete) begin
      \$84  = next_step;
    end
    if (rst) begin
      \$84  = 3'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$85  = status__payload;
    if (complete) begin
      if (ends) begin
        \$85  = \error$80 ;
      end
    end
    if (rst) begin
      \$85  = 3'h0;
    end
  end
  assign \packets__payload$1  = packets__payload;
  assign \packets__valid$3  = packets__valid;
  assign \packets__ready$5  = packets__ready;
  assign error = packet_error;
  assign \small  = 4'h0;
  assign left = 1'h0;
  assign most_items = 4'h0;
  assign allowed = 1'h0;
  assign terminated = 1'h0;
  assign running = 1'h0;
  assign unit_log2 = 3'h0;
  assign all_served = reached_1;
  assign raised = 3'h0;
  assign leads = 1'h0;
  assign \packets__payload.data  = packets__payload[63:0];
  assign \packets__payload.data[0]  = packets__payload[7:0];
  assign \packets__payload.data[1]  = packets__payload[15:8];
  assign \packets__payload.data[2]  = packets__payload[23:16];
  assign \packets__payload.data[3]  = packets__payload[31:24];
  assign \packets__payload.data[4]  = packets__payload[39:32];
  assign \packets__payload.data[5]  = packets__payload[47:40];
  assign \packets__payload.data[6]  = packets__payload[55:48];
  assign \packets__payload.data[7]  = packets__payload[63:56];
  assign \packets__payload.count  = packets__payload[67:64];
  assign \packets__payload.last  = packets__payload[68];
  assign \packets__payload$1.data  = packets__payload[63:0];
  assign \packets__payload$1.data[0]  = packets__payload[7:0];
  assign \packets__payload$1.data[1]  = packets__payload[15:8];
  assign \packets__payload$1.data[2]  = packets__payload[23:16];
  assign \packets__payload$1.data[3]  = packets__payload[31:24];
  assign \packets__payload$1.data[4]  = packets__payload[39:32];
  assign \packets__payload$1.data[5]  = packets__payload[47:40];
  assign \packets__payload$1.data[6]  = packets__payload[55:48];
  assign \packets__payload$1.data[7]  = packets__payload[63:56];
  assign \packets__payload$1.count  = packets__payload[67:64];
  assign \packets__payload$1.last  = packets__payload[68];
  assign \word__payload.data  = word__payload[63:0];
  assign \word__payload.data[0]  = word__payload[7:0];
  assign \word__payload.data[1]  = word__payload[15:8];
  assign \word__payload.data[2]  = word__payload[23:16];
  assign \word__payload.data[3]  = word__payload[31:24];
  assign \word__payload.data[4]  = word__payload[39:32];
  assign \word__payload.data[5]  = word__payload[47:40];
  assign \word__payload.data[6]  = word__payload[55:48];
  assign \word__payload.data[7]  = word__payload[63:56];
  assign \word__payload.count  = word__payload[67:64];
  assign \word__payload.align  = word__payload[70:68];
  assign \word__payload.last  = word__payload[71];
  assign \word__payload.error  = word__payload[72];
  assign \word.data  = word[63:0];
  assign \word.data[0]  = word[7:0];
  assign \word.data[1]  = word[15:8];
  assign \word.data[2]  = word[23:16];
  assign \word.data[3]  = word[31:24];
  assign \word.data[4]  = word[39:32];
  assign \word.data[5]  = word[47:40];
  assign \word.data[6]  = word[55:48];
  assign \word.data[7]  = word[63:56];
  assign \word.count  = word[67:64];
  assign \word.align  = word[70:68];
  assign \word.last  = word[71];
  assign \word.error  = word[72];
  assign word__payload[63:0] = { lane_7, lane_6, lane_5, lane_4, lane_3, lane_2, lane_1, lane_0 };
  assign word__payload[72:64] = word[72:64];
  assign lane_used[7] = \$42 ;
  assign lane_used[6] = \$40 ;
  assign lane_used[5] = \$38 ;
  assign lane_used[4] = \$36 ;
  assign lane_used[3] = \$34 ;
  assign lane_used[2] = \$32 ;
  assign lane_used[1] = \$30 ;
  assign lane_used[0] = \$28 ;
  assign run_bytes = 4'h0;
  assign \$9  = 1'h0;
  assign \$10  = 1'h1;
  assign \$11  = 1'h1;
  assign \final  = 1'h1;
  assign \$12  = 1'h0;
  assign has_items = 1'h0;
  assign \$13  = 11'h000;
  assign \$14  = \$13 ;
  assign \$15  = 1'h1;
  assign \$16  = 5'h08;
  assign \$17  = 1'h1;
  assign \$18  = 1'h0;
  assign \$19  = 4'h4;
  assign \$20  = 1'h1;
  assign \$21  = 1'h0;
  assign \$22  = 3'h2;
  assign \$23  = 1'h1;
  assign \$24  = 1'h0;
  assign \$25  = 2'h1;
  assign \$26  = 1'h1;
  assign \$27  = 2'h0;
  assign \$28  = 1'h0;
  assign \$29  = 2'h1;
  assign \$30  = 1'h0;
  assign \$31  = 3'h2;
  assign \$32  = 1'h0;
  assign \$33  = 3'h3;
  assign \$34  = 1'h0;
  assign \$35  = 4'h4;
  assign \$36  = 1'h0;
  assign \$37  = 4'h5;
  assign \$38  = 1'h0;
  assign \$39  = 4'h6;
  assign \$40  = 1'h0;
  assign \$41  = 4'h7;
  assign \$42  = 1'h0;
  assign \$45  = \$44 ;
  assign reached_0 = \$46 ;
endmodule

module \geometry_msgs_msg_Twist_cdr_8_serializer.core.packer (packets__ready, rst, word__valid, packets__valid, error, word__ready, word__payload, packets__payload, aclk);
  reg \$auto$verilog_backend.cc:2355:dump_module$2  = 0;
  wire \$1 ;
  wire \$10 ;
  wire \$11 ;
  wire [4:0] \$12 ;
  wire [3:0] \$13 ;
  wire [3:0] \$14 ;
  wire \$15 ;
  wire [5:0] \$16 ;
  wire [5:0] \$17 ;
  wire [5:0] \$18 ;
  wire \$19 ;
  wire \$2 ;
  wire \$20 ;
  wire \$21 ;
  wire [6:0] \$22 ;
  wire [2:0] \$23 ;
  wire \$24 ;
  wire [63:0] \$25 ;
  wire [5:0] \$26 ;
  wire [6:0] \$27 ;
  wire \$28 ;
  wire \$29 ;
  wire [3:0] \$3 ;
  wire \$30 ;
  wire \$31 ;
  wire [7:0] \$32 ;
  wire \$33 ;
  wire \$34 ;
  wire \$35 ;
  wire [5:0] \$36 ;
  wire [3:0] \$37 ;
  wire [3:0] \$38 ;
  reg [63:0] \$39 ;
  wire [5:0] \$4 ;
  reg [4:0] \$40 ;
  reg \$41 ;
  reg [1:0] \$42 ;
  reg \$43 ;
  reg [3:0] \$44 ;
  reg \$45 ;
  wire [5:0] \$5 ;
  wire [63:0] \$6 ;
  wire \$7 ;
  wire \$8 ;
  wire \$9 ;
  reg [4:0] \$like ;
  input aclk;
  wire aclk;
  reg [4:0] beats;
  reg [1:0] end_beats = 2'h0;
  reg [3:0] end_count = 4'h0;
  reg ending = 1'h0;
  output error;
  wire error;
  reg \inside  = 1'h0;
  wire is_last;
  wire [63:0] kept;
  wire leaves;
  reg [4:0] level = 5'h00;
  reg marked = 1'h0;
  output [68:0] packets__payload;
  wire [68:0] packets__payload;
  wire [3:0] \packets__payload.count ;
  wire [63:0] \packets__payload.data ;
  wire [7:0] \packets__payload.data[0] ;
  wire [7:0] \packets__payload.data[1] ;
  wire [7:0] \packets__payload.data[2] ;
  wire [7:0] \packets__payload.data[3] ;
  wire [7:0] \packets__payload.data[4] ;
  wire [7:0] \packets__payload.data[5] ;
  wire [7:0] \packets__payload.data[6] ;
  wire [7:0] \packets__payload.data[7] ;
  wire \packets__payload.last ;
  input packets__ready;
  wire packets__ready;
  output packets__valid;
  wire packets__valid;
  wire [2:0] pad;
  wire [2:0] position;
  wire [4:0] rest;
  input rst;
  wire rst;
  wire still_ending;
  reg [63:0] store = 64'h0000000000000000;
  input [72:0] word__payload;
  wire [72:0] word__payload;
  wire [2:0] \word__payload.align ;
  wire [3:0] \word__payload.count ;
  wire [63:0] \word__payload.data ;
  wire [7:0] \word__payload.data[0] ;
  wire [7:0] \word__payload.data[1] ;
  wire [7:0] \word__payload.data[2] ;
  wire [7:0] \word__payload.data[3] ;
  wire [7:0] \word__payload.data[4] ;
  wire [7:0] \word__payload.data[5] ;
  wire [7:0] \word__payload.data[6] ;
  wire [7:0] \word__payload.data[7] ;
  wire \word__payload.error ;
  wire \word__payload.last ;
  output word__ready;
  wire word__ready;
  input word__valid;
  wire word__valid;
  always @(posedge aclk)
    end_beats <= \$42 ;
  always @(posedge aclk)
    \inside  <= \$43 ;
  always @(posedge aclk)
    end_count <= \$44 ;
  always @(posedge aclk)
    marked <= \$45 ;
  assign \$1  = level >= 4'h8;
  assign packets__valid = ending | \$1 ;
  assign \$2  = end_beats == 1'h1;
  assign is_last = ending & \$2 ;
  assign \$3  = is_last ? end_count : 4'h8;
  assign error = is_last & marked;
  assign leaves = packets__valid & packets__ready;
  assign \$4  = level - 4'h8;
  assign \$5  = leaves ? \$4  : { 1'h0, level };
  assign kept = leaves ? 64'h0000000000000000 : store;
  assign \$7  = leaves & is_last;
  assign \$8  = ~ \$7 ;
  assign still_ending = ending & \$8 ;
  assign \$9  = \$5 [4:0] <= 1'h0;
  assign \$10  = still_ending & word__payload[71];
  assign \$11  = ~ \$10 ;
  assign word__ready = \$9  & \$11 ;
  assign \$12  = 1'h0 + word__payload[67:64];
  assign \$13  = - \$12 [2:0];
  assign \$14  = \$13  & { 1'h0, word__payload[70:68] };
  assign \$15  = word__valid & word__ready;
  assign \$16  = \$5 [4:0] + word__payload[67:64];
  assign \$17  = \$like  + 3'h7;
  assign \$19  = ~ \inside ;
  assign \$20  = ! word__payload[67:64];
  assign \$21  = \$19  & \$20 ;
  assign \$22  = \$18  + \$21 ;
  assign \$23  = end_beats - 1'h1;
  assign \$24  = word__valid & word__ready;
  assign \$25  = kept | word__payload[63:0];
  assign \$26  = \$5 [4:0] + word__payload[67:64];
  assign \$27  = \$26  + \$14 [2:0];
  assign \$28  = ~ word__payload[71];
  assign \$29  = | word__payload[67:64];
  assign \$30  = \inside  | \$29 ;
  assign \$31  = \$28  & \$30 ;
  assign \$33  = ~ \inside ;
  assign \$34  = ! word__payload[67:64];
  assign \$35  = \$33  & \$34 ;
  assign \$36  = \$like  - 1'h1;
  assign \$37  = \$36 [2:0] + 1'h1;
  assign \$38  = \$35  ? 4'h0 : \$37 ;
  always @(posedge aclk)
    store <= \$39 ;
  always @(posedge aclk)
    level <= \$40 ;
  always @(posedge aclk)
    ending <= \$41 ;
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    \$42  = end_beats;
    if (leaves) begin
      \$42  = \$23 [1:0];
    end
    if (\$24 ) begin
      if (word__payload[71]) begin
        \$42  = beats[1:0];
      end
    end
    if (rst) begin
      \$42  = 2'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    \$43  = \inside ;
    if (\$24 ) begin
      \$43  = \$31 ;
    end
    if (rst) begin
      \$43  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    \$44  = end_count;
    if (\$24 ) begin
      if (word__payload[71]) begin
        \$44  = \$38 ;
      end
    end
    if (rst) begin
      \$44  = 4'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    \$45  = marked;
    if (\$24 ) begin
      if (word__payload[71]) begin
        \$45  = word__payload[72];
      end
    end
    if (rst) begin
      \$45  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    \$like  = 5'h00;
    if (\$15 ) begin
      if (word__payload[71]) begin
        \$like  = \$16 [4:0];
      end
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    beats = 5'h00;
    if (\$15 ) begin
      if (word__payload[71]) begin
        beats = \$22 [4:0];
      end
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    \$39  = kept;
    if (\$24 ) begin
      \$39  = \$25 ;
    end
    if (rst) begin
      \$39  = 64'h0000000000000000;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    \$40  = \$5 [4:0];
    if (\$24 ) begin
      \$40  = \$27 [4:0];
      if (word__payload[71]) begin
        \$40  = \$32 [4:0];
      end
    end
    if (rst) begin
      \$40  = 5'h00;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    \$41  = still_ending;
    if (\$24 ) begin
      if (word__payload[71]) begin
        \$41  = 1'h1;
      end
    end
    if (rst) begin
      \$41  = 1'h0;
    end
  end
  assign rest = \$5 [4:0];
  assign pad = \$14 [2:0];
  assign position = 3'h0;
  assign \packets__payload.data  = packets__payload[63:0];
  assign \packets__payload.data[0]  = packets__payload[7:0];
  assign \packets__payload.data[1]  = packets__payload[15:8];
  assign \packets__payload.data[2]  = packets__payload[23:16];
  assign \packets__payload.data[3]  = packets__payload[31:24];
  assign \packets__payload.data[4]  = packets__payload[39:32];
  assign \packets__payload.data[5]  = packets__payload[47:40];
  assign \packets__payload.data[6]  = packets__payload[55:48];
  assign \packets__payload.data[7]  = packets__payload[63:56];
  assign \packets__payload.count  = packets__payload[67:64];
  assign \packets__payload.last  = packets__payload[68];
  assign \word__payload.data  = word__payload[63:0];
  assign \word__payload.data[0]  = word__payload[7:0];
  assign \word__payload.data[1]  = word__payload[15:8];
  assign \word__payload.data[2]  = word__payload[23:16];
  assign \word__payload.data[3]  = word__payload[31:24];
  assign \word__payload.data[4]  = word__payload[39:32];
  assign \word__payload.data[5]  = word__payload[47:40];
  assign \word__payload.data[6]  = word__payload[55:48];
  assign \word__payload.data[7]  = word__payload[63:56];
  assign \word__payload.count  = word__payload[67:64];
  assign \word__payload.align  = word__payload[70:68];
  assign \word__payload.last  = word__payload[71];
  assign \word__payload.error  = word__payload[72];
  assign packets__payload[63:0] = store;
  assign packets__payload[67:64] = \$3 ;
  assign packets__payload[68] = is_last;
  assign \$6  = 64'h0000000000000000;
  assign \$18  = { 3'h0, \$17 [5:3] };
  assign \$32  = { beats, 3'h0 };
endmodule
