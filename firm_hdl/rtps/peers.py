"""Participants that were found: the way to each, and how much it may make us send.

A peer names its own addresses, and nobody proves that they are its own. So a peer has a credit:
what it asks for is sent as long as it is not many times what it has sent itself. RFC 9000, 8.1, has
the same rule for QUIC. Samples that a writer sends without being asked cost nothing, and readers
may ask for them again, but not without end (:mod:`firm_hdl.rtps.writer`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeAlias

from firm_hdl.rtps.discovery import ParticipantData
from firm_hdl.rtps.wire.locators import Address, distance
from firm_hdl.rtps.wire.submessages import Submessage

__all__ = ["Outgoing", "Peer", "Route", "Send"]

# Bytes that a peer may cost for each byte that came from it, and how many are kept for later.
_PER_BYTE, _MOST_CREDIT = 3, 1 << 20
# Histories that late readers of one peer get at once, and how many more in a second.
_HISTORIES, _HISTORIES_PER_SECOND = 64, 1.0
# Choices among addresses that are remembered: most endpoints name the same ones.
_MOST_FOUND = 64
# Addresses that are tried as long as none of them is known to be the peer's.
_MOST_ADDRESSES = 4
# Seconds without a sign of life by one way before another one is taken.
_PATIENCE = 3.0

Ways: TypeAlias = tuple[tuple[Address, ...], bool]


@dataclass(slots=True)
class Peer:
    """A participant that was found."""

    data: ParticipantData  # What it says of itself, as of its last announcement.
    here: str  # Our IPv4 address.
    host: str | None  # Where its first announcement came from, if that is known.
    heard_at: float = float("-inf")  # When it last said anything.
    credit: float = 0.0  # Bytes that it may cost. It may fall below 0 with one datagram.
    # When it was last told of us, and when that is repeated.
    answered_at: float = float("-inf")
    again_at: float = float("inf")
    _way: str | None = None
    _way_at: float = float("-inf")
    _histories: float = _HISTORIES
    _histories_at: float = 0.0
    # What `ways` has found.
    _found: dict[tuple[Address, ...], Ways] = field(default_factory=dict)

    def hear(self, host: str | None, size: int, now: float) -> None:
        """Note that a datagram of `size` bytes came from it, and from which host."""
        self.heard_at = now
        self.credit = min(self.credit + _PER_BYTE * size, max(self.credit, _MOST_CREDIT))
        if host == self._way or self._way is None or now - self._way_at >= _PATIENCE:
            named = (*self.data.discovery, *self.data.user)
            if any(each.host == host for each in named):
                self._found = self._found if host == self._way else {}
                self._way, self._way_at = host, now

    def renew(self, data: ParticipantData) -> None:
        """Take what it says of itself now."""
        self.data, self._way, self._found = data, None, {}

    def spend(self, size: int) -> bool:
        """Take `size` bytes from its credit; return `False` if there is none left."""
        if self.credit <= 0:
            return False
        self.credit -= size
        return True

    def may_have_history(self, now: float) -> bool:
        """Whether one more of its readers may ask for a history."""
        gained = (now - self._histories_at) * _HISTORIES_PER_SECOND
        self._histories = min(_HISTORIES, self._histories + gained)
        self._histories_at = now
        if self._histories < 1:
            return False
        self._histories -= 1
        return True

    def ways(self, addresses: tuple[Address, ...]) -> Ways:
        """Choose among its addresses, or those of one of its endpoints.

        Returns
        -------
        tuple of Address
            Where to send: the address that it is heard from; all, the nearest first, if it is
            heard from none of them.
        bool
            Whether they are known to be its own.
        """
        found = self._found.get(addresses)
        if found is None:
            if len(self._found) >= _MOST_FOUND:
                self._found.clear()
            found = self._found[addresses] = self._choose(addresses)
        return found

    def _choose(self, addresses: tuple[Address, ...]) -> Ways:
        heard = tuple(each for each in addresses if each.host == self._way)
        if heard:
            return heard[:1], True
        nearest = sorted(addresses, key=lambda each: distance(each, self.here))
        # What comes through the loopback interface comes from this host. The system sends nothing
        # from there to others.
        if self.host is None or self.host.startswith("127."):
            return tuple(nearest[:1]), True
        return tuple(nearest[:_MOST_ADDRESSES]), False


@dataclass(frozen=True, slots=True)
class Route:
    """The way to the endpoints of a peer."""

    peer: Peer
    own: tuple[Address, ...] = ()  # Addresses of the endpoint itself, if it names any.
    discovery: bool = False  # Whether it is a built-in endpoint of discovery.

    def ways(self) -> Ways:
        """Return where to send, and whether that is known to be the peer's; see `Peer.ways`."""
        data = self.peer.data
        return self.peer.ways(self.own or (data.discovery if self.discovery else data.user))


@dataclass(frozen=True, slots=True)
class Outgoing:
    """One datagram."""

    route: Route
    prefix: bytes  # GUID prefix of the participant that it is for.
    # Its content, without the INFO_DST that names the participant.
    submessages: tuple[Submessage, ...]
    # Whether the peer has made us send it, so that it costs credit (`firm_hdl.rtps.peers`).
    is_answer: bool = True


Send: TypeAlias = Callable[[Outgoing], None]
"""Takes a datagram. It is sent later, or lost."""
