"""The SystemVerilog folder of a message type: packages, modules with structs, and file list."""

from __future__ import annotations

from typing import Any

from firm_hdl.export.backend import Converters, Output, module_name
from firm_hdl.export.remarks import remark
from firm_hdl.export.systemverilog.package import constants_of, shared_packages
from firm_hdl.export.systemverilog.structs import package_name
from firm_hdl.export.systemverilog.types import WORDS, bus_name
from firm_hdl.export.systemverilog.wrapper import instance, wrapper
from firm_hdl.export.top import DIRECTIONS, Direction
from firm_hdl.export.tree import Tree, tree_of

__all__ = ["FOLDER", "wrapper_name", "write"]

FOLDER = "systemverilog"
"""Subfolder of a type's folder."""

_LIST, _WAIVERS = "files.f", "waivers.vlt"

WAIVERS_TEXT = """\
// Warnings of Verilator that are harmless here, each with the reason. To lint:
// $ verilator --lint-only -Wall ../waivers.vlt waivers.vlt -F files.f --top-module MODULE

`verilator_config

// A design need not use all constants of a package.
lint_off -rule UNUSEDPARAM -file "*_sv_pkg.sv"

// A field keeps its name even if that is a keyword of C++; Verilator renames it internally.
lint_off -rule SYMRSVDWORD -file "*_sv_pkg.sv"
"""


def wrapper_name(folder: str, direction: Direction) -> str:
    """Return the name of the module with structs."""
    return f"{folder}_{direction}_sv"


def write(converters: Converters) -> Output:
    """Write SystemVerilog-2012 around the Verilog modules, and the manifest's `systemverilog`.

    With flat ports, there is none.
    """
    if converters.options.ports == "flat":
        return Output(files={})
    tree = tree_of(converters.message, converters.plan, WORDS)
    modules = {way: wrapper_name(converters.name, way) for way in DIRECTIONS}
    cores = [f"../{module_name(converters.name, way)}.v" for way in DIRECTIONS]
    texts = shared_packages(converters.plan, tree)
    shared = list(texts)
    for way, name in modules.items():
        texts[f"{name}.sv"] = _module(converters, tree, way, name)
    listed = [*shared, *cores, *(f"{name}.sv" for name in modules.values())]
    files = {**texts, _LIST: "".join(f"{file}\n" for file in listed), _WAIVERS: WAIVERS_TEXT}
    return Output(
        files={f"{FOLDER}/{name}": text for name, text in files.items()},
        manifest={"systemverilog": _section(converters, tree, modules, listed)},
        instances={
            way: instance(converters.plan, tree, way, name=name) for way, name in modules.items()
        },
    )


def _module(converters: Converters, tree: Tree, way: Direction, name: str) -> str:
    header = "".join(remark(converters.header(name, f"the {way}"), ""))
    core = module_name(converters.name, way)
    return header + wrapper(converters.plan, tree, way, name=name, core=core)


def _section(
    converters: Converters, tree: Tree, modules: dict[Direction, str], listed: list[str]
) -> dict[str, Any]:
    """Return the folder's entry of the manifest; files are in compile order."""
    plan = converters.plan
    return {
        "folder": FOLDER,
        "standard": "1800-2012",
        "package": package_name(tree.package.name),
        "modules": modules,
        "message_type": tree.root.type,
        "ready_type": tree.root.ready_type,
        "leaves": tree.leaf_members(plan),
        "constants": [
            entry.entry(package_name(package.name))
            for package in tree.packages
            for entry in constants_of(package, plan)
        ],
        "shared_packages": [
            {"name": bus_name(plan.bus_bytes), "message": None},
            *(
                {"name": package_name(each.name), "message": each.message.name}
                for each in tree.packages
            ),
        ],
        "files": listed,
        "waivers": _WAIVERS,
    }
