"""A reader: the writers that it listens to, and what it misses of them (8.4.10.3, 8.4.12).

As in :mod:`firm_hdl.rtps.writer`, there is neither I/O nor a clock.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from firm_hdl.rtps.backlog import MOST_SAMPLE_BYTES, Backlog
from firm_hdl.rtps.budget import Budget
from firm_hdl.rtps.discovery import EndpointData
from firm_hdl.rtps.peers import Outgoing, Route, Send
from firm_hdl.rtps.qos import Qos
from firm_hdl.rtps.wire.guid import Guid
from firm_hdl.rtps.wire.submessages import (
    AckNack,
    Data,
    DataFrag,
    Gap,
    Heartbeat,
    HeartbeatFrag,
    NackFrag,
    NumberSet,
    Submessage,
)

__all__ = ["Deliver", "Reader"]

# How far beyond the next sample a reader keeps samples and gaps.
_WINDOW = 4096
# Seconds between requests for what is missing, and how often without progress before the writer's
# next heartbeat is awaited. Fast DDS sends heartbeats every 3 s, which is long for a lost request.
_REPEAT, _MOST_REPEATS = 0.1, 20
# Seconds to wait for fragments or samples that may be on their way.
_PATIENCE = 0.02
# Seconds between answers to heartbeats of a writer (heartbeatResponseDelay, 8.4.7.1).
_RESPONSE = 0.001
# Seconds between ACKNACKs to a writer that has said nothing yet, at first; and their number.
_GREETING, _MOST_GREETINGS = 0.25, 6
# How GUID prefixes of Fast DDS and RTI begin. They answer a first ACKNACK at once if its base is
# 0 alone. To base 1, which 8.3.5.5 asks for, Fast DDS answers with its next heartbeat, after 3 s.
_GREETED_WITH_0 = (b"\x01\x0f", b"\x01\x01")
# NACK_FRAGs in one answer.
_MOST_PARTIAL = 4
# Seconds without anything new after which what waits is forgotten; a writer can send it again.
_MOST_WAITING = 30.0
# Seconds without anything new after which a lower number is not late: the writer began anew.
_MOST_LATE = 1.0

Deliver: TypeAlias = Callable[[Guid, Data, int | None], None]
"""Takes a sample: the writer, the sample, and the time that the writer gave, in nanoseconds."""


@dataclass(slots=True)
class _Proxy:
    """A matched writer (WriterProxy, 8.4.10.4)."""

    guid: Guid
    route: Route
    reliable: bool
    backlog: Backlog
    # Lowest sequence number that was neither delivered nor given up, and the highest known.
    next: int = 1
    last: int = 0
    # Whether a heartbeat has said where the sequence begins.
    synced: bool = False
    # Bit n: sample ``next + n`` will not come.
    gaps: int = 0
    heartbeat_count: int | None = None
    fragment_count: int | None = None
    # Whether a heartbeat waits for its answer, and when the last one was answered.
    owes_answer: bool = False
    answered_at: float = float("-inf")
    ask_at: float = float("inf")
    repeats: int = 0
    fragment_at: float = float("-inf")
    # When something came that was not known yet.
    news_at: float = float("-inf")

    def is_gap(self, number: int) -> bool:
        """Whether a sample from `next` on will not come."""
        return bool(self.gaps >> (number - self.next) & 1)


class Reader:
    """A reader, best-effort or reliable. Samples of a reliable writer come in order.

    * `budget`: memory for fragments, and for samples that wait for earlier ones.
    * `most_bytes`: the largest sample that it takes in fragments.
    * `counters`: counts samples and fragments that were ``refused``: too large, too far ahead,
      without memory; and writers that ``restarted``.
    """

    def __init__(
        self,
        guid: Guid,
        qos: Qos,
        send: Send,
        deliver: Deliver,
        budget: Budget,
        most_bytes: int = MOST_SAMPLE_BYTES,
        counters: Counter[str] | None = None,
    ):
        self.guid = guid
        self.qos = qos
        self._send = send
        self._deliver = deliver
        self._budget = budget
        self._most_bytes = most_bytes
        self._counters = Counter[str]() if counters is None else counters
        self._proxies: dict[Guid, _Proxy] = {}
        self._count = 0
        self.lost = 0  # How many samples did not come, and will not.

    @property
    def matched(self) -> tuple[Guid, ...]:
        """The writers that it listens to."""
        return tuple(self._proxies)

    def match(self, writer: EndpointData, route: Route, now: float) -> None:
        """Begin to listen to a writer, or note the new way to it."""
        known = self._proxies.get(writer.guid)
        if known is not None:
            known.route = route
            return
        reliable = self.qos.reliable and writer.qos.reliable
        backlog = Backlog(
            writer.guid.prefix, self._budget, reliable, self._most_bytes, self._counters
        )
        proxy = self._proxies[writer.guid] = _Proxy(writer.guid, route, reliable, backlog)
        if reliable:
            proxy.ask_at = now

    def unmatch(self, writer: Guid) -> None:
        """Stop to listen to a writer. Samples that wait for earlier ones are lost."""
        proxy = self._proxies.pop(writer, None)
        if proxy is not None:
            proxy.backlog.clear()

    def on_data(self, writer: Guid, data: Data, timestamp: int | None, now: float) -> None:
        """Take a sample (8.4.12.1, 8.4.12.2)."""
        proxy = self._proxies.get(writer)
        number = data.sequence_number
        if proxy is None or number < proxy.next:
            return
        if not proxy.reliable:
            self.lost += number - proxy.next if proxy.synced else 0
            proxy.synced, proxy.news_at = True, now
            proxy.next = number + 1
            proxy.backlog.take_below(proxy.next)
            self._deliver(writer, data, timestamp)
            return
        if number in proxy.backlog:
            return
        # Before the first heartbeat, nobody knows whether earlier ones are to come: samples wait.
        is_next = number == proxy.next and proxy.synced
        if number >= proxy.next + _WINDOW:
            self._counters["refused"] += 1
            return
        if not is_next and not proxy.backlog.keep(data, timestamp):
            return
        proxy.news_at = now
        if is_next:
            self._go_on(proxy, number + 1)
            self._deliver(writer, data, timestamp)
        self._progress(proxy)
        if proxy.synced and number > proxy.last:
            # Writers send in order (8.4.2.2.1): what is below and did not come may be lost.
            proxy.last = number
            if proxy.next <= number:
                proxy.ask_at = min(proxy.ask_at, now + _PATIENCE)

    def on_data_frag(self, writer: Guid, data: DataFrag, timestamp: int | None, now: float) -> None:
        """Take fragments (8.4.14.1); the last missing ones complete a sample."""
        proxy = self._proxies.get(writer)
        number = data.sequence_number
        if proxy is None or number < proxy.next or number in proxy.backlog:
            return
        if proxy.reliable and number >= proxy.next + _WINDOW:
            self._counters["refused"] += 1
            return
        proxy.fragment_at = proxy.news_at = now
        whole = proxy.backlog.add(data)
        if whole is not None:
            self.on_data(writer, whole, timestamp, now)

    def on_heartbeat(self, writer: Guid, heartbeat: Heartbeat, now: float) -> bool:
        """Take a HEARTBEAT (8.4.12.2): what is lost for good, and what can be asked for.

        Returns: whether the writer began anew: its last number went back. Of a heartbeat that is
        late, it did so, too; but then, others came in the last second.
        """
        proxy = self._proxies.get(writer)
        if proxy is None:
            return False
        went_back = heartbeat.last < max(proxy.last, proxy.next - 1)
        restarted = went_back and now - proxy.news_at >= _MOST_LATE
        if restarted:
            self._restart(proxy)
        if not proxy.reliable or heartbeat.count == proxy.heartbeat_count:
            return restarted
        if went_back and not restarted:
            return False
        proxy.heartbeat_count, proxy.news_at = heartbeat.count, now
        if heartbeat.first > proxy.next:
            self._give_up(proxy, heartbeat.first)
        # What was asked before is answered; what is missing now is asked for below.
        proxy.synced, proxy.ask_at = True, float("inf")
        proxy.last = max(proxy.last, heartbeat.last)
        proxy.repeats = 0
        self._progress(proxy)
        if proxy.next <= proxy.last or not heartbeat.final:
            if now - proxy.answered_at >= _RESPONSE:
                self._answer(proxy, now)
            else:
                proxy.owes_answer, proxy.ask_at = True, proxy.answered_at + _RESPONSE
        return restarted

    def on_heartbeat_frag(self, writer: Guid, heartbeat: HeartbeatFrag, now: float) -> None:
        """Take a HEARTBEAT_FRAG: ask for the fragments that the writer has already sent."""
        proxy = self._proxies.get(writer)
        if proxy is None or not proxy.reliable or heartbeat.count == proxy.fragment_count:
            return
        proxy.fragment_count = heartbeat.count
        number = heartbeat.sequence_number
        if number >= proxy.next and proxy.backlog.has_part(number):
            missing = proxy.backlog.missing(number, heartbeat.last)
            if missing:
                self._post(proxy, (self._nack_frag(proxy, number, missing),))

    def on_gap(self, writer: Guid, gap: Gap, now: float) -> None:
        """Take a GAP (8.4.12.2): sequence numbers that will not come."""
        proxy = self._proxies.get(writer)
        if proxy is None or not proxy.reliable:
            return
        if gap.start <= proxy.next < gap.numbers.base:
            self._go_on(proxy, gap.numbers.base)
        first, limit = max(gap.start, proxy.next), proxy.next + _WINDOW
        end = min(gap.numbers.base, limit)
        if first < end:
            proxy.gaps |= (1 << (end - first)) - 1 << (first - proxy.next)
        for number in gap.numbers.members:
            if proxy.next <= number < limit:
                proxy.gaps |= 1 << (number - proxy.next)
        self._progress(proxy)

    def tick(self, now: float) -> float:
        """Send the ACKNACKs that are due. Return when to call again, at the latest."""
        due = float("inf")
        for proxy in self._proxies.values():
            if proxy.backlog and now - proxy.news_at >= _MOST_WAITING:
                proxy.backlog.clear()
                self._counters["refused"] += 1
            if now >= proxy.ask_at:
                proxy.ask_at = float("inf")
                if not proxy.synced:
                    self._greet(proxy, now)
                elif proxy.owes_answer or (
                    proxy.next <= proxy.last and proxy.repeats < _MOST_REPEATS
                ):
                    self._answer(proxy, now)
            due = min(due, proxy.ask_at)
        return due

    def _greet(self, proxy: _Proxy, now: float) -> None:
        """Ask a new writer for a heartbeat (8.4.2.3.4), some times and ever more seldom."""
        base = 0 if proxy.guid.prefix[:2] in _GREETED_WITH_0 else proxy.next
        self._post(proxy, (self._ack_nack(proxy, NumberSet(base), final=False),))
        proxy.repeats += 1
        if proxy.repeats < _MOST_GREETINGS:
            proxy.ask_at = now + _GREETING * 2 ** (proxy.repeats - 1)

    def _restart(self, proxy: _Proxy) -> None:
        """Begin anew with a writer that began anew."""
        proxy.backlog.clear()
        proxy.next, proxy.last, proxy.gaps, proxy.repeats = 1, 0, 0, 0
        proxy.synced, proxy.heartbeat_count, proxy.fragment_count = False, None, None
        self._counters["restarted"] += 1

    def _give_up(self, proxy: _Proxy, first: int) -> None:
        """Note that a writer no longer has what is below `first`. What came of it is delivered."""
        before, gaps = proxy.next, proxy.gaps
        delivered = self._go_on(proxy, first)
        if proxy.synced:
            gone = (gaps & (1 << min(first - before, _WINDOW)) - 1).bit_count()
            self.lost += first - before - delivered - gone

    def _go_on(self, proxy: _Proxy, number: int) -> int:
        """Deliver the samples that wait below `number`, go on there, and return how many.

        `number` is above the one that is next.
        """
        ready = proxy.backlog.take_below(number)
        # Bits of samples that came although they were said not to come count no more.
        proxy.gaps >>= min(number - proxy.next, _WINDOW)
        proxy.next, proxy.repeats = number, 0
        for each in ready:
            self._deliver(proxy.guid, each.data, each.timestamp)
        return len(ready)

    def _progress(self, proxy: _Proxy) -> None:
        """Deliver what no longer waits for an earlier sample."""
        if not proxy.synced:
            return
        number = proxy.next
        while number in proxy.backlog or proxy.is_gap(number):
            number += 1
        if number > proxy.next:
            self._go_on(proxy, number)

    def _answer(self, proxy: _Proxy, now: float) -> None:
        """Acknowledge what came, and ask for what is missing (8.4.12.2, 8.4.14.1)."""
        # The base acknowledges all below `next`, the bits name what is missing of the 256 behind.
        window = range(proxy.next, min(proxy.last, proxy.next + NumberSet.MAX_SIZE - 1) + 1)
        absent, partial = proxy.backlog.absent(window)
        if proxy.gaps:
            absent = [number for number in absent if not proxy.is_gap(number)]
            partial = [number for number in partial if not proxy.is_gap(number)]
        submessages: list[Submessage] = [
            self._ack_nack(proxy, NumberSet.of(proxy.next, absent), final=True)
        ]
        proxy.owes_answer, proxy.answered_at = False, now
        if absent or partial:
            proxy.repeats += 1
            proxy.ask_at = now + _REPEAT
        if partial and now - proxy.fragment_at < _PATIENCE:
            proxy.ask_at = now + _PATIENCE
        else:
            for number in partial[:_MOST_PARTIAL]:
                missing = proxy.backlog.missing(number)
                submessages.append(self._nack_frag(proxy, number, missing))
        self._post(proxy, tuple(submessages))

    def _ack_nack(self, proxy: _Proxy, missing: NumberSet, final: bool) -> AckNack:
        return AckNack(
            reader=self.guid.entity,
            writer=proxy.guid.entity,
            missing=missing,
            count=self._next_count(),
            final=final,
        )

    def _nack_frag(self, proxy: _Proxy, number: int, missing: list[int]) -> NackFrag:
        return NackFrag(
            reader=self.guid.entity,
            writer=proxy.guid.entity,
            sequence_number=number,
            missing=NumberSet.of(missing[0], missing),
            count=self._next_count(),
        )

    def _next_count(self) -> int:
        self._count = (self._count + 1) & 0x7FFF_FFFF
        return self._count

    def _post(self, proxy: _Proxy, submessages: tuple[Submessage, ...]) -> None:
        self._send(Outgoing(proxy.route, proxy.guid.prefix, submessages))
