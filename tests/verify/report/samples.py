"""Sample results, in the form that a run writes."""

from __future__ import annotations

import math
import random

from firm_hdl.verify.results.file import Results
from firm_hdl.verify.results.records import PlanCoverage, Record, Seconds, Test
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed

__all__ = ["a_record", "a_run", "a_test"]


def a_test(name="std_msgs/msg/Header", **more):
    """Return a test of a type by TS3."""
    known = {
        "system": "ts3",
        "simulator": "python",
        "distro": "lyrical",
        "same": ("kilted", "lyrical"),
        "wire": "cdr",
        "bus_bytes": 8,
        "options": "seed=0",
    }
    return Test(type=name, **{**known, **more})


def a_record(test=None, **more):
    """Return a passed record, with other values where given."""
    known = {
        "verdict": Passed(40),
        "seconds": Seconds(generation=0.1, simulation=0.2, testing=0.01),
        "cpu_seconds": 0.3,
        "cases": 10,
        "packets": 40,
        "cycles": 600,
        "beats": 99,
        "coverage": PlanCoverage(taken=5, possible=5),
        "metrics": {"leaves": 3, "steps": 4},
        "shape": "1234",
        "command": "firm-hdl verify --distro lyrical std_msgs/msg/Header",
        "waveform_command": "firm-hdl verify --distro lyrical --vcd waveforms std_msgs/msg/Header",
    }
    return Record(test=test or a_test(), **{**known, **more})


def a_run(count=60, seed=1):
    """Return a run over many types of some packages, all of which pass."""
    rng = random.Random(seed)
    records = {}
    for number in range(count):
        leaves = 1 + int(math.exp(rng.gauss(2.0, 1.1)))
        work = leaves**1.2 * math.exp(rng.gauss(0, 0.3))
        test = a_test(f"{rng.choice('abcde')}_msgs/msg/Type{number}")
        seconds = Seconds(
            generation=0.08 + 0.006 * work, simulation=0.03 * work, testing=0.002 * work
        )
        records[test.key] = a_record(
            test,
            seconds=seconds,
            cpu_seconds=0.95 * seconds.total,
            metrics={"leaves": leaves, "steps": leaves // 2 + 1, "depth": rng.randint(1, 4)},
            shape=f"{number % 50:016x}",
            coverage=PlanCoverage(taken=3 * leaves, possible=3 * leaves),
        )
    return Results(
        options={"systems": ["ts3"], "seed": 0, "cases": None},
        planned=tuple(record.test for record in records.values()),
        records=records,
        sessions=({"started": "2026-01-01 00:00 UTC", "Python": "3.11.7"},),
    )


VERDICTS = {
    "passed": Passed(7),
    "known": KnownDifference(("some-key",), 7),
    "failed": Failed(("it is wrong",)),
    "not_judged": NotJudged("nobody is here"),
}


def run_of(*records, planned=()):
    tests = (*(record.test for record in records), *planned)
    return Results(planned=tests, records={record.test.key: record for record in records})


def mixed(**counts):
    """Return a run with so many tests of each verdict; `not_run` tests are only planned."""
    records = []
    for name, verdict in VERDICTS.items():
        for number in range(counts.get(name, 0)):
            test = a_test(f"{name}_msgs/msg/T{number}")
            records.append(a_record(test, verdict=verdict, seconds=Seconds(testing=1.0)))
    planned = [a_test(f"not_run_msgs/msg/T{n}") for n in range(counts.get("not_run", 0))]
    return run_of(*records, planned=planned)
