"""The area and the clock rate of the parts of a node besides its converters.

An area is a sum: a constant, and a multiple of each figure of the node. ``lab/bench/parts`` has the
parts that were measured, and the factors fit them best (least squares), within 4 %;
``docs/explanation/performance.md`` has the table. The clock rate is that of the one part that was
placed and routed.
"""

from __future__ import annotations

from firm_hdl.estimates.nearest import Estimate

__all__ = ["part_estimate", "placed_cells"]

_PART = "ECP5 LFE5U-45F-8"

_FIGURES = ("constant", "memories", "memories x bus_bytes", "bus_bytes", "peers")
_PARTS: dict[str, tuple[str, float, dict[str, tuple[float, float]]]] = {
    "core": (
        "6 cores, the clock of one with 8 topics",
        160,
        {"constant": (746, 1284), "memories": (571, 547), "memories x bus_bytes": (3.6, 35.4)},
    ),
    "stream": (
        "links of 1 and 8 bytes, the clock of 8",
        210,
        {"constant": (376, 426), "bus_bytes": (15.1, 31.9)},
    ),
    "axi_dma": (
        "links of 1 and 8 bytes, the clock of 8",
        150,
        {"constant": (1077, 1212), "bus_bytes": (142, 122)},
    ),
    "uart": (
        "links of 1 and 8 bytes, the clock of 8",
        154,
        {"constant": (1350, 1253), "bus_bytes": (64.6, 82.1)},
    ),
    "udp": (
        "links of 1 and 8 bytes, the clock of 8",
        165,
        {"constant": (1159, 1393), "bus_bytes": (66, 81.9)},
    ),
    "rtps": (
        "a participant, the slopes of earlier ones, the clock of one in a node that was placed",
        99.2,
        {
            "constant": (6624, 3716),
            "memories": (41.5, 4.8),
            "bus_bytes": (41.7, 46.9),
            "peers": (30.3, 8.8),
        },
    ),
    "ethernet udp": ("1 UDP port", 127, {"constant": (2229, 1488)}),
    "ethernet rtps": ("3 UDP ports, 16 KiB for fragments", 127, {"constant": (2711, 1816)}),
}
"""What was measured, its clock rate in MHz, and the factors of look-up tables and flip-flops."""

_CELLS_PER_LUT = 1.6


def part_estimate(name: str, *, memories: int = 0, bus_bytes: int = 0, peers: int = 0) -> Estimate:
    """Return the area and the clock rate of a part of a node.

    * `name`: ``core``, the kind of a link, or ``ethernet`` and that kind: the layers from UDP to a
      PHY.
    * `memories`: packet memories of topics: one for each direction.
    * `bus_bytes`, `peers`: as in the description of the node.
    """
    what, mhz, factors = _PARTS[name]
    numbers = (1, memories, memories * bus_bytes, bus_bytes, peers)
    figures = dict(zip(_FIGURES, numbers, strict=True))
    lut, ff = (round(sum(factors[key][at] * figures[key] for key in factors)) for at in (0, 1))
    return Estimate(part=_PART, lut=lut, ff=ff, mhz=mhz, type=what, is_same=False)


def placed_cells(lut: int) -> int:
    """Return how many cells of look-up tables a placed node takes.

    * `lut`: those of logic, as in an estimate. Carry chains and memories are cells, too.
    """
    return 100 * round(_CELLS_PER_LUT * lut / 100)
