"""Scripts for Vivado, make and VUnit; each is a template beside this module."""

from __future__ import annotations

from firm_hdl.export.packaging.facts import Manifest, own_files, remark, shared_packages
from firm_hdl.export.templates import render

__all__ = ["scripts"]


def scripts(manifest: Manifest) -> dict[str, str]:
    """Return the texts of all scripts by file name.

    The scripts for VUnit need packets for the benches, so a folder without packets has none.
    """
    vhdl = manifest["vhdl"]
    vunit_top = f"tb_{vhdl['name']}_vunit"
    templates = {"vivado.tcl": "vivado.tcl", "Makefile": "Makefile"}
    if vhdl["bench"]["stimuli"] is not None:
        templates |= {"vunit_run.py": "vunit_run.py", f"{vunit_top}.vhd": "vunit_bench.vhd"}
    values = {
        "converters": remark(manifest),
        "message": manifest["inputs"]["message"],
        "vhdl": vhdl,
        "bench": vhdl["bench"],
        "shared_files": [
            *vhdl["common_files"],
            *(each["file"] for each in shared_packages(manifest)),
        ],
        "own_files": own_files(vhdl["files"], vhdl),
        "vunit_top": vunit_top,
    }
    return {name: render(f"packaging/{template}", **values) for name, template in templates.items()}
