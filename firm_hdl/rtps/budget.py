"""Memory for what peers send: shared fairly, whoever asks for how much."""

from __future__ import annotations

from typing import Protocol

__all__ = ["Budget", "Holder"]

# What a value takes besides its bytes, about.
_OVERHEAD_BYTES = 200


class Holder(Protocol):
    """Who takes memory."""

    prefix: bytes  # GUID prefix of the peer on whose account it is.

    def shrink(self) -> None:
        """Give some of the memory back; called only if there is some."""


class Budget:
    """Memory that peers share.

    As long as there is enough, each takes what it needs. After that, the peer that has most gives
    some back to one that has less. So a peer always gets its share, whatever the others do.

    * `limit`: number of bytes.
    """

    def __init__(self, limit: int):
        self.limit = limit
        self.used = 0
        self._held: dict[bytes, dict[Holder, int]] = {}
        self._of_peer: dict[bytes, int] = {}

    def of(self, holder: Holder) -> int:
        """Return how much a holder has."""
        return self._held.get(holder.prefix, {}).get(holder, 0)

    def take(self, holder: Holder, size: int) -> bool:
        """Take the memory of a value of `size` bytes, perhaps from others.

        Returns: `False` if nobody has more than the holder would have then.
        """
        size += _OVERHEAD_BYTES
        while self.used + size > self.limit:
            other = self._largest(holder, size)
            if other is None:
                return False
            other.shrink()
        self._add(holder, size)
        return True

    def give_back(self, holder: Holder, size: int, values: int = 1) -> None:
        """Give back the memory of `values` values, of `size` bytes together."""
        self._add(holder, -size - values * _OVERHEAD_BYTES)

    def _largest(self, holder: Holder, size: int) -> Holder | None:
        """Return who has most of the peer that has most, if that is more than `holder` asks for."""
        # First the peer, then one of its holders: so many small ones do not hide that a peer has
        # most.
        mine = self._of_peer.get(holder.prefix, 0) + size
        peer = max(self._of_peer, key=self._of_peer.__getitem__, default=holder.prefix)
        if self._of_peer.get(peer, 0) <= mine:
            peer = holder.prefix
        held = self._held.get(peer, {})
        other = max(held, key=held.__getitem__, default=holder)
        if other is holder or (peer == holder.prefix and held[other] <= self.of(holder) + size):
            return None
        return other

    def _add(self, holder: Holder, size: int) -> None:
        held = self._held.setdefault(holder.prefix, {})
        held[holder] = held.get(holder, 0) + size
        self._of_peer[holder.prefix] = self._of_peer.get(holder.prefix, 0) + size
        self.used += size
        if not held[holder]:
            del held[holder]
        if not self._of_peer[holder.prefix]:
            del self._held[holder.prefix], self._of_peer[holder.prefix]
