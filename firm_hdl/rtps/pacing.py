"""How fast datagrams are sent: receivers lose what their sockets cannot hold."""

from __future__ import annotations

__all__ = ["Pacer"]

# A socket of Linux holds 212,992 bytes by default, and counts a datagram of 1,400 bytes as 2,304.
_BURST_BYTES = 64 << 10
# After a pause, as much may be sent at once: a pause for each datagram would cost more than that.
_CHUNK_BYTES = 16 << 10


class Pacer:
    """A token bucket.

    Parameters
    ----------
    bytes_per_second : float
        The rate in the long run. A burst of 64 KiB passes at once.
    """

    def __init__(self, bytes_per_second: float):
        if bytes_per_second <= 0:
            raise ValueError(f"Rate must be positive, not {bytes_per_second}")
        self._rate = bytes_per_second
        self._tokens = float(_BURST_BYTES)
        self._at = 0.0
        self._needed = 0.0

    def wait(self, now: float) -> float:
        """Return the seconds until the next datagram may be sent; 0 or less means now."""
        if now > self._at:
            self._tokens = min(_BURST_BYTES, self._tokens + (now - self._at) * self._rate)
            self._at = now
        # A datagram may be larger than what is left: the debt is paid before the next one.
        if self._tokens > self._needed:
            self._needed = 0.0
            return 0.0
        self._needed = float(_CHUNK_BYTES)
        return (self._needed - self._tokens) / self._rate

    def note(self, size: int) -> None:
        """Note that a datagram of `size` bytes was sent."""
        self._tokens -= size
