"""A node with pins of each kind, and tools that only pretend to make a bitstream of it."""

from __future__ import annotations

import sys

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out, connect, flipped

from firm_hdl.jobs.programs import Program
from firm_hdl.node import accelerator_signature, read_description_text
from firm_hdl.node.bitstream.build import Tools
from tests.node.samples import LIBRARY

__all__ = ["BITSTREAM", "PINS", "TEXT", "Pins", "description", "fake_tools"]

TEXT = """\
node: pins
clock_mhz: 5
bus_bytes: 1
link: {kind: uart, baud: 1250000, memory_bytes: 64, packets: 2}
accelerator: tests.node.bitstream.samples:Pins
subscribe:
  /heard: {type: std_msgs/msg/String, memory_bytes: 64, packets: 2}
publish:
  /said: {type: std_msgs/msg/String, memory_bytes: 64, packets: 2}
"""

PINS = "pins: {lamps: [led.0, led.1], button: button.1, wire: gpio.0+, bus.a: B9}\n"


class Pins(wiring.Component):
    """Say what it hears; `lamps` count up once a button was pressed."""

    def __init__(self, description):
        pin = wiring.Signature({"i": In(1), "o": Out(1), "oe": Out(1)})
        bus = wiring.Signature({"a": Out(1)})
        super().__init__(
            accelerator_signature(
                description, lamps=Out(2), button=In(1), wire=Out(pin), bus=Out(bus)
            )
        )

    def elaborate(self, platform):
        m = Module()
        connect(m, flipped(self.subscribe.heard), flipped(self.publish.said))
        m.d.comb += [
            self.lamps.eq(1),
            self.wire.o.eq(0),
            self.wire.oe.eq(self.button),
            self.bus.a.eq(self.wire.i),
        ]
        return m


def description(pins=PINS, changes=()):
    """Read the description, with other words in place of some."""
    text = TEXT + pins
    for old, new in dict(changes).items():
        assert old in text
        text = text.replace(old, new)
    return read_description_text(text, name="pins.yaml", library=LIBRARY)


# Bytes that are no text.
BITSTREAM = bytes(range(256))

YOSYS = """
import sys
assert "synth_ecp5" in sys.argv[-1] and "read_verilog top.v" in sys.argv[-1]
assert "module \\\\pins_verilog" in open("node.il").read()
open("top.json", "w").write("{}")
"""
NEXTPNR = """
import json, sys
seed = int(sys.argv[sys.argv.index("--seed") + 1])
reached = MHZ[seed - 1]
if not reached:
    open("nextpnr.log", "w").write(
        "Info: TRELLIS_IO: 9/ 197 4%\\nInfo: TRELLIS_FF: 30000/ 24288 123%\\nERROR: no room\\n"
    )
    sys.exit(1)
open(sys.argv[sys.argv.index("--textcfg") + 1], "w").write(str(seed))
clocks = reached if isinstance(reached, dict) else {"aclk": (reached, 5)}
def path(end, ns):
    step = {"delay": ns, "type": "routing", "to": {"cell": "of " + end}}
    return {"from": end, "to": end, "path": [step]}
json.dump({
    "fmax": {name: {"achieved": mhz, "constraint": of} for name, (mhz, of) in clocks.items()},
    "utilization": {"TRELLIS_FF": {"used": 10, "available": 24288}},
    "critical_paths": [
        path("<async>", 999),
        *(path("posedge " + name, 1000 / mhz) for name, (mhz, _) in clocks.items()),
    ],
}, open("report.json", "w"))
"""
PACKER = """
import sys
assert open(sys.argv[-2]).read() == "SEED"
open(sys.argv[-1], "wb").write(bytes(range(256)))
"""


def fake_tools(*mhz, seed=1):
    """Return tools that reach some MHz, by seed, and pack the result of one seed only.

    A seed has MHz of `aclk`, which needs 5, or for each clock what is reached and what is needed. A
    node that reaches 0 MHz is too large.
    """

    def program(title, code):
        return Program(title=title, command=(sys.executable, "-c", code), version="9")

    return Tools(
        yosys=program("Yosys", YOSYS),
        placer=program("nextpnr-ecp5", NEXTPNR.replace("MHZ", repr(mhz))),
        packer=program("ecppack", PACKER.replace("SEED", str(seed))),
    )
