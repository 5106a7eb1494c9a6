"""Libraries beside converters, as text."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from firm_hdl.bench.cycles import Cycles
from lab.bench.software.run import CLOCK_MHZ, LIBRARIES, Compared

__all__ = ["made_on", "software_rows", "software_table"]

_ROW = "{:<52}{:>9}" + "{:>22}" * (1 + len(LIBRARIES))


def software_table(compared: Iterable[Compared]) -> str:
    """Write a line of Markdown for each type and direction: ns per message, and Gbit/s."""
    names = [*LIBRARIES, "converter"]
    lines = [
        f"| Type | Wire | Bytes | Direction | {' | '.join(names)} |",
        f"| --- | --- | ---: | --- | {' | '.join(['---:'] * len(names))} |",
    ]
    for each in compared:
        for (kind, wire, direction), cells in _lines(each):
            cells = [f"{each.bytes:,.0f}", direction, *cells]
            lines.append(f"| {kind} | {wire} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def software_rows(compared: Compared | None = None) -> str:
    """Return the lines of a type for a terminal; `None`: the heading."""
    if compared is None:
        return _ROW.format("ns per message (Gbit/s)", "bytes", *LIBRARIES, "converter")
    return "\n".join(
        _ROW.format(" ".join(what), f"{compared.bytes:,.0f}", *cells).rstrip()
        for what, cells in _lines(compared)
    )


def _lines(compared: Compared) -> Iterator[tuple[tuple[str, str, str], list[str]]]:
    for result in compared.results:
        what = result.converter
        cells = [
            _cell(compared.times[name].of(what.direction), compared.bytes)
            if name in compared.times
            else ""
            for name in LIBRARIES
        ]
        cells.append("" if result.cycles is None else _of_converter(result.cycles))
        yield (what.type, what.wire, what.direction), cells


def _of_converter(cycles: Cycles) -> str:
    count = cycles.messages.count
    return _cell(1e3 * cycles.cycles / count / CLOCK_MHZ, cycles.bytes / count)


def _cell(ns: float, size: float) -> str:
    return f"{ns:,.0f} ({_three_digits(8 * size / ns)})"


def _three_digits(number: float) -> str:
    return f"{number:.3f}" if number < 1 else f"{number:.2f}" if number < 10 else f"{number:.1f}"


def made_on(machine: str, versions: Mapping[str, Mapping[str, str]]) -> str:
    """Write how the figures were made."""
    lines = [f"* Processor: {machine}; one thread\n"]
    for name, found in versions.items():
        each = ", ".join(f"{what} {version}" for what, version in found.items())
        lines.append(f"* {name}: {each}\n")
    return "".join(lines)
