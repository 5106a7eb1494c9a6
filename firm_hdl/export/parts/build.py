# amaranth: UnusedElaboratable=no
"""The files of a packet part: the design in each language, and the manifest."""

from __future__ import annotations

import os
from typing import Any

import firm_hdl
from firm_hdl import rtlil
from firm_hdl.export.design import (
    BuiltDesign,
    core_file,
    design_folder,
    inputs_of_design,
    verilog_file,
    vhdl_folder,
    write_design,
)
from firm_hdl.export.parts.catalog import Part
from firm_hdl.export.parts.top import PartTop, clocks_of, part_ports
from firm_hdl.garbage import search_put_off
from firm_hdl.gateware.packets import GateStatus, Outcome
from firm_hdl.vhdl.convert import convert

__all__ = ["build_part"]


def build_part(
    part: Part, out: str | os.PathLike[str] = "parts_out", *, force: bool = False
) -> BuiltDesign:
    """Write the design of a packet part into a folder of its own, ``out/NAME``.

    Parameters
    ----------
    out : path
        Created if it does not exist.
    force : bool
        Write the folder even if it is current.

    Raises
    ------
    UserError
        If the part is too large, or the folder cannot be written.
    """
    name = part.name
    folder = design_folder(out, name)
    ports = part_ports(part)
    with search_put_off():
        design = rtlil.rtlil_of(PartTop(part), name=name)
    settings = ", ".join(f"{key} {value}" for key, value in part.parameters.items())
    what = f"packet {part.kind}: {settings}"

    def make_files() -> dict[str, str]:
        header = f"{name}: {what}\nMade by firm-hdl {firm_hdl.__version__}\n"
        vhdl = convert(design, name=name, header=header).files
        return {
            **verilog_file(design, name=name, header=header),
            **vhdl_folder(vhdl),
            **core_file(name, vhdl, kind="part", description=what),
        }

    facts = _facts(part)
    return write_design(
        folder,
        inputs=inputs_of_design(facts, design),
        facts=facts,
        ports=[
            {
                "name": port.name,
                "direction": port.direction,
                "width": port.width,
                "meaning": port.meaning,
            }
            for port in ports
        ],
        make_files=make_files,
        force=force,
    )


def _facts(part: Part) -> dict[str, Any]:
    facts: dict[str, Any] = {
        "part": part.kind,
        "parameters": part.parameters,
        "clocks": [{"clock": clock, "reset": reset} for clock, reset in clocks_of(part).values()],
    }
    codes: Any = {"gate": GateStatus, "fifo": Outcome}.get(part.kind)
    if codes is not None:
        facts["codes"] = {code.name: code.value for code in codes}
    return facts
