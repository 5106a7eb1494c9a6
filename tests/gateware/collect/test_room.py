# amaranth: UnusedElaboratable=no
"""No beat that waits is overwritten, however large the steps are that follow it."""

from __future__ import annotations

from firm_hdl import Serializer
from firm_hdl.sim import Harness, RunOptions, Stalls
from tests.gateware.test_reset import letters
from tests.strategies import make


def test_packets_wait_whole_while_large_steps_follow():
    """The rest of a string and both numbers are one step, which begins in each lane of a beat."""
    tx = Serializer(make("ros1", {"s": "string", "a": "uint64", "b": "uint64"}), bus_bytes=8)
    sizes = [*range(24), 16, 8, 16, 24, 15, 9]
    texts = [bytes(range(size, 2 * size)) for size in sizes]
    messages = [
        {0: [len(text)], 1: letters(text, 8), 2: [size], 3: [255 - size]}
        for size, text in zip(sizes, texts, strict=True)
    ]
    packets = [
        len(text).to_bytes(4, "little")
        + text
        + size.to_bytes(8, "little")
        + (255 - size).to_bytes(8, "little")
        for size, text in zip(sizes, texts, strict=True)
    ]
    options = RunOptions(stalls={"packets_out": Stalls.bits("0" * 30 + "1" * 3)})
    assert Harness(None, tx).run_messages(messages, options).packets == packets
