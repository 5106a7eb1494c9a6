"""A board behind UDP: a datagram is a frame."""

from __future__ import annotations

import contextlib
import errno
import os
import socket
from collections.abc import Sequence
from typing import Any

from firm_hdl.node.boards.board import Board, BoardError

__all__ = ["UdpBoard"]

_MOST_DATAGRAM = 65_535
_BUFFER_BYTES = 1 << 22
_MOST_AT_ONCE = 256
# What the network says of one datagram, such as that nobody listens there (ICMP). Others follow.
_PASSING = (errno.ECONNREFUSED, errno.EHOSTUNREACH, errno.ENETUNREACH, errno.EHOSTDOWN)


class UdpBoard(Board):
    """A board with the link `udp`.

    Nothing tells that such a board is gone; a bridge notices that it does not answer.

    * `host`, `port`: address of the board; datagrams of others are ignored. If it is another
      machine, the host uses the same port, where that is free: cores such as LiteEth have one for
      both directions.
    * `frame_bytes`: most bytes of a datagram's payload: a multiple of 16.
    """

    def __init__(self, name: str, host: str, port: int, frame_bytes: int) -> None:
        super().__init__(name, frame_bytes)
        self._address = (host, port)
        self._socket: socket.socket | None = None
        self._is_unreachable = False

    def open(self) -> None:
        self.close()
        found = None
        try:
            family, kind, proto, _, address = socket.getaddrinfo(
                *self._address, type=socket.SOCK_DGRAM
            )[0]
            found = socket.socket(family, kind, proto)
            found.setblocking(False)
            # A message may be many datagrams. The system may give less.
            for option in (socket.SO_RCVBUF, socket.SO_SNDBUF):
                found.setsockopt(socket.SOL_SOCKET, option, _BUFFER_BYTES)
            _take_port(found, family, address)
            found.connect(address)
        except OSError as error:
            if found is not None:
                found.close()
            raise BoardError(f"cannot reach {self.name}: {error.strerror or error}") from None
        self._socket, self._is_unreachable = found, False

    @property
    def is_unreachable(self) -> bool:
        # What the network said of the datagrams before would be said of the next one.
        error = self._opened().getsockopt(socket.SOL_SOCKET, socket.SO_ERROR)
        if error:
            self._judge(OSError(error, os.strerror(error)))
        return self._is_unreachable

    def fileno(self) -> int:
        return self._opened().fileno()

    def send(self, frames: Sequence[bytes]) -> bool:
        own = self._opened()
        for frame in frames:
            try:
                own.send(frame)
            except ConnectionRefusedError as error:
                # This is said of a datagram before, and the frame was not sent.
                self._judge(error)
                with contextlib.suppress(OSError):
                    own.send(frame)
            except BlockingIOError:
                return False
            except OSError as error:
                self._judge(error)
                return False
        return True

    def receive(self) -> list[bytes]:
        own, frames = self._opened(), []
        for _ in range(_MOST_AT_ONCE):
            try:
                frames.append(own.recv(_MOST_DATAGRAM))
                self._is_unreachable = False
            except BlockingIOError:
                break
            except OSError as error:
                self._judge(error)
        return frames

    def close(self) -> None:
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def _judge(self, error: OSError) -> None:
        """Count what concerns one datagram; anything else ends the board."""
        if error.errno not in _PASSING:
            raise BoardError(f"{self.name}: {error.strerror or error}") from None
        self.counters["unreachable"] += 1
        self._is_unreachable = True

    def _opened(self) -> socket.socket:
        if self._socket is None:
            raise BoardError(f"{self.name} is closed")
        return self._socket


def _take_port(own: socket.socket, family: int, address: tuple[Any, ...]) -> None:
    """Take the port that the board has, if it is free and the board is another machine."""
    with socket.socket(family, socket.SOCK_DGRAM) as probe:
        probe.connect(address)
        if probe.getsockname()[0] == address[0]:
            return
    with contextlib.suppress(OSError):
        own.bind(("", address[1]))
