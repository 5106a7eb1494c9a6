"""Areas of the parts of a node."""

from __future__ import annotations

from firm_hdl.estimates import core_estimate, link_estimate
from firm_hdl.node.description import LINKS


def test_the_measured_cores_are_those_of_the_line_and_every_link_but_rtps_has_an_area():
    found = [(core.lut, core.ff) for core in map(core_estimate, (2, 5, 8))]
    assert found == [(1879, 2932), (3714, 5424), (5550, 7917)]
    assert [kind for kind in LINKS if link_estimate(kind) is None] == ["rtps"]
