"""The parts whose figures are in ``lab/notes/performance.md``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from amaranth.hdl import DomainRenamer, Elaboratable

from firm_hdl.ethernet.edge import EthernetEdge, EthernetSettings
from firm_hdl.frontend import open_library
from firm_hdl.gateware.packets import (
    PacketArbiter,
    PacketCrossing,
    PacketFifo,
    PacketGate,
    PacketRouter,
    PacketWidth,
)
from firm_hdl.gateware.packets.memory import WhenFull
from firm_hdl.gateware.parser import Parser
from firm_hdl.model import Message
from firm_hdl.node import Description, read_description_text
from firm_hdl.node.gateware import NodeCore
from firm_hdl.node.links import link_of

__all__ = ["EIGHT_TOPICS", "PARTS", "Part"]

BUS_BYTES = 8
MEMORY_BYTES = 1 << 16
PACKETS = 64
STREAMS = 8
"""Streams of the arbiter, and topics of the router."""

EIGHT_TOPICS = """\
node: eight
clock_mhz: 156.25
subscribe:
  twist: {type: geometry_msgs/msg/Twist}
  imu: {type: sensor_msgs/msg/Imu, memory_bytes: 4096}
  scan: {type: sensor_msgs/msg/LaserScan}
  text: {type: std_msgs/msg/String, memory_bytes: 4096}
publish:
  twist_out: {type: geometry_msgs/msg/Twist}
  imu_out: {type: sensor_msgs/msg/Imu, memory_bytes: 4096}
  scan_out: {type: sensor_msgs/msg/LaserScan}
  text_out: {type: std_msgs/msg/String, memory_bytes: 4096}
"""
"""The description of the node whose core is measured. The gates drop; the FIFOs wait."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """A part of a design, with its parameters.

    Attributes
    ----------
    name : str
        The class, and the message type if the part has one.
    parameters : str
        As the page shows them.
    make : callable
        Returns the component. All of its logic is in the domain ``sync``.
    """

    name: str
    parameters: str
    make: Callable[[], Elaboratable]


def _described(text: str) -> Description:
    return read_description_text(text, library=open_library("lyrical", (), ()))


def _strings(memories: int, bus_bytes: int, link: str) -> Description:
    """Describe a node of subscriptions and publications of `String`, with 4 KiB each."""
    text = f"node: strings\nclock_mhz: 125\nbus_bytes: {bus_bytes}\nlink: {link}\n"
    for kind, count in (("subscribe", (memories + 1) // 2), ("publish", memories // 2)):
        rows = [
            f"  {kind}_{number}: {{type: std_msgs/msg/String, memory_bytes: 4096}}\n"
            for number in range(count)
        ]
        text += "".join([f"{kind}:\n" if rows else "", *rows])
    return _described(text)


def _core(memories: int, bus_bytes: int) -> Part:
    return Part(
        name="`NodeCore` of `String`",
        parameters=f"{memories} memories, {bus_bytes} bytes",
        make=lambda: NodeCore(_strings(memories, bus_bytes, "{kind: stream}")),
    )


def _link(kind: str, bus_bytes: int, memories: int = 2, peers: int = 0) -> Part:
    given = f"address: 10.0.0.2, peers: {peers}" if peers else ""
    parameters = f"{bus_bytes} bytes" + (f", {memories} memories, {peers} peers" if peers else "")
    return Part(
        name=f"link `{kind}`",
        parameters=parameters,
        make=lambda: link_of(_strings(memories, bus_bytes, f"{{kind: {kind}, {given}}}")),
    )


def _edge(ports: tuple[int, ...], groups: tuple[int, ...], fragment_bytes: int) -> Part:
    return Part(
        name="`EthernetEdge`",
        parameters=f"{len(ports)} ports, {fragment_bytes} bytes for fragments",
        make=lambda: EthernetEdge(
            EthernetSettings(
                mac=0x02_00_00_00_00_50,
                address=0xC0_A8_32_32,
                ports=ports,
                groups=groups,
                fragment_bytes=fragment_bytes,
            )
        ),
    )


def _message(name: str) -> Message:
    return open_library("lyrical", (), ()).message(name)


def _parser(name: str) -> Part:
    return Part(
        name=f"`Parser` of `{name.rpartition('/')[2]}`",
        parameters="",
        make=lambda: Parser(_message(name), bus_bytes=BUS_BYTES),
    )


def _gate(name: str, when_full: WhenFull) -> Part:
    return Part(
        name=f"`PacketGate` of `{name.rpartition('/')[2]}`",
        parameters=f'64 KiB, `"{when_full}"`',
        make=lambda: PacketGate(
            _message(name),
            bus_bytes=BUS_BYTES,
            memory_bytes=MEMORY_BYTES,
            packets=PACKETS,
            when_full=when_full,
        ),
    )


def _fifo(when_full: WhenFull) -> Part:
    return Part(
        name="`PacketFifo`",
        parameters=f'64 KiB, {PACKETS} packets, `"{when_full}"`',
        make=lambda: PacketFifo(BUS_BYTES, MEMORY_BYTES, PACKETS, when_full=when_full),
    )


def _width(in_bytes: int, out_bytes: int) -> Part:
    return Part(
        name="`PacketWidth`",
        parameters=f"{in_bytes} to {out_bytes} bytes",
        make=lambda: PacketWidth(in_bytes, out_bytes),
    )


def _crossing() -> Elaboratable:
    # Both sides get the same clock, because nextpnr has to report one rate.
    one_clock = DomainRenamer({"write": "sync", "read": "sync"})
    crossing: Elaboratable = one_clock(PacketCrossing(BUS_BYTES))
    return crossing


_CLOUD, _TWIST = "sensor_msgs/msg/PointCloud2", "geometry_msgs/msg/Twist"

_PARTICIPANTS = ((1, 8), (2, 2), (2, 8), (2, 16), (6, 8))
"""Memories and peers."""

PARTS = (
    _parser(_TWIST),
    _parser(_CLOUD),
    _gate(_TWIST, "wait"),
    _gate(_CLOUD, "wait"),
    _gate(_CLOUD, "drop"),
    _fifo("wait"),
    _fifo("drop"),
    Part(
        name="`PacketArbiter`",
        parameters=f"{STREAMS} inputs",
        make=lambda: PacketArbiter(BUS_BYTES, STREAMS),
    ),
    Part(
        name="`PacketRouter`",
        parameters=f"{STREAMS} topics",
        make=lambda: PacketRouter(BUS_BYTES, STREAMS),
    ),
    _width(1, BUS_BYTES),
    _width(BUS_BYTES, 1),
    Part(name="`PacketCrossing`", parameters="16 beats, both sides at one clock", make=_crossing),
    Part(
        name="`NodeCore`",
        parameters='4 subscriptions, `"drop"`; 4 publications, `"wait"`',
        make=lambda: NodeCore(_described(EIGHT_TOPICS)),
    ),
    # Those that the estimates of nodes come from.
    *(_core(memories, bus_bytes) for bus_bytes in (1, 8) for memories in (2, 6)),
    *(
        _link(kind, bus_bytes)
        for kind in ("stream", "axi_dma", "uart", "udp")
        for bus_bytes in (1, 8)
    ),
    _link("rtps", 1, peers=8),
    *(_link("rtps", 8, memories, peers) for memories, peers in _PARTICIPANTS),
    _edge((7411,), (), 0),
    _edge((7400, 7410, 7411), (0xEF_FF_00_01,), 1 << 14),
)
"""The parts, in the order of the page."""
