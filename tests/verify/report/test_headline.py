"""The first line of a report: its sign is that of the run."""

from __future__ import annotations

import json
from dataclasses import replace

from firm_hdl.verify.report.formats import FORMATS
from firm_hdl.verify.report.summary import summarise
from firm_hdl.verify.report.tables import SIGNS, headline
from tests.verify.report.samples import a_record, a_test, mixed, run_of


def first_line(*runs, in_all_formats=False):
    """Return the first line of a report, which has the result. Formats take a while to agree."""
    summary = summarise({f"r{number}": run for number, run in enumerate(runs)})
    line = headline(summary)
    if not in_all_formats:
        return line
    assert f"**{line}**" in FORMATS["md"](summary)
    found = json.loads(FORMATS["json"](summary))["verdict"]
    assert SIGNS[found][0] == line[0]
    kind = found.replace(" ", "-")
    assert f'<div class="verdict {kind}">{line}</div>' in FORMATS["html"](summary)
    return line


def test_no_check_mark_if_a_run_failed():
    run = mixed(passed=2, not_judged=2)
    assert first_line(run, in_all_formats=True) == "✓ 2 of 4 tests passed, 2 not judged"
    failed = replace(run, failure="something was named")
    line = "✗ 2 of 4 tests passed, 2 not judged; the run failed: something was named"
    assert first_line(failed, in_all_formats=True) == line
    # The first reason of several runs.
    other = run_of(a_record(a_test("other/msg/T")))
    assert first_line(other, failed) == line.replace("2 of 4", "3 of 5")
    wrong = replace(other, failure="another reason")
    assert first_line(failed, wrong) == line.replace("2 of 4", "3 of 5")
    # A failed test is a reason already.
    tests = replace(mixed(passed=1, failed=1), failure="1 of 2 tests failed")
    assert first_line(tests) == "✗ 1 of 2 tests passed, 1 failed"
    missing = replace(mixed(passed=1, not_run=1), failure="it was named")
    assert first_line(missing) == "✗ 1 of 2 tests passed, 1 not run; the run failed: it was named"
    # A run that was killed is no success, whatever its earlier sessions were.
    killed = replace(mixed(passed=2), failure=None)
    assert first_line(killed, in_all_formats=True) == "? 2 of 2 tests passed; a run has not ended"
    assert first_line(mixed(passed=1), killed)[0] == "?"
    both = "✗ 2 of 2 tests passed; the run failed: it was named; a run has not ended"
    assert first_line(replace(mixed(passed=2), failure="it was named"), killed) == both
    assert first_line(replace(mixed(passed=1, failed=1), failure=None))[0] == "✗"
    nothing = replace(run_of(), failure="there is nothing")
    assert first_line(nothing) == "✗ 0 of 0 tests passed; the run failed: there is nothing"
