# amaranth: UnusedElaboratable=no
"""The ports of an accelerator in VHDL or Verilog: those of a node without one, turned round.

So an accelerator beside a node and one inside it have the same ports.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

from firm_hdl.export.component import ComponentPort
from firm_hdl.export.ports import PlainPort, vhdl_type
from firm_hdl.node.description import Description
from firm_hdl.node.node import Node
from firm_hdl.node.top import node_ports

__all__ = ["AcceleratorPort", "accelerator_ports", "outer_ports"]


@dataclass(frozen=True, slots=True, kw_only=True)
class AcceleratorPort(PlainPort):
    """A port of an accelerator: a plain vector, or a record."""

    signed: bool = False  # The bits are those of a signed number.
    # The member of the accelerator in Amaranth, such as `subscribe.cmd_vel.linear.x.data`; empty
    # for clock and reset.
    member: str = ""
    is_optional: bool = False  # The accelerator may do without it.
    type: str = ""  # The type of a record, with its package; empty for a plain vector.
    # Widths of the fields of a record, such as `linear.x.valid`, in order.
    parts: Mapping[str, int] = field(default_factory=dict)

    @property
    def vhdl_type(self) -> str:
        """The type in VHDL."""
        return self.type or vhdl_type(self.width)


def accelerator_ports(description: Description) -> tuple[AcceleratorPort, ...]:
    """List the ports: clock, reset, time, then those of the messages in the order of topics."""
    return tuple(_ports(description))


def outer_ports(description: Description) -> tuple[ComponentPort, ...]:
    """List the ports of the node if those of its messages came out of it."""
    node = Node(replace(description, accelerator="", hdl=None))
    # Only its names are needed.
    node._MustUse__used = True
    return node_ports(node)


def _ports(description: Description) -> Iterator[AcceleratorPort]:
    yield AcceleratorPort(name="aclk", direction="in", width=1)
    yield AcceleratorPort(name="aresetn", direction="in", width=1)
    for port in outer_ports(description):
        group = port.member.partition(".")[0]
        if group in ("time", "subscribe", "publish", "serve"):
            yield AcceleratorPort(
                name=port.name,
                direction="in" if port.direction == "out" else "out",
                width=port.width,
                signed=port.signed,
                member=port.member,
                is_optional=group == "time",
            )
