"""What a host says to a board, without sockets, threads and clocks: time is an argument.

A session begins when a way to a board is open. First, the board has to answer with the fingerprint
of the description; no message passes before. Then the clock of the node is kept in step, and its
counters are read. One request of control is under way at any time; its answer also shows that the
board is there. Whether it has started again, :mod:`.arrivals` finds out; what was lost,
:mod:`.losses`.
"""

from __future__ import annotations

import random
from collections import Counter, deque
from collections.abc import Iterable
from dataclasses import asdict, replace

from firm_hdl.node.bridge.arrivals import MOST_HELD, Arrivals, Asked
from firm_hdl.node.bridge.losses import PASS_SECONDS, LostRequests, Unconfirmed
from firm_hdl.node.control import (
    ControlRequest,
    ControlResponse,
    Operation,
    Register,
    Result,
    is_loss,
    nominal_rate,
    registers,
)
from firm_hdl.node.description import CONTROL_TOPIC, Description
from firm_hdl.node.frame import HEADER_BYTES, FrameError, decode_header
from firm_hdl.node.messages import MessageSender, NodeMessage
from firm_hdl.node.timekeeping import ClockKeeper

__all__ = ["ROUND_SECONDS", "Session", "SilentBoardError", "WrongBoardError"]

HURRY_SECONDS = 0.05
"""A request is repeated after so long where the network says that nobody gets it: messages wait for
the board meanwhile."""

ROUND_SECONDS = 5.0
"""All counters of a board are read in turn; a round begins so often."""

_SHORT_SECONDS = 0.02
_MOST_ASKED = 64
_LATENCIES = 64

_SETTLED = 0x8100
"""The number of the first message that does not say that a sequence begins; those that do have 0.
If one of these comes again later, the others seem to be behind, so that the board counts no gap. It
believes such a number when the next one follows, so two requests are sent."""


class WrongBoardError(Exception):
    """The board has another description than the host; the text says so."""


class SilentBoardError(Exception):
    """The board does not answer."""


