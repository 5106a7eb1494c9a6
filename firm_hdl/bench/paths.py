"""Critical paths of nextpnr, in the signal names of the design."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import islice
from typing import Any

from firm_hdl.bench.netlist import Names
from firm_hdl.bench.tools import BenchError

__all__ = ["CriticalPath", "critical_path"]

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

    Raises
    ------
    BenchError
        If the report has no such path.
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
