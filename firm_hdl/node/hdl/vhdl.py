"""VHDL of the user's: GHDL checks it, and its netlist becomes Verilog for a simulation.

GHDL can write Verilog itself. But that of GHDL 2.0 drops the last arm of a `case`, and cuts long
constants. So the netlist is read gate by gate, as proofs of :mod:`firm_hdl.equivalence` read it.
"""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from firm_hdl.equivalence.circuit import ProofError
from firm_hdl.equivalence.dump import parse_dump
from firm_hdl.equivalence.vhdl_side import read_vhdl
from firm_hdl.jobs import ToolError, run_tool
from firm_hdl.jobs.programs import find_ghdl
from firm_hdl.node.description import Description
from firm_hdl.node.hdl.netlist import verilog_of
from firm_hdl.node.hdl.ports import AcceleratorPort
from firm_hdl.node.hdl.sources import (
    check_ports,
    path_of,
    problems_of,
    refused,
    refused_twice,
)

__all__ = ["checked_vhdl", "verilog_of_vhdl"]

_WRAPPER = "firm_hdl_check"
_TWICE = re.compile(r'(\S.*):\d+:\d+:warning: (\w+ "[^"]+") was also defined in file "([^"]+)"')
_NO_ARCHITECTURE = re.compile(r'entity "[^"]+" has no architecture')


def checked_vhdl(
    description: Description,
    sources: Mapping[str, bytes],
    wanted: Sequence[AcceleratorPort],
) -> tuple[AcceleratorPort, ...]:
    """Analyse files of VHDL-2008, and check the ports of the entity.

    Returns
    -------
    tuple of AcceleratorPort
        Those of `wanted` that the entity has.

    Raises
    ------
    DefinitionError
        If the VHDL is wrong, cannot be synthesized, or has no such entity or other ports.
    ProgramMissingError
    """
    entity = _entity(description)
    with tempfile.TemporaryDirectory(prefix="firm_hdl-") as folder:
        dump = _dump(description, sources, Path(folder))
        try:
            modules = parse_dump(dump)
        except ProofError as error:
            raise refused(description, _reason(error)) from None
        # GHDL writes the outermost entity under its own name; those with generics under others.
        own = next((m.own for name, m in modules.items() if name.lower() == entity.lower()), None)
        if own is None:
            raise refused(description, f"GHDL's netlist has no entity '{entity}'")
        top = next(module for module in modules.values() if module.own is own)
        both = {net for i in top.instances if i.kind == "$inout" for net in i.outputs.values()}
        for name, net in own.inputs.items():
            if net in both:
                raise refused(
                    description,
                    f"port '{name}' of '{entity}' must be an input or an output, not an inout",
                )
        found = [
            AcceleratorPort(name=name, direction="in", width=net.width)
            for name, net in own.outputs.items()
        ]
        found += [
            AcceleratorPort(name=name, direction="out", width=net.width)
            for name, net in own.inputs.items()
        ]
        ports = check_ports(description, found, wanted, ignores_case=True)
        _check_types(description, Path(folder), ports)
    return ports


def verilog_of_vhdl(
    description: Description, sources: Mapping[str, bytes], ports: Sequence[AcceleratorPort]
) -> str:
    """Return the entity as a module of Verilog, for a simulator with two values.

    Raises
    ------
    DefinitionError
        If the netlist has something that cannot be translated.
    """
    with tempfile.TemporaryDirectory(prefix="firm_hdl-") as folder:
        dump = _dump(description, sources, Path(folder))
    try:
        circuit = read_vhdl(dump)
    except ProofError as error:
        raise refused(description, _reason(error)) from None
    names = {port.name.lower(): port.name for port in ports}
    return verilog_of(circuit, name=_entity(description), names=names)


def _reason(error: ProofError) -> str:
    reason = str(error).replace(", which a proof does not support", "")
    if "$const_Z" in reason:
        reason += ": an output or a signal that nothing drives, or a tri-state"
    return f"the VHDL cannot be simulated in a node: {reason}"


def _entity(description: Description) -> str:
    assert description.hdl is not None
    return description.hdl.entity


def _dump(description: Description, sources: Mapping[str, bytes], folder: Path) -> str:
    """Analyse the files, and return GHDL's netlist of the entity."""
    ghdl = find_ghdl()
    options = ["--std=08", f"--workdir={folder}"]
    paths = [os.path.abspath(path_of(description, file)) for file in sources]
    environment = {"LC_ALL": "C"}
    try:
        said = run_tool(
            [ghdl, "-a", *options, "-Wlibrary", *paths], folder, environment=environment
        )
    except ToolError as error:
        raise problems_of(description, str(error), sources, "GHDL") from None
    if twice := _TWICE.search(said):
        # GHDL would take the last one.
        unit = twice[2].replace('"', "'")
        raise refused_twice(description, unit, twice[3], twice[1])
    command = [ghdl, "--synth", *options, "-dm", "--out=dump", _entity(description)]
    try:
        return run_tool(command, folder, environment=environment, with_errors=False)
    except ToolError as error:
        said = str(error)
        if "cannot find entity" in said:
            names = ", ".join(map(repr, sources))
            raise refused(
                description, f"there is no entity '{_entity(description)}' in {names}"
            ) from None
        if _NO_ARCHITECTURE.search(said):
            message = f"entity '{_entity(description)}' has no architecture"
            raise refused(description, message) from None
        raise problems_of(description, said, sources, "GHDL") from None


def _check_types(description: Description, folder: Path, ports: Sequence[AcceleratorPort]) -> None:
    """Check that ports have the types that a component of the node's VHDL has."""
    entity = _entity(description)
    signals = [(f"s{n}", port) for n, port in enumerate(ports)]
    lines = ["library ieee;", "use ieee.std_logic_1164.all;", f"entity {_WRAPPER} is end entity;"]
    lines += [f"architecture check of {_WRAPPER} is"]
    lines += [f"  signal {name} : {_type(port)};" for name, port in signals]
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
        for line in str(error).splitlines():
            place = line.removeprefix(f"{file}:").split(":")
            row = int(place[0]) - first if place[0].isdigit() and line.startswith(str(file)) else -1
            if 0 <= row < len(ports):
                port = ports[row]
                message = f"port '{port.name}' of '{entity}' must have the type {_type(port)}"
                raise refused(description, message) from None
        raise refused(description, f"GHDL failed: {str(error)[:400]}") from None


def _type(port: AcceleratorPort) -> str:
    return "std_logic" if port.width == 1 else f"std_logic_vector({port.width - 1} downto 0)"
