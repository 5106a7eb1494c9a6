"""Netlists of Yosys as JSON, and critical paths of nextpnr in the design's own names of nets."""

from __future__ import annotations

import re
from collections import Counter, deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice
from typing import Any

from firm_hdl.bench.tools import BenchError

__all__ = ["PORT", "CriticalPath", "Names", "cell_counts", "critical_path", "top_module"]


MOST_NAMES = 3
"""Largest number of named signals that join a path at one point."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CriticalPath:
    """The slowest path between two registers."""

    ns: float  # Delay of the path.
    routing_ns: float  # The part of the delay that is routing.
    cells: int  # Number of look-up tables, carry chains and the like on the path.
    # Signals on the path, each with its arrival time in ns. The first and the last are the
    # registers. Signals after `&` join the path there, directly or through other logic. Each
    # joining signal is named only once.
    points: tuple[tuple[float, str], ...]

    def __str__(self) -> str:
        route = " > ".join(f"{name} {ns:.1f}" for ns, name in self.points)
        cells = f"{self.cells} cell{'' if self.cells == 1 else 's'}"
        return f"{self.ns:.1f} ns, {self.routing_ns:.1f} of them routing, {cells}: {route}"


def critical_path(report: Mapping[str, Any], names: Names) -> CriticalPath:
    """Find the path from register to register in a report of nextpnr.

    Raises `BenchError` if the report has no such path.
    """
    for found in report.get("critical_paths", []):
        if "async" not in found["from"] and "async" not in found["to"]:
            return _described(found["path"], names)
    raise BenchError("nextpnr reports no path from a register to a register")


def _described(path: list[Mapping[str, Any]], names: Names) -> CriticalPath:
    points: list[tuple[float, str]] = []
    now = routing = 0.0
    net = ""
    known: set[str] = set()
    for segment in path:
        now += segment["delay"]
        match segment["type"]:
            case "clk-to-q":
                name = names.register(segment["from"]["cell"])
            case "setup":
                name = names.register(segment["to"]["cell"])
            case "routing":
                routing += segment["delay"]
                net = segment["net"]
                name = names.net(net)
            case _:
                joining = names.joining(segment["from"]["cell"], net)
                new = list(islice((each for each in joining if each not in known), MOST_NAMES))
                known.update(new)
                name = "& " + ", ".join(new) if new else ""
        # A register and the net that it drives have the same name.
        if name and (name not in known or segment["type"] == "setup"):
            points.append((round(now, 2), name))
            known.add(name)
    return CriticalPath(
        ns=round(now, 2),
        routing_ns=round(routing, 2),
        cells=sum(segment["type"] == "logic" for segment in path),
        points=tuple(points),
    )


PORT = "port "
"""Prefix of the names of flip-flops outside of ports; see :mod:`firm_hdl.bench.surroundings`."""

_PACKED = re.compile(r"_(?:DFF)?LC$|\$.*$")


def top_module(netlist: Mapping[str, Any]) -> dict[str, Any]:
    """Return the module ``top`` of a netlist as `write_json` writes it.

    Raises `BenchError` if there is none, or if it has no cells.
    """
    top: dict[str, Any] = netlist.get("modules", {}).get("top", {})
    if not top.get("cells"):
        raise BenchError("Yosys ended without an error, and its netlist has no cells")
    return top


def cell_counts(top: Mapping[str, Any]) -> Counter[str]:
    """Count a module's cells by type."""
    return Counter(cell["type"] for cell in top["cells"].values())


class Names:
    """The design's own names of the nets of a netlist.

    Most nets between look-up tables have no name in the design. Yosys names them after a neighbour,
    such as ``fill_LUT4_A_Z``. These names are not used, because the choice of the neighbour is
    arbitrary.

    * `top`: a module, as :func:`top_module` returns it.
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
        self._sinks: dict[int, list[str]] = {}
        for name in self._cells:
            for bit in self._connected(name, "input"):
                self._sinks.setdefault(bit, []).append(name)
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
        """Return the design's name of a flip-flop, from the name of its cell.

        On iCE40, a placed cell has the name of the look-up table in it, which drives the flip-flop.
        """
        if cell.startswith(PORT):
            return cell.partition("[")[0]
        inside = self._mapped(cell)
        outputs = list(self._connected(inside, "output"))
        for sink in (inside, *(name for bit in outputs for name in self._sinks.get(bit, ()))):
            if sink.startswith(PORT):
                return sink.partition("[")[0]
            for bit in self._connected(sink, "output"):
                if bit in self._own:
                    return self._own[bit]
        return cell

    def _mapped(self, cell: str) -> str:
        """Return the name that a placed cell had before it was packed."""
        return cell if cell in self._cells else _PACKED.sub("", cell)

    def joining(self, cell: str, net: str) -> Iterator[str]:
        """Yield the design's names of the nets that a cell depends on, except one net.

        Logic without names is followed backwards. The nearest nets come first, each name once.
        """
        seen = {self._bits.get(net, -1)}
        told: set[str] = set()
        waiting = deque(self._connected(self._mapped(cell), "input"))
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
        for port, kind in found["port_directions"].items():
            for bit in found["connections"][port] if kind == direction else ():
                if isinstance(bit, int):
                    yield bit
