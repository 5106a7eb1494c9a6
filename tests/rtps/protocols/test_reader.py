"""A reader alone: when it asks, for what, and what it keeps, rule by rule."""

from __future__ import annotations

import pytest

from firm_hdl.rtps import Guid
from firm_hdl.rtps.backlog import Backlog
from firm_hdl.rtps.budget import Budget
from firm_hdl.rtps.reader import Reader
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.submessages import AckNack, Gap, HeartbeatFrag, NackFrag, NumberSet
from tests.rtps.network import route_to
from tests.rtps.test_endpoints import (
    BEST_EFFORT,
    HERE,
    KEEP_ALL,
    ROUTE,
    THERE,
    Outbox,
    data,
    endpoint,
    heartbeat,
    part,
)

# What a sample of 4 bytes takes while it waits.
EARLY = 204


@pytest.fixture
def sent():
    return Outbox()


class Listener(Reader):
    """A reader that writes down what it delivers: numbers and times."""

    def __init__(self, sent, qos=KEEP_ALL, writer=HERE, *, synced=True):
        self.got, self.times, self.budget = [], [], Budget(1 << 20)
        super().__init__(THERE, qos, sent.append, self._note, self.budget)
        self.match(endpoint(writer, qos), ROUTE, 1.0)
        if synced:
            self.on_heartbeat(writer, heartbeat(1, 0), 1.0)

    def _note(self, writer, data, timestamp):
        assert writer in self.matched
        self.got.append(data.sequence_number)
        self.times.append(timestamp)

    def take(self, *numbers, now=1.0):
        for number in numbers:
            self.on_data(HERE, data(number), None, now)


def gap(start, base, members=()):
    return Gap(reader=0, writer=0x103, start=start, numbers=NumberSet(base, members))


def begun(number, last, count=1):
    return HeartbeatFrag(reader=0, writer=0x103, sequence_number=number, last=last, count=count)


def asked(reader, sent, last, count, now=1.0):
    """Return what the reader misses up to sample `last`."""
    sent.clear()
    reader.on_heartbeat(HERE, heartbeat(1, last, count=count, final=False), now)
    (answer,) = sent.take(AckNack)
    return answer.missing


# Greeting.


@pytest.mark.parametrize(
    ("prefix", "base"), [(b"\1\x0f", 0), (b"\1\1", 0), (b"\1\x0e", 1), (b"\0\1", 1), (b"\0\0", 1)]
)
def test_a_writer_is_greeted_as_its_vendor_understands(sent, prefix, base):
    writer = Guid(prefix + bytes(10), 0x103)
    reader = Listener(sent, writer=writer, synced=False)
    assert reader.tick(1.0) == 1.25
    (outgoing,) = sent
    assert (outgoing.route, outgoing.prefix) == (ROUTE, writer.prefix)
    assert outgoing.submessages == (
        AckNack(reader=0x204, writer=0x103, missing=NumberSet(base), count=1, final=False),
    )


def test_a_best_effort_reader_asks_for_nothing(sent):
    reader = Listener(sent, BEST_EFFORT)
    reader.on_heartbeat(HERE, heartbeat(4, 9, count=2, final=False), 1.0)
    reader.on_data_frag(HERE, part(5000, 1), None, 1.0)
    reader.on_heartbeat_frag(HERE, begun(5000, 3), 1.0)
    assert reader.tick(9.0) == float("inf") and not sent
    # Samples below the heartbeat's first one, or in a gap, are as good as others.
    reader.on_gap(HERE, gap(1, 9), 1.0)
    reader.take(2)
    # The sample in fragments is far ahead, which is no matter here.
    reader.on_data_frag(HERE, part(5000, 2, 2), None, 1.0)
    assert reader.got == [2, 5000] and reader.lost == 4997
    reader.on_data_frag(HERE, part(6000, 1), None, 1.0)
    reader.take(6001)
    assert reader.budget.used == 0


def test_a_writer_that_has_moved_is_answered_at_its_new_address(sent):
    reader = Listener(sent)
    reader.take(1)
    moved = route_to(Address("10.0.0.9", 7500))
    reader.match(endpoint(HERE), moved, 2.0)
    reader.on_heartbeat(HERE, heartbeat(1, 2, count=2), 2.0)
    (outgoing,) = sent
    # All else is as before.
    assert outgoing.route == moved and outgoing.submessages[0].missing == NumberSet(2, (2,))


# Samples.


def test_what_comes_twice_takes_memory_once(sent):
    reader = Listener(sent)
    reader.take(3, 3)
    assert reader.budget.used == EARLY
    reader.on_data_frag(HERE, part(4, 1), None, 1.0)
    reader.take(4)
    assert reader.budget.used == 2 * EARLY
    reader.take(1, 2)
    reader.on_data_frag(HERE, part(4, 1), None, 1.0)
    assert (reader.got, reader.budget.used) == ([1, 2, 3, 4], 0)


# Asking.


@pytest.mark.parametrize("final", [False, True])
def test_a_heartbeat_that_asks_is_answered_though_nothing_is_missing(sent, final):
    reader = Listener(sent)
    reader.take(1)
    reader.on_heartbeat(HERE, heartbeat(1, 1, count=2, final=final), 1.0)
    answers = sent.take(AckNack)
    assert [each.missing for each in answers] == ([] if final else [NumberSet(2)])
    assert reader.tick(9.0) == float("inf") and not sent


