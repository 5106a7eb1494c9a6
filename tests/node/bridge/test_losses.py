"""Losses with the board and on the way from it, over several sessions with it."""

from __future__ import annotations

import random

import pytest

from firm_hdl.node.bridge.session import Session
from firm_hdl.node.messages import NodeMessage
from tests.node.bridge.fakes import (
    CAL,
    ECHO,
    FakeBoard,
    FakeGraph,
    FakeNode,
    bridge_of,
    run_until,
)


def test_losses_on_the_way_add_up_over_all_sessions():
    board = FakeBoard()
    made, _ = bridge_of(board, FakeGraph())
    assert run_until(made, lambda: made.side.is_ready)
    for session in range(1, 4):
        first, _, _, last = (
            board.node.sender.frames(NodeMessage(topic=2, packet=b"%d" % number))
            for number in range(4)
        )
        board.come(first + last)
        assert run_until(made, lambda lost=2 * session: made.side.on_the_way["lost"] == lost)
        board.is_dead = True
        assert run_until(made, lambda restarts=session: made.side.restarts == restarts)
        board.node, board.is_dead = FakeNode(), False
        assert run_until(made, lambda: made.side.is_ready)
    assert made.side.on_the_way == {"lost": 6}
    made.close()


def test_restarts_add_up_over_all_sessions():
    board = FakeBoard()
    made, _ = bridge_of(board, FakeGraph())
    assert run_until(made, lambda: made.side.is_ready)
    for count in (2, 4):
        # It starts again while the way to it stays open, and is then gone with the way.
        board.node = FakeNode()
        board.come(board.node.sender.frames(NodeMessage(topic=2, packet=b"a")))
        assert run_until(made, lambda count=count: made.side.restarts == count - 1)
        assert run_until(made, lambda: made.side.is_ready)
        board.is_dead = True
        assert run_until(made, lambda: not made.side.is_ready)
        assert made.side.restarts == count
        board.node, board.is_dead = FakeNode(), False
        assert run_until(made, lambda: made.side.is_ready)
        assert made.side.restarts == count
    made.close()
    assert made.side.restarts == 4


def test_what_waits_of_a_board_that_is_never_known_is_lost_with_it():
    board, graph = FakeBoard(), FakeGraph()
    board.node.is_mute = True
    made, _ = bridge_of(board, graph)
    assert run_until(made, lambda: board.opened)
    for packet in (b"a", b"b"):
        board.come(board.node.sender.frames(NodeMessage(topic=2, packet=packet)))
    assert run_until(made, lambda: not board.coming)
    assert not made.side.on_the_way
    board.is_dead = True
    assert run_until(made, lambda: made.side.restarts == 1)
    assert made.side.on_the_way == {"held back": 2} and not graph.opened
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
    assert run_until(made, lambda: made.side.restarts == 1)
    # Its response would have confirmed the second request; that is no further loss.
    assert made.counters.dropped == {("/cal", "unanswered"): 1}
    assert graph.abandoned == ["second"]
    made.close()


class Link:
    """A direction of a link that loses frames, repeats them, holds them back, and damages numbers.

    The last four arguments are probabilities; a frame that comes late lets up to `depth` others go
    first.
    """

    def __init__(self, rng, depth, loses, repeats, delays, damages):
        self.rng, self.depth = rng, depth
        self.loses, self.repeats, self.delays, self.damages = loses, repeats, delays, damages
        self.sent, self.held = 0, []

    def carry(self, frame):
        """Take a frame; return those that come now."""
        self.sent += 1
        come = [each for at, each in self.held if at <= self.sent]
        self.held = [(at, each) for at, each in self.held if at > self.sent]
        if self.happens(self.loses):
            return come
        if self.happens(self.damages):
            at, bit = self.rng.choice([12, 13]), 1 << self.rng.randrange(8)
            frame = frame[:at] + bytes([frame[at] ^ bit]) + frame[at + 1 :]
        if self.happens(self.repeats):
            self.hold(frame)
        if self.happens(self.delays):
            self.hold(frame)
            return come
        return [*come, frame]

    def happens(self, probability):
        return self.rng.random() < probability

    def hold(self, frame):
        self.held.append((self.sent + self.rng.randint(1, self.depth), frame))


class HostileTalk:
    """A session with a node over two such links. Tags say what arrived there."""

    def __init__(self, seed, *, depth=20, size=3, there=(0.05, 0.05, 0.05, 0.0), back=None):
        self.rng, self.size, self.now = random.Random(seed), size, 100.0
        self.node = FakeNode()
        self.node.values = {}
        self.there = Link(self.rng, depth, *there)
        self.back = Link(self.rng, depth, *(back or there))
        self.session = Session(ECHO, 272, self.now)
        self.taken, self.got = set(), []

    def board(self, frames):
        for frame in frames:
            for each in self.back.carry(frame):
                wall = int(self.now * 1e9) + (1 << 60)
                self.got += [m.packet for m in self.session.take(each, self.now, wall)]

    def host(self, frames):
        for frame in frames:
            for each in self.there.carry(frame):
                passed = self.node.receiver.counters.passed
                self.board(self.node.take(each))
                self.taken |= {each[8:12]} if self.node.receiver.counters.passed > passed else set()

    def step(self):
        self.host(self.session.due(self.now, int(self.now * 1e9) + (1 << 60)))
        self.now += 0.02

    def run(self, count):
        """Exchange messages; return the differences of the account to the truth, there and back."""
        while not self.session.is_ready:
            self.step()
        sent, tags = [], set()
        for number in range(count):
            if self.rng.random() < 0.7:
                sent.append(b"%03d" % number * self.size)
                self.board(self.node.sender.frames(NodeMessage(topic=2, packet=sent[-1])))
            if self.rng.random() < 0.5:
                message = NodeMessage(topic=3, packet=bytes(self.size), tag=1 << 31 | number)
                tags.add(message.tag.to_bytes(4, "little"))
                self.host(self.session.frames(message))
            self.step()
        self.session.finish(self.now)
        while not self.session.is_finished:
            self.step()
        assert self.got == sorted(set(self.got))
        there = sum(value for each, value in self.session.drops() if each.name == "lost")
        back = self.session.lost_on_the_way()["lost"]
        return there - len(tags - self.taken), back - (len(sent) - len(self.got))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    "options",
    [
        {},
        {"there": (0.2, 0.0, 0.0, 0.0)},
        {"there": (0.0, 0.2, 0.0, 0.0), "depth": 3},
        {"depth": 60},
        {"size": 200},
        {"there": (0.0, 0.0, 0.0, 0.0), "back": (0.2, 0.2, 0.2, 0.0)},
    ],
)
def test_the_account_is_exact_on_a_hostile_link(seed, options):
    """Messages that are lost count once; those that come again or late, and requests, never."""
    talk = HostileTalk(seed, **options)
    assert talk.run(300) == (0, 0)
    assert talk.session.restarts == 0


def test_damaged_numbers_add_no_losses_by_themselves():
    for seed in range(4):
        talk = HostileTalk(seed, there=(0.0, 0.0, 0.0, 0.0), back=(0.0, 0.0, 0.0, 0.01))
        assert talk.run(300)[1] == 0 and talk.session.restarts == 0
