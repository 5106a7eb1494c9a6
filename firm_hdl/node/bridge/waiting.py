"""What a bridge keeps in mind: messages for the board, requests at the board, and retries."""

from __future__ import annotations

import threading
from collections import OrderedDict, deque
from collections.abc import Iterator
from dataclasses import dataclass

from firm_hdl.node.description import Topic

__all__ = ["RETRY_SECONDS", "Call", "Calls", "MessageQueue", "Retry", "Waiting"]

RETRY_SECONDS = (0.2, 2.0)
"""Time until a board or a graph that is gone is tried again: the first, and the longest one."""

_TAGS = 1 << 32


@dataclass(frozen=True, slots=True)
class Waiting:
    """A message for the board, its caller if it is a request, and when it came."""

    topic: Topic
    packet: bytes
    caller: object
    at: float


class MessageQueue:
    """Messages for the board, in order. Any thread puts, one takes.

    * `max_bytes`: limit of all packets together.
    """

    def __init__(self, max_bytes: int) -> None:
        self._max_bytes = max_bytes
        self._lock = threading.Lock()
        self._messages: deque[Waiting] = deque()
        self._bytes = 0

    def put(self, message: Waiting) -> bool:
        """Add a message; return whether there is room."""
        with self._lock:
            if self._bytes + len(message.packet) > self._max_bytes:
                return False
            self._messages.append(message)
            self._bytes += len(message.packet)
            return True

    def take(self, *, before: float = float("inf")) -> Waiting | None:
        """Take the next message if it came before a time; `None` if there is none."""
        with self._lock:
            if not self._messages or self._messages[0].at >= before:
                return None
            message = self._messages.popleft()
            self._bytes -= len(message.packet)
            return message

    def oldest(self) -> float | None:
        """Return when the next message came; `None` if there is none."""
        with self._lock:
            return self._messages[0].at if self._messages else None


@dataclass(frozen=True, slots=True)
class Call:
    """A request at the board, and until when its response counts."""

    topic: Topic
    caller: object
    until: float


class Calls:
    """Requests at the board, by their tags, in the order of their ends."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._tag = 0
        self._calls: OrderedDict[int, Call] = OrderedDict()

    def __len__(self) -> int:
        return len(self._calls)

    @property
    def is_full(self) -> bool:
        """Whether there are as many as there may be."""
        return len(self._calls) >= self._most

    def next_tag(self) -> int:
        """Return a tag that no request has."""
        self._tag = (self._tag + 1) % _TAGS
        return self._tag

    def add(self, tag: int, call: Call) -> None:
        """Keep a request that was sent."""
        self._calls[tag] = call

    def answered(self, tag: int, topic: Topic) -> Call | None:
        """Take the request that a response of a service is for; `None` if there is none."""
        call = self._calls.get(tag)
        if call is None or call.topic is not topic:
            return None
        return self._calls.pop(tag)

    def ended(self, now: float = float("inf")) -> Iterator[Call]:
        """Take the requests whose time is over."""
        while self._calls and next(iter(self._calls.values())).until < now:
            yield self._calls.popitem(last=False)[1]


class Retry:
    """When something that failed is tried again: soon at first, then less and less often.

    * `first`, `longest`: seconds.
    """

    def __init__(self, first: float, longest: float) -> None:
        self._first, self._longest = first, longest
        self._pause = first
        self._why = ""
        self.at = 0.0  # The time from which it may be tried.

    def failed(self, now: float, why: str) -> bool:
        """Note that it was tried, or has ended; return whether the reason is another one."""
        self.at = now + self._pause
        self._pause = min(2 * self._pause, self._longest)
        before, self._why = self._why, why
        return why != before

    def forget(self) -> None:
        """Forget the reason, which nobody was told."""
        self._why = ""

    def worked(self) -> None:
        """Note that it works again."""
        self._pause, self._why = self._first, ""
