"""A talk with a board: what is under way at once, how long it waits, and a second session."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from firm_hdl.node.frame import FLAG_START, HEADER_BYTES
from firm_hdl.verify.board.talk import Talk, TalkError, _Window, room_for
from tests.node.bridge.fakes import FakeBoard
from tests.verify.board.fakes import STRING, LoopNode, described

ONE = described(STRING)
(LOOP,) = ONE.loops()


def node_of(*, link=(1 << 20, 99), came=(1 << 20, 99), back=(1 << 20, 99), kind="udp"):
    """Return a description and a loop; each memory has a size in bytes, and a number of packets."""
    stores = [SimpleNamespace(memory_bytes=size, packets=most) for size, most in (came, back)]
    loop = tuple(SimpleNamespace(stores=[("", store)]) for store in stores)
    found = SimpleNamespace(memory_bytes=link[0], packets=link[1], kind=kind)
    return SimpleNamespace(link=found, bus_bytes=8), loop


FOUR = 4 * (HEADER_BYTES + 16)
"""Room for four packets of 9 to 16 bytes, so two may be under way."""


@pytest.mark.parametrize(
    ("given", "most"),
    [
        ({"link": (FOUR, 99)}, 2),
        ({"link": (FOUR - 2, 99)}, 1),
        ({"came": (FOUR, 99)}, 2),
        ({"back": (FOUR, 99)}, 2),
        ({"back": (FOUR - 2, 99)}, 1),
        ({"link": (1 << 20, 6)}, 3),
        ({"came": (1 << 20, 4)}, 2),
        ({"back": (1 << 20, 5)}, 2),
        # One is always sent.
        ({"back": (1 << 20, 1)}, 1),
        ({"link": (10, 99)}, 1),
    ],
)
def test_half_of_the_least_memory_is_under_way(given, most):
    window = _Window(*node_of(**given))
    count = 0
    while window.has_room(bytes(9)):
        window.add(bytes(9), True)
        count += 1
    assert count == most and window.bytes == most * (HEADER_BYTES + 16)
    # What came back makes room, however much more there is.
    window.remove(1)
    assert window.bytes == (most - 1) * (HEADER_BYTES + 16) and window.has_room(bytes(9))
    window.remove(99)
    assert window.bytes == 0


def test_packets_that_do_not_come_back_are_removed_with_the_next_that_does():
    window = _Window(*node_of(link=(FOUR, 99)))
    for _ in range(3):
        # Nothing would come back that makes room, so these are sent in any case.
        assert window.has_room(bytes(16))
        window.add(bytes(16), False)
    window.add(bytes(16), True)
    window.add(bytes(16), False)
    window.add(bytes(16), True)
    assert window.bytes == 6 * (HEADER_BYTES + 16) and not window.has_room(b"")
    window.remove(1)
    assert window.bytes == 2 * (HEADER_BYTES + 16)
    window.remove(1)
    assert window.bytes == 0


def test_a_packet_has_to_fit_into_every_memory():
    assert room_for(*node_of(came=(300, 9), back=(200, 9), link=(500, 9))) == 200
    assert room_for(*node_of(came=(100, 9), back=(200, 9), link=(500, 9))) == 100
    # A link that is no stream stores the header, too.
    assert room_for(*node_of(link=(500, 9))) == 500 - HEADER_BYTES
    assert room_for(*node_of(came=(600, 9), link=(500, 9), kind="stream")) == 600


@pytest.fixture
def talk():
    with Talk(FakeBoard(LoopNode(ONE)), ONE, 0.3) as found:
        found.open()
        yield found


def test_a_talk_closes_its_board():
    board = FakeBoard(LoopNode(ONE))
    closed = []
    board.close = lambda: closed.append(True)
    with Talk(board, ONE):
        assert not closed
    assert closed


@pytest.mark.parametrize("bit", [0, 31, 32, 63])
def test_every_bit_of_a_fingerprint_counts(bit):
    node = LoopNode(ONE)
    node.fingerprint ^= 1 << bit
    with Talk(FakeBoard(node), ONE, 0.3) as talk, pytest.raises(TalkError, match="is another one"):
        talk.open()


def test_what_the_board_lost_before_does_not_count():
    board = FakeBoard(LoopNode(ONE))
    board.counters["overrun"] = 5
    with Talk(board, ONE, 0.3) as talk:
        talk.open()
        board.counters["overrun"] += 2
        assert talk.losses() == {"overrun": 2}


@pytest.mark.parametrize("waits", [False, True])
def test_what_waits_to_be_sent_is_sent_as_soon_as_there_is_room(waits):
    flushed = []

    class Busy(FakeBoard):
        """A board that has frames to send, or none."""

        waits_to_send = waits

        def flush(self):
            flushed.append(True)

    with Talk(Busy(LoopNode(ONE)), ONE, 0.3) as talk:
        talk.open()
    assert bool(flushed) is waits


def test_only_the_first_requests_begin_a_sequence():
    sent = []
    board = FakeBoard(LoopNode(ONE), loses=lambda frame: sent.append(frame[1]))
    with Talk(board, ONE, 0.3) as talk:
        talk.open()
        at = len(sent)
        talk.read([16, 17])
    assert any(flags & FLAG_START for flags in sent[:at])
    assert not any(flags & FLAG_START for flags in sent[at:])
