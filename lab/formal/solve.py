"""Decide whether a claim can be broken: ABC, as Yosys brings it.

`pdr` (property directed reachability) proves a claim for any number of cycles: it finds an
invariant that implies the claim, and checks this invariant once more. `bmc3` (bounded model
checking) looks at all runs of a number of cycles. The answer is read from files that ABC writes,
not from messages; an answer that is missing is none.
"""

from __future__ import annotations

import re
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias

from firm_hdl.equivalence.tools import Tools, answer_of
from firm_hdl.jobs import TooSlowError

__all__ = ["Answer", "Method", "decide"]

Method: TypeAlias = Literal["PDR", "BMC", "induction"]
Result: TypeAlias = Literal["proved", "broken", "undecided"]

_START = "read_verilog start.v; prep -top start; simplemap; abc -g AND -script +{commands}"
# ABC is called on this design, and then reads another one.
_DESIGN = "module start(input a, b, output c); assign c = a & b; endmodule\n"
_COMMANDS = (
    "backup;read_aiger,{aiger};cone,-O,{output};scleanup;{solve};write_status,{name}.status;"
    "write_cex,-n,-f,{name}.cex;restore"
)
_SOLVE = {"PDR": "pdr,-T,{seconds}", "BMC": "bmc3,-F,{depth},-T,{seconds}"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """What a solver found.

    Attributes
    ----------
    result : "proved", "broken" or "undecided"
        `BMC` proves a claim for the cycles of its depth only.
    cycles : int
        Cycles of the counterexample; of a proof by `PDR`, frames of the invariant.
    inputs : str
        The counterexample: the inputs that are 1, as ``name@cycle``. All others are 0.
    seconds : float
    """

    result: Result
    cycles: int = 0
    inputs: str = ""
    seconds: float = 0.0


def decide(
    aiger: Path, output: int, tools: Tools, *, method: Method, depth: int, timeout: float
) -> Answer:
    """Decide whether an output of a graph can be 1.

    Parameters
    ----------
    depth : int
        Cycles of `BMC`.
    timeout : float
        Seconds, after which the answer is "undecided".
    """
    folder, name = aiger.parent, f"{aiger.stem}.{output}"
    (folder / "start.v").write_text(_DESIGN, encoding="utf-8")
    solve = _SOLVE[method].format(depth=depth, seconds=int(timeout))
    commands = _COMMANDS.format(aiger=aiger.name, output=output, name=name, solve=solve)
    start = time.monotonic()
    try:
        tools.run_yosys(folder, _START.format(commands=commands), timeout + 10)
        words = answer_of("ABC", folder / f"{name}.status").split()
    except TooSlowError:
        return Answer(result="undecided", seconds=time.monotonic() - start)
    seconds = time.monotonic() - start
    found, frames = words[0], int(words[1])
    # The number of frames is -1 if the counterexample has one cycle.
    if found == "snl_SAT" and len(words) > 4:
        inputs = _inputs(answer_of("ABC", folder / f"{name}.cex"))
        return Answer(result="broken", cycles=int(words[4]) + 1, inputs=inputs, seconds=seconds)
    proved = found == "snl_UNSAT" if method == "PDR" else frames + 1 >= depth
    return Answer(result="proved" if proved else "undecided", cycles=frames, seconds=seconds)


def _inputs(text: str) -> str:
    """Return what is 1 of a counterexample, without what is undefined at the start."""
    return " ".join(
        word.removesuffix("=1")
        for word in text.split()
        if re.fullmatch(r"[a-z]\w*(\[\d+\])?@\d+=1", word) and not re.match(r"n\d+@", word)
    )
