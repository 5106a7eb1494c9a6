"""What a host says to a board, without sockets, threads and clocks: time is an argument.

A session begins when a way to a board is open. First, the board has to answer with the fingerprint
of the description; no message passes before. Then the clock of the node is kept in step, and its
counters are read. One request of control is under way at any time; its answer also shows that the
board is there.
"""

from __future__ import annotations

import random
from collections import Counter, deque
from dataclasses import dataclass

from firm_hdl.node.bridge.unconfirmed import PASS_SECONDS, Unconfirmed
from firm_hdl.node.control import (
    ControlRequest,
    ControlResponse,
    Operation,
    Register,
    Result,
    nominal_rate,
    registers,
)
from firm_hdl.node.description import CONTROL_TOPIC, Description
from firm_hdl.node.frame import FLAG_START, HEADER_BYTES
from firm_hdl.node.messages import MessageReceiver, MessageSender, NodeMessage
from firm_hdl.node.timekeeping import ClockKeeper

__all__ = ["ROUND_SECONDS", "Session", "SilentBoardError", "WrongBoardError"]

REPEAT_SECONDS = 0.25
"""A request without an answer is repeated after so long."""

ROUND_SECONDS = 5.0
"""All counters of a board are read in turn; a round begins so often."""

_MOST_HELD = 1024
_MOST_LATE = 3
_MOST_ASKED = 64
_LATENCIES = 64
_RESET_SECONDS = 10**8
"""A node whose time is before that of 1973 has started again since its time was set."""

_NO_LOSSES = ("passed", "bytes_low", "bytes_high", "control", "control_full", "unsent")
"""Counters that do not count losses: a request of control without room was repeated, and before a
host has spoken, all that a node sends is unsent."""


class WrongBoardError(Exception):
    """The board has another description than the host; the text says so."""


class SilentBoardError(Exception):
    """The board does not answer."""


@dataclass(frozen=True, slots=True)
class _Asked:
    """A request that is under way, and when it was sent: on the host's clock, and in its time."""

    request: ControlRequest
    at: float
    wall_ns: int
    is_sample: bool


