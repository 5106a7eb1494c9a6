// Structs of geometry_msgs/msg/Twist: twist_t has data and valid of every field, twist_ready_t has
// ready, in the opposite direction. TWIST_ALL_READY takes every transfer; TWIST_IDLE offers none.
// Made by firm-hdl. All converters with wire cdr and a bus of 8 bytes share this file.

`ifndef GEOMETRY_MSGS_MSG_TWIST_CDR_8_SV_PKG
`define GEOMETRY_MSGS_MSG_TWIST_CDR_8_SV_PKG

package geometry_msgs_msg_twist_cdr_8_sv_pkg;

  import firm_hdl_sv_pkg::*;
  import firm_hdl_bus_8_sv_pkg::*;

  typedef struct packed {
    geometry_msgs_msg_vector3_cdr_8_sv_pkg::vector3_t linear;  // geometry_msgs/msg/Vector3
    geometry_msgs_msg_vector3_cdr_8_sv_pkg::vector3_t angular;  // geometry_msgs/msg/Vector3
  } twist_t;

  typedef struct packed {
    geometry_msgs_msg_vector3_cdr_8_sv_pkg::vector3_ready_t linear;
    geometry_msgs_msg_vector3_cdr_8_sv_pkg::vector3_ready_t angular;
  } twist_ready_t;

  localparam twist_t TWIST_IDLE = '0;
  localparam twist_ready_t TWIST_ALL_READY = '1;

  // Sequences and arrays: all elements use the same streams, one after the other.

  typedef struct packed {
    uint32_stream_t length;  // number of elements
    twist_t         item;
  } twist_sequence_t;

  typedef struct packed {
    logic         length;
    twist_ready_t item;
  } twist_sequence_ready_t;

  localparam twist_sequence_t TWIST_SEQUENCE_IDLE = '0;
  localparam twist_sequence_ready_t TWIST_SEQUENCE_ALL_READY = '1;

  typedef struct packed {
    twist_t item;
  } twist_array_t;

  typedef struct packed {
    twist_ready_t item;
  } twist_array_ready_t;

  localparam twist_array_t TWIST_ARRAY_IDLE = '0;
  localparam twist_array_ready_t TWIST_ARRAY_ALL_READY = '1;

endpackage : geometry_msgs_msg_twist_cdr_8_sv_pkg

`endif
