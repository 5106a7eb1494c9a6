"""Losses on the way from the board, over several sessions with it."""

from __future__ import annotations

from firm_hdl.node.messages import NodeMessage
from tests.node.bridge.fakes import FakeBoard, FakeGraph, FakeNode, bridge_of, run_until


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
        assert run_until(made, lambda count=count: made.restarts == count)
        board.node, board.is_dead = FakeNode(), False
        assert run_until(made, lambda: made.is_ready)
        assert made.restarts == count
    made.close()
    assert made.restarts == 4
