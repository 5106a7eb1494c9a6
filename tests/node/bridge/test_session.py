"""What a host says to a board: time, losses and restarts are arguments."""

from __future__ import annotations

import itertools
import random

import pytest

from firm_hdl.node.boards import Board
from firm_hdl.node.bridge.session import (
    Session,
    SilentBoardError,
    WrongBoardError,
)
from firm_hdl.node.control import registers
from firm_hdl.node.messages import MessageSender, NodeMessage
from tests.node.bridge.fakes import ECHO, FakeNode

REPEAT_SECONDS = Board.repeat_seconds
EPOCH_NS = 1_800_000_000_000_000_000


class Talk:
    """A session and a node, with a clock of their own."""

    def __init__(self, node=None, loses=lambda: False, delay=lambda: 0.001, **options):
        self.node, self.loses, self.now = node or FakeNode(), loses, 100.0
        self.delay = delay
        self.session = Session(ECHO, None, self.now, **options)
        self.got = []

    def step(self, seconds=0.03):
        """Exchange what is due, then let time pass."""
        for frame in self.session.due(self.now, self.wall):
            self.say(frame)
        self.now += seconds

    def say(self, frame):
        self.now += self.delay()
        answers = [] if self.loses() else self.node.take(frame)
        self.now += self.delay()
        for answer in answers:
            if not self.loses():
                self.got += self.session.take(answer, self.now, self.wall)

    def run(self, seconds):
        end = self.now + seconds
        while self.now < end:
            self.step()

    @property
    def wall(self):
        return EPOCH_NS + int((self.now - 100) * 1e9)


def published(node, number=1):
    (frame,) = node.sender.frames(NodeMessage(topic=2, packet=b"%d" % number))
    return frame


def test_a_board_is_ready_when_it_has_the_same_fingerprint():
    talk = Talk()
    assert not talk.session.is_ready
    talk.run(0.1)
    assert talk.session.is_ready and talk.node.read[:2] == [1, 2]
    assert 0.001 < talk.session.latency < 0.01


def test_the_latency_is_the_median_of_the_last_round_trips():
    delays = itertools.cycle([0.001, 0.004, 0.009, 0.002, 0.1])
    talk = Talk(delay=lambda: next(delays) / 2)
    # Both ways of a request take a delay each: 2.5, 5.5, 50.5, 6.5 and 51 ms in turn.
    for _ in range(5):
        talk.run(20)
        assert talk.session.latency == pytest.approx(0.0065, rel=0.01)
    talk.delay = lambda: 0.0005
    talk.run(80)
    assert talk.session.latency == pytest.approx(0.001, rel=0.01)


@pytest.mark.parametrize("bit", [0, 31, 32, 63])
def test_another_fingerprint_is_an_error(bit):
    talk = Talk(FakeNode(ECHO.fingerprint ^ 1 << bit))
    with pytest.raises(WrongBoardError, match=f"is {ECHO.fingerprint ^ 1 << bit:016x}, and that"):
        talk.run(1)
    assert not talk.session.is_ready


def test_messages_of_a_board_wait_until_it_is_known():
    talk = Talk()
    assert talk.session.take(published(talk.node), talk.now, talk.wall) == []
    talk.run(0.1)
    assert [each.packet for each in talk.got] == [b"1"]
    wrong = Talk(FakeNode(1))
    wrong.session.take(published(wrong.node), wrong.now, wrong.wall)
    with pytest.raises(WrongBoardError):
        wrong.run(1)
    assert wrong.got == [] and wrong.session.lost_on_the_way()["held back"] == 1


@pytest.mark.parametrize(("options", "seconds"), [({}, 5), ({"silent_seconds": 7.0}, 7)])
def test_a_board_that_does_not_answer_is_gone(options, seconds):
    talk = Talk(**options)
    talk.node.is_mute = True
    with pytest.raises(SilentBoardError, match=f"no answer for {seconds} s"):
        talk.run(60)
    assert seconds <= talk.now - 100 < seconds + 1


