"""A filter for scans of a laser: ranges above a limit become infinite, all else stays.

`Near` is the accelerator of ``near.yaml``. It has no registers: what the deserializer gives in a
cycle, the serializer takes in the same one, a bus word with two ranges per cycle.
"""

from __future__ import annotations

import struct
from typing import Any

from amaranth.hdl import Module, Mux, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import connect, flipped

from firm_hdl.node import Description, accelerator_signature

__all__ = ["Near"]

LIMIT = 2.5
"""The largest range that stays, in metres."""

INFINITE = 0x7F80_0000
"""The bits of an infinite float32."""


def near(number: Value) -> Value:
    """Return a range as it is sent. The bits of positive floats have the order of the floats."""
    (limit,) = struct.unpack("<I", struct.pack("<f", LIMIT))
    return Mux((number > limit) & ~number[31], INFINITE, number)


class Near(wiring.Component):
    """The accelerator: its ports are those of the description."""

    def __init__(self, description: Description) -> None:
        super().__init__(accelerator_signature(description))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        came: Any = self.subscribe.scan
        sent: Any = self.publish.near
        for name in came.signature.members:
            if name != "ranges":
                connect(m, flipped(getattr(came, name)), flipped(getattr(sent, name)))
        connect(m, flipped(came.ranges.length), flipped(sent.ranges.length))
        items, filtered = came.ranges.items, sent.ranges.items
        m.d.comb += [
            filtered.payload.last.eq(items.payload.last),
            filtered.valid.eq(items.valid),
            items.ready.eq(filtered.ready),
        ]
        for lane in range(len(items.payload.data)):
            m.d.comb += filtered.payload.data[lane].eq(near(items.payload.data[lane]))
        return m
