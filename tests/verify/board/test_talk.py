"""A talk with a board: what is under way at once, how long it waits, and a second session."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from firm_hdl.node.boards.board import BoardError
from firm_hdl.node.frame import FLAG_START, HEADER_BYTES
from firm_hdl.verify.board import talk as talking
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


@pytest.mark.parametrize(
    ("board", "link", "seconds"),
    [
        # There and back; the line of a board counts more than the link of its node.
        (100, {"link": "udp"}, 2 + 2 * 50 / 100),
        (100, {"link": "{kind: uart, baud: 115200}"}, 2 + 2 * 50 / 100),
        (None, {"link": "{kind: uart, baud: 115200}"}, 2 + 2 * 50 / 11520),
        (None, {"link": "udp"}, 2),
    ],
)
def test_the_patience_is_that_of_the_slowest_way(board, link, seconds):
    found = FakeBoard()
    found.bytes_per_second = board
    talk = Talk(found, described(STRING, **link), 2.0)
    assert talk._patience(50) == pytest.approx(seconds)


@pytest.fixture
def talk():
    with Talk(FakeBoard(LoopNode(ONE)), ONE, 0.3) as found:
        found.open()
        yield found


def test_what_is_no_frame_is_no_restart(talk):
    """It may have the bit of a first frame by chance."""
    talk._keep(bytes([0xFF, FLAG_START]) * HEADER_BYTES)
    assert talk.losses() == {"malformed": 1}
    assert talk.read([1]) == {1: ONE.fingerprint & 0xFFFF_FFFF}


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


@pytest.mark.parametrize("method", ["open", "send", "flush", "receive"])
def test_a_board_that_is_gone_ends_the_talk_with_its_own_words(method, talk, monkeypatch):
    def fails(*given):
        raise BoardError("fake: it is gone")

    board = talk._board
    monkeypatch.setattr(board, method, fails)
    monkeypatch.setattr(type(board), "waits_to_send", method == "flush")
    with pytest.raises(TalkError, match=r"^fake: it is gone$"):
        talk.open() if method == "open" else talk.read([16])


def test_a_second_session_begins_anew(talk):
    board, (came, back) = talk._board, LOOP
    node, packet = board.node, bytes.fromhex("00010000 02000000 6100")
    assert talk.exchange(LOOP, [packet], [True]) == [packet]
    # Something is lost, and something comes that nobody takes.
    node.send(back.id, packet)
    board.come(node.send(back.id, packet))
    talk.read([16])
    assert talk.losses() == {"lost": 1}
    board.node = LoopNode(ONE)
    talk.open()
    assert not talk.losses() and talk.take(back) == []
    assert talk.exchange(LOOP, [packet], [True]) == [packet] and came.id != back.id


def test_a_slow_board_has_its_time_again_after_each_packet(talk, monkeypatch):
    """Each packet takes 0.25 s of the 0.3 s that the board may be silent."""
    clock, waits, (_, back) = [100.0], [], LOOP
    monkeypatch.setattr(talking, "time", SimpleNamespace(monotonic=lambda: clock[0]))

    def wait(until):
        waits.append(until)
        clock[0] += 0.05 if len(waits) % 2 else 0.2
        if len(waits) % 2 == 0:
            talk._came[back.id].append(b"answer")

    monkeypatch.setattr(talk, "_wait", wait)
    assert talk.exchange(LOOP, [b"packet"] * 4, [True] * 4) == [b"answer"] * 4


def test_packets_are_taken_once(talk):
    packet = bytes.fromhex("00010000 02000000 6100")
    board, (_, back) = talk._board, LOOP
    board.come(board.node.send(back.id, packet))
    talk.read([16])
    assert talk.take(back) == [packet] and talk.take(back) == []


def test_what_the_board_lost_before_does_not_count():
    board = FakeBoard(LoopNode(ONE))
    board.counters["overrun"] = 5
    with Talk(board, ONE, 0.3) as talk:
        talk.open()
        board.counters["overrun"] += 2
        assert talk.losses() == {"overrun": 2}


def test_everything_that_is_lost_on_the_way_back_is_told(talk):
    causes = {"lost": 1, "late": 2, "cut": 3, "stray": 4, "malformed": 5, "large": 6}
    for cause, count in causes.items():
        setattr(talk._receiver.counters, cause, count)
    assert talk.losses() == causes


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


def test_registers_are_returned_in_the_order_of_the_request(talk):
    node, kept = talk._board.node, []
    right = node.control
    for number, name in enumerate(("passed", "lost", "late")):
        node.counters[0, name] = 10 + number

    def late(message):
        """Answer the first request last, and each twice."""
        kept.append(message)
        if len(kept) < 3:
            return []
        return [frame for each in reversed(kept) for _ in range(2) for frame in right(each)]

    node.control = late
    assert list(talk.read([16, 17, 18]).items()) == [(16, 10), (17, 11), (18, 12)]


def test_so_many_requests_are_under_way_and_no_more(talk):
    asked = []
    talk._board.node.control = lambda message: asked.append(message.tag) or []

    def stop(until):
        raise TalkError("it waits")

    talk._wait = stop
    with pytest.raises(TalkError, match="it waits"):
        talk.read(range(16, 25))
    assert len(asked) == len(set(asked)) == 4


def test_tags_begin_again_after_the_last(talk):
    talk._tag = 0xFFFF_FFFD
    assert set(talk.read([16, 17, 18, 19])) == {16, 17, 18, 19} and talk._tag == 1


def test_only_the_first_requests_begin_a_sequence():
    sent = []
    board = FakeBoard(LoopNode(ONE), loses=lambda frame: sent.append(frame[1]))
    with Talk(board, ONE, 0.3) as talk:
        talk.open()
        at = len(sent)
        talk.read([16, 17])
    assert any(flags & FLAG_START for flags in sent[:at])
    assert not any(flags & FLAG_START for flags in sent[at:])
