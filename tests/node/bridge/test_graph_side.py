"""The graph of a bridge: it is joined, looked after, lost and left, in a time of its own."""

from __future__ import annotations

import select

import pytest

from firm_hdl.node.bridge.waiting import Calls, Waiting
from firm_hdl.node.messages import NodeMessage
from tests.node.bridge.clocks import Sleeper
from tests.node.bridge.fakes import CAL, HEARD


class Timed(Sleeper):
    """A bridge that has joined both sides, and waits; `run` lets time pass."""

    def __init__(self, monkeypatch):
        super().__init__(monkeypatch)
        self.sleep()
        assert self.graph.opened == 1
        self.board.sample_seconds = 1.0

    def run(self, **options):
        """Run the bridge to its end; return how long this took, and when each second began."""
        begin, seconds = self.now, []

        def each_second():
            seconds.append(self.now - begin)
            assert len(seconds) < 60, "it does not end"

        self.passes = True
        self.bridge.run(each_second=each_second, **options)
        return self.now - begin, seconds

    def come(self, topic, packet=b"", tag=0):
        message = NodeMessage(topic=topic, packet=packet, tag=tag)
        self.board.come(self.board.node.sender.frames(message))
        self.bridge.step()

    @property
    def dropped(self):
        return self.bridge.counters.dropped

    @property
    def is_woken(self):
        return bool(select.select([self.bridge._wake_receiver], [], [], 0)[0])


@pytest.fixture
def timed(monkeypatch):
    made = Timed(monkeypatch)
    yield made
    made.bridge.close()


def test_a_graph_is_looked_after_once_a_second(timed):
    checked = timed.graph.checked
    took, seconds = timed.run(seconds=4.5)
    assert took == pytest.approx(4.5, abs=0.2)
    assert seconds == pytest.approx([0, 1, 2, 3, 4], abs=0.2)
    assert 4 <= timed.graph.checked - checked <= 5
    assert timed.graph.closed == 1


def test_a_graph_that_is_gone_is_noticed_without_a_message(timed):
    timed.graph.is_dead = True
    timed.now += 1.0
    timed.bridge.step()
    assert timed.said[-1] == "graph fake: it is dead; trying again"
    assert timed.graph.closed == 1
    timed.graph.is_dead = False
    timed.come(2, b"early")
    assert timed.dropped == {("/said", "no graph"): 1} and timed.graph.got == []
    # It is tried again after 0.2 s, and so is the next time that it goes.
    for opened in (2, 3):
        timed.now += 0.199
        timed.bridge.step()
        assert timed.graph.opened == opened - 1
        timed.now += 0.002
        timed.bridge.step()
        assert timed.graph.opened == opened
        assert timed.said[-1] == "graph fake: joined"
        timed.graph.is_dead = True
        timed.come(2, b"lost")
        assert timed.said[-1] == "graph fake: it is dead; trying again"
        assert timed.graph.closed == opened
        timed.graph.is_dead = False
    assert timed.dropped == {("/said", "no graph"): 3} and timed.bridge.side.restarts == 0


def test_requests_of_a_graph_that_is_gone_are_given_up(timed):
    timed.board.node.answers_no_calls = True
    for caller in ("first", "second"):
        timed.graph.on_message(CAL, b"", caller)
    timed.now += 0.5
    timed.bridge.step()
    assert timed.bridge.counters.to_board["/cal"] == 2 and not timed.dropped
    timed.graph.is_dead = True
    timed.now += 1.0
    timed.bridge.step()
    assert timed.dropped == {("/cal", "unanswered"): 2}
    assert timed.graph.abandoned == ["first", "second"]
    # Their responses are for nobody.
    timed.come(4, tag=1)
    assert timed.dropped["/cal", "unknown call"] == 1


def test_a_response_without_a_tag_is_for_nobody(timed):
    timed.come(4)
    assert timed.dropped == {("/cal", "unknown call"): 1} and timed.graph.answers == []


