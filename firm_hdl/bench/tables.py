"""Results as text: a line for each converter, and a summary."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import exp, fsum, log

from firm_hdl.bench.cycles import Stated
from firm_hdl.bench.devices import Device
from firm_hdl.bench.results import Result

__all__ = ["LINE_RATE_MHZ", "beats_per_cycle", "geometric_mean", "head", "row", "summary"]

LINE_RATE_MHZ = 156.25
"""Clock rate at which a beat of 8 bytes per cycle is 10 Gbit/s."""

_ROW = "{:<52}{:>4} {:>6}{:>7}{:>6}{:>5}{:>5}  {:<28}{:>11}{:>8}{:>8}"


def geometric_mean(values: Iterable[float]) -> float:
    """Return the geometric mean of one or more positive numbers."""
    logs = [log(value) for value in values]
    return exp(fsum(logs) / len(logs))


def beats_per_cycle(results: Iterable[Result]) -> list[tuple[float, Result]]:
    """Return the beats per cycle of all results with cycles, the lowest first."""
    found = [(1 / each.cycles.per_beat, each) for each in results if each.cycles is not None]
    return sorted(found, key=lambda pair: (pair[0], pair[1].key))


def head(device: Device | None) -> str:
    """Return the heading of the table."""
    title = "" if device is None else f"{device.title}\n"
    names = ("converter", "bus", "LUT", "FF", "carry", "RAM", "BRAM", "MHz, median (of seeds)")
    return title + _ROW.format(*names, "beats/cycle", "latency", "Gbit/s").rstrip()


def row(result: Result, *, path: bool = True) -> str:
    """Return the line of a converter, then its critical path, or why figures are missing."""
    what, measured, cycles = result.converter, result.measured, result.cycles
    area = [""] * 5
    rates = ""
    if measured is not None:
        found = measured.area
        area = [str(n) for n in (found.lut, found.ff, found.carry, found.lutram, found.bram)]
        if measured.mhz is not None:
            each = " ".join(f"{placed.mhz:.1f}" for placed in measured.placed)
            rates = f"{measured.mhz:.1f} ({each})"
    counts = ["", ""]
    if cycles is not None:
        counts = [f"{1 / cycles.per_beat:.3f}", str(cycles.latency)]
    rate = "" if result.gbit_per_s is None else f"{result.gbit_per_s:.2f}"
    name = f"{what.type} {what.wire} {what.direction}"
    lines = [_ROW.format(name, what.bus_bytes, *area, rates, *counts, rate).rstrip()]
    if path and measured is not None and measured.path is not None:
        lines.append(f"    {measured.path}")
    if result.problem:
        lines.append(f"    no figures: {result.problem}")
    return "\n".join(lines)


def summary(results: Sequence[Result], stated: Stated | None) -> str:
    """Describe how the figures were made, and summarize them."""
    lines = []
    mappings = sorted({each.measured.mapping for each in results if each.measured is not None})
    for mapping in mappings:
        measured = [
            each.measured
            for each in results
            if each.measured is not None and each.measured.mapping == mapping
        ]
        tools = sorted({f"{name} {version}" for m in measured for name, version in m.tools.items()})
        placements = sorted({m.placement for m in measured if m.placement})
        lines.append(f"{', '.join(tools)}: {'; '.join([mapping, *placements])}")
    if stated is not None and any(each.cycles is not None for each in results):
        lines.append(f"simulated with {stated}")
    pairs = beats_per_cycle(results)
    if len(pairs) > 1:
        mean = geometric_mean(value for value, _ in pairs)
        lowest, worst = pairs[0]
        below = sum(value < 0.85 for value, _ in pairs)
        lines.append(
            f"beats per cycle: {mean:.3f} (geometric mean of {len(pairs)}), "
            f"{below} below 0.85, lowest {lowest:.3f} ({worst.converter})"
        )
    rates = sorted((each.mhz, each.key, each) for each in results if each.mhz is not None)
    if len(rates) > 1:
        lines.append(f"lowest clock rate: {rates[0][0]:.1f} MHz ({rates[0][2].converter})")
    wrong = sum(bool(each.problem) for each in results)
    if wrong:
        lines.append(f"{wrong} of {len(results)} converters are without some figures")
    return "\n".join(lines)
