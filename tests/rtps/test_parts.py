"""Small parts: fragments, policies, ports and addresses, pacing."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from firm_hdl.rtps import Durability, Qos, Reliability
from firm_hdl.rtps.backlog import Backlog
from firm_hdl.rtps.budget import Budget
from firm_hdl.rtps.discovery import EndpointData, ParticipantData
from firm_hdl.rtps.participant import Pacer
from firm_hdl.rtps.qos import duration, seconds
from firm_hdl.rtps.spdp import Settings
from firm_hdl.rtps.wire import locators
from firm_hdl.rtps.wire.guid import Guid, is_keyed, user_reader, user_writer
from firm_hdl.rtps.wire.locators import Address, Ports
from firm_hdl.rtps.wire.octets import Cursor, MalformedError
from firm_hdl.rtps.wire.parameters import ParameterList
from firm_hdl.rtps.wire.submessages import Data, fragment, fragment_count

# A busy machine is no fault.
SLOW = [HealthCheck.too_slow, HealthCheck.data_too_large]

GUID = Guid(bytes(range(12)), 0x103)


@settings(deadline=None, suppress_health_check=SLOW)
@given(payload=st.binary(min_size=1, max_size=500), size=st.integers(1, 64), random=st.randoms())
def test_samples_are_put_together_in_any_order(payload, size, random):
    sample = Data(reader=1, writer=2, sequence_number=3, payload=payload)
    count = fragment_count(len(payload), size)
    parts = [fragment(sample, number, size) for number in range(1, count + 1)]
    random.shuffle(parts)
    budget = Budget(1 << 20)
    backlog = Backlog(GUID.prefix, budget)
    done = [backlog.add(each) for each in [*parts[:-1], *parts[:-1], parts[-1]]]
    assert done[:-1] == [None] * (len(done) - 1)
    assert done[-1] == sample
    assert budget.used == 0


@pytest.mark.parametrize(("in_order", "left"), [(True, [1, 2]), (False, [4, 5])])
def test_the_incomplete_sample_that_counts_least_makes_room(in_order, left):
    """Of a reliable writer, the first ones count most; of a best-effort one, the last ones."""
    budget = Budget(2 * (1000 + 200))
    backlog = Backlog(GUID.prefix, budget, in_order)
    for number in range(1, 6):
        sample = Data(reader=1, writer=2, sequence_number=number, payload=bytes(2000))
        assert backlog.add(fragment(sample, 1, 1000)) is None
    assert [number for number in range(1, 6) if backlog.has_part(number)] == left
    backlog.clear()
    assert budget.used == 0


class Holder:
    """Memory of a peer, in values of 100 bytes, of which it gives one back."""

    def __init__(self, budget, peer):
        self.budget, self.prefix = budget, bytes([peer])

    def take(self, count):
        return sum(self.budget.take(self, 100) for _ in range(count))

    def shrink(self):
        self.budget.give_back(self, 100)

    @property
    def values(self):
        return self.budget.of(self) / 300


def test_peers_get_their_shares_of_memory_whoever_takes_first():
    budget = Budget(12 * 300)
    first, second, third = (Holder(budget, peer) for peer in (1, 2, 3))
    also_third = Holder(budget, 3)
    assert first.take(99) == 12
    assert (second.take(99), first.values) == (6, 6)
    # What counts is the peer, however many endpoints it has.
    assert third.take(99) == 4 and also_third.take(99) == 2
    assert [each.values for each in (first, second, third, also_third)] == [4, 4, 2, 2]
    for each in (first, second, third, also_third):
        for _ in range(int(each.values)):
            each.shrink()
    assert budget.used == 0 and first.take(99) == 12


def test_incomplete_samples_are_limited():
    """64 of them, or 4 if they are not sent again; 64 MiB of each, and 131,072 fragments."""
    for in_order, left in ((True, [*range(1, 65)]), (False, [62, 63, 64, 65])):
        backlog = Backlog(GUID.prefix, Budget(1 << 20), in_order)
        for number in range(1, 66):
            sample = Data(reader=1, writer=2, sequence_number=number, payload=bytes(8))
            assert backlog.add(fragment(sample, 2, 4)) is None
        assert [number for number in range(1, 66) if backlog.has_part(number)] == left
    # There is no fragment beyond the last one, whatever a heartbeat says.
    assert backlog.missing(65, last=9) == [1]
    part = fragment(Data(reader=1, writer=2, sequence_number=99, payload=bytes(8)), 1, 4)
    for size, whole, begun in (
        (1024, 64 << 20, True),
        (1024, (64 << 20) + 1, False),
        (4, 4 << 17, True),
        (4, (4 << 17) + 1, False),
        (1024, (1 << 32) - 1, False),
    ):
        new = replace(part, fragment_bytes=size, sample_bytes=whole, payload=bytes(size))
        assert backlog.add(new) is None
        assert backlog.has_part(99) is begun
        backlog.drop(99)


def test_tables_of_policies():
    """DDS table 2.2.3, by hand: which offers satisfy a request."""
    best, reliable = Reliability
    pairs = [
        ({"reliability": best}, {"reliability": reliable}, "RELIABILITY"),
        ({"reliability": reliable}, {"reliability": best}, None),
        ({}, {"durability": Durability.TRANSIENT_LOCAL}, "DURABILITY"),
        ({"durability": Durability.PERSISTENT}, {"durability": Durability.TRANSIENT}, None),
        ({"deadline": 2.0}, {"deadline": 1.0}, "DEADLINE"),
        ({"deadline": 1.0}, {"deadline": 2.0}, None),
        ({"liveliness": 0}, {"liveliness": 2}, "LIVELINESS"),
        ({"lease": 2.0}, {"lease": 1.0}, "LIVELINESS"),
        ({"lease": 1.0, "liveliness": 2}, {"lease": 2.0, "liveliness": 1}, None),
        ({"exclusive": True}, {}, "OWNERSHIP"),
        ({}, {"exclusive": True}, "OWNERSHIP"),
        ({"partitions": ("a",)}, {}, "PARTITION"),
        ({}, {"partitions": ("a",)}, "PARTITION"),
        ({"partitions": ("",)}, {}, None),
        ({"partitions": ("a", "b")}, {"partitions": ("b",)}, None),
        ({"representations": (2,)}, {}, "DATA_REPRESENTATION"),
        ({"representations": (0,)}, {"representations": (2, 0)}, None),
        # A writer uses the first of those that it names.
        ({"representations": (2, 0)}, {}, "DATA_REPRESENTATION"),
        ({"representations": (0, 2)}, {}, None),
    ]
    for offered, asked, problem in pairs:
        expected = () if problem is None else (problem,)
        assert Qos(**asked).refused(Qos(**offered)) == expected, (offered, asked)
    asked = Qos(deadline=1.0, exclusive=True, partitions=("a",))
    problems = asked.refused(Qos(reliability=best))
    assert problems == ("RELIABILITY", "DEADLINE", "OWNERSHIP", "PARTITION")


@settings(deadline=None, suppress_health_check=SLOW)
@given(
    qos=st.builds(
        Qos,
        reliability=st.sampled_from(Reliability),
        durability=st.sampled_from(Durability),
        deadline=st.sampled_from([0.5, 3.0, float("inf")]),
        liveliness=st.integers(0, 2),
        lease=st.sampled_from([0.25, float("inf")]),
        exclusive=st.booleans(),
        partitions=st.lists(st.text("abc", min_size=1), max_size=3).map(tuple),
        representations=st.just((0,)),
    ),
    writer=st.booleans(),
    user=st.binary(max_size=40),
)
def test_endpoints_are_read_as_they_are_written(qos, writer, user):
    data = EndpointData(
        guid=GUID,
        topic="rt/é",
        type_name="T",
        qos=qos,
        addresses=(Address("10.1.2.3", 7411),),
        user_data=user,
    )
    assert EndpointData.decode(data.encode(), writer) == data


def test_defaults_of_policies_differ_for_writers_and_readers():
    bare = ParameterList(((0x5A, bytes(GUID)), (0x05, b"\2\0\0\0t\0"), (0x07, b"\2\0\0\0T\0")))
    written = EndpointData.decode(bare.encode_payload(), writer=True)
    read = EndpointData.decode(bare.encode_payload(), writer=False)
    assert (written.qos.reliable, read.qos.reliable) == (True, False)
    with pytest.raises(MalformedError, match=r"^an endpoint without topic$"):
        EndpointData.decode(ParameterList(bare.items[:1]).encode_payload(), writer=True)


@settings(deadline=None, suppress_health_check=SLOW)
@given(
    domain=st.none() | st.integers(0, 232),
    name=st.text("abé", max_size=9),
    user=st.binary(max_size=9),
)
def test_participants_are_read_as_they_are_written(domain, name, user):
    data = ParticipantData(
        prefix=bytes(range(12)),
        discovery=(Address("10.1.2.3", 7410), Address("127.0.0.1", 7410)),
        user=(Address("10.1.2.3", 7411),),
        lease=2.5,
        user_data=user,
        name=name,
        domain=domain,
    )
    assert ParticipantData.decode(data.encode()) == data


def test_policies_on_the_wire_by_hand():
    def written(pid, **policies):
        return dict(Qos(**policies).parameters())[pid].hex(" ", 4)

    # HISTORY: KEEP_LAST is 0, KEEP_ALL is 1.
    assert written(0x40, depth=3) == "00000000 03000000"
    assert written(0x40, depth=0) == "01000000 01000000"
    assert written(0x1A) == "02000000 00000000 9a999919"
    assert written(0x1D, durability=Durability.TRANSIENT_LOCAL) == "01000000"
    assert written(0x1B, liveliness=1, lease=2.5) == "01000000 02000000 00000080"
    assert written(0x23) == "ffffff7f ffffffff"
    assert written(0x1F, exclusive=True) == "01000000"
    assert written(0x29, partitions=("abc", "d")) == "02000000 04000000 61626300 02000000 64000000"


def test_durations_that_are_infinite():
    """9.3.2: the largest number of seconds, whatever the fraction is."""
    assert duration(2**31 - 1) == duration(1e99) == bytes.fromhex("ffffff7f ffffffff")
    assert duration(2**31 - 2) == bytes.fromhex("feffff7f 00000000")
    for fraction in ("00000000", "ffffffff"):
        assert seconds(Cursor(bytes.fromhex("ffffff7f" + fraction), True)) == float("inf")
    assert seconds(Cursor(bytes.fromhex("feffff7f 00000080"), True)) == 2**31 - 1.5


def test_defaults_of_participants():
    """9.6.2.2.2: what an announcement leaves out."""
    bare = ParameterList(((0x50, bytes(GUID)),))
    read = ParticipantData.decode(bare.encode_payload())
    assert (read.prefix, read.vendor, read.lease) == (GUID.prefix, bytes(2), 100.0)
    assert (read.discovery, read.user, read.user_data, read.name) == ((), (), b"", "")
    assert read.domain is None
    # SPDP, and SEDP of publications and subscriptions.
    assert [bit for bit in range(32) if read.has(bit)] == [0, 1, 2, 3, 4, 5]
    with pytest.raises(MalformedError, match=r"^a participant without GUID$"):
        ParticipantData.decode(ParameterList(()).encode_payload())


def test_user_data_is_limited():
    guid = (0x50, bytes(GUID))
    for size, wrong in ((4096, None), (4097, r"^user data of 4097 bytes$")):
        value = size.to_bytes(4, "little") + b"u" * size
        payload = ParameterList((guid, (0x2C, value))).encode_payload()
        if wrong is None:
            assert ParticipantData.decode(payload).user_data == b"u" * size
        else:
            with pytest.raises(MalformedError, match=wrong):
                ParticipantData.decode(payload)


def test_kinds_of_endpoints():
    """Table 9.1: the two upper bits of the kind say whose they are, the others what they are."""
    assert (user_writer(1), user_reader(0x203)) == (0x103, 0x20304)
    for kind, keyed in ((0x02, True), (0x03, False), (0x04, False), (0x07, True)):
        for owner in (0x00, 0x40, 0xC0):
            assert is_keyed(0x100 | owner | kind) is keyed


def test_participants_in_big_endian_by_hand():
    payload = bytes.fromhex(
        "00020000"
        "00500010 000102030405060708090a0b 000001c1"
        "00320018 00000001 00001cf2 000000000000000000000000 0a010203"
        "00020008 00000014 80000000"
        "00580004 0000003f"
        "002c000c 00000008 656e636c6176653d"
        "00010000"
    )
    read = ParticipantData.decode(payload)
    assert read.prefix == bytes(range(12))
    assert read.discovery == (Address("10.1.2.3", 7410),)
    assert (read.lease, read.endpoints, read.user_data) == (20.5, 0x3F, b"enclave=")


def test_ports_of_the_standard():
    """9.6.1.1, by hand."""
    assert Ports.of(0, 0) == (7400, 7410, 7411)
    assert Ports.of(0, 3) == (7400, 7416, 7417)
    assert Ports.of(42, 1) == (17900, 17912, 17913)
    assert Ports.of(232, 62) == (65400, 65534, 65535)
    for domain, participant in ((-1, 0), (233, 0), (232, 63)):
        with pytest.raises(ValueError, match=r"[Dd]omain"):
            Ports.of(domain, participant)


def test_addresses_of_other_transports_are_left_out():
    good = locators.encode(Address("10.0.0.1", 7410))
    ipv6 = b"\2\0\0\0" + good[4:]
    memory = b"\0\0\0\1" + good[4:]
    group, none = (locators.encode(Address(h, 7410)) for h in ("239.255.0.1", "0.0.0.0"))
    no_port = locators.encode(Address("10.0.0.1", 0))
    values = [Cursor(each, True) for each in (ipv6, memory, group, none, no_port, good)]
    assert locators.decode(values) == (Address("10.0.0.1", 7410),)


def test_pacing():
    pacer = Pacer(1e6)
    assert pacer.wait(1.0) == 0
    pacer.note((64 << 10) - 1)
    assert pacer.wait(1.0) == 0
    pacer.note(1001)
    # 1,000 bytes of debt, and 16 KiB that are sent at once then.
    assert pacer.wait(1.0) == pytest.approx(0.017384)
    assert pacer.wait(1.01) == pytest.approx(0.007384)
    assert pacer.wait(1.0174) == 0
    pacer.note(16000)
    assert pacer.wait(1.0174) == 0
    pacer.note(1000)
    assert pacer.wait(1.0174) > 0
    # A pause gives no more than one burst.
    assert pacer.wait(1000.0) == 0
    pacer.note((64 << 10) + 500)
    assert pacer.wait(1000.0) == pytest.approx(0.016884)
    with pytest.raises(ValueError, match=r"^Rate must be positive, not 0$"):
        Pacer(0)


def test_values_out_of_range():
    with pytest.raises(ValueError, match=r"^Depth must be at least 0, not -1$"):
        Qos(depth=-1)
    with pytest.raises(ValueError, match=r"^Limit of samples must be at least 1, not 0$"):
        Qos(max_samples=0)
    own = ParticipantData(prefix=bytes(12), discovery=(), user=(), lease=1)
    given = {"own": own, "host": "", "targets": ()}
    for size in (255, 65_001):
        wrong = f"^Fragments must have from 256 to 65000 bytes, not {size}$"
        with pytest.raises(ValueError, match=wrong):
            Settings(**given, fragment_bytes=size)
    for size in (256, 65_000):
        assert Settings(**given, fragment_bytes=size).fragment_bytes == size
