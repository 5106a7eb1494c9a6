"""The bridge: messages from a graph go to a board, and those of the board to the graph.

It knows neither kind: a :class:`.Board` carries frames, a :class:`.Graph` has messages. Both may
end at any time and come back. What cannot be passed on is dropped and counted, never kept for long:
a command that is seconds old moves a robot that nobody steers any more.
"""

from __future__ import annotations

import select
import socket
import time
from collections import Counter
from collections.abc import Callable
from contextlib import suppress

from firm_hdl.errors import UserError
from firm_hdl.node.boards.board import Board, BoardError
from firm_hdl.node.bridge.counters import BridgeCounters
from firm_hdl.node.bridge.session import Session, SilentBoardError, WrongBoardError
from firm_hdl.node.bridge.waiting import Call, Calls, MessageQueue, Retry, Waiting
from firm_hdl.node.control import Register
from firm_hdl.node.description import Description, Topic
from firm_hdl.node.graphs.graph import Graph, GraphError
from firm_hdl.node.messages import NodeMessage

__all__ = ["Bridge"]

HOLD_SECONDS = 0.25
"""How long a message for a board waits that is not there."""

CALL_SECONDS = 10.0
"""How long a request waits for its response."""

RETRY_SECONDS = (0.2, 2.0)
"""Time until a board or a graph that is gone is tried again: the first, and the longest one."""

CHECK_SECONDS = 1.0
"""How often a graph is looked after."""

_MOST_QUEUED_BYTES = 1 << 26
_MOST_CALLS = 1 << 16
_MOST_AT_ONCE = 256
_MOST_SLEEP = 0.5
_LINGER_SECONDS = 1.0


