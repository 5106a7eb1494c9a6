"""The end of a run: unjudged tests are no pass in the exit status and the printed summary."""

from __future__ import annotations

import pytest

import firm_hdl.verify.ts3.acceptance as acceptance
from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.user_oracle import judge_of
from firm_hdl.cli import main
from firm_hdl.verify.results.file import read_results
from firm_hdl.verify.results.verdict import (
    Failed,
    KnownDifference,
    NotJudged,
    Passed,
)
from firm_hdl.verify.run import failure
from firm_hdl.verify.systems.options import Request
from tests.frontend.workspace import make_files
from tests.verify.report.samples import a_record, a_test

PASSED, KNOWN = Passed(3), KnownDifference(("a-key",), 1)
FAILED, SILENT = Failed(("no",)), NotJudged("nobody knows")
FEW = ["--jobs", "1", "--cases", "1", "--no-stalls", "--no-broken", "--distro", "lyrical"]
FEW += ["--reference", "none"]


def found(*verdicts):
    return [a_record(a_test(f"p/msg/T{n}"), verdict=v) for n, v in enumerate(verdicts)]


ALL, NAMED = Request(), Request(types=("p/msg/T",))


@pytest.mark.parametrize(
    ("verdicts", "of_all", "named"),
    [
        ([PASSED], True, True),
        ([PASSED, KNOWN], True, True),
        ([PASSED, SILENT], True, False),
        ([KNOWN, SILENT], True, False),
        ([PASSED, FAILED], False, False),
        ([SILENT], False, False),
        ([SILENT, SILENT], False, False),
        ([], False, False),
    ],
)
def test_success_needs_a_judgement_of_each_named_type(verdicts, of_all, named):
    assert (not failure(found(*verdicts), ALL)) is of_all
    assert (not failure(found(*verdicts), NAMED)) is named


@pytest.fixture
def without_judge_of_wide(monkeypatch):
    """Prevent rosbags from judging the type `Wide`."""

    def judge(message, *arguments, **options):
        if message.name.endswith("Wide"):
            raise NotJudgedError("it is wide")
        return judge_of(message, *arguments, **options)

    monkeypatch.setattr(acceptance, "judge_of", judge)


@pytest.fixture
def source(tmp_path):
    return str(make_files(tmp_path / "src", {f"p/msg/{n}.msg": "int8 x\n" for n in ("A", "Wide")}))


LINE = "not judged: p/msg/Wide (lyrical), ts3, 8-byte bus: it is wide\n"


def test_named_type_that_is_not_judged_is_no_success(
    source, without_judge_of_wide, tmp_path, capsys
):
    call = ["verify", *FEW, "--path", source]
    page, results = tmp_path / "r.md", tmp_path / "r.jsonl"
    report = ["--results", str(results), "--report", str(page)]
    assert main([*call, *report, "p/A", "p/Wide"]) == 1
    output = capsys.readouterr().out
    assert LINE + "1 of 2 tests was not judged, although named, so the run fails\n" in output
    why = "1 of 2 tests was not judged, although named"
    assert read_results(results).failure == why
    assert f"**✗ 1 of 2 tests passed, 1 not judged; the run failed: {why}**" in page.read_text()
    assert main([*call, "p/A"]) == 0
    assert "not judged" not in capsys.readouterr().out


@pytest.mark.thorough
def test_of_all_types_those_that_are_not_judged_are_listed(
    source, without_judge_of_wide, tmp_path, capsys
):
    call = ["verify", *FEW, "--path", source, "--all", "--no-share-circuits"]
    call += ["--results", str(tmp_path / "r.jsonl")]
    # The first run judges; the second reads the file.
    for _ in range(2):
        assert main(call) == 0
        assert capsys.readouterr().out.endswith(LINE + "1 of 2 tests was not judged\n")


@pytest.mark.parametrize("system", ["ts1", "ts2"])
def test_named_definition_that_no_oracle_reads_is_no_success(tmp_path, capsys, system):
    text = "module p { module msg { struct A { long double a; }; }; };"
    path = str(make_files(tmp_path, {"p/msg/A.idl": text, "p/msg/B.msg": "int8 x\n"}))
    call = ["verify", *FEW, "--systems", system, "--oracle", "rosbags", "--path", path]
    assert main([*call, "p/A", "p/B"]) == 1
    bus = ", 8-byte bus" if system == "ts2" else ""
    output = capsys.readouterr().out
    assert f"not judged: p/msg/A (lyrical), {system}{bus}: " in output
    assert "1 of 2 tests was not judged, although named, so the run fails\n" in output
    assert main([*call, "--all"]) == 0
    assert capsys.readouterr().out.endswith("1 of 2 tests was not judged\n")
