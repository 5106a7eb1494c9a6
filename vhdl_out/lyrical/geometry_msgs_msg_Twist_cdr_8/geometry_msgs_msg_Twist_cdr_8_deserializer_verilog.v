// geometry_msgs_msg_Twist_cdr_8_deserializer_verilog: the deserializer of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
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
// deserializer: start 0, items from lane 0, unit 8, map from lane 0, unit 4
//   0 linear_x: map of 8; begins linear.x; checks 0=00 1=01; to 1 (+8)
//   1 linear_x_2: map of 8; linear.x; begins linear.y; to 2 (+8)
//   2 linear_y: map of 8; linear.y; begins linear.z; to 3 (+8)
//   3 linear_z: map of 8; linear.z; begins angular.x; to 4 (+8)
//   4 angular_x: map of 8; angular.x; begins angular.y; to 5 (+12)
//   5 angular_y: map of 12 in two words; angular.y angular.z; to end (+0)
//   6 packet_end: end of the packet

// Buffer: Give each beat a position in the ring; tell how many bytes of the current packet
// arrived.
//
// The buffer itself stores no bytes: its readers write `beat` to memories of their own, and read
// it from the next cycle on. The sequencer stores decoded lengths and flags, the mover the bytes.
//
// Latency 1 cycle from `packets` to `arrival.beat`, and 2 cycles to `arrival.limit`.
module geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_buffer (
  input wire         rst,
  input wire         aclk,
  input wire         packets_valid,
  input wire         arrival_next,
  input wire [3:0]   freed,
  input wire [68:0]  packets_payload,  // bits: data(63:0) count(67:64) last(68)
  output wire [73:0] arrival_beat,  // bits: data(63:0) count(67:64) last(68) at(72:69) valid(73)
  output wire        packets_ready,
  output wire [6:0]  arrival_limit,
  output wire [3:0]  arrival_following,
  output wire        arrival_ended
);

  // Registers.
  reg room = 1'b1;
  reg [6:0] arrival_limit_q = 7'd0;
  reg [3:0] arrival_following_q = 4'd0;
  reg arrival_ended_q = 1'b0;
  reg full = 1'b0;
  reg [68:0] payload = 69'd0;  // bits as of packets_payload
  reg [3:0] arrived = 4'd0;
  reg [3:0] at = 4'd0;
  // the end of the packet after the current one; bits: limit(6:0) following(10:7)
  reg [10:0] second = 11'd0;
  reg has_second = 1'b0;
  reg [3:0] pushed = 4'd0;  // ends stored in the memory, modulo 2 laps
  reg [3:0] popped = 4'd0;  // ends taken out of it, modulo 2 laps

  // Combinational signals.
  wire arrives;
  wire [3:0] used;
  wire [3:0] end_following;
  wire ends_now;
  wire [6:0] end_limit;
  wire [6:0] newest_limit;
  wire stored;
  wire [10:0] first;
  wire more;
  wire follows;
  wire takes_first;
  wire has_second_next;
  wire [10:0] ends_read_data;
  wire [3:0] payload_count;
  wire payload_last;
  wire [6:0] first_limit;
  wire [3:0] first_following;

  reg [10:0] ends [0:7];
  integer ends_at;
  initial begin
    for (ends_at = 0; ends_at < 8; ends_at = ends_at + 1)
      ends[ends_at] = 11'd0;
  end

  assign arrives = packets_valid & room;
  assign used = arrived - freed;
  assign end_following = at + 4'd1;
  assign ends_now = full & payload_last;
  assign end_limit = {at, 3'd0} + {3'd0, payload_count};
  assign newest_limit = ends_now ? end_limit : {full ? end_following : at, 3'd0};
  assign stored = pushed != popped;
  assign first = has_second ? second : {end_following, newest_limit};
  assign more = stored | ends_now;
  assign follows = arrival_ended_q & ends_now;
  assign takes_first = arrival_next | ~arrival_ended_q;
  assign has_second_next = has_second ? (~arrival_next | more) : (~arrival_next & follows);

  always @(posedge aclk) begin
    ends[pushed[2:0]] <= {end_following, end_limit};
  end
  assign ends_read_data = ends[popped[2:0]];

  always @(posedge aclk) begin
    if (rst) begin
      full <= 1'b0;
      arrived <= 4'd0;
      at <= 4'd0;
      room <= 1'b1;
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
      room <= ~used[3] & ~((used == 4'd7) & arrives);
      if (takes_first) begin
        arrival_limit_q <= first_limit;
        arrival_following_q <= first_following;
        arrival_ended_q <= has_second | ends_now;
      end
      if (arrival_next || !has_second) begin
        if (stored) begin
          second <= ends_read_data;
        end else begin
          second <= {end_following, end_limit};
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

  assign payload_count = payload[67:64];
  assign payload_last = payload[68];
  assign first_limit = first[6:0];
  assign first_following = first[10:7];
  assign arrival_beat = {full, at, payload};

  assign packets_ready = room;
  assign arrival_limit = arrival_limit_q;
  assign arrival_following = arrival_following_q;
  assign arrival_ended = arrival_ended_q;
endmodule

// ByteFlags: Flags of the packet buffer: one for each byte, and those of headers for each beat.
//
// Whether a beat is that of a header is not known as it arrives. So every beat is compared with
// the checked bytes of each header state, and the sequencer reads the flag of the right beat.
//
// Flags are written together with their beat, and read combinationally.
module geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_sequencer_byte_flags (
  input wire        rst,
  input wire        aclk,
  output wire       mismatch,
  input wire [73:0] beat,  // bits: data(63:0) count(67:64) last(68) at(72:69) valid(73)
  input wire [3:0]  header_at
);

  // Combinational signals.
  wire headers_table_write_data;
  wire [63:0] beat_data;
  wire [3:0] beat_count;
  wire beat_last;
  wire [3:0] beat_at;
  wire beat_valid;

  reg [0:0] headers_table [0:7];
  integer headers_table_at;
  initial begin
    for (headers_table_at = 0; headers_table_at < 8; headers_table_at = headers_table_at + 1)
      headers_table[headers_table_at] = 1'b0;
  end

  assign headers_table_write_data = ((beat_data[7:0] != 8'd0) & (~beat_last |
      (beat_count > 4'd0))) | ((beat_data[15:8] != 8'd1) & (~beat_last | (beat_count > 4'd1)));

  always @(posedge aclk) begin
    if (beat_valid) begin
      headers_table[beat_at[2:0]] <= headers_table_write_data;
    end
  end
  assign mismatch = headers_table[header_at[2:0]];

  assign beat_data = beat[63:0];
  assign beat_count = beat[67:64];
  assign beat_last = beat[68];
  assign beat_at = beat[72:69];
  assign beat_valid = beat[73];
endmodule

// Sequencer: Run a program over the packets in the buffer: check them, and give orders to the
// mover.
//
// Each state gives one order, once all its bytes are in the buffer. The sequencer waits only for
// bytes and for `orders.ready`. The last order of a packet carries its status. The page "How the
// converters work" follows one packet through all cycles.
//
// An error in the bytes of a state takes two cycles: one finds it, and one computes which bytes
// are good. Then the state is ordered with its good bytes. All later states are ordered without
// bytes and with lengths of 0, and the rest of the packet is dropped:
//
//     cycle         | 0        | 1         | 2            | 3
//     state         | s        | s         | s            | next one
//     found         | 1        |           |              |
//     bad           |          | 1         | 1            | 1
//     new_error     |          | 1         |              |
//     *_room        |          |           | good bytes   | 0
//     orders.valid  |          |           | s            | next one
//
// A length over its limit takes no cycle: its state transfers it as 0.
//
// A length that is charged to the Budget stalls the sequencer before the next state. Its
// order waits, too. If the length claims too much, its order transfers it as 0, and the sequencer
// goes back to the length's state, and leaves it with an order that has no state:
//
//     cycle         | 0        | 1         | 2         | 3         | 4           | 5
//     state         | length   | body      | body      | body      | body        | length
//     pending       |          | 1         | 1         | 1         | 1           |
//     zero_length   |          |           |           |           | 1           |
//     orders.valid  | length   |           |           |           |             | blank
module geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_sequencer (
  input wire         rst,
  input wire         aclk,
  output wire        orders_valid,
  output wire        arrival_next,
  input wire         orders_ready,
  input wire [73:0]  beat,  // bits: data(63:0) count(67:64) last(68) at(72:69) valid(73)
  input wire [6:0]   arrival_limit,
  input wire [3:0]   arrival_following,
  input wire         arrival_ended,
  // bits: step(2:0) blank(3) items_at(9:4) map_at(15:10) items_next(18:16) map_next(21:19)
  // items_bytes(25:22) map_bytes(29:26) items(30) last(31) length_good(32) final(33) first(37:34)
  // ends(38) status(41:39)
  output wire [41:0] orders_payload,
  output wire [3:0]  header_at
);
  localparam [2:0] STATUS_OK = 3'd0;
  localparam [2:0] STATUS_TRUNCATED = 3'd1;
  localparam [2:0] STATUS_TRAILING = 3'd2;
  localparam [2:0] STATUS_LENGTH = 3'd3;
  localparam [2:0] STATUS_ENCAPSULATION = 3'd4;
  localparam [2:0] STATUS_STRING = 3'd5;

  // Registers.
  reg bad = 1'b0;
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  reg [2:0] code = 3'd0;
  reg new_error = 1'b0;
  reg [3:0] items_room = 4'd0;
  reg [3:0] map_room = 4'd0;
  reg rest = 1'b0;  // items in the rest of the run
  reg has_nul = 1'b0;
  reg [6:0] first_at = 7'd0;  // first byte after the step before
  reg [6:0] last_at = 7'd7;  // last byte of the step's map or word
  reg words_last = 1'b1;  // one is left
  reg step_linear_x = 1'b1;  // step 0: map of 8; begins linear.x
  reg step_linear_x_2 = 1'b0;  // step 1: map of 8; linear.x; begins linear.y
  reg step_linear_y = 1'b0;  // step 2: map of 8; linear.y; begins linear.z
  reg step_linear_z = 1'b0;  // step 3: map of 8; linear.z; begins angular.x
  reg step_angular_x = 1'b0;  // step 4: map of 8; angular.x; begins angular.y
  reg step_angular_y = 1'b0;  // step 5: map of 12 in two words; angular.y angular.z
  reg step_packet_end = 1'b0;  // step 6: end of the packet
  reg at_end = 1'b0;  // the message is over, but not the packet
  reg [4:0] map_offset = 5'd25;  // signed: first byte of the map's last word, relative to last_at
  reg two_word_map = 1'b0;  // the map has two bus words
  reg [5:0] exit_add = 6'd8;  // bytes from last_at to the last byte of the step after it

  // Combinational signals.
  wire mismatch;
  wire [6:0] not_last_at;  // -1 - last_at
  wire [6:0] step_end;
  wire [6:0] left;
  wire present;
  wire ends_message;
  wire ends_packet;
  wire header_error;
  wire cut;
  wire trailing;
  wire bytes_good;
  wire stops;
  wire drains;
  wire length_accepted;
  wire allowed;
  wire issue;
  wire [3:0] first_beat_of_map;
  wire [6:0] map_at;
  wire [5:0] one_less_map_offset;  // 1 - map_offset, signed
  wire [5:0] map_left_carries;  // of the sum of three numbers, bit by bit; one addition is left
  wire [6:0] map_left_without_carries;
  wire [6:0] map_left;  // signed: limit - map_at
  wire [3:0] map_room_if_cut;
  wire [6:0] items_left;
  wire [3:0] rest_room_if_cut;
  wire [3:0] items_room_if_cut;
  wire bad_drained;
  wire [2:0] orders_payload_items_next;
  wire [2:0] orders_payload_map_next;
  wire [3:0] orders_payload_items_bytes;
  wire [3:0] orders_payload_map_bytes;
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  wire [2:0] orders_payload_status;
  wire [6:0] exit_sum;
  wire [6:0] last_at_of_next_packet;  // its first step ends 7 bytes after its first byte
  wire [6:0] early_last_at;
  wire [6:0] first_at_if_bad;
  wire moves_on;
  wire map_offset_next_3;  // also map_offset_next_4
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  wire [2:0] good_status;
  wire [5:0] orders_payload_map_at;

  geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_sequencer_byte_flags byte_flags (
    .aclk      (aclk),
    .rst       (rst),
    .mismatch  (mismatch),
    .beat      (beat),
    .header_at (first_at[6:3])
  );

  assign not_last_at = ~last_at;
  assign step_end = last_at + 7'd1;
  assign left = arrival_limit + not_last_at;
  assign present = ~left[6];
  assign ends_message = at_end | step_angular_y;
  assign ends_packet = ends_message & arrival_ended;
  assign header_error = step_linear_x & mismatch & (arrival_limit != first_at);
  assign cut = arrival_ended & ~present;
  assign trailing = present & (|left[5:2]);
  assign bytes_good = present & ~(step_linear_x & mismatch);
  assign stops = header_error | cut | (ends_message & ~arrival_ended & trailing);
  assign drains = bad & ~new_error & (~at_end | arrival_ended);
  assign length_accepted = ~bad;
  assign allowed = length_accepted & (~ends_message | arrival_ended);
  assign orders_valid = drains | (allowed & bytes_good);
  assign issue = (drains & orders_ready) | (allowed & orders_ready & bytes_good);
  assign arrival_next = (drains & orders_ready & ends_packet) | (allowed & orders_ready &
      ends_packet & bytes_good);
  assign first_beat_of_map = map_at[6:3] - {3'd0, two_word_map};
  assign map_at = last_at + {{2{map_offset[4]}}, map_offset};
  assign one_less_map_offset = 6'd1 - {{1{map_offset[4]}}, map_offset};
  assign map_left_carries = (arrival_limit[5:0] & not_last_at[5:0]) | (arrival_limit[5:0] &
      one_less_map_offset) | (not_last_at[5:0] & one_less_map_offset);
  assign map_left_without_carries = arrival_limit ^ not_last_at ^ {one_less_map_offset[5],
      one_less_map_offset};
  assign map_left = map_left_without_carries + {map_left_carries, 1'b0};
  assign map_room_if_cut = map_left[6] ? 4'd0 : ((map_left >= 7'd8) ? 4'd8 : map_left[3:0]);
  assign items_left = arrival_limit - first_at;
  assign rest_room_if_cut = items_left[6] ? 4'd0 : ((items_left >= 7'd8) ? 4'd8 : items_left[3:0]);
  assign items_room_if_cut = two_word_map ? (map_left[6] ? {1'b0, (&map_left[6:3]) ? map_left[2:0] :
      3'd0} : 4'd8) : map_room_if_cut;
  assign bad_drained = bad & drains & orders_ready;
  assign orders_payload_items_next = first_beat_of_map[2:0] + 3'd1;
  assign orders_payload_map_next = orders_payload_map_at[5:3] + 3'd1;
  assign orders_payload_items_bytes = (bad && (items_room < 4'd8)) ? items_room : 4'd8;
  assign orders_payload_map_bytes = bad ? map_room : 4'd8;
  assign orders_payload_status = bad ? code : good_status;
  assign exit_sum = last_at + {1'd0, exit_add};
  assign last_at_of_next_packet = {arrival_following, 3'd0} + 7'd7;
  assign early_last_at = ends_packet ? last_at_of_next_packet : exit_sum;
  assign first_at_if_bad = at_end ? arrival_limit : first_at;
  assign moves_on = issue & ~ends_packet;
  assign map_offset_next_3 = step_linear_x | step_linear_x_2 | step_linear_y | step_linear_z |
      step_angular_x;

  assign good_status = trailing ? STATUS_TRAILING :
      STATUS_OK;

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
      step_linear_x <= 1'b1;
      step_linear_x_2 <= 1'b0;
      step_linear_y <= 1'b0;
      step_linear_z <= 1'b0;
      step_angular_x <= 1'b0;
      step_angular_y <= 1'b0;
      step_packet_end <= 1'b0;
      at_end <= 1'b0;
      map_offset <= 5'd25;
      two_word_map <= 1'b0;
      exit_add <= 6'd8;
    end else begin
      if (issue && ends_packet) begin
        bad <= 1'b0;
      end else if (length_accepted) begin
        bad <= stops;
        if (ends_message) begin
          code <= STATUS_TRAILING;
        end else begin
          code <= STATUS_LENGTH;
        end
        if (header_error) begin
          code <= STATUS_ENCAPSULATION;
        end else if (cut) begin
          code <= STATUS_TRUNCATED;
        end
      end
      new_error <= stops & length_accepted;
      if (bad && new_error) begin
        if ((code == STATUS_TRAILING) || (code == STATUS_STRING)) begin
          items_room <= 4'd8;
        end else begin
          items_room <= 4'd0;
        end
        if (code == STATUS_TRUNCATED) begin
          items_room <= items_room_if_cut;
        end
        if (code == STATUS_TRAILING) begin
          map_room <= 4'd8;
        end else begin
          map_room <= 4'd0;
        end
        if (code == STATUS_TRUNCATED) begin
          map_room <= map_room_if_cut;
        end
      end else if (bad_drained) begin
        items_room <= 4'd0;
        map_room <= 4'd0;
      end
      if (issue) begin
        if (ends_packet) begin
          rest <= 1'b0;
          has_nul <= 1'b0;
        end
        last_at <= early_last_at;
        if (ends_packet) begin
          step_linear_x <= 1'b1;
          step_linear_x_2 <= 1'b0;
          step_linear_y <= 1'b0;
          step_linear_z <= 1'b0;
          step_angular_x <= 1'b0;
          step_angular_y <= 1'b0;
          step_packet_end <= 1'b0;
          at_end <= 1'b0;
          map_offset <= 5'd25;
          two_word_map <= 1'b0;
          exit_add <= 6'd8;
        end else begin
          step_linear_x <= 1'b0;
          step_linear_x_2 <= step_linear_x;
          step_linear_y <= step_linear_x_2;
          step_linear_z <= step_linear_y;
          step_angular_x <= step_linear_z;
          step_angular_y <= step_angular_x;
          step_packet_end <= step_angular_y;
          at_end <= step_angular_y;
          map_offset <= {{2{map_offset_next_3}}, step_angular_x, 1'b0, step_linear_x |
              step_linear_x_2 | step_linear_y | step_linear_z | step_angular_x | step_angular_y};
          two_word_map <= step_angular_x;
          exit_add <= {2'd0, step_linear_x | step_linear_x_2 | step_linear_y | step_linear_z,
              step_linear_z, 2'd0};
        end
      end
      if (issue || (bad && at_end)) begin
        if (ends_packet) begin
          first_at <= {arrival_following, 3'd0};
        end else begin
          if (bad) begin
            first_at <= first_at_if_bad;
          end else begin
            first_at <= step_end;
          end
        end
      end
      words_last <= words_last;
    end
  end

  assign header_at = first_at[6:3];
  assign orders_payload_map_at = map_at[5:0];
  assign orders_payload = {orders_payload_status, ends_packet, first_at[6:3], 1'b0, length_accepted,
      words_last, 1'b0, orders_payload_map_bytes, orders_payload_items_bytes,
      orders_payload_map_next, orders_payload_items_next, map_at[5:0], first_beat_of_map[2:0],
      map_at[2:0], at_end, step_angular_x | step_angular_y, step_linear_y | step_linear_z,
      step_linear_x_2 | step_linear_z | step_angular_y};
endmodule

// OrderQueue: A queue of two orders, so that `i.ready` is a register.
module geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_queue (
  input wire         rst,
  input wire         aclk,
  input wire         i_valid,
  output wire        i_ready,
  output wire [3:0]  freed,
  input wire         o_ready,
  // bits: step(2:0) blank(3) items_at(9:4) map_at(15:10) items_next(18:16) map_next(21:19)
  // items_bytes(25:22) map_bytes(29:26) items(30) last(31) length_good(32) final(33) first(37:34)
  // ends(38) status(41:39)
  input wire [41:0]  i_payload,
  input wire [3:0]   oldest,
  output wire        o_valid,
  output wire [41:0] o_payload  // bits as of i_payload
);

  // Registers.
  reg o_valid_q = 1'b0;
  reg [41:0] o_payload_q = 42'd0;  // bits as of i_payload
  reg has_second = 1'b0;
  reg [41:0] second = 42'd0;  // the order that came while o was waiting; bits as of i_payload

  // Combinational signals.
  wire [3:0] second_first;
  wire [3:0] o_payload_first;

  assign i_ready = ~has_second;
  assign freed = o_valid_q ? o_payload_first : (has_second ? second_first : oldest);

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
    if (i_ready) begin
      second <= i_payload;
    end
  end

  assign second_first = second[37:34];
  assign o_payload_first = o_payload_q[37:34];

  assign o_valid = o_valid_q;
  assign o_payload = o_payload_q;
endmodule

// Mover: Read two words of the packet buffer per order, and write leaves from their lanes.
//
// One cycle reads the words and rotates their first bytes to lane 0; the next cycle writes the
// leaves. So a leaf is valid 2 cycles after its order. Leaves of a state become valid in wire
// order, each as soon as its register is free. A leaf whose register is full delays only later
// leaves:
//
//     cycle           | 0        | 1             | 2
//     orders          | a        | b             | c
//     words           |          | of a          | of b
//     leaves of a     |          | are written   | valid
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
  input wire [73:0]  beat,  // bits: data(63:0) count(67:64) last(68) at(72:69) valid(73)
  input wire         orders_valid,
  // bits: step(2:0) blank(3) items_at(9:4) map_at(15:10) items_next(18:16) map_next(21:19)
  // items_bytes(25:22) map_bytes(29:26) items(30) last(31) length_good(32) final(33) first(37:34)
  // ends(38) status(41:39)
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
  localparam [2:0] STEP_LINEAR_X = 3'd0;
  localparam [2:0] STEP_LINEAR_X_2 = 3'd1;
  localparam [2:0] STEP_LINEAR_Y = 3'd2;
  localparam [2:0] STEP_LINEAR_Z = 3'd3;
  localparam [2:0] STEP_ANGULAR_X = 3'd4;
  localparam [2:0] STEP_ANGULAR_Y = 3'd5;

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
  reg [63:0] payload_linear_x = 64'd0;
  reg [63:0] payload_linear_y = 64'd0;
  reg [63:0] payload_linear_z = 64'd0;
  reg [63:0] payload_angular_x = 64'd0;
  reg [63:0] payload_angular_y = 64'd0;
  reg [63:0] payload_angular_z = 64'd0;
  reg length_good = 1'b0;
  reg last = 1'b0;
  reg [63:0] items_word = 64'd0;
  reg [7:0] items_good = 8'd0;  // bit k: byte k of the word is good; else its value is written as 0
  reg [63:0] map_word = 64'd0;
  reg [7:0] map_good = 8'd0;  // bit k: byte k of the word is good; else its value is written as 0
  reg begins_linear_x = 1'b0;
  reg [31:0] carried = 32'd0;
  reg begins_linear_x_2 = 1'b0;
  reg begins_linear_y = 1'b0;
  reg begins_linear_z = 1'b0;
  reg begins_angular_x = 1'b0;
  reg active_linear_x = 1'b0;
  reg active_linear_y = 1'b0;
  reg active_linear_z = 1'b0;
  reg active_angular_x = 1'b0;
  reg active_angular_y = 1'b0;
  reg active_angular_z = 1'b0;
  reg ends_now = 1'b0;
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  reg [2:0] status_now = 3'd0;
  reg slow = 1'b0;  // a leaf of the order that is executed, or the status, is full

  // Combinational signals.
  wire full_linear_x;
  wire full_linear_y;
  wire full_linear_z;
  wire full_angular_x;
  wire full_angular_y;
  wire full_angular_z;
  wire status_full;
  wire has_step;
  wire chosen_step_linear_x_2;
  wire blocked_linear_x;
  wire go_linear_x;
  wire chosen_step_linear_y;
  wire blocked_linear_y;
  wire go_linear_y;
  wire chosen_step_linear_z;
  wire blocked_linear_z;
  wire go_linear_z;
  wire chosen_step_angular_x;
  wire blocked_angular_x;
  wire go_angular_x;
  wire chosen_step_angular_y;
  wire blocked_angular_y;
  wire go_angular_y;
  wire blocked_angular_z;
  wire go_angular_z;
  wire ends;
  wire next_order_is_slow;
  wire order_stays_slow;
  wire carried_part;
  wire carried_part_2;
  wire carried_part_3;
  wire carried_part_4;
  wire carried_part_5;
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
  wire [63:0] beat_data;
  wire [3:0] beat_at;
  wire beat_valid;
  // 0 LINEAR_X, 1 LINEAR_X_2, 2 LINEAR_Y, 3 LINEAR_Z, 4 ANGULAR_X, 5 ANGULAR_Y
  wire [2:0] orders_payload_step;
  wire orders_payload_blank;
  wire [5:0] orders_payload_items_at;
  wire [5:0] orders_payload_map_at;
  wire [3:0] orders_payload_items_bytes;
  wire [3:0] orders_payload_map_bytes;
  wire orders_payload_last;
  wire orders_payload_length_good;
  wire orders_payload_ends;
  // 0 OK, 1 TRUNCATED, 2 TRAILING, 3 LENGTH, 4 ENCAPSULATION, 5 STRING, 6 ITEMS
  wire [2:0] orders_payload_status;

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

  assign full_linear_x = message_linear_x_valid_q & ~message_linear_x_ready;
  assign full_linear_y = message_linear_y_valid_q & ~message_linear_y_ready;
  assign full_linear_z = message_linear_z_valid_q & ~message_linear_z_ready;
  assign full_angular_x = message_angular_x_valid_q & ~message_angular_x_ready;
  assign full_angular_y = message_angular_y_valid_q & ~message_angular_y_ready;
  assign full_angular_z = message_angular_z_valid_q & ~message_angular_z_ready;
  assign status_full = status_valid_q & ~status_ready;
  assign has_step = orders_valid & ~orders_payload_blank;
  assign chosen_step_linear_x_2 = has_step & (orders_payload_step == STEP_LINEAR_X_2);
  assign blocked_linear_x = active_linear_x & message_linear_x_valid_q;
  assign go_linear_x = active_linear_x & ~blocked_linear_x;
  assign chosen_step_linear_y = has_step & (orders_payload_step == STEP_LINEAR_Y);
  assign blocked_linear_y = active_linear_y & message_linear_y_valid_q;
  assign go_linear_y = active_linear_y & ~blocked_linear_y;
  assign chosen_step_linear_z = has_step & (orders_payload_step == STEP_LINEAR_Z);
  assign blocked_linear_z = active_linear_z & message_linear_z_valid_q;
  assign go_linear_z = active_linear_z & ~blocked_linear_z;
  assign chosen_step_angular_x = has_step & (orders_payload_step == STEP_ANGULAR_X);
  assign blocked_angular_x = active_angular_x & message_angular_x_valid_q;
  assign go_angular_x = active_angular_x & ~blocked_angular_x;
  assign chosen_step_angular_y = has_step & (orders_payload_step == STEP_ANGULAR_Y);
  assign blocked_angular_y = active_angular_y & message_angular_y_valid_q;
  assign go_angular_y = active_angular_y & ~blocked_angular_y;
  assign blocked_angular_z = active_angular_z & message_angular_z_valid_q;
  assign go_angular_z = active_angular_z & ~blocked_angular_z & ~blocked_angular_y;
  assign ends = orders_valid & orders_payload_ends;
  assign next_order_is_slow = (chosen_step_linear_x_2 & full_linear_x) | (chosen_step_linear_y &
      full_linear_y) | (chosen_step_linear_z & full_linear_z) | (chosen_step_angular_x &
      full_angular_x) | (chosen_step_angular_y & full_angular_y) | (chosen_step_angular_y &
      full_angular_z) | (ends & status_full);
  assign order_stays_slow = (blocked_linear_x & ~message_linear_x_ready) | (blocked_linear_y &
      ~message_linear_y_ready) | (blocked_linear_z & ~message_linear_z_ready) | (blocked_angular_x &
      ~message_angular_x_ready) | (blocked_angular_y & ~message_angular_y_ready) |
      (blocked_angular_z & ~message_angular_z_ready) | (ends_now & status_full);
  assign orders_ready = ~slow;
  assign carried_part = orders_ready & begins_linear_x;
  assign carried_part_2 = orders_ready & begins_linear_x_2;
  assign carried_part_3 = orders_ready & begins_linear_y;
  assign carried_part_4 = orders_ready & begins_linear_z;
  assign carried_part_5 = orders_ready & begins_angular_x;

  always @(posedge aclk) begin
    if (beat_valid) begin
      lane_0[beat_at[2:0]] <= beat_data[7:0];
    end
  end
  assign lane_0_items_data = lane_0[orders_payload_items_at[5:3]];
  assign lane_0_map_data = lane_0[orders_payload_map_at[5:3]];

  always @(posedge aclk) begin
    if (beat_valid) begin
      lane_1[beat_at[2:0]] <= beat_data[15:8];
    end
  end
  assign lane_1_items_data = lane_1[orders_payload_items_at[5:3]];
  assign lane_1_map_data = lane_1[orders_payload_map_at[5:3]];

  always @(posedge aclk) begin
    if (beat_valid) begin
      lane_2[beat_at[2:0]] <= beat_data[23:16];
    end
  end
  assign lane_2_items_data = lane_2[orders_payload_items_at[5:3]];
  assign lane_2_map_data = lane_2[orders_payload_map_at[5:3]];

  always @(posedge aclk) begin
    if (beat_valid) begin
      lane_3[beat_at[2:0]] <= beat_data[31:24];
    end
  end
  assign lane_3_items_data = lane_3[orders_payload_items_at[5:3]];
  assign lane_3_map_data = lane_3[orders_payload_map_at[5:3]];

  always @(posedge aclk) begin
    if (beat_valid) begin
      lane_4[beat_at[2:0]] <= beat_data[39:32];
    end
  end
  assign lane_4_items_data = lane_4[orders_payload_items_at[5:3]];
  assign lane_4_map_data = lane_4[orders_payload_map_at[5:3]];

  always @(posedge aclk) begin
    if (beat_valid) begin
      lane_5[beat_at[2:0]] <= beat_data[47:40];
    end
  end
  assign lane_5_items_data = lane_5[orders_payload_items_at[5:3]];
  assign lane_5_map_data = lane_5[orders_payload_map_at[5:3]];

  always @(posedge aclk) begin
    if (beat_valid) begin
      lane_6[beat_at[2:0]] <= beat_data[55:48];
    end
  end
  assign lane_6_items_data = lane_6[orders_payload_items_at[5:3]];
  assign lane_6_map_data = lane_6[orders_payload_map_at[5:3]];

  always @(posedge aclk) begin
    if (beat_valid) begin
      lane_7[beat_at[2:0]] <= beat_data[63:56];
    end
  end
  assign lane_7_items_data = lane_7[orders_payload_items_at[5:3]];
  assign lane_7_map_data = lane_7[orders_payload_map_at[5:3]];

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
      begins_linear_x <= 1'b0;
      begins_linear_x_2 <= 1'b0;
      begins_linear_y <= 1'b0;
      begins_linear_z <= 1'b0;
      begins_angular_x <= 1'b0;
      active_linear_x <= 1'b0;
      active_linear_y <= 1'b0;
      active_linear_z <= 1'b0;
      active_angular_x <= 1'b0;
      active_angular_y <= 1'b0;
      active_angular_z <= 1'b0;
      ends_now <= 1'b0;
      status_now <= 3'd0;
      status_payload_q <= 3'd0;
      slow <= 1'b0;
    end else begin
      if (message_linear_x_ready) begin
        message_linear_x_valid_q <= 1'b0;
      end
      if (go_linear_x) begin
        message_linear_x_valid_q <= 1'b1;
      end
      if (message_linear_y_ready) begin
        message_linear_y_valid_q <= 1'b0;
      end
      if (go_linear_y) begin
        message_linear_y_valid_q <= 1'b1;
      end
      if (message_linear_z_ready) begin
        message_linear_z_valid_q <= 1'b0;
      end
      if (go_linear_z) begin
        message_linear_z_valid_q <= 1'b1;
      end
      if (message_angular_x_ready) begin
        message_angular_x_valid_q <= 1'b0;
      end
      if (go_angular_x) begin
        message_angular_x_valid_q <= 1'b1;
      end
      if (message_angular_y_ready) begin
        message_angular_y_valid_q <= 1'b0;
      end
      if (go_angular_y) begin
        message_angular_y_valid_q <= 1'b1;
      end
      if (message_angular_z_ready) begin
        message_angular_z_valid_q <= 1'b0;
      end
      if (go_angular_z) begin
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
        length_good <= orders_payload_length_good;
        last <= orders_payload_last;
        begins_linear_x <= orders_valid & ~orders_payload_blank &
            (orders_payload_step == STEP_LINEAR_X);
        begins_linear_x_2 <= orders_valid & ~orders_payload_blank &
            (orders_payload_step == STEP_LINEAR_X_2);
        begins_linear_y <= orders_valid & ~orders_payload_blank &
            (orders_payload_step == STEP_LINEAR_Y);
        begins_linear_z <= orders_valid & ~orders_payload_blank &
            (orders_payload_step == STEP_LINEAR_Z);
        begins_angular_x <= orders_valid & ~orders_payload_blank &
            (orders_payload_step == STEP_ANGULAR_X);
        ends_now <= ends;
        status_now <= orders_payload_status;
      end
      if (orders_ready) begin
        active_linear_x <= chosen_step_linear_x_2;
      end else begin
        active_linear_x <= active_linear_x & ~go_linear_x;
      end
      if (orders_ready) begin
        active_linear_y <= chosen_step_linear_y;
      end else begin
        active_linear_y <= active_linear_y & ~go_linear_y;
      end
      if (orders_ready) begin
        active_linear_z <= chosen_step_linear_z;
      end else begin
        active_linear_z <= active_linear_z & ~go_linear_z;
      end
      if (orders_ready) begin
        active_angular_x <= chosen_step_angular_x;
      end else begin
        active_angular_x <= active_angular_x & ~go_angular_x;
      end
      if (orders_ready) begin
        active_angular_y <= chosen_step_angular_y;
      end else begin
        active_angular_y <= active_angular_y & ~go_angular_y;
      end
      if (orders_ready) begin
        active_angular_z <= chosen_step_angular_y;
      end else begin
        active_angular_z <= active_angular_z & ~go_angular_z;
      end
      if (orders_ready) begin
        slow <= next_order_is_slow;
      end else begin
        slow <= order_stays_slow;
      end
    end
  end

  always @(posedge aclk) begin
    if (orders_ready) begin
      items_word <= {lane_7_items_data, lane_6_items_data, lane_5_items_data, lane_4_items_data,
          lane_3_items_data, lane_2_items_data, lane_1_items_data, lane_0_items_data};
      items_good <= {orders_payload_items_bytes > 4'd7, orders_payload_items_bytes > 4'd6,
          orders_payload_items_bytes > 4'd5, orders_payload_items_bytes > 4'd4,
          orders_payload_items_bytes > 4'd3, orders_payload_items_bytes > 4'd2,
          orders_payload_items_bytes > 4'd1, orders_payload_items_bytes > 4'd0};
      map_word <= {lane_7_map_data, lane_6_map_data, lane_5_map_data, lane_4_map_data,
          lane_3_map_data, lane_2_map_data, lane_1_map_data, lane_0_map_data};
      map_good <= {orders_payload_map_bytes > 4'd7, orders_payload_map_bytes > 4'd6,
          orders_payload_map_bytes > 4'd5, orders_payload_map_bytes > 4'd4,
          orders_payload_map_bytes > 4'd3, orders_payload_map_bytes > 4'd2,
          orders_payload_map_bytes > 4'd1, orders_payload_map_bytes > 4'd0};
    end
    if (carried_part) begin
      carried[7:0] <= map_word[39:32];
    end
    if (carried_part) begin
      carried[15:8] <= map_word[47:40];
    end
    if (carried_part) begin
      carried[23:16] <= map_word[55:48];
    end
    if (carried_part) begin
      carried[31:24] <= map_word[63:56];
    end
    if (carried_part_2) begin
      carried[7:0] <= map_word[39:32];
    end
    if (carried_part_2) begin
      carried[15:8] <= map_word[47:40];
    end
    if (carried_part_2) begin
      carried[23:16] <= map_word[55:48];
    end
    if (carried_part_2) begin
      carried[31:24] <= map_word[63:56];
    end
    if (carried_part_3) begin
      carried[7:0] <= map_word[39:32];
    end
    if (carried_part_3) begin
      carried[15:8] <= map_word[47:40];
    end
    if (carried_part_3) begin
      carried[23:16] <= map_word[55:48];
    end
    if (carried_part_3) begin
      carried[31:24] <= map_word[63:56];
    end
    if (carried_part_4) begin
      carried[7:0] <= map_word[39:32];
    end
    if (carried_part_4) begin
      carried[15:8] <= map_word[47:40];
    end
    if (carried_part_4) begin
      carried[23:16] <= map_word[55:48];
    end
    if (carried_part_4) begin
      carried[31:24] <= map_word[63:56];
    end
    if (carried_part_5) begin
      carried[7:0] <= map_word[39:32];
    end
    if (carried_part_5) begin
      carried[15:8] <= map_word[47:40];
    end
    if (carried_part_5) begin
      carried[23:16] <= map_word[55:48];
    end
    if (carried_part_5) begin
      carried[31:24] <= map_word[63:56];
    end
    if (go_linear_x) begin
      payload_linear_x <= map_good[3] ? {map_word[31:0], carried} : 64'd0;
    end
    if (go_linear_y) begin
      payload_linear_y <= map_good[3] ? {map_word[31:0], carried} : 64'd0;
    end
    if (go_linear_z) begin
      payload_linear_z <= map_good[3] ? {map_word[31:0], carried} : 64'd0;
    end
    if (go_angular_x) begin
      payload_angular_x <= map_good[3] ? {map_word[31:0], carried} : 64'd0;
    end
    if (go_angular_y) begin
      payload_angular_y <= items_good[3] ? {items_word[31:0], carried} : 64'd0;
    end
    if (go_angular_z) begin
      payload_angular_z <= map_good[3] ? {map_word[31:0], items_word[63:32]} : 64'd0;
    end
  end

  assign beat_data = beat[63:0];
  assign beat_at = beat[72:69];
  assign beat_valid = beat[73];
  assign orders_payload_step = orders_payload[2:0];
  assign orders_payload_blank = orders_payload[3];
  assign orders_payload_items_at = orders_payload[9:4];
  assign orders_payload_map_at = orders_payload[15:10];
  assign orders_payload_items_bytes = orders_payload[25:22];
  assign orders_payload_map_bytes = orders_payload[29:26];
  assign orders_payload_last = orders_payload[31];
  assign orders_payload_length_good = orders_payload[32];
  assign orders_payload_ends = orders_payload[38];
  assign orders_payload_status = orders_payload[41:39];

  assign message_linear_x_valid = message_linear_x_valid_q;
  assign message_linear_y_valid = message_linear_y_valid_q;
  assign message_linear_z_valid = message_linear_z_valid_q;
  assign message_angular_x_valid = message_angular_x_valid_q;
  assign message_angular_y_valid = message_angular_y_valid_q;
  assign message_angular_z_valid = message_angular_z_valid_q;
  assign status_valid = status_valid_q;
  assign status_payload = status_payload_q;
  assign message_linear_x_payload = payload_linear_x;
  assign message_linear_y_payload = payload_linear_y;
  assign message_linear_z_payload = payload_linear_z;
  assign message_angular_x_payload = payload_angular_x;
  assign message_angular_y_payload = payload_angular_y;
  assign message_angular_z_payload = payload_angular_z;
endmodule

// Deserializer: Turn packets into messages.
//
// A packet advances one step of the plan per cycle, as soon as the bytes of the step have arrived.
// Each step gives an order to a queue of two, and every leaf has one register. Leaves that are not
// taken hold the packet only when the queue is full. Most leaves cost one cycle more if they are
// still full when their next value comes.
//
// Leaves become valid in wire order, `LATENCY_CYCLES["deserializer"]` cycles after the last beat
// of their step. All outputs are registers. One clock domain, `sync`; its reset discards all
// packets and messages inside.
//
// Each packet ends in one transfer on `status`. After the first error in a packet, the remaining
// scalars and lengths transfer as 0, the current sequence is completed with zeros, and the rest of
// the packet is dropped. The next packet is decoded normally.
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
  input wire [68:0]  packets_payload,  // bits: data(63:0) count(67:64) last(68)
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
  wire [73:0] beat;
  wire [6:0] arrival_limit;
  wire [3:0] arrival_following;
  wire arrival_ended;
  wire orders_valid;
  wire arrival_next;
  wire [41:0] orders_payload;
  wire [3:0] oldest;
  wire i_ready;
  wire [3:0] freed;
  wire o_valid;
  wire [41:0] o_payload;
  wire orders_ready_25;

  geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_buffer buffer_sig (
    .aclk              (aclk),
    .packets_valid     (packets_valid),
    .rst               (rst),
    .arrival_next      (arrival_next),
    .freed             (freed),
    .packets_payload   (packets_payload),
    .arrival_beat      (beat),
    .packets_ready     (packets_ready),
    .arrival_limit     (arrival_limit),
    .arrival_following (arrival_following),
    .arrival_ended     (arrival_ended)
  );

  geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_sequencer sequencer (
    .aclk              (aclk),
    .rst               (rst),
    .orders_valid      (orders_valid),
    .arrival_next      (arrival_next),
    .orders_ready      (i_ready),
    .beat              (beat),
    .arrival_limit     (arrival_limit),
    .arrival_following (arrival_following),
    .arrival_ended     (arrival_ended),
    .orders_payload    (orders_payload),
    .header_at         (oldest)
  );

  geometry_msgs_msg_Twist_cdr_8_deserializer_verilog_core_queue queue (
    .aclk      (aclk),
    .rst       (rst),
    .i_valid   (orders_valid),
    .i_ready   (i_ready),
    .freed     (freed),
    .o_ready   (orders_ready_25),
    .i_payload (orders_payload),
    .oldest    (oldest),
    .o_valid   (o_valid),
    .o_payload (o_payload)
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
    .orders_ready              (orders_ready_25),
    .beat                      (beat),
    .orders_valid              (o_valid),
    .orders_payload            (o_payload),
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
endmodule

// Top: A converter with AXI4-Stream on its packet side and named ports on its message side.
//
// The top level adds neither registers nor latency. `aresetn` is active low and synchronous to the
// rising edge of `aclk`; one cycle of reset discards all packets and messages inside. A last beat
// without any ones in ``tkeep`` adds no bytes, so it can end an empty packet.
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
  wire tkeep_begins_with_1;
  wire tkeep_begins_with_2;
  wire tkeep_begins_with_3;
  wire tkeep_begins_with_4;
  wire tkeep_begins_with_5;
  wire tkeep_begins_with_6;
  wire tkeep_begins_with_7;
  wire [3:0] packets_payload_count;

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
    .packets_payload           ({s_axis_tlast, packets_payload_count, s_axis_tdata}),
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
  assign tkeep_begins_with_1 = s_axis_tkeep[0] & ~s_axis_tkeep[1];
  assign tkeep_begins_with_2 = (&s_axis_tkeep[1:0]) & ~s_axis_tkeep[2];
  assign tkeep_begins_with_3 = (&s_axis_tkeep[2:0]) & ~s_axis_tkeep[3];
  assign tkeep_begins_with_4 = (&s_axis_tkeep[3:0]) & ~s_axis_tkeep[4];
  assign tkeep_begins_with_5 = (&s_axis_tkeep[4:0]) & ~s_axis_tkeep[5];
  assign tkeep_begins_with_6 = (&s_axis_tkeep[5:0]) & ~s_axis_tkeep[6];
  assign tkeep_begins_with_7 = (&s_axis_tkeep[6:0]) & ~s_axis_tkeep[7];
  assign packets_payload_count = s_axis_tlast ? {&s_axis_tkeep, tkeep_begins_with_4 |
      tkeep_begins_with_5 | tkeep_begins_with_6 | tkeep_begins_with_7, tkeep_begins_with_2 |
      tkeep_begins_with_3 | tkeep_begins_with_6 | tkeep_begins_with_7, tkeep_begins_with_1 |
      tkeep_begins_with_3 | tkeep_begins_with_5 | tkeep_begins_with_7} : 4'd8;

  assign m_axis_status_tdata = {5'd0, status_payload};
endmodule
