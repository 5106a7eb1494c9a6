"""The board of a bridge: it is opened, filled, flushed, lost and tried again."""

from __future__ import annotations

import pytest

from firm_hdl.node.boards import BoardError
from firm_hdl.node.bridge.boardside import BoardSide
from firm_hdl.node.bridge.counters import BridgeCounters
from firm_hdl.node.messages import NodeMessage
from tests.node.bridge.clocks import Sleeper
from tests.node.bridge.fakes import CAL, ECHO, HEARD, SAID, FakeBoard, FakeNode


class Board(FakeBoard):
    """A board that may refuse messages, hold bytes, and have no file."""

    refuses = is_filed_away = waits_to_send = False

    def __init__(self):
        super().__init__()
        self.flushed = 0

    def send(self, frames):
        return not self.refuses and super().send(frames)

    def flush(self):
        self.flushed += 1

    def fileno(self):
        if self.is_filed_away:
            raise BoardError("it has no file")
        return super().fileno()


@pytest.fixture
def board():
    made = Board()
    yield made
    made.close()


class Side(BoardSide):
    """The side of a board, with what it reports, and how often it says that calls are lost."""

    def __init__(self, board):
        self.said, self.lost, self.drops_of = [], 0, BridgeCounters()
        super().__init__(ECHO, board, self.drops_of, self.said.append, self._note)

    def _note(self):
        self.lost += 1

    def get_ready(self):
        for _ in range(4):
            self.care(1e9)
            list(self.receive())
        assert self.is_ready
        return self


def test_what_a_board_refuses_is_dropped_and_not_waited_for(board):
    side = Side(board).get_ready()
    board.refuses = True
    assert side.send(HEARD, b"x") == "board full"
    assert not len(side.session.unconfirmed)
    board.refuses, board.has_room = False, False
    assert side.send(HEARD, b"x") == "board full" and not side.has_room
    board.has_room = True
    assert side.send(HEARD, b"x") is None and side.has_room
    assert side.send(CAL, b"x", 7) is None
    # A request is confirmed by its response.
    assert len(side.session.unconfirmed) == 1
    board.is_dead = True
    assert side.send(HEARD, b"x") == side.send(HEARD, b"x") == "no board"
    assert side.drops_of.dropped == {("/heard", "board lost"): 1} and side.lost == 1


def test_a_board_that_is_not_known_has_no_room(board):
    side = Side(board)
    assert not side.has_room and side.send(HEARD, b"x") == "no board"
    side.care(0.0)
    assert side.was_tried and not side.has_room and side.send(HEARD, b"x") == "no board"


def test_a_clock_that_is_far_off_is_reported_once(board):
    board.has_real_time = True
    side, now = Side(board), [1_700_000_000 * 10**9]
    side._clock = lambda: now[0]
    board.sample_seconds = 0.0
    for _ in range(60):
        now[0] += 2 * 10**9
        board.node.seconds += 1
        side.care(1e9)
        list(side.receive())
    (line,) = (line for line in side.said if "clock" in line)
    assert line.startswith("board fake: its clock is -") and " MHz in place of 100; " in line


def test_what_waits_is_sent_when_the_board_can_be_written_to(board):
    side = Side(board).get_ready()
    assert side.files() == ([board.fileno()], []) and board.flushed == 0
    board.waits_to_send = True
    assert side.files() == ([board.fileno()], [board.fileno()])
    list(side.receive())
    assert board.flushed == 1
    board.is_filed_away = True
    assert side.files() == ([], []) and side.session is None
    assert side.said[-1] == "board fake: it has no file; trying again"


def test_what_the_way_lost_is_part_of_what_was_lost(board):
    side = Side(board).get_ready()
    assert side.on_the_way == {}
    board.counters["damaged"] += 3
    board.come([b"no frame"])
    list(side.receive())
    assert side.on_the_way == {"damaged": 3, "malformed": 1}
    side.lose("gone")
    assert side.on_the_way == {"damaged": 3, "malformed": 1}


def test_a_board_is_being_opened_only_while_it_is(board):
    side, seen = Side(board), []
    opens = board.open

    def note():
        seen.append(side.is_opening)
        opens()

    board.open = note
    assert not side.is_opening and not side.was_tried
    board.is_dead = True
    side.care(1e9)
    assert seen == [True] and not side.is_opening and side.was_tried
    board.is_dead = False
    side.care(2e9)
    assert seen == [True, True] and not side.is_opening and side.session is not None


def test_reasons_and_pauses_begin_anew_with_a_board_that_was_ready(monkeypatch):
    sleeper = Sleeper(monkeypatch)
    said = []
    for _ in range(3):
        sleeper.sleep()
        assert sleeper.bridge.side.is_ready
        sleeper.board.is_dead = True
        sleeper.board.come([])
        # It is tried again after 0.2 s, and then after 0.4 s.
        assert sleeper.sleep() == 0.2
        assert sleeper.sleep(0.2) == 0.4
        said += ["board fake: ready", "board fake: it is dead; trying again"]
        assert [line for line in sleeper.said if "board" in line] == said
        sleeper.board.is_dead = False
        sleeper.now += 2.0
    sleeper.bridge.close()


def test_figures_of_a_board_that_is_gone_are_those_of_its_last_session(board):
    side = Side(board)
    assert side.drops() == [] and side.restarts == 0
    side.get_ready()
    # With the request that goes before the first one that the link believes.
    side.session.values[17] = 4
    side.lose("gone")
    assert [value for _, value in side.drops()] == [3] and side.restarts == 1
    side.lose(None)
    # It was closed on purpose.
    assert side.restarts == 1 and len(side.said) == 2


def test_messages_behind_one_that_ends_the_session_are_for_nobody(board):
    side = Side(board).get_ready()
    frames = [board.node.sender.frames(NodeMessage(topic=SAID.id, packet=b"x")) for _ in range(2)]
    board.come([*frames[0], *frames[1]])
    found = []
    for message in side.receive():
        found.append(message)
        side.lose("gone")
    assert len(found) == 1


@pytest.mark.parametrize("is_gone", [False, True])
def test_a_board_that_starts_again_all_the_time_is_reported_now_and_then(monkeypatch, is_gone):
    sleeper = Sleeper(monkeypatch)
    sleeper.sleep()
    begin, before = sleeper.now, len(sleeper.said)
    while sleeper.now < begin + 20:
        sleeper.board.node = FakeNode()
        if is_gone:
            sleeper.board.is_dead = True
            list(sleeper.bridge.side.receive())
            sleeper.board.is_dead = False
        elif sleeper.bridge.side.is_ready:
            frames = sleeper.board.node.sender.frames(NodeMessage(topic=SAID.id, packet=b"x"))
            sleeper.board.come(frames)
        sleeper.now += 0.2
        for _ in range(6):
            sleeper.bridge.side.care(sleeper.now)
            list(sleeper.bridge.side.receive())
    assert sleeper.bridge.side.restarts > 10
    assert 5 < len(sleeper.said) - before <= 22
    sleeper.bridge.close()
