"""The VHDL package of a bus width: strings, arrays and sequences of primitives as streams.

The number of items in a transfer depends only on the primitive and on the width of the bus. So all
messages on a bus of one width share these types.
"""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.export.primitives import PRIMITIVE_BYTES, TYPES_NAME, bus_name
from firm_hdl.export.records import shared_records
from firm_hdl.export.vhdl.records import stream_record

__all__ = ["bus_package"]


def bus_package(bus_bytes: int) -> str:
    """Write the package."""
    return "".join(_package(bus_bytes))


def _package(bus_bytes: int) -> Iterator[str]:
    name = bus_name(bus_bytes)
    yield f"""\
-- Streams of strings, arrays and sequences on a bus of {bus_bytes} bytes, for all message types.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.{TYPES_NAME}.all;

package {name} is
"""
    for primitive, size in PRIMITIVE_BYTES.items():
        yield from _items(primitive, max(1, bus_bytes // size))
    for record in shared_records():
        yield from stream_record(record)
    yield f"\nend package {name};\n"


def _items(primitive: str, lanes: int) -> Iterator[str]:
    zeros = "(others => '0')" if primitive == "bool" else "(others => (others => '0'))"
    yield (
        f"\n  type {primitive}_items_stream_t is record\n"
        f"    data  : {primitive}_items_t(0 to {lanes - 1});  -- zeros after the last item\n"
        "    last  : std_logic;  -- last transfer of the array or sequence\n"
        "    valid : std_logic;\n"
        "  end record;\n"
        f"\n  constant {primitive.upper()}_ITEMS_STREAM_IDLE : {primitive}_items_stream_t := (\n"
        f"    data => {zeros}, last => '0', valid => '0');\n"
    )
