"""Netlists of Yosys as JSON: counts of cells, own names of nets, and registers outside of ports.

A clock rate of a circuit alone leaves out the paths from its input ports and to its output ports.
So every bit of a port gets a flip-flop outside. They are put into the netlist after it was mapped:
the circuit inside is the one whose cells were counted, and nothing is optimized across its ports.
"""

from __future__ import annotations

import re
from collections import Counter, deque
from collections.abc import Iterator, Mapping
from itertools import count
from typing import Any

from firm_hdl.bench.devices import Placer
from firm_hdl.bench.tools import BenchError

__all__ = ["Names", "cell_counts", "register_ports", "top_module"]

UNREGISTERED = ("clk", "rst")
"""Clock and reset. A reset comes from a register of its own, whose path is not the circuit's."""


def top_module(netlist: Mapping[str, Any]) -> dict[str, Any]:
    """Return the module ``top`` of a netlist as `write_json` writes it.

    Raises
    ------
    BenchError
        If there is none, or if it has no cells.
    """
    top: dict[str, Any] = netlist.get("modules", {}).get("top", {})
    if not top.get("cells"):
        raise BenchError("Yosys ended without an error, and its netlist has no cells")
    return top


def cell_counts(top: Mapping[str, Any]) -> Counter[str]:
    """Count a module's cells by type."""
    return Counter(cell["type"] for cell in top["cells"].values())


def register_ports(top: dict[str, Any], placer: Placer) -> int:
    """Put a flip-flop outside of every bit of every port but clock and reset.

    Returns
    -------
    int
        Number of flip-flops that were added.

    Raises
    ------
    BenchError
        If the module has no port ``clk``.
    """
    if "clk" not in top["ports"]:
        raise BenchError("the circuit has no clock 'clk', so it has no clock rate")
    (clock,) = top["ports"]["clk"]["bits"]
    fresh = count(1 + max(_bits(top), default=1))
    added = 0
    for name, port in top["ports"].items():
        if name in UNREGISTERED:
            continue
        for index, inside in enumerate(port["bits"]):
            # An output may be a constant.
            if not isinstance(inside, int):
                continue
            outside = next(fresh)
            is_input = port["direction"] == "input"
            data, output = (outside, inside) if is_input else (inside, outside)
            port["bits"][index] = outside
            top["cells"][f"port {name}[{index}]"] = {
                "type": placer.register,
                "parameters": dict(placer.parameters),
                "attributes": {},
                "port_directions": {
                    placer.clock: "input",
                    placer.data: "input",
                    placer.output: "output",
                },
                "connections": {
                    placer.clock: [clock],
                    placer.data: [data],
                    placer.output: [output],
                },
            }
            added += 1
    return added


def _bits(top: Mapping[str, Any]) -> Iterator[int]:
    for cell in top["cells"].values():
        for bits in cell["connections"].values():
            yield from (bit for bit in bits if isinstance(bit, int))
    for each in (*top["ports"].values(), *top["netnames"].values()):
        yield from (bit for bit in each["bits"] if isinstance(bit, int))


class Names:
    """What the design itself calls the nets of a netlist.

    Most nets between look-up tables have no name in the design. Yosys names them after a neighbour,
    such as ``fill_LUT4_A_Z``; those names are not used, because the neighbour may be any.

    Parameters
    ----------
    top : mapping
        A module, as :func:`top_module` returns it.
    """

    def __init__(self, top: Mapping[str, Any]):
        self._cells = top["cells"]
        kinds = "|".join(sorted({re.escape(cell["type"]) for cell in self._cells.values()}))
        derived = re.compile(rf"^\$|_(?:{kinds})_")
        self._own: dict[int, str] = {}
        self._bits: dict[str, int] = {}
        self._drivers = {
            bit: name for name in self._cells for bit in self._connected(name, "output")
        }
        for name, net in top["netnames"].items():
            is_own = not net.get("hide_name") and not derived.search(name)
            for index, bit in enumerate(net["bits"]):
                if not isinstance(bit, int):
                    continue
                self._bits[f"{name}[{index}]" if len(net["bits"]) > 1 else name] = bit
                known = self._own.get(bit)
                if is_own and (known is None or (len(name), name) < (len(known), known)):
                    self._own[bit] = name

    def net(self, name: str) -> str:
        """Return the design's name of a net, without the index of the bit, or an empty text."""
        return self._own.get(self._bits.get(name, -1), "")

    def register(self, cell: str) -> str:
        """Return the design's name of a flip-flop, from the name of its cell."""
        if cell.startswith("port "):
            return cell.partition("[")[0]
        outputs = self._connected(cell, "output")
        return next((self._own[bit] for bit in outputs if bit in self._own), cell)

    def joining(self, cell: str, net: str) -> Iterator[str]:
        """Yield the design's names of what enters a cell, through other logic, beside one net.

        The nearest come first, and none comes twice.
        """
        seen = {self._bits.get(net, -1)}
        told: set[str] = set()
        waiting = deque(self._connected(cell, "input"))
        while waiting:
            bit = waiting.popleft()
            if bit in seen:
                continue
            seen.add(bit)
            if bit in self._own:
                if self._own[bit] not in told:
                    told.add(self._own[bit])
                    yield self._own[bit]
            elif bit in self._drivers:
                waiting.extend(self._connected(self._drivers[bit], "input"))

    def _connected(self, cell: str, direction: str) -> Iterator[int]:
        found = self._cells.get(cell, {"port_directions": {}})
        for port, way in found["port_directions"].items():
            for bit in found["connections"][port] if way == direction else ():
                if isinstance(bit, int):
                    yield bit
