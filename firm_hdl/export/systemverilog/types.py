"""The SystemVerilog packages that all messages share: one of primitives, one per bus width.

Their texts do not depend on the message type. So a task for a `float64_stream_t`, for example,
works for all message types, and all converters of a design have the same status type.
"""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.export.primitives import PRIMITIVE_BITS, PRIMITIVE_BYTES
from firm_hdl.export.records import shared_records
from firm_hdl.export.systemverilog.structs import guarded, stream_structs, struct
from firm_hdl.export.templates import text_of

__all__ = [
    "BEAT",
    "STATUS",
    "STATUS_STREAM",
    "TYPES_NAME",
    "WORDS",
    "bus_name",
    "bus_package",
    "types_package",
]

TYPES_NAME = "firm_hdl_sv_pkg"
"""Name of the package of primitives."""

STATUS, STATUS_STREAM, BEAT = "packet_status_t", "packet_status_stream_t", "packet_beat_t"
"""Names of types: the status of a packet, the stream of statuses, and the stream of beats."""

WORDS = frozenset(
    [
        *(STATUS, STATUS_STREAM, BEAT, TYPES_NAME),
        *("packet_status_stream_idle", "packet_beat_idle"),
        *(f"{primitive}_data_t" for primitive in PRIMITIVE_BITS),
    ]
)
"""Names that these packages declare and the VHDL packages do not, in lower case."""


def bus_name(bus_bytes: int) -> str:
    """Return the name of the package of a bus width."""
    return f"firm_hdl_bus_{bus_bytes}_sv_pkg"


def types_package() -> str:
    """Return the package of primitives, a file beside this module."""
    return text_of(f"systemverilog/{TYPES_NAME}.sv")


def bus_package(bus_bytes: int) -> str:
    """Write the package of a bus width."""
    head = (
        f"// Packets on a bus of {bus_bytes} bytes, and streams of strings, arrays and sequences "
        "on it,\n// for all message types.\n\n"
    )
    return head + guarded(bus_name(bus_bytes), _bus(bus_bytes))


def _bus(bus_bytes: int) -> Iterator[str]:
    name = bus_name(bus_bytes)
    yield f"package {name};\n\n  import {TYPES_NAME}::*;\n"
    yield "\n  // AXI4-Stream. A deserializer ignores tuser.\n"
    first = "bytes of the packet, the first one in bits 7 to 0"
    yield from struct(
        BEAT,
        [
            ("tdata", f"logic [{8 * bus_bytes - 1}:0]", first, ()),
            ("tkeep", f"logic [{bus_bytes - 1}:0]", "valid bytes, from lane 0 on", ()),
            ("tlast", "logic", "last beat of the packet", ()),
            ("tuser", "logic", "with tlast: the packet's status is not OK", ()),
            ("tvalid", "logic", "", ()),
        ],
    )
    yield f"\n  localparam {BEAT} PACKET_BEAT_IDLE = '0;\n"
    for primitive, size in PRIMITIVE_BYTES.items():
        yield from _items(primitive, max(1, bus_bytes // size))
    for record in shared_records():
        yield from stream_structs(record)
    yield f"\nendpackage : {name}\n"


def _items(primitive: str, lanes: int) -> Iterator[str]:
    kind = f"{primitive}_items_stream"
    first = "the first item at index 0; zeros after the last item"
    yield from struct(
        f"{kind}_t",
        [
            ("data", f"{primitive}_data_t [{lanes - 1}:0]", first, ()),
            ("last", "logic", "last transfer of the array or sequence", ()),
            ("valid", "logic", "", ()),
        ],
    )
    yield f"\n  localparam {kind}_t {kind.upper()}_IDLE = '0;\n"
