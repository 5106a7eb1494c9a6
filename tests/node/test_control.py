"""Control messages on the host, and the registers of a node."""

from __future__ import annotations

import struct

import pytest

from firm_hdl.node.control import (
    COUNTERS_FROM,
    ControlRequest,
    ControlResponse,
    Operation,
    Result,
    nominal_rate,
    registers,
)
from tests.node.samples import read


def test_requests_are_the_documented_bytes():
    request = ControlRequest(operation=Operation.SET_TIME, argument=5, seconds=6, nanoseconds=7)
    assert request.encode() == struct.pack("<B3xIII", 2, 5, 6, 7)


def test_responses_are_read():
    response = ControlResponse.decode(struct.pack("<BB2xIII", 1, 2, 3, 4, 5))
    want = ControlResponse(operation=1, result=Result.ARGUMENT, value=3, seconds=4, nanoseconds=5)
    assert response == want
    with pytest.raises(ValueError, match=r"^a response has 16 bytes, not 3$"):
        ControlResponse.decode(b"abc")
    with pytest.raises(ValueError, match="is not a valid Result"):
        ControlResponse.decode(bytes([1, 9]) + bytes(14))


def test_registers_are_numbered_in_the_order_of_topics():
    found = registers(read())
    assert [each.number for each in found[:6]] == list(range(6))
    assert [each.number for each in found[6:]] == list(
        range(COUNTERS_FROM, COUNTERS_FROM + len(found) - 6)
    )
    twist = [each.name for each in found if each.topic == 1]
    assert twist[0] == "passed" and twist[-2:] == ["bytes_low", "bytes_high"]
    assert {each.part for each in found if each.topic == 4} == {"in", "out"}
    names = [(each.owner, each.part, each.name) for each in found]
    assert [name for owner, _, name in names if owner == "/robot/odom"] == [
        *("passed", "aborted", "full", "large"),
        *("bytes_low", "bytes_high"),
    ]
    assert [name for _, part, name in names if part == "node"] == [
        *("unknown", "control", "control_full"),
    ]
    # Two registers of a service have one name, in different directions, and none is twice.
    assert len(set(names)) == len(names)


def test_rates_are_nanoseconds():
    assert nominal_rate(100e6) == 10 << 22
    assert nominal_rate(156.25e6) == round(6.4 * (1 << 22))
