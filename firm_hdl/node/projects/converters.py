"""A project that puts the converters of a type into a SoC of LiteX, with firmware in C."""

from __future__ import annotations

import os
import shlex
from collections.abc import Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import Any

from firm_hdl.export.build import plan_of
from firm_hdl.export.registers import register_maps
from firm_hdl.export.top import ports_of
from firm_hdl.export.verilog.backend import converter_axis_ports
from firm_hdl.frontend import Library
from firm_hdl.model import Primitive
from firm_hdl.names.identifiers import identifier
from firm_hdl.node.projects import render, write_folder
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, Direction, Plan
from firm_hdl.registers import c_values

__all__ = ["write_litex_project"]

_FILES = ("README.md", "Makefile", "soc.py", "main.c", "requirements.txt")
_BUS_BYTES = 8
_VALUES = 8
"""How many values the firmware sets and prints."""


def write_litex_project(
    library: Library,
    type_name: str,
    folder: str | os.PathLike[str] | None = None,
    *,
    origins: Mapping[str, Sequence[str]],
) -> Path:
    """Write the project of a message type into a new folder; return the folder.

    * `folder`: `None` is the name of the type, and ``_litex``.
    * `origins`: folders and files of the definitions, by the option of ``firm-hdl build``.

    Raises `DefinitionError` if the type is not there. Raises `UserError` if it has no registers, or
    the folder exists or cannot be written.
    """
    message = library.message(type_name)
    plan = plan_of(message, None, _BUS_BYTES, DEFAULT_MAX_MESSAGE_BYTES)
    layout = register_maps(message, plan)["deserializer"]
    out = Path(folder or f"{identifier(type_name.rpartition('/')[2]).lower()}_litex")
    words = [message.name, "--distro", library.distro]
    for option, paths in origins.items():
        for path in paths:
            words += [option, os.path.relpath(path, out)]
    values: dict[str, Any] = {
        "message": message,
        "distro": library.distro,
        "name": f"{layout.name}_{plan.wire}_{plan.bus_bytes}",
        "build_words": shlex.join(words),
        "leaves": [*zip(_leaves(plan, "deserializer"), _leaves(plan, "serializer"), strict=True)],
        "region_bytes": 1 << layout.table.address_bits,
        "type": layout.name,
        "values": [
            (value, kind.kind == "float", _example(kind, number))
            for number, (value, kind) in enumerate(islice(c_values(layout), _VALUES))
        ],
        "has_more": len(layout.items) > _VALUES,
    }
    write_folder(out, {name: render(f"litex/{name}", **values) for name in _FILES})
    return out


def _example(kind: Primitive, number: int) -> str:
    """Return a value in C that differs from message to message, and between values."""
    if kind.kind == "bool":
        return "number % 2"
    return f"number + {number / 4 if kind.kind == 'float' else number}"


def _leaves(plan: Plan, way: Direction) -> list[str]:
    """Return the names of the streams of leaves."""
    leaves = {
        port.name for port in ports_of(plan, way) if port.leaf is not None and port.member == "data"
    }
    ports = converter_axis_ports(plan, way)
    return [port.name.removesuffix("_tdata") for port in ports if port.inner in leaves]
