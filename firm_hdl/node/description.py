"""The description of a node, as frozen values: what a file says, checked and completed.

:mod:`firm_hdl.node.reading` makes one of a file; ``docs/reference/node.md`` describes the file.
Every other part of :mod:`firm_hdl.node` starts from here, and decides nothing again.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from firm_hdl.errors import Span
from firm_hdl.model import Message, Wire
from firm_hdl.plan import BUS_BYTES, Plan, build_plan
from firm_hdl.wire import lay_out

__all__ = [
    "CONTROL_TOPIC",
    "DATAGRAM_BYTES",
    "ETHERNETS",
    "LINKS",
    "NODE_BUS_BYTES",
    "REGISTER_BUSES",
    "SERVICE_PARTS",
    "Description",
    "EthernetKind",
    "Hdl",
    "IoPins",
    "Kind",
    "Link",
    "Store",
    "Topic",
    "TopicQos",
    "Way",
]

Kind: TypeAlias = Literal["subscribe", "publish", "serve"]
"""What the node does with a topic; `serve` is a service, of which the node is the server."""

Way: TypeAlias = Literal["in", "out"]
"""The way of packets: `in` from the host to the node, `out` from the node to the host."""

Language: TypeAlias = Literal["vhdl", "verilog", "systemverilog"]

EthernetKind: TypeAlias = Literal["stream", "gmii", "rgmii", "mii"]

ETHERNETS: tuple[EthernetKind, ...] = ("stream", "gmii", "rgmii", "mii")
"""Where a link `udp` ends: at datagrams for a core below, or at the pins of a PHY."""

LinkKind: TypeAlias = Literal["stream", "axi_dma", "udp", "uart", "rtps"]

LINKS: tuple[LinkKind, ...] = ("stream", "axi_dma", "udp", "uart", "rtps")
"""All links."""

RegisterBus: TypeAlias = Literal["axi4lite", "csr"]

REGISTER_BUSES: tuple[RegisterBus, ...] = ("axi4lite", "csr")
"""Buses on which a node has registers: AXI4-Lite, or the CSR bus of amaranth-soc."""

SERVICE_PARTS: dict[Way, str] = {"in": "request", "out": "response"}
"""What a service has in each way."""

CONTROL_TOPIC = 0
"""The id of control messages. Topics are numbered from 1 on."""

NODE_BUS_BYTES = tuple(width for width in BUS_BYTES if width <= 16)
"""Bus widths of a node: the header of a frame, 16 bytes, has to fill whole beats."""

DATAGRAM_BYTES = 1472
"""Payload of the largest datagram that fits into a frame of Ethernet: 1500 bytes, less 20 for the
header of IPv4 (RFC 791) and 8 for that of UDP (RFC 768)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TopicQos:
    """The quality of service that the host asks ROS for. The hardware does not depend on it.

    Attributes
    ----------
    reliability : "reliable" or "best_effort"
    durability : "volatile" or "transient_local"
        In ROS 1, `transient_local` is a latched topic.
    history : "keep_last" or "keep_all"
    depth : int
        Messages that are kept; the size of the queue in ROS 1.
    """

    reliability: Literal["reliable", "best_effort"] = "reliable"
    durability: Literal["volatile", "transient_local"] = "volatile"
    history: Literal["keep_last", "keep_all"] = "keep_last"
    depth: int = 10


