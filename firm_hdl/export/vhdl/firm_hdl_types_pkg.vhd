-- Streams of ROS's primitive types, for all message types and bus widths.
--
-- A transfer happens at a rising clock edge at which valid and ready are both '1'. The source sets
-- valid without waiting for ready, and keeps valid and the data unchanged until the transfer.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

package firm_hdl_types_pkg is

  -- Status of a packet on m_axis_status_tdata, one transfer per packet.
  constant STATUS_OK            : std_logic_vector(7 downto 0) := x"00";
  constant STATUS_TRUNCATED     : std_logic_vector(7 downto 0) := x"01";
  constant STATUS_TRAILING      : std_logic_vector(7 downto 0) := x"02";
  constant STATUS_LENGTH        : std_logic_vector(7 downto 0) := x"03";
  constant STATUS_ENCAPSULATION : std_logic_vector(7 downto 0) := x"04";
  constant STATUS_STRING        : std_logic_vector(7 downto 0) := x"05";
  constant STATUS_ITEMS         : std_logic_vector(7 downto 0) := x"06";

  -- The name of a status, for messages of test benches.
  function status_name (status : std_logic_vector(7 downto 0)) return string;

  type bool_stream_t is record
    data  : std_logic;  -- '1' is true
    valid : std_logic;
  end record;

  type int8_stream_t is record
    data  : signed(7 downto 0);
    valid : std_logic;
  end record;

  type uint8_stream_t is record
    data  : unsigned(7 downto 0);
    valid : std_logic;
  end record;

  type int16_stream_t is record
    data  : signed(15 downto 0);
    valid : std_logic;
  end record;

  type uint16_stream_t is record
    data  : unsigned(15 downto 0);
    valid : std_logic;
  end record;

  type int32_stream_t is record
    data  : signed(31 downto 0);
    valid : std_logic;
  end record;

  type uint32_stream_t is record
    data  : unsigned(31 downto 0);
    valid : std_logic;
  end record;

  type int64_stream_t is record
    data  : signed(63 downto 0);
    valid : std_logic;
  end record;

  type uint64_stream_t is record
    data  : unsigned(63 downto 0);
    valid : std_logic;
  end record;

  type float32_stream_t is record
    data  : std_logic_vector(31 downto 0);  -- IEEE 754 bits
    valid : std_logic;
  end record;

  type float64_stream_t is record
    data  : std_logic_vector(63 downto 0);  -- IEEE 754 bits
    valid : std_logic;
  end record;

  -- Idle streams: valid is '0'.
  constant BOOL_STREAM_IDLE    : bool_stream_t    := (data => '0', valid => '0');
  constant INT8_STREAM_IDLE    : int8_stream_t    := (data => (others => '0'), valid => '0');
  constant UINT8_STREAM_IDLE   : uint8_stream_t   := (data => (others => '0'), valid => '0');
  constant INT16_STREAM_IDLE   : int16_stream_t   := (data => (others => '0'), valid => '0');
  constant UINT16_STREAM_IDLE  : uint16_stream_t  := (data => (others => '0'), valid => '0');
  constant INT32_STREAM_IDLE   : int32_stream_t   := (data => (others => '0'), valid => '0');
  constant UINT32_STREAM_IDLE  : uint32_stream_t  := (data => (others => '0'), valid => '0');
  constant INT64_STREAM_IDLE   : int64_stream_t   := (data => (others => '0'), valid => '0');
  constant UINT64_STREAM_IDLE  : uint64_stream_t  := (data => (others => '0'), valid => '0');
  constant FLOAT32_STREAM_IDLE : float32_stream_t := (data => (others => '0'), valid => '0');
  constant FLOAT64_STREAM_IDLE : float64_stream_t := (data => (others => '0'), valid => '0');

  -- Items of one transfer, the first one at index 0.
  type bool_items_t is array (natural range <>) of std_logic;
  type int8_items_t is array (natural range <>) of signed(7 downto 0);
  type uint8_items_t is array (natural range <>) of unsigned(7 downto 0);
  type int16_items_t is array (natural range <>) of signed(15 downto 0);
  type uint16_items_t is array (natural range <>) of unsigned(15 downto 0);
  type int32_items_t is array (natural range <>) of signed(31 downto 0);
  type uint32_items_t is array (natural range <>) of unsigned(31 downto 0);
  type int64_items_t is array (natural range <>) of signed(63 downto 0);
  type uint64_items_t is array (natural range <>) of unsigned(63 downto 0);
  type float32_items_t is array (natural range <>) of std_logic_vector(31 downto 0);
  type float64_items_t is array (natural range <>) of std_logic_vector(63 downto 0);

  -- Conversion between items and vectors, with the first item in the lowest bits.
  function to_slv (items : bool_items_t) return std_logic_vector;
  function to_bool_items (bits : std_logic_vector) return bool_items_t;
  function to_slv (items : int8_items_t) return std_logic_vector;
  function to_int8_items (bits : std_logic_vector) return int8_items_t;
  function to_slv (items : uint8_items_t) return std_logic_vector;
  function to_uint8_items (bits : std_logic_vector) return uint8_items_t;
  function to_slv (items : int16_items_t) return std_logic_vector;
  function to_int16_items (bits : std_logic_vector) return int16_items_t;
  function to_slv (items : uint16_items_t) return std_logic_vector;
  function to_uint16_items (bits : std_logic_vector) return uint16_items_t;
  function to_slv (items : int32_items_t) return std_logic_vector;
  function to_int32_items (bits : std_logic_vector) return int32_items_t;
  function to_slv (items : uint32_items_t) return std_logic_vector;
  function to_uint32_items (bits : std_logic_vector) return uint32_items_t;
  function to_slv (items : int64_items_t) return std_logic_vector;
  function to_int64_items (bits : std_logic_vector) return int64_items_t;
  function to_slv (items : uint64_items_t) return std_logic_vector;
  function to_uint64_items (bits : std_logic_vector) return uint64_items_t;
  function to_slv (items : float32_items_t) return std_logic_vector;
  function to_float32_items (bits : std_logic_vector) return float32_items_t;
  function to_slv (items : float64_items_t) return std_logic_vector;
  function to_float64_items (bits : std_logic_vector) return float64_items_t;

