"""Files for tools that compile a folder's VHDL: FuseSoC, Vivado, make, VUnit.

All facts come from the manifest. VHDL packages that several types share are packaged separately, so
that a project with several types has them once. Scripts are templates beside this module.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from firm_hdl.export.fusesoc import STALLS, copied, core, fileset, simulation
from firm_hdl.export.templates import render

__all__ = ["cores", "packaging"]

Manifest = Mapping[str, Any]

_SHARED = "all converters of firm-hdl share"


def packaging(manifest: Manifest) -> dict[str, str]:
    """Return the texts of all files by name, for the VHDL folder.

    The scripts for VUnit need packets for the benches, so a folder without packets has none.
    """
    vhdl = manifest["vhdl"]
    vunit_top = f"tb_{vhdl['name']}_vunit"
    templates = {"vivado.tcl": "vivado.tcl", "Makefile": "Makefile"}
    if vhdl["bench"]["stimuli"] is not None:
        templates |= {"vunit_run.py": "vunit_run.py", f"{vunit_top}.vhd": "vunit_bench.vhd"}
    values = {
        "converters": _remark(manifest),
        "message": manifest["inputs"]["message"],
        "vhdl": vhdl,
        "bench": vhdl["bench"],
        "shared_files": [
            *vhdl["common_files"],
            *(each["file"] for each in vhdl["shared_packages"]),
        ],
        "own_files": _own_files(vhdl["files"], vhdl),
        "vunit_top": vunit_top,
    }
    scripts = {name: render(f"packaging/{text}", **values) for name, text in templates.items()}
    return {**cores(manifest), **scripts}


def _remark(manifest: Manifest) -> str:
    """Return the message and its options, for a comment."""
    inputs = manifest["inputs"]
    options = inputs["options"]
    return (
        f"{inputs['message']} ({inputs['distro']}, {options['wire']}, "
        f"bus of {options['bus_bytes']} bytes)"
    )


def _own_files(files: Iterable[str], section: Manifest) -> list[str]:
    """Return the files that no other folder has."""
    others = {*section["common_files"], *(p["file"] for p in section.get("shared_packages", ()))}
    return [file for file in files if file not in others]


def cores(manifest: Manifest) -> dict[str, str]:
    """Return the cores of FuseSoC: one for the type, one for each package that types share."""
    vhdl, distro = manifest["vhdl"], manifest["inputs"]["distro"]
    version = manifest["inputs"]["generator"]["firm-hdl"]

    def full(library: str, name: str) -> str:
        return f"firm-hdl:{library}:{name}:{version}"

    def shared(name: str, description: str, files: Iterable[str], *needed: str) -> str:
        filesets = {"all": fileset("vhdl", files, needed)}
        targets = {"default": {"filesets": ["all"]}}
        return core(name, description, filesets=filesets, targets=targets)

    # Types of one name may differ between distributions, and so do their packages.
    packages = {
        each["name"]: full(distro if each["message"] else "vhdl", each["name"])
        for each in vhdl["shared_packages"]
    }
    common = full("vhdl", "flat" if vhdl["ports"] == "flat" else "common")
    bench = full("vhdl", "bench")
    found = {
        "firm_hdl_common": shared(common, f"Packages that {_SHARED}", vhdl["common_files"]),
        "firm_hdl_bench": shared(
            bench, f"Parts of the test benches that {_SHARED}", vhdl["bench"]["common_files"]
        ),
    }
    for each in vhdl["shared_packages"]:
        what = f"Records of {each['message']}" if each["message"] else "Streams of one bus width"
        needed = [common, *(packages[name] for name in each["needs"])]
        name = each["name"]
        text = f"{what}, which {_SHARED}"
        found[name] = shared(packages[name], text, [each["file"]], *needed)
    needed = [common, *packages.values()]
    found[vhdl["name"]] = _type(manifest, full(distro, vhdl["name"]), needed, bench)
    return {f"{name}.core": text for name, text in found.items()}


def _type(manifest: Manifest, name: str, needed: list[str], bench_core: str) -> str:
    """Write the core of a type's converters: target `sim` runs the test bench in GHDL."""
    section = manifest["vhdl"]
    bench, stimuli = section["bench"], section["bench"]["stimuli"]
    sections: dict[str, dict[str, Any]] = {
        "filesets": {
            "rtl": fileset("vhdl", _own_files(section["files"], section), needed),
            "bench": fileset("vhdl", _own_files(bench["files"], bench), [bench_core]),
        },
        "targets": {"default": {"filesets": ["rtl"]}},
    }
    if stimuli is not None:
        sections["filesets"]["stimuli"] = copied(stimuli)
        for top in bench["entities"]:
            target = "sim" if top == bench["entity"] else "sim_record"
            sections["targets"][target] = simulation(
                "ghdl", top, ["rtl", "bench", "stimuli"], STALLS
            )
        sections["parameters"] = STALLS
    return core(name, f"Converters of {_remark(manifest)}", **sections)
