"""The comparison of a VHDL bench covers everything that the bench writes."""

from __future__ import annotations

import json
from dataclasses import replace
from types import SimpleNamespace

import pytest

from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.make import Case
from firm_hdl.cases.wide_oracle import WideOracle
from firm_hdl.export.build import BuildError
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, build_plan
from firm_hdl.verify.bench import run
from firm_hdl.verify.bench.run import _check_transfers, _compare
from firm_hdl.verify.results.verdict import Failed, NotJudged, Passed
from firm_hdl.verify.systems.options import Options
from firm_hdl.wire import lay_out
from tests.strategies import make
from tests.verify.report.samples import a_test

MESSAGE = make("ros1", {"x": "int16", "b": "bool", "s": "string"})
PLAN = build_plan(lay_out(MESSAGE), bus_bytes=2)
CASES = [
    Case(
        what=what,
        value=None,
        packet=b"",
        transfers={
            ("x",): [x],
            ("b",): [1],
            ("s", "length"): [3],
            ("s", "items"): [((97, 98), False), ((99, 0), True)],
        },
    )
    for what, x in (("one", -2), ("two", 5))
]
LINES = [
    "4 x FFFE",
    "4 b 1",
    "5 s.length 00000003",
    "6 s.items 6261",
    "7 s.items 0063 *",
    "9 x 0005",
    "9 b 1",
    "9 s.length 00000003",
    "12 s.items 6261",
    "17 s.items 0063 *",
]


def check(lines):
    return _check_transfers(PLAN, CASES, "".join(f"{line}\n" for line in lines))


def test_correct_output_is_counted():
    assert check(LINES) == 10


@pytest.mark.parametrize(
    ("change", "output"),
    [
        ({0: "4 x FFFF"}, "transfers of x: number 0 of 2 is ['FFFF'] instead of ['FFFE']"),
        ({1: "4 b 0"}, "transfers of b: number 0 of 2 "),
        ({1: "4 b X"}, "transfers of b: number 0 of 2 is ['X'] instead of ['1']"),
        ({9: "17 s.items 0063"}, "transfers of s.items: number 3 of 4 is ['0063'] instead of"),
        ({8: "12 s.items 6261 *"}, "transfers of s.items: number 2 of 4 is ['6261 *'] instead"),
        # A byte in a lane that the string does not use.
        ({9: "17 s.items A563 *"}, "transfers of s.items: number 3 of 4 "),
        ({7: None}, "transfers of s.length: number 1 of 2 is [] instead of ['00000003']"),
        ({9: None}, "transfers of s.items: number 3 of 4 is [] instead of ['0063 *']"),
        ({0: "4 x FFFE\n5 x FFFE"}, "transfers of x: number 1 of 2 is ['FFFE'] instead of"),
        ({9: "17 s.items 0063 *\n18 s.items 0000"}, "transfers of s.items: number 4 of 4 is ["),
        ({9: "17 s.items 0063 *\n18 y 00"}, "transfers of leaves that there are not: y"),
        # The right data on another leaf.
        ({0: "4 y FFFE"}, "transfers of x: number 0 of 2 is ['0005'] instead of ['FFFE']"),
    ],
)
def test_transfers(change, output):
    lines = [change.get(number, line) for number, line in enumerate(LINES)]
    with pytest.raises(AssertionError) as caught:
        check([line for line in lines if line is not None])
    assert str(caught.value).startswith(output)


def test_no_transfers_at_all():
    with pytest.raises(AssertionError, match=r"^transfers of x: number 0 of 2 is \[\] instead of"):
        check([])


@pytest.mark.parametrize(
    ("got", "output"),
    [
        ("00\n0101\n", "number 1 of 2 is ['0101'] instead of ['01']"),
        ("00\n", "number 1 of 2 is [] instead of ['01']"),
        ("00\n01\n02\n", "number 2 of 2 is ['02'] instead of []"),
        ("00\n01\n\n", "number 2 of 2 is [''] instead of []"),
        ("01\n00\n", "number 0 of 2 is ['01'] instead of ['00']"),
        ("00\n0X\n", "number 1 of 2 is ['0X'] instead of ['01']"),
        ("", "number 0 of 2 is [] instead of ['00']"),
    ],
)
def test_packets(got, output):
    with pytest.raises(AssertionError) as caught:
        _compare("packets", got, "00\n01\n")
    assert str(caught.value) == f"packets: {output}"
    _compare("packets", "00\n01\n", "00\n01\n")


