"""A transport that loses datagrams of both directions, as a bad network does."""

from __future__ import annotations

import random
import socket
from collections.abc import Iterator

from firm_hdl.rtps.transport import Transport
from firm_hdl.rtps.wire.locators import Address

__all__ = ["LossyTransport"]


class LossyTransport(Transport):
    """Sockets that lose a part of what they send and of what they receive.

    Parameters
    ----------
    loss : float
        The probability that a datagram is lost.
    seed : int
        For the random numbers.
    """

    def __init__(self, domain: int, host: str, loss: float, seed: int):
        super().__init__(domain, host)
        self.loss = loss
        self.lost = 0
        self._random = random.Random(seed)

    def send(self, address: Address, datagram: bytes) -> bool:
        """Send a datagram, or lose it."""
        return self._loses() or super().send(address, datagram)

    def receive(self, source: socket.socket, limit: int = 64) -> Iterator[bytes]:
        """Yield those datagrams that are not lost."""
        yield from (each for each in super().receive(source, limit) if not self._loses())

    def _loses(self) -> bool:
        lost = self._random.random() < self.loss
        self.lost += lost
        return lost
