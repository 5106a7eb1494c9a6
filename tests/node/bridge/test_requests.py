"""What a session asks, request by request, with each answer and its time written down."""

from __future__ import annotations

import pytest

from firm_hdl.node.boards import Board
from firm_hdl.node.bridge import session as sessions
from firm_hdl.node.bridge.losses import PASS_SECONDS
from firm_hdl.node.bridge.session import (
    ROUND_SECONDS,
    SilentBoardError,
)
from firm_hdl.node.frame import Header, encode_header
from firm_hdl.node.messages import MessageSender, NodeMessage
from tests.node.bridge.script import EPOCH, READ, REQUESTS, SET_RATE, SET_TIME, Script

REPEAT_SECONDS = Board.repeat_seconds

# Registers of ECHO, as docs/reference/frame.md numbers them: from 16 on, those of the link, the
# node and each topic in turn. What does not count a loss is left out.
LINK = dict(zip(range(17, 24), "lost late cut stray malformed full large".split(), strict=True))
NODE = {25: "unknown"}
GATE = "truncated trailing length encapsulation string full large overrun".split()
FIFO = "aborted full large".split()
HEARD = dict(zip(range(29, 37), GATE, strict=True))
SAID = dict(zip(range(40, 43), FIFO, strict=True))
STAMP = dict(zip(range(46, 49), FIFO, strict=True))
CAL = dict(zip(range(52, 60), GATE, strict=True)) | dict(zip(range(63, 66), FIFO, strict=True))
LOSSES = LINK | NODE | HEARD | SAID | STAMP | CAL
COUNTERS = range(16, 68)
# At the end, what the link has lost comes last, and how many requests it has taken right after.
LAST = (*(number for number in LOSSES if number != 17), 17, REQUESTS)


def test_the_clocks_are_compared_first_and_then_all_counters_are_read():
    script = Script()
    script.asked(0, *COUNTERS)
    assert script.ask() is None
    assert script.session.values.keys() == {0, *COUNTERS}


def test_a_round_that_takes_longer_than_its_time_is_not_begun_anew_before_its_end():
    script = Script()
    found = []
    while len(found) < 2 * len(COUNTERS) + 2:
        script.now += 0.2
        asked = script.ask()
        if asked[0] == READ and asked[1]:
            found.append(asked[1])
        script.answer(asked)
    assert script.now - 100 > 4 * ROUND_SECONDS
    assert found == [*COUNTERS, *COUNTERS, *COUNTERS[:2]]
    # No more than the rest of this round is left for a board that is fast again.
    script.asked(*COUNTERS[2:])
    assert script.ask() is None


def test_only_values_of_registers_are_kept():
    script = Script()
    for number in COUNTERS[:3]:
        script.asked(*([0] if number == 16 else []))
        script.answer(script.ask(), number, result=2 if number == 17 else 0)
        if number == 17:
            # It is asked once in a round, whatever the answer.
            assert script.session.values == {0: 0, 16: 16}
    assert script.session.values == {0: 0, 16: 16, 18: 18}
    script.now += 1.0
    script.answer(script.ask())
    change = script.ask()
    assert change[0] == SET_RATE
    script.answer(change, 5)
    assert script.session.values == {0: 0, 16: 16, 18: 18}


def test_all_losses_in_the_node_are_named():
    script = Script()
    script.asked(0)
    for number in COUNTERS:
        # The link has also lost the request that goes before the first one that it believes.
        script.answer(script.ask(), number + (number == 17))
    found = [(each.number, each.name, value) for each, value in script.session.drops()]
    assert found == [(number, name, number) for number, name in LOSSES.items()]


# The clock.


def test_the_time_is_set_after_the_first_comparison():
    script = Script()
    asked = script.ask()
    assert asked[:2] == (READ, 0)
    script.answer(asked, time=0, after=0.25)
    operation, argument, seconds, nanoseconds, _ = script.ask()
    # Half of the delay, in which the request travels, is added.
    assert (operation, argument, seconds, nanoseconds) == (SET_TIME, 0, EPOCH, 375_000_000)


def test_the_distance_of_the_clocks_is_counted_from_the_middle_of_the_delay():
    script = Script()
    asked = script.ask()
    script.answer(asked, time=script.wall + 20_000_000 + 300, after=0.04)
    assert script.session.offset_ns == pytest.approx(300)


