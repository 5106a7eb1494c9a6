"""The bridge: messages from a graph go to a board, and those of the board to the graph.

It knows neither kind: a :class:`.Board` carries frames, a :class:`.Graph` has messages. Both may
end at any time and come back. What cannot be passed on is dropped and counted, never kept for long:
a command that is seconds old moves a robot that nobody steers any more.
"""

from __future__ import annotations

import select
import socket
import time
from collections.abc import Callable
from contextlib import suppress

from firm_hdl.errors import UserError
from firm_hdl.node.boards.board import Board
from firm_hdl.node.bridge.boardside import BoardSide
from firm_hdl.node.bridge.counters import BridgeCounters, Load
from firm_hdl.node.bridge.waiting import RETRY_SECONDS, Call, Calls, MessageQueue, Retry, Waiting
from firm_hdl.node.capacity import most_bytes
from firm_hdl.node.description import Description, Topic
from firm_hdl.node.graphs.graph import Graph, GraphError
from firm_hdl.node.messages import NodeMessage

__all__ = ["Bridge"]

HOLD_SECONDS = 0.25
"""How long a message waits for a board that is not there, or has no room."""

CALL_SECONDS = 10.0
"""How long a request waits for its response."""

CHECK_SECONDS = 1.0
"""How often a graph is looked after."""

_MOST_QUEUED_BYTES = 1 << 26
_MOST_CALLS = 1 << 16
_MOST_AT_ONCE = 256
# Each has a line in the account.
_MOST_UNKNOWN = 8
_MOST_SLEEP = 0.5
_POLL_SECONDS = 0.005
_LINGER_SECONDS = 1.0


