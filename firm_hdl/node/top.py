"""The top level of a node: its members as ports of plain vectors."""

from __future__ import annotations

from firm_hdl.export.component import ComponentPort, ComponentTop, Path, PlainPorts
from firm_hdl.node.node import Node

__all__ = ["NodeTop", "node_ports"]

_LINK: dict[str, str] = {
    "frames_in": "s_axis",
    "pieces_in": "s_axis",
    "frames_out": "m_axis",
    "datagrams_in": "udp_rx",
    "datagrams_out": "udp_tx",
    "rx": "uart_rx",
    "tx": "uart_tx",
}
"""How ports of links are called; others have the names of their members."""

_REGISTERS = {"axi": "s_axi", "interrupt": "irq"}
"""How those of registers are called; others have the names of their members."""


class NodeTop(ComponentTop):
    """A node with ports of plain vectors. It adds neither registers nor latency.

    `aclk` is the clock; `aresetn` is a synchronous reset, active low. A stream of frames is
    AXI4-Stream, ``s_axis`` and ``m_axis``. All other ports have the names of the node's members,
    joined by ``_``: ``subscribe_cmd_vel_linear_x_data``.
    A soft reset by registers acts as `aresetn` does.

    Parameters
    ----------
    node : Node

    Members
    -------
    As :func:`node_ports` lists them.
    """

    def __init__(self, node: Node):
        super().__init__(_plain(node), also_resets=getattr(node, "soft_reset", None))


def node_ports(node: Node) -> tuple[ComponentPort, ...]:
    """List the ports of the top level of a node: clock, reset, and those of its members.

    Raises `UserError` if the node has more input bits than Amaranth elaborates.
    """
    return _plain(node).ports


def _plain(node: Node) -> PlainPorts:
    return PlainPorts(
        node,
        kind="node",
        has_axis=lambda path: path[0] == "link",
        spell=_spelled,
    )


def _spelled(path: Path) -> Path:
    """Return the path from which the name of a port is made."""
    if path[0] != "link":
        return (_REGISTERS.get(path[0], path[0]), *path[1:])
    if path[1] == "dest":
        return ("m_axis", "tdest")
    if path[1] == "pieces_in":
        return ("s_axis", f"t{path[2]}")
    return (_LINK.get(path[1], path[1]), *path[2:])
