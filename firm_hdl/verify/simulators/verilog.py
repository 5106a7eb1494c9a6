"""Functions that simulators of Verilog share, for the modules and the rows of inputs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from firm_hdl.export.top import Top
from firm_hdl.export.verilog import module_name
from firm_hdl.names.identifiers import identifier
from firm_hdl.verify.simulators.benches import STIMULI
from firm_hdl.verify.simulators.trace import Trace
from firm_hdl.verilog import convert

__all__ = ["modules_of", "write_inputs"]


def modules_of(trace: Trace) -> list[str]:
    """Name the devices' modules as ``firm-hdl build`` names them."""
    plan = trace.devices[0].plan
    base = f"{identifier(plan.message)}_{plan.wire}_{plan.bus_bytes}"
    return [module_name(base, device.direction) for device in trace.devices]


def write_inputs(trace: Trace, tops: Sequence[Top], folder: Path) -> list[str]:
    """Write the Verilog and the rows of inputs; return the names of the files of Verilog.

    A row begins with the number of its changes, because Verilog's formats cannot find a line end.
    """
    files = []
    for module, top in zip(modules_of(trace), tops, strict=True):
        files.append(f"{module}.v")
        text = convert(top, name=module)
        (folder / files[-1]).write_text(text, encoding="utf-8")
    rows = (f"{row.count(' ') // 2} {row}\n" for row in trace.stimuli)
    (folder / STIMULI).write_text("".join(rows))
    return files
