"""The VHDL package that all messages share: streams of primitives, and status codes.

Its text does not depend on the message type. So a procedure for, say, a `float64_stream_t` works
for all types and bus widths, and all converters of a design have the same status codes.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from firm_hdl.export.primitives import PRIMITIVE_BITS, TYPES_NAME
from firm_hdl.gateware.signatures import Status

__all__ = ["data_type", "types_package"]

_INTEGERS = [(f"{sign}int{bits}", bits) for bits in (8, 16, 32, 64) for sign in ("", "u")]
_DATA = {
    "bool": ("std_logic", "'1' is true"),
    **{
        name: (f"{'un' if name[0] == 'u' else ''}signed({bits - 1} downto 0)", "")
        for name, bits in _INTEGERS
    },
    "float32": ("std_logic_vector(31 downto 0)", "IEEE 754 bits"),
    "float64": ("std_logic_vector(63 downto 0)", "IEEE 754 bits"),
}

_HEAD = f"""\
-- Streams of ROS's primitive types, for all message types and bus widths.
--
-- A transfer happens at a rising clock edge at which valid and ready are both '1'. The source sets
-- valid without waiting for ready, and keeps valid and the data unchanged until the transfer.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

package {TYPES_NAME} is

  -- Status of a packet on m_axis_status_tdata, one transfer per packet.
"""


def data_type(primitive: str) -> str:
    """Return the VHDL type of a primitive's value.

    >>> data_type("int16"), data_type("bool")
    ('signed(15 downto 0)', 'std_logic')
    """
    return _DATA[primitive][0]


def types_package() -> str:
    """Write the package and its body."""
    return "".join([_HEAD, *_statuses(), *_declarations(), *_bodies()])


def _statuses() -> Iterator[str]:
    statuses: Any = Status
    width = max(len(status.name) for status in statuses)
    for status in statuses:
        name = f"STATUS_{status.name}".ljust(width + 7)
        yield f'  constant {name} : std_logic_vector(7 downto 0) := x"{status.value:02x}";\n'
    yield "\n  -- The name of a status, for messages of test benches.\n"
    yield "  function status_name (status : std_logic_vector(7 downto 0)) return string;\n"


def _declarations() -> Iterator[str]:
    for name, (data, remark) in _DATA.items():
        comment = f"  -- {remark}" if remark else ""
        yield (
            f"\n  type {name}_stream_t is record\n"
            f"    data  : {data};{comment}\n"
            "    valid : std_logic;\n"
            "  end record;\n"
        )
    yield "\n  -- Idle streams: valid is '0'.\n"
    width = max(map(len, _DATA))
    for name in _DATA:
        zero = "'0'" if name == "bool" else "(others => '0')"
        constant = f"{name.upper()}_STREAM_IDLE".ljust(width + 12)
        yield (
            f"  constant {constant} : {name + '_stream_t':{width + 9}} :="
            f" (data => {zero}, valid => '0');\n"
        )
    yield "\n  -- Items of one transfer, the first one at index 0.\n"
    for name, (data, _) in _DATA.items():
        yield f"  type {name}_items_t is array (natural range <>) of {data};\n"
    yield "\n  -- Conversion between items and vectors, with the first item in the lowest bits.\n"
    for name in _DATA:
        yield f"  {_TO_SLV.format(name=name)};\n  {_TO_ITEMS.format(name=name)};\n"
    yield f"\nend package {TYPES_NAME};\n"


_TO_SLV = "function to_slv (items : {name}_items_t) return std_logic_vector"
_TO_ITEMS = "function to_{name}_items (bits : std_logic_vector) return {name}_items_t"


def _bodies() -> Iterator[str]:
    yield f"\npackage body {TYPES_NAME} is\n"
    yield "\n  function status_name (status : std_logic_vector(7 downto 0)) return string is\n"
    yield "  begin\n    case status is\n"
    statuses: Any = Status
    for status in statuses:
        yield f'      when STATUS_{status.name} => return "{status.name}";\n'
    yield '      when others => return "UNKNOWN";\n    end case;\n  end function;\n'
    for name in _DATA:
        yield from _conversions(name)
    yield f"\nend package body {TYPES_NAME};\n"


def _conversions(name: str) -> Iterator[str]:
    bits = PRIMITIVE_BITS[name]
    kind = _DATA[name][0].partition("(")[0]
    if bits == 1:
        size, part, into, outof = "items'length", "(k)", "all_items(k)", "{}"
        number = "bits'length"
    else:
        size, number = f"{bits} * items'length", f"bits'length / {bits}"
        part = f"({bits} * k + {bits - 1} downto {bits} * k)"
        into = "all_items(k)" if kind == "std_logic_vector" else "std_logic_vector(all_items(k))"
        outof = "{}" if kind == "std_logic_vector" else f"{kind}({{}})"
    yield (
        f"\n  {_TO_SLV.format(name=name)} is\n"
        f"    alias all_items : {name}_items_t(0 to items'length - 1) is items;\n"
        f"    variable result : std_logic_vector({size} - 1 downto 0);\n"
        "  begin\n"
        "    for k in all_items'range loop\n"
        f"      result{part} := {into};\n"
        "    end loop;\n"
        "    return result;\n"
        "  end function;\n"
        f"\n  {_TO_ITEMS.format(name=name)} is\n"
        "    alias all_bits : std_logic_vector(bits'length - 1 downto 0) is bits;\n"
        f"    variable result : {name}_items_t(0 to {number} - 1);\n"
        "  begin\n"
        "    for k in result'range loop\n"
        f"      result(k) := {outof.format('all_bits' + part)};\n"
        "    end loop;\n"
        "    return result;\n"
        "  end function;\n"
    )
