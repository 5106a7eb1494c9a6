"""What is open at the start of a proof: registers that a reset does not change, in all modules."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from amaranth.hdl import Module, Signal

from firm_hdl.equivalence.tools import Tools
from firm_hdl.formal.netlist import write_aiger
from firm_hdl.formal.scene import Scene


class Reader(Tools):
    """A Yosys that runs nothing."""

    def run_yosys(self, folder: Path, script: str, timeout: float | None) -> None:
        assert f"read_rtlil {folder.name}.il; " in script


def registers(scene: Scene) -> None:
    """Registers with and without a reset, in the scene and in a block of the scene."""
    inner = Module()
    for m, place in ((scene.m, "outer"), (inner, "inner")):
        for reset_less in (True, False):
            what = "kept" if reset_less else "reset"
            register = Signal(name=f"{what}_{place}", reset_less=reset_less)
            m.d.sync += register.eq(~register)
            scene.claim(f"{what} {place}", register)
    scene.m.submodules.inner = inner


@pytest.mark.parametrize("is_configured", [False, True])
def test_registers_without_a_reset_have_any_value(tmp_path, is_configured):
    scene = Scene(registers)
    scene.is_configured = is_configured
    folder = tmp_path / "scene"
    folder.mkdir()
    assert write_aiger(scene, folder, Reader(ghdl=(), yosys=())) == folder / "scene.aig"
    text = (folder / "scene.il").read_text()
    # The attributes of a wire stand above the wire.
    wires = re.findall(r"((?:^ *attribute .*\n)*)^ *wire .*\\(\w+)$", text, re.MULTILINE)
    is_open = {name for above, name in wires if "undefined_at_start" in above}
    assert is_open == (set() if is_configured else {"kept_outer", "kept_inner"})
    # Nothing resets the block in the middle of a run.
    assert {"clk"} <= {name for _, name in wires} and "rst" not in {name for _, name in wires}
