"""Scores of mutants, and explanations of survivors."""

from __future__ import annotations

from tests.depth import by_depth
from tests.mutation.test_tool import MODULE, ROOT
from tools.mutation.explained import Explanation, explain, read_explanations
from tools.mutation.mutants import identify
from tools.mutation.report import markdown
from tools.mutation.results import Record, append, read
from tools.mutation.rules.python_rules import changes
from tools.mutation.targets import all_mutants
from tools.mutation.workshop import Run


def test_an_explanation_is_of_one_change_wherever_it_is(tmp_path):
    out = tmp_path / "out.jsonl"
    (mutant, *_) = identify("firm_hdl/wire/toy.py", "wire", MODULE, changes(MODULE))
    runs = {"rest": Run(status="passed", by="", cpu_seconds=1.0)}
    record = Record.of(mutant, runs, tests=1, complete=True, tree="a")
    append(out, record)
    assert list(read(out).values()) == [record]
    given = {name: getattr(record, name) for name in ("path", "scope", "rule", "old", "new")}
    known = [Explanation(**given, kind="cost", why="It is as good.")]
    assert explain(record, known) is known[0]
    assert "Survivors with" in markdown([record], known, "a")
    other = [Explanation(**{**given, "new": "return 1"}, kind="cost", why="It is as good.")]
    assert explain(record, other) is None
    assert "Survivors without" in markdown([record], other, "a")
    assert "1 of these were found before files changed" in markdown([record], other, "b")


def test_scores_are_shares_of_all_mutants_and_of_those_without_an_explanation():
    mutants = identify("firm_hdl/wire/toy.py", "wire", MODULE, changes(MODULE))[:5]
    statuses = ["failed", "failed", "passed", "passed", "timeout"]
    records = [
        Record.of(
            mutant,
            {"rest": Run(status=status, by="", cpu_seconds=1.0)},
            tests=1,
            complete=True,
            tree="a",
        )
        for mutant, status in zip(mutants, statuses, strict=True)
    ]
    given = {name: getattr(records[2], name) for name in ("path", "scope", "rule", "old", "new")}
    known = [Explanation(**given, kind="equivalent", why="It is the same.")]
    table = [line.split(" | ") for line in markdown(records, known, "a").splitlines()]
    (row, *_) = (cells for cells in table if cells[0] == "| all")
    assert row[1:3] == ["5", "3"] and row[-2:] == ["60.0 %", "75.0 % |"]


def test_explanations_are_of_existing_mutants():
    # Those of one file in sixteen take seconds, too.
    paths = {*sorted({each.path for each in read_explanations()})[:: by_depth(16, 1)]}
    explanations = [each for each in read_explanations() if each.path in paths]
    mutants = all_mutants(ROOT, only=paths)
    there = {(m.path, m.change.scope, m.change.rule, m.place.old, m.place.new) for m in mutants}
    for each in explanations:
        assert (each.path, each.scope, each.rule, each.old, each.new) in there, each
        assert each.why