class Bridge:
    """A bridge. It is used from one thread; :meth:`stop` may be called from any, and by signals.

    Parameters
    ----------
    description : Description
    board : Board
    graph : Graph
        It is joined once the board has answered for the first time, so that peers find a node that
        works. One that ends is also joined when the board has said nothing for its
        `silent_seconds`, so that the bridge ends with it.
    report : callable or None
        Takes a line of text for people when something happens, such as a board that is gone.
    clock : callable
        Returns the time that the node is to have, in ns since the epoch.

    Attributes
    ----------
    counters : BridgeCounters
    side : BoardSide
        The side of the board, with its figures.
    was_stopped : bool
        :meth:`stop` was called.
    """

    def __init__(
        self,
        description: Description,
        board: Board,
        graph: Graph,
        *,
        report: Callable[[str], None] | None = None,
        clock: Callable[[], int] = time.time_ns,
    ) -> None:
        self.description, self.board, self.graph = description, board, graph
        self.counters = BridgeCounters()
        self._report = report or (lambda _: None)
        self.side = BoardSide(
            description, board, self.counters, self._report, self._end_calls, clock
        )
        self._topics = {topic.id: topic for topic in description.topics}
        self._most_bytes = {
            topic.id: most_bytes(description, "in", store)
            for topic, store in description.received()
        }
        # Topics of which a message was too large.
        self._large: set[int] = set()
        self._load = Load(description, board.bytes_per_second)
        self._unknown: set[int] = set()
        self._queue = MessageQueue(_MOST_QUEUED_BYTES)
        # What comes later is not sent any more.
        self._last = float("inf")
        self._calls = Calls(_MOST_CALLS)
        self.was_stopped = self._has_graph = False
        self._graph_retry = Retry(*RETRY_SECONDS)
        self._next_check = 0.0
        # From when on a graph that ends does not wait for a board that has never answered.
        self._waits_until = float("inf")
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

        Before, a board that is ready is asked for its last figures, for its `end_seconds` at most.
        A `KeyboardInterrupt` closes both at once.

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
                if self.side.was_tried and seconds is not None:
                    end, seconds = now + seconds, None
                is_done = self._queue.oldest() is None and not self._calls
                if self._has_graph and self.graph.has_ended and is_done:
                    # What the board makes of the last message is still to come.
                    end = min(end, now + _LINGER_SECONDS)
                if each_second is not None and now >= next_second:
                    next_second = now + CHECK_SECONDS
                    each_second()
                self.step(end)
            self._finish()
        except UserError:
            # Ctrl-C also ends a compiler that makes a simulation, which is no mistake then.
            if not self.was_stopped:
                raise
        finally:
            self.close()

    def step(self, end: float = float("inf")) -> None:
        """Do what is due, and wait for what comes: until `end`, or half a second."""
        now = time.monotonic()
        self.side.care(now)
        self._care_for_graph(now)
        self._to_board(now)
        self._end_calls(now)
        # A simulation may have read while it sent, so nothing may be left there before the wait.
        self._from_board()
        for line in self._load.judge(time.monotonic()):
            self._report(f"board {self.board.name}: {line}")
        self._wait(end)

    def _finish(self) -> None:
        """Send what waits, and let the board say what has arrived and what it lost."""
        self._last = time.monotonic()
        end, session = self._last + self.board.end_seconds, self.side.session
        has_asked = False
        # A board that is lost now is not tried again.
        while self.side.is_ready and self.side.session is session and time.monotonic() < end:
            self._to_board(time.monotonic())
            if not has_asked and not self._has_waiting:
                has_asked = True
                self.side.finish()
            self.side.care(time.monotonic())
            self._from_board()
            if self.side.has_read_last:
                return
            self._wait(end)

    def close(self) -> None:
        """Leave the graph, and close the board, for good; the counters stay."""
        if self._has_graph:
            self._has_graph = False
            self.graph.close()
        while (waiting := self._queue.take()) is not None:
            if waiting.at < self._last:
                self.counters.drop(waiting.topic.name, "bridge ended")
            if waiting.topic.kind == "serve":
                self.graph.abandon(waiting.topic, waiting.caller)
        self.side.lose(None)
        for each in (self._wake_receiver, self._wake_sender):
            each.close()

    def _from_board(self) -> None:
        for message in self.side.receive():
            self._pass(message)

    # The graph.

    def _care_for_graph(self, now: float) -> None:
        if not self._may_join():
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
                for line in self.graph.news():
                    self._report(f"graph {self.graph.name}: {line}")
        except GraphError as error:
            self._lose_graph(str(error))

    def _may_join(self) -> bool:
        """Return whether it is time to join the graph."""
        # To open a simulation takes as long as to compile it.
        now = time.monotonic()
        if self.graph.ends and self.side.was_tried and self._waits_until == float("inf"):
            self._waits_until = now + self.board.silent_seconds
        return self.side.was_ready or now >= self._waits_until

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
            is_named = message.topic in self._unknown or len(self._unknown) < _MOST_UNKNOWN
            if is_named:
                self._unknown.add(message.topic)
            name = str(message.topic) if is_named else "other topics"
            self.counters.drop(name, "unknown topic")
            return
        self._load.add("out", topic, message.packet)
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
            old = now if self.side.has_room else now - HOLD_SECONDS
            waiting = self._queue.take(before=min(old, self._last))
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
        topic, size = waiting.topic, len(waiting.packet)
        if size > (most := self._most_bytes[topic.id]):
            if topic.id not in self._large:
                self._large.add(topic.id)
                self._report(
                    f"graph {self.graph.name}: a message of {topic.name} has {size} bytes, and the "
                    f"memory on the board has room for {most}; larger ones are dropped"
                )
            return "too large"
        self._load.add("in", topic, waiting.packet)
        if topic.kind != "serve":
            return self.side.send(topic, waiting.packet)
        if self._calls.is_full:
            return "queue full"
        tag = self._calls.next_tag()
        cause = self.side.send(topic, waiting.packet, tag)
        if cause is None:
            until = time.monotonic() + CALL_SECONDS
            self._calls.add(tag, Call(topic, waiting.caller, until))
        return cause

    def _end_calls(self, now: float = float("inf")) -> None:
        """Forget requests that were not answered in time; without a time, all."""
        for call in self._calls.ended(now):
            self.counters.drop(call.topic.name, "unanswered")
            self.graph.abandon(call.topic, call.caller)

    # Waiting.

    def _wait(self, end: float) -> None:
        """Wait until the board or the graph has something, or something is due."""
        reads, writes = self.side.files()
        now = time.monotonic()
        until = min(now + _MOST_SLEEP, self._next_due(), end)
        if self.side.has_room and self._has_waiting:
            until = now
        wakes = self._wake_receiver.fileno()
        readable, _, _ = select.select([*reads, wakes], writes, [], max(0.0, until - now))
        if wakes in readable:
            with suppress(BlockingIOError):
                self._wake_receiver.recv(4096)

    @property
    def _has_waiting(self) -> bool:
        """Whether a message waits that may still be sent."""
        oldest = self._queue.oldest()
        return oldest is not None and oldest < self._last

    def _next_due(self) -> float:
        found = self.side.next_due()
        if not self._has_graph and not self.side.was_ready:
            found = min(found, self._waits_until)
        elif not self._has_graph:
            found = min(found, self._graph_retry.at)
        oldest = self._queue.oldest()
        if oldest is not None and not self.side.has_room:
            found = min(found, oldest + HOLD_SECONDS)
            if self.side.is_ready:
                # Of a driver that holds bytes, nothing tells when it has sent them.
                found = min(found, time.monotonic() + _POLL_SECONDS)
        return found
