// Streams of ROS's primitive types, for all message types and bus widths.
//
// A transfer happens at a rising clock edge at which valid and ready are both 1. The source sets
// valid without waiting for ready, and keeps valid and the data unchanged until the transfer.

`ifndef FIRM_HDL_SV_PKG
`define FIRM_HDL_SV_PKG

package firm_hdl_sv_pkg;

  // Status of a packet, one transfer per packet.
  typedef enum logic [7:0] {
    STATUS_OK            = 8'h00,
    STATUS_TRUNCATED     = 8'h01,
    STATUS_TRAILING      = 8'h02,
    STATUS_LENGTH        = 8'h03,
    STATUS_ENCAPSULATION = 8'h04,
    STATUS_STRING        = 8'h05,
    STATUS_ITEMS         = 8'h06
  } packet_status_t;

  typedef struct packed {
    packet_status_t tdata;
    logic           tvalid;
  } packet_status_stream_t;

  localparam packet_status_stream_t PACKET_STATUS_STREAM_IDLE = '0;

  // Values. A float is its IEEE 754 bits; a bool is 1 if true.
  typedef logic bool_data_t;
  typedef logic [31:0] float32_data_t;
  typedef logic [63:0] float64_data_t;
  typedef logic signed [7:0] int8_data_t;
  typedef logic [7:0] uint8_data_t;
  typedef logic signed [15:0] int16_data_t;
  typedef logic [15:0] uint16_data_t;
  typedef logic signed [31:0] int32_data_t;
  typedef logic [31:0] uint32_data_t;
  typedef logic signed [63:0] int64_data_t;
  typedef logic [63:0] uint64_data_t;

  typedef struct packed {
    bool_data_t data;
    logic       valid;
  } bool_stream_t;

  typedef struct packed {
    float32_data_t data;
    logic          valid;
  } float32_stream_t;

  typedef struct packed {
    float64_data_t data;
    logic          valid;
  } float64_stream_t;

  typedef struct packed {
    int8_data_t data;
    logic       valid;
  } int8_stream_t;

  typedef struct packed {
    uint8_data_t data;
    logic        valid;
  } uint8_stream_t;

  typedef struct packed {
    int16_data_t data;
    logic        valid;
  } int16_stream_t;

  typedef struct packed {
    uint16_data_t data;
    logic         valid;
  } uint16_stream_t;

  typedef struct packed {
    int32_data_t data;
    logic        valid;
  } int32_stream_t;

  typedef struct packed {
    uint32_data_t data;
    logic         valid;
  } uint32_stream_t;

  typedef struct packed {
    int64_data_t data;
    logic        valid;
  } int64_stream_t;

  typedef struct packed {
    uint64_data_t data;
    logic         valid;
  } uint64_stream_t;

  // Idle streams: valid is 0.
  localparam bool_stream_t BOOL_STREAM_IDLE = '0;
  localparam float32_stream_t FLOAT32_STREAM_IDLE = '0;
  localparam float64_stream_t FLOAT64_STREAM_IDLE = '0;
  localparam int8_stream_t INT8_STREAM_IDLE = '0;
  localparam uint8_stream_t UINT8_STREAM_IDLE = '0;
  localparam int16_stream_t INT16_STREAM_IDLE = '0;
  localparam uint16_stream_t UINT16_STREAM_IDLE = '0;
  localparam int32_stream_t INT32_STREAM_IDLE = '0;
  localparam uint32_stream_t UINT32_STREAM_IDLE = '0;
  localparam int64_stream_t INT64_STREAM_IDLE = '0;
  localparam uint64_stream_t UINT64_STREAM_IDLE = '0;

endpackage : firm_hdl_sv_pkg

`endif
