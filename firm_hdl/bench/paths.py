"""Critical paths of nextpnr, in the signal names of the design."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from firm_hdl.bench.netlist import Names
from firm_hdl.bench.tools import BenchError

__all__ = ["CriticalPath", "critical_path"]


@dataclass(frozen=True, slots=True, kw_only=True)
class CriticalPath:
    """The slowest path between two registers.

    Attributes
    ----------
    ns : float
        Its delay.
    routing_ns : float
        The part of it that is wires.
    luts : int
        Number of cells on the way.
    points : tuple of (float, str)
        Signals on the way, and when they are reached in ns. A name in parentheses is that of the
        nearest signal that the design names. The first and the last are the registers.
    """

    ns: float
    routing_ns: float
    luts: int
    points: tuple[tuple[float, str], ...]

    def __str__(self) -> str:
        way = " > ".join(f"{name} {ns:.1f}" for ns, name in self.points)
        return f"{self.ns:.1f} ns, {self.routing_ns:.1f} of them routing, {self.luts} LUTs: {way}"


def critical_path(report: Mapping[str, Any], names: Names) -> CriticalPath:
    """Find the path from register to register in a report of nextpnr.

    Raises
    ------
    BenchError
        If there is none.
    """
    for found in report.get("critical_paths", []):
        if "async" not in found["from"] and "async" not in found["to"]:
            return _described(found["path"], names)
    raise BenchError("nextpnr reports no path from a register to a register")


def _described(path: list[Mapping[str, Any]], names: Names) -> CriticalPath:
    points: list[tuple[float, str]] = []
    now = routing = 0.0
    for segment in path:
        now += segment["delay"]
        kind = segment["type"]
        if kind == "routing":
            routing += segment["delay"]
        if kind == "clk-to-q":
            name = names.register(segment["from"]["cell"])
        elif kind == "setup":
            name = names.register(segment["to"]["cell"])
        else:
            name = names.of(segment["net"]) if kind == "routing" else ""
        # The register says more than the nets behind and before it.
        known = {each.strip("()") for _, each in points[-1:]}
        if name and (kind == "setup" or name.strip("()") not in known):
            points.append((round(now, 2), name))
    return CriticalPath(
        ns=round(now, 2),
        routing_ns=round(routing, 2),
        luts=sum(segment["type"] == "logic" for segment in path),
        points=tuple(points),
    )
