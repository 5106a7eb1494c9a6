"""What counts for each part of a report, and what does not."""

from __future__ import annotations

import json
import math

import pytest

from firm_hdl.export.build import BuildError
from firm_hdl.verify.report import html, markdown
from firm_hdl.verify.report.as_json import to_json
from firm_hdl.verify.report.command import write_report
from firm_hdl.verify.report.outcomes import NotRun, outcomes_of
from firm_hdl.verify.report.stats import Correlation, Fit
from firm_hdl.verify.report.summary import Trend, summarise
from firm_hdl.verify.report.tables import (
    TableCell,
    coverage_table,
    every_table,
    group_table,
    oracle_table,
    trend_table,
    within_table,
)
from firm_hdl.verify.report.verdicts import reason_groups
from firm_hdl.verify.results.file import Results, ResultsWriter
from firm_hdl.verify.results.records import OracleVerdict, PlanCoverage, Seconds
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed
from tests.verify.report.samples import a_record, a_test


def run_of(*records, planned=()):
    tests = (*(record.test for record in records), *planned)
    return Results(planned=tests, records={record.test.key: record for record in records})


def test_a_record_counts_also_if_its_test_is_not_planned():
    record = a_record(verdict=Failed(("no",)))
    (outcome,) = outcomes_of([Results(records={record.test.key: record})])
    assert outcome.test == record.test and outcome.verdict == Failed(("no",))


def test_a_circuit_of_another_type_is_named_by_that_type_or_by_its_test_if_it_did_not_run():
    one = a_record(a_test("p/A"))
    twins = [a_record(a_test(f"p/{name}"), same_as=one.test.key) for name in "BC"]
    ran = outcomes_of([run_of(one, *twins)])
    assert [each.circuit_of for each in ran] == ["", "p/A", "p/A"]
    assert [each.verdict.name for each in ran] == ["passed"] * 3
    alone = outcomes_of([run_of(*twins)])
    assert [each.circuit_of for each in alone] == [one.test.key] * 2
    reason = f"has the circuit of {one.test.key}, which was not run"
    assert [each.verdict for each in alone] == [NotRun(reason)] * 2
    table = every_table(ran)
    at = table.headings.index("Circuit of")
    assert [row[at].text for row in table.rows] == ["", "p/A", "p/A"]


def test_reasons_are_grouped_without_names_and_numbers():
    reasons = ("p/A has 7 fields", "p/B has 1,234.5 fields", "nobody knows")
    tests = [a_test(f"p/T{number}") for number in range(3)]
    records = [
        a_record(test, verdict=NotJudged(reason))
        for test, reason in zip(tests, reasons, strict=True)
    ]
    missing = [a_test(f"q/T{number}") for number in range(4)]
    outcomes = outcomes_of([run_of(*records, planned=missing)])
    assert [(group.text, len(group.outcomes)) for group in reason_groups(outcomes)] == [
        (NotRun().reason, 4),
        ("p/A has 7 fields", 2),
        ("nobody knows", 1),
    ]
    by_package = reason_groups(outcomes, lambda outcome: f"of {outcome.test.package}")
    assert [(group.text, len(group.outcomes)) for group in by_package] == [("of q", 4), ("of p", 3)]


def test_notes_of_definitions_are_among_the_words_of_oracles_only():
    word = OracleVerdict(oracle="genmsg", verdict=NotJudged("it cannot read it"))
    noted = a_record(a_test("p/A"), note="a note")
    definition = a_record(a_test("p/B"), note="another note", verdicts=(word,))
    summary = summarise({"r": run_of(noted, definition, a_record(a_test("p/C")))})
    assert [each.test.type for each in summary.noted] == ["p/A"]
    assert [(each.what, each.example) for each in summary.said] == [("it cannot read it", "p/B")]


