"""Every figure of a report, with a different number for each figure.

If all counts were 1, swapped columns and missing tests would not be found.
"""

from __future__ import annotations

import json
import re

import pytest

from firm_hdl.verify.report.formats import FORMATS
from firm_hdl.verify.report.summary import outcomes_of, summarise
from firm_hdl.verify.report.tables import (
    coverage_table,
    facts,
)
from firm_hdl.verify.results.records import PlanCoverage
from firm_hdl.verify.results.verdict import Counts, Failed, NotJudged, Passed
from tests.verify.report.samples import a_record, a_test, mixed, run_of


def rows(table):
    return [[cell.text for cell in row] for row in table.rows]


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


def test_no_text_ends_the_block_that_it_is_in():
    for ticks in ("```", "````", "``` ````` ```"):
        verdict = Failed((f"before\n{ticks}\n# after",))
        text = FORMATS["md"](summarise({"r": run_of(a_record(verdict=verdict))}))
        (fence,) = re.findall(r"(?m)^(`{3,})\nbefore$", text)
        assert fence not in ticks
        assert "\n# after\n" + fence in text


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
