// Structs of geometry_msgs/msg/Vector3: vector3_t has data and valid of every field,
// vector3_ready_t has ready, in the opposite direction. VECTOR3_ALL_READY takes every transfer;
// VECTOR3_IDLE offers none.
// Made by firm-hdl. All converters with wire cdr and a bus of 8 bytes share this file.

`ifndef GEOMETRY_MSGS_MSG_VECTOR3_CDR_8_SV_PKG
`define GEOMETRY_MSGS_MSG_VECTOR3_CDR_8_SV_PKG

package geometry_msgs_msg_vector3_cdr_8_sv_pkg;

  import firm_hdl_sv_pkg::*;
  import firm_hdl_bus_8_sv_pkg::*;

  typedef struct packed {
    float64_stream_t x;  // float64
    float64_stream_t y;  // float64
    float64_stream_t z;  // float64
  } vector3_t;

  typedef struct packed {
    logic x;
    logic y;
    logic z;
  } vector3_ready_t;

  localparam vector3_t VECTOR3_IDLE = '0;
  localparam vector3_ready_t VECTOR3_ALL_READY = '1;

  // Sequences and arrays: all elements use the same streams, one after the other.

  typedef struct packed {
    uint32_stream_t length;  // number of elements
    vector3_t       item;
  } vector3_sequence_t;

  typedef struct packed {
    logic           length;
    vector3_ready_t item;
  } vector3_sequence_ready_t;

  localparam vector3_sequence_t VECTOR3_SEQUENCE_IDLE = '0;
  localparam vector3_sequence_ready_t VECTOR3_SEQUENCE_ALL_READY = '1;

  typedef struct packed {
    vector3_t item;
  } vector3_array_t;

  typedef struct packed {
    vector3_ready_t item;
  } vector3_array_ready_t;

  localparam vector3_array_t VECTOR3_ARRAY_IDLE = '0;
  localparam vector3_array_ready_t VECTOR3_ARRAY_ALL_READY = '1;

endpackage : geometry_msgs_msg_vector3_cdr_8_sv_pkg

`endif