def test_a_stage_has_the_tests_that_it_took_time_of():
    records = [
        a_record(
            a_test(f"p/T{number}"),
            seconds=Seconds(generation=1.0 + number, testing=2.0 if number < 2 else 0.0),
            cpu_seconds=9.0 * (number > 0),
        )
        for number in range(4)
    ]
    silent = a_record(a_test("p/X"), verdict=NotJudged("no"), seconds=Seconds(generation=99.0))
    (curve,) = summarise({"r": run_of(*records, silent)}).curves
    assert {name: box.count for name, box in curve.stages.items()} == {
        "generation": 4,
        "testing": 2,
    }
    assert curve.stage_values == {"generation": (1.0, 2.0, 3.0, 4.0), "testing": (2.0, 2.0)}
    assert curve.seconds.count == 4 and curve.seconds.most == 4.0
    assert curve.cpu_seconds.count == 3 and curve.cpu_seconds.least == 9.0


def test_a_test_that_failed_took_its_time_like_any_other():
    failed = a_record(a_test("p/F"), verdict=Failed(("no",)), seconds=Seconds(testing=9.0))
    (curve,) = summarise({"r": run_of(failed, a_record(a_test("p/A")))}).curves
    assert curve.seconds.count == 2 and curve.seconds.most == 9.0


def test_trends_are_of_tests_with_a_circuit_and_a_figure():
    first = a_test("p/T0")
    records = [
        a_record(
            a_test(f"p/T{number}"),
            metrics={"leaves": number + 1.0} | ({"depth": number} if number else {}),
            seconds=Seconds(testing=1.0 + number * number),
            verdict=Passed(1),
        )
        for number in range(8)
    ]
    twin = a_record(
        a_test("p/Twin"), same_as=first.key, metrics={"leaves": 9.0}, seconds=Seconds(testing=7.0)
    )
    trends = {
        (trend.metric, trend.time): trend
        for trend in summarise({"r": run_of(*records, twin)}).trends
    }
    assert trends["leaves", "total"].correlation.count == 8
    # A test without the figure is left out; it is not one whose figure is 0.
    assert trends["depth", "total"].correlation.count == 7
    assert trends["depth", "total"].points == tuple((n, 1.0 + n * n) for n in range(1, 8))
    assert trends["depth", "testing"].points == ()
    assert ("depth", "simulation") not in trends


def test_trends_are_in_the_order_of_their_names():
    # By chance, a set of so many names hardly has this order.
    names = [f"{letter}_figure" for letter in "hbfdacge"]
    records = [
        a_record(
            a_test(f"p/T{number}"),
            metrics=dict.fromkeys(names, number + 1.0),
            seconds=Seconds(testing=1.0 + number),
        )
        for number in range(3)
    ]
    trends = summarise({"r": run_of(*records)}).trends
    found = [trend.metric for trend in trends if trend.time == "total"]
    assert found == sorted(names)


def test_known_differences_are_part_of_the_share_that_is_drawn():
    verdicts = (Passed(1), KnownDifference(("k",), 1), Failed(("no",)), NotJudged("no"))
    records = [a_record(a_test(f"p/T{n}"), verdict=each) for n, each in enumerate(verdicts)]
    table = group_table(summarise({"r": run_of(*records)}).by_suite, "Test system")
    (share,) = (cell for row in table.rows for cell in row if cell.counts is not None)
    assert share.value == 2 / 4


def test_an_oracle_that_differs_is_marked_and_no_other():
    words = {"one": Passed(1), "two": Failed(("no",))}
    verdicts = tuple(OracleVerdict(oracle=name, verdict=each) for name, each in words.items())
    table = oracle_table(summarise({"r": run_of(a_record(verdicts=verdicts))}))
    at = table.headings.index("Differ#")
    assert [(row[1].text, row[at].text, row[at].verdict) for row in table.rows] == [
        ("one", "0", ""),
        ("two", "1", "failed"),
    ]


