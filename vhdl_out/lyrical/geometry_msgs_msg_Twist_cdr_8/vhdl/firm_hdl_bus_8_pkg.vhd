-- Streams of strings, arrays and sequences on a bus of 8 bytes, for all message types.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_types_pkg.all;

package firm_hdl_bus_8_pkg is

  type bool_items_stream_t is record
    data  : bool_items_t(0 to 7);  -- zeros after the last item
    last  : std_logic;  -- last transfer of the array or sequence
    valid : std_logic;
  end record;

  constant BOOL_ITEMS_STREAM_IDLE : bool_items_stream_t := (
    data => (others => '0'), last => '0', valid => '0');

  type float32_items_stream_t is record
    data  : float32_items_t(0 to 1);  -- zeros after the last item
    last  : std_logic;  -- last transfer of the array or sequence
    valid : std_logic;
  end record;

  constant FLOAT32_ITEMS_STREAM_IDLE : float32_items_stream_t := (
    data => (others => (others => '0')), last => '0', valid => '0');

  type float64_items_stream_t is record
    data  : float64_items_t(0 to 0);  -- zeros after the last item
    last  : std_logic;  -- last transfer of the array or sequence
    valid : std_logic;
  end record;

  constant FLOAT64_ITEMS_STREAM_IDLE : float64_items_stream_t := (
    data => (others => (others => '0')), last => '0', valid => '0');

  type int8_items_stream_t is record
    data  : int8_items_t(0 to 7);  -- zeros after the last item
    last  : std_logic;  -- last transfer of the array or sequence
    valid : std_logic;
  end record;

  constant INT8_ITEMS_STREAM_IDLE : int8_items_stream_t := (
    data => (others => (others => '0')), last => '0', valid => '0');

  type uint8_items_stream_t is record
    data  : uint8_items_t(0 to 7);  -- zeros after the last item
    last  : std_logic;  -- last transfer of the array or sequence
    valid : std_logic;
  end record;

  constant UINT8_ITEMS_STREAM_IDLE : uint8_items_stream_t := (
    data => (others => (others => '0')), last => '0', valid => '0');

  type int16_items_stream_t is record
    data  : int16_items_t(0 to 3);  -- zeros after the last item
    last  : std_logic;  -- last transfer of the array or sequence
    valid : std_logic;
  end record;

  constant INT16_ITEMS_STREAM_IDLE : int16_items_stream_t := (
    data => (others => (others => '0')), last => '0', valid => '0');

  type uint16_items_stream_t is record
    data  : uint16_items_t(0 to 3);  -- zeros after the last item
    last  : std_logic;  -- last transfer of the array or sequence
    valid : std_logic;
  end record;

  constant UINT16_ITEMS_STREAM_IDLE : uint16_items_stream_t := (
    data => (others => (others => '0')), last => '0', valid => '0');

  type int32_items_stream_t is record
    data  : int32_items_t(0 to 1);  -- zeros after the last item
    last  : std_logic;  -- last transfer of the array or sequence
    valid : std_logic;
  end record;

  constant INT32_ITEMS_STREAM_IDLE : int32_items_stream_t := (
    data => (others => (others => '0')), last => '0', valid => '0');

  type uint32_items_stream_t is record
    data  : uint32_items_t(0 to 1);  -- zeros after the last item
    last  : std_logic;  -- last transfer of the array or sequence
    valid : std_logic;
  end record;

  constant UINT32_ITEMS_STREAM_IDLE : uint32_items_stream_t := (
    data => (others => (others => '0')), last => '0', valid => '0');

  type int64_items_stream_t is record
    data  : int64_items_t(0 to 0);  -- zeros after the last item
    last  : std_logic;  -- last transfer of the array or sequence
    valid : std_logic;
  end record;

  constant INT64_ITEMS_STREAM_IDLE : int64_items_stream_t := (
    data => (others => (others => '0')), last => '0', valid => '0');

  type uint64_items_stream_t is record
    data  : uint64_items_t(0 to 0);  -- zeros after the last item
    last  : std_logic;  -- last transfer of the array or sequence
    valid : std_logic;
  end record;

  constant UINT64_ITEMS_STREAM_IDLE : uint64_items_stream_t := (
    data => (others => (others => '0')), last => '0', valid => '0');

  type string_stream_t is record
    length : uint32_stream_t;       -- number of elements
    items  : uint8_items_stream_t;
  end record;

  type string_stream_ready_t is record
    length : std_logic;
    items  : std_logic;
  end record;

  constant STRING_STREAM_IDLE : string_stream_t := (
    length => UINT32_STREAM_IDLE,
    items  => UINT8_ITEMS_STREAM_IDLE);

  constant STRING_STREAM_ALL_READY : string_stream_ready_t := (
    length => '1',
    items  => '1');

  type wstring_stream_t is record
    length : uint32_stream_t;        -- number of elements
    items  : uint32_items_stream_t;
  end record;

  type wstring_stream_ready_t is record
    length : std_logic;
    items  : std_logic;
  end record;

  constant WSTRING_STREAM_IDLE : wstring_stream_t := (
    length => UINT32_STREAM_IDLE,
    items  => UINT32_ITEMS_STREAM_IDLE);

  constant WSTRING_STREAM_ALL_READY : wstring_stream_ready_t := (
    length => '1',
    items  => '1');

  type bool_sequence_stream_t is record
    length : uint32_stream_t;      -- number of elements
    items  : bool_items_stream_t;
  end record;

  type bool_sequence_stream_ready_t is record
    length : std_logic;
    items  : std_logic;
  end record;

  constant BOOL_SEQUENCE_STREAM_IDLE : bool_sequence_stream_t := (
    length => UINT32_STREAM_IDLE,
    items  => BOOL_ITEMS_STREAM_IDLE);

  constant BOOL_SEQUENCE_STREAM_ALL_READY : bool_sequence_stream_ready_t := (
    length => '1',
    items  => '1');

  type bool_array_stream_t is record
    items : bool_items_stream_t;
  end record;

  type bool_array_stream_ready_t is record
    items : std_logic;
  end record;

  constant BOOL_ARRAY_STREAM_IDLE : bool_array_stream_t := (
    items => BOOL_ITEMS_STREAM_IDLE);

  constant BOOL_ARRAY_STREAM_ALL_READY : bool_array_stream_ready_t := (
    items => '1');

  type float32_sequence_stream_t is record
    length : uint32_stream_t;         -- number of elements
    items  : float32_items_stream_t;
  end record;

  type float32_sequence_stream_ready_t is record
    length : std_logic;
    items  : std_logic;
  end record;

  constant FLOAT32_SEQUENCE_STREAM_IDLE : float32_sequence_stream_t := (
    length => UINT32_STREAM_IDLE,
    items  => FLOAT32_ITEMS_STREAM_IDLE);

  constant FLOAT32_SEQUENCE_STREAM_ALL_READY : float32_sequence_stream_ready_t := (
    length => '1',
    items  => '1');

  type float32_array_stream_t is record
    items : float32_items_stream_t;
  end record;

  type float32_array_stream_ready_t is record
    items : std_logic;
  end record;

  constant FLOAT32_ARRAY_STREAM_IDLE : float32_array_stream_t := (
    items => FLOAT32_ITEMS_STREAM_IDLE);

  constant FLOAT32_ARRAY_STREAM_ALL_READY : float32_array_stream_ready_t := (
    items => '1');

  type float64_sequence_stream_t is record
    length : uint32_stream_t;         -- number of elements
    items  : float64_items_stream_t;
  end record;

  type float64_sequence_stream_ready_t is record
    length : std_logic;
    items  : std_logic;
  end record;

  constant FLOAT64_SEQUENCE_STREAM_IDLE : float64_sequence_stream_t := (
    length => UINT32_STREAM_IDLE,
    items  => FLOAT64_ITEMS_STREAM_IDLE);

  constant FLOAT64_SEQUENCE_STREAM_ALL_READY : float64_sequence_stream_ready_t := (
    length => '1',
    items  => '1');

  type float64_array_stream_t is record
    items : float64_items_stream_t;
  end record;

  type float64_array_stream_ready_t is record
    items : std_logic;
  end record;

  constant FLOAT64_ARRAY_STREAM_IDLE : float64_array_stream_t := (
    items => FLOAT64_ITEMS_STREAM_IDLE);

  constant FLOAT64_ARRAY_STREAM_ALL_READY : float64_array_stream_ready_t := (
    items => '1');

  type int8_sequence_stream_t is record
    length : uint32_stream_t;      -- number of elements
    items  : int8_items_stream_t;
  end record;

  type int8_sequence_stream_ready_t is record
    length : std_logic;
    items  : std_logic;
  end record;

  constant INT8_SEQUENCE_STREAM_IDLE : int8_sequence_stream_t := (
    length => UINT32_STREAM_IDLE,
    items  => INT8_ITEMS_STREAM_IDLE);

  constant INT8_SEQUENCE_STREAM_ALL_READY : int8_sequence_stream_ready_t := (
    length => '1',
    items  => '1');

  type int8_array_stream_t is record
    items : int8_items_stream_t;
  end record;

  type int8_array_stream_ready_t is record
    items : std_logic;
  end record;

  constant INT8_ARRAY_STREAM_IDLE : int8_array_stream_t := (
    items => INT8_ITEMS_STREAM_IDLE);

  constant INT8_ARRAY_STREAM_ALL_READY : int8_array_stream_ready_t := (
    items => '1');

  type uint8_sequence_stream_t is record
    length : uint32_stream_t;       -- number of elements
    items  : uint8_items_stream_t;
  end record;

  type uint8_sequence_stream_ready_t is record
    length : std_logic;
    items  : std_logic;
  end record;

  constant UINT8_SEQUENCE_STREAM_IDLE : uint8_sequence_stream_t := (
    length => UINT32_STREAM_IDLE,
    items  => UINT8_ITEMS_STREAM_IDLE);

  constant UINT8_SEQUENCE_STREAM_ALL_READY : uint8_sequence_stream_ready_t := (
    length => '1',
    items  => '1');

  type uint8_array_stream_t is record
    items : uint8_items_stream_t;
  end record;

  type uint8_array_stream_ready_t is record
    items : std_logic;
  end record;

  constant UINT8_ARRAY_STREAM_IDLE : uint8_array_stream_t := (
    items => UINT8_ITEMS_STREAM_IDLE);

  constant UINT8_ARRAY_STREAM_ALL_READY : uint8_array_stream_ready_t := (
    items => '1');

  type int16_sequence_stream_t is record
    length : uint32_stream_t;       -- number of elements
    items  : int16_items_stream_t;
  end record;

  type int16_sequence_stream_ready_t is record
    length : std_logic;
    items  : std_logic;
  end record;

  constant INT16_SEQUENCE_STREAM_IDLE : int16_sequence_stream_t := (
    length => UINT32_STREAM_IDLE,
    items  => INT16_ITEMS_STREAM_IDLE);

  constant INT16_SEQUENCE_STREAM_ALL_READY : int16_sequence_stream_ready_t := (
    length => '1',
    items  => '1');

  type int16_array_stream_t is record
    items : int16_items_stream_t;
  end record;

  type int16_array_stream_ready_t is record
    items : std_logic;
  end record;

  constant INT16_ARRAY_STREAM_IDLE : int16_array_stream_t := (
    items => INT16_ITEMS_STREAM_IDLE);

  constant INT16_ARRAY_STREAM_ALL_READY : int16_array_stream_ready_t := (
    items => '1');

  type uint16_sequence_stream_t is record
    length : uint32_stream_t;        -- number of elements
    items  : uint16_items_stream_t;
  end record;

  type uint16_sequence_stream_ready_t is record
    length : std_logic;
    items  : std_logic;
  end record;

  constant UINT16_SEQUENCE_STREAM_IDLE : uint16_sequence_stream_t := (
    length => UINT32_STREAM_IDLE,
    items  => UINT16_ITEMS_STREAM_IDLE);

  constant UINT16_SEQUENCE_STREAM_ALL_READY : uint16_sequence_stream_ready_t := (
    length => '1',
    items  => '1');

  type uint16_array_stream_t is record
    items : uint16_items_stream_t;
  end record;

  type uint16_array_stream_ready_t is record
    items : std_logic;
  end record;

  constant UINT16_ARRAY_STREAM_IDLE : uint16_array_stream_t := (
    items => UINT16_ITEMS_STREAM_IDLE);

  constant UINT16_ARRAY_STREAM_ALL_READY : uint16_array_stream_ready_t := (
    items => '1');

  type int32_sequence_stream_t is record
    length : uint32_stream_t;       -- number of elements
    items  : int32_items_stream_t;
  end record;

  type int32_sequence_stream_ready_t is record
    length : std_logic;
    items  : std_logic;
  end record;

  constant INT32_SEQUENCE_STREAM_IDLE : int32_sequence_stream_t := (
    length => UINT32_STREAM_IDLE,
    items  => INT32_ITEMS_STREAM_IDLE);

  constant INT32_SEQUENCE_STREAM_ALL_READY : int32_sequence_stream_ready_t := (
    length => '1',
    items  => '1');

  type int32_array_stream_t is record
    items : int32_items_stream_t;
  end record;

  type int32_array_stream_ready_t is record
    items : std_logic;
  end record;

  constant INT32_ARRAY_STREAM_IDLE : int32_array_stream_t := (
    items => INT32_ITEMS_STREAM_IDLE);

  constant INT32_ARRAY_STREAM_ALL_READY : int32_array_stream_ready_t := (
    items => '1');

  type uint32_sequence_stream_t is record
    length : uint32_stream_t;        -- number of elements
    items  : uint32_items_stream_t;
  end record;

  type uint32_sequence_stream_ready_t is record
    length : std_logic;
    items  : std_logic;
  end record;

  constant UINT32_SEQUENCE_STREAM_IDLE : uint32_sequence_stream_t := (
    length => UINT32_STREAM_IDLE,
    items  => UINT32_ITEMS_STREAM_IDLE);

  constant UINT32_SEQUENCE_STREAM_ALL_READY : uint32_sequence_stream_ready_t := (
    length => '1',
    items  => '1');

  type uint32_array_stream_t is record
    items : uint32_items_stream_t;
  end record;

  type uint32_array_stream_ready_t is record
    items : std_logic;
  end record;

  constant UINT32_ARRAY_STREAM_IDLE : uint32_array_stream_t := (
    items => UINT32_ITEMS_STREAM_IDLE);

  constant UINT32_ARRAY_STREAM_ALL_READY : uint32_array_stream_ready_t := (
    items => '1');

  type int64_sequence_stream_t is record
    length : uint32_stream_t;       -- number of elements
    items  : int64_items_stream_t;
  end record;

  type int64_sequence_stream_ready_t is record
    length : std_logic;
    items  : std_logic;
  end record;

  constant INT64_SEQUENCE_STREAM_IDLE : int64_sequence_stream_t := (
    length => UINT32_STREAM_IDLE,
    items  => INT64_ITEMS_STREAM_IDLE);

  constant INT64_SEQUENCE_STREAM_ALL_READY : int64_sequence_stream_ready_t := (
    length => '1',
    items  => '1');

  type int64_array_stream_t is record
    items : int64_items_stream_t;
  end record;

  type int64_array_stream_ready_t is record
    items : std_logic;
  end record;

  constant INT64_ARRAY_STREAM_IDLE : int64_array_stream_t := (
    items => INT64_ITEMS_STREAM_IDLE);

  constant INT64_ARRAY_STREAM_ALL_READY : int64_array_stream_ready_t := (
    items => '1');

  type uint64_sequence_stream_t is record
    length : uint32_stream_t;        -- number of elements
    items  : uint64_items_stream_t;
  end record;

  type uint64_sequence_stream_ready_t is record
    length : std_logic;
    items  : std_logic;
  end record;

  constant UINT64_SEQUENCE_STREAM_IDLE : uint64_sequence_stream_t := (
    length => UINT32_STREAM_IDLE,
    items  => UINT64_ITEMS_STREAM_IDLE);

  constant UINT64_SEQUENCE_STREAM_ALL_READY : uint64_sequence_stream_ready_t := (
    length => '1',
    items  => '1');

  type uint64_array_stream_t is record
    items : uint64_items_stream_t;
  end record;

  type uint64_array_stream_ready_t is record
    items : std_logic;
  end record;

  constant UINT64_ARRAY_STREAM_IDLE : uint64_array_stream_t := (
    items => UINT64_ITEMS_STREAM_IDLE);

  constant UINT64_ARRAY_STREAM_ALL_READY : uint64_array_stream_ready_t := (
    items => '1');

  type string_sequence_stream_t is record
    length : uint32_stream_t;  -- number of elements
    item   : string_stream_t;
  end record;

  type string_sequence_stream_ready_t is record
    length : std_logic;
    item   : string_stream_ready_t;
  end record;

  constant STRING_SEQUENCE_STREAM_IDLE : string_sequence_stream_t := (
    length => UINT32_STREAM_IDLE,
    item   => STRING_STREAM_IDLE);

  constant STRING_SEQUENCE_STREAM_ALL_READY : string_sequence_stream_ready_t := (
    length => '1',
    item   => STRING_STREAM_ALL_READY);

  type string_array_stream_t is record
    item : string_stream_t;
  end record;

  type string_array_stream_ready_t is record
    item : string_stream_ready_t;
  end record;

  constant STRING_ARRAY_STREAM_IDLE : string_array_stream_t := (
    item => STRING_STREAM_IDLE);

  constant STRING_ARRAY_STREAM_ALL_READY : string_array_stream_ready_t := (
    item => STRING_STREAM_ALL_READY);

  type wstring_sequence_stream_t is record
    length : uint32_stream_t;   -- number of elements
    item   : wstring_stream_t;
  end record;

  type wstring_sequence_stream_ready_t is record
    length : std_logic;
    item   : wstring_stream_ready_t;
  end record;

  constant WSTRING_SEQUENCE_STREAM_IDLE : wstring_sequence_stream_t := (
    length => UINT32_STREAM_IDLE,
    item   => WSTRING_STREAM_IDLE);

  constant WSTRING_SEQUENCE_STREAM_ALL_READY : wstring_sequence_stream_ready_t := (
    length => '1',
    item   => WSTRING_STREAM_ALL_READY);

  type wstring_array_stream_t is record
    item : wstring_stream_t;
  end record;

  type wstring_array_stream_ready_t is record
    item : wstring_stream_ready_t;
  end record;

  constant WSTRING_ARRAY_STREAM_IDLE : wstring_array_stream_t := (
    item => WSTRING_STREAM_IDLE);

  constant WSTRING_ARRAY_STREAM_ALL_READY : wstring_array_stream_ready_t := (
    item => WSTRING_STREAM_ALL_READY);

end package firm_hdl_bus_8_pkg;
