"""Words: what the collector hands to the packer, one transfer per step."""

from __future__ import annotations

from amaranth.lib import data

from firm_hdl.gateware.positions import Ring
from firm_hdl.plan import Plan

__all__ = ["words_layout"]


def words_layout(plan: Plan) -> data.StructLayout:
    """Return the payload of the stream of words, which come in wire order.

    A position is rounded up by adding a distance and clearing low bits; so that one addition is
    enough, a distance includes what rounding up needs.

    Members
    -------
    items, map : unsigned(8 * bus_bytes)
        The word of items, and that of the map. If `lead`, both are of the map, in this order.
    items_bytes, map_bytes : range(bus_bytes + 1)
        Bytes of these words.
    lead : unsigned(1)
    to_map, map_mask
        Distance from the bytes before to the map, and the mask of its alignment.
    to_end, end_mask
        Distance from the start of the map to where the next step starts, and the mask of its
        alignment. After a packet, that is the next beat.
    max_beats : unsigned
        The next step starts at most so many beats after the one in which this step starts.
    last : unsigned(1)
        The packet ends with this step.
    empty : unsigned(1)
        The packet has no byte so far.
    waits : unsigned(1)
        No leaf of the message was taken so far: the packet does not begin with this step.
    error : unsigned(1)
        The packet is marked with an error. Only looked at when `last` is set.
    """
    ring, bus = Ring(plan), plan.bus_bytes
    return data.StructLayout(
        {
            "items": 8 * bus,
            "map": 8 * bus,
            "items_bytes": range(bus + 1),
            "map_bytes": range(bus + 1),
            "lead": 1,
            "to_map": range(bus + 9),
            "map_mask": 3,
            "to_end": range(3 * bus + 9),
            "end_mask": max(3, ring.lane_bits),
            "max_beats": range((bus - 1 + (bus + 8) + (3 * bus + 8)) // bus + 1),
            "last": 1,
            "empty": 1,
            "waits": 1,
            "error": 1,
        }
    )
