"""A reader: the writers that it listens to, and what it misses of them (8.4.10.3, 8.4.12).

As in :mod:`firm_hdl.rtps.writer`, there is neither I/O nor a clock.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeAlias

from firm_hdl.rtps.discovery import EndpointData
from firm_hdl.rtps.fragments import Budget, Reassembly
from firm_hdl.rtps.outgoing import Outgoing, Send
from firm_hdl.rtps.qos import Qos
from firm_hdl.rtps.wire.guid import Guid
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.numbers import NumberSet
from firm_hdl.rtps.wire.reliability import AckNack, Gap, Heartbeat, HeartbeatFrag, NackFrag
from firm_hdl.rtps.wire.samples import Data, DataFrag
from firm_hdl.rtps.wire.submessages import Submessage

__all__ = ["Deliver", "Reader"]

# How far beyond the next sample a reader keeps samples and gaps.
_WINDOW = 4096
# Seconds between requests for what is missing, and how often without progress before the writer's
# next heartbeat is awaited. Fast DDS sends heartbeats every 3 s, which is long for a lost request.
_REPEAT, _MOST_REPEATS = 0.1, 20
# Seconds to wait for fragments or samples that may be on their way.
_PATIENCE = 0.02
# Seconds between ACKNACKs to a writer that has said nothing yet, at first; and their number.
_GREETING, _MOST_GREETINGS = 0.25, 6
# How GUID prefixes of Fast DDS and RTI begin. They answer a first ACKNACK at once if its base is
# 0 alone. To base 1, which 8.3.5.5 asks for, Fast DDS answers with its next heartbeat, after 3 s.
_GREETED_WITH_0 = (b"\x01\x0f", b"\x01\x01")
# NACK_FRAGs in one answer.
_MOST_PARTIAL = 4

Deliver: TypeAlias = Callable[[Guid, Data, int | None], None]
"""Takes a sample: the writer, the sample, and the time that the writer gave, in nanoseconds."""


@dataclass(slots=True)
class _Proxy:
    """A matched writer (WriterProxy, 8.4.10.4)."""

    guid: Guid
    address: Address
    reliable: bool
    fragments: Reassembly
    # Lowest sequence number that was neither delivered nor given up, and the highest known.
    next: int = 1
    last: int = 0
    # Whether a heartbeat has said where the sequence begins.
    synced: bool = False
    early: dict[int, tuple[Data, int | None]] = field(default_factory=dict)
    gaps: set[int] = field(default_factory=set)
    heartbeat_count: int | None = None
    fragment_count: int | None = None
    ask_at: float = float("inf")
    repeats: int = 0
    fragment_at: float = float("-inf")


class Reader:
    """A reader, best-effort or reliable. Samples of a reliable writer come in order.

    Parameters
    ----------
    guid : Guid
        Its name.
    qos : Qos
        Its policies.
    send : Send
        Takes its datagrams.
    deliver : Deliver
        Takes samples.
    budget : Budget
        Memory for fragments, and for samples that wait for earlier ones.
    """

    def __init__(self, guid: Guid, qos: Qos, send: Send, deliver: Deliver, budget: Budget):
        self.guid = guid
        self.qos = qos
        self._send = send
        self._deliver = deliver
        self._budget = budget
        self._proxies: dict[Guid, _Proxy] = {}
        self._count = 0
        self.lost = 0

    @property
    def matched(self) -> tuple[Guid, ...]:
        """The writers that it listens to."""
        return tuple(self._proxies)

    def match(self, writer: EndpointData, address: Address, now: float) -> None:
        """Begin to listen to a writer, or note its new address."""
        known = self._proxies.get(writer.guid)
        if known is not None:
            known.address = address
            return
        reliable = self.qos.reliable and writer.qos.reliable
        proxy = _Proxy(writer.guid, address, reliable, Reassembly(self._budget))
        self._proxies[writer.guid] = proxy
        if reliable:
            proxy.ask_at = now

    def unmatch(self, writer: Guid) -> None:
        """Stop to listen to a writer. Samples that wait for earlier ones are lost."""
        proxy = self._proxies.pop(writer, None)
        if proxy is not None:
            proxy.fragments.drop_all()
            for data, _ in proxy.early.values():
                self._budget.give_back(len(data.payload or b""))

    def on_data(self, writer: Guid, data: Data, timestamp: int | None, now: float) -> None:
        """Take a sample (8.4.12.1, 8.4.12.2)."""
        proxy = self._proxies.get(writer)
        number = data.sequence_number
        if proxy is None or number < proxy.next:
            return
        if not proxy.reliable:
            self.lost += number - proxy.next if proxy.synced else 0
            proxy.synced = True
            proxy.next = number + 1
            proxy.fragments.drop_below(proxy.next)
            self._deliver(writer, data, timestamp)
            return
        if number >= proxy.next + _WINDOW or number in proxy.early:
            return
        proxy.fragments.drop(number)
        if number == proxy.next and proxy.synced:
            proxy.next += 1
            proxy.repeats = 0
            self._deliver(writer, data, timestamp)
        elif self._budget.take(len(data.payload or b"")):
            proxy.early[number] = (data, timestamp)
        self._progress(proxy, now)
        if proxy.synced and number > proxy.last:
            # Writers send in order (8.4.2.2.1): what is below and did not come may be lost.
            proxy.last = number
            if proxy.next <= number:
                proxy.ask_at = min(proxy.ask_at, now + _PATIENCE)

    def on_data_frag(self, writer: Guid, data: DataFrag, timestamp: int | None, now: float) -> None:
        """Take fragments (8.4.14.1); the last missing ones complete a sample."""
        proxy = self._proxies.get(writer)
        number = data.sequence_number
        if proxy is None or number < proxy.next or number in proxy.early:
            return
        if proxy.reliable and number >= proxy.next + _WINDOW:
            return
        proxy.fragment_at = now
        whole = proxy.fragments.add(data)
        if whole is not None:
            self.on_data(writer, whole, timestamp, now)

    def on_heartbeat(self, writer: Guid, heartbeat: Heartbeat, now: float) -> None:
        """Take a HEARTBEAT (8.4.12.2): what is lost for good, and what can be asked for."""
        proxy = self._proxies.get(writer)
        if proxy is None or not proxy.reliable or heartbeat.count == proxy.heartbeat_count:
            return
        proxy.heartbeat_count = heartbeat.count
        if heartbeat.first > proxy.next:
            self._give_up(proxy, heartbeat.first)
        # What was asked before is answered; what is missing now is asked for below.
        proxy.synced, proxy.ask_at = True, float("inf")
        proxy.last = max(proxy.last, heartbeat.last)
        proxy.repeats = 0
        self._progress(proxy, now)
        if proxy.next <= proxy.last or not heartbeat.final:
            self._answer(proxy, now)

    def on_heartbeat_frag(self, writer: Guid, heartbeat: HeartbeatFrag, now: float) -> None:
        """Take a HEARTBEAT_FRAG: ask for the fragments that the writer has already sent."""
        proxy = self._proxies.get(writer)
        if proxy is None or not proxy.reliable or heartbeat.count == proxy.fragment_count:
            return
        proxy.fragment_count = heartbeat.count
        number = heartbeat.sequence_number
        if number >= proxy.next and number in proxy.fragments:
            missing = proxy.fragments.missing(number, heartbeat.last)
            if missing:
                self._post(proxy, (self._nack_frag(proxy, number, missing),))

    def on_gap(self, writer: Guid, gap: Gap, now: float) -> None:
        """Take a GAP (8.4.12.2): sequence numbers that will not come."""
        proxy = self._proxies.get(writer)
        if proxy is None or not proxy.reliable:
            return
        if gap.start <= proxy.next < gap.numbers.base:
            self._deliver_below(proxy, gap.numbers.base)
        end = min(gap.numbers.base, proxy.next + _WINDOW)
        proxy.gaps.update(range(max(gap.start, proxy.next), end))
        limit = proxy.next + _WINDOW
        proxy.gaps.update(n for n in gap.numbers.members if proxy.next <= n < limit)
        self._progress(proxy, now)

    def tick(self, now: float) -> float:
        """Send the ACKNACKs that are due. Return when to call again, at the latest."""
        due = float("inf")
        for proxy in self._proxies.values():
            if now >= proxy.ask_at:
                proxy.ask_at = float("inf")
                if not proxy.synced:
                    self._greet(proxy, now)
                elif proxy.next <= proxy.last and proxy.repeats < _MOST_REPEATS:
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

    def _give_up(self, proxy: _Proxy, first: int) -> None:
        """Note that a writer no longer has what is below `first`. What came of it is delivered."""
        before = proxy.next
        delivered = self._deliver_below(proxy, first)
        if proxy.synced:
            gone = sum(each < first for each in proxy.gaps)
            self.lost += first - before - delivered - gone

    def _deliver_below(self, proxy: _Proxy, number: int) -> int:
        """Deliver the samples that wait below `number`, go on there, and return how many.

        `number` is above the one that is next.
        """
        ready = sorted(each for each in proxy.early if each < number)
        proxy.next, proxy.repeats = number, 0
        for each in ready:
            self._take_early(proxy, each)
        return len(ready)

    def _progress(self, proxy: _Proxy, now: float) -> None:
        """Deliver what no longer waits for an earlier sample."""
        if not proxy.synced:
            return
        before = proxy.next
        while proxy.next in proxy.early or proxy.next in proxy.gaps:
            proxy.next += 1
            if proxy.next - 1 in proxy.early:
                self._take_early(proxy, proxy.next - 1)
        if proxy.gaps:
            proxy.gaps = {each for each in proxy.gaps if each >= proxy.next}
        proxy.fragments.drop_below(proxy.next)
        if proxy.next > before:
            proxy.repeats = 0

    def _take_early(self, proxy: _Proxy, number: int) -> None:
        data, timestamp = proxy.early.pop(number)
        self._budget.give_back(len(data.payload or b""))
        self._deliver(proxy.guid, data, timestamp)

    def _answer(self, proxy: _Proxy, now: float) -> None:
        """Acknowledge what came, and ask for what is missing (8.4.12.2, 8.4.14.1)."""
        window = range(proxy.next, min(proxy.last, proxy.next + NumberSet.MAX_SIZE - 1) + 1)
        absent = [n for n in window if n not in proxy.early and n not in proxy.gaps]
        partial = [n for n in absent if n in proxy.fragments]
        whole = [n for n in absent if n not in proxy.fragments]
        submessages: list[Submessage] = [
            self._ack_nack(proxy, NumberSet.of(proxy.next, whole), final=True)
        ]
        if absent:
            proxy.repeats += 1
            proxy.ask_at = now + _REPEAT
        if partial and now - proxy.fragment_at < _PATIENCE:
            proxy.ask_at = now + _PATIENCE
        else:
            for number in partial[:_MOST_PARTIAL]:
                missing = proxy.fragments.missing(number)
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
        self._send(Outgoing(proxy.address, proxy.guid.prefix, submessages))
