"""Sums and orders over several types, suites, distributions and files."""

from __future__ import annotations

import json

import pytest

from firm_hdl.verify.report import summary as module
from firm_hdl.verify.report.command import FORMATS
from firm_hdl.verify.report.outcomes import outcomes_of
from firm_hdl.verify.report.prose import facts, shown_packages, shown_tests, slowest_suite
from firm_hdl.verify.report.stats import Correlation
from firm_hdl.verify.report.summary import summarise
from firm_hdl.verify.report.tables import (
    coverage_table,
    every_table,
    failure_table,
    group_table,
    oracle_table,
    stage_table,
    trend_table,
    within_table,
)
from firm_hdl.verify.report.verdicts import reason_groups
from firm_hdl.verify.results.file import Results
from firm_hdl.verify.results.records import OracleVerdict, PlanCoverage, Seconds
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed
from tests.verify.report.samples import a_record, a_test


def run_of(*records, planned=()):
    tests = (*(record.test for record in records), *planned)
    return Results(planned=tests, records={record.test.key: record for record in records})


def summary_of(*records):
    return summarise({"r": run_of(*records)})


def types(outcomes):
    return [each.test.type.rpartition("/")[2] for each in outcomes]


def texts(table):
    return [[cell.text for cell in row] for row in table.rows]


def test_outcomes_are_in_the_order_of_their_keys_whatever_that_of_the_files_is():
    one = run_of(*(a_record(a_test(f"p/msg/{name}")) for name in "DB"))
    other = run_of(a_record(a_test("p/msg/A")), planned=[a_test("p/msg/C")])
    for files in ((one, other), (other, one)):
        assert types(outcomes_of(files)) == ["A", "B", "C", "D"]
        found = json.loads(FORMATS["json"](summarise(dict(zip("rs", files, strict=True)))))
        assert [each["test"]["type"] for each in found["outcomes"]] == [
            f"p/msg/{name}" for name in "ABCD"
        ]


def test_of_types_with_as_many_leaves_steps_decide_and_then_time():
    figures = {"A": (5, 1, 9.0), "B": (5, 2, 1.0), "C": (4, 9, 9.0), "D": (5, 2, 2.0)}
    records = [
        a_record(
            a_test(f"p/msg/{name}"),
            metrics={"leaves": leaves, "steps": steps},
            seconds=Seconds(testing=took),
        )
        for name, (leaves, steps, took) in figures.items()
    ]
    assert types(summary_of(*records).most_complex) == ["D", "B", "A", "C"]
    # Without leaves, a type is not complex at all.
    flat = a_record(a_test("p/msg/E"), metrics={"leaves": 0, "steps": 99})
    assert types(summary_of(*records, flat).most_complex) == ["D", "B", "A", "C"]


def test_a_type_may_have_several_of_the_slowest_tests():
    records = [
        a_record(a_test(options=f"seed={n}"), seconds=Seconds(testing=float(n)))
        for n in range(1, 18)
    ]
    found = [each.test.options for each in summary_of(*records).slowest]
    assert found == [f"seed={n}" for n in range(17, 2, -1)]
    # Of the same tests, only one of the type is complex.
    assert len(summary_of(*records).most_complex) == 1


def test_a_test_that_was_not_judged_needs_no_circuit_of_another():
    for same_as in ("", "somewhere"):
        record = a_record(verdict=NotJudged("no reference"), same_as=same_as)
        (outcome,) = outcomes_of([run_of(record)])
        assert (outcome.verdict, outcome.circuit_of) == (NotJudged("no reference"), "")
    # One that passed needs it, and so does one with a known difference.
    for verdict in (Passed(1), KnownDifference(("k",), 1)):
        (outcome,) = outcomes_of([run_of(a_record(verdict=verdict, same_as="somewhere"))])
        assert (outcome.verdict.name, outcome.circuit_of) == ("not run", "somewhere")
    failed = Failed(("no",))
    (outcome,) = outcomes_of([run_of(a_record(verdict=failed, same_as="somewhere"))])
    assert outcome.verdict == failed


