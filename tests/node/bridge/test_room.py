"""Messages for a board that has no room, or takes no more at all."""

from __future__ import annotations

import socket
import time

import pytest

from firm_hdl.node.boards import BoardError, board_of
from firm_hdl.node.boards.bytestreams import ByteBoard
from firm_hdl.node.bridge import bridge
from tests.node.bridge.fakes import HEARD, LINE, FakeBoard, FakeGraph, bridge_of, run_until


def test_messages_wait_for_room_for_a_moment():
    board, graph = FakeBoard(), FakeGraph()
    made, _ = bridge_of(board, graph)
    assert run_until(made, lambda: graph.opened)
    board.has_room = False
    graph.say(HEARD, b"0", b"1")
    assert not run_until(made, lambda: graph.got, bridge.HOLD_SECONDS / 2)
    board.has_room = True
    assert run_until(made, lambda: len(graph.got) == 2)
    assert not made.counters.dropped
    # The twin: the room comes too late, and the old messages give way to new ones.
    board.has_room = False
    begin = time.monotonic()
    graph.say(HEARD, b"2", b"3")
    assert run_until(made, lambda: made.counters.dropped.total() == 2)
    assert time.monotonic() - begin >= bridge.HOLD_SECONDS
    graph.say(HEARD, b"4")
    board.has_room = True
    assert run_until(made, lambda: len(graph.got) == 3)
    assert made.counters.dropped == {("/heard", "board full"): 2}
    made.close()


def test_one_message_always_has_room():
    """Even on a line so slow that nothing may wait."""

    class Line(ByteBoard):
        def _open(self):
            raise NotImplementedError

    board = Line("line", 0)
    assert board.has_room and not board.waits_to_send
    board._waiting += b"x"
    assert not board.has_room and board.waits_to_send


def test_a_connection_that_is_reset_takes_no_more():
    with socket.create_server(("127.0.0.1", 0)) as server:
        name = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        board = board_of(name, LINE)
        board.open()
        server.accept()[0].close()
        # The first bytes are answered with a reset, from which on the system takes no more.
        with pytest.raises(BoardError, match=f"^{name}: (Connection reset by peer|Broken pipe)$"):
            for _ in range(1000):
                board.send([b"x"])
        board.close()
    for use in (board.fileno, board.receive, lambda: board.send([b"x"])):
        with pytest.raises(BoardError, match=f"^{name} is closed$"):
            use()
