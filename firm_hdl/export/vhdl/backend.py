"""The VHDL folder of a message type: cores, the user's layer, test benches, and files for tools."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from firm_hdl.export.backend import BuildError, Converters, Output
from firm_hdl.export.folder import read_manifest
from firm_hdl.export.packaging import packaging
from firm_hdl.export.primitives import TYPES_NAME
from firm_hdl.export.record_top import RecordTop, why_no_record
from firm_hdl.export.top import DIRECTIONS, Direction, ports_of
from firm_hdl.export.tree import tree_of
from firm_hdl.export.vhdl.bench import (
    PARTS,
    RUN_SCRIPT,
    STIMULI,
    View,
    bench,
    flat_view,
    packets_text,
    record_view,
    run_script,
    stream_view,
)
from firm_hdl.export.vhdl.constants import comment
from firm_hdl.export.vhdl.layer import flat_package, user_layer
from firm_hdl.export.vhdl.wrapper import Core, instance, plain_lines, stream_lines
from firm_hdl.garbage import search_put_off
from firm_hdl.names.identifiers import identifier
from firm_hdl.plan import Plan
from firm_hdl.rtlil.ir import Design
from firm_hdl.vhdl.convert import convert
from firm_hdl.vhdl.package import PACKAGE_NAME

__all__ = ["check_packages", "to_vhdl", "write"]

FOLDER = "vhdl"
"""Subfolder of a type's folder."""

SECTION = "vhdl"
"""Key of the manifest's entry about the subfolder."""


COMMON = (f"{TYPES_NAME}.vhd", f"{PACKAGE_NAME}.vhd")
"""Files that are the same for all types."""


def write(converters: Converters) -> Output:
    """Write VHDL-2008, and the manifest's entry `vhdl`."""
    made = to_vhdl(converters)
    manifest = {SECTION: made.manifest}
    files = {**made.files, **_lists(made.manifest)}
    if "tools" in converters.options.extras:
        files |= packaging({"inputs": converters.inputs, **manifest})
    return Output(
        files={f"{FOLDER}/{name}": text for name, text in files.items()},
        manifest=manifest,
        instances=made.instances,
    )


def _about(converters: Converters, way: Direction) -> str:
    """Write what a core's file begins with."""
    inner = "inside, and 8 at its ports, as the constants of firm_hdl_types_pkg"
    return f"{converters.steps(way)}A status has 3 bits {inner}.\n"


def _lists(section: Mapping[str, Any]) -> dict[str, str]:
    """List the files to synthesize, and those of the benches, which compile after the design."""
    lists = {"files.txt": section["files"], "bench_files.txt": section["bench"]["files"]}
    return {name: "".join(f"{file}\n" for file in files) for name, files in lists.items()}


@dataclass(slots=True, kw_only=True)
class _Parts:
    """Parts of the folder; `design` and `benches` are texts by file name, in compile order."""

    base: str
    header: str
    design: dict[str, str] = field(default_factory=dict)
    benches: dict[str, str] = field(default_factory=dict)
    section: dict[str, Any] = field(default_factory=dict)
    instances: dict[Direction, str] = field(default_factory=dict)

    @property
    def head(self) -> str:
        """The comment at the head of each file that is not shared."""
        return "".join(comment(self.header, ""))

    @search_put_off()
    def core(self, circuit: Design | RecordTop, name: str, steps: str = "") -> Core:
        made = convert(circuit, name=name)
        package = f"{PACKAGE_NAME}.vhd"
        entities = [text for file, text in made.files.items() if file != package]
        self.design |= {
            package: made.files[package],
            f"{made.top}.vhd": "".join([self.head, *comment(steps, ""), "\n".join(entities)]),
        }
        # The outermost entity is the last one.
        return Core(entity=made.top, names=list(made.entities.values())[-1].ports)

    def add_bench(self, view: View, plan: Plan, kind: str = "") -> None:
        top = f"{self.base}{kind}_tb"
        what = f"{plan.message}{kind.replace('_', ' ')}, {plan.wire}, bus of {plan.bus_bytes} bytes"
        self.benches[top] = bench(
            top, view, bus_bytes=plan.bus_bytes, what=what, files=kind, header=self.header
        )


def to_vhdl(converters: Converters) -> Output:
    """Write the VHDL of a message type, except the files of :mod:`firm_hdl.export.packaging`.

    Returns: texts by name in the VHDL folder, and the manifest's entry `vhdl`.
    """
    name, plan = converters.name, converters.plan
    parts = _Parts(base=identifier(name).lower(), header=converters.header(name, "converters"))
    cores = {
        way: parts.core(
            converters.circuits[way], f"{parts.base}_{way}_flat", _about(converters, way)
        )
        for way in DIRECTIONS
    }
    for way, circuit in converters.register_circuits.items():
        parts.core(circuit, f"{parts.base}_{way}_registers")
    ports = converters.options.ports
    if ports == "records":
        _add_records(parts, converters, cores)
    else:
        _add_flat(parts, converters, cores)
    common = [file for file in COMMON if file in parts.design]
    design = [*common, *(file for file in parts.design if file not in common)]
    entities = list(parts.benches)
    benches = {**PARTS, **{f"{top}.vhd": text for top, text in parts.benches.items()}}
    files = {
        **{file: parts.design[file] for file in design},
        **benches,
        RUN_SCRIPT: run_script([*design, *benches], entities[0]),
    }
    if converters.stimuli:
        remark = f"Packets of {plan.message}, {plan.wire}, serialized by rosbags; one per line."
        files[STIMULI] = packets_text(converters.stimuli, remark)
    section = {
        "folder": FOLDER,
        "name": parts.base,
        "standard": "2008",
        "ports": ports,
        **parts.section,
        # Files are in compile order.
        "files": design,
        "common_files": common,
        "bench": {
            "entity": entities[0],
            "entities": entities,
            "files": list(benches),
            "common_files": list(PARTS),
            "script": RUN_SCRIPT,
            "stimuli": STIMULI if converters.stimuli else None,
        },
    }
    return Output(files=files, manifest=section, instances=parts.instances)


