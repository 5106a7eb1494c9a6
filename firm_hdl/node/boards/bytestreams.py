"""Boards behind a stream of bytes, TCP or a serial line: frames in COBS with a CRC."""

from __future__ import annotations

import fcntl
import os
import socket
import stat
import sys
import termios
from abc import abstractmethod
from collections.abc import Sequence
from contextlib import suppress

from firm_hdl.node.boards.board import Board, BoardError
from firm_hdl.node.bytestream import ByteStreamReader, write_frame

__all__ = ["BAUD_RATES", "SerialBoard", "TcpBoard"]

_CHUNK = 1 << 16
_WAIT_SECONDS = 0.05
"""How long a message may wait behind others for a line of known speed."""

_TCP_BYTES = 1 << 16
"""What may wait for a connection, whose speed is unknown, and once more in the system.

A network carries so much in a few milliseconds, and a line of 1 Mbaud behind a server in 1.3 s."""

_CONNECT_SECONDS = 3.0

BAUD_RATES = {
    int(name[1:]): getattr(termios, name)
    for name in dir(termios)
    if name.startswith("B") and name[1:].isdigit() and name != "B0"
}
"""The rates that the system has, with its numbers for them."""


class ByteBoard(Board):
    """What both have in common: a file descriptor that bytes are written to and read from.

    * `room_bytes`: what may wait before there is no more room; one message always may.
    * `max_bytes`: largest frame that is received.
    """

    def __init__(self, name: str, room_bytes: int, max_bytes: int = 1 << 24) -> None:
        super().__init__(name)
        self._room_bytes, self._max_bytes = room_bytes, max_bytes
        self._reader = ByteStreamReader(max_bytes=max_bytes)
        self._waiting = bytearray()
        self._file: int | None = None

    @abstractmethod
    def _open(self) -> int:
        """Return a file descriptor that does not block; it is closed by this class."""

    def open(self) -> None:
        self.close()
        self._file = self._open()
        self._reader = ByteStreamReader(max_bytes=self._max_bytes)
        self._waiting.clear()

    def fileno(self) -> int:
        if self._file is None:
            raise BoardError(f"{self.name} is closed")
        return self._file

    @property
    def waits_to_send(self) -> bool:
        return bool(self._waiting)

    @property
    def has_room(self) -> bool:
        waits = len(self._waiting) + self._held_by_system()
        return not waits or waits < self._room_bytes

    def _held_by_system(self) -> int:
        """Return how many bytes the system has taken and not yet sent, as far as this counts."""
        return 0

    def send(self, frames: Sequence[bytes]) -> bool:
        for frame in frames:
            self._waiting += write_frame(frame)
        self.flush()
        return True

    def flush(self) -> None:
        while self._waiting:
            try:
                count = os.write(self.fileno(), self._waiting[:_CHUNK])
            except BlockingIOError:
                return
            except OSError as error:
                raise BoardError(f"{self.name}: {error.strerror}") from None
            del self._waiting[:count]

    def receive(self) -> list[bytes]:
        try:
            data = os.read(self.fileno(), _CHUNK)
        except BlockingIOError:
            return []
        except OSError as error:
            # A serial adapter that was unplugged; the other side of a pty that was closed.
            raise BoardError(f"{self.name}: {error.strerror}") from None
        if not data:
            raise BoardError(f"{self.name}: the other side has closed")
        before = self._reader.counters
        damaged, large = before.damaged, before.large
        frames = self._reader.feed(data)
        self.counters["damaged"] += self._reader.counters.damaged - damaged
        self.counters["large"] += self._reader.counters.large - large
        return frames

    def close(self) -> None:
        if self._file is not None:
            with suppress(OSError):
                os.close(self._file)
            self._file = None


class TcpBoard(ByteBoard):
    """Bytes over a connection of TCP, such as that of a server of serial lines.

    * `host`, `port`: where the board listens.
    """

    def __init__(self, name: str, host: str, port: int) -> None:
        super().__init__(name, _TCP_BYTES)
        self._address = (host, port)

    def _open(self) -> int:
        try:
            connection = socket.create_connection(self._address, _CONNECT_SECONDS)
        except OSError as error:
            raise BoardError(f"cannot reach {self.name}: {error.strerror or error}") from None
        # A message is sent as a whole, and should not wait for the next one.
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        # The system would else hold several MB for a peer that is slow.
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _TCP_BYTES)
        connection.setblocking(False)
        return connection.detach()


class SerialBoard(ByteBoard):
    """A serial line, or a pty: 8 data bits, no parity, 1 stop bit, no flow control.

    * `path`: the device, such as ``/dev/ttyUSB0``.
    * `baud`: a key of `BAUD_RATES`.
    """

    def __init__(self, name: str, path: str, baud: int) -> None:
        # A byte has a start bit and a stop bit.
        rate = baud / 10
        super().__init__(name, int(_WAIT_SECONDS * rate))
        self._path, self._baud = path, baud
        self.bytes_per_second = rate

    def _open(self) -> int:
        file = None
        try:
            file = os.open(self._path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
            if not stat.S_ISCHR(os.fstat(file).st_mode):
                raise BoardError(f"'{self._path}' is no serial device")
            self._configure(file)
        except OSError as error:
            self._drop(file)
            raise BoardError(f"cannot open '{self._path}': {error.strerror}") from None
        except termios.error as error:
            self._drop(file)
            raise BoardError(f"'{self._path}' is no serial device: {error.args[-1]}") from None
        except BoardError:
            self._drop(file)
            raise
        return file

    def _configure(self, file: int) -> None:
        """Make the line transparent: each byte passes as it is (termios(3), ``cfmakeraw``)."""
        speed = BAUD_RATES[self._baud]
        control = termios.tcgetattr(file)[6]
        control[termios.VMIN], control[termios.VTIME] = 1, 0
        flags = termios.CS8 | termios.CREAD | termios.CLOCAL
        termios.tcsetattr(file, termios.TCSANOW, [0, 0, flags, 0, speed, speed, control])
        # Bytes of before belong to nobody.
        termios.tcflush(file, termios.TCIOFLUSH)

    def _held_by_system(self) -> int:
        # The 4 KiB of a driver are 4 s at 9,600 baud. A pty says 0.
        try:
            found = fcntl.ioctl(self.fileno(), termios.TIOCOUTQ, bytes(4))
        except OSError:
            # Not all drivers know.
            return 0
        return int.from_bytes(found, sys.byteorder)

    @staticmethod
    def _drop(file: int | None) -> None:
        if file is not None:
            os.close(file)
