"""Verilog and SystemVerilog of the user's: Verilator checks them.

Verilator has no list of a module's ports that all of its versions write. So a module around it has
the ports that are wanted, and Verilator says where the two differ.
"""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from firm_hdl.jobs import ToolError, run_tool
from firm_hdl.jobs.programs import find_verilator
from firm_hdl.node.description import Description
from firm_hdl.node.hdl.ports import AcceleratorPort
from firm_hdl.node.hdl.sources import check_ports, path_of, problems_of, refused, refused_twice

__all__ = ["checked_verilog", "preprocessed"]

_WRAPPER = "firm_hdl_check"
_NOT_FOUND = re.compile(
    r"(?:Pin not found|Pin is not an in/out\S*): '([^']+)'|attempts to connect to '([^']+)', but"
)
_TWICE = re.compile(
    r"MODDUP: (.+?):\d+:\d+: Duplicate[^']*'([^']+)'"
    r"(?:.*\n)*?\s+(\S.*?):\d+:\d+: \.\.\. Location"
)
_MISSING = re.compile(r"PINMISSING:.*(?:missing pin|unconnected pin|Missing pin).*?'([^']+)'")
_WIDTH = re.compile(r"(Input|Output) port connection '([^']+)' expects (\d+) bits")
_ASSIGNED = re.compile(r"Assign.*to input.*'([^']+)'")
_UNDRIVEN = re.compile(r"UNDRIVEN:.*Signal is not driven: '([^']+)'")
_NO_MODULE = re.compile(r"(?:containing module|module reference): '([^']+)'")


def checked_verilog(
    description: Description,
    sources: Mapping[str, bytes],
    wanted: Sequence[AcceleratorPort],
) -> tuple[AcceleratorPort, ...]:
    """Check files of Verilog or SystemVerilog, and the ports of the module, as `checked_vhdl`."""
    said, is_right = _lint(description, sources, wanted)
    if is_right and not (_MISSING.search(said) or _WIDTH.search(said) or _UNDRIVEN.search(said)):
        return tuple(wanted)
    absent = {name for names in _NOT_FOUND.findall(said) for name in names if name}
    optional = {port.name for port in wanted if port.is_optional}
    if absent & optional:
        return checked_verilog(
            description, sources, [port for port in wanted if port.name not in absent & optional]
        )
    # What Verilator has not said is as wanted.
    found = {port.name: port for port in wanted if port.name not in absent}
    for name in _MISSING.findall(said):
        found[name] = AcceleratorPort(name=name, direction="in", width=1)
    for _, name, width in _WIDTH.findall(said):
        if name in found:
            found[name] = _with(found[name], width=int(width))
    for name in [*_ASSIGNED.findall(said), *_UNDRIVEN.findall(said)]:
        if name in found:
            other = "out" if found[name].direction == "in" else "in"
            found[name] = _with(found[name], direction=other)
    check_ports(description, list(found.values()), wanted, ignores_case=False)
    if is_right:
        return tuple(wanted)
    raise problems_of(description, said, sources, "Verilator")


def _with(
    port: AcceleratorPort, *, width: int | None = None, direction: str = ""
) -> AcceleratorPort:
    return AcceleratorPort(
        name=port.name,
        direction=direction or port.direction,  # type: ignore[arg-type]
        width=port.width if width is None else width,
    )


def preprocessed(description: Description) -> tuple[str, dict[str, bytes]]:
    """Return all files as one text, and the files that they include, by absolute path.

    Raises
    ------
    DefinitionError
    """
    paths = _paths(description)
    with tempfile.TemporaryDirectory(prefix="firm_hdl-") as folder:
        try:
            command = [*_command(description), "-E", *paths]
            text = run_tool(command, Path(folder), with_errors=False)
        except ToolError as error:
            raise problems_of(description, str(error), {}, "Verilator") from None
    places = re.findall(r'^`line \d+ "([^"<]+)"', text, re.MULTILINE)
    more = {os.path.normpath(path): path for path in places if os.path.isfile(path)}
    return text, {name: Path(path).read_bytes() for name, path in more.items() if name not in paths}


def _paths(description: Description) -> list[str]:
    assert description.hdl is not None
    return [os.path.abspath(path_of(description, file)) for file in description.hdl.files]


def _command(description: Description) -> list[str]:
    assert description.hdl is not None
    folders = dict.fromkeys(os.path.dirname(path) for path in _paths(description))
    language = "1364-2005" if description.hdl.language == "verilog" else "1800-2017"
    command = [*find_verilator("An accelerator in Verilog"), "--default-language", language]
    return [*command, *(f"-I{folder}" for folder in folders)]


def _lint(
    description: Description, sources: Mapping[str, bytes], ports: Sequence[AcceleratorPort]
) -> tuple[str, bool]:
    """Let Verilator check the files with a module around them; return what it says."""
    assert description.hdl is not None
    entity = description.hdl.entity
    heads = [f"  {p.direction}put wire [{p.width - 1}:0] {p.name}" for p in ports]
    pins = [f"    .{port.name}({port.name})" for port in ports]
    text = [f"module {_WRAPPER} (", ",\n".join(heads), ");", f"  {entity} it ("]
    text += [",\n".join(pins), "  );", "endmodule", ""]
    with tempfile.TemporaryDirectory(prefix="firm_hdl-") as folder:
        file = Path(folder, f"{_WRAPPER}.v")
        file.write_text("\n".join(text), encoding="ascii")
        command = [*_command(description), "--lint-only", "-Wall", "-Wno-fatal", "--no-timing"]
        command += ["-Wno-DECLFILENAME", "--top-module", _WRAPPER, *_paths(description), str(file)]
        try:
            said, is_right = run_tool(command, Path(folder)), True
        except ToolError as error:
            said, is_right = str(error), False
        for twice in _TWICE.finditer(said):
            # A search for a module that is missing reads a file again.
            if twice[1] == twice[3]:
                continue
            # Verilator would take the first one; other tools refuse both.
            raise refused_twice(description, f"'{twice[2]}'", twice[3], twice[1])
        # Warnings of the user's own files are not ours; errors are.
        lines = [
            line
            for line in said.splitlines()
            if "%Error" in line or str(file) in line or not line.startswith("%")
        ]
    if not is_right and entity in _NO_MODULE.findall(said):
        names = ", ".join(map(repr, sources))
        raise refused(description, f"there is no module '{entity}' in {names}")
    return "\n".join(line for line in lines if line.startswith("%")), is_right
