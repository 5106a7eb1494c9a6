"""VHDL of the user's: GHDL checks it, and its netlist becomes Verilog for a simulation.

GHDL can write Verilog itself. But that of GHDL 2.0 drops the last arm of a `case`, and cuts long
constants. So the netlist is read gate by gate, as proofs of :mod:`firm_hdl.equivalence` read it.
"""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import accumulate
from pathlib import Path
from typing import Literal
from xml.etree import ElementTree

from firm_hdl.equivalence.circuit import ProofError
from firm_hdl.equivalence.dump import Module, Net, parse_dump
from firm_hdl.equivalence.vhdl_side import read_vhdl
from firm_hdl.jobs import ToolError, run_tool
from firm_hdl.jobs.programs import find_ghdl
from firm_hdl.node.hdl.netlist import verilog_of
from firm_hdl.node.hdl.ports import AcceleratorPort
from firm_hdl.node.hdl.records import NO_FILES, Generated
from firm_hdl.node.hdl.sources import Sources, listed

__all__ = ["checked_vhdl", "verilog_of_vhdl"]

_WRAPPER = "firm_hdl_check"
_TWICE = re.compile(r'(\S.*):\d+:\d+:warning: (\w+ "[^"]+") was also defined in file "([^"]+)"')
_NO_ARCHITECTURE = re.compile(r'entity "[^"]+" has no architecture')


def checked_vhdl(
    sources: Sources,
    wanted: Sequence[AcceleratorPort],
    packages: Mapping[str, str],
) -> tuple[AcceleratorPort, ...]:
    """Analyse files of VHDL-2008, and check the ports of the entity.

    * `packages`: texts of the packages with the types of records, by file name.

    Returns: those of `wanted` that the entity has.

    Raises `ProgramMissingError`. Raises `DefinitionError` if the VHDL is wrong, cannot be
    synthesized, or has no such entity or other ports.
    """
    entity = sources.hdl.entity
    files = Generated(entity=entity, packages=packages, wrapper={})
    with tempfile.TemporaryDirectory(prefix="firm_hdl-") as name:
        folder = Path(name)
        dump = _dump(sources, folder, files)
        try:
            modules = parse_dump(dump)
        except ProofError as error:
            raise sources.refused(_reason(error)) from None
        # GHDL writes the outermost entity under its own name; those with generics under others.
        top = next((m for name, m in modules.items() if name.lower() == entity.lower()), None)
        if top is None or top.own is None:
            raise sources.refused(f"GHDL's netlist has no entity '{entity}'")
        both = {net for i in top.instances if i.kind == "$inout" for net in i.outputs.values()}
        problems: dict[str, str] = {}
        # The fields of a record are ports of their own, such as twist.linear, in order.
        found: dict[str, AcceleratorPort] = {}
        undriven: dict[str, list[bool]] = {}
        for nets in (top.own.outputs, top.own.inputs):
            for path, net in nets.items():
                name = path.partition(".")[0]
                before = found[name].width if name in found else 0
                way: Literal["in", "out"] = "in" if nets is top.own.outputs else "out"
                found[name] = AcceleratorPort(name=name, direction=way, width=before + net.width)
                if way == "out" and net in both:
                    problems[name] = (
                        f"port '{name}' of '{entity}' must be an input or an output, not an inout"
                    )
                elif way == "out":
                    undriven.setdefault(name, []).extend(_undriven(top, net))
        parts = {port.name.lower(): port.parts for port in wanted}
        for name, bits in undriven.items():
            if any(bits):
                text = f"nothing drives {_named(name, bits, parts.get(name, {}))} of '{entity}'"
                problems.setdefault(name, text)
        for port in _ascending(sources, folder):
            problems.setdefault(
                port,
                f"port '{port}' of '{entity}' has an ascending range, so its bit 0 would be the "
                "highest one: write 'downto'",
            )
        ports = sources.check_ports(list(found.values()), wanted, problems)
        _check_types(sources, folder, ports)
    return ports


def _named(port: str, bits: Sequence[bool], parts: Mapping[str, int]) -> str:
    """Name the fields of an output, or its bits, that nothing drives."""
    if all(bits):
        return f"the output '{port}'"
    if sum(parts.values()) != len(bits):
        found = [str(place) for place, bit in enumerate(bits) if bit]
        return f"bit {listed(found, '')} of the output '{port}'"
    ends = accumulate(parts.values())
    fields = [
        f"{port}.{part}"
        for (part, width), end in zip(parts.items(), ends, strict=True)
        if any(bits[end - width : end])
    ]
    return listed(fields)


def _undriven(module: Module, net: Net) -> list[bool]:
    """Return whether nothing drives each bit of a net, as far as its gates only join bits."""
    driver = next((i for i in module.instances if net in i.outputs.values()), None)
    if driver is not None and driver.kind == "$const_Z":
        return [True] * net.width
    if driver is not None and driver.kind.startswith("$concat"):
        # The first input has the highest bits.
        return [
            bit
            for part in reversed(list(driver.inputs.values()))
            for bit in _undriven(module, part)
        ]
    if driver is not None and driver.kind == "$extract":
        (whole,) = driver.inputs.values()
        return _undriven(module, whole)[driver.parameters[0] :][: net.width]
    if driver is not None and driver.kind in ("$signal", "$output", "$nop"):
        return _undriven(module, next(iter(driver.inputs.values())))
    return [False] * net.width


