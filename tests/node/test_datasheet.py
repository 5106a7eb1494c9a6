"""The datasheet of a node, as text."""

from __future__ import annotations

from firm_hdl.export.component import ComponentPort
from firm_hdl.node.datasheet import node_datasheet
from tests.node.samples import read

TEXT = "node: n\nclock_mhz: 125\nsubscribe: {/a: {type: std_msgs/msg/Char, rate_hz: 1000}}\n"
PORTS = [ComponentPort(name="aclk", direction="in", width=1, signed=False, member="clock")]


def test_the_page_has_the_clock_and_what_is_set_of_the_link():
    def page(more=""):
        link = f"{{kind: rtps, address: 10.0.0.9{more}}}"
        description = read(TEXT, link=link)
        return node_datasheet(description, "n", PORTS, module="n", vhdl_ports={}, placed={})

    text = page(", static_peers: [10.0.0.1, 10.0.0.2]")
    assert "<td>static_peers</td><td>10.0.0.1 10.0.0.2</td>" in text
    assert "Warning:</strong> the clock of 125 MHz is above the 99.2 MHz that are" in text
    assert "<b>125 MHz</b>" in text
    assert "static_peers" not in page() and "<td>domain</td><td>0</td>" in page()