def _add_records(parts: _Parts, converters: Converters, cores: Mapping[Direction, Core]) -> None:
    """Add the layer with records and its benches."""
    message, plan = converters.message, converters.plan
    reason = why_no_record(message, plan)
    record_cores = None if reason else _record_cores(parts, converters, cores)
    layer = user_layer(
        message,
        plan,
        name=parts.base,
        cores=cores,
        record_cores=record_cores,
        header=parts.header,
    )
    parts.design = {**layer.packages, **parts.design, **layer.wrappers}
    for way, entity in layer.entities.items():
        base = layer.tree.package.base.upper()
        tied = f"rdy <= {base}_ALL_READY" if way == "deserializer" else f"msg <= {base}_IDLE"
        lines = stream_lines(plan, layer.tree, way)
        parts.instances[way] = instance(way, entity, lines, (TYPES_NAME, layer.package), tied)
    parts.add_bench(stream_view(plan, layer), plan)
    section: dict[str, Any] = {"built": False, "reason": reason}
    if layer.record is not None:
        parts.add_bench(record_view(layer, layer.record), plan, "_record")
        values = layer.record.values
        section = {"built": True, "message_type": values.name, "bits": values.bits}
    parts.section = {
        "package": layer.package,
        "entities": {
            way: {
                "records": layer.entities[way],
                "flat": cores[way].entity,
                **({"record": layer.record.entities[way]} if layer.record else {}),
            }
            for way in DIRECTIONS
        },
        "message_type": layer.tree.root.type,
        "ready_type": layer.tree.root.ready_type,
        "record_view": section,
        "leaves": layer.tree.leaf_members(plan),
        "constants": [
            entry.entry(package) for package, named in layer.constants.items() for entry in named
        ],
        "shared_packages": [
            {
                "name": each.name,
                "file": f"{each.name}.vhd",
                "message": each.message or None,
                "needs": list(each.needs),
            }
            for each in layer.shared
        ],
    }


def _record_cores(
    parts: _Parts, converters: Converters, cores: Mapping[Direction, Core]
) -> dict[Direction, Core]:
    """Add entities with the whole message as one vector, around the converters."""
    found = {}
    for way, core in cores.items():
        top = RecordTop(converters.message, converters.plan, way, core.entity, core.names)
        found[way] = parts.core(top, f"{parts.base}_{way}_record_flat")
    return found


def _add_flat(parts: _Parts, converters: Converters, cores: Mapping[Direction, Core]) -> None:
    """Add a package without records and a bench."""
    message, plan = converters.message, converters.plan
    package = f"{parts.base}_pkg"
    text, constants = flat_package(message, plan, name=package, cores=cores, header=parts.header)
    parts.design = {f"{package}.vhd": text, **parts.design}
    for way, core in cores.items():
        lines = plain_lines(ports_of(plan, way), core.names)
        parts.instances[way] = instance(way, core.entity, lines, (package,))
    parts.add_bench(flat_view(plan, package, cores), plan)
    parts.section = {
        "package": package,
        "entities": {way: {"flat": cores[way].entity} for way in DIRECTIONS},
        "record_view": {"built": False, "reason": "The ports are flat"},
        "constants": [entry.entry(package) for entry in constants],
        "shared_packages": [],
    }


def check_packages(folders: Mapping[Path, Converters]) -> None:
    """Refuse messages in neighbouring folders that use one package name for two ROS types.

    Within a message, the second of two equal names gets a number. A design with both messages
    compiles each file name once, so a name must belong to the same type in all folders.

    Raises `BuildError`.
    """
    owners: dict[Path, tuple[str, Path]] = {}
    for folder, converters in folders.items():
        if converters.options.ports != "records":
            continue
        for package in tree_of(converters.message, converters.plan).packages:
            file, owner = folder.parent / package.name, package.message.name
            if file not in owners:
                owners[file] = _owner(file, folders) or (owner, folder)
            other, other_folder = owners[file]
            if other != owner:
                raise BuildError(
                    f"{converters.message.name}: the VHDL package '{package.name}' would be that "
                    f"of {owner}, but in '{other_folder}' it is that of {other}; build one of them "
                    "into another folder (--out), and compile it into another library"
                )


def _owner(file: Path, made_anew: Collection[Path]) -> tuple[str, Path] | None:
    """Return the type that owns a package in a folder that is not built now, and that folder."""
    for path in sorted(file.parent.glob(f"[!.]*/{FOLDER}/{file.name}.vhd")):
        folder = path.parent.parent
        found = None if folder in made_anew else read_manifest(folder)
        # The manifest may be damaged.
        with suppress(AttributeError, KeyError, TypeError):
            for each in (found or {SECTION: {"shared_packages": []}})[SECTION]["shared_packages"]:
                if each["name"] == file.name and each["message"]:
                    return str(each["message"]), folder
    return None
