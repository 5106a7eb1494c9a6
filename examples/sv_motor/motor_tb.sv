// Sends the beats of a file, with random pauses, and compares each new speed of the motor with
// another file.

`timescale 1ns / 1ps

module motor_tb;

  logic        aclk = 0, aresetn = 0;
  logic [31:0] tdata = 0;
  logic [3:0]  tkeep = 0;
  logic        tlast = 0, tvalid = 0, tready;
  logic [63:0] speed;

  motor dut (
    .aclk, .aresetn, .s_axis_tdata(tdata), .s_axis_tkeep(tkeep), .s_axis_tlast(tlast),
    .s_axis_tvalid(tvalid), .s_axis_tready(tready), .speed
  );

  always #5 aclk = !aclk;

  integer beats, speeds, sent = 0, seen = 0;
  logic [31:0] data;
  logic [3:0]  keep;
  logic        last;
  logic [63:0] want;

  initial begin
    beats = $fopen("work/beats.txt", "r");
    repeat (3) @(posedge aclk);
    aresetn <= 1;
    @(posedge aclk);
    while ($fscanf(beats, "%h %b %b", data, keep, last) == 3) begin
      {tvalid, tdata, tkeep, tlast} <= {1'b1, data, keep, last};
      do @(posedge aclk); while (!tready);
      tvalid <= 0;
      sent += last;
      repeat ($urandom_range(2)) @(posedge aclk);
    end
    repeat (100) @(posedge aclk);
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
