"""A program that sends and gets the messages of a node."""

from __future__ import annotations

import pytest

from firm_hdl.node.bridge import Client, WrongBoardError
from tests.node.bridge.fakes import ECHO, FakeBoard, FakeNode


def test_a_program_talks_with_a_node():
    with Client(ECHO, FakeBoard()) as node:
        for text in (b"a", b"b"):
            node.send("/heard", text)
        assert [node.receive("/said") for _ in range(2)] == [b"a", b"b"]
        assert node.call("/cal", b"request") == b"request"
        with pytest.raises(TimeoutError, match=r"^no message of '/said' in 0\.01 s$"):
            node.receive("/said", 0.01)
        with pytest.raises(KeyError):
            node.send("/said", b"a")
    assert node.bridge.counters.to_board == {"/heard": 2, "/cal": 1}


def test_errors_of_the_board_reach_the_program():
    with pytest.raises(WrongBoardError), Client(ECHO, FakeBoard(FakeNode(fingerprint=1))):
        pass
    board = FakeBoard()
    board.is_dead = True
    lines = []
    with (
        pytest.raises(TimeoutError, match="the board fake does not answer"),
        Client(ECHO, board, report=lines.append, ready_seconds=0.05),
    ):
        pass
    assert "it is dead" in lines[0]