def test_a_value_is_as_wide_as_its_lanes():
    """Items of one bit each, and items of two bytes, several at once; and a value of 9 bits."""
    message = make("ros1", {"flags": "bool[]", "x": "uint16[]"})
    plan = build_plan(lay_out(message), bus_bytes=4)
    lanes = {str(leaf): leaf.lanes for leaf in plan.leaves}
    assert lanes["flags.items"] == 4 and lanes["x.items"] == 2
    transfers = {
        ("flags", "length"): [3],
        ("flags", "items"): [((1, 0, 1), True)],
        ("x", "length"): [3],
        ("x", "items"): [((0x1234, 0xABCD), False), ((0x8000, 0), True)],
    }
    cases = [Case(what="", value=None, packet=b"", transfers=transfers)]
    lines = ["flags.length 00000003", "flags.items 5 *", "x.length 00000003"]
    lines += ["x.items ABCD1234", "x.items 00008000 *"]
    text = "".join(f"{number} {line}\n" for number, line in enumerate(lines))
    assert _check_transfers(plan, cases, text) == 5


def test_only_a_bench_that_says_so_has_passed(monkeypatch, tmp_path):
    said, asked = [], []

    def run_tool(*given, **more):
        asked.append((given, more))
        return said[-1]

    monkeypatch.setattr(run, "run_tool", run_tool)
    said.append("PASS all of them")
    assert run._simulate("bench", tmp_path, "ghdl") == tmp_path / "work_bench"
    (given, more), work = asked[0], tmp_path / "work_bench"
    names = ["-gresults=results.txt", "-gtransfers=transfers.txt"]
    assert given == (["sh", str(tmp_path / run.RUN_SCRIPT), *names], tmp_path)
    assert more["environment"] == {"GHDL": "ghdl", "WORK": str(work), "BENCH": "bench"}
    for words in ("", "\n", "FAIL packet 0", "it will PASS later", "PASSED by"):
        said.append(words)
        with pytest.raises(run.ToolError, match=words.strip() or "without a word"):
            run._simulate("bench", tmp_path, "ghdl")


def test_any_word_of_an_analysis_is_an_error(monkeypatch, tmp_path):
    manifest = {"folder": "vhdl", "files": ["a.vhd"]}
    manifest["bench"] = {"files": ["tb.vhd"], "entities": ["tb", "tb_record"]}
    (tmp_path / "vhdl").mkdir()
    (tmp_path / run.MANIFEST).write_text(json.dumps({"vhdl": manifest}))
    asked, said = [], ["", "tb.vhd:1:1:warning: it is unused\n"]
    monkeypatch.setattr(run, "run_tool", lambda command, folder: asked.append(command) or said[0])
    vhdl, entities = run._analyse(SimpleNamespace(folder=tmp_path), "ghdl")
    assert (vhdl, entities) == (tmp_path / "vhdl", ["tb", "tb_record"])
    assert asked[0][:3] == ["ghdl", "-a", "--std=08"] and "--warn-error" in asked[0]
    assert asked[0][-2:] == [str(vhdl / "a.vhd"), str(vhdl / "tb.vhd")]
    del said[0]
    with pytest.raises(run.ToolError, match="it is unused"):
        run._analyse(SimpleNamespace(folder=tmp_path), "ghdl")


RIGHT = "0001\n02\n"
PACKETS = [replace(case, packet=each) for case, each in zip(CASES, (b"\0\1", b"\2"), strict=True)]


def result_of(monkeypatch, tmp_path, *written):
    """Return the counts of benches, of which each has written packets and transfers."""
    folders = {}
    for number, (packets, lines) in enumerate(written):
        folders[f"bench_{number}"] = folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "results.txt").write_text(packets)
        if lines is not None:
            (folder / "transfers.txt").write_text("".join(f"{line}\n" for line in lines))
    monkeypatch.setattr(run, "plan_of", lambda *_: PLAN)
    monkeypatch.setattr(run, "_cases", lambda *_: PACKETS)
    monkeypatch.setattr(run, "build", lambda *_, **__: [None])
    monkeypatch.setattr(run, "_analyse", lambda *_: (tmp_path, list(folders)))
    monkeypatch.setattr(run, "_simulate", lambda entity, *_: folders[entity])
    record = run.run_bench((Options(), "ghdl"), a_test("std_msgs/msg/Bool"))
    return record.verdict, record.metrics


def test_all_benches_are_compared_and_the_first_one_has_transfers(monkeypatch, tmp_path):
    written = (RIGHT, LINES), (RIGHT, None), (RIGHT, None)
    assert result_of(monkeypatch, tmp_path, *written) == (Passed(6), {"transfers": 10.0})


