"""The folder of a bitstream: the top level, what the tools made of it, and their report."""

from __future__ import annotations

import json
import os
import re
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from firm_hdl import rtlil
from firm_hdl.errors import UserError
from firm_hdl.export.design import BuiltDesign
from firm_hdl.export.folder import build_folder, read_manifest
from firm_hdl.export.manifest import digest, inputs_of, manifest_of
from firm_hdl.garbage import search_put_off
from firm_hdl.jobs import ProgramMissingError, ToolError, made_by, run_tool
from firm_hdl.jobs.processes import unwound_when_terminated
from firm_hdl.jobs.programs import (
    Program,
    errors_in,
    find_nextpnr,
    find_yosys,
    which,
    yowasp_command,
)
from firm_hdl.node.accelerator import load_accelerator
from firm_hdl.node.bitstream.board import Board
from firm_hdl.node.bitstream.families import Family
from firm_hdl.node.bitstream.top import BoardTop, board_top
from firm_hdl.node.description import Description
from firm_hdl.node.node import Node
from firm_hdl.node.top import NodeTop

__all__ = ["Bitstream", "build_bitstream", "find_tools"]

PIP = "pip install 'firm-hdl[boards]'"

SEEDS = (1, 2, 3)
"""Seeds of nextpnr, one after the other until the clock is reached."""

HOPELESS = 0.85
"""What part of the clock has to be reached for another seed to be tried."""

TIMEOUT = 4 * 3600.0
"""Seconds after which a tool is stopped."""

REPORT = "report.txt"

# Yosys 0.70 aborts on some circuits after ABC, but not if they are flattened before.
_PREPARATION = "hierarchy -top top; proc; flatten; opt_clean"


@dataclass(frozen=True, slots=True, kw_only=True)
class Bitstream:
    """A bitstream."""

    file: Path
    report: Path
    was_current: bool  # Both were there, and nothing was done.
    facts: Mapping[str, Any]  # `clocks`, `cells`, `seed` and `tools`, as in the manifest.


@dataclass(frozen=True, slots=True, kw_only=True)
class Tools:
    """The programs that make a bitstream."""

    yosys: Program
    placer: Program
    packer: Program


def find_tools(family: Family, *, is_run: bool = True) -> Tools:
    """Find the programs for a family of FPGAs: the packages of YoWASP, or those on the PATH.

    * `is_run`: as for :func:`firm_hdl.jobs.programs.find_packaged`.

    Raises `ProgramMissingError`. Raises `ToolError` if a package is installed and does not run.
    """
    install = f": {PIP}"
    # icepack does not tell its version.
    path = which(family.packer)
    command = yowasp_command(family.package, family.packer) or ((path,) if path else None)
    if not command:
        raise ProgramMissingError(f"{family.packer} is not installed{install}")
    return Tools(
        yosys=find_yosys(install, is_run=is_run),
        placer=find_nextpnr(family.package, family.placer, install, is_run=is_run),
        packer=Program(title=family.packer, command=command, version=""),
    )


