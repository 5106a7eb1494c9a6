"""Cores of FuseSoC, in its format CAPI2: YAML after a first line ``CAPI=2:``."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import yaml

__all__ = ["STALLS", "copied", "core", "fileset", "simulation"]

_TYPES = {"vhdl": "vhdlSource-2008", "verilog": "verilogSource-2005"}


def core(name: str, description: str, **sections: dict[str, Any]) -> str:
    """Write a core: its name with library and version, and its sections."""
    document = {"name": name, "description": description, **sections}
    return "CAPI=2:\n" + yaml.safe_dump(document, sort_keys=False, width=1000, allow_unicode=True)


def fileset(language: str, files: Iterable[str], depend: Sequence[str] = ()) -> dict[str, Any]:
    """Return a set of files in compile order, and the cores that they need."""
    needed = {"depend": list(depend)} if depend else {}
    return {"file_type": _TYPES[language], **needed, "files": list(files)}


def copied(file: str) -> dict[str, Any]:
    """Return a set of one file, which FuseSoC copies to the folder of the simulation."""
    return {"files": [{file: {"file_type": "user", "copyto": file}}]}


def simulation(
    tool: str, top: str, filesets: Sequence[str], parameters: Iterable[str] = ()
) -> dict[str, Any]:
    """Return a target that runs a bench in GHDL or Icarus Verilog (``ghdl`` or ``icarus``)."""
    title, options = {
        "ghdl": ("GHDL", {"run_options": ["--ieee-asserts=disable-at-0"]}),
        "icarus": ("Icarus Verilog", {"iverilog_options": ["-g2005"]}),
    }[tool]
    needed = list(parameters)
    return {
        "description": f"Run {top} in {title}",
        "default_tool": tool,
        "filesets": list(filesets),
        "toplevel": top,
        **({"parameters": needed} if needed else {}),
        "tools": {tool: options},
    }


def _generic(default: int, description: str) -> dict[str, Any]:
    return {
        "datatype": "int",
        "default": default,
        "paramtype": "generic",
        "description": description,
    }


STALLS = {
    "seed": _generic(1, "Seed of the random stalls"),
    "stalls": _generic(40, "Percent of the cycles in which a stream stalls, 0 to 99"),
}
"""Generics of the benches, as parameters of a core."""
