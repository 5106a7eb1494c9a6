"""The messages of a board, put together, and whether the board has started again.

The numbers of messages show what is lost, and their flag or a clock that was reset that a board has
started again. A network that repeats or delays a frame shows the same, so such a sign is only a
reason to ask: the answer to a later request decides. In the same sequence, an answer has a number
after those that had come before its request was sent.

    board     17   18   | 0*   1    2    3      * says that a sequence begins
    host                  sign | asks    answer: its number is before 19, so the sequence is new

Until the answer comes, what follows the sign is read as both: as the old sequence, and as a new one
that may take its place.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass

from firm_hdl.node.control import ControlRequest, ControlResponse
from firm_hdl.node.description import CONTROL_TOPIC
from firm_hdl.node.frame import LATE_MESSAGES, Header
from firm_hdl.node.messages import MessageReceiver, NodeMessage, distance

__all__ = ["MOST_HELD", "Arrivals", "Asked"]

MOST_HELD = 1024
"""Messages that are kept until it is known whether they count."""

_MOST_LATE = 3
_RESET_SECONDS = 10**8
"""A node whose time is before that of 1973 has started again since its time was set."""

_MOST_BEHIND = (1 << 15) - 1
"""What is behind is late. Whether a sequence goes back, :meth:`Arrivals.judge` finds out."""


@dataclass(frozen=True, slots=True)
class Asked:
    """A request that was sent, and when: on the host's clock, and in its time."""

    request: ControlRequest
    at: float
    wall_ns: int
    is_sample: bool
    # How many requests were sent up to this one, and which message of the board came next.
    number: int
    expected: int | None


class Arrivals:
    """Put the frames of a board together.

    * `receiver`: that of the session before, whose sequence and counters go on.
    """

    def __init__(self, receiver: MessageReceiver | None = None) -> None:
        # Of the sequence that counts.
        self.receiver = receiver or MessageReceiver(most_late=_MOST_BEHIND)
        self.suspected_at = float("-inf")  # When the last sign of a restart came.
        # Since the sign: the new sequence, and its messages.
        self._new: MessageReceiver | None = None
        self._new_messages: list[NodeMessage] = []
        self._new_starts = False
        # Messages in a row whose numbers were behind.
        self._late = 0

    @property
    def is_suspected(self) -> bool:
        """Whether a sign has come, and no answer that decides."""
        return self._new is not None

    @property
    def may_be_new(self) -> bool:
        """Whether this sign was a frame that says so."""
        return self._new is not None and self._new_starts

    def take(self, frame: bytes, header: Header | None, now: float) -> NodeMessage | None:
        """Take a frame, whose header is `None` if it has none; return the message of it."""
        if header is None:
            return self.receiver.take(frame)
        starts = header.start and self.receiver.expected is not None
        if starts:
            self._suspect(now)
            self._new_starts = True
        if self.may_be_new:
            # What comes may be of the new sequence, whose numbers can also be ahead.
            self.receiver.doubt()
        late = self.receiver.counters.late
        message = None if starts else self.receiver.take(frame)
        self._late += self.receiver.counters.late - late
        if message is not None:
            self._late = 0
        elif self._late >= _MOST_LATE:
            # The message that says so may have been lost.
            self._suspect(now)
        if self._new is not None:
            new = self._new.take(frame)
            if new is not None and message is None and len(self._new_messages) < MOST_HELD:
                self._new_messages.append(new)
        return message

    def judge(
        self, asked: Asked, header: Header, packet: bytes, now: float, *, is_set: bool
    ) -> list[NodeMessage] | None:
        """Find out by an answer whether the board has started again.

        One answer alone may be damaged, or may belong to a request that was sent before the sign.

        * `asked`: the request.
        * `header`, `packet`: of the answer, which is not taken yet.
        * `is_set`: whether the time of the node was set.

        Returns: if it has: the messages for the graph that have come since.
        """
        ahead = 0 if asked.expected is None else distance(header.sequence, asked.expected)
        was_reset = False
        with suppress(ValueError):
            was_reset = is_set and ControlResponse.decode(packet).seconds < _RESET_SECONDS
        # Without a sign before its request, an answer decides nothing. But it can be the sign.
        if self._new is None or asked.at < self.suspected_at:
            expected = self.receiver.expected
            if ahead < 0 or was_reset:
                self._suspect(now)
            elif expected is not None and abs(distance(header.sequence, expected)) <= LATE_MESSAGES:
                # The sequence is that of before.
                self.receiver.jumped = 0
            return None
        new, self._new, self._late = self._new, None, 0
        messages, self._new_messages = self._new_messages, []
        # Only late numbers were the sign. If the answer is late as well, but not by much, the
        # sequence is that of before, and one of its numbers was believed that was damaged.
        if not (was_reset or self._new_starts or ahead < -LATE_MESSAGES):
            if ahead < 0:
                self.receiver.go_back(header.sequence)
            return None
        # The old sequence goes on: the network had repeated a frame, or delayed it.
        if ahead >= 0 and not was_reset:
            return None
        self.receiver.take_back()
        new.counters.add(self.receiver.counters)
        self.receiver = new
        return [message for message in messages if message.topic != CONTROL_TOPIC]

    def _suspect(self, now: float) -> None:
        """Keep what comes as a new sequence, too, until an answer decides."""
        if self._new is None:
            self._new, self._new_starts = MessageReceiver(most_late=_MOST_BEHIND), False
            self.suspected_at = now
