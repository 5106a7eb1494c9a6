"""The VHDL package of a bus width: strings, arrays and sequences of primitives as streams.

The number of items in a transfer depends only on the primitive and on the width of the bus. So all
messages on a bus of one width have these types in common.
"""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.export.primitives import PRIMITIVE_BYTES, TEXTS, TYPES_NAME, bus_name
from firm_hdl.export.vhdl.records import Element, stream_record

__all__ = ["bus_package"]

_LENGTH = Element(
    name="length",
    type="uint32_stream_t",
    ready_type="std_logic",
    idle="UINT32_STREAM_IDLE",
    all_ready="'1'",
    remark="  -- number of elements",
)


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
    for text, primitive in TEXTS.items():
        yield from stream_record(f"{text}_stream", [_LENGTH, _of_items(primitive)])
    for primitive in PRIMITIVE_BYTES:
        items = _of_items(primitive)
        yield from stream_record(f"{primitive}_sequence_stream", [_LENGTH, items])
        yield from stream_record(f"{primitive}_array_stream", [items])
    for text in TEXTS:
        item = Element(
            name="item",
            type=f"{text}_stream_t",
            ready_type=f"{text}_stream_ready_t",
            idle=f"{text.upper()}_STREAM_IDLE",
            all_ready=f"{text.upper()}_STREAM_ALL_READY",
        )
        yield from stream_record(f"{text}_sequence_stream", [_LENGTH, item])
        yield from stream_record(f"{text}_array_stream", [item])
    yield f"\nend package {name};\n"


def _items(primitive: str, lanes: int) -> Iterator[str]:
    zeros = "(others => '0')" if primitive == "bool" else "(others => (others => '0'))"
    yield (
        f"\n  type {primitive}_items_stream_t is record\n"
        f"    data  : {primitive}_items_t(0 to {lanes - 1});  -- zeros behind the last item\n"
        "    last  : std_logic;  -- last transfer of the array or sequence\n"
        "    valid : std_logic;\n"
        "  end record;\n"
        f"\n  constant {primitive.upper()}_ITEMS_STREAM_IDLE : {primitive}_items_stream_t := (\n"
        f"    data => {zeros}, last => '0', valid => '0');\n"
    )


def _of_items(primitive: str) -> Element:
    return Element(
        name="items",
        type=f"{primitive}_items_stream_t",
        ready_type="std_logic",
        idle=f"{primitive.upper()}_ITEMS_STREAM_IDLE",
        all_ready="'1'",
    )