class Session:
    """The talk with a board that is open.

    * `frame_bytes`: most bytes of a frame, header included; as of the board.
    * `now`: seconds of a clock that never jumps.
    * `sample_seconds`: how often the clocks are compared.
    * `silent_seconds`: a board from which nothing whole came for so long is gone.
    * `repeat_seconds`: a request without an answer is repeated after so long.
    * `before`: the last session with the same board. Its counters and the sequence of messages go
      on, or are kept and begin anew if the board has started again since.
    """

    def __init__(
        self,
        description: Description,
        frame_bytes: int | None,
        now: float,
        *,
        sample_seconds: float = 1.0,
        silent_seconds: float = 5.0,
        repeat_seconds: float = 0.25,
        before: Session | None = None,
    ) -> None:
        self._description, self._frame_bytes = description, frame_bytes
        self._sample_seconds, self._silent_seconds = sample_seconds, silent_seconds
        self._repeat_seconds = repeat_seconds
        self._counters = [each for each in registers(description) if each.part != "identity"]
        number = {(each.part, each.name): each.number for each in self._counters}
        self._lost_register = number["link", "lost"]
        self._requests_register = number["node", "control"]
        self._keeper = ClockKeeper(nominal_rate(description.clock_hz))
        self._sender = MessageSender(frame_bytes)
        self._arrivals: Arrivals = Arrivals(before._arrivals.receiver if before else None)
        self._control: LostRequests = before._control if before else LostRequests()
        # Answers that were lost before the board started again.
        self._past_back: int = before._past_back if before else 0
        # What was lost counts from when the board is known.
        self._lost_before = self._arrivals.receiver.counters.lost
        self._lost_asked = self._settled_at = self._asks_from = 0
        self._tag = random.getrandbits(32)
        self._asked: dict[int, Asked] = {}
        self._held: deque[NodeMessage] = deque()
        self._latencies: deque[float] = deque(maxlen=_LATENCIES)
        # When a request was answered last as it should be.
        self._heard = self._waits_until = self.answered_at = now
        self._is_set: bool = before is not None and before._is_set
        self._is_unanswered = self._is_finishing = self._is_settled = False
        # Until when the last messages may still be in the node.
        self._passes_until = now
        self._next_sample = self._next_round = now
        self._todo: deque[ControlRequest] = deque()
        # Of the clock; a newer one takes its place, because the time of an older one has passed.
        self._clock_request: ControlRequest | None = None
        self._identity: dict[int, int] = {}
        # Registers by their numbers, as they were read last since the board started.
        self.values: dict[int, int] = dict(before.values) if before else {}
        # Counters of a board before it started again.
        self._past: Counter[int] = Counter(before._past) if before else Counter()
        self.unconfirmed = Unconfirmed()  # Messages for the board. Who sends them notes them there.
        self.is_ready = False  # The board is the right one; messages may pass.
        self.restarts = 0  # How often the board has started again.
        # Messages of the board that were dropped because it was not known to be the right one.
        self.held_back: int = before.held_back if before else 0

    # To the board.

    def frames(self, message: NodeMessage) -> list[bytes]:
        """Return the frames of a message, which are sent at once; see :class:`MessageSender`."""
        return self._sender.frames(message)

    def due(self, now: float, wall_ns: int) -> list[bytes]:
        """Return the frames of the request that is due, if there is one.

        * `wall_ns`: time of the host in ns since the epoch.

        Raises `SilentBoardError` if the board has not answered for `silent_seconds`.
        """
        if now - self._heard > self._silent_seconds:
            raise SilentBoardError(f"no answer for {self._silent_seconds:g} s")
        if now < self._waits_until:
            return []
        request, is_sample = self._next(now)
        if request is None:
            return []
        pause = self._repeat_seconds
        if self._is_finishing:
            # There is little time for many counters, of which a bad link loses some.
            pause = min(pause, max(_SHORT_SECONDS, 4 * (self.latency or pause)))
        self._waits_until = now + pause
        self._is_unanswered = True
        asked = Asked(request, now, wall_ns, is_sample, 0, self._arrivals.receiver.expected)
        if self.is_ready:
            return self._ask(asked)
        if request.argument != self._requests_register:
            # The first message says that a sequence begins. It may have been lost.
            self._sender, self._is_settled = MessageSender(self._frame_bytes), False
            return self._ask(asked)
        if not self._is_settled:
            self._is_settled = True
            self._sender = MessageSender(self._frame_bytes, sequence=_SETTLED, starts=False)
            self._settled_at = self._control.asked + 1
        return self._ask(asked) + self._ask(asked)

    def _ask(self, asked: Asked) -> list[bytes]:
        """Return the frames of a request, and keep it in mind."""
        self._tag = (self._tag + 1) & 0xFFFF_FFFF
        self._control.asked += 1
        self._asked[self._tag] = replace(asked, number=self._control.asked)
        while len(self._asked) > _MOST_ASKED:
            del self._asked[next(iter(self._asked))]
        packet = asked.request.encode()
        return self.frames(NodeMessage(topic=CONTROL_TOPIC, packet=packet, tag=self._tag))

    def hurry(self, now: float) -> None:
        """Let requests be due soon, which find out whether the board is there again."""
        self._next_sample = min(self._next_sample, now)
        self._waits_until = min(self._waits_until, now + HURRY_SECONDS)

    def next_due(self) -> float:
        """Return when :meth:`due` should be called next, if nothing comes."""
        if not self.is_ready or self._todo or self._clock_request or self._is_unanswered:
            return self._waits_until
        return max(self._waits_until, min(self._next_sample, self._next_round))

    def _next(self, now: float) -> tuple[ControlRequest | None, bool]:
        """Return the next request, and whether its answer compares the clocks."""
        if not self.is_ready:
            # The two halves of the fingerprint; see `IDENTITY`.
            unknown = {1, 2} - self._identity.keys()
            return _read(min(unknown, default=self._requests_register)), False
        if self._is_finishing:
            return (self._todo[0] if self._todo else None), False
        if self._clock_request is not None:
            request, self._clock_request = self._clock_request, None
            return request, False
        if now >= self._next_sample or self._is_unanswered:
            # Every answer has the time of the node, whatever was asked for.
            self._next_sample = now + self._sample_seconds
            return _read(0), True
        if now >= self._next_round and not self._todo:
            self._next_round = now + ROUND_SECONDS
            self._todo.extend(_read(each.number) for each in self._counters)
        return (self._todo[0] if self._todo else None), False

    @property
    def may_be_new(self) -> bool:
        """Whether a frame has said that the board has started again, which is not known yet."""
        return self._arrivals.may_be_new

    # The end.

    def finish(self, now: float) -> None:
        """Let what is due be a last round: of all counters of losses, and of nothing else.

        A first answer shows that all messages have arrived. `PASS_SECONDS` later they have passed,
        and the counters are final. The answer to the first of them confirms all messages.
        """
        self._is_finishing = True
        losses = [each.number for each in self._counters if is_loss(each)]
        losses.remove(self._lost_register)
        self.read([0, *losses, self._lost_register, self._requests_register], now)

    def read(self, numbers: Iterable[int], now: float) -> None:
        """Let the next requests read some registers, in place of all counters in turn.

        No answer to a request of before counts. :attr:`has_read` tells when the values are there.
        """
        self._todo = deque(map(_read, numbers))
        self._asks_from = self._control.asked
        self._waits_until = now

    @property
    def has_read(self) -> bool:
        """Whether all requests of :meth:`read` were answered."""
        return self.is_ready and not self._todo

    def _read_lost(self) -> None:
        """Read what the link has lost, and then which part of this were requests."""
        self._todo.extend(map(_read, (self._lost_register, self._requests_register)))

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

        Raises `WrongBoardError` if the board has another description.
        """
        arrivals, suspected_at = self._arrivals, self._arrivals.suspected_at
        try:
            header = decode_header(frame)
        except FrameError:
            header = None
        if header is not None and header.topic == CONTROL_TOPIC and header.tag in self._asked:
            asked = self._asked[header.tag]
            first = arrivals.judge(asked, header, frame[HEADER_BYTES:], now, is_set=self._is_set)
            if first is not None:
                self._begin_again(now)
                for each in first:
                    self._hold(each)
        message = arrivals.take(frame, header, now)
        if arrivals.suspected_at != suspected_at:
            # An answer shows whether the board has started again.
            self._waits_until = self._next_sample = now
        if message is None:
            return []
        self._heard = now
        self._is_unanswered = False
        if message.topic != CONTROL_TOPIC:
            if self.is_ready:
                return [message]
            self._hold(message)
            return []
        self._control.answered += 1
        # The board has taken a request that came twice.
        self._control.asked += message.tag not in self._asked
        self._answer(message, now, wall_ns)
        if not self.is_ready or not self._held:
            return []
        found, self._held = list(self._held), deque()
        return found

    def _hold(self, message: NodeMessage) -> None:
        self._held.append(message)
        if len(self._held) > MOST_HELD:
            self._held.popleft()
            self.held_back += 1

    def _begin_again(self, now: float) -> None:
        """The board has started again, perhaps with another design."""
        self._identity.clear()
        # Also of the board that a session before has left.
        self._past.update(self.values)
        self._past[self._lost_register] -= self._control.lost_there
        self._past_back += self._control.lost_back
        self._control, self._lost_before = LostRequests(), self._arrivals.receiver.counters.lost
        self._asks_from = 0
        self.values.clear()
        self._is_set = self._is_settled = False
        self._asked.clear()
        self._waits_until = now
        if not self.is_ready:
            return
        self.restarts += 1
        self.is_ready = False
        self._todo.clear()
        self._keeper = ClockKeeper(nominal_rate(self._description.clock_hz))
        self._next_sample = self._next_round = now
        if self._is_finishing:
            # What was read is of before.
            self.finish(now)

    def _answer(self, message: NodeMessage, now: float, wall_ns: int) -> None:
        asked = self._asked.pop(message.tag, None)
        if asked is None or self._arrivals.is_suspected or asked.number <= self._asks_from:
            return
        try:
            response = ControlResponse.decode(message.packet)
        except ValueError:
            return
        if response.operation != asked.request.operation:
            return
        self.answered_at = now
        self._waits_until = max(now, self._passes_until)
        self._latencies.append(now - asked.at)
        self.unconfirmed.answered(asked.at, now)
        if asked.request == _read(self._lost_register):
            self._lost_asked = asked.number
        if self._todo and asked.request == self._todo[0]:
            self._todo.popleft()
            if asked.request.argument == 0:
                # The first request of `finish`: a round reads counters alone.
                self._waits_until = self._passes_until = now + PASS_SECONDS
        self._is_set |= asked.request.operation == Operation.SET_TIME
        if asked.request.operation == Operation.READ:
            if response.result == Result.OK:
                self._keep(asked.request.argument, response.value)
            elif not self.is_ready:
                raise WrongBoardError(
                    f"the board refuses to read register {asked.request.argument}: its node is of "
                    "another version"
                )
            if asked.request.argument == self._requests_register:
                self._note_requests(asked, response.value)
        if asked.is_sample:
            more = self._keeper.sample(asked.wall_ns, response, wall_ns)
            if more is not None:
                self._clock_request = more

    def _keep(self, number: int, value: int) -> None:
        if self.is_ready:
            self.values[number] = value
            return
        self._identity[number] = value
        if not self._identity.keys() >= {1, 2}:
            return
        found = self._identity[1] | self._identity[2] << 32
        if found != self._description.fingerprint:
            self.end()
            raise WrongBoardError(
                f"the board's fingerprint is {found:016x}, and that of the description is "
                f"{self._description.fingerprint:016x}: its node is another one, or an older one"
            )

    def _note_requests(self, asked: Asked, taken: int) -> None:
        """Take how many requests the board has taken; the first time, the board is known."""
        if not self.is_ready:
            if not self._control.is_known:
                self._arrivals.receiver.counters.lost = self._lost_before
            # Unless the board has believed the first one at once, it has counted it as lost.
            self._control.begin(asked.number, taken, int(asked.number > self._settled_at))
            self.is_ready = True
        self._control.note(asked.number, taken)
        if self._is_finishing and not self._todo and asked.number != self._lost_asked + 1:
            # Requests were lost between the two.
            self._read_lost()

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

    @property
    def clock_error(self) -> float | None:
        """Error of the node's clock as a fraction, if it is too large to be corrected."""
        return self._keeper.error

    def lost_on_the_way(self) -> Counter[str]:
        """Return what was lost between the board and here, by cause."""
        counters = asdict(self._arrivals.receiver.counters)
        del counters["passed"]
        lost = max(0, counters["lost"] - self._past_back - self._control.lost_back)
        return Counter(counters | {"lost": lost, "held back": self.held_back})

    def drops(self) -> list[tuple[Register, int]]:
        """Return the losses in the node that are not 0, as they were read last.

        Those that a board had counted before it started again are added.
        """
        found = self._past + Counter(self.values)
        found[self._lost_register] -= self._control.lost_there
        return [
            (each, found[each.number])
            for each in self._counters
            if is_loss(each) and found[each.number] > 0
        ]


def _read(number: int) -> ControlRequest:
    return ControlRequest(operation=Operation.READ, argument=number)
