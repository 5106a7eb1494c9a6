"""Writers and readers as users have them: what they ask of their participant."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from firm_hdl.rtps.endpoints import DataReader, DataWriter
from firm_hdl.rtps.wire.guid import Guid, SampleIdentity

GUID = Guid(bytes(range(12)), 0x103)
IDENTITY = SampleIdentity(GUID, 4)


class Owner:
    """A participant: what it was asked for, and what its endpoints are matched with."""

    def __init__(self):
        self.asked, self.peers = [], ()

    def matched(self, guid):
        assert guid == GUID
        return self.peers

    def wait_until(self, condition, timeout):
        self.asked.append(timeout)
        return condition()

    def write(self, *arguments):
        self.asked.append(arguments)
        return 17

    def remove(self, guid):
        self.asked.append(guid)


@pytest.fixture
def owner():
    return Owner()


@pytest.fixture
def writer(owner):
    return DataWriter(owner, SimpleNamespace(guid=GUID, acknowledged=False), "rt/a", "T")


def test_a_sample_is_written_with_what_it_answers(owner, writer):
    assert writer.write(bytearray(b"abcd"), IDENTITY, timeout=2.5) == 17
    assert writer.write(b"efgh", to=[GUID]) == 17
    assert owner.asked == [
        (writer._writer, b"abcd", IDENTITY, 2.5, None),
        # ROS 2 waits for 100 ms.
        (writer._writer, b"efgh", None, 0.1, [GUID]),
    ]


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        (("text",), TypeError, "^a sample is bytes, not str$"),
        ((None,), TypeError, "^a sample is bytes, not NoneType$"),
        ((5,), TypeError, "^a sample is bytes, not int$"),
        (
            (b"",),
            ValueError,
            "^a sample has at least the 4 bytes of .* 67108864 bytes; this one has 0$",
        ),
        ((b"\0\1\0",), ValueError, "; this one has 3$"),
        ((bytes((64 << 20) + 1),), ValueError, "; this one has 67108865$"),
        ((b"abcd", 5), TypeError, "^a sample is related to a SampleIdentity, not to 5$"),
        ((b"abcd", None, "soon"), ValueError, "soon"),
    ],
)
def test_what_is_no_sample_is_not_written(owner, writer, arguments, error, message):
    with pytest.raises(error, match=message):
        writer.write(*arguments)
    assert owner.asked == []


@pytest.mark.parametrize(
    ("count", "peers", "is_matched"), [(1, 0, False), (1, 1, True), (2, 1, False), (2, 3, True)]
)
def test_as_many_matches_are_awaited_as_were_asked_for(owner, writer, count, peers, is_matched):
    owner.peers = ("a", "b", "c")[:peers]
    assert writer.matched == owner.peers
    assert writer.wait_for_match(count, timeout=0.5) is is_matched
    assert owner.asked == [0.5]


def test_waiting_ends_after_10_seconds_unless_another_time_is_given(owner, writer):
    assert writer.wait_for_match() is writer.wait_for_acknowledgments() is False
    assert writer.wait_for_acknowledgments(timeout=0.25) is False
    writer._writer.acknowledged = True
    assert writer.wait_for_acknowledgments(timeout=3.0) is True
    assert owner.asked == [10.0, 10.0, 0.25, 3.0]


def test_a_reader_tells_what_it_has_lost(owner):
    reader = DataReader(owner, SimpleNamespace(guid=GUID, lost=3), "rt/a", "T", lambda _: None)
    assert reader.lost == 3
    reader.close()
    assert owner.asked == [GUID]
