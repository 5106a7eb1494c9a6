"""What of the messages and requests for a board is lost, as far as a host can know.

Nobody knows what a dead board took, but an answer to a request of control shows what the core has
received: the link keeps the order, so all that was sent before the request came before it. Such a
message may still be in a gate, a converter or the accelerator when the answer leaves, because an
answer overtakes messages. A second request that is answered later shows that the board lived on
meanwhile. So a message is confirmed when a request was answered that was sent after it, and then
another one that was sent `PASS_SECONDS` after this answer.

What is not confirmed is an upper bound, and most of it may have been passed on.
"""

from __future__ import annotations

from collections import Counter, deque
from dataclasses import dataclass

__all__ = ["PASS_SECONDS", "LostRequests", "Unconfirmed"]

PASS_SECONDS = 0.05
"""The time in which a message passes through a node, from the core on."""


class Unconfirmed:
    """Messages that were sent to a board, by topic, until the board confirms them.

    All times are of one clock that never jumps.
    """

    def __init__(self) -> None:
        self._sent: deque[tuple[float, str]] = deque()
        # Requests that were answered: when they were sent, and when the answer came.
        self._answered: deque[tuple[float, float]] = deque()

    def __len__(self) -> int:
        return len(self._sent)

    def sent(self, topic: str, now: float) -> None:
        """Note a message that is sent now."""
        self._sent.append((now, topic))

    def answered(self, asked_at: float, now: float) -> None:
        """Note that the answer to a request has come, and when the request was sent."""
        confirmed = float("-inf")
        while self._answered and self._answered[0][1] + PASS_SECONDS <= asked_at:
            confirmed = self._answered.popleft()[0]
        self._answered.append((asked_at, now))
        while self._sent and self._sent[0][0] < confirmed:
            self._sent.popleft()

    def take(self) -> Counter[str]:
        """Forget everything, as the board is gone; return the messages that are unconfirmed."""
        found = Counter(topic for _, topic in self._sent)
        self._sent.clear()
        self._answered.clear()
        return found


@dataclass(slots=True)
class LostRequests:
    """How many requests and answers were lost, which are no losses of messages: they are repeated.

    The board counts the requests that it takes, so those that were lost on the way to it differ
    from those whose answer was lost. Of a board that does not count them, nothing is known.
    """

    # Requests that were sent, and answers that came.
    asked: int = 0
    answered: int = 0
    # What was lost on the way to the board, and back.
    lost_there: int = 0
    lost_back: int = 0
    # By how much the numbers differ when nothing is lost.
    _taken: int = 0
    _there: int = 0
    _back: int | None = None

    @property
    def is_known(self) -> bool:
        """Whether the board was asked for the requests that it has taken since it started."""
        return self._back is not None

    def begin(self, asked: int, taken: int, lost: int) -> None:
        """Begin with a request of this number, as of which the board has taken and lost so many."""
        self.lost_there += lost
        self._taken, self._there = taken, asked - taken - self.lost_there
        if self._back is None:
            self._back = taken - self.answered

    def note(self, asked: int, taken: int) -> None:
        """Note how many requests the board has taken, up to one with its number."""
        assert self._back is not None
        if taken > self._taken:
            self.lost_there = max(0, asked - taken - self._there)
            self.lost_back = max(0, taken - self.answered - self._back)