def _ascending(sources: Sources, folder: Path) -> list[str]:
    """Return the ports of the entity that are vectors with ascending ranges.

    GHDL's netlist has no directions, but its syntax tree has, also those of subtypes.
    """
    place = sources.places_of(()).get("")
    if place is None:
        return []
    command = [find_ghdl(), "--file-to-xml", "--std=08", f"--workdir={folder}"]
    try:
        tree = run_tool(
            [*command, os.path.abspath(place.source.name)],
            folder,
            environment={"LC_ALL": "C"},
            with_errors=False,
        )
        root = ElementTree.fromstring(tree)
    except (ToolError, ElementTree.ParseError):
        # Other versions of GHDL may have no such tree.
        return []
    entity = sources.hdl.entity.lower()
    nodes = {node.get("id"): node for node in root.iter() if node.get("id")}
    found = []
    for unit in root.iter("library_unit"):
        if unit.get("identifier") != entity or unit.get("kind") != "entity_declaration":
            continue
        for port in unit.iterfind("port_chain/el"):
            kind = port.find("type")
            of = None if kind is None else nodes.get(kind.get("ref"))
            range_ = None if of is None else of.find("index_constraint_list/el/range_constraint")
            if range_ is not None and range_.get("direction") == "to":
                found.append(port.get("identifier", ""))
    return found


def verilog_of_vhdl(
    sources: Sources,
    ports: Sequence[AcceleratorPort],
    generated: Generated = NO_FILES,
) -> str:
    """Return the entity, or the wrapper around it, as a module of Verilog with two values.

    Raises `DefinitionError` if the netlist has something that cannot be translated.
    """
    entity = generated.entity or sources.hdl.entity
    with tempfile.TemporaryDirectory(prefix="firm_hdl-") as folder:
        dump = _dump(sources, Path(folder), replace(generated, entity=entity))
    try:
        circuit = read_vhdl(dump)
    except ProofError as error:
        raise sources.refused(_reason(error)) from None
    names = {port.name.lower(): port.name for port in ports}
    return verilog_of(circuit, name=entity, names=names)


def _reason(error: ProofError) -> str:
    reason = str(error).replace(", which a proof does not support", "")
    if "$const_Z" in reason:
        reason += ": an output or a signal that nothing drives, or a tri-state"
    return f"the VHDL cannot be simulated in a node: {reason}"


def _dump(sources: Sources, folder: Path, files: Generated) -> str:
    """Analyse the files, and return GHDL's netlist of an entity."""
    ghdl = find_ghdl()
    options = ["--std=08", f"--workdir={folder}"]
    for file, text in {**files.packages, **files.wrapper}.items():
        (folder / file).write_text(text, encoding="utf-8")
    paths = [*files.packages, *sources.names, *files.wrapper]
    environment = {"LC_ALL": "C"}
    try:
        said = run_tool(
            [ghdl, "-a", *options, "-Wlibrary", *paths], folder, environment=environment
        )
    except ToolError as error:
        raise sources.problems_of(str(error), "GHDL") from None
    if twice := _TWICE.search(said):
        # GHDL would take the last one.
        unit = twice[2].replace('"', "'")
        raise sources.refused_twice(unit, twice[3], twice[1])
    command = [ghdl, "--synth", *options, "-dm", "--out=dump", files.entity]
    try:
        return run_tool(command, folder, environment=environment, with_errors=False)
    except ToolError as error:
        said = str(error)
        if "cannot find entity" in said:
            names = ", ".join(map(repr, sources.files))
            raise sources.refused(f"there is no entity '{sources.hdl.entity}' in {names}") from None
        if _NO_ARCHITECTURE.search(said):
            message = f"entity '{sources.hdl.entity}' has no architecture"
            raise sources.refused(message) from None
        raise sources.problems_of(said, "GHDL") from None


def _check_types(
    sources: Sources,
    folder: Path,
    ports: Sequence[AcceleratorPort],
) -> None:
    """Check that ports have the types that a component of the node's VHDL has."""
    entity = sources.hdl.entity
    signals = [(f"s{n}", port) for n, port in enumerate(ports)]
    lines = ["library ieee;", "use ieee.std_logic_1164.all;", f"entity {_WRAPPER} is end entity;"]
    lines += [f"architecture check of {_WRAPPER} is"]
    lines += [f"  signal {name} : {port.vhdl_type};" for name, port in signals]
    lines += ["begin", f"  it : entity work.{entity} port map ("]
    first = len(lines) + 1
    lines += [f"    {port.name} => {name}," for name, port in signals]
    lines[-1] = lines[-1].rstrip(",")
    lines += ["  );", "end architecture;"]
    file = folder / f"{_WRAPPER}.vhd"
    file.write_text("\n".join(lines) + "\n", encoding="ascii")
    command = [find_ghdl(), "-a", "--std=08", f"--workdir={folder}", str(file)]
    try:
        run_tool(command, folder, environment={"LC_ALL": "C"})
    except ToolError as error:
        problems = {}
        for line in str(error).splitlines():
            place = line.removeprefix(f"{file}:").split(":")
            row = int(place[0]) - first if place[0].isdigit() and line.startswith(str(file)) else -1
            if 0 <= row < len(ports):
                port = ports[row]
                problems[port.name] = (
                    f"port '{port.name}' of '{entity}' must have the type {port.vhdl_type}"
                )
        sources.check_ports(ports, ports, problems)
        raise sources.refused(f"GHDL failed: {str(error)[:400]}") from None
