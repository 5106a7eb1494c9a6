"""The SystemVerilog packages that all messages share: one of primitives, one per bus width.

Their texts do not depend on the message type. So a task for, say, a `float64_stream_t` works for
all types, and all converters of a design have the same status type.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from firm_hdl.export.primitives import FORMS, PRIMITIVE_BITS, PRIMITIVE_BYTES, TEXTS
from firm_hdl.export.systemverilog.structs import Member, constant, guarded, stream_structs, struct
from firm_hdl.gateware.signatures import Status

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

_IDLES = {STATUS_STREAM: "PACKET_STATUS_STREAM_IDLE", BEAT: "PACKET_BEAT_IDLE"}

WORDS = frozenset(
    [
        *(STATUS, STATUS_STREAM, BEAT, TYPES_NAME),
        *(name.lower() for name in _IDLES.values()),
        *(f"{primitive}_data_t" for primitive in PRIMITIVE_BITS),
    ]
)
"""Names that these packages declare and the VHDL packages do not, in lower case."""

_HEAD = """\
// Streams of ROS's primitive types, for all message types and bus widths.
//
// A transfer happens at a rising clock edge at which valid and ready are both 1. The source sets
// valid without waiting for ready, and keeps valid and the data unchanged until the transfer.

"""


def bus_name(bus_bytes: int) -> str:
    """Return the name of the package of a bus width."""
    return f"firm_hdl_bus_{bus_bytes}_sv_pkg"


def types_package() -> str:
    """Write the package of primitives."""
    return _HEAD + guarded(TYPES_NAME, _types())


def _types() -> Iterator[str]:
    statuses: Any = Status
    width = max(len(status.name) for status in statuses) + 7
    yield f"package {TYPES_NAME};\n\n  // Status of a packet, one transfer per packet.\n"
    yield "  typedef enum logic [7:0] {\n"
    yield ",\n".join(
        f"    {'STATUS_' + status.name:{width}} = 8'h{status.value:02x}" for status in statuses
    )
    yield f"\n  }} {STATUS};\n"
    members = [Member(name="tdata", type=STATUS), Member(name="tvalid", type="logic")]
    yield from struct(STATUS_STREAM, members)
    yield "\n" + constant(STATUS_STREAM, _IDLES[STATUS_STREAM], "'0")
    yield "\n  // Values. A float is its IEEE 754 bits; a bool is 1 if true.\n"
    for name, bits in PRIMITIVE_BITS.items():
        signed = " signed" if name.startswith("int") else ""
        vector = f" [{bits - 1}:0]" if bits > 1 else ""
        yield f"  typedef logic{signed}{vector} {name}_data_t;\n"
    for name in PRIMITIVE_BITS:
        members = [Member(name="data", type=f"{name}_data_t"), Member(name="valid", type="logic")]
        yield from struct(f"{name}_stream_t", members)
    yield "\n  // Idle streams: valid is 0.\n"
    for name in PRIMITIVE_BITS:
        yield constant(f"{name}_stream_t", f"{name.upper()}_STREAM_IDLE", "'0")
    yield f"\nendpackage : {TYPES_NAME}\n"


_LENGTH = Member(name="length", type="uint32_stream_t", remark="  // number of elements")


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
    beat = [
        ("tdata", f"[{8 * bus_bytes - 1}:0]", "bytes of the packet, the first one in bits 7 to 0"),
        ("tkeep", f"[{bus_bytes - 1}:0]", "valid bytes, from lane 0 on"),
        ("tlast", "", "last beat of the packet"),
        ("tuser", "", "with tlast: the packet's status is not OK"),
        ("tvalid", "", ""),
    ]
    members = [
        Member(name=name, type=f"logic {range_}".rstrip(), remark=remark and f"  // {remark}")
        for name, range_, remark in beat
    ]
    yield from struct(BEAT, members)
    yield "\n" + constant(BEAT, _IDLES[BEAT], "'0")
    for primitive, size in PRIMITIVE_BYTES.items():
        yield from _items(primitive, max(1, bus_bytes // size))
    for text, primitive in TEXTS.items():
        yield from stream_structs(f"{text}_stream", [_LENGTH, _of_items(primitive)])
    for primitive in PRIMITIVE_BYTES:
        yield from _sequence_and_array(f"{primitive}", _of_items(primitive))
    for text in TEXTS:
        item = Member(
            name="item", type=f"{text}_stream_t", ready_type=f"{text}_stream_ready_t"
        )
        yield from _sequence_and_array(text, item)
    yield f"\nendpackage : {name}\n"


def _sequence_and_array(what: str, item: Member) -> Iterator[str]:
    for form in FORMS:
        members = [_LENGTH, item] if form == "sequence" else [item]
        yield from stream_structs(f"{what}_{form}_stream", members)


def _items(primitive: str, lanes: int) -> Iterator[str]:
    members = [
        Member(
            name="data",
            type=f"{primitive}_data_t [{lanes - 1}:0]",
            remark="  // the first item at index 0; zeros behind the last item",
        ),
        Member(name="last", type="logic", remark="  // last transfer of the array or sequence"),
        Member(name="valid", type="logic"),
    ]
    kind = f"{primitive}_items_stream"
    yield from struct(f"{kind}_t", members)
    yield "\n" + constant(f"{kind}_t", f"{kind.upper()}_IDLE", "'0")


def _of_items(primitive: str) -> Member:
    return Member(name="items", type=f"{primitive}_items_stream_t")