def test_no_more_is_asked_for_at_once_than_a_set_can_name(sent):
    reader = Listener(sent)
    reader.on_data_frag(HERE, part(257, 1), None, 1.0)
    reader.on_heartbeat(HERE, heartbeat(1, 1000, count=2), 2.0)
    (answer,) = sent[0].submessages
    assert answer.missing == NumberSet(1, tuple(range(1, 257)))


def test_gaps_and_early_samples_are_not_asked_for(sent):
    reader = Listener(sent)
    reader.on_gap(HERE, gap(2, 4, (5,)), 1.0)
    reader.take(7)
    assert asked(reader, sent, 8, 2) == NumberSet(1, (1, 4, 6, 8))


def test_requests_are_numbered_modulo_two_to_the_31(sent):
    reader = Listener(sent)
    reader._count = 0x7FFF_FFFD
    for count in range(2, 5):
        reader.on_heartbeat(HERE, heartbeat(1, 1, count=count), float(count))
    assert [each.count for each in sent.take(AckNack)] == [0x7FFF_FFFE, 0x7FFF_FFFF, 0]


@pytest.mark.parametrize("is_member", [False, True])
def test_a_writer_that_answers_with_gaps_is_asked_on(sent, is_member):
    reader = Listener(sent)
    reader.on_heartbeat(HERE, heartbeat(1, 60, count=2), 1.0)
    now = 1.0
    for number in range(1, 61):
        sent.clear()
        now += 1.0
        reader.tick(now)
        (answer,) = sent.take(AckNack)
        assert answer.missing.base == number
        name = gap(number, number, (number,)) if is_member else gap(number, number + 1)
        reader.on_gap(HERE, name, now)
    assert reader.tick(now + 1) == float("inf") and not sent


# Gaps.


@pytest.mark.parametrize(
    ("name", "base", "missing"),
    [
        # A gap that begins with the next number may have any length.
        (gap(1, 100_000), 100_000, (100_000, 100_001)),
        (gap(1, 1, (1, 3)), 2, (2, 4)),
        (gap(1, 2, (2,)), 3, (3, 4)),
        (gap(2, 3), 1, (1, 3, 4)),
    ],
)
def test_gaps(sent, name, base, missing):
    reader = Listener(sent)
    reader.on_gap(HERE, name, 1.0)
    assert asked(reader, sent, max(missing), 2) == NumberSet(base, missing)


# Fragments.


def test_fragments_are_asked_for_by_what_is_missing(sent):
    reader = Listener(sent)
    reader.on_data_frag(HERE, part(1, 1), None, 1.0)
    # The writer has sent what is here, then one more; the second time, it says nothing new.
    reader.on_heartbeat_frag(HERE, begun(1, 1), 1.0)
    assert not sent
    for _ in range(2):
        reader.on_heartbeat_frag(HERE, begun(1, 2, count=2), 1.0)
    (outgoing,) = sent
    assert outgoing.submessages == (
        NackFrag(
            reader=0x204, writer=0x103, sequence_number=1, missing=NumberSet(2, (2,)), count=1
        ),
    )


def test_fragments_are_asked_for_again(sent):
    reader = Listener(sent)
    for number in range(1, 7):
        reader.on_data_frag(HERE, part(number, 3), None, 0.0)
    # Nothing came for 20 ms.
    reader.on_heartbeat(HERE, heartbeat(1, 6, count=2), 0.02)
    assert reader.tick(0.11) == pytest.approx(0.12)
    reader.tick(0.125)
    nacks = sent.take(NackFrag)
    assert [each.sequence_number for each in nacks] == [1, 2, 3, 4] * 2
    assert {each.missing for each in nacks} == {NumberSet(1, (1, 2))}


def test_a_sample_that_fragments_have_completed_is_not_waited_for(sent):
    """What is missing besides is asked for again in the usual time; if nothing is, never."""
    reader = Listener(sent)
    reader.on_data_frag(HERE, part(1, 1, 3), None, 1.0)
    assert reader.got == [1]
    reader.on_heartbeat(HERE, heartbeat(1, 1, count=2, final=False), 1.0)
    assert reader.tick(1.0) == float("inf")
    reader.on_heartbeat(HERE, heartbeat(1, 2, count=3), 2.0)
    assert reader.tick(2.0) == pytest.approx(2.1)


def test_a_flood_of_heartbeats_gets_an_answer_each_millisecond(sent):
    reader = Listener(sent)
    for count in range(2, 102):
        reader.on_heartbeat(HERE, heartbeat(1, 0, count=count, final=False), 2.0)
    assert len(sent.take(AckNack)) == 1
    # The last one gets its answer, too.
    assert reader.tick(2.0) == pytest.approx(2.001)
    assert reader.tick(2.001) == float("inf") and len(sent.take(AckNack)) == 1


@pytest.mark.parametrize(
    ("parts", "left"),
    [
        ([(9, 1), (9, 2), (9, 3)], {}),
        # Newer ones make room, and an older one does not.
        ([(1, 1), (9, 1), (9, 2)], {1: 1}),
        ([(9, 1), (1, 1), (1, 2)], {1: 2}),
    ],
)
def test_a_sample_without_memory_gives_all_of_its_own_back(parts, left):
    # A fragment of 4 bytes takes 204.
    budget = Budget(2 * 204)
    backlog = Backlog(HERE.prefix, budget)
    for number, first in parts:
        assert backlog.add(part(number, first)) is None
    assert budget.used == 204 * sum(left.values())
    assert {number for number in (1, 9) if backlog.has_part(number)} == set(left)
