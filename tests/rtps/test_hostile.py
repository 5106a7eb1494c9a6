"""Damaged and hostile datagrams: no error, little memory, and the good ones still count."""

from __future__ import annotations

import random
import struct

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from firm_hdl.rtps import Durability, Qos, SampleIdentity
from firm_hdl.rtps.core import Core
from firm_hdl.rtps.wire import message, submessages
from firm_hdl.rtps.wire.guid import Guid
from firm_hdl.rtps.wire.parameters import ParameterList, Pid
from firm_hdl.rtps.wire.submessages import Data, Gap, Heartbeat, NumberSet
from tests.depth import by_depth
from tests.rtps.captures import CAPTURES, SEDP_CYCLONE, SEDP_FAST_DDS
from tests.rtps.network import Network
from tests.rtps.test_core import KEEP_ALL, pair

# A busy machine is no fault.
SLOW = [HealthCheck.too_slow, HealthCheck.data_too_large]


def conversation():
    """Return a station, and datagrams that it took part in."""
    network = Network(seed=1, loss=0.2)
    one, two, writer = pair(network)
    one.writer(Qos(durability=Durability.TRANSIENT_LOCAL), topic="rt/u")
    two.reader(KEEP_ALL, topic="rt/u")
    for size in (8, 3000, 8, 100):
        one.write(writer, bytes(size))
    network.run(3)
    others = [bytes.fromhex(text) for text, *_ in CAPTURES.values()]
    return two, [*network.sent, *others, bytes.fromhex(SEDP_FAST_DDS), bytes.fromhex(SEDP_CYCLONE)]


TARGET, SEEN = conversation()


def damaged(datagram, random):
    """Return a datagram with some bytes changed, removed or repeated."""
    data = bytearray(datagram)
    for _ in range(random.randrange(1, 6)):
        at = random.randrange(4, len(data))
        match random.randrange(5):
            case 0:
                data[at] ^= 1 << random.randrange(8)
            case 1:
                data[at] = random.choice((0, 1, 0x7F, 0x80, 0xFF))
            case 2 if len(data) > 30:
                del data[at : at + random.randrange(1, 9)]
            case 3:
                data[at:at] = random.randbytes(random.randrange(1, 9))
            case 4:
                data[at : at + 4] = struct.pack("<i", random.choice((-1, 0, 1, 2**31 - 1, 255)))
        if len(data) < 24:
            break
    return bytes(data)


@given(seed=st.integers(0, 2**64))
@settings(max_examples=by_depth(30, 10_000), deadline=None, suppress_health_check=SLOW)
def test_damaged_datagrams_raise_nothing(seed):
    generator = random.Random(seed)
    for _ in range(40):
        datagram = damaged(generator.choice(SEEN), generator)
        TARGET.core.receive(datagram, TARGET.network.now)
    TARGET.core.tick(TARGET.network.now)
    assert TARGET.core._budget.used <= TARGET.core._budget.limit
    while TARGET.core.outbox:
        TARGET.core.pop()
    TARGET.take_events()
    TARGET.events.clear()


@given(st.binary(max_size=200))
@settings(max_examples=by_depth(100, 20_000), deadline=None, suppress_health_check=SLOW)
def test_random_bytes_raise_nothing(data):
    for datagram in (data, b"RTPS\x02\x03\x01\x0f" + bytes(12) + data):
        TARGET.core.receive(datagram, TARGET.network.now)


def test_that_an_error_would_be_noticed(monkeypatch):
    """The twin: with a decoder that raises something else, the same datagrams raise it."""

    def broken(kind, flags, body):
        raise KeyError(kind)

    monkeypatch.setattr(message, "decode", broken)
    with pytest.raises(KeyError):
        TARGET.core.receive(SEEN[0], TARGET.network.now)
    assert submessages.decode is not broken


def test_what_is_wrong_is_counted():
    station = Network().station()
    for datagram in (b"", b"RTPS", message.write(bytes(12), []) + b"\7\1"):
        station.core.receive(datagram, 0.0)
    assert station.core.counters == {"received": 3, "malformed": 3, "unknown": 0}
    # A datagram counts once, however many of its submessages are not known.
    station.core.receive(message.write(bytes(12), []) + bytes.fromhex("80010000"), 0.0)
    twice = bytes.fromhex("8001040000000000") * 2
    station.core.receive(message.write(bytes(12), []) + twice, 0.0)
    assert station.core.counters == {"received": 5, "malformed": 3, "unknown": 2}


def test_a_sample_whose_inline_qos_is_damaged_arrives_without_it():
    network = Network()
    one, two, writer = pair(network)
    one.write(writer, b"good")
    network.run(1)
    for number, identity in enumerate((bytes(20), bytes(24)), 2):
        data = Data(
            reader=0,
            writer=writer.guid.entity,
            sequence_number=number,
            payload=bytes([number]) * 4,
            inline=ParameterList(((Pid.RELATED_SAMPLE_IDENTITY, identity),)),
        )
        two.core.receive(message.write(writer.guid.prefix, [data]), network.now)
    network.run(1)
    whole = SampleIdentity(Guid(bytes(12), 0), 0)
    assert [each.related for each in two.samples] == [None, None, whole]
    assert two.core.counters["malformed"] == 1


def test_heartbeats_and_gaps_of_strangers_are_ignored():
    network = Network()
    _, two, writer = pair(network)
    stranger = bytes(11) + b"\x77"
    evil = [
        Heartbeat(reader=0, writer=writer.guid.entity, first=1 << 60, last=1 << 61, count=1),
        Gap(reader=0, writer=writer.guid.entity, start=1, numbers=NumberSet(1 << 60)),
    ]
    two.core.receive(message.write(stranger, evil), network.now)
    one = network.stations[0]
    one.write(writer, b"good")
    assert network.run(1, lambda: two.payloads == [b"good"])


def test_nobody_can_announce_or_end_the_endpoints_of_others():
    network = Network()
    one, two, _ = pair(network)
    evil = network.station()
    network.run(2)
    forged = [each for each in network.sent if each[8:20] == one.core.prefix]
    spoofed = [each[:8] + evil.core.prefix + each[20:] for each in forged]
    for datagram in spoofed:
        two.core.receive(datagram, network.now)
    assert {each.guid.prefix for each in two.core.remotes(writers=True)} == {one.core.prefix}
    assert isinstance(two.core, Core) and len(two.core.peers) == 2