def test_requests_that_find_no_board_are_given_up(timed):
    timed.board.is_dead = True
    timed.bridge.step()
    timed.graph.on_message(CAL, b"", "me")
    timed.graph.say(HEARD, b"")
    timed.now += 0.251
    timed.bridge.step()
    assert timed.dropped == {("/cal", "no board"): 1, ("/heard", "no board"): 1}
    assert timed.graph.abandoned == ["me"]
    # The graph is looked after meanwhile.
    checked = timed.graph.checked
    timed.now += 1.0
    timed.bridge.step()
    assert timed.graph.checked == checked + 1 and timed.bridge.side.was_ready
    assert not timed.bridge.side.is_ready


def test_requests_at_the_board_are_limited(timed):
    timed.bridge._calls = Calls(2)
    timed.board.node.answers_no_calls = True
    for caller in range(3):
        timed.graph.on_message(CAL, b"", caller)
    timed.now += 0.001
    timed.bridge.step()
    assert timed.dropped == {("/cal", "queue full"): 1} and timed.graph.abandoned == [2]
    assert timed.bridge.counters.to_board["/cal"] == 2
    # Messages are sent all the same.
    timed.graph.say(HEARD, b"")
    timed.now += 0.001
    timed.bridge.step()
    assert (
        timed.bridge.counters.to_board["/heard"] == 1
        and ("/heard", "queue full") not in timed.dropped
    )


def test_the_bridge_is_woken_once_by_what_comes(timed):
    timed.graph.say(HEARD, b"1", b"2")
    assert timed.is_woken
    timed.bridge.step()
    assert not timed.is_woken
    timed.bridge.stop()
    assert timed.is_woken


# The end.


def test_a_graph_that_has_ended_ends_the_bridge_a_moment_later(timed):
    timed.graph.has_ended = True
    took, _ = timed.run()
    assert took == pytest.approx(1.0, abs=0.2)


def test_the_bridge_ends_in_time_if_its_graph_ends_shortly_before(timed):
    timed.graph.has_ended = True
    took, _ = timed.run(seconds=0.3)
    assert took == pytest.approx(0.3, abs=0.2)


def test_requests_of_a_graph_that_has_ended_are_waited_for(timed):
    timed.graph.has_ended = timed.board.node.answers_no_calls = True
    timed.graph.on_message(CAL, b"", "me")
    # They are given up after 10 s.
    took, _ = timed.run()
    assert took == pytest.approx(11.0, abs=0.2)
    assert timed.graph.abandoned == ["me"] and timed.dropped == {("/cal", "unanswered"): 1}


def test_messages_of_a_graph_that_has_ended_wait_for_room(timed):
    timed.graph.has_ended = True
    timed.board.has_room = False
    timed.graph.say(HEARD, b"x")
    took, _ = timed.run()
    # It is given up after 0.25 s, which the bridge may notice half a second later.
    assert 1.25 <= took < 1.9
    assert timed.dropped == {("/heard", "board full"): 1}


def test_what_waits_for_room_at_the_end_is_sent_and_then_the_board_is_asked(timed):
    timed.board.has_room = False
    timed.graph.say(HEARD, b"x")
    timed.now += 0.001
    timed.bridge.stop()
    receive, begin = timed.board.receive, timed.now

    def receive_and_make_room():
        timed.board.has_room = timed.now >= begin + 0.1
        return receive()

    timed.board.receive = receive_and_make_room
    took, _ = timed.run()
    assert 0.1 < took < 0.3
    assert timed.graph.got == [("/said", b"x")] and timed.bridge.side.has_read_last


def test_the_board_is_asked_although_later_messages_wait(timed):
    timed.bridge.stop()
    timed.bridge._queue.put(Waiting(HEARD, b"late", None, timed.now + 5.0))
    took, _ = timed.run()
    assert took < 0.2 and timed.bridge.side.has_read_last
    assert timed.graph.got == [] and not timed.dropped
