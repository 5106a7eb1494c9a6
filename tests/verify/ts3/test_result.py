"""The result of a type: its verdict, its test and record, and the command that repeats it."""

from __future__ import annotations

import shlex
from dataclasses import replace

import pytest

from firm_hdl.verify.results.records import PlanCoverage, Seconds
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed
from firm_hdl.verify.systems.options import Options
from firm_hdl.verify.systems.tasks import TypeUnderTest
from firm_hdl.verify.ts3.result import Result, command_of, record_of, same_circuits, test_of
from tests.frontend.workspace import make_files

TASK = TypeUnderTest(distro="humble", name="p/msg/A", same=("humble", "jazzy"))
SILENT = NotJudged("nobody knows")


@pytest.mark.parametrize(
    ("given", "verdict"),
    [
        ({"judged": 3}, Passed(3)),
        ({"judged": 3, "known": ("k",)}, KnownDifference(("k",), 3)),
        ({"judged": 3, "known": ("k",), "obstacle": SILENT}, SILENT),
        ({"judged": 3, "failures": ["a", "b"], "obstacle": SILENT}, Failed(("a", "b"))),
        ({"judged": 3, "failures": ["a"], "known": ("k",)}, Failed(("a",))),
        ({}, NotJudged("no packet was compared with the oracle")),
        ({"known": ("k",)}, NotJudged("no packet was compared with the oracle")),
    ],
)
def test_the_worst_that_is_known_is_the_verdict(given, verdict):
    assert Result(distro="humble", name="p/A", **given).verdict == verdict


def test_notes_are_added():
    result = Result(distro="humble", name="p/A")
    for text in ("one", "two"):
        result.add_note(text)
    assert result.note == "one; two"


USUAL = Options()
OTHER = Options(
    bus_bytes=4,
    wire="ros1",
    seed=3,
    broken=False,
    most_cases=9,
    simulator="ghdl",
    paths=("a", "b c"),
    references=("genpy", "fastcdr"),
    vcd="waves",
)
REPLAY = Options(bags=("x.bag", "y.bag"), longest=100, stalled=False, references=())


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (USUAL, "--distro humble --bus-bytes 8 --seed 0"),
        (
            OTHER,
            "--distro humble --path a --path 'b c' --simulator ghdl --bus-bytes 4 --wire ros1 "
            "--seed 3 --no-broken --cases 9 --reference genpy --reference fastcdr --vcd waves",
        ),
        (
            REPLAY,
            "--distro humble --bag x.bag --bag y.bag --max-message-bytes 100 --bus-bytes 8 "
            "--seed 0 --no-stalls --reference none",
        ),
    ],
)
def test_the_command_has_every_option_that_is_not_usual(options, words):
    text = command_of(options, "humble", "p/msg/A")
    assert shlex.split(text) == shlex.split(f"firm-hdl verify {words} p/msg/A")


@pytest.mark.parametrize(
    ("options", "key"),
    [
        (USUAL, "ts3 python humble p/msg/A cdr/8 seed=0"),
        (
            OTHER,
            "ts3 ghdl humble p/msg/A ros1/4 "
            "seed=3,cases=9,no-broken,references=genpy+fastcdr,path=a,path=b c",
        ),
        (
            REPLAY,
            "ts3 python humble p/msg/A cdr/8 "
            "seed=0,no-stalls,references=,bag=x.bag,bag=y.bag,longest=100",
        ),
    ],
)
def test_the_key_has_everything_that_a_result_depends_on(options, key):
    assert test_of(TASK, options).key == key
    assert test_of(TASK, options).same == ("humble", "jazzy")


def test_a_record_has_what_the_result_has():
    result = Result(distro="humble", name="p/msg/A", judged=5, cases=1, packets=2, beats=3)
    result.cycles, result.simulated_cycles, result.cpu_seconds = 4, 6, 7.5
    result.note, result.shape, result.command = "note", "shape", "command"
    result.seconds, result.metrics = Seconds(testing=8.5), {"leaves": 9.0}
    result.coverage, result.written_by = PlanCoverage(taken=1, possible=2), ("genpy",)
    record = record_of(TASK, result, OTHER, "another test")
    assert record.test == test_of(TASK, OTHER) and record.verdict == Passed(5)
    assert (record.cases, record.packets, record.beats, record.cycles) == (1, 2, 3, 6)
    assert (record.note, record.shape, record.command) == ("note", "shape", "command")
    assert (record.seconds, record.cpu_seconds) == (Seconds(testing=8.5), 7.5)
    assert (record.metrics, record.coverage) == ({"leaves": 9.0}, result.coverage)
    assert record.same_as == "another test" and record.written_by == ("rosbags", "genpy")
    # Only the Python simulation writes waveforms.
    wave = replace(OTHER, simulator="python", vcd="waveforms")
    assert record.waveform_command == command_of(wave, "humble", "p/msg/A")
    assert record_of(TASK, Result(distro="humble", name="p/msg/A"), OTHER).written_by == ()


def test_circuits_are_those_of_the_first_task_with_the_same_plan(tmp_path):
    texts = {f"p/msg/{name}.msg": "string s\n" for name in "ABC"}
    texts |= {"p/msg/Other.msg": "int8 s\n", "p/msg/Wrong.msg": "Such s\n"}
    # These are longer than the usual limit of a message, which their circuits raise.
    texts |= {f"p/msg/{name}.msg": "uint8[20000000] x\n" for name in ("Long", "Longer")}
    options = Options(paths=(str(make_files(tmp_path, texts)),))
    names = ("Wrong", "A", "Other", "B", "C", "Long", "Longer")
    tasks = [TypeUnderTest(distro="lyrical", name=f"p/msg/{n}", same=("lyrical",)) for n in names]
    found = same_circuits(tasks, options)
    assert [(one.name, other.name) for one, other in found.items()] == [
        ("p/msg/B", "p/msg/A"),
        ("p/msg/C", "p/msg/A"),
        ("p/msg/Longer", "p/msg/Long"),
    ]
