"""The bridge between a board and a graph, both fakes: what passes, what is dropped."""

from __future__ import annotations

import contextlib
import threading
import time
from pathlib import Path

import pytest

from firm_hdl.errors import UserError
from firm_hdl.node.bridge import WrongBoardError, bridge
from firm_hdl.node.bridge.command import account, status_line
from firm_hdl.node.bridge.counters import CAUSES
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
    assert not made.counters.dropped and not made.side.on_the_way
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
    run_until(made, lambda: made.side.restarts > 1)
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
    assert run_until(made, lambda: made.side.is_ready)
    graph.say(HEARD, b"y")
    assert run_until(made, lambda: graph.got == [("/said", b"y")])
    assert made.side.restarts > 0


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
    assert run_until(made, lambda: made.side.is_ready)
    graph.say(HEARD, b"new")
    assert run_until(made, lambda: graph.got[10:] == [("/said", b"new")])


def test_a_board_that_starts_again_gets_what_comes_meanwhile(running, board, graph):
    made, said = running
    board.node = FakeNode()
    board.come(board.node.sender.frames(NodeMessage(topic=2, packet=b"first")))
    assert run_until(made, lambda: said[-1:] == ["board fake: it has started again; ready"])
    graph.say(HEARD, *packets(20))
    assert run_until(made, lambda: len(graph.got) == 21)
    assert [packet for _, packet in graph.got] == [b"first", *packets(20)]
    assert not made.counters.dropped


@pytest.fixture
def asked_often(board):
    """Let the bridge compare the clocks often, so that messages are soon confirmed."""
    board.sample_seconds = 0.02


def die(board):
    board.is_dead = True


def start_again(board):
    board.node = FakeNode()
    board.come(board.node.sender.frames(NodeMessage(topic=2, packet=b"first")))


@pytest.mark.parametrize("end", [die, start_again])
def test_what_a_board_took_with_it_is_named(asked_often, running, board, graph, end):
    made, _ = running
    graph.say(HEARD, *packets(10))
    assert run_until(made, lambda: len(graph.got) == 10)
    # These are confirmed after a while. What the accelerator keeps is not.
    assert run_until(made, lambda: not len(made.side.session.unconfirmed))
    board.node.holds = True
    graph.say(HEARD, *packets(5))
    assert run_until(made, lambda: len(board.node.held) == 5)
    end(board)
    assert run_until(made, lambda: made.side.restarts == 1)
    assert made.counters.dropped == {("/heard", "board lost"): 5}
    assert "dropped: 5 of /heard: board lost" in account(made)
    # A message that was sent is named once, and one of the next board is not among them.
    board.is_dead = False
    assert run_until(made, lambda: made.side.is_ready)
    graph.say(HEARD, b"new")
    made.run(seconds=0.05)
    assert made.counters.dropped == {("/heard", "board lost"): 5}


def test_a_board_that_falls_silent_may_have_lost_all_since(asked_often, running, board, graph):
    made, said = running
    graph.say(HEARD, b"x")
    assert run_until(made, lambda: graph.got and not len(made.side.session.unconfirmed))
    board.node.is_mute = True
    graph.say(HEARD, *packets(8))
    assert run_until(made, lambda: made.counters.to_board["/heard"] == 9)
    made.side.session._heard -= 60
    assert run_until(made, lambda: made.side.restarts == 1), said
    assert made.counters.dropped == {("/heard", "board lost"): 8}


def test_counters_of_a_dead_board_stay_in_the_account(running, board):
    made, _ = running
    assert run_until(made, lambda: made.side.drops())
    board.is_dead = True
    assert run_until(made, lambda: made.side.restarts == 1)
    board.node, board.is_dead = FakeNode(), False
    board.node.values = {17: 2}
    made.run(seconds=0.5)
    assert [value for _, value in made.side.drops()] == [9]


def test_the_end_names_the_last_drops_of_a_working_board(running, board, graph):
    made, _ = running
    assert run_until(made, lambda: made.side.drops())
    threading.Timer(0.05, made.stop).start()
    graph.say(HEARD, *packets(50))
    # It is seconds until the next round of counters.
    board.node.values = {17: 8}
    made.run()
    assert [value for _, value in made.side.drops()] == [8]
    assert len(graph.got) == 50 and not made.counters.dropped
    assert not [line for line in account(made) if "counters" in line]


