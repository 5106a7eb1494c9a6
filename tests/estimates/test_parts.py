"""Areas of the parts of a node: those that were measured come out again."""

from __future__ import annotations

import pytest

from firm_hdl.estimates import part_estimate
from firm_hdl.node.description import LINKS

# As docs/explanation/performance.md has them.
MEASURED = [
    *(("core", 2, 1, 0, 1926, 2388), ("core", 2, 8, 0, 1985, 3013), ("core", 6, 1, 0, 4186, 4799)),
    *(("core", 6, 8, 0, 4350, 6256), ("core", 8, 8, 0, 5550, 7917)),
    *(("stream", 2, 1, 0, 391, 458), ("stream", 2, 8, 0, 497, 681)),
    *(("axi_dma", 2, 1, 0, 1219, 1334), ("axi_dma", 2, 8, 0, 2213, 2185)),
    *(("uart", 2, 1, 0, 1415, 1335), ("uart", 2, 8, 0, 1867, 1910)),
    *(("udp", 2, 1, 0, 1225, 1475), ("udp", 2, 8, 0, 1687, 2048)),
    ("rtps", 2, 8, 8, 7283, 4171),
]


@pytest.mark.parametrize(("name", "memories", "bus_bytes", "peers", "lut", "ff"), MEASURED)
def test_an_estimate_is_near_what_was_measured(name, memories, bus_bytes, peers, lut, ff):
    found = part_estimate(name, memories=memories, bus_bytes=bus_bytes, peers=peers)
    assert (found.lut, found.ff) == (pytest.approx(lut, rel=0.03), pytest.approx(ff, rel=0.03))


def test_every_link_has_an_area_and_a_clock():
    for kind in LINKS:
        found = part_estimate(kind, memories=2, bus_bytes=8, peers=8)
        assert min(found.lut, found.ff, found.mhz) > 0 and not found.is_same
