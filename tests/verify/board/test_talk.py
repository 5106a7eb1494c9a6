"""A talk with a board: what is under way at once, how long it waits, and a second session."""

from __future__ import annotations

import pytest

from firm_hdl.node import read_description_text
from firm_hdl.node.frame import HEADER_BYTES
from firm_hdl.verify.board.description import loop_text
from firm_hdl.verify.board.talk import Talk
from tests.node.bridge.fakes import FakeBoard
from tests.verify.board.fakes import STRING, LoopNode, described

ONE = described(STRING)
PACKET = b"\0\1\0\0\2\0\0\0a\0"
"""It takes 16 bytes of a memory with beats of 8 bytes."""

FOUR = 4 * (HEADER_BYTES + 16)
"""Room for four such packets and their headers, so two may be under way."""


class Counts(FakeBoard):
    """Counts the messages that are under way at most."""

    most = 0

    def send(self, frames):
        taken = super().send(frames)
        self.most = max(self.most, len(self.coming))
        return taken


@pytest.mark.parametrize(
    ("line", "options", "most"),
    [
        ("link: {kind: udp}", f"{{kind: udp, memory_bytes: {FOUR}}}", 2),
        ("link: {kind: udp}", "{kind: udp, packets: 7}", 3),
        ("  /loopback/in/std_msgs/String:", f"{{type: {STRING}, memory_bytes: {FOUR}}}", 2),
        ("  /loopback/out/std_msgs/String:", f"{{type: {STRING}, memory_bytes: {FOUR // 2}}}", 1),
        ("  /loopback/out/std_msgs/String:", f"{{type: {STRING}, packets: 5}}", 2),
        # One is always sent.
        ("  /loopback/in/std_msgs/String:", f"{{type: {STRING}, packets: 1}}", 1),
    ],
)
def test_half_of_the_least_memory_is_under_way(line, options, most):
    key = line.partition(":")[0]
    lines = [
        f"{key}: {options}" if each.startswith(f"{key}:") else each
        for each in loop_text([STRING], "lyrical").splitlines()
    ]
    node = read_description_text("\n".join(lines))
    board = Counts(LoopNode(node))
    with Talk(board, node) as talk:
        talk.open()
        board.most = 0
        got = talk.exchange(node.loops()[0], [PACKET] * 9, [True] * 9)
    assert got == [PACKET] * 9 and board.most == most


def test_packets_that_do_not_come_back_hold_no_others():
    cut = PACKET[:-1]
    with Talk(FakeBoard(LoopNode(ONE)), ONE) as talk:
        talk.open()
        sent = [*[cut] * 40, PACKET, *[cut] * 3, PACKET]
        assert (
            talk.exchange(ONE.loops()[0], sent, [each is PACKET for each in sent]) == [PACKET] * 2
        )


def test_what_the_board_lost_before_does_not_count():
    board = FakeBoard(LoopNode(ONE))
    board.counters["overrun"] = 5
    with Talk(board, ONE, 0.3) as talk:
        talk.open()
        board.counters["overrun"] += 2
        assert talk.losses() == {"overrun": 2}


def test_what_waits_to_be_sent_is_sent_as_soon_as_there_is_room():
    flushed = []

    class Busy(FakeBoard):
        """A board that has frames to send."""

        waits_to_send = True

        def flush(self):
            flushed.append(True)

    with Talk(Busy(LoopNode(ONE)), ONE, 0.3) as talk:
        talk.open()
    assert flushed
