# amaranth: UnusedElaboratable=no
"""The files of a node: the design in each language, the manifest, and the summary."""

from __future__ import annotations

import os
from dataclasses import asdict
from typing import Any

from amaranth.back import rtlil

import firm_hdl
from firm_hdl.errors import UserError
from firm_hdl.export.design import (
    BuiltDesign,
    design_files,
    design_folder,
    inputs_of_design,
    write_design,
)
from firm_hdl.names.identifiers import identifier
from firm_hdl.node.description import Description
from firm_hdl.node.node import Node
from firm_hdl.node.summary import facts_of, summary
from firm_hdl.node.top import NodeTop, node_ports

__all__ = ["build_node"]

SUMMARY = "summary.txt"


def build_node(
    description: Description,
    out: str | os.PathLike[str] = "node_out",
    *,
    accelerator: Any = None,
    force: bool = False,
) -> BuiltDesign:
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
    folder = design_folder(out, name)
    node = Node(description, accelerator)
    try:
        ports = node_ports(node)
    except ValueError as error:
        raise UserError(str(error)) from None
    # The accelerator's code is part of the design.
    design = rtlil.convert(NodeTop(node), name=name, emit_src=False)
    facts = facts_of(description)
    what = f"a node of ROS {description.distro}"

    def make_files() -> dict[str, str]:
        files = design_files(
            design,
            name=name,
            header=f"{name}: {what}, made by firm-hdl {firm_hdl.__version__}\n",
            kind="node",
            description=f"Node {description.node} of ROS {description.distro}",
        )
        return {**files, SUMMARY: summary(description) + "\n"}

    return write_design(
        folder,
        inputs=inputs_of_design({"node": description.node, "facts": facts}, design),
        facts={**facts, "clock": "aclk", "reset": "aresetn"},
        ports=[asdict(port) for port in ports],
        make_files=make_files,
        force=force,
    )
