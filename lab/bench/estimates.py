"""The file of `firm_hdl.estimates`, from results."""

from __future__ import annotations

import json
from collections.abc import Iterable

from firm_hdl.bench.results import Result
from firm_hdl.estimates import features_of
from firm_hdl.export.build import plan_of
from firm_hdl.frontend import open_library

__all__ = ["estimates_json"]

DEVICE = "ecp5"
"""The device of estimates."""


def entries_of(results: Iterable[Result]) -> list[dict[str, object]]:
    """Return the entries of all results with a clock rate on the device of estimates."""
    entries: list[dict[str, object]] = []
    for result in results:
        what, measured = result.converter, result.measured
        if measured is None or measured.device.name != DEVICE or result.mhz is None:
            continue
        message = open_library(what.distro, (), ()).message(what.type)
        plan = plan_of(message, what.wire, what.bus_bytes, what.max_message_bytes)
        entries.append(
            {
                "type": what.type,
                "wire": what.wire,
                "bus_bytes": what.bus_bytes,
                "direction": what.direction,
                "part": measured.device.title,
                "lut": measured.area.lut,
                "ff": measured.area.ff,
                "mhz": round(result.mhz, 1),
                **features_of(plan),
            }
        )
    return entries


def estimates_json(results: Iterable[Result]) -> str:
    """Return the text of the file."""
    lines = ",\n".join(json.dumps(entry) for entry in entries_of(results))
    return f"[\n{lines}\n]\n"