class Session:
    """The talk with a board that is open.

    Parameters
    ----------
    description : Description
    frame_bytes : int or None
        Most bytes of a frame, header included; as of the board.
    now : float
        Seconds of a clock that never jumps.
    sample_seconds : float
        How often the clocks are compared.
    silent_seconds : float
        A board from which nothing whole came for so long is gone.
    before : Session or None
        The last session with the same board. Its counters go on, or are kept if the board has
        started again since.

    Attributes
    ----------
    is_ready : bool
        The board is the right one; messages may pass.
    restarts : int
        How often the board has started again.
    held_back : int
        Messages of the board that were dropped because it was not known to be the right one.
    values : dict of int to int
        Registers by their numbers, as they were read last since the board started.
    unconfirmed : Unconfirmed
        Messages for the board. Who sends them notes them there.
    """

    def __init__(
        self,
        description: Description,
        frame_bytes: int | None,
        now: float,
        *,
        sample_seconds: float = 1.0,
        silent_seconds: float = 5.0,
        before: Session | None = None,
    ) -> None:
        self._description, self._frame_bytes = description, frame_bytes
        self._sample_seconds, self._silent_seconds = sample_seconds, silent_seconds
        self._counters = [each for each in registers(description) if each.part != "identity"]
        self._keeper = ClockKeeper(nominal_rate(description.clock_hz))
        self._sender = MessageSender(frame_bytes)
        self._receiver = MessageReceiver()
        self._tag = random.getrandbits(32)
        self._asked: dict[int, _Asked] = {}
        self._held: deque[NodeMessage] = deque()
        self._latencies: deque[float] = deque(maxlen=_LATENCIES)
        self._heard = self._waits_until = now
        self._is_set: bool = before is not None and before._is_set
        self._is_unanswered = self._is_finishing = False
        # Until when the last messages may still be in the node.
        self._passes_until = now
        self._late = 0
        self._next_sample = self._next_round = now
        self._todo: deque[ControlRequest] = deque()
        # Of the clock; a newer one takes its place, because the time of an older one has passed.
        self._clock_request: ControlRequest | None = None
        self._identity: dict[int, int] = {}
        self.values: dict[int, int] = dict(before.values) if before else {}
        # Counters of a board before it started again.
        self._past: Counter[int] = Counter(before._past) if before else Counter()
        self.unconfirmed = Unconfirmed()
        self.is_ready = False
        self.restarts = self.held_back = 0

    # To the board.

    def frames(self, message: NodeMessage) -> list[bytes]:
        """Return the frames of a message, which are sent at once; see :class:`MessageSender`."""
        return self._sender.frames(message)

    def due(self, now: float, wall_ns: int) -> list[bytes]:
        """Return the frames of the request that is due, if there is one.

        Parameters
        ----------
        now : float
        wall_ns : int
            Time of the host in ns since the epoch.

        Raises
        ------
        SilentBoardError
            If the board has not answered for `silent_seconds`.
        """
        if now - self._heard > self._silent_seconds:
            raise SilentBoardError(f"no answer for {self._silent_seconds:g} s")
        if now < self._waits_until:
            return []
        request, is_sample = self._next(now)
        if request is None:
            return []
        self._waits_until = now + REPEAT_SECONDS
        self._is_unanswered = True
        if not self.is_ready:
            # The first message says that a sequence begins. It may have been lost.
            self._sender = MessageSender(self._frame_bytes)
        self._tag = (self._tag + 1) & 0xFFFF_FFFF
        self._asked[self._tag] = _Asked(request, now, wall_ns, is_sample)
        while len(self._asked) > _MOST_ASKED:
            del self._asked[next(iter(self._asked))]
        message = NodeMessage(topic=CONTROL_TOPIC, packet=request.encode(), tag=self._tag)
        return self._sender.frames(message)

    def next_due(self) -> float:
        """Return when :meth:`due` should be called next, if nothing comes."""
        if not self.is_ready or self._todo or self._clock_request or self._is_unanswered:
            return self._waits_until
        return max(self._waits_until, min(self._next_sample, self._next_round))

    def _next(self, now: float) -> tuple[ControlRequest | None, bool]:
        """Return the next request, and whether its answer compares the clocks."""
        if not self.is_ready:
            return _read(2 if 1 in self._identity else 1), False
        if self._is_finishing:
            return (self._todo[0] if self._todo else None), False
        if self._clock_request is not None:
            request, self._clock_request = self._clock_request, None
            return request, False
        if now >= self._next_sample or self._is_unanswered:
            self._next_sample = now + self._sample_seconds
            return _read(0), True
        if now >= self._next_round and not self._todo:
            self._next_round = now + ROUND_SECONDS
            self._todo.extend(_read(each.number) for each in self._counters)
        return (self._todo[0] if self._todo else None), False

    # The end.

    def finish(self, now: float) -> None:
        """Let what is due be a last round: of all counters of losses, and of nothing else.

        A first answer shows that all messages have arrived. `PASS_SECONDS` later they have passed,
        and the counters are final. The answer to the first of them confirms all messages.
        """
        self._is_finishing = True
        # An answer to a request of before shows nothing of the last messages.
        self._asked.clear()
        self._todo = deque([_read(0)])
        self._todo.extend(_read(each.number) for each in self._counters if _is_loss(each))
        self._waits_until = now

    @property
    def is_finished(self) -> bool:
        """Whether all counters of losses were read after :meth:`finish`."""
        return self._is_finishing and not self._todo

    def end(self) -> None:
        """Count the messages of the board that still wait until it is known."""
        self.held_back += len(self._held)
        self._held.clear()

    # From the board.

    def take(self, frame: bytes, now: float, wall_ns: int) -> list[NodeMessage]:
        """Take a frame; return the messages for the graph that it sets free.

        Raises
        ------
        WrongBoardError
            If the board has another description.
        """
        starts = len(frame) >= HEADER_BYTES and bool(frame[1] & FLAG_START)
        message = self._receive(frame, now)
        if message is None:
            return []
        self._heard = now
        self._is_unanswered = False
        if starts:
            self._begin_again(now)
        if message.topic != CONTROL_TOPIC:
            if self.is_ready:
                return [message]
            self._held.append(message)
            if len(self._held) > _MOST_HELD:
                self._held.popleft()
                self.held_back += 1
            return []
        self._answer(message, now, wall_ns)
        if not self.is_ready or not self._held:
            return []
        found, self._held = list(self._held), deque()
        return found

    def _receive(self, frame: bytes, now: float) -> NodeMessage | None:
        """Put messages together. Several late ones in a row are those of a new sequence."""
        counters = self._receiver.counters
        late = counters.late
        message = self._receiver.take(frame)
        if message is not None:
            self._late = 0
        self._late += counters.late - late
        if self._late >= _MOST_LATE:
            # The message that said so was lost.
            self._late = 0
            self._receiver = MessageReceiver()
            self._receiver.counters = counters
            self._begin_again(now)
        return message

    def _begin_again(self, now: float) -> None:
        """The board has started again, perhaps with another design."""
        self._identity.clear()
        # Also of the board that a session before has left.
        self._past.update(self.values)
        self.values.clear()
        self._is_set = False
        if not self.is_ready:
            return
        self.restarts += 1
        self.is_ready = False
        self._asked.clear()
        self._todo.clear()
        self._clock_request = None
        self._waits_until = now
        self._keeper = ClockKeeper(nominal_rate(self._description.clock_hz))
        self._next_sample = self._next_round = now
        if self._is_finishing:
            # What was read is of before.
            self.finish(now)

    def _answer(self, message: NodeMessage, now: float, wall_ns: int) -> None:
        asked = self._asked.pop(message.tag, None)
        try:
            response = ControlResponse.decode(message.packet)
        except ValueError:
            return
        if asked is None or response.operation != asked.request.operation:
            return
        self._waits_until = max(now, self._passes_until)
        self._latencies.append(now - asked.at)
        if self._is_set and response.seconds < _RESET_SECONDS:
            # Its first message, which says so, did not come, or came to a session before.
            self._begin_again(now)
            return
        self.unconfirmed.answered(asked.at, now)
        if self._todo and asked.request == self._todo[0]:
            self._todo.popleft()
            if asked.request.argument == 0:
                # The first request of `finish`: a round reads counters alone.
                self._waits_until = self._passes_until = now + PASS_SECONDS
        self._is_set |= asked.request.operation == Operation.SET_TIME
        if response.result == Result.OK and asked.request.operation == Operation.READ:
            self._keep(asked.request.argument, response.value)
        if asked.is_sample:
            more = self._keeper.sample(asked.wall_ns, response, wall_ns)
            if more is not None:
                self._clock_request = more

    def _keep(self, number: int, value: int) -> None:
        if self.is_ready:
            self.values[number] = value
            return
        self._identity[number] = value
        if self._identity.keys() < {1, 2}:
            return
        found = self._identity[1] | self._identity[2] << 32
        if found != self._description.fingerprint:
            self.end()
            raise WrongBoardError(
                f"the board's fingerprint is {found:016x}, and that of the description is "
                f"{self._description.fingerprint:016x}: one of them is older"
            )
        self.is_ready = True

    # For people.

    @property
    def latency(self) -> float | None:
        """The median of the last round trips to the board, in seconds."""
        if not self._latencies:
            return None
        return sorted(self._latencies)[len(self._latencies) // 2]

    @property
    def offset_ns(self) -> float | None:
        """Time of the node less that of the host, when the clocks were last compared."""
        return self._keeper.offset_ns

    def lost_on_the_way(self) -> Counter[str]:
        """Return what was lost between the board and here, by cause."""
        counters = self._receiver.counters
        names = ("lost", "cut", "stray", "malformed", "large")
        found = Counter({name: getattr(counters, name) for name in names})
        found["held back"] = self.held_back
        return found

    def drops(self) -> list[tuple[Register, int]]:
        """Return the losses in the node that are not 0, as they were read last.

        Those that a board had counted before it started again are added.
        """
        return [
            (each, value)
            for each in self._counters
            if _is_loss(each)
            and (value := self._past[each.number] + self.values.get(each.number, 0))
        ]


def _read(number: int) -> ControlRequest:
    return ControlRequest(operation=Operation.READ, argument=number)


def _is_loss(register: Register) -> bool:
    return register.name not in _NO_LOSSES
