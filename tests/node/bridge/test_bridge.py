"""The bridge between a board and a graph, both fakes: what passes, what is dropped."""

from __future__ import annotations

import contextlib
import threading
import time

import pytest

from firm_hdl.errors import UserError
from firm_hdl.node.bridge import WrongBoardError, bridge
from firm_hdl.node.bridge.status import account, status_line
from firm_hdl.node.messages import NodeMessage
from tests.node.bridge.fakes import (
    CAL,
    HEARD,
    SAID,
    FakeBoard,
    FakeGraph,
    FakeNode,
    bridge_of,
    run_until,
)


@pytest.fixture
def board():
    return FakeBoard()


@pytest.fixture
def graph():
    return FakeGraph()


@pytest.fixture
def running(board, graph):
    """A bridge that has joined both sides, and its lines."""
    made, said = bridge_of(board, graph)
    assert run_until(made, lambda: graph.opened)
    yield made, said
    made.close()


def packets(count):
    return [b"%d" % n * (n % 40) for n in range(count)]


def test_messages_pass_in_order_both_ways(running, graph):
    made, said = running
    graph.say(HEARD, *packets(600))
    assert run_until(made, lambda: len(graph.got) == 600)
    assert graph.got == [("/said", packet) for packet in packets(600)]
    assert made.counters.to_board["/heard"] == made.counters.to_graph["/said"] == 600
    assert not made.counters.dropped and not made.on_the_way
    assert said == ["board fake: ready", "graph fake: joined"]


def test_each_response_goes_to_its_caller(running, graph):
    made, _ = running
    for number in range(50):
        graph.on_message(CAL, b"%d" % number, number)
    assert run_until(made, lambda: len(graph.answers) == 50)
    assert graph.answers == [(number, b"%d" % number) for number in range(50)]


def test_messages_of_another_thread_wake_the_bridge(running, graph):
    made, _ = running
    threading.Timer(0.05, lambda: graph.say(HEARD, b"x")).start()
    begin = time.monotonic()
    while not graph.got and time.monotonic() < begin + 20:
        made.step()
    assert graph.got


def test_the_graph_is_joined_when_the_board_has_answered(board, graph):
    board.is_dead = True
    made, said = bridge_of(board, graph)
    run_until(made, lambda: made.restarts > 1)
    # The same reason is said once.
    assert not graph.opened and said == ["board fake: it is dead; trying again"]
    board.is_dead = False
    assert run_until(made, lambda: graph.opened)
    made.close()


def test_another_board_is_an_error_at_first(graph):
    made, _ = bridge_of(FakeBoard(FakeNode(fingerprint=1)), graph)
    with pytest.raises(WrongBoardError):
        made.run(seconds=20)
    assert not graph.opened


def test_a_board_that_becomes_another_one_gets_nothing(running, board, graph):
    made, said = running
    board.node = FakeNode(fingerprint=1)
    board.come(board.node.sender.frames(NodeMessage(topic=2, packet=b"wrong")))
    assert run_until(made, lambda: "fingerprint" in said[-1])
    graph.say(HEARD, b"x")
    run_until(made, lambda: made.counters.dropped)
    assert graph.got == [] and made.counters.dropped == {("/heard", "no board"): 1}
    board.node = FakeNode()
    assert run_until(made, lambda: made.is_ready)
    graph.say(HEARD, b"y")
    assert run_until(made, lambda: graph.got == [("/said", b"y")])
    assert made.restarts > 0


def test_a_board_that_dies_and_comes_back(running, board, graph):
    made, said = running
    graph.say(HEARD, *packets(10))
    assert run_until(made, lambda: len(graph.got) == 10)
    graph.on_message(CAL, b"", "early")
    board.node.answers_no_calls = True
    made.step(time.monotonic())
    board.is_dead = True
    assert run_until(made, lambda: "it is dead" in said[-1])
    assert graph.abandoned == ["early"] or graph.answers == [("early", b"")]
    graph.say(HEARD, *packets(5))
    assert run_until(made, lambda: made.counters.dropped["/heard", "no board"] == 5)
    board.node, board.is_dead = FakeNode(), False
    assert run_until(made, lambda: made.is_ready)
    graph.say(HEARD, b"new")
    assert run_until(made, lambda: graph.got[10:] == [("/said", b"new")])


def test_a_board_that_starts_again_gets_what_comes_meanwhile(running, board, graph):
    made, said = running
    board.node = FakeNode()
    board.come(board.node.sender.frames(NodeMessage(topic=2, packet=b"first")))
    assert run_until(
        made, lambda: said[-2:] == ["board fake: it has started again", "board fake: ready"]
    )
    graph.say(HEARD, *packets(20))
    assert run_until(made, lambda: len(graph.got) == 21)
    assert [packet for _, packet in graph.got] == [b"first", *packets(20)]
    assert not made.counters.dropped


