"""Reports have all results and nothing else, in every format."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from html.parser import HTMLParser

import pytest

from firm_hdl.cli import main
from firm_hdl.verify.report import formats, tables
from firm_hdl.verify.report.formats import FORMATS
from firm_hdl.verify.report.summary import failures_of, outcomes_of, summarise
from firm_hdl.verify.results.file import Results, ResultsWriter
from firm_hdl.verify.results.records import OracleVerdict, PlanCoverage, Seconds
from firm_hdl.verify.results.verdict import Counts, Failed, KnownDifference, NotJudged, Passed
from tests.verify.report.samples import a_record, a_run, a_test

FAILED = a_record(
    a_test("nav_msgs/msg/Path"),
    verdict=Failed(("hardware: packet 3 of 14 differs", "and more")),
    command="firm-hdl verify nav_msgs/msg/Path",
    waveform_command="firm-hdl verify --vcd waveforms nav_msgs/msg/Path",
)


def run_of(*records, planned=None):
    tests = tuple(record.test for record in records) if planned is None else planned
    return Results(planned=tests, records={record.test.key: record for record in records})


def rendered(form, *runs):
    return FORMATS[form](summarise({f"run{n}.jsonl": run for n, run in enumerate(runs)}))


class Page(HTMLParser):
    """A parser that checks that elements are closed in order, and keeps their content."""

    VOID = ("meta", "input", "line", "rect", "circle", "path")

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.text, self.attributes = [], [], [], []
        self.feed(text)
        self.close()
        assert not self.open

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs
        if tag not in ("meta", "input"):
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text.append(data)


@pytest.mark.parametrize("form", list(FORMATS))
def test_a_failure_is_shown_in_every_format(form):
    passed = rendered(form, run_of(a_record()))
    failed = rendered(form, run_of(a_record(), FAILED))
    for text in (FAILED.verdict.failures[0], FAILED.command, FAILED.waveform_command):
        assert text in failed and text not in passed
    said = {"html": "1 of 2 tests passed, 1 failed", "md": "1 of 2 tests passed, 1 failed"}
    if form == "json":
        assert json.loads(passed)["verdict"] == "passed"
        found = json.loads(failed)
        assert found["verdict"] == "failed" and found["failed"] == [FAILED.test.key]
        none = {"known": 0, "not_judged": 0, "not_run": 0}
        assert found["counts"] == {"passed": 1, "failed": 1, **none}
    else:
        assert said[form] in failed and "1 of 1 tests passed" in passed
        assert "✗ fail" in failed and "✗" not in passed


@pytest.mark.parametrize("form", list(FORMATS))
def test_missing_record_is_no_pass(form):
    missing = a_test("nav_msgs/msg/Path")
    text = rendered(form, run_of(a_record(), planned=(a_test(), missing)))
    if form == "json":
        found = json.loads(text)
        assert found["verdict"] == "not run" and found["not_run"] == [missing.key]
    else:
        assert "1 of 2 tests passed, 1 not run" in text and "nav_msgs/msg/Path" in text
        assert "? not run" in text


def test_no_results_are_no_pass():
    assert Counts.of([]).verdict == "not run"
    for form in ("html", "md"):
        assert "? no tests" in rendered(form, Results())
    assert json.loads(rendered("json", Results()))["verdict"] == "not run"


def test_unjudged_tests_are_no_pass_and_have_a_reason():
    skipped = a_record(a_test("a/msg/W"), verdict=NotJudged("no oracle for wstring"))
    outcomes = outcomes_of([run_of(a_record(), skipped)])
    counts = Counts.of(each.verdict for each in outcomes)
    assert counts.not_judged == 1 and counts.passed == 1
    for form in FORMATS:
        text = rendered(form, run_of(a_record(), skipped))
        assert "no oracle for wstring" in text and "skipped" not in text
        if form != "json":
            assert "1 of 2 tests passed, 1 not judged" in text


EVIL = "</title><script>alert(1)</script>\"'&`|*_<b>\n```"


def test_names_of_users_are_plain_text_in_every_format():
    record = replace(
        FAILED,
        test=a_test(f"a/msg/{EVIL}", distro=EVIL, same=(EVIL,), options=EVIL),
        verdict=Failed((EVIL, EVIL)),
        command=EVIL,
        waveform_command=EVIL,
        coverage=PlanCoverage(taken=0, possible=1, missing=(EVIL,)),
        metrics={EVIL: 3.0},
        same_as=EVIL,
    )
    more = [
        replace(a_record(a_test(f"a/msg/T{n}")), metrics={EVIL: n + 1.0}, seconds=s)
        for n, s in enumerate(Seconds(simulation=0.1 * x) for x in (1, 2, 3, 5, 4, 7))
    ]
    run = replace(run_of(record, *more), options={EVIL: EVIL}, sessions=({EVIL: EVIL},))
    calm = replace(run_of(a_record()), options={"x": "y"})
    page, plain = Page(rendered("html", run)), Page(rendered("html", calm))
    assert page.tags.count("script") == plain.tags.count("script") == 1
    assert page.tags.count("b") == page.attributes.count(("class", "tile"))
    assert "alert(1)" in "".join(page.text)
    assert not [name for name, _ in page.attributes if name.startswith("on")]
    assert json.loads(rendered("json", run))["outcomes"][0]["details"] == [EVIL, EVIL]
    text = rendered("md", run)
    outside = re.sub(r"(?ms)^(`{3,})$.*?^\1$", "", text)
    assert not re.search(r"(?<!\\)<", outside)


def test_page_is_self_contained_and_well_formed():
    text = rendered("html", a_run())
    page = Page(text)
    assert not set(page.tags) & {"link", "img", "iframe", "object", "base", "image", "use"}
    links = [value for name, value in page.attributes if name in ("src", "href", "xlink:href")]
    assert links and all(link.startswith("#") for link in links)
    assert (
        "url(" not in text
        and "@import" not in text
        and "http" not in text.replace("http-equiv", "")
    )
    assert "prefers-color-scheme: dark" in text
    targets = {value for name, value in page.attributes if name == "id"}
    assert {link[1:] for link in links} <= targets
    # A search field refers to its table, not to a section of the same name.
    assert len(targets) == len([name for name, _ in page.attributes if name == "id"])
    searched = {value for name, value in page.attributes if name == "data-table"}
    assert searched and searched <= targets


def test_nothing_rounds_up_to_all():
    coverage = PlanCoverage(taken=99_999, possible=100_000)
    run = run_of(a_record(coverage=coverage))
    assert "99.99%" in rendered("md", run) and "100.00%" not in rendered("md", run)
    assert "100.00%" in rendered("md", run_of(a_record()))


def definition(name, *verdicts, **more):
    """Return a record of TS1 with oracles' verdicts, given as (oracle, verdict)."""
    said = tuple(OracleVerdict(oracle=o, verdict=v) for o, v in verdicts)
    test = a_test(name, system="ts1", simulator="", wire="", bus_bytes=0, options="")
    known = {"coverage": None, "shape": "", "metrics": {}, "seconds": Seconds(testing=0.1)}
    return a_record(test, verdicts=said, **{**known, **more})