end package firm_hdl_types_pkg;

package body firm_hdl_types_pkg is

  function status_name (status : std_logic_vector(7 downto 0)) return string is
  begin
    case status is
      when STATUS_OK => return "OK";
      when STATUS_TRUNCATED => return "TRUNCATED";
      when STATUS_TRAILING => return "TRAILING";
      when STATUS_LENGTH => return "LENGTH";
      when STATUS_ENCAPSULATION => return "ENCAPSULATION";
      when STATUS_STRING => return "STRING";
      when STATUS_ITEMS => return "ITEMS";
      when others => return "UNKNOWN";
    end case;
  end function;

  function to_slv (items : bool_items_t) return std_logic_vector is
    alias all_items : bool_items_t(0 to items'length - 1) is items;
    variable result : std_logic_vector(items'length - 1 downto 0);
  begin
    for k in all_items'range loop
      result(k) := all_items(k);
    end loop;
    return result;
  end function;

  function to_bool_items (bits : std_logic_vector) return bool_items_t is
    alias all_bits : std_logic_vector(bits'length - 1 downto 0) is bits;
    variable result : bool_items_t(0 to bits'length - 1);
  begin
    for k in result'range loop
      result(k) := all_bits(k);
    end loop;
    return result;
  end function;

  function to_slv (items : int8_items_t) return std_logic_vector is
    alias all_items : int8_items_t(0 to items'length - 1) is items;
    variable result : std_logic_vector(8 * items'length - 1 downto 0);
  begin
    for k in all_items'range loop
      result(8 * k + 7 downto 8 * k) := std_logic_vector(all_items(k));
    end loop;
    return result;
  end function;

  function to_int8_items (bits : std_logic_vector) return int8_items_t is
    alias all_bits : std_logic_vector(bits'length - 1 downto 0) is bits;
    variable result : int8_items_t(0 to bits'length / 8 - 1);
  begin
    for k in result'range loop
      result(k) := signed(all_bits(8 * k + 7 downto 8 * k));
    end loop;
    return result;
  end function;

  function to_slv (items : uint8_items_t) return std_logic_vector is
    alias all_items : uint8_items_t(0 to items'length - 1) is items;
    variable result : std_logic_vector(8 * items'length - 1 downto 0);
  begin
    for k in all_items'range loop
      result(8 * k + 7 downto 8 * k) := std_logic_vector(all_items(k));
    end loop;
    return result;
  end function;

  function to_uint8_items (bits : std_logic_vector) return uint8_items_t is
    alias all_bits : std_logic_vector(bits'length - 1 downto 0) is bits;
    variable result : uint8_items_t(0 to bits'length / 8 - 1);
  begin
    for k in result'range loop
      result(k) := unsigned(all_bits(8 * k + 7 downto 8 * k));
    end loop;
    return result;
  end function;

  function to_slv (items : int16_items_t) return std_logic_vector is
    alias all_items : int16_items_t(0 to items'length - 1) is items;
    variable result : std_logic_vector(16 * items'length - 1 downto 0);
  begin
    for k in all_items'range loop
      result(16 * k + 15 downto 16 * k) := std_logic_vector(all_items(k));
    end loop;
    return result;
  end function;

  function to_int16_items (bits : std_logic_vector) return int16_items_t is
    alias all_bits : std_logic_vector(bits'length - 1 downto 0) is bits;
    variable result : int16_items_t(0 to bits'length / 16 - 1);
  begin
    for k in result'range loop
      result(k) := signed(all_bits(16 * k + 15 downto 16 * k));
    end loop;
    return result;
  end function;

  function to_slv (items : uint16_items_t) return std_logic_vector is
    alias all_items : uint16_items_t(0 to items'length - 1) is items;
    variable result : std_logic_vector(16 * items'length - 1 downto 0);
  begin
    for k in all_items'range loop
      result(16 * k + 15 downto 16 * k) := std_logic_vector(all_items(k));
    end loop;
    return result;
  end function;

  function to_uint16_items (bits : std_logic_vector) return uint16_items_t is
    alias all_bits : std_logic_vector(bits'length - 1 downto 0) is bits;
    variable result : uint16_items_t(0 to bits'length / 16 - 1);
  begin
    for k in result'range loop
      result(k) := unsigned(all_bits(16 * k + 15 downto 16 * k));
    end loop;
    return result;
  end function;

  function to_slv (items : int32_items_t) return std_logic_vector is
    alias all_items : int32_items_t(0 to items'length - 1) is items;
    variable result : std_logic_vector(32 * items'length - 1 downto 0);
  begin
    for k in all_items'range loop
      result(32 * k + 31 downto 32 * k) := std_logic_vector(all_items(k));
    end loop;
    return result;
  end function;

  function to_int32_items (bits : std_logic_vector) return int32_items_t is
    alias all_bits : std_logic_vector(bits'length - 1 downto 0) is bits;
    variable result : int32_items_t(0 to bits'length / 32 - 1);
  begin
    for k in result'range loop
      result(k) := signed(all_bits(32 * k + 31 downto 32 * k));
    end loop;
    return result;
  end function;

  function to_slv (items : uint32_items_t) return std_logic_vector is
    alias all_items : uint32_items_t(0 to items'length - 1) is items;
    variable result : std_logic_vector(32 * items'length - 1 downto 0);
  begin
    for k in all_items'range loop
      result(32 * k + 31 downto 32 * k) := std_logic_vector(all_items(k));
    end loop;
    return result;
  end function;

  function to_uint32_items (bits : std_logic_vector) return uint32_items_t is
    alias all_bits : std_logic_vector(bits'length - 1 downto 0) is bits;
    variable result : uint32_items_t(0 to bits'length / 32 - 1);
  begin
    for k in result'range loop
      result(k) := unsigned(all_bits(32 * k + 31 downto 32 * k));
    end loop;
    return result;
  end function;

  function to_slv (items : int64_items_t) return std_logic_vector is
    alias all_items : int64_items_t(0 to items'length - 1) is items;
    variable result : std_logic_vector(64 * items'length - 1 downto 0);
  begin
    for k in all_items'range loop
      result(64 * k + 63 downto 64 * k) := std_logic_vector(all_items(k));
    end loop;
    return result;
  end function;

  function to_int64_items (bits : std_logic_vector) return int64_items_t is
    alias all_bits : std_logic_vector(bits'length - 1 downto 0) is bits;
    variable result : int64_items_t(0 to bits'length / 64 - 1);
  begin
    for k in result'range loop
      result(k) := signed(all_bits(64 * k + 63 downto 64 * k));
    end loop;
    return result;
  end function;

  function to_slv (items : uint64_items_t) return std_logic_vector is
    alias all_items : uint64_items_t(0 to items'length - 1) is items;
    variable result : std_logic_vector(64 * items'length - 1 downto 0);
  begin
    for k in all_items'range loop
      result(64 * k + 63 downto 64 * k) := std_logic_vector(all_items(k));
    end loop;
    return result;
  end function;

  function to_uint64_items (bits : std_logic_vector) return uint64_items_t is
    alias all_bits : std_logic_vector(bits'length - 1 downto 0) is bits;
    variable result : uint64_items_t(0 to bits'length / 64 - 1);
  begin
    for k in result'range loop
      result(k) := unsigned(all_bits(64 * k + 63 downto 64 * k));
    end loop;
    return result;
  end function;

  function to_slv (items : float32_items_t) return std_logic_vector is
    alias all_items : float32_items_t(0 to items'length - 1) is items;
    variable result : std_logic_vector(32 * items'length - 1 downto 0);
  begin
    for k in all_items'range loop
      result(32 * k + 31 downto 32 * k) := all_items(k);
    end loop;
    return result;
  end function;

  function to_float32_items (bits : std_logic_vector) return float32_items_t is
    alias all_bits : std_logic_vector(bits'length - 1 downto 0) is bits;
    variable result : float32_items_t(0 to bits'length / 32 - 1);
  begin
    for k in result'range loop
      result(k) := all_bits(32 * k + 31 downto 32 * k);
    end loop;
    return result;
  end function;

  function to_slv (items : float64_items_t) return std_logic_vector is
    alias all_items : float64_items_t(0 to items'length - 1) is items;
    variable result : std_logic_vector(64 * items'length - 1 downto 0);
  begin
    for k in all_items'range loop
      result(64 * k + 63 downto 64 * k) := all_items(k);
    end loop;
    return result;
  end function;

  function to_float64_items (bits : std_logic_vector) return float64_items_t is
    alias all_bits : std_logic_vector(bits'length - 1 downto 0) is bits;
    variable result : float64_items_t(0 to bits'length / 64 - 1);
  begin
    for k in result'range loop
      result(k) := all_bits(64 * k + 63 downto 64 * k);
    end loop;
    return result;
  end function;

end package body firm_hdl_types_pkg;
