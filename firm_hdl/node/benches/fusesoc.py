"""The benches of a node in its core of FuseSoC, as targets."""

from __future__ import annotations

from typing import Any

from firm_hdl.node.benches.script import FRAMES

__all__ = ["bench_core"]


def bench_core(name: str) -> dict[str, dict[str, Any]]:
    """Return the entries of the benches, by section of the core.

    The target `sim` runs the bench in GHDL, and `sim_verilog` that in Icarus Verilog.

    Parameters
    ----------
    name : str
        Name of the node's entity.
    """
    top = f"{name}_tb"
    filesets: dict[str, Any] = {
        "bench": {
            "files": ["vhdl/firm_hdl_bench_pkg.vhd", f"vhdl/{top}.vhd"],
            "file_type": "vhdlSource-2008",
        },
        "bench_verilog": {"files": [f"{top}.v"], "file_type": "verilogSource-2005"},
        # FuseSoC copies the frames to the folder of the simulation, where the bench reads them.
        "frames": {"files": [{FRAMES: {"file_type": "user", "copyto": FRAMES}}]},
    }
    texts = {
        "seed": (1, "Seed of the random stalls"),
        "stalls": (40, "Percent of the cycles in which a stream stalls, 0 to 99"),
    }
    targets: dict[str, Any] = {
        "sim": {
            "description": f"Run {top} in GHDL",
            "default_tool": "ghdl",
            "filesets": ["vhdl", "bench", "frames"],
            "toplevel": top,
            "parameters": list(texts),
            "tools": {"ghdl": {"run_options": ["--ieee-asserts=disable-at-0"]}},
        },
        "sim_verilog": {
            "description": f"Run {top} in Icarus Verilog",
            "default_tool": "icarus",
            "filesets": ["verilog", "bench_verilog", "frames"],
            "toplevel": top,
            "tools": {"icarus": {"iverilog_options": ["-g2005"]}},
        },
    }
    parameters: dict[str, Any] = {
        name: {
            "datatype": "int",
            "default": default,
            "paramtype": "generic",
            "description": text,
        }
        for name, (default, text) in texts.items()
    }
    return {"filesets": filesets, "targets": targets, "parameters": parameters}
