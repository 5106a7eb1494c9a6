"""Make the netlists and reports of the tools that `test_reports.py` reads: run this module.

They are the output of Yosys 0.70 and nextpnr 0.11.1 for `Accumulator`, without the unread parts.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any
from unittest import mock

from amaranth.back import rtlil
from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.bench import DEVICES, flow, measure

__all__ = ["FOLDER", "Accumulator"]

FOLDER = Path(__file__).parent / "reports"


class Accumulator(wiring.Component):
    """A sum of an input while another input is high; the output is high if the sum is large."""

    def __init__(self) -> None:
        super().__init__({"amount": In(8), "enable": In(1), "large": Out(1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        total = Signal(8)
        with m.If(self.enable):
            m.d.sync += total.eq(total + self.amount)
        m.d.comb += self.large.eq(total > 100)
        return m


def main() -> None:
    """Write the files of all devices."""
    FOLDER.mkdir(exist_ok=True)
    circuit = rtlil.convert(Accumulator(), name="top", emit_src=False)
    for name, device in DEVICES.items():
        remaining: dict[str, Any] = {}

        def write(tool: object, file: Path, remaining: dict[str, Any] = remaining) -> str:
            text = file.read_text(encoding="utf-8")
            remaining[file.stem] = json.loads(text)
            return text

        with mock.patch.object(flow, "written", write):
            measure(circuit, device, [1])
        for entry in remaining.values():
            _strip(entry)
        found = {"netlist": {"modules": {"top": remaining["top"]["modules"]["top"]}}}
        if "report" in remaining:
            found["report"] = remaining["report"]
        text = json.dumps(found, indent=None, separators=(",", ":")) + "\n"
        (FOLDER / f"{name}.json").write_text(text)


def _strip(entry: Any) -> None:
    """Remove parts that are not read: attributes, places, and the utilization."""
    if isinstance(entry, dict):
        for key in ("attributes", "loc", "sources", "utilization", "parameters"):
            entry.pop(key, None)
    for each in entry.values() if isinstance(entry, dict) else entry:
        if isinstance(each, dict | list):
            _strip(each)


if __name__ == "__main__":
    main()
