"""Test benches of a node: frames go into its link, and those that come out are compared.

:mod:`script` decides which frames, and :mod:`write` writes the benches in VHDL and in Verilog.
"""

from __future__ import annotations

from firm_hdl.node.benches.script import FRAMES, LinkScript, Stimuli, link_script
from firm_hdl.node.benches.write import bench_core, bench_files

__all__ = ["FRAMES", "LinkScript", "Stimuli", "bench_core", "bench_files", "link_script"]
