"""Writers and readers alone: what they send in answer to single submessages."""

from __future__ import annotations

import pytest

from firm_hdl.rtps import Durability, Guid, Qos, Reliability
from firm_hdl.rtps.budget import Budget
from firm_hdl.rtps.discovery import EndpointData, key_of
from firm_hdl.rtps.reader import Reader
from firm_hdl.rtps.wire.guid import PUBLICATIONS_READER
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.parameters import ParameterList, Pid
from firm_hdl.rtps.wire.submessages import (
    AckNack,
    Data,
    DataFrag,
    Gap,
    Heartbeat,
    HeartbeatFrag,
    NackFrag,
    NumberSet,
)
from firm_hdl.rtps.writer import Writer
from tests.rtps.network import route_to

HERE, THERE = Guid(bytes(12), 0x103), Guid(bytes(range(12)), 0x204)
ROUTE = route_to(Address("10.0.0.1", 7411))
KEEP_ALL = Qos(depth=0)
BEST_EFFORT = Qos(reliability=Reliability.BEST_EFFORT)


def endpoint(guid, qos=KEEP_ALL):
    return EndpointData(guid=guid, topic="t", type_name="T", qos=qos)


class Outbox(list):
    """Takes datagrams, and gives the submessages of a kind back."""

    def take(self, kind, prefix=None):
        found = [
            each
            for outgoing in self
            if prefix is None or outgoing.prefix == prefix
            for each in outgoing.submessages
            if isinstance(each, kind)
        ]
        self.clear()
        return found


@pytest.fixture
def sent():
    return Outbox()


@pytest.fixture
def writer(sent):
    made = Writer(HERE, KEEP_ALL, sent.append)
    made.match(endpoint(THERE), ROUTE, 0.0)
    sent.clear()
    return made


def ack(base, missing=(), count=1, final=True):
    numbers = NumberSet(base, tuple(missing))
    return AckNack(reader=0x204, writer=0x103, missing=numbers, count=count, final=final)


@pytest.fixture
def got():
    return []


@pytest.fixture
def reader(sent, got):
    def deliver(writer, data, timestamp):
        got.append(data.sequence_number)

    made = Reader(THERE, KEEP_ALL, sent.append, deliver, Budget(1 << 20))
    made.match(endpoint(HERE), ROUTE, 0.0)
    return made


def data(number, payload=b"abcd"):
    return Data(reader=0, writer=0x103, sequence_number=number, payload=payload)


def heartbeat(first, last, count=1, final=True):
    return Heartbeat(reader=0, writer=0x103, first=first, last=last, count=count, final=final)


def part(number, first, count=1):
    return DataFrag(
        reader=0,
        writer=0x103,
        sequence_number=number,
        first=first,
        count=count,
        fragment_bytes=4,
        sample_bytes=12,
        payload=bytes(4 * count),
    )


def test_what_is_missing_is_sent_again_with_a_heartbeat(writer, sent):
    for _ in range(5):
        writer.write(b"abcd", 1.0)
    sent.clear()
    writer.on_ack_nack(THERE, ack(2, (2, 4)), 1.1)
    again = [each.submessages[-1] for each in sent]
    assert [type(each) for each in again] == [Data, Data, Heartbeat]
    assert [each.sequence_number for each in again[:2]] == [2, 4]
    assert (again[2].first, again[2].last, again[2].final) == (2, 5, False)
    sent.clear()
    # The same answer once more, and a new one at once: neither is acted upon twice.
    writer.on_ack_nack(THERE, ack(2, (2, 4)), 1.101)
    writer.on_ack_nack(THERE, ack(2, (2, 4), count=2), 1.102)
    assert not sent
    writer.on_ack_nack(THERE, ack(2, (2, 4), count=3), 1.2)
    assert len(sent.take(Data)) == 2


def test_numbers_that_a_writer_never_had_are_no_gap(writer, sent):
    writer.write(b"abcd", 1.0)
    sent.clear()
    writer.on_ack_nack(THERE, ack(2, (2, 3)), 1.1)
    assert not sent
    assert writer.acknowledged
    writer.on_ack_nack(THERE, ack(100, (), count=2), 1.1)
    writer.write(b"abcd", 1.2)
    assert not writer.acknowledged


def test_old_samples_are_a_gap_for_a_late_volatile_reader(sent):
    writer = Writer(HERE, Qos(durability=Durability.TRANSIENT_LOCAL), sent.append)
    for _ in range(5):
        writer.write(b"abcd", 1.0)
    writer.match(endpoint(THERE), ROUTE, 2.0)
    (first,) = sent.take(Heartbeat)
    assert (first.first, first.last) == (6, 5)
    writer.on_ack_nack(THERE, ack(1, (1, 3, 5)), 2.1)
    (gap,) = sent.take(Gap)
    assert (gap.start, gap.numbers) == (1, NumberSet(2, (3, 5)))


def test_fragments_that_are_asked_for(writer, sent):
    writer.write(bytes(5000), 1.0)
    assert [each.first for each in sent.take(DataFrag)] == [1, 2, 3, 4]
    asked = NackFrag(
        reader=0x204, writer=0x103, sequence_number=1, missing=NumberSet(2, (2, 4, 9)), count=1
    )
    for _ in range(2):
        writer.on_nack_frag(THERE, asked, 1.1)
    assert [each.first for each in sent.take(DataFrag)] == [2, 4]
    writer.forget(1)
    for number, count, gaps in ((1, 2, [1]), (7, 3, [])):
        # What is gone is a gap; what is still to come is none.
        gone = NackFrag(
            reader=0x204,
            writer=0x103,
            sequence_number=number,
            missing=NumberSet(1, (1,)),
            count=count,
        )
        writer.on_nack_frag(THERE, gone, 1.2)
        assert [each.start for each in sent.take(Gap)] == gaps


