"""What announcements of participants and endpoints say (8.5, 9.6.2), as far as a node needs it."""

from __future__ import annotations

from ipaddress import IPv4Address
from typing import Any

from amaranth.hdl import Module, Mux, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.node.description import Link
from firm_hdl.node.rtps.events import announced_layout, raw
from firm_hdl.node.rtps.names import NameDigest
from firm_hdl.node.rtps.parameters import swapped
from firm_hdl.rtps.wire.guid import PUBLICATIONS_WRITER, SPDP_WRITER
from firm_hdl.rtps.wire.parameters import Pid

__all__ = ["AnnouncementReader"]

_UDP_V4 = 1
_INFINITE = 0x7FFF_FFFF
_MOST_LEASE = 100
_WRITER_NO_KEY, _READER_NO_KEY = 3, 4


class AnnouncementReader(wiring.Component):
    """Collect the fields of one announcement from the words of its parameters.

    Of several locators of a kind, the nearest one counts: the one that has the most leading bits in
    common with the address of the node. Names count by their CRC-32. An endpoint is refused here if
    it cannot match any of ours: its topic has a key, its ownership is exclusive, it is in a
    partition, its data are not XCDR 1; or it is a reader that asks for a deadline, or for a
    liveliness that is not automatic and without end (8.7.2, DDS 2.2.3).

    Parameters
    ----------
    link : Link
        Its domain and address.

    Members
    -------
    begins : In(1)
        Forget the announcement before.
    source, writer : In(96), In(32)
        Who announces: its GUID prefix, and the entity identifier of its writer.
    pid, index, adds, aligned, byte, word, value : as of a `ParameterReader`
    announced : Out(announced_layout())
        Complete a cycle after the end of the list.
    """

    def __init__(self, link: Link):
        self.link = link
        super().__init__(
            {
                "begins": In(1),
                "source": In(96),
                "writer": In(32),
                "pid": In(16),
                "index": In(5),
                "adds": In(1),
                "aligned": In(1),
                "byte": In(8),
                "word": In(32),
                "value": In(32),
                "announced": Out(announced_layout()),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        out, value, is_writer = Signal(announced_layout()), self.value, Signal()
        refused, has_guid = Signal(), Signal()
        m.d.comb += is_writer.eq(self.writer == raw(PUBLICATIONS_WRITER))
        entity_kind = out.entity[24:30]
        m.d.comb += [
            self.announced.eq(out),
            self.announced.is_participant.eq(~refused & has_guid & (out.discovery.port != 0)),
            self.announced.is_endpoint.eq(
                ~refused
                & has_guid
                & (entity_kind == Mux(is_writer, _WRITER_NO_KEY, _READER_NO_KEY))
            ),
        ]
        with m.If(self.begins):
            m.d.sync += [
                refused.eq(0),
                has_guid.eq(0),
                out.discovery.port.eq(0),
                out.user.port.eq(0),
                out.lease.eq(_MOST_LEASE),
                # 9.6.2.2.2: a policy that is not there has its default.
                out.is_reliable.eq(is_writer),
                out.durability.eq(0),
                out.topic.eq(0),
                out.type.eq(0),
            ]

        def refuse(condition: object) -> None:
            with m.If(condition):
                m.d.sync += refused.eq(1)

        self._names(m, out)
        pid = self.pid
        is_user = (pid == Pid.DEFAULT_UNICAST_LOCATOR) | (pid == Pid.UNICAST_LOCATOR)
        self._locator(m, pid == Pid.METATRAFFIC_UNICAST_LOCATOR, out.discovery)
        self._locator(m, is_user, out.user)
        first = self.aligned & (self.index == 0)
        second = self.aligned & (self.index == 1)
        with m.Switch(self.pid):
            with m.Case(Pid.PARTICIPANT_GUID, Pid.ENDPOINT_GUID):
                # A participant announces its own alone.
                wanted = Mux(
                    self.writer == raw(SPDP_WRITER), Pid.PARTICIPANT_GUID, Pid.ENDPOINT_GUID
                )
                for place in range(3):
                    at = self.aligned & (self.index == place)
                    refuse(at & (self.word != self.source.word_select(place, 32)))
                with m.If(self.aligned & (self.index == 3) & (self.pid == wanted)):
                    m.d.sync += [has_guid.eq(1), out.entity.eq(self.word)]
            with m.Case(Pid.PARTICIPANT_LEASE_DURATION), m.If(first):
                m.d.sync += out.lease.eq(
                    Mux(value > _MOST_LEASE, _MOST_LEASE, Mux(value == 0, 1, value))
                )
            with m.Case(Pid.DOMAIN_ID):
                refuse(first & (value != self.link.domain))
            with m.Case(Pid.RELIABILITY), m.If(first):
                m.d.sync += out.is_reliable.eq(value == 2)
            with m.Case(Pid.DURABILITY):
                refuse(first & (value > 3))
                with m.If(first):
                    m.d.sync += out.durability.eq(value)
            with m.Case(Pid.OWNERSHIP, Pid.PARTITION):
                refuse(first & (value != 0))
            with m.Case(Pid.DEADLINE):
                refuse(first & ~is_writer & (value != _INFINITE))
            with m.Case(Pid.LIVELINESS):
                refuse(first & ~is_writer & (value != 0))
                refuse(second & ~is_writer & (value != _INFINITE))
            with m.Case(Pid.DATA_REPRESENTATION):
                # A count, and numbers of 16 bits; XCDR 1 is 0. A writer uses its first one.
                several = Signal()
                with m.If(first):
                    m.d.sync += several.eq(value > 1)
                has_second = several & ~is_writer & (self.word[16:] == 0)
                refuse(second & (self.word[:16] != 0) & ~has_second)
        return m

    def _names(self, m: Module, out: Any) -> None:
        """Digest the names of the topic and of the type."""
        m.submodules.digest = digest = NameDigest()
        is_topic, is_type = self.pid == Pid.TOPIC_NAME, self.pid == Pid.TYPE_NAME
        # The first word is the length of the string.
        m.d.comb += [
            digest.begins.eq(self.adds & (self.index == 0)),
            digest.byte.eq(self.byte),
            digest.adds.eq(self.adds & (self.index != 0)),
        ]
        with m.If(is_topic):
            m.d.sync += out.topic.eq(digest.digest)
        with m.If(is_type):
            m.d.sync += out.type.eq(digest.digest)

    def _locator(self, m: Module, is_of_kind: Value, locator: Any) -> None:
        """Take the nearest of the locators of a kind (9.3.2): UDP over IPv4, and unicast."""
        own = int(IPv4Address(self.link.ip))
        port, usable = Signal(16), Signal()
        distance, nearest = Signal(32), Signal(32)
        address = swapped(self.word)
        m.d.comb += distance.eq(address ^ own)
        with m.If(self.aligned & is_of_kind), m.Switch(self.index):
            with m.Case(0):
                m.d.sync += usable.eq(self.value == _UDP_V4)
            with m.Case(1):
                m.d.sync += port.eq(self.value)
                with m.If(self.value[16:] != 0):
                    m.d.sync += usable.eq(0)
            with m.Case(5):
                is_unicast = (address[28:] < 0xE) & (address != 0)
                is_nearer = (locator.port == 0) | (distance < nearest)
                with m.If(usable & (port != 0) & is_unicast & is_nearer):
                    m.d.sync += [
                        locator.address.eq(address),
                        locator.port.eq(port),
                        nearest.eq(distance),
                    ]