def known(*keys):
    return KnownDifference(keys, 1)


def test_verdicts_of_oracles_are_counted_and_known_differences_named():
    run = run_of(
        definition("a/msg/A", ("genmsg", Passed(3)), ("rosbags", known("a-key"))),
        definition("a/msg/B", ("genmsg", Passed(3)), ("rosbags", known("a-key", "b-key"))),
        definition("a/msg/C", ("rosbags", NotJudged("a/msg/C is too deep"))),
        definition("a/msg/D", ("rosbags", NotJudged("a/msg/D is too deep"))),
        definition("a/msg/E", ("rosbags", Failed(("x",))), verdict=Failed(("rosbags: x",))),
    )
    summary = summarise({"r": run})
    assert [(s.oracle, s.agree, s.known, s.differ, s.not_judged) for s in summary.oracles] == [
        ("genmsg", 2, 0, 0, 0),
        ("rosbags", 0, 2, 1, 2),
    ]
    assert [(s.verdict, s.what, s.count, s.example) for s in summary.said] == [
        ("known difference", "a-key", 2, "a/msg/A"),
        ("known difference", "b-key", 1, "a/msg/B"),
        ("not judged", "a/msg/C is too deep", 2, "a/msg/C"),
    ]
    for form in FORMATS:
        text = rendered(form, run)
        assert "a-key" in text and "rosbags: x" in text
    assert 'id="oracles"' not in rendered("html", run_of(a_record()))


