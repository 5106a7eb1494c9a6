"""What solvers and processes say is a proof only if it is one."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest

from firm_hdl.equivalence.tools import Tools
from firm_hdl.formal import command, solve
from firm_hdl.formal.solve import Answer, decide
from firm_hdl.jobs import ToolError, TooSlowError

KEY = "slice/order"


class Said(Tools):
    """A Yosys that writes what ABC would have said: the status, and the counterexample."""

    def __new__(cls, *texts: str):
        return super().__new__(cls)

    def __init__(self, *texts: str):
        super().__init__(ghdl=(), yosys=())
        object.__setattr__(self, "texts", texts)

    def run_yosys(self, folder: Path, script: str, timeout: float | None) -> str:
        for ending, text in zip(("status", "cex"), self.texts, strict=False):
            (folder / f"scene.2.{ending}").write_text(text, encoding="utf-8")
        return ""


@pytest.mark.parametrize(
    ("method", "status", "result"),
    [
        ("PDR", "snl_UNSAT 7 0", "proved"),
        # It gave up: an invariant that was not found proves nothing, whatever its frames.
        ("PDR", "snl_UNK 7 0", "undecided"),
        ("PDR", "snl_UNK 99 0", "undecided"),
        # Frames are counted from 0.
        ("BMC", "snl_UNK 9 0", "proved"),
        ("BMC", "snl_UNK 8 0", "undecided"),
        ("BMC", "snl_UNK -1 0", "undecided"),
        ("BMC", "snl_SAT 3 0 0 4", "broken"),
        ("PDR", "snl_SAT 3 0 0 4", "broken"),
    ],
)
def test_only_a_finished_search_is_a_proof(tmp_path, method, status, result):
    tools = Said(status, "go@0=1 n3@0=1 go@2=0 data[1]@4=1")
    answer = decide(tmp_path / "scene.aig", 2, tools, method=method, depth=10, timeout=1.0)
    assert answer.result == result
    if result == "broken":
        assert (answer.cycles, answer.inputs) == (5, "go@0 data[1]@4")


def test_a_solver_that_takes_too_long_or_says_nothing_proves_nothing(tmp_path):
    class Slow(Said):
        def run_yosys(self, *arguments: object) -> str:
            raise TooSlowError("slow")

    given = {"method": "PDR", "depth": 0, "timeout": 1.0}
    assert decide(tmp_path / "scene.aig", 2, Slow(), **given).result == "undecided"
    with pytest.raises(ToolError, match=r"did not write scene\.2\.status"):
        decide(tmp_path / "scene.aig", 2, Said(), **given)


@pytest.mark.parametrize("said", ["snl_UNSAT 7 0", "snl_SAT 3 0 0 4", "snl_UNK 7 0", None])
def test_every_answer_has_its_seconds(tmp_path, monkeypatch, said):
    class Slow(Said):
        def run_yosys(self, *arguments: object) -> str:
            raise TooSlowError("slow")

    clock = iter([100.0, 102.5])
    monkeypatch.setattr(solve, "time", SimpleNamespace(monotonic=lambda: next(clock)))
    tools = Slow() if said is None else Said(said, "go@0=1")
    answer = decide(tmp_path / "scene.aig", 2, tools, method="PDR", depth=0, timeout=1.0)
    assert answer.seconds == 2.5


@pytest.mark.parametrize(("method", "call"), [("PDR", "pdr,-T,70;"), ("BMC", "bmc3,-F,12,-T,70;")])
def test_the_solver_gets_its_claim_depth_and_time_and_yosys_more_time(tmp_path, method, call):
    asked = []

    class Asked(Said):
        def run_yosys(self, folder: Path, script: str, timeout: float | None) -> str:
            asked.append((script, timeout))
            return super().run_yosys(folder, script, timeout)

    tools = Asked("snl_UNK -1 0")
    decide(tmp_path / "scene.aig", 2, tools, method=method, depth=12, timeout=70.5)
    [(script, limit)] = asked
    assert f"read_aiger,scene.aig;cone,-O,2;scleanup;{call}" in script
    assert limit > 71


@pytest.mark.parametrize(
    ("answers", "status"),
    [
        ([Answer(result="proved")], 0),
        ([Answer(result="undecided")], 1),
        ([Answer(result="broken")], 1),
        # The process died, or gave no answer at all.
        ([Exception("BrokenProcessPool")], 1),
        ([], 1),
    ],
)
def test_a_proof_without_an_answer_is_no_success(answers, status, monkeypatch, capsys):
    monkeypatch.setattr(command, "find_tools", lambda **_: None)
    monkeypatch.setattr(
        command, "in_processes", lambda work, tasks, jobs: ((KEY, each) for each in answers)
    )
    assert command.main([KEY]) == status
    assert capsys.readouterr().err == ""
