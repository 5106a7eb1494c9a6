"""Figures of parts, as a table and as JSON."""

from __future__ import annotations

import json
from collections.abc import Iterable

from firm_hdl.bench.results import measured_to_json
from lab.bench.parts.run import PartResult

__all__ = ["part_table", "parts_text"]


def part_table(results: Iterable[PartResult]) -> str:
    """Write a line for each part that was measured."""
    lines = [
        "| Part | Parameters | LUT | FF | LUT RAM | Block RAM | MHz (each seed) |",
        "| --- | --- | ---: | ---: | ---: | ---: | ---: |",
    ]
    for result in results:
        if (measured := result.measured) is None:
            continue
        area = measured.area
        cells = [result.part.name, result.part.parameters]
        cells += [f"{n:,}" for n in (area.lut, area.ff, area.lutram, area.bram)]
        each = ", ".join(f"{placed.mhz:.0f}" for placed in measured.placed)
        cells.append("" if measured.mhz is None else f"{measured.mhz:.1f} ({each})")
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def parts_text(results: Iterable[PartResult]) -> str:
    """Write results as JSON, a line for each part."""
    lines = ",\n".join(
        json.dumps(
            {
                "part": result.part.name,
                "parameters": result.part.parameters,
                "circuit": None if result.measured is None else measured_to_json(result.measured),
                "problem": result.problem,
            }
        )
        for result in results
    )
    return f'{{"parts": [\n{lines}\n]}}\n'
