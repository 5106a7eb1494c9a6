"""Writers and readers alone: windows, memory, and what a later submessage must not take back."""

from __future__ import annotations

import pytest

from firm_hdl.rtps import Durability, Guid, Qos
from firm_hdl.rtps.budget import Budget
from firm_hdl.rtps.reader import Reader
from firm_hdl.rtps.wire.submessages import (
    AckNack,
    Data,
    Gap,
    Heartbeat,
    HeartbeatFrag,
    NackFrag,
    NumberSet,
)
from firm_hdl.rtps.writer import Writer
from tests.rtps.test_endpoints import (
    BEST_EFFORT,
    HERE,
    KEEP_ALL,
    ROUTE,
    THERE,
    Outbox,
    ack,
    data,
    endpoint,
    heartbeat,
    part,
)


@pytest.fixture
def sent():
    return Outbox()


def listening(sent, qos=KEEP_ALL, limit=1 << 20):
    """Return a reader that waits for sample 1, the numbers that it delivers, and its memory."""
    got, budget = [], Budget(limit)
    deliver = lambda writer, data, timestamp: got.append(data.sequence_number)  # noqa: E731
    reader = Reader(THERE, qos, sent.append, deliver, budget)
    reader.match(endpoint(HERE, qos), ROUTE, 0.0)
    reader.on_heartbeat(HERE, heartbeat(1, 0), 0.0)
    return reader, got, budget


def test_early_samples_without_memory_are_dropped_and_asked_for(sent):
    # A sample of 4 bytes takes 204.
    reader, got, budget = listening(sent, limit=410)
    for number in (2, 3, 4):
        reader.on_data(HERE, data(number), None, 1.0)
    assert budget.used == 408
    sent.clear()
    reader.on_heartbeat(HERE, heartbeat(1, 4, count=2), 1.0)
    (answer,) = sent.take(AckNack)
    assert answer.missing == NumberSet(1, (1, 4))
    reader.on_data(HERE, data(1), None, 1.0)
    assert (got, budget.used) == ([1, 2, 3], 0)


def test_a_writer_that_began_anew_is_asked_for_fragments_again(sent):
    reader, _, _ = listening(sent)

    def ask(number, now):
        reader.on_data_frag(HERE, part(number, 1), None, now)
        frag = HeartbeatFrag(reader=0, writer=0x103, sequence_number=number, last=2, count=1)
        reader.on_heartbeat_frag(HERE, frag, now)
        return [each.sequence_number for each in sent.take(NackFrag)]

    assert ask(9, 1.0) == [9]
    reader.on_heartbeat(HERE, heartbeat(1, 9, count=2), 1.0)
    # Long after, the writer has fewer samples, and counts from 1 again.
    reader.on_heartbeat(HERE, heartbeat(1, 1), 60.0)
    assert ask(1, 60.0) == [1]


def test_memory_of_a_peer_is_not_taken_for_one_that_would_then_have_as_much():
    class Peer:
        def __init__(self, prefix):
            self.prefix = prefix

        def shrink(self):
            pytest.fail("nobody has more")

    budget, one, other = Budget(1000), Peer(b"a" * 12), Peer(b"b" * 12)
    assert budget.take(one, 400)
    assert not budget.take(other, 400)
    assert (budget.of(one), budget.of(other)) == (600, 0)


def test_fragments_of_a_sample_that_will_not_come_are_forgotten(sent):
    reader, got, budget = listening(sent)
    # The fragment that is missing before this one takes a byte.
    reader.on_data_frag(HERE, part(1, 2), None, 1.0)
    assert budget.used == 205
    reader.on_gap(HERE, Gap(reader=0, writer=0x103, start=1, numbers=NumberSet(2)), 1.0)
    assert (got, budget.used) == ([], 0)
    # One that waits for another one is not put together again.
    reader.on_data(HERE, data(3), None, 1.0)
    reader.on_data_frag(HERE, part(3, 1), None, 1.0)
    assert budget.used == 204


def gap(start, base, members=()):
    return Gap(reader=0, writer=0x103, start=start, numbers=NumberSet(base, members))


@pytest.mark.parametrize(
    ("gaps", "first", "lost"),
    [
        ([], 4, 3),
        ([gap(2, 3)], 4, 2),
        ([gap(2, 2, (2, 3))], 4, 1),
        # Numbers that were passed before, and those that the writer still has.
        ([gap(1, 1, (1,))], 4, 2),
        ([gap(2, 3), gap(5, 7)], 4, 2),
    ],
)
def test_what_is_gone_is_lost_unless_it_never_was(sent, gaps, first, lost):
    reader, _, _ = listening(sent)
    for each in gaps:
        reader.on_gap(HERE, each, 1.0)
    assert reader.lost == 0
    reader.on_heartbeat(HERE, heartbeat(first, 9, count=2), 1.0)
    assert reader.lost == lost