def build_bitstream(
    description: Description,
    built: BuiltDesign,
    board: Board,
    *,
    force: bool = False,
    report: Callable[[str], None] = lambda text: None,
) -> Bitstream:
    """Make the bitstream of a node, in the folder ``boards/BOARD`` of the node.

    The folder has a bitstream only if the clock is reached. Whatever goes wrong later than the top
    level, the folder has that, the constraints, and the report, if there is one.

    * `built`: the folder of the node, as :func:`firm_hdl.node.build.build_node` made it.
    * `force`: make a bitstream that is current, too.
    * `report`: called with what is done next.

    Raises `DefinitionError` if node and board do not fit together. Raises `ProgramMissingError` if
    a tool is not installed. Raises `UserError` if a tool fails, the node is too large, or its clock
    is not reached.
    """
    node = read_manifest(built.folder)
    assert node is not None, "it was just built"
    module = node["verilog"]["module"]
    top = board_top(description, node["ports"], module, board)
    family = board.family
    files = {"top.v": top.verilog, family.constraints[1]: top.constraints}
    options = [family.devices[board.device], "--package", board.package]
    options += ["--speed", board.speed] if board.speed else []
    options += ["--freq", f"{top.clock_hz / 1e6:.6f}"]
    facts = {
        "board": board.name,
        "options": options,
        "files": {name: digest(text) for name, text in files.items()},
        **{key: node["inputs"][key] for key in ("design_sha256", "accelerator_files")},
    }
    inputs = inputs_of(facts)
    folder = built.folder / "boards" / board.name
    out = built.folder.parent

    def write(more: Mapping[str, str], found: Mapping[str, Any] | None, *, force: bool) -> bool:
        """Write the folder, and delete what is outdated; return whether it was current."""
        every = {**files, **more}
        made = every, manifest_of(inputs, every, {"bitstream": found})
        return build_folder(out, folder, inputs, lambda: made, force=force) is None

    known: Any = (read_manifest(folder) or {}).get("bitstream")
    if write({}, None, force=force or not known):
        return Bitstream(
            file=folder / family.bitstream, report=folder / REPORT, was_current=True, facts=known
        )
    try:
        tools = find_tools(family)
        # Tools run for minutes, and end with this process.
        with (
            unwound_when_terminated(),
            tempfile.TemporaryDirectory(prefix="firm-hdl-board-") as name,
        ):
            place = Path(name)
            for file, text in files.items():
                (place / file).write_text(text, encoding="utf-8")
            reads = ["read_verilog top.v", *_sources(description, module, place)]
            found = _placed(tools, place, family, reads, options, top, report)
            text = _report_text(description, board, top, found)
            worst = found["clocks"][found["tightest"]]
            if not worst["is_met"]:
                write({REPORT: text}, None, force=True)
                hint = "A lower 'clock_mhz' helps, or a smaller 'bus_bytes'"
                if worst["needed_mhz"] > 1.01e-6 * top.clock_hz:
                    hint = "This is the clock of the PHY, for which the FPGA is too slow"
                raise UserError(
                    f"'{description.node}' on {board.name} reaches {worst['reached_mhz']:g} MHz, "
                    f"and its clock has {worst['needed_mhz']:g} MHz: no bitstream was made. "
                    f"{hint}; {folder / REPORT} has its longest path"
                )
            report(f"packs {family.bitstream}")
            command = [*tools.packer.command, *family.pack, family.netlist[1], family.bitstream]
            _run(tools.packer, command, place)
            data = made_by(family.packer, place / family.bitstream).read_bytes()
    except ToolError as error:
        raise UserError(f"no bitstream was made: {error}") from None
    bitstream = data.decode("utf-8", "surrogateescape")
    write({REPORT: text, family.bitstream: bitstream}, found, force=True)
    return Bitstream(
        file=folder / family.bitstream, report=folder / REPORT, was_current=False, facts=found
    )


def _sources(description: Description, module: str, folder: Path) -> list[str]:
    """Write the node for Yosys; return the commands that read it.

    The node is in RTLIL: Yosys reads a large memory in Verilog, word by word, for many minutes.
    """
    accelerator = load_accelerator(description)
    with search_put_off():
        circuit = rtlil.rtlil_of(NodeTop(Node(description, accelerator)), name=module)
    (folder / "node.il").write_text(rtlil.without_indices(circuit), encoding="utf-8")
    reads = ["read_rtlil node.il"]
    if description.hdl is not None:
        # VHDL is there as for a simulation: gate by gate. Yosys itself reads less of SystemVerilog.
        is_slang = description.hdl.language == "systemverilog"
        read = f"read_slang --top {accelerator.entity}" if is_slang else "read_verilog -sv"
        for file, text in accelerator.modules.items():
            (folder / file).write_bytes(text.encode("utf-8", "surrogateescape"))
            reads.append(f"{read} {file}")
    return reads


def _placed(
    tools: Tools,
    folder: Path,
    family: Family,
    reads: list[str],
    options: list[str],
    top: BoardTop,
    report: Callable[[str], None],
) -> dict[str, Any]:
    """Synthesize, place and route; return the figures of the first seed that reaches the clock.

    Raises `ToolError` or `UserError`.
    """
    report("synthesis")
    script = "; ".join([*reads, _PREPARATION, f"{family.synthesis} -json top.json"])
    _run(tools.yosys, [*tools.yosys.command, "-q", "-l", "yosys.log", "-p", script], folder)
    made_by("Yosys", folder / "top.json", may_be_empty=False)
    best: dict[str, Any] = {}
    for seed in SEEDS:
        report(f"place and route, seed {seed} (some minutes)")
        netlist, log = f"{seed}-{family.netlist[1]}", folder / "nextpnr.log"
        command = [*options, "--json", "top.json", *family.constraints, family.netlist[0], netlist]
        command += ["--report", "report.json", "--seed", str(seed)]
        (folder / "report.json").unlink(missing_ok=True)
        _run(
            tools.placer,
            [*tools.placer.command, *command, "--timing-allow-fail", "-q", "-l", log.name],
            folder,
        )
        made_by(family.placer, folder / netlist)
        said = made_by(family.placer, folder / "report.json", may_be_empty=False)
        found = _figures(json.loads(said.read_text(encoding="utf-8")), top)
        reached = _part(found["clocks"][found["tightest"]])
        report(f"seed {seed} reaches {100 * reached:.0f} % of the clock")
        if reached > best.get("reached", 0.0):
            best = {
                "reached": reached,
                **found,
                "seed": seed,
                "tools": {each.title: each.version for each in (tools.yosys, tools.placer)},
                "commands": [f"yosys -p '{script}'", " ".join([family.placer, *command])],
            }
            os.replace(folder / netlist, folder / family.netlist[1])
        if reached >= 1 or reached < HOPELESS:
            break
    del best["reached"]
    return best


