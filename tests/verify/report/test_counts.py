"""Every figure of a report, with a different number for each figure.

If all counts were 1, swapped columns and missing tests would not be found.
"""

from __future__ import annotations

import json
import re

import pytest

from firm_hdl.cli import main
from firm_hdl.verify.report import markdown as markdown_writer
from firm_hdl.verify.report.command import FORMATS
from firm_hdl.verify.report.outcomes import Counts, count, outcomes_of
from firm_hdl.verify.report.prose import facts, shown_packages, shown_tests
from firm_hdl.verify.report.stats import box_of, curve_of, share_within
from firm_hdl.verify.report.summary import summarise
from firm_hdl.verify.report.tables import (
    circuits_table,
    coverage_table,
    cut,
    every_table,
    group_table,
    oracle_table,
    stage_table,
    within_table,
)
from firm_hdl.verify.results.file import ResultsWriter
from firm_hdl.verify.results.records import OracleVerdict, PlanCoverage, Seconds
from firm_hdl.verify.results.verdict import Failed, NotJudged, Passed
from tests.verify.report.samples import VERDICTS, a_record, a_test, mixed, run_of

ALL = {"passed": 2, "known": 3, "failed": 5, "not_judged": 7, "not_run": 11}


def rows(table):
    return [[cell.text for cell in row] for row in table.rows]


def test_every_verdict_is_counted():
    counts = count(outcomes_of([mixed(**ALL)]))
    assert counts == Counts(**ALL) and counts.total == 28
    found = json.loads(FORMATS["json"](summarise({"r": mixed(**ALL)})))
    assert found["counts"] == ALL and found["verdict"] == "failed"
    assert len(found["outcomes"]) == 28 and len(found["failed"]) == 5
    assert len(found["not_run"]) == 11


@pytest.mark.parametrize(
    ("counts", "verdict"),
    [
        ({}, "not run"),
        ({"passed": 1}, "passed"),
        ({"known": 1}, "known difference"),
        ({"not_judged": 1}, "not judged"),
        ({"not_run": 1}, "not run"),
        ({"failed": 1}, "failed"),
        ({"passed": 9, "failed": 1}, "failed"),
        ({"passed": 9, "not_run": 1}, "not run"),
        ({"passed": 9, "known": 1}, "passed"),
        ({"passed": 1, "not_judged": 9}, "passed"),
        ({"known": 1, "not_judged": 9}, "known difference"),
        ({"known": 9, "not_run": 1}, "not run"),
        ({"not_run": 9, "failed": 1}, "failed"),
        ({"not_judged": 9, "failed": 1, "not_run": 1}, "failed"),
    ],
)
def test_the_worst_decides(counts, verdict):
    assert Counts(**counts).verdict == verdict
    # Each format has the same figures.
    found = json.loads(FORMATS["json"](summarise({"r": mixed(**counts)})))
    assert found["verdict"] == verdict
    line = next(line for line in FORMATS["md"](summarise({"r": mixed(**counts)})).splitlines()
                if line.startswith("**"))  # fmt: skip
    sign = {"passed": "✓", "failed": "✗", "not run": "?"}.get(verdict)
    if sign:
        assert line.startswith(f"**{sign} ")
    else:
        assert "✓" not in line and "✗" not in line


def test_columns_have_the_counts_of_their_headings():
    summary = summarise({"r": mixed(**ALL)})
    table = group_table(summary.by_suite, "Test system")
    (row,) = rows(table)
    shown = dict(zip((name.rstrip("#") for name in table.headings), row, strict=True))
    suite = shown.pop("Test system")
    assert suite == "ts3, python, 8-byte bus"
    assert {name: shown[name] for name in shown if shown[name].isdigit()} == {
        "Passed": "2", "Known difference": "3", "Failed": "5", "Not judged": "7", "Not run": "11"
    }  # fmt: skip


