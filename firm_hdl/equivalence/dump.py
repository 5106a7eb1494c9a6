"""Read the output of ``ghdl --synth --out=dump``: GHDL's own netlist, gate by gate.

GHDL can also print a netlist as Verilog and as VHDL. But another tool would have to interpret these
texts, and GHDL 2.0 drops the last arm of a `case` in Verilog. The dump has one statement for each
gate. Any unknown statement is an error.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from firm_hdl.equivalence.circuit import ProofError

__all__ = ["Instance", "Module", "Net", "parse_dump"]

_MODULE = re.compile(r"module \{m\d+\} ([\\$]\S+)$")
_PORT = re.compile(r"(input|output|inout) ([\\$]\S+?)(?:\[(\d+):0\]|\[\?\])?;$")
_INSTANCE = re.compile(r"instance (\S+?) ?\{i(\d+)\}: (\S+)$")
_INPUT = re.compile(r"input (\S+)\{p\d+\} <- (\S+)$")
_NET = re.compile(r"(\S+)\{n(\d+)(?:w(\d+)\}|\}:(\d+))$")


@dataclass(frozen=True, slots=True)
class Net:
    """An output of an instance."""

    number: int
    width: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Instance:
    """A gate (`kind` starts with ``$``) or an instance of a module."""

    name: str
    kind: str
    parameters: tuple[int, ...]  # Parameters in order.
    # Inputs in order, by name; by position if the gate has a variable number of inputs.
    inputs: Mapping[str, Net]
    outputs: Mapping[str, Net]


@dataclass(frozen=True, slots=True, kw_only=True)
class Module:
    """A module."""

    name: str
    ports: Mapping[str, int | None]  # Widths of all ports; `None` is any width.
    # The module's ports as an instance inside the module. The inputs of the instance drive the
    # module's output ports, and the module's input ports drive the outputs of the instance.
    own: Instance | None
    instances: tuple[Instance, ...]


def parse_dump(text: str) -> dict[str, Module]:
    """Parse a dump.

    Returns the user's modules by name, without the backslash, the outermost one first.

    Raises `ProofError` if the text has an unknown statement.
    """
    lines = [line.strip() for line in text.splitlines()]
    lines = [line for line in lines if line and not line.startswith("#")]
    modules = {}
    for block in _blocks(lines, "module "):
        module = _module(block)
        if not module.name.startswith("$"):
            modules[module.name] = module
    if not modules:
        raise ProofError("GHDL's netlist is empty")
    return modules


def _blocks(lines: list[str], start: str) -> Iterator[list[str]]:
    """Split lines into blocks, each of which begins with a line that starts with `start`."""
    block: list[str] = []
    for line in lines:
        if line.startswith(start) and block:
            yield block
            block = []
        block.append(line)
    if block:
        yield block


def _module(block: list[str]) -> Module:
    match = _MODULE.match(block[0]) or _unknown(block[0])
    name = match[1].removeprefix("\\")
    ports: dict[str, int | None] = {}
    place = 1
    while place < len(block) and not block[place].startswith("instance "):
        line = block[place]
        place += 1
        # Declarations of gates are not needed. The last lines only repeat connections.
        if name.startswith("$") or line.startswith("connect "):
            continue
        port = _PORT.match(line) or _unknown(line)
        if port[1] == "inout":
            raise ProofError(f"{name} has a port of mode inout, which a proof does not support")
        ports[_plain(port[2])] = int(port[3] or 0) + 1
    instances = [_instance(lines) for lines in _blocks(block[place:], "instance ")]
    # The instance that encloses all modules is printed after the last module.
    instances = [i for i in instances if i.kind != "$top"]
    own = [i for i in instances if i.kind == name and i.name == name]
    others = tuple(i for i in instances if i is not own[0]) if own else tuple(instances)
    return Module(name=name, ports=ports, own=own[0] if own else None, instances=others)


def _instance(block: list[str]) -> Instance:
    match = _INSTANCE.match(block[0]) or _unknown(block[0])
    name, kind = match[1], match[3]
    parameters: tuple[int, ...] = ()
    inputs: dict[str, Net] = {}
    outputs: dict[str, Net] = {}
    for line in block[1:]:
        if line.startswith("parameters"):
            parameters = tuple(int(word.rpartition("=")[2]) for word in line.split()[1:])
        elif line.startswith("outputs "):
            for word in line.split()[1:]:
                port, net = _net(word, name)
                _add(outputs, port, net, line)
        elif line.startswith("input "):
            found = _INPUT.match(line) or _unknown(line)
            _add(inputs, _port_of(found[1], name), _net(found[2], None)[1], line)
        elif not line.startswith("connect "):
            _unknown(line)
    return Instance(
        name=_plain(name),
        kind=kind.removeprefix("\\"),
        parameters=parameters,
        inputs=inputs,
        outputs=outputs,
    )


def _add(nets: dict[str, Net], port: str, net: Net, line: str) -> None:
    if port in nets:
        _unknown(line)
    nets[port] = net


def _net(text: str, instance: str | None) -> tuple[str, Net]:
    """Read ``name.port{n12w3}``; the port is empty if `instance` is `None`."""
    match = _NET.match(text) or _unknown(text)
    port = _port_of(match[1], instance) if instance is not None else ""
    return port, Net(int(match[2]), int(match[3] or match[4]))


def _port_of(text: str, instance: str) -> str:
    if not text.startswith(f"{instance}."):
        _unknown(text)
    return _plain(text[len(instance) + 1 :])


def _plain(name: str) -> str:
    return name.removeprefix("\\").removeprefix("$") if name[:1] in "\\$" else name


def _unknown(line: str) -> re.Match[str]:
    raise ProofError(f"GHDL's netlist has an unknown line: {line!r}")
