"""The board of a bridge: it is opened, asked, and opened again when it is gone.

What is lost with a board is named: messages that it does not confirm any more, and its counters,
which start at 0 again.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterator

from firm_hdl.node.boards.board import Board, BoardError
from firm_hdl.node.bridge.counters import BridgeCounters
from firm_hdl.node.bridge.session import Session, SilentBoardError, WrongBoardError
from firm_hdl.node.bridge.waiting import RETRY_SECONDS, Retry
from firm_hdl.node.control import Register
from firm_hdl.node.description import Description, Topic
from firm_hdl.node.messages import NodeMessage

__all__ = ["BoardSide"]

REPORT_SECONDS = 2.0
"""Of a board that is gone and back, or has started again, at most two lines are reported in this
time."""


class BoardSide:
    """A board, the session with it while it is open, and the figures of all sessions.

    * `counters`: gets the messages that were lost with the board.
    * `report`: takes a line of text for people.
    * `on_lost`: called when the board is gone or has started again: it answers no request of
      before.
    * `clock`: returns the time that the node is to have, in ns since the epoch.
    """

    def __init__(
        self,
        description: Description,
        board: Board,
        counters: BridgeCounters,
        report: Callable[[str], None],
        on_lost: Callable[[], None],
        clock: Callable[[], int] = time.time_ns,
    ) -> None:
        self._clock = clock
        self._description, self._board, self._counters = description, board, counters
        self._report, self._on_lost = report, on_lost
        self.session: Session | None = None  # The talk with the board while it is open.
        # The session before, whose counters of the board go on.
        self._before: Session | None = None
        self._restarts = 0
        self._retry = Retry(*RETRY_SECONDS)
        # The board is being opened; this was tried once; it was ready once; all counters of losses
        # were read after `finish`.
        self.is_opening = self.was_tried = self.was_ready = self.has_read_last = False
        self._is_ending = False
        # When a restart may be reported again, and whether the last one was.
        self._report_at, self._is_reported = 0.0, True
        self._reports_clock = board.has_real_time

    # Figures.

    @property
    def is_ready(self) -> bool:
        """Whether the board is there and the right one."""
        return self.session is not None and self.session.is_ready

    @property
    def has_room(self) -> bool:
        """Whether a message can be sent now, and is soon on its way."""
        return self._is_there and self._board.has_room

    @property
    def _is_there(self) -> bool:
        session = self.session
        if session is None or not session.is_ready or session.may_be_new:
            return False
        try:
            return not self._board.is_unreachable
        except BoardError as error:
            self.lose(str(error))
            return False

    @property
    def restarts(self) -> int:
        """How often the board, or the way to it, started again or was gone."""
        return self._restarts + (self.session.restarts if self.session else 0)

    @property
    def on_the_way(self) -> Counter[str]:
        """What was lost between the board and here, in all sessions, and the signs of it."""
        session = self.session or self._before
        lost = session.lost_on_the_way() if session else Counter()
        return +(lost + self._board.counters)

    def drops(self) -> list[tuple[Register, int]]:
        """Return what the node says that it dropped; see :meth:`.Session.drops`."""
        session = self.session or self._before
        return session.drops() if session else []

    # Its life.

    def care(self, now: float) -> None:
        """Open the board if it is time to, and send the request that is due."""
        try:
            if self.session is None:
                if now < self._retry.at:
                    return
                self._open()
            assert self.session is not None
            if self._board.is_unreachable:
                self.session.hurry(now)
            frames = self.session.due(time.monotonic(), self._clock())
            if frames:
                self._board.send(frames)
        except (BoardError, SilentBoardError) as error:
            self.lose(str(error))

    def _open(self) -> None:
        self.was_tried = self.is_opening = True
        try:
            self._board.open()
        finally:
            self.is_opening = False
        self.session = Session(
            self._description,
            self._board.frame_bytes,
            time.monotonic(),
            sample_seconds=self._board.sample_seconds,
            silent_seconds=self._board.silent_seconds,
            repeat_seconds=self._board.repeat_seconds,
            before=self._before,
        )

    def lose(self, why: str | None) -> None:
        """Close the board. With a reason, it is tried again later."""
        session, self.session = self.session, None
        if session is not None:
            session.end()
            self._restarts += session.restarts
            self._before = session
            self._drop_unconfirmed(session, "board lost" if why else "unconfirmed")
        self._board.close()
        self._on_lost()
        if why is not None:
            self._restarts += 1
            now = time.monotonic()
            if self._retry.failed(now, why):
                if self._may_report(now):
                    more = "" if self._is_ending else "; trying again"
                    self._report(f"board {self._board.name}: {why}{more}")
                else:
                    self._retry.forget()

    def _may_report(self, now: float) -> bool:
        """Return whether a restart is reported: a board may start again at any rate."""
        self._is_reported = now >= self._report_at
        if self._is_reported:
            self._report_at = now + REPORT_SECONDS
        return self._is_reported

    def _drop_unconfirmed(self, session: Session, cause: str) -> None:
        for topic, count in session.unconfirmed.take().items():
            self._counters.drop(topic, cause, count)

    def finish(self) -> None:
        """Ask for the last time: whether all has arrived, and for the counters of losses.

        :attr:`has_read_last` tells when this is done.
        """
        self._is_ending = True
        if self.session is not None:
            self.session.finish(time.monotonic())

    # Messages.

    def send(self, topic: Topic, packet: bytes, tag: int = 0) -> str | None:
        """Send a message; return why it was dropped, or `None`; see `CAUSES`."""
        if not self._is_there:
            return "no board"
        session = self.session
        assert session is not None
        if not self._board.has_room:
            return "board full"
        now = time.monotonic()
        message = NodeMessage(topic=topic.id, packet=packet, tag=tag)
        try:
            if not self._board.send(session.frames(message)):
                return "board full"
        except BoardError as error:
            self.lose(str(error))
            return "no board"
        if topic.kind == "subscribe":
            # A request is confirmed by its response.
            session.unconfirmed.sent(topic.name, now)
        return None

    def receive(self) -> Iterator[NodeMessage]:
        """Yield the messages that have come; send what waits.

        Raises
        ------
        WrongBoardError
            If the board has another description, at the first time that it answers.
        """
        if self.session is None:
            return
        try:
            for frame in self._board.receive():
                yield from self._take(frame)
            if self._board.waits_to_send:
                self._board.flush()
        except BoardError as error:
            self.lose(str(error))
        except WrongBoardError as error:
            if not self.was_ready:
                raise
            self.lose(str(error))

    def _take(self, frame: bytes) -> list[NodeMessage]:
        session = self.session
        if session is None:
            return []
        was_ready, restarts = session.is_ready, session.restarts
        now = time.monotonic()
        messages = session.take(frame, now, self._clock())
        if session.restarts > restarts:
            self._drop_unconfirmed(session, "board lost")
            self._on_lost()
        if session.is_ready and not was_ready:
            self.was_ready = True
            self._retry.worked()
            again = "it has started again; " if session.restarts else ""
            if self._may_report(now) if again else self._is_reported:
                self._report(f"board {self._board.name}: {again}ready")
        if self._reports_clock and (error := session.clock_error) is not None:
            self._reports_clock = False
            mhz = self._description.clock_hz / 1e6
            self._report(
                f"board {self._board.name}: its clock is {100 * error:+.2g} % off, which is "
                f"{mhz * (1 + error):.4g} MHz in place of {mhz:g}; its time jumps again and again"
            )
        self.has_read_last = session.is_finished
        return messages

    # Waiting.

    def files(self) -> tuple[list[int], list[int]]:
        """Return the file descriptors to wait for: those to read, and those to write."""
        if self.session is None:
            return [], []
        try:
            own = self._board.fileno()
        except BoardError as error:
            self.lose(str(error))
            return [], []
        return [own], [own] if self._board.waits_to_send else []

    def next_due(self) -> float:
        """Return when :meth:`care` has something to do."""
        return self.session.next_due() if self.session else self._retry.at
