"""Tables with each cell under its heading, and the sentences of a report."""

from __future__ import annotations

import json

from firm_hdl.verify.report import html
from firm_hdl.verify.report.command import FORMATS
from firm_hdl.verify.report.prose import facts, headline, shown_packages, shown_tests, sources
from firm_hdl.verify.report.summary import summarise
from firm_hdl.verify.report.tables import (
    circuits_table,
    coverage_table,
    every_table,
    failure_table,
    missing_table,
    title_of,
    writer_table,
)
from firm_hdl.verify.results.file import Results
from firm_hdl.verify.results.records import PlanCoverage, Seconds
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged
from tests.verify.report.samples import a_record, a_test


def summary_of(*records, planned=None, **more):
    tests = tuple(each.test for each in records) if planned is None else planned
    by_key = {each.test.key: each for each in records}
    return summarise({"r.jsonl": Results(planned=tests, records=by_key, **more)})


def texts(table):
    return [[cell.text for cell in row] for row in table.rows]


def under_headings(table, row=0):
    names = [name.removesuffix("#") for name in table.headings]
    return dict(zip(names, [cell.text for cell in table.rows[row]], strict=True))


PLAIN = a_test("p/msg/A", system="ts1", simulator="", wire="", bus_bytes=0, options="", same=())


def test_each_value_of_a_test_is_in_its_column():
    whole = a_record(
        a_test("p/msg/A", wire="ros1", bus_bytes=4, same=("iron", "jazzy")),
        metrics={"leaves": 3, "steps": 4},
        packets=5,
        cycles=6,
        coverage=PlanCoverage(taken=7, possible=8),
        seconds=Seconds(generation=9),
        cpu_seconds=10,
        same_as="other key",
    )
    table = every_table(summary_of(whole).outcomes)
    assert under_headings(table) == {
        "Type": "p/msg/A",
        "Distributions": "iron jazzy",
        "Test system": "ts3 python",
        "Wire": "ros1 4",
        "Result": table.rows[0][4].text,
        "Time": "9 s",
        "CPU": "10 s",
        "Leaves": "3",
        "Steps": "4",
        "Packets": "5",
        "Cycles": "6",
        "Plan coverage": "7 of 8",
        "Circuit of": "other key",
    }
    bare = a_record(PLAIN, metrics={}, coverage=None, packets=0, cycles=0)
    found = under_headings(every_table(summary_of(bare).outcomes))
    assert found["Test system"] == "ts1" and found["Distributions"] == "lyrical"
    assert found["Plan coverage"] == "-" and found["Leaves"] == "0"
    assert "Wire" not in found and "Circuit of" not in found


def test_a_test_that_did_not_run_has_a_row():
    (test,) = (a_test("p/msg/A"),)
    found = under_headings(every_table(summary_of(planned=(test,)).outcomes))
    assert found["Result"] == "? not run" and found["Time"] == "-" and found["Packets"] == "0"


def test_a_column_is_left_out_only_if_all_of_it_is_empty():
    with_command = a_record(a_test("p/A"), verdict=Failed(("no",)))
    without = a_record(a_test("p/B"), verdict=Failed(("no",)), command="")
    both = failure_table(summary_of(with_command, without).failed)
    assert both.headings[-1] == "Repeat it"
    assert [row[-1] for row in texts(both)] == [with_command.command, ""]
    alone = failure_table(summary_of(without).failed)
    assert alone.headings == both.headings[:-1] and len(alone.rows[0]) == len(alone.headings)


def test_titles_of_tests_are_unique():
    (whole,) = summary_of(a_record(a_test("p/msg/A", same=("iron", "jazzy")))).outcomes
    assert title_of(whole) == "p/msg/A, iron jazzy, ts3, python, cdr, 8-byte bus, seed=0"
    (plain,) = summary_of(a_record(PLAIN)).outcomes
    assert title_of(plain) == "p/msg/A, lyrical, ts1"


def test_a_long_failure_is_cut_in_the_table():
    fits, long = "x" * 300, "y" * 301
    records = [
        a_record(a_test(f"p/msg/{n}"), verdict=Failed((text, "second")), command=f"run {n}")
        for n, text in (("A", fits), ("B", long))
    ]
    rows = texts(failure_table(summary_of(*records).failed))
    assert [row[1:] for row in rows] == [[fits, "run A"], ["y" * 300 + "...", "run B"]]


def test_coverage_of_a_suite_is_summed():
    records = [
        a_record(a_test("p/msg/A"), coverage=PlanCoverage(taken=1, possible=2, missing=("m", "n"))),
        a_record(a_test("p/msg/B"), coverage=PlanCoverage(taken=3, possible=3)),
        a_record(a_test("p/msg/C"), coverage=PlanCoverage(taken=0, possible=5)),
        a_record(a_test("p/msg/D"), coverage=None),
    ]
    summary = summary_of(*records)
    assert texts(coverage_table(summary)) == [
        ["ts3, python, 8-byte bus", "3", "1", "4", "10", "40.0%"]
    ]
    rows = texts(missing_table(summary.uncovered))
    assert [row[1:] for row in rows] == [["1 of 2", "m; n"], ["0 of 5", "not named"]]


