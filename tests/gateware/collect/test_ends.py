# amaranth: UnusedElaboratable=no
"""Ends and errors of packets, while as many of them wait as have room."""

from __future__ import annotations

from firm_hdl import Serializer
from firm_hdl.sim import Harness, RunOptions, Stalls
from tests.gateware.test_reset import letters
from tests.strategies import make


def test_each_packet_that_waits_keeps_its_end_and_its_error():
    """Each packet is a beat, and a text of more than two letters is an error."""
    tx = Serializer(make("ros1", {"s": "string<=2"}), bus_bytes=8)
    sizes = [0, 3, 1, 4, 2, 0, 4, 1, 3, 2, 4, 0, 1, 1, 3, 0, 2, 4, 4, 1, 0, 3]
    texts = [bytes(range(number, number + size)) for number, size in enumerate(sizes)]
    messages = [{0: [len(text)], 1: letters(text, 8)} for text in texts]
    options = RunOptions(stalls={"packets_out": Stalls.bits("0" * 50 + "1" * 12)})
    seen = Harness(None, tx).run_messages(messages, options)
    assert seen.packets == [len(text).to_bytes(4, "little") + text for text in texts]
    assert seen.packet_errors == [size > 2 for size in sizes]