def test_the_newest_of_two_comparisons_counts():
    script = Script()
    first = script.ask()
    script.now += REPEAT_SECONDS
    second = script.ask()
    assert second[:2] == first[:2] == (READ, 0) and first[-1] != second[-1]
    script.answer(first, time=0, after=0.125)
    script.answer(second, time=0, after=0.5)
    # 100.875 s, and half of the shorter delay of 0.375 s.
    assert script.ask()[:4] == (SET_TIME, 0, EPOCH + 1, 62_500_000)
    assert script.session.next_due() == script.now + REPEAT_SECONDS


# Tags.


def test_tags_go_on_after_the_last_one(monkeypatch):
    monkeypatch.setattr(sessions.random, "getrandbits", lambda bits: (1 << bits) - 2)
    script = Script(is_known=False)
    tags = []
    for _ in range(3):
        tags.append(script.ask()[-1])
        script.now += REPEAT_SECONDS
    assert tags == [0xFFFF_FFFF, 0, 1]


def test_sessions_have_tags_of_their_own():
    """So an answer to a session before is none to this one."""
    assert Script(is_known=False).ask()[-1] != Script(is_known=False).ask()[-1]


def test_an_answer_counts_once():
    script = Script()
    script.asked(0)
    asked = script.ask()
    script.answer(asked, 3)
    script.answer(asked, 4, after=1.0)
    assert script.session.values[16] == 3 and script.session.latency == 0.0


# Silence.


def test_a_board_is_gone_after_its_time_of_silence_and_not_before():
    script = Script(is_known=False)
    script.now += 5.0
    assert script.ask()
    script.now += 0.001
    with pytest.raises(SilentBoardError):
        script.ask()


# A board that starts again.


def test_all_begins_anew_with_a_board_that_starts_again():
    script = Script()
    script.asked(0, *COUNTERS[:4])
    # A request is under way, and is not waited for.
    before = script.ask()
    script.now += 0.01
    assert script.start_again() == [] and script.session.restarts == 1
    assert script.session.next_due() == script.now and script.session.offset_ns is None
    # Nor does a late answer count.
    script.answer(before, 9)
    script.know()
    assert script.session.values == {}
    script.asked(0, *COUNTERS)
    assert script.ask() is None


def test_a_time_for_a_board_of_before_is_not_set():
    script = Script()
    script.answer(script.ask(), time=0)
    script.start_again()
    script.know()
    assert script.ask()[:2] == (READ, 0)


def test_a_first_message_without_bytes_says_that_a_board_has_started_again():
    """Such as std_msgs/Empty in ROS 1."""
    script = Script()
    assert script.start_again(b"") == []
    assert script.session.restarts == 1 and not script.session.is_ready


@pytest.mark.parametrize(("seconds", "restarts"), [(10**8 - 1, 1), (10**8, 0)])
def test_a_board_whose_time_is_that_of_before_1973_has_started_again(seconds, restarts):
    script = Script()
    script.answer(script.ask(), time=0)
    request = script.ask()
    assert request[0] == SET_TIME
    # This is the time before it was set.
    script.answer(request, time=0)
    for _ in range(2):
        # One answer alone may be damaged.
        assert script.session.restarts == 0
        script.answer(script.ask(), time=seconds * 10**9)
    assert script.session.restarts == restarts


def test_counters_of_before_are_counted_once():
    script = Script()
    script.asked(0, 16)
    # With the request that goes before the first one that the link believes.
    script.answer(script.ask(), 8)
    script.start_again()
    assert [value for _, value in script.session.drops()] == [7]


def late(script, count=1):
    """Let messages come that are older than the last one."""
    for _ in range(count):
        sender = MessageSender(sequence=65500)
        sender._starts = False
        for frame in sender.frames(NodeMessage(topic=2, packet=b"late")):
            assert script.session.take(frame, script.now, script.wall) == []


@pytest.mark.parametrize("has_restarted", [False, True])
def test_a_board_is_asked_after_three_late_messages_in_a_row(has_restarted):
    script = Script()
    script.asked(0, *COUNTERS)
    for _ in range(20):
        late(script, 2)
        assert script.ask() is None and script.publish() == [b"x"]
    script.session.take(b"?", script.now, script.wall)
    if has_restarted:
        # Its first message was lost, and the next ones may have several frames.
        script.sender = MessageSender(32, sequence=1)
        script.sender._starts = False
        found = [script.publish(b"y" * 40) for _ in range(4)]
    else:
        late(script, 3)
        found = [script.publish(b"y" * 40)]
    script.answer(script.ask())
    assert script.session.restarts == has_restarted
    assert found[-1:] == ([[]] if has_restarted else [[b"y" * 40]])
    # The first three were dropped as late ones.
    assert not has_restarted or script.know() == [b"y" * 40]
    assert script.session.restarts == has_restarted
    found = script.session.lost_on_the_way()
    assert (found["lost"], found["malformed"]) == (0, 1)


