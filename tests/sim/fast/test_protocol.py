"""The bytes of each message, as its table says, and back."""

from __future__ import annotations

import pytest

from firm_hdl.sim.fast import protocol
from firm_hdl.sim.fast.protocol import Answer, Done, Order, Reason

STALL_HEAD = "04 {:02x}000000 0300 {:02x}000000"


def numbers(text: str) -> bytes:
    return bytes.fromhex(text)


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (protocol.message(Order.GET), "03 00000000"),
        (protocol.message(Order.HALT), "07 00000000"),
        (protocol.message(Order.RESET), "08 00000000"),
        (protocol.numbered(Order.SEND, 0x102, b"ab"), "01 04000000 0201 6162"),
        (protocol.numbered(Order.SET, 1, b"\5"), "02 03000000 0100 05"),
        (
            protocol.run(0x0102, 3, [(4, 5, 6), (7, protocol.ALL_TRANSFERS, 1 << 32)]),
            "05 28000000 0201000000000000 0300000000000000"
            "0400 0500 0600000000000000 0700 ffff 0000000001000000",
        ),
        (protocol.live(1, 2, 3), "06 0c000000 01000000 02000000 03000000"),
        (protocol.transfers(0x0201, b"xyz"), "01 05000000 0102 78797a"),
        (
            protocol.done(Done(reason=Reason.CONDITIONS, cycle=0x0A0B, queued=(1, 0x0C0D))),
            "03 19000000 02 0b0a000000000000 0100000000000000 0d0c000000000000",
        ),
    ],
)
def test_messages(message, text):
    assert message == numbers(text)


@pytest.mark.parametrize(
    ("pattern", "data"),
    [
        # Bit n is cycle n, from the lowest on; whole bytes only.
        ("", ""),
        ("1", "01"),
        ("0000001", "40"),
        ("00000001", "80"),
        ("10000000" + "1", "01 01"),
        ("1" * 15, "ff 7f"),
        ("0" * 16, "00 00"),
    ],
)
def test_patterns_of_stalls(pattern, data):
    bits = [bit == "1" for bit in pattern]
    message = protocol.stall(3, bits)
    assert message == numbers(STALL_HEAD.format(6 + len(numbers(data)), len(bits)) + data)
    assert protocol.read_stall(message[5:]) == (3, bits)


def test_bodies_are_read_as_they_are_written():
    conditions = [(1, 2, 3), (4, protocol.ALL_TRANSFERS, 1 << 40)]
    assert protocol.read_run(protocol.run(9, 8, conditions)[5:]) == (9, 8, conditions)
    assert protocol.read_run(protocol.run(9, 8, [])[5:]) == (9, 8, [])
    assert protocol.read_live(protocol.live(7, 6, 5)[5:]) == (7, 6, 5)
    assert protocol.read_number(b"\1\2rest") == (0x0201, b"rest")
    for reason in Reason:
        for queued in ((), (5,), (0, 1 << 40, 2)):
            done = Done(reason=reason, cycle=1 << 50, queued=queued)
            assert protocol.read_done(protocol.done(done)[5:]) == done


def test_only_whole_messages_are_taken_from_a_buffer():
    whole = protocol.message(Answer.VALUES, b"abc") + protocol.message(Answer.DONE)
    found = [(Answer.VALUES, b"abc"), (Answer.DONE, b"")]
    for end in range(len(whole) + 1):
        buffer = bytearray(whole[:end])
        count = (end >= 8) + (end >= 13)
        assert protocol.messages(buffer) == found[:count]
        assert buffer == whole[(0, 8, 13)[count] : end]