def test_circuits_and_writers_are_listed_by_suite():
    summary = summary_of(
        a_record(a_test("p/msg/A"), shape="1", written_by=("a", "b")),
        a_record(a_test("p/msg/B"), shape="1", same_as="x", written_by=("b",)),
        a_record(a_test("p/msg/C"), shape="2"),
        a_record(a_test("p/msg/C", bus_bytes=4), shape="", written_by=("a",)),
        a_record(a_test("p/msg/D", bus_bytes=2), shape="3"),
    )
    assert texts(circuits_table(summary)) == [
        ["ts3, python, 8-byte bus", "2", "1"],
        ["ts3, python, 2-byte bus", "1", "0"],
    ]
    assert texts(writer_table(summary)) == [
        ["ts3, python, 8-byte bus", "a", "1"],
        ["ts3, python, 8-byte bus", "b", "2"],
        ["ts3, python, 4-byte bus", "a", "1"],
    ]
    assert ("3", "different circuits") in set(facts(summary))


def test_a_session_on_the_same_machine_is_as_the_one_before():
    one, other = {"Python": "3.11", "system": "x"}, {"Python": "3.12", "system": "x"}
    sessions = (
        {"started": "1", **one},
        {"started": "2", **one},
        one,
        {"started": "4", **other},
        {"started": "5", **other},
        {"started": "6", **one},
    )
    options = {"systems": ["ts2", "ts3"], "paths": [], "cases": None, "seed": 7}
    summary = summary_of(
        a_record(), planned=(a_test(), a_test("p/msg/B")), sessions=sessions, options=options
    )
    assert list(sources(summary)) == [
        (
            "r.jsonl",
            [
                "1 of 2 planned tests have a record",
                "systems: ts2, ts3",
                "paths: none",
                "cases: default",
                "seed: 7",
                "session 1 1",
                "    Python: 3.11",
                "    system: x",
                "session 2 2: as before",
                "session 3: as before",
                "session 4 4",
                "    Python: 3.12",
                "    system: x",
                "session 5 5: as before",
                "session 6 6",
                "    Python: 3.11",
                "    system: x",
            ],
        )
    ]


def test_the_headline_names_all_verdicts():
    assert headline(summary_of()) == "? no tests"
    assert headline(summary_of(a_record())) == "✓ 1 of 1 tests passed"
    known = a_record(a_test("p/msg/K"), verdict=KnownDifference(("key",), 1))
    said = headline(summary_of(a_record(), known))
    assert said == "✓ 1 of 2 tests passed, 1 with a known difference"
    both = summary_of(
        a_record(),
        a_record(a_test("p/msg/B"), verdict=NotJudged("x")),
        a_record(a_test("p/msg/C"), verdict=Failed(("y",))),
        planned=tuple(
            a_test(name) for name in ("std_msgs/msg/Header", "p/msg/B", "p/msg/C", "p/D")
        ),
    )
    assert headline(both) == "✗ 1 of 4 tests passed, 1 failed, 1 not run, 1 not judged"


def test_processor_time_is_of_types_that_have_all_tests():
    records = [
        a_record(a_test("p/msg/A"), cpu_seconds=1),
        a_record(a_test("p/A", system="ts1"), cpu_seconds=2),
        a_record(a_test("p/msg/B"), cpu_seconds=4),
        a_record(a_test("p/msg/B", system="ts1"), cpu_seconds=8),
        a_record(a_test("p/msg/C"), cpu_seconds=1),
    ]
    found = {what: output for output, what in facts(summary_of(*records))}
    assert found["median CPU time per type, 2 tests of each"] == "12 s"
    assert found["CPU time in total"] == "16 s"
    assert found["types"] == "3" and found["tests"] == "5" and found["failed"] == "0"
    alone = {what: output for output, what in facts(summary_of(*records[2:3]))}
    assert alone["median CPU time per test"] == "4 s"


def test_long_lists_end_with_the_number_of_omitted_rows():
    records = [a_record(a_test(f"p{n}/msg/A"), seconds=Seconds(testing=n)) for n in range(1, 5)]
    summary = summary_of(*records)
    assert shown_tests(summary, 4) == (list(summary.outcomes), "")
    found, rest = shown_tests(summary, 3)
    assert [each.test.package for each in found] == ["p4", "p3", "p2"]
    assert rest.startswith("and 1 more: ")
    groups = len(summary.by_package)
    assert shown_packages(summary, groups) == (list(summary.by_package), "")
    assert shown_packages(summary, groups - 1)[1].startswith("and 1 more; ")


def test_as_many_failures_as_a_page_shows_are_shown_whole(monkeypatch):
    monkeypatch.setattr(html, "MOST_ARTICLES", 2)
    for count in (2, 3):
        records = [
            a_record(a_test(f"p/msg/A{n}"), verdict=Failed((f"wrong {n}", f"also {n}")))
            for n in range(count)
        ]
        page = html.to_html(summary_of(*records))
        assert page.count("<article") == 2
        assert all(f"wrong {n}" in page for n in range(count))
        assert ("also 2" in page) is False


def test_lists_of_tests_in_json_are_keys_of_its_outcomes():
    summary = summary_of(
        a_record(a_test("p/msg/A"), coverage=PlanCoverage(taken=1, possible=2)),
        a_record(a_test("p/msg/B"), verdict=Failed(("wrong",)), seconds=Seconds(testing=9.0)),
        a_record(a_test("p/msg/C"), verdict=NotJudged("nobody")),
        planned=tuple(a_test(f"p/msg/{name}") for name in "ABCD"),
    )
    found = json.loads(FORMATS["json"](summary))
    types = {each["key"]: each["test"]["type"][-1] for each in found["outcomes"]}
    lists = ("failed", "not_run", "not_judged", "uncovered")
    assert [[types[key] for key in found[name]] for name in lists] == [["B"], ["D"], ["C"], ["A"]]
    for name in ("slowest", "most_complex"):
        assert {*found[name]} <= {*types} and found[name]
    assert types[found["slowest"][0]] == "B"