def test_the_first_message_of_a_board_that_comes_again_is_no_restart():
    script = Script(is_known=False)
    (first,) = script.sender.frames(NodeMessage(topic=2, packet=b"first"))
    script.session.take(first, script.now, script.wall)
    assert script.know() == [b"first"]
    assert script.session.take(first, script.now, script.wall) == []
    assert script.publish() == [b"x"]
    script.asked(0)
    assert script.publish() == [b"x"]
    assert script.session.restarts == 0 and not (+script.session.lost_on_the_way())["lost"]


# Messages.


def test_the_last_messages_of_a_board_wait_until_it_is_known():
    script = Script(is_known=False)
    for number in range(1024):
        assert script.publish(b"%d" % number) == []
    assert script.session.lost_on_the_way()["held back"] == 0
    for number in (1024, 1025):
        script.publish(b"%d" % number)
    assert script.session.lost_on_the_way()["held back"] == 2
    assert script.know() == [b"%d" % number for number in range(2, 1026)]


@pytest.mark.parametrize("is_known", [False, True])
def test_frames_are_as_large_as_the_board_takes(is_known):
    script = Script(32, is_known)
    frames = script.session.frames(NodeMessage(topic=1, packet=bytes(40)))
    assert [len(each) for each in frames] == [32, 32, 24]


def header(**fields):
    return encode_header(Header(**{"topic": 2, "length": 1, "sequence": 3, **fields}))


@pytest.mark.parametrize(
    ("frame", "cause"),
    [
        (b"\xf2" + bytes(15), "malformed"),
        (header(length=(1 << 26) + 1), "large"),
        (header(length=(1 << 26) + 1, fragment=1), "stray"),
        (header() + b"too many", "cut"),
        # The third message after the board is known: two before it are missing.
        (header(sequence=5) + b"x", "lost"),
    ],
)
def test_what_is_lost_on_the_way_is_named(frame, cause):
    script = Script()
    script.session.take(frame, script.now, script.wall)
    assert +script.session.lost_on_the_way() == {cause: 2 if cause == "lost" else 1}


def test_an_answer_confirms_what_was_sent_before_its_request():
    script = Script()
    unconfirmed = script.session.unconfirmed
    unconfirmed.sent("/heard", script.now - 0.01)
    asked = script.ask()
    script.now += 0.01
    unconfirmed.sent("/heard", script.now)
    script.answer(asked, after=0.01)
    script.now += 2 * PASS_SECONDS
    script.answer(script.ask())
    # The second message may have come after the first request.
    assert len(unconfirmed) == 1


# The end.


def test_at_the_end_losses_are_read_when_the_last_messages_have_passed():
    script = Script()
    script.asked(0, 16)
    script.session.finish(script.now)
    script.asked(0)
    assert script.session.next_due() == script.now + PASS_SECONDS
    script.now += PASS_SECONDS
    for number in LAST:
        assert not script.session.is_finished
        # The others are read at once.
        script.asked(number)
    assert script.session.is_finished and script.ask() is None


def test_a_second_answer_does_not_shorten_the_time_in_which_messages_pass():
    script = Script()
    script.session.finish(script.now)
    asked = []
    for _ in range(3):
        asked.append(script.ask())
        script.now += REPEAT_SECONDS
    assert [each[:2] for each in asked] == [(READ, 0)] * 3
    script.answer(asked[0])
    due = script.now + PASS_SECONDS
    for each in asked[1:]:
        script.answer(each, after=0.01)
        assert script.session.next_due() == due and script.ask() is None
    script.now = due
    script.asked(18)


def test_a_late_answer_is_none_to_the_request_that_is_next():
    script = Script()
    script.session.finish(script.now)
    script.asked(0)
    script.now += PASS_SECONDS
    first = script.ask()
    script.now += REPEAT_SECONDS
    second = script.ask()
    assert first[:2] == second[:2] == (READ, 18)
    script.answer(first)
    script.answer(second)
    script.asked(19)


def test_a_board_that_starts_again_at_the_end_is_asked_for_all_again():
    script = Script()
    script.session.finish(script.now)
    script.asked(0)
    script.now += PASS_SECONDS
    script.asked(18, 19)
    script.start_again()
    assert not script.session.is_finished
    script.know()
    assert not script.session.is_finished
    script.asked(0)
    assert script.session.next_due() == script.now + PASS_SECONDS
    script.now += PASS_SECONDS
    script.asked(*LAST)
    assert script.session.is_finished
