"""Messages of a node for a program in Python, without a graph of ROS."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from concurrent.futures import TimeoutError as FutureTimeoutError

from firm_hdl.node.boards.board import Board
from firm_hdl.node.bridge.bridge import Bridge
from firm_hdl.node.description import Description, Topic
from firm_hdl.node.graphs.graph import FutureGraph, OnMessage

__all__ = ["Client"]


class Client:
    """A program in place of a graph; a context manager.

    A packet is a serialized message, with the encapsulation header of CDR; rosbags makes and reads
    packets. A bridge runs in a thread of its own. It keeps the clock of the node, opens a board
    again that was lost, and counts what was lost: `bridge` has its figures.

    Parameters
    ----------
    description : Description
    board : Board
        Not yet open.
    report : callable or None
        Takes a line of text for people when something happens, such as a board that is gone.
    ready_seconds : float
        How long the board may take until it has answered; a simulation is compiled first.

    Raises
    ------
    TimeoutError
        From all methods, if the board, or a message, does not come in time.
    UserError, WrongBoardError
        From all methods, if the board will never be possible, or has another description.
    KeyError
        If there is no topic of this name.
    """

    def __init__(
        self,
        description: Description,
        board: Board,
        *,
        report: Callable[[str], None] | None = None,
        ready_seconds: float = 600.0,
    ) -> None:
        self._topics = {(topic.kind, topic.name): topic for topic in description.topics}
        self._graph = _Program(description)
        self.bridge = Bridge(description, board, self._graph, report=report)
        self._ready_seconds = ready_seconds
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._run, daemon=True)

    def open(self) -> Client:
        """Open the board, once, and wait until it has answered; return the client."""
        self._thread.start()
        try:
            has_changed = self._graph.changed.wait(self._ready_seconds)
        except KeyboardInterrupt:
            # A simulation may be compiled for minutes.
            self.bridge.stop()
            raise
        if not has_changed:
            self.close()
            raise TimeoutError(f"the board {self.bridge.board.name} does not answer")
        self._check()
        return self

    def __enter__(self) -> Client:
        return self.open()

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the board; may be called at any time, and again."""
        self.bridge.stop()
        if self._thread.ident is not None:
            self._thread.join()

    def _run(self) -> None:
        try:
            self.bridge.run()
        except BaseException as error:
            self._error = error
        finally:
            self._graph.changed.set()

    def _check(self) -> None:
        if self._error is not None:
            raise self._error

    def send(self, topic: str, packet: bytes) -> None:
        """Send a message to a subscription of the node."""
        self._check()
        self._graph.on_message(self._topics["subscribe", topic], packet, None)

    def receive(self, topic: str, seconds: float = 1.0) -> bytes:
        """Take the oldest message of a publication of the node that was not taken."""
        self._check()
        try:
            return self._graph.came[topic].get(timeout=seconds)
        except queue.Empty:
            self._check()
            raise TimeoutError(f"no message of '{topic}' in {seconds:g} s") from None

    def call(self, service: str, packet: bytes, seconds: float = 10.0) -> bytes:
        """Send a request to a service of the node; return the response."""
        self._check()
        response: Future[bytes] = Future()
        self._graph.on_message(self._topics["serve", service], packet, response)
        try:
            return response.result(seconds)
        except (FutureTimeoutError, CancelledError):
            raise TimeoutError(f"no response of '{service}'") from None


_MOST_MESSAGES = 1 << 16


class _Program(FutureGraph):
    """A program as a graph: messages of each topic wait in a queue, and the newest is dropped."""

    on_message: OnMessage

    def __init__(self, description: Description) -> None:
        super().__init__("program")
        self.changed = threading.Event()
        self.came: dict[str, queue.Queue[bytes]] = {
            topic.name: queue.Queue(_MOST_MESSAGES)
            for topic in description.topics
            if topic.kind == "publish"
        }

    def open(self, on_message: OnMessage) -> None:
        self.on_message = on_message
        self.changed.set()

    def publish(self, topic: Topic, packet: bytes) -> bool:
        try:
            self.came[topic.name].put_nowait(packet)
        except queue.Full:
            return False
        return True

    def close(self) -> None:
        return
