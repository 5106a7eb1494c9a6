"""Each verdict has the data that justifies it."""

from __future__ import annotations

import json

import pytest

from firm_hdl.verify.results.records import Record, from_json, to_json
from firm_hdl.verify.results.records import Test as Tested
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed

EACH = [
    Passed(3),
    Failed(("status is LENGTH",)),
    NotJudged("rosbags has no wstring"),
    KnownDifference(("rosbags-octal",), 1),
]


TEST = Tested(system="ts2", distro="iron", type="p/A")


def read_back(verdict):
    """Write a verdict as part of a record, and read the record."""
    return from_json(Record, {"test": to_json(TEST), "verdict": verdict}).verdict


@pytest.mark.parametrize("cases", [0, -1, True, 1.0])
@pytest.mark.parametrize("make", [Passed, lambda cases: KnownDifference(("key",), cases)])
def test_nothing_judged_is_no_pass(make, cases):
    with pytest.raises(ValueError, match="at least 1 case"):
        make(cases)


def test_a_failure_without_a_text_is_a_failure():
    assert Failed(("", "  \n", "why")).failures == (
        "failed without saying why",
        "failed without saying why",
        "why",
    )
    with pytest.raises(ValueError, match="at least one text"):
        Failed(())


def test_a_missing_judgement_has_a_reason():
    with pytest.raises(ValueError, match="must have a reason"):
        NotJudged(" ")


@pytest.mark.parametrize("keys", [(), ("",), ("key", " ")])
def test_a_known_difference_has_a_key(keys):
    with pytest.raises(ValueError, match="must have the key"):
        KnownDifference(keys, 1)


@pytest.mark.parametrize("verdict", EACH, ids=lambda each: each.name)
def test_json_reads_back(verdict):
    assert read_back(json.loads(json.dumps(to_json(verdict)))) == verdict