class Bridge:
    """A bridge. It is used from one thread; :meth:`stop` may be called from any, and by signals.

    Parameters
    ----------
    description : Description
    board : Board
    graph : Graph
        It is joined once the board has answered for the first time, so that peers find a node that
        works.
    report : callable or None
        Takes a line of text for people when something happens, such as a board that is gone.

    Attributes
    ----------
    counters : BridgeCounters
    session : Session or None
        The talk with the board while it is open.
    is_opening, was_ready, was_stopped : bool
        The board is being opened, which :meth:`stop` does not end; it was ready; `stop` was called.
    """

    def __init__(
        self,
        description: Description,
        board: Board,
        graph: Graph,
        *,
        report: Callable[[str], None] | None = None,
    ) -> None:
        self.description, self.board, self.graph = description, board, graph
        self.counters = BridgeCounters()
        self.session: Session | None = None
        self._restarts = 0
        self._report = report or (lambda _: None)
        self._topics = {topic.id: topic for topic in description.topics}
        self._past: Counter[str] = Counter()
        self._drops: list[tuple[Register, int]] = []
        self._queue = MessageQueue(_MOST_QUEUED_BYTES)
        self._calls = Calls(_MOST_CALLS)
        self.was_stopped = False
        self._has_graph = self.was_ready = self._was_tried = self.is_opening = False
        self._board_retry, self._graph_retry = Retry(*RETRY_SECONDS), Retry(*RETRY_SECONDS)
        self._next_check = 0.0
        self._wake_receiver, self._wake_sender = socket.socketpair()
        for each in (self._wake_receiver, self._wake_sender):
            each.setblocking(False)

    # Any thread.

    def stop(self) -> None:
        """Let :meth:`run` end soon."""
        self.was_stopped = True
        self._wake()

    def on_message(self, topic: Topic, packet: bytes, caller: object) -> None:
        """Take a message of the graph; an `OnMessage`."""
        if self._queue.put(Waiting(topic, packet, caller, time.monotonic())):
            self._wake()
        else:
            self.counters.drop(topic.name, "queue full")

    def _wake(self) -> None:
        # It is full of such bytes, or closed.
        with suppress(OSError):
            self._wake_sender.send(b"\0")

    # The thread of the bridge.

    def run(
        self, *, seconds: float | None = None, each_second: Callable[[], None] | None = None
    ) -> None:
        """Pass messages on until :meth:`stop`, or until the graph has ended; then close both.

        Parameters
        ----------
        seconds : float or None
            The longest time, from when the board was opened first (compiled) or could not be.
        each_second : callable or None
            Called about once a second.

        Raises
        ------
        WrongBoardError
            If the board has another description, at the first time that it answers. Later, such a
            board is treated like one that is gone.
        UserError
            If board or graph will never be possible.
        """
        end, next_second = float("inf"), 0.0
        try:
            while not self.was_stopped and (now := time.monotonic()) < end:
                if self._was_tried and seconds is not None:
                    end, seconds = now + seconds, None
                is_done = self._queue.oldest() is None and not self._calls
                if self._has_graph and self.graph.has_ended and is_done:
                    # What the board makes of the last message is still to come.
                    end = min(end, now + _LINGER_SECONDS)
                if each_second is not None and now >= next_second:
                    next_second = now + CHECK_SECONDS
                    each_second()
                self.step(end)
        except UserError:
            # Ctrl-C also ends a compiler that makes a simulation, which is no mistake then.
            if not self.was_stopped:
                raise
        finally:
            self.close()

    def step(self, end: float = float("inf")) -> None:
        """Do what is due, and wait for what comes: until `end`, or half a second."""
        now = time.monotonic()
        self._care_for_board(now)
        self._care_for_graph(now)
        self._to_board(now)
        self._end_calls(now)
        # A simulation may have read while it sent, so nothing may be left there before the wait.
        self._from_board()
        self._wait(end)

    def close(self) -> None:
        """Leave the graph, and close the board, for good; the counters stay."""
        if self._has_graph:
            self._has_graph = False
            self.graph.close()
        self._lose_board(None)
        for each in (self._wake_receiver, self._wake_sender):
            each.close()

    @property
    def on_the_way(self) -> Counter[str]:
        """What was lost between the board and here, in all sessions."""
        now = self.session.lost_on_the_way() if self.session else Counter()
        return +(self._past + now + self.board.counters)

    @property
    def last_drops(self) -> list[tuple[Register, int]]:
        """What the node says that it dropped; see :meth:`.Session.drops`."""
        return self.session.drops() if self.session else self._drops

    @property
    def restarts(self) -> int:
        """How often the board, or the way to it, started again or was gone."""
        return self._restarts + (self.session.restarts if self.session else 0)

    @property
    def is_ready(self) -> bool:
        """Whether the board is there and the right one."""
        return self.session is not None and self.session.is_ready

    # The board.

    def _care_for_board(self, now: float) -> None:
        try:
            if self.session is None:
                if now < self._board_retry.at:
                    return
                self._was_tried = True
                self.is_opening = True
                try:
                    self.board.open()
                finally:
                    self.is_opening = False
                self.session = Session(
                    self.description,
                    self.board.frame_bytes,
                    time.monotonic(),
                    sample_seconds=self.board.sample_seconds,
                )
            frames = self.session.due(time.monotonic(), time.time_ns())
            if frames:
                self.board.send(frames)
        except (BoardError, SilentBoardError) as error:
            self._lose_board(str(error))

    def _lose_board(self, why: str | None) -> None:
        """Close the board. With a reason, it is tried again later."""
        if self.session is not None:
            self._past += self.session.lost_on_the_way()
            self._restarts += self.session.restarts
            self._drops = self.session.drops()
            self.session = None
        self.board.close()
        self._end_calls()
        if why is not None:
            self._restarts += 1
            if self._board_retry.failed(time.monotonic(), why):
                self._report(f"board {self.board.name}: {why}; trying again")

    def _from_board(self) -> None:
        """Take what has come."""
        if self.session is None:
            return
        try:
            for frame in self.board.receive():
                self._take(frame)
            if self.board.waits_to_send:
                self.board.flush()
        except BoardError as error:
            self._lose_board(str(error))
        except WrongBoardError as error:
            if not self.was_ready:
                raise
            self._lose_board(str(error))

    def _take(self, frame: bytes) -> None:
        session = self.session
        if session is None:
            return
        was_ready, restarts = session.is_ready, session.restarts
        messages = session.take(frame, time.monotonic(), time.time_ns())
        if session.restarts > restarts:
            self._report(f"board {self.board.name}: it has started again")
            self._end_calls()
        if session.is_ready and not was_ready:
            self.was_ready = True
            self._board_retry.worked()
            self._report(f"board {self.board.name}: ready")
        for message in messages:
            self._pass(message)

    # The graph.

    def _care_for_graph(self, now: float) -> None:
        if not self.was_ready:
            return
        try:
            if not self._has_graph:
                if now < self._graph_retry.at:
                    return
                self.graph.open(self.on_message)
                self._has_graph = True
                self._graph_retry.worked()
                self._report(f"graph {self.graph.name}: joined")
            if now >= self._next_check:
                self._next_check = now + CHECK_SECONDS
                self.graph.check()
        except GraphError as error:
            self._lose_graph(str(error))

    def _lose_graph(self, why: str) -> None:
        self._has_graph = False
        self.graph.close()
        # The callers are gone with it.
        self._end_calls()
        if self._graph_retry.failed(time.monotonic(), why):
            self._report(f"graph {self.graph.name}: {why}; trying again")

    def _pass(self, message: NodeMessage) -> None:
        """Give a message of the board to the graph."""
        topic = self._topics.get(message.topic)
        if topic is None or topic.kind == "subscribe":
            self.counters.drop(str(message.topic), "unknown topic")
            return
        call = None
        if topic.kind == "serve":
            call = self._calls.answered(message.tag, topic)
            if call is None:
                self.counters.drop(topic.name, "unknown call")
                return
        if not self._has_graph:
            self.counters.drop(topic.name, "no graph")
            return
        try:
            if call is None:
                is_taken = self.graph.publish(topic, message.packet)
            else:
                is_taken = self.graph.respond(topic, call.caller, message.packet)
        except GraphError as error:
            self.counters.drop(topic.name, "no graph")
            self._lose_graph(str(error))
            return
        if is_taken:
            self.counters.to_graph[topic.name] += 1
        else:
            self.counters.drop(topic.name, "graph full")

    # From the graph to the board.

    def _to_board(self, now: float) -> None:
        """Send what waits; drop what has waited for too long."""
        for _ in range(_MOST_AT_ONCE):
            old = now if self.is_ready else now - HOLD_SECONDS
            waiting = self._queue.take(before=old)
            if waiting is None:
                return
            cause = self._send(waiting)
            if cause is None:
                self.counters.to_board[waiting.topic.name] += 1
                continue
            self.counters.drop(waiting.topic.name, cause)
            if waiting.topic.kind == "serve":
                self.graph.abandon(waiting.topic, waiting.caller)

    def _send(self, waiting: Waiting) -> str | None:
        """Send a message to the board; return why it was dropped, or `None`."""
        topic, session = waiting.topic, self.session
        if session is None or not session.is_ready:
            return "no board"
        tag = 0
        if topic.kind == "serve":
            if self._calls.is_full:
                return "queue full"
            tag = self._calls.next_tag()
        message = NodeMessage(topic=topic.id, packet=waiting.packet, tag=tag)
        try:
            if not self.board.send(session.frames(message)):
                return "board full"
        except BoardError as error:
            self._lose_board(str(error))
            return "no board"
        if topic.kind == "serve":
            until = time.monotonic() + CALL_SECONDS
            self._calls.add(tag, Call(topic, waiting.caller, until))
        return None

    def _end_calls(self, now: float = float("inf")) -> None:
        """Forget requests that were not answered in time; without a time, all."""
        for call in self._calls.ended(now):
            self.counters.drop(call.topic.name, "unanswered")
            self.graph.abandon(call.topic, call.caller)

    # Waiting.

    def _wait(self, end: float) -> None:
        """Wait until the board or the graph has something, or something is due."""
        now = time.monotonic()
        until = min(now + _MOST_SLEEP, self._next_due(), end)
        reads: list[socket.socket | int] = [self._wake_receiver]
        writes: list[int] = []
        if self.session is not None:
            try:
                own = self.board.fileno()
            except BoardError as error:
                self._lose_board(str(error))
                return
            reads.append(own)
            writes += [own] if self.board.waits_to_send else []
        # Without a board, what waits is looked at again when it is too old.
        waits = self.is_ready and self._queue.oldest() is not None
        readable, _, _ = select.select(reads, writes, [], 0.0 if waits else max(0.0, until - now))
        if self._wake_receiver in readable:
            with suppress(BlockingIOError):
                self._wake_receiver.recv(4096)

    def _next_due(self) -> float:
        found = self.session.next_due() if self.session else self._board_retry.at
        if self.was_ready and not self._has_graph:
            found = min(found, self._graph_retry.at)
        oldest = self._queue.oldest()
        if oldest is not None and not self.is_ready:
            found = min(found, oldest + HOLD_SECONDS)
        return found