def test_groups_differ_in_each_of_their_keys():
    tests = [
        a_test("a_msgs/msg/A", bus_bytes=8, distro="iron", same=("humble", "iron")),
        a_test("a_msgs/msg/A", bus_bytes=4, distro="iron", same=("iron",)),
        a_test("a_msgs/msg/B", bus_bytes=8, simulator="ghdl", distro="iron", same=("iron",)),
        a_test("b_msgs/msg/B", bus_bytes=8, distro="iron", same=("iron",)),
    ]
    summary = summarise(
        {"r": run_of(*(a_record(t, cpu_seconds=n + 1.0) for n, t in enumerate(tests)))}
    )
    eight, four, ghdl = (
        f"ts3, {s}, {b}-byte bus" for s, b in (("python", 8), ("python", 4), ("ghdl", 8))
    )
    assert {g.labels: (g.counts.total, g.cpu_seconds) for g in summary.by_suite} == {
        (eight,): (2, 5.0), (four,): (1, 2.0), (ghdl,): (1, 3.0)
    }  # fmt: skip
    assert {g.labels: g.counts.total for g in summary.by_distro} == {
        (eight, "humble"): 1, (eight, "iron"): 2, (four, "iron"): 1, (ghdl, "iron"): 1
    }  # fmt: skip
    assert {g.labels[1:]: g.cpu_seconds for g in summary.by_package if g.labels[0] == eight} == {
        ("humble", "a_msgs"): 1.0, ("iron", "a_msgs"): 1.0, ("iron", "b_msgs"): 4.0
    }  # fmt: skip


def test_a_failure_counts_in_whatever_order_files_come():
    good, bad = (a_record(verdict=VERDICTS[name]) for name in ("passed", "failed"))
    other = a_record(a_test("b/msg/B"))
    for files in (
        [run_of(good), run_of(bad)],
        [run_of(bad), run_of(good)],
        [run_of(good), run_of(bad), run_of(good)],
        [run_of(other), run_of(bad, other), run_of(good)],
    ):
        outcomes = {o.test.type: o.verdict.name for o in outcomes_of(files)}
        assert outcomes["std_msgs/msg/Header"] == "failed"
        assert outcomes.get("b/msg/B", "passed") == "passed"


@pytest.mark.parametrize("form", list(FORMATS))
def test_every_failure_is_named(form):
    records = [
        a_record(a_test(f"m/msg/T{n}"), verdict=Failed((f"reason {n};", f"more of {n};")))
        for n in range(45)
    ]
    text = FORMATS[form](summarise({"r": run_of(*records)}))
    for number in range(45):
        assert f"reason {number};" in text, number
        assert f"m/msg/T{number}" in text.replace("\\", "")
    # The first ones have all details.
    assert all(f"more of {number};" in text for number in (0, 1))


def test_failures_of_a_cut_list_are_the_next_ones(monkeypatch):
    monkeypatch.setattr(markdown_writer, "MOST_FAILURES", 2)
    records = [a_record(a_test(f"m/msg/T{n}"), verdict=Failed((f"reason {n};",))) for n in range(5)]
    text = FORMATS["md"](summarise({"r": run_of(*records)}))
    assert [n for n in range(5) if f"### m/msg/T{n}" in text.replace("\\", "")] == [0, 1]
    assert "3 more tests failed" in text and all(f"reason {n};" in text for n in range(5))


def test_long_lists_keep_tests_that_did_not_pass():
    run = mixed(passed=6, known=2, failed=2, not_judged=2, not_run=2)
    shown, rest = shown_tests(summarise({"r": run}), 5)
    names = [outcome.verdict.name for outcome in shown]
    assert names[:4] == ["failed"] * 2 + ["not run"] * 2 and "passed" not in names
    assert rest.startswith("and 9 more")
    groups, rest = shown_packages(summarise({"r": run}), 4)
    assert "passed_msgs" not in {group.labels[-1] for group in groups} and "more" in rest
    # Of tests of the same kind, the slowest.
    slow = [a_record(a_test(f"m/msg/T{n}"), seconds=Seconds(testing=float(n))) for n in range(6)]
    shown, _ = shown_tests(summarise({"r": run_of(*slow)}), 2)
    assert [outcome.test.type for outcome in shown] == ["m/msg/T5", "m/msg/T4"]
    table = every_table(summarise({"r": run_of(*slow)}).outcomes)
    first, rest = cut(table, 2)
    assert [row[0].text for row in first.rows] == ["m/msg/T0", "m/msg/T1"] and rest == "and 4 more"
    assert cut(table, 6) == (table, "")


def test_coverage_is_full_where_all_was_taken():
    figures = [(5, 5), (4, 5), (9, 10), (7, 7), (0, 3)]
    records = [
        a_record(a_test(f"m/msg/T{n}"), coverage=PlanCoverage(taken=t, possible=p))
        for n, (t, p) in enumerate(figures)
    ]
    records.append(a_record(a_test("m/msg/None"), coverage=None))
    summary = summarise({"r": run_of(*records)})
    (row,) = rows(coverage_table(summary))
    assert row[1:] == ["5", "2", "25", "30", "83.3%"]
    assert [o.test.type[-2:] for o in summary.uncovered] == ["T1", "T2", "T4"]
    assert "83.33%" in [figure for figure, what in facts(summary) if what == "plan coverage"]


