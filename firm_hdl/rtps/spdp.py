"""The Simple Participant Discovery Protocol (8.5.3): participants find each other. No I/O."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING, TypeAlias

from firm_hdl.rtps.discovery import ParticipantData, check_owner, key_of, key_payload
from firm_hdl.rtps.peers import Peer, Route
from firm_hdl.rtps.wire.guid import PARTICIPANT, SPDP_READER, SPDP_WRITER, Guid
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.parameters import ParameterList, Pid
from firm_hdl.rtps.wire.submessages import Data
from firm_hdl.rtps.writer import FRAGMENT_BYTES

if TYPE_CHECKING:
    from firm_hdl.rtps.sedp import Sedp

__all__ = ["DISPOSED", "Settings", "Spdp"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """What a participant is and does."""

    own: ParticipantData  # What it announces.
    host: str  # Its IPv4 address.
    targets: tuple[Address, ...]  # Where announcements go, besides known peers.
    # Where they go at first, and seldom after that: addresses where a peer may be.
    seldom: tuple[Address, ...] = ()
    period: float = 1.0  # Seconds between announcements.
    # Larger samples are sent in fragments of this size: from 256 to 65,000.
    fragment_bytes: int = FRAGMENT_BYTES
    memory_bytes: int = 128 << 20  # Memory for samples that cannot be delivered yet.

    def __post_init__(self) -> None:
        if not 256 <= self.fragment_bytes <= 65_000:
            raise ValueError(
                f"Fragments must have from 256 to 65000 bytes, not {self.fragment_bytes}"
            )


DISPOSED = b"\0\0\0\x03"
"""Status of an instance that its writer disposed of and left (9.6.4.9), always big-endian."""

_MOST_PEERS = 256
# Strangers whose endpoints are asked for at once. The next ones have to say something more first.
_MOST_STRANGERS = 32
# A domain has ports for 120 participants of a host (9.6.1.1).
_MOST_PEERS_OF_HOST = 120
# Our first announcements come quickly, as some may be lost.
_QUICK, _QUICK_COUNT = 0.1, 5
# Seconds of silence after which a peer has no better place than a stranger.
_QUIET = 10.0
# An address where a peer may be is tried once in so many announcements.
_SELDOM = 10
# A lease of days would keep a dead peer for days; one of microseconds would lose it at once. The
# default is 100 s (9.6.2.2.2). Peers without endpoints are kept for shorter than others.
_LEAST_LEASE, _MOST_LEASE, _MOST_LEASE_OF_STRANGER = 1.0, 100.0, 30.0
# Seconds for which a participant that left is not found again: its farewell may have overtaken an
# announcement; and how many are remembered.
_GONE, _MOST_GONE = 1.0, 256
# Seconds between answers to the announcements of a peer.
_ANSWER = 0.5
# Bytes of an announcement besides its payload.
_HEAD_BYTES = 44

Tell: TypeAlias = Callable[[Address, Data], None]
"""Sends a submessage to whoever is at an address."""


class Spdp:
    """The announcer of a participant, and the participants that it heard of.

    * `listener`: who is told of peers, and knows how much each one is to us.
    * `counters`: counts announcements that got ``no_place``, and peers that were ``displaced`` by
      others.
    """

    def __init__(
        self,
        settings: Settings,
        listener: Sedp,
        tell: Tell,
        counters: Counter[str] | None = None,
    ):
        self._settings = settings
        self._own = settings.own
        self._listener = listener
        self._tell = tell
        self._counters = Counter[str]() if counters is None else counters
        self._peers: dict[bytes, Peer] = {}
        # How many there are of each host, and which ones the listener was not told of yet.
        self._of_host: Counter[str | None] = Counter()
        self._unmet: set[bytes] = set()
        # 8.5.3.3.1: a best-effort stateless writer sends its only sample again and again.
        self._announcement = Data(
            reader=SPDP_READER,
            writer=SPDP_WRITER,
            sequence_number=1,
            payload=settings.own.encode(),
        )
        self._left: dict[bytes, float] = {}
        self._announce_at = float("-inf")
        self._announced = 0

    @property
    def peers(self) -> tuple[ParticipantData, ...]:
        """The participants that are there."""
        return tuple(peer.data for peer in self._peers.values())

    def peer(self, prefix: bytes) -> Peer | None:
        """Return a participant by its GUID prefix."""
        return self._peers.get(prefix)

    def hear(self, prefix: bytes, host: str | None, size: int, now: float) -> None:
        """Note that a participant sent anything, and from which host: it lives."""
        known = self._peers.get(prefix)
        if known is not None:
            known.hear(host, size, now)
            if prefix in self._unmet:
                self._unmet.remove(prefix)
                self._listener.on_peer(known, now)

    def on_data(self, source: bytes, data: Data, host: str | None, now: float) -> None:
        """Take an announcement, or the news that a participant leaves (8.5.3.3).

        Raises `MalformedError`: it is not valid, or is about another participant.
        """
        if data.payload is None or data.key:
            gone = key_of(data.payload, data.inline, Pid.PARTICIPANT_GUID)
            if gone is not None:
                check_owner(gone.prefix, source)
                if source in self._peers and len(self._left) < _MOST_GONE:
                    self._left[source] = now
                self._drop(source, expired=False)
            return
        announced = ParticipantData.decode(data.payload)
        check_owner(announced.prefix, source)
        # Another domain may have the same port.
        if announced.domain not in (None, self._own.domain):
            return
        known = self._peers.get(source)
        if known is None:
            self._meet(announced, host, _HEAD_BYTES + len(data.payload), now)
        elif known.data == announced:
            if self._listener.rank(source) < 2:
                self._answer(known, now)
        else:
            known.renew(announced)
            known.hear(host, 0, now)
            self._answer(known, now)
            self._listener.on_peer(known, now)

    def _meet(self, announced: ParticipantData, host: str | None, size: int, now: float) -> None:
        """Take a participant that is not known yet, if there is a place for it."""
        prefix = announced.prefix
        if prefix in self._left:
            return
        if not self._has_place(host, now):
            self._counters["no_place"] += 1
            return
        peer = self._peers[prefix] = Peer(announced, self._settings.host, host)
        self._of_host[host] += 1
        peer.hear(host, size, now)
        self._answer(peer, now)
        strangers = (each for each in self._peers if not self._listener.rank(each))
        if next(islice(strangers, _MOST_STRANGERS, None), None) is not None:
            self._unmet.add(prefix)
        else:
            self._listener.on_peer(peer, now)

    def tick(self, now: float) -> float:
        """Announce if it is time; drop silent peers. Return when to call again, at the latest."""
        if now >= self._announce_at:
            # All possible addresses at first, and after that a part of them each time.
            seldom = self._settings.seldom
            some = seldom[self._announced % _SELDOM :: _SELDOM] if self._announced else seldom
            self._announced += 1
            period, quick = self._settings.period, self._announced < _QUICK_COUNT
            self._announce_at = now + (min(_QUICK, period) if quick else period)
            matched = [p for prefix, p in self._peers.items() if self._listener.rank(prefix) == 2]
            self._tell_all(self._announcement, some, matched)
        self._left = {prefix: at for prefix, at in self._left.items() if now < at + _GONE}
        due = self._announce_at
        for prefix, peer in list(self._peers.items()):
            deadline = peer.heard_at + self._lease(peer.data)
            if now >= deadline:
                self._drop(prefix, expired=True)
                continue
            if now >= peer.again_at:
                peer.again_at = float("inf")
                self._tell_peer(peer)
            due = min(due, deadline, peer.again_at)
        return due

    def leave(self) -> None:
        """Tell all that this participant leaves."""
        guid = Guid(self._own.prefix, PARTICIPANT)
        farewell = Data(
            reader=SPDP_READER,
            writer=SPDP_WRITER,
            sequence_number=2,
            payload=key_payload(guid, Pid.PARTICIPANT_GUID),
            key=True,
            inline=ParameterList(((Pid.STATUS_INFO, DISPOSED),)),
        )
        self._tell_all(farewell, (), list(self._peers.values()))

    def _tell_all(self, data: Data, some: tuple[Address, ...], peers: list[Peer]) -> None:
        """Send to the targets, and to peers: multicast does not reach all of them.

        A peer of ROS 2 whose discovery is limited to its host joins no group.
        """
        known = [way for peer in peers for way in Route(peer, discovery=True).ways()[0]]
        # Without repetitions, in an order that does not depend on hashes.
        for target in dict.fromkeys((*self._settings.targets, *some, *known)):
            self._tell(target, data)

    def _answer(self, peer: Peer, now: float) -> None:
        """Answer the announcement of a peer by our own, and again if it is new.

        A peer may announce itself before it listens.
        """
        if now - peer.answered_at < _ANSWER:
            return
        if peer.answered_at == float("-inf"):
            peer.again_at = now + _QUICK
        peer.answered_at = now
        self._tell_peer(peer)

    def _tell_peer(self, peer: Peer) -> None:
        size = _HEAD_BYTES + len(self._announcement.payload or b"")
        for way in Route(peer, discovery=True).ways()[0]:
            if peer.spend(size):
                self._tell(way, self._announcement)
            else:
                self._counters["withheld"] += 1

    def _has_place(self, host: str | None, now: float) -> bool:
        """Make sure that one more peer has a place.

        Strangers give way: first those that only announced themselves or are silent, then those
        without endpoints, then those that are not matched with us; of these, the first. No host
        takes the places of all others.
        """
        of_host = host is not None and self._of_host[host] >= _MOST_PEERS_OF_HOST
        if not of_host and len(self._peers) < _MOST_PEERS:
            return True
        for most in (-1, 0, 1):
            for prefix, peer in self._peers.items():
                if of_host and peer.host != host:
                    continue
                rank = -1 if prefix in self._unmet else self._listener.rank(prefix)
                if rank <= most or now - peer.heard_at >= _QUIET:
                    self._counters["displaced"] += 1
                    self._drop(prefix, expired=True)
                    return True
        return False

    def _lease(self, peer: ParticipantData) -> float:
        most = _MOST_LEASE if self._listener.rank(peer.prefix) else _MOST_LEASE_OF_STRANGER
        return min(max(peer.lease, _LEAST_LEASE), most)

    def _drop(self, prefix: bytes, expired: bool) -> None:
        peer = self._peers.pop(prefix, None)
        if peer is None:
            return
        self._of_host[peer.host] -= 1
        if not self._of_host[peer.host]:
            del self._of_host[peer.host]
        if prefix in self._unmet:
            self._unmet.remove(prefix)
        else:
            self._listener.on_peer_lost(prefix, expired)
