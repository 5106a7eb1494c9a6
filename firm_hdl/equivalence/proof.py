"""Prove that the VHDL of a design is equivalent to the design: `prove`.

ABC, called through Yosys, decides most claims of the miter. The SAT solver of Yosys decides the
others. ABC simplifies the combined circuit by finding nets that are equal. A claim that holds
becomes the constant 0. The result of ABC is read from the netlist that Yosys writes, not from
messages.
"""

from __future__ import annotations

import json
import re
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal, TypeAlias

from amaranth.back import rtlil as amaranth_rtlil

from firm_hdl.equivalence.circuit import ProofError
from firm_hdl.equivalence.match import match_names
from firm_hdl.equivalence.miter import Miter, make_miter
from firm_hdl.equivalence.rtlil_side import read_rtlil
from firm_hdl.equivalence.tools import Tools, answer_of, find_tools
from firm_hdl.equivalence.vhdl_side import read_vhdl
from firm_hdl.jobs import ToolError, TooSlowError
from firm_hdl.vhdl.convert import Vhdl, convert

__all__ = ["DEFAULT_TIMEOUT", "Proof", "Result", "prove", "solve"]


# Equal cells of the two sides are merged before they become gates. These passes may exploit
# undefined values, but a miter has none. `check` finds loops, because their value is undefined.
_GATES = "read_json {name}.json; opt_expr; opt_merge; opt_clean; simplemap; techmap; check -assert"
_ABC = "abc -g AND -script +strash;&get,-n;&fraig,-x;&put; opt_clean; write_json answer.json"
_SAT = "sat -timeout {seconds} -prove differs 0 -show-ports -dump_json model.json"
_FEW = 4


@dataclass(frozen=True, slots=True, kw_only=True)
class Difference:
    """Inputs and registers for which the two sides differ."""

    where: tuple[str, ...]  # Claims that do not hold, with the values of both sides.
    inputs: Mapping[str, int]  # Inputs and registers that are not 0.


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """The answer of the solvers."""

    equal: bool | None  # `None`: the solvers gave up.
    difference: Difference | None = None
    open: tuple[str, ...] = ()  # Claims that are undecided, if `equal` is `None`.


def solve(miter: Miter, tools: Tools, folder: Path, timeout: float) -> Answer:
    """Prove all claims of a miter, or find inputs for which one does not hold.

    * `folder`: folder for temporary files.
    * `timeout`: time limit of each of the two solvers in seconds.
    """
    if not miter.claims:
        return Answer(equal=True)
    _write(folder / "miter.json", miter, values=False)
    try:
        tools.run_yosys(folder, f"{_GATES.format(name='miter')}; {_ABC}", timeout)
    except TooSlowError:
        left = list(range(len(miter.claims)))
    except ToolError as error:
        is_loop = "problems in 'check -assert'" in str(error)
        why = "one of the circuits has a combinational loop, or a latch" if is_loop else str(error)
        raise ProofError(why) from None
    else:
        left = _left(folder / "answer.json", len(miter.claims))
    # A difference often shows in many claims, and a few claims make a small problem.
    for part in filter(None, (left[:_FEW], left[_FEW:])):
        verdict = _search(miter, part, tools, folder, timeout)
        if not verdict.equal:
            return verdict
    return Answer(equal=True)


def _write(path: Path, miter: Miter, *, values: bool) -> None:
    path.write_text(json.dumps(miter.netlist(values=values)), encoding="utf-8")


def _left(path: Path, claims: int) -> list[int]:
    """Return the numbers of the claims that ABC did not reduce to the constant 0."""
    answer = json.loads(answer_of("Yosys", path))
    bits = answer["modules"]["miter"]["ports"]["differs"]["bits"]
    if len(bits) != claims:
        raise ProofError(f"Yosys returned {len(bits)} claims instead of {claims}")
    return [number for number, bit in enumerate(bits) if bit != "0"]


def _search(miter: Miter, left: list[int], tools: Tools, folder: Path, timeout: float) -> Answer:
    """Let the SAT solver look for a difference in the claims that ABC has left."""
    # There are no differences, or there would be nothing to solve.
    rest = replace(miter, claims=tuple(miter.claims[number] for number in left))
    _write(folder / "rest.json", rest, values=True)
    names = tuple(claim.what for claim in rest.claims)
    script = f"{_GATES.format(name='rest')}; tee -q -o sat.txt {_SAT.format(seconds=int(timeout))}"
    try:
        tools.run_yosys(folder, script, timeout * 2 + 60)
    except TooSlowError:
        return Answer(equal=None, open=names)
    log = answer_of("Yosys", folder / "sat.txt")
    if "SAT proof finished - no model found: SUCCESS!" in log:
        return Answer(equal=True)
    if "SAT proof finished - model found: FAIL!" not in log:
        return Answer(equal=None, open=names)
    return Answer(equal=False, difference=_model(rest, folder / "model.json"))


def _model(miter: Miter, path: Path) -> Difference:
    """Read the values that the solver found."""
    # WaveJSON has the value of a single bit in `wave`, and that of a vector in `data`.
    found = {
        signal["name"]: int(re.sub("[^01]", "0", signal.get("data", signal["wave"])[0]), 2)
        for signal in json.loads(answer_of("Yosys", path))["signal"]
    }
    inputs = {name: found.get(f"in{n}", 0) for n, name in enumerate(miter.inputs)}
    wrong = [n for n in range(len(miter.claims)) if found.get("differs", 0) >> n & 1]
    return Difference(
        where=tuple(
            f"{miter.claims[n].what} is {found.get(f'amaranth{n}', 0):#x} in the RTLIL and "
            f"{found.get(f'vhdl{n}', 0):#x} in the VHDL"
            for n in wrong
        ),
        inputs={name: value for name, value in inputs.items() if value},
    )


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