def test_requests_without_an_answer_are_given_up(running, board, graph, monkeypatch):
    made, _ = running
    board.node.answers_no_calls = True
    monkeypatch.setattr(bridge, "CALL_SECONDS", 0.05)
    graph.on_message(CAL, b"", "me")
    assert run_until(made, lambda: graph.abandoned == ["me"])
    assert made.counters.dropped == {("/cal", "unanswered"): 1}
    # A response that comes too late is for nobody.
    board.come(board.node.sender.frames(NodeMessage(topic=4, packet=b"", tag=1)))
    assert run_until(made, lambda: made.counters.dropped["/cal", "unknown call"] == 1)
    assert graph.answers == []


def test_a_graph_that_goes_and_comes_back(running, board, graph):
    made, said = running
    graph.is_dead = True
    board.come(board.node.sender.frames(NodeMessage(topic=2, packet=b"lost")))
    assert run_until(made, lambda: "graph fake: it is dead; trying again" in said)
    assert made.counters.dropped == {("/said", "no graph"): 1}
    graph.is_dead = False
    assert run_until(made, lambda: graph.opened == 2)
    graph.say(HEARD, b"x")
    assert run_until(made, lambda: graph.got == [("/said", b"x")])


def test_what_the_graph_does_not_take_is_counted(running, graph):
    made, _ = running
    graph.is_full = True
    graph.say(HEARD, b"x")
    assert run_until(made, lambda: made.counters.dropped == {("/said", "graph full"): 1})


def test_topics_that_a_board_must_not_send_are_counted(running, board):
    made, _ = running
    for topic in (1, 9):
        board.come(board.node.sender.frames(NodeMessage(topic=topic, packet=b"")))
    assert run_until(made, lambda: len(made.counters.dropped) == 2)
    assert made.counters.dropped == {("1", "unknown topic"): 1, ("9", "unknown topic"): 1}


def test_lost_frames_are_counted_and_nothing_wrong_is_passed(running, board, graph):
    made, _ = running
    # One of the frames of each 10th message, in both directions.
    counter = iter(range(10**9))
    board.loses = lambda frame: frame[2] in (1, 2) and next(counter) % 10 == 9
    sent = [b"%d" % n * 200 for n in range(200)]
    graph.say(HEARD, *sent)
    assert run_until(made, lambda: made.counters.to_board["/heard"] == 200)
    run_until(made, lambda: False, 0.1)
    got = [packet for _, packet in graph.got]
    assert 0 < len(got) < 200 and got == [packet for packet in sent if packet in set(got)]
    board.loses = lambda frame: False
    graph.say(HEARD, b"end")
    assert run_until(made, lambda: graph.got[-1][1] == b"end")
    passed = board.node.receiver.counters.passed
    assert made.on_the_way["lost"] > 0
    assert len(got) + made.on_the_way["lost"] + board.node.receiver.counters.lost == 200, passed


def test_memory_is_bounded(running, graph, monkeypatch):
    made, _ = running
    monkeypatch.setattr(made._queue, "_max_bytes", 100)
    graph.say(HEARD, b"x" * 60, b"y" * 60, b"z" * 40)
    assert run_until(made, lambda: len(graph.got) == 2)
    assert made.counters.dropped == {("/heard", "queue full"): 1}


def test_run_ends_after_a_time_and_when_it_is_stopped(board, graph):
    made, _ = bridge_of(board, graph)
    seconds = []
    made.run(seconds=0.05, each_second=lambda: seconds.append(1))
    assert graph.opened and seconds
    made, _ = bridge_of(FakeBoard(), FakeGraph())
    threading.Timer(0.1, made.stop).start()
    made.run(seconds=60)


@pytest.mark.parametrize("is_stopped", [False, True])
def test_a_compiler_that_ctrl_c_ends_is_no_mistake(board, is_stopped):
    made, _ = bridge_of(board)

    def fail():
        if is_stopped:
            made.stop()
        raise UserError("the compiler failed")

    board.open = fail
    with contextlib.nullcontext() if is_stopped else pytest.raises(UserError):
        made.run()


def test_people_can_read_how_it_does(running, board, graph):
    made, _ = running
    graph.say(HEARD, *packets(3))
    assert run_until(made, lambda: len(graph.got) == 3 and made.last_drops)
    line = status_line(made, (12.3, 4.0))
    assert line.startswith("echo, ready, to board 12/s, to graph 4/s, dropped 7, round trip ")
    made.counters.drop("/heard", "no board", 4)
    rows = [line.split() for line in account(made)]
    assert ["/heard", "subscribe", "3", "0"] in rows and ["/said", "publish", "0", "3"] in rows
    text = "\n".join(account(made))
    assert "dropped: 4 of /heard: no board" in text
    assert "dropped: 7 on the board, link link: lost" in text
    assert SAID.name in text
