"""Messages for a board that has no room."""

from __future__ import annotations

import time

from firm_hdl.node.bridge import bridge
from tests.node.bridge.fakes import HEARD, FakeBoard, FakeGraph, bridge_of, run_until


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