@dataclass(frozen=True, slots=True, kw_only=True)
class Store:
    """The packets of one message type in one direction, and the memory in which they wait.

    Attributes
    ----------
    message : Message
    max_message_bytes : int
        As for :class:`firm_hdl.Deserializer`.
    memory_bytes, packets, when_full
        As for :class:`firm_hdl.PacketFifo`.
    """

    message: Message
    max_message_bytes: int
    memory_bytes: int
    packets: int
    when_full: Literal["wait", "drop"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Topic:
    """A topic or a service of a node.

    Attributes
    ----------
    id : int
        The number that travels in a frame: the place in the description, from 1 on.
    kind : Kind
    name : str
        The complete name, after remappings.
    written : str
        The name as the description has it.
    port : str
        Name of the member in the circuit.
    type : str
        The full name of the type.
    definition_hash : str
        SHA-256 of the definitions, as `Library.definition_hash` gives it.
    stores : tuple of pairs of Way and Store
        `in` of a subscription, `out` of a publication, both of a service.
    qos : TopicQos
    rate_hz : float or None
        Messages per second that the user expects, for the summary.
    span : Span or None
        The name in the description.
    """

    id: int
    kind: Kind
    name: str
    written: str
    port: str
    type: str
    definition_hash: str
    stores: tuple[tuple[Way, Store], ...]
    qos: TopicQos = TopicQos()
    rate_hz: float | None = None
    span: Span | None = field(default=None, compare=False, repr=False)

    def store(self, way: Way) -> Store:
        """Return the packets of a way, in which the topic has some."""
        return dict(self.stores)[way]

    def has(self, way: Way) -> bool:
        """Whether the topic has packets in a way."""
        return way in dict(self.stores)

    def part(self, way: Way) -> str:
        """Return what the topic is in a way, such as ``subscribe`` or ``request``."""
        return SERVICE_PARTS[way] if self.kind == "serve" else self.kind

    def path(self, way: Way) -> tuple[str, ...]:
        """Return the member of an accelerator with the message of a way."""
        own = (self.kind, self.port)
        return (*own, SERVICE_PARTS[way]) if self.kind == "serve" else own


@dataclass(frozen=True, slots=True, kw_only=True)
class Link:
    """The link between the node and its host.

    Attributes
    ----------
    kind : LinkKind
    memory_bytes : int
        Memory in which a message is put together and checked (`axi_dma`, `udp` and `uart`). The
        largest message that passes has 16 bytes less. With `rtps`, datagrams wait there.
    packets : int
        Most messages in that memory; most datagrams with `rtps`.
    buffer_bytes : int
        Most bytes of a frame, header included: the size of a buffer in the memory of the processor
        (`axi_dma`).
    datagram_bytes : int
        Most bytes of a datagram's payload, header included (`udp`, and what `rtps` sends).
    data_bytes : int
        Bytes per cycle at the interface of the core below (`udp`).
    port : int
        Port of the node (`udp`).
    host : str
        IPv4 address of the host (`udp`). Empty: the one from which the last valid frame came.
    host_port : int
        Port of the host (`udp`); counts only with `host`.
    ethernet : EthernetKind
        Where the hardware ends (`udp`, `rtps`).
    mac : str
        The node's address in hardware, 6 bytes in hexadecimal with ``:`` between them; this and
        `gateway` only with an `ethernet` that is not `stream`.
    address : str
        IPv4 address of the node, with the bits of the network if there is an `ethernet`:
        ``192.168.1.50/24``.
    gateway : str
        IPv4 address of the way to other networks; empty: there is none.
    baud : int
        Bits per second (`uart`).
    domain : int
        ROS_DOMAIN_ID (`rtps`).
    participant : int
        Number of the participant on its address, from which its ports follow (`rtps`).
    peers : int
        Most participants that the node knows at a time (`rtps`).
    matches : int
        Most endpoints of peers that are matched with those of the node at a time (`rtps`).
    static_peers : tuple of str
        IPv4 addresses that are told of the node besides the multicast group (`rtps`).
    """

    kind: LinkKind
    memory_bytes: int = 1 << 14
    packets: int = 16
    buffer_bytes: int = 16_368
    datagram_bytes: int = DATAGRAM_BYTES
    data_bytes: int = 1
    port: int = 7411
    host: str = ""
    host_port: int = 7411
    ethernet: EthernetKind = "stream"
    mac: str = ""
    address: str = ""
    gateway: str = ""
    baud: int = 1_000_000
    domain: int = 0
    participant: int = 0
    peers: int = 8
    matches: int = 32
    static_peers: tuple[str, ...] = ()

    @property
    def frame_bytes(self) -> int | None:
        """Most bytes of a frame, header included; `None`: a message is one frame of any size."""
        return {"axi_dma": self.buffer_bytes, "udp": self.datagram_bytes}.get(self.kind)

    @property
    def can_wait(self) -> bool:
        """Whether what comes can be held."""
        return self.kind in ("stream", "axi_dma")

    @property
    def has_ethernet(self) -> bool:
        """Whether the node has all layers down to the pins of a PHY."""
        return self.ethernet != "stream"

    @property
    def ip(self) -> str:
        """The IPv4 address of the node, without the bits of its network."""
        return self.address.partition("/")[0]


@dataclass(frozen=True, slots=True, kw_only=True)
class Hdl:
    """An accelerator in another language than Amaranth."""

    language: Language
    files: tuple[str, ...]  # Files in compile order, relative to the folder of the description.
    entity: str  # Name of the entity or module.
    # Messages are ports of records or structs, rather than of plain vectors.
    has_records: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class IoPins:
    """The pins of a board for a member of an accelerator that comes out of the node as `io`."""

    name: str  # The path of the member, such as `pwm`, or `encoder.a`.
    pins: tuple[str, ...]  # One pin for each bit, the lowest first, as `led.0` or as `B2`.
    # The name and the pins in the description.
    span: Span = field(compare=False, repr=False)
    spans: tuple[Span, ...] = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Description:
    """A node: its name, its topics, its link and its accelerator.

    Attributes
    ----------
    node : str
        Name of the node.
    namespace : str
        Complete namespace.
    distro : str
    wire : Wire
    bus_bytes : int
        Bytes per beat of all packet streams of the node: 1, 2, 4, 8 or 16.
    clock_hz : float
        Frequency of the clock, from which the time and the baud rate follow.
    link : Link
    topics : tuple of Topic
        In the order of their ids.
    accelerator : str
        ``module:Class``, or what `hdl` is, for people; empty if the message ports come out of the
        node.
    hdl : Hdl or None
        The files of an accelerator that is not in Amaranth.
    registers : "axi4lite", "csr" or ""
        The bus on which the node has registers; empty: it has none.
    pins : tuple of IoPins
        Pins of a board, for its bitstream. The node itself does not depend on them.
    folder : str
        The folder of the file, in which the module of the accelerator is searched, too.
    accelerator_span, clock_span, link_span, node_span, registers_span : Span or None
        The accelerator, the clock, the link, the name and the registers of the node in the file.
    """

    node: str
    namespace: str = "/"
    distro: str
    wire: Wire
    bus_bytes: int = 8
    clock_hz: float = 100e6
    link: Link
    topics: tuple[Topic, ...]
    accelerator: str = ""
    hdl: Hdl | None = None
    registers: RegisterBus | Literal[""] = ""
    pins: tuple[IoPins, ...] = ()
    folder: str = field(default="", compare=False)
    accelerator_span: Span | None = field(default=None, compare=False, repr=False)
    clock_span: Span | None = field(default=None, compare=False, repr=False)
    link_span: Span | None = field(default=None, compare=False, repr=False)
    node_span: Span | None = field(default=None, compare=False, repr=False)
    registers_span: Span | None = field(default=None, compare=False, repr=False)

    def of_kind(self, kind: Kind) -> tuple[Topic, ...]:
        """Return the topics of a kind, in the order of their ids."""
        return tuple(topic for topic in self.topics if topic.kind == kind)

    def received(self) -> Iterator[tuple[Topic, Store]]:
        """Yield the topics whose packets come from the host, and how they are stored."""
        return self._stores("in")

    def sent(self) -> Iterator[tuple[Topic, Store]]:
        """Yield the topics whose packets go to the host, and how they are stored."""
        return self._stores("out")

    def loops(self) -> tuple[tuple[Topic, Topic], ...]:
        """Pair subscriptions with publications of the same type, as :class:`.Loop` joins them.

        The nth subscription of a type goes with its nth publication. Topics without a partner are
        left out.
        """
        left = list(self.of_kind("publish"))
        found: list[tuple[Topic, Topic]] = []
        for topic in self.of_kind("subscribe"):
            partner = next((each for each in left if each.type == topic.type), None)
            if partner is not None:
                left.remove(partner)
                found.append((topic, partner))
        return tuple(found)

    def plan(self, store: Store) -> Plan:
        """Return the plan of the converters and the gate of some packets."""
        return build_plan(
            lay_out(store.message, self.wire),
            bus_bytes=self.bus_bytes,
            max_message_bytes=store.max_message_bytes,
        )

    def _stores(self, way: Way) -> Iterator[tuple[Topic, Store]]:
        for topic in self.topics:
            if topic.has(way):
                yield topic, topic.store(way)

    @property
    def fingerprint(self) -> int:
        """64 bits that tell whether two sides mean the same by the ids of topics.

        They depend on the wire format, and on id, kind, name and definition of every topic. The
        node answers with them, so that a host finds out that its description is another one.
        """
        lines = [f"wire {self.wire}"]
        for topic in self.topics:
            lines.append(
                f"{topic.id} {topic.kind} {topic.name} {topic.type} {topic.definition_hash}"
            )
        digest = hashlib.sha256("\n".join(lines).encode()).digest()
        return int.from_bytes(digest[:8], "little")
