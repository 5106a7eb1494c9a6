// geometry_msgs_msg_Twist_cdr_8_serializer_verilog: the serializer of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
// lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
// definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
// What each port means: manifest.json.
// Steps, as `firm-hdl plan --program` prints them.
// One line a step: its number and name, what it takes, and where it leads. A step is one cycle.
// "map": bytes at fixed places, at most two bus words. "items": a bus word of a string or an
// array, which is a run of them. "rest": the last items of a run, which the next step takes
// before its map; "rest x 8": of 8 bytes each. "lanes": the bytes of the bus, from 0 on. "unit
// 4": bytes start and end at multiples of 4. "body": the step after a length that more than a
// rest follows. "level 0": the outermost sequence of elements; "while level 0": while it has
// elements left. "to 2 (+8)": the last byte of step 2 is 8 bytes after that of this step; with
// "align 4 | 3", then down to a multiple of 4, and 3 more: from byte 21, "+6, align 4 | 3" leads
// to byte 27. "a.length:0..3": bytes 0 to 3 of a leaf, from the first lane on.
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
//
// Leaves are taken in wire order, each as soon as it is offered. A length is decoded in the cycle
// before it is taken, so it is taken one cycle after it is offered at the earliest. Latency 1
// cycle from the last leaf of a state to the state's words. Throughput one state per cycle:
//
//     cycle              | 0        | 1         | 2
//     length.valid       | 1        | 1         |
//     known              |          | 1         |
//     length.ready       |          | 1         |
//     complete           |          | 1         |
//     words.valid        |          |           | 1
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
  output wire [127:0] words_payload_0,  // bits: items(63:0) map(127:64)
  // bits: items_bytes(3:0) map_bytes(7:4) two_word_map(8) to_map(13:9) map_mask(16:14)
  // to_end(22:17) end_mask(25:23) max_beats(28:26) last(29) empty(30) waits(31) error(32)
  output wire [32:0]  words_payload_128,
  output wire         status_valid,
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  output wire [2:0]   status_payload,
  output wire         words_valid,
  input wire          words_ready
);
  localparam [2:0] STATUS_OK = 3'd0;

  // Registers.
  reg [32:0] words_payload_128_q = 33'd0;  // bits as of words_payload_128_q
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
  reg words_last = 1'b1;  // one is left
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
  wire lacks_any;
  wire free;
  wire complete;
  wire serves_0;
  wire items_0_writes;
  wire items_4_writes;
  wire map_0_writes_part;
  wire map_0_writes;
  wire [4:0] map_size;
  wire begins;
  wire [3:0] to_map_0;
  wire [7:0] most_bytes;
  wire moves_on;
  wire [5:0] to_end;
  wire [2:0] end_mask;

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
  assign lacks_any = lacks_linear_x | lacks_linear_y | lacks_linear_z | lacks_angular_x |
      lacks_angular_y | lacks_angular_z | (step_linear_x & ~message_linear_x_valid) |
      (step_linear_x_2 & ~message_linear_y_valid) | (step_linear_y & ~message_linear_z_valid) |
      (step_linear_z & ~message_angular_x_valid) | (step_angular_x & ~message_angular_y_valid);
  assign free = ~words_valid_q | words_ready;
  assign complete = free & ~lacks_any & (~step_angular_y | ~status_valid_q | status_ready);
  assign serves_0 = message_linear_x_ready | message_linear_y_ready | message_linear_z_ready |
      message_angular_x_ready | message_angular_y_ready;
  assign items_0_writes = free & ~(step_angular_y & served_0);
  assign items_4_writes = free & ~(step_angular_y & served_1);
  assign map_0_writes_part = ((step_linear_x_2 | step_linear_y | step_linear_z | step_angular_x) &
      served_0) | (step_angular_y & served_1);
  assign map_0_writes = free & ~map_0_writes_part;
  assign map_size = {1'd0, map_bytes} + {1'd0, two_word_map ? 4'd8 : 4'd0};
  assign begins = begun | (|items_bytes) | (|map_bytes);
  assign to_map_0 = two_word_map ? 4'd0 : items_bytes;
  assign most_bytes = {1'd0, {2'd0, 1'b0, to_map_0} + {1'd0, to_end}} + 8'd7;
  assign moves_on = complete & ~step_angular_y;

  assign to_end = step_angular_y ? (begins ? ({1'd0, map_size} + 6'd7) : 6'd8) :
      {1'b0, map_size};

  assign end_mask = step_angular_y ? 3'd7 :
      3'd0;

  always @(posedge aclk) begin
    if (rst) begin
      words_payload_128_q <= 33'd0;
      served_0 <= 1'b0;
      served_1 <= 1'b0;
      error_sig <= 3'd0;
      status_valid_q <= 1'b0;
      status_payload_q <= 3'd0;
      begun <= 1'b0;
      words_valid_q <= 1'b0;
      words_last <= 1'b1;
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
        words_payload_128_q[13:0] <= {1'b0, to_map_0, two_word_map, map_bytes, items_bytes};
        words_payload_128_q[28:26] <= most_bytes[5:3];
        words_payload_128_q[25:14] <= {end_mask, to_end, 3'd0};
        words_payload_128_q[30] <= ~begins;
        words_valid_q <= complete;
      end
      if (free) begin
        words_payload_128_q[29] <= step_angular_y;
        words_payload_128_q[32:31] <= {error_sig != STATUS_OK, 1'b0};
      end
      served_0 <= (served_0 | serves_0) & ~complete;
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
    end
  end

  always @(posedge aclk) begin
    if (items_0_writes) begin
      items_0 <= message_angular_y_payload[63:32];
    end
    if (items_4_writes) begin
      items_4 <= message_angular_z_payload[31:0];
    end
    if (map_0_writes) begin
      map_0 <= (step_linear_x ? 32'd256 : 32'd0) | (step_linear_x_2 ?
          message_linear_x_payload[63:32] : 32'd0) | (step_linear_y ?
          message_linear_y_payload[63:32] : 32'd0) | (step_linear_z ?
          message_linear_z_payload[63:32] : 32'd0) | (step_angular_x ?
          message_angular_x_payload[63:32] : 32'd0) | (step_angular_y ?
          message_angular_z_payload[63:32] : 32'd0);
    end
    if (free) begin
      map_4 <= (step_linear_x ? message_linear_x_payload[31:0] : 32'd0) | (step_linear_x_2 ?
          message_linear_y_payload[31:0] : 32'd0) | (step_linear_y ?
          message_linear_z_payload[31:0] : 32'd0) | (step_linear_z ?
          message_angular_x_payload[31:0] : 32'd0) | (step_angular_x ?
          message_angular_y_payload[31:0] : 32'd0);
    end
  end

  assign words_payload_0 = {map_4, map_0, items_4, items_0};
  assign message_angular_z_ready = go_angular_z;

  assign words_payload_128 = words_payload_128_q;
  assign status_valid = status_valid_q;
  assign status_payload = status_payload_q;
  assign words_valid = words_valid_q;
endmodule

// Packer: Write words to a ring of beats, and send the beats that are complete.
//
// Throughput two words in and one beat out per cycle; latency 3 cycles:
//
//     cycle          | 0                  | 1            | 2          | 3
//     words          | valid, ready       |              |            |
//     they are       | placed and rotated | written      |            |
//     beat           |                    | complete     | read       | packets.valid
module geometry_msgs_msg_Twist_cdr_8_serializer_verilog_core_packer (
  input wire         rst,
  input wire         aclk,
  input wire         packets_ready,
  input wire [127:0] words_payload_0,  // bits: items(63:0) map(127:64)
  // bits: items_bytes(3:0) map_bytes(7:4) two_word_map(8) to_map(13:9) map_mask(16:14)
  // to_end(22:17) end_mask(25:23) max_beats(28:26) last(29) empty(30) waits(31) error(32)
  input wire [32:0]  words_payload_128,
  input wire         words_valid,
  output wire        words_ready,
  output wire        packets_valid,
  output wire [68:0] packets_payload,  // bits: data(63:0) count(67:64) last(68)
  output wire        error_sig
);

  // Registers.
  reg ready = 1'b1;
  reg packets_valid_q = 1'b0;
  reg [68:0] payload = 69'd0;  // bits: data(63:0) count(67:64) last(68)
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
  wire [3:0] map_beat;
  wire [6:0] total;
  wire [6:0] total_8;
  wire [6:0] base;
  wire [6:0] end_sig;
  wire [6:0] map_end;
  wire [6:0] items_at;
  wire [3:0] newest;
  wire [3:0] room;
  wire [2:0] ends_write_addr;
  wire ends_write_en;
  wire commits;
  wire frees_slot_0;
  wire frees_slot_1;
  wire frees_slot_2;
  wire frees_slot_3;
  wire frees_slot_4;
  wire frees_slot_5;
  wire frees_slot_6;
  wire frees_slot_7;
  wire items_used_0;
  wire items_0_written;
  wire map_used_0;
  wire map_0_written;
  wire map_used_4;
  wire map_4_written;
  wire reads;
  wire is_last;
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

  assign takes = words_valid & ready;
  assign map_beat = base[6:3] + {3'd0, words_payload_two_word_map};
  assign total = at + {2'd0, words_payload_to_map};
  assign total_8 = base + {1'd0, words_payload_to_end};
  assign base = (total & ~{4'd0, words_payload_map_mask}) | {4'd0, words_payload_map_mask & 3'd4};
  assign end_sig = (total_8 & ~{4'd0, words_payload_end_mask}) | {4'd0, words_payload_end_mask &
      (words_payload_last ? 3'd0 : 3'd4)};
  assign map_end = {map_beat, base[2:0]} + {3'd0, words_payload_map_bytes};
  assign items_at = words_payload_two_word_map ? base : at;
  assign newest = at[6:3] + {1'd0, takes ? words_payload_max_beats : 3'd0};
  assign room = bound - newest;
  assign ends_write_addr = complete_next[2:0] - 3'd1;
  assign ends_write_en = writes & ends_packet;
  assign commits = writes & ~waits;
  assign frees_slot_0 = reads & (first[2:0] == 3'd0);
  assign frees_slot_1 = reads & (first[2:0] == 3'd1);
  assign frees_slot_2 = reads & (first[2:0] == 3'd2);
  assign frees_slot_3 = reads & (first[2:0] == 3'd3);
  assign frees_slot_4 = reads & (first[2:0] == 3'd4);
  assign frees_slot_5 = reads & (first[2:0] == 3'd5);
  assign frees_slot_6 = reads & (first[2:0] == 3'd6);
  assign frees_slot_7 = reads & (first[2:0] == 3'd7);
  assign items_used_0 = writes & (items_size > 4'd0);
  assign items_0_written = items_0_has[first[2:0]];
  assign map_used_0 = writes & (map_size > 4'd0);
  assign map_0_written = map_0_has[first[2:0]];
  assign map_used_4 = writes & (map_size > 4'd4);
  assign map_4_written = map_4_has[first[2:0]];
  assign reads = (complete != first) & (~packets_valid_q | packets_ready);
  assign is_last = last[first[2:0]];

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
      ready <= 1'b1;
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
        items_start <= items_at;
        items_size <= words_payload_items_bytes;
        map_start <= {map_beat, base[2:0]};
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
      ready <= ~room[3];
      if (reads) begin
        bound <= bound + 4'd1;
        first <= first + 4'd1;
      end
      if (commits) begin
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
      if (frees_slot_0) begin
        items_0_has[0] <= 1'b0;
      end else if (items_used_0 && (items_start[5:3] == 3'd0)) begin
        items_0_has[0] <= 1'b1;
      end
      if (frees_slot_1) begin
        items_0_has[1] <= 1'b0;
      end else if (items_used_0 && (items_start[5:3] == 3'd1)) begin
        items_0_has[1] <= 1'b1;
      end
      if (frees_slot_2) begin
        items_0_has[2] <= 1'b0;
      end else if (items_used_0 && (items_start[5:3] == 3'd2)) begin
        items_0_has[2] <= 1'b1;
      end
      if (frees_slot_3) begin
        items_0_has[3] <= 1'b0;
      end else if (items_used_0 && (items_start[5:3] == 3'd3)) begin
        items_0_has[3] <= 1'b1;
      end
      if (frees_slot_4) begin
        items_0_has[4] <= 1'b0;
      end else if (items_used_0 && (items_start[5:3] == 3'd4)) begin
        items_0_has[4] <= 1'b1;
      end
      if (frees_slot_5) begin
        items_0_has[5] <= 1'b0;
      end else if (items_used_0 && (items_start[5:3] == 3'd5)) begin
        items_0_has[5] <= 1'b1;
      end
      if (frees_slot_6) begin
        items_0_has[6] <= 1'b0;
      end else if (items_used_0 && (items_start[5:3] == 3'd6)) begin
        items_0_has[6] <= 1'b1;
      end
      if (frees_slot_7) begin
        items_0_has[7] <= 1'b0;
      end else if (items_used_0 && (items_start[5:3] == 3'd7)) begin
        items_0_has[7] <= 1'b1;
      end
      if (frees_slot_0) begin
        map_0_has[0] <= 1'b0;
      end else if (map_used_0 && (map_start[5:3] == 3'd0)) begin
        map_0_has[0] <= 1'b1;
      end
      if (frees_slot_1) begin
        map_0_has[1] <= 1'b0;
      end else if (map_used_0 && (map_start[5:3] == 3'd1)) begin
        map_0_has[1] <= 1'b1;
      end
      if (frees_slot_2) begin
        map_0_has[2] <= 1'b0;
      end else if (map_used_0 && (map_start[5:3] == 3'd2)) begin
        map_0_has[2] <= 1'b1;
      end
      if (frees_slot_3) begin
        map_0_has[3] <= 1'b0;
      end else if (map_used_0 && (map_start[5:3] == 3'd3)) begin
        map_0_has[3] <= 1'b1;
      end
      if (frees_slot_4) begin
        map_0_has[4] <= 1'b0;
      end else if (map_used_0 && (map_start[5:3] == 3'd4)) begin
        map_0_has[4] <= 1'b1;
      end
      if (frees_slot_5) begin
        map_0_has[5] <= 1'b0;
      end else if (map_used_0 && (map_start[5:3] == 3'd5)) begin
        map_0_has[5] <= 1'b1;
      end
      if (frees_slot_6) begin
        map_0_has[6] <= 1'b0;
      end else if (map_used_0 && (map_start[5:3] == 3'd6)) begin
        map_0_has[6] <= 1'b1;
      end
      if (frees_slot_7) begin
        map_0_has[7] <= 1'b0;
      end else if (map_used_0 && (map_start[5:3] == 3'd7)) begin
        map_0_has[7] <= 1'b1;
      end
      if (frees_slot_0) begin
        map_4_has[0] <= 1'b0;
      end else if (map_used_4 && (map_start[5:3] == 3'd0)) begin
        map_4_has[0] <= 1'b1;
      end
      if (frees_slot_1) begin
        map_4_has[1] <= 1'b0;
      end else if (map_used_4 && (map_start[5:3] == 3'd1)) begin
        map_4_has[1] <= 1'b1;
      end
      if (frees_slot_2) begin
        map_4_has[2] <= 1'b0;
      end else if (map_used_4 && (map_start[5:3] == 3'd2)) begin
        map_4_has[2] <= 1'b1;
      end
      if (frees_slot_3) begin
        map_4_has[3] <= 1'b0;
      end else if (map_used_4 && (map_start[5:3] == 3'd3)) begin
        map_4_has[3] <= 1'b1;
      end
      if (frees_slot_4) begin
        map_4_has[4] <= 1'b0;
      end else if (map_used_4 && (map_start[5:3] == 3'd4)) begin
        map_4_has[4] <= 1'b1;
      end
      if (frees_slot_5) begin
        map_4_has[5] <= 1'b0;
      end else if (map_used_4 && (map_start[5:3] == 3'd5)) begin
        map_4_has[5] <= 1'b1;
      end
      if (frees_slot_6) begin
        map_4_has[6] <= 1'b0;
      end else if (map_used_4 && (map_start[5:3] == 3'd6)) begin
        map_4_has[6] <= 1'b1;
      end
      if (frees_slot_7) begin
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
      payload[63:0] <= {(items_0_written ? items_0_read_data[63:32] : 32'd0) | (map_4_written ?
          map_4_read_data : 32'd0), (items_0_written ? items_0_read_data[31:0] : 32'd0) |
          (map_0_written ? map_0_read_data : 32'd0)};
      payload[68] <= is_last;
      if (is_last) begin
        payload[67:64] <= ends_read_data_count;
      end else begin
        payload[67:64] <= 4'd8;
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

  assign words_ready = ready;
  assign packets_valid = packets_valid_q;
  assign packets_payload = payload;
  assign error_sig = error_sig_q;
endmodule

// Serializer: Turn messages into packets.
//
// Leaves are taken in wire order, several in one cycle if they are valid. No leaf waits for a
// later one. A length is taken one cycle after it is offered at the earliest. The serializer adds
// the lengths on the wire, padding and terminators. A beat is valid `LATENCY_CYCLES["serializer"]`
// cycles after the last leaf of the step that fills it. The `ready` of a leaf depends
// combinationally on its own `valid` and on that of the earlier leaves of the same step; all other
// outputs are registers. One clock domain, `sync`; its reset discards all messages and packets
// inside.
//
// Each packet ends in one transfer on `status`. A length over its bound is written unchanged, and
// as many items are taken as it says. The packet is marked with an error, so that the receiver can
// drop it. `length` decides how many items are taken; an `items.last` that disagrees marks the
// packet with an error.
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
  output wire [68:0] packets_payload,  // bits: data(63:0) count(67:64) last(68)
  output wire        packet_error
);

  // Combinational signals.
  wire [127:0] words_payload_0;
  wire [32:0] words_payload_128;
  wire words_valid;
  wire words_ready;

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
    .words_payload_0           (words_payload_0),
    .words_payload_128         (words_payload_128),
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
endmodule

// Top: A converter with AXI4-Stream on its packet side and named ports on its message side.
//
// The top level adds neither registers nor latency. `aresetn` is active low and synchronous to the
// rising edge of `aclk`; one cycle of reset discards all packets and messages inside. A last beat
// without any ones in ``tkeep`` adds no bytes, so it can end an empty packet.
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
endmodule
