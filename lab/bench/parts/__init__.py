"""Area and clock rate of the parts that carry whole packets."""

from __future__ import annotations

from lab.bench.parts.run import PART_DEVICE, PartResult, run_parts
from lab.bench.parts.standard import EIGHT_TOPICS, PARTS, Part
from lab.bench.parts.table import part_table, parts_text

__all__ = [
    "EIGHT_TOPICS",
    "PARTS",
    "PART_DEVICE",
    "Part",
    "PartResult",
    "part_table",
    "parts_text",
    "run_parts",
]