@pytest.mark.parametrize(
    ("count", "kept"),
    [(3, [1, 2, 3]), (4, [1, 3]), (6, [1, 3, 5]), (7, [1, 4, 7]), (8, [1, 4, 7])],
)
def test_of_many_tests_some_are_points_of_charts_and_all_count(monkeypatch, count, kept):
    monkeypatch.setattr(module, "MOST_POINTS", 3)
    records = [
        a_record(
            a_test(f"p/msg/T{n}"),
            seconds=Seconds(generation=1.0 * n, testing=10.0 * n),
            metrics={"leaves": 100 * n},
        )
        for n in range(1, count + 1)
    ]
    summary = summary_of(*records)
    (curve,) = summary.curves
    assert curve.stage_values == {
        "generation": tuple(1.0 * n for n in kept),
        "testing": tuple(10.0 * n for n in kept),
    }
    assert curve.stages["testing"].count == curve.seconds.count == count
    (trend,) = (each for each in summary.trends if each.time == "total")
    assert trend.points == tuple((100.0 * n, 11.0 * n) for n in kept)
    assert trend.correlation.count == count


def test_a_stage_that_took_no_time_is_no_point_of_its_trend():
    records = [
        a_record(
            a_test(f"p/msg/T{n}"),
            seconds=Seconds(generation=1.0, simulation=2.0 * n * (n % 2)),
            metrics={"leaves": n},
        )
        for n in range(9)
    ]
    found = {each.time: each.correlation for each in summary_of(*records).trends}
    assert {time: each.count for time, each in found.items()} == {"total": 9, "simulation": 4}
    assert found["simulation"].pearson == pytest.approx(1)


def test_circuits_of_others_count_whatever_their_own_shape_is():
    first = a_record(a_test("p/msg/A"), shape="1")
    records = [
        a_record(a_test(f"p/msg/{name}"), shape=shape, same_as=first.test.key)
        for name, shape in (("B", "1"), ("C", ""))
    ]
    assert summary_of(first, *records).circuits == {"ts3, python, 8-byte bus": (1, 2)}


def test_a_reason_goes_on_after_the_name_of_a_type():
    reasons = ("needs p/A: it is odd", "needs p/msg/B: it is odd", "needs p/C; it is odd",
               "needs 'p/A', it is odd", "needs 'p/D', it is odd", 'needs "p/D", it is odd',
               "needs p/A, it is odd")  # fmt: skip
    records = [
        a_record(a_test(f"p/msg/T{n}"), verdict=NotJudged(reason))
        for n, reason in enumerate(reasons)
    ]
    found = {
        each.text: len(each.outcomes) for each in reason_groups(outcomes_of([run_of(*records)]))
    }
    assert found == {reasons[0]: 2, reasons[3]: 2, reasons[2]: 1, reasons[5]: 1, reasons[6]: 1}


def suites():
    """Two suites with three types; each number differs."""
    covered = {("ts3", "A"): (1, 2), ("ts3", "B"): (4, 4), ("bench", "A"): (8, 16)}
    return [
        a_record(
            a_test(f"{'pq'[name == 'B']}/msg/{name}", system=system, same=("iron", "lyrical")),
            coverage=PlanCoverage(taken=taken, possible=possible),
            cpu_seconds=float(possible),
            shape=name,
        )
        for (system, name), (taken, possible) in covered.items()
    ]


def test_sums_are_of_a_suite_and_those_of_the_head_of_all():
    summary = summary_of(*suites())
    assert texts(coverage_table(summary)) == [
        ["bench, python, 8-byte bus", "1", "0", "8", "16", "50.0%"],
        ["ts3, python, 8-byte bus", "2", "1", "5", "6", "83.3%"],
    ]
    said = {what: figure for figure, what in facts(summary)}
    assert said["plan coverage"] == "59.09%"  # 13 of 22.
    assert (said["tests"], said["types"], said["different circuits"]) == ("3", "2", "2")
    assert said["CPU time in total"] == "22 s"
    table = group_table(summary.by_package, "Test system|Distribution|Package")
    found = [(*row[:3], row[5], row[-1]) for row in texts(table)]
    bench, ts3 = "bench, python, 8-byte bus", "ts3, python, 8-byte bus"
    assert found == [
        (bench, "iron", "p", "1", "16 s"), (bench, "lyrical", "p", "1", "16 s"),
        (ts3, "iron", "p", "1", "2 s"), (ts3, "iron", "q", "1", "4 s"),
        (ts3, "lyrical", "p", "1", "2 s"), (ts3, "lyrical", "q", "1", "4 s"),
    ]  # fmt: skip