def test_the_clock_is_set_and_the_rate_corrected():
    talk = Talk()
    talk.run(3)
    assert 0 <= talk.node.seconds - EPOCH_NS // 10**9 < 3
    # A clock that stands still is set again and again, and never a reason to think of a restart.
    assert talk.session.restarts == 0


@pytest.mark.parametrize("seed", range(4))
def test_the_clock_of_a_slow_simulation_is_never_set_back(seed):
    # More requests are due than it answers.
    rng = random.Random(seed)
    talk = Talk(delay=lambda: rng.uniform(0.02, 0.12), sample_seconds=0.1)
    talk.run(20)
    assert len(talk.node.set_ns) > 30 and talk.node.set_ns == sorted(talk.node.set_ns)


def test_one_request_is_under_way_at_any_time():
    talk = Talk()
    first = talk.session.due(talk.now, talk.wall)
    assert len(first) == 1
    assert talk.session.due(talk.now + 0.9 * REPEAT_SECONDS, talk.wall) == []
    assert talk.session.next_due() == pytest.approx(talk.now + REPEAT_SECONDS)
    again = talk.session.due(talk.now + REPEAT_SECONDS, talk.wall)
    # Both say that a sequence begins, as the first one may have been lost.
    assert len(again) == 1 and first[0][1] & 2 and again[0][1] & 2
    # The answer to either of them counts.
    (answer,) = talk.node.take(first[0])
    talk.session.take(answer, talk.now + 0.3, talk.wall)
    assert talk.session.due(talk.now + 0.3, talk.wall)


@pytest.mark.parametrize(("sample_seconds", "samples", "rounds"), [(1.0, 15, 3), (7.0, 3, 3)])
def test_what_is_next_due_is_due_then_and_not_before(sample_seconds, samples, rounds):
    """Who only wakes up for it misses neither a comparison of the clocks nor a round."""
    talk = Talk(sample_seconds=sample_seconds)
    first = min(each.number for each in registers(ECHO) if each.part != "identity")
    while (at := talk.session.next_due()) < 114.5:
        if at > talk.now:
            assert talk.session.due(at - 1e-6, talk.wall) == []
            talk.now = at
        for frame in talk.session.due(talk.now, talk.wall):
            talk.say(frame)
    assert talk.node.read.count(0) == samples and talk.node.read.count(first) == rounds


def test_a_request_that_is_lost_is_repeated_as_one_that_compares_the_clocks():
    talk = Talk()
    talk.run(4)
    talk.now = talk.session.next_due()
    assert talk.session.due(talk.now, talk.wall)
    assert talk.session.next_due() == pytest.approx(talk.now + REPEAT_SECONDS)
    count = len(talk.node.read)
    talk.now = talk.session.next_due()
    talk.step()
    assert talk.node.read[count:] == [0]


def test_requests_without_an_answer_take_limited_memory():
    talk = Talk()
    for number in range(200):
        # Messages show that the board is there.
        talk.session.take(published(talk.node, number), talk.now, talk.wall)
        talk.now += REPEAT_SECONDS
        assert talk.session.due(talk.now, talk.wall)
    assert len(talk.session._asked) == 64


def test_the_clock_of_a_board_that_starts_again_is_set_at_once():
    talk = Talk(sample_seconds=3.0)
    talk.run(1)
    talk.node = FakeNode()
    talk.session.take(published(talk.node), talk.now, talk.wall)
    talk.run(1)
    assert talk.session.restarts == 1 and talk.session.is_ready
    # An answer shows that it has.
    assert talk.node.read[:5] == [0, 1, 2, 26, 0] and talk.node.set_ns


def test_an_answer_to_another_operation_is_ignored():
    class Confused(FakeNode):
        def _control(self, packet):
            return b"\2" + super()._control(packet)[1:]

    talk = Talk(Confused())
    talk.run(1)
    assert talk.node.read and not talk.session.is_ready


