"""A writer alone: what it keeps, what it sends to whom, and when it asks, rule by rule."""

from __future__ import annotations

import pytest

from firm_hdl.rtps import Durability, Guid, Qos
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.parameters import ParameterList, Pid
from firm_hdl.rtps.wire.submessages import (
    Data,
    DataFrag,
    Gap,
    Heartbeat,
    InfoTimestamp,
    NackFrag,
    NumberSet,
)
from firm_hdl.rtps.writer import HistoryFullError, Writer
from tests.rtps.network import route_to
from tests.rtps.test_endpoints import (
    BEST_EFFORT,
    HERE,
    KEEP_ALL,
    ROUTE,
    THERE,
    Outbox,
    ack,
    endpoint,
)

DURABLE = Qos(depth=0, durability=Durability.TRANSIENT_LOCAL)
OTHER = Guid(bytes(11) + b"\1", 0x304)
INLINE = ParameterList(((Pid.KEY_HASH, bytes(16)),))


@pytest.fixture
def sent():
    return Outbox()


def serving(sent, qos=KEEP_ALL, reader=KEEP_ALL, fragment_bytes=8):
    """Return a writer with one reader, which has answered."""
    writer = Writer(HERE, qos, sent.append, fragment_bytes)
    writer.match(endpoint(THERE, reader), ROUTE, 0.0)
    writer.on_ack_nack(THERE, ack(1, count=0), 0.0)
    sent.clear()
    return writer


def numbers(sent, kind=Data, prefix=None):
    return [each.sequence_number for each in sent.take(kind, prefix)]


def nack_frag(number, missing, count=1):
    return NackFrag(
        reader=0x204, writer=0x103, sequence_number=number, missing=missing, count=count
    )


# What is sent.


def test_a_sample_is_sent_with_its_time_and_a_heartbeat(sent):
    writer = serving(sent)
    writer.write(b"abcdefgh", 1.0, 77, INLINE, key=True)
    (outgoing,) = sent
    assert (outgoing.route, outgoing.prefix) == (ROUTE, THERE.prefix)
    assert outgoing.submessages == (
        InfoTimestamp(77),
        Data(
            reader=0x204,
            writer=0x103,
            sequence_number=1,
            payload=b"abcdefgh",
            key=True,
            inline=INLINE,
        ),
        Heartbeat(reader=0x204, writer=0x103, first=1, last=1, count=2, final=False),
    )


def test_a_large_sample_is_sent_in_fragments_with_its_time(sent):
    writer = serving(sent)
    writer.write(b"abcdefghi", 1.0, 77, INLINE)
    first, second, last = sent
    for number, each in enumerate((first, second)):
        assert each.submessages == (
            InfoTimestamp(77),
            DataFrag(
                reader=0x204,
                writer=0x103,
                sequence_number=1,
                first=number + 1,
                count=1,
                fragment_bytes=8,
                sample_bytes=9,
                payload=(b"abcdefgh", b"i")[number],
                inline=INLINE,
            ),
        )
    (beat,) = last.submessages
    assert (beat.first, beat.last, beat.final) == (1, 1, False)


def test_a_reader_that_has_moved_is_served_at_its_new_address(sent):
    writer = serving(sent)
    moved = route_to(Address("10.0.0.9", 7500))
    writer.match(endpoint(THERE), moved, 2.0)
    # It is known: it is not asked anew.
    assert not sent
    writer.write(b"abcd", 2.0)
    assert [each.route for each in sent] == [moved]


@pytest.mark.parametrize(("last", "first"), [(0, 1), (2, 3)])
def test_the_history_of_a_writer_whose_samples_all_have_begins_with_the_next_one(sent, last, first):
    writer = serving(sent)
    for _ in range(last):
        writer.write(b"abcd", 1.0)
    writer.on_ack_nack(THERE, ack(last + 1, count=1), 1.0)
    sent.clear()
    writer.on_ack_nack(THERE, ack(last + 1, count=2, final=False), 1.0)
    assert [(each.first, each.last, each.final) for each in sent.take(Heartbeat)] == [
        (first, last, True)
    ]


