"""ROS's primitives, and the types of the packages that all messages share.

Records in VHDL and structs in SystemVerilog have the same names. The number of items in a transfer
depends only on the primitive and on the width of the bus. So all messages on a bus of one width
share a package with the strings, arrays and sequences of primitives.
"""

from __future__ import annotations

from typing import Any

from firm_hdl.gateware.signatures import Status
from firm_hdl.model import PRIMITIVES
from firm_hdl.plan import Leaf

__all__ = [
    "BUS_TYPES",
    "FORMS",
    "PRIMITIVE_BITS",
    "PRIMITIVE_BYTES",
    "SHARED_TYPES",
    "SHARED_WORDS",
    "TEXTS",
    "TYPES_NAME",
    "bus_name",
    "primitive_name",
]

TYPES_NAME = "firm_hdl_types_pkg"
"""Name of the VHDL package that all messages share."""

# `byte` and `char` become integers.
_PRIMITIVES = [each for each in PRIMITIVES["ros2"].values() if each.name not in ("byte", "char")]
PRIMITIVE_BITS = {each.name: each.bits for each in _PRIMITIVES}
PRIMITIVE_BYTES = {each.name: each.bytes for each in _PRIMITIVES}
"""Size of each primitive on the wire, in bytes."""

TEXTS = {"string": "uint8", "wstring": "uint32"}
"""Strings, with the type of their items."""

FORMS = ("sequence", "array")

SHARED_TYPES = frozenset(
    [
        *("std_logic", "std_logic_vector", "unsigned", "signed"),
        *(f"{kind}_{what}_t" for kind in PRIMITIVE_BITS for what in ("stream", "items")),
    ]
)
"""Types of record members that shared packages declare, in lower case."""

_STATUSES: Any = Status

SHARED_WORDS = frozenset(
    [
        *SHARED_TYPES,
        *(f"{kind}_stream_idle" for kind in PRIMITIVE_BITS),
        *(f"to_{kind}_items" for kind in PRIMITIVE_BITS),
        *(f"status_{status.name.lower()}" for status in _STATUSES),
        *("status_name", "to_slv", TYPES_NAME),
    ]
)
"""All names that the shared package declares, and its own name, in lower case."""

_RECORDS = (
    *TEXTS,
    *(f"{name}_{form}" for name in (*PRIMITIVE_BYTES, *TEXTS) for form in FORMS),
)

BUS_TYPES = frozenset(
    [
        *(f"{name}_items_stream_{what}" for name in PRIMITIVE_BYTES for what in ("t", "idle")),
        *(
            f"{name}_stream_{what}"
            for name in _RECORDS
            for what in ("t", "ready_t", "idle", "all_ready")
        ),
    ]
)
"""All names that the package of a bus width declares, in lower case."""


def bus_name(bus_bytes: int) -> str:
    """Return the name of the VHDL package of a bus width."""
    return f"firm_hdl_bus_{bus_bytes}_pkg"


def primitive_name(leaf: Leaf) -> str:
    """Return the primitive of a leaf; ``byte`` and ``char`` become an integer of 8 bits.

    >>> primitive_name(Leaf(path=("a",), kind="scalar", type="byte", signed=True))
    'int8'
    """
    primitive = leaf.primitive
    if primitive.kind != "int":
        return primitive.kind if primitive.kind == "bool" else primitive.name
    return f"{'' if leaf.signed else 'u'}int{8 * primitive.bytes}"
