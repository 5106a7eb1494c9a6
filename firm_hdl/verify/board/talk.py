"""A talk with a board under test: packets go there and come back, and registers are read.

Every wait has an end: a board that is silent for too long ends the talk, or the exchange of
packets. Time is only used to decide that nothing more comes.
"""

from __future__ import annotations

import random
import select
import time
from collections import Counter, defaultdict, deque
from collections.abc import Iterable, Sequence

from firm_hdl.node import Description, Topic
from firm_hdl.node.boards import Board, BoardError
from firm_hdl.node.control import ControlRequest, ControlResponse, Operation, Result
from firm_hdl.node.description import CONTROL_TOPIC
from firm_hdl.node.frame import FLAG_START, HEADER_BYTES
from firm_hdl.node.messages import MessageReceiver, MessageSender, NodeMessage

__all__ = ["SILENT_SECONDS", "Talk", "TalkError", "room_for"]

SILENT_SECONDS = 5.0
"""A board that says nothing for so long has failed, unless the user names another time."""

REPEAT_SECONDS = 0.25
"""A request without an answer is repeated after so long, and then after twice as long each time."""

MOST_ASKED = 4
"""Requests that are under way at once: a node keeps so many."""


class TalkError(Exception):
    """The board does not answer, or is another one; the text says so."""


