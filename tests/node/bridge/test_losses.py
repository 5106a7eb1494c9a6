"""Losses with the board and on the way from it, over several sessions with it."""

from __future__ import annotations

import pytest

from firm_hdl.node.messages import NodeMessage
from tests.node.bridge.fakes import CAL, FakeBoard, FakeGraph, FakeNode, bridge_of, run_until


def test_losses_on_the_way_add_up_over_all_sessions():
    board = FakeBoard()
    made, _ = bridge_of(board, FakeGraph())
    assert run_until(made, lambda: made.is_ready)
    for session in range(1, 4):
        first, _, _, last = (
            board.node.sender.frames(NodeMessage(topic=2, packet=b"%d" % number))
            for number in range(4)
        )
        board.come(first + last)
        assert run_until(made, lambda lost=2 * session: made.on_the_way["lost"] == lost)
        board.is_dead = True
        assert run_until(made, lambda restarts=session: made.restarts == restarts)
        board.node, board.is_dead = FakeNode(), False
        assert run_until(made, lambda: made.is_ready)
    assert made.on_the_way == {"lost": 6}
    made.close()


def test_restarts_add_up_over_all_sessions():
    board = FakeBoard()
    made, _ = bridge_of(board, FakeGraph())
    assert run_until(made, lambda: made.is_ready)
    for count in (2, 4):
        # It starts again while the way to it stays open, and is then gone with the way.
        board.node = FakeNode()
        board.come(board.node.sender.frames(NodeMessage(topic=2, packet=b"a")))
        assert run_until(made, lambda count=count: made.restarts == count - 1)
        assert run_until(made, lambda: made.is_ready)
        board.is_dead = True
        assert run_until(made, lambda: not made.is_ready)
        assert made.restarts == count
        board.node, board.is_dead = FakeNode(), False
        assert run_until(made, lambda: made.is_ready)
        assert made.restarts == count
    made.close()
    assert made.restarts == 4


def test_what_waits_of_a_board_that_is_never_known_is_lost_with_it():
    board, graph = FakeBoard(), FakeGraph()
    board.node.is_mute = True
    made, _ = bridge_of(board, graph)
    assert run_until(made, lambda: board.opened)
    for packet in (b"a", b"b"):
        board.come(board.node.sender.frames(NodeMessage(topic=2, packet=packet)))
    assert run_until(made, lambda: not board.coming)
    assert not made.on_the_way
    board.is_dead = True
    assert run_until(made, lambda: made.restarts == 1)
    assert made.on_the_way == {"held back": 2} and not graph.opened
    made.close()


@pytest.mark.parametrize("dies", [False, True])
def test_a_request_is_answered_or_lost_once(dies):
    board, graph = FakeBoard(), FakeGraph()
    made, _ = bridge_of(board, graph)
    assert run_until(made, lambda: graph.opened)
    graph.on_message(CAL, b"1", "first")
    assert run_until(made, lambda: graph.answers == [("first", b"1")])
    board.node.answers_no_calls = True
    graph.on_message(CAL, b"2", "second")
    assert run_until(made, lambda: made.counters.to_board["/cal"] == 2)
    assert not made.counters.dropped
    if dies:
        board.is_dead = True
    else:
        board.node = FakeNode()
        board.come(board.node.sender.frames(NodeMessage(topic=2, packet=b"a")))
    assert run_until(made, lambda: made.restarts == 1)
    # Its response would have confirmed the second request; that is no further loss.
    assert made.counters.dropped == {("/cal", "unanswered"): 1}
    assert graph.abandoned == ["second"]
    made.close()