def test_heartbeats_are_numbered_modulo_two_to_the_31(sent):
    writer = serving(sent)
    writer._count = 0x7FFF_FFFD
    for _ in range(3):
        writer.write(b"abcd", 1.0)
    assert [each.count for each in sent.take(Heartbeat)] == [0x7FFF_FFFE, 0x7FFF_FFFF, 0]


# What is kept.


@pytest.mark.parametrize(("depth", "kept"), [(1, [3]), (2, [2, 3]), (3, [1, 2, 3])])
def test_a_history_has_its_depth(sent, depth, kept):
    writer = serving(sent, Qos(depth=depth))
    for _ in range(3):
        writer.write(b"abcd", 1.0)
    sent.clear()
    writer.on_ack_nack(THERE, ack(1, (1, 2, 3)), 1.0)
    assert numbers(sent) == kept


def test_a_full_history_has_as_many_samples_as_it_may(sent):
    writer = serving(sent, Qos(depth=0, max_samples=2))
    for _ in range(2):
        writer.write(b"abcd", 1.0)
    with pytest.raises(HistoryFullError, match=r"^2 samples are not acknowledged$"):
        writer.write(b"abcd", 1.0)
    writer.on_ack_nack(THERE, ack(2, count=1), 1.0)
    assert writer.write(b"abcd", 1.0) == 3


@pytest.mark.parametrize("forgotten", [0, 1])
def test_a_best_effort_reader_gets_the_history_once(sent, forgotten):
    durable = Qos(depth=0, durability=Durability.TRANSIENT_LOCAL)
    lossy = Qos(reliability=BEST_EFFORT.reliability, durability=Durability.TRANSIENT_LOCAL)
    writer = serving(sent, durable)
    for _ in range(3):
        writer.write(b"abcd", 1.0)
    for number in range(forgotten):
        writer.forget(number + 1)
    sent.clear()
    writer.match(endpoint(OTHER, lossy), ROUTE, 2.0)
    assert numbers(sent, prefix=OTHER.prefix) == [1, 2, 3][forgotten:]
    # One that is volatile begins with the next one.
    volatile = Guid(bytes(11) + b"\2", 0x304)
    writer.match(endpoint(volatile, BEST_EFFORT), ROUTE, 2.0)
    assert not sent
    writer.match(endpoint(Guid(bytes(11) + b"\3", 0x304), DURABLE), ROUTE, 2.0)
    kinds = [type(each) for outgoing in sent for each in outgoing.submessages]
    assert kinds == [Heartbeat]


# When it asks.


def test_pauses_are_short_again_after_progress(sent):
    writer = serving(sent)
    writer.write(b"abcd", 1.0)
    assert writer.tick(1.0) == pytest.approx(1.05)
    due = 1.05
    for later in (0.1, 0.2, 0.4):
        due, before = writer.tick(due), due
        assert due == pytest.approx(before + later)
    # One more sample for a reader that is behind changes nothing.
    writer.write(b"abcd", 1.4)
    assert writer.tick(1.4) == due
    # Progress does, and so does a sample for a reader that has all others.
    writer.on_ack_nack(THERE, ack(2), 1.5)
    assert writer.tick(1.5) == pytest.approx(1.55)
    writer.on_ack_nack(THERE, ack(3, count=2), 1.5)
    assert writer.tick(1.5) == float("inf")
    writer.write(b"abcd", 9.0)
    assert writer.tick(9.0) == pytest.approx(9.05)


