"""Records: the stored data of a test, its JSON form, and references to other tests."""

from __future__ import annotations

from firm_hdl.verify.results.records import (
    MOST_CHARACTERS,
    OracleVerdict,
    PlanCoverage,
    Record,
    Seconds,
    clipped_verdict,
    from_json,
    to_json,
)
from firm_hdl.verify.results.records import Test as Tested
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed


def clipped(failures):
    return clipped_verdict(Failed(tuple(failures))).failures


WHOLE = Tested(
    system="ts3",
    distro="iron",
    type="p/msg/A",
    same=("iron", "jazzy"),
    simulator="python",
    wire="cdr",
    bus_bytes=8,
    options="seed=1",
)


def test_long_failures_are_cut_and_say_how_long_they_were():
    fits, long = "x" * MOST_CHARACTERS, "y" * (MOST_CHARACTERS + 1)
    start = "y" * MOST_CHARACTERS
    output = f"{start}... ({MOST_CHARACTERS + 1} characters)"
    assert clipped([fits, long, "z"]) == (fits, output, "z")
    assert clipped_verdict(Failed((long, "z"))) == Failed((output, "z"))
    assert clipped_verdict(NotJudged(long)) == NotJudged(output)


RECORD = Record(
    test=WHOLE,
    verdict=KnownDifference(("k", "l"), 3),
    note="note",
    seconds=Seconds(generation=1.0000004, simulation=2.0, testing=3.5),
    cpu_seconds=0.1234567,
    cases=1,
    packets=2,
    cycles=3,
    beats=4,
    coverage=PlanCoverage(taken=0, possible=2, missing=("m", "n")),
    metrics={"fields": 3.0, "none": 0.0},
    shape="shape",
    same_as="other",
    verdicts=(
        OracleVerdict(oracle="one", verdict=Passed(2), is_refused=True),
        OracleVerdict(oracle="two", verdict=Failed(("f", "g"))),
    ),
    written_by=("a", "b"),
    command="command",
    waveform_command="waveform",
)


def test_the_json_of_a_record_is_complete():
    assert to_json(RECORD) == {
        "test": {
            "system": "ts3",
            "distro": "iron",
            "type": "p/msg/A",
            "same": ["iron", "jazzy"],
            "simulator": "python",
            "wire": "cdr",
            "bus_bytes": 8,
            "options": "seed=1",
        },
        "verdict": {"verdict": "known difference", "keys": ["k", "l"], "cases": 3},
        "note": "note",
        "seconds": {"generation": 1.0, "simulation": 2.0, "testing": 3.5},
        "cpu_seconds": 0.123457,
        "cases": 1,
        "packets": 2,
        "cycles": 3,
        "beats": 4,
        # An empty list is written, too.
        "coverage": {"taken": 0, "possible": 2, "missing": ["m", "n"]},
        "metrics": {"fields": 3.0},
        "shape": "shape",
        "same_as": "other",
        "verdicts": [
            {"oracle": "one", "verdict": "passed", "cases": 2, "is_refused": True},
            {"oracle": "two", "verdict": "failed", "failures": ["f", "g"]},
        ],
        "written_by": ["a", "b"],
        "command": "command",
        "waveform_command": "waveform",
    }


def test_a_record_is_read_back():
    given = to_json(RECORD)
    found = from_json(Record, given)
    assert to_json(found) == given and found.verdicts == RECORD.verdicts
    few = {"test": given["test"], "verdict": {"verdict": "passed", "cases": 1}}
    assert from_json(Record, few) == Record(test=WHOLE, verdict=Passed(1))
