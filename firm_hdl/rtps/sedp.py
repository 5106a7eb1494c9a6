"""The Simple Endpoint Discovery Protocol (8.5.4): endpoints find each other. No I/O.

The announcements of endpoints are samples of two reliable, transient-local writers, which are the
same class as writers of users.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field

from firm_hdl.rtps.discovery import EndpointData, ParticipantData, key_of, key_payload
from firm_hdl.rtps.events import Event, Incompatible, Matched, Unmatched
from firm_hdl.rtps.fragments import Budget
from firm_hdl.rtps.outgoing import Send
from firm_hdl.rtps.qos import Durability, Qos
from firm_hdl.rtps.reader import Reader
from firm_hdl.rtps.spdp import DISPOSED
from firm_hdl.rtps.wire.guid import (
    PUBLICATIONS_READER,
    PUBLICATIONS_WRITER,
    SUBSCRIPTIONS_READER,
    SUBSCRIPTIONS_WRITER,
    Guid,
    is_keyed,
)
from firm_hdl.rtps.wire.locators import Address, nearest
from firm_hdl.rtps.wire.parameters import ParameterList, Pid
from firm_hdl.rtps.wire.samples import Data
from firm_hdl.rtps.writer import Writer

__all__ = ["Local", "Sedp"]

_QOS = Qos(durability=Durability.TRANSIENT_LOCAL, depth=0)
_MAX_ENDPOINTS = 2048


@dataclass(slots=True)
class Local:
    """An endpoint of the user.

    Attributes
    ----------
    endpoint : Writer or Reader
        The endpoint.
    data : EndpointData
        What is announced about it.
    number : int
        Sequence number of the announcement.
    matched, refused : dict
        Endpoints of peers that fit, and policies that do not.
    """

    endpoint: Writer | Reader
    data: EndpointData
    number: int = 0
    matched: dict[Guid, EndpointData] = field(default_factory=dict)
    refused: dict[Guid, tuple[str, ...]] = field(default_factory=dict)

    @property
    def is_writer(self) -> bool:
        """Whether it is a writer."""
        return isinstance(self.endpoint, Writer)


class Sedp:
    """The built-in endpoints of SEDP, and the endpoints of this and of other participants.

    Parameters
    ----------
    prefix : bytes
        GUID prefix of this participant.
    host : str
        Our IPv4 address, for the choice among a peer's addresses.
    send : Send
        Takes datagrams.
    budget : Budget
        Memory for announcements that are not complete.
    events : deque
        Takes what happened.
    """

    def __init__(self, prefix: bytes, host: str, send: Send, budget: Budget, events: deque[Event]):
        self._host = host
        self._events = events
        self._peers: dict[bytes, ParticipantData] = {}
        self._locals: dict[Guid, Local] = {}
        # Of all peers: what they announced, and whether it is a writer.
        self._remotes: dict[Guid, tuple[EndpointData, bool]] = {}
        self._now = 0.0
        self.publications = Writer(Guid(prefix, PUBLICATIONS_WRITER), _QOS, send)
        self.subscriptions = Writer(Guid(prefix, SUBSCRIPTIONS_WRITER), _QOS, send)

        def listener(entity: int, writer: bool) -> Reader:
            def deliver(source: Guid, data: Data, timestamp: int | None) -> None:
                self._on_announcement(source.prefix, data, writer)

            return Reader(Guid(prefix, entity), _QOS, send, deliver, budget)

        self.publications_reader = listener(PUBLICATIONS_READER, True)
        self.subscriptions_reader = listener(SUBSCRIPTIONS_READER, False)

    @property
    def locals(self) -> dict[Guid, Local]:
        """The user's endpoints."""
        return self._locals

    def remotes(self, writers: bool) -> Iterator[EndpointData]:
        """Yield the writers or the readers of all peers."""
        yield from (data for data, writer in self._remotes.values() if writer == writers)

    def on_peer(self, peer: ParticipantData, now: float) -> None:
        """Match the built-in endpoints with those that a participant has (8.5.5.1)."""
        self._now = now
        self._peers[peer.prefix] = peer
        address = nearest(peer.discovery, self._host)
        if address is None:
            return
        for bit, endpoint, entity in (
            (3, self.publications, PUBLICATIONS_READER),
            (5, self.subscriptions, SUBSCRIPTIONS_READER),
            (2, self.publications_reader, PUBLICATIONS_WRITER),
            (4, self.subscriptions_reader, SUBSCRIPTIONS_WRITER),
        ):
            if peer.has(bit):
                guid = Guid(peer.prefix, entity)
                remote = EndpointData(guid=guid, topic="", type_name="", qos=_QOS)
                endpoint.match(remote, address, now)
        for guid, (data, writer) in list(self._remotes.items()):
            if guid.prefix == peer.prefix:
                self._match_all(data, writer)

    def on_peer_lost(self, prefix: bytes) -> None:
        """Forget a participant with all its endpoints (8.5.5.2)."""
        self._peers.pop(prefix, None)
        self.publications.unmatch(Guid(prefix, PUBLICATIONS_READER))
        self.subscriptions.unmatch(Guid(prefix, SUBSCRIPTIONS_READER))
        self.publications_reader.unmatch(Guid(prefix, PUBLICATIONS_WRITER))
        self.subscriptions_reader.unmatch(Guid(prefix, SUBSCRIPTIONS_WRITER))
        for guid in [guid for guid in self._remotes if guid.prefix == prefix]:
            self._drop_remote(guid)

    def add(self, local: Local, now: float) -> None:
        """Announce an endpoint, and match it with those of peers."""
        self._now = now
        announcer = self.publications if local.is_writer else self.subscriptions
        local.number = announcer.write(local.data.encode(), now)
        self._locals[local.data.guid] = local
        for data, writer in list(self._remotes.values()):
            if writer != local.is_writer:
                self._match(local, data)

    def remove(self, guid: Guid, now: float) -> None:
        """Tell all peers that an endpoint is gone."""
        local = self._locals.pop(guid)
        announcer = self.publications if local.is_writer else self.subscriptions
        announcer.forget(local.number)
        inline = ParameterList(((Pid.KEY_HASH, bytes(guid)), (Pid.STATUS_INFO, DISPOSED)))
        payload = key_payload(guid, Pid.ENDPOINT_GUID)
        announcer.write(payload, now, inline=inline, key=True)
        for remote in list(local.matched):
            self._unmatch(local, remote)

    def tick(self, now: float) -> float:
        """Do what is due. Return when to call again, at the latest."""
        self._now = now
        return min(
            self.publications.tick(now),
            self.subscriptions.tick(now),
            self.publications_reader.tick(now),
            self.subscriptions_reader.tick(now),
        )

    def _on_announcement(self, source: bytes, data: Data, writer: bool) -> None:
        """Take an announcement, or the news that an endpoint is gone."""
        if data.payload is None or data.key:
            gone = key_of(data.payload, data.inline, Pid.ENDPOINT_GUID)
            if gone is not None and gone.prefix == source:
                self._drop_remote(gone)
            return
        remote = EndpointData.decode(data.payload, writer)
        # A participant announces its own endpoints alone.
        if remote.guid.prefix != source:
            return
        if remote.guid not in self._remotes:
            known = sum(guid.prefix == source for guid in self._remotes)
            if known >= _MAX_ENDPOINTS:
                return
        self._remotes[remote.guid] = (remote, writer)
        self._match_all(remote, writer)

    def _drop_remote(self, guid: Guid) -> None:
        self._remotes.pop(guid, None)
        for local in self._locals.values():
            local.refused.pop(guid, None)
            if guid in local.matched:
                self._unmatch(local, guid)

    def _match_all(self, remote: EndpointData, writer: bool) -> None:
        for local in list(self._locals.values()):
            if local.is_writer != writer:
                self._match(local, remote)

    def _match(self, local: Local, remote: EndpointData) -> None:
        """Match two endpoints if topic, type and policies fit (8.7.2, DDS 2.2.3)."""
        mine = local.data
        address = self._address(remote)
        if (mine.topic, mine.type_name, is_keyed(mine.guid.entity)) != (
            remote.topic,
            remote.type_name,
            is_keyed(remote.guid.entity),
        ):
            return
        offered, asked = (mine, remote) if local.is_writer else (remote, mine)
        refused = asked.qos.refused(offered.qos)
        if refused:
            if remote.guid in local.matched:
                self._unmatch(local, remote.guid)
            if local.refused.get(remote.guid) != refused:
                local.refused[remote.guid] = refused
                self._events.append(Incompatible(mine.guid, remote, refused))
            return
        local.refused.pop(remote.guid, None)
        if address is None:
            return
        new = remote.guid not in local.matched
        local.matched[remote.guid] = remote
        local.endpoint.match(remote, address, self._now)
        if new:
            self._events.append(Matched(mine.guid, remote))

    def _unmatch(self, local: Local, guid: Guid) -> None:
        remote = local.matched.pop(guid)
        local.endpoint.unmatch(guid)
        self._events.append(Unmatched(local.data.guid, remote))

    def _address(self, remote: EndpointData) -> Address | None:
        """Return where to send to an endpoint: its own address, or that of its participant."""
        peer = self._peers.get(remote.guid.prefix)
        own = remote.addresses or (peer.user if peer else ())
        return nearest(own, self._host)