def _run(program: Program, command: list[str], folder: Path) -> None:
    """Run a tool in a folder; its log is in ``NAME.log``, if it writes one.

    File names are relative, because programs of YoWASP have a ``/tmp`` of their own.

    Raises `ToolError` if the program fails. Raises `UserError` if the design does not fit.
    """
    try:
        run_tool(command, folder, timeout=TIMEOUT)
    except ToolError as error:
        log = folder / f"{program.title.partition('-')[0].lower()}.log"
        said = log.read_text(encoding="utf-8", errors="replace") if log.is_file() else ""
        cells = re.findall(r"(\w+): *(\d+)/ *(\d+) ", said)
        too_many = {name: (int(n), int(m)) for name, n, m in cells if int(n) > int(m)}
        if too_many:
            listed = ", ".join(f"{name} {n:,} of {m:,}" for name, (n, m) in too_many.items())
            raise UserError(f"the node is too large for the FPGA: {listed}") from None
        raise ToolError(f"{program.title} failed: {errors_in(said, str(error))}") from None


def _figures(said: Mapping[str, Any], top: BoardTop) -> dict[str, Any]:
    """Read clocks and cells in a report of nextpnr, and the longest path of the tightest clock.

    The tightest clock is the one that is missed most, or has the least room.

    Raises `ToolError` if the clock of the node is not among those that nextpnr looked at.
    """
    clocks = {
        name: {
            "needed_mhz": round(each["constraint"], 3),
            "reached_mhz": round(each["achieved"], 3),
            "is_met": each["achieved"] >= each["constraint"],
        }
        for name, each in said.get("fmax", {}).items()
    }
    if not any(each["needed_mhz"] >= 0.999e-6 * top.clock_hz for each in clocks.values()):
        raise ToolError(f"nextpnr did not look at the clock of {top.clock_hz / 1e6:g} MHz")
    cells = {
        name: [each["used"], each["available"]]
        for name, each in said["utilization"].items()
        if each["used"]
    }
    tightest = min(clocks, key=lambda name: _part(clocks[name]))
    # Ends of a path are as `posedge CLOCK`, or `<async>` at a pin.
    paths = [
        [[round(step["delay"], 3), step["type"], step["to"]["cell"]] for step in each["path"]]
        for each in said.get("critical_paths", ())
        if {each[end].rpartition(" ")[2] for end in ("from", "to")} == {tightest}
    ]
    path = max(paths, key=lambda steps: sum(step[0] for step in steps), default=[])
    return {"clocks": clocks, "cells": cells, "tightest": tightest, "path": path}


def _part(clock: Mapping[str, Any]) -> float:
    """Return what part of its frequency a clock reaches."""
    return float(clock["reached_mhz"] / clock["needed_mhz"])


def _report_text(
    description: Description, board: Board, top: BoardTop, found: Mapping[str, Any]
) -> str:
    """Write the report for people."""
    lines = [f"{description.node} on {board.title} ({board.name})", ""]
    for name, clock in found["clocks"].items():
        met = "met" if clock["is_met"] else "MISSED"
        lines.append(
            f"clock {name}: {clock['needed_mhz']:g} MHz needed, {clock['reached_mhz']:g} MHz "
            f"reached: {met}"
        )
    source = board.clock_hz / 1e6
    lines.append(f"clock of the node {top.clock_hz / 1e6:.9g} MHz, of the board {source:g} MHz")
    lines += ["no board was at hand: the bitstream was never tried on one", ""]
    lines += [f"{name:16} {used:7} of {of}" for name, (used, of) in found["cells"].items()]
    lines += ["", *(f"{name} {version}" for name, version in found["tools"].items())]
    lines += [
        "",
        *found["commands"],
        "# node.il is the node in RTLIL; NAME_verilog.v means the same",
    ]
    lines += ["", f"the longest path of {found['tightest']}, in ns:"]
    lines += [f"{delay:8.3f}  {kind:10} {cell}" for delay, kind, cell in found["path"]]
    return "\n".join(lines) + "\n"