def test_one_of_many_keeps_a_share_below_all():
    records = [
        a_record(
            a_test(f"p/T{number}"),
            seconds=Seconds(testing=0.005 if number else 30.0),
            coverage=PlanCoverage(taken=10 - (not number), possible=10),
        )
        for number in range(2500)
    ]
    summary = summarise({"r": run_of(*records)})
    shares = within_table(summary.curves).rows[0][2:]
    assert {cell.text for cell in shares[:-1]} == {"99.9%"} and shares[-1].text == "100.0%"
    assert shares[0].value == 2499 / 2500
    (row,) = coverage_table(summary).rows
    assert [cell.text for cell in row[1:]] == ["2,500", "2,499", "24,999", "25,000", "99.9%"]
    # A plan without decisions has taken all of them.
    empty = a_record(coverage=PlanCoverage(taken=0, possible=0))
    table = every_table(summarise({"r": run_of(empty)}).outcomes)
    assert table.rows[0][table.headings.index("Plan coverage#")].value == 1.0


def test_figures_of_a_trend_are_in_their_columns():
    found = Correlation(
        count=9,
        pearson=-0.25,
        spearman=0.5,
        linear=Fit(a=1.0, b=2.0, r2=0.75),
        power=Fit(a=3.0, b=4.0, r2=0.125),
    )
    trend = Trend(suite="ts3", metric="case_bytes", time="total", correlation=found, points=())
    (row,) = trend_table([trend]).rows
    assert [cell.text for cell in row] == [
        *("ts3", "case bytes", "total", "9", "+0.50", "-0.25"),
        *("3·x^4.00", "0.12", "1 + 2·x", "0.75"),
    ]
    assert [cell.value for cell in row[3:6]] == [9, 0.5, -0.25]
    # Columns are sorted by these.
    assert [row[7].value, row[9].value] == [0.125, 0.75]


def test_the_form_of_a_report_is_that_of_its_name_in_any_case(tmp_path):
    path, out = tmp_path / "r.jsonl", tmp_path / "R.JSON"
    with ResultsWriter(path, options={}, planned=[a_test()]):
        pass
    # A link stays, and its file is written.
    out.symlink_to("elsewhere")
    write_report([path], out)
    assert out.is_symlink() and (tmp_path / "elsewhere").read_text().startswith("{")
    with pytest.raises(BuildError, match="is one of the results; the report needs another name"):
        write_report([path], path, "md")


def test_a_bar_is_in_pages_only_and_a_number_may_have_a_colour():
    table = group_table(summarise({"r": run_of(a_record())}).by_suite, "Test system")
    written = markdown._table(table).splitlines()[0]
    assert "Share" in table.headings and "Share" not in written and "Result" in written
    assert 'class="n failed"' in html._cell(TableCell("1", 1.0, verdict="failed"))
    assert 'class="n"' in html._cell(TableCell("1", 1.0))
    # Numbers are sorted by more digits than they are shown with.
    assert 'data-v="1234.56789"' in html._cell(TableCell("1,235", 1234.56789))
    # A text is kept on one line if it is short, or if it is a verdict, whose colour it then has.
    assert html._cell(TableCell("x" * 39)) == f'<td class="t">{"x" * 39}</td>'
    assert html._cell(TableCell("x" * 40)) == f"<td>{'x' * 40}</td>"
    assert 'class="t not-judged"' in html._cell(TableCell("x" * 40, verdict="not judged"))


def test_a_record_in_json_names_its_test_once_and_no_figure_is_not_a_number():
    found = json.loads(to_json(summarise({"r": run_of(a_record())})))
    (outcome,) = found["outcomes"]
    assert outcome["test"]["type"] == a_test().type and "test" not in outcome["record"]
    assert outcome["record"]["packets"] == 40
    with pytest.raises(ValueError, match="not JSON compliant"):
        to_json(summarise({"r": run_of(a_record(metrics={"leaves": math.nan}))}))
