// geometry_msgs_msg_Twist_cdr_8_deserializer_verilog: the deserializer of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
// lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
// definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
// What each port means: manifest.json.
module geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_buffer (
  input wire         rst,
  input wire         aclk,
  input wire         packets_valid,
  input wire         arrival_next,
  input wire [3:0]   freed,
  input wire [68:0]  packets_payload,
  output wire [73:0] arrival_beat,
  output wire        packets_ready,
  output wire [6:0]  arrival_limit,
  output wire [3:0]  arrival_following,
  output wire        arrival_ended
);

  // Registers.
  reg packets_ready_q = 1'b1;
  reg [6:0] arrival_limit_q = 7'd0;
  reg [3:0] arrival_following_q = 4'd0;
  reg arrival_ended_q = 1'b0;
  reg full = 1'b0;
  reg [68:0] payload = 69'd0;
  reg [3:0] arrived = 4'd0;
  reg [3:0] at = 4'd0;
  reg [10:0] second = 11'd0;
  reg has_second = 1'b0;
  reg [3:0] pushed = 4'd0;
  reg [3:0] popped = 4'd0;

  // Combinational signals.
  wire arrives;
  wire [3:0] used;
  wire [3:0] next_beat;
  wire ends_now;
  wire [6:0] add_3;
  wire [6:0] newest_0;
  wire stored;
  wire more;
  wire follows;
  wire or_14;
  wire [10:0] arrival_limit_next;
  wire has_second_next;
  wire [10:0] ends_read_data;

  // Signals that no logic reads, for simulation.
  wire room;
  wire [2:0] ends_write_addr;
  wire [10:0] ends_write_data;
  wire ends_write_en;
  wire [2:0] ends_read_addr;
  wire [10:0] end_sig;
  wire [10:0] newest;

  reg [10:0] ends [0:7];
  integer ends_at;
  initial begin
    for (ends_at = 0; ends_at < 8; ends_at = ends_at + 1)
      ends[ends_at] = 11'd0;
  end

  assign arrives = packets_valid & packets_ready_q;
  assign used = arrived - freed;
  assign next_beat = at + 4'd1;
  assign ends_now = full & payload[68];
  assign add_3 = {at, 3'd0} + {3'd0, payload[67:64]};
  assign newest_0 = ends_now ? add_3 : {full ? next_beat : at, 3'd0};
  assign stored = pushed != popped;
  assign more = stored | ends_now;
  assign follows = arrival_ended_q & ends_now;
  assign or_14 = arrival_next | ~arrival_ended_q;
  assign arrival_limit_next = has_second ? second : {next_beat, newest_0};
  assign has_second_next = has_second ? (~arrival_next | more) : (~arrival_next & follows);

  always @(posedge aclk) begin
    ends[pushed[2:0]] <= {next_beat, add_3};
  end
  assign ends_read_data = ends[popped[2:0]];

  always @(posedge aclk) begin
    if (rst) begin
      full <= 1'b0;
      arrived <= 4'd0;
      at <= 4'd0;
      packets_ready_q <= 1'b1;
      arrival_limit_q <= 7'd0;
      arrival_following_q <= 4'd0;
      arrival_ended_q <= 1'b0;
      second <= 11'd0;
      has_second <= 1'b0;
      pushed <= 4'd0;
      popped <= 4'd0;
    end else begin
      full <= arrives;
      arrived <= arrived + {3'd0, arrives};
      at <= at + {3'd0, full};
      packets_ready_q <= ~used[3] & ~((used == 4'd7) & arrives);
      if (or_14) begin
        arrival_limit_q <= arrival_limit_next[6:0];
        arrival_following_q <= arrival_limit_next[10:7];
        arrival_ended_q <= has_second | ends_now;
      end
      if (arrival_next || !has_second) begin
        if (stored) begin
          second <= ends_read_data;
        end else begin
          second <= {next_beat, add_3};
        end
      end
      has_second <= has_second_next;
      if (has_second && ends_now) begin
        pushed <= pushed + 4'd1;
      end
      if (arrival_next && has_second && more) begin
        popped <= popped + 4'd1;
      end
    end
  end

  always @(posedge aclk) begin
    payload <= packets_payload;
  end

  assign arrival_beat = {full, at, payload};

  assign packets_ready = packets_ready_q;
  assign arrival_limit = arrival_limit_q;
  assign arrival_following = arrival_following_q;
  assign arrival_ended = arrival_ended_q;

  assign room = packets_ready_q;
  assign ends_write_addr = pushed[2:0];
  assign ends_write_data = {next_beat, add_3};
  assign ends_write_en = 1'b1;
  assign ends_read_addr = popped[2:0];
  assign end_sig = {next_beat, add_3};
  assign newest = {next_beat, newest_0};
endmodule

module geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_sequencer_byte_flags (
  input wire        rst,
  input wire        aclk,
  output wire       mismatch,
  input wire [73:0] beat,
  input wire [3:0]  header_at
);

  // Combinational signals.
  wire headers_write_data;

  // Signals that no logic reads, for simulation.
  wire [2:0] headers_write_addr;
  wire headers_write_en;
  wire [2:0] headers_read_addr;
  wire headers_read_data;

  reg [0:0] headers [0:7];
  integer headers_at;
  initial begin
    for (headers_at = 0; headers_at < 8; headers_at = headers_at + 1)
      headers[headers_at] = 1'b0;
  end

  assign headers_write_data = |{(beat[15:8] != 8'd1) & (~beat[68] | (beat[67:64] > 4'd1)),
      (beat[7:0] != 8'd0) & (~beat[68] | (beat[67:64] > 4'd0))};

  always @(posedge aclk) begin
    if (beat[73]) begin
      headers[beat[71:69]] <= headers_write_data;
    end
  end
  assign mismatch = headers[header_at[2:0]];

  assign headers_write_addr = beat[71:69];
  assign headers_write_en = beat[73];
  assign headers_read_addr = header_at[2:0];
  assign headers_read_data = mismatch;
endmodule

module geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_sequencer (
  input wire         rst,
  input wire         aclk,
  output wire        orders_valid,
  output wire        arrival_next,
  input wire         orders_ready,
  input wire [73:0]  beat,
  input wire [6:0]   arrival_limit,
  input wire [3:0]   arrival_following,
  input wire         arrival_ended,
  output wire [41:0] orders_payload,
  output wire [3:0]  header_at
);

  // Registers.
  reg bad = 1'b0;
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  reg [2:0] code = 3'd0;
  reg new_error = 1'b0;
  reg [3:0] items_room = 4'd0;
  reg [3:0] map_room = 4'd0;
  reg rest = 1'b0;
  reg has_nul = 1'b0;
  reg [6:0] first_at = 7'd0;
  reg [6:0] last_at = 7'd7;
  reg words_last = 1'b1;
  reg words_less = 1'b0;
  reg [6:0] step = 7'd1;
  reg at_end = 1'b0;
  reg [4:0] map_offset = 5'd25;
  reg two_word_map = 1'b0;
  reg [5:0] exit_add = 6'd8;

  // Combinational signals.
  wire mismatch_31;
  wire [6:0] step_end;
  wire [6:0] left;
  wire present;
  wire ends_message;
  wire ends_packet;
  wire mismatch;
  wire cut;
  wire trailing;
  wire stops;
  wire drains;
  wire allowed;
  wire issue;
  wire [6:0] map_at;
  wire [3:0] sub_77;
  wire [5:0] sub_88;
  wire [5:0] or_132;
  wire [6:0] map_left;
  wire [6:0] exit_sum;
  wire [6:0] early_last;
  wire step_to_exit;
  wire and_187;
  wire and_201;
  wire and_203;
  wire [3:0] items_room_next;
  wire [6:0] first_at_next;

  // Signals that no logic reads, for simulation.
  wire default_0;
  wire default_1;
  wire default_2;
  wire default_3;
  wire default_4;
  wire default_5;
  wire [73:0] arrival_beat;
  wire [6:0] nul_at;
  wire [6:0] nul_at_23;
  wire nonzero;
  wire [6:0] nul_within;
  wire [3:0] oldest;
  wire [6:0] items_at;
  wire [6:0] next_packet;
  wire [5:0] over_rest;
  wire [6:0] to_exit_low;
  wire [6:0] body_sum;
  wire [6:0] to_body_low;
  wire words_loads;
  wire exits_always;
  wire done;
  wire wrong_nul;
  wire [3:0] items_wanted;
  wire [5:0] exit_amount;
  wire [2:0] to_exit_mask;
  wire [5:0] body_amount;
  wire [2:0] to_body_mask;
  wire [6:0] next_last;
  wire step_to_body;
  wire words_down;
  wire words_keeps;
  wire words_pending;
  wire [2:0] words_value;

  geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_sequencer_byte_flags byte_flags (
    .aclk      (aclk),
    .rst       (rst),
    .mismatch  (mismatch_31),
    .beat      (beat),
    .header_at (first_at[6:3])
  );

  assign step_end = last_at + 7'd1;
  assign left = arrival_limit + ~last_at;
  assign present = ~left[6];
  assign ends_message = at_end | step[5];
  assign ends_packet = ends_message & arrival_ended;
  assign mismatch = step[0] & mismatch_31 & (arrival_limit != first_at);
  assign cut = arrival_ended & ~present;
  assign trailing = present & (|left[5:2]);
  assign stops = mismatch | cut | (ends_message & ~arrival_ended & trailing);
  assign drains = bad & ~new_error & (~at_end | arrival_ended);
  assign allowed = ~bad & (~ends_message | arrival_ended);
  assign orders_valid = drains | (allowed & present & ~(step[0] & mismatch_31));
  assign issue = (drains & orders_ready) | (allowed & orders_ready & present & ~(step[0] &
      mismatch_31));
  assign arrival_next = (drains & orders_ready & ends_packet) | (allowed & orders_ready &
      ends_packet & present & ~(step[0] & mismatch_31));
  assign map_at = last_at + {{2{map_offset[4]}}, map_offset};
  assign sub_77 = map_at[6:3] - {3'd0, two_word_map};
  assign sub_88 = 6'd1 - {{1{map_offset[4]}}, map_offset};
  assign or_132 = (arrival_limit[5:0] & ~last_at[5:0]) | (arrival_limit[5:0] &
      (6'd1 - {{1{map_offset[4]}}, map_offset})) | (~last_at[5:0] & (6'd1 - {{1{map_offset[4]}},
      map_offset}));
  assign map_left = (arrival_limit ^ ~last_at ^ {sub_88[5], 6'd1 - {{1{map_offset[4]}},
      map_offset}}) + {or_132, 1'b0};
  assign exit_sum = last_at + {1'd0, exit_add};
  assign early_last = ends_packet ? ({arrival_following, 3'd0} + 7'd7) : exit_sum;
  assign step_to_exit = issue & ~ends_packet;
  assign and_187 = issue & ends_packet;
  assign and_201 = bad & new_error;
  assign and_203 = bad & drains & orders_ready;
  assign items_room_next = two_word_map ? (map_left[6] ? {1'b0, (&map_left[6:3]) ? map_left[2:0] :
      3'd0} : 4'd8) : (map_left[6] ? 4'd0 : ((map_left >= 7'd8) ? 4'd8 : map_left[3:0]));
  assign first_at_next = ends_packet ? {arrival_following, 3'd0} : (bad ? (at_end ? arrival_limit :
      first_at) : step_end);

  always @(posedge aclk) begin
    if (rst) begin
      bad <= 1'b0;
      code <= 3'd0;
      new_error <= 1'b0;
      items_room <= 4'd0;
      map_room <= 4'd0;
      rest <= 1'b0;
      has_nul <= 1'b0;
      first_at <= 7'd0;
      last_at <= 7'd7;
      words_last <= 1'b1;
      words_less <= 1'b0;
      step <= 7'd1;
      at_end <= 1'b0;
      map_offset <= 5'd25;
      two_word_map <= 1'b0;
      exit_add <= 6'd8;
    end else begin
      if (and_187) begin
        bad <= 1'b0;
      end else if (!bad) begin
        bad <= stops;
        if (ends_message) begin
          code <= 3'd2;
        end else begin
          code <= 3'd3;
        end
        if (mismatch) begin
          code <= 3'd4;
        end else if (cut) begin
          code <= 3'd1;
        end
      end
      new_error <= stops & ~bad;
      if (and_201) begin
        if ((code == 3'd2) || (code == 3'd5)) begin
          items_room <= 4'd8;
        end else begin
          items_room <= 4'd0;
        end
        if (code == 3'd1) begin
          items_room <= items_room_next;
        end
        if (code == 3'd2) begin
          map_room <= 4'd8;
        end else begin
          map_room <= 4'd0;
        end
        if (code == 3'd1) begin
          if (map_left[6]) begin
            map_room <= 4'd0;
          end else begin
            if (map_left >= 7'd8) begin
              map_room <= 4'd8;
            end else begin
              map_room <= map_left[3:0];
            end
          end
        end
      end else if (and_203) begin
        items_room <= 4'd0;
        map_room <= 4'd0;
      end
      if (issue) begin
        if (ends_packet) begin
          rest <= 1'b0;
          has_nul <= 1'b0;
        end
        last_at <= early_last;
        if (ends_packet) begin
          step <= 7'd1;
          at_end <= 1'b0;
          map_offset <= 5'd25;
          two_word_map <= 1'b0;
          exit_add <= 6'd8;
        end else begin
          step <= {step[5:0], 1'b0};
          at_end <= step[5];
          map_offset <= {|step[4:0], |step[4:0], step[4], 1'b0, |step[5:0]};
          two_word_map <= step[4];
          exit_add <= {2'd0, |step[3:0], step[3], 2'd0};
        end
      end
      if (issue || (bad && at_end)) begin
        first_at <= first_at_next;
      end
      words_last <= words_last;
      words_less <= words_less;
    end
  end

  assign header_at = first_at[6:3];
  assign orders_payload = {bad ? code : (trailing ? 3'd2 : 3'd0), ends_packet, first_at[6:3], 1'b0,
      ~bad, words_last, 1'b0, bad ? map_room : 4'd8, (bad && (items_room < 4'd8)) ? items_room :
      4'd8, map_at[5:3] + 3'd1, sub_77[2:0] + 3'd1, map_at[5:0], sub_77[2:0], map_at[2:0], at_end,
      |step[5:4], |step[3:2], |{step[5], step[3], step[1]}};

  assign default_0 = step[0];
  assign default_1 = step[1];
  assign default_2 = step[2];
  assign default_3 = step[3];
  assign default_4 = step[4];
  assign default_5 = step[5];
  assign arrival_beat = beat;
  assign nul_at = 7'd0;
  assign nul_at_23 = 7'd0;
  assign nonzero = 1'b0;
  assign nul_within = arrival_limit;
  assign oldest = first_at[6:3];
  assign items_at = {sub_77, map_at[2:0]};
  assign next_packet = {arrival_following, 3'd0};
  assign over_rest = 6'd0;
  assign to_exit_low = 7'd0;
  assign body_sum = last_at;
  assign to_body_low = 7'd0;
  assign words_loads = 1'b0;
  assign exits_always = 1'b1;
  assign done = 1'b1;
  assign wrong_nul = 1'b0;
  assign items_wanted = 4'd8;
  assign exit_amount = exit_add;
  assign to_exit_mask = 3'd0;
  assign body_amount = 6'd0;
  assign to_body_mask = 3'd0;
  assign next_last = early_last;
  assign step_to_body = 1'b0;
  assign words_down = 1'b0;
  assign words_keeps = 1'b1;
  assign words_pending = 1'b0;
  assign words_value = 3'd0;
endmodule

module geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_queue (
  input wire         rst,
  input wire         aclk,
  input wire         i_valid,
  output wire        i_ready,
  output wire [3:0]  freed,
  input wire         o_ready,
  input wire [41:0]  i_payload,
  input wire [3:0]   oldest,
  output wire        o_valid,
  output wire [41:0] o_payload
);

  // Registers.
  reg o_valid_q = 1'b0;
  reg [41:0] o_payload_q = 42'd0;
  reg has_second = 1'b0;
  reg [41:0] second = 42'd0;

  assign i_ready = ~has_second;
  assign freed = o_valid_q ? o_payload_q[37:34] : (has_second ? second[37:34] : oldest);

  always @(posedge aclk) begin
    if (rst) begin
      o_valid_q <= 1'b0;
      o_payload_q <= 42'd0;
      has_second <= 1'b0;
    end else begin
      if (o_ready) begin
        o_valid_q <= i_valid | has_second;
        if (has_second) begin
          o_payload_q <= second;
        end else begin
          o_payload_q <= i_payload;
        end
      end
      if (o_ready) begin
        has_second <= 1'b0;
      end else if (i_valid) begin
        has_second <= 1'b1;
      end
    end
  end

  always @(posedge aclk) begin
    if (!has_second) begin
      second <= i_payload;
    end
  end

  assign o_valid = o_valid_q;
  assign o_payload = o_payload_q;
endmodule

module geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_mover (
  input wire         rst,
  input wire         aclk,
  input wire         message_linear_x_ready,
  input wire         message_linear_y_ready,
  input wire         message_linear_z_ready,
  input wire         message_angular_x_ready,
  input wire         message_angular_y_ready,
  input wire         message_angular_z_ready,
  input wire         status_ready,
  output wire        orders_ready,
  input wire [73:0]  beat,
  input wire         orders_valid,
  input wire [41:0]  orders_payload,
  output wire        message_linear_x_valid,
  output wire        message_linear_y_valid,
  output wire        message_linear_z_valid,
  output wire        message_angular_x_valid,
  output wire        message_angular_y_valid,
  output wire        message_angular_z_valid,
  output wire        status_valid,
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  output wire [2:0]  status_payload,
  output wire [63:0] message_linear_x_payload,
  output wire [63:0] message_linear_y_payload,
  output wire [63:0] message_linear_z_payload,
  output wire [63:0] message_angular_x_payload,
  output wire [63:0] message_angular_y_payload,
  output wire [63:0] message_angular_z_payload
);

  // Registers.
  reg message_linear_x_valid_q = 1'b0;
  reg message_linear_y_valid_q = 1'b0;
  reg message_linear_z_valid_q = 1'b0;
  reg message_angular_x_valid_q = 1'b0;
  reg message_angular_y_valid_q = 1'b0;
  reg message_angular_z_valid_q = 1'b0;
  reg status_valid_q = 1'b0;
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  reg [2:0] status_payload_q = 3'd0;
  reg [63:0] message_linear_x_payload_q = 64'd0;
  reg [63:0] message_linear_y_payload_q = 64'd0;
  reg [63:0] message_linear_z_payload_q = 64'd0;
  reg [63:0] message_angular_x_payload_q = 64'd0;
  reg [63:0] message_angular_y_payload_q = 64'd0;
  reg [63:0] message_angular_z_payload_q = 64'd0;
  reg length_good = 1'b0;
  reg last = 1'b0;
  reg final_sig = 1'b0;
  reg [63:0] items_word = 64'd0;
  reg [7:0] items_good = 8'd0;
  reg [63:0] map_word = 64'd0;
  reg [7:0] map_good = 8'd0;
  reg cut_0 = 1'b0;
  reg [31:0] carried = 32'd0;
  reg cut_1 = 1'b0;
  reg cut_2 = 1'b0;
  reg cut_3 = 1'b0;
  reg cut_4 = 1'b0;
  reg active_0 = 1'b0;
  reg active_1 = 1'b0;
  reg active_2 = 1'b0;
  reg active_3 = 1'b0;
  reg active_4 = 1'b0;
  reg active_5 = 1'b0;
  reg ends_now = 1'b0;
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  reg [2:0] status_now = 3'd0;
  reg slow = 1'b0;

  // Combinational signals.
  wire blocked_0;
  wire go_0;
  wire blocked_1;
  wire go_1;
  wire blocked_2;
  wire go_2;
  wire blocked_3;
  wire go_3;
  wire blocked_4;
  wire go_4;
  wire blocked_5;
  wire go_5;
  wire ends;
  wire active_0_next;
  wire active_1_next;
  wire active_2_next;
  wire active_3_next;
  wire active_4_next;
  wire active_5_next;
  wire or_165;
  wire or_181;
  wire [7:0] lane_0_items_data;
  wire [7:0] lane_0_map_data;
  wire [7:0] lane_1_items_data;
  wire [7:0] lane_1_map_data;
  wire [7:0] lane_2_items_data;
  wire [7:0] lane_2_map_data;
  wire [7:0] lane_3_items_data;
  wire [7:0] lane_3_map_data;
  wire [7:0] lane_4_items_data;
  wire [7:0] lane_4_map_data;
  wire [7:0] lane_5_items_data;
  wire [7:0] lane_5_map_data;
  wire [7:0] lane_6_items_data;
  wire [7:0] lane_6_map_data;
  wire [7:0] lane_7_items_data;
  wire [7:0] lane_7_map_data;

  // Signals that no logic reads, for simulation.
  wire take;
  wire [2:0] lane_0_write_addr;
  wire [7:0] lane_0_write_data;
  wire lane_0_write_en;
  wire [2:0] lane_0_items_addr;
  wire [2:0] lane_0_map_addr;
  wire [2:0] lane_1_write_addr;
  wire [7:0] lane_1_write_data;
  wire lane_1_write_en;
  wire [2:0] lane_1_items_addr;
  wire [2:0] lane_1_map_addr;
  wire [2:0] lane_2_write_addr;
  wire [7:0] lane_2_write_data;
  wire lane_2_write_en;
  wire [2:0] lane_2_items_addr;
  wire [2:0] lane_2_map_addr;
  wire [2:0] lane_3_write_addr;
  wire [7:0] lane_3_write_data;
  wire lane_3_write_en;
  wire [2:0] lane_3_items_addr;
  wire [2:0] lane_3_map_addr;
  wire [2:0] lane_4_write_addr;
  wire [7:0] lane_4_write_data;
  wire lane_4_write_en;
  wire [2:0] lane_4_items_addr;
  wire [2:0] lane_4_map_addr;
  wire [2:0] lane_5_write_addr;
  wire [7:0] lane_5_write_data;
  wire lane_5_write_en;
  wire [2:0] lane_5_items_addr;
  wire [2:0] lane_5_map_addr;
  wire [2:0] lane_6_write_addr;
  wire [7:0] lane_6_write_data;
  wire lane_6_write_en;
  wire [2:0] lane_6_items_addr;
  wire [2:0] lane_6_map_addr;
  wire [2:0] lane_7_write_addr;
  wire [7:0] lane_7_write_data;
  wire lane_7_write_en;
  wire [2:0] lane_7_items_addr;
  wire [2:0] lane_7_map_addr;
  wire [63:0] payload_0;
  wire [63:0] payload_1;
  wire [63:0] payload_2;
  wire [63:0] payload_3;
  wire [63:0] payload_4;
  wire [63:0] payload_5;

  reg [7:0] lane_0 [0:7];
  integer lane_0_at;
  initial begin
    for (lane_0_at = 0; lane_0_at < 8; lane_0_at = lane_0_at + 1)
      lane_0[lane_0_at] = 8'd0;
  end

  reg [7:0] lane_1 [0:7];
  integer lane_1_at;
  initial begin
    for (lane_1_at = 0; lane_1_at < 8; lane_1_at = lane_1_at + 1)
      lane_1[lane_1_at] = 8'd0;
  end

  reg [7:0] lane_2 [0:7];
  integer lane_2_at;
  initial begin
    for (lane_2_at = 0; lane_2_at < 8; lane_2_at = lane_2_at + 1)
      lane_2[lane_2_at] = 8'd0;
  end

  reg [7:0] lane_3 [0:7];
  integer lane_3_at;
  initial begin
    for (lane_3_at = 0; lane_3_at < 8; lane_3_at = lane_3_at + 1)
      lane_3[lane_3_at] = 8'd0;
  end

  reg [7:0] lane_4 [0:7];
  integer lane_4_at;
  initial begin
    for (lane_4_at = 0; lane_4_at < 8; lane_4_at = lane_4_at + 1)
      lane_4[lane_4_at] = 8'd0;
  end

  reg [7:0] lane_5 [0:7];
  integer lane_5_at;
  initial begin
    for (lane_5_at = 0; lane_5_at < 8; lane_5_at = lane_5_at + 1)
      lane_5[lane_5_at] = 8'd0;
  end

  reg [7:0] lane_6 [0:7];
  integer lane_6_at;
  initial begin
    for (lane_6_at = 0; lane_6_at < 8; lane_6_at = lane_6_at + 1)
      lane_6[lane_6_at] = 8'd0;
  end

  reg [7:0] lane_7 [0:7];
  integer lane_7_at;
  initial begin
    for (lane_7_at = 0; lane_7_at < 8; lane_7_at = lane_7_at + 1)
      lane_7[lane_7_at] = 8'd0;
  end

  assign blocked_0 = active_0 & message_linear_x_valid_q;
  assign go_0 = active_0 & ~blocked_0;
  assign blocked_1 = active_1 & message_linear_y_valid_q;
  assign go_1 = active_1 & ~blocked_1;
  assign blocked_2 = active_2 & message_linear_z_valid_q;
  assign go_2 = active_2 & ~blocked_2;
  assign blocked_3 = active_3 & message_angular_x_valid_q;
  assign go_3 = active_3 & ~blocked_3;
  assign blocked_4 = active_4 & message_angular_y_valid_q;
  assign go_4 = active_4 & ~blocked_4;
  assign blocked_5 = active_5 & message_angular_z_valid_q;
  assign go_5 = active_5 & ~blocked_5 & ~blocked_4;
  assign ends = orders_valid & orders_payload[38];
  assign orders_ready = ~slow;
  assign active_0_next = orders_ready ? (orders_valid & ~orders_payload[3] &
      (orders_payload[2:0] == 3'd1)) : (active_0 & ~go_0);
  assign active_1_next = orders_ready ? (orders_valid & ~orders_payload[3] &
      (orders_payload[2:0] == 3'd2)) : (active_1 & ~go_1);
  assign active_2_next = orders_ready ? (orders_valid & ~orders_payload[3] &
      (orders_payload[2:0] == 3'd3)) : (active_2 & ~go_2);
  assign active_3_next = orders_ready ? (orders_valid & ~orders_payload[3] &
      (orders_payload[2:0] == 3'd4)) : (active_3 & ~go_3);
  assign active_4_next = orders_ready ? (orders_valid & ~orders_payload[3] &
      (orders_payload[2:0] == 3'd5)) : (active_4 & ~go_4);
  assign active_5_next = orders_ready ? (orders_valid & ~orders_payload[3] &
      (orders_payload[2:0] == 3'd5)) : (active_5 & ~go_5);
  assign or_165 = |{ends & status_valid_q & ~status_ready, orders_valid & ~orders_payload[3] &
      (orders_payload[2:0] == 3'd5) & message_angular_z_valid_q & ~message_angular_z_ready,
      orders_valid & ~orders_payload[3] & (orders_payload[2:0] == 3'd5) &
      message_angular_y_valid_q & ~message_angular_y_ready, orders_valid & ~orders_payload[3] &
      (orders_payload[2:0] == 3'd4) & message_angular_x_valid_q & ~message_angular_x_ready,
      orders_valid & ~orders_payload[3] & (orders_payload[2:0] == 3'd3) & message_linear_z_valid_q &
      ~message_linear_z_ready, orders_valid & ~orders_payload[3] & (orders_payload[2:0] == 3'd2) &
      message_linear_y_valid_q & ~message_linear_y_ready, orders_valid & ~orders_payload[3] &
      (orders_payload[2:0] == 3'd1) & message_linear_x_valid_q & ~message_linear_x_ready};
  assign or_181 = |{ends_now & status_valid_q & ~status_ready, blocked_5 & ~message_angular_z_ready,
      blocked_4 & ~message_angular_y_ready, blocked_3 & ~message_angular_x_ready, blocked_2 &
      ~message_linear_z_ready, blocked_1 & ~message_linear_y_ready, blocked_0 &
      ~message_linear_x_ready};

  always @(posedge aclk) begin
    if (beat[73]) begin
      lane_0[beat[71:69]] <= beat[7:0];
    end
  end
  assign lane_0_items_data = lane_0[orders_payload[9:7]];
  assign lane_0_map_data = lane_0[orders_payload[15:13]];

  always @(posedge aclk) begin
    if (beat[73]) begin
      lane_1[beat[71:69]] <= beat[15:8];
    end
  end
  assign lane_1_items_data = lane_1[orders_payload[9:7]];
  assign lane_1_map_data = lane_1[orders_payload[15:13]];

  always @(posedge aclk) begin
    if (beat[73]) begin
      lane_2[beat[71:69]] <= beat[23:16];
    end
  end
  assign lane_2_items_data = lane_2[orders_payload[9:7]];
  assign lane_2_map_data = lane_2[orders_payload[15:13]];

  always @(posedge aclk) begin
    if (beat[73]) begin
      lane_3[beat[71:69]] <= beat[31:24];
    end
  end
  assign lane_3_items_data = lane_3[orders_payload[9:7]];
  assign lane_3_map_data = lane_3[orders_payload[15:13]];

  always @(posedge aclk) begin
    if (beat[73]) begin
      lane_4[beat[71:69]] <= beat[39:32];
    end
  end
  assign lane_4_items_data = lane_4[orders_payload[9:7]];
  assign lane_4_map_data = lane_4[orders_payload[15:13]];

  always @(posedge aclk) begin
    if (beat[73]) begin
      lane_5[beat[71:69]] <= beat[47:40];
    end
  end
  assign lane_5_items_data = lane_5[orders_payload[9:7]];
  assign lane_5_map_data = lane_5[orders_payload[15:13]];

  always @(posedge aclk) begin
    if (beat[73]) begin
      lane_6[beat[71:69]] <= beat[55:48];
    end
  end
  assign lane_6_items_data = lane_6[orders_payload[9:7]];
  assign lane_6_map_data = lane_6[orders_payload[15:13]];

  always @(posedge aclk) begin
    if (beat[73]) begin
      lane_7[beat[71:69]] <= beat[63:56];
    end
  end
  assign lane_7_items_data = lane_7[orders_payload[9:7]];
  assign lane_7_map_data = lane_7[orders_payload[15:13]];

  always @(posedge aclk) begin
    if (rst) begin
      message_linear_x_valid_q <= 1'b0;
      message_linear_y_valid_q <= 1'b0;
      message_linear_z_valid_q <= 1'b0;
      message_angular_x_valid_q <= 1'b0;
      message_angular_y_valid_q <= 1'b0;
      message_angular_z_valid_q <= 1'b0;
      status_valid_q <= 1'b0;
      length_good <= 1'b0;
      last <= 1'b0;
      final_sig <= 1'b0;
      cut_0 <= 1'b0;
      cut_1 <= 1'b0;
      cut_2 <= 1'b0;
      cut_3 <= 1'b0;
      cut_4 <= 1'b0;
      active_0 <= 1'b0;
      active_1 <= 1'b0;
      active_2 <= 1'b0;
      active_3 <= 1'b0;
      active_4 <= 1'b0;
      active_5 <= 1'b0;
      ends_now <= 1'b0;
      status_now <= 3'd0;
      status_payload_q <= 3'd0;
      slow <= 1'b0;
    end else begin
      if (message_linear_x_ready) begin
        message_linear_x_valid_q <= 1'b0;
      end
      if (go_0) begin
        message_linear_x_valid_q <= 1'b1;
      end
      if (message_linear_y_ready) begin
        message_linear_y_valid_q <= 1'b0;
      end
      if (go_1) begin
        message_linear_y_valid_q <= 1'b1;
      end
      if (message_linear_z_ready) begin
        message_linear_z_valid_q <= 1'b0;
      end
      if (go_2) begin
        message_linear_z_valid_q <= 1'b1;
      end
      if (message_angular_x_ready) begin
        message_angular_x_valid_q <= 1'b0;
      end
      if (go_3) begin
        message_angular_x_valid_q <= 1'b1;
      end
      if (message_angular_y_ready) begin
        message_angular_y_valid_q <= 1'b0;
      end
      if (go_4) begin
        message_angular_y_valid_q <= 1'b1;
      end
      if (message_angular_z_ready) begin
        message_angular_z_valid_q <= 1'b0;
      end
      if (go_5) begin
        message_angular_z_valid_q <= 1'b1;
      end
      if (status_ready) begin
        status_valid_q <= 1'b0;
      end
      if (orders_ready) begin
        if (ends_now) begin
          status_valid_q <= 1'b1;
          status_payload_q <= status_now;
        end
        length_good <= orders_payload[32];
        last <= orders_payload[31];
        final_sig <= orders_payload[33];
        cut_0 <= orders_valid & ~orders_payload[3] & (orders_payload[2:0] == 3'd0);
        cut_1 <= orders_valid & ~orders_payload[3] & (orders_payload[2:0] == 3'd1);
        cut_2 <= orders_valid & ~orders_payload[3] & (orders_payload[2:0] == 3'd2);
        cut_3 <= orders_valid & ~orders_payload[3] & (orders_payload[2:0] == 3'd3);
        cut_4 <= orders_valid & ~orders_payload[3] & (orders_payload[2:0] == 3'd4);
        ends_now <= ends;
        status_now <= orders_payload[41:39];
      end
      active_0 <= active_0_next;
      active_1 <= active_1_next;
      active_2 <= active_2_next;
      active_3 <= active_3_next;
      active_4 <= active_4_next;
      active_5 <= active_5_next;
      if (orders_ready) begin
        slow <= or_165;
      end else begin
        slow <= or_181;
      end
    end
  end

  always @(posedge aclk) begin
    if (orders_ready) begin
      items_word <= {lane_7_items_data, lane_6_items_data, lane_5_items_data, lane_4_items_data,
          lane_3_items_data, lane_2_items_data, lane_1_items_data, lane_0_items_data};
      items_good <= {orders_payload[25:22] > 4'd7, orders_payload[25:22] > 4'd6,
          orders_payload[25:22] > 4'd5, orders_payload[25:22] > 4'd4, orders_payload[25:22] > 4'd3,
          orders_payload[25:22] > 4'd2, orders_payload[25:22] > 4'd1, orders_payload[25:22] > 4'd0};
      map_word <= {lane_7_map_data, lane_6_map_data, lane_5_map_data, lane_4_map_data,
          lane_3_map_data, lane_2_map_data, lane_1_map_data, lane_0_map_data};
      map_good <= {orders_payload[29:26] > 4'd7, orders_payload[29:26] > 4'd6,
          orders_payload[29:26] > 4'd5, orders_payload[29:26] > 4'd4, orders_payload[29:26] > 4'd3,
          orders_payload[29:26] > 4'd2, orders_payload[29:26] > 4'd1, orders_payload[29:26] > 4'd0};
    end
    if (orders_ready && cut_0) begin
      carried[7:0] <= map_word[39:32];
    end
    if (orders_ready && cut_0) begin
      carried[15:8] <= map_word[47:40];
    end
    if (orders_ready && cut_0) begin
      carried[23:16] <= map_word[55:48];
    end
    if (orders_ready && cut_0) begin
      carried[31:24] <= map_word[63:56];
    end
    if (orders_ready && cut_1) begin
      carried[7:0] <= map_word[39:32];
    end
    if (orders_ready && cut_1) begin
      carried[15:8] <= map_word[47:40];
    end
    if (orders_ready && cut_1) begin
      carried[23:16] <= map_word[55:48];
    end
    if (orders_ready && cut_1) begin
      carried[31:24] <= map_word[63:56];
    end
    if (orders_ready && cut_2) begin
      carried[7:0] <= map_word[39:32];
    end
    if (orders_ready && cut_2) begin
      carried[15:8] <= map_word[47:40];
    end
    if (orders_ready && cut_2) begin
      carried[23:16] <= map_word[55:48];
    end
    if (orders_ready && cut_2) begin
      carried[31:24] <= map_word[63:56];
    end
    if (orders_ready && cut_3) begin
      carried[7:0] <= map_word[39:32];
    end
    if (orders_ready && cut_3) begin
      carried[15:8] <= map_word[47:40];
    end
    if (orders_ready && cut_3) begin
      carried[23:16] <= map_word[55:48];
    end
    if (orders_ready && cut_3) begin
      carried[31:24] <= map_word[63:56];
    end
    if (orders_ready && cut_4) begin
      carried[7:0] <= map_word[39:32];
    end
    if (orders_ready && cut_4) begin
      carried[15:8] <= map_word[47:40];
    end
    if (orders_ready && cut_4) begin
      carried[23:16] <= map_word[55:48];
    end
    if (orders_ready && cut_4) begin
      carried[31:24] <= map_word[63:56];
    end
    if (go_0) begin
      if (map_good[3]) begin
        message_linear_x_payload_q <= {map_word[31:0], carried};
      end else begin
        message_linear_x_payload_q <= 64'd0;
      end
    end
    if (go_1) begin
      if (map_good[3]) begin
        message_linear_y_payload_q <= {map_word[31:0], carried};
      end else begin
        message_linear_y_payload_q <= 64'd0;
      end
    end
    if (go_2) begin
      if (map_good[3]) begin
        message_linear_z_payload_q <= {map_word[31:0], carried};
      end else begin
        message_linear_z_payload_q <= 64'd0;
      end
    end
    if (go_3) begin
      if (map_good[3]) begin
        message_angular_x_payload_q <= {map_word[31:0], carried};
      end else begin
        message_angular_x_payload_q <= 64'd0;
      end
    end
    if (go_4) begin
      if (items_good[3]) begin
        message_angular_y_payload_q <= {items_word[31:0], carried};
      end else begin
        message_angular_y_payload_q <= 64'd0;
      end
    end
    if (go_5) begin
      if (map_good[3]) begin
        message_angular_z_payload_q <= {map_word[31:0], items_word[63:32]};
      end else begin
        message_angular_z_payload_q <= 64'd0;
      end
    end
  end

  assign message_linear_x_valid = message_linear_x_valid_q;
  assign message_linear_y_valid = message_linear_y_valid_q;
  assign message_linear_z_valid = message_linear_z_valid_q;
  assign message_angular_x_valid = message_angular_x_valid_q;
  assign message_angular_y_valid = message_angular_y_valid_q;
  assign message_angular_z_valid = message_angular_z_valid_q;
  assign status_valid = status_valid_q;
  assign status_payload = status_payload_q;
  assign message_linear_x_payload = message_linear_x_payload_q;
  assign message_linear_y_payload = message_linear_y_payload_q;
  assign message_linear_z_payload = message_linear_z_payload_q;
  assign message_angular_x_payload = message_angular_x_payload_q;
  assign message_angular_y_payload = message_angular_y_payload_q;
  assign message_angular_z_payload = message_angular_z_payload_q;

  assign take = orders_ready;
  assign lane_0_write_addr = beat[71:69];
  assign lane_0_write_data = beat[7:0];
  assign lane_0_write_en = beat[73];
  assign lane_0_items_addr = orders_payload[9:7];
  assign lane_0_map_addr = orders_payload[15:13];
  assign lane_1_write_addr = beat[71:69];
  assign lane_1_write_data = beat[15:8];
  assign lane_1_write_en = beat[73];
  assign lane_1_items_addr = orders_payload[9:7];
  assign lane_1_map_addr = orders_payload[15:13];
  assign lane_2_write_addr = beat[71:69];
  assign lane_2_write_data = beat[23:16];
  assign lane_2_write_en = beat[73];
  assign lane_2_items_addr = orders_payload[9:7];
  assign lane_2_map_addr = orders_payload[15:13];
  assign lane_3_write_addr = beat[71:69];
  assign lane_3_write_data = beat[31:24];
  assign lane_3_write_en = beat[73];
  assign lane_3_items_addr = orders_payload[9:7];
  assign lane_3_map_addr = orders_payload[15:13];
  assign lane_4_write_addr = beat[71:69];
  assign lane_4_write_data = beat[39:32];
  assign lane_4_write_en = beat[73];
  assign lane_4_items_addr = orders_payload[9:7];
  assign lane_4_map_addr = orders_payload[15:13];
  assign lane_5_write_addr = beat[71:69];
  assign lane_5_write_data = beat[47:40];
  assign lane_5_write_en = beat[73];
  assign lane_5_items_addr = orders_payload[9:7];
  assign lane_5_map_addr = orders_payload[15:13];
  assign lane_6_write_addr = beat[71:69];
  assign lane_6_write_data = beat[55:48];
  assign lane_6_write_en = beat[73];
  assign lane_6_items_addr = orders_payload[9:7];
  assign lane_6_map_addr = orders_payload[15:13];
  assign lane_7_write_addr = beat[71:69];
  assign lane_7_write_data = beat[63:56];
  assign lane_7_write_en = beat[73];
  assign lane_7_items_addr = orders_payload[9:7];
  assign lane_7_map_addr = orders_payload[15:13];
  assign payload_0 = message_linear_x_payload_q;
  assign payload_1 = message_linear_y_payload_q;
  assign payload_2 = message_linear_z_payload_q;
  assign payload_3 = message_angular_x_payload_q;
  assign payload_4 = message_angular_y_payload_q;
  assign payload_5 = message_angular_z_payload_q;
endmodule

module geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core (
  input wire         rst,
  input wire         aclk,
  input wire         packets_valid,
  input wire         message_linear_x_ready,
  input wire         message_linear_y_ready,
  input wire         message_linear_z_ready,
  input wire         message_angular_x_ready,
  input wire         message_angular_y_ready,
  input wire         message_angular_z_ready,
  input wire         status_ready,
  input wire [68:0]  packets_payload,
  output wire        packets_ready,
  output wire        message_linear_x_valid,
  output wire        message_linear_y_valid,
  output wire        message_linear_z_valid,
  output wire        message_angular_x_valid,
  output wire        message_angular_y_valid,
  output wire        message_angular_z_valid,
  output wire        status_valid,
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  output wire [2:0]  status_payload,
  output wire [63:0] message_linear_x_payload,
  output wire [63:0] message_linear_y_payload,
  output wire [63:0] message_linear_z_payload,
  output wire [63:0] message_angular_x_payload,
  output wire [63:0] message_angular_y_payload,
  output wire [63:0] message_angular_z_payload
);

  // Combinational signals.
  wire [73:0] arrival_beat;
  wire [6:0] arrival_limit;
  wire [3:0] arrival_following;
  wire arrival_ended;
  wire i_valid;
  wire arrival_next;
  wire [41:0] i_payload;
  wire [3:0] oldest;
  wire orders_ready;
  wire [3:0] freed;
  wire orders_valid_26;
  wire [41:0] orders_payload_22;
  wire o_ready;

  // Signals that no logic reads, for simulation.
  wire [41:0] orders_payload;
  wire i_ready;
  wire orders_valid;
  wire [41:0] o_payload;
  wire orders_ready_25;
  wire o_valid;
  wire [73:0] beat;
  wire stall_newest;
  wire stall_newest_38;
  wire zero_length;
  wire zero_length_40;

  geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_buffer buffer_sig (
    .aclk              (aclk),
    .packets_valid     (packets_valid),
    .rst               (rst),
    .arrival_next      (arrival_next),
    .freed             (freed),
    .packets_payload   (packets_payload),
    .arrival_beat      (arrival_beat),
    .packets_ready     (packets_ready),
    .arrival_limit     (arrival_limit),
    .arrival_following (arrival_following),
    .arrival_ended     (arrival_ended)
  );

  geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_sequencer sequencer (
    .aclk              (aclk),
    .rst               (rst),
    .orders_valid      (i_valid),
    .arrival_next      (arrival_next),
    .orders_ready      (orders_ready),
    .beat              (arrival_beat),
    .arrival_limit     (arrival_limit),
    .arrival_following (arrival_following),
    .arrival_ended     (arrival_ended),
    .orders_payload    (i_payload),
    .header_at         (oldest)
  );

  geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_queue queue (
    .aclk      (aclk),
    .rst       (rst),
    .i_valid   (i_valid),
    .i_ready   (orders_ready),
    .freed     (freed),
    .o_ready   (o_ready),
    .i_payload (i_payload),
    .oldest    (oldest),
    .o_valid   (orders_valid_26),
    .o_payload (orders_payload_22)
  );

  geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_mover mover (
    .aclk                      (aclk),
    .message_linear_x_ready    (message_linear_x_ready),
    .message_linear_y_ready    (message_linear_y_ready),
    .message_linear_z_ready    (message_linear_z_ready),
    .message_angular_x_ready   (message_angular_x_ready),
    .message_angular_y_ready   (message_angular_y_ready),
    .message_angular_z_ready   (message_angular_z_ready),
    .status_ready              (status_ready),
    .rst                       (rst),
    .orders_ready              (o_ready),
    .beat                      (arrival_beat),
    .orders_valid              (orders_valid_26),
    .orders_payload            (orders_payload_22),
    .message_linear_x_valid    (message_linear_x_valid),
    .message_linear_y_valid    (message_linear_y_valid),
    .message_linear_z_valid    (message_linear_z_valid),
    .message_angular_x_valid   (message_angular_x_valid),
    .message_angular_y_valid   (message_angular_y_valid),
    .message_angular_z_valid   (message_angular_z_valid),
    .status_valid              (status_valid),
    .status_payload            (status_payload),
    .message_linear_x_payload  (message_linear_x_payload),
    .message_linear_y_payload  (message_linear_y_payload),
    .message_linear_z_payload  (message_linear_z_payload),
    .message_angular_x_payload (message_angular_x_payload),
    .message_angular_y_payload (message_angular_y_payload),
    .message_angular_z_payload (message_angular_z_payload)
  );

  assign orders_payload = i_payload;
  assign i_ready = orders_ready;
  assign orders_valid = i_valid;
  assign o_payload = orders_payload_22;
  assign orders_ready_25 = o_ready;
  assign o_valid = orders_valid_26;
  assign beat = arrival_beat;
  assign stall_newest = 1'b0;
  assign stall_newest_38 = 1'b0;
  assign zero_length = 1'b0;
  assign zero_length_40 = 1'b0;
endmodule

module geometry_msgs_msg_Twist_cdr_8_deserializer_verilog (
  input wire         aclk,
  input wire         aresetn,
  input wire [63:0]  s_axis_tdata,
  input wire [7:0]   s_axis_tkeep,
  input wire         s_axis_tlast,
  input wire         s_axis_tvalid,
  input wire         linear_x_ready,
  input wire         linear_y_ready,
  input wire         linear_z_ready,
  input wire         angular_x_ready,
  input wire         angular_y_ready,
  input wire         angular_z_ready,
  input wire         m_axis_status_tready,
  output wire        s_axis_tready,
  output wire [63:0] linear_x_data,
  output wire        linear_x_valid,
  output wire [63:0] linear_y_data,
  output wire        linear_y_valid,
  output wire [63:0] linear_z_data,
  output wire        linear_z_valid,
  output wire [63:0] angular_x_data,
  output wire        angular_x_valid,
  output wire [63:0] angular_y_data,
  output wire        angular_y_valid,
  output wire [63:0] angular_z_data,
  output wire        angular_z_valid,
  output wire [7:0]  m_axis_status_tdata,
  output wire        m_axis_status_tvalid
);

  // Combinational signals.
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  wire [2:0] status_payload;
  wire rst;
  wire or_13;
  wire or_26;
  wire or_39;
  wire [3:0] packets_payload_64;

  // Signals that no logic reads, for simulation.
  wire packets_valid;
  wire packets_ready;
  wire status_valid;
  wire status_ready;
  wire [63:0] message_linear_x_payload;
  wire message_linear_x_valid;
  wire message_linear_x_ready;
  wire [63:0] message_linear_y_payload;
  wire message_linear_y_valid;
  wire message_linear_y_ready;
  wire [63:0] message_linear_z_payload;
  wire message_linear_z_valid;
  wire message_linear_z_ready;
  wire [63:0] message_angular_x_payload;
  wire message_angular_x_valid;
  wire message_angular_x_ready;
  wire [63:0] message_angular_y_payload;
  wire message_angular_y_valid;
  wire message_angular_y_ready;
  wire [63:0] message_angular_z_payload;
  wire message_angular_z_valid;
  wire message_angular_z_ready;
  wire [68:0] packets_payload;

  geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core core (
    .aclk                      (aclk),
    .packets_valid             (s_axis_tvalid),
    .message_linear_x_ready    (linear_x_ready),
    .message_linear_y_ready    (linear_y_ready),
    .message_linear_z_ready    (linear_z_ready),
    .message_angular_x_ready   (angular_x_ready),
    .message_angular_y_ready   (angular_y_ready),
    .message_angular_z_ready   (angular_z_ready),
    .status_ready              (m_axis_status_tready),
    .rst                       (rst),
    .packets_payload           ({s_axis_tlast, packets_payload_64, s_axis_tdata}),
    .packets_ready             (s_axis_tready),
    .message_linear_x_valid    (linear_x_valid),
    .message_linear_y_valid    (linear_y_valid),
    .message_linear_z_valid    (linear_z_valid),
    .message_angular_x_valid   (angular_x_valid),
    .message_angular_y_valid   (angular_y_valid),
    .message_angular_z_valid   (angular_z_valid),
    .status_valid              (m_axis_status_tvalid),
    .status_payload            (status_payload),
    .message_linear_x_payload  (linear_x_data),
    .message_linear_y_payload  (linear_y_data),
    .message_linear_z_payload  (linear_z_data),
    .message_angular_x_payload (angular_x_data),
    .message_angular_y_payload (angular_y_data),
    .message_angular_z_payload (angular_z_data)
  );

  assign rst = ~aresetn;
  assign or_13 = |{(&s_axis_tkeep[6:0]) & ~s_axis_tkeep[7], (&s_axis_tkeep[4:0]) & ~s_axis_tkeep[5],
      (&s_axis_tkeep[2:0]) & ~s_axis_tkeep[3], s_axis_tkeep[0] & ~s_axis_tkeep[1]};
  assign or_26 = |{(&s_axis_tkeep[6:0]) & ~s_axis_tkeep[7], (&s_axis_tkeep[5:0]) & ~s_axis_tkeep[6],
      (&s_axis_tkeep[2:0]) & ~s_axis_tkeep[3], (&s_axis_tkeep[1:0]) & ~s_axis_tkeep[2]};
  assign or_39 = |{(&s_axis_tkeep[6:0]) & ~s_axis_tkeep[7], (&s_axis_tkeep[5:0]) & ~s_axis_tkeep[6],
      (&s_axis_tkeep[4:0]) & ~s_axis_tkeep[5], (&s_axis_tkeep[3:0]) & ~s_axis_tkeep[4]};
  assign packets_payload_64 = s_axis_tlast ? {&s_axis_tkeep, or_39, or_26, or_13} : 4'd8;

  assign m_axis_status_tdata = {5'd0, status_payload};

  assign packets_valid = s_axis_tvalid;
  assign packets_ready = s_axis_tready;
  assign status_valid = m_axis_status_tvalid;
  assign status_ready = m_axis_status_tready;
  assign message_linear_x_payload = linear_x_data;
  assign message_linear_x_valid = linear_x_valid;
  assign message_linear_x_ready = linear_x_ready;
  assign message_linear_y_payload = linear_y_data;
  assign message_linear_y_valid = linear_y_valid;
  assign message_linear_y_ready = linear_y_ready;
  assign message_linear_z_payload = linear_z_data;
  assign message_linear_z_valid = linear_z_valid;
  assign message_linear_z_ready = linear_z_ready;
  assign message_angular_x_payload = angular_x_data;
  assign message_angular_x_valid = angular_x_valid;
  assign message_angular_x_ready = angular_x_ready;
  assign message_angular_y_payload = angular_y_data;
  assign message_angular_y_valid = angular_y_valid;
  assign message_angular_y_ready = angular_y_ready;
  assign message_angular_z_payload = angular_z_data;
  assign message_angular_z_valid = angular_z_valid;
  assign message_angular_z_ready = angular_z_ready;
  assign packets_payload = {s_axis_tlast, packets_payload_64, s_axis_tdata};
endmodule