@pytest.mark.parametrize("qos", [KEEP_ALL, BEST_EFFORT])
def test_a_writer_that_begins_anew_under_its_old_name_is_heard_from_its_beginning(sent, qos):
    reader, got, budget = listening(sent, qos)
    for number in (1, 2, 3, 5):
        reader.on_data(HERE, data(number), None, 1.0)
    # The last number of the new one went back, and nothing else came for a second.
    assert not reader.on_heartbeat(HERE, heartbeat(1, 1, count=1), 1.9)
    reader.on_data(HERE, data(1), None, 1.9)
    assert reader.on_heartbeat(HERE, heartbeat(1, 2, count=2), 2.0)
    assert budget.used == 0
    for number in (1, 2, 3):
        reader.on_data(HERE, data(number), None, 2.1)
    assert got == [1, 2, 3, *([5] if qos is BEST_EFFORT else []), 1, 2, 3]
    assert reader.lost == (1 if qos is BEST_EFFORT else 0)


def test_a_writer_that_says_nothing_is_asked_ever_more_seldom(sent):
    reader = Reader(THERE, KEEP_ALL, sent.append, lambda *_: None, Budget(1 << 20))
    reader.match(endpoint(HERE), ROUTE, 1.0)
    now, times = 1.0, []
    while now < float("inf"):
        due = reader.tick(now)
        times += [now for each in sent.take(AckNack) if not each.final]
        now = due
    assert times == [1.0, 1.25, 1.75, 2.75, 4.75, 8.75]


@pytest.mark.parametrize(("acknowledged", "sent_again"), [(1, [1, 2, 3]), (2, [1, 3]), (3, [1, 3])])
def test_a_durable_writer_forgets_the_end_of_an_instance_that_all_have(
    sent, acknowledged, sent_again
):
    durable = Qos(depth=0, durability=Durability.TRANSIENT_LOCAL)
    writer = Writer(HERE, durable, sent.append)
    writer.match(endpoint(THERE, durable), ROUTE, 0.0)
    for is_end in (False, True, False):
        writer.write(b"abcd", 1.0, key=is_end)
    writer.on_ack_nack(THERE, ack(acknowledged + 1), 1.1)
    late = Guid(bytes(11) + b"\1", 0x204)
    writer.match(endpoint(late, durable), ROUTE, 2.0)
    sent.clear()
    writer.on_ack_nack(late, ack(1, (1, 2, 3)), 2.1)
    assert [each.sequence_number for each in sent.take(Data, late.prefix)] == sent_again


@pytest.mark.parametrize(
    ("qos", "large", "asks"),
    [
        # Every 50 ms, or every 2 ms while half of the room is in use; samples are 1 ms apart.
        (Qos(depth=0, max_samples=100), (), []),
        (Qos(depth=0, max_samples=8), (), [4, 6, 8]),
        (Qos(depth=8, max_samples=8), (), [4, 6, 8]),
        # A sample in fragments is always asked for.
        (Qos(depth=0, max_samples=100), (3, 7), [3, 7]),
    ],
)
def test_which_samples_ask_for_an_acknowledgement(sent, qos, large, asks):
    writer = Writer(HERE, qos, sent.append, fragment_bytes=8)
    writer.match(endpoint(THERE, qos), ROUTE, 1.0)
    asking = []
    for number in range(1, 9):
        sent.clear()
        writer.write(b"abcd" * (4 if number in large else 1), 1.0 + 0.00101 * number)
        (beat,) = sent.take(Heartbeat)
        asking += [] if beat.final else [number]
    assert asking == asks


def test_gaps_of_a_writer_are_not_those_of_the_one_that_begins_anew(sent):
    reader, got, _ = listening(sent)
    # 1 is missing, so the gap waits.
    reader.on_gap(HERE, Gap(reader=0, writer=HERE.entity, start=3, numbers=NumberSet(4)), 1.0)
    reader.on_data(HERE, data(4), None, 1.0)
    assert reader.on_heartbeat(HERE, heartbeat(1, 2, count=2), 2.0)
    for number in (1, 2, 3):
        reader.on_data(HERE, data(number), None, 2.1)
    assert got == [1, 2, 3]