class Talk:
    """A talk with a board, which is closed in the end; a context manager.

    Parameters
    ----------
    board : Board
        Not yet open.
    description : Description
        Of the node that the board has to have.
    silent_seconds : float

    Raises
    ------
    TalkError
        From all methods, if the board is gone or silent, has started again, or is another one.
    """

    def __init__(
        self, board: Board, description: Description, silent_seconds: float = SILENT_SECONDS
    ) -> None:
        self._board, self._description = board, description
        self._silent_seconds = silent_seconds
        self._bytes_per_second = board.bytes_per_second
        if self._bytes_per_second is None and description.link.kind == "uart":
            self._bytes_per_second = description.link.baud / 10
        self._tag = random.getrandbits(32)
        self._begin()

    def _begin(self) -> None:
        self._sender = MessageSender(self._board.frame_bytes)
        self._receiver = MessageReceiver()
        self._answers: deque[NodeMessage] = deque()
        self._came: dict[int, list[bytes]] = defaultdict(list)
        self._is_heard = False
        self._before = Counter(self._board.counters)

    def __enter__(self) -> Talk:
        return self

    def __exit__(self, *error: object) -> None:
        self._board.close()

    def open(self) -> None:
        """Open the way to the board, and check that it has the node of the description."""
        self._begin()
        try:
            self._board.open()
        except BoardError as error:
            raise TalkError(str(error)) from None
        # Until the board has answered, each request begins a sequence: the first may be lost.
        low, high = self._read((1, 2), begins=True).values()
        wanted = self._description.fingerprint
        if (found := low | high << 32) != wanted:
            raise TalkError(
                f"{self._board.name}: the board's fingerprint is {found:016x}, and that of the "
                f"description is {wanted:016x}: its node is another one"
            )

    def read(self, numbers: Iterable[int]) -> dict[int, int]:
        """Read registers; return their values by their numbers."""
        return self._read(tuple(numbers), begins=False)

    def exchange(
        self, loop: tuple[Topic, Topic], packets: Sequence[bytes], comes_back: Sequence[bool]
    ) -> list[bytes]:
        """Send packets to a subscription, and return what its publication sends.

        No more packets are under way than the memories of the node have room for.

        Parameters
        ----------
        loop : subscription and publication
        packets : sequence of bytes
        comes_back : sequence of bool
            Whether an answer is expected, for each packet; that of the last one is.

        Returns
        -------
        list of bytes
            Fewer packets than expected if nothing came for too long. More than expected can come.
        """
        came, back = loop
        window = _Window(self._description, loop)
        got: list[bytes] = []
        wanted, at, heard = sum(comes_back), 0, time.monotonic()
        while len(got) < wanted:
            while at < len(packets) and window.has_room(packets[at]):
                self._send(NodeMessage(topic=came.id, packet=packets[at]))
                window.add(packets[at], comes_back[at])
                at += 1
            end = heard + self._patience(window.bytes)
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
        counters = self._receiver.counters
        names = ("lost", "late", "cut", "stray", "malformed", "large")
        found = Counter({name: getattr(counters, name) for name in names})
        return +(found + self._board.counters - self._before)

    def _read(self, numbers: Sequence[int], *, begins: bool) -> dict[int, int]:
        left, values = deque(numbers), dict[int, int]()
        asked: dict[int, int] = {}
        # By register: when it is asked for again, and how long after that.
        again: dict[int, tuple[float, float]] = {}
        heard = time.monotonic()
        while len(values) < len(set(numbers)):
            now = time.monotonic()
            # What is repeated comes first: nothing new is asked before it is answered.
            left.extendleft(each for each, (due, _) in again.items() if due <= now)
            while left and (left[0] in again or len(again) < MOST_ASKED):
                number = left.popleft()
                wait = 2 * again[number][1] if number in again else REPEAT_SECONDS
                again[number] = (now + wait, wait)
                asked[self._ask(number, begins=begins)] = number
            self._wait(min(due for due, _ in again.values()))
            if not self._answers and now > heard + self._patience(HEADER_BYTES * MOST_ASKED):
                raise TalkError(self._silence())
            while self._answers:
                message = self._answers.popleft()
                number = asked.get(message.tag, -1)
                if number in again:
                    values[number] = self._value(number, message)
                    del again[number]
                    heard = time.monotonic()
        return {number: values[number] for number in numbers}

    def _ask(self, number: int, *, begins: bool) -> int:
        """Ask for a register; return the tag of the request."""
        if begins:
            self._sender = MessageSender(self._board.frame_bytes)
        self._tag = (self._tag + 1) & 0xFFFF_FFFF
        request = ControlRequest(operation=Operation.READ, argument=number)
        self._send(NodeMessage(topic=CONTROL_TOPIC, packet=request.encode(), tag=self._tag))
        return self._tag

    def _value(self, number: int, message: NodeMessage) -> int:
        try:
            response = ControlResponse.decode(message.packet)
        except ValueError as error:
            raise TalkError(f"{self._board.name}: {error}") from None
        if response.operation != Operation.READ or response.result != Result.OK:
            raise TalkError(f"{self._board.name}: the board refuses to read register {number}")
        return response.value

    def _send(self, message: NodeMessage) -> None:
        try:
            # A frame that was not taken is like one that is lost: no answer comes.
            self._board.send(self._sender.frames(message))
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
            frames = self._board.receive()
        except BoardError as error:
            raise TalkError(str(error)) from None
        for frame in frames:
            self._keep(frame)

    def _keep(self, frame: bytes) -> None:
        begins = len(frame) >= HEADER_BYTES and bool(frame[1] & FLAG_START)
        message = self._receiver.take(frame)
        if message is None:
            return
        if begins and self._is_heard:
            raise TalkError(f"{self._board.name}: the board has started again during the test")
        self._is_heard = True
        if message.topic == CONTROL_TOPIC:
            self._answers.append(message)
        else:
            self._came[message.topic].append(message.packet)

    def _patience(self, byte_count: int) -> float:
        """Return how long the board may be silent while so many bytes are under way."""
        rate = self._bytes_per_second
        # There and back.
        return self._silent_seconds + (2 * byte_count / rate if rate else 0.0)

    def _silence(self) -> str:
        """Say that the board does not answer, and what came instead."""
        causes = ", ".join(f"{count} {cause}" for cause, count in self.losses().items())
        more = f" (frames: {causes})" if causes else ""
        return f"{self._board.name}: the board does not answer for {self._silent_seconds:g} s{more}"


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


def room_for(description: Description, loop: tuple[Topic, Topic]) -> int:
    """Return the size of the largest packet that passes every memory on the way, in bytes."""
    most = min(store.memory_bytes for topic in loop for _, store in topic.stores)
    link = description.link
    return most if link.kind == "stream" else min(most, link.memory_bytes - HEADER_BYTES)
