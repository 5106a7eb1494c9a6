"""What becomes of a type that was sent through a board: its record, and what is printed."""

from __future__ import annotations

import pytest

from firm_hdl.cases import NotJudgedError
from firm_hdl.errors import DefinitionError, Diagnostic, UserError
from firm_hdl.verify.board import system
from firm_hdl.verify.board.system import Boards
from firm_hdl.verify.results.verdict import Failed, NotJudged, Passed
from firm_hdl.verify.systems.options import Request
from tests.node.bridge.fakes import FakeBoard
from tests.verify.board.fakes import BOTH, STRING, LoopNode, described

ONE = described(STRING)


def records_of(monkeypatch, judge_loop, description=ONE, **given):
    """Return the records of a run in which something else judges each type."""
    monkeypatch.setattr(system, "judge_loop", judge_loop)
    request = Request(**{"board": "fake", "references": (), **given})
    with Boards(description, request, FakeBoard(LoopNode(description))) as boards:
        return boards.run(None)


def judges_well(talk, description, loop, options, trial):
    record, trial.judged = trial.record, 4
    record.cases, record.packets = 3, 9
    record.metrics, record.shape = {"leaves": 2.0}, "a shape"
    record.note, record.written_by = "a remark", ("rosbags", "genpy")
    trial.watch.enter("simulation")


def test_a_record_has_all_that_was_found(monkeypatch, capsys):
    (record,) = records_of(monkeypatch, judges_well)
    assert (record.verdict, record.note, record.shape) == (Passed(4), "a remark", "a shape")
    assert (record.cases, record.packets, record.metrics) == (3, 9, {"leaves": 2.0})
    assert record.written_by == ("rosbags", "genpy")
    assert record.seconds.generation > 0 and record.seconds.simulation > 0
    assert record.seconds.testing == 0
    printed = capsys.readouterr().out.splitlines()
    assert f"note: {STRING} (lyrical): a remark" in printed
    assert "lyrical     1 of    1 types pass (8-byte bus)" in printed
    assert any(line.startswith("9 packets, 0 failures in ") for line in printed)


@pytest.mark.parametrize(
    ("error", "verdict"),
    [
        (NotJudgedError("nobody can"), NotJudged("nobody can")),
        # A reason is never blank.
        (NotJudgedError(), NotJudged("NotJudgedError")),
        (KeyError("x"), Failed(("KeyError: 'x'",))),
    ],
)
def test_what_goes_wrong_with_one_type_does_not_end_the_run(monkeypatch, capsys, error, verdict):
    def judge_loop(talk, description, loop, options, trial):
        if loop[0].type == STRING:
            judges_well(talk, description, loop, options, trial)
            return
        raise error

    records = records_of(monkeypatch, judge_loop, described(*BOTH))
    assert [each.verdict for each in records] == [verdict, Passed(4)]
    # Nothing was written before the error.
    assert records[0].written_by == () and records[0].cases == 0
    printed = capsys.readouterr().out
    assert ("again: firm-hdl verify" in printed) is isinstance(verdict, Failed)
    judged = 2 if isinstance(verdict, Failed) else 1
    assert f"lyrical     1 of    {judged} types pass (8-byte bus)\n" in printed


@pytest.mark.parametrize(
    "error", [UserError("the node"), DefinitionError([Diagnostic(message="the node")])]
)
def test_what_is_wrong_with_the_node_ends_the_run(monkeypatch, error):
    def judge_loop(*given):
        raise error

    with pytest.raises(type(error), match="the node"):
        records_of(monkeypatch, judge_loop)
