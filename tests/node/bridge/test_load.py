"""Messages that the way to a board cannot carry: too large, or too many."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.node.bridge.counters import Load
from tests.node.bridge.fakes import CAL, HEARD, LINE, SAID, FakeBoard, bridge_of, run_until


@pytest.mark.parametrize(("link_bytes", "most"), [(4096, 1024), (256, 240)])
def test_a_message_larger_than_the_memory_is_said_once_and_counted(link_bytes, most):
    description = replace(LINE, link=replace(LINE.link, memory_bytes=link_bytes))
    made, said = bridge_of(description=description)
    graph = made.graph
    assert run_until(made, lambda: graph.opened)
    for size in (most, most + 1, 5000):
        graph.say(HEARD, bytes(size))
    graph.on_message(CAL, bytes(most + 1), "caller")
    try:
        assert run_until(made, lambda: graph.got and graph.abandoned)
    finally:
        made.close()
    assert graph.got == [("/said", bytes(most))] and graph.abandoned == ["caller"]
    assert [line for line in said if "bytes" in line] == [
        f"graph fake: a message of {name} has {most + 1} bytes, and the memory on the board has "
        f"room for {room}; larger ones are dropped"
        for name, room in (("/heard", most), ("/cal", min(most, 256)))
    ]
    large = {name: n for (name, cause), n in made.counters.dropped.items() if cause == "too large"}
    assert large == {"/heard": 2, "/cal": 1}


def test_a_load_is_compared_with_the_link_in_each_direction():
    # A header, a CRC and the marks of a frame take 23 bytes.
    load = Load(LINE, 1000.0)
    assert not list(load.judge(10.0))
    for _ in range(9):
        load.add("in", HEARD, bytes(200))
        load.add("out", SAID, bytes(176))
    assert not list(load.judge(11.9))
    (line,) = load.judge(12.0)
    assert line.startswith("messages for the board have 1,004 bytes/s, most of them of /heard, ")
    for _ in range(10):
        load.add("in", HEARD, bytes(200))
        load.add("out", SAID, bytes(176))
    (line,) = load.judge(14.0)
    assert line.startswith("messages of the board have 995 bytes/s, most of them of /said, ")
    for _ in range(100):
        load.add("in", HEARD, bytes(200))
        load.add("out", SAID, bytes(200))
    assert not list(load.judge(16.0))


def test_a_bridge_says_that_a_line_is_too_slow():
    board = FakeBoard()
    board.bytes_per_second = 100.0
    made, said = bridge_of(board, description=LINE)
    assert run_until(made, lambda: made.graph.opened)

    def is_said():
        made.graph.say(HEARD, bytes(200))
        return len([line for line in said if "bytes/s" in line]) == 2

    try:
        assert run_until(made, is_said)
    finally:
        made.close()
    assert any(line.startswith("board fake: messages for the board have ") for line in said)
    assert any(line.startswith("board fake: messages of the board have ") for line in said)
