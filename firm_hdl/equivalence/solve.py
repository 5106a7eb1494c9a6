"""Decide whether the outputs of a miter can ever be 1.

ABC, called through Yosys, decides most claims. The SAT solver of Yosys decides the others.

ABC simplifies the combined circuit by finding nets that are equal. A claim that holds becomes the
constant 0. The result of ABC is read from the netlist that Yosys writes, not from messages.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from firm_hdl.equivalence.circuit import ProofError
from firm_hdl.equivalence.miter import Miter
from firm_hdl.equivalence.tools import Tools, answer_of
from firm_hdl.jobs import ToolError, TooSlowError

__all__ = ["solve"]

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

    Parameters
    ----------
    folder : Path
        Folder for temporary files.
    timeout : float
        Time limit of each of the two solvers in seconds.
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
    rest = Miter(
        differences=(),
        claims=tuple(miter.claims[number] for number in left),
        inputs=miter.inputs,
        cells=miter.cells,
        unmatched=miter.unmatched,
        registers=miter.registers,
    )
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
