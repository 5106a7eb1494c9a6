// Sends the beats of a file, with random pauses, and compares each new speed of the motor with
// another file.

module motor_tb;

  logic        aclk = 0, aresetn = 0;
  logic        tready;
  logic [63:0] speed;

  firm_hdl_bus_4_sv_pkg::packet_beat_t beat = firm_hdl_bus_4_sv_pkg::PACKET_BEAT_IDLE;

  motor dut (.aclk, .aresetn, .s_axis(beat), .s_axis_tready(tready), .speed);

  always #5 aclk = !aclk;

  integer beats, speeds, sent = 0, seen = 0;
  logic [31:0] data;
  logic [3:0]  keep;
  logic        last;
  logic [63:0] want;

  initial begin
    beats = $fopen("work/beats.txt", "r");
    repeat (3) @(negedge aclk);
    aresetn = 1;
    while ($fscanf(beats, "%h %b %b", data, keep, last) == 3) begin
      beat = '{tdata: data, tkeep: keep, tlast: last, tuser: 1'b0, tvalid: 1'b1};
      // Signals change at the falling edge, half a cycle before they are sampled.
      #1 while (!tready) @(negedge aclk) #1;
      @(negedge aclk) beat.tvalid = 0;
      if (last) sent += 1;
      repeat ($urandom_range(2)) @(negedge aclk);
    end
    repeat (100) @(negedge aclk);
    if (sent == 0 || $fscanf(speeds, "%h", want) == 1) begin
      $display("FAIL after %0d packets and %0d speeds: %h is missing", sent, seen, want);
      $fatal(1);
    end
    $display("PASS %0d packets, %0d speeds", sent, seen);
    $finish;
  end

  initial speeds = $fopen("work/speeds.txt", "r");

  always @(speed) if (aresetn) begin
    if ($fscanf(speeds, "%h", want) != 1 || speed !== want) begin
      $display("FAIL after %0d packets: the speed is %h instead of %h", sent, speed, want);
      $fatal(1);
    end
    seen += 1;
  end

endmodule
