"""A scene as an and-inverter graph, with all that is undefined after a start left open.

Registers with a reset start with the values that a reset gives them. So a run from the start of the
graph is a run from any state after a cycle of reset. Registers without a reset, memories, and
undefined values of Amaranth's netlist may have any value: what depends on a word that was never
written breaks claims.
"""

from __future__ import annotations

from pathlib import Path

from amaranth.back import rtlil
from amaranth.hdl import ClockDomain, Fragment

from firm_hdl.equivalence.tools import Tools
from lab.formal.scene import STARTS, Scene

__all__ = ["write_aiger"]

_UNDEFINED = "undefined_at_start"
# Nothing here simplifies, because Yosys may choose what is undefined. `setundef` makes each such
# value an input of its own; so does `-zinit` with the start of a register.
_SCRIPT = """
read_rtlil {name}.il; hierarchy -check; setattr -unset init a:{undefined} %s; delete t:$meminit_v2
delete t:$print t:$check; proc -noopt -norom; flatten; memory_collect; memory_map; {clocks}
opt_clean; simplemap; techmap; setundef -undriven -anyseq; dfflegalize -cell $_DFF_P_ 01
aigmap; opt_clean; write_aiger -zinit -symbols {name}.aig
"""


def write_aiger(scene: Scene, folder: Path, tools: Tools, *, name: str = "scene") -> Path:
    """Write a scene in binary AIGER; its outputs are the claims, in their order."""
    fragment = Fragment.get(scene, None)
    fragment.add_domains(ClockDomain("sync", reset_less=True))
    if scene.is_step or not scene.is_configured:
        _mark_undefined(fragment, is_step=scene.is_step)
    text = rtlil.convert(fragment, name="scene", ports=scene.ports, emit_src=False)
    (folder / f"{name}.il").write_text(text, encoding="utf-8")
    script = _SCRIPT.format(name=name, undefined=_UNDEFINED, clocks="")
    tools.run_yosys(folder, script.replace("\n", "; "), None)
    return folder / f"{name}.aig"


def _mark_undefined(fragment: Fragment, *, is_step: bool) -> None:
    """Mark the registers that a reset does not change; in the step of an induction, all."""
    for domain, statements in fragment.statements.items():
        if domain == "comb":
            continue
        for statement in statements:
            for signal in statement._lhs_signals():
                if signal.reset_less or (is_step and not signal.name.startswith(STARTS)):
                    signal.attrs[_UNDEFINED] = 1
    for inner, _name, _location in fragment.subfragments:
        _mark_undefined(inner, is_step=is_step)
