"""The Simple Endpoint Discovery Protocol (8.5.4): endpoints find each other. No I/O.

The announcements of endpoints are samples of two reliable, transient-local writers, which are the
same class as writers of users.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Iterator
from dataclasses import dataclass, field

from firm_hdl.rtps.budget import Budget
from firm_hdl.rtps.discovery import EndpointData, check_owner, key_of, key_payload
from firm_hdl.rtps.events import Event, Incompatible, Matched, PeerFound, PeerLost, Unmatched
from firm_hdl.rtps.peers import Peer, Route, Send
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
from firm_hdl.rtps.wire.octets import MalformedError
from firm_hdl.rtps.wire.parameters import ParameterList, Pid
from firm_hdl.rtps.wire.submessages import Data
from firm_hdl.rtps.writer import Writer

__all__ = ["Local", "Sedp"]

# Announcements of all endpoints are kept for participants that come late.
_QOS = Qos(durability=Durability.TRANSIENT_LOCAL, depth=0, max_samples=1 << 31)
_MAX_ENDPOINTS = 2048
# Endpoints of one participant that an endpoint of ours is matched with.
_MAX_MATCHES = 64
# The largest announcement.
_MOST_BYTES = 1 << 16
# Memory for the endpoints of all participants, and what one takes besides its announcement, about.
_SPACE_BYTES, _ENDPOINT_BYTES = 32 << 20, 1000


@dataclass(slots=True)
class Local:
    """An endpoint of the user."""

    endpoint: Writer | Reader
    data: EndpointData  # What is announced about it.
    number: int = 0  # Sequence number of the announcement.
    # Endpoints of peers that fit, and policies that do not. Those of this participant that fit are
    # in `matched`, too.
    matched: dict[Guid, EndpointData] = field(default_factory=dict)
    refused: dict[Guid, tuple[str, ...]] = field(default_factory=dict)
    # Endpoints of this participant that fit.
    beside: dict[Guid, Local] = field(default_factory=dict)
    # How many endpoints of each participant fit.
    matches: Counter[bytes] = field(default_factory=Counter)

    @property
    def is_writer(self) -> bool:
        """Whether it is a writer."""
        return isinstance(self.endpoint, Writer)


@dataclass(slots=True, eq=False)
class _Known:
    """A participant with its endpoints, and whether each is a writer."""

    sedp: Sedp
    peer: Peer
    prefix: bytes
    endpoints: dict[Guid, tuple[EndpointData, bool]] = field(default_factory=dict)
    sizes: dict[Guid, int] = field(default_factory=dict)

    def shrink(self) -> None:
        """Forget an endpoint: the newest that is not matched, if there is one."""
        self.sedp.forget_one(self)


class Sedp:
    """The built-in endpoints of SEDP, and the endpoints of this and of other participants.

    * `budget`: memory for announcements that are not complete.
    * `events`: takes what happened.
    * `counters`: counts announcements that are ``malformed``, endpoints that are ``not_kept``, and
      those that fit, but are ``not_matched``: their participant has too many.
    """

    def __init__(
        self,
        prefix: bytes,
        send: Send,
        budget: Budget,
        events: deque[Event],
        counters: Counter[str] | None = None,
    ):
        self._prefix = prefix
        self._events = events
        self._counters = Counter[str]() if counters is None else counters
        self._known: dict[bytes, _Known] = {}
        self._space = Budget(_SPACE_BYTES)
        self._locals: dict[Guid, Local] = {}
        # How many endpoints of each participant are matched with ours.
        self._matches: Counter[bytes] = Counter()
        self._now = 0.0
        self.publications = Writer(
            Guid(prefix, PUBLICATIONS_WRITER), _QOS, send, counters=self._counters
        )
        self.subscriptions = Writer(
            Guid(prefix, SUBSCRIPTIONS_WRITER), _QOS, send, counters=self._counters
        )

        def listener(entity: int, writer: bool) -> Reader:
            def deliver(source: Guid, data: Data, timestamp: int | None) -> None:
                try:
                    self._on_announcement(source.prefix, data, writer)
                except MalformedError:
                    self._counters["malformed"] += 1

            return Reader(
                Guid(prefix, entity), _QOS, send, deliver, budget, _MOST_BYTES, self._counters
            )

        self.publications_reader = listener(PUBLICATIONS_READER, True)
        self.subscriptions_reader = listener(SUBSCRIPTIONS_READER, False)

    @property
    def locals(self) -> dict[Guid, Local]:
        """The user's endpoints."""
        return self._locals

    def remotes(self, writers: bool) -> Iterator[EndpointData]:
        """Yield the writers or the readers of all peers."""
        for known in self._known.values():
            yield from (data for data, writer in known.endpoints.values() if writer == writers)

    def rank(self, prefix: bytes) -> int:
        """Return 2 for a peer that is matched with us, 1 for one with endpoints, and 0."""
        if self._matches[prefix]:
            return 2
        known = self._known.get(prefix)
        return int(known is not None and bool(known.endpoints))

    def on_peer(self, peer: Peer, now: float) -> None:
        """Match the built-in endpoints with those that a participant has (8.5.5.1)."""
        self._now = now
        prefix = peer.data.prefix
        known = self._known.get(prefix)
        if known is None:
            known = self._known[prefix] = _Known(self, peer, prefix)
        self._events.append(PeerFound(peer.data))
        if not peer.data.discovery:
            return
        # Bits of BuiltinEndpointSet_t (9.3.2), as `_BUILTIN_ENDPOINTS` has them.
        for bit, endpoint, entity in (
            (3, self.publications, PUBLICATIONS_READER),
            (5, self.subscriptions, SUBSCRIPTIONS_READER),
            (2, self.publications_reader, PUBLICATIONS_WRITER),
            (4, self.subscriptions_reader, SUBSCRIPTIONS_WRITER),
        ):
            if peer.data.has(bit):
                remote = EndpointData(guid=Guid(prefix, entity), topic="", type_name="", qos=_QOS)
                endpoint.match(remote, Route(peer, discovery=True), now)
        for data, writer in list(known.endpoints.values()):
            self._match_all(data, writer)

    def on_peer_lost(self, prefix: bytes, expired: bool) -> None:
        """Forget a participant with all its endpoints (8.5.5.2)."""
        known = self._known.pop(prefix)
        self.publications.unmatch(Guid(prefix, PUBLICATIONS_READER))
        self.subscriptions.unmatch(Guid(prefix, SUBSCRIPTIONS_READER))
        self.publications_reader.unmatch(Guid(prefix, PUBLICATIONS_WRITER))
        self.subscriptions_reader.unmatch(Guid(prefix, SUBSCRIPTIONS_WRITER))
        for guid in list(known.endpoints):
            self._forget(known, guid)
        self._events.append(PeerLost(known.peer.data, expired))

    def renew(self, prefix: bytes, now: float) -> None:
        """Begin anew with a participant that began anew under its old name."""
        known = self._known.get(prefix)
        if known is not None:
            self._counters["restarted"] += 1
            self.on_peer_lost(prefix, expired=True)
            self.on_peer(known.peer, now)

    def add(self, local: Local, now: float) -> None:
        """Announce an endpoint, and match it with those of peers, and of this participant."""
        self._now = now
        announcer = self.publications if local.is_writer else self.subscriptions
        local.number = announcer.write(local.data.encode(), now)
        self._locals[local.data.guid] = local
        for known in self._known.values():
            for data, writer in known.endpoints.values():
                if writer != local.is_writer:
                    self._match(local, data)
        for other in list(self._locals.values()):
            if other.is_writer != local.is_writer:
                self._match(local, other.data)
                self._match(other, local.data)

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
        for other in self._locals.values():
            if guid in other.matched:
                self._unmatch(other, guid)

    def tick(self, now: float) -> float:
        """Do what is due. Return when to call again, at the latest."""
        self._now = now
        return min(
            self.publications.tick(now),
            self.subscriptions.tick(now),
            self.publications_reader.tick(now),
            self.subscriptions_reader.tick(now),
        )

    def forget_one(self, known: _Known) -> None:
        """Forget an endpoint of a participant: the newest that is not matched, if there is one."""
        newest = list(reversed(known.endpoints))
        unmatched = (
            guid
            for guid in newest
            if not any(guid in local.matched for local in self._locals.values())
        )
        self._forget(known, next(unmatched, newest[0]))
        self._counters["not_kept"] += 1

    def _on_announcement(self, source: bytes, data: Data, writer: bool) -> None:
        """Take an announcement, or the news that an endpoint is gone."""
        known = self._known.get(source)
        if known is None:
            return
        if data.payload is None or data.key:
            gone = key_of(data.payload, data.inline, Pid.ENDPOINT_GUID)
            if gone is not None:
                check_owner(gone.prefix, source)
                self._forget(known, gone)
            return
        remote = EndpointData.decode(data.payload, writer)
        check_owner(remote.guid.prefix, source)
        new = remote.guid not in known.endpoints
        size = _ENDPOINT_BYTES + len(data.payload)
        if new and len(known.endpoints) >= _MAX_ENDPOINTS:
            self._counters["not_kept"] += 1
            return
        if not new:
            self._space.give_back(known, known.sizes.pop(remote.guid))
        if not self._space.take(known, size):
            self._forget(known, remote.guid)
            self._counters["not_kept"] += 1
            return
        known.sizes[remote.guid] = size
        known.endpoints[remote.guid] = (remote, writer)
        self._match_all(remote, writer)

    def _forget(self, known: _Known, guid: Guid) -> None:
        """Forget an endpoint of a participant."""
        if known.endpoints.pop(guid, None) is None:
            return
        size = known.sizes.pop(guid, None)
        if size is not None:
            self._space.give_back(known, size)
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
        mine, guid, prefix = local.data, remote.guid, remote.guid.prefix
        is_new = guid not in local.matched
        same = (mine.topic, mine.type_name, is_keyed(mine.guid.entity)) == (
            remote.topic,
            remote.type_name,
            is_keyed(guid.entity),
        )
        offered, asked = (mine, remote) if local.is_writer else (remote, mine)
        refused = asked.qos.refused(offered.qos) if same else ()
        if not same or refused:
            if not is_new:
                self._unmatch(local, guid)
            if refused and local.refused.get(guid) != refused:
                local.refused[guid] = refused
                self._events.append(Incompatible(mine.guid, remote, refused))
            return
        local.refused.pop(guid, None)
        if prefix == self._prefix:
            local.beside[guid] = self._locals[guid]
        else:
            route = Route(self._known[prefix].peer, remote.addresses)
            if not route.ways()[0]:
                return
            if is_new and local.matches[prefix] >= _MAX_MATCHES:
                self._counters["not_matched"] += 1
                return
            local.endpoint.match(remote, route, self._now)
        local.matched[guid] = remote
        if is_new:
            local.matches[prefix] += 1
            self._matches[prefix] += 1
            self._events.append(Matched(mine.guid, remote))

    def _unmatch(self, local: Local, guid: Guid) -> None:
        remote = local.matched.pop(guid)
        local.beside.pop(guid, None)
        local.endpoint.unmatch(guid)
        for matches in (local.matches, self._matches):
            matches[guid.prefix] -= 1
            if not matches[guid.prefix]:
                del matches[guid.prefix]
        self._events.append(Unmatched(local.data.guid, remote))
