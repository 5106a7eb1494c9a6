"""A writer: its history, and the readers that it serves (8.4.7.4, 8.4.9). No I/O, no clock.

Calls bring the time, samples and what readers answered; datagrams go to `send`. So a test decides
what is lost, and when.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from firm_hdl.rtps.discovery import EndpointData
from firm_hdl.rtps.fragments import fragment, fragment_count
from firm_hdl.rtps.outgoing import Outgoing, Send
from firm_hdl.rtps.qos import Durability, Qos
from firm_hdl.rtps.wire.guid import Guid
from firm_hdl.rtps.wire.infos import InfoTimestamp
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.numbers import NumberSet
from firm_hdl.rtps.wire.parameters import ParameterList
from firm_hdl.rtps.wire.reliability import AckNack, Gap, Heartbeat, NackFrag
from firm_hdl.rtps.wire.samples import NO_PARAMETERS, Data
from firm_hdl.rtps.wire.submessages import Submessage

__all__ = ["FRAGMENT_BYTES", "HistoryFullError", "Writer"]

FRAGMENT_BYTES = 1280
"""Largest payload of one datagram, in bytes.

With headers, a timestamp, inline QoS and a heartbeat, a datagram stays below the 1,472 bytes that
an Ethernet frame holds. So IP does not cut it, and boards without IP fragments can read it.
"""

# Seconds between heartbeats while a reader has not acknowledged all: at first, and at most.
_HEARTBEAT, _MAX_HEARTBEAT = 0.05, 1.0
# Seconds between those that ask for an acknowledgement while half of a KEEP_ALL history is in use.
_HEARTBEAT_WHEN_FULL = 0.002
# Heartbeats to a reader that never answered.
_MOST_UNANSWERED = 12
# Seconds before a sample is sent once more: nackSuppressionDuration of 8.4.7.1.
_SUPPRESSION = 0.01


class HistoryFullError(Exception):
    """A writer that keeps all samples has no room before readers acknowledge some."""


@dataclass(frozen=True, slots=True)
class _Change:
    """A sample in the history (CacheChange, 8.2.3)."""

    data: Data
    timestamp: int | None
    # Kept until readers of today have it, even if others may come: the end of an instance.
    passing: bool


@dataclass(slots=True)
class _Proxy:
    """A matched reader (ReaderProxy, 8.4.7.5)."""

    guid: Guid
    address: Address
    reliable: bool
    # Lowest sequence number that is relevant to it; all up to `acked` were acknowledged.
    first: int
    acked: int
    heard: bool = False
    unanswered: int = 0
    last_count: int | None = None
    last_fragment_count: int | None = None
    period: float = _HEARTBEAT
    heartbeat_at: float = 0.0
    asked_at: float = float("-inf")
    resent: dict[int, float] = field(default_factory=dict)


class Writer:
    """A writer, best-effort or reliable.

    Parameters
    ----------
    guid : Guid
        Its name.
    qos : Qos
        Its policies.
    send : Send
        Takes its datagrams.
    fragment_bytes : int
        Samples with more bytes are sent in fragments of this size.
    """

    def __init__(
        self,
        guid: Guid,
        qos: Qos,
        send: Send,
        fragment_bytes: int = FRAGMENT_BYTES,
    ):
        self.guid = guid
        self.qos = qos
        self._send = send
        self._fragment_bytes = fragment_bytes
        self._changes: dict[int, _Change] = {}
        self._proxies: dict[Guid, _Proxy] = {}
        self._count = 0
        self.last = 0

    @property
    def matched(self) -> tuple[Guid, ...]:
        """The readers that it serves."""
        return tuple(self._proxies)

    def write(
        self,
        payload: bytes | None,
        now: float,
        timestamp: int | None = None,
        inline: ParameterList = NO_PARAMETERS,
        key: bool = False,
    ) -> int:
        """Add a sample to the history, send it to all readers, and return its sequence number.

        Parameters
        ----------
        payload : bytes or None
            The sample with its encapsulation header; with `key`, the key of an instance that ends.
        now : float
            The time, in seconds of any clock that never goes back.
        timestamp : int or None
            Nanoseconds since 1970, for the readers.

        Raises
        ------
        HistoryFullError
            The depth is 0, and readers have acknowledged too little.
        """
        self._make_room()
        self.last += 1
        data = Data(
            reader=0,
            writer=self.guid.entity,
            sequence_number=self.last,
            payload=payload,
            key=key,
            inline=inline,
        )
        change = _Change(data, timestamp, key)
        if self._durable or any(proxy.reliable for proxy in self._proxies.values()):
            self._changes[self.last] = change
        for proxy in self._proxies.values():
            if proxy.acked >= self.last - 1:
                proxy.period, proxy.heartbeat_at = _HEARTBEAT, now + _HEARTBEAT
            self._transmit(proxy, change, self._heartbeat_with(proxy, change, now))
        return self.last

    def forget(self, number: int) -> None:
        """Remove a sample from the history. Readers that ask for it get a GAP."""
        self._changes.pop(number, None)

    def match(self, reader: EndpointData, address: Address, now: float) -> None:
        """Begin to serve a reader, or note its new address.

        A reader that is not volatile gets the history. Any other begins with the next sample; old
        ones are not sent again, whoever asks for them.
        """
        known = self._proxies.get(reader.guid)
        if known is not None:
            known.address = address
            return
        wants_old = self._durable and reader.qos.durability > Durability.VOLATILE
        first = min(self._changes, default=self.last + 1) if wants_old else self.last + 1
        reliable = self.qos.reliable and reader.qos.reliable
        proxy = _Proxy(reader.guid, address, reliable, first, first - 1)
        self._proxies[reader.guid] = proxy
        if reliable:
            self._ask(proxy, now)
            return
        for number, change in self._changes.items():
            if number >= first:
                self._transmit(proxy, change, ())

    def unmatch(self, reader: Guid) -> None:
        """Stop to serve a reader."""
        if self._proxies.pop(reader, None) is not None:
            self._purge()

    def on_ack_nack(self, reader: Guid, answer: AckNack, now: float) -> None:
        """Take an ACKNACK (8.4.9.2): what it acknowledges, and what it misses."""
        proxy = self._proxies.get(reader)
        if proxy is None or not proxy.reliable or answer.count == proxy.last_count:
            return
        proxy.last_count = answer.count
        proxy.heard, proxy.unanswered = True, 0
        acked = min(answer.missing.base - 1, self.last)
        if acked > proxy.acked:
            proxy.acked = acked
            proxy.period, proxy.heartbeat_at = _HEARTBEAT, now + _HEARTBEAT
            proxy.resent = {n: at for n, at in proxy.resent.items() if n > acked}
            self._purge()
        self._resend(proxy, answer.missing.members, now)
        if not answer.final and not answer.missing.members:
            # A reader asks for a heartbeat; also when it has just found this writer.
            self._ask(proxy, now, final=proxy.acked >= self.last)

    def on_nack_frag(self, reader: Guid, answer: NackFrag, now: float) -> None:
        """Take a NACK_FRAG (8.4.14.1): send the fragments that a reader misses."""
        proxy = self._proxies.get(reader)
        if proxy is None or not proxy.reliable or answer.count == proxy.last_fragment_count:
            return
        proxy.last_fragment_count = answer.count
        proxy.heard, proxy.unanswered = True, 0
        change = self._changes.get(answer.sequence_number)
        if change is None or answer.sequence_number < proxy.first:
            self._gap(proxy, (answer.sequence_number,))
            return
        if change.data.payload is None:
            return
        size = fragment_count(len(change.data.payload), self._fragment_bytes)
        self._fragments(
            proxy, change, (each for each in answer.missing.members if 0 < each <= size)
        )
        self._ask(proxy, now)

    def tick(self, now: float) -> float:
        """Send the heartbeats that are due. Return when to call again, at the latest."""
        due = float("inf")
        for proxy in self._proxies.values():
            if not self._pending(proxy):
                continue
            if now >= proxy.heartbeat_at:
                proxy.period = min(2 * proxy.period, _MAX_HEARTBEAT)
                self._ask(proxy, now)
            due = min(due, proxy.heartbeat_at)
        return due

    @property
    def acknowledged(self) -> bool:
        """Whether all reliable readers have all samples."""
        return all(p.acked >= self.last for p in self._proxies.values() if p.reliable)

    @property
    def _durable(self) -> bool:
        return self.qos.durability > Durability.VOLATILE

    def _make_room(self) -> None:
        depth = self.qos.depth
        if not depth:
            if len(self._changes) >= self.qos.max_samples:
                raise HistoryFullError(f"{self.qos.max_samples} samples are not acknowledged")
            return
        while len(self._changes) >= depth:
            del self._changes[next(iter(self._changes))]

    def _pending(self, proxy: _Proxy) -> bool:
        """Whether a reader has to be asked for an answer."""
        if not proxy.reliable:
            return False
        if proxy.unanswered >= _MOST_UNANSWERED:
            return False
        return proxy.acked < self.last or not proxy.heard

    def _purge(self) -> None:
        """Remove what all reliable readers have, unless others may want it later."""
        acked = (proxy.acked for proxy in self._proxies.values() if proxy.reliable)
        lowest = min(acked, default=self.last)
        for number in [number for number in self._changes if number <= lowest]:
            if not self._durable or self._changes[number].passing:
                del self._changes[number]

    def _heartbeat_with(self, proxy: _Proxy, change: _Change, now: float) -> tuple[Heartbeat, ...]:
        """Return the heartbeat that goes with a sample.

        It tells a reader at once what is lost. Now and then it asks for an acknowledgement, too,
        which frees the history.
        """
        if not proxy.reliable:
            return ()
        large = len(change.data.payload or b"") > self._fragment_bytes
        full = not self.qos.depth and 2 * len(self._changes) >= self.qos.max_samples
        period = _HEARTBEAT_WHEN_FULL if full else _HEARTBEAT
        final = now - proxy.asked_at < period and not large
        if not final:
            proxy.asked_at = now
        return (self._heartbeat(proxy, final),)

    def _heartbeat(self, proxy: _Proxy, final: bool) -> Heartbeat:
        self._count = (self._count + 1) & 0x7FFF_FFFF
        lowest = next(iter(self._changes), self.last + 1)
        return Heartbeat(
            reader=proxy.guid.entity,
            writer=self.guid.entity,
            first=max(proxy.first, lowest),
            last=self.last,
            count=self._count,
            final=final,
        )

    def _ask(self, proxy: _Proxy, now: float, final: bool = False) -> None:
        """Send a heartbeat by itself, which a reader has to answer unless it is `final`."""
        proxy.unanswered += not proxy.heard
        proxy.heartbeat_at = now + proxy.period
        if not final:
            proxy.asked_at = now
        self._post(proxy, (self._heartbeat(proxy, final),))

    def _transmit(self, proxy: _Proxy, change: _Change, behind: tuple[Submessage, ...]) -> None:
        """Send a sample to a reader, in fragments if it is large."""
        size = len(change.data.payload or b"")
        if size > self._fragment_bytes:
            count = fragment_count(size, self._fragment_bytes)
            self._fragments(proxy, change, range(1, count + 1))
            if behind:
                self._post(proxy, behind)
            return
        data = replace(change.data, reader=proxy.guid.entity)
        self._post(proxy, (InfoTimestamp(change.timestamp), data, *behind))

    def _fragments(self, proxy: _Proxy, change: _Change, numbers: Iterable[int]) -> None:
        data = replace(change.data, reader=proxy.guid.entity)
        stamp = InfoTimestamp(change.timestamp)
        for number in numbers:
            self._post(proxy, (stamp, fragment(data, number, self._fragment_bytes)))

    def _resend(self, proxy: _Proxy, numbers: tuple[int, ...], now: float) -> None:
        """Send samples again; those that are no longer there, or never were, by a GAP."""
        gone, sent = [], False
        for number in numbers:
            change = self._changes.get(number)
            if number > self.last:
                continue
            if change is None or number < proxy.first:
                gone.append(number)
            elif now - proxy.resent.get(number, float("-inf")) >= _SUPPRESSION:
                proxy.resent[number] = now
                self._transmit(proxy, change, ())
                sent = True
        if gone:
            self._gap(proxy, gone)
        if sent:
            self._ask(proxy, now)

    def _gap(self, proxy: _Proxy, numbers: Iterable[int]) -> None:
        """Say that samples are not to be had (8.3.8.4)."""
        start, *rest = numbers
        self._post(
            proxy,
            (
                Gap(
                    reader=proxy.guid.entity,
                    writer=self.guid.entity,
                    start=start,
                    numbers=NumberSet.of(start + 1, rest),
                ),
            ),
        )

    def _post(self, proxy: _Proxy, submessages: tuple[Submessage, ...]) -> None:
        self._send(Outgoing(proxy.address, proxy.guid.prefix, submessages))
