"""Make the netlists and reports of the tools that `test_reports.py` reads: run this module.

They are what Yosys 0.70 and nextpnr 0.11.1 wrote of `Accumulator`, less what is not read.
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
    """A sum of what an input brings while another is high; the output says whether it is large."""

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
        kept: dict[str, Any] = {}

        def keep(tool: object, file: Path, kept: dict[str, Any] = kept) -> str:
            text = file.read_text(encoding="utf-8")
            kept[file.stem] = json.loads(text)
            return text

        with mock.patch.object(flow, "written", keep):
            measure(circuit, device, [1])
        for entry in kept.values():
            _forget(entry)
        found = {"netlist": {"modules": {"top": kept["top"]["modules"]["top"]}}}
        if "report" in kept:
            found["report"] = kept["report"]
        text = json.dumps(found, indent=None, separators=(",", ":")) + "\n"
        (FOLDER / f"{name}.json").write_text(text)


def _forget(entry: Any) -> None:
    """Remove what is not read: attributes, places, and the utilization."""
    if isinstance(entry, dict):
        for key in ("attributes", "loc", "sources", "utilization", "parameters"):
            entry.pop(key, None)
    for each in entry.values() if isinstance(entry, dict) else entry:
        if isinstance(each, dict | list):
            _forget(each)


if __name__ == "__main__":
    main()
