"""What a board has not confirmed when it dies is at least what is lost with it."""

from __future__ import annotations

import random
from collections import Counter

import pytest

from firm_hdl.node.bridge.losses import PASS_SECONDS, Unconfirmed


def board_that_dies(seed, pass_seconds):
    """Let a board die while messages are under way; return those lost, and those unconfirmed.

    A message is lost if what the board made of it has not arrived. Both ways of the link keep the
    order, and an answer overtakes the messages that are still in the node.
    """
    rng = random.Random(seed)
    delay, death = rng.uniform(0.0001, 0.03), rng.uniform(0.3, 0.6)
    events = [(rng.uniform(0, 0.6), 0, rng.choice("ab")) for _ in range(200)]
    at = 0.0
    while at < 0.6:
        events += [(at, 1, ""), (at + 2 * delay, 2, at)]
        at += 2 * delay + rng.choice([0.0, 0.0, 0.03, 0.1])
    found, lost = Unconfirmed(), Counter()
    for now, kind, what in sorted(events):
        if now > death:
            break
        if kind == 0:
            found.sent(what, now)
            lost[what] += now + 2 * delay + rng.uniform(0, pass_seconds) > death
        elif kind == 2:
            found.answered(what, now)
    return lost, found.take()


SEEDS = range(200)


def test_no_more_is_lost_than_unconfirmed():
    for seed in SEEDS:
        lost, unconfirmed = board_that_dies(seed, PASS_SECONDS)
        assert lost <= unconfirmed, seed


def test_a_node_that_keeps_messages_for_longer_breaks_the_bound():
    outcomes = (board_that_dies(seed, 6 * PASS_SECONDS) for seed in SEEDS)
    assert not all(lost <= unconfirmed for lost, unconfirmed in outcomes)


def test_the_bound_is_small():
    """Most of what was sent long before is confirmed: of 200 messages, few are left."""
    counts = [board_that_dies(seed, PASS_SECONDS)[1].total() for seed in SEEDS]
    assert max(counts) < 150 and sum(counts) / len(counts) < 75


@pytest.mark.parametrize(
    ("answers", "left"),
    [
        ([], 3),
        # One answer shows nothing, and neither does one that was asked too soon after.
        ([(2.0, 2.1)], 3),
        ([(2.0, 2.1), (2.11, 2.2)], 3),
        ([(2.0, 2.1), (2.11, 2.12), (2.16, 2.3)], 1),
        # What was sent when the request was may be behind it.
        ([(1.0, 1.1), (9.0, 9.1)], 3),
        ([(4.0, 4.1), (9.0, 9.1)], 0),
    ],
)
def test_what_confirms(answers, left):
    found = Unconfirmed()
    for now in (1.0, 1.5, 3.0):
        found.sent("/a", now)
    for asked_at, now in answers:
        found.answered(asked_at, now)
    assert len(found) == left
    assert found.take() == Counter({"/a": left} if left else {}) and not len(found)


def test_a_request_that_follows_an_answer_after_just_the_time_confirms():
    for later, left in ((0.0, 0), (-0.001, 1)):
        found = Unconfirmed()
        found.sent("/a", -2.0)
        found.answered(-1.0, 0.0)
        found.answered(PASS_SECONDS + later, 1.0)
        assert len(found) == left


def test_answers_of_before_confirm_nothing_of_the_next_board():
    found = Unconfirmed()
    found.answered(1.0, 1.1)
    found.take()
    found.sent("/a", 0.5)
    found.answered(9.0, 9.1)
    assert len(found) == 1
