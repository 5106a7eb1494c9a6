"""A node with pins of each kind, and boards for it."""

from __future__ import annotations

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out, connect, flipped

from firm_hdl.node import accelerator_signature, read_description_text
from tests.node.samples import LIBRARY

__all__ = ["PINS", "Pins", "description"]

_TEXT = """\
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
    text = _TEXT + pins
    for old, new in dict(changes).items():
        assert old in text
        text = text.replace(old, new)
    return read_description_text(text, name="pins.yaml", library=LIBRARY)