@pytest.mark.parametrize(
    ("written", "output"),
    [
        ([("0001\n03\n", LINES), (RIGHT, None)], "packets that came out: number 1 of 2 "),
        ([(RIGHT, LINES), ("0001\n", None)], "packets that came out: number 1 of 2 is [] "),
        ([("", LINES), (RIGHT, None)], "packets that came out: number 0 of 2 is [] "),
        ([(RIGHT, LINES[:-1]), (RIGHT, LINES)], "transfers of s.items: number 3 of 4 "),
        ([(RIGHT, None), (RIGHT, LINES)], "bench_0 ended without an error, but did not write"),
    ],
)
def test_what_one_bench_has_wrong_fails(written, output, monkeypatch, tmp_path):
    verdict, _ = result_of(monkeypatch, tmp_path, *written)
    assert isinstance(verdict, Failed) and verdict.failures[0].startswith(output)


def cases_of(monkeypatch, oracle, cases, **found):
    """Return the cases of a bench, for an oracle and what other libraries say."""
    asked = []

    def judge_of(message, distro, *, stand_in):
        asked.append((message, distro))
        return SimpleNamespace(oracle=oracle)

    def confirm(*given):
        asked.append(given)
        return SimpleNamespace(**{"failures": (), "by": (), **found})

    monkeypatch.setattr(run, "judge_of", judge_of)
    monkeypatch.setattr(run, "stimulus_cases", lambda judge, plan: iter(cases))
    monkeypatch.setattr(run, "confirm", confirm)
    assert run._cases(MESSAGE, PLAN, "lyrical") == cases
    return asked


WIDE = WideOracle.__new__(WideOracle)


def test_only_wide_text_needs_another_library(monkeypatch):
    assert cases_of(monkeypatch, object(), CASES) == [(MESSAGE, "lyrical")]
    asked = cases_of(monkeypatch, WIDE, CASES, by=("fastcdr",))
    assert asked == [(MESSAGE, "lyrical"), (MESSAGE, "ros1", CASES, run.WIDE_REFERENCES)]


@pytest.mark.parametrize(
    ("oracle", "cases", "found", "error", "words"),
    [
        (object(), [], {}, NotJudgedError, "it has no packet that is short enough"),
        (WIDE, CASES, {"failures": ("a", "b"), "by": ("fastcdr",)}, AssertionError, "a"),
        (WIDE, CASES, {}, AssertionError, "fastcdr could not write the type's wide text"),
    ],
)
def test_a_bench_without_packets_that_are_right_has_not_passed(
    monkeypatch, oracle, cases, found, error, words
):
    with pytest.raises(error, match=f"^{words}$"):
        cases_of(monkeypatch, oracle, cases, **found)


@pytest.mark.parametrize(
    ("given", "distro"), [({}, "lyrical"), ({"paths": ("p",)}, None), ({"wire": "ros1"}, "lyrical")]
)
def test_what_is_built_is_what_was_asked_for(monkeypatch, given, distro):
    test = a_test("std_msgs/msg/Bool", bus_bytes=4)
    asked, library = {}, SimpleNamespace(message=lambda name: (name, MESSAGE))
    message, wire = (test.type, MESSAGE), given.get("wire")

    def noted(name, answer=None):
        monkeypatch.setattr(run, name, lambda *given: asked.update({name: given}) or answer)

    def build(names, folder, *, library, options, stimuli):
        asked["build"] = names, library, options.wire, options.bus_bytes, stimuli("any", 1)
        raise run.ToolError("it stops")

    noted("library_of", library)
    noted("check_wire")
    noted("plan_of", "plan")
    noted("check_size")
    noted("_cases", PACKETS)
    monkeypatch.setattr(run, "build", build)
    record = run.run_bench((Options(**given), "ghdl"), test)
    assert record.verdict == Failed(("it stops",))
    assert asked == {
        "library_of": (test.distro, Options(**given)),
        "check_wire": (message,),
        "plan_of": (message, wire, test.bus_bytes, DEFAULT_MAX_MESSAGE_BYTES),
        "check_size": ("plan",),
        # What the user defined is judged by its own definition.
        "_cases": (message, "plan", distro),
        "build": ([test.type], library, wire, test.bus_bytes, [b"\0\1", b"\2"]),
    }

    def refuse(plan):
        raise BuildError("it is too large")

    monkeypatch.setattr(run, "check_size", refuse)
    record = run.run_bench((Options(**given), "ghdl"), test)
    assert record.verdict == NotJudged("it is too large")