def test_the_end_of_a_board_that_answers_no_more(running, board, graph, monkeypatch):
    """The twin: without a last answer, nobody knows, and the account says so."""
    monkeypatch.setattr(board, "end_seconds", 0.1)
    made, _ = running
    board.node.is_mute = True
    graph.say(HEARD, *packets(50))
    assert run_until(made, lambda: made.counters.to_board["/heard"] == 50)
    made.run(seconds=0.01)
    assert made.counters.dropped == {("/heard", "unconfirmed"): 50}
    assert "not all counters on the board could be read at the end" in account(made)


def test_a_board_that_is_lost_at_the_end_is_not_tried_again(running, board, graph):
    made, said = running
    graph.say(HEARD, *packets(5))
    assert run_until(made, lambda: len(graph.got) == 5)
    made.stop()
    made.side.finish = lambda finish=made.side.finish: (finish(), die(board))
    made.run()
    assert said[-1] == "board fake: it is dead" and board.opened == 1
    assert made.counters.dropped == {("/heard", "board lost"): 5}


def test_ctrl_c_ends_the_end(running, board):
    made, _ = running

    def interrupt():
        raise KeyboardInterrupt

    made.stop()
    made.side.finish = interrupt
    with pytest.raises(KeyboardInterrupt):
        made.run()
    assert made.side.session is None and made._wake_receiver.fileno() < 0


def test_what_waits_at_the_end_is_named(board, graph):
    """Also requests, which are given up; what comes after `stop` is for nobody."""
    made, _ = bridge_of(board, graph)
    assert run_until(made, lambda: graph.opened)
    board.is_dead = True
    assert run_until(made, lambda: made.side.restarts == 1)
    graph.say(HEARD, b"x")
    graph.on_message(CAL, b"", "early")
    made.close()
    assert made.counters.dropped == {("/heard", "bridge ended"): 1, ("/cal", "bridge ended"): 1}
    assert graph.abandoned == ["early"]


def test_what_comes_after_the_end_is_not_sent(running, board, graph):
    made, _ = running

    def finish():
        finish_side()
        graph.say(HEARD, b"late")
        graph.on_message(CAL, b"", "late")

    finish_side, made.side.finish = made.side.finish, finish
    made.stop()
    made.run()
    assert graph.got == [] and graph.abandoned == ["late"] and not made.counters.dropped


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
    for topic in range(1000, 1100):
        board.come(board.node.sender.frames(NodeMessage(topic=topic, packet=b"")))
    assert run_until(made, lambda: made.counters.dropped.total() == 102)
    # A line for each would be an account that nobody reads.
    assert len(made.counters.dropped) == 9
    assert made.counters.dropped["other topics", "unknown topic"] == 94


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
    made.side.finish()
    assert run_until(made, lambda: made.side.has_read_last)
    (lost,) = [value for each, value in made.side.drops() if each.name == "lost"]
    # The 7 are those of before.
    assert made.side.on_the_way["lost"] > 0
    assert len(got) + made.side.on_the_way["lost"] + lost - 7 == 200


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
    assert seconds
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
    assert run_until(made, lambda: len(graph.got) == 3 and made.side.drops())
    line = status_line(made, (12.3, 4.0))
    assert line.startswith("echo, ready, to board 12/s, to graph 4/s, dropped 7, round trip ")
    made.counters.drop("/heard", "no board", 4)
    rows = [line.split() for line in account(made)]
    assert ["/heard", "subscribe", "3", "0"] in rows and ["/said", "publish", "0", "3"] in rows
    text = "\n".join(account(made))
    assert "dropped: 4 of /heard: no board" in text
    assert "dropped: 7 on the board, link link: lost" in text
    assert SAID.name in text


def test_all_causes_are_documented():
    text = (Path(__file__).parents[3] / "docs" / "reference" / "node.md").read_text()
    assert [cause for cause in CAUSES if f"`{cause}`" not in text] == []
