// geometry_msgs_msg_Twist_cdr_8_serializer_verilog: the serializer of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
// lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
// definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
// What each port means: manifest.json.

module geometry_msgs_msg_Twist_cdr_8_serializer_verilog(aresetn, m_axis_tready, linear_x_data, linear_x_valid, linear_y_data, linear_y_valid, linear_z_data, linear_z_valid, angular_x_data, angular_x_valid, angular_y_data, angular_y_valid, angular_z_data, angular_z_valid, m_axis_status_tready, m_axis_tdata, m_axis_tkeep, m_axis_tlast, m_axis_tuser, m_axis_tvalid, linear_x_ready
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
  assign m_axis_tkeep = { \$8 , \$7 , \$6 , \$5 , \$4 , \$3 , \$2 , \$1  };
  assign m_axis_status_tdata = { 5'h00, status__payload };
  \geometry_msgs_msg_Twist_cdr_8_serializer_verilog.core  core (
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
  assign m_axis_tlast = packets__payload[68];
  assign m_axis_tdata = packets__payload[63:0];
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
  assign packets__ready = m_axis_tready;
  assign packets__valid = m_axis_tvalid;
  assign packet_error = m_axis_tuser;
endmodule

module \geometry_msgs_msg_Twist_cdr_8_serializer_verilog.core (packets__ready, message__linear__x__payload, message__linear__x__valid, message__linear__y__payload, message__linear__y__valid, message__linear__z__payload, message__linear__z__valid, message__angular__x__payload, message__angular__x__valid, message__angular__y__payload, message__angular__y__valid, message__angular__z__payload, message__angular__z__valid, status__ready, rst, message__linear__x__ready, message__linear__y__ready, message__linear__z__ready, message__angular__x__ready, message__angular__y__ready, message__angular__z__ready
, status__valid, status__payload, packets__valid, packets__payload, packet_error, aclk);
  input aclk;
  wire aclk;
  wire error;
  input [63:0] message__angular__x__payload;
  wire [63:0] message__angular__x__payload;
  output message__angular__x__ready;
  wire message__angular__x__ready;
  input message__angular__x__valid;
  wire message__angular__x__valid;
  input [63:0] message__angular__y__payload;
  wire [63:0] message__angular__y__payload;
  output message__angular__y__ready;
  wire message__angular__y__ready;
  input message__angular__y__valid;
  wire message__angular__y__valid;
  input [63:0] message__angular__z__payload;
  wire [63:0] message__angular__z__payload;
  output message__angular__z__ready;
  wire message__angular__z__ready;
  input message__angular__z__valid;
  wire message__angular__z__valid;
  input [63:0] message__linear__x__payload;
  wire [63:0] message__linear__x__payload;
  output message__linear__x__ready;
  wire message__linear__x__ready;
  input message__linear__x__valid;
  wire message__linear__x__valid;
  input [63:0] message__linear__y__payload;
  wire [63:0] message__linear__y__payload;
  output message__linear__y__ready;
  wire message__linear__y__ready;
  input message__linear__y__valid;
  wire message__linear__y__valid;
  input [63:0] message__linear__z__payload;
  wire [63:0] message__linear__z__payload;
  output message__linear__z__ready;
  wire message__linear__z__ready;
  input message__linear__z__valid;
  wire message__linear__z__valid;
  output packet_error;
  wire packet_error;
  output [68:0] packets__payload;
  wire [68:0] packets__payload;
  wire [68:0] \packets__payload$7 ;
  wire [3:0] \packets__payload$7.count ;
  wire [63:0] \packets__payload$7.data ;
  wire [7:0] \packets__payload$7.data_0 ;
  wire [7:0] \packets__payload$7.data_1 ;
  wire [7:0] \packets__payload$7.data_2 ;
  wire [7:0] \packets__payload$7.data_3 ;
  wire [7:0] \packets__payload$7.data_4 ;
  wire [7:0] \packets__payload$7.data_5 ;
  wire [7:0] \packets__payload$7.data_6 ;
  wire [7:0] \packets__payload$7.data_7 ;
  wire \packets__payload$7.last ;
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
  input packets__ready;
  wire packets__ready;
  wire \packets__ready$11 ;
  output packets__valid;
  wire packets__valid;
  wire \packets__valid$9 ;
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
  wire [2:0] \status__payload$15 ;
  input status__ready;
  wire status__ready;
  wire \status__ready$19 ;
  output status__valid;
  wire status__valid;
  wire \status__valid$17 ;
  (* unused_bits = "0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32 33 34 35 36 37 38 39 40 41 42 43 44 45 46 47 48 49 50 51 52 53 54 55 56 57 58 59 60 61 62 63 64 65 66 67 68 69 70 71 72 73 74 75 76 77 78 79 80 81 82 83 84 85 86 87 88 89 90 91 92 93 94 95 96 97 98 99 100 101 102 103 104 105 106 107 108 109 110 111 112 113 114 115 116 117 118 119 120 121 122 123 124 125 126 127 128 129 130 131 132 133 134 135 136 137 138 139 140 141 142 143 144 145 146 147 148 149 150 151 152 153 154 155 156 157 158 159 160" *)
  wire [160:0] words__payload;
  (* unused_bits = "0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32 33 34 35 36 37 38 39 40 41 42 43 44 45 46 47 48 49 50 51 52 53 54 55 56 57 58 59 60 61 62 63 64 65 66 67 68 69 70 71 72 73 74 75 76 77 78 79 80 81 82 83 84 85 86 87 88 89 90 91 92 93 94 95 96 97 98 99 100 101 102 103 104 105 106 107 108 109 110 111 112 113 114 115 116 117 118 119 120 121 122 123 124 125 126 127 128 129 130 131 132 133 134 135 136 137 138 139 140 141 142 143 144 145 146 147 148 149 150 151 152 153 154 155 156 157 158 159 160" *)
  wire [160:0] \words__payload$1 ;
  wire \words__payload$1.empty ;
  wire [2:0] \words__payload$1.end_mask ;
  wire \words__payload$1.error ;
  wire [63:0] \words__payload$1.items ;
  wire [3:0] \words__payload$1.items_bytes ;
  wire \words__payload$1.last ;
  wire \words__payload$1.lead ;
  wire [63:0] \words__payload$1.map ;
  wire [3:0] \words__payload$1.map_bytes ;
  wire [2:0] \words__payload$1.map_mask ;
  wire [2:0] \words__payload$1.max_beats ;
  wire [5:0] \words__payload$1.to_end ;
  wire [4:0] \words__payload$1.to_map ;
  wire \words__payload$1.waits ;
  wire \words__payload.empty ;
  wire [2:0] \words__payload.end_mask ;
  wire \words__payload.error ;
  wire [63:0] \words__payload.items ;
  wire [3:0] \words__payload.items_bytes ;
  wire \words__payload.last ;
  wire \words__payload.lead ;
  wire [63:0] \words__payload.map ;
  wire [3:0] \words__payload.map_bytes ;
  wire [2:0] \words__payload.map_mask ;
  wire [2:0] \words__payload.max_beats ;
  wire [5:0] \words__payload.to_end ;
  wire [4:0] \words__payload.to_map ;
  wire \words__payload.waits ;
  wire words__ready;
  wire \words__ready$5 ;
  wire words__valid;
  wire \words__valid$3 ;
  assign words__payload = { \words__payload$1.error , \words__payload$1.waits , \words__payload$1.empty , \words__payload$1.last , \words__payload$1.max_beats , \words__payload$1.end_mask , \words__payload$1.to_end , \words__payload$1.map_mask , \words__payload$1.to_map , \words__payload$1.lead , \words__payload$1.map_bytes , \words__payload$1.items_bytes , \words__payload$1.map , \words__payload$1.items  };
  assign \words__payload$1  = { \words__payload$1.error , \words__payload$1.waits , \words__payload$1.empty , \words__payload$1.last , \words__payload$1.max_beats , \words__payload$1.end_mask , \words__payload$1.to_end , \words__payload$1.map_mask , \words__payload$1.to_map , \words__payload$1.lead , \words__payload$1.map_bytes , \words__payload$1.items_bytes , \words__payload$1.map , \words__payload$1.items  };
  \geometry_msgs_msg_Twist_cdr_8_serializer_verilog.core.collector  collector (
    .aclk(aclk),
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
    .rst(rst),
    .status__payload(status__payload),
    .status__ready(status__ready),
    .status__valid(status__valid),
    .words__payload_0({ \words__payload$1.map , \words__payload$1.items  }),
    .words__payload_128({ \words__payload$1.error , \words__payload$1.waits , \words__payload$1.empty , \words__payload$1.last , \words__payload$1.max_beats , \words__payload$1.end_mask , \words__payload$1.to_end , \words__payload$1.map_mask , \words__payload$1.to_map , \words__payload$1.lead , \words__payload$1.map_bytes , \words__payload$1.items_bytes  }),
    .words__ready(words__ready),
    .words__valid(words__valid)
  );
  \geometry_msgs_msg_Twist_cdr_8_serializer_verilog.core.packer  packer (
    .aclk(aclk),
    .error(packet_error),
    .packets__payload(packets__payload),
    .packets__ready(packets__ready),
    .packets__valid(packets__valid),
    .rst(rst),
    .words__payload_0({ \words__payload$1.map , \words__payload$1.items  }),
    .words__payload_128({ \words__payload$1.error , \words__payload$1.waits , \words__payload$1.empty , \words__payload$1.last , \words__payload$1.max_beats , \words__payload$1.end_mask , \words__payload$1.to_end , \words__payload$1.map_mask , \words__payload$1.to_map , \words__payload$1.lead , \words__payload$1.map_bytes , \words__payload$1.items_bytes  }),
    .words__ready(words__ready),
    .words__valid(words__valid)
  );
  assign \packets__payload$7.data_7  = packets__payload[63:56];
  assign \packets__payload$7.data_6  = packets__payload[55:48];
  assign \packets__payload$7.data_5  = packets__payload[47:40];
  assign \packets__payload$7.data_4  = packets__payload[39:32];
  assign \packets__payload$7.data_3  = packets__payload[31:24];
  assign \packets__payload$7.data_2  = packets__payload[23:16];
  assign \packets__payload$7.data_1  = packets__payload[15:8];
  assign \packets__payload$7.data_0  = packets__payload[7:0];
  assign \packets__payload$7.data  = packets__payload[63:0];
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
  assign \words__payload.error  = \words__payload$1.error ;
  assign \words__payload.waits  = \words__payload$1.waits ;
  assign \words__payload.empty  = \words__payload$1.empty ;
  assign \words__payload.last  = \words__payload$1.last ;
  assign \words__payload.max_beats  = \words__payload$1.max_beats ;
  assign \words__payload.end_mask  = \words__payload$1.end_mask ;
  assign \words__payload.to_end  = \words__payload$1.to_end ;
  assign \words__payload.map_mask  = \words__payload$1.map_mask ;
  assign \words__payload.to_map  = \words__payload$1.to_map ;
  assign \words__payload.lead  = \words__payload$1.lead ;
  assign \words__payload.map_bytes  = \words__payload$1.map_bytes ;
  assign \words__payload.items_bytes  = \words__payload$1.items_bytes ;
  assign \words__payload.map  = \words__payload$1.map ;
  assign \words__payload.items  = \words__payload$1.items ;
  assign \packets__payload$7.count  = packets__payload[67:64];
  assign \packets__payload$7.last  = packets__payload[68];
  assign \status__ready$19  = status__ready;
  assign \status__valid$17  = status__valid;
  assign \status__payload$15  = status__payload;
  assign error = packet_error;
  assign \packets__ready$11  = packets__ready;
  assign \packets__valid$9  = packets__valid;
  assign \packets__payload$7  = packets__payload;
  assign \words__ready$5  = words__ready;
  assign \words__valid$3  = words__valid;
endmodule

module \geometry_msgs_msg_Twist_cdr_8_serializer_verilog.core.collector (message__linear__x__payload, message__linear__x__valid, message__linear__y__payload, message__linear__y__valid, message__linear__z__payload, message__linear__z__valid, message__angular__x__payload, message__angular__x__valid, message__angular__y__payload, message__angular__y__valid, message__angular__z__payload, message__angular__z__valid, status__ready, rst, message__linear__x__ready, message__linear__y__ready, message__linear__z__ready, message__angular__x__ready, message__angular__y__ready, message__angular__z__ready, words__payload_0
, words__payload_128, status__valid, status__payload, words__valid, words__ready, aclk);
  wire \$100 ;
  wire \$101 ;
  wire \$102 ;
  wire \$104 ;
  wire \$105 ;
  wire \$106 ;
  wire \$107 ;
  wire [31:0] \$109 ;
  wire [31:0] \$111 ;
  wire [31:0] \$112 ;
  wire [31:0] \$114 ;
  wire [31:0] \$116 ;
  wire [31:0] \$117 ;
  wire [31:0] \$118 ;
  wire [31:0] \$120 ;
  wire [31:0] \$122 ;
  wire [31:0] \$123 ;
  wire [31:0] \$124 ;
  wire [31:0] \$128 ;
  wire \$13 ;
  wire [31:0] \$130 ;
  wire [31:0] \$131 ;
  wire [31:0] \$133 ;
  wire [31:0] \$135 ;
  wire [31:0] \$136 ;
  wire [31:0] \$137 ;
  wire [31:0] \$139 ;
  wire \$14 ;
  wire [31:0] \$140 ;
  wire \$142 ;
  wire \$144 ;
  wire \$145 ;
  wire \$147 ;
  wire \$149 ;
  wire \$15 ;
  wire \$150 ;
  wire \$151 ;
  wire \$152 ;
  wire [6:0] \$153 ;
  (* unused_bits = "0 1 2 6 7" *)
  wire [7:0] \$154 ;
  wire \$156 ;
  wire \$19 ;
  wire \$190 ;
  wire [32:0] \$194 ;
  wire \$196 ;
  wire \$197 ;
  wire [2:0] \$198 ;
  wire \$199 ;
  wire \$20 ;
  wire [2:0] \$200 ;
  wire [31:0] \$201 ;
  wire [31:0] \$202 ;
  wire [31:0] \$203 ;
  wire [31:0] \$204 ;
  wire \$205 ;
  wire \$206 ;
  wire [5:0] \$209 ;
  wire \$21 ;
  wire [3:0] \$210 ;
  wire [3:0] \$211 ;
  wire \$212 ;
  wire \$25 ;
  wire \$26 ;
  wire \$27 ;
  wire \$31 ;
  wire \$32 ;
  wire \$33 ;
  wire \$37 ;
  wire \$38 ;
  wire \$39 ;
  wire \$43 ;
  wire \$44 ;
  wire \$45 ;
  wire \$46 ;
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
  wire [3:0] \$72 ;
  wire \$73 ;
  wire \$74 ;
  wire \$76 ;
  wire [3:0] \$77 ;
  wire [4:0] \$78 ;
  (* unused_bits = "5" *)
  wire [5:0] \$79 ;
  wire [5:0] \$80 ;
  wire [5:0] \$81 ;
  wire [5:0] \$82 ;
  wire \$91 ;
  wire \$92 ;
  wire \$93 ;
  wire \$94 ;
  wire \$96 ;
  wire \$97 ;
  wire \$98 ;
  wire \$99 ;
  wire choice_388_Y ;
  wire choice_390_Y ;
  wire [3:0] choice_397_Y ;
  wire [3:0] choice_399_Y ;
  wire [3:0] choice_406_Y ;
  wire [3:0] choice_408_Y ;
  wire [5:0] choice_415_Y ;
  wire [5:0] choice_417_Y ;
  wire choice_425_Y ;
  wire choice_429_Y ;
  wire [2:0] choice_441_Y ;
  wire choice_445_Y ;
  wire choice_447_Y ;
  wire [2:0] choice_451_Y ;
  wire choice_465_Y ;
  wire choice_469_Y ;
  wire [2:0] choice_473_Y ;
  wire [2:0] choice_477_Y ;
  wire [4:0] choice_481_Y ;
  wire [2:0] choice_485_Y ;
  wire [5:0] choice_489_Y ;
  wire choice_493_Y ;
  wire [3:0] choice_497_Y ;
  wire [3:0] choice_501_Y ;
  wire choice_505_Y ;
  wire choice_509_Y ;
  input aclk;
  wire aclk;
  wire begins;
  reg begun = 1'h0;
  wire complete;
  wire default_0;
  wire default_1;
  wire default_2;
  wire default_3;
  wire default_4;
  wire default_5;
  wire done;
  wire [2:0] end_mask;
  wire ends;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  reg [2:0] error = 3'h0;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] found;
  wire free;
  wire go_1_0;
  wire go_2_0;
  wire go_3_0;
  wire go_4_0;
  wire go_5_0;
  wire go_5_1;
  reg [31:0] items_0 = 32'd0;
  reg [31:0] items_4 = 32'd0;
  reg [3:0] items_bytes = 4'h0;
  wire [3:0] items_size;
  wire lacks_1_0;
  wire lacks_2_0;
  wire lacks_3_0;
  wire lacks_4_0;
  wire lacks_5_0;
  wire lacks_5_1;
  wire left_1_0;
  wire left_2_0;
  wire left_3_0;
  wire left_4_0;
  wire left_5_0;
  wire left_5_1;
  reg [31:0] map_0 = 32'd0;
  reg [31:0] map_4 = 32'd0;
  reg [3:0] map_bytes = 4'h8;
  wire [4:0] map_size;
  input [63:0] message__angular__x__payload;
  wire [63:0] message__angular__x__payload;
  output message__angular__x__ready;
  wire message__angular__x__ready;
  input message__angular__x__valid;
  wire message__angular__x__valid;
  input [63:0] message__angular__y__payload;
  wire [63:0] message__angular__y__payload;
  output message__angular__y__ready;
  wire message__angular__y__ready;
  input message__angular__y__valid;
  wire message__angular__y__valid;
  input [63:0] message__angular__z__payload;
  wire [63:0] message__angular__z__payload;
  output message__angular__z__ready;
  wire message__angular__z__ready;
  input message__angular__z__valid;
  wire message__angular__z__valid;
  input [63:0] message__linear__x__payload;
  wire [63:0] message__linear__x__payload;
  output message__linear__x__ready;
  wire message__linear__x__ready;
  input message__linear__x__valid;
  wire message__linear__x__valid;
  input [63:0] message__linear__y__payload;
  wire [63:0] message__linear__y__payload;
  output message__linear__y__ready;
  wire message__linear__y__ready;
  input message__linear__y__valid;
  wire message__linear__y__valid;
  input [63:0] message__linear__z__payload;
  wire [63:0] message__linear__z__payload;
  output message__linear__z__ready;
  wire message__linear__z__ready;
  input message__linear__z__valid;
  wire message__linear__z__valid;
  wire nul_now;
  input rst;
  wire rst;
  reg served_0 = 1'h0;
  reg served_1 = 1'h0;
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
  reg [5:0] step = 6'h01;
  wire step_to_body;
  wire [5:0] to_end;
  wire [4:0] to_map;
  reg two_word_map = 1'h0;
  (* unused_bits = "0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32 33 34 35 36 37 38 39 40 41 42 43 44 45 46 47 48 49 50 51 52 53 54 55 56 57 58 59 60 61 62 63 64 65 66 67 68 69 70 71 72 73 74 75 76 77 78 79 80 81 82 83 84 85 86 87 88 89 90 91 92 93 94 95 96 97 98 99 100 101 102 103 104 105 106 107 108 109 110 111 112 113 114 115 116 117 118 119 120 121 122 123 124 125 126 127 128 129 130 131 132 133 134 135 136 137 138 139 140 141 142 143 144 145 146 147 148 149 150 151 152 153 154 155 156 157 158 159 160" *)
  wire [160:0] words__payload;
  wire \words__payload.empty ;
  wire [2:0] \words__payload.end_mask ;
  wire \words__payload.error ;
  wire [63:0] \words__payload.items ;
  wire [3:0] \words__payload.items_bytes ;
  wire \words__payload.last ;
  wire \words__payload.lead ;
  wire [63:0] \words__payload.map ;
  wire [3:0] \words__payload.map_bytes ;
  wire [2:0] \words__payload.map_mask ;
  wire [2:0] \words__payload.max_beats ;
  wire [5:0] \words__payload.to_end ;
  wire [4:0] \words__payload.to_map ;
  wire \words__payload.waits ;
  output [127:0] words__payload_0;
  wire [127:0] words__payload_0;
  output [32:0] words__payload_128;
  reg [32:0] words__payload_128 = 33'h000000000;
  input words__ready;
  wire words__ready;
  output words__valid;
  reg words__valid = 1'h0;
  wire words_down;
  wire words_keeps;
  wire words_loads;
  assign \$13  = ~ served_0;
  assign left_1_0 = step[1] & \$13 ;
  assign \$14  = ~ message__linear__x__valid;
  assign lacks_1_0 = left_1_0 & \$14 ;
  assign \$15  = left_1_0 & message__linear__x__valid;
  assign go_1_0 = \$15  & free;
  assign \$19  = ~ served_0;
  assign left_2_0 = step[2] & \$19 ;
  assign \$20  = ~ message__linear__y__valid;
  assign lacks_2_0 = left_2_0 & \$20 ;
  assign \$21  = left_2_0 & message__linear__y__valid;
  assign go_2_0 = \$21  & free;
  assign \$25  = ~ served_0;
  assign left_3_0 = step[3] & \$25 ;
  assign \$26  = ~ message__linear__z__valid;
  assign lacks_3_0 = left_3_0 & \$26 ;
  assign \$27  = left_3_0 & message__linear__z__valid;
  assign go_3_0 = \$27  & free;
  assign \$31  = ~ served_0;
  assign left_4_0 = step[4] & \$31 ;
  assign \$32  = ~ message__angular__x__valid;
  assign lacks_4_0 = left_4_0 & \$32 ;
  assign \$33  = left_4_0 & message__angular__x__valid;
  assign go_4_0 = \$33  & free;
  assign \$37  = ~ served_0;
  assign left_5_0 = step[5] & \$37 ;
  assign \$38  = ~ message__angular__y__valid;
  assign lacks_5_0 = left_5_0 & \$38 ;
  assign \$39  = left_5_0 & message__angular__y__valid;
  assign go_5_0 = \$39  & free;
  assign \$43  = ~ served_1;
  assign left_5_1 = step[5] & \$43 ;
  assign \$44  = ~ message__angular__z__valid;
  assign lacks_5_1 = left_5_1 & \$44 ;
  assign \$45  = left_5_1 & message__angular__z__valid;
  assign \$46  = \$45  & free;
  assign \$48  = ~ lacks_5_0;
  assign go_5_1 = \$46  & \$48 ;
  assign \$49  = ~ words__valid;
  assign free = \$49  | words__ready;
  assign \$50  = ~ message__linear__x__valid;
  assign \$51  = step[0] & \$50 ;
  assign \$52  = ~ message__linear__y__valid;
  assign \$53  = step[1] & \$52 ;
  assign \$54  = ~ message__linear__z__valid;
  assign \$55  = step[2] & \$54 ;
  assign \$56  = ~ message__angular__x__valid;
  assign \$57  = step[3] & \$56 ;
  assign \$58  = ~ message__angular__y__valid;
  assign \$59  = step[4] & \$58 ;
  assign \$60  = | { lacks_5_1, lacks_5_0, \$59 , lacks_4_0, \$57 , lacks_3_0, \$55 , lacks_2_0, \$53 , lacks_1_0, \$51  };
  assign \$61  = ~ \$60 ;
  assign \$62  = free & \$61 ;
  assign \$63  = ~ step[5];
  assign \$64  = ~ status__valid;
  assign \$65  = \$64  | status__ready;
  assign \$66  = \$63  | \$65 ;
  assign complete = \$62  & \$66 ;
  assign \$72  = two_word_map ? 4'h8 : 4'h0;
  assign map_size = map_bytes + \$72 ;
  assign \$73  = | items_bytes;
  assign \$74  = begun | \$73 ;
  assign \$76  = | map_bytes;
  assign begins = \$74  | \$76 ;
  assign \$77  = two_word_map ? 4'h0 : items_bytes;
  assign \$78  = \$77  + 1'h0;
  assign { \$79 [5], to_map } = \$78  + 1'h0;
  assign \$80  = map_size + 3'h7;
  assign \$81  = begins ? \$80  : 6'h08;
  assign \$82  = map_size + 1'h0;
  assign \$91  = | { go_5_0, go_4_0, go_3_0, go_2_0, go_1_0 };
  assign \$92  = served_0 | \$91 ;
  assign \$93  = ~ complete;
  assign \$94  = \$92  & \$93 ;
  assign \$96  = served_1 | go_5_1;
  assign \$97  = ~ complete;
  assign \$98  = \$96  & \$97 ;
  assign \$99  = complete & step[5];
  assign \$100  = | error;
  assign \$101  = | step[4:1];
  assign \$102  = \$101  & served_0;
  assign \$104  = step[5] & served_1;
  assign \$105  = | { \$104 , \$102  };
  assign \$106  = ~ \$105 ;
  assign \$107  = free & \$106 ;
  assign \$109  = step[0] ? 32'd256 : 32'd0;
  assign \$111  = step[1] ? message__linear__x__payload[63:32] : 32'd0;
  assign \$112  = \$109  | \$111 ;
  assign \$114  = step[2] ? message__linear__y__payload[63:32] : 32'd0;
  assign \$116  = step[3] ? message__linear__z__payload[63:32] : 32'd0;
  assign \$117  = \$114  | \$116 ;
  assign \$118  = \$112  | \$117 ;
  assign \$120  = step[4] ? message__angular__x__payload[63:32] : 32'd0;
  assign \$122  = step[5] ? message__angular__z__payload[63:32] : 32'd0;
  assign \$123  = \$120  | \$122 ;
  assign \$124  = \$118  | \$123 ;
  assign \$128  = step[0] ? message__linear__x__payload[31:0] : 32'd0;
  assign \$130  = step[1] ? message__linear__y__payload[31:0] : 32'd0;
  assign \$131  = \$128  | \$130 ;
  assign \$133  = step[2] ? message__linear__z__payload[31:0] : 32'd0;
  assign \$135  = step[3] ? message__angular__x__payload[31:0] : 32'd0;
  assign \$136  = \$133  | \$135 ;
  assign \$137  = \$131  | \$136 ;
  assign \$139  = step[4] ? message__angular__y__payload[31:0] : 32'd0;
  assign \$140  = \$137  | \$139 ;
  assign \$142  = step[5] & served_0;
  assign \$144  = ~ \$142 ;
  assign \$145  = free & \$144 ;
  assign \$147  = step[5] & served_1;
  assign \$149  = ~ \$147 ;
  assign \$150  = free & \$149 ;
  assign \$151  = ~ step[5];
  assign \$152  = begins & \$151 ;
  assign \$153  = to_map + to_end;
  assign \$154  = \$153  + 3'h7;
  assign \$156  = ~ begins;
  assign \$190  = | step[3:0];
  always @(posedge aclk)
    words__payload_128 <= \$194 ;
  always @(posedge aclk)
    served_0 <= \$196 ;
  always @(posedge aclk)
    served_1 <= \$197 ;
  always @(posedge aclk)
    error <= \$198 ;
  always @(posedge aclk)
    status__valid <= \$199 ;
  always @(posedge aclk)
    status__payload <= \$200 ;
  always @(posedge aclk)
    map_0 <= \$201 ;
  always @(posedge aclk)
    map_4 <= \$202 ;
  always @(posedge aclk)
    items_0 <= \$203 ;
  always @(posedge aclk)
    items_4 <= \$204 ;
  always @(posedge aclk)
    begun <= \$205 ;
  always @(posedge aclk)
    words__valid <= \$206 ;
  always @(posedge aclk)
    step <= \$209 ;
  always @(posedge aclk)
    map_bytes <= \$210 ;
  always @(posedge aclk)
    items_bytes <= \$211 ;
  always @(posedge aclk)
    two_word_map <= \$212 ;
  assign choice_388_Y  = step[5] ? (* full_case = 32'd1 *) 1'h0 : step[4];
  assign choice_390_Y  = complete ? choice_388_Y  : two_word_map;
  assign \$212  = rst ? 1'h0 : choice_390_Y ;
  assign choice_397_Y  = step[5] ? (* full_case = 32'd1 *) 4'h0 : { step[4], 3'h0 };
  assign choice_399_Y  = complete ? choice_397_Y  : items_bytes;
  assign \$211  = rst ? 4'h0 : choice_399_Y ;
  assign choice_406_Y  = step[5] ? (* full_case = 32'd1 *) 4'h8 : { \$190 , step[4], 2'h0 };
  assign choice_408_Y  = complete ? choice_406_Y  : map_bytes;
  assign \$210  = rst ? 4'h8 : choice_408_Y ;
  assign choice_415_Y  = step[5] ? (* full_case = 32'd1 *) 6'h01 : { step[4:0], 1'h0 };
  assign choice_417_Y  = complete ? choice_415_Y  : step;
  assign \$209  = rst ? 6'h01 : choice_417_Y ;
  assign choice_425_Y  = free ? complete : words__valid;
  assign \$206  = rst ? 1'h0 : choice_425_Y ;
  assign choice_429_Y  = complete ? \$152  : begun;
  assign \$205  = rst ? 1'h0 : choice_429_Y ;
  assign \$204  = \$150  ? message__angular__z__payload[31:0] : items_4;
  assign \$203  = \$145  ? message__angular__y__payload[63:32] : items_0;
  assign \$202  = free ? \$140  : map_4;
  assign \$201  = \$107  ? \$124  : map_0;
  assign choice_441_Y  = \$99  ? error : status__payload;
  assign \$200  = rst ? 3'h0 : choice_441_Y ;
  assign choice_445_Y  = status__ready ? 1'h0 : status__valid;
  assign choice_447_Y  = \$99  ? 1'h1 : choice_445_Y ;
  assign \$199  = rst ? 1'h0 : choice_447_Y ;
  assign choice_451_Y  = \$99  ? 3'h0 : error;
  assign \$198  = rst ? 3'h0 : choice_451_Y ;
  assign \$197  = rst ? 1'h0 : \$98 ;
  assign \$196  = rst ? 1'h0 : \$94 ;
  assign end_mask = step[5] ? (* full_case = 32'd1 *) 3'h7 : 3'h0;
  assign to_end = step[5] ? (* full_case = 32'd1 *) \$81  : \$82 ;
  assign choice_465_Y  = free ? \$100  : words__payload_128[32];
  assign \$194 [32] = rst ? 1'h0 : choice_465_Y ;
  assign choice_469_Y  = free ? step[5] : words__payload_128[29];
  assign \$194 [29] = rst ? 1'h0 : choice_469_Y ;
  assign choice_473_Y  = free ? \$154 [5:3] : words__payload_128[28:26];
  assign \$194 [28:26] = rst ? 3'h0 : choice_473_Y ;
  assign choice_477_Y  = free ? 3'h0 : words__payload_128[16:14];
  assign \$194 [16:14] = rst ? 3'h0 : choice_477_Y ;
  assign choice_481_Y  = free ? to_map : words__payload_128[13:9];
  assign \$194 [13:9] = rst ? 5'h00 : choice_481_Y ;
  assign choice_485_Y  = free ? end_mask : words__payload_128[25:23];
  assign \$194 [25:23] = rst ? 3'h0 : choice_485_Y ;
  assign choice_489_Y  = free ? to_end : words__payload_128[22:17];
  assign \$194 [22:17] = rst ? 6'h00 : choice_489_Y ;
  assign choice_493_Y  = free ? two_word_map : words__payload_128[8];
  assign \$194 [8] = rst ? 1'h0 : choice_493_Y ;
  assign choice_497_Y  = free ? map_bytes : words__payload_128[7:4];
  assign \$194 [7:4] = rst ? 4'h0 : choice_497_Y ;
  assign choice_501_Y  = free ? items_bytes : words__payload_128[3:0];
  assign \$194 [3:0] = rst ? 4'h0 : choice_501_Y ;
  assign choice_505_Y  = free ? \$156  : words__payload_128[30];
  assign \$194 [30] = rst ? 1'h0 : choice_505_Y ;
  assign choice_509_Y  = free ? 1'h0 : words__payload_128[31];
  assign \$194 [31] = rst ? 1'h0 : choice_509_Y ;
  assign words__payload = { words__payload_128, map_4, map_0, items_4, items_0 };
  assign \words__payload.error  = words__payload_128[32];
  assign \words__payload.waits  = words__payload_128[31];
  assign \words__payload.empty  = words__payload_128[30];
  assign \words__payload.last  = words__payload_128[29];
  assign \words__payload.max_beats  = words__payload_128[28:26];
  assign \words__payload.end_mask  = words__payload_128[25:23];
  assign \words__payload.to_end  = words__payload_128[22:17];
  assign \words__payload.map_mask  = words__payload_128[16:14];
  assign \words__payload.to_map  = words__payload_128[13:9];
  assign \words__payload.lead  = words__payload_128[8];
  assign \words__payload.map_bytes  = words__payload_128[7:4];
  assign \words__payload.items_bytes  = words__payload_128[3:0];
  assign \words__payload.map  = { map_4, map_0 };
  assign \$79 [4:0] = to_map;
  assign \words__payload.items  = { items_4, items_0 };
  assign words__payload_0 = { map_4, map_0, items_4, items_0 };
  assign message__angular__z__ready = go_5_1;
  assign message__angular__y__ready = go_5_0;
  assign message__angular__x__ready = go_4_0;
  assign message__linear__z__ready = go_3_0;
  assign message__linear__y__ready = go_2_0;
  assign message__linear__x__ready = go_1_0;
  assign words_keeps = 1'h1;
  assign words_down = 1'h0;
  assign words_loads = 1'h0;
  assign step_to_body = 1'h0;
  assign nul_now = 1'h0;
  assign items_size = items_bytes;
  assign found = error;
  assign ends = step[5];
  assign done = 1'h1;
  assign default_5 = step[5];
  assign default_4 = step[4];
  assign default_3 = step[3];
  assign default_2 = step[2];
  assign default_1 = step[1];
  assign default_0 = step[0];
endmodule

module \geometry_msgs_msg_Twist_cdr_8_serializer_verilog.core.packer (packets__ready, rst, words__payload_0, words__payload_128, words__valid, words__ready, packets__valid, packets__payload, error, aclk);
  (* unused_bits = "7" *)
  wire [7:0] \$1 ;
  wire [2:0] \$10 ;
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
  wire [2:0] \$11 ;
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
  (* unused_bits = "7 8 9" *)
  wire [9:0] \$12 ;
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
  (* unused_bits = "4" *)
  wire [4:0] \$13 ;
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
  (* unused_bits = "3 4 5 6 7" *)
  wire [7:0] \$14 ;
  (* unused_bits = "3 4" *)
  wire [4:0] \$140 ;
  (* unused_bits = "4" *)
  wire [4:0] \$141 ;
  wire [31:0] \$142 ;
  wire [31:0] \$143 ;
  wire [31:0] \$144 ;
  wire [31:0] \$145 ;
  wire [31:0] \$146 ;
  wire [31:0] \$147 ;
  wire [3:0] \$148 ;
  wire \$149 ;
  wire [2:0] \$15 ;
  wire \$150 ;
  wire [63:0] \$151 ;
  wire [6:0] \$152 ;
  wire [3:0] \$153 ;
  wire [63:0] \$154 ;
  wire [6:0] \$155 ;
  wire [3:0] \$156 ;
  wire [6:0] \$157 ;
  wire [3:0] \$158 ;
  wire \$159 ;
  (* unused_bits = "4" *)
  wire [4:0] \$16 ;
  wire \$160 ;
  wire \$161 ;
  wire [3:0] \$162 ;
  wire \$163 ;
  wire [3:0] \$164 ;
  wire [7:0] \$165 ;
  wire [7:0] \$166 ;
  wire [7:0] \$167 ;
  wire [3:0] \$168 ;
  wire [7:0] \$169 ;
  (* unused_bits = "0 1 2 4" *)
  wire [4:0] \$17 ;
  wire \$170 ;
  wire [3:0] \$171 ;
  wire [68:0] \$172 ;
  wire \$173 ;
  wire \$19 ;
  (* unused_bits = "7" *)
  wire [7:0] \$2 ;
  (* unused_bits = "3" *)
  wire [3:0] \$20 ;
  (* unused_bits = "1 2 3 4 5 6 7" *)
  wire [7:0] \$21 ;
  wire \$23 ;
  (* unused_bits = "3" *)
  wire [3:0] \$25 ;
  (* unused_bits = "1 2 3 4 5 6 7" *)
  wire [7:0] \$26 ;
  wire \$28 ;
  (* unused_bits = "3" *)
  wire [3:0] \$29 ;
  wire [9:0] \$3 ;
  (* unused_bits = "1 2 3 4 5 6 7" *)
  wire [7:0] \$30 ;
  (* unused_bits = "3 4" *)
  wire [4:0] \$31 ;
  wire \$32 ;
  wire \$33 ;
  wire \$34 ;
  (* unused_bits = "1 2 3 4 5 6 7" *)
  wire [7:0] \$35 ;
  wire [6:0] \$36 ;
  (* unused_bits = "3 4" *)
  wire [4:0] \$37 ;
  wire [3:0] \$38 ;
  wire [3:0] \$39 ;
  wire [9:0] \$4 ;
  wire \$40 ;
  (* unused_bits = "4" *)
  wire [4:0] \$41 ;
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
  (* unused_bits = "7 8 9" *)
  wire [9:0] \$7 ;
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
  wire [9:0] \$8 ;
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
  wire [9:0] \$9 ;
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
  wire choice_101_Y ;
  wire choice_102_CMP ;
  wire choice_103_Y ;
  wire choice_113_Y ;
  wire choice_114_CMP ;
  wire choice_115_Y ;
  wire choice_117_Y ;
  wire choice_125_Y ;
  wire choice_126_CMP ;
  wire choice_127_Y ;
  wire choice_138_Y ;
  wire choice_139_CMP ;
  wire choice_13_Y ;
  wire choice_140_Y ;
  wire choice_142_Y ;
  wire choice_151_Y ;
  wire choice_152_CMP ;
  wire choice_153_Y ;
  wire choice_158_Y ;
  wire choice_159_CMP ;
  wire choice_15_Y ;
  wire choice_160_Y ;
  wire choice_162_Y ;
  wire choice_165_Y ;
  wire choice_166_CMP ;
  wire choice_167_Y ;
  wire [3:0] choice_171_Y ;
  wire choice_175_Y ;
  wire choice_177_Y ;
  wire choice_181_Y ;
  wire choice_183_Y ;
  wire choice_187_Y ;
  wire choice_189_Y ;
  wire choice_193_Y ;
  wire choice_195_Y ;
  wire choice_199_Y ;
  wire choice_19_Y ;
  wire choice_201_Y ;
  wire choice_205_Y ;
  wire choice_207_Y ;
  wire choice_20_CMP ;
  wire choice_211_Y ;
  wire choice_213_Y ;
  wire choice_217_Y ;
  wire choice_219_Y ;
  wire choice_21_Y ;
  wire choice_223_Y ;
  wire choice_225_Y ;
  wire choice_229_Y ;
  wire choice_231_Y ;
  wire choice_235_Y ;
  wire choice_237_Y ;
  wire choice_23_Y ;
  wire choice_241_Y ;
  wire choice_243_Y ;
  wire choice_247_Y ;
  wire choice_249_Y ;
  wire choice_253_Y ;
  wire choice_255_Y ;
  wire choice_259_Y ;
  wire choice_25_Y ;
  wire choice_261_Y ;
  wire choice_265_Y ;
  wire choice_267_Y ;
  wire choice_26_CMP ;
  wire choice_271_Y ;
  wire choice_273_Y ;
  wire choice_277_Y ;
  wire choice_279_Y ;
  wire choice_27_Y ;
  wire choice_283_Y ;
  wire choice_285_Y ;
  wire choice_289_Y ;
  wire choice_291_Y ;
  wire choice_295_Y ;
  wire choice_297_Y ;
  wire choice_301_Y ;
  wire choice_303_Y ;
  wire choice_307_Y ;
  wire choice_309_Y ;
  wire choice_313_Y ;
  wire choice_315_Y ;
  wire [3:0] choice_319_Y ;
  wire [3:0] choice_325_Y ;
  wire choice_329_Y ;
  wire choice_333_Y ;
  wire choice_337_Y ;
  wire choice_33_Y ;
  wire [3:0] choice_341_Y ;
  wire [6:0] choice_345_Y ;
  wire [3:0] choice_349_Y ;
  wire choice_34_CMP ;
  wire [6:0] choice_353_Y ;
  wire [3:0] choice_359_Y ;
  wire choice_35_Y ;
  wire [6:0] choice_363_Y ;
  wire choice_37_Y ;
  wire choice_41_Y ;
  wire choice_42_CMP ;
  wire choice_43_Y ;
  wire choice_50_Y ;
  wire choice_51_CMP ;
  wire choice_52_Y ;
  wire choice_54_Y ;
  wire choice_59_Y ;
  wire choice_60_CMP ;
  wire choice_61_Y ;
  wire choice_69_Y ;
  wire choice_70_CMP ;
  wire choice_71_Y ;
  wire choice_73_Y ;
  wire choice_79_Y ;
  wire choice_80_CMP ;
  wire choice_81_Y ;
  wire choice_90_Y ;
  wire choice_91_CMP ;
  wire choice_92_Y ;
  wire choice_94_Y ;
  wire [3:0] choice_9_Y ;
  input aclk;
  wire aclk;
  reg [6:0] at = 7'h00;
  wire [6:0] base;
  reg [3:0] bound = 4'h5;
  reg [3:0] complete = 4'h0;
  reg [3:0] complete_next = 4'h0;
  wire [6:0] end_sig;
  wire [2:0] ends__read__addr;
  wire [4:0] ends__read__data;
  wire [3:0] \ends__read__data.count ;
  wire \ends__read__data.error ;
  wire [2:0] ends__write__addr;
  wire [4:0] ends__write__data;
  wire [3:0] \ends__write__data.count ;
  wire \ends__write__data.error ;
  wire ends__write__en;
  reg ends_packet = 1'h0;
  output error;
  reg error = 1'h0;
  wire error_now;
  reg failed = 1'h0;
  reg [3:0] first = 4'h0;
  wire is_last;
  wire [2:0] items_0__read__addr;
  wire [63:0] items_0__read__data;
  wire [2:0] items_0__write__addr;
  reg [63:0] items_0__write__data = 64'h0000000000000000;
  wire items_0__write__en;
  reg [7:0] items_has_0 = 8'h00;
  wire [2:0] items_index_0;
  wire [63:0] items_placed;
  reg [3:0] items_size = 4'h0;
  wire [2:0] items_slot_0;
  reg [6:0] items_start = 7'h00;
  wire items_used_0;
  wire items_written_0;
  reg [7:0] last = 8'h00;
  reg [3:0] last_bytes = 4'h0;
  wire [2:0] map_0__read__addr;
  wire [31:0] map_0__read__data;
  wire [2:0] map_0__write__addr;
  wire [31:0] map_0__write__data;
  wire map_0__write__en;
  wire [2:0] map_4__read__addr;
  wire [31:0] map_4__read__data;
  wire [2:0] map_4__write__addr;
  wire [31:0] map_4__write__data;
  wire map_4__write__en;
  (* unused_bits = "0 1 2 3 4 5 6" *)
  wire [6:0] map_at;
  (* unused_bits = "3 4 5 6" *)
  wire [6:0] map_end;
  reg [7:0] map_has_0 = 8'h00;
  reg [7:0] map_has_4 = 8'h00;
  wire [2:0] map_index_0;
  wire [2:0] map_index_4;
  reg [63:0] map_placed = 64'h0000000000000000;
  reg [3:0] map_size = 4'h0;
  wire [2:0] map_slot_0;
  wire [2:0] map_slot_4;
  reg [6:0] map_start = 7'h00;
  wire map_used_0;
  wire map_used_4;
  wire map_written_0;
  wire map_written_4;
  wire [3:0] newest;
  output [68:0] packets__payload;
  reg [68:0] packets__payload = 69'h000000000000000000;
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
  input packets__ready;
  wire packets__ready;
  output packets__valid;
  reg packets__valid = 1'h0;
  wire [68:0] payload;
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
  wire reads;
  wire ready;
  (* unused_bits = "0 1 2" *)
  wire [3:0] room;
  input rst;
  wire rst;
  wire takes;
  wire [6:0] total;
  wire [6:0] \total$6 ;
  reg waits = 1'h0;
  (* unused_bits = "0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32 33 34 35 36 37 38 39 40 41 42 43 44 45 46 47 48 49 50 51 52 53 54 55 56 57 58 59 60 61 62 63 64 65 66 67 68 69 70 71 72 73 74 75 76 77 78 79 80 81 82 83 84 85 86 87 88 89 90 91 92 93 94 95 96 97 98 99 100 101 102 103 104 105 106 107 108 109 110 111 112 113 114 115 116 117 118 119 120 121 122 123 124 125 126 127 128 129 130 131 132 133 134 135 136 137 138 139 140 141 142 143 144 145 146 147 148 149 150 151 152 153 154 155 156 157 158 159 160" *)
  wire [160:0] words__payload;
  wire \words__payload.empty ;
  wire [2:0] \words__payload.end_mask ;
  wire \words__payload.error ;
  wire [63:0] \words__payload.items ;
  wire [3:0] \words__payload.items_bytes ;
  wire \words__payload.last ;
  wire \words__payload.lead ;
  wire [63:0] \words__payload.map ;
  wire [3:0] \words__payload.map_bytes ;
  wire [2:0] \words__payload.map_mask ;
  wire [2:0] \words__payload.max_beats ;
  wire [5:0] \words__payload.to_end ;
  wire [4:0] \words__payload.to_map ;
  wire \words__payload.waits ;
  input [127:0] words__payload_0;
  wire [127:0] words__payload_0;
  input [32:0] words__payload_128;
  wire [32:0] words__payload_128;
  output words__ready;
  reg words__ready = 1'h1;
  input words__valid;
  wire words__valid;
  reg writes = 1'h0;
  reg [4:0] ends [7:0];
  initial begin
    ends[0] = 5'h00;
    ends[1] = 5'h00;
    ends[2] = 5'h00;
    ends[3] = 5'h00;
    ends[4] = 5'h00;
    ends[5] = 5'h00;
    ends[6] = 5'h00;
    ends[7] = 5'h00;
  end
  always @(posedge aclk) begin
    if (ends__write__en)
      ends[ends__write__addr] <= ends__write__data;
  end
  assign ends__read__data = ends[first[2:0]];
  reg [63:0] items_0 [7:0];
  initial begin
    items_0[0] = 64'h0000000000000000;
    items_0[1] = 64'h0000000000000000;
    items_0[2] = 64'h0000000000000000;
    items_0[3] = 64'h0000000000000000;
    items_0[4] = 64'h0000000000000000;
    items_0[5] = 64'h0000000000000000;
    items_0[6] = 64'h0000000000000000;
    items_0[7] = 64'h0000000000000000;
  end
  always @(posedge aclk) begin
    if (items_used_0)
      items_0[items_0__write__addr] <= items_0__write__data;
  end
  assign items_0__read__data = items_0[first[2:0]];
  reg [31:0] map_0 [7:0];
  initial begin
    map_0[0] = 32'd0;
    map_0[1] = 32'd0;
    map_0[2] = 32'd0;
    map_0[3] = 32'd0;
    map_0[4] = 32'd0;
    map_0[5] = 32'd0;
    map_0[6] = 32'd0;
    map_0[7] = 32'd0;
  end
  always @(posedge aclk) begin
    if (map_used_0)
      map_0[map_0__write__addr] <= map_placed[31:0];
  end
  assign map_0__read__data = map_0[first[2:0]];
  reg [31:0] map_4 [7:0];
  initial begin
    map_4[0] = 32'd0;
    map_4[1] = 32'd0;
    map_4[2] = 32'd0;
    map_4[3] = 32'd0;
    map_4[4] = 32'd0;
    map_4[5] = 32'd0;
    map_4[6] = 32'd0;
    map_4[7] = 32'd0;
  end
  always @(posedge aclk) begin
    if (map_used_4)
      map_4[map_4__write__addr] <= map_placed[63:32];
  end
  assign map_4__read__data = map_4[first[2:0]];
  assign takes = words__valid & words__ready;
  assign { \$1 [7], total } = at + words__payload_128[13:9];
  assign { \$2 [7], \total$6  } = base + words__payload_128[22:17];
  assign \$3  = ~ { 7'h00, words__payload_128[16:14] };
  assign \$4  = { 3'h0, total } & \$3 ;
  assign { \$7 [9:7], base } = \$4  | { 7'h00, words__payload_128[16], 2'h0 };
  assign \$8  = ~ { 7'h00, words__payload_128[25:23] };
  assign \$9  = { 3'h0, \total$6  } & \$8 ;
  assign \$10  = words__payload_128[29] ? 3'h0 : 3'h4;
  assign \$11  = words__payload_128[25:23] & \$10 ;
  assign { \$12 [9:7], end_sig } = \$9  | { 7'h00, \$11  };
  assign \$13  = base[6:3] + words__payload_128[8];
  assign { \$14 [7], map_end } = { \$13 [3:0], base[2:0] } + words__payload_128[7:4];
  assign \$15  = takes ? words__payload_128[28:26] : 3'h0;
  assign { \$16 [4], newest } = at[6:3] + \$15 ;
  assign { \$17 [4], room } = bound - newest;
  assign \$19  = 3'h0 < items_size;
  assign items_used_0 = writes & \$19 ;
  assign { \$20 [3], items_0__write__addr } = items_start[5:3] + 1'h0;
  assign { \$21 [7:1], items_written_0 } = items_has_0 >> first[2:0];
  assign \$23  = 3'h0 < map_size;
  assign map_used_0 = writes & \$23 ;
  assign { \$25 [3], map_0__write__addr } = map_start[5:3] + 1'h0;
  assign { \$26 [7:1], map_written_0 } = map_has_0 >> first[2:0];
  assign \$28  = 3'h4 < map_size;
  assign map_used_4 = writes & \$28 ;
  assign { \$29 [3], map_4__write__addr } = map_start[5:3] + 1'h0;
  assign { \$30 [7:1], map_written_4 } = map_has_4 >> first[2:0];
  assign { \$31 [4:3], ends__write__addr } = complete_next - 1'h1;
  assign ends__write__en = writes & ends_packet;
  assign \$32  = complete != first;
  assign \$33  = ~ packets__valid;
  assign \$34  = \$33  | packets__ready;
  assign reads = \$32  & \$34 ;
  assign { \$35 [7:1], is_last } = last >> first[2:0];
  assign \$36  = words__payload_128[8] ? base : at;
  assign \$37  = map_end[2:0] - 1'h1;
  assign \$38  = \$37 [2:0] + 1'h1;
  assign \$39  = words__payload_128[30] ? 4'h0 : \$38 ;
  assign \$40  = ~ room[3];
  assign \$41  = bound + 1'h1;
  assign \$42  = ! first[2:0];
  assign \$43  = reads & \$42 ;
  assign \$44  = ! items_0__write__addr;
  assign \$45  = items_used_0 & \$44 ;
  assign \$46  = first[2:0] == 1'h1;
  assign \$47  = reads & \$46 ;
  assign \$48  = items_0__write__addr == 1'h1;
  assign \$49  = items_used_0 & \$48 ;
  assign \$50  = first[2:0] == 2'h2;
  assign \$51  = reads & \$50 ;
  assign \$52  = items_0__write__addr == 2'h2;
  assign \$53  = items_used_0 & \$52 ;
  assign \$54  = first[2:0] == 2'h3;
  assign \$55  = reads & \$54 ;
  assign \$56  = items_0__write__addr == 2'h3;
  assign \$57  = items_used_0 & \$56 ;
  assign \$58  = first[2:0] == 3'h4;
  assign \$59  = reads & \$58 ;
  assign \$60  = items_0__write__addr == 3'h4;
  assign \$61  = items_used_0 & \$60 ;
  assign \$62  = first[2:0] == 3'h5;
  assign \$63  = reads & \$62 ;
  assign \$64  = items_0__write__addr == 3'h5;
  assign \$65  = items_used_0 & \$64 ;
  assign \$66  = first[2:0] == 3'h6;
  assign \$67  = reads & \$66 ;
  assign \$68  = items_0__write__addr == 3'h6;
  assign \$69  = items_used_0 & \$68 ;
  assign \$70  = first[2:0] == 3'h7;
  assign \$71  = reads & \$70 ;
  assign \$72  = items_0__write__addr == 3'h7;
  assign \$73  = items_used_0 & \$72 ;
  assign \$74  = ! first[2:0];
  assign \$75  = reads & \$74 ;
  assign \$76  = ! map_0__write__addr;
  assign \$77  = map_used_0 & \$76 ;
  assign \$78  = first[2:0] == 1'h1;
  assign \$79  = reads & \$78 ;
  assign \$80  = map_0__write__addr == 1'h1;
  assign \$81  = map_used_0 & \$80 ;
  assign \$82  = first[2:0] == 2'h2;
  assign \$83  = reads & \$82 ;
  assign \$84  = map_0__write__addr == 2'h2;
  assign \$85  = map_used_0 & \$84 ;
  assign \$86  = first[2:0] == 2'h3;
  assign \$87  = reads & \$86 ;
  assign \$88  = map_0__write__addr == 2'h3;
  assign \$89  = map_used_0 & \$88 ;
  assign \$90  = first[2:0] == 3'h4;
  assign \$91  = reads & \$90 ;
  assign \$92  = map_0__write__addr == 3'h4;
  assign \$93  = map_used_0 & \$92 ;
  assign \$94  = first[2:0] == 3'h5;
  assign \$95  = reads & \$94 ;
  assign \$96  = map_0__write__addr == 3'h5;
  assign \$97  = map_used_0 & \$96 ;
  assign \$98  = first[2:0] == 3'h6;
  assign \$99  = reads & \$98 ;
  assign \$100  = map_0__write__addr == 3'h6;
  assign \$101  = map_used_0 & \$100 ;
  assign \$102  = first[2:0] == 3'h7;
  assign \$103  = reads & \$102 ;
  assign \$104  = map_0__write__addr == 3'h7;
  assign \$105  = map_used_0 & \$104 ;
  assign \$106  = ! first[2:0];
  assign \$107  = reads & \$106 ;
  assign \$108  = ! map_4__write__addr;
  assign \$109  = map_used_4 & \$108 ;
  assign \$110  = first[2:0] == 1'h1;
  assign \$111  = reads & \$110 ;
  assign \$112  = map_4__write__addr == 1'h1;
  assign \$113  = map_used_4 & \$112 ;
  assign \$114  = first[2:0] == 2'h2;
  assign \$115  = reads & \$114 ;
  assign \$116  = map_4__write__addr == 2'h2;
  assign \$117  = map_used_4 & \$116 ;
  assign \$118  = first[2:0] == 2'h3;
  assign \$119  = reads & \$118 ;
  assign \$120  = map_4__write__addr == 2'h3;
  assign \$121  = map_used_4 & \$120 ;
  assign \$122  = first[2:0] == 3'h4;
  assign \$123  = reads & \$122 ;
  assign \$124  = map_4__write__addr == 3'h4;
  assign \$125  = map_used_4 & \$124 ;
  assign \$126  = first[2:0] == 3'h5;
  assign \$127  = reads & \$126 ;
  assign \$128  = map_4__write__addr == 3'h5;
  assign \$129  = map_used_4 & \$128 ;
  assign \$130  = first[2:0] == 3'h6;
  assign \$131  = reads & \$130 ;
  assign \$132  = map_4__write__addr == 3'h6;
  assign \$133  = map_used_4 & \$132 ;
  assign \$134  = first[2:0] == 3'h7;
  assign \$135  = reads & \$134 ;
  assign \$136  = map_4__write__addr == 3'h7;
  assign \$137  = map_used_4 & \$136 ;
  assign \$138  = ~ waits;
  assign \$139  = writes & \$138 ;
  assign \$140  = complete_next - 1'h1;
  assign \$141  = first + 1'h1;
  assign \$142  = items_written_0 ? items_0__read__data[31:0] : 32'd0;
  assign \$143  = map_written_0 ? map_0__read__data : 32'd0;
  assign \$144  = \$142  | \$143 ;
  assign \$145  = items_written_0 ? items_0__read__data[63:32] : 32'd0;
  assign \$146  = map_written_4 ? map_4__read__data : 32'd0;
  assign \$147  = \$145  | \$146 ;
  assign \$148  = is_last ? ends__read__data[3:0] : 4'h8;
  assign \$149  = is_last & ends__read__data[4];
  always @(posedge aclk)
    writes <= \$150 ;
  always @(posedge aclk)
    items_0__write__data <= \$151 ;
  always @(posedge aclk)
    items_start <= \$152 ;
  always @(posedge aclk)
    items_size <= \$153 ;
  always @(posedge aclk)
    map_placed <= \$154 ;
  always @(posedge aclk)
    map_start <= \$155 ;
  always @(posedge aclk)
    map_size <= \$156 ;
  always @(posedge aclk)
    at <= \$157 ;
  always @(posedge aclk)
    complete_next <= \$158 ;
  always @(posedge aclk)
    ends_packet <= \$159 ;
  always @(posedge aclk)
    failed <= \$160 ;
  always @(posedge aclk)
    waits <= \$161 ;
  always @(posedge aclk)
    last_bytes <= \$162 ;
  always @(posedge aclk)
    words__ready <= \$163 ;
  always @(posedge aclk)
    bound <= \$164 ;
  always @(posedge aclk)
    items_has_0 <= \$165 ;
  always @(posedge aclk)
    map_has_0 <= \$166 ;
  always @(posedge aclk)
    map_has_4 <= \$167 ;
  always @(posedge aclk)
    complete <= \$168 ;
  always @(posedge aclk)
    last <= \$169 ;
  always @(posedge aclk)
    packets__valid <= \$170 ;
  always @(posedge aclk)
    first <= \$171 ;
  always @(posedge aclk)
    packets__payload <= \$172 ;
  always @(posedge aclk)
    error <= \$173 ;
  assign \$173  = reads ? \$149  : error;
  assign choice_101_Y  = choice_102_CMP  ? (* full_case = 32'd1 *) 1'h0 : choice_94_Y ;
  assign choice_102_CMP  = first[2:0] == (* full_case = 32'd1 *) 3'h2;
  assign choice_103_Y  = reads ? choice_101_Y  : choice_94_Y ;
  assign \$169 [2] = rst ? 1'h0 : choice_103_Y ;
  assign \$171  = rst ? 4'h0 : choice_9_Y ;
  assign choice_113_Y  = choice_114_CMP  ? (* full_case = 32'd1 *) 1'h1 : last[1];
  assign choice_114_CMP  = \$140 [2:0] == (* full_case = 32'd1 *) 3'h1;
  assign choice_115_Y  = ends_packet ? choice_113_Y  : last[1];
  assign choice_117_Y  = \$139  ? choice_115_Y  : last[1];
  assign choice_125_Y  = choice_126_CMP  ? (* full_case = 32'd1 *) 1'h0 : choice_117_Y ;
  assign choice_126_CMP  = first[2:0] == (* full_case = 32'd1 *) 3'h1;
  assign choice_127_Y  = reads ? choice_125_Y  : choice_117_Y ;
  assign \$169 [1] = rst ? 1'h0 : choice_127_Y ;
  assign choice_13_Y  = packets__ready ? 1'h0 : packets__valid;
  assign choice_138_Y  = choice_139_CMP  ? (* full_case = 32'd1 *) 1'h1 : last[0];
  assign choice_139_CMP  = ! (* full_case = 32'd1 *) \$140 [2:0];
  assign choice_140_Y  = ends_packet ? choice_138_Y  : last[0];
  assign choice_142_Y  = \$139  ? choice_140_Y  : last[0];
  assign choice_15_Y  = reads ? 1'h1 : choice_13_Y ;
  assign choice_151_Y  = choice_152_CMP  ? (* full_case = 32'd1 *) 1'h0 : choice_142_Y ;
  assign choice_152_CMP  = ! (* full_case = 32'd1 *) first[2:0];
  assign choice_153_Y  = reads ? choice_151_Y  : choice_142_Y ;
  assign \$169 [0] = rst ? 1'h0 : choice_153_Y ;
  assign choice_158_Y  = choice_159_CMP  ? (* full_case = 32'd1 *) 1'h1 : last[6];
  assign choice_159_CMP  = \$140 [2:0] == (* full_case = 32'd1 *) 3'h6;
  assign choice_160_Y  = ends_packet ? choice_158_Y  : last[6];
  assign choice_162_Y  = \$139  ? choice_160_Y  : last[6];
  assign choice_165_Y  = choice_166_CMP  ? (* full_case = 32'd1 *) 1'h0 : choice_162_Y ;
  assign choice_166_CMP  = first[2:0] == (* full_case = 32'd1 *) 3'h6;
  assign choice_167_Y  = reads ? choice_165_Y  : choice_162_Y ;
  assign \$169 [6] = rst ? 1'h0 : choice_167_Y ;
  assign \$170  = rst ? 1'h0 : choice_15_Y ;
  assign choice_171_Y  = \$139  ? complete_next : complete;
  assign \$168  = rst ? 4'h0 : choice_171_Y ;
  assign choice_175_Y  = \$137  ? 1'h1 : map_has_4[7];
  assign choice_177_Y  = \$135  ? 1'h0 : choice_175_Y ;
  assign \$167 [7] = rst ? 1'h0 : choice_177_Y ;
  assign choice_181_Y  = \$129  ? 1'h1 : map_has_4[5];
  assign choice_183_Y  = \$127  ? 1'h0 : choice_181_Y ;
  assign \$167 [5] = rst ? 1'h0 : choice_183_Y ;
  assign choice_187_Y  = \$125  ? 1'h1 : map_has_4[4];
  assign choice_189_Y  = \$123  ? 1'h0 : choice_187_Y ;
  assign choice_19_Y  = choice_20_CMP  ? (* full_case = 32'd1 *) 1'h1 : last[7];
  assign \$167 [4] = rst ? 1'h0 : choice_189_Y ;
  assign choice_193_Y  = \$121  ? 1'h1 : map_has_4[3];
  assign choice_195_Y  = \$119  ? 1'h0 : choice_193_Y ;
  assign \$167 [3] = rst ? 1'h0 : choice_195_Y ;
  assign choice_199_Y  = \$117  ? 1'h1 : map_has_4[2];
  assign choice_201_Y  = \$115  ? 1'h0 : choice_199_Y ;
  assign \$167 [2] = rst ? 1'h0 : choice_201_Y ;
  assign choice_205_Y  = \$113  ? 1'h1 : map_has_4[1];
  assign choice_207_Y  = \$111  ? 1'h0 : choice_205_Y ;
  assign \$167 [1] = rst ? 1'h0 : choice_207_Y ;
  assign choice_20_CMP  = \$140 [2:0] == (* full_case = 32'd1 *) 3'h7;
  assign choice_21_Y  = ends_packet ? choice_19_Y  : last[7];
  assign choice_211_Y  = \$109  ? 1'h1 : map_has_4[0];
  assign choice_213_Y  = \$107  ? 1'h0 : choice_211_Y ;
  assign \$167 [0] = rst ? 1'h0 : choice_213_Y ;
  assign choice_217_Y  = \$133  ? 1'h1 : map_has_4[6];
  assign choice_219_Y  = \$131  ? 1'h0 : choice_217_Y ;
  assign \$167 [6] = rst ? 1'h0 : choice_219_Y ;
  assign choice_223_Y  = \$105  ? 1'h1 : map_has_0[7];
  assign choice_225_Y  = \$103  ? 1'h0 : choice_223_Y ;
  assign \$166 [7] = rst ? 1'h0 : choice_225_Y ;
  assign choice_229_Y  = \$97  ? 1'h1 : map_has_0[5];
  assign choice_23_Y  = \$139  ? choice_21_Y  : last[7];
  assign choice_231_Y  = \$95  ? 1'h0 : choice_229_Y ;
  assign \$166 [5] = rst ? 1'h0 : choice_231_Y ;
  assign choice_235_Y  = \$93  ? 1'h1 : map_has_0[4];
  assign choice_237_Y  = \$91  ? 1'h0 : choice_235_Y ;
  assign \$166 [4] = rst ? 1'h0 : choice_237_Y ;
  assign choice_241_Y  = \$89  ? 1'h1 : map_has_0[3];
  assign choice_243_Y  = \$87  ? 1'h0 : choice_241_Y ;
  assign \$166 [3] = rst ? 1'h0 : choice_243_Y ;
  assign choice_247_Y  = \$85  ? 1'h1 : map_has_0[2];
  assign choice_249_Y  = \$83  ? 1'h0 : choice_247_Y ;
  assign choice_25_Y  = choice_26_CMP  ? (* full_case = 32'd1 *) 1'h0 : choice_23_Y ;
  assign \$166 [2] = rst ? 1'h0 : choice_249_Y ;
  assign choice_253_Y  = \$81  ? 1'h1 : map_has_0[1];
  assign choice_255_Y  = \$79  ? 1'h0 : choice_253_Y ;
  assign \$166 [1] = rst ? 1'h0 : choice_255_Y ;
  assign choice_259_Y  = \$77  ? 1'h1 : map_has_0[0];
  assign choice_261_Y  = \$75  ? 1'h0 : choice_259_Y ;
  assign \$166 [0] = rst ? 1'h0 : choice_261_Y ;
  assign choice_265_Y  = \$101  ? 1'h1 : map_has_0[6];
  assign choice_267_Y  = \$99  ? 1'h0 : choice_265_Y ;
  assign \$166 [6] = rst ? 1'h0 : choice_267_Y ;
  assign choice_26_CMP  = first[2:0] == (* full_case = 32'd1 *) 3'h7;
  assign choice_27_Y  = reads ? choice_25_Y  : choice_23_Y ;
  assign choice_271_Y  = \$73  ? 1'h1 : items_has_0[7];
  assign choice_273_Y  = \$71  ? 1'h0 : choice_271_Y ;
  assign \$165 [7] = rst ? 1'h0 : choice_273_Y ;
  assign choice_277_Y  = \$65  ? 1'h1 : items_has_0[5];
  assign choice_279_Y  = \$63  ? 1'h0 : choice_277_Y ;
  assign \$165 [5] = rst ? 1'h0 : choice_279_Y ;
  assign choice_283_Y  = \$61  ? 1'h1 : items_has_0[4];
  assign choice_285_Y  = \$59  ? 1'h0 : choice_283_Y ;
  assign \$165 [4] = rst ? 1'h0 : choice_285_Y ;
  assign choice_289_Y  = \$57  ? 1'h1 : items_has_0[3];
  assign \$169 [7] = rst ? 1'h0 : choice_27_Y ;
  assign choice_291_Y  = \$55  ? 1'h0 : choice_289_Y ;
  assign \$165 [3] = rst ? 1'h0 : choice_291_Y ;
  assign choice_295_Y  = \$53  ? 1'h1 : items_has_0[2];
  assign choice_297_Y  = \$51  ? 1'h0 : choice_295_Y ;
  assign \$165 [2] = rst ? 1'h0 : choice_297_Y ;
  assign \$172 [68] = reads ? is_last : packets__payload[68];
  assign choice_301_Y  = \$49  ? 1'h1 : items_has_0[1];
  assign choice_303_Y  = \$47  ? 1'h0 : choice_301_Y ;
  assign \$165 [1] = rst ? 1'h0 : choice_303_Y ;
  assign choice_307_Y  = \$45  ? 1'h1 : items_has_0[0];
  assign choice_309_Y  = \$43  ? 1'h0 : choice_307_Y ;
  assign \$165 [0] = rst ? 1'h0 : choice_309_Y ;
  assign choice_313_Y  = \$69  ? 1'h1 : items_has_0[6];
  assign choice_315_Y  = \$67  ? 1'h0 : choice_313_Y ;
  assign \$165 [6] = rst ? 1'h0 : choice_315_Y ;
  assign choice_319_Y  = reads ? \$41 [3:0] : bound;
  assign \$164  = rst ? 4'h5 : choice_319_Y ;
  assign \$163  = rst ? 1'h1 : \$40 ;
  assign choice_325_Y  = takes ? \$39  : last_bytes;
  assign \$162  = rst ? 4'h0 : choice_325_Y ;
  assign choice_329_Y  = takes ? words__payload_128[31] : waits;
  assign choice_33_Y  = choice_34_CMP  ? (* full_case = 32'd1 *) 1'h1 : last[5];
  assign \$161  = rst ? 1'h0 : choice_329_Y ;
  assign choice_333_Y  = takes ? words__payload_128[32] : failed;
  assign \$160  = rst ? 1'h0 : choice_333_Y ;
  assign choice_337_Y  = takes ? words__payload_128[29] : ends_packet;
  assign \$159  = rst ? 1'h0 : choice_337_Y ;
  assign choice_341_Y  = takes ? end_sig[6:3] : complete_next;
  assign \$158  = rst ? 4'h0 : choice_341_Y ;
  assign choice_345_Y  = takes ? end_sig : at;
  assign \$157  = rst ? 7'h00 : choice_345_Y ;
  assign choice_349_Y  = takes ? words__payload_128[7:4] : map_size;
  assign choice_34_CMP  = \$140 [2:0] == (* full_case = 32'd1 *) 3'h5;
  assign choice_35_Y  = ends_packet ? choice_33_Y  : last[5];
  assign \$156  = rst ? 4'h0 : choice_349_Y ;
  assign choice_353_Y  = takes ? { \$13 [3:0], base[2:0] } : map_start;
  assign \$155  = rst ? 7'h00 : choice_353_Y ;
  assign \$154  = takes ? words__payload_0[127:64] : map_placed;
  assign choice_359_Y  = takes ? words__payload_128[3:0] : items_size;
  assign \$153  = rst ? 4'h0 : choice_359_Y ;
  assign choice_363_Y  = takes ? \$36  : items_start;
  assign \$152  = rst ? 7'h00 : choice_363_Y ;
  assign \$151  = takes ? words__payload_0[63:0] : items_0__write__data;
  assign \$150  = rst ? 1'h0 : takes;
  assign choice_37_Y  = \$139  ? choice_35_Y  : last[5];
  assign choice_41_Y  = choice_42_CMP  ? (* full_case = 32'd1 *) 1'h0 : choice_37_Y ;
  assign choice_42_CMP  = first[2:0] == (* full_case = 32'd1 *) 3'h5;
  assign choice_43_Y  = reads ? choice_41_Y  : choice_37_Y ;
  assign \$169 [5] = rst ? 1'h0 : choice_43_Y ;
  assign \$172 [67:64] = reads ? \$148  : packets__payload[67:64];
  assign choice_50_Y  = choice_51_CMP  ? (* full_case = 32'd1 *) 1'h1 : last[4];
  assign choice_51_CMP  = \$140 [2:0] == (* full_case = 32'd1 *) 3'h4;
  assign choice_52_Y  = ends_packet ? choice_50_Y  : last[4];
  assign choice_54_Y  = \$139  ? choice_52_Y  : last[4];
  assign choice_59_Y  = choice_60_CMP  ? (* full_case = 32'd1 *) 1'h0 : choice_54_Y ;
  assign choice_60_CMP  = first[2:0] == (* full_case = 32'd1 *) 3'h4;
  assign choice_61_Y  = reads ? choice_59_Y  : choice_54_Y ;
  assign \$169 [4] = rst ? 1'h0 : choice_61_Y ;
  assign choice_69_Y  = choice_70_CMP  ? (* full_case = 32'd1 *) 1'h1 : last[3];
  assign \$172 [63:0] = reads ? { \$147 , \$144  } : packets__payload[63:0];
  assign choice_70_CMP  = \$140 [2:0] == (* full_case = 32'd1 *) 3'h3;
  assign choice_71_Y  = ends_packet ? choice_69_Y  : last[3];
  assign choice_73_Y  = \$139  ? choice_71_Y  : last[3];
  assign choice_79_Y  = choice_80_CMP  ? (* full_case = 32'd1 *) 1'h0 : choice_73_Y ;
  assign choice_80_CMP  = first[2:0] == (* full_case = 32'd1 *) 3'h3;
  assign choice_81_Y  = reads ? choice_79_Y  : choice_73_Y ;
  assign \$169 [3] = rst ? 1'h0 : choice_81_Y ;
  assign choice_9_Y  = reads ? \$141 [3:0] : first;
  assign choice_90_Y  = choice_91_CMP  ? (* full_case = 32'd1 *) 1'h1 : last[2];
  assign choice_91_CMP  = \$140 [2:0] == (* full_case = 32'd1 *) 3'h2;
  assign choice_92_Y  = ends_packet ? choice_90_Y  : last[2];
  assign choice_94_Y  = \$139  ? choice_92_Y  : last[2];
  assign ends__write__data = { failed, last_bytes };
  assign words__payload = { words__payload_128, words__payload_0 };
  assign map_at = { \$13 [3:0], base[2:0] };
  assign \ends__read__data.error  = ends__read__data[4];
  assign \ends__read__data.count  = ends__read__data[3:0];
  assign \payload.last  = packets__payload[68];
  assign \payload.count  = packets__payload[67:64];
  assign \payload.data_7  = packets__payload[63:56];
  assign \payload.data_6  = packets__payload[55:48];
  assign \payload.data_5  = packets__payload[47:40];
  assign \payload.data_4  = packets__payload[39:32];
  assign \payload.data_3  = packets__payload[31:24];
  assign \payload.data_2  = packets__payload[23:16];
  assign \payload.data_1  = packets__payload[15:8];
  assign \payload.data_0  = packets__payload[7:0];
  assign \payload.data  = packets__payload[63:0];
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
  assign \ends__write__data.error  = ends__write__data[4];
  assign \ends__write__data.count  = ends__write__data[3:0];
  assign \words__payload.error  = words__payload_128[32];
  assign \words__payload.waits  = words__payload_128[31];
  assign \words__payload.empty  = words__payload_128[30];
  assign \words__payload.last  = words__payload_128[29];
  assign \words__payload.max_beats  = words__payload_128[28:26];
  assign \words__payload.end_mask  = words__payload_128[25:23];
  assign \words__payload.to_end  = words__payload_128[22:17];
  assign \words__payload.map_mask  = words__payload_128[16:14];
  assign \words__payload.to_map  = words__payload_128[13:9];
  assign \words__payload.lead  = words__payload_128[8];
  assign \words__payload.map_bytes  = words__payload_128[7:4];
  assign \words__payload.items_bytes  = words__payload_128[3:0];
  assign \words__payload.map  = words__payload_0[127:64];
  assign \words__payload.items  = words__payload_0[63:0];
  assign \$35 [0] = is_last;
  assign \$31 [2:0] = ends__write__addr;
  assign \$30 [0] = map_written_4;
  assign \$29 [2:0] = map_4__write__addr;
  assign \$26 [0] = map_written_0;
  assign \$25 [2:0] = map_0__write__addr;
  assign \$21 [0] = items_written_0;
  assign \$20 [2:0] = items_0__write__addr;
  assign \$17 [3:0] = room;
  assign \$16 [3:0] = newest;
  assign \$14 [6:0] = map_end;
  assign \$12 [6:0] = end_sig;
  assign \$7 [6:0] = base;
  assign \$2 [6:0] = \total$6 ;
  assign \$1 [6:0] = total;
  assign error_now = error;
  assign payload = packets__payload;
  assign ends__read__addr = first[2:0];
  assign map_4__read__addr = first[2:0];
  assign map_4__write__en = map_used_4;
  assign map_4__write__data = map_placed[63:32];
  assign map_slot_4 = map_4__write__addr;
  assign map_index_4 = 3'h4;
  assign map_0__read__addr = first[2:0];
  assign map_0__write__en = map_used_0;
  assign map_0__write__data = map_placed[31:0];
  assign map_slot_0 = map_0__write__addr;
  assign map_index_0 = 3'h0;
  assign items_0__read__addr = first[2:0];
  assign items_0__write__en = items_used_0;
  assign items_placed = items_0__write__data;
  assign items_slot_0 = items_0__write__addr;
  assign items_index_0 = 3'h0;
  assign ready = words__ready;
endmodule
