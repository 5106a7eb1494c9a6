"""The core of FuseSoC for a node: the design, and its benches as targets."""

from __future__ import annotations

from typing import Any

import yaml

import firm_hdl
from firm_hdl.node.benches.script import FRAMES
from firm_hdl.node.description import Description

__all__ = ["node_core"]


def node_core(
    description: Description, name: str, module: str, vhdl: list[str], *, has_bench: bool
) -> str:
    """Write a core of FuseSoC: the VHDL by default, or the Verilog, and the benches.

    Parameters
    ----------
    name : str
        Name of the entity.
    module : str
        Name of the module in Verilog.
    vhdl : list of str
        Files of the node in compile order, in the folder ``vhdl/``.
    has_bench : bool
        Then the target `sim` runs the bench in GHDL, and `sim_verilog` that in Icarus Verilog.
    """
    document: dict[str, Any] = {
        "name": f"firm-hdl:node:{name}:{firm_hdl.__version__}",
        "description": f"Node {description.node} of ROS {description.distro}",
        "filesets": {
            "vhdl": {"files": [f"vhdl/{file}" for file in vhdl], "file_type": "vhdlSource-2008"},
            "verilog": {"files": [f"{module}.v"], "file_type": "verilogSource-2005"},
        },
        "targets": {
            "default": {"filesets": ["vhdl"], "toplevel": name},
            "verilog": {"filesets": ["verilog"], "toplevel": module},
        },
    }
    if has_bench:
        _add_benches(document, f"{name}_tb")
    return "CAPI=2:\n" + yaml.safe_dump(document, sort_keys=False, width=1000)


def _add_benches(document: dict[str, Any], top: str) -> None:
    document["filesets"] |= {
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
    document["targets"] |= {
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
    document["parameters"] = {
        name: {
            "datatype": "int",
            "default": default,
            "paramtype": "generic",
            "description": text,
        }
        for name, (default, text) in texts.items()
    }
