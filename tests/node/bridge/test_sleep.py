"""How long a bridge sleeps when nothing comes: until something is due, in a time of its own."""

from __future__ import annotations

import pytest

from firm_hdl.node.boards import Board
from firm_hdl.node.boards.simulated import SimulatedBoard
from tests.node.bridge.clocks import Sleeper
from tests.node.bridge.fakes import HEARD


@pytest.fixture
def sleeper(monkeypatch):
    made = Sleeper(monkeypatch)
    yield made
    made.bridge.close()


def test_half_a_second_at_most_and_never_after_the_end(sleeper):
    assert sleeper.sleep() == 0.5
    assert sleeper.sleep(end=sleeper.now + 0.01) == 0.01


def test_until_the_clocks_are_compared(sleeper):
    sleeper.board.sample_seconds = 0.3
    assert sleeper.sleep() == 0.3
    assert sleeper.sleep(0.2) == 0.1
    assert sleeper.sleep(0.1) == 0.3


def test_how_long_a_board_may_say_nothing_is_its_own(sleeper):
    sleeper.board.silent_seconds = 2.0
    sleeper.board.node.is_mute = True
    sleeper.sleep()
    sleeper.sleep(1.9)
    assert sleeper.said == []
    sleeper.sleep(0.2)
    assert sleeper.said == ["board fake: no answer for 2 s; trying again"]
    # An answer of a simulation on a busy machine may take longer than that of a board.
    assert (Board.silent_seconds, SimulatedBoard.silent_seconds) == (5.0, 60.0)


def test_until_a_board_that_is_gone_is_tried_again(sleeper):
    sleeper.board.is_dead = True
    assert sleeper.sleep() == 0.2
    assert sleeper.sleep(0.15) == 0.05
    assert sleeper.sleep(0.05) == 0.4


def test_until_a_graph_that_is_gone_is_tried_again(sleeper):
    sleeper.graph.is_dead = True
    assert sleeper.sleep() == 0.2
    assert sleeper.sleep(0.15) == 0.05
    assert sleeper.sleep(0.05) == 0.4
    sleeper.graph.is_dead = False
    assert sleeper.sleep(0.4) == 0.5


def test_until_the_board_or_the_graph_is_due_whichever_is_first(sleeper):
    sleeper.board.sample_seconds = 1.5
    assert sleeper.sleep() == 0.5
    sleeper.graph.is_dead = True
    # It is asked each second how it is. The clocks are compared 0.5 s later.
    assert sleeper.sleep(1.0) == 0.2
    assert sleeper.sleep(0.2) == 0.3
    assert sleeper.sleep(0.3) == 0.1
    assert sleeper.sleep(0.1) == 0.5


def test_until_the_oldest_message_has_waited_for_too_long(sleeper):
    sleeper.board.is_dead = True
    sleeper.sleep()
    sleeper.bridge.on_message(HEARD, b"1", None)
    assert sleeper.sleep(0.1) == 0.1
    # The board is tried again in 0.4 s, and the message is dropped in 0.05 s.
    assert sleeper.sleep(0.1) == 0.05
    assert sleeper.sleep(0.051) == 0.349
    assert sleeper.bridge.counters.dropped == {("/heard", "no board"): 1}


def test_a_moment_while_a_message_waits_for_room(sleeper):
    sleeper.sleep()
    sleeper.board.has_room = False
    sleeper.graph.say(HEARD, b"1")
    assert sleeper.sleep() == 0.005
    sleeper.board.has_room = True
    assert sleeper.sleep(0.005) == 0.5 and sleeper.graph.got == [("/said", b"1")]


def test_not_at_all_while_a_message_can_be_sent(sleeper):
    sleeper.sleep()
    sleeper.graph.say(HEARD, *[b"1"] * 1000)
    sleeper.now += 0.001
    sleeper.bridge.step()
    assert sleeper.slept[-1] == 0.0
    sleeper.sleep()
    assert len(sleeper.graph.got) == 1000
