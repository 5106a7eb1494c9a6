"""Verilog and SystemVerilog of the user's: Verilator checks them.

Verilator has no list of a module's ports that all of its versions write. So a module around it has
the ports that are wanted, and Verilator says where the two differ.
"""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Literal

from firm_hdl.jobs import ToolError, run_tool
from firm_hdl.jobs.programs import find_verilator
from firm_hdl.node.hdl.ports import AcceleratorPort
from firm_hdl.node.hdl.records import Generated
from firm_hdl.node.hdl.sources import Sources

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
_PLACED = re.compile(r"%Error\S*: \S.*?:\d+:")
_OWN = re.compile(
    r"^%Warning-(?:(UNDRIVEN): (.+?):(\d+):(\d+): .* not driven: '([^']+)'(\[[\d:]+\])?"
    r"|(?:LITENDIAN|ASCRANGE): (.+?):(\d+):(\d+): )",
    re.MULTILINE,
)
_NO_MODULE = re.compile(r"(?:containing module|module reference): '([^']+)'")


def checked_verilog(
    sources: Sources,
    wanted: Sequence[AcceleratorPort],
    packages: Mapping[str, str],
) -> tuple[AcceleratorPort, ...]:
    """Check files of Verilog or SystemVerilog, and the ports of the module, as `checked_vhdl`."""
    # Verilator compares nothing else while a port is not there.
    ports = list(wanted)
    said, own, is_right = _lint(sources, ports, packages)
    errors = [line for line in said.splitlines() if "%Error" in line and _WRAPPER not in line]
    if any(_PLACED.match(line) and not _ASSIGNED.search(line) for line in errors):
        # Mistakes inside can be why ports are not there.
        raise sources.problems_of(said, "Verilator")
    while absent := {name for names in _NOT_FOUND.findall(said) for name in names if name}:
        left = [port for port in ports if port.name not in absent]
        if left == ports:
            break
        ports = left
        said, own, is_right = _lint(sources, ports, packages)
    # What Verilator has not said is as wanted.
    found = {port.name: port for port in ports}
    for name in _MISSING.findall(said):
        found[name] = AcceleratorPort(name=name, direction="in", width=1)
    for _, name, width in _WIDTH.findall(said):
        if name in found:
            found[name] = replace(found[name], width=int(width))
    for name in [*_ASSIGNED.findall(said), *_UNDRIVEN.findall(said)]:
        if name in found:
            other: Literal["in", "out"] = "out" if found[name].direction == "in" else "in"
            found[name] = replace(found[name], direction=other)
    problems = _own_problems(sources, found, own)
    sources.check_ports(list(found.values()), wanted, problems)
    if is_right:
        return tuple(ports)
    raise sources.problems_of(said, "Verilator")


def _own_problems(
    sources: Sources,
    ports: Mapping[str, AcceleratorPort],
    said: str,
) -> dict[str, str]:
    """Return what Verilator warns of at the ports of the module, by their names."""
    entity = sources.hdl.entity
    places = sources.places_of(ports)
    problems: dict[str, str] = {}
    for match in _OWN.finditer(said):
        path, row, column = match.group(*((2, 3, 4) if match[1] else (7, 8, 9)))
        if (file := sources.name_of(path)) is None:
            continue
        at = sources.span_of(file, int(row), int(column))
        if match[1]:
            name, bits = match[5], match[6]
            is_here = name in ports and places.get(name) == at and ports[name].direction == "out"
            some = f"bits {bits.strip('[]')} of " if bits else ""
            text = f"nothing drives {some}the output '{name}' of '{entity}'"
        else:
            # The range comes before the names that have it.
            names = re.match(r"\[[^\]]*\]\s*(\w+)", at.source.text[at.start :])
            name = names[1] if names else ""
            is_here = name in places and places[name].source == at.source
            text = (
                f"port '{name}' of '{entity}' has an ascending range, so its bit 0 would be the "
                f"highest one: write '[{ports[name].width - 1}:0]'"
                if is_here
                else ""
            )
        if is_here:
            problems.setdefault(name, text)
    return problems


def preprocessed(sources: Sources, generated: Generated) -> tuple[str, dict[str, bytes]]:
    """Return all files as one text, and the files that they include, by absolute path.

    Raises `DefinitionError`.
    """
    with tempfile.TemporaryDirectory(prefix="firm_hdl-") as name:
        folder = Path(name)
        before, after = _written(generated.packages, folder), _written(generated.wrapper, folder)
        try:
            command = [*_command(sources), "-E", *before, *sources.names, *after]
            text = run_tool(command, folder, with_errors=False)
        except ToolError as error:
            raise sources.problems_of(str(error), "Verilator") from None
    places = re.findall(r'^`line \d+ "([^"<]+)"', text, re.MULTILINE)
    more = {os.path.normpath(path): path for path in places if os.path.isfile(path)}
    known = {*sources.names, *before, *after}
    return text, {name: Path(path).read_bytes() for name, path in more.items() if name not in known}


def _written(files: Mapping[str, str], folder: Path) -> list[str]:
    for file, text in files.items():
        (folder / file).write_text(text, encoding="utf-8")
    return [str(folder / file) for file in files]


def _command(sources: Sources) -> list[str]:
    folders = dict.fromkeys(os.path.dirname(path) for path in sources.names)
    language = "1364-2005" if sources.hdl.language == "verilog" else "1800-2017"
    command = [*find_verilator("An accelerator in Verilog"), "--default-language", language]
    return [*command, *(f"-I{folder}" for folder in folders)]


def _lint(
    sources: Sources,
    ports: Sequence[AcceleratorPort],
    packages: Mapping[str, str],
) -> tuple[str, str, bool]:
    """Let Verilator check the files with a module around them.

    Returns: what Verilator says on errors, and on the module around them; all that it says; and
    whether there is no error.
    """
    entity = sources.hdl.entity
    heads = [f"  {p.direction}put wire [{p.width - 1}:0] {p.name}" for p in ports]
    pins = [f"    .{port.name}({port.name})" for port in ports]
    text = [f"module {_WRAPPER} (", ",\n".join(heads), ");", f"  {entity} it ("]
    text += [",\n".join(pins), "  );", "endmodule", ""]
    with tempfile.TemporaryDirectory(prefix="firm_hdl-") as name:
        folder = Path(name)
        file = folder / f"{_WRAPPER}.v"
        file.write_text("\n".join(text), encoding="ascii")
        command = [*_command(sources), "--lint-only", "-Wall", "-Wno-fatal", "--no-timing"]
        command += ["-Wno-DECLFILENAME", "--top-module", _WRAPPER]
        command += [*_written(packages, folder), *sources.names, str(file)]
        try:
            said, is_right = run_tool(command, folder), True
        except ToolError as error:
            said, is_right = str(error), False
        for twice in _TWICE.finditer(said):
            # A search for a module that is missing reads a file again.
            if twice[1] == twice[3]:
                continue
            # Verilator would take the first one; other tools refuse both.
            raise sources.refused_twice(f"'{twice[2]}'", twice[3], twice[1])
        # Most warnings of the user's own files are not ours; errors are.
        lines = [
            line
            for line in said.splitlines()
            if line.startswith("%") and ("%Error" in line or str(file) in line)
        ]
    if not is_right and entity in _NO_MODULE.findall("\n".join(lines)):
        names = ", ".join(map(repr, sources.files))
        raise sources.refused(f"there is no module '{entity}' in {names}")
    return "\n".join(lines), said, is_right
