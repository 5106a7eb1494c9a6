"""The VHDL folder of a message type: cores, the user's layer, test bench, stimuli and script."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from firm_hdl.export.names import identifier
from firm_hdl.export.top import DIRECTIONS, Direction, Top
from firm_hdl.export.vhdl import convert
from firm_hdl.export.vhdl_bench import RUN_SCRIPT, STIMULI, Bench, bench, run_script
from firm_hdl.export.vhdl_types import UserLayer, user_layer
from firm_hdl.export.vhdl_user_parts import packets_text
from firm_hdl.model import Message
from firm_hdl.plan import Plan

__all__ = ["VhdlFolder", "to_vhdl"]


@dataclass(frozen=True, slots=True, kw_only=True)
class VhdlFolder:
    """Files, and what the manifest says of them.

    Attributes
    ----------
    files : dict of str to str
        Texts by file name.
    manifest : dict
        Its section on VHDL.
    """

    files: dict[str, str]
    manifest: dict[str, Any]


def to_vhdl(
    message: Message,
    plan: Plan,
    tops: Mapping[Direction, Top],
    *,
    name: str,
    header: str = "",
    stimuli: Sequence[bytes] = (),
) -> VhdlFolder:
    """Write the VHDL of a message type.

    Parameters
    ----------
    tops : mapping of direction to Top
        Both converters.
    name : str
        What all names start with, once they are identifiers in lower case.
    header : str
        Lines for a comment at the head of every file that is the type's own.
    stimuli : sequence of bytes
        Packets for the test bench. Without any, there is no file of them.
    """
    base = identifier(name).lower()
    cores: dict[Direction, str] = {}
    ports: dict[Direction, Mapping[str, str]] = {}
    design: dict[str, str] = {}
    for direction in DIRECTIONS:
        core = convert(tops[direction], name=f"{base}_{direction}_flat", header=header)
        cores[direction] = core.top
        # The outermost entity is the last one.
        ports[direction] = list(core.entities.values())[-1].ports
        design.update(core.files)
    layer = user_layer(
        message, plan, name=base, cores=cores, core_ports=ports, header=header
    )
    design = {**layer.packages, **design, **layer.wrappers}
    made = bench(message, plan, layer, header=header)
    files = {
        **design,
        **made.files,
        RUN_SCRIPT: run_script([*design, *made.files], made.top),
    }
    if stimuli:
        remark = f"Packets of {message.name}, {plan.wire}, written by rosbags; one a line."
        files[STIMULI] = packets_text(list(stimuli), remark)
    return VhdlFolder(files=files, manifest=_section(layer, cores, list(design), made, plan))


def _section(
    layer: UserLayer, cores: Mapping[Direction, str], design: list[str], made: Bench, plan: Plan
) -> dict[str, Any]:
    return {
        "folder": "vhdl",
        "standard": "2008",
        "package": layer.package,
        "entities": {
            direction: {"records": layer.entities[direction], "flat": cores[direction]}
            for direction in DIRECTIONS
        },
        "message_type": layer.tree.root.type,
        "ready_type": layer.tree.root.ready_type,
        # In the order in which they compile.
        "files": design,
        "bench": {"entity": made.top, "files": list(made.files), "script": RUN_SCRIPT},
        "leaves": {
            str(plan.leaves[node.leaf]): node.access
            for node in layer.tree.root.leaves()
            if node.leaf is not None
        },
        "constants": [
            {"type": entry.owner.name, "constant": entry.constant.name, "name": entry.name}
            for entry in layer.constants
        ],
    }
