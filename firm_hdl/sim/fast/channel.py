"""The socket between a simulation and its engine."""

from __future__ import annotations

import select
import socket
from typing import ClassVar, Literal

from firm_hdl.sim.fast import protocol
from firm_hdl.sim.fast.protocol import Answer

__all__ = ["Channel", "SimulationError"]

_CHUNK = 1 << 18


class SimulationError(Exception):
    """The engine of a simulation has ended, or was closed; it cannot be used any more."""


class Channel:
    """Our end of the socket to an engine.

    Neither side can block the other for ever: while this side waits to send, it also receives.

    * `own`: the end of a pair of sockets; the engine has the other one.
    """

    engine: ClassVar[Literal["verilator", "amaranth"]]

    def __init__(self, own: socket.socket):
        self._socket = own
        self._received = bytearray()
        own.setblocking(False)

    def send(self, data: bytes) -> None:
        """Send messages.

        Raises
        ------
        SimulationError
        """
        try:
            self._send_all(memoryview(data))
        except KeyboardInterrupt:
            # Half a message: the engine would take the next one for its rest.
            self.close()
            raise

    def _send_all(self, view: memoryview) -> None:
        while view:
            self._check()
            # The socket may be full because the engine waits until its own messages are read.
            readable, _, _ = select.select([self._socket], [self._socket], [])
            if readable:
                self._read()
            try:
                view = view[self._socket.send(view) :]
            except BlockingIOError:
                continue
            except OSError:
                self._end()

    def receive(self, seconds: float | None) -> list[tuple[int, bytes]]:
        """Return the messages that came: kinds and bodies.

        Parameters
        ----------
        seconds : float or None
            How long to wait for a message; `None`: until one comes.

        Raises
        ------
        SimulationError
            If the engine has ended.
        """
        self._check()
        while True:
            if select.select([self._socket], [], [], seconds)[0]:
                self._read()
            found = protocol.messages(self._received)
            for kind, body in found:
                if kind == Answer.FAILED:
                    self.close()
                    raise SimulationError(body.decode())
            if found or seconds is not None:
                return found

    def fileno(self) -> int:
        """Return the file descriptor of the socket."""
        self._check()
        return self._socket.fileno()

    def again(self) -> Channel:
        """Start another engine of the same design, without compiling it again."""
        raise NotImplementedError

    def close(self) -> None:
        """Close the socket, and wait until the engine has ended. May be called again."""
        self._socket.close()

    def _read(self) -> None:
        try:
            data = self._socket.recv(_CHUNK)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if not data:
            self._end()
        self._received += data

    def _end(self) -> None:
        """The engine has closed its socket."""
        # Its last words may be a message.
        for kind, body in protocol.messages(self._received):
            if kind == Answer.FAILED:
                self.close()
                raise SimulationError(body.decode())
        self.close()
        raise SimulationError(f"The simulation ended: {self._reason()}")

    def _check(self) -> None:
        if self._socket.fileno() < 0:
            raise SimulationError("The simulation is closed")

    def _reason(self) -> str:
        """Return why the engine ended without a message."""
        return "its socket was closed"