@pytest.mark.parametrize("seed", range(5))
def test_loss_of_two_fifths_of_all_frames(seed):
    rng = random.Random(seed)
    talk = Talk(loses=lambda: rng.random() < 0.4)
    while not talk.session.is_ready:
        talk.step()
    talk.run(10)
    assert talk.session.is_ready and talk.session.restarts == 0


def test_a_board_that_starts_again_is_asked_again():
    talk = Talk()
    talk.run(2)
    # Its first message says so, and an answer shows it.
    talk.node = FakeNode()
    assert talk.session.take(published(talk.node), talk.now, talk.wall) == []
    talk.step()
    assert talk.session.restarts == 1 and not talk.session.is_ready
    talk.run(0.1)
    assert talk.session.is_ready and [each.packet for each in talk.got] == [b"1"]
    talk.node = FakeNode(fingerprint=3)
    with pytest.raises(WrongBoardError):
        talk.run(5)


@pytest.mark.parametrize("seconds", [2, 20])
def test_a_restart_is_seen_if_the_first_message_is_lost(seconds):
    talk = Talk()
    talk.run(seconds)
    talk.node = FakeNode()
    published(talk.node)
    talk.run(3)
    # By the numbers of messages, or by the clock.
    assert talk.session.restarts == 1 and talk.session.is_ready


def test_foreign_frames_change_nothing():
    rng = random.Random(1)
    talk = Talk()
    talk.run(1)
    for _ in range(300):
        frame = bytearray(published(FakeNode())) + rng.randbytes(rng.randrange(40))
        frame[rng.randrange(len(frame))] ^= 1 << rng.randrange(8)
        frame[1] &= 1
        assert all(m.topic for m in talk.session.take(bytes(frame), talk.now, talk.wall))
    talk.run(1)
    assert talk.session.is_ready


def test_an_answer_that_nobody_asked_for_is_ignored():
    talk = Talk()
    talk.run(1)
    stray = NodeMessage(topic=0, packet=bytes([1, 0, 0, 0]) + b"\xff" * 12, tag=1234)
    before = dict(talk.session.values)
    talk.session.take(talk.node.sender.frames(stray)[0], talk.now, talk.wall)
    short = NodeMessage(topic=0, packet=b"\1", tag=5)
    talk.session.take(talk.node.sender.frames(short)[0], talk.now, talk.wall)
    assert talk.session.values == before


def next_talk(talk, node):
    """Open the way again, to the same node or to another one."""
    talk.node = node
    talk.session = Session(ECHO, None, talk.now, before=talk.session)


@pytest.mark.parametrize("starts_again", [False, True])
@pytest.mark.parametrize("loses_first", [False, True])
def test_counters_of_a_board_that_starts_again_are_kept(starts_again, loses_first):
    talk = Talk()
    talk.run(6)
    node = FakeNode() if starts_again else talk.node
    node.values = {17: 9}
    if loses_first:
        published(node)
    next_talk(talk, node)
    talk.run(6)
    (found,) = talk.session.drops()
    # The 7 are part of the 9 unless the board began at 0 again.
    assert found[1] == (16 if starts_again else 9) and talk.session.restarts == 0


def test_counters_are_kept_in_the_same_session():
    talk = Talk()
    talk.run(6)
    talk.node = FakeNode()
    talk.run(7)
    assert talk.session.restarts == 1
    assert [value for _, value in talk.session.drops()] == [14]
    talk.node = FakeNode()
    talk.run(7)
    assert talk.session.restarts == 2
    assert [value for _, value in talk.session.drops()] == [21]


