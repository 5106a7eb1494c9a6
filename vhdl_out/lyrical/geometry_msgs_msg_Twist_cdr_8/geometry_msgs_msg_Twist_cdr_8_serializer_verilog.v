// geometry_msgs_msg_Twist_cdr_8_serializer_verilog: the serializer of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
// lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
// definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
// What each port means: manifest.json.

module geometry_msgs_msg_Twist_cdr_8_serializer_verilog(aresetn, m_axis_tready, linear_x_data, linear_x_valid, linear_y_data, linear_y_valid, linear_z_data, linear_z_valid, angular_x_data, angular_x_valid, angular_y_data, angular_y_valid, angular_z_data, angular_z_valid, m_axis_status_tready, m_axis_tdata, m_axis_tkeep, m_axis_tlast, m_axis_tuser, m_axis_tvalid, linear_x_ready
, linear_y_ready, linear_z_ready, angular_x_ready, angular_y_ready, angular_z_ready, m_axis_status_tdata, m_axis_status_tvalid, aclk);
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
  assign m_axis_tkeep[0] = packets__payload[67:64] > 1'h0;
  assign m_axis_tkeep[1] = packets__payload[67:64] > 1'h1;
  assign m_axis_tkeep[2] = packets__payload[67:64] > 2'h2;
  assign m_axis_tkeep[3] = packets__payload[67:64] > 2'h3;
  assign m_axis_tkeep[4] = packets__payload[67:64] > 3'h4;
  assign m_axis_tkeep[5] = packets__payload[67:64] > 3'h5;
  assign m_axis_tkeep[6] = packets__payload[67:64] > 3'h6;
  assign m_axis_tkeep[7] = packets__payload[67:64] > 3'h7;
  assign rst = ~ aresetn;
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
  assign \packets__payload.data[1]  = packets__payload[15:8];
  assign \packets__payload.data[0]  = packets__payload[7:0];
  assign \packets__payload.data  = packets__payload[63:0];
  assign \packets__payload.data[2]  = packets__payload[23:16];
  assign \packets__payload.data[3]  = packets__payload[31:24];
  assign \packets__payload.data[4]  = packets__payload[39:32];
  assign \packets__payload.data[5]  = packets__payload[47:40];
  assign \packets__payload.data[6]  = packets__payload[55:48];
  assign \packets__payload.data[7]  = packets__payload[63:56];
  assign \packets__payload.count  = packets__payload[67:64];
  assign \packets__payload.last  = packets__payload[68];
  assign m_axis_status_tdata = { 5'h00, status__payload };
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

module \geometry_msgs_msg_Twist_cdr_8_serializer_verilog.core (packets__ready, message__linear__x__payload, message__linear__x__valid, message__linear__y__payload, message__linear__y__valid, message__linear__z__payload, message__linear__z__valid, message__angular__x__payload, message__angular__x__valid, message__angular__y__payload, message__angular__y__valid, message__angular__z__payload, message__angular__z__valid, status__ready, rst, packets__valid, packet_error, message__linear__x__ready, message__linear__y__ready, message__linear__z__ready, message__angular__x__ready
, message__angular__y__ready, message__angular__z__ready, status__valid, status__payload, packets__payload, aclk);
  wire [7:0] \$1 ;
  wire [7:0] \$2 ;
  wire [7:0] \$3 ;
  wire [7:0] \$4 ;
  wire \$43 ;
  wire \$44 ;
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
  (* unused_bits = "4" *)
  wire [4:0] \$67 ;
  wire \$68 ;
  wire \$69 ;
  wire [7:0] \$7 ;
  wire \$70 ;
  wire \$71 ;
  wire \$72 ;
  wire \$73 ;
  wire [2:0] \$74 ;
  wire [7:0] \$75 ;
  wire [7:0] \$76 ;
  wire [7:0] \$77 ;
  wire [7:0] \$78 ;
  wire [7:0] \$79 ;
  wire [7:0] \$8 ;
  wire [7:0] \$80 ;
  wire [7:0] \$81 ;
  wire [7:0] \$82 ;
  wire [72:0] \$83 ;
  wire [2:0] \$84 ;
  wire [2:0] \$85 ;
  wire [7:0] choice_101_Y ;
  wire [7:0] choice_105_Y ;
  wire [2:0] choice_109_Y ;
  wire [2:0] choice_111_Y ;
  wire [2:0] choice_113_Y ;
  wire choice_117_Y ;
  wire choice_121_Y ;
  wire choice_129_Y ;
  wire choice_131_Y ;
  wire choice_133_Y ;
  wire choice_145_Y ;
  wire choice_148_CMP ;
  wire choice_150_CMP ;
  wire choice_152_CMP ;
  wire choice_154_CMP ;
  wire choice_156_CMP ;
  wire choice_158_CMP ;
  wire choice_160_CMP ;
  wire choice_162_CMP ;
  wire choice_163_CMP ;
  wire choice_164_CMP ;
  wire choice_165_CMP ;
  wire choice_166_CMP ;
  wire [2:0] choice_181_Y ;
  wire choice_184_CMP ;
  wire [2:0] choice_185_Y ;
  wire choice_187_CMP ;
  wire [2:0] choice_188_Y ;
  wire choice_190_CMP ;
  wire [2:0] choice_191_Y ;
  wire choice_193_CMP ;
  wire [2:0] choice_194_Y ;
  wire choice_196_CMP ;
  wire [2:0] choice_197_Y ;
  wire choice_199_CMP ;
  wire choice_201_CMP ;
  wire choice_202_CMP ;
  wire choice_203_CMP ;
  wire choice_204_CMP ;
  wire choice_205_CMP ;
  wire choice_206_CMP ;
  wire choice_207_CMP ;
  wire choice_209_CMP ;
  wire choice_210_CMP ;
  wire choice_211_CMP ;
  wire choice_212_CMP ;
  wire choice_213_CMP ;
  wire choice_214_CMP ;
  wire choice_215_CMP ;
  wire choice_217_CMP ;
  wire choice_218_CMP ;
  wire choice_219_CMP ;
  wire choice_220_CMP ;
  wire choice_221_CMP ;
  wire choice_222_CMP ;
  wire choice_223_CMP ;
  wire [7:0] choice_224_Y ;
  wire choice_227_CMP ;
  wire [7:0] choice_228_Y ;
  wire choice_230_CMP ;
  wire [7:0] choice_231_Y ;
  wire choice_233_CMP ;
  wire [7:0] choice_234_Y ;
  wire choice_236_CMP ;
  wire [7:0] choice_237_Y ;
  wire choice_239_CMP ;
  wire [7:0] choice_240_Y ;
  wire choice_242_CMP ;
  wire [7:0] choice_243_Y ;
  wire choice_246_CMP ;
  wire [7:0] choice_247_Y ;
  wire choice_249_CMP ;
  wire [7:0] choice_250_Y ;
  wire choice_252_CMP ;
  wire [7:0] choice_253_Y ;
  wire choice_255_CMP ;
  wire [7:0] choice_256_Y ;
  wire choice_258_CMP ;
  wire [7:0] choice_259_Y ;
  wire choice_261_CMP ;
  wire [7:0] choice_262_Y ;
  wire choice_265_CMP ;
  wire [7:0] choice_266_Y ;
  wire choice_268_CMP ;
  wire [7:0] choice_269_Y ;
  wire choice_271_CMP ;
  wire [7:0] choice_272_Y ;
  wire choice_274_CMP ;
  wire [7:0] choice_275_Y ;
  wire choice_277_CMP ;
  wire [7:0] choice_278_Y ;
  wire choice_280_CMP ;
  wire [7:0] choice_281_Y ;
  wire choice_284_CMP ;
  wire [7:0] choice_285_Y ;
  wire choice_287_CMP ;
  wire [7:0] choice_288_Y ;
  wire choice_290_CMP ;
  wire [7:0] choice_291_Y ;
  wire choice_293_CMP ;
  wire [7:0] choice_294_Y ;
  wire choice_296_CMP ;
  wire [7:0] choice_297_Y ;
  wire choice_299_CMP ;
  wire [7:0] choice_300_Y ;
  wire choice_303_CMP ;
  wire [7:0] choice_304_Y ;
  wire choice_306_CMP ;
  wire [7:0] choice_307_Y ;
  wire choice_309_CMP ;
  wire [7:0] choice_310_Y ;
  wire choice_312_CMP ;
  wire [7:0] choice_313_Y ;
  wire choice_315_CMP ;
  wire [7:0] choice_316_Y ;
  wire choice_318_CMP ;
  wire choice_319_CMP ;
  wire [7:0] choice_320_Y ;
  wire choice_323_CMP ;
  wire [7:0] choice_324_Y ;
  wire choice_326_CMP ;
  wire [7:0] choice_327_Y ;
  wire choice_329_CMP ;
  wire [7:0] choice_330_Y ;
  wire choice_332_CMP ;
  wire [7:0] choice_333_Y ;
  wire choice_335_CMP ;
  wire [7:0] choice_336_Y ;
  wire choice_338_CMP ;
  wire choice_339_CMP ;
  wire [7:0] choice_340_Y ;
  wire choice_343_CMP ;
  wire [7:0] choice_344_Y ;
  wire choice_346_CMP ;
  wire [7:0] choice_347_Y ;
  wire choice_349_CMP ;
  wire [7:0] choice_350_Y ;
  wire choice_352_CMP ;
  wire [7:0] choice_353_Y ;
  wire choice_355_CMP ;
  wire [7:0] choice_356_Y ;
  wire choice_358_CMP ;
  wire choice_359_CMP ;
  wire [7:0] choice_360_Y ;
  wire choice_363_CMP ;
  wire [7:0] choice_364_Y ;
  wire choice_366_CMP ;
  wire [7:0] choice_367_Y ;
  wire choice_369_CMP ;
  wire [7:0] choice_370_Y ;
  wire choice_372_CMP ;
  wire [7:0] choice_373_Y ;
  wire choice_375_CMP ;
  wire [7:0] choice_376_Y ;
  wire choice_378_CMP ;
  wire choice_379_CMP ;
  wire [2:0] choice_49_Y ;
  wire [2:0] choice_51_Y ;
  wire [2:0] choice_55_Y ;
  wire choice_59_Y ;
  wire [2:0] choice_63_Y ;
  wire [3:0] choice_67_Y ;
  wire choice_73_Y ;
  wire [7:0] choice_77_Y ;
  wire [7:0] choice_81_Y ;
  wire [7:0] choice_85_Y ;
  wire [7:0] choice_89_Y ;
  wire [7:0] choice_93_Y ;
  wire [7:0] choice_97_Y ;
  wire able_0;
  wire able_1;
  input aclk;
  wire aclk;
  wire [2:0] align;
  wire all_served;
  wire allowed;
  wire [3:0] base;
  wire complete;
  wire done;
  wire ends;
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
  wire final_sig;
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
  wire last_items;
  wire leads;
  reg led = 1'h0;
  wire left;
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
  wire [3:0] most_items;
  wire [7:0] next_lane_0;
  wire [7:0] next_lane_1;
  wire [7:0] next_lane_2;
  wire [7:0] next_lane_3;
  wire [7:0] next_lane_4;
  wire [7:0] next_lane_5;
  wire [7:0] next_lane_6;
  wire [7:0] next_lane_7;
  wire [2:0] next_step;
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
  wire [3:0] small_sig;
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
  assign go_0 = \$44  & able_0;
  assign reached_0 = served_0 | able_0;
  assign \$47  = ~ served_1;
  assign \$48  = writable & \$47 ;
  assign \$49  = \$48  & reached_0;
  assign go_1 = \$49  & able_1;
  assign \$50  = served_1 | able_1;
  assign reached_1 = reached_0 & \$50 ;
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
  assign choice_101_Y  = writable ? next_lane_1 : lane_1;
  assign \$76  = rst ? 8'h00 : choice_101_Y ;
  assign choice_105_Y  = writable ? next_lane_0 : lane_0;
  assign \$75  = rst ? 8'h00 : choice_105_Y ;
  assign choice_109_Y  = writable ? \error$80  : \error$81 ;
  assign choice_111_Y  = ends ? 3'h0 : choice_109_Y ;
  assign choice_113_Y  = complete ? choice_111_Y  : choice_109_Y ;
  assign \$74  = rst ? 3'h0 : choice_113_Y ;
  assign choice_117_Y  = writable ? 1'h0 : led;
  assign \$73  = rst ? 1'h0 : choice_117_Y ;
  assign choice_121_Y  = writable ? complete : full;
  assign \$72  = rst ? 1'h0 : choice_121_Y ;
  assign \$71  = rst ? 1'h0 : \$66 ;
  assign \$70  = rst ? 1'h0 : \$63 ;
  assign choice_129_Y  = status__ready ? 1'h0 : status__valid;
  assign choice_131_Y  = ends ? 1'h1 : choice_129_Y ;
  assign choice_133_Y  = complete ? choice_131_Y  : choice_129_Y ;
  assign \$69  = rst ? 1'h0 : choice_133_Y ;
  assign choice_145_Y  = done ? 1'h1 : 1'h0;
  assign ends = choice_148_CMP  ? choice_145_Y  : 1'h0;
  assign choice_148_CMP  = step == 3'h6;
  assign message__angular__z__ready = choice_150_CMP  ? go_0 : 1'h0;
  assign choice_150_CMP  = step == 3'h6;
  assign message__angular__y__ready = choice_152_CMP  ? go_0 : 1'h0;
  assign choice_152_CMP  = step == 3'h5;
  assign message__angular__x__ready = choice_154_CMP  ? go_0 : 1'h0;
  assign choice_154_CMP  = step == 3'h4;
  assign message__linear__z__ready = choice_156_CMP  ? go_0 : 1'h0;
  assign choice_156_CMP  = step == 3'h3;
  assign message__linear__y__ready = choice_158_CMP  ? go_0 : 1'h0;
  assign choice_158_CMP  = step == 3'h2;
  assign message__linear__x__ready = choice_160_CMP  ? go_0 : 1'h0;
  assign choice_160_CMP  = step == 3'h1;
  function [0:0] choice_161 ;
    input [0:0] a;
    input [4:0] b;
    input [4:0] s;
    (* parallel_case *)
    casez (s)
      5'b????1:
        choice_161  = b[0:0];
      5'b???1?:
        choice_161  = b[1:1];
      5'b??1??:
        choice_161  = b[2:2];
      5'b?1???:
        choice_161  = b[3:3];
      5'b1????:
        choice_161  = b[4:4];
      default:
        choice_161  = a;
    endcase
  endfunction
  assign able_1 = choice_161 (1'h1, { message__linear__y__valid, message__linear__z__valid, message__angular__x__valid, message__angular__y__valid, message__angular__z__valid }, { choice_166_CMP , choice_165_CMP , choice_164_CMP , choice_163_CMP , choice_162_CMP  });
  assign choice_162_CMP  = step == 3'h5;
  assign choice_163_CMP  = step == 3'h4;
  assign choice_164_CMP  = step == 3'h3;
  assign choice_165_CMP  = step == 3'h2;
  assign choice_166_CMP  = step == 3'h1;
  assign choice_181_Y  = done ? 3'h6 : 3'h0;
  function [2:0] choice_183 ;
    input [2:0] a;
    input [17:0] b;
    input [5:0] s;
    (* parallel_case *)
    casez (s)
      6'b?????1:
        choice_183  = b[2:0];
      6'b????1?:
        choice_183  = b[5:3];
      6'b???1??:
        choice_183  = b[8:6];
      6'b??1???:
        choice_183  = b[11:9];
      6'b?1????:
        choice_183  = b[14:12];
      6'b1?????:
        choice_183  = b[17:15];
      default:
        choice_183  = a;
    endcase
  endfunction
  assign next_step = choice_183 (3'h0, { choice_197_Y , choice_194_Y , choice_191_Y , choice_188_Y , choice_185_Y , choice_181_Y  }, { choice_199_CMP , choice_196_CMP , choice_193_CMP , choice_190_CMP , choice_187_CMP , choice_184_CMP  });
  assign choice_184_CMP  = step == 3'h5;
  assign choice_185_Y  = done ? 3'h5 : 3'h0;
  assign choice_187_CMP  = step == 3'h4;
  assign choice_188_Y  = done ? 3'h4 : 3'h0;
  assign choice_190_CMP  = step == 3'h3;
  assign choice_191_Y  = done ? 3'h3 : 3'h0;
  assign choice_193_CMP  = step == 3'h2;
  assign choice_194_Y  = done ? 3'h2 : 3'h0;
  assign choice_196_CMP  = step == 3'h1;
  assign choice_197_Y  = done ? 3'h1 : 3'h0;
  assign choice_199_CMP  = ! step;
  function [0:0] choice_200 ;
    input [0:0] a;
    input [6:0] b;
    input [6:0] s;
    (* parallel_case *)
    casez (s)
      7'b??????1:
        choice_200  = b[0:0];
      7'b?????1?:
        choice_200  = b[1:1];
      7'b????1??:
        choice_200  = b[2:2];
      7'b???1???:
        choice_200  = b[3:3];
      7'b??1????:
        choice_200  = b[4:4];
      7'b?1?????:
        choice_200  = b[5:5];
      7'b1??????:
        choice_200  = b[6:6];
      default:
        choice_200  = a;
    endcase
  endfunction
  assign done = choice_200 (1'h0, 7'h7f, { choice_207_CMP , choice_206_CMP , choice_205_CMP , choice_204_CMP , choice_203_CMP , choice_202_CMP , choice_201_CMP  });
  assign choice_201_CMP  = step == 3'h6;
  assign choice_202_CMP  = step == 3'h5;
  assign choice_203_CMP  = step == 3'h4;
  assign choice_204_CMP  = step == 3'h3;
  assign choice_205_CMP  = step == 3'h2;
  assign choice_206_CMP  = step == 3'h1;
  assign choice_207_CMP  = ! step;
  function [3:0] choice_208 ;
    input [3:0] a;
    input [27:0] b;
    input [6:0] s;
    (* parallel_case *)
    casez (s)
      7'b??????1:
        choice_208  = b[3:0];
      7'b?????1?:
        choice_208  = b[7:4];
      7'b????1??:
        choice_208  = b[11:8];
      7'b???1???:
        choice_208  = b[15:12];
      7'b??1????:
        choice_208  = b[19:16];
      7'b?1?????:
        choice_208  = b[23:20];
      7'b1??????:
        choice_208  = b[27:24];
      default:
        choice_208  = a;
    endcase
  endfunction
  assign base = choice_208 (4'h0, 28'h8888884, { choice_215_CMP , choice_214_CMP , choice_213_CMP , choice_212_CMP , choice_211_CMP , choice_210_CMP , choice_209_CMP  });
  assign choice_209_CMP  = step == 3'h6;
  assign choice_210_CMP  = step == 3'h5;
  assign choice_211_CMP  = step == 3'h4;
  assign choice_212_CMP  = step == 3'h3;
  assign choice_213_CMP  = step == 3'h2;
  assign choice_214_CMP  = step == 3'h1;
  assign choice_215_CMP  = ! step;
  function [0:0] choice_216 ;
    input [0:0] a;
    input [6:0] b;
    input [6:0] s;
    (* parallel_case *)
    casez (s)
      7'b??????1:
        choice_216  = b[0:0];
      7'b?????1?:
        choice_216  = b[1:1];
      7'b????1??:
        choice_216  = b[2:2];
      7'b???1???:
        choice_216  = b[3:3];
      7'b??1????:
        choice_216  = b[4:4];
      7'b?1?????:
        choice_216  = b[5:5];
      7'b1??????:
        choice_216  = b[6:6];
      default:
        choice_216  = a;
    endcase
  endfunction
  assign able_0 = choice_216 (1'h1, { message__linear__x__valid, message__linear__x__valid, message__linear__y__valid, message__linear__z__valid, message__angular__x__valid, message__angular__y__valid, message__angular__z__valid }, { choice_223_CMP , choice_222_CMP , choice_221_CMP , choice_220_CMP , choice_219_CMP , choice_218_CMP , choice_217_CMP  });
  assign choice_217_CMP  = step == 3'h6;
  assign choice_218_CMP  = step == 3'h5;
  assign choice_219_CMP  = step == 3'h4;
  assign choice_220_CMP  = step == 3'h3;
  assign choice_221_CMP  = step == 3'h2;
  assign choice_222_CMP  = step == 3'h1;
  assign choice_223_CMP  = ! step;
  assign choice_224_Y  = go_1 ? message__angular__z__payload[31:24] : \$8 ;
  function [7:0] choice_226 ;
    input [7:0] a;
    input [47:0] b;
    input [5:0] s;
    (* parallel_case *)
    casez (s)
      6'b?????1:
        choice_226  = b[7:0];
      6'b????1?:
        choice_226  = b[15:8];
      6'b???1??:
        choice_226  = b[23:16];
      6'b??1???:
        choice_226  = b[31:24];
      6'b?1????:
        choice_226  = b[39:32];
      6'b1?????:
        choice_226  = b[47:40];
      default:
        choice_226  = a;
    endcase
  endfunction
  assign next_lane_7 = choice_226 (\$8 , { choice_240_Y , choice_237_Y , choice_234_Y , choice_231_Y , choice_228_Y , choice_224_Y  }, { choice_242_CMP , choice_239_CMP , choice_236_CMP , choice_233_CMP , choice_230_CMP , choice_227_CMP  });
  assign choice_227_CMP  = step == 3'h5;
  assign choice_228_Y  = go_1 ? message__angular__y__payload[31:24] : \$8 ;
  assign choice_230_CMP  = step == 3'h4;
  assign choice_231_Y  = go_1 ? message__angular__x__payload[31:24] : \$8 ;
  assign choice_233_CMP  = step == 3'h3;
  assign choice_234_Y  = go_1 ? message__linear__z__payload[31:24] : \$8 ;
  assign choice_236_CMP  = step == 3'h2;
  assign choice_237_Y  = go_1 ? message__linear__y__payload[31:24] : \$8 ;
  assign choice_239_CMP  = step == 3'h1;
  assign choice_240_Y  = go_0 ? message__linear__x__payload[31:24] : \$8 ;
  assign choice_242_CMP  = ! step;
  assign choice_243_Y  = go_1 ? message__angular__z__payload[23:16] : \$7 ;
  function [7:0] choice_245 ;
    input [7:0] a;
    input [47:0] b;
    input [5:0] s;
    (* parallel_case *)
    casez (s)
      6'b?????1:
        choice_245  = b[7:0];
      6'b????1?:
        choice_245  = b[15:8];
      6'b???1??:
        choice_245  = b[23:16];
      6'b??1???:
        choice_245  = b[31:24];
      6'b?1????:
        choice_245  = b[39:32];
      6'b1?????:
        choice_245  = b[47:40];
      default:
        choice_245  = a;
    endcase
  endfunction
  assign next_lane_6 = choice_245 (\$7 , { choice_259_Y , choice_256_Y , choice_253_Y , choice_250_Y , choice_247_Y , choice_243_Y  }, { choice_261_CMP , choice_258_CMP , choice_255_CMP , choice_252_CMP , choice_249_CMP , choice_246_CMP  });
  assign choice_246_CMP  = step == 3'h5;
  assign choice_247_Y  = go_1 ? message__angular__y__payload[23:16] : \$7 ;
  assign choice_249_CMP  = step == 3'h4;
  assign choice_250_Y  = go_1 ? message__angular__x__payload[23:16] : \$7 ;
  assign choice_252_CMP  = step == 3'h3;
  assign choice_253_Y  = go_1 ? message__linear__z__payload[23:16] : \$7 ;
  assign choice_255_CMP  = step == 3'h2;
  assign choice_256_Y  = go_1 ? message__linear__y__payload[23:16] : \$7 ;
  assign choice_258_CMP  = step == 3'h1;
  assign choice_259_Y  = go_0 ? message__linear__x__payload[23:16] : \$7 ;
  assign choice_261_CMP  = ! step;
  assign choice_262_Y  = go_1 ? message__angular__z__payload[15:8] : \$6 ;
  function [7:0] choice_264 ;
    input [7:0] a;
    input [47:0] b;
    input [5:0] s;
    (* parallel_case *)
    casez (s)
      6'b?????1:
        choice_264  = b[7:0];
      6'b????1?:
        choice_264  = b[15:8];
      6'b???1??:
        choice_264  = b[23:16];
      6'b??1???:
        choice_264  = b[31:24];
      6'b?1????:
        choice_264  = b[39:32];
      6'b1?????:
        choice_264  = b[47:40];
      default:
        choice_264  = a;
    endcase
  endfunction
  assign next_lane_5 = choice_264 (\$6 , { choice_278_Y , choice_275_Y , choice_272_Y , choice_269_Y , choice_266_Y , choice_262_Y  }, { choice_280_CMP , choice_277_CMP , choice_274_CMP , choice_271_CMP , choice_268_CMP , choice_265_CMP  });
  assign choice_265_CMP  = step == 3'h5;
  assign choice_266_Y  = go_1 ? message__angular__y__payload[15:8] : \$6 ;
  assign choice_268_CMP  = step == 3'h4;
  assign choice_269_Y  = go_1 ? message__angular__x__payload[15:8] : \$6 ;
  assign choice_271_CMP  = step == 3'h3;
  assign choice_272_Y  = go_1 ? message__linear__z__payload[15:8] : \$6 ;
  assign choice_274_CMP  = step == 3'h2;
  assign choice_275_Y  = go_1 ? message__linear__y__payload[15:8] : \$6 ;
  assign choice_277_CMP  = step == 3'h1;
  assign choice_278_Y  = go_0 ? message__linear__x__payload[15:8] : \$6 ;
  assign choice_280_CMP  = ! step;
  assign choice_281_Y  = go_1 ? message__angular__z__payload[7:0] : \$5 ;
  function [7:0] choice_283 ;
    input [7:0] a;
    input [47:0] b;
    input [5:0] s;
    (* parallel_case *)
    casez (s)
      6'b?????1:
        choice_283  = b[7:0];
      6'b????1?:
        choice_283  = b[15:8];
      6'b???1??:
        choice_283  = b[23:16];
      6'b??1???:
        choice_283  = b[31:24];
      6'b?1????:
        choice_283  = b[39:32];
      6'b1?????:
        choice_283  = b[47:40];
      default:
        choice_283  = a;
    endcase
  endfunction
  assign next_lane_4 = choice_283 (\$5 , { choice_297_Y , choice_294_Y , choice_291_Y , choice_288_Y , choice_285_Y , choice_281_Y  }, { choice_299_CMP , choice_296_CMP , choice_293_CMP , choice_290_CMP , choice_287_CMP , choice_284_CMP  });
  assign choice_284_CMP  = step == 3'h5;
  assign choice_285_Y  = go_1 ? message__angular__y__payload[7:0] : \$5 ;
  assign choice_287_CMP  = step == 3'h4;
  assign choice_288_Y  = go_1 ? message__angular__x__payload[7:0] : \$5 ;
  assign choice_290_CMP  = step == 3'h3;
  assign choice_291_Y  = go_1 ? message__linear__z__payload[7:0] : \$5 ;
  assign choice_293_CMP  = step == 3'h2;
  assign choice_294_Y  = go_1 ? message__linear__y__payload[7:0] : \$5 ;
  assign choice_296_CMP  = step == 3'h1;
  assign choice_297_Y  = go_0 ? message__linear__x__payload[7:0] : \$5 ;
  assign choice_299_CMP  = ! step;
  assign choice_300_Y  = go_0 ? message__angular__z__payload[63:56] : \$4 ;
  function [7:0] choice_302 ;
    input [7:0] a;
    input [55:0] b;
    input [6:0] s;
    (* parallel_case *)
    casez (s)
      7'b??????1:
        choice_302  = b[7:0];
      7'b?????1?:
        choice_302  = b[15:8];
      7'b????1??:
        choice_302  = b[23:16];
      7'b???1???:
        choice_302  = b[31:24];
      7'b??1????:
        choice_302  = b[39:32];
      7'b?1?????:
        choice_302  = b[47:40];
      7'b1??????:
        choice_302  = b[55:48];
      default:
        choice_302  = a;
    endcase
  endfunction
  assign next_lane_3 = choice_302 (\$4 , { 8'h00, choice_316_Y , choice_313_Y , choice_310_Y , choice_307_Y , choice_304_Y , choice_300_Y  }, { choice_319_CMP , choice_318_CMP , choice_315_CMP , choice_312_CMP , choice_309_CMP , choice_306_CMP , choice_303_CMP  });
  assign choice_303_CMP  = step == 3'h6;
  assign choice_304_Y  = go_0 ? message__angular__y__payload[63:56] : \$4 ;
  assign choice_306_CMP  = step == 3'h5;
  assign choice_307_Y  = go_0 ? message__angular__x__payload[63:56] : \$4 ;
  assign choice_309_CMP  = step == 3'h4;
  assign choice_310_Y  = go_0 ? message__linear__z__payload[63:56] : \$4 ;
  assign choice_312_CMP  = step == 3'h3;
  assign choice_313_Y  = go_0 ? message__linear__y__payload[63:56] : \$4 ;
  assign choice_315_CMP  = step == 3'h2;
  assign choice_316_Y  = go_0 ? message__linear__x__payload[63:56] : \$4 ;
  assign choice_318_CMP  = step == 3'h1;
  assign choice_319_CMP  = ! step;
  assign choice_320_Y  = go_0 ? message__angular__z__payload[55:48] : \$3 ;
  function [7:0] choice_322 ;
    input [7:0] a;
    input [55:0] b;
    input [6:0] s;
    (* parallel_case *)
    casez (s)
      7'b??????1:
        choice_322  = b[7:0];
      7'b?????1?:
        choice_322  = b[15:8];
      7'b????1??:
        choice_322  = b[23:16];
      7'b???1???:
        choice_322  = b[31:24];
      7'b??1????:
        choice_322  = b[39:32];
      7'b?1?????:
        choice_322  = b[47:40];
      7'b1??????:
        choice_322  = b[55:48];
      default:
        choice_322  = a;
    endcase
  endfunction
  assign next_lane_2 = choice_322 (\$3 , { 8'h00, choice_336_Y , choice_333_Y , choice_330_Y , choice_327_Y , choice_324_Y , choice_320_Y  }, { choice_339_CMP , choice_338_CMP , choice_335_CMP , choice_332_CMP , choice_329_CMP , choice_326_CMP , choice_323_CMP  });
  assign choice_323_CMP  = step == 3'h6;
  assign choice_324_Y  = go_0 ? message__angular__y__payload[55:48] : \$3 ;
  assign choice_326_CMP  = step == 3'h5;
  assign choice_327_Y  = go_0 ? message__angular__x__payload[55:48] : \$3 ;
  assign choice_329_CMP  = step == 3'h4;
  assign choice_330_Y  = go_0 ? message__linear__z__payload[55:48] : \$3 ;
  assign choice_332_CMP  = step == 3'h3;
  assign choice_333_Y  = go_0 ? message__linear__y__payload[55:48] : \$3 ;
  assign choice_335_CMP  = step == 3'h2;
  assign choice_336_Y  = go_0 ? message__linear__x__payload[55:48] : \$3 ;
  assign choice_338_CMP  = step == 3'h1;
  assign choice_339_CMP  = ! step;
  assign choice_340_Y  = go_0 ? message__angular__z__payload[47:40] : \$2 ;
  function [7:0] choice_342 ;
    input [7:0] a;
    input [55:0] b;
    input [6:0] s;
    (* parallel_case *)
    casez (s)
      7'b??????1:
        choice_342  = b[7:0];
      7'b?????1?:
        choice_342  = b[15:8];
      7'b????1??:
        choice_342  = b[23:16];
      7'b???1???:
        choice_342  = b[31:24];
      7'b??1????:
        choice_342  = b[39:32];
      7'b?1?????:
        choice_342  = b[47:40];
      7'b1??????:
        choice_342  = b[55:48];
      default:
        choice_342  = a;
    endcase
  endfunction
  assign next_lane_1 = choice_342 (\$2 , { 8'h01, choice_356_Y , choice_353_Y , choice_350_Y , choice_347_Y , choice_344_Y , choice_340_Y  }, { choice_359_CMP , choice_358_CMP , choice_355_CMP , choice_352_CMP , choice_349_CMP , choice_346_CMP , choice_343_CMP  });
  assign choice_343_CMP  = step == 3'h6;
  assign choice_344_Y  = go_0 ? message__angular__y__payload[47:40] : \$2 ;
  assign choice_346_CMP  = step == 3'h5;
  assign choice_347_Y  = go_0 ? message__angular__x__payload[47:40] : \$2 ;
  assign choice_349_CMP  = step == 3'h4;
  assign choice_350_Y  = go_0 ? message__linear__z__payload[47:40] : \$2 ;
  assign choice_352_CMP  = step == 3'h3;
  assign choice_353_Y  = go_0 ? message__linear__y__payload[47:40] : \$2 ;
  assign choice_355_CMP  = step == 3'h2;
  assign choice_356_Y  = go_0 ? message__linear__x__payload[47:40] : \$2 ;
  assign choice_358_CMP  = step == 3'h1;
  assign choice_359_CMP  = ! step;
  assign choice_360_Y  = go_0 ? message__angular__z__payload[39:32] : \$1 ;
  function [7:0] choice_362 ;
    input [7:0] a;
    input [55:0] b;
    input [6:0] s;
    (* parallel_case *)
    casez (s)
      7'b??????1:
        choice_362  = b[7:0];
      7'b?????1?:
        choice_362  = b[15:8];
      7'b????1??:
        choice_362  = b[23:16];
      7'b???1???:
        choice_362  = b[31:24];
      7'b??1????:
        choice_362  = b[39:32];
      7'b?1?????:
        choice_362  = b[47:40];
      7'b1??????:
        choice_362  = b[55:48];
      default:
        choice_362  = a;
    endcase
  endfunction
  assign next_lane_0 = choice_362 (\$1 , { 8'h00, choice_376_Y , choice_373_Y , choice_370_Y , choice_367_Y , choice_364_Y , choice_360_Y  }, { choice_379_CMP , choice_378_CMP , choice_375_CMP , choice_372_CMP , choice_369_CMP , choice_366_CMP , choice_363_CMP  });
  assign choice_363_CMP  = step == 3'h6;
  assign choice_364_Y  = go_0 ? message__angular__y__payload[39:32] : \$1 ;
  assign choice_366_CMP  = step == 3'h5;
  assign choice_367_Y  = go_0 ? message__angular__x__payload[39:32] : \$1 ;
  assign choice_369_CMP  = step == 3'h4;
  assign choice_370_Y  = go_0 ? message__linear__z__payload[39:32] : \$1 ;
  assign choice_372_CMP  = step == 3'h3;
  assign choice_373_Y  = go_0 ? message__linear__y__payload[39:32] : \$1 ;
  assign choice_375_CMP  = step == 3'h2;
  assign choice_376_Y  = go_0 ? message__linear__x__payload[39:32] : \$1 ;
  assign choice_378_CMP  = step == 3'h1;
  assign choice_379_CMP  = ! step;
  assign choice_49_Y  = ends ? \error$80  : status__payload;
  assign choice_51_Y  = complete ? choice_49_Y  : status__payload;
  assign \$85  = rst ? 3'h0 : choice_51_Y ;
  assign choice_55_Y  = complete ? next_step : step;
  assign \$84  = rst ? 3'h0 : choice_55_Y ;
  assign choice_59_Y  = complete ? \$68  : word[72];
  assign \$83 [72] = rst ? 1'h0 : choice_59_Y ;
  assign choice_63_Y  = complete ? 3'h0 : word[70:68];
  assign \$83 [70:68] = rst ? 3'h0 : choice_63_Y ;
  assign choice_67_Y  = complete ? \$67 [3:0] : word[67:64];
  assign \$83 [67:64] = rst ? 4'h0 : choice_67_Y ;
  assign \$83 [63:0] = rst ? 64'h0000000000000000 : word[63:0];
  assign choice_73_Y  = complete ? ends : word[71];
  assign \$83 [71] = rst ? 1'h0 : choice_73_Y ;
  assign choice_77_Y  = writable ? next_lane_7 : lane_7;
  assign \$82  = rst ? 8'h00 : choice_77_Y ;
  assign choice_81_Y  = writable ? next_lane_6 : lane_6;
  assign \$81  = rst ? 8'h00 : choice_81_Y ;
  assign choice_85_Y  = writable ? next_lane_5 : lane_5;
  assign \$80  = rst ? 8'h00 : choice_85_Y ;
  assign choice_89_Y  = writable ? next_lane_4 : lane_4;
  assign \$79  = rst ? 8'h00 : choice_89_Y ;
  assign choice_93_Y  = writable ? next_lane_3 : lane_3;
  assign \$78  = rst ? 8'h00 : choice_93_Y ;
  assign choice_97_Y  = writable ? next_lane_2 : lane_2;
  assign \$77  = rst ? 8'h00 : choice_97_Y ;
  \geometry_msgs_msg_Twist_cdr_8_serializer_verilog.core.packer  packer (
    .aclk(aclk),
    .error(packet_error),
    .packets__payload(packets__payload),
    .packets__ready(packets__ready),
    .packets__valid(packets__valid),
    .rst(rst),
    .word__payload({ word[72:64], lane_7, lane_6, lane_5, lane_4, lane_3, lane_2, lane_1, lane_0 }),
    .word__ready(word__ready),
    .word__valid(word__valid)
  );
  assign \word.error  = word[72];
  assign \word.last  = word[71];
  assign \word.align  = word[70:68];
  assign \word.count  = word[67:64];
  assign \word.data[7]  = word[63:56];
  assign \word.data[6]  = word[55:48];
  assign \word.data[5]  = word[47:40];
  assign \word.data[4]  = word[39:32];
  assign \word.data[3]  = word[31:24];
  assign \word.data[2]  = word[23:16];
  assign \word.data[1]  = word[15:8];
  assign \word.data[0]  = word[7:0];
  assign \word.data  = word[63:0];
  assign \word__payload.error  = word[72];
  assign \word__payload.last  = word[71];
  assign \word__payload.align  = word[70:68];
  assign \word__payload.count  = word[67:64];
  assign \word__payload.data[7]  = lane_7;
  assign \word__payload.data[6]  = lane_6;
  assign \word__payload.data[5]  = lane_5;
  assign \word__payload.data[4]  = lane_4;
  assign \word__payload.data[3]  = lane_3;
  assign \word__payload.data[2]  = lane_2;
  assign \word__payload.data[1]  = lane_1;
  assign \word__payload.data[0]  = lane_0;
  assign \word__payload.data  = { lane_7, lane_6, lane_5, lane_4, lane_3, lane_2, lane_1, lane_0 };
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
  assign leads = 1'h0;
  assign raised = 3'h0;
  assign word__payload = { word[72:64], lane_7, lane_6, lane_5, lane_4, lane_3, lane_2, lane_1, lane_0 };
  assign all_served = reached_1;
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
  assign error = packet_error;
  assign \packets__ready$5  = packets__ready;
  assign \packets__valid$3  = packets__valid;
  assign \packets__payload$1  = packets__payload;
endmodule

module \geometry_msgs_msg_Twist_cdr_8_serializer_verilog.core.packer (packets__ready, rst, word__valid, packets__valid, error, word__ready, word__payload, packets__payload, aclk);
  wire \$1 ;
  wire \$10 ;
  wire \$11 ;
  (* unused_bits = "3 4" *)
  wire [4:0] \$12 ;
  wire [3:0] \$13 ;
  (* unused_bits = "3" *)
  wire [3:0] \$14 ;
  wire \$15 ;
  (* unused_bits = "5" *)
  wire [5:0] \$16 ;
  (* unused_bits = "0 1 2" *)
  wire [5:0] \$17 ;
  wire \$19 ;
  wire \$2 ;
  wire \$20 ;
  wire \$21 ;
  (* unused_bits = "5 6" *)
  wire [6:0] \$22 ;
  (* unused_bits = "2" *)
  wire [2:0] \$23 ;
  wire \$24 ;
  wire [63:0] \$25 ;
  wire [5:0] \$26 ;
  (* unused_bits = "5 6" *)
  wire [6:0] \$27 ;
  wire \$28 ;
  wire \$29 ;
  wire \$30 ;
  wire \$31 ;
  wire \$33 ;
  wire \$34 ;
  wire \$35 ;
  (* unused_bits = "3 4 5" *)
  wire [5:0] \$36 ;
  wire [3:0] \$37 ;
  wire [3:0] \$38 ;
  wire [63:0] \$39 ;
  wire [5:0] \$4 ;
  wire [4:0] \$40 ;
  wire \$41 ;
  wire [1:0] \$42 ;
  wire \$43 ;
  wire [3:0] \$44 ;
  wire \$45 ;
  (* unused_bits = "5" *)
  wire [5:0] \$5 ;
  wire \$7 ;
  wire \$8 ;
  wire \$9 ;
  wire choice_13_Y ;
  wire [1:0] choice_17_Y ;
  wire [1:0] choice_19_Y ;
  wire choice_1_Y ;
  wire [1:0] choice_21_Y ;
  wire choice_25_Y ;
  wire choice_27_Y ;
  wire [4:0] choice_31_Y ;
  wire [4:0] choice_33_Y ;
  wire [63:0] choice_37_Y ;
  wire choice_3_Y ;
  wire [4:0] choice_41_Y ;
  wire [4:0] choice_45_Y ;
  wire [3:0] choice_7_Y ;
  wire [3:0] choice_9_Y ;
  wire [4:0] \$like ;
  input aclk;
  wire aclk;
  (* unused_bits = "2 3 4" *)
  wire [4:0] beats;
  reg [1:0] end_beats = 2'h0;
  reg [3:0] end_count = 4'h0;
  reg ending = 1'h0;
  output error;
  wire error;
  reg inside_sig = 1'h0;
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
    inside_sig <= \$43 ;
  always @(posedge aclk)
    end_count <= \$44 ;
  always @(posedge aclk)
    marked <= \$45 ;
  assign \$1  = level >= 4'h8;
  assign packets__valid = ending | \$1 ;
  assign \$2  = end_beats == 1'h1;
  assign is_last = ending & \$2 ;
  assign \packets__payload.count  = is_last ? end_count : 4'h8;
  assign error = is_last & marked;
  assign leaves = packets__valid & packets__ready;
  assign \$4  = level - 4'h8;
  assign { \$5 [5], rest } = leaves ? \$4  : { 1'h0, level };
  assign kept = leaves ? 64'h0000000000000000 : store;
  assign \$7  = leaves & is_last;
  assign \$8  = ~ \$7 ;
  assign still_ending = ending & \$8 ;
  assign \$9  = rest <= 1'h0;
  assign \$10  = still_ending & word__payload[71];
  assign \$11  = ~ \$10 ;
  assign word__ready = \$9  & \$11 ;
  assign \$12  = 1'h0 + word__payload[67:64];
  assign \$13  = - \$12 [2:0];
  assign { \$14 [3], pad } = \$13  & { 1'h0, word__payload[70:68] };
  assign \$15  = word__valid & word__ready;
  assign \$16  = rest + word__payload[67:64];
  assign \$17  = \$like  + 3'h7;
  assign \$19  = ~ inside_sig;
  assign \$20  = ! word__payload[67:64];
  assign \$21  = \$19  & \$20 ;
  assign \$22  = { 3'h0, \$17 [5:3] } + \$21 ;
  assign \$23  = end_beats - 1'h1;
  assign \$24  = word__valid & word__ready;
  assign \$25  = kept | word__payload[63:0];
  assign \$26  = rest + word__payload[67:64];
  assign \$27  = \$26  + pad;
  assign \$28  = ~ word__payload[71];
  assign \$29  = | word__payload[67:64];
  assign \$30  = inside_sig | \$29 ;
  assign \$31  = \$28  & \$30 ;
  assign \$33  = ~ inside_sig;
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
  assign choice_1_Y  = word__payload[71] ? word__payload[72] : marked;
  assign \$44  = rst ? 4'h0 : choice_9_Y ;
  assign choice_13_Y  = \$24  ? \$31  : inside_sig;
  assign \$43  = rst ? 1'h0 : choice_13_Y ;
  assign choice_17_Y  = leaves ? \$23 [1:0] : end_beats;
  assign choice_19_Y  = word__payload[71] ? beats[1:0] : choice_17_Y ;
  assign choice_21_Y  = \$24  ? choice_19_Y  : choice_17_Y ;
  assign \$42  = rst ? 2'h0 : choice_21_Y ;
  assign choice_25_Y  = word__payload[71] ? 1'h1 : still_ending;
  assign choice_27_Y  = \$24  ? choice_25_Y  : still_ending;
  assign \$41  = rst ? 1'h0 : choice_27_Y ;
  assign choice_3_Y  = \$24  ? choice_1_Y  : marked;
  assign choice_31_Y  = word__payload[71] ? { beats[1:0], 3'h0 } : \$27 [4:0];
  assign choice_33_Y  = \$24  ? choice_31_Y  : rest;
  assign \$40  = rst ? 5'h00 : choice_33_Y ;
  assign choice_37_Y  = \$24  ? \$25  : kept;
  assign \$39  = rst ? 64'h0000000000000000 : choice_37_Y ;
  assign choice_41_Y  = word__payload[71] ? \$22 [4:0] : 5'h00;
  assign beats = \$15  ? choice_41_Y  : 5'h00;
  assign choice_45_Y  = word__payload[71] ? \$16 [4:0] : 5'h00;
  assign \$like  = \$15  ? choice_45_Y  : 5'h00;
  assign \$45  = rst ? 1'h0 : choice_3_Y ;
  assign choice_7_Y  = word__payload[71] ? \$38  : end_count;
  assign choice_9_Y  = \$24  ? choice_7_Y  : end_count;
  assign \word__payload.error  = word__payload[72];
  assign \word__payload.last  = word__payload[71];
  assign \word__payload.align  = word__payload[70:68];
  assign \word__payload.count  = word__payload[67:64];
  assign \word__payload.data[7]  = word__payload[63:56];
  assign \word__payload.data[6]  = word__payload[55:48];
  assign \word__payload.data[5]  = word__payload[47:40];
  assign \word__payload.data[4]  = word__payload[39:32];
  assign \word__payload.data[3]  = word__payload[31:24];
  assign \word__payload.data[2]  = word__payload[23:16];
  assign \word__payload.data[1]  = word__payload[15:8];
  assign \word__payload.data[0]  = word__payload[7:0];
  assign \word__payload.data  = word__payload[63:0];
  assign \packets__payload.last  = is_last;
  assign \packets__payload.data[7]  = store[63:56];
  assign \packets__payload.data[6]  = store[55:48];
  assign \packets__payload.data[5]  = store[47:40];
  assign \packets__payload.data[4]  = store[39:32];
  assign \packets__payload.data[3]  = store[31:24];
  assign \packets__payload.data[2]  = store[23:16];
  assign \packets__payload.data[1]  = store[15:8];
  assign \packets__payload.data[0]  = store[7:0];
  assign \packets__payload.data  = store;
  assign \$14 [2:0] = pad;
  assign \$5 [4:0] = rest;
  assign packets__payload = { is_last, \packets__payload.count , store };
  assign position = 3'h0;
endmodule