def test_circuits_and_types_are_counted_once():
    shapes = ["a", "b", "b", "c"]
    records = [
        a_record(a_test(f"m/msg/T{n}", system=system), shape=shape)
        for system in ("ts2", "ts3")
        for n, shape in enumerate(shapes)
    ]
    twin = a_test("n/msg/Twin", distro="noetic", same=("noetic",))
    records.append(a_record(twin, same_as=records[-1].test.key, shape="c"))
    summary = summarise({"r": run_of(*records)})
    assert {row[0][:3]: row[1:] for row in rows(circuits_table(summary))} == {
        "ts2": ["3", "0"], "ts3": ["3", "1"]
    }  # fmt: skip
    said = {what: figure for figure, what in facts(summary)}
    assert (said["tests"], said["types"], said["different circuits"]) == ("9", "5", "3")


def test_times_are_in_their_columns():
    seconds = [Seconds(generation=1.0 * n, simulation=10.0 * n) for n in range(1, 6)]
    records = [
        a_record(a_test(f"m/msg/T{n}"), seconds=each, cpu_seconds=100.0)
        for n, each in enumerate(seconds)
    ]
    summary = summarise({"r": run_of(*records)})
    table = stage_table(summary.curves)
    found = {row[1].text: [cell.value for cell in row[2:]] for row in table.rows}
    assert found["generation"] == pytest.approx([1, 2, 3, 4, 4.8, 5, 15])
    assert found["all stages"] == pytest.approx([11, 22, 33, 44, 52.8, 55, 165])
    assert found["processor"] == pytest.approx([100.0] * 6 + [500.0])
    every = every_table(summary.outcomes)
    place = every.headings.index("Time#")
    assert every.headings[place + 1] == "CPU#"
    assert next((row[place].value, row[place + 1].value) for row in every.rows) == (11.0, 100.0)
    # Shares within a limit include the limit itself.
    values = [0.1, 0.2, 0.2, 0.5, 3]
    assert [share_within(values, limit) for limit in (0.05, 0.1, 0.2, 0.5, 3)] == [
        0, 0.2, 0.6, 0.8, 1
    ]  # fmt: skip
    (row,) = rows(within_table(summary.curves))
    assert row[1] == "5" and row[-3:] == ["0.0%", "20.0%", "100.0%"]
    box = box_of([float(n) for n in range(101)])
    assert (box.q1, box.median, box.q3, box.p95) == (25, 50, 75, 95)
    assert curve_of([3.0]) == [(3.0, 1.0)]


def test_tests_that_took_no_time_have_no_part_in_times():
    idle = a_record(a_test("m/msg/Idle"), seconds=Seconds(), cpu_seconds=0.0)
    none = a_record(a_test("m/msg/No"), verdict=NotJudged("no"), seconds=Seconds(testing=9.0))
    busy = a_record(a_test("m/msg/Busy"), seconds=Seconds(testing=2.0))
    (curve,) = summarise({"r": run_of(idle, none, busy)}).curves
    assert curve.seconds.count == 1 and curve.seconds.most == 2.0
    assert summarise({"r": run_of(idle)}).curves == ()


def test_slowest_and_most_complex_come_first():
    records = [
        a_record(
            a_test(f"m/msg/T{n}"),
            seconds=Seconds(testing=float(n + 1)),
            metrics={"leaves": 40 - n, "steps": 40 - n},
        )
        for n in range(20)
    ]
    summary = summarise({"r": run_of(*records)})
    assert [o.test.type for o in summary.slowest] == [f"m/msg/T{n}" for n in range(19, 4, -1)]
    assert [o.test.type for o in summary.most_complex] == [f"m/msg/T{n}" for n in range(15)]


def written(path, run):
    with ResultsWriter(path, options=run.options, planned=run.planned) as writer:
        for record in run.records.values():
            writer.add(record)
    return str(path)


