"""Words: what the collector hands to the packer, one transfer per step."""

from __future__ import annotations

from amaranth.lib import data

from firm_hdl.gateware.positions import Ring
from firm_hdl.plan import Plan

__all__ = ["words_layout"]


def words_layout(plan: Plan) -> data.StructLayout:
    """Return the payload of the stream of words: the bytes of one step, in wire order.

    To round a position up, the packer adds a distance and clears low bits. Each distance includes
    the addend of the rounding, so one addition is enough.

    Members
    -------
    items, map : unsigned(8 * bus_bytes)
        The word of items, and that of the map. If `lead`, `items` is the first word of the map.
    items_bytes, map_bytes : range(bus_bytes + 1)
        Number of bytes in these words, from lane 0 on.
    lead : unsigned(1)
        The map has two words.
    to_map : range(bus_bytes + 9); map_mask : unsigned(3)
        Distance in bytes from the start of this step to the map, and the low bits that the map's
        alignment clears.
    to_end : range(3 * bus_bytes + 9); end_mask : unsigned(max(3, lane_bits))
        Distance in bytes from the start of the map to the start of the next step, and the low bits
        that its alignment clears. After the last step, the next packet starts with the next beat.
    max_beats : unsigned
        Upper bound of the beats from the start of this step to the start of the next one.
    last : unsigned(1)
        The packet ends with this step.
    empty : unsigned(1)
        The packet has no byte up to the end of this step.
    waits : unsigned(1)
        No leaf was taken so far, only constants: no beat of the packet may be sent yet.
    error : unsigned(1)
        The packet is marked with an error. Only used if `last`.
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
