"""Figures of a report: Markdown tables, the slowest tests, limits, and relations."""

from __future__ import annotations

import math

import pytest

from firm_hdl.drawing.svg import number
from firm_hdl.verify.report.command import write_report
from firm_hdl.verify.report.markdown import _block, _table, _text
from firm_hdl.verify.report.prose import slowest_suite, trends_by_suite
from firm_hdl.verify.report.stats import correlate, curve_of, share_within
from firm_hdl.verify.report.summary import summarise
from firm_hdl.verify.report.tables import Table, TableCell
from firm_hdl.verify.results.file import Results
from firm_hdl.verify.results.records import Seconds
from tests.verify.report.samples import a_record, a_test


def summary_of(*records, planned=None):
    tests = tuple(each.test for each in records) if planned is None else planned
    return summarise({"r": Results(planned=tests, records={r.test.key: r for r in records})})


def timed(name, took, **more):
    return a_record(a_test(name), seconds=Seconds(simulation=took), **more)


def test_a_table_has_numbers_on_the_right_and_no_marks():
    rows = ((TableCell("a|b"), TableCell("1", 1)), (TableCell("*c*"), TableCell("2", 2)))
    assert _table(Table(("Type", "Leaves#"), rows)).splitlines() == [
        "| Type | Leaves |",
        "| --- | ---: |",
        r"| a\|b | 1 |",
        r"| \*c\* | 2 |",
    ]
    assert _table(Table(("Type",), ())) == ""


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("a_b _c_ d_", r"a_b \_c\_ d\_"),
        ("a  b\n c", "a b c"),
        (r"\`*{}[]<>#|~", r"\\\`\*\{\}\[\]\<\>\#\|\~"),
        ("1. - + (x)!", "1. - + (x)!"),
    ],
)
def test_special_characters_are_escaped(text, written):
    assert _text(text) == written


@pytest.mark.parametrize(
    ("texts", "fence"),
    [(["a"], "```"), (["`a`", "``"], "```"), (["a ``` b", "`"], "````"), (["`" * 7], "`" * 8)],
)
def test_a_fence_is_longer_than_any_in_the_text(texts, fence):
    assert _block(texts) == "\n".join([fence, *texts, fence, ""])


def test_the_slowest_come_first_and_no_more_than_fifteen():
    records = [timed(f"p/msg/T{n}", n / 10) for n in range(20)]
    found = [each.test.type for each in summary_of(*records).slowest]
    assert found == [f"p/msg/T{n}" for n in range(19, 4, -1)]


def test_tests_without_time_are_not_slow():
    records = [timed("p/msg/A", 0), timed("p/msg/B", 0.1)]
    planned = (*(each.test for each in records), a_test("p/msg/C"))
    assert [each.test.type for each in summary_of(*records, planned=planned).slowest] == ["p/msg/B"]


def test_a_type_is_among_the_most_complex_once_and_by_leaves_then_steps():
    records = [
        timed("p/msg/A", 1, metrics={"leaves": 2, "steps": 9}),
        timed("p/msg/B", 1, metrics={"leaves": 3, "steps": 1}),
        timed("p/msg/C", 1, metrics={"leaves": 3, "steps": 2}),
        timed("p/msg/D", 9, metrics={}),
        a_record(a_test("p/msg/C", bus_bytes=4), metrics={"leaves": 3, "steps": 2}),
    ]
    found = [each.test.type for each in summary_of(*records).most_complex]
    assert found == ["p/msg/C", "p/msg/B", "p/msg/A"]


def test_shares_are_of_round_limits():
    times = (0.005, 0.05, 0.15, 0.3, 0.7, 1.5, 4.5, 9, 15, 50, 100)
    records = [timed(f"p/msg/T{n}", took) for n, took in enumerate(times)]
    (curve,) = summary_of(*records).curves
    limits = (0.01, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 60)
    assert curve.within == {limit: (n + 1) / 11 for n, limit in enumerate(limits)}


def test_the_suite_with_trends_that_takes_most_time_is_named():
    def suite(system, factor):
        return [
            a_record(
                a_test(f"p/msg/T{n}", system=system),
                seconds=Seconds(simulation=factor * (n + 1)),
                metrics={"leaves": n + 1, "steps": n + 1},
            )
            for n in range(20)
        ]

    summary = summary_of(*suite("ts3", 1), *suite("bench", 3))
    assert len(trends_by_suite(summary)) == 2
    assert slowest_suite(summary).startswith("bench")


def test_a_relation_needs_two_points_that_differ():
    assert correlate([1], [1]) is None
    assert correlate([], []) is None
    assert correlate([1, 1], [1, 2]) is None and correlate([1, 2], [2, 2]) is None
    found = correlate([1, 2], [5, 3])
    assert (found.count, found.pearson, found.spearman) == pytest.approx((2, -1, -1))


def test_a_line_and_a_power_law_are_found_where_they_are():
    x = [float(n) for n in range(1, 60)]
    line = correlate(x, [3 + 2 * each for each in x]).linear
    assert (line.a, line.b, line.r2) == pytest.approx((3, 2, 1))
    law = correlate(x, [3 * each**1.5 for each in x]).power
    assert (law.a, law.b, law.r2) == pytest.approx((3, 1.5, 1))
    assert correlate([-each for each in x], x).power is None


def test_curves_and_shares_of_few_values():
    assert curve_of([]) == [] and curve_of([2.0, 1.0]) == [(1.0, 0.5), (2.0, 1.0)]
    assert (share_within([], 1), share_within([1, 2, 3, 4], 3)) == (0, 0.75)


def test_negative_numbers_have_as_many_digits():
    assert [number(each) for each in (-1234.5, -0.123456, -math.inf)] == ["-1,234", "-0.123", "-"]


def test_a_report_may_go_into_folders_that_are_not_there(tmp_path):
    out = tmp_path / "a" / "b" / "report.md"
    write_report([], out)
    assert out.read_text().startswith("# Verification of firm-hdl\n")
    write_report([], out, title="Mine")
    assert out.read_text().startswith("# Mine\n")
    # No other file is left in the folder.
    assert list(out.parent.iterdir()) == [out]


def test_reports_are_of_firm_hdl_unless_they_are_called_otherwise():
    assert summarise({}).title == "Verification of firm-hdl"
    assert summarise({}, "Mine").title == "Mine"