def test_command_takes_all_files_its_title_and_its_format(tmp_path, capsys):
    one = written(tmp_path / "1.jsonl", run_of(a_record(a_test("m/msg/One"))))
    bad = a_record(a_test("m/msg/Two"), verdict=VERDICTS["failed"])
    two = written(tmp_path / "2.jsonl", run_of(bad))
    for files in ([one, two], [two, one]):
        assert main(["report", *files, "--format", "json", "--title", "Mine"]) == 0
        found = json.loads(capsys.readouterr().out)
        assert found["title"] == "Mine" and found["counts"]["failed"] == 1
        assert found["counts"]["passed"] == 1
        assert {run["name"] for run in found["runs"]} == {one, two}
    assert main(["report", one, "--title", "Mine"]) == 0
    assert capsys.readouterr().out.startswith("# Mine\n")
    # The option has priority over the file name.
    out = tmp_path / "report.html"
    assert main(["report", one, "--out", str(out), "--format", "json", "--title", "Mine"]) == 0
    assert json.loads(out.read_text())["title"] == "Mine"


def test_no_text_ends_the_block_that_it_is_in():
    for ticks in ("```", "````", "``` ````` ```"):
        verdict = Failed((f"before\n{ticks}\n# after",))
        text = FORMATS["md"](summarise({"r": run_of(a_record(verdict=verdict))}))
        (fence,) = re.findall(r"(?m)^(`{3,})\nbefore$", text)
        assert fence not in ticks
        assert "\n# after\n" + fence in text


def definition(name, verdict, is_refused=False, oracle="genmsg"):
    """Return a record of TS1 with the verdict of one oracle."""
    said = OracleVerdict(oracle=oracle, verdict=verdict, is_refused=is_refused)
    test = a_test(name, system="ts1", simulator="", wire="", bus_bytes=0, options="")
    return a_record(test, verdicts=(said,), coverage=None, shape="", metrics={})


def test_verdicts_of_oracles_are_in_their_columns():
    records = [
        definition(f"m/msg/{name}{n}", VERDICTS[name])
        for name, number in (("passed", 2), ("known", 3), ("failed", 5), ("not_judged", 7))
        for n in range(number)
    ]
    records += [definition(f"m/msg/Refused{n}", Passed(1), is_refused=True) for n in range(4)]
    summary = summarise({"r": run_of(*records)})
    table = oracle_table(summary)
    (row,) = rows(table)
    shown = dict(zip((heading.rstrip("#") for heading in table.headings), row, strict=True))
    assert shown == {
        "Distribution": "lyrical", "Oracle": "genmsg", "Agree": "6", "Of these, both refuse": "4",
        "Known difference": "3", "Differ": "5", "Not judged": "7",
    }  # fmt: skip
    found = json.loads(FORMATS["json"](summary))["oracles"][0]
    assert (found["agree"], found["refused"], found["known"]) == (6, 4, 3)
    assert (found["differ"], found["not_judged"]) == (5, 7)


def test_the_most_frequent_word_of_an_oracle_comes_first():
    reasons = ["it has 3 levels", "m/msg/X is odd", "it has 12,345 levels", "n/msg/Y is odd",
               "nobody is here", "it has 1.5 levels"]  # fmt: skip
    records = [definition(f"m/msg/T{n}", NotJudged(reason)) for n, reason in enumerate(reasons)] + [
        definition("m/msg/Z", NotJudged("nobody is here"), oracle="a")
    ]
    # A type of two distributions counts as two definitions.
    for distro in ("iron", "jazzy"):
        test = a_test("m/msg/Z", system="ts1", distro=distro, same=(distro,))
        records.append(a_record(test, verdicts=records[-1].verdicts))
    said = summarise({"r": run_of(*records)}).said
    assert [(s.oracle, s.what, s.count, s.example) for s in said] == [
        ("a", "nobody is here", 3, "m/msg/Z"),
        ("genmsg", "it has 3 levels", 3, "m/msg/T0"),
        ("genmsg", "m/msg/X is odd", 2, "m/msg/T1"),
        ("genmsg", "nobody is here", 1, "m/msg/T4"),
    ]


def test_a_later_file_counts_unless_an_earlier_one_failed():
    def outcome(*verdicts):
        files = [run_of(a_record(a_test("p/msg/T"), verdict=each)) for each in verdicts]
        (found,) = outcomes_of(files)
        return found.verdict

    passed, failed, silent = Passed(1), Failed(("no",)), NotJudged("nobody")
    assert outcome(silent, passed) == passed
    assert outcome(passed, silent) == silent
    assert outcome(Passed(1), Passed(2)) == Passed(2)
    assert outcome(passed, failed) == outcome(failed, passed) == failed
    assert outcome(failed, Failed(("later",))) == failed
