"""Messages to frames and back, on the host.

A message is one packet with its topic and its tag. A sender cuts what is too large for a frame. A
receiver puts fragments together, in any order, with bounded memory, and counts all that it drops.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields

from firm_hdl.node.frame import (
    FRAGMENT_UNIT,
    HEADER_BYTES,
    LATE_MESSAGES,
    FrameError,
    Header,
    decode_header,
    encode_header,
)

__all__ = ["MessageReceiver", "MessageSender", "NodeMessage", "distance"]

_SEQUENCES = 1 << 16


@dataclass(frozen=True, slots=True, kw_only=True)
class NodeMessage:
    """A packet on its way between host and node."""

    topic: int  # Id of the topic.
    packet: bytes  # The serialized message.
    tag: int = 0  # Of a request or a response; else 0.


def distance(sequence: int, expected: int) -> int:
    """Return how many messages lie between two numbers; negative if the number is before.

    >>> distance(2, 65535), distance(65535, 2)
    (3, -3)
    """
    return (sequence - expected + _SEQUENCES // 2) % _SEQUENCES - _SEQUENCES // 2


class MessageSender:
    """Write messages as frames.

    * `frame_bytes`: most bytes of a frame, header included: 16 and a multiple of 16. `None`: no
      limit.
    * `sequence`: number of the first message.
    * `starts`: whether the first message says that the sequence begins.
    """

    def __init__(
        self, frame_bytes: int | None = None, *, sequence: int = 0, starts: bool = True
    ) -> None:
        if frame_bytes is not None and (
            frame_bytes <= HEADER_BYTES or (frame_bytes - HEADER_BYTES) % FRAGMENT_UNIT
        ):
            raise ValueError(
                f"Frame size must be {HEADER_BYTES} and a multiple of {FRAGMENT_UNIT} bytes, not "
                f"{frame_bytes}"
            )
        self._room = None if frame_bytes is None else frame_bytes - HEADER_BYTES
        self._sequence, self._starts = sequence % _SEQUENCES, starts

    def frames(self, message: NodeMessage) -> list[bytes]:
        """Return the frames of the next message, in order.

        Raises `ValueError` if the message needs more than 65,536 frames, or a number does not fit.
        """
        packet = message.packet
        room = self._room or max(1, len(packet))
        starts = range(0, max(1, len(packet)), room)
        frames = [
            encode_header(
                Header(
                    topic=message.topic,
                    length=len(packet),
                    tag=message.tag,
                    sequence=self._sequence,
                    fragment=number,
                    last=at == starts[-1],
                    start=self._starts,
                )
            )
            + packet[at : at + room]
            for number, at in enumerate(starts)
        ]
        self._sequence, self._starts = (self._sequence + 1) % _SEQUENCES, False
        return frames


@dataclass(slots=True)
class FrameCounters:
    """What a receiver did with frames and messages."""

    passed: int = 0  # Messages that arrived whole.
    # Messages that did not, by the gaps between the numbers of those that did. All others below say
    # why; none of them is a further loss.
    lost: int = 0
    # Messages that were dropped because a later one had passed, or the same one before, or because
    # their number is far from what is expected.
    late: int = 0
    # Messages that were dropped because a fragment was missing, or their length was wrong.
    cut: int = 0
    stray: int = 0  # Frames that were dropped because they belong to no message that is under way.
    # Frames that were dropped because their header was missing or of another version.
    malformed: int = 0
    large: int = 0  # Messages that were dropped because they are larger than the limit.

    def add(self, other: FrameCounters) -> None:
        """Add what another receiver did."""
        for each in fields(self):
            setattr(self, each.name, getattr(self, each.name) + getattr(other, each.name))


@dataclass(slots=True)
class _Assembly:
    """The fragments of a message that have come."""

    header: Header
    parts: dict[int, bytes] = field(default_factory=dict)
    size: int = 0
    frames: int | None = None

    def add(self, header: Header, payload: bytes) -> bool:
        """Add a fragment; return whether it fits those before it."""
        first = self.header
        if (header.topic, header.tag, header.length) != (first.topic, first.tag, first.length):
            return False
        if header.fragment in self.parts:
            return True
        self.size += len(payload)
        self.parts[header.fragment] = payload
        if header.last:
            if self.frames not in (None, header.fragment + 1):
                return False
            self.frames = header.fragment + 1
        # An empty fragment brings nothing, and there could be any number of them.
        is_empty = not payload and not (header.last and header.fragment == 0)
        return not is_empty and self.size <= first.length

    @property
    def is_complete(self) -> bool:
        return self.frames is not None and self.parts.keys() == set(range(self.frames))

    def packet(self) -> bytes:
        return b"".join(self.parts[number] for number in sorted(self.parts))


class MessageReceiver:
    """Read frames, and put messages together.

    * `max_bytes`: largest message.
    * `max_open`: most messages that are under way at once; then the oldest one is cut. A sender
      sends one after the other, so more than one only happens if the network changes the order.
    * `most_late`: how many numbers before the expected one are late. What is further back may be a
      sender that has started again.
    """

    def __init__(
        self,
        *,
        max_bytes: int = 1 << 26,
        max_open: int = 4,
        most_late: int = LATE_MESSAGES,
    ) -> None:
        self._max_bytes, self._max_open, self._most_late = max_bytes, max_open, most_late
        self._open: dict[int, _Assembly] = {}
        self.expected: int | None = None  # Number of the next message, once one has come.
        # The number that would confirm a message whose number was far from the expected one.
        self._confirms: int | None = None
        # What the last number that was more than 64 ahead has added to `counters.lost`. It is no
        # loss if the sender had started again. Who knows that it had not sets this to 0.
        self.jumped = 0
        self.counters = FrameCounters()

    def take(self, frame: bytes) -> NodeMessage | None:
        """Take a frame; return the message that it completes."""
        try:
            header = decode_header(frame)
        except FrameError:
            self.counters.malformed += 1
            return None
        if header.length > self._max_bytes:
            self.counters.large += header.fragment == 0
            self.counters.stray += header.fragment != 0
            return None
        if self._is_late(header):
            self.counters.late += header.last
            return None
        assembly = self._assembly(header)
        if not assembly.add(header, frame[HEADER_BYTES:]):
            self._cut(header.sequence)
            return None
        if not assembly.is_complete:
            return None
        if assembly.size != header.length:
            self._cut(header.sequence)
            return None
        del self._open[header.sequence]
        if not self._passes(assembly.header):
            self.counters.late += 1
            return None
        return NodeMessage(topic=header.topic, packet=assembly.packet(), tag=header.tag)

    def go_back(self, sequence: int) -> None:
        """Expect a number again, as one of those that have passed since was damaged."""
        assert self.expected is not None
        self.counters.lost += distance(sequence, self.expected)
        self.expected = sequence

    def doubt(self) -> None:
        """Do not believe a number that is far away, although the next one may follow."""
        self._confirms = None

    def take_back(self) -> None:
        """Count no gap for the last jump: the sender had started again."""
        self.counters.lost -= self.jumped
        self.jumped = 0

    def _ahead(self, header: Header) -> int:
        """Return how many messages are missing before one; negative if it is late."""
        if self.expected is None or header.start:
            return 0
        return distance(header.sequence, self.expected)

    def _is_late(self, header: Header) -> bool:
        is_behind = -self._most_late <= self._ahead(header) < 0
        return is_behind and header.sequence != self._confirms

    def _assembly(self, header: Header) -> _Assembly:
        """Return the message of a frame; begin it if need be, and cut the oldest if too many."""
        if header.sequence not in self._open:
            while len(self._open) >= self._max_open:
                self._cut(next(iter(self._open)))
            self._open[header.sequence] = _Assembly(header)
        return self._open[header.sequence]

    def _cut(self, sequence: int) -> None:
        del self._open[sequence]
        self.counters.cut += 1

    def _passes(self, header: Header) -> bool:
        """Count a message that is whole, and those before it that are not, if it is believed.

        A number that is far from the expected one may be damaged; the next message shows it, as in
        RFC 3550, A.1.
        """
        ahead, following = self._ahead(header), (header.sequence + 1) % _SEQUENCES
        if not 0 <= ahead <= LATE_MESSAGES and header.sequence != self._confirms:
            self._confirms = following
            return False
        # Behind is a new sequence. Of that, only the message that was not believed is missing.
        if ahead > LATE_MESSAGES:
            self.jumped = ahead - 1
        self.counters.lost += ahead if ahead >= 0 else 1
        self.counters.passed += 1
        self.expected, self._confirms = following, None
        for sequence in [s for s, each in self._open.items() if self._is_late(each.header)]:
            self._cut(sequence)
        return True