@pytest.mark.parametrize("answer", ["ack", "fragments"])
def test_a_reader_that_has_answered_once_is_asked_for_ever(sent, answer):
    writer = Writer(HERE, KEEP_ALL, sent.append)
    writer.match(endpoint(THERE), ROUTE, 0.0)
    writer.write(b"abcd", 0.0)
    for now in range(1, 11):
        writer.tick(float(now))
    if answer == "ack":
        writer.on_ack_nack(THERE, ack(1), 11.0)
    else:
        writer.on_nack_frag(THERE, nack_frag(1, NumberSet(1, (1,))), 11.0)
    sent.clear()
    for now in range(20, 120):
        writer.tick(float(now))
    # Each 2 s, as it is silent.
    assert len(sent.take(Heartbeat)) == 51


def test_a_reader_is_asked_before_the_last_samples_give_way(sent):
    """One that answers loses nothing at 500 samples per second, though the depth is 10."""
    writer = serving(sent, Qos(depth=10), Qos(depth=10))
    for number in range(1, 501):
        now = 1.0 + 0.002 * number
        writer.write(b"x", now)
        beats = sent.take(Heartbeat)
        if any(not each.final for each in beats):
            writer.on_ack_nack(THERE, ack(number + 1, count=number), now)
        sent.clear()
    assert writer.overwritten == 0


def test_a_heartbeat_that_asked_makes_the_next_one_final(sent):
    writer = serving(sent)
    writer.write(b"abcd", 1.0)
    # Not acknowledged: it is asked at 1.05 s, and again by a sample 50 ms later.
    writer.tick(1.0625)
    sent.clear()
    for now in (1.0625, 1.11, 1.125, 1.126):
        writer.write(b"abcd", now)
    assert [each.final for each in sent.take(Heartbeat)] == [True, True, False, True]


# What is sent again.


def test_samples_are_sent_again_to_each_reader_by_itself(sent):
    writer = serving(sent)
    writer.match(endpoint(OTHER), ROUTE, 0.0)
    for _ in range(3):
        writer.write(b"abcd", 1.0, 50)
    sent.clear()
    writer.on_ack_nack(OTHER, ack(1, (1, 3)), 1.5)
    (first, second, beat) = sent
    assert {each.prefix for each in sent} == {OTHER.prefix}
    assert first.submessages[0] == second.submessages[0] == InfoTimestamp(50)
    assert {each.submessages[-1].reader for each in (first, second, beat)} == {0x304}
    sent.clear()
    writer.on_ack_nack(THERE, ack(1, (1,)), 1.5)
    assert numbers(sent, prefix=THERE.prefix) == [1]
    # What is acknowledged needs no memory of when it was sent.
    writer.on_ack_nack(OTHER, ack(3, count=2), 1.6)
    assert [*writer._proxies[OTHER].resent] == [3]


def test_what_is_gone_is_a_gap_for_its_reader(sent):
    writer = serving(sent, Qos(depth=1))
    for _ in range(4):
        writer.write(b"abcd", 1.0)
    sent.clear()
    # 5 was never there, and is no gap.
    writer.on_ack_nack(THERE, ack(1, (1, 2, 5)), 1.0)
    (outgoing,) = sent
    assert outgoing.submessages == (
        Gap(reader=0x204, writer=0x103, start=1, numbers=NumberSet(2, (2,))),
    )


def test_fragments_that_a_sample_does_not_have_are_not_sent(sent):
    """Not even fragment 0, from which a hostile set may begin."""
    writer = serving(sent)
    writer.write(b"abcdefghi", 1.0)
    sent.clear()
    writer.on_nack_frag(THERE, nack_frag(1, NumberSet(0, (0, 1, 2, 3))), 1.0)
    *parts, beat = [each.submessages[-1] for each in sent]
    assert [each.first for each in parts] == [1, 2]
    # The reader is asked whether it has all now.
    assert isinstance(beat, Heartbeat) and not beat.final


def test_a_sample_without_bytes_has_no_fragments(sent):
    writer = serving(sent)
    writer.write(None, 1.0, inline=INLINE, key=True)
    sent.clear()
    writer.on_nack_frag(THERE, nack_frag(1, NumberSet(1, (1,))), 1.0)
    assert not sent
