# amaranth: UnusedElaboratable=no
"""Solvers that give up: the result is undecided, which is no proof."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path

import pytest
from amaranth.back import rtlil as amaranth_rtlil
from amaranth.hdl import Module, Signal

from firm_hdl.equivalence import Proof, ProofError, Tools, command, prove
from firm_hdl.equivalence.command import Attempt, ProofTask
from firm_hdl.equivalence.miter import Claim, Miter
from firm_hdl.equivalence.proof import solve
from firm_hdl.jobs import ToolError, TooSlowError
from firm_hdl.vhdl.convert import Vhdl, convert
from tests.depth import by_depth

# A product of two primes of 31 bits: to decide whether the output is ever 1 is to factor it.
PRODUCT = 1500450271 * 1836311903
TASK = ProofTask(distro="lyrical", name="std_msgs/msg/Bool", direction="serializer")


def rtlil_of(*, is_zero: bool) -> str:
    a, b, out = Signal(31, name="a"), Signal(31, name="b"), Signal(name="out")
    m = Module()
    m.d.comb += out.eq(0 if is_zero else (a * b == PRODUCT) & (a > 1) & (b > 1))
    text: str = amaranth_rtlil.convert(m, name="top", ports=[a, b, out], emit_src=False)
    return text


def factors() -> tuple[str, Vhdl]:
    """Return a design that checks factors, and the VHDL of one whose output is always 0."""
    return rtlil_of(is_zero=False), convert(rtlil_of(is_zero=True), name="top")


@dataclass(frozen=True, slots=True, kw_only=True)
class ShortTimeouts(Tools):
    """Tools whose solvers have a limit of seconds; the other tools have no limit."""

    def run_ghdl(self, folder: Path, *arguments: str, timeout: float | None = None) -> str:
        return Tools.run_ghdl(self, folder, *arguments)

    def run_yosys(self, folder: Path, script: str, timeout: float | None = None) -> None:
        is_solver = "abc " in script or "sat " in script
        Tools.run_yosys(self, folder, script, by_depth(1, 2) if is_solver else None)


@pytest.fixture
def short_timeouts(tools: Tools) -> Tools:
    return ShortTimeouts(ghdl=tools.ghdl, yosys=tools.yosys)


@pytest.fixture(scope="module")
def proof_cache() -> dict[str, Proof]:
    """A cache for the proof, which takes as long as both solvers may take."""
    return {}


@pytest.fixture
def undecided(short_timeouts: Tools, proof_cache: dict[str, Proof]) -> Proof:
    if not proof_cache:
        proof_cache["factors"] = prove(*factors(), timeout=1, tools=short_timeouts)
    return proof_cache["factors"]


def test_claim_that_no_solver_decides_is_undecided(undecided: Proof) -> None:
    assert undecided.result == "undecided"
    assert (undecided.differences, undecided.counterexample) == (("output out",), {})
    lines = str(undecided).splitlines()
    assert lines[0].startswith("undecided (") and lines[1].strip() == "output out"


@pytest.mark.parametrize(
    ("results", "message", "status"),
    [
        (["equal", "undecided"], "1 equal, 1 undecided", 1),
        (["undecided", "equal"], "1 equal, 1 undecided", 1),
        (["undecided"] * 2, "2 undecided", 1),
        (["unequal", "undecided"], "1 undecided, 1 unequal", 1),
        (["equal"] * 2, "2 equal", 0),
        ([], "", 1),
    ],
)
def test_summary_and_status_count_each_kind_of_result(
    results: list[str],
    message: str,
    status: int,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    attempts = [
        Attempt(proof=Proof(result=result, registers=1, claims=1, seconds=1.0))  # type: ignore[arg-type]
        for result in results
    ]
    monkeypatch.setattr(command, "find_tools", lambda: None)
    monkeypatch.setattr(
        command, "run_tasks", lambda tasks, jobs: iter([(TASK, a) for a in attempts])
    )
    assert command.run_proofs([TASK] * len(attempts), 1, with_summary=True) == status
    out = capsys.readouterr().out.splitlines()
    head = f"{len(results)} converters of {len({*results} and {1})} types: {message}"
    assert head in out
    assert [line.split()[0] for line in out[: len(results)]] == results


# Without tools: every way in which the two solvers can end.

CLAIMS = 7
SUCCESS = "SAT proof finished - no model found: SUCCESS!\n"
FOUND = "SAT proof finished - model found: FAIL!\n"


class Solvers:
    """Fake solvers: ABC leaves claims or fails; then the SAT solver gives the answers in order.

    `asked` has the number of claims of each call of the SAT solver.
    """

    def __init__(self, left: list[int] | Exception, *answers: str | Exception) -> None:
        self.left, self.answers = left, list(answers)
        self.asked: list[int] = []

    def run_yosys(self, folder: Path, script: str, timeout: float | None = None) -> None:
        if "abc " in script:
            if isinstance(self.left, Exception):
                raise self.left
            bits = ["x" if n in self.left else "0" for n in range(CLAIMS)]
            answer = {"modules": {"miter": {"ports": {"differs": {"bits": bits}}}}}
            (folder / "answer.json").write_text(json.dumps(answer))
            return
        rest = json.loads((folder / "rest.json").read_text())["modules"]["miter"]
        self.asked.append(len(rest["ports"]["differs"]["bits"]))
        answer = self.answers.pop(0)
        if isinstance(answer, Exception):
            raise answer
        (folder / "sat.txt").write_text(answer)
        wave = [{"name": "differs", "wave": "1"}, {"name": "amaranth0", "wave": "1"}]
        (folder / "model.json").write_text(json.dumps({"signal": wave}))


def some_miter() -> Miter:
    claims = tuple(
        Claim(what=f"output o{n}", amaranth=(n + 2,), vhdl=("0",)) for n in range(CLAIMS)
    )
    return Miter(
        differences=(),
        claims=claims,
        inputs={"input i": tuple(range(2, CLAIMS + 2))},
        cells=[],
        unmatched=(),
        registers=0,
    )


SLOW = TooSlowError("Yosys was stopped after 1 s")
ALL = list(range(CLAIMS))


@pytest.mark.parametrize(
    ("left", "answers", "equal", "asked"),
    [
        ([], [], True, []),
        ([2], [SUCCESS], True, [1]),
        ([2], [FOUND], False, [1]),
        ([2], ["Interrupted SAT solver: TIMEOUT!\n"], None, [1]),
        ([2], [""], None, [1]),
        ([2], [SLOW], None, [1]),
        (ALL, [SUCCESS, SUCCESS], True, [4, 3]),
        (ALL, [SUCCESS, FOUND], False, [4, 3]),
        (ALL, [SUCCESS, SLOW], None, [4, 3]),
        (ALL, [FOUND], False, [4]),
        (ALL, [SLOW], None, [4]),
        # If the first solver does not end, all claims are left.
        (SLOW, [SUCCESS, SUCCESS], True, [4, 3]),
        (SLOW, [SUCCESS, FOUND], False, [4, 3]),
        (SLOW, [SLOW], None, [4]),
    ],
)
def test_only_what_a_solver_proved_is_equal(
    left: list[int] | Exception,
    answers: list[str | Exception],
    equal: bool | None,
    asked: list[int],
    tmp_path: Path,
) -> None:
    tools = Solvers(left, *answers)
    verdict = solve(some_miter(), tools, tmp_path, 1)
    assert (verdict.equal, tools.asked) == (equal, asked)
    first = 0 if left == ALL or isinstance(left, Exception) else 2
    names = [f"output o{n}" for n in (range(4, 7) if len(asked) == 2 else [first, *range(1, 4)])]
    if equal is None:
        assert list(verdict.open) == names[: asked[-1]]
    if equal is False:
        assert verdict.difference is not None
        (where,) = verdict.difference.where
        assert where.startswith(f"{names[0]} is 0x1 in the RTLIL and 0x0 in the VHDL")


def test_a_difference_names_the_claims_that_fail_and_the_inputs(tmp_path: Path) -> None:
    # The highest bit comes first; what is unknown is taken for 0. A single bit has no data.
    values = {"differs": "1x10", "in0": "00x0110", "amaranth1": "1", "vhdl1": "x", "vhdl3": "1"}
    inputs = {**some_miter().inputs, "register r": (20, 21), "anything": (22,)}
    values |= {"in1": "00"}

    class Found(Solvers):
        def run_yosys(self, folder: Path, script: str, timeout: float | None = None) -> None:
            super().run_yosys(folder, script, timeout)
            wave = [
                {"name": name, "wave": bits}
                if len(bits) == 1
                else {"name": name, "wave": "=", "data": [bits]}
                for name, bits in values.items()
            ]
            (folder / "model.json").write_text(json.dumps({"signal": wave}))

    verdict = solve(replace(some_miter(), inputs=inputs), Found([1, 2, 5, 6], FOUND), tmp_path, 1)
    assert verdict.difference is not None
    assert verdict.difference.where == (
        "output o2 is 0x1 in the RTLIL and 0x0 in the VHDL",
        "output o6 is 0x0 in the RTLIL and 0x1 in the VHDL",
    )
    assert verdict.difference.inputs == {"input i": 0b110}


@pytest.mark.parametrize("bits", [[], ["0"] * (CLAIMS - 1), ["0"] * (CLAIMS + 1)])
def test_an_answer_about_other_claims_is_none(bits: list[str], tmp_path: Path) -> None:
    class Other(Solvers):
        def run_yosys(self, folder: Path, script: str, timeout: float | None = None) -> None:
            answer = {"modules": {"miter": {"ports": {"differs": {"bits": bits}}}}}
            (folder / "answer.json").write_text(json.dumps(answer))

    with pytest.raises(ProofError, match=rf"returned {len(bits)} claims instead of {CLAIMS}"):
        solve(some_miter(), Other([]), tmp_path, 1)


@pytest.mark.parametrize(
    ("message", "match"),
    [
        ("ERROR: Found 1 problems in 'check -assert'.", "combinational loop"),
        ("ERROR: out of memory", "out of memory"),
    ],
)
def test_a_tool_that_fails_proves_nothing(message: str, match: str, tmp_path: Path) -> None:
    with pytest.raises(ProofError, match=match):
        solve(some_miter(), Solvers(ToolError(message)), tmp_path, 1)
