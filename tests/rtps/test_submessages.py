"""Submessages and their receiver: bytes written by hand, both byte orders, what is not valid."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from firm_hdl.rtps.wire import message
from firm_hdl.rtps.wire.guid import Guid, SampleIdentity
from firm_hdl.rtps.wire.octets import Cursor, MalformedError
from firm_hdl.rtps.wire.parameters import ParameterList
from firm_hdl.rtps.wire.submessages import (
    AckNack,
    Data,
    DataFrag,
    Gap,
    Heartbeat,
    HeartbeatFrag,
    InfoDestination,
    InfoSource,
    InfoTimestamp,
    NackFrag,
    NumberSet,
    encode,
)
from tests.depth import by_depth

# A busy machine is no fault.
SLOW = [HealthCheck.too_slow, HealthCheck.data_too_large]

ME, OTHER = bytes(range(12)), bytes(range(12, 24))
HEARTBEAT = Heartbeat(reader=1, writer=2, first=1, last=3, count=4)

ENTITIES = {"reader": st.integers(0, 2**32 - 1), "writer": st.integers(0, 2**32 - 1)}
NUMBERS = st.integers(1, 2**62)
COUNTS = st.integers(0, 2**32 - 1)
PARAMETERS = st.lists(
    st.tuples(
        st.integers(2, 0xFFFF).filter(lambda pid: not 0x4000 <= pid < 0x8000),
        st.binary(max_size=24).map(lambda data: data[: len(data) & ~3]),
    ),
    max_size=4,
)


@st.composite
def number_sets(draw, largest=2**62):
    base = draw(st.integers(1, largest))
    offsets = draw(st.sets(st.integers(0, 255), max_size=40))
    return NumberSet.of(base, (base + each for each in offsets))


@st.composite
def fragments(draw, little):
    size = draw(st.integers(1, 300))
    whole = draw(st.integers(1, 3000))
    last = -(-whole // size)
    first = draw(st.integers(1, last))
    count = draw(st.integers(1, last - first + 1))
    length = min(count * size, whole - (first - 1) * size)
    return DataFrag(
        reader=draw(ENTITIES["reader"]),
        writer=draw(ENTITIES["writer"]),
        sequence_number=draw(NUMBERS),
        first=first,
        count=count,
        fragment_bytes=size,
        sample_bytes=whole,
        payload=draw(st.binary(min_size=length, max_size=length)),
        inline=ParameterList(tuple(draw(PARAMETERS)), little),
    )


def submessages(little):
    """Return a strategy for submessages whose inline QoS has this byte order."""
    inline = PARAMETERS.map(lambda items: ParameterList(tuple(items), little))
    data = st.builds(
        Data, sequence_number=NUMBERS, payload=st.binary(max_size=99), inline=inline, **ENTITIES
    )
    ended = st.builds(Data, sequence_number=NUMBERS, payload=st.none(), inline=inline, **ENTITIES)
    bounds = st.tuples(NUMBERS, st.integers(-1, 1000))
    return st.one_of(
        data,
        ended,
        fragments(little),
        bounds.flatmap(
            lambda pair: st.builds(
                Heartbeat,
                first=st.just(pair[0]),
                last=st.just(pair[0] + pair[1]),
                count=COUNTS,
                final=st.booleans(),
                **ENTITIES,
            )
        ),
        st.builds(AckNack, missing=number_sets(), count=COUNTS, final=st.booleans(), **ENTITIES),
        st.builds(Gap, start=NUMBERS, numbers=number_sets(), **ENTITIES),
        st.builds(HeartbeatFrag, sequence_number=NUMBERS, last=COUNTS, count=COUNTS, **ENTITIES),
        st.builds(
            NackFrag,
            sequence_number=NUMBERS,
            missing=number_sets(2**31),
            count=COUNTS,
            **ENTITIES,
        ),
    )


def normal(submessage):
    """Return a submessage as it is read: without inline QoS, there is no byte order."""
    inline = getattr(submessage, "inline", None)
    if inline is None or inline.items:
        return submessage
    return replace(submessage, inline=ParameterList(()))


@pytest.mark.parametrize("little", [True, False], ids=["little", "big"])
@settings(max_examples=by_depth(30, 2000), deadline=None, suppress_health_check=SLOW)
@given(data=st.data(), stamp=st.none() | st.integers(0, 2**32 * 10**9 - 1))
def test_what_is_written_is_read_again(little, data, stamp):
    sent = data.draw(st.lists(submessages(little), max_size=5))
    every = [InfoDestination(ME), InfoSource(OTHER), InfoTimestamp(stamp), *sent]
    content = message.read(message.write(OTHER[::-1], every, little), ME)
    assert content.error is None
    assert [each.submessage for each in content.received] == [normal(each) for each in sent]
    assert {(each.source, each.timestamp) for each in content.received} <= {(OTHER, stamp)}


def test_bytes_of_both_byte_orders_by_hand():
    big = bytes.fromhex("07 00 001c 00000001 00000002 00000000 00000001 00000000 00000003 00000004")
    little = bytes.fromhex(
        "07 01 1c00 00000001 00000002 00000000 01000000 00000000 03000000 04000000"
    )
    assert encode(HEARTBEAT, little=False) == big
    assert encode(HEARTBEAT) == little
    # A number of more than 32 bits: the high half comes first, whatever the byte order.
    far = AckNack(reader=1, writer=2, missing=NumberSet(2**32 + 5, (2**32 + 6,)), count=9)
    assert encode(far) == bytes.fromhex(
        "06 01 1c00 00000001 00000002 01000000 05000000 02000000 00000040 09000000"
    )
    assert encode(far, little=False) == bytes.fromhex(
        "06 00 001c 00000001 00000002 00000001 00000005 00000002 40000000 00000009"
    )
    data = Data(
        reader=1,
        writer=2,
        sequence_number=7,
        payload=b"abcd",
        inline=ParameterList(((0x70, bytes(4)),), little=False),
    )
    assert encode(data, little=False) == bytes.fromhex(
        "15 06 0024 0000 0010 00000001 00000002 00000000 00000007"
        "0070 0004 00000000 0001 0000 61626364"
    )


def test_fields_of_later_versions_are_skipped():
    """9.4.5.4: the inline QoS begins where the header says."""
    head = "0000 {} 00000001 00000002 00000000 07000000"
    data = bytes.fromhex("15 07 2c00" + head.format("1800") + "ffffffffffffffff")
    tail = bytes.fromhex("70000400 01020304 01000000 61626364")
    (read,) = message.read(message.write(OTHER, []) + data + tail, ME).received
    assert read.submessage.payload == b"abcd"
    assert read.submessage.inline.items == ((0x70, b"\1\2\3\4"),)
    sizes = "01000000 0100 0400 04000000"
    part = bytes.fromhex("16 03 3400" + head.format("2000") + sizes + "ffffffff")
    (read,) = message.read(message.write(OTHER, []) + part + tail, ME).received
    assert (read.submessage.payload, len(read.submessage.inline.items)) == (b"abcd", 1)


@pytest.mark.parametrize("version", [b"\2\0", b"\2\1", b"\2\2", b"\2\4", b"\2\xff"])
def test_other_minor_versions_are_read(version):
    """8.6.1: old releases of peers write 2.1 and 2.2, and later ones keep to what is known."""
    datagram = message.write(OTHER, [HEARTBEAT])
    content = message.read(datagram[:4] + version + datagram[6:], ME)
    assert [each.submessage for each in content.received] == [HEARTBEAT] and not content.error
    for major in (1, 3):
        with pytest.raises(MalformedError, match=rf"^RTPS version {major}\.{version[1]}$"):
            message.read(datagram[:4] + bytes([major, version[1]]) + datagram[6:], ME)


def test_the_identifier_of_the_standard_counts_more_than_that_of_a_vendor():
    standard, own = (bytes([number]) * 16 + bytes(4) + b"\7\0\0\0" for number in (1, 2))
    both = ParameterList(((0x800F, own), (0x0083, standard)))
    alone = ParameterList(((0x800F, own),))
    for vendor, related in ((b"\1\x0f", own), (b"\1\xff", own), (b"\1\x10", None)):
        assert both.related(vendor) == SampleIdentity(Guid.parse(standard), 7)
        wanted = None if related is None else SampleIdentity(Guid.parse(related), 7)
        assert alone.related(vendor) == wanted


def test_a_set_has_at_most_256_numbers():
    full = NumberSet.of(5, range(400))
    assert (full.base, full.members) == (5, tuple(range(5, 5 + 256)))
    assert full.bitmap("<") == bytes.fromhex("00010000") + b"\xff" * 32
    gap = Gap(reader=1, writer=2, start=1, numbers=full)
    (read,) = message.read(message.write(OTHER, [gap]), ME).received
    assert read.submessage == gap


def test_a_size_of_0_means_to_the_end():
    whole = encode(Data(reader=1, writer=2, sequence_number=7, payload=bytes(70_000)))
    assert whole[2:4] == bytes(2)
    head = message.write(OTHER, [])
    content = message.read(head + encode(HEARTBEAT) + whole, ME)
    assert [type(each.submessage) for each in content.received] == [Heartbeat, Data]
    assert content.received[1].submessage.payload == bytes(70_000)
    # INFO_TS and PAD may be empty.
    empty = bytes.fromhex("09030000 01010000")
    content = message.read(head + empty + encode(HEARTBEAT), ME)
    assert [each.submessage for each in content.received] == [HEARTBEAT]
    assert content.unknown == 0


def test_the_largest_size_that_a_header_can_say():
    # 20 bytes of a DATA are before its payload.
    for extra, size in ((-1, 0xFFFE), (0, 0xFFFF), (1, 0)):
        whole = Data(reader=1, writer=2, sequence_number=7, payload=bytes(0xFFFF - 20 + extra))
        written = encode(whole)
        assert int.from_bytes(written[2:4], "little") == size
        content = message.read(message.write(OTHER, []) + written, ME)
        assert content.received[0].submessage == whole


def test_a_receiver_interprets_submessages_in_order():
    other = Heartbeat(reader=1, writer=2, first=1, last=1, count=1)
    every = [
        InfoTimestamp(5),
        HEARTBEAT,
        InfoDestination(OTHER),
        other,
        InfoDestination(bytes(12)),
        HEARTBEAT,
        InfoSource(ME[::-1]),
        HEARTBEAT,
        InfoTimestamp(None),
        HEARTBEAT,
    ]
    content = message.read(message.write(OTHER, every), ME)
    read = [(each.source, each.timestamp) for each in content.received]
    assert read == [(OTHER, 5), (OTHER, 5), (ME[::-1], None), (ME[::-1], None)]


def test_unknown_kinds_are_skipped():
    unknown = bytes.fromhex("80010400 aabbccdd")
    datagram = message.write(OTHER, []) + unknown + encode(HEARTBEAT)
    content = message.read(datagram, ME)
    assert content.unknown == 1
    assert [each.submessage for each in content.received] == [HEARTBEAT]


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("0701", "part of a submessage's header"),
        ("07011d00" + "00" * 28, "a submessage that is longer than its datagram"),
        ("07011b00" + "01" * 27, "4 bytes at 24 of 27"),
        ("07011c00" + "00" * 28, "sequence number 0"),
        (
            "07011c00 0000000100000002 0000000005000000 0000000003000000 01000000",
            "a heartbeat from 5 to 3",
        ),
        ("06011800 0000000100000002 0000000001000000 01010000 00000000", "a set of 257 numbers"),
        ("08011c00 0000000100000002 00000000ffffffff ffffffffffffffff 00000000", "a set of 0 num"),
        ("13011c00 0000000100000002 0000000000000000 02000000 01000000 00000000", "sequence numb"),
        ("12011c00 0000000100000002 0000000000000000 02000000 00000000 00000000", "sequence numb"),
        ("15011400 00001000 0000000100000002 0000000000000000", "sequence number 0"),
        ("15010800 0000100000000001", "16 bytes at 4 of 8"),
        ("150d1400 00001000 0000000100000002 0000000001000000", "data and key at once"),
        ("15031800 00001000 0000000100000002 0000000001000000 70000800", "8 bytes at 24 of 24"),
        ("15050800 0000ffff00000001 00000002 0000000001000000", "65535 bytes at 4 of 8"),
        (
            "16012000 00001c00 0000000100000002 0000000001000000 01000000 0000 0400 10000000",
            "0 fragments of 4 bytes from 1 of 16 bytes",
        ),
        (
            "16012000 00001c00 0000000100000002 0000000001000000 05000000 0100 0400 10000000",
            "1 fragments of 4 bytes from 5 of 16 bytes",
        ),
        (
            "16012000 00001c00 0000000100000002 0000000001000000 01000000 0100 0400 10000000",
            "4 bytes at 32 of 32",
        ),
    ],
)
def test_what_is_not_valid_ends_the_datagram(text, error):
    head = message.write(OTHER, [HEARTBEAT])
    content = message.read(head + bytes.fromhex(text), ME)
    assert content.error is not None
    assert content.error.startswith(error)
    # What came before counts.
    assert [each.submessage for each in content.received] == [HEARTBEAT]


@pytest.mark.parametrize(
    "datagram",
    [b"", b"RTPS", b"RTPX" + bytes(16), b"RTPS\x01\x00" + bytes(14), b"RTPS\x03\x00" + bytes(14)],
)
def test_what_is_no_datagram_of_ours(datagram):
    with pytest.raises(MalformedError):
        message.read(datagram, ME)


def test_parameter_lists():
    # PAD is skipped; "must understand" is no part of a standard identifier, but of a vendor's.
    text = "0000 0400 00000000  7040 0400 01020304  0fc0 0000  7000 0000  0100 0000  ff"
    cursor = Cursor(bytes.fromhex(text), little=True)
    read = ParameterList.decode(cursor)
    assert read.items == ((0x70, b"\1\2\3\4"), (0xC00F, b""), (0x70, b""))
    assert cursor.left == 1
    assert len(read.every(0x70)) == 2
    assert read.first(0x71) is None
    for bad in ("70000400", "", "7000"):
        with pytest.raises(MalformedError):
            ParameterList.decode(Cursor(bytes.fromhex(bad), little=True))
    most = bytes.fromhex("70000000") * 512
    end = bytes.fromhex("01000000")
    assert len(ParameterList.decode(Cursor(most + end, little=True)).items) == 512
    with pytest.raises(MalformedError, match=r"^more than 512 parameters$"):
        ParameterList.decode(Cursor(most + most[:4] + end, little=True))
    with pytest.raises(MalformedError, match=r"^encapsulation 0001 is no parameter list$"):
        ParameterList.decode_payload(bytes.fromhex("00010000 01000000"))
    with pytest.raises(ValueError, match=r"^parameter 0x0070 has 65536 bytes$"):
        ParameterList(((0x70, bytes(0x10000)),)).encode()


def test_strings_that_do_not_end():
    assert Cursor(b"\3\0\0\0ab\0", little=True).string() == "ab"
    assert Cursor(b"\2\0\0\0ab", little=True).string() == "ab"
    assert Cursor(b"\3\0\0\0a\xff\0", little=True).string() == "a\N{REPLACEMENT CHARACTER}"
    with pytest.raises(MalformedError):
        Cursor(b"\xff\xff\xff\xffab", little=True).string()
