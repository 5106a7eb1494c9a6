"""The sockets of a participant, and samples in fragments, at the limits of what they take."""

from __future__ import annotations

import socket

import pytest

from firm_hdl.rtps.backlog import Backlog
from firm_hdl.rtps.budget import Budget
from firm_hdl.rtps.transport import Transport
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.wire.parameters import ParameterList, Pid
from firm_hdl.rtps.wire.submessages import Data, DataFrag, fragment
from tests.rtps.test_participant import DOMAIN

THERE = Address("127.0.0.1", 9)
INLINE = ParameterList(((Pid.KEY_HASH, bytes(16)),))


@pytest.fixture
def transport():
    made = Transport(DOMAIN, "127.0.0.1")
    yield made
    made.close()


class Socket:
    """What the system says, call by call: bytes, or an error that is raised."""

    def __init__(self, *answers):
        self.answers = list(answers)

    def recvfrom(self, size):
        return self._next(), ("10.0.0.5", 7411)

    def sendto(self, datagram, address):
        return self._next()

    def _next(self):
        answer = self.answers.pop(0)
        if isinstance(answer, OSError):
            raise answer
        return answer

    def close(self):
        return


@pytest.mark.parametrize(
    ("answer", "is_taken"),
    [
        (4, True),
        # Later, there may be room.
        (BlockingIOError(), False),
        # The datagram is lost, as it might be on the way.
        (OSError("no route"), True),
        (ConnectionRefusedError(), True),
    ],
)
def test_a_datagram_that_cannot_be_sent_is_kept_or_lost(transport, answer, is_taken):
    (first, second), transport._unicast = transport._unicast, (Socket(answer), Socket())
    first.close()
    second.close()
    assert transport.send(THERE, b"abcd") is is_taken


def test_an_error_about_what_was_sent_ends_no_reading(transport):
    source = Socket(b"1", ConnectionRefusedError(), b"2", BlockingIOError(), b"3")
    there = "10.0.0.5"
    assert list(transport.receive(source)) == [(b"1", there), (b"2", there)]
    assert list(transport.receive(Socket(*[b"x"] * 70))) == [(b"x", there)] * 64
    late = Socket(b"1", OSError(), b"2", b"3")
    assert list(transport.receive(late, limit=3)) == [(b"1", there), (b"2", there)]


def test_datagrams_reach_the_ports_that_are_announced(transport):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for number, address in enumerate((transport.discovery, transport.user)):
            sender.sendto(b"%d" % number, address)
    discovery, user = transport._unicast
    for each, datagram in ((discovery, b"0"), (user, b"1")):
        each.settimeout(10)
        assert each.recv(99) == datagram


def test_the_largest_datagram_is_received_whole(transport):
    datagram = bytes(range(251)) * 240
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.sendto(datagram, transport.user)
    _, user = transport._unicast
    user.settimeout(10)
    assert list(transport.receive(user, limit=1)) == [(datagram, "127.0.0.1")]


# Fragments.

SAMPLE = Data(
    reader=5, writer=6, sequence_number=7, payload=b"abcdefghij", key=False, inline=INLINE
)


def part(first, payload, **changes):
    given = {"count": 1, "fragment_bytes": 4, "sample_bytes": 10, "sequence_number": 7, **changes}
    return DataFrag(reader=5, writer=6, first=first, payload=payload, inline=INLINE, **given)


def test_a_sample_that_was_cut_has_all_that_it_had():
    backlog = Backlog(bytes(12), Budget(1 << 20))
    found = [backlog.add(fragment(SAMPLE, number, 4)) for number in (3, 1, 2)]
    assert found == [None, None, SAMPLE]


def test_fragments_that_are_announced_and_missing_may_still_come():
    backlog = Backlog(bytes(12), Budget(1 << 20))
    # It says that there are three, and has one.
    assert backlog.add(part(1, b"abcd", count=3)) is None
    assert backlog.missing(7) == [2, 3]
    assert backlog.add(part(2, b"efghij", count=2)) == SAMPLE


def test_no_more_fragments_are_missing_than_one_answer_can_name():
    backlog = Backlog(bytes(12), Budget(1 << 20))
    backlog.add(part(1, b"abcd", sample_bytes=4 * 1000))
    assert backlog.missing(7) == list(range(2, 258))
    assert backlog.missing(7, 4) == [2, 3, 4]
