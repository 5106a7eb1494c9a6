// geometry_msgs_msg_Twist_cdr_8_serializer_verilog: the serializer of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
// lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
// definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
// What each port means: manifest.json.
// Steps, as `firm-hdl plan --program` prints and explains them:
// serializer: start 0, items from lane 0, unit 8, map from lane 0, unit 4, at most 3 beats a
//       state
//   0 linear_x: map of 8; begins linear.x; map = 00 01 00 00 linear.x:0..3; to 1
//   1 linear_x_2: map of 8; linear.x; begins linear.y; map = linear.x:4..7 linear.y:0..3; to 2
//   2 linear_y: map of 8; linear.y; begins linear.z; map = linear.y:4..7 linear.z:0..3; to 3
//   3 linear_z: map of 8; linear.z; begins angular.x; map = linear.z:4..7 angular.x:0..3; to 4
//   4 angular_x: map of 8; angular.x; begins angular.y; map = angular.x:4..7 angular.y:0..3; to 5
//   5 angular_y: map of 12 in two words; angular.y angular.z; items = angular.y:4..7
//       angular.z:0..3; map = angular.z:4..7; to end

// Collector: Take the leaves of each state of a program, and put them into two words.
module geometry_msgs_msg_Twist_cdr_8_serializer_verilog_core_collector (
  input wire          rst,
  input wire          aclk,
  input wire [63:0]   message_linear_x_payload,
  input wire          message_linear_x_valid,
  input wire [63:0]   message_linear_y_payload,
  input wire          message_linear_y_valid,
  input wire [63:0]   message_linear_z_payload,
  input wire          message_linear_z_valid,
  input wire [63:0]   message_angular_x_payload,
  input wire          message_angular_x_valid,
  input wire [63:0]   message_angular_y_payload,
  input wire          message_angular_y_valid,
  input wire [63:0]   message_angular_z_payload,
  input wire          message_angular_z_valid,
  input wire          status_ready,
  output wire         message_linear_x_ready,
  output wire         message_linear_y_ready,
  output wire         message_linear_z_ready,
  output wire         message_angular_x_ready,
  output wire         message_angular_y_ready,
  output wire         message_angular_z_ready,
  output wire [127:0] port_537_0,
  output wire [32:0]  port_541_0,
  output wire         status_valid,
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  output wire [2:0]   status_payload,
  output wire         words_valid,
  input wire          words_ready
);
  localparam [2:0] STATUS_OK = 3'd0;

  // Registers.
  reg [32:0] port_541_0_q = 33'd0;
  reg status_valid_q = 1'b0;
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  reg [2:0] status_payload_q = 3'd0;
  reg words_valid_q = 1'b0;
  reg served_0 = 1'b0;
  reg served_1 = 1'b0;
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  reg [2:0] error_sig = 3'd0;
  reg [31:0] items_0 = 32'd0;
  reg [31:0] items_4 = 32'd0;
  reg [31:0] map_0 = 32'd0;
  reg [31:0] map_4 = 32'd0;
  reg begun = 1'b0;
  reg words_last = 1'b1;
  reg words_less = 1'b0;
  reg step_linear_x = 1'b1;  // step 0: map of 8; begins linear.x
  reg step_linear_x_2 = 1'b0;  // step 1: map of 8; linear.x; begins linear.y
  reg step_linear_y = 1'b0;  // step 2: map of 8; linear.y; begins linear.z
  reg step_linear_z = 1'b0;  // step 3: map of 8; linear.z; begins angular.x
  reg step_angular_x = 1'b0;  // step 4: map of 8; angular.x; begins angular.y
  reg step_angular_y = 1'b0;  // step 5: map of 12 in two words; angular.y angular.z
  reg [3:0] map_bytes = 4'd8;
  reg [3:0] items_bytes = 4'd0;
  reg two_word_map = 1'b0;
  reg rest = 1'b0;
  reg has_nul = 1'b0;

  // Combinational signals.
  wire left_linear_x;
  wire lacks_linear_x;
  wire left_linear_y;
  wire lacks_linear_y;
  wire left_linear_z;
  wire lacks_linear_z;
  wire left_angular_x;
  wire lacks_angular_x;
  wire left_angular_y;
  wire lacks_angular_y;
  wire left_angular_z;
  wire lacks_angular_z;
  wire go_angular_z;
  wire free;
  wire or_60;
  wire complete;
  wire [4:0] map_size;
  wire begins;
  wire [3:0] to_map_0;
  wire to_exit;
  wire served_0_next;
  wire or_120;
  wire [31:0] or_133;
  wire [31:0] map_0_next;
  wire [31:0] or_152;
  wire [5:0] add_159;
  wire [5:0] to_end;
  wire [2:0] end_mask;

  // Signals that no logic reads, for simulation.
  wire length_zero;
  wire length_skips;
  wire length_over;
  wire [160:0] words_payload;
  wire [4:0] to_map;
  wire length_rest;
  wire length_at_most_one_pass;
  wire words_loads;
  wire done;
  wire ends;
  wire go_linear_x;
  wire go_linear_y;
  wire go_linear_z;
  wire go_angular_x;
  wire go_angular_y;
  wire [3:0] items_size;
  wire to_body;
  wire words_down;
  wire words_keeps;
  wire words_is_small;
  wire words_is_2;
  wire words_is_3;
  wire words_is_4;
  wire [2:0] found;  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  wire words_pending;
  wire [2:0] words_value;

  assign left_linear_x = step_linear_x_2 & ~served_0;
  assign lacks_linear_x = left_linear_x & ~message_linear_x_valid;
  assign message_linear_x_ready = left_linear_x & message_linear_x_valid & free;
  assign left_linear_y = step_linear_y & ~served_0;
  assign lacks_linear_y = left_linear_y & ~message_linear_y_valid;
  assign message_linear_y_ready = left_linear_y & message_linear_y_valid & free;
  assign left_linear_z = step_linear_z & ~served_0;
  assign lacks_linear_z = left_linear_z & ~message_linear_z_valid;
  assign message_linear_z_ready = left_linear_z & message_linear_z_valid & free;
  assign left_angular_x = step_angular_x & ~served_0;
  assign lacks_angular_x = left_angular_x & ~message_angular_x_valid;
  assign message_angular_x_ready = left_angular_x & message_angular_x_valid & free;
  assign left_angular_y = step_angular_y & ~served_0;
  assign lacks_angular_y = left_angular_y & ~message_angular_y_valid;
  assign message_angular_y_ready = left_angular_y & message_angular_y_valid & free;
  assign left_angular_z = step_angular_y & ~served_1;
  assign lacks_angular_z = left_angular_z & ~message_angular_z_valid;
  assign go_angular_z = left_angular_z & message_angular_z_valid & free & ~lacks_angular_y;
  assign free = ~words_valid_q | words_ready;
  assign or_60 = lacks_linear_x | lacks_linear_y | lacks_linear_z | lacks_angular_x |
      lacks_angular_y | lacks_angular_z | (step_linear_x & ~message_linear_x_valid) |
      (step_linear_x_2 & ~message_linear_y_valid) | (step_linear_y & ~message_linear_z_valid) |
      (step_linear_z & ~message_angular_x_valid) | (step_angular_x & ~message_angular_y_valid);
  assign complete = free & ~or_60 & (~step_angular_y | ~status_valid_q | status_ready);
  assign map_size = {1'd0, map_bytes} + {1'd0, two_word_map ? 4'd8 : 4'd0};
  assign begins = begun | (|items_bytes) | (|map_bytes);
  assign to_map_0 = two_word_map ? 4'd0 : items_bytes;
  assign to_exit = complete & ~step_angular_y;
  assign served_0_next = (served_0 | message_linear_x_ready | message_linear_y_ready |
      message_linear_z_ready | message_angular_x_ready | message_angular_y_ready) & ~complete;
  assign or_120 = ((step_linear_x_2 | step_linear_y | step_linear_z | step_angular_x) & served_0) |
      (step_angular_y & served_1);
  assign or_133 = (step_linear_x ? 32'd256 : 32'd0) | (step_linear_x_2 ?
      message_linear_x_payload[63:32] : 32'd0) | (step_linear_y ? message_linear_y_payload[63:32] :
      32'd0) | (step_linear_z ? message_linear_z_payload[63:32] : 32'd0);
  assign map_0_next = or_133 | (step_angular_x ? message_angular_x_payload[63:32] : 32'd0) |
      (step_angular_y ? message_angular_z_payload[63:32] : 32'd0);
  assign or_152 = (step_linear_x ? message_linear_x_payload[31:0] : 32'd0) | (step_linear_x_2 ?
      message_linear_y_payload[31:0] : 32'd0) | (step_linear_y ? message_linear_z_payload[31:0] :
      32'd0) | (step_linear_z ? message_angular_x_payload[31:0] : 32'd0);
  assign add_159 = {1'd0, 1'b0, to_map_0} + to_end + 6'd7;

  assign to_end = step_angular_y ? (begins ? ({1'd0, map_size} + 6'd7) : 6'd8) :
      {1'b0, map_size};

  assign end_mask = step_angular_y ? 3'd7 :
      3'd0;

  always @(posedge aclk) begin
    if (rst) begin
      port_541_0_q <= 33'd0;
      served_0 <= 1'b0;
      served_1 <= 1'b0;
      error_sig <= 3'd0;
      status_valid_q <= 1'b0;
      status_payload_q <= 3'd0;
      begun <= 1'b0;
      words_valid_q <= 1'b0;
      words_last <= 1'b1;
      words_less <= 1'b0;
      step_linear_x <= 1'b1;
      step_linear_x_2 <= 1'b0;
      step_linear_y <= 1'b0;
      step_linear_z <= 1'b0;
      step_angular_x <= 1'b0;
      step_angular_y <= 1'b0;
      map_bytes <= 4'd8;
      items_bytes <= 4'd0;
      two_word_map <= 1'b0;
      rest <= 1'b0;
      has_nul <= 1'b0;
    end else begin
      if (free) begin
        port_541_0_q[13:0] <= {1'b0, to_map_0, two_word_map, map_bytes, items_bytes};
        port_541_0_q[28:26] <= add_159[5:3];
        port_541_0_q[25:14] <= {end_mask, to_end, 3'd0};
        port_541_0_q[30] <= ~begins;
        words_valid_q <= complete;
      end
      if (free) begin
        port_541_0_q[29] <= step_angular_y;
        port_541_0_q[32:31] <= {error_sig != STATUS_OK, 1'b0};
      end
      served_0 <= served_0_next;
      served_1 <= (served_1 | go_angular_z) & ~complete;
      if (complete && step_angular_y) begin
        error_sig <= STATUS_OK;
        status_payload_q <= error_sig;
      end
      if (status_ready) begin
        status_valid_q <= 1'b0;
      end
      if (complete && step_angular_y) begin
        status_valid_q <= 1'b1;
      end
      if (complete) begin
        begun <= begins & ~step_angular_y;
        if (step_angular_y) begin
          step_linear_x <= 1'b1;
          step_linear_x_2 <= 1'b0;
          step_linear_y <= 1'b0;
          step_linear_z <= 1'b0;
          step_angular_x <= 1'b0;
          step_angular_y <= 1'b0;
          map_bytes <= 4'd8;
          items_bytes <= 4'd0;
          two_word_map <= 1'b0;
        end else begin
          step_linear_x <= 1'b0;
          step_linear_x_2 <= step_linear_x;
          step_linear_y <= step_linear_x_2;
          step_linear_z <= step_linear_y;
          step_angular_x <= step_linear_z;
          step_angular_y <= step_angular_x;
          map_bytes <= {step_linear_x | step_linear_x_2 | step_linear_y | step_linear_z,
              step_angular_x, 2'd0};
          items_bytes <= {step_angular_x, 3'd0};
          two_word_map <= step_angular_x;
        end
        if (step_angular_y) begin
          rest <= 1'b0;
          has_nul <= 1'b0;
        end
      end
      words_last <= words_last;
      words_less <= words_less;
    end
  end

  always @(posedge aclk) begin
    if (free && (!step_angular_y || !served_0)) begin
      items_0 <= message_angular_y_payload[63:32];
    end
    if (free && (!step_angular_y || !served_1)) begin
      items_4 <= message_angular_z_payload[31:0];
    end
    if (free && !or_120) begin
      map_0 <= map_0_next;
    end
    if (free) begin
      map_4 <= or_152 | (step_angular_x ? message_angular_y_payload[31:0] : 32'd0);
    end
  end

  assign port_537_0 = {map_4, map_0, items_4, items_0};
  assign message_angular_z_ready = go_angular_z;

  assign port_541_0 = port_541_0_q;
  assign status_valid = status_valid_q;
  assign status_payload = status_payload_q;
  assign words_valid = words_valid_q;

  assign length_zero = 1'b0;
  assign length_skips = 1'b0;
  assign length_over = 1'b0;
  assign words_payload = {port_541_0_q, map_4, map_0, items_4, items_0};
  assign to_map = {1'b0, to_map_0};
  assign length_rest = 1'b0;
  assign length_at_most_one_pass = 1'b0;
  assign words_loads = 1'b0;
  assign done = 1'b1;
  assign ends = step_angular_y;
  assign go_linear_x = message_linear_x_ready;
  assign go_linear_y = message_linear_y_ready;
  assign go_linear_z = message_linear_z_ready;
  assign go_angular_x = message_angular_x_ready;
  assign go_angular_y = message_angular_y_ready;
  assign items_size = items_bytes;
  assign to_body = 1'b0;
  assign words_down = 1'b0;
  assign words_keeps = 1'b1;
  assign words_is_small = 1'b1;
  assign words_is_2 = 1'b0;
  assign words_is_3 = 1'b0;
  assign words_is_4 = 1'b0;
  assign found = error_sig;
  assign words_pending = 1'b0;
  assign words_value = 3'd0;
endmodule

// Packer: Write words to a ring of beats, and send the beats that are complete.
module geometry_msgs_msg_Twist_cdr_8_serializer_verilog_core_packer (
  input wire         rst,
  input wire         aclk,
  input wire         packets_ready,
  input wire [127:0] words_payload_0,
  input wire [32:0]  words_payload_128,
  input wire         words_valid,
  output wire        words_ready,
  output wire        packets_valid,
  output wire [68:0] packets_payload,
  output wire        error_sig
);

  // Registers.
  reg words_ready_q = 1'b1;
  reg packets_valid_q = 1'b0;
  reg [68:0] packets_payload_q = 69'd0;
  reg error_sig_q = 1'b0;
  reg writes = 1'b0;
  reg [63:0] items_0_write_data = 64'd0;
  reg [6:0] items_start = 7'd0;
  reg [3:0] items_size = 4'd0;
  reg [63:0] map_placed = 64'd0;
  reg [6:0] map_start = 7'd0;
  reg [3:0] map_size = 4'd0;
  reg [6:0] at = 7'd0;
  reg [3:0] complete_next = 4'd0;
  reg ends_packet = 1'b0;
  reg failed = 1'b0;
  reg waits = 1'b0;
  reg [3:0] last_bytes = 4'd0;
  reg [3:0] bound = 4'd5;
  reg [3:0] complete = 4'd0;
  reg [7:0] last = 8'd0;
  reg [7:0] items_0_has = 8'd0;
  reg [7:0] map_0_has = 8'd0;
  reg [7:0] map_4_has = 8'd0;
  reg [3:0] first = 4'd0;

  // Combinational signals.
  wire takes;
  wire [6:0] total;
  wire [6:0] total_6;
  wire [6:0] base;
  wire [6:0] end_sig;
  wire [3:0] add_13;
  wire [6:0] map_end;
  wire [3:0] newest;
  wire [3:0] room;
  wire [2:0] ends_write_addr;
  wire ends_write_en;
  wire items_used_0;
  wire items_0_written;
  wire map_used_0;
  wire map_0_written;
  wire map_used_4;
  wire map_4_written;
  wire reads;
  wire is_last;
  wire and_43;
  wire and_46;
  wire and_50;
  wire and_54;
  wire and_58;
  wire and_62;
  wire and_66;
  wire and_70;
  wire and_74;
  wire [4:0] ends_read_data;
  wire [63:0] items_0_read_data;
  wire [31:0] map_0_read_data;
  wire [31:0] map_4_read_data;
  wire [63:0] words_payload_items;
  wire [63:0] words_payload_map;
  wire [3:0] words_payload_items_bytes;
  wire [3:0] words_payload_map_bytes;
  wire words_payload_two_word_map;
  wire [4:0] words_payload_to_map;
  wire [2:0] words_payload_map_mask;
  wire [5:0] words_payload_to_end;
  wire [2:0] words_payload_end_mask;
  wire [2:0] words_payload_max_beats;
  wire words_payload_last;
  wire words_payload_empty;
  wire words_payload_waits;
  wire words_payload_error;
  wire [3:0] ends_read_data_count;
  wire ends_read_data_error;

  // Signals that no logic reads, for simulation.
  wire [160:0] words_payload;
  wire [6:0] map_at;
  wire ready;
  wire [2:0] items_index_0;
  wire [2:0] items_slot_0;
  wire [2:0] items_0_write_addr;
  wire [63:0] items_placed;
  wire items_0_write_en;
  wire [2:0] items_0_read_addr;
  wire [2:0] map_index_0;
  wire [2:0] map_slot_0;
  wire [2:0] map_0_write_addr;
  wire [31:0] map_0_write_data;
  wire map_0_write_en;
  wire [2:0] map_0_read_addr;
  wire [2:0] map_index_4;
  wire [2:0] map_slot_4;
  wire [2:0] map_4_write_addr;
  wire [31:0] map_4_write_data;
  wire map_4_write_en;
  wire [2:0] map_4_read_addr;
  wire [2:0] ends_read_addr;
  wire [68:0] payload;
  wire [4:0] ends_write_data;

  reg [4:0] ends [0:7];
  integer ends_at;
  initial begin
    for (ends_at = 0; ends_at < 8; ends_at = ends_at + 1)
      ends[ends_at] = 5'd0;
  end

  reg [63:0] items_0 [0:7];
  integer items_0_at;
  initial begin
    for (items_0_at = 0; items_0_at < 8; items_0_at = items_0_at + 1)
      items_0[items_0_at] = 64'd0;
  end

  reg [31:0] map_0 [0:7];
  integer map_0_at;
  initial begin
    for (map_0_at = 0; map_0_at < 8; map_0_at = map_0_at + 1)
      map_0[map_0_at] = 32'd0;
  end

  reg [31:0] map_4 [0:7];
  integer map_4_at;
  initial begin
    for (map_4_at = 0; map_4_at < 8; map_4_at = map_4_at + 1)
      map_4[map_4_at] = 32'd0;
  end

  assign takes = words_valid & words_ready_q;
  assign total = at + {2'd0, words_payload_to_map};
  assign total_6 = base + {1'd0, words_payload_to_end};
  assign base = (total & ~{4'd0, words_payload_map_mask}) | {4'd0, words_payload_map_mask & 3'd4};
  assign end_sig = (total_6 & ~{4'd0, words_payload_end_mask}) | {4'd0, words_payload_end_mask &
      (words_payload_last ? 3'd0 : 3'd4)};
  assign add_13 = base[6:3] + {3'd0, words_payload_two_word_map};
  assign map_end = {add_13, base[2:0]} + {3'd0, words_payload_map_bytes};
  assign newest = at[6:3] + {1'd0, takes ? words_payload_max_beats : 3'd0};
  assign room = bound - newest;
  assign ends_write_addr = complete_next[2:0] - 3'd1;
  assign ends_write_en = writes & ends_packet;
  assign items_used_0 = writes & (items_size > 4'd0);
  assign items_0_written = items_0_has[first[2:0]];
  assign map_used_0 = writes & (map_size > 4'd0);
  assign map_0_written = map_0_has[first[2:0]];
  assign map_used_4 = writes & (map_size > 4'd4);
  assign map_4_written = map_4_has[first[2:0]];
  assign reads = (complete != first) & (~packets_valid_q | packets_ready);
  assign is_last = last[first[2:0]];
  assign and_43 = writes & ~waits;
  assign and_46 = reads & (first[2:0] == 3'd0);
  assign and_50 = reads & (first[2:0] == 3'd1);
  assign and_54 = reads & (first[2:0] == 3'd2);
  assign and_58 = reads & (first[2:0] == 3'd3);
  assign and_62 = reads & (first[2:0] == 3'd4);
  assign and_66 = reads & (first[2:0] == 3'd5);
  assign and_70 = reads & (first[2:0] == 3'd6);
  assign and_74 = reads & (first[2:0] == 3'd7);

  always @(posedge aclk) begin
    if (ends_write_en) begin
      ends[ends_write_addr] <= {failed, last_bytes};
    end
  end
  assign ends_read_data = ends[first[2:0]];

  always @(posedge aclk) begin
    if (items_used_0) begin
      items_0[items_start[5:3]] <= items_0_write_data;
    end
  end
  assign items_0_read_data = items_0[first[2:0]];

  always @(posedge aclk) begin
    if (map_used_0) begin
      map_0[map_start[5:3]] <= map_placed[31:0];
    end
  end
  assign map_0_read_data = map_0[first[2:0]];

  always @(posedge aclk) begin
    if (map_used_4) begin
      map_4[map_start[5:3]] <= map_placed[63:32];
    end
  end
  assign map_4_read_data = map_4[first[2:0]];

  always @(posedge aclk) begin
    if (rst) begin
      writes <= 1'b0;
      items_start <= 7'd0;
      items_size <= 4'd0;
      map_start <= 7'd0;
      map_size <= 4'd0;
      at <= 7'd0;
      complete_next <= 4'd0;
      ends_packet <= 1'b0;
      failed <= 1'b0;
      waits <= 1'b0;
      last_bytes <= 4'd0;
      words_ready_q <= 1'b1;
      bound <= 4'd5;
      complete <= 4'd0;
      last <= 8'd0;
      items_0_has <= 8'd0;
      map_0_has <= 8'd0;
      map_4_has <= 8'd0;
      packets_valid_q <= 1'b0;
      first <= 4'd0;
    end else begin
      writes <= takes;
      if (takes) begin
        if (words_payload_two_word_map) begin
          items_start <= base;
        end else begin
          items_start <= at;
        end
        items_size <= words_payload_items_bytes;
        map_start <= {add_13, base[2:0]};
        map_size <= words_payload_map_bytes;
        at <= end_sig;
        complete_next <= end_sig[6:3];
        ends_packet <= words_payload_last;
        failed <= words_payload_error;
        waits <= words_payload_waits;
        if (words_payload_empty) begin
          last_bytes <= 4'd0;
        end else begin
          last_bytes <= {1'd0, map_end[2:0] - 3'd1} + 4'd1;
        end
      end
      words_ready_q <= ~room[3];
      if (reads) begin
        bound <= bound + 4'd1;
        first <= first + 4'd1;
      end
      if (and_43) begin
        complete <= complete_next;
        if (ends_packet) begin
          case (ends_write_addr)
            3'd0: last[0] <= 1'b1;
            3'd1: last[1] <= 1'b1;
            3'd2: last[2] <= 1'b1;
            3'd3: last[3] <= 1'b1;
            3'd4: last[4] <= 1'b1;
            3'd5: last[5] <= 1'b1;
            3'd6: last[6] <= 1'b1;
            3'd7: last[7] <= 1'b1;
            default: ;
          endcase
        end
      end
      if (reads) begin
        case (first[2:0])
          3'd0: last[0] <= 1'b0;
          3'd1: last[1] <= 1'b0;
          3'd2: last[2] <= 1'b0;
          3'd3: last[3] <= 1'b0;
          3'd4: last[4] <= 1'b0;
          3'd5: last[5] <= 1'b0;
          3'd6: last[6] <= 1'b0;
          3'd7: last[7] <= 1'b0;
          default: ;
        endcase
      end
      if (and_46) begin
        items_0_has[0] <= 1'b0;
      end else if (items_used_0 && (items_start[5:3] == 3'd0)) begin
        items_0_has[0] <= 1'b1;
      end
      if (and_50) begin
        items_0_has[1] <= 1'b0;
      end else if (items_used_0 && (items_start[5:3] == 3'd1)) begin
        items_0_has[1] <= 1'b1;
      end
      if (and_54) begin
        items_0_has[2] <= 1'b0;
      end else if (items_used_0 && (items_start[5:3] == 3'd2)) begin
        items_0_has[2] <= 1'b1;
      end
      if (and_58) begin
        items_0_has[3] <= 1'b0;
      end else if (items_used_0 && (items_start[5:3] == 3'd3)) begin
        items_0_has[3] <= 1'b1;
      end
      if (and_62) begin
        items_0_has[4] <= 1'b0;
      end else if (items_used_0 && (items_start[5:3] == 3'd4)) begin
        items_0_has[4] <= 1'b1;
      end
      if (and_66) begin
        items_0_has[5] <= 1'b0;
      end else if (items_used_0 && (items_start[5:3] == 3'd5)) begin
        items_0_has[5] <= 1'b1;
      end
      if (and_70) begin
        items_0_has[6] <= 1'b0;
      end else if (items_used_0 && (items_start[5:3] == 3'd6)) begin
        items_0_has[6] <= 1'b1;
      end
      if (and_74) begin
        items_0_has[7] <= 1'b0;
      end else if (items_used_0 && (items_start[5:3] == 3'd7)) begin
        items_0_has[7] <= 1'b1;
      end
      if (and_46) begin
        map_0_has[0] <= 1'b0;
      end else if (map_used_0 && (map_start[5:3] == 3'd0)) begin
        map_0_has[0] <= 1'b1;
      end
      if (and_50) begin
        map_0_has[1] <= 1'b0;
      end else if (map_used_0 && (map_start[5:3] == 3'd1)) begin
        map_0_has[1] <= 1'b1;
      end
      if (and_54) begin
        map_0_has[2] <= 1'b0;
      end else if (map_used_0 && (map_start[5:3] == 3'd2)) begin
        map_0_has[2] <= 1'b1;
      end
      if (and_58) begin
        map_0_has[3] <= 1'b0;
      end else if (map_used_0 && (map_start[5:3] == 3'd3)) begin
        map_0_has[3] <= 1'b1;
      end
      if (and_62) begin
        map_0_has[4] <= 1'b0;
      end else if (map_used_0 && (map_start[5:3] == 3'd4)) begin
        map_0_has[4] <= 1'b1;
      end
      if (and_66) begin
        map_0_has[5] <= 1'b0;
      end else if (map_used_0 && (map_start[5:3] == 3'd5)) begin
        map_0_has[5] <= 1'b1;
      end
      if (and_70) begin
        map_0_has[6] <= 1'b0;
      end else if (map_used_0 && (map_start[5:3] == 3'd6)) begin
        map_0_has[6] <= 1'b1;
      end
      if (and_74) begin
        map_0_has[7] <= 1'b0;
      end else if (map_used_0 && (map_start[5:3] == 3'd7)) begin
        map_0_has[7] <= 1'b1;
      end
      if (and_46) begin
        map_4_has[0] <= 1'b0;
      end else if (map_used_4 && (map_start[5:3] == 3'd0)) begin
        map_4_has[0] <= 1'b1;
      end
      if (and_50) begin
        map_4_has[1] <= 1'b0;
      end else if (map_used_4 && (map_start[5:3] == 3'd1)) begin
        map_4_has[1] <= 1'b1;
      end
      if (and_54) begin
        map_4_has[2] <= 1'b0;
      end else if (map_used_4 && (map_start[5:3] == 3'd2)) begin
        map_4_has[2] <= 1'b1;
      end
      if (and_58) begin
        map_4_has[3] <= 1'b0;
      end else if (map_used_4 && (map_start[5:3] == 3'd3)) begin
        map_4_has[3] <= 1'b1;
      end
      if (and_62) begin
        map_4_has[4] <= 1'b0;
      end else if (map_used_4 && (map_start[5:3] == 3'd4)) begin
        map_4_has[4] <= 1'b1;
      end
      if (and_66) begin
        map_4_has[5] <= 1'b0;
      end else if (map_used_4 && (map_start[5:3] == 3'd5)) begin
        map_4_has[5] <= 1'b1;
      end
      if (and_70) begin
        map_4_has[6] <= 1'b0;
      end else if (map_used_4 && (map_start[5:3] == 3'd6)) begin
        map_4_has[6] <= 1'b1;
      end
      if (and_74) begin
        map_4_has[7] <= 1'b0;
      end else if (map_used_4 && (map_start[5:3] == 3'd7)) begin
        map_4_has[7] <= 1'b1;
      end
      if (packets_ready) begin
        packets_valid_q <= 1'b0;
      end
      if (reads) begin
        packets_valid_q <= 1'b1;
      end
    end
  end

  always @(posedge aclk) begin
    if (takes) begin
      items_0_write_data <= words_payload_items;
      map_placed <= words_payload_map;
    end
    if (reads) begin
      packets_payload_q[63:0] <= {(items_0_written ? items_0_read_data[63:32] : 32'd0) |
          (map_4_written ? map_4_read_data : 32'd0), (items_0_written ? items_0_read_data[31:0] :
          32'd0) | (map_0_written ? map_0_read_data : 32'd0)};
      packets_payload_q[68] <= is_last;
      if (is_last) begin
        packets_payload_q[67:64] <= ends_read_data_count;
      end else begin
        packets_payload_q[67:64] <= 4'd8;
      end
      error_sig_q <= is_last & ends_read_data_error;
    end
  end

  assign words_payload_items = words_payload_0[63:0];
  assign words_payload_map = words_payload_0[127:64];
  assign words_payload_items_bytes = words_payload_128[3:0];
  assign words_payload_map_bytes = words_payload_128[7:4];
  assign words_payload_two_word_map = words_payload_128[8];
  assign words_payload_to_map = words_payload_128[13:9];
  assign words_payload_map_mask = words_payload_128[16:14];
  assign words_payload_to_end = words_payload_128[22:17];
  assign words_payload_end_mask = words_payload_128[25:23];
  assign words_payload_max_beats = words_payload_128[28:26];
  assign words_payload_last = words_payload_128[29];
  assign words_payload_empty = words_payload_128[30];
  assign words_payload_waits = words_payload_128[31];
  assign words_payload_error = words_payload_128[32];
  assign ends_read_data_count = ends_read_data[3:0];
  assign ends_read_data_error = ends_read_data[4];

  assign words_ready = words_ready_q;
  assign packets_valid = packets_valid_q;
  assign packets_payload = packets_payload_q;
  assign error_sig = error_sig_q;

  assign words_payload = {words_payload_128, words_payload_0};
  assign map_at = {add_13, base[2:0]};
  assign ready = words_ready_q;
  assign items_index_0 = 3'd0;
  assign items_slot_0 = items_start[5:3];
  assign items_0_write_addr = items_start[5:3];
  assign items_placed = items_0_write_data;
  assign items_0_write_en = items_used_0;
  assign items_0_read_addr = first[2:0];
  assign map_index_0 = 3'd0;
  assign map_slot_0 = map_start[5:3];
  assign map_0_write_addr = map_start[5:3];
  assign map_0_write_data = map_placed[31:0];
  assign map_0_write_en = map_used_0;
  assign map_0_read_addr = first[2:0];
  assign map_index_4 = 3'd4;
  assign map_slot_4 = map_start[5:3];
  assign map_4_write_addr = map_start[5:3];
  assign map_4_write_data = map_placed[63:32];
  assign map_4_write_en = map_used_4;
  assign map_4_read_addr = first[2:0];
  assign ends_read_addr = first[2:0];
  assign payload = packets_payload_q;
  assign ends_write_data = {failed, last_bytes};
endmodule

// Serializer: Turn messages into packets.
module geometry_msgs_msg_Twist_cdr_8_serializer_verilog_core (
  input wire         rst,
  input wire         aclk,
  input wire         packets_ready,
  input wire [63:0]  message_linear_x_payload,
  input wire         message_linear_x_valid,
  input wire [63:0]  message_linear_y_payload,
  input wire         message_linear_y_valid,
  input wire [63:0]  message_linear_z_payload,
  input wire         message_linear_z_valid,
  input wire [63:0]  message_angular_x_payload,
  input wire         message_angular_x_valid,
  input wire [63:0]  message_angular_y_payload,
  input wire         message_angular_y_valid,
  input wire [63:0]  message_angular_z_payload,
  input wire         message_angular_z_valid,
  input wire         status_ready,
  output wire        message_linear_x_ready,
  output wire        message_linear_y_ready,
  output wire        message_linear_z_ready,
  output wire        message_angular_x_ready,
  output wire        message_angular_y_ready,
  output wire        message_angular_z_ready,
  output wire        status_valid,
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  output wire [2:0]  status_payload,
  output wire        packets_valid,
  output wire [68:0] packets_payload,
  output wire        packet_error
);

  // Combinational signals.
  wire [127:0] words_payload_0;
  wire [32:0] words_payload_128;
  wire words_valid;
  wire words_ready;

  // Signals that no logic reads, for simulation.
  wire [160:0] words_payload;
  wire [160:0] words_payload_1;
  wire error_sig;

  geometry_msgs_msg_Twist_cdr_8_serializer_verilog_core_collector collector (
    .aclk                      (aclk),
    .message_linear_x_payload  (message_linear_x_payload),
    .message_linear_x_valid    (message_linear_x_valid),
    .message_linear_y_payload  (message_linear_y_payload),
    .message_linear_y_valid    (message_linear_y_valid),
    .message_linear_z_payload  (message_linear_z_payload),
    .message_linear_z_valid    (message_linear_z_valid),
    .message_angular_x_payload (message_angular_x_payload),
    .message_angular_x_valid   (message_angular_x_valid),
    .message_angular_y_payload (message_angular_y_payload),
    .message_angular_y_valid   (message_angular_y_valid),
    .message_angular_z_payload (message_angular_z_payload),
    .message_angular_z_valid   (message_angular_z_valid),
    .status_ready              (status_ready),
    .rst                       (rst),
    .message_linear_x_ready    (message_linear_x_ready),
    .message_linear_y_ready    (message_linear_y_ready),
    .message_linear_z_ready    (message_linear_z_ready),
    .message_angular_x_ready   (message_angular_x_ready),
    .message_angular_y_ready   (message_angular_y_ready),
    .message_angular_z_ready   (message_angular_z_ready),
    .port_537_0                (words_payload_0),
    .port_541_0                (words_payload_128),
    .status_valid              (status_valid),
    .status_payload            (status_payload),
    .words_valid               (words_valid),
    .words_ready               (words_ready)
  );

  geometry_msgs_msg_Twist_cdr_8_serializer_verilog_core_packer packer (
    .aclk              (aclk),
    .packets_ready     (packets_ready),
    .rst               (rst),
    .words_payload_0   (words_payload_0),
    .words_payload_128 (words_payload_128),
    .words_valid       (words_valid),
    .words_ready       (words_ready),
    .packets_valid     (packets_valid),
    .packets_payload   (packets_payload),
    .error_sig         (packet_error)
  );

  assign words_payload = {words_payload_128, words_payload_0};
  assign words_payload_1 = {words_payload_128, words_payload_0};
  assign error_sig = packet_error;
endmodule

// Top: A converter with AXI4-Stream on its packet side and named ports on its message side.
module geometry_msgs_msg_Twist_cdr_8_serializer_verilog (
  input wire         aclk,
  input wire         aresetn,
  input wire         m_axis_tready,
  input wire [63:0]  linear_x_data,
  input wire         linear_x_valid,
  input wire [63:0]  linear_y_data,
  input wire         linear_y_valid,
  input wire [63:0]  linear_z_data,
  input wire         linear_z_valid,
  input wire [63:0]  angular_x_data,
  input wire         angular_x_valid,
  input wire [63:0]  angular_y_data,
  input wire         angular_y_valid,
  input wire [63:0]  angular_z_data,
  input wire         angular_z_valid,
  input wire         m_axis_status_tready,
  output wire [63:0] m_axis_tdata,
  output wire [7:0]  m_axis_tkeep,
  output wire        m_axis_tlast,
  output wire        m_axis_tuser,
  output wire        m_axis_tvalid,
  output wire        linear_x_ready,
  output wire        linear_y_ready,
  output wire        linear_z_ready,
  output wire        angular_x_ready,
  output wire        angular_y_ready,
  output wire        angular_z_ready,
  output wire [7:0]  m_axis_status_tdata,
  output wire        m_axis_status_tvalid
);

  // Combinational signals.
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  wire [2:0] status_payload;
  wire [68:0] packets_payload;
  wire rst;
  wire [3:0] packets_payload_count;

  // Signals that no logic reads, for simulation.
  wire packet_error;
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

  geometry_msgs_msg_Twist_cdr_8_serializer_verilog_core core (
    .aclk                      (aclk),
    .packets_ready             (m_axis_tready),
    .message_linear_x_payload  (linear_x_data),
    .message_linear_x_valid    (linear_x_valid),
    .message_linear_y_payload  (linear_y_data),
    .message_linear_y_valid    (linear_y_valid),
    .message_linear_z_payload  (linear_z_data),
    .message_linear_z_valid    (linear_z_valid),
    .message_angular_x_payload (angular_x_data),
    .message_angular_x_valid   (angular_x_valid),
    .message_angular_y_payload (angular_y_data),
    .message_angular_y_valid   (angular_y_valid),
    .message_angular_z_payload (angular_z_data),
    .message_angular_z_valid   (angular_z_valid),
    .status_ready              (m_axis_status_tready),
    .rst                       (rst),
    .message_linear_x_ready    (linear_x_ready),
    .message_linear_y_ready    (linear_y_ready),
    .message_linear_z_ready    (linear_z_ready),
    .message_angular_x_ready   (angular_x_ready),
    .message_angular_y_ready   (angular_y_ready),
    .message_angular_z_ready   (angular_z_ready),
    .status_valid              (m_axis_status_tvalid),
    .status_payload            (status_payload),
    .packets_valid             (m_axis_tvalid),
    .packets_payload           (packets_payload),
    .packet_error              (m_axis_tuser)
  );

  assign rst = ~aresetn;

  assign m_axis_tdata = packets_payload[63:0];
  assign m_axis_tkeep = {packets_payload_count > 4'd7, packets_payload_count > 4'd6,
      packets_payload_count > 4'd5, packets_payload_count > 4'd4, packets_payload_count > 4'd3,
      packets_payload_count > 4'd2, packets_payload_count > 4'd1, packets_payload_count > 4'd0};
  assign m_axis_tlast = packets_payload[68];
  assign m_axis_status_tdata = {5'd0, status_payload};
  assign packets_payload_count = packets_payload[67:64];

  assign packet_error = m_axis_tuser;
  assign packets_valid = m_axis_tvalid;
  assign packets_ready = m_axis_tready;
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
endmodule
