"""What tools want to be told of a folder's VHDL: lists of files, FuseSoC, Vivado, make, VUnit.

Everything comes from the manifest. The packages that are the same for all types are packaged apart,
so that a project with several types has them once.
"""

from __future__ import annotations

from firm_hdl.export.packaging.facts import Manifest
from firm_hdl.export.packaging.fusesoc import cores
from firm_hdl.export.packaging.scripts import makefile, vivado_script
from firm_hdl.export.packaging.vunit import vunit_bench, vunit_script

__all__ = ["packaging"]


def packaging(manifest: Manifest) -> dict[str, str]:
    """Write all files, by name; they are to be in the folder of the VHDL.

    ``files.txt`` lists what is to be synthesized, a file a line, in the order in which it compiles;
    ``bench_files.txt`` the files of the test benches, which compile after the design.
    """
    vhdl = manifest["vhdl"]
    files = {
        "files.txt": "".join(f"{file}\n" for file in vhdl["files"]),
        "bench_files.txt": "".join(f"{file}\n" for file in vhdl["bench"]["files"]),
        **cores(manifest),
        "vivado.tcl": vivado_script(manifest),
        "Makefile": makefile(manifest),
    }
    if vhdl["bench"]["stimuli"] is not None:
        files["vunit_run.py"] = vunit_script(manifest)
        files[f"tb_{vhdl['name']}_vunit.vhd"] = vunit_bench(manifest)
    return files
