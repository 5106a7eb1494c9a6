"""The Simple Participant Discovery Protocol (8.5.3): participants find each other. No I/O."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from firm_hdl.rtps.discovery import ParticipantData, key_of, key_payload
from firm_hdl.rtps.outgoing import Outgoing, Send
from firm_hdl.rtps.wire.guid import PARTICIPANT, SPDP_READER, SPDP_WRITER, UNKNOWN_PREFIX, Guid
from firm_hdl.rtps.wire.locators import Address, nearest
from firm_hdl.rtps.wire.parameters import ParameterList, Pid
from firm_hdl.rtps.wire.samples import NO_PARAMETERS, Data

__all__ = ["DISPOSED", "Spdp"]

DISPOSED = b"\0\0\0\x03"
"""Status of an instance that its writer disposed of and left (9.6.4.9), always big-endian."""

_MAX_PEERS = 256
# Announcements of a new participant come quickly, as some may be lost.
_QUICK, _QUICK_COUNT = 0.1, 5
# A lease of days would keep a dead peer for days; one of microseconds would lose it at once.
_LEASE_LIMITS = (1.0, 3600.0)
# Seconds for which a participant that left is not found again: its farewell may have overtaken an
# announcement.
_GONE = 1.0
# Seconds between directed answers to one peer, so that a flood of announcements makes no other.
_ANSWER = 1.0


@dataclass(slots=True)
class _Peer:
    data: ParticipantData
    deadline: float
    answered_at: float


class Spdp:
    """The announcer of a participant, and the participants that it heard of.

    Parameters
    ----------
    own : ParticipantData
        What it announces.
    host : str
        Our IPv4 address, for the choice among a peer's addresses.
    targets : tuple of Address
        Where announcements go: the multicast group, and addresses where peers may be.
    period : float
        Seconds between announcements.
    send : Send
        Takes datagrams.
    found, lost : callables
        Called with a new or changed peer, and with one that left or whose lease expired.
    """

    def __init__(
        self,
        own: ParticipantData,
        host: str,
        targets: tuple[Address, ...],
        period: float,
        send: Send,
        found: Callable[[ParticipantData, float], None],
        lost: Callable[[ParticipantData, bool], None],
    ):
        self._own = own
        self._host = host
        self._targets = targets
        self._period = period
        self._send = send
        self._found = found
        self._lost = lost
        self._peers: dict[bytes, _Peer] = {}
        self._left: dict[bytes, float] = {}
        self._announce_at = float("-inf")
        self._announced = 0

    @property
    def peers(self) -> tuple[ParticipantData, ...]:
        """The participants that are there."""
        return tuple(peer.data for peer in self._peers.values())

    def peer(self, prefix: bytes) -> ParticipantData | None:
        """Return a participant by its GUID prefix."""
        known = self._peers.get(prefix)
        return None if known is None else known.data

    def refresh(self, prefix: bytes, now: float) -> None:
        """Note that a participant sent anything: it lives."""
        known = self._peers.get(prefix)
        if known is not None:
            known.deadline = now + _lease(known.data)

    def on_data(self, source: bytes, data: Data, now: float) -> None:
        """Take an announcement, or the news that a participant leaves (8.5.3.3)."""
        if data.payload is None or data.key:
            gone = key_of(data.payload, data.inline, Pid.PARTICIPANT_GUID)
            if gone is not None and gone.prefix == source:
                if source in self._peers:
                    self._left[source] = now
                self._drop(source, expired=False)
            return
        peer = ParticipantData.decode(data.payload)
        # A participant announces itself alone; another domain may have the same port.
        if peer.prefix != source or peer.domain not in (None, self._own.domain):
            return
        known = self._peers.get(source)
        if known is None and (len(self._peers) == _MAX_PEERS or source in self._left):
            return
        if known is not None and known.data == peer:
            known.deadline = now + _lease(peer)
            return
        answered_at = float("-inf") if known is None else known.answered_at
        known = self._peers[source] = _Peer(peer, now + _lease(peer), answered_at)
        self._answer(known, now)
        # A peer may announce itself before it listens.
        self._announced = min(self._announced, _QUICK_COUNT - 2)
        self._announce_at = min(self._announce_at, now + _QUICK)
        self._found(peer, now)

    def tick(self, now: float) -> float:
        """Announce if it is time; drop silent peers. Return when to call again, at the latest."""
        if now >= self._announce_at:
            self._announced += 1
            quick = self._announced < _QUICK_COUNT
            self._announce_at = now + (min(_QUICK, self._period) if quick else self._period)
            self._tell_all(self._announcement())
        self._left = {prefix: at for prefix, at in self._left.items() if now < at + _GONE}
        for prefix in [p for p, peer in self._peers.items() if now >= peer.deadline]:
            self._drop(prefix, expired=True)
        return min([self._announce_at, *(peer.deadline for peer in self._peers.values())])

    def leave(self) -> None:
        """Tell all that this participant leaves."""
        inline = ParameterList(((Pid.STATUS_INFO, DISPOSED),))
        guid = Guid(self._own.prefix, PARTICIPANT)
        farewell = Data(
            reader=SPDP_READER,
            writer=SPDP_WRITER,
            sequence_number=2,
            payload=key_payload(guid, Pid.PARTICIPANT_GUID),
            key=True,
            inline=inline,
        )
        self._tell_all(farewell)

    def _tell_all(self, data: Data) -> None:
        """Send to the targets, and to each peer: multicast does not reach all of them.

        A peer of ROS 2 whose discovery is limited to its host joins no group.
        """
        known = (nearest(peer.data.discovery, self._host) for peer in self._peers.values())
        # Without repetitions, in an order that does not depend on hashes.
        for target in dict.fromkeys((*self._targets, *(each for each in known if each))):
            self._send(Outgoing(target, UNKNOWN_PREFIX, (data,)))

    def _announcement(self) -> Data:
        # 8.5.3.3.1: a best-effort stateless writer sends its only sample again and again.
        return Data(
            reader=SPDP_READER,
            writer=SPDP_WRITER,
            sequence_number=1,
            payload=self._own.encode(),
            inline=NO_PARAMETERS,
        )

    def _answer(self, peer: _Peer, now: float) -> None:
        """Announce this participant to a new peer at once."""
        address = nearest(peer.data.discovery, self._host)
        if address is not None and now - peer.answered_at >= _ANSWER:
            peer.answered_at = now
            self._send(Outgoing(address, UNKNOWN_PREFIX, (self._announcement(),)))

    def _drop(self, prefix: bytes, expired: bool) -> None:
        peer = self._peers.pop(prefix, None)
        if peer is not None:
            self._lost(peer.data, expired)


def _lease(peer: ParticipantData) -> float:
    return min(max(peer.lease, _LEASE_LIMITS[0]), _LEASE_LIMITS[1])
