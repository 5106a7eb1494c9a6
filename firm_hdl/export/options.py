"""The options of a build. Amaranth is not imported, so that wrong arguments are refused at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, get_args

from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES
from firm_hdl.wire import Wire

__all__ = [
    "EXTRAS",
    "IPS",
    "LEAF_PORTS",
    "PORTS",
    "Extra",
    "IpTool",
    "LeafPorts",
    "Options",
    "Ports",
]

Ports: TypeAlias = Literal["records", "flat"]
PORTS: tuple[Ports, ...] = get_args(Ports)

LeafPorts: TypeAlias = Literal["plain", "axis"]
LEAF_PORTS: tuple[LeafPorts, ...] = get_args(LeafPorts)

IpTool: TypeAlias = Literal["vivado", "quartus", "litex"]
IPS: tuple[IpTool, ...] = get_args(IpTool)

Extra: TypeAlias = Literal["systemverilog", "tools", "documents"]
EXTRAS: tuple[Extra, ...] = get_args(Extra)
"""Files that a build writes only when it is asked for them.

``systemverilog``: modules with structs. ``tools``: files for FuseSoC, Vivado, make, VUnit and
Verilator, and instantiation templates. ``documents``: the datasheet.
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """The options of a build."""

    wire: Wire | None = None  # Wire format; `None`: that of the distribution.
    # As for the converters.
    bus_bytes: int = 8
    max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES
    # "records" adds entities with records and modules with structs; "flat" is for tools that do not
    # support them.
    ports: Ports = "records"
    extras: frozenset[Extra] = frozenset()  # Some of `EXTRAS`.
    registers: bool = False  # Also write converters with registers on AXI4-Lite.
    leaf_ports: LeafPorts = "plain"  # "axis": also write modules whose leaves are AXI4-Stream.
    ip: IpTool | None = None  # Also write IP for a tool, with these leaves.

    @property
    def facts(self) -> dict[str, Any]:
        """The options that are not of every build, if they differ from their defaults."""
        return {
            **({"registers": True} if self.registers else {}),
            **({"leaf_ports": self.leaf_ports} if self.leaf_ports != "plain" else {}),
            **({"ip": self.ip} if self.ip else {}),
        }
