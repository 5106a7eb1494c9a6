// A board with a node behind LiteEth: what a top level on an FPGA contains, without its pins.
module board (
  input  wire       clk,
  input  wire       resetn,
  input  wire [7:0] rx_data,
  input  wire       rx_valid,
  output wire [7:0] tx_data,
  output wire       tx_valid
);
  wire [7:0]  rx_word, tx_word;
  wire        rx_last, rx_error, rx_word_valid, rx_word_ready;
  wire        tx_last, tx_last_be, tx_word_valid, tx_word_ready;
  wire [15:0] rx_length, rx_src_port, rx_dst_port, tx_length, tx_src_port, tx_dst_port;
  wire [31:0] rx_address, tx_address;
  wire        mdio;

  liteeth_core ethernet (
    .sys_clock(clk), .sys_reset(!resetn),
    .gmii_clocks_rx(clk), .gmii_clocks_tx(clk), .gmii_clocks_gtx(),
    .gmii_rx_data(rx_data), .gmii_rx_dv(rx_valid), .gmii_rx_er(1'b0),
    .gmii_tx_data(tx_data), .gmii_tx_en(tx_valid), .gmii_tx_er(),
    .gmii_col(1'b0), .gmii_crs(1'b0), .gmii_int_n(1'b1), .gmii_rst_n(),
    .gmii_mdc(), .gmii_mdio(mdio),
    .node_source_data(rx_word), .node_source_last(rx_last), .node_source_last_be(),
    .node_source_error(rx_error), .node_source_length(rx_length),
    .node_source_ip_address(rx_address), .node_source_src_port(rx_src_port),
    .node_source_dst_port(rx_dst_port),
    .node_source_valid(rx_word_valid), .node_source_ready(rx_word_ready),
    .node_sink_data(tx_word), .node_sink_last(tx_last), .node_sink_last_be(tx_last_be),
    .node_sink_length(tx_length), .node_sink_ip_address(tx_address),
    .node_sink_src_port(tx_src_port), .node_sink_dst_port(tx_dst_port),
    .node_sink_valid(tx_word_valid), .node_sink_ready(tx_word_ready)
  );

  near_verilog node (
    .aclk(clk), .aresetn(resetn),
    .udp_rx_data(rx_word), .udp_rx_last(rx_last), .udp_rx_last_be(1'b0),
    .udp_rx_error(rx_error), .udp_rx_length(rx_length), .udp_rx_ip_address(rx_address),
    .udp_rx_src_port(rx_src_port), .udp_rx_dst_port(rx_dst_port),
    .udp_rx_valid(rx_word_valid), .udp_rx_ready(rx_word_ready),
    .udp_tx_data(tx_word), .udp_tx_last(tx_last), .udp_tx_last_be(tx_last_be),
    .udp_tx_error(), .udp_tx_length(tx_length), .udp_tx_ip_address(tx_address),
    .udp_tx_src_port(tx_src_port), .udp_tx_dst_port(tx_dst_port),
    .udp_tx_valid(tx_word_valid), .udp_tx_ready(tx_word_ready)
  );
endmodule

// Cells of Lattice that LiteEth instantiates, for simulation.
module BUFG (input wire I, output wire O);
  assign O = I;
endmodule

module ODDRX1F (input wire D0, input wire D1, input wire SCLK, output wire Q);
  assign Q = SCLK ? D0 : D1;
endmodule

module FD1S3BX (input wire D, input wire CK, input wire PD, output reg Q);
  always @(posedge CK or posedge PD)
    if (PD) Q <= 1'b1;
    else Q <= D;
endmodule

module BB (input wire I, input wire T, output wire O, inout wire B);
  assign O = B;
  assign B = T ? 1'bz : I;
endmodule
