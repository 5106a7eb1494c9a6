// geometry_msgs_msg_Twist_cdr_8_deserializer: the deserializer of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
// lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
// definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
// What each port means: manifest.json.

module geometry_msgs_msg_Twist_cdr_8_deserializer(aresetn, s_axis_tdata, s_axis_tkeep, s_axis_tlast, s_axis_tvalid, linear_x_ready, linear_y_ready, linear_z_ready, angular_x_ready, angular_y_ready, angular_z_ready, m_axis_status_tready, s_axis_tready, linear_x_data, linear_x_valid, linear_y_data, linear_y_valid, linear_z_data, linear_z_valid, angular_x_data, angular_x_valid
, angular_y_data, angular_y_valid, angular_z_data, angular_z_valid, m_axis_status_tdata, m_axis_status_tvalid, aclk);
  wire \$1 ;
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
  wire \$41 ;
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
  assign \$3  = \$1  & \$2 ;
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
  assign \$42  = s_axis_tlast ? { \$41 , \$39 , \$26 , \$13  } : 4'h8;
  \geometry_msgs_msg_Twist_cdr_8_deserializer.core  core (
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
  assign packets__valid = s_axis_tvalid;
  assign packets__ready = s_axis_tready;
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
  assign packets__payload[68] = s_axis_tlast;
  assign packets__payload[67:64] = \$42 ;
  assign packets__payload[63:0] = s_axis_tdata;
  assign \$1  = s_axis_tkeep[0];
  assign \$41  = \$40 ;
endmodule

module \geometry_msgs_msg_Twist_cdr_8_deserializer.core (packets__valid, message__linear__x__ready, message__linear__y__ready, message__linear__z__ready, message__angular__x__ready, message__angular__y__ready, message__angular__z__ready, status__ready, rst, packets__ready, packets__payload, message__linear__x__valid, message__linear__y__valid, message__linear__z__valid, message__angular__x__valid, message__angular__y__valid, message__angular__z__valid, status__valid, message__linear__x__payload, message__linear__y__payload, message__linear__z__payload
, message__angular__x__payload, message__angular__y__payload, message__angular__z__payload, status__payload, aclk);
  reg \$auto$verilog_backend.cc:2355:dump_module$1  = 0;
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
  wire \$11 ;
  wire [4:0] \$110 ;
  wire \$111 ;
  wire \$112 ;
  wire \$113 ;
  wire \$114 ;
  wire \$115 ;
  wire \$116 ;
  wire [4:0] \$117 ;
  wire \$118 ;
  wire \$119 ;
  wire \$12 ;
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
  wire [63:0] \$130 ;
  wire \$131 ;
  wire \$132 ;
  wire \$133 ;
  wire \$134 ;
  wire \$135 ;
  wire [63:0] \$136 ;
  wire \$137 ;
  wire \$138 ;
  wire \$139 ;
  wire \$14 ;
  wire \$140 ;
  wire \$141 ;
  wire [63:0] \$142 ;
  wire \$143 ;
  wire \$144 ;
  wire \$145 ;
  wire \$146 ;
  wire \$147 ;
  wire [63:0] \$148 ;
  wire \$149 ;
  wire \$15 ;
  wire \$150 ;
  wire \$151 ;
  wire \$152 ;
  wire \$153 ;
  wire [63:0] \$154 ;
  wire \$155 ;
  wire \$156 ;
  wire \$157 ;
  wire \$158 ;
  wire \$159 ;
  wire \$16 ;
  wire [63:0] \$160 ;
  wire \$161 ;
  wire \$162 ;
  wire \$163 ;
  wire [1:0] \$164 ;
  wire [2:0] \$165 ;
  wire [3:0] \$166 ;
  wire \$167 ;
  wire \$168 ;
  wire \$169 ;
  wire \$17 ;
  wire \$170 ;
  wire \$171 ;
  wire [3:0] \$172 ;
  reg \$173 ;
  reg \$174 ;
  reg \$175 ;
  reg \$176 ;
  reg \$177 ;
  reg \$178 ;
  reg \$179 ;
  wire \$18 ;
  reg [31:0] \$180 ;
  reg [63:0] \$181 ;
  reg [63:0] \$182 ;
  reg [63:0] \$183 ;
  reg [63:0] \$184 ;
  reg [63:0] \$185 ;
  reg [63:0] \$186 ;
  reg \$187 ;
  reg [2:0] \$188 ;
  reg [2:0] \$189 ;
  wire \$19 ;
  reg [2:0] \$190 ;
  reg \$191 ;
  reg [2:0] \$192 ;
  wire [7:0] \$193 ;
  wire \$2 ;
  wire \$20 ;
  wire \$21 ;
  wire [10:0] \$22 ;
  wire [10:0] \$23 ;
  wire \$24 ;
  wire [4:0] \$25 ;
  wire \$26 ;
  wire \$27 ;
  wire [3:0] \$28 ;
  wire \$29 ;
  wire \$3 ;
  wire \$30 ;
  wire [2:0] \$31 ;
  wire \$32 ;
  wire \$33 ;
  wire [1:0] \$34 ;
  wire \$35 ;
  wire [1:0] \$36 ;
  wire \$37 ;
  wire [1:0] \$38 ;
  wire \$39 ;
  wire \$4 ;
  wire [2:0] \$40 ;
  wire \$41 ;
  wire [2:0] \$42 ;
  wire \$43 ;
  wire [3:0] \$44 ;
  wire \$45 ;
  wire [3:0] \$46 ;
  wire \$47 ;
  wire [3:0] \$48 ;
  wire \$49 ;
  wire \$5 ;
  wire [3:0] \$50 ;
  wire \$51 ;
  wire \$52 ;
  wire \$53 ;
  wire \$54 ;
  wire \$55 ;
  wire \$56 ;
  wire \$57 ;
  wire \$58 ;
  wire \$59 ;
  wire \$6 ;
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
  wire \$8 ;
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
  wire \$9 ;
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
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  reg [2:0] \$signal ;
  wire \$signal$50 ;
  reg able_0;
  input aclk;
  wire aclk;
  reg [2:0] align;
  wire [2:0] \align$64 ;
  wire all_served;
  wire allowed;
  reg [3:0] base;
  reg [3:0] behind;
  wire [3:0] \behind$51 ;
  reg [31:0] carry = 32'd0;
  wire complete;
  wire [3:0] count;
  wire [63:0] data;
  wire [7:0] \data[0] ;
  wire [7:0] \data[1] ;
  wire [7:0] \data[2] ;
  wire [7:0] \data[3] ;
  wire [7:0] \data[4] ;
  wire [7:0] \data[5] ;
  wire [7:0] \data[6] ;
  wire [7:0] \data[7] ;
  reg done;
  reg draining = 1'h0;
  reg drop;
  wire enable;
  wire ended;
  reg ends;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  reg [2:0] error = 3'h0;
  reg [2:0] extra = 3'h0;
  wire \final ;
  wire finish;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  reg [2:0] finished;
  wire [3:0] first_bytes;
  wire first_last;
  wire fresh;
  wire go_0;
  wire has_items;
  wire [11:0] have;
  wire held;
  wire [7:0] lane_used;
  reg last_items;
  wire left;
  reg map_there;
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
  reg mismatch;
  wire [3:0] most_items;
  reg [2:0] next_step;
  wire nul_missing;
  wire over;
  input [68:0] packets__payload;
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
  output packets__ready;
  wire packets__ready;
  wire \packets__ready$5 ;
  input packets__valid;
  wire packets__valid;
  wire \packets__valid$3 ;
  wire promised;
  wire reached_0;
  input rst;
  wire rst;
  wire [3:0] run_bytes;
  wire [71:0] \run_bytes$54 ;
  wire [12:0] run_have;
  wire running;
  reg served_0 = 1'h0;
  wire [3:0] \small ;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  reg [2:0] status;
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
  wire take;
  wire terminated;
  wire [3:0] total;
  wire [2:0] unit_log2;
  assign \$1  = | data[7:0];
  assign \$2  = \$193 [0] & \$1 ;
  assign \$3  = data[15:8] != 1'h1;
  assign \$4  = \$193 [1] & \$3 ;
  assign \$5  = | { \$4 , \$2  };
  assign \$6  = ~ message__linear__x__valid;
  assign \$7  = \$6  | message__linear__x__ready;
  assign \$8  = ~ message__linear__y__valid;
  assign \$9  = \$8  | message__linear__y__ready;
  assign \$10  = ~ message__linear__z__valid;
  assign \$11  = \$10  | message__linear__z__ready;
  assign \$12  = ~ message__angular__x__valid;
  assign \$13  = \$12  | message__angular__x__ready;
  assign \$14  = ~ message__angular__y__valid;
  assign \$15  = \$14  | message__angular__y__ready;
  assign \$16  = ~ message__angular__z__valid;
  assign \$17  = \$16  | message__angular__z__ready;
  assign \$52  = ~ served_0;
  assign \$53  = enable & \$52 ;
  assign go_0 = \$54  & able_0;
  assign \$55  = served_0 | able_0;
  assign fresh = ~ served_0;
  assign \$94  = | error;
  assign \$95  = ~ \$94 ;
  assign \$96  = ~ map_there;
  assign \$97  = ~ \$signal$50 ;
  assign \$98  = ~ draining;
  assign \$99  = | error;
  assign \$100  = map_there | ended;
  assign \$101  = held & \$100 ;
  assign \$102  = \$99  | \$101 ;
  assign enable = \$98  & \$102 ;
  assign \$103  = | error;
  assign \$104  = \$103  | \$signal$50 ;
  assign promised = \$104  | ended;
  assign \$105  = enable & reached_0;
  assign \$106  = ~ ends;
  assign \$107  = ~ status__valid;
  assign \$108  = \$107  | status__ready;
  assign \$109  = \$106  | \$108 ;
  assign complete = \$105  & \$109 ;
  assign \$110  = base + 4'h0;
  assign \$111  = | error;
  assign \$112  = ~ \$111 ;
  assign \$113  = complete & \$112 ;
  assign \$114  = ~ ends;
  assign take = \$113  & \$114 ;
  assign finish = complete & ends;
  assign \$115  = ! \$signal ;
  assign \$116  = \$115  & \behind$51 [3];
  assign \$117  = extra + first_bytes;
  assign \$118  = ! error;
  assign \$119  = \$117 [3:0] > 2'h3;
  assign \$120  = \$118  & \$119 ;
  assign \$121  = draining & held;
  assign \$122  = ~ first_last;
  assign \$123  = ~ status__valid;
  assign \$124  = \$123  | status__ready;
  assign \$125  = | error;
  assign \$126  = ~ \$125 ;
  assign \$127  = \$193 [3] & \$126 ;
  assign \$128  = ~ mismatch;
  assign \$129  = \$127  & \$128 ;
  assign \$130  = \$129  ? { data[31:0], carry } : 64'h0000000000000000;
  assign \$131  = | error;
  assign \$132  = ~ \$131 ;
  assign \$133  = \$193 [3] & \$132 ;
  assign \$134  = ~ mismatch;
  assign \$135  = \$133  & \$134 ;
  assign \$136  = \$135  ? { data[31:0], carry } : 64'h0000000000000000;
  assign \$137  = | error;
  assign \$138  = ~ \$137 ;
  assign \$139  = \$193 [3] & \$138 ;
  assign \$140  = ~ mismatch;
  assign \$141  = \$139  & \$140 ;
  assign \$142  = \$141  ? { data[31:0], carry } : 64'h0000000000000000;
  assign \$143  = | error;
  assign \$144  = ~ \$143 ;
  assign \$145  = \$193 [3] & \$144 ;
  assign \$146  = ~ mismatch;
  assign \$147  = \$145  & \$146 ;
  assign \$148  = \$147  ? { data[31:0], carry } : 64'h0000000000000000;
  assign \$149  = | error;
  assign \$150  = ~ \$149 ;
  assign \$151  = \$193 [3] & \$150 ;
  assign \$152  = ~ mismatch;
  assign \$153  = \$151  & \$152 ;
  assign \$154  = \$153  ? { data[31:0], carry } : 64'h0000000000000000;
  assign \$155  = | error;
  assign \$156  = ~ \$155 ;
  assign \$157  = \$193 [3] & \$156 ;
  assign \$158  = ~ mismatch;
  assign \$159  = \$157  & \$158 ;
  assign \$160  = \$159  ? { data[31:0], carry } : 64'h0000000000000000;
  assign \$161  = served_0 | go_0;
  assign \$162  = ~ complete;
  assign \$163  = \$161  & \$162 ;
  assign \$164  = \behind$51 [0] + \behind$51 [1];
  assign \$165  = \$164  + \behind$51 [2];
  assign \$166  = \$165  + \behind$51 [3];
  assign \$167  = draining & held;
  assign \$168  = ~ first_last;
  assign \$169  = ~ status__valid;
  assign \$170  = \$169  | status__ready;
  assign \$171  = \$117 [3:0] > 2'h3;
  assign \$172  = \$171  ? 4'h4 : \$117 [3:0];
  always @(posedge aclk)
    message__linear__x__valid <= \$173 ;
  always @(posedge aclk)
    message__linear__y__valid <= \$174 ;
  always @(posedge aclk)
    message__linear__z__valid <= \$175 ;
  always @(posedge aclk)
    message__angular__x__valid <= \$176 ;
  always @(posedge aclk)
    message__angular__y__valid <= \$177 ;
  always @(posedge aclk)
    message__angular__z__valid <= \$178 ;
  always @(posedge aclk)
    status__valid <= \$179 ;
  always @(posedge aclk)
    carry <= \$180 ;
  always @(posedge aclk)
    message__linear__x__payload <= \$181 ;
  always @(posedge aclk)
    message__linear__y__payload <= \$182 ;
  always @(posedge aclk)
    message__linear__z__payload <= \$183 ;
  always @(posedge aclk)
    message__angular__x__payload <= \$184 ;
  always @(posedge aclk)
    message__angular__y__payload <= \$185 ;
  always @(posedge aclk)
    message__angular__z__payload <= \$186 ;
  always @(posedge aclk)
    served_0 <= \$187 ;
  always @(posedge aclk)
    step <= \$188 ;
  always @(posedge aclk)
    error <= \$189 ;
  always @(posedge aclk)
    status__payload <= \$190 ;
  always @(posedge aclk)
    draining <= \$191 ;
  always @(posedge aclk)
    extra <= \$192 ;
  \geometry_msgs_msg_Twist_cdr_8_deserializer.core.window  window (
    .aclk(aclk),
    .count(\$110 [3:0]),
    .data(data),
    .drop(drop),
    .ended(ended),
    .ends_0(first_last),
    .finish(finish),
    .first_bytes(first_bytes),
    .held(held),
    .packets__payload(packets__payload),
    .packets__ready(packets__ready),
    .packets__valid(packets__valid),
    .\port$341$0 (\$193 ),
    .rst(rst),
    .take(take)
  );
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    map_there = 1'h0;
    casez (step)
      3'h0:
          map_there = \$193 [7];
      3'h1:
          map_there = \$193 [7];
      3'h2:
          map_there = \$193 [7];
      3'h3:
          map_there = \$193 [7];
      3'h4:
          map_there = \$193 [7];
      3'h5:
          map_there = \$193 [7];
      3'h6:
          map_there = \$193 [3];
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    behind = 4'h0;
    casez (step)
      3'h0:
          behind = 4'h0;
      3'h1:
          behind = 4'h0;
      3'h2:
          behind = 4'h0;
      3'h3:
          behind = 4'h0;
      3'h4:
          behind = 4'h0;
      3'h5:
          behind = 4'h0;
      3'h6:
          behind = \$193 [7:4];
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    mismatch = 1'h0;
    casez (step)
      3'h0:
          mismatch = \$5 ;
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
    able_0 = 1'h1;
    casez (step)
      3'h0:
          /* empty */;
      3'h1:
          able_0 = \$7 ;
      3'h2:
          able_0 = \$9 ;
      3'h3:
          able_0 = \$11 ;
      3'h4:
          able_0 = \$13 ;
      3'h5:
          able_0 = \$15 ;
      3'h6:
          able_0 = \$17 ;
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
    if (\$24 ) begin
      last_items = \$26 ;
    end
    if (\$27 ) begin
      last_items = \$29 ;
    end
    if (\$30 ) begin
      last_items = \$32 ;
    end
    if (\$33 ) begin
      last_items = \$35 ;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$signal  = error;
    if (\$95 ) begin
      casez ({ nul_missing, \$97 , 1'h0, \$96 , mismatch })
        5'b????1:
            \$signal  = 3'h4;
        5'b???1?:
            \$signal  = 3'h1;
        5'b?1???:
            \$signal  = 3'h1;
        5'h1?:
            \$signal  = 3'h5;
      endcase
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    finished = \$signal ;
    if (\$116 ) begin
      finished = 3'h2;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    status = error;
    if (\$120 ) begin
      status = 3'h2;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    drop = 1'h0;
    if (\$121 ) begin
      if (\$122 ) begin
        drop = 1'h1;
      end else if (\$124 ) begin
        drop = 1'h1;
      end
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$173  = message__linear__x__valid;
    if (message__linear__x__ready) begin
      \$173  = 1'h0;
    end
    casez (step)
      3'h0:
          /* empty */;
      3'h1:
          if (go_0) begin
            \$173  = 1'h1;
          end
    endcase
    if (rst) begin
      \$173  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$174  = message__linear__y__valid;
    if (message__linear__y__ready) begin
      \$174  = 1'h0;
    end
    casez (step)
      3'h0:
          /* empty */;
      3'h1:
          /* empty */;
      3'h2:
          if (go_0) begin
            \$174  = 1'h1;
          end
    endcase
    if (rst) begin
      \$174  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$175  = message__linear__z__valid;
    if (message__linear__z__ready) begin
      \$175  = 1'h0;
    end
    casez (step)
      3'h0:
          /* empty */;
      3'h1:
          /* empty */;
      3'h2:
          /* empty */;
      3'h3:
          if (go_0) begin
            \$175  = 1'h1;
          end
    endcase
    if (rst) begin
      \$175  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$176  = message__angular__x__valid;
    if (message__angular__x__ready) begin
      \$176  = 1'h0;
    end
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
          if (go_0) begin
            \$176  = 1'h1;
          end
    endcase
    if (rst) begin
      \$176  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$177  = message__angular__y__valid;
    if (message__angular__y__ready) begin
      \$177  = 1'h0;
    end
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
          if (go_0) begin
            \$177  = 1'h1;
          end
    endcase
    if (rst) begin
      \$177  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$178  = message__angular__z__valid;
    if (message__angular__z__ready) begin
      \$178  = 1'h0;
    end
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
          if (go_0) begin
            \$178  = 1'h1;
          end
    endcase
    if (rst) begin
      \$178  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$179  = status__valid;
    if (status__ready) begin
      \$179  = 1'h0;
    end
    if (complete) begin
      if (ends) begin
        if (ended) begin
          \$179  = 1'h1;
        end
      end
    end
    if (\$167 ) begin
      if (\$168 ) begin
      end else if (\$170 ) begin
        \$179  = 1'h1;
      end
    end
    if (rst) begin
      \$179  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$180  = carry;
    casez (step)
      3'h0:
          if (complete) begin
            \$180 [7:0] = data[39:32];
            \$180 [15:8] = data[47:40];
            \$180 [23:16] = data[55:48];
            \$180 [31:24] = data[63:56];
          end
      3'h1:
          if (complete) begin
            \$180 [7:0] = data[39:32];
            \$180 [15:8] = data[47:40];
            \$180 [23:16] = data[55:48];
            \$180 [31:24] = data[63:56];
          end
      3'h2:
          if (complete) begin
            \$180 [7:0] = data[39:32];
            \$180 [15:8] = data[47:40];
            \$180 [23:16] = data[55:48];
            \$180 [31:24] = data[63:56];
          end
      3'h3:
          if (complete) begin
            \$180 [7:0] = data[39:32];
            \$180 [15:8] = data[47:40];
            \$180 [23:16] = data[55:48];
            \$180 [31:24] = data[63:56];
          end
      3'h4:
          if (complete) begin
            \$180 [7:0] = data[39:32];
            \$180 [15:8] = data[47:40];
            \$180 [23:16] = data[55:48];
            \$180 [31:24] = data[63:56];
          end
      3'h5:
          if (complete) begin
            \$180 [7:0] = data[39:32];
            \$180 [15:8] = data[47:40];
            \$180 [23:16] = data[55:48];
            \$180 [31:24] = data[63:56];
          end
    endcase
    if (rst) begin
      \$180  = 32'd0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$181  = message__linear__x__payload;
    casez (step)
      3'h0:
          /* empty */;
      3'h1:
          if (go_0) begin
            \$181  = \$130 ;
          end
    endcase
    if (rst) begin
      \$181  = 64'h0000000000000000;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$182  = message__linear__y__payload;
    casez (step)
      3'h0:
          /* empty */;
      3'h1:
          /* empty */;
      3'h2:
          if (go_0) begin
            \$182  = \$136 ;
          end
    endcase
    if (rst) begin
      \$182  = 64'h0000000000000000;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$183  = message__linear__z__payload;
    casez (step)
      3'h0:
          /* empty */;
      3'h1:
          /* empty */;
      3'h2:
          /* empty */;
      3'h3:
          if (go_0) begin
            \$183  = \$142 ;
          end
    endcase
    if (rst) begin
      \$183  = 64'h0000000000000000;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$184  = message__angular__x__payload;
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
          if (go_0) begin
            \$184  = \$148 ;
          end
    endcase
    if (rst) begin
      \$184  = 64'h0000000000000000;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$185  = message__angular__y__payload;
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
          if (go_0) begin
            \$185  = \$154 ;
          end
    endcase
    if (rst) begin
      \$185  = 64'h0000000000000000;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$186  = message__angular__z__payload;
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
          if (go_0) begin
            \$186  = \$160 ;
          end
    endcase
    if (rst) begin
      \$186  = 64'h0000000000000000;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$187  = \$163 ;
    if (rst) begin
      \$187  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$188  = step;
    if (complete) begin
      \$188  = next_step;
    end
    if (rst) begin
      \$188  = 3'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$189  = error;
    if (complete) begin
      \$189  = \$signal ;
      if (ends) begin
        if (ended) begin
          \$189  = 3'h0;
        end
      end
    end
    if (\$167 ) begin
      if (\$168 ) begin
      end else if (\$170 ) begin
        \$189  = 3'h0;
      end
    end
    if (rst) begin
      \$189  = 3'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$190  = status__payload;
    if (complete) begin
      if (ends) begin
        if (ended) begin
          \$190  = finished;
        end
      end
    end
    if (\$167 ) begin
      if (\$168 ) begin
      end else if (\$170 ) begin
        \$190  = status;
      end
    end
    if (rst) begin
      \$190  = 3'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$191  = draining;
    if (complete) begin
      if (ends) begin
        (* full_case = 32'd1 *)
        if (ended) begin
        end else begin
          \$191  = 1'h1;
        end
      end
    end
    if (\$167 ) begin
      if (\$168 ) begin
      end else if (\$170 ) begin
        \$191  = 1'h0;
      end
    end
    if (rst) begin
      \$191  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$192  = extra;
    if (complete) begin
      if (ends) begin
        (* full_case = 32'd1 *)
        if (ended) begin
        end else begin
          \$192  = \$166 [2:0];
        end
      end
    end
    if (\$167 ) begin
      if (\$168 ) begin
        \$192  = \$172 [2:0];
      end
    end
    if (rst) begin
      \$192  = 3'h0;
    end
  end
  assign \packets__payload$1  = packets__payload;
  assign \packets__valid$3  = packets__valid;
  assign \packets__ready$5  = packets__ready;
  assign have = { 4'h0, \$193  };
  assign \small  = 4'h0;
  assign left = 1'h0;
  assign most_items = 4'h0;
  assign allowed = 1'h0;
  assign terminated = 1'h0;
  assign running = 1'h0;
  assign unit_log2 = 3'h0;
  assign all_served = reached_0;
  assign run_have = 13'h0000;
  assign \run_bytes$54  = 72'h000000000000000000;
  assign over = 1'h0;
  assign count = \$110 [3:0];
  assign \align$64  = align;
  assign total = \$117 [3:0];
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
  assign \data[0]  = data[7:0];
  assign \data[1]  = data[15:8];
  assign \data[2]  = data[23:16];
  assign \data[3]  = data[31:24];
  assign \data[4]  = data[39:32];
  assign \data[5]  = data[47:40];
  assign \data[6]  = data[55:48];
  assign \data[7]  = data[63:56];
  assign nul_missing = 1'h0;
  assign \behind$51  = behind;
  assign \$signal$50  = map_there;
  assign lane_used[7] = \$51 ;
  assign lane_used[6] = \$49 ;
  assign lane_used[5] = \$47 ;
  assign lane_used[4] = \$45 ;
  assign lane_used[3] = \$43 ;
  assign lane_used[2] = \$41 ;
  assign lane_used[1] = \$39 ;
  assign lane_used[0] = \$37 ;
  assign run_bytes = 4'h0;
  assign \$18  = 1'h0;
  assign \$19  = 1'h1;
  assign \$20  = 1'h1;
  assign \final  = 1'h1;
  assign \$21  = 1'h0;
  assign has_items = 1'h0;
  assign \$22  = 11'h000;
  assign \$23  = \$22 ;
  assign \$24  = 1'h1;
  assign \$25  = 5'h08;
  assign \$26  = 1'h1;
  assign \$27  = 1'h0;
  assign \$28  = 4'h4;
  assign \$29  = 1'h1;
  assign \$30  = 1'h0;
  assign \$31  = 3'h2;
  assign \$32  = 1'h1;
  assign \$33  = 1'h0;
  assign \$34  = 2'h1;
  assign \$35  = 1'h1;
  assign \$36  = 2'h0;
  assign \$37  = 1'h0;
  assign \$38  = 2'h1;
  assign \$39  = 1'h0;
  assign \$40  = 3'h2;
  assign \$41  = 1'h0;
  assign \$42  = 3'h3;
  assign \$43  = 1'h0;
  assign \$44  = 4'h4;
  assign \$45  = 1'h0;
  assign \$46  = 4'h5;
  assign \$47  = 1'h0;
  assign \$48  = 4'h6;
  assign \$49  = 1'h0;
  assign \$50  = 4'h7;
  assign \$51  = 1'h0;
  assign \$54  = \$53 ;
  assign reached_0 = \$55 ;
  assign \$56  = 1'h0;
  assign \$57  = map_there;
  assign \$58  = 1'h0;
  assign \$59  = 1'h0;
  assign \$60  = 1'h0;
  assign \$61  = 1'h0;
  assign \$62  = 1'h0;
  assign \$63  = 1'h0;
  assign \$64  = 1'h0;
  assign \$65  = 1'h0;
  assign \$66  = 1'h0;
  assign \$67  = 1'h0;
  assign \$68  = 1'h0;
  assign \$69  = 1'h0;
  assign \$70  = 1'h0;
  assign \$71  = 1'h0;
  assign \$72  = 1'h0;
  assign \$73  = 1'h0;
  assign \$74  = 1'h0;
  assign \$75  = 1'h0;
  assign \$76  = 1'h0;
  assign \$77  = 1'h0;
  assign \$78  = 1'h0;
  assign \$79  = 1'h0;
  assign \$80  = 1'h0;
  assign \$81  = 1'h0;
  assign \$82  = 1'h0;
  assign \$83  = 1'h0;
  assign \$84  = 1'h0;
  assign \$85  = 1'h0;
  assign \$86  = 1'h0;
  assign \$87  = 1'h0;
  assign \$88  = 1'h0;
  assign \$89  = 1'h0;
  assign \$90  = 1'h0;
  assign \$91  = 1'h0;
  assign \$92  = 1'h0;
  assign \$93  = 1'h0;
endmodule

module \geometry_msgs_msg_Twist_cdr_8_deserializer.core.window (packets__valid, rst, count, take, finish, packets__ready, data, ends_0, \port$341$0 , ended, held, first_bytes, packets__payload, drop, aclk);
  reg \$auto$verilog_backend.cc:2355:dump_module$2  = 0;
  wire [1:0] \$1 ;
  wire \$10 ;
  wire [7:0] \$11 ;
  wire [7:0] \$12 ;
  wire \$13 ;
  wire \$14 ;
  wire \$15 ;
  wire [1:0] \$16 ;
  wire [2:0] \$17 ;
  wire [3:0] \$18 ;
  wire [4:0] \$19 ;
  wire \$2 ;
  wire [5:0] \$20 ;
  wire [6:0] \$21 ;
  wire [7:0] \$22 ;
  wire [7:0] \$23 ;
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
  wire [1:0] \$35 ;
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
  wire \$5 ;
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
  wire \$6 ;
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
  wire \$8 ;
  wire \$80 ;
  wire \$81 ;
  wire \$82 ;
  wire \$83 ;
  wire \$84 ;
  wire \$85 ;
  wire [2:0] \$86 ;
  wire \$87 ;
  wire [3:0] \$88 ;
  wire [1:0] \$89 ;
  wire \$9 ;
  wire \$90 ;
  wire [3:0] \$91 ;
  wire [2:0] \$92 ;
  reg \$93 ;
  reg [72:0] \$94 ;
  reg [72:0] \$95 ;
  reg [1:0] \$96 ;
  reg \$97 ;
  reg [4:0] \$98 ;
  input aclk;
  wire aclk;
  reg [72:0] beat_0;
  wire [63:0] \beat_0.data ;
  wire [7:0] \beat_0.keep ;
  wire \beat_0.last ;
  input [3:0] count;
  wire [3:0] count;
  output [63:0] data;
  wire [63:0] data;
  wire [7:0] \data[0] ;
  wire [7:0] \data[1] ;
  wire [7:0] \data[2] ;
  wire [7:0] \data[3] ;
  wire [7:0] \data[4] ;
  wire [7:0] \data[5] ;
  wire [7:0] \data[6] ;
  wire [7:0] \data[7] ;
  input drop;
  wire drop;
  output ended;
  wire ended;
  output ends_0;
  wire ends_0;
  reg [1:0] fill = 2'h0;
  input finish;
  wire finish;
  reg first = 1'h0;
  output [3:0] first_bytes;
  wire [3:0] first_bytes;
  wire first_last;
  reg free = 1'h0;
  wire [11:0] have;
  output held;
  wire held;
  reg [4:0] offset = 5'h00;
  input [68:0] packets__payload;
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
  output packets__ready;
  wire packets__ready;
  input packets__valid;
  wire packets__valid;
  wire [5:0] past;
  wire pops;
  reg pops_finished;
  reg pops_idle;
  reg pops_taken;
  output [7:0] \port$341$0 ;
  wire [7:0] \port$341$0 ;
  input rst;
  wire rst;
  reg [72:0] slot_0 = 73'h0000000000000000000;
  wire [63:0] \slot_0.data ;
  wire [7:0] \slot_0.keep ;
  wire \slot_0.last ;
  reg [72:0] slot_1 = 73'h0000000000000000000;
  wire [63:0] \slot_1.data ;
  wire [7:0] \slot_1.keep ;
  wire \slot_1.last ;
  input take;
  wire take;
  wire [5:0] taken;
  wire valid_0;
  assign \$1  = first + 1'h0;
  assign \$2  = fill > 1'h0;
  assign ends_0 = valid_0 & beat_0[72];
  assign \$3  = ! offset[4:3];
  assign \$4  = ! offset[4:3];
  assign \$5  = ! offset[4:3];
  assign \$6  = ! offset[4:3];
  assign \$7  = ! offset[4:3];
  assign \$8  = ! offset[4:3];
  assign \$9  = ! offset[4:3];
  assign \$10  = ! offset[4:3];
  assign \$11  = beat_0[71:64] & { \$10 , \$9 , \$8 , \$7 , \$6 , \$5 , \$4 , \$3  };
  assign \$12  = \$11  & { valid_0, valid_0, valid_0, valid_0, valid_0, valid_0, valid_0, valid_0 };
  assign \$13  = ! offset[4:3];
  assign \$14  = \$13  | beat_0[72];
  assign held = valid_0 & \$14 ;
  assign \$15  = ! offset[4:3];
  assign \$16  = beat_0[64] + beat_0[65];
  assign \$17  = \$16  + beat_0[66];
  assign \$18  = \$17  + beat_0[67];
  assign \$19  = \$18  + beat_0[68];
  assign \$20  = \$19  + beat_0[69];
  assign \$21  = \$20  + beat_0[70];
  assign \$22  = \$21  + beat_0[71];
  assign \$23  = \$15  ? \$22  : 8'h00;
  assign taken = offset + count;
  assign \$24  = ~ ends_0;
  assign \$25  = valid_0 & \$24 ;
  assign \$26  = taken[5:3] > 1'h0;
  assign \$27  = \$25  & \$26 ;
  assign \$28  = ~ ends_0;
  assign \$29  = valid_0 & \$28 ;
  assign \$30  = offset[4:3] > 1'h0;
  assign \$31  = \$29  & \$30 ;
  assign \$32  = take ? pops_taken : pops_idle;
  assign \$33  = drop ? 1'h1 : \$32 ;
  assign pops = finish ? pops_finished : \$33 ;
  assign \$34  = packets__valid & packets__ready;
  assign \$35  = free + 1'h1;
  assign \$36  = ! free;
  assign \$37  = ~ packets__payload[68];
  assign \$38  = packets__payload[67:64] > 1'h0;
  assign \$39  = \$37  | \$38 ;
  assign \$40  = ~ packets__payload[68];
  assign \$41  = packets__payload[67:64] > 1'h1;
  assign \$42  = \$40  | \$41 ;
  assign \$43  = ~ packets__payload[68];
  assign \$44  = packets__payload[67:64] > 2'h2;
  assign \$45  = \$43  | \$44 ;
  assign \$46  = ~ packets__payload[68];
  assign \$47  = packets__payload[67:64] > 2'h3;
  assign \$48  = \$46  | \$47 ;
  assign \$49  = ~ packets__payload[68];
  assign \$50  = packets__payload[67:64] > 3'h4;
  assign \$51  = \$49  | \$50 ;
  assign \$52  = ~ packets__payload[68];
  assign \$53  = packets__payload[67:64] > 3'h5;
  assign \$54  = \$52  | \$53 ;
  assign \$55  = ~ packets__payload[68];
  assign \$56  = packets__payload[67:64] > 3'h6;
  assign \$57  = \$55  | \$56 ;
  assign \$58  = ~ packets__payload[68];
  assign \$59  = packets__payload[67:64] > 3'h7;
  assign \$60  = \$58  | \$59 ;
  assign \$62  = ~ packets__payload[68];
  assign \$63  = packets__payload[67:64] > 1'h0;
  assign \$64  = \$62  | \$63 ;
  assign \$65  = ~ packets__payload[68];
  assign \$66  = packets__payload[67:64] > 1'h1;
  assign \$67  = \$65  | \$66 ;
  assign \$68  = ~ packets__payload[68];
  assign \$69  = packets__payload[67:64] > 2'h2;
  assign \$70  = \$68  | \$69 ;
  assign \$71  = ~ packets__payload[68];
  assign \$72  = packets__payload[67:64] > 2'h3;
  assign \$73  = \$71  | \$72 ;
  assign \$74  = ~ packets__payload[68];
  assign \$75  = packets__payload[67:64] > 3'h4;
  assign \$76  = \$74  | \$75 ;
  assign \$77  = ~ packets__payload[68];
  assign \$78  = packets__payload[67:64] > 3'h5;
  assign \$79  = \$77  | \$78 ;
  assign \$80  = ~ packets__payload[68];
  assign \$81  = packets__payload[67:64] > 3'h6;
  assign \$82  = \$80  | \$81 ;
  assign \$83  = ~ packets__payload[68];
  assign \$84  = packets__payload[67:64] > 3'h7;
  assign \$85  = \$83  | \$84 ;
  assign \$86  = fill - pops;
  assign \$87  = packets__valid & packets__ready;
  assign \$88  = $signed(\$86 ) + $signed({ 1'h0, \$87  });
  assign \$89  = first + pops;
  assign \$90  = finish | drop;
  assign \$91  = taken[5:3] - pops;
  assign \$92  = offset[4:3] - pops;
  always @(posedge aclk)
    free <= \$93 ;
  always @(posedge aclk)
    slot_0 <= \$94 ;
  always @(posedge aclk)
    slot_1 <= \$95 ;
  always @(posedge aclk)
    fill <= \$96 ;
  always @(posedge aclk)
    first <= \$97 ;
  always @(posedge aclk)
    offset <= \$98 ;
  assign packets__ready = fill < 2'h2;
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    (* full_case = 32'd1 *)
    casez (\$1 [0])
      1'h0:
          beat_0 = slot_0;
      1'h1:
          beat_0 = slot_1;
    endcase
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    pops_taken = 1'h0;
    if (\$27 ) begin
      pops_taken = 1'h1;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    pops_idle = 1'h0;
    if (\$31 ) begin
      pops_idle = 1'h1;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    pops_finished = 1'h0;
    if (valid_0) begin
      pops_finished = 1'h1;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    \$93  = free;
    if (\$34 ) begin
      \$93  = \$35 [0];
    end
    if (rst) begin
      \$93  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    \$94  = slot_0;
    if (\$34 ) begin
      if (\$36 ) begin
        \$94 [63:0] = packets__payload[63:0];
        \$94 [71:64] = { \$60 , \$57 , \$54 , \$51 , \$48 , \$45 , \$42 , \$39  };
        \$94 [72] = packets__payload[68];
      end
    end
    if (rst) begin
      \$94  = 73'h0000000000000000000;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    \$95  = slot_1;
    if (\$34 ) begin
      if (\$61 ) begin
        \$95 [63:0] = packets__payload[63:0];
        \$95 [71:64] = { \$85 , \$82 , \$79 , \$76 , \$73 , \$70 , \$67 , \$64  };
        \$95 [72] = packets__payload[68];
      end
    end
    if (rst) begin
      \$95  = 73'h0000000000000000000;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    \$96  = \$88 [1:0];
    if (rst) begin
      \$96  = 2'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    \$97  = \$89 [0];
    if (rst) begin
      \$97  = 1'h0;
    end
  end
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$2 ) begin end
    \$98 [2:0] = offset[2:0];
    (* full_case = 32'd1 *)
    if (\$90 ) begin
      \$98  = 5'h00;
    end else if (take) begin
      \$98  = { \$91 [1:0], 3'h0 };
    end else begin
      \$98 [4:3] = \$92 [1:0];
    end
    if (rst) begin
      \$98  = 5'h00;
    end
  end
  assign have = { 4'h0, \$12  };
  assign first_last = ends_0;
  assign past = taken;
  assign data = beat_0[63:0];
  assign \port$341$0  = \$12 ;
  assign first_bytes = \$23 [3:0];
  assign \beat_0.data  = beat_0[63:0];
  assign \beat_0.keep  = beat_0[71:64];
  assign \beat_0.last  = beat_0[72];
  assign \slot_0.data  = slot_0[63:0];
  assign \slot_0.keep  = slot_0[71:64];
  assign \slot_0.last  = slot_0[72];
  assign \slot_1.data  = slot_1[63:0];
  assign \slot_1.keep  = slot_1[71:64];
  assign \slot_1.last  = slot_1[72];
  assign \data[0]  = beat_0[7:0];
  assign \data[1]  = beat_0[15:8];
  assign \data[2]  = beat_0[23:16];
  assign \data[3]  = beat_0[31:24];
  assign \data[4]  = beat_0[39:32];
  assign \data[5]  = beat_0[47:40];
  assign \data[6]  = beat_0[55:48];
  assign \data[7]  = beat_0[63:56];
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
  assign valid_0 = \$2 ;
  assign ended = ends_0;
  assign \$61  = free;
endmodule