def test_verdicts_of_oracles_are_summed_by_distribution():
    def definition(name, distro, *verdicts):
        said = [OracleVerdict(oracle=who, verdict=v, is_refused=v == Passed(1))
                for who, v in zip(("one", "two"), verdicts, strict=False)]  # fmt: skip
        test = a_test(f"p/msg/{name}", system="ts1", distro=distro, same=(distro,))
        return a_record(test, verdicts=tuple(said))

    known, failed, silent = KnownDifference(("k",), 2), Failed(("no",)), NotJudged("nobody")
    summary = summary_of(
        definition("A", "iron", Passed(1), Passed(2)),
        definition("B", "iron", Passed(1), known),
        definition("C", "iron", Passed(3)),
        definition("A", "jazzy", failed, silent),
        definition("B", "jazzy", silent),
    )
    assert texts(oracle_table(summary)) == [
        ["iron", "one", "3", "2", "0", "0", "0"],
        ["iron", "two", "1", "0", "1", "0", "0"],
        ["jazzy", "one", "0", "0", "0", "1", "1"],
        ["jazzy", "two", "0", "0", "0", "0", "1"],
    ]


def test_long_lists_begin_with_what_did_not_pass_and_keep_the_order_otherwise():
    verdicts = {"A": Passed(1), "B": NotJudged("no"), "C": KnownDifference(("k",), 1),
                "D": Failed(("no",)), "E": Passed(1)}  # fmt: skip
    records = [
        a_record(a_test(f"{name.lower()}/msg/{name}", same=()), verdict=verdict,
                 seconds=Seconds(testing=float("ABCDE".index(name) + 1)))
        for name, verdict in verdicts.items()
    ]  # fmt: skip
    summary = summarise({"r": run_of(*records, planned=[a_test("f/msg/F", same=())])})
    assert types(shown_tests(summary, 5)[0]) == ["D", "F", "B", "C", "E"]
    packages = [group.labels[-1] for group in shown_packages(summary, 5)[0]]
    assert packages == ["b", "c", "d", "f", "a"]


def test_a_column_that_is_empty_at_first_is_kept_for_the_others():
    records = [
        a_record(a_test(f"p/{name}"), verdict=Failed(("no",)), command=command)
        for name, command in (("A", ""), ("B", "run B"))
    ]
    table = failure_table(summary_of(*records).failed)
    assert [row[-1] for row in texts(table)] == ["", "run B"]


def test_tests_without_processor_time_have_no_row_for_it():
    records = [a_record(a_test(f"p/T{n}"), cpu_seconds=0.0) for n in range(3)]
    (curve,) = summary_of(*records).curves
    names = [row[1] for row in texts(stage_table([curve]))]
    assert names == ["generation", "simulation", "testing", "all stages"]


def test_shares_are_of_all_tests_although_a_curve_has_fewer_points():
    records = [a_record(a_test(f"p/T{n}"), seconds=Seconds(testing=1.0 + n)) for n in range(500)]
    (curve,) = summary_of(*records).curves
    assert len(curve.points) < 500
    assert texts(within_table([curve]))[0][1] == "500"


def test_what_has_no_figure_is_sorted_before_all_that_have_one():
    """Shares and R² are from 0 to 1."""
    table = every_table(summary_of(a_record(coverage=None)).outcomes)
    (row,) = table.rows
    cell = row[table.headings.index("Plan coverage#")]
    assert (cell.text, cell.value < 0) == ("-", True)
    found = Correlation(count=2, pearson=1.0, spearman=1.0, linear=None, power=None)
    trend = module.Trend(suite="s", metric="m", time="total", correlation=found, points=())
    table = trend_table([trend])
    for cell, name in zip(table.rows[0], table.headings, strict=True):
        assert name != "R²#" or (cell.text, cell.value < 0) == ("-", True)


def test_a_type_of_two_distributions_is_two_types_to_processor_time():
    records = [
        a_record(a_test("p/msg/A", distro=distro, same=(distro,)), cpu_seconds=took)
        for distro, took in (("iron", 1.0), ("jazzy", 3.0))
    ]
    said = {what: figure for figure, what in facts(summary_of(*records))}
    assert said["median CPU time per test"] == "3 s" and said["types"] == "1"


@pytest.mark.parametrize("slow", ["bench", "ts3"])
def test_the_suite_that_takes_most_time_is_the_slowest(slow):
    records = [
        a_record(
            a_test(f"p/msg/T{n}", system=system),
            seconds=Seconds(simulation=(3.0 if system == slow else 1.0) * (n + 1)),
            metrics={"leaves": n + 1},
        )
        for system in ("bench", "ts3")
        for n in range(6)
    ]
    assert slowest_suite(summary_of(*records)) == f"{slow}, python, 8-byte bus"
