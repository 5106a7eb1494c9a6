"""Prove that the VHDL of a design is equivalent to the design: `prove`."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, TypeAlias

from amaranth.back import rtlil as amaranth_rtlil

from firm_hdl.equivalence.circuit import ProofError
from firm_hdl.equivalence.match import match_names
from firm_hdl.equivalence.miter import Miter, make_miter
from firm_hdl.equivalence.rtlil_side import read_rtlil
from firm_hdl.equivalence.solve import solve
from firm_hdl.equivalence.tools import Tools, find_tools
from firm_hdl.equivalence.vhdl_side import read_vhdl
from firm_hdl.jobs import ToolError
from firm_hdl.vhdl.convert import Vhdl, convert

__all__ = ["DEFAULT_TIMEOUT", "Proof", "Result", "prove"]

DEFAULT_TIMEOUT = 300.0
"""Time limit of each solver in seconds."""

Result: TypeAlias = Literal["equal", "unequal", "undecided"]
_RESULTS: Mapping[bool | None, Result] = {True: "equal", False: "unequal", None: "undecided"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Proof:
    """The result of an attempt to prove the VHDL of a design equal to its RTLIL."""

    result: Result  # Undecided: the solvers gave up; the circuits may be equal or not.
    # The differences, if `result` is unequal; the open claims, if it is undecided.
    differences: tuple[str, ...] = ()
    # Inputs and registers for which the sides differ; those that are not named are 0. Empty if no
    # solver was needed, for example if an initial value differs. The registers may have values that
    # they never reach. If so, the circuits may be equivalent, but this is not proved.
    counterexample: Mapping[str, int] = field(default_factory=dict)
    # Registers that only one side has. If their values are never used, the proof can succeed.
    unmatched: tuple[str, ...] = ()
    registers: int  # Number of register bits that both sides have.
    claims: int  # Number of outputs, next states and so on that a solver compared.
    seconds: float  # Duration of the attempt.

    def __str__(self) -> str:
        if self.result == "equal":
            return f"equal ({self.registers} bits of registers, {self.seconds:.1f} s)"
        lines = [f"{self.result} ({self.seconds:.1f} s)", *self.differences]
        if self.counterexample:
            lines.append("for")
            lines += [f"  {name} = {value:#x}" for name, value in self.counterexample.items()]
        if self.unmatched:
            lines.append(f"without a partner: {', '.join(self.unmatched)}")
        return "\n    ".join(lines)


@contextmanager
def _as_proof_errors() -> Iterator[None]:
    """Turn errors of tools into errors of proofs."""
    try:
        yield
    except ToolError as error:
        raise ProofError(str(error)) from None


@_as_proof_errors()
def prove(
    design: Any,
    vhdl: Vhdl | None = None,
    *,
    name: str = "top",
    ports: Any = None,
    platform: Any = None,
    timeout: float = DEFAULT_TIMEOUT,
    tools: Tools | None = None,
) -> Proof:
    """Prove that VHDL and RTLIL of a design are the same circuit, sequentially.

    Parameters
    ----------
    design : elaboratable or str
        An Amaranth component or other elaboratable, or RTLIL text of `amaranth.back.rtlil`.
    vhdl : Vhdl or None
        The VHDL of the design, from `firm_hdl.vhdl.convert.convert`; `None`: convert the design.
    name, ports, platform
        As for `convert`.
    timeout : float
        Seconds for each solver.
    tools : Tools or None
        GHDL and Yosys; `None`: those that `find_tools` finds.

    Raises
    ------
    ProgramMissingError
        If GHDL or Yosys is not installed.
    ProofError
        If the design has a construct that a proof does not support, such as a foreign instance, or
        if a tool failed.
    """
    began = time.perf_counter()
    found = tools or find_tools()
    rtlil = _rtlil(design, name=name, ports=ports, platform=platform)
    vhdl = convert(rtlil, name=name) if vhdl is None else vhdl
    with tempfile.TemporaryDirectory(prefix="firm-hdl-") as folder:
        miter = _miter(rtlil, vhdl, found, Path(folder), timeout)
        result: Result = "unequal"
        differences, example = miter.differences, {}
        if not differences:
            verdict = solve(miter, found, Path(folder), timeout)
            result = _RESULTS[verdict.equal]
            differences = verdict.open
            if verdict.difference is not None:
                differences = verdict.difference.where
                example = dict(verdict.difference.inputs)
    return Proof(
        result=result,
        differences=differences,
        counterexample=example,
        unmatched=miter.unmatched,
        registers=miter.registers,
        claims=len(miter.claims),
        seconds=time.perf_counter() - began,
    )


def _rtlil(design: Any, **options: Any) -> str:
    if isinstance(design, str):
        return design
    text: str = amaranth_rtlil.convert(design, emit_src=False, **options)
    return text


def _miter(rtlil: str, vhdl: Vhdl, tools: Tools, folder: Path, timeout: float) -> Miter:
    for name, text in vhdl.files.items():
        (folder / name).write_text(text, encoding="utf-8")
    tools.run_ghdl(folder, "-a", "--std=08", *vhdl.files, timeout=timeout)
    # With `-dm`, memories stay registers, so the proof does not rely on GHDL's memory inference.
    options = "--std=08", "-dm", "--out=dump"
    dump = tools.run_ghdl(folder, "--synth", *options, vhdl.top, timeout=timeout)
    # The outermost module is the last one.
    top = list(vhdl.entities)[-1]
    match = match_names(rtlil, top, vhdl.entities)
    return make_miter(
        read_rtlil(rtlil, tools, folder, timeout),
        read_vhdl(dump, match.memories),
        ports=vhdl.entities[top].ports,
        signals=match.signals,
    )
