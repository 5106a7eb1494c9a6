"""The options of a build. Amaranth is not imported, so that wrong arguments are refused at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES
from firm_hdl.wire import Wire

__all__ = ["EXTRAS", "PORTS", "Extra", "Options", "Ports"]

Ports: TypeAlias = Literal["records", "flat"]
PORTS: tuple[Ports, ...] = get_args(Ports)

Extra: TypeAlias = Literal["systemverilog", "tools", "documents"]
EXTRAS: tuple[Extra, ...] = get_args(Extra)
"""Files that a build writes only when it is asked for them.

``systemverilog``: modules with structs. ``tools``: files for FuseSoC, Vivado, make, VUnit and
Verilator, and instantiation templates. ``documents``: the datasheet.
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """The options of a build.

    Attributes
    ----------
    wire : "ros1", "cdr" or None
        Wire format; `None`: that of the distribution.
    bus_bytes, max_message_bytes : int
        As for the converters.
    ports : "records" or "flat"
        "records" adds entities with records and modules with structs; "flat" is for tools that do
        not support them.
    extras : frozenset of str
        Some of :data:`EXTRAS`.
    registers : bool
        Also write converters with registers on AXI4-Lite.
    """

    wire: Wire | None = None
    bus_bytes: int = 8
    max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES
    ports: Ports = "records"
    extras: frozenset[Extra] = frozenset()
    registers: bool = False
