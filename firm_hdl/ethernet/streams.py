"""The streams inside of the edge, and the sum that IPv4, ICMP, IGMP and UDP share."""

from __future__ import annotations

from amaranth.hdl import Cat, Const, Module, Signal, Value
from amaranth.lib import data, stream

__all__ = [
    "FrameSignature",
    "SendSignature",
    "SymbolSignature",
    "add_word",
    "compare",
    "is_all_ones",
]


def SymbolSignature() -> stream.Signature:
    """Return the stream between a PHY and a MAC: what a GMII has in a cycle.

    A frame is a run of symbols with `enable`, from the preamble to the frame check sequence. After
    it comes at least one symbol without. Between symbols, and between frames, there may be cycles
    without any.

    Members
    -------
    data : unsigned(8)
    enable, error : unsigned(1)
        As RX_DV and RX_ER, or TX_EN and TX_ER, of IEEE 802.3, clause 35.
    """
    return stream.Signature(data.StructLayout({"data": 8, "enable": 1, "error": 1}))


def FrameSignature() -> stream.Signature:
    """Return the stream of received frames between two layers, which cannot be held.

    The bytes of a frame come first, then one transfer with `end`, which is no byte. Nothing may
    change for good before it. After an `end`, at least 12 cycles pass before the next byte.

    Members
    -------
    data : unsigned(8)
    end : unsigned(1)
    good : unsigned(1)
        With `end`: the frame is whole, and all layers below found it right.
    """
    layout = data.StructLayout({"data": 8, "end": 1, "good": 1})
    return stream.Signature(layout, always_ready=True)


def SendSignature() -> stream.Signature:
    """Return the stream of frames to send: `data`, and `last` with the last byte.

    It starts with the destination's address and ends before padding and frame check sequence. Once
    a frame has begun, its bytes do not pause.
    """
    return stream.Signature(data.StructLayout({"data": 8, "last": 1}))


def add_word(total: Value, word: Value) -> Value:
    """Add 16 bits to a sum in one's complement (RFC 1071).

    A sum has 17 bits: the highest one is a carry that is added with the next word, so that one
    carry chain is enough. It comes in from a bit below the lowest one: 1 + carry carries, or not.
    """
    return (Cat(Const(1, 1), total[:16]) + Cat(total[16], word))[1:18]


def is_all_ones(total: Value) -> Value:
    """Whether a sum in one's complement is 0xFFFF, which that of right data is.

    Its carry may be still to be added.
    """
    return (total == 0x0FFFF) | (total == 0x1FFFE)


def compare(
    m: Module, flag: Signal, byte: Value, place: Value, first: int, value: int, size: int
) -> None:
    """Set a flag if the bytes at places `first` to `first + size - 1` have a constant value.

    The statement belongs into the condition under which `byte` counts. The flag is right from the
    cycle after the last byte until the first byte of the next frame.
    """
    for k, expected in enumerate(value.to_bytes(size, "big")):
        with m.If(place == first + k):
            same = byte == expected
            m.d.sync += flag.eq(flag & same if k else same)
