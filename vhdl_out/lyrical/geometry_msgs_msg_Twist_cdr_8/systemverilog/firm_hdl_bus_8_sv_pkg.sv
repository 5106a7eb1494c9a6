// Packets on a bus of 8 bytes, and streams of strings, arrays and sequences on it,
// for all message types.

`ifndef FIRM_HDL_BUS_8_SV_PKG
`define FIRM_HDL_BUS_8_SV_PKG

package firm_hdl_bus_8_sv_pkg;

  import firm_hdl_sv_pkg::*;

  // AXI4-Stream. A deserializer ignores tuser.

  typedef struct packed {
    logic [63:0] tdata;  // bytes of the packet, the first one in bits 7 to 0
    logic [7:0]  tkeep;  // valid bytes, from lane 0 on
    logic        tlast;  // last beat of the packet
    logic        tuser;  // with tlast: the packet's status is not OK
    logic        tvalid;
  } packet_beat_t;

  localparam packet_beat_t PACKET_BEAT_IDLE = '0;

  typedef struct packed {
    bool_data_t [7:0] data;  // the first item at index 0; zeros after the last item
    logic             last;  // last transfer of the array or sequence
    logic             valid;
  } bool_items_stream_t;

  localparam bool_items_stream_t BOOL_ITEMS_STREAM_IDLE = '0;

  typedef struct packed {
    float32_data_t [1:0] data;  // the first item at index 0; zeros after the last item
    logic                last;  // last transfer of the array or sequence
    logic                valid;
  } float32_items_stream_t;

  localparam float32_items_stream_t FLOAT32_ITEMS_STREAM_IDLE = '0;

  typedef struct packed {
    float64_data_t [0:0] data;  // the first item at index 0; zeros after the last item
    logic                last;  // last transfer of the array or sequence
    logic                valid;
  } float64_items_stream_t;

  localparam float64_items_stream_t FLOAT64_ITEMS_STREAM_IDLE = '0;

  typedef struct packed {
    int8_data_t [7:0] data;  // the first item at index 0; zeros after the last item
    logic             last;  // last transfer of the array or sequence
    logic             valid;
  } int8_items_stream_t;

  localparam int8_items_stream_t INT8_ITEMS_STREAM_IDLE = '0;

  typedef struct packed {
    uint8_data_t [7:0] data;  // the first item at index 0; zeros after the last item
    logic              last;  // last transfer of the array or sequence
    logic              valid;
  } uint8_items_stream_t;

  localparam uint8_items_stream_t UINT8_ITEMS_STREAM_IDLE = '0;

  typedef struct packed {
    int16_data_t [3:0] data;  // the first item at index 0; zeros after the last item
    logic              last;  // last transfer of the array or sequence
    logic              valid;
  } int16_items_stream_t;

  localparam int16_items_stream_t INT16_ITEMS_STREAM_IDLE = '0;

  typedef struct packed {
    uint16_data_t [3:0] data;  // the first item at index 0; zeros after the last item
    logic               last;  // last transfer of the array or sequence
    logic               valid;
  } uint16_items_stream_t;

  localparam uint16_items_stream_t UINT16_ITEMS_STREAM_IDLE = '0;

  typedef struct packed {
    int32_data_t [1:0] data;  // the first item at index 0; zeros after the last item
    logic              last;  // last transfer of the array or sequence
    logic              valid;
  } int32_items_stream_t;

  localparam int32_items_stream_t INT32_ITEMS_STREAM_IDLE = '0;

  typedef struct packed {
    uint32_data_t [1:0] data;  // the first item at index 0; zeros after the last item
    logic               last;  // last transfer of the array or sequence
    logic               valid;
  } uint32_items_stream_t;

  localparam uint32_items_stream_t UINT32_ITEMS_STREAM_IDLE = '0;

  typedef struct packed {
    int64_data_t [0:0] data;  // the first item at index 0; zeros after the last item
    logic              last;  // last transfer of the array or sequence
    logic              valid;
  } int64_items_stream_t;

  localparam int64_items_stream_t INT64_ITEMS_STREAM_IDLE = '0;

  typedef struct packed {
    uint64_data_t [0:0] data;  // the first item at index 0; zeros after the last item
    logic               last;  // last transfer of the array or sequence
    logic               valid;
  } uint64_items_stream_t;

  localparam uint64_items_stream_t UINT64_ITEMS_STREAM_IDLE = '0;

  typedef struct packed {
    uint32_stream_t      length;  // number of elements
    uint8_items_stream_t items;
  } string_stream_t;

  typedef struct packed {
    logic length;
    logic items;
  } string_stream_ready_t;

  localparam string_stream_t STRING_STREAM_IDLE = '0;
  localparam string_stream_ready_t STRING_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint32_stream_t       length;  // number of elements
    uint32_items_stream_t items;
  } wstring_stream_t;

  typedef struct packed {
    logic length;
    logic items;
  } wstring_stream_ready_t;

  localparam wstring_stream_t WSTRING_STREAM_IDLE = '0;
  localparam wstring_stream_ready_t WSTRING_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint32_stream_t     length;  // number of elements
    bool_items_stream_t items;
  } bool_sequence_stream_t;

  typedef struct packed {
    logic length;
    logic items;
  } bool_sequence_stream_ready_t;

  localparam bool_sequence_stream_t BOOL_SEQUENCE_STREAM_IDLE = '0;
  localparam bool_sequence_stream_ready_t BOOL_SEQUENCE_STREAM_ALL_READY = '1;

  typedef struct packed {
    bool_items_stream_t items;
  } bool_array_stream_t;

  typedef struct packed {
    logic items;
  } bool_array_stream_ready_t;

  localparam bool_array_stream_t BOOL_ARRAY_STREAM_IDLE = '0;
  localparam bool_array_stream_ready_t BOOL_ARRAY_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint32_stream_t        length;  // number of elements
    float32_items_stream_t items;
  } float32_sequence_stream_t;

  typedef struct packed {
    logic length;
    logic items;
  } float32_sequence_stream_ready_t;

  localparam float32_sequence_stream_t FLOAT32_SEQUENCE_STREAM_IDLE = '0;
  localparam float32_sequence_stream_ready_t FLOAT32_SEQUENCE_STREAM_ALL_READY = '1;

  typedef struct packed {
    float32_items_stream_t items;
  } float32_array_stream_t;

  typedef struct packed {
    logic items;
  } float32_array_stream_ready_t;

  localparam float32_array_stream_t FLOAT32_ARRAY_STREAM_IDLE = '0;
  localparam float32_array_stream_ready_t FLOAT32_ARRAY_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint32_stream_t        length;  // number of elements
    float64_items_stream_t items;
  } float64_sequence_stream_t;

  typedef struct packed {
    logic length;
    logic items;
  } float64_sequence_stream_ready_t;

  localparam float64_sequence_stream_t FLOAT64_SEQUENCE_STREAM_IDLE = '0;
  localparam float64_sequence_stream_ready_t FLOAT64_SEQUENCE_STREAM_ALL_READY = '1;

  typedef struct packed {
    float64_items_stream_t items;
  } float64_array_stream_t;

  typedef struct packed {
    logic items;
  } float64_array_stream_ready_t;

  localparam float64_array_stream_t FLOAT64_ARRAY_STREAM_IDLE = '0;
  localparam float64_array_stream_ready_t FLOAT64_ARRAY_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint32_stream_t     length;  // number of elements
    int8_items_stream_t items;
  } int8_sequence_stream_t;

  typedef struct packed {
    logic length;
    logic items;
  } int8_sequence_stream_ready_t;

  localparam int8_sequence_stream_t INT8_SEQUENCE_STREAM_IDLE = '0;
  localparam int8_sequence_stream_ready_t INT8_SEQUENCE_STREAM_ALL_READY = '1;

  typedef struct packed {
    int8_items_stream_t items;
  } int8_array_stream_t;

  typedef struct packed {
    logic items;
  } int8_array_stream_ready_t;

  localparam int8_array_stream_t INT8_ARRAY_STREAM_IDLE = '0;
  localparam int8_array_stream_ready_t INT8_ARRAY_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint32_stream_t      length;  // number of elements
    uint8_items_stream_t items;
  } uint8_sequence_stream_t;

  typedef struct packed {
    logic length;
    logic items;
  } uint8_sequence_stream_ready_t;

  localparam uint8_sequence_stream_t UINT8_SEQUENCE_STREAM_IDLE = '0;
  localparam uint8_sequence_stream_ready_t UINT8_SEQUENCE_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint8_items_stream_t items;
  } uint8_array_stream_t;

  typedef struct packed {
    logic items;
  } uint8_array_stream_ready_t;

  localparam uint8_array_stream_t UINT8_ARRAY_STREAM_IDLE = '0;
  localparam uint8_array_stream_ready_t UINT8_ARRAY_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint32_stream_t      length;  // number of elements
    int16_items_stream_t items;
  } int16_sequence_stream_t;

  typedef struct packed {
    logic length;
    logic items;
  } int16_sequence_stream_ready_t;

  localparam int16_sequence_stream_t INT16_SEQUENCE_STREAM_IDLE = '0;
  localparam int16_sequence_stream_ready_t INT16_SEQUENCE_STREAM_ALL_READY = '1;

  typedef struct packed {
    int16_items_stream_t items;
  } int16_array_stream_t;

  typedef struct packed {
    logic items;
  } int16_array_stream_ready_t;

  localparam int16_array_stream_t INT16_ARRAY_STREAM_IDLE = '0;
  localparam int16_array_stream_ready_t INT16_ARRAY_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint32_stream_t       length;  // number of elements
    uint16_items_stream_t items;
  } uint16_sequence_stream_t;

  typedef struct packed {
    logic length;
    logic items;
  } uint16_sequence_stream_ready_t;

  localparam uint16_sequence_stream_t UINT16_SEQUENCE_STREAM_IDLE = '0;
  localparam uint16_sequence_stream_ready_t UINT16_SEQUENCE_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint16_items_stream_t items;
  } uint16_array_stream_t;

  typedef struct packed {
    logic items;
  } uint16_array_stream_ready_t;

  localparam uint16_array_stream_t UINT16_ARRAY_STREAM_IDLE = '0;
  localparam uint16_array_stream_ready_t UINT16_ARRAY_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint32_stream_t      length;  // number of elements
    int32_items_stream_t items;
  } int32_sequence_stream_t;

  typedef struct packed {
    logic length;
    logic items;
  } int32_sequence_stream_ready_t;

  localparam int32_sequence_stream_t INT32_SEQUENCE_STREAM_IDLE = '0;
  localparam int32_sequence_stream_ready_t INT32_SEQUENCE_STREAM_ALL_READY = '1;

  typedef struct packed {
    int32_items_stream_t items;
  } int32_array_stream_t;

  typedef struct packed {
    logic items;
  } int32_array_stream_ready_t;

  localparam int32_array_stream_t INT32_ARRAY_STREAM_IDLE = '0;
  localparam int32_array_stream_ready_t INT32_ARRAY_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint32_stream_t       length;  // number of elements
    uint32_items_stream_t items;
  } uint32_sequence_stream_t;

  typedef struct packed {
    logic length;
    logic items;
  } uint32_sequence_stream_ready_t;

  localparam uint32_sequence_stream_t UINT32_SEQUENCE_STREAM_IDLE = '0;
  localparam uint32_sequence_stream_ready_t UINT32_SEQUENCE_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint32_items_stream_t items;
  } uint32_array_stream_t;

  typedef struct packed {
    logic items;
  } uint32_array_stream_ready_t;

  localparam uint32_array_stream_t UINT32_ARRAY_STREAM_IDLE = '0;
  localparam uint32_array_stream_ready_t UINT32_ARRAY_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint32_stream_t      length;  // number of elements
    int64_items_stream_t items;
  } int64_sequence_stream_t;

  typedef struct packed {
    logic length;
    logic items;
  } int64_sequence_stream_ready_t;

  localparam int64_sequence_stream_t INT64_SEQUENCE_STREAM_IDLE = '0;
  localparam int64_sequence_stream_ready_t INT64_SEQUENCE_STREAM_ALL_READY = '1;

  typedef struct packed {
    int64_items_stream_t items;
  } int64_array_stream_t;

  typedef struct packed {
    logic items;
  } int64_array_stream_ready_t;

  localparam int64_array_stream_t INT64_ARRAY_STREAM_IDLE = '0;
  localparam int64_array_stream_ready_t INT64_ARRAY_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint32_stream_t       length;  // number of elements
    uint64_items_stream_t items;
  } uint64_sequence_stream_t;

  typedef struct packed {
    logic length;
    logic items;
  } uint64_sequence_stream_ready_t;

  localparam uint64_sequence_stream_t UINT64_SEQUENCE_STREAM_IDLE = '0;
  localparam uint64_sequence_stream_ready_t UINT64_SEQUENCE_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint64_items_stream_t items;
  } uint64_array_stream_t;

  typedef struct packed {
    logic items;
  } uint64_array_stream_ready_t;

  localparam uint64_array_stream_t UINT64_ARRAY_STREAM_IDLE = '0;
  localparam uint64_array_stream_ready_t UINT64_ARRAY_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint32_stream_t length;  // number of elements
    string_stream_t item;
  } string_sequence_stream_t;

  typedef struct packed {
    logic                 length;
    string_stream_ready_t item;
  } string_sequence_stream_ready_t;

  localparam string_sequence_stream_t STRING_SEQUENCE_STREAM_IDLE = '0;
  localparam string_sequence_stream_ready_t STRING_SEQUENCE_STREAM_ALL_READY = '1;

  typedef struct packed {
    string_stream_t item;
  } string_array_stream_t;

  typedef struct packed {
    string_stream_ready_t item;
  } string_array_stream_ready_t;

  localparam string_array_stream_t STRING_ARRAY_STREAM_IDLE = '0;
  localparam string_array_stream_ready_t STRING_ARRAY_STREAM_ALL_READY = '1;

  typedef struct packed {
    uint32_stream_t  length;  // number of elements
    wstring_stream_t item;
  } wstring_sequence_stream_t;

  typedef struct packed {
    logic                  length;
    wstring_stream_ready_t item;
  } wstring_sequence_stream_ready_t;

  localparam wstring_sequence_stream_t WSTRING_SEQUENCE_STREAM_IDLE = '0;
  localparam wstring_sequence_stream_ready_t WSTRING_SEQUENCE_STREAM_ALL_READY = '1;

  typedef struct packed {
    wstring_stream_t item;
  } wstring_array_stream_t;

  typedef struct packed {
    wstring_stream_ready_t item;
  } wstring_array_stream_ready_t;

  localparam wstring_array_stream_t WSTRING_ARRAY_STREAM_IDLE = '0;
  localparam wstring_array_stream_ready_t WSTRING_ARRAY_STREAM_ALL_READY = '1;

endpackage : firm_hdl_bus_8_sv_pkg

`endif
