# amaranth: UnusedElaboratable=no
"""What a proof says: from the answers of the solvers, which are fakes here, to the exit status."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from firm_hdl import load_message
from firm_hdl.equivalence import Proof, ProofError, Tools, converters, proof, prove
from firm_hdl.equivalence.converters import ProofTask, attempt, converter_vhdl
from firm_hdl.equivalence.miter import Claim, Miter
from firm_hdl.equivalence.solve import Answer, Difference
from firm_hdl.export.top import DIRECTIONS
from firm_hdl.jobs import ToolError
from firm_hdl.vhdl.convert import Vhdl

NO_TOOLS = Tools(ghdl=(), yosys=())
VHDL = Vhdl(top="top", files={}, entities={})
MITER = Miter(
    differences=(),
    claims=tuple(Claim(what=f"output o{n}", amaranth=(2,), vhdl=(3,)) for n in range(3)),
    inputs={},
    cells=[],
    unmatched=("only", "here"),
    registers=5,
)
WRONG = Difference(where=("output o1 is 0x2", "output o2 is 0x0"), inputs={"input i": 26})


@pytest.mark.parametrize(
    ("answer", "said", "lines"),
    [
        (Answer(equal=True), ("equal", (), {}), []),
        (
            Answer(equal=None, open=("output o0", "output o2")),
            ("undecided", ("output o0", "output o2"), {}),
            ["output o0", "output o2", "without a partner: only, here"],
        ),
        (
            Answer(equal=False, difference=WRONG),
            ("unequal", WRONG.where, WRONG.inputs),
            [*WRONG.where, "for", "input i = 0x1a", "without a partner: only, here"],
        ),
    ],
)
def test_a_proof_says_what_the_solvers_found(monkeypatch, answer, said, lines) -> None:
    asked = []
    monkeypatch.setattr(proof, "_miter", lambda *given: asked.append(given[-1]) or MITER)
    monkeypatch.setattr(proof, "solve", lambda *given: asked.append(given[-1]) or answer)
    found = prove("rtlil", VHDL, tools=NO_TOOLS, timeout=7.5)
    assert (found.result, found.differences, found.counterexample) == said
    assert (found.registers, found.claims, found.unmatched) == (5, 3, ("only", "here"))
    assert asked == [7.5, 7.5]
    first, *others = str(replace(found, seconds=2.25)).splitlines()
    equal = "equal (5 bits of registers, 2.2 s)"
    assert first == (equal if found.result == "equal" else f"{found.result} (2.2 s)")
    assert [line.strip() for line in others] == lines


def test_what_differs_without_a_solver_is_unequal(monkeypatch) -> None:
    differs = replace(MITER, differences=("only one side has the input a",))
    monkeypatch.setattr(proof, "_miter", lambda *given: differs)
    monkeypatch.setattr(proof, "solve", lambda *given: Answer(equal=True))
    found = prove("rtlil", VHDL, tools=NO_TOOLS)
    assert (found.result, found.differences) == ("unequal", differs.differences)


def test_an_error_of_a_tool_is_an_error_of_the_proof(tmp_path: Path) -> None:
    class Broken(Tools):
        def run_ghdl(self, folder: Path, *arguments: str, timeout: float | None = None) -> str:
            assert timeout == 3
            raise ToolError("GHDL failed: it is broken")

    with pytest.raises(ProofError, match=r"^GHDL failed: it is broken$"):
        prove("rtlil", VHDL, tools=Broken(ghdl=(), yosys=()), timeout=3)


TASK = ProofTask(distro="noetic", name="std_msgs/String", direction="serializer")
GIVEN = {"wire": "cdr", "bus_bytes": 4, "max_message_bytes": 1000}


@pytest.mark.parametrize("direction", ["deserializer", "serializer"])
def test_a_task_reaches_the_solvers_with_all_its_options(monkeypatch, direction) -> None:
    equal = Proof(result="equal", registers=1, claims=1, seconds=1.0)
    asked = []
    monkeypatch.setattr(
        converters, "converter_vhdl", lambda *given, **options: (("rtlil", *given, options), VHDL)
    )
    monkeypatch.setattr(
        converters, "prove", lambda *given, **options: asked.append((*given, options)) or equal
    )
    task = replace(TASK, direction=direction, timeout=7, **GIVEN)
    assert attempt(task).proof is equal
    message = load_message("std_msgs/String", distro="noetic")
    assert asked == [(("rtlil", message, direction, GIVEN), VHDL, {"timeout": 7})]


def test_the_converter_has_the_options() -> None:
    message = load_message("std_msgs/String", distro="noetic")
    for direction in DIRECTIONS:
        rtlil, vhdl = converter_vhdl(message, direction, **GIVEN)
        assert vhdl.top == f"std_msgs_string_cdr_4_{direction}_flat"
        assert f"module \\{vhdl.top}\n" in rtlil
        ports = vhdl.entities[vhdl.top].ports
        assert ("s_axis_tdata" in ports) == (direction == "deserializer")
        assert "wire width 32 " in rtlil and "axis_tdata" in rtlil
    # A limit of a length is a number in the circuit.
    assert converter_vhdl(message, "serializer", **{**GIVEN, "max_message_bytes": 999})[0] != rtlil


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        ({"name": "std_msgs/Strin"}, "type 'Strin' is not defined in package 'std_msgs'"),
        ({"max_message_bytes": 3}, "Maximum message size must be from 4 bytes"),
    ],
)
def test_a_converter_that_there_is_not_is_a_problem(changes, problem) -> None:
    found = attempt(replace(TASK, **changes))
    assert found.proof is None and found.result == "failed"
    assert problem in found.problem
