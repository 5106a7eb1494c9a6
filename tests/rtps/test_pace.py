"""How fast a participant sends: a burst at once, and the rest at its rate."""

from __future__ import annotations

import pytest

from firm_hdl.rtps import Participant, Qos
from firm_hdl.rtps.transport import Transport
from tests.rtps.test_participant import DOMAIN, OPTIONS, TOPIC, TYPE, wait

BURST = 64 << 10
MOST_DATAGRAM = 1500


class NotingTransport(Transport):
    """A transport that notes the sizes of datagrams, and says whether the system takes them."""

    def __init__(self, takes=True):
        super().__init__(DOMAIN, OPTIONS["interface"])
        self.takes, self.sizes = takes, []

    def send(self, address, datagram):
        self.sizes.append(len(datagram))
        return super().send(address, datagram) and self.takes


def slow_participant(transport):
    """Return a participant that sends a byte per second after its first burst."""
    return Participant(**OPTIONS, bytes_per_second=1.0, transport=transport)


@pytest.fixture
def other():
    with Participant(**OPTIONS) as made:
        yield made


def test_no_more_than_a_burst_is_sent_at_once_and_what_is_left_at_the_end_is_counted(other):
    transport = NotingTransport()
    made = slow_participant(transport)
    other.reader(TOPIC, TYPE, lambda sample: None)
    writer = made.writer(TOPIC, TYPE, Qos(depth=0))
    assert writer.wait_for_match()
    writer.write(bytes(300_000))
    assert sum(transport.sizes) < BURST + MOST_DATAGRAM
    fragments = -(-300_000 // 1280)
    begun = len(transport.sizes)
    made.close()
    # Heartbeats wait, too. The farewell does not.
    assert made.counters["unsent"] >= fragments - begun > 0
    assert made.counters["unacknowledged"] == 1
    assert made.counters["sent"] == len(transport.sizes) > begun
    assert not made.counters["dropped"]


def test_datagrams_that_the_system_does_not_take_are_counted():
    transport = NotingTransport(takes=False)
    made = slow_participant(transport)
    assert wait(lambda: transport.sizes)
    made.close()
    assert made.counters["dropped"] == made.counters["sent"] == len(transport.sizes)
