"""The page of figures: tables between marks of a Markdown file, and plots beside it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from statistics import median

from firm_hdl.bench.results import Result
from firm_hdl.bench.tables import LINE_RATE_MHZ, beats_per_cycle, geometric_mean
from firm_hdl.bench.tools import BenchError
from firm_hdl.files import write_file

__all__ = [
    "area_table",
    "beats_table",
    "below_table",
    "converter_table",
    "covering_table",
    "made_with",
    "path_list",
    "write_page",
]


def write_page(page: Path, parts: Mapping[str, str]) -> None:
    """Replace parts of a page, each between lines ``<!-- NAME -->`` and ``<!-- end NAME -->``.

    Raises
    ------
    BenchError
        If the page does not have the marks of a part.
    """
    text = page.read_text(encoding="utf-8")
    for name, part in parts.items():
        begin, end = f"<!-- {name} -->\n", f"<!-- end {name} -->\n"
        whole = re.compile(f"{re.escape(begin)}.*?{re.escape(end)}", re.DOTALL)
        if len(whole.findall(text)) != 1:
            raise BenchError(f"'{page}' has not one part '{name}'")
        text = whole.sub(lambda _, new=f"{begin}\n{part}\n{end}": new, text)  # type: ignore[misc]
    write_file(page, text)


def converter_table(results: Iterable[Result]) -> str:
    """Write a line for each converter, with all figures except the path, and then the paths."""
    found = list(results)
    lines = [
        "| Type | Wire | Bus | Direction | LUT | FF | Carry | RAM | MHz (each seed) | "
        "Beats/cycle | Latency | Gbit/s |",
        "| --- | --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    for result in found:
        what, measured, cycles = result.converter, result.measured, result.cycles
        cells = [what.type, what.wire, str(what.bus_bytes), what.direction]
        if measured is None:
            cells += [""] * 5
        else:
            area = measured.area
            cells += [f"{n:,}" for n in (area.lut, area.ff, area.carry)]
            cells.append(str(area.lutram + area.bram))
            cells.append(_rates(result))
        cells += ["", ""] if cycles is None else [f"{1 / cycles.per_beat:.3f}", str(cycles.latency)]
        cells.append("" if result.gbit_per_s is None else f"{result.gbit_per_s:.2f}")
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def _rates(result: Result) -> str:
    if result.measured is None or result.mhz is None:
        return ""
    each = [f"{placed.mhz:.0f}" for placed in result.measured.placed]
    return f"{result.mhz:.1f}" + (f" ({', '.join(each)})" if len(each) > 1 else "")


def path_list(results: Iterable[Result]) -> str:
    """Write the critical path of each converter."""
    return "".join(
        f"* `{result.converter.type}` {result.converter.wire} {result.converter.direction}: "
        f"`{result.measured.path}`\n"
        for result in results
        if result.measured is not None and result.measured.path is not None
    )


def area_table(results: Iterable[Result]) -> str:
    """Write the figures of converters on several devices: a line for each, by device."""
    lines = [
        "| Device | Type | Direction | LUT | FF | Carry | RAM | MHz |",
        "| --- | --- | --- | ---: | ---: | ---: | ---: | ---: |",
    ]
    for result in results:
        if (measured := result.measured) is None:
            continue
        area = measured.area
        cells = [measured.device.title, result.converter.type, result.converter.direction]
        cells += [f"{n:,}" for n in (area.lut, area.ff, area.carry)]
        cells += [str(area.lutram + area.bram), _rates(result)]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def beats_table(sets: Mapping[str, Sequence[Result]]) -> str:
    """Write the geometric mean and the extremes of beats per cycle of sets of converters."""
    lines = [
        "| Converters | Number | Beats per cycle, geometric mean | Below 0.85 | Lowest |",
        "| --- | ---: | ---: | ---: | --- |",
    ]
    for name, results in sets.items():
        pairs = beats_per_cycle(results)
        if not pairs:
            continue
        mean = geometric_mean(value for value, _ in pairs)
        below = sum(value < 0.85 for value, _ in pairs)
        lowest, worst = pairs[0]
        lines.append(
            f"| {name} | {len(pairs)} | {mean:.3f} | {below} | {lowest:.3f}, "
            f"{worst.converter.type} {worst.converter.direction} |"
        )
    return "\n".join(lines) + "\n"


def covering_table(results: Iterable[Result]) -> str:
    """Write how many converters of each distribution and direction reach the clock of 10 Gbit/s."""
    lines = [
        f"| Converters | Number | {LINE_RATE_MHZ} MHz or more | Median MHz | Lowest MHz |",
        "| --- | ---: | ---: | ---: | ---: |",
    ]
    sets: dict[str, list[float]] = {}
    for result in results:
        if result.mhz is not None:
            what = result.converter
            sets.setdefault(f"{what.distro}, {what.direction}s", []).append(result.mhz)
    for name, rates in sorted(sets.items()):
        enough = sum(rate >= LINE_RATE_MHZ for rate in rates)
        cells = [name, str(len(rates)), str(enough), f"{median(rates):.0f}", f"{min(rates):.0f}"]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def below_table(results: Iterable[Result]) -> str:
    """Write the critical path of each converter below the clock of 10 Gbit/s, the slowest first."""
    lines = ["| Type | Direction | LUT | MHz | Slowest path |", "| --- | --- | ---: | ---: | --- |"]
    rates = [(each.mhz, each.key, each) for each in results if each.mhz is not None]
    for mhz, _, result in sorted(rates, key=lambda each: each[:2]):
        if mhz < LINE_RATE_MHZ and (measured := result.measured) is not None:
            what = result.converter
            cells = [what.type, what.direction, f"{measured.area.lut:,}", f"{mhz:.1f}"]
            lines.append(f"| {' | '.join([*cells, f'`{measured.path}`'])} |")
    return "\n".join(lines) + "\n"


def made_with(results: Iterable[Result]) -> str:
    """Write each combination of device, tools and options with which figures were made."""
    counts: dict[str, int] = {}
    for result in results:
        if (found := result.measured) is None:
            continue
        tools = ", ".join(f"{name} {version}" for name, version in sorted(found.tools.items()))
        seeds = ", ".join(str(each.seed) for each in found.placed)
        parts = [f"`{found.mapping}`", *([f"`{found.placement}`"] if found.placement else [])]
        conditions = f"{found.device.title}: {tools}; {'; '.join(parts)}"
        conditions += f"; seeds {seeds}" if seeds else ""
        counts[conditions] = counts.get(conditions, 0) + 1
    return "".join(
        f"* {conditions} ({count} converters)\n" for conditions, count in sorted(counts.items())
    )
