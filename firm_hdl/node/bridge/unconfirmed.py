"""The messages that a board may not have passed on, were it gone now.

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

__all__ = ["PASS_SECONDS", "Unconfirmed"]

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