def test_answers_of_strangers_and_best_effort_readers_are_ignored(writer, sent):
    other = Guid(bytes(12), 0x304)
    writer.match(endpoint(other, BEST_EFFORT), ROUTE, 0.0)
    writer.write(bytes(5000), 1.0)
    sent.clear()
    asked = NackFrag(
        reader=0x204, writer=0x103, sequence_number=1, missing=NumberSet(1, (1,)), count=1
    )
    for guid in (other, Guid(bytes(12), PUBLICATIONS_READER)):
        writer.on_ack_nack(guid, ack(1, (1,)), 1.1)
        writer.on_nack_frag(guid, asked, 1.1)
    assert not sent


def test_a_reader_asks_for_what_is_missing_and_says_what_is_lost(reader, sent, got):
    reader.on_heartbeat(HERE, heartbeat(1, 0), 1.0)
    assert not sent
    reader.on_data(HERE, data(1), None, 1.0)
    reader.on_data(HERE, data(4), None, 1.0)
    reader.on_heartbeat(HERE, heartbeat(1, 5, count=2), 1.1)
    (answer,) = sent.take(AckNack)
    # The writer need not answer with a heartbeat: it sends the samples.
    assert (answer.missing, answer.final) == (NumberSet(2, (2, 3, 5)), True)
    # The same heartbeat again is none.
    reader.on_heartbeat(HERE, heartbeat(1, 5, count=2), 1.1)
    assert not sent
    reader.on_heartbeat(HERE, heartbeat(4, 5, count=3), 1.2)
    assert got == [1, 4]
    assert reader.lost == 2
    reader.on_gap(HERE, Gap(reader=0, writer=0x103, start=5, numbers=NumberSet(6)), 1.3)
    reader.on_data(HERE, data(6), None, 1.3)
    assert (got, reader.lost) == ([1, 4, 6], 2)


def test_fragments_far_ahead_take_no_memory(sent, got):
    budget = Budget(1 << 20)
    reader = Reader(THERE, KEEP_ALL, sent.append, lambda *_: got.append(1), budget)
    reader.match(endpoint(HERE), ROUTE, 0.0)
    reader.on_heartbeat(HERE, heartbeat(1, 0), 1.0)
    for number, takes in ((4097, False), (1 << 40, False), (4096, True)):
        reader.on_data_frag(HERE, part(number, 2), None, 1.0)
        assert bool(budget.used) is takes


def test_a_reader_repeats_its_request_while_there_is_progress(reader, sent, got):
    reader.on_heartbeat(HERE, heartbeat(1, 50), 1.0)
    asked = len(sent.take(AckNack))
    now = 1.0
    for number in range(1, 51):
        now = max(now, reader.tick(now)) if number % 2 else now
        reader.tick(now)
        asked += len(sent.take(AckNack))
        reader.on_data(HERE, data(number), None, now)
    assert got == list(range(1, 51))
    # Every second sample took a request: more than a reader makes without progress.
    assert asked >= 25
    sent.clear()
    reader.on_heartbeat(HERE, heartbeat(1, 60, count=2), now)
    for _ in range(100):
        now += 1
        reader.tick(now)
    assert len(sent.take(AckNack)) == 20
    # The next heartbeat is a reason to go on.
    reader.on_heartbeat(HERE, heartbeat(1, 60, count=3), now)
    for _ in range(100):
        now += 1
        reader.tick(now)
    assert len(sent.take(AckNack)) == 20


def test_fragments_are_asked_for_when_no_more_come(reader, sent, got):
    reader.on_heartbeat(HERE, heartbeat(1, 0), 1.0)
    reader.on_data_frag(HERE, part(1, 2), None, 1.0)
    reader.on_heartbeat(HERE, heartbeat(1, 1, count=2), 1.001)
    # More may be on their way: the sample as a whole is not asked for either.
    assert [each.submessages[0].missing for each in sent] == [NumberSet(1)]
    assert not sent.take(NackFrag)
    reader.tick(1.03)
    (nack,) = sent.take(NackFrag)
    assert (nack.sequence_number, nack.missing) == (1, NumberSet(1, (1, 3)))
    begun = HeartbeatFrag(reader=0, writer=0x103, sequence_number=1, last=2, count=1)
    for _ in range(2):
        reader.on_heartbeat_frag(HERE, begun, 1.1)
    assert [each.missing for each in sent.take(NackFrag)] == [NumberSet(1, (1,))]
    reader.on_data_frag(HERE, part(1, 1), None, 1.2)
    reader.on_data_frag(HERE, part(1, 3), None, 1.2)
    assert got == [1]


def test_the_end_of_an_instance_is_named_by_its_key_or_its_hash():
    inline = ParameterList(((Pid.KEY_HASH, bytes(THERE)),))
    key = ParameterList(((Pid.ENDPOINT_GUID, bytes(HERE)),)).encode_payload()
    for payload in (None, b""):
        assert key_of(payload, inline, Pid.ENDPOINT_GUID) == THERE
    assert key_of(key, inline, Pid.ENDPOINT_GUID) == HERE
    assert key_of(key, inline, Pid.PARTICIPANT_GUID) == THERE
    assert key_of(None, ParameterList(()), Pid.ENDPOINT_GUID) is None
