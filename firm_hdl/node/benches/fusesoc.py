"""The benches of a node in its core of FuseSoC, as targets."""

from __future__ import annotations

from typing import Any

from firm_hdl.export.fusesoc import STALLS, copied, fileset, simulation
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
    return {
        "filesets": {
            "bench": fileset("vhdl", ["vhdl/firm_hdl_bench_pkg.vhd", f"vhdl/{top}.vhd"]),
            "bench_verilog": fileset("verilog", [f"{top}.v"]),
            "frames": copied(FRAMES),
        },
        "targets": {
            "sim": simulation("ghdl", top, ["vhdl", "bench", "frames"], STALLS),
            "sim_verilog": simulation("icarus", top, ["verilog", "bench_verilog", "frames"]),
        },
        "parameters": STALLS,
    }