def test_long_reports_are_cut_and_say_so(monkeypatch):
    assert tables.MOST_ROWS == 1000, "docs/howto/verify.md"
    for module, name, most in ((tables, "MOST_ROWS", 20), (formats, "_MOST_ARTICLES", 2)):
        monkeypatch.setattr(module, name, most)
    failed = [
        replace(FAILED, test=a_test(f"z{n}_msgs/msg/F{n}"), verdict=Failed((f"it is {n}",)))
        for n in range(4)
    ]
    run = run_of(*a_run(60).records.values(), *failed)
    text = rendered("html", run)
    assert text.count("<article>") == 2 and "2 more tests failed" in text
    assert "Show 20 of 64 tests" in text and "and 44 more: those that did not pass" in text
    # Failed tests are not left out.
    assert all(f"it is {number}" in text for number in range(4))
    assert text.count("z3_msgs/msg/F3 (") == 1 and '<td class="t">z3_msgs/msg/F3</td>' in text
    assert len(json.loads(rendered("json", run))["outcomes"]) == 64
    assert Page(text)


def written(path, run):
    with ResultsWriter(path, options=run.options, planned=run.planned) as writer:
        for record in run.records.values():
            writer.add(record)
    return str(path)


@pytest.mark.parametrize("form", list(FORMATS))
def test_the_file_name_selects_the_format(tmp_path, form, capsys):
    path = written(tmp_path / "r.jsonl", a_run(8))
    out = tmp_path / "new" / f"report.{form}"
    assert main(["report", path, "--out", str(out)]) == 0
    assert capsys.readouterr().out == f"wrote   {out}\n"
    assert main(["report", path, "--format", form]) == 0
    assert capsys.readouterr().out == out.read_text()
    assert [each.name for each in out.parent.iterdir()] == [out.name]


def test_command_refuses_other_files(tmp_path, capsys):
    (tmp_path / "x").write_text("hello\n")
    assert main(["report", str(tmp_path / "x")]) == 1
    assert capsys.readouterr().err == (f"error: '{tmp_path}/x' has no results of firm-hdl verify\n")
    assert main(["report", str(tmp_path / "y")]) == 1
    assert "No such file" in capsys.readouterr().err
    path = written(tmp_path / "r.jsonl", a_run(2))
    assert main(["report", path, "--out", str(tmp_path / "r.pdf")]) == 1
    assert "must end in .html, .md, .json" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("other", "verdict", "why"),
    [
        (a_record(shape="aa"), "passed", ""),
        (a_record(shape="bb"), "failed", "not the circuit of 'KEY', as its record says"),
        (
            replace(FAILED, test=a_test(), shape="aa"),
            "failed",
            "has the circuit of 'KEY', which failed",
        ),
        (None, "not run", "has the circuit of 'KEY', which was not run"),
        (
            a_record(verdict=NotJudged("x"), shape="aa"),
            "not judged",
            "has the circuit of 'KEY', which was not judged",
        ),
    ],
)
def test_a_shared_circuit_has_the_verdict_of_its_test(other, verdict, why):
    twin = a_record(a_test("a/msg/Twin"), same_as=a_test().key, shape="aa")
    records = [twin] if other is None else [twin, other]
    (outcome,) = (o for o in outcomes_of([run_of(*records)]) if o.test == twin.test)
    assert outcome.verdict.name == verdict
    said = outcome.verdict.reason if verdict.startswith("not") else failures_of(outcome)
    wanted = why.replace("KEY", a_test().key)
    assert said == wanted if verdict.startswith("not") else said == ((wanted,) if why else ())