@pytest.mark.parametrize("loss", [0.0, 0.3])
def test_at_the_end_all_has_arrived_and_the_counters_are_the_last_ones(loss):
    rng = random.Random(2)
    talk = Talk(loses=lambda: rng.random() < loss)
    talk.run(6)
    for _ in range(10):
        talk.session.unconfirmed.sent("/heard", talk.now)
    talk.node.values = {17: 12, 19: 3}
    talk.session.finish(talk.now + 0.001)
    begin = talk.now
    while not talk.session.is_finished and talk.now < begin + 60:
        talk.step(0.01)
    assert talk.session.is_finished and not len(talk.session.unconfirmed)
    assert [value for _, value in talk.session.drops()] == [12, 3]
    # Nothing more is asked, until the other side is thought to be gone.
    count = len(talk.node.read)
    talk.run(4)
    assert len(talk.node.read) == count


def test_an_answer_to_a_request_of_before_is_none_to_the_last_ones():
    talk = Talk()
    talk.run(6)
    asked, answers = [], []
    while asked != [0]:
        talk.now += 0.01
        count = len(talk.node.read)
        for frame in talk.session.due(talk.now, talk.wall):
            answers = talk.node.take(frame)
        asked = talk.node.read[count:]
        if asked != [0]:
            for answer in answers:
                talk.session.take(answer, talk.now, talk.wall)
            answers = []
    # The answer is under way when the end begins, whose first request is the same one.
    talk.session.finish(talk.now)
    for answer in answers:
        talk.session.take(answer, talk.now, talk.wall)
    count = len(talk.node.read)
    talk.step(0.001)
    assert talk.node.read[count:] == [0]


@pytest.mark.parametrize("sessions", [1, 2, 3])
def test_counters_of_all_sessions_are_kept(sessions):
    talk = Talk()
    talk.run(6)
    for _ in range(sessions):
        next_talk(talk, FakeNode())
        talk.run(6)
    assert [value for _, value in talk.session.drops()] == [7 * (sessions + 1)]


def test_messages_that_wait_when_a_session_ends_are_counted():
    talk = Talk()
    talk.session.take(published(talk.node), talk.now, talk.wall)
    talk.session.end()
    assert talk.session.lost_on_the_way()["held back"] == 1


@pytest.mark.parametrize("lost", [0, 1, 2])
@pytest.mark.parametrize("before", [20_000, 40_000, 60_000])
def test_a_restart_is_no_gap_whatever_its_first_number_is_ahead_of(before, lost):
    """Its first messages are lost, of which the first one says that a sequence begins."""
    talk = Talk()
    talk.node.sender = MessageSender(sequence=before)
    talk.run(2)
    talk.node = FakeNode()
    for number in range(10):
        frame = published(talk.node, number)
        if number >= lost:
            talk.got += talk.session.take(frame, talk.now, talk.wall)
    talk.run(3)
    assert talk.session.restarts == 1 and talk.session.is_ready
    assert talk.session.lost_on_the_way()["lost"] <= 1
    numbers = [int(each.packet) for each in talk.got]
    assert numbers == sorted(numbers) and numbers[-1] == 9


def test_answers_that_were_lost_before_a_restart_are_no_lost_messages():
    ways = itertools.cycle([False, True])
    talk = Talk()
    talk.run(6)
    # Each request arrives, and its answer does not.
    talk.loses = lambda: next(ways)
    talk.run(2)
    talk.loses = lambda: False
    for restarts in (0, 1):
        talk.run(6)
        assert talk.session.restarts == restarts
        assert talk.session.lost_on_the_way()["lost"] == 0
        talk.node = FakeNode()
        talk.session.take(published(talk.node), talk.now, talk.wall)


def test_a_gap_before_a_restart_stays_counted():
    talk = Talk()
    talk.run(2)
    talk.node.sender = MessageSender(sequence=5000, starts=False)
    talk.run(2)
    real = talk.session.lost_on_the_way()["lost"]
    assert real > 4000
    talk.node = FakeNode()
    talk.session.take(published(talk.node), talk.now, talk.wall)
    talk.run(2)
    assert talk.session.restarts == 1 and talk.session.lost_on_the_way()["lost"] == real
