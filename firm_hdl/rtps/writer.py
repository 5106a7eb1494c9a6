"""A writer: its history, and the readers that it serves (8.4.7.4, 8.4.9). No I/O, no clock.

Calls bring the time, samples and what readers answered; datagrams go to `send`. So a test decides
what is lost, and when.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, field, replace

from firm_hdl.rtps.discovery import EndpointData
from firm_hdl.rtps.peers import Outgoing, Route, Send
from firm_hdl.rtps.qos import Durability, Qos
from firm_hdl.rtps.wire.guid import Guid
from firm_hdl.rtps.wire.parameters import ParameterList
from firm_hdl.rtps.wire.submessages import (
    NO_PARAMETERS,
    AckNack,
    Data,
    Gap,
    Heartbeat,
    InfoTimestamp,
    NackFrag,
    NumberSet,
    Submessage,
    fragment,
    fragment_count,
)

__all__ = ["FRAGMENT_BYTES", "Change", "HistoryFullError", "Writer"]

FRAGMENT_BYTES = 1280
"""Largest payload of one datagram, in bytes.

With headers, a timestamp, inline QoS and a heartbeat, a datagram stays below the 1,472 bytes that
an Ethernet frame holds. So IP does not cut it, and boards without IP fragments can read it.
"""

# Seconds between heartbeats while a reader has not acknowledged all: at first, and at most.
_HEARTBEAT, _MAX_HEARTBEAT = 0.05, 1.0
# Seconds between those that ask for an acknowledgement while half of the history is in use.
_HEARTBEAT_WHEN_FULL = 0.002
# Heartbeats to a reader that never answered.
_MOST_UNANSWERED = 12
# Seconds after which a reader that does not answer is sent heartbeats alone, and between these.
_SILENCE, _SILENT_HEARTBEAT = 10.0, 2.0
# Seconds before a sample is sent once more: nackSuppressionDuration of 8.4.7.1.
_SUPPRESSION = 0.01
# Seconds after which a full history no longer waits for a reader that does not get on: that has not
# acknowledged a hundredth of the history. One that was left behind once is waited for less.
_PATIENCE, _LITTLE_PATIENCE = 10.0, 1.0
# Ends of instances that are kept for readers that have not acknowledged them.
_MOST_ENDS = 256
# Seconds without an answer after which a lower number is not late: the reader began anew.
_MOST_LATE = 1.0
# Bytes of a datagram besides the payload, about.
_HEAD_BYTES = 100
# How often a reader may ask for all that it was sent. More costs the credit of its participant.
_MOST_REPAIRS = 2


class HistoryFullError(Exception):
    """A writer that keeps all samples has no room before readers acknowledge some."""


@dataclass(frozen=True, slots=True)
class Change:
    """A sample in the history (CacheChange, 8.2.3)."""

    data: Data
    timestamp: int | None  # Nanoseconds since 1970.
    to: Collection[Guid] | None = None  # The readers that it is for; by default all.
    # Whether it is kept until readers of today have it, even if others may come: the end of an
    # instance.
    passing: bool = False

    @property
    def size(self) -> int:
        """Bytes that it takes to send it, about."""
        return len(self.data.payload or b"") + _HEAD_BYTES

    def is_for(self, reader: Guid) -> bool:
        """Whether a reader gets it."""
        return self.to is None or reader in self.to


@dataclass(slots=True)
class _Proxy:
    """A matched reader (ReaderProxy, 8.4.7.5)."""

    guid: Guid
    route: Route
    reliable: bool
    # Lowest sequence number that is relevant to it; all up to `acked` were acknowledged.
    first: int
    acked: int
    # When it was last seen to get on, and `acked` at that time.
    progress_at: float
    progress: int
    # Whether the history waits for it, and for how long.
    waited_for: bool = True
    patience: float = _PATIENCE
    # Up to where it has said that it has all, and when it last answered.
    stated: int = 0
    answered_at: float = float("-inf")
    # Bytes of samples that it may ask for without the credit of its participant.
    repairs: int = 0
    heard: bool = False
    unanswered: int = 0
    last_count: int | None = None
    last_fragment_count: int | None = None
    period: float = _HEARTBEAT
    heartbeat_at: float = 0.0
    asked_at: float = float("-inf")
    resent: dict[int, float] = field(default_factory=dict)
    # Samples for others that it was told of by a GAP, which may be lost.
    skipped: list[int] = field(default_factory=list)

    def lacks(self, number: int, change: Change) -> bool:
        """Whether it has to acknowledge a sample yet."""
        return self.waits and self.acked < number and change.is_for(self.guid)

    @property
    def waits(self) -> bool:
        """Whether samples are kept for it."""
        return self.reliable and self.waited_for

    def is_silent(self, last: int, now: float) -> bool:
        """Whether it has not answered for long, though it lacks samples up to `last`."""
        heard_at = max(self.answered_at, self.progress_at)
        return self.reliable and self.acked < last and now - heard_at >= _SILENCE


class Writer:
    """A writer, best-effort or reliable.

    * `fragment_bytes`: samples with more bytes are sent in fragments of this size.
    * `counters`: counts samples that were ``overwritten`` before all readers had them, readers that
      were ``left_behind``, and samples or fragments that were asked for and ``withheld``.
    """

    def __init__(
        self,
        guid: Guid,
        qos: Qos,
        send: Send,
        fragment_bytes: int = FRAGMENT_BYTES,
        counters: Counter[str] | None = None,
    ):
        self.guid = guid
        self.qos = qos
        self._send = send
        self._fragment_bytes = fragment_bytes
        self._counters = Counter[str]() if counters is None else counters
        self._changes: dict[int, Change] = {}
        # Bytes that it takes to send all of them.
        self._size = 0
        self._proxies: dict[Guid, _Proxy] = {}
        self._count = 0
        self.last = 0  # Sequence number of the last sample.
        # How many samples gave way to new ones before all reliable readers had acknowledged them.
        self.overwritten = 0

    @property
    def matched(self) -> tuple[Guid, ...]:
        """The readers that it serves."""
        return tuple(self._proxies)

    def history(self) -> Iterator[Change]:
        """Yield the samples that it keeps, the oldest first."""
        yield from self._changes.values()

    def write(
        self,
        payload: bytes | None,
        now: float,
        timestamp: int | None = None,
        inline: ParameterList = NO_PARAMETERS,
        key: bool = False,
        to: Collection[Guid] | None = None,
    ) -> int:
        """Add a sample to the history, send it to its readers, and return its sequence number.

        * `payload`: the sample with its encapsulation header; with `key`, the key of an instance
          that ends.
        * `now`: the time, in seconds of any clock that never goes back.
        * `timestamp`: nanoseconds since 1970, for the readers.
        * `to`: the readers that it is for; by default all.

        Raises `HistoryFullError`: the depth is 0, and readers have acknowledged too little.
        """
        self._make_room(now)
        self.last += 1
        data = Data(
            reader=0,
            writer=self.guid.entity,
            sequence_number=self.last,
            payload=payload,
            key=key,
            inline=inline,
        )
        change = Change(data, timestamp, to, passing=key)
        if key:
            ends = [number for number, each in self._changes.items() if each.passing]
            for number in ends[:-_MOST_ENDS]:
                self._overwrite(number)
        if self._durable or any(p.lacks(self.last, change) for p in self._proxies.values()):
            self._changes[self.last] = change
            self._size += change.size
        for proxy in self._proxies.values():
            if not change.is_for(proxy.guid):
                self._skip(proxy)
                continue
            if proxy.acked >= self.last - 1:
                proxy.progress_at = now
                proxy.period, proxy.heartbeat_at = _HEARTBEAT, now + _HEARTBEAT
            if proxy.route.ways()[1]:
                repairs = proxy.repairs + _MOST_REPAIRS * change.size
                proxy.repairs = min(repairs, _MOST_REPAIRS * self._size)
            if proxy.is_silent(self.last - 1, now):
                # It asks for what it missed once it answers again.
                self._counters["withheld"] += 1
                continue
            self._transmit(proxy, change, self._heartbeat_with(proxy, change, now))
        return self.last

    def forget(self, number: int) -> None:
        """Remove a sample from the history. Readers that ask for it get a GAP."""
        change = self._changes.pop(number, None)
        self._size -= 0 if change is None else change.size

    def match(self, reader: EndpointData, route: Route, now: float) -> None:
        """Begin to serve a reader, or note the new way to it.

        A reader that is not volatile gets the history. Any other begins with the next sample; old
        ones are not sent again, whoever asks for them.
        """
        known = self._proxies.get(reader.guid)
        if known is not None:
            known.route = route
            return
        wants_old = self._durable and reader.qos.durability > Durability.VOLATILE
        first = min(self._changes, default=self.last + 1) if wants_old else self.last + 1
        reliable = self.qos.reliable and reader.qos.reliable
        proxy = _Proxy(reader.guid, route, reliable, first, first - 1, now, first - 1)
        self._proxies[reader.guid] = proxy
        old = [each for number, each in self._changes.items() if number >= first]
        if old and route.ways()[1] and route.peer.may_have_history(now):
            proxy.repairs = _MOST_REPAIRS * sum(each.size for each in old)
        if reliable:
            self._ask(proxy, now)
            return
        for change in old:
            if change.is_for(reader.guid):
                self._repair(proxy, change)

    def unmatch(self, reader: Guid) -> None:
        """Stop to serve a reader."""
        if self._proxies.pop(reader, None) is not None:
            self._purge()

    def on_ack_nack(self, reader: Guid, answer: AckNack, now: float) -> bool:
        """Take an ACKNACK (8.4.9.2): what it acknowledges, and what it misses.

        Returns: whether the reader began anew: it misses what it once had. Of an answer that is
        late, it does so, too; but then, others came in the last second.
        """
        proxy = self._proxies.get(reader)
        if proxy is None or not proxy.reliable or answer.count == proxy.last_count:
            return False
        acked = min(answer.missing.base - 1, self.last)
        began_anew = acked < proxy.stated and now - proxy.answered_at >= _MOST_LATE
        proxy.last_count, proxy.answered_at = answer.count, now
        if acked > proxy.stated:
            proxy.stated = acked
            proxy.skipped = [number for number in proxy.skipped if number > acked]
        proxy.heard, proxy.unanswered = True, 0
        if acked > proxy.acked:
            proxy.acked = acked
            self._note_progress(proxy, now)
            proxy.period, proxy.heartbeat_at = _HEARTBEAT, now + _HEARTBEAT
            proxy.resent = {n: at for n, at in proxy.resent.items() if n > acked}
            self._purge()
        self._resend(proxy, answer.missing.members, now)
        if not answer.final and not answer.missing.members:
            # A reader asks for a heartbeat; also when it has just found this writer.
            self._ask(proxy, now, final=proxy.acked >= self.last)
        return began_anew

    def on_nack_frag(self, reader: Guid, answer: NackFrag, now: float) -> None:
        """Take a NACK_FRAG (8.4.14.1): send the fragments that a reader misses."""
        proxy = self._proxies.get(reader)
        if proxy is None or not proxy.reliable or answer.count == proxy.last_fragment_count:
            return
        proxy.last_fragment_count, proxy.answered_at = answer.count, now
        proxy.heard, proxy.unanswered = True, 0
        number = answer.sequence_number
        if number > self.last:
            return
        change = self._changes.get(number)
        if change is None or not self._is_for(proxy, number, change):
            self._gap(proxy, (number,))
            return
        if change.data.payload is None:
            return
        count = self._count_of(len(change.data.payload))
        self._repair(proxy, change, [each for each in answer.missing.members if 0 < each <= count])
        self._ask(proxy, now)

    def tick(self, now: float) -> float:
        """Send the heartbeats that are due. Return when to call again, at the latest."""
        due = float("inf")
        for proxy in self._proxies.values():
            if not self._pending(proxy):
                continue
            if now >= proxy.heartbeat_at:
                most = _SILENT_HEARTBEAT if proxy.is_silent(self.last, now) else _MAX_HEARTBEAT
                proxy.period = min(2 * proxy.period, most)
                self._ask(proxy, now, is_answer=not proxy.heard)
            due = min(due, proxy.heartbeat_at)
        return due

    def ask_all(self, now: float) -> None:
        """Ask the readers that have not acknowledged all samples to do so at once."""
        for proxy in self._proxies.values():
            if self._pending(proxy) and proxy.acked < self.last:
                self._ask(proxy, now, is_answer=False)

    @property
    def acknowledged(self) -> bool:
        """Whether all reliable readers have all samples."""
        return all(p.acked >= self.last for p in self._proxies.values() if p.waits)

    @property
    def unacknowledged(self) -> int:
        """How many samples of the history not all of their reliable readers have."""
        return sum(
            any(proxy.lacks(number, change) for proxy in self._proxies.values())
            for number, change in self._changes.items()
        )

    @property
    def _durable(self) -> bool:
        return self.qos.durability > Durability.VOLATILE

    def _make_room(self, now: float) -> None:
        if self.qos.depth:
            while len(self._changes) >= self.qos.depth:
                self._overwrite(next(iter(self._changes)))
            return
        if len(self._changes) >= self.qos.max_samples:
            self._leave_behind(now)
        if len(self._changes) >= self.qos.max_samples:
            raise HistoryFullError(f"{self.qos.max_samples} samples are not acknowledged")

    def _overwrite(self, number: int) -> None:
        change = self._changes[number]
        self.forget(number)
        if any(proxy.lacks(number, change) for proxy in self._proxies.values()):
            self.overwritten += 1
            self._counters["overwritten"] += 1

    def _note_progress(self, proxy: _Proxy, now: float) -> None:
        """Note that a reader acknowledged something."""
        has_all = proxy.acked >= self.last
        if has_all or proxy.acked >= proxy.progress + self.qos.max_samples // 100:
            proxy.progress, proxy.progress_at = proxy.acked, now
        proxy.waited_for |= has_all

    def _leave_behind(self, now: float) -> None:
        """Wait no longer for readers that do not get on, until they have all samples.

        So one that hangs does not stop the writer for all others.
        """
        for proxy in self._proxies.values():
            is_behind = proxy.waits and proxy.acked < self.last
            if is_behind and now - proxy.progress_at >= proxy.patience:
                proxy.waited_for, proxy.patience = False, _LITTLE_PATIENCE
                self._counters["left_behind"] += 1
        self._purge()

    def _pending(self, proxy: _Proxy) -> bool:
        """Whether a reader has to be asked for an answer."""
        if not proxy.reliable:
            return False
        if proxy.unanswered >= _MOST_UNANSWERED:
            return False
        return proxy.acked < self.last or not proxy.heard

    def _purge(self) -> None:
        """Remove what all reliable readers have, unless others may want it later."""
        acked = (proxy.acked for proxy in self._proxies.values() if proxy.waits)
        lowest = min(acked, default=self.last)
        gone = []
        for number, change in self._changes.items():
            if self._durable and not change.passing:
                continue
            # Numbers ascend. So the reader that has acknowledged least lacks all that is for
            # everybody from here on; only samples for some readers could be done with, and they
            # come in turn.
            if number > lowest and change.to is None:
                break
            if not any(proxy.lacks(number, change) for proxy in self._proxies.values()):
                gone.append(number)
        for number in gone:
            self.forget(number)

    def _heartbeat_with(self, proxy: _Proxy, change: Change, now: float) -> tuple[Heartbeat, ...]:
        """Return the heartbeat that goes with a sample.

        It tells a reader at once what is lost. Now and then it asks for an acknowledgement, too,
        which frees the history.
        """
        if not proxy.reliable:
            return ()
        large = len(change.data.payload or b"") > self._fragment_bytes
        full = 2 * len(self._changes) >= (self.qos.depth or self.qos.max_samples)
        period = _HEARTBEAT_WHEN_FULL if full else _HEARTBEAT
        final = now - proxy.asked_at < period and not large
        if not final:
            proxy.asked_at = now
        return (self._heartbeat(proxy, final),)

    def _heartbeat(self, proxy: _Proxy, final: bool) -> Heartbeat:
        self._count = (self._count + 1) & 0x7FFF_FFFF
        # A sample for others may have left the history. If the reader has lost its GAP, it has to
        # ask for it, and would count it as lost if the first number were above.
        lowest = min((next(iter(self._changes), self.last + 1), *proxy.skipped[:1]))
        return Heartbeat(
            reader=proxy.guid.entity,
            writer=self.guid.entity,
            first=max(proxy.first, lowest),
            last=self.last,
            count=self._count,
            final=final,
        )

    def _ask(self, proxy: _Proxy, now: float, final: bool = False, is_answer: bool = True) -> None:
        """Send a heartbeat by itself, which a reader has to answer unless it is `final`."""
        proxy.unanswered += not proxy.heard
        proxy.heartbeat_at = now + proxy.period
        if not final:
            proxy.asked_at = now
        self._post(proxy, (self._heartbeat(proxy, final),), is_answer)

    def _transmit(self, proxy: _Proxy, change: Change, behind: tuple[Submessage, ...]) -> None:
        """Send a sample to a reader for the first time, in fragments if it is large."""
        size = len(change.data.payload or b"")
        if size > self._fragment_bytes:
            for each in self._fragments(proxy, change, range(1, self._count_of(size) + 1)):
                self._post(proxy, each, is_answer=False)
            if behind:
                self._post(proxy, behind, is_answer=False)
            return
        self._post(proxy, (*self._whole(proxy, change), *behind), is_answer=False)

    def _repair(
        self, proxy: _Proxy, change: Change, numbers: Collection[int] | None = None
    ) -> bool:
        """Send a sample, or fragments of it, that a reader asked for.

        Returns: whether at least a part of it could be sent.
        """
        size = len(change.data.payload or b"")
        if size > self._fragment_bytes or numbers is not None:
            every = range(1, self._count_of(size) + 1) if numbers is None else numbers
            parts = self._fragments(proxy, change, every)
        else:
            parts = iter((self._whole(proxy, change),))
        sent = False
        part_bytes = min(size, self._fragment_bytes) + _HEAD_BYTES
        for each in parts:
            is_free = proxy.repairs > 0
            if not is_free and proxy.route.peer.credit <= 0:
                self._counters["withheld"] += 1
                break
            proxy.repairs -= part_bytes if is_free else 0
            self._post(proxy, each, is_answer=not is_free)
            sent = True
        return sent

    def _whole(self, proxy: _Proxy, change: Change) -> tuple[Submessage, ...]:
        data = replace(change.data, reader=proxy.guid.entity)
        return InfoTimestamp(change.timestamp), data

    def _fragments(
        self, proxy: _Proxy, change: Change, numbers: Iterable[int]
    ) -> Iterator[tuple[Submessage, ...]]:
        data = replace(change.data, reader=proxy.guid.entity)
        stamp = InfoTimestamp(change.timestamp)
        for number in numbers:
            yield stamp, fragment(data, number, self._fragment_bytes)

    def _count_of(self, size: int) -> int:
        return fragment_count(size, self._fragment_bytes)

    def _is_for(self, proxy: _Proxy, number: int, change: Change) -> bool:
        return number >= proxy.first and change.is_for(proxy.guid)

    def _skip(self, proxy: _Proxy) -> None:
        """Say that the newest sample is not for a reader."""
        if proxy.reliable:
            if proxy.acked == self.last - 1:
                proxy.acked = self.last
            proxy.skipped = [*proxy.skipped[1 - NumberSet.MAX_SIZE :], self.last]
            self._gap(proxy, (self.last,), is_answer=False)

    def _resend(self, proxy: _Proxy, numbers: tuple[int, ...], now: float) -> None:
        """Send samples again; those that are no longer there, or never were, by a GAP."""
        gone, sent = [], False
        for number in numbers:
            change = self._changes.get(number)
            if number > self.last:
                continue
            if change is None or not self._is_for(proxy, number, change):
                gone.append(number)
            elif now - proxy.resent.get(number, float("-inf")) >= _SUPPRESSION:
                if not self._repair(proxy, change):
                    break
                proxy.resent[number] = now
                sent = True
        if len(proxy.resent) > 2 * len(self._changes) + NumberSet.MAX_SIZE:
            proxy.resent = {n: at for n, at in proxy.resent.items() if n in self._changes}
        if gone:
            self._gap(proxy, gone)
        if sent:
            self._ask(proxy, now)

    def _gap(self, proxy: _Proxy, numbers: Iterable[int], is_answer: bool = True) -> None:
        """Say that samples are not to be had (8.3.8.4)."""
        start, *rest = numbers
        gap = Gap(
            reader=proxy.guid.entity,
            writer=self.guid.entity,
            start=start,
            numbers=NumberSet.of(start + 1, rest),
        )
        self._post(proxy, (gap,), is_answer)

    def _post(
        self, proxy: _Proxy, submessages: tuple[Submessage, ...], is_answer: bool = True
    ) -> None:
        self._send(Outgoing(proxy.route, proxy.guid.prefix, submessages, is_answer))
