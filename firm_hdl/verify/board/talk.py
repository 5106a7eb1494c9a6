"""A talk with a board under test: packets go there and come back, and registers are read.

What control messages say, and whether the board has started again, is found out by the session of
the bridge. While packets are under way, nothing else is asked. Every wait has an end: a board that
is silent for too long ends the talk, or the exchange of packets.
"""

from __future__ import annotations

import select
import time
from collections import Counter, defaultdict, deque
from collections.abc import Callable, Iterable, Sequence

from firm_hdl.node import Description, Topic
from firm_hdl.node.boards import Board, BoardError
from firm_hdl.node.bridge.session import Session, WrongBoardError
from firm_hdl.node.capacity import link_bytes_per_second
from firm_hdl.node.frame import HEADER_BYTES
from firm_hdl.node.messages import NodeMessage

__all__ = ["Talk", "TalkError"]


class TalkError(Exception):
    """The board does not answer, or is another one; the text says so."""


class Talk:
    """A talk with a board, which is closed in the end; a context manager.

    * `board`: not yet open.
    * `description`: of the node that the board has to have.
    * `silent_seconds`: a board that says nothing for so long has failed; `None`: as the board has
      it.

    Raises `TalkError`: from all methods, if the board is gone or silent, has started again, or is
    another one.
    """

    def __init__(
        self, board: Board, description: Description, silent_seconds: float | None = None
    ) -> None:
        self._board, self._description = board, description
        self._silent_seconds = silent_seconds or board.silent_seconds
        self._bytes_per_second = board.bytes_per_second or link_bytes_per_second(description)

    def __enter__(self) -> Talk:
        return self

    def __exit__(self, *error: object) -> None:
        self._board.close()

    def open(self) -> None:
        """Open the way to the board, and check that it has the node of the description."""
        self._came: dict[int, list[bytes]] = defaultdict(list)
        self._before = Counter(self._board.counters)
        try:
            self._board.open()
        except BoardError as error:
            raise TalkError(str(error)) from None
        self._session = Session(
            self._description,
            self._board.frame_bytes,
            time.monotonic(),
            # The clock is set, which shows a restart. Nobody reads it.
            sample_seconds=float("inf"),
            # What it says besides answers is no sign of life here.
            silent_seconds=float("inf"),
            repeat_seconds=self._board.repeat_seconds,
        )
        self._ask(lambda: self._session.is_ready)

    def read(self, numbers: Iterable[int]) -> dict[int, int]:
        """Read registers; return their values by their numbers."""
        wanted = list(numbers)
        self._session.read(wanted, time.monotonic())
        self._ask(lambda: self._session.has_read)
        values = self._session.values
        for number in wanted:
            if number not in values:
                raise TalkError(f"{self._board.name}: the board refuses to read register {number}")
        return {number: values[number] for number in wanted}

    def exchange(
        self, loop: tuple[Topic, Topic], packets: Sequence[bytes], comes_back: Sequence[bool]
    ) -> list[bytes]:
        """Send packets to a subscription, and return what its publication sends.

        No more packets are under way than the memories of the node have room for.

        * `comes_back`: whether an answer is expected, for each packet; that of the last one is.

        Fewer packets than expected come back if nothing came for too long, and more can come.
        """
        came, back = loop
        window = _Window(self._description, loop)
        got: list[bytes] = []
        wanted, at, heard = sum(comes_back), 0, time.monotonic()
        while len(got) < wanted:
            while at < len(packets) and window.has_room(packets[at]):
                self._send(self._session.frames(NodeMessage(topic=came.id, packet=packets[at])))
                window.add(packets[at], comes_back[at])
                at += 1
            # There and back.
            end = heard + self._silent_seconds + 2 * window.bytes / self._bytes_per_second
            if self._session.may_be_new:
                # Only an answer tells whether packets still come.
                self._ask(lambda: not self._session.may_be_new)
            else:
                self._wait(end)
            if new := self.take(back):
                got += new
                window.remove(len(new))
                heard = time.monotonic()
            elif time.monotonic() >= end:
                break
        return got

    def take(self, topic: Topic) -> list[bytes]:
        """Take the packets of a publication that have come; none is no error."""
        return self._came.pop(topic.id, [])

    def losses(self) -> Counter[str]:
        """Return what was lost between the board and here since the talk was opened, by cause."""
        return +(self._session.lost_on_the_way() + self._board.counters - self._before)

    def _ask(self, is_done: Callable[[], bool]) -> None:
        """Send the requests that are due, until something is known."""
        begin = time.monotonic()
        while not is_done():
            now = time.monotonic()
            end = max(begin, self._session.answered_at) + self._silent_seconds
            if now > end:
                causes = ", ".join(f"{count} {cause}" for cause, count in self.losses().items())
                more = f" (frames: {causes})" if causes else ""
                raise TalkError(
                    f"{self._board.name}: the board does not answer for "
                    f"{self._silent_seconds:g} s{more}"
                )
            if frames := self._session.due(now, time.time_ns()):
                self._send(frames)
            self._wait(min(end, self._session.next_due()))

    def _send(self, frames: Sequence[bytes]) -> None:
        try:
            # What is not taken is like what is lost: no answer comes.
            self._board.send(frames)
        except BoardError as error:
            raise TalkError(str(error)) from None

    def _wait(self, until: float) -> None:
        """Wait until something comes, but not after `until`; keep what comes."""
        try:
            file = self._board.fileno()
            sends = [file] if self._board.waits_to_send else []
            left = max(0.0, until - time.monotonic())
            _, writable, _ = select.select([file], sends, [], left)
            if writable:
                self._board.flush()
            for frame in self._board.receive():
                for message in self._session.take(frame, time.monotonic(), time.time_ns()):
                    self._came[message.topic].append(message.packet)
        except BoardError as error:
            raise TalkError(str(error)) from None
        except WrongBoardError as error:
            raise TalkError(f"{self._board.name}: {error}") from None
        if self._session.restarts:
            raise TalkError(f"{self._board.name}: the board has started again during the test")


class _Window:
    """The packets that are under way: half of what every memory on their way has room for."""

    def __init__(self, description: Description, loop: tuple[Topic, Topic]) -> None:
        link = description.link
        stores = [store for topic in loop for _, store in topic.stores]
        self._bus_bytes = description.bus_bytes
        self._most_bytes = min(link.memory_bytes, *(each.memory_bytes for each in stores)) // 2
        self._most = max(1, min(link.packets, *(each.packets for each in stores)) // 2)
        self._packets: deque[tuple[int, bool]] = deque()
        self.bytes = 0

    def _size(self, packet: bytes) -> int:
        """Return the memory that a packet takes: whole beats, and its header in the link."""
        return HEADER_BYTES + -(-len(packet) // self._bus_bytes) * self._bus_bytes

    def has_room(self, packet: bytes) -> bool:
        """Whether a packet may be sent; it always may if there is nothing to wait for."""
        if not any(comes_back for _, comes_back in self._packets):
            return True
        fits = self.bytes + self._size(packet) <= self._most_bytes
        return fits and len(self._packets) < self._most

    def add(self, packet: bytes, comes_back: bool) -> None:
        self._packets.append((self._size(packet), comes_back))
        self.bytes += self._size(packet)

    def remove(self, count: int) -> None:
        """Remove packets that came back, and the bad ones before them, which were judged first."""
        while count and self._packets:
            size, comes_back = self._packets.popleft()
            self.bytes -= size
            count -= comes_back
