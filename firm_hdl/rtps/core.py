"""A participant without sockets, threads and clocks: datagrams and the time in, datagrams out.

It has the built-in endpoints of discovery (8.5) and the user's endpoints, and brings what comes to
the endpoint that it is for. :mod:`firm_hdl.rtps.participant` connects it with a network.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Collection, Iterator, Sequence

from firm_hdl.rtps.backlog import MOST_SAMPLE_BYTES
from firm_hdl.rtps.budget import Budget
from firm_hdl.rtps.discovery import EndpointData, ParticipantData
from firm_hdl.rtps.events import Arrived, Event, Sample
from firm_hdl.rtps.peers import Outgoing
from firm_hdl.rtps.qos import Durability, Qos
from firm_hdl.rtps.reader import Reader
from firm_hdl.rtps.sedp import Local, Sedp
from firm_hdl.rtps.spdp import Settings, Spdp
from firm_hdl.rtps.wire import message
from firm_hdl.rtps.wire.guid import (
    SPDP_WRITER,
    Guid,
    SampleIdentity,
    is_builtin,
    user_reader,
    user_writer,
)
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.message import Received
from firm_hdl.rtps.wire.octets import MalformedError
from firm_hdl.rtps.wire.parameters import ParameterList, identity
from firm_hdl.rtps.wire.submessages import (
    NO_PARAMETERS,
    AckNack,
    Data,
    DataFrag,
    Gap,
    Heartbeat,
    HeartbeatFrag,
    InfoDestination,
    NackFrag,
    Submessage,
)
from firm_hdl.rtps.writer import HistoryFullError, Writer

__all__ = ["Core"]

# Bytes that wait to be sent. An address has at most as many as are left for others.
_MAX_OUTBOX_BYTES = 128 << 20
# Events that wait for the user, and bytes of the samples among them.
_MAX_EVENTS, _MAX_EVENT_BYTES = 1 << 16, 64 << 20


class Core:
    """A participant."""

    def __init__(self, settings: Settings):
        self.settings = settings
        self.prefix = settings.own.prefix
        # Datagrams to send, in this order: pairs of an address and bytes.
        self.outbox: deque[tuple[Address, bytes]] = deque()
        # What happened, oldest first. `next_event` removes them.
        self.events: deque[Event] = deque()
        # What came and what became of it; the page docs/explanation/rtps.md explains each.
        self.counters: Counter[str] = Counter()
        self._outbox_bytes = 0
        # Of which so many to each address.
        self._waiting: dict[Address, int] = {}
        self._event_bytes = 0
        self._keys = 0
        self._budget = Budget(settings.memory_bytes)
        self._sedp = Sedp(self.prefix, self._post, self._budget, self.events, self.counters)
        self._spdp = Spdp(settings, self._sedp, self._tell, self.counters)
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
        """Return the endpoints that one of ours is matched with."""
        local = self._sedp.locals.get(guid)
        return () if local is None else tuple(local.matched.values())

    def add_writer(
        self, topic: str, type_name: str, qos: Qos, user_data: bytes, now: float
    ) -> Writer:
        """Create and announce a writer. The names are those of the wire."""
        self._keys += 1
        guid = Guid(self.prefix, user_writer(self._keys))
        writer = Writer(guid, qos, self._post, self.settings.fragment_bytes, self.counters)
        self._writers[guid.entity] = writer
        self._announce(writer, topic, type_name, qos, user_data, now)
        return writer

    def add_reader(
        self,
        topic: str,
        type_name: str,
        qos: Qos,
        user_data: bytes,
        now: float,
        most_bytes: int = MOST_SAMPLE_BYTES,
    ) -> Reader:
        """Create and announce a reader. Its samples become events."""
        self._keys += 1
        guid = Guid(self.prefix, user_reader(self._keys))

        def deliver(source: Guid, data: Data, timestamp: int | None) -> None:
            self._deliver(guid, source, data, timestamp)

        reader = Reader(guid, qos, self._post, deliver, self._budget, most_bytes, self.counters)
        self._readers[guid.entity] = reader
        local = self._announce(reader, topic, type_name, qos, user_data, now)
        if qos.durability > Durability.VOLATILE:
            # Writers of this participant that are volatile have no history for it.
            for other in local.beside.values():
                assert isinstance(other.endpoint, Writer)
                for change in other.endpoint.history():
                    if change.is_for(guid):
                        self._deliver(guid, other.data.guid, change.data, change.timestamp)
        return reader

    def remove(self, guid: Guid, now: float) -> None:
        """Remove an endpoint, and tell peers."""
        local = self._sedp.locals.get(guid)
        if local is not None:
            if isinstance(local.endpoint, Writer):
                self.counters["unacknowledged"] += local.endpoint.unacknowledged
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
        to: Collection[Guid] | None = None,
    ) -> int:
        """Write a sample, and return its sequence number.

        Raises `HistoryFullError`: the writer keeps all samples, and readers have acknowledged too
        little.
        """
        local = self._sedp.locals.get(writer.guid)
        beside = [] if local is None else [g for g in local.beside if to is None or g in to]
        if beside and self._is_crowded and writer.qos.reliable and not writer.qos.depth:
            raise HistoryFullError("readers of this participant have taken too few samples")
        inline = NO_PARAMETERS if related is None else ParameterList(tuple(identity(related)))
        number = writer.write(payload, now, timestamp, inline, to=to)
        for reader in beside:
            if self._is_crowded:
                self.counters["refused"] += 1
                continue
            data = Data(
                reader=reader.entity,
                writer=writer.guid.entity,
                sequence_number=number,
                payload=payload,
                inline=inline,
            )
            self._deliver(reader, writer.guid, data, timestamp)
        return number

    def receive(self, datagram: bytes, now: float, host: str | None = None) -> None:
        """Take a datagram. Whatever is in it, there is no error; what is wrong is counted.

        Parameters
        ----------
        host : str or None
            IPv4 address that it came from, if that is known. Peers are reached there first.
        """
        self.counters["received"] += 1
        try:
            content = message.read(datagram, self.prefix)
        except MalformedError:
            self.counters["malformed"] += 1
            return
        if content.source == self.prefix:
            return
        self._spdp.hear(content.source, host, len(datagram), now)
        self.counters["unknown"] += bool(content.unknown)
        bad = content.error is not None
        for each in content.received:
            try:
                self._take(each, host, now)
            except MalformedError:
                # Such as discovery data that is no parameter list. Other submessages are not
                # concerned.
                bad = True
        self.counters["malformed"] += bad

    def tick(self, now: float) -> float:
        """Do what is due. Return when to call again, at the latest."""
        ends = (local.endpoint.tick(now) for local in self._sedp.locals.values())
        return min(self._spdp.tick(now), self._sedp.tick(now), *ends)

    @property
    def writers(self) -> list[Writer]:
        """The user's writers."""
        ends = [local.endpoint for local in self._sedp.locals.values()]
        return [each for each in ends if isinstance(each, Writer)]

    def leave(self) -> None:
        """Tell all peers that this participant leaves. What was not sent yet is dropped."""
        self.counters["unsent"] += len(self.outbox)
        self.counters["unacknowledged"] += sum(each.unacknowledged for each in self.writers)
        while self.outbox:
            self.pop()
        self._spdp.leave()

    def next_event(self) -> Event | None:
        """Remove and return the oldest event, or return `None`."""
        if not self.events:
            return None
        event = self.events.popleft()
        if isinstance(event, Arrived):
            self._event_bytes -= len(event.sample.payload)
        return event

    def pop(self) -> tuple[Address, bytes]:
        """Remove and return the next datagram to send.

        Raises `IndexError`: there is none.
        """
        address, datagram = self.outbox.popleft()
        self._outbox_bytes -= len(datagram)
        self._waiting[address] -= len(datagram)
        if not self._waiting[address]:
            del self._waiting[address]
        return address, datagram

    def _post(self, outgoing: Outgoing) -> None:
        """Send to a peer, if it has the credit for what it asked for.

        Submessages begin with a word (9.4.1). So one that ends within a word is the last one of
        its datagram, and the others go in another.
        """
        some: list[Submessage] = []
        for each in outgoing.submessages:
            some.append(each)
            payload = each.payload if isinstance(each, Data | DataFrag) else None
            if len(payload or b"") % 4 or each is outgoing.submessages[-1]:
                self._post_datagram(outgoing, some)
                some = []

    def _post_datagram(self, outgoing: Outgoing, submessages: Sequence[Submessage]) -> None:
        route = outgoing.route
        datagram = message.write(self.prefix, (InfoDestination(outgoing.prefix), *submessages))
        ways, are_its_own = route.ways()
        for way in ways:
            # Whatever goes to an address that may be somebody else's costs credit.
            is_free = are_its_own and not outgoing.is_answer
            if is_free or route.peer.spend(len(datagram)):
                self._enqueue(way, datagram)
            else:
                self.counters["withheld"] += 1

    def _tell(self, address: Address, submessage: Submessage) -> None:
        self._enqueue(address, message.write(self.prefix, (submessage,)))

    def _enqueue(self, address: Address, datagram: bytes) -> None:
        size = len(datagram)
        waiting = self._waiting.get(address, 0) + size
        if waiting > _MAX_OUTBOX_BYTES - self._outbox_bytes:
            self.counters["dropped"] += 1
            return
        self._outbox_bytes += size
        self._waiting[address] = waiting
        self.outbox.append((address, datagram))

    def _announce(
        self,
        endpoint: Writer | Reader,
        topic: str,
        type_name: str,
        qos: Qos,
        user_data: bytes,
        now: float,
    ) -> Local:
        data = EndpointData(
            guid=endpoint.guid,
            topic=topic,
            type_name=type_name,
            qos=qos,
            addresses=self.settings.own.user,
            user_data=user_data,
        )
        local = Local(endpoint, data)
        self._sedp.add(local, now)
        return local

    @property
    def _is_crowded(self) -> bool:
        """Whether the user has to take events before more come."""
        return len(self.events) >= _MAX_EVENTS or self._event_bytes >= _MAX_EVENT_BYTES

    def _take(self, received: Received, host: str | None, now: float) -> None:
        """Bring a submessage to the endpoints that it is for."""
        submessage, stamp = received.submessage, received.timestamp
        # Only what becomes an event, or leads to one, is refused: answers of readers still free the
        # histories of writers.
        if isinstance(submessage, Data | DataFrag) and self._is_crowded:
            # A reliable writer sends it again.
            self.counters["refused"] += 1
            return
        if isinstance(submessage, Data) and submessage.writer == SPDP_WRITER:
            self._spdp.on_data(received.source, submessage, host, now)
            return
        if self._spdp.peer(received.source) is None:
            self.counters["strangers"] += 1
            return
        if isinstance(submessage, AckNack | NackFrag):
            self._answered(Guid(received.source, submessage.reader), submessage, now)
            return
        for reader, writer in self._listeners(received):
            match submessage:
                case Data():
                    reader.on_data(writer, submessage, stamp, now)
                case DataFrag():
                    reader.on_data_frag(writer, submessage, stamp, now)
                case Heartbeat():
                    if reader.on_heartbeat(writer, submessage, now) and is_builtin(writer.entity):
                        self._sedp.renew(writer.prefix, now)
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
        if isinstance(answer, NackFrag):
            writer.on_nack_frag(reader, answer, now)
        elif writer.on_ack_nack(reader, answer, now) and is_builtin(answer.writer):
            self._sedp.renew(reader.prefix, now)

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
        self._event_bytes += len(sample.payload)
        self.events.append(Arrived(reader, sample))
