"""Surround a circuit with flip-flops, so that its clock rate can be measured.

The clock rate of a circuit alone does not include the paths from input ports and to output ports.
So every bit of a port gets a flip-flop outside. The flip-flops are added to the netlist after
mapping. So the circuit inside is the one whose cells were counted, and nothing is optimized across
its ports.

On some devices, every port must have a pin, and converters have more ports than there are pins.
There, the flip-flops of inputs form a long shift register. A second one reduces the outputs by XOR,
three at a time. Paths in both are short, from flip-flop to flip-flop, and do not limit the clock.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import count
from typing import Any

from firm_hdl.bench.devices import CellPorts, Placer
from firm_hdl.bench.netlist import PORT
from firm_hdl.bench.tools import BenchError

__all__ = ["surround"]

UNREGISTERED = ("clk", "rst")
"""Clock and reset. In a design, reset comes from a register whose path is not measured here."""


def surround(top: dict[str, Any], placer: Placer) -> int:
    """Put flip-flops outside of all ports except clock and reset; add pins if the device needs any.

    * `top`: a module, as `top_module` returns it. It is changed.

    Returns the number of flip-flops next to ports.

    Raises `BenchError` if the module has no port ``clk``.
    """
    if "clk" not in top["ports"]:
        raise BenchError("the circuit has no clock 'clk', so it has no clock rate")
    around = _Around(top, placer)
    inputs, outputs = around.register_ports()
    if placer.pins is not None:
        around.chain(inputs, outputs)
    return len(inputs) + len(outputs)


class _Around:
    def __init__(self, top: dict[str, Any], placer: Placer):
        self.top, self.placer = top, placer
        self.ports: dict[str, Any] = top["ports"]
        self.fresh = count(1 + max(_bits(top), default=1))
        (self.clock,) = self.ports["clk"]["bits"]

    def register_ports(self) -> tuple[list[str], list[int]]:
        """Add the flip-flops; return the names of those of inputs, and the bits of outputs."""
        inputs: list[str] = []
        outputs: list[int] = []
        for name, port in self.ports.items():
            for index, inside in enumerate(port["bits"]):
                # An output may be a constant.
                if name in UNREGISTERED or not isinstance(inside, int):
                    continue
                outside = port["bits"][index] = next(self.fresh)
                cell = f"{PORT}{name}[{index}]"
                if port["direction"] == "input":
                    self.register(cell, outside, inside)
                    inputs.append(cell)
                else:
                    self.register(cell, inside, outside)
                    outputs.append(outside)
        return inputs, outputs

    def register(self, name: str, data: int, output: int) -> None:
        """Add a flip-flop."""
        kind = self.placer.register
        self.cell(name, kind, {"clock": self.clock, "data": data}, output)

    def cell(self, name: str, kind: CellPorts, inputs: Mapping[str, int], output: int) -> None:
        """Add a cell; inputs are given by our names of its ports."""
        connections = {kind.ports[port]: [bit] for port, bit in inputs.items()}
        self.top["cells"][name] = {
            "type": kind.type,
            "parameters": dict(kind.parameters),
            "attributes": {},
            "port_directions": {**dict.fromkeys(connections, "input"), kind.output: "output"},
            "connections": {**connections, kind.output: [output]},
        }

    def chain(self, inputs: list[str], outputs: list[int]) -> None:
        """Reduce the ports to two besides clock and reset."""
        pins = self.placer.pins
        assert pins is not None
        data = self.placer.register.ports["data"]
        scan_in = before = next(self.fresh)
        for name in inputs:
            connections = self.top["cells"][name]["connections"]
            connections[data] = [before]
            (before,) = connections[self.placer.register.output]
        # The end of the first chain is the start of the second, so that no logic is unused.
        for index in range(0, len(outputs), 3):
            three = (outputs[index : index + 3] + [before] * 2)[:3]
            total, after = next(self.fresh), next(self.fresh)
            bits = dict(zip("0123", (before, *three), strict=True))
            self.cell(f"sum {index}", pins.lut, bits, total)
            self.register(f"sum register {index}", total, after)
            before = after
        kept = {name: port for name, port in self.ports.items() if name in UNREGISTERED}
        self.ports.clear()
        self.ports.update(kept)
        self.ports["scan_in"] = {"direction": "input", "bits": [scan_in]}
        self.ports["scan_out"] = {"direction": "output", "bits": [before]}
        self.buffer()

    def buffer(self) -> None:
        """Put buffers at the pins, unless nextpnr adds them."""
        pins = self.placer.pins
        assert pins is not None
        if pins.input_buffer is None or pins.output_buffer is None:
            return
        for name, port in self.ports.items():
            (inside,) = port["bits"]
            pin = next(self.fresh)
            port["bits"] = [pin]
            if port["direction"] == "input":
                self.cell(f"pin {name}", pins.input_buffer, {"data": pin}, inside)
            else:
                self.cell(f"pin {name}", pins.output_buffer, {"data": inside}, pin)


def _bits(top: Mapping[str, Any]) -> Iterator[int]:
    for cell in top["cells"].values():
        for bits in cell["connections"].values():
            yield from (bit for bit in bits if isinstance(bit, int))
    for each in (*top["ports"].values(), *top["netnames"].values()):
        yield from (bit for bit in each["bits"] if isinstance(bit, int))
