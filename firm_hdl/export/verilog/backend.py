"""The Verilog of a type's converters: a file per module, a template of each, and waivers."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

from firm_hdl.export.axis_leaves import AxisPort, axis_module, axis_ports
from firm_hdl.export.backend import Converters, Output, module_name
from firm_hdl.export.top import DIRECTIONS, Direction, ports_of
from firm_hdl.export.verilog.template import instance, template
from firm_hdl.plan import Plan
from firm_hdl.verilog import convert

__all__ = ["converter_axis_ports", "waivers", "write"]

_WAIVERS = "waivers.vlt"
"""File with waivers of Verilator's warnings."""

_WAIVED = {
    "WIDTH": "An assignment cuts the result of a shift.",
    "UNUSEDSIGNAL": "Amaranth names every field of a structure, used or not.",
    "VARHIDDEN": "A parameter of a function has the name of the signal that it takes.",
    "DECLFILENAME": "A file has a module and its submodules.",
}


def write(converters: Converters) -> Output:
    """Write Verilog-2005 that is also SystemVerilog, and the manifest's entry `converters`."""
    name, plan = converters.name, converters.plan
    files, instances = {}, {}
    section: dict[str, dict[str, Any]] = {}
    for direction in DIRECTIONS:
        module = module_name(name, direction)
        header = converters.header(module, f"the {direction}")
        files[f"{module}.v"] = convert(
            converters.circuits[direction],
            name=module,
            header=header + converters.steps(direction),
        )
        section[direction] = {
            "module": module,
            "verilog": f"{module}.v",
            "clock": "aclk",
            "reset": "aresetn",
            "ports": _ports(plan, direction),
        }
        if converters.options.leaf_ports == "axis":
            axis, ports = (
                module_name(name, direction, "axis"),
                converter_axis_ports(plan, direction),
            )
            what = converters.header(axis, f"the {direction} with leaves as AXI4-Stream")
            files[f"{axis}.v"] = axis_module(axis, module, ports, what)
            section[direction]["axis"] = {
                "module": axis,
                "verilog": [f"{module}.v", f"{axis}.v"],
                "ports": [asdict(port) for port in ports],
            }
        instances[direction] = instance(converters.message, plan, direction, module=module)
        if "tools" in converters.options.extras:
            section[direction]["template"] = f"{module}.veo"
            files[f"{module}.veo"] = template(direction, instances[direction], header=header)
    if "tools" in converters.options.extras:
        parts = [(), *([("axis",)] if converters.options.leaf_ports == "axis" else [])]
        modules = [module_name(name, each, *part) for part in parts for each in DIRECTIONS]
        modules += [module_name(name, each, "registers") for each in converters.registers]
        files[_WAIVERS] = waivers(modules)
    return Output(files=files, manifest={"converters": section}, instances=instances)


def converter_axis_ports(plan: Plan, direction: Direction) -> list[AxisPort]:
    """List the ports of a converter whose leaves are AXI4-Stream."""
    ports = ports_of(plan, direction)
    return axis_ports(ports, {port.name: port.member for port in ports if port.leaf is not None})


def waivers(modules: Iterable[str]) -> str:
    """Write the waivers of some modules, each with its reason, for ``verilator --lint-only -Wall``.

    * `modules`: names of the modules. The file of a module is its name with ``.v``.
    """
    lines = [
        "// Warnings of Verilator that are harmless here, each with the reason. To lint:\n",
        f"// $ verilator --lint-only -Wall {_WAIVERS} FILE.v\n\n",
        "`verilator_config\n",
    ]
    files = [f"{module}.v" for module in modules]
    for rule, reason in _WAIVED.items():
        lines.append(f"\n// {reason}\n")
        lines += [f'lint_off -rule {rule} -file "*{file}"\n' for file in files]
    return "".join(lines)


def _ports(plan: Plan, direction: Direction) -> list[dict[str, Any]]:
    entries = []
    for port in ports_of(plan, direction):
        entry: dict[str, Any] = {
            "name": port.name,
            "direction": port.direction,
            "width": port.width,
            "signed": port.signed,
            "meaning": port.meaning,
        }
        if port.leaf is not None:
            entry["leaf"] = str(plan.leaves[port.leaf])
        entries.append(entry)
    return entries
