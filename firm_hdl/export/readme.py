"""The readme of a built folder: what its files are for, and what a design around them must know."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from firm_hdl.export.backend import Converters, Output
from firm_hdl.export.facts import contract, definitions_of, lengths, port_groups, statuses
from firm_hdl.export.templates import render
from firm_hdl.export.top import DIRECTIONS

__all__ = ["README", "write"]

README = "README.md"

_MOST_FIELDS = 40
"""Fields whose ports the page lists."""


def write(converters: Converters, sections: Mapping[str, Any]) -> Output:
    """Write the readme of a type's folder.

    * `sections`: the sections of the manifest.
    """
    plan, inputs, vhdl = converters.plan, converters.inputs, sections["vhdl"]
    bench = vhdl["bench"]
    groups = list(port_groups(sections))
    fields = [ports[0] for _, ports in groups if "leaf" in ports[0]]
    listed = [port for _, ports in groups for port in ports if "leaf" not in port]
    names = [*vhdl["common_files"], *(each["file"] for each in vhdl["shared_packages"])]
    text = render(
        "readme.md",
        message=converters.message.name,
        version=inputs["generator"]["firm-hdl"],
        distro=inputs["distro"],
        wire=plan.wire,
        bus_bytes=plan.bus_bytes,
        tops=list(_tops(sections)),
        shared=[f"`{name}`" for name in dict.fromkeys(names)],
        script=bench["script"],
        bench=bench["entity"],
        has_registers="registers" in sections,
        ip=sections["ip"]["tool"] if "ip" in sections else "",
        ports=[*listed, *fields[:_MOST_FIELDS]],
        more=len(fields[_MOST_FIELDS:]),
        contract=list(contract(plan, sections["timing"]["recovery"])),
        statuses=list(statuses(plan, sections["status"])),
        lengths=list(lengths(plan)),
        types=[
            (name, [_printable(line) for line in text.strip().split("\n")])
            for name, text in definitions_of([converters.message])
        ],
    )
    return Output(files={README: text})


def _printable(line: str) -> str:
    """Return a line that anyone may have written without control characters."""
    return "".join(c if c.isprintable() else " " for c in line.expandtabs(4)).rstrip()


def _tops(sections: Mapping[str, Any]) -> Iterator[tuple[str, dict[str, str]]]:
    """Yield the outermost files of each language: what they are, and the file of each direction."""
    kinds = {
        "records": "VHDL, a record of streams",
        "record": "VHDL, a record of values",
        "flat": "VHDL, plain vectors",
    }
    entities = sections["vhdl"]["entities"]
    for kind, what in kinds.items():
        if kind in entities[DIRECTIONS[0]]:
            yield what, {way: f"vhdl/{entities[way][kind]}.vhd" for way in DIRECTIONS}
    verilog = sections["converters"]
    yield "Verilog, plain vectors", {way: verilog[way]["verilog"] for way in DIRECTIONS}
