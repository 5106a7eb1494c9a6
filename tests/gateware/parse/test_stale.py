# amaranth: UnusedElaboratable=no
"""What the packet before has left in the packet buffer is no length of this packet."""

from __future__ import annotations

import struct

from firm_hdl import Deserializer
from firm_hdl.plan import decode
from firm_hdl.sim import Harness, RunOptions
from firm_hdl.sim.transfers import join_transfers
from tests.strategies import make

ELEMENT = make("ros1", {"s": "uint8[]"}, "Element")
MESSAGE = make("ros1", {"e": (ELEMENT, "[]"), "z": "uint8"})
# Each word of these items is a legal length, and large enough to be counted in the budget.
FILLED = struct.pack("<2I", 1, 48) + struct.pack("<I", 400) * 12 + b"\1"
# So many elements that there is no room for 400 bytes more.
MANY = struct.pack("<4I", 200, 0, 0, 0)


def test_a_packet_that_ends_early_is_not_completed_by_the_one_before():
    rx = Deserializer(MESSAGE, bus_bytes=4, max_message_bytes=1024)
    parts = [MANY[:size] for size in (4, 5, 8, 13)] + [FILLED[:size] for size in (4, 8, 9)]
    packets = [each for part in parts for each in (FILLED, part)]
    decoded = [decode(rx.plan, packet) for packet in packets]
    statuses = [str(each.status) for each in decoded]
    assert statuses == ["OK", "TRUNCATED"] * len(parts)
    seen = Harness(rx, None).run_packets(packets, RunOptions(limit=1000))
    assert [status.name for status in seen.statuses] == statuses
    carried = {leaf: payloads for leaf, payloads in seen.transfers.items() if payloads}
    assert carried == join_transfers(each.streams for each in decoded)
