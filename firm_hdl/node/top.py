"""The top level of a node: its members as ports of plain vectors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal

from amaranth.hdl import Module, Shape, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.export.top import MAX_INPUT_BITS, add_domain
from firm_hdl.gateware.axi_stream import count_of_keep, keep_of_count
from firm_hdl.names.identifiers import flat_names
from firm_hdl.node.node import Node

__all__ = ["NodeTop", "node_ports", "parts_of"]

Path = tuple[str, ...]

_AXIS = {"data": "tdata", "count": "tkeep", "last": "tlast", "valid": "tvalid", "ready": "tready"}
_LINK: dict[str, str] = {
    "frames_in": "s_axis",
    "frames_out": "m_axis",
    "datagrams_in": "udp_rx",
    "datagrams_out": "udp_tx",
    "gmii": "gmii",
    "rgmii": "rgmii",
    "mii": "mii",
    "rx": "uart_rx",
    "tx": "uart_tx",
    "nonce": "nonce",
}
"""How ports of links are called."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NodePort:
    """A port of a top level.

    Attributes
    ----------
    name : str
    direction : "in" or "out"
    width : int
        Width in bits.
    signed : bool
    member : str
        The member of :class:`Node` that it belongs to, or what it is.
    """

    name: str
    direction: Literal["in", "out"]
    width: int
    signed: bool
    member: str


class NodeTop(wiring.Component):
    """A node with ports of plain vectors. It adds neither registers nor latency.

    `aclk` is the clock; `aresetn` is a synchronous reset, active low. A stream of frames is
    AXI4-Stream, ``s_axis`` and ``m_axis``. All other ports have the names of the node's members,
    joined by ``_``: ``subscribe_cmd_vel_linear_x_data``.

    Parameters
    ----------
    node : Node

    Members
    -------
    As :func:`node_ports` lists them.
    """

    def __init__(self, node: Node):
        self.node = node
        self._parts = {port.name: part for port, part in _named(node)}
        super().__init__(
            {
                port.name: (In if port.direction == "in" else Out)(Shape(port.width, port.signed))
                for port in node_ports(node)
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        add_domain(m, "sync", self.aclk, self.aresetn)
        m.submodules.node = self.node
        bus = self.node.description.bus_bytes
        for name, part in self._parts.items():
            port = getattr(self, name)
            if not part.is_count:
                m.d.comb += part.value.eq(port) if part.flow == In else port.eq(part.value)
            elif part.flow == Out:
                m.d.comb += port.eq(keep_of_count(part.value, bus))
            else:
                last = getattr(self, name.replace("tkeep", "tlast"))
                m.d.comb += part.value.eq(count_of_keep(port, last))
        return m


def node_ports(node: Node) -> tuple[NodePort, ...]:
    """List the ports of the top level of a node: clock, reset, and those of its members.

    Raises
    ------
    ValueError
        If the node has more input bits than Amaranth elaborates.
    """
    clock = NodePort(name="aclk", direction="in", width=1, signed=False, member="clock")
    reset = NodePort(name="aresetn", direction="in", width=1, signed=False, member="reset, low")
    ports = (clock, reset, *(port for port, _ in _named(node)))
    bits = sum(port.width for port in ports if port.direction == "in")
    if bits > MAX_INPUT_BITS:
        raise ValueError(
            f"The node has {bits} input bits, and Amaranth elaborates at most {MAX_INPUT_BITS}"
        )
    return ports


@dataclass(frozen=True, slots=True)
class _Part:
    """A signal of a node, or a field of one; `is_count` if its port is a mask of lanes."""

    path: Path
    flow: Any
    value: Value
    is_count: bool = False


def _named(node: Node) -> list[tuple[NodePort, _Part]]:
    parts = list(_parts(node))
    names = flat_names((_spelled(part.path) for part in parts), ("aclk", "aresetn"))
    bus = node.description.bus_bytes
    return [
        (
            NodePort(
                name=names[_spelled(part.path)],
                direction="in" if part.flow == In else "out",
                width=bus if part.is_count else len(part.value),
                signed=part.value.shape().signed,
                member=".".join(part.path),
            ),
            part,
        )
        for part in parts
        if part.is_count or len(part.value)
    ]


def _parts(node: wiring.Component) -> Iterator[_Part]:
    for path, member, value in node.signature.flatten(node):
        names = tuple(str(name) for name in path)
        is_frames = names[:2] in (("link", "frames_in"), ("link", "frames_out"))
        for inner, each in _fields(names, value):
            is_count = is_frames and inner[-1] == "count"
            yield _Part(inner, member.flow, each, is_count)


def parts_of(component: wiring.Component) -> Iterator[tuple[Path, Value]]:
    """Yield the members of a component as :func:`node_ports` divides and names those of a node."""
    for part in _parts(component):
        yield part.path, part.value


def _fields(path: Path, value: Any) -> Iterator[tuple[Path, Value]]:
    """Yield the fields of a structure, and any other value as it is."""
    if isinstance(value, data.View) and isinstance(value.shape(), data.StructLayout):
        base = path[:-1] if path[-1] == "payload" else path
        for name in value.shape().members:
            yield from _fields((*base, name), value[name])
    elif path[-1] == "payload":
        yield (*path[:-1], "data"), Value.cast(value)
    else:
        yield path, Value.cast(value)


def _spelled(path: Path) -> Path:
    """Return the path from which the name of a port is made."""
    if path[0] != "link":
        return path
    if path[1] == "dest":
        return ("m_axis", "tdest")
    rest = tuple(_AXIS.get(name, name) for name in path[2:]) if "frames" in path[1] else path[2:]
    return (_LINK[path[1]], *rest)
