"""Records: the stored data of a test, its JSON form, and references to other tests."""

from __future__ import annotations

import pytest

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


@pytest.mark.parametrize(
    "name",
    ["note", "seconds", "cpu_seconds", "cases", "coverage", "metrics", "verdicts", "written_by"],
)
def test_each_part_of_a_record_is_read_back(name):
    given = to_json(RECORD)
    found = from_json(Record, given)
    expected = {"seconds": Seconds(generation=1.0, simulation=2.0, testing=3.5)}
    expected |= {"cpu_seconds": 0.123457, "metrics": {"fields": 3.0}}
    assert getattr(found, name) == expected.get(name, getattr(RECORD, name))
    without = from_json(Record, {n: value for n, value in given.items() if n != name})
    assert getattr(without, name) == getattr(Record(test=WHOLE, verdict=Passed(1)), name)


@pytest.mark.parametrize(
    ("given", "output"),
    [
        ([], "A record must be an object, not a list"),
        ({}, "Test must be an object, not nothing"),
        ({"test": {"system": "x", "size": 1, "age": 2}}, "Test has no age, size"),
    ],
)
def test_invalid_records_are_refused(given, output):
    with pytest.raises(ValueError) as error:
        from_json(Record, given)
    assert str(error.value) == output


def test_parts_of_a_record_are_refused_by_name():
    whole = {
        "test": {"system": "ts2", "distro": "iron", "type": "p/A"},
        "verdict": {"verdict": "passed", "cases": 1},
    }
    for part, output in {
        "seconds": "Seconds must be an object, not a number",
        "coverage": "PlanCoverage must be an object, not a number",
        "test": "Test must be an object, not a number",
    }.items():
        with pytest.raises(ValueError) as error:
            from_json(Record, {**whole, part: 3})
        assert str(error.value) == output
    with pytest.raises(ValueError, match="What an oracle says must be an object, not a number"):
        from_json(Record, {**whole, "verdicts": [3]})
    with pytest.raises(ValueError, match="Test: "):
        from_json(Record, {**whole, "test": {"system": "ts2"}})


@pytest.mark.parametrize(
    ("part", "name", "values"),
    [
        ("test", "type", [7, None]),
        ("test", "same", ["humble", [7], {}]),
        ("test", "bus_bytes", [True, 8.0, "8"]),
        ("seconds", "testing", ["1", None]),
        ("coverage", "missing", [[None], 7]),
        (None, "metrics", [{"steps": None}, [1], {"steps": True}]),
        (None, "written_by", [[True], "rosbags"]),
        (None, "cases", [1.5, None]),
        (None, "verdicts", [[{"oracle": 7, "verdict": "passed", "cases": 1}]]),
    ],
)
def test_values_of_another_type_are_refused(part, name, values):
    whole = {
        "test": {"system": "ts2", "distro": "iron", "type": "p/A", "same": ["iron"]},
        "verdict": {"verdict": "passed", "cases": 1},
        "seconds": {"testing": 1},
        "coverage": {"taken": 1, "possible": 2, "missing": ["x"]},
        "metrics": {"steps": 1, "depth": 1.5},
        "verdicts": [{"oracle": "genmsg", "verdict": "passed", "cases": 1, "is_refused": True}],
        "written_by": ["rosbags"],
        "cases": 3,
    }
    assert from_json(Record, whole).cases == 3
    for value in values:
        wrong = {name: value} if part is None else {part: {**whole[part], name: value}}
        with pytest.raises(ValueError, match=r"must be of another type$"):
            from_json(Record, {**whole, **wrong})
