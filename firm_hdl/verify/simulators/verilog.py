"""What simulators of Verilog have in common: the modules, their instances, the rows of inputs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from firm_hdl.export.top import Top
from firm_hdl.export.verilog import module_name, to_verilog
from firm_hdl.names.identifiers import identifier
from firm_hdl.verify.simulators.trace import Device, Pin, Trace

__all__ = ["RESULTS", "STIMULI", "instances", "vector", "write_inputs"]

STIMULI = "stimuli.txt"
RESULTS = "results.txt"


def _module_of(device: Device) -> str:
    """Name a device's module as ``firm-hdl build`` names it."""
    plan = device.plan
    folder = f"{identifier(plan.message)}_{plan.wire}_{plan.bus_bytes}"
    return module_name(folder, device.direction)


def write_inputs(trace: Trace, tops: Sequence[Top], folder: Path) -> list[str]:
    """Write the Verilog and the rows of inputs; return the names of the files of Verilog.

    A row has the number of its changes in front, as the formats of Verilog know no end of a line.
    """
    files = []
    for device, top in zip(trace.devices, tops, strict=True):
        module = _module_of(device)
        files.append(f"{module}.v")
        text = to_verilog(top, module=module, header="")
        (folder / files[-1]).write_text(text, encoding="utf-8")
    rows = (f"{row.count(' ') // 2} {row}\n" for row in trace.stimuli)
    (folder / STIMULI).write_text("".join(rows))
    return files


def vector(pin: Pin) -> str:
    """Return a pin's range, with a space behind it; nothing for a single bit."""
    return "" if pin.port.width == 1 else f"[{pin.port.width - 1}:0] "


def instances(trace: Trace) -> Iterator[str]:
    """Yield an instance of each device: inputs are ``i`` and their number, outputs ``o``."""
    for number, device in enumerate(trace.devices):
        pairs = [".aclk(aclk)", ".aresetn(aresetn)"]
        for letter, pins in (("i", trace.inputs), ("o", trace.outputs)):
            mine = [pin for pin in pins if pin.device == number]
            pairs += [f".{pin.port.name}({letter}{pin.number})" for pin in mine]
        joined = ",\n    ".join(pairs)
        yield f"  {_module_of(device)} {device.direction} (\n    {joined});\n"
