"""The figures of a converter, and files of them as JSON."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from firm_hdl.bench.cycles import Cycles, Stated
from firm_hdl.bench.devices import DEVICES, Area
from firm_hdl.bench.flow import Measured, Placed
from firm_hdl.bench.netlist import CriticalPath
from firm_hdl.bench.tools import BenchError
from firm_hdl.files import read_file
from firm_hdl.plan import Direction
from firm_hdl.wire import Wire

__all__ = [
    "Converted",
    "Result",
    "measured_from_json",
    "measured_to_json",
    "read_results",
    "results_text",
]

FORMAT = 1
"""Version of the file format."""

MOST_BYTES = 1 << 28


@dataclass(frozen=True, slots=True, kw_only=True, order=True)
class Converted:
    """The identification of a converter."""

    distro: str
    type: str
    wire: Wire
    bus_bytes: int
    max_message_bytes: int
    direction: Direction

    def __str__(self) -> str:
        return f"{self.type} ({self.distro}, {self.wire}, {self.bus_bytes} bytes) {self.direction}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Result:
    """The figures of a converter."""

    converter: Converted
    cycles: Cycles | None = None
    measured: Measured | None = None  # `None` if no device was asked for.
    problem: str = ""  # Why figures are missing; else empty.

    @property
    def mhz(self) -> float | None:
        """Median clock rate in MHz."""
        return None if self.measured is None else self.measured.mhz

    @property
    def gbit_per_s(self) -> float | None:
        """Throughput of packets in 10⁹ bits per second, with the stated messages, at `mhz`."""
        if self.mhz is None or self.cycles is None:
            return None
        return self.mhz * self.cycles.bits_per_cycle / 1000

    @property
    def key(self) -> tuple[str, ...]:
        """The key of comparisons: the converter, and the device."""
        device = "" if self.measured is None else self.measured.device.name
        return (*(str(value) for value in asdict(self.converter).values()), device)


def measured_to_json(measured: Measured) -> dict[str, Any]:
    """Return the figures of a circuit as a value for JSON."""
    return {
        "device": measured.device.name,
        "part": measured.device.title,
        "mapping": measured.mapping,
        "placement": measured.placement,
        "tools": dict(measured.tools),
        **asdict(measured.area),
        "port_registers": measured.port_registers,
        "mhz": measured.mhz,
        "seeds": [
            {"seed": each.seed, "mhz": each.mhz, "critical_path": asdict(each.path)}
            for each in measured.placed
        ],
        "problem": measured.problem,
    }


def measured_from_json(found: Mapping[str, Any]) -> Measured:
    """Read what :func:`measured_to_json` wrote; raise a `KeyError` if something is missing."""
    return Measured(
        device=DEVICES[found["device"]],
        area=Area(**{name: found[name] for name in Area.__dataclass_fields__}),
        port_registers=found["port_registers"],
        placed=tuple(
            Placed(seed=each["seed"], mhz=each["mhz"], path=_path(each["critical_path"]))
            for each in found["seeds"]
        ),
        mapping=found["mapping"],
        placement=found["placement"],
        tools=found["tools"],
        problem=found["problem"],
    )


def _path(found: Mapping[str, Any]) -> CriticalPath:
    points = tuple((ns, name) for ns, name in found["points"])
    return CriticalPath(**{**found, "points": points})


def results_text(results: Iterable[Result]) -> str:
    """Write results as JSON, in the order of their converters, a line for each."""
    in_order = sorted(results, key=lambda each: each.key)
    lines = ",\n".join(json.dumps(_entry(result)) for result in in_order)
    return f'{{"format": {FORMAT}, "results": [\n{lines}\n]}}\n'


def _entry(result: Result) -> dict[str, Any]:
    entry: dict[str, Any] = asdict(result.converter)
    cycles = result.cycles
    if cycles is not None:
        entry["simulation"] = {
            "messages": asdict(cycles.messages),
            "bytes": cycles.bytes,
            "beats": cycles.beats,
            "cycles": cycles.cycles,
            "latency": cycles.latency,
            "cycles_per_beat": round(cycles.per_beat, 4),
        }
    if result.measured is not None:
        entry["circuit"] = measured_to_json(result.measured)
    if result.gbit_per_s is not None:
        entry["gbit_per_s"] = round(result.gbit_per_s, 3)
    entry["problem"] = result.problem
    return entry


def read_results(path: str | Path) -> list[Result]:
    """Read a file of results.

    Raises `BenchError` if the file is not a file of results. Raises `OSError` if the file cannot be
    read.
    """
    try:
        found = json.loads(read_file(path, MOST_BYTES))
        if found["format"] != FORMAT:
            raise BenchError(f"'{path}' has format {found['format']}, and {FORMAT} is read")
        results = [_result(entry) for entry in found["results"]]
        if not all(map(_can_be_compared, results)):
            raise ValueError("a figure is no number that was measured")
        return results
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        reason = f"{type(error).__name__}: {error}"
        raise BenchError(f"'{path}' is not a file of results of bench ({reason})") from None


def _can_be_compared(result: Result) -> bool:
    """Tell whether all figures are numbers that a program can have measured."""
    found: list[object] = []
    if (cycles := result.cycles) is not None:
        found += [cycles.bytes, cycles.latency, cycles.beats, cycles.cycles]
        if 0 in (cycles.beats, cycles.cycles):
            return False
    if result.measured is not None:
        found += asdict(result.measured.area).values()
        found += [each.mhz for each in result.measured.placed]
    return all(type(each) in (int, float) and 0 <= each < 1e18 for each in found)  # type: ignore[operator]


def _result(entry: Mapping[str, Any]) -> Result:
    cycles = None
    if (found := entry.get("simulation")) is not None:
        stated = found["messages"]
        cycles = Cycles(
            messages=Stated(
                count=stated["count"],
                characters=(stated["characters"][0], stated["characters"][1]),
                elements=(stated["elements"][0], stated["elements"][1]),
                seed=stated["seed"],
            ),
            **{name: found[name] for name in ("bytes", "beats", "cycles", "latency")},
        )
    circuit = entry.get("circuit")
    return Result(
        converter=Converted(**{name: entry[name] for name in Converted.__dataclass_fields__}),
        cycles=cycles,
        measured=None if circuit is None else measured_from_json(circuit),
        problem=entry["problem"],
    )
