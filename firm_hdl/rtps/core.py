"""A participant without sockets, threads and clocks: datagrams and the time in, datagrams out.

It has the built-in endpoints of discovery (8.5) and the user's endpoints, and brings what comes to
the endpoint that it is for. :mod:`firm_hdl.rtps.participant` connects it with a network.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Iterator
from dataclasses import dataclass

from firm_hdl.rtps.discovery import EndpointData, ParticipantData
from firm_hdl.rtps.events import Arrived, Event, PeerFound, PeerLost, Sample
from firm_hdl.rtps.fragments import Budget
from firm_hdl.rtps.outgoing import Outgoing
from firm_hdl.rtps.qos import Qos
from firm_hdl.rtps.reader import Reader
from firm_hdl.rtps.sedp import Local, Sedp
from firm_hdl.rtps.spdp import Spdp
from firm_hdl.rtps.wire import message
from firm_hdl.rtps.wire.guid import (
    SPDP_WRITER,
    UNKNOWN_PREFIX,
    Guid,
    SampleIdentity,
    user_reader,
    user_writer,
)
from firm_hdl.rtps.wire.infos import InfoDestination
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.message import Received
from firm_hdl.rtps.wire.octets import MalformedError
from firm_hdl.rtps.wire.parameters import ParameterList, identity
from firm_hdl.rtps.wire.reliability import AckNack, Gap, Heartbeat, HeartbeatFrag, NackFrag
from firm_hdl.rtps.wire.samples import NO_PARAMETERS, Data, DataFrag
from firm_hdl.rtps.writer import FRAGMENT_BYTES, Writer

__all__ = ["Core", "Settings"]

# Bytes that wait to be sent. More come only if peers ask for much, and can ask again.
_MAX_OUTBOX_BYTES = 64 << 20


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """What a participant is and does.

    Attributes
    ----------
    own : ParticipantData
        What it announces.
    host : str
        Its IPv4 address.
    targets : tuple of Address
        Where announcements go.
    period : float
        Seconds between announcements.
    fragment_bytes : int
        Larger samples are sent in fragments of this size: from 256 to 65,000.
    memory_bytes : int
        Memory for samples that cannot be delivered yet.
    """

    own: ParticipantData
    host: str
    targets: tuple[Address, ...]
    period: float = 1.0
    fragment_bytes: int = FRAGMENT_BYTES
    memory_bytes: int = 128 << 20

    def __post_init__(self) -> None:
        if not 256 <= self.fragment_bytes <= 65_000:
            raise ValueError(
                f"Fragments must have from 256 to 65000 bytes, not {self.fragment_bytes}"
            )


class Core:
    """A participant.

    Parameters
    ----------
    settings : Settings
        What it is and does.

    Attributes
    ----------
    outbox : deque
        Datagrams to send, in this order: pairs of an address and bytes.
    events : deque
        What happened, oldest first. The user removes them.
    counters : Counter
        How many datagrams came (``received``), were not valid or not valid to the end
        (``malformed``), had a kind of submessage that is not known (``unknown``), or were not sent
        because too many wait (``dropped``).
    """

    def __init__(self, settings: Settings):
        self.settings = settings
        self.prefix = settings.own.prefix
        self.outbox: deque[tuple[Address, bytes]] = deque()
        self.events: deque[Event] = deque()
        self.counters: Counter[str] = Counter()
        self._outbox_bytes = 0
        self._keys = 0
        self._budget = Budget(settings.memory_bytes)
        own, host, send = settings.own, settings.host, self._post
        self._sedp = Sedp(own.prefix, host, send, self._budget, self.events)
        self._spdp = Spdp(
            own, host, settings.targets, settings.period, send, self._found, self._lost
        )
        pub, sub = self._sedp.publications, self._sedp.subscriptions
        self._writers = {each.guid.entity: each for each in (pub, sub)}
        listeners = (self._sedp.publications_reader, self._sedp.subscriptions_reader)
        self._readers = {each.guid.entity: each for each in listeners}

    @property
    def peers(self) -> tuple[ParticipantData, ...]:
        """The participants that are there."""
        return self._spdp.peers

    def remotes(self, writers: bool) -> Iterator[EndpointData]:
        """Yield the writers or the readers of all peers."""
        return self._sedp.remotes(writers)

    def matched(self, guid: Guid) -> tuple[EndpointData, ...]:
        """Return the endpoints of peers that one of ours is matched with."""
        local = self._sedp.locals.get(guid)
        return () if local is None else tuple(local.matched.values())

    def add_writer(
        self, topic: str, type_name: str, qos: Qos, user_data: bytes, now: float
    ) -> Writer:
        """Create and announce a writer. The names are those of the wire."""
        self._keys += 1
        guid = Guid(self.prefix, user_writer(self._keys))
        writer = Writer(guid, qos, self._post, self.settings.fragment_bytes)
        self._writers[guid.entity] = writer
        self._announce(writer, topic, type_name, qos, user_data, now)
        return writer

    def add_reader(
        self, topic: str, type_name: str, qos: Qos, user_data: bytes, now: float
    ) -> Reader:
        """Create and announce a reader. Its samples become events."""
        self._keys += 1
        guid = Guid(self.prefix, user_reader(self._keys))

        def deliver(source: Guid, data: Data, timestamp: int | None) -> None:
            self._deliver(guid, source, data, timestamp)

        reader = Reader(guid, qos, self._post, deliver, self._budget)
        self._readers[guid.entity] = reader
        self._announce(reader, topic, type_name, qos, user_data, now)
        return reader

    def remove(self, guid: Guid, now: float) -> None:
        """Remove an endpoint, and tell peers."""
        if guid in self._sedp.locals:
            self._sedp.remove(guid, now)
            self._writers.pop(guid.entity, None)
            self._readers.pop(guid.entity, None)

    def write(
        self,
        writer: Writer,
        payload: bytes,
        now: float,
        timestamp: int | None,
        related: SampleIdentity | None = None,
    ) -> int:
        """Write a sample, and return its sequence number.

        Raises
        ------
        HistoryFullError
            The writer keeps all samples, and readers have acknowledged too little.
        """
        inline = NO_PARAMETERS if related is None else ParameterList(tuple(identity(related)))
        return writer.write(payload, now, timestamp, inline)

    def receive(self, datagram: bytes, now: float) -> None:
        """Take a datagram. Whatever is in it, there is no error; what is wrong is counted."""
        self.counters["received"] += 1
        try:
            content = message.read(datagram, self.prefix)
        except MalformedError:
            self.counters["malformed"] += 1
            return
        if content.source == self.prefix:
            return
        self._spdp.refresh(content.source, now)
        self.counters["unknown"] += bool(content.unknown)
        bad = content.error is not None
        for each in content.received:
            try:
                self._take(each, now)
            except MalformedError:
                # Such as discovery data that is no parameter list. Other submessages are not
                # concerned.
                bad = True
        self.counters["malformed"] += bad

    def tick(self, now: float) -> float:
        """Do what is due. Return when to call again, at the latest."""
        due = [self._spdp.tick(now), self._sedp.tick(now)]
        for local in self._sedp.locals.values():
            due.append(local.endpoint.tick(now))
        return min(due)

    def leave(self) -> None:
        """Tell all peers that this participant leaves."""
        self._spdp.leave()

    def pop(self) -> tuple[Address, bytes]:
        """Remove and return the next datagram to send.

        Raises
        ------
        IndexError
            There is none.
        """
        address, datagram = self.outbox.popleft()
        self._outbox_bytes -= len(datagram)
        return address, datagram

    def _post(self, outgoing: Outgoing) -> None:
        head = () if outgoing.prefix == UNKNOWN_PREFIX else (InfoDestination(outgoing.prefix),)
        datagram = message.write(self.prefix, (*head, *outgoing.submessages))
        if self._outbox_bytes + len(datagram) > _MAX_OUTBOX_BYTES:
            self.counters["dropped"] += 1
            return
        self._outbox_bytes += len(datagram)
        self.outbox.append((outgoing.to, datagram))

    def _announce(
        self,
        endpoint: Writer | Reader,
        topic: str,
        type_name: str,
        qos: Qos,
        user_data: bytes,
        now: float,
    ) -> None:
        data = EndpointData(
            guid=endpoint.guid,
            topic=topic,
            type_name=type_name,
            qos=qos,
            addresses=self.settings.own.user,
            user_data=user_data,
        )
        self._sedp.add(Local(endpoint, data), now)

    def _take(self, received: Received, now: float) -> None:
        """Bring a submessage to the endpoints that it is for."""
        submessage, stamp = received.submessage, received.timestamp
        match submessage:
            case AckNack() | NackFrag():
                self._answered(Guid(received.source, submessage.reader), submessage, now)
                return
            case Data(writer=entity) if entity == SPDP_WRITER:
                self._spdp.on_data(received.source, submessage, now)
                return
        for reader, writer in self._listeners(received):
            match submessage:
                case Data():
                    reader.on_data(writer, submessage, stamp, now)
                case DataFrag():
                    reader.on_data_frag(writer, submessage, stamp, now)
                case Heartbeat():
                    reader.on_heartbeat(writer, submessage, now)
                case HeartbeatFrag():
                    reader.on_heartbeat_frag(writer, submessage, now)
                case Gap():
                    reader.on_gap(writer, submessage, now)

    def _listeners(self, received: Received) -> Iterator[tuple[Reader, Guid]]:
        """Yield the readers that a submessage of a writer is for, and the writer.

        Reader 0 means all readers that are matched with the writer (8.3.8.2).
        """
        submessage = received.submessage
        assert isinstance(submessage, Data | DataFrag | Heartbeat | HeartbeatFrag | Gap)
        writer = Guid(received.source, submessage.writer)
        if submessage.reader:
            reader = self._readers.get(submessage.reader)
            if reader is not None:
                yield reader, writer
            return
        for reader in list(self._readers.values()):
            yield reader, writer

    def _answered(self, reader: Guid, answer: AckNack | NackFrag, now: float) -> None:
        writer = self._writers.get(answer.writer)
        if writer is None:
            return
        if isinstance(answer, AckNack):
            writer.on_ack_nack(reader, answer, now)
        else:
            writer.on_nack_frag(reader, answer, now)

    def _deliver(self, reader: Guid, writer: Guid, data: Data, timestamp: int | None) -> None:
        if data.payload is None or data.key:
            return
        try:
            related = data.inline.related(writer.prefix[:2])
        except MalformedError:
            self.counters["malformed"] += 1
            related = None
        sample = Sample(
            payload=data.payload,
            writer=writer,
            sequence_number=data.sequence_number,
            source_timestamp=timestamp,
            related=related,
        )
        self.events.append(Arrived(reader, sample))

    def _found(self, peer: ParticipantData, now: float) -> None:
        self._sedp.on_peer(peer, now)
        self.events.append(PeerFound(peer))

    def _lost(self, peer: ParticipantData, expired: bool) -> None:
        self._sedp.on_peer_lost(peer.prefix)
        self.events.append(PeerLost(peer, expired))
