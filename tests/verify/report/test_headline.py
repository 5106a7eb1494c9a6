"""The first line of a report: its sign is that of the run."""

from __future__ import annotations

import json
from dataclasses import replace

from firm_hdl.verify.report.command import FORMATS
from firm_hdl.verify.report.prose import headline
from firm_hdl.verify.report.summary import summarise
from firm_hdl.verify.report.tables import SIGNS
from tests.verify.report.samples import VERDICTS, a_record, a_test, mixed, run_of

NAMED = {"named": True}


def first_line(*runs):
    """Return the first line of a report, which has the result; all formats agree about it."""
    summary = summarise({f"r{number}": run for number, run in enumerate(runs)})
    line = headline(summary)
    assert f"**{line}**" in FORMATS["md"](summary)
    found = json.loads(FORMATS["json"](summary))["verdict"]
    assert SIGNS[found][0] == line[0]
    kind = found.replace(" ", "-")
    assert f'<div class="verdict {kind}">{line}</div>' in FORMATS["html"](summary)
    return line


def test_no_check_mark_if_a_named_type_was_not_judged():
    run = mixed(passed=2, not_judged=2)
    assert first_line(run) == "✓ 2 of 4 tests passed, 2 not judged"
    named = replace(run, options=NAMED)
    assert first_line(named) == "- 2 of 4 tests passed, 2 not judged, 2 of them named"
    assert first_line(replace(mixed(passed=2), options=NAMED)) == "✓ 2 of 2 tests passed"
    # Only the types of the run with names are named.
    other = run_of(a_record(a_test("other/msg/T"), verdict=VERDICTS["not_judged"]))
    assert first_line(named, other) == "- 2 of 5 tests passed, 3 not judged, 2 of them named"
    # What is worse decides.
    failed = replace(mixed(passed=1, failed=1, not_judged=1), options=NAMED)
    assert first_line(failed).startswith("✗ 1 of 3 tests passed, 1 failed, 1 not judged")
    missing = replace(mixed(passed=1, not_run=1, not_judged=1), options=NAMED)
    assert first_line(missing).startswith("? 1 of 3 tests passed, 1 not run, 1 not judged")


def test_no_check_mark_if_definitions_were_refused():
    refused = {"refused": True}
    run = replace(mixed(passed=2), options=refused)
    assert first_line(run) == "✗ 2 of 2 tests passed, but definitions were refused"
    assert first_line(mixed(passed=2), run)[0] == "✗"
    assert first_line(replace(mixed(passed=2), options={"refused": False}))[0] == "✓"
    nothing = replace(run_of(), options=refused)
    assert first_line(nothing) == "✗ 0 of 0 tests passed, but definitions were refused"
