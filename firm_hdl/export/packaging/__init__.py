"""Files for tools that compile a folder's VHDL: lists of files, FuseSoC, Vivado, make, VUnit.

All facts come from the manifest. VHDL packages that several types share are packaged separately, so
that a project with several types has them once.
"""

from __future__ import annotations

from firm_hdl.export.packaging.facts import Manifest
from firm_hdl.export.packaging.fusesoc import cores
from firm_hdl.export.packaging.scripts import scripts

__all__ = ["packaging"]


def packaging(manifest: Manifest) -> dict[str, str]:
    """Return the texts of all files by name, for the VHDL folder.

    ``files.txt`` lists the files to synthesize, one per line, in compile order. ``bench_files.txt``
    lists the files of the test benches, which compile after the design.
    """
    vhdl = manifest["vhdl"]
    lists = {"files.txt": vhdl["files"], "bench_files.txt": vhdl["bench"]["files"]}
    return {
        **{name: "".join(f"{file}\n" for file in files) for name, files in lists.items()},
        **cores(manifest),
        **scripts(manifest),
    }
