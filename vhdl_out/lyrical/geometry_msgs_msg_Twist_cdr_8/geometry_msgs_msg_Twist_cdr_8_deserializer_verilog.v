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
  assign \packets__payload.count  = s_axis_tlast ? { \$40 , \$39 , \$26 , \$13  } : 4'h8;
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
    .packets__payload({ s_axis_tlast, \packets__payload.count , s_axis_tdata }),
    .packets__ready(s_axis_tready),
    .packets__valid(s_axis_tvalid),
    .rst(rst),
    .status__payload(status__payload),
    .status__ready(m_axis_status_tready),
    .status__valid(m_axis_status_tvalid)
  );
  assign \packets__payload.data[6]  = s_axis_tdata[55:48];
  assign \packets__payload.data[5]  = s_axis_tdata[47:40];
  assign \packets__payload.data[4]  = s_axis_tdata[39:32];
  assign \packets__payload.data[3]  = s_axis_tdata[31:24];
  assign \packets__payload.data[2]  = s_axis_tdata[23:16];
  assign \packets__payload.data[1]  = s_axis_tdata[15:8];
  assign \packets__payload.data[0]  = s_axis_tdata[7:0];
  assign \packets__payload.data  = s_axis_tdata;
  assign \packets__payload.data[7]  = s_axis_tdata[63:56];
  assign \packets__payload.last  = s_axis_tlast;
  assign m_axis_status_tdata = { 5'h00, status__payload };
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
  assign packets__payload = { s_axis_tlast, \packets__payload.count , s_axis_tdata };
endmodule

module \geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.core (packets__valid, message__linear__x__ready, message__linear__y__ready, message__linear__z__ready, message__angular__x__ready, message__angular__y__ready, message__angular__z__ready, status__ready, rst, packets__ready, packets__payload, message__linear__x__valid, message__linear__y__valid, message__linear__z__valid, message__angular__x__valid, message__angular__y__valid, message__angular__z__valid, status__valid, message__linear__x__payload, message__linear__y__payload, message__linear__z__payload
, message__angular__x__payload, message__angular__y__payload, message__angular__z__payload, status__payload, aclk);
  wire \$1 ;
  wire \$10 ;
  wire \$100 ;
  wire \$101 ;
  wire \$102 ;
  wire \$105 ;
  wire \$106 ;
  wire \$107 ;
  wire \$108 ;
  wire \$109 ;
  wire \$11 ;
  (* unused_bits = "4" *)
  wire [4:0] \$110 ;
  wire \$111 ;
  wire \$112 ;
  wire \$113 ;
  wire \$114 ;
  wire \$115 ;
  wire \$116 ;
  (* unused_bits = "4" *)
  wire [4:0] \$117 ;
  wire \$118 ;
  wire \$119 ;
  wire \$12 ;
  wire \$120 ;
  wire \$121 ;
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
  (* unused_bits = "3" *)
  wire [3:0] \$166 ;
  wire \$167 ;
  wire \$169 ;
  wire \$17 ;
  wire \$170 ;
  wire \$171 ;
  (* unused_bits = "3" *)
  wire [3:0] \$172 ;
  wire \$173 ;
  wire \$174 ;
  wire \$175 ;
  wire \$176 ;
  wire \$177 ;
  wire \$178 ;
  wire \$179 ;
  wire [31:0] \$180 ;
  wire [63:0] \$181 ;
  wire [63:0] \$182 ;
  wire [63:0] \$183 ;
  wire [63:0] \$184 ;
  wire [63:0] \$185 ;
  wire [63:0] \$186 ;
  wire \$187 ;
  wire [2:0] \$188 ;
  wire [2:0] \$189 ;
  wire [2:0] \$190 ;
  wire \$191 ;
  wire [2:0] \$192 ;
  wire \$2 ;
  wire \$3 ;
  wire \$4 ;
  wire \$5 ;
  wire \$52 ;
  wire \$53 ;
  wire \$6 ;
  wire \$7 ;
  wire \$8 ;
  wire \$9 ;
  wire \$94 ;
  wire \$98 ;
  wire \$99 ;
  wire [2:0] choice_100_Y ;
  wire [2:0] choice_102_Y ;
  wire [2:0] choice_104_Y ;
  wire [2:0] choice_106_Y ;
  wire [2:0] choice_110_Y ;
  wire [2:0] choice_112_Y ;
  wire [2:0] choice_114_Y ;
  wire [2:0] choice_116_Y ;
  wire [2:0] choice_118_Y ;
  wire [2:0] choice_120_Y ;
  wire [2:0] choice_124_Y ;
  wire [63:0] choice_130_Y ;
  wire [63:0] choice_132_Y ;
  wire choice_133_CMP ;
  wire [63:0] choice_136_Y ;
  wire [63:0] choice_138_Y ;
  wire choice_139_CMP ;
  wire [63:0] choice_142_Y ;
  wire [63:0] choice_144_Y ;
  wire choice_145_CMP ;
  wire [63:0] choice_148_Y ;
  wire [63:0] choice_150_Y ;
  wire choice_151_CMP ;
  wire [63:0] choice_154_Y ;
  wire [63:0] choice_156_Y ;
  wire choice_157_CMP ;
  wire [63:0] choice_160_Y ;
  wire [63:0] choice_162_Y ;
  wire choice_163_CMP ;
  wire [7:0] choice_166_Y ;
  wire [7:0] choice_168_Y ;
  wire choice_169_CMP ;
  wire [7:0] choice_170_Y ;
  wire choice_172_CMP ;
  wire [7:0] choice_173_Y ;
  wire choice_175_CMP ;
  wire [7:0] choice_176_Y ;
  wire choice_178_CMP ;
  wire [7:0] choice_179_Y ;
  wire choice_181_CMP ;
  wire [7:0] choice_182_Y ;
  wire choice_184_CMP ;
  wire [7:0] choice_187_Y ;
  wire [7:0] choice_189_Y ;
  wire choice_190_CMP ;
  wire [7:0] choice_191_Y ;
  wire choice_193_CMP ;
  wire [7:0] choice_194_Y ;
  wire choice_196_CMP ;
  wire [7:0] choice_197_Y ;
  wire choice_199_CMP ;
  wire [7:0] choice_200_Y ;
  wire choice_202_CMP ;
  wire [7:0] choice_203_Y ;
  wire choice_205_CMP ;
  wire [7:0] choice_208_Y ;
  wire [7:0] choice_210_Y ;
  wire choice_211_CMP ;
  wire [7:0] choice_212_Y ;
  wire choice_214_CMP ;
  wire [7:0] choice_215_Y ;
  wire choice_217_CMP ;
  wire [7:0] choice_218_Y ;
  wire choice_220_CMP ;
  wire [7:0] choice_221_Y ;
  wire choice_223_CMP ;
  wire [7:0] choice_224_Y ;
  wire choice_226_CMP ;
  wire [7:0] choice_229_Y ;
  wire [7:0] choice_231_Y ;
  wire choice_232_CMP ;
  wire [7:0] choice_233_Y ;
  wire choice_235_CMP ;
  wire [7:0] choice_236_Y ;
  wire choice_238_CMP ;
  wire [7:0] choice_239_Y ;
  wire choice_241_CMP ;
  wire [7:0] choice_242_Y ;
  wire choice_244_CMP ;
  wire [7:0] choice_245_Y ;
  wire choice_247_CMP ;
  wire choice_250_Y ;
  wire choice_252_Y ;
  wire choice_254_Y ;
  wire choice_256_Y ;
  wire choice_258_Y ;
  wire choice_260_Y ;
  wire choice_262_Y ;
  wire choice_266_Y ;
  wire choice_268_Y ;
  wire choice_270_Y ;
  wire choice_271_CMP ;
  wire choice_274_Y ;
  wire choice_276_Y ;
  wire choice_278_Y ;
  wire choice_279_CMP ;
  wire choice_282_Y ;
  wire choice_284_Y ;
  wire choice_286_Y ;
  wire choice_287_CMP ;
  wire choice_290_Y ;
  wire choice_292_Y ;
  wire choice_294_Y ;
  wire choice_295_CMP ;
  wire choice_298_Y ;
  wire choice_300_Y ;
  wire choice_302_Y ;
  wire choice_303_CMP ;
  wire choice_306_Y ;
  wire choice_308_Y ;
  wire choice_310_Y ;
  wire choice_311_CMP ;
  wire choice_314_Y ;
  wire choice_316_Y ;
  wire [2:0] choice_326_Y ;
  wire [2:0] choice_328_Y ;
  wire [2:0] choice_330_Y ;
  wire choice_342_Y ;
  wire choice_345_CMP ;
  wire choice_347_CMP ;
  wire choice_348_CMP ;
  wire choice_349_CMP ;
  wire choice_350_CMP ;
  wire choice_351_CMP ;
  wire choice_352_CMP ;
  wire [2:0] choice_367_Y ;
  wire choice_370_CMP ;
  wire [2:0] choice_371_Y ;
  wire choice_373_CMP ;
  wire [2:0] choice_374_Y ;
  wire choice_376_CMP ;
  wire [2:0] choice_377_Y ;
  wire choice_379_CMP ;
  wire [2:0] choice_380_Y ;
  wire choice_382_CMP ;
  wire [2:0] choice_383_Y ;
  wire choice_385_CMP ;
  wire choice_387_CMP ;
  wire choice_388_CMP ;
  wire choice_389_CMP ;
  wire choice_390_CMP ;
  wire choice_391_CMP ;
  wire choice_392_CMP ;
  wire choice_393_CMP ;
  wire choice_395_CMP ;
  wire choice_396_CMP ;
  wire choice_397_CMP ;
  wire choice_398_CMP ;
  wire choice_399_CMP ;
  wire choice_400_CMP ;
  wire choice_401_CMP ;
  wire choice_403_CMP ;
  wire choice_405_CMP ;
  wire choice_407_CMP ;
  wire choice_408_CMP ;
  wire choice_409_CMP ;
  wire choice_410_CMP ;
  wire choice_411_CMP ;
  wire choice_412_CMP ;
  wire choice_413_CMP ;
  wire [2:0] choice_69_Y ;
  wire [2:0] choice_71_Y ;
  wire [2:0] choice_73_Y ;
  wire [2:0] choice_75_Y ;
  wire [2:0] choice_77_Y ;
  wire choice_82_Y ;
  wire choice_84_Y ;
  wire choice_86_Y ;
  wire choice_88_Y ;
  wire choice_90_Y ;
  wire choice_92_Y ;
  wire [2:0] choice_96_Y ;
  wire [2:0] choice_98_Y ;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] \$signal ;
  wire \$signal$50 ;
  wire able_0;
  input aclk;
  wire aclk;
  wire [2:0] align;
  wire [2:0] \align$64 ;
  wire all_served;
  wire allowed;
  wire [3:0] base;
  wire [3:0] behind;
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
  wire done;
  reg draining = 1'h0;
  wire drop;
  wire enable;
  wire ended;
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
  reg [2:0] extra = 3'h0;
  wire final_sig;
  wire finish;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] finished;
  wire [3:0] first_bytes;
  wire first_last;
  wire go_0;
  wire has_items;
  (* unused_bits = "2" *)
  wire [11:0] have;
  wire held;
  wire [7:0] lane_used;
  wire last_items;
  wire left;
  wire map_there;
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
  wire mismatch;
  wire [3:0] most_items;
  wire [2:0] next_step;
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
  wire reached_0;
  input rst;
  wire rst;
  wire [3:0] run_bytes;
  wire [71:0] \run_bytes$54 ;
  wire [12:0] run_have;
  wire running;
  reg served_0 = 1'h0;
  wire [3:0] small_sig;
  (* enum_base_type = "Status" *)
  (* enum_value_000 = "OK" *)
  (* enum_value_001 = "TRUNCATED" *)
  (* enum_value_010 = "TRAILING" *)
  (* enum_value_011 = "LENGTH" *)
  (* enum_value_100 = "ENCAPSULATION" *)
  (* enum_value_101 = "STRING" *)
  (* enum_value_110 = "ITEMS" *)
  wire [2:0] status;
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
  assign \$2  = have[0] & \$1 ;
  assign \$3  = data[15:8] != 1'h1;
  assign \$4  = have[1] & \$3 ;
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
  assign go_0 = \$53  & able_0;
  assign reached_0 = served_0 | able_0;
  assign \$94  = | error;
  assign \$98  = ~ draining;
  assign \$99  = | error;
  assign \$100  = map_there | ended;
  assign \$101  = held & \$100 ;
  assign \$102  = \$99  | \$101 ;
  assign enable = \$98  & \$102 ;
  assign \$105  = enable & reached_0;
  assign \$106  = ~ ends;
  assign \$107  = ~ status__valid;
  assign \$108  = \$107  | status__ready;
  assign \$109  = \$106  | \$108 ;
  assign complete = \$105  & \$109 ;
  assign { \$110 [4], count } = base + 4'h0;
  assign \$111  = | error;
  assign \$112  = ~ \$111 ;
  assign \$113  = complete & \$112 ;
  assign \$114  = ~ ends;
  assign take = \$113  & \$114 ;
  assign finish = complete & ends;
  assign \$115  = ! \$signal ;
  assign \$116  = \$115  & \behind$51 [3];
  assign { \$117 [4], total } = extra + first_bytes;
  assign \$118  = ! error;
  assign \$119  = total > 2'h3;
  assign \$120  = \$118  & \$119 ;
  assign \$121  = draining & held;
  assign \$123  = ~ status__valid;
  assign \$124  = \$123  | status__ready;
  assign \$125  = | error;
  assign \$126  = ~ \$125 ;
  assign \$127  = have[3] & \$126 ;
  assign \$128  = ~ mismatch;
  assign \$129  = \$127  & \$128 ;
  assign \$130  = \$129  ? { data[31:0], carry } : 64'h0000000000000000;
  assign \$131  = | error;
  assign \$132  = ~ \$131 ;
  assign \$133  = have[3] & \$132 ;
  assign \$134  = ~ mismatch;
  assign \$135  = \$133  & \$134 ;
  assign \$136  = \$135  ? { data[31:0], carry } : 64'h0000000000000000;
  assign \$137  = | error;
  assign \$138  = ~ \$137 ;
  assign \$139  = have[3] & \$138 ;
  assign \$140  = ~ mismatch;
  assign \$141  = \$139  & \$140 ;
  assign \$142  = \$141  ? { data[31:0], carry } : 64'h0000000000000000;
  assign \$143  = | error;
  assign \$144  = ~ \$143 ;
  assign \$145  = have[3] & \$144 ;
  assign \$146  = ~ mismatch;
  assign \$147  = \$145  & \$146 ;
  assign \$148  = \$147  ? { data[31:0], carry } : 64'h0000000000000000;
  assign \$149  = | error;
  assign \$150  = ~ \$149 ;
  assign \$151  = have[3] & \$150 ;
  assign \$152  = ~ mismatch;
  assign \$153  = \$151  & \$152 ;
  assign \$154  = \$153  ? { data[31:0], carry } : 64'h0000000000000000;
  assign \$155  = | error;
  assign \$156  = ~ \$155 ;
  assign \$157  = have[3] & \$156 ;
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
  assign \$169  = ~ status__valid;
  assign \$170  = \$169  | status__ready;
  assign \$171  = total > 2'h3;
  assign \$172  = \$171  ? 4'h4 : total;
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
  assign choice_100_Y  = complete ? choice_98_Y  : status__payload;
  assign choice_102_Y  = \$170  ? status : choice_100_Y ;
  assign choice_104_Y  = first_last ? choice_102_Y  : choice_100_Y ;
  assign choice_106_Y  = \$167  ? choice_104_Y  : choice_100_Y ;
  assign \$190  = rst ? 3'h0 : choice_106_Y ;
  assign choice_110_Y  = ended ? 3'h0 : \$signal ;
  assign choice_112_Y  = ends ? choice_110_Y  : \$signal ;
  assign choice_114_Y  = complete ? choice_112_Y  : error;
  assign choice_116_Y  = \$170  ? 3'h0 : choice_114_Y ;
  assign choice_118_Y  = first_last ? choice_116_Y  : choice_114_Y ;
  assign choice_120_Y  = \$167  ? choice_118_Y  : choice_114_Y ;
  assign \$189  = rst ? 3'h0 : choice_120_Y ;
  assign choice_124_Y  = complete ? next_step : step;
  assign \$188  = rst ? 3'h0 : choice_124_Y ;
  assign \$187  = rst ? 1'h0 : \$163 ;
  assign choice_130_Y  = go_0 ? \$160  : message__angular__z__payload;
  assign choice_132_Y  = choice_133_CMP  ? choice_130_Y  : message__angular__z__payload;
  assign choice_133_CMP  = step == 3'h6;
  assign \$186  = rst ? 64'h0000000000000000 : choice_132_Y ;
  assign choice_136_Y  = go_0 ? \$154  : message__angular__y__payload;
  assign choice_138_Y  = choice_139_CMP  ? choice_136_Y  : message__angular__y__payload;
  assign choice_139_CMP  = step == 3'h5;
  assign \$185  = rst ? 64'h0000000000000000 : choice_138_Y ;
  assign choice_142_Y  = go_0 ? \$148  : message__angular__x__payload;
  assign choice_144_Y  = choice_145_CMP  ? choice_142_Y  : message__angular__x__payload;
  assign choice_145_CMP  = step == 3'h4;
  assign \$184  = rst ? 64'h0000000000000000 : choice_144_Y ;
  assign choice_148_Y  = go_0 ? \$142  : message__linear__z__payload;
  assign choice_150_Y  = choice_151_CMP  ? choice_148_Y  : message__linear__z__payload;
  assign choice_151_CMP  = step == 3'h3;
  assign \$183  = rst ? 64'h0000000000000000 : choice_150_Y ;
  assign choice_154_Y  = go_0 ? \$136  : message__linear__y__payload;
  assign choice_156_Y  = choice_157_CMP  ? choice_154_Y  : message__linear__y__payload;
  assign choice_157_CMP  = step == 3'h2;
  assign \$182  = rst ? 64'h0000000000000000 : choice_156_Y ;
  assign choice_160_Y  = go_0 ? \$130  : message__linear__x__payload;
  assign choice_162_Y  = choice_163_CMP  ? choice_160_Y  : message__linear__x__payload;
  assign choice_163_CMP  = step == 3'h1;
  assign \$181  = rst ? 64'h0000000000000000 : choice_162_Y ;
  assign choice_166_Y  = complete ? data[63:56] : carry[31:24];
  function [7:0] choice_168 ;
    input [7:0] a;
    input [47:0] b;
    input [5:0] s;
    (* parallel_case *)
    casez (s)
      6'b?????1:
        choice_168  = b[7:0];
      6'b????1?:
        choice_168  = b[15:8];
      6'b???1??:
        choice_168  = b[23:16];
      6'b??1???:
        choice_168  = b[31:24];
      6'b?1????:
        choice_168  = b[39:32];
      6'b1?????:
        choice_168  = b[47:40];
      default:
        choice_168  = a;
    endcase
  endfunction
  assign choice_168_Y  = choice_168 (carry[31:24], { choice_182_Y , choice_179_Y , choice_176_Y , choice_173_Y , choice_170_Y , choice_166_Y  }, { choice_184_CMP , choice_181_CMP , choice_178_CMP , choice_175_CMP , choice_172_CMP , choice_169_CMP  });
  assign choice_169_CMP  = step == 3'h5;
  assign choice_170_Y  = complete ? data[63:56] : carry[31:24];
  assign choice_172_CMP  = step == 3'h4;
  assign choice_173_Y  = complete ? data[63:56] : carry[31:24];
  assign choice_175_CMP  = step == 3'h3;
  assign choice_176_Y  = complete ? data[63:56] : carry[31:24];
  assign choice_178_CMP  = step == 3'h2;
  assign choice_179_Y  = complete ? data[63:56] : carry[31:24];
  assign choice_181_CMP  = step == 3'h1;
  assign choice_182_Y  = complete ? data[63:56] : carry[31:24];
  assign choice_184_CMP  = ! step;
  assign \$180 [31:24] = rst ? 8'h00 : choice_168_Y ;
  assign choice_187_Y  = complete ? data[47:40] : carry[15:8];
  function [7:0] choice_189 ;
    input [7:0] a;
    input [47:0] b;
    input [5:0] s;
    (* parallel_case *)
    casez (s)
      6'b?????1:
        choice_189  = b[7:0];
      6'b????1?:
        choice_189  = b[15:8];
      6'b???1??:
        choice_189  = b[23:16];
      6'b??1???:
        choice_189  = b[31:24];
      6'b?1????:
        choice_189  = b[39:32];
      6'b1?????:
        choice_189  = b[47:40];
      default:
        choice_189  = a;
    endcase
  endfunction
  assign choice_189_Y  = choice_189 (carry[15:8], { choice_203_Y , choice_200_Y , choice_197_Y , choice_194_Y , choice_191_Y , choice_187_Y  }, { choice_205_CMP , choice_202_CMP , choice_199_CMP , choice_196_CMP , choice_193_CMP , choice_190_CMP  });
  assign choice_190_CMP  = step == 3'h5;
  assign choice_191_Y  = complete ? data[47:40] : carry[15:8];
  assign choice_193_CMP  = step == 3'h4;
  assign choice_194_Y  = complete ? data[47:40] : carry[15:8];
  assign choice_196_CMP  = step == 3'h3;
  assign choice_197_Y  = complete ? data[47:40] : carry[15:8];
  assign choice_199_CMP  = step == 3'h2;
  assign choice_200_Y  = complete ? data[47:40] : carry[15:8];
  assign choice_202_CMP  = step == 3'h1;
  assign choice_203_Y  = complete ? data[47:40] : carry[15:8];
  assign choice_205_CMP  = ! step;
  assign \$180 [15:8] = rst ? 8'h00 : choice_189_Y ;
  assign choice_208_Y  = complete ? data[39:32] : carry[7:0];
  function [7:0] choice_210 ;
    input [7:0] a;
    input [47:0] b;
    input [5:0] s;
    (* parallel_case *)
    casez (s)
      6'b?????1:
        choice_210  = b[7:0];
      6'b????1?:
        choice_210  = b[15:8];
      6'b???1??:
        choice_210  = b[23:16];
      6'b??1???:
        choice_210  = b[31:24];
      6'b?1????:
        choice_210  = b[39:32];
      6'b1?????:
        choice_210  = b[47:40];
      default:
        choice_210  = a;
    endcase
  endfunction
  assign choice_210_Y  = choice_210 (carry[7:0], { choice_224_Y , choice_221_Y , choice_218_Y , choice_215_Y , choice_212_Y , choice_208_Y  }, { choice_226_CMP , choice_223_CMP , choice_220_CMP , choice_217_CMP , choice_214_CMP , choice_211_CMP  });
  assign choice_211_CMP  = step == 3'h5;
  assign choice_212_Y  = complete ? data[39:32] : carry[7:0];
  assign choice_214_CMP  = step == 3'h4;
  assign choice_215_Y  = complete ? data[39:32] : carry[7:0];
  assign choice_217_CMP  = step == 3'h3;
  assign choice_218_Y  = complete ? data[39:32] : carry[7:0];
  assign choice_220_CMP  = step == 3'h2;
  assign choice_221_Y  = complete ? data[39:32] : carry[7:0];
  assign choice_223_CMP  = step == 3'h1;
  assign choice_224_Y  = complete ? data[39:32] : carry[7:0];
  assign choice_226_CMP  = ! step;
  assign \$180 [7:0] = rst ? 8'h00 : choice_210_Y ;
  assign choice_229_Y  = complete ? data[55:48] : carry[23:16];
  function [7:0] choice_231 ;
    input [7:0] a;
    input [47:0] b;
    input [5:0] s;
    (* parallel_case *)
    casez (s)
      6'b?????1:
        choice_231  = b[7:0];
      6'b????1?:
        choice_231  = b[15:8];
      6'b???1??:
        choice_231  = b[23:16];
      6'b??1???:
        choice_231  = b[31:24];
      6'b?1????:
        choice_231  = b[39:32];
      6'b1?????:
        choice_231  = b[47:40];
      default:
        choice_231  = a;
    endcase
  endfunction
  assign choice_231_Y  = choice_231 (carry[23:16], { choice_245_Y , choice_242_Y , choice_239_Y , choice_236_Y , choice_233_Y , choice_229_Y  }, { choice_247_CMP , choice_244_CMP , choice_241_CMP , choice_238_CMP , choice_235_CMP , choice_232_CMP  });
  assign choice_232_CMP  = step == 3'h5;
  assign choice_233_Y  = complete ? data[55:48] : carry[23:16];
  assign choice_235_CMP  = step == 3'h4;
  assign choice_236_Y  = complete ? data[55:48] : carry[23:16];
  assign choice_238_CMP  = step == 3'h3;
  assign choice_239_Y  = complete ? data[55:48] : carry[23:16];
  assign choice_241_CMP  = step == 3'h2;
  assign choice_242_Y  = complete ? data[55:48] : carry[23:16];
  assign choice_244_CMP  = step == 3'h1;
  assign choice_245_Y  = complete ? data[55:48] : carry[23:16];
  assign choice_247_CMP  = ! step;
  assign \$180 [23:16] = rst ? 8'h00 : choice_231_Y ;
  assign choice_250_Y  = status__ready ? 1'h0 : status__valid;
  assign choice_252_Y  = ended ? 1'h1 : choice_250_Y ;
  assign choice_254_Y  = ends ? choice_252_Y  : choice_250_Y ;
  assign choice_256_Y  = complete ? choice_254_Y  : choice_250_Y ;
  assign choice_258_Y  = \$170  ? 1'h1 : choice_256_Y ;
  assign choice_260_Y  = first_last ? choice_258_Y  : choice_256_Y ;
  assign choice_262_Y  = \$167  ? choice_260_Y  : choice_256_Y ;
  assign \$179  = rst ? 1'h0 : choice_262_Y ;
  assign choice_266_Y  = message__angular__z__ready ? 1'h0 : message__angular__z__valid;
  assign choice_268_Y  = go_0 ? 1'h1 : choice_266_Y ;
  assign choice_270_Y  = choice_271_CMP  ? choice_268_Y  : choice_266_Y ;
  assign choice_271_CMP  = step == 3'h6;
  assign \$178  = rst ? 1'h0 : choice_270_Y ;
  assign choice_274_Y  = message__angular__y__ready ? 1'h0 : message__angular__y__valid;
  assign choice_276_Y  = go_0 ? 1'h1 : choice_274_Y ;
  assign choice_278_Y  = choice_279_CMP  ? choice_276_Y  : choice_274_Y ;
  assign choice_279_CMP  = step == 3'h5;
  assign \$177  = rst ? 1'h0 : choice_278_Y ;
  assign choice_282_Y  = message__angular__x__ready ? 1'h0 : message__angular__x__valid;
  assign choice_284_Y  = go_0 ? 1'h1 : choice_282_Y ;
  assign choice_286_Y  = choice_287_CMP  ? choice_284_Y  : choice_282_Y ;
  assign choice_287_CMP  = step == 3'h4;
  assign \$176  = rst ? 1'h0 : choice_286_Y ;
  assign choice_290_Y  = message__linear__z__ready ? 1'h0 : message__linear__z__valid;
  assign choice_292_Y  = go_0 ? 1'h1 : choice_290_Y ;
  assign choice_294_Y  = choice_295_CMP  ? choice_292_Y  : choice_290_Y ;
  assign choice_295_CMP  = step == 3'h3;
  assign \$175  = rst ? 1'h0 : choice_294_Y ;
  assign choice_298_Y  = message__linear__y__ready ? 1'h0 : message__linear__y__valid;
  assign choice_300_Y  = go_0 ? 1'h1 : choice_298_Y ;
  assign choice_302_Y  = choice_303_CMP  ? choice_300_Y  : choice_298_Y ;
  assign choice_303_CMP  = step == 3'h2;
  assign \$174  = rst ? 1'h0 : choice_302_Y ;
  assign choice_306_Y  = message__linear__x__ready ? 1'h0 : message__linear__x__valid;
  assign choice_308_Y  = go_0 ? 1'h1 : choice_306_Y ;
  assign choice_310_Y  = choice_311_CMP  ? choice_308_Y  : choice_306_Y ;
  assign choice_311_CMP  = step == 3'h1;
  assign \$173  = rst ? 1'h0 : choice_310_Y ;
  assign choice_314_Y  = \$124  ? 1'h1 : 1'h0;
  assign choice_316_Y  = first_last ? choice_314_Y  : 1'h1;
  assign drop = \$121  ? choice_316_Y  : 1'h0;
  assign status = \$120  ? 3'h2 : error;
  assign finished = \$116  ? 3'h2 : \$signal ;
  assign choice_326_Y  = map_there ? error : 3'h1;
  assign choice_328_Y  = map_there ? choice_326_Y  : 3'h1;
  assign choice_330_Y  = mismatch ? 3'h4 : choice_328_Y ;
  assign \$signal  = \$94  ? error : choice_330_Y ;
  assign choice_342_Y  = done ? 1'h1 : 1'h0;
  assign ends = choice_345_CMP  ? choice_342_Y  : 1'h0;
  assign choice_345_CMP  = step == 3'h6;
  function [0:0] choice_346 ;
    input [0:0] a;
    input [5:0] b;
    input [5:0] s;
    (* parallel_case *)
    casez (s)
      6'b?????1:
        choice_346  = b[0:0];
      6'b????1?:
        choice_346  = b[1:1];
      6'b???1??:
        choice_346  = b[2:2];
      6'b??1???:
        choice_346  = b[3:3];
      6'b?1????:
        choice_346  = b[4:4];
      6'b1?????:
        choice_346  = b[5:5];
      default:
        choice_346  = a;
    endcase
  endfunction
  assign able_0 = choice_346 (1'h1, { \$7 , \$9 , \$11 , \$13 , \$15 , \$17  }, { choice_352_CMP , choice_351_CMP , choice_350_CMP , choice_349_CMP , choice_348_CMP , choice_347_CMP  });
  assign choice_347_CMP  = step == 3'h6;
  assign choice_348_CMP  = step == 3'h5;
  assign choice_349_CMP  = step == 3'h4;
  assign choice_350_CMP  = step == 3'h3;
  assign choice_351_CMP  = step == 3'h2;
  assign choice_352_CMP  = step == 3'h1;
  assign choice_367_Y  = done ? 3'h6 : 3'h0;
  function [2:0] choice_369 ;
    input [2:0] a;
    input [17:0] b;
    input [5:0] s;
    (* parallel_case *)
    casez (s)
      6'b?????1:
        choice_369  = b[2:0];
      6'b????1?:
        choice_369  = b[5:3];
      6'b???1??:
        choice_369  = b[8:6];
      6'b??1???:
        choice_369  = b[11:9];
      6'b?1????:
        choice_369  = b[14:12];
      6'b1?????:
        choice_369  = b[17:15];
      default:
        choice_369  = a;
    endcase
  endfunction
  assign next_step = choice_369 (3'h0, { choice_383_Y , choice_380_Y , choice_377_Y , choice_374_Y , choice_371_Y , choice_367_Y  }, { choice_385_CMP , choice_382_CMP , choice_379_CMP , choice_376_CMP , choice_373_CMP , choice_370_CMP  });
  assign choice_370_CMP  = step == 3'h5;
  assign choice_371_Y  = done ? 3'h5 : 3'h0;
  assign choice_373_CMP  = step == 3'h4;
  assign choice_374_Y  = done ? 3'h4 : 3'h0;
  assign choice_376_CMP  = step == 3'h3;
  assign choice_377_Y  = done ? 3'h3 : 3'h0;
  assign choice_379_CMP  = step == 3'h2;
  assign choice_380_Y  = done ? 3'h2 : 3'h0;
  assign choice_382_CMP  = step == 3'h1;
  assign choice_383_Y  = done ? 3'h1 : 3'h0;
  assign choice_385_CMP  = ! step;
  function [0:0] choice_386 ;
    input [0:0] a;
    input [6:0] b;
    input [6:0] s;
    (* parallel_case *)
    casez (s)
      7'b??????1:
        choice_386  = b[0:0];
      7'b?????1?:
        choice_386  = b[1:1];
      7'b????1??:
        choice_386  = b[2:2];
      7'b???1???:
        choice_386  = b[3:3];
      7'b??1????:
        choice_386  = b[4:4];
      7'b?1?????:
        choice_386  = b[5:5];
      7'b1??????:
        choice_386  = b[6:6];
      default:
        choice_386  = a;
    endcase
  endfunction
  assign done = choice_386 (1'h0, 7'h7f, { choice_393_CMP , choice_392_CMP , choice_391_CMP , choice_390_CMP , choice_389_CMP , choice_388_CMP , choice_387_CMP  });
  assign choice_387_CMP  = step == 3'h6;
  assign choice_388_CMP  = step == 3'h5;
  assign choice_389_CMP  = step == 3'h4;
  assign choice_390_CMP  = step == 3'h3;
  assign choice_391_CMP  = step == 3'h2;
  assign choice_392_CMP  = step == 3'h1;
  assign choice_393_CMP  = ! step;
  function [3:0] choice_394 ;
    input [3:0] a;
    input [27:0] b;
    input [6:0] s;
    (* parallel_case *)
    casez (s)
      7'b??????1:
        choice_394  = b[3:0];
      7'b?????1?:
        choice_394  = b[7:4];
      7'b????1??:
        choice_394  = b[11:8];
      7'b???1???:
        choice_394  = b[15:12];
      7'b??1????:
        choice_394  = b[19:16];
      7'b?1?????:
        choice_394  = b[23:20];
      7'b1??????:
        choice_394  = b[27:24];
      default:
        choice_394  = a;
    endcase
  endfunction
  assign base = choice_394 (4'h0, 28'h8888884, { choice_401_CMP , choice_400_CMP , choice_399_CMP , choice_398_CMP , choice_397_CMP , choice_396_CMP , choice_395_CMP  });
  assign choice_395_CMP  = step == 3'h6;
  assign choice_396_CMP  = step == 3'h5;
  assign choice_397_CMP  = step == 3'h4;
  assign choice_398_CMP  = step == 3'h3;
  assign choice_399_CMP  = step == 3'h2;
  assign choice_400_CMP  = step == 3'h1;
  assign choice_401_CMP  = ! step;
  assign mismatch = choice_403_CMP  ? \$5  : 1'h0;
  assign choice_403_CMP  = ! step;
  assign \behind$51  = choice_405_CMP  ? have[7:4] : 4'h0;
  assign choice_405_CMP  = step == 3'h6;
  function [0:0] choice_406 ;
    input [0:0] a;
    input [6:0] b;
    input [6:0] s;
    (* parallel_case *)
    casez (s)
      7'b??????1:
        choice_406  = b[0:0];
      7'b?????1?:
        choice_406  = b[1:1];
      7'b????1??:
        choice_406  = b[2:2];
      7'b???1???:
        choice_406  = b[3:3];
      7'b??1????:
        choice_406  = b[4:4];
      7'b?1?????:
        choice_406  = b[5:5];
      7'b1??????:
        choice_406  = b[6:6];
      default:
        choice_406  = a;
    endcase
  endfunction
  assign map_there = choice_406 (1'h0, { have[7], have[7], have[7], have[7], have[7], have[7], have[3] }, { choice_413_CMP , choice_412_CMP , choice_411_CMP , choice_410_CMP , choice_409_CMP , choice_408_CMP , choice_407_CMP  });
  assign choice_407_CMP  = step == 3'h6;
  assign choice_408_CMP  = step == 3'h5;
  assign choice_409_CMP  = step == 3'h4;
  assign choice_410_CMP  = step == 3'h3;
  assign choice_411_CMP  = step == 3'h2;
  assign choice_412_CMP  = step == 3'h1;
  assign choice_413_CMP  = ! step;
  assign choice_69_Y  = ended ? (* full_case = 32'd1 *) extra : \$166 [2:0];
  assign choice_71_Y  = ends ? choice_69_Y  : extra;
  assign choice_73_Y  = complete ? choice_71_Y  : extra;
  assign choice_75_Y  = first_last ? choice_73_Y  : \$172 [2:0];
  assign choice_77_Y  = \$167  ? choice_75_Y  : choice_73_Y ;
  assign \$192  = rst ? 3'h0 : choice_77_Y ;
  assign choice_82_Y  = ended ? (* full_case = 32'd1 *) draining : 1'h1;
  assign choice_84_Y  = ends ? choice_82_Y  : draining;
  assign choice_86_Y  = complete ? choice_84_Y  : draining;
  assign choice_88_Y  = \$170  ? 1'h0 : choice_86_Y ;
  assign choice_90_Y  = first_last ? choice_88_Y  : choice_86_Y ;
  assign choice_92_Y  = \$167  ? choice_90_Y  : choice_86_Y ;
  assign \$191  = rst ? 1'h0 : choice_92_Y ;
  assign choice_96_Y  = ended ? finished : status__payload;
  assign choice_98_Y  = ends ? choice_96_Y  : status__payload;
  \geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.core.window  window (
    .aclk(aclk),
    .count(count),
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
    .\port$341$0 (have[7:0]),
    .rst(rst),
    .take(take)
  );
  assign \data[7]  = data[63:56];
  assign \data[6]  = data[55:48];
  assign \data[5]  = data[47:40];
  assign \data[4]  = data[39:32];
  assign \data[3]  = data[31:24];
  assign \data[2]  = data[23:16];
  assign \data[1]  = data[15:8];
  assign \data[0]  = data[7:0];
  assign \packets__payload$1.last  = packets__payload[68];
  assign \packets__payload$1.count  = packets__payload[67:64];
  assign \packets__payload$1.data[7]  = packets__payload[63:56];
  assign \packets__payload$1.data[6]  = packets__payload[55:48];
  assign \packets__payload$1.data[5]  = packets__payload[47:40];
  assign \packets__payload$1.data[4]  = packets__payload[39:32];
  assign \packets__payload$1.data[3]  = packets__payload[31:24];
  assign \packets__payload$1.data[2]  = packets__payload[23:16];
  assign \packets__payload$1.data[1]  = packets__payload[15:8];
  assign \packets__payload$1.data[0]  = packets__payload[7:0];
  assign \packets__payload$1.data  = packets__payload[63:0];
  assign \packets__payload.last  = packets__payload[68];
  assign \packets__payload.count  = packets__payload[67:64];
  assign \packets__payload.data[7]  = packets__payload[63:56];
  assign \packets__payload.data[6]  = packets__payload[55:48];
  assign \packets__payload.data[5]  = packets__payload[47:40];
  assign \packets__payload.data[4]  = packets__payload[39:32];
  assign \packets__payload.data[3]  = packets__payload[31:24];
  assign \packets__payload.data[2]  = packets__payload[23:16];
  assign \packets__payload.data[1]  = packets__payload[15:8];
  assign \packets__payload.data[0]  = packets__payload[7:0];
  assign \packets__payload.data  = packets__payload[63:0];
  assign \$117 [3:0] = total;
  assign \$110 [3:0] = count;
  assign \align$64  = 3'h0;
  assign over = 1'h0;
  assign \run_bytes$54  = 72'h000000000000000000;
  assign nul_missing = 1'h0;
  assign run_have = 13'h0000;
  assign \$signal$50  = map_there;
  assign all_served = reached_0;
  assign lane_used = 8'h00;
  assign last_items = 1'h1;
  assign unit_log2 = 3'h0;
  assign run_bytes = 4'h0;
  assign running = 1'h0;
  assign terminated = 1'h0;
  assign allowed = 1'h0;
  assign has_items = 1'h0;
  assign most_items = 4'h0;
  assign final_sig = 1'h1;
  assign left = 1'h0;
  assign small_sig = 4'h0;
  assign align = 3'h0;
  assign behind = \behind$51 ;
  assign have[11:8] = 4'h0;
  assign \packets__ready$5  = packets__ready;
  assign \packets__valid$3  = packets__valid;
  assign \packets__payload$1  = packets__payload;
endmodule

module \geometry_msgs_msg_Twist_cdr_8_deserializer_verilog.core.window (packets__valid, rst, count, take, finish, packets__ready, data, ends_0, \port$341$0 , ended, held, first_bytes, packets__payload, drop, aclk);
  (* unused_bits = "1" *)
  wire [1:0] \$1 ;
  wire \$10 ;
  wire [7:0] \$11 ;
  wire \$13 ;
  wire \$14 ;
  wire \$15 ;
  wire [1:0] \$16 ;
  wire [2:0] \$17 ;
  wire [3:0] \$18 ;
  wire [4:0] \$19 ;
  wire [5:0] \$20 ;
  wire [6:0] \$21 ;
  wire [7:0] \$22 ;
  (* unused_bits = "4 5 6 7" *)
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
  (* unused_bits = "1" *)
  wire [1:0] \$35 ;
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
  (* unused_bits = "2 3" *)
  wire [3:0] \$88 ;
  (* unused_bits = "1" *)
  wire [1:0] \$89 ;
  wire \$9 ;
  wire \$90 ;
  (* unused_bits = "2 3" *)
  wire [3:0] \$91 ;
  (* unused_bits = "2" *)
  wire [2:0] \$92 ;
  wire \$93 ;
  wire [72:0] \$94 ;
  wire [72:0] \$95 ;
  wire [1:0] \$96 ;
  wire \$97 ;
  wire [4:0] \$98 ;
  wire [2:0] choice_11_Y ;
  wire choice_19_Y ;
  wire choice_21_Y ;
  wire [63:0] choice_25_Y ;
  wire [63:0] choice_27_Y ;
  wire [1:0] choice_2_Y ;
  wire [7:0] choice_31_Y ;
  wire [7:0] choice_33_Y ;
  wire choice_37_Y ;
  wire choice_39_Y ;
  wire [63:0] choice_43_Y ;
  wire [63:0] choice_45_Y ;
  wire [7:0] choice_49_Y ;
  wire [1:0] choice_4_Y ;
  wire [7:0] choice_51_Y ;
  wire choice_55_Y ;
  wire choice_67_CMP ;
  wire [2:0] choice_9_Y ;
  input aclk;
  wire aclk;
  wire [72:0] beat_0;
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
  (* unused_bits = "0 1 2" *)
  wire [5:0] past;
  wire pops;
  wire pops_finished;
  wire pops_idle;
  wire pops_taken;
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
  (* unused_bits = "0 1 2" *)
  wire [5:0] taken;
  wire valid_0;
  assign \$1  = first + 1'h0;
  assign valid_0 = fill > 1'h0;
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
  assign \port$341$0  = \$11  & { valid_0, valid_0, valid_0, valid_0, valid_0, valid_0, valid_0, valid_0 };
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
  assign { \$23 [7:4], first_bytes } = \$15  ? \$22  : 8'h00;
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
  assign choice_11_Y  = \$90  ? (* full_case = 32'd1 *) 3'h0 : choice_9_Y ;
  assign \$98 [2:0] = rst ? 3'h0 : choice_11_Y ;
  assign \$97  = rst ? 1'h0 : \$89 [0];
  assign \$96  = rst ? 2'h0 : \$88 [1:0];
  assign choice_19_Y  = free ? packets__payload[68] : slot_1[72];
  assign choice_2_Y  = take ? (* full_case = 32'd1 *) \$91 [1:0] : \$92 [1:0];
  assign choice_21_Y  = \$34  ? choice_19_Y  : slot_1[72];
  assign \$95 [72] = rst ? 1'h0 : choice_21_Y ;
  assign choice_25_Y  = free ? packets__payload[63:0] : slot_1[63:0];
  assign choice_27_Y  = \$34  ? choice_25_Y  : slot_1[63:0];
  assign \$95 [63:0] = rst ? 64'h0000000000000000 : choice_27_Y ;
  assign choice_31_Y  = free ? { \$85 , \$82 , \$79 , \$76 , \$73 , \$70 , \$67 , \$64  } : slot_1[71:64];
  assign choice_33_Y  = \$34  ? choice_31_Y  : slot_1[71:64];
  assign \$95 [71:64] = rst ? 8'h00 : choice_33_Y ;
  assign choice_37_Y  = free ? slot_0[72] : packets__payload[68];
  assign choice_39_Y  = \$34  ? choice_37_Y  : slot_0[72];
  assign choice_4_Y  = \$90  ? (* full_case = 32'd1 *) 2'h0 : choice_2_Y ;
  assign \$94 [72] = rst ? 1'h0 : choice_39_Y ;
  assign choice_43_Y  = free ? slot_0[63:0] : packets__payload[63:0];
  assign choice_45_Y  = \$34  ? choice_43_Y  : slot_0[63:0];
  assign \$94 [63:0] = rst ? 64'h0000000000000000 : choice_45_Y ;
  assign choice_49_Y  = free ? slot_0[71:64] : { \$60 , \$57 , \$54 , \$51 , \$48 , \$45 , \$42 , \$39  };
  assign choice_51_Y  = \$34  ? choice_49_Y  : slot_0[71:64];
  assign \$94 [71:64] = rst ? 8'h00 : choice_51_Y ;
  assign choice_55_Y  = \$34  ? \$35 [0] : free;
  assign \$93  = rst ? 1'h0 : choice_55_Y ;
  assign pops_finished = valid_0 ? 1'h1 : 1'h0;
  assign \$98 [4:3] = rst ? 2'h0 : choice_4_Y ;
  assign pops_idle = \$31  ? 1'h1 : 1'h0;
  assign pops_taken = \$27  ? 1'h1 : 1'h0;
  function [72:0] choice_65 ;
    input [72:0] a;
    input [145:0] b;
    input [1:0] s;
    (* full_case = 32'd1 *)
    (* parallel_case *)
    casez (s)
      2'b?1:
        choice_65  = b[72:0];
      2'b1?:
        choice_65  = b[145:73];
      default:
        choice_65  = a;
    endcase
  endfunction
  assign beat_0 = choice_65 (73'hxxxxxxxxxxxxxxxxxxx, { slot_0, slot_1 }, { choice_67_CMP , \$1 [0] });
  assign choice_67_CMP  = ~ (* full_case = 32'd1 *) \$1 [0];
  assign choice_9_Y  = take ? (* full_case = 32'd1 *) 3'h0 : offset[2:0];
  assign \packets__payload.last  = packets__payload[68];
  assign \packets__payload.count  = packets__payload[67:64];
  assign \packets__payload.data[7]  = packets__payload[63:56];
  assign \packets__payload.data[6]  = packets__payload[55:48];
  assign \packets__payload.data[5]  = packets__payload[47:40];
  assign \packets__payload.data[4]  = packets__payload[39:32];
  assign \packets__payload.data[3]  = packets__payload[31:24];
  assign \packets__payload.data[2]  = packets__payload[23:16];
  assign \packets__payload.data[1]  = packets__payload[15:8];
  assign \packets__payload.data[0]  = packets__payload[7:0];
  assign \packets__payload.data  = packets__payload[63:0];
  assign \data[7]  = beat_0[63:56];
  assign \data[6]  = beat_0[55:48];
  assign \data[5]  = beat_0[47:40];
  assign \data[4]  = beat_0[39:32];
  assign \data[3]  = beat_0[31:24];
  assign \data[2]  = beat_0[23:16];
  assign \data[1]  = beat_0[15:8];
  assign \data[0]  = beat_0[7:0];
  assign \slot_1.last  = slot_1[72];
  assign \slot_1.keep  = slot_1[71:64];
  assign \slot_1.data  = slot_1[63:0];
  assign \slot_0.last  = slot_0[72];
  assign \slot_0.keep  = slot_0[71:64];
  assign \slot_0.data  = slot_0[63:0];
  assign \beat_0.last  = beat_0[72];
  assign \beat_0.keep  = beat_0[71:64];
  assign \beat_0.data  = beat_0[63:0];
  assign \$23 [3:0] = first_bytes;
  assign ended = ends_0;
  assign data = beat_0[63:0];
  assign past = taken;
  assign first_last = ends_0;
  assign have = { 4'h0, \port$341$0  };
endmodule
