"""Designs of one top level, each in a folder of its own: nodes and packet parts."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import Any

import firm_hdl
from firm_hdl.export.crossings import constraints
from firm_hdl.export.folder import build_folder, check_folder
from firm_hdl.export.fusesoc import core, fileset
from firm_hdl.export.manifest import digest, inputs_of, manifest_of
from firm_hdl.rtlil.ir import Design
from firm_hdl.verilog import convert

__all__ = [
    "BuiltDesign",
    "core_file",
    "design_folder",
    "inputs_of_design",
    "shared_unit",
    "verilog_file",
    "verilog_module",
    "vhdl_folder",
    "write_design",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class BuiltDesign:
    """The folder of a design."""

    folder: Path
    was_current: bool  # The folder was current, and nothing was written.
    # Outdated files that the user changed, and that stay; paths in the folder.
    kept: tuple[str, ...] = ()


def design_folder(out: str | os.PathLike[str], name: str) -> Path:
    """Return the folder of a design.

    Raises `UserError` if there is such a folder, and firm-hdl did not make it.
    """
    folder = Path(out, name)
    check_folder(folder.parent, folder)
    return folder


def verilog_module(name: str) -> str:
    """Return the name of a design's module; `name` is that of its VHDL entity."""
    return f"{name}_verilog"


def verilog_file(design: Design, *, name: str, header: str) -> dict[str, str]:
    """Write a design in Verilog, and the constraints of FIFOs that cross clock domains.

    * `name`: name of the VHDL entity; the module is ``NAME_verilog``.
    * `header`: lines of the comment at the head of the file, without comment marks.

    Returns: the text, by the file's path in the folder of the design, as for all files here.
    """
    module = verilog_module(name)
    return {
        f"{module}.v": convert(design, name=module, header=header),
        **constraints(design, name=name, module=module),
    }


def vhdl_folder(files: Mapping[str, str]) -> dict[str, str]:
    """Put files of VHDL, in compile order, into ``vhdl/``, with their list, ``vhdl/files.txt``."""
    texts = {f"vhdl/{file}": text for file, text in files.items()}
    return {**texts, "vhdl/files.txt": "".join(f"{file}\n" for file in files)}


def core_file(
    name: str,
    vhdl: Iterable[str],
    *,
    kind: str,
    description: str,
    more: Mapping[str, Mapping[str, Any]] | None = None,
    change: Callable[[dict[str, Any]], dict[str, Any]] | None = None,
) -> dict[str, str]:
    """Write a core of FuseSoC: the VHDL by default, or the Verilog.

    * `name`: name of the VHDL entity, and of the core.
    * `vhdl`: files in ``vhdl/``, in compile order.
    * `kind`, `description`: library of the core, such as ``"node"``, and what the design is, for
      people.
    * `more`: more entries of the core by section, such as ``targets``.
    * `change`: called with the sections, and returns them as they are written.
    """
    module = verilog_module(name)
    sections: dict[str, dict[str, Any]] = {
        "filesets": {
            "vhdl": fileset("vhdl", [f"vhdl/{file}" for file in vhdl]),
            "verilog": fileset("verilog", [f"{module}.v"]),
        },
        "targets": {
            "default": {"filesets": ["vhdl"], "toplevel": name},
            "verilog": {"filesets": ["verilog"], "toplevel": module},
        },
    }
    for section, entries in (more or {}).items():
        sections[section] = {**sections.get(section, {}), **entries}
    sections = change(sections) if change else sections
    version = firm_hdl.__version__
    return {f"{name}.core": core(f"firm-hdl:{kind}:{name}:{version}", description, **sections)}


def shared_unit(files: Mapping[str, Iterable[str]]) -> str:
    """Say which design unit two parts of a design would both have; empty if there is none.

    VHDL ignores the case of names (IEEE Std 1076-2008, 15.4.2), and units of VHDL and of
    SystemVerilog may be in one library. So the names of all of them differ in more than case.
    `files` has the names of files by the part, such as ``"its messages"``.
    """
    owners: dict[str, str] = {}
    for owner, names in files.items():
        for unit in (PurePath(each).stem for each in names if each.endswith((".vhd", ".sv"))):
            if (first := owners.setdefault(unit.lower(), owner)) != owner:
                return f"{first} and {owner} would both have a unit with the name '{unit}'"
    return ""


def inputs_of_design(facts: Mapping[str, Any], design: str) -> dict[str, Any]:
    """Return all that the files of a design depend on.

    * `facts`: what the manifest says of the design.
    * `design`: the design, as RTLIL of Amaranth.
    """
    return inputs_of({**facts, "design_sha256": digest(design)})


def write_design(
    folder: Path,
    *,
    inputs: Mapping[str, Any],
    facts: Mapping[str, Any],
    ports: Sequence[Mapping[str, Any]],
    make_files: Callable[[], Mapping[str, str]],
    force: bool = False,
) -> BuiltDesign:
    """Write the folder of a design, if it is not current.

    * `folder`: as :func:`design_folder` returns it.
    * `inputs`: as :func:`inputs_of_design` returns them.
    * `facts`, `ports`: what the manifest says of the design and of its ports.
    * `make_files`: returns all files but the manifest: texts by paths in the folder.
    * `force`: write the folder even if it is current.

    Raises `UserError` if something of the user's is in the place of a file, or the folder cannot be
    written.
    """

    def make() -> tuple[Mapping[str, str], dict[str, Any]]:
        name, files = folder.name, make_files()
        module = verilog_module(name)
        sections = {
            **facts,
            "verilog": {"module": module, "file": f"{module}.v"},
            "vhdl": {"entity": name, "files": "vhdl/files.txt"},
            "ports": list(ports),
        }
        return files, manifest_of(inputs, files, sections)

    kept = build_folder(folder.parent, folder, inputs, make, force=force)
    return BuiltDesign(folder=folder, was_current=kept is None, kept=kept or ())
