"""The area of the parts of a node besides its converters, from a few that were measured.

All have a bus of 8 bytes and are mapped for ECP5 by Yosys; ``lab/bench/parts`` has them. A core has
a gate for each direction that comes in, and a FIFO for each that goes out. Its area is estimated by
the line through those of two cores, with two and with eight topics.
"""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["PartEstimate", "core_estimate", "ethernet_estimate", "link_estimate"]

_PART = "ECP5 LFE5U-45F-8"
_LINKS = {"stream": (497, 681), "uart": (1878, 1910), "udp": (1687, 2048)}
_ETHERNET = (2977, 1518)
_CORES = {2: (1879, 2932), 8: (5550, 7917)}
"""Look-up tables and flip-flops: of links, of the layers between UDP and a PHY with 8 ports, and of
cores by the number of their packet memories."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PartEstimate:
    """An estimate of a part.

    Attributes
    ----------
    part : str
        FPGA and speed grade.
    lut, ff : int
        Look-up tables and flip-flops.
    how : str
        Whether they are measured.
    """

    part: str
    lut: int
    ff: int
    how: str


def link_estimate(kind: str) -> PartEstimate | None:
    """Return the area of a link with the memory of the default; `None` if none was measured."""
    if kind not in _LINKS:
        return None
    lut, ff = _LINKS[kind]
    return PartEstimate(part=_PART, lut=lut, ff=ff, how="estimated: the link with its defaults")


def ethernet_estimate() -> PartEstimate:
    """Return the area of the layers between UDP and a PHY."""
    lut, ff = _ETHERNET
    return PartEstimate(part=_PART, lut=lut, ff=ff, how="estimated: with 8 ports")


def core_estimate(memories: int) -> PartEstimate:
    """Return the area of a core with so many packet memories."""
    (few, less), (many, more) = _CORES.items()
    share = (memories - few) / (many - few)
    lut, ff = (round(a + share * (b - a)) for a, b in zip(less, more, strict=True))
    return PartEstimate(part=_PART, lut=lut, ff=ff, how="estimated: cores of 2 and of 8 topics")
