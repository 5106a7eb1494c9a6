"""Control messages on the host: registers of a node, and its clock, which follows the host's."""

from __future__ import annotations

import random
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
from firm_hdl.node.timekeeping import ClockKeeper, with_seconds_of
from tests.node.samples import read

NOMINAL = nominal_rate(100e6)
START = 1_700_000_000 * 10**9


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


class SimulatedClock:
    """A node's clock with a crystal that is wrong."""

    def __init__(self, error):
        self.error, self.rate = error, NOMINAL
        self.host_ns, self.node_ns = START, 0.0

    def at(self, host_ns):
        passed = host_ns - self.host_ns
        self.node_ns += passed * (1 + self.error) * self.rate / NOMINAL
        self.host_ns = host_ns
        return self.node_ns

    def do(self, host_ns, request):
        self.at(host_ns)
        if request.operation == Operation.SET_TIME:
            self.node_ns = request.seconds * 10**9 + request.nanoseconds
        else:
            self.rate = request.argument


def run(error, jitter_ns, seconds=90, keeper=None):
    """Return the offsets in ns after each second, and how often the time was set."""
    clock, keeper, rng = SimulatedClock(error), keeper or ClockKeeper(NOMINAL), random.Random(1)
    offsets, sets, now = [], 0, START
    for second in range(seconds):
        now = START + second * 10**9
        there, back = (rng.randint(50_000, 50_000 + jitter_ns) for _ in range(2))
        node = int(clock.at(now + there))
        whole, part = divmod(node, 10**9)
        response = ControlResponse(
            operation=1, result=Result.OK, value=0, seconds=whole, nanoseconds=part
        )
        request = keeper.sample(now, response, now + there + back)
        if request is not None:
            sets += request.operation == Operation.SET_TIME
            clock.do(now + 2 * (there + back), request)
        later = now + 900_000_000
        offsets.append(clock.at(later) - later)
    return offsets, sets


@pytest.mark.parametrize("error", [-100e-6, 0, 37e-6, 100e-6])
def test_a_clock_is_set_once_and_then_kept_in_step(error):
    keeper = ClockKeeper(NOMINAL)
    offsets, sets = run(error, jitter_ns=20_000, keeper=keeper)
    assert sets == 1 and keeper.error is None
    assert all(abs(offset) < 30_000 for offset in offsets[60:])


@pytest.mark.parametrize("error", [-0.5, -2e-3, 900e-6, 76.923 / 75 - 1, 1])
def test_a_clock_of_another_frequency_is_found(error):
    keeper = ClockKeeper(NOMINAL)
    run(error, jitter_ns=20_000, keeper=keeper)
    assert keeper.error == pytest.approx(error, rel=0.2)


def test_a_host_that_sets_its_own_clock_has_no_wrong_node():
    keeper = ClockKeeper(NOMINAL)
    for second in range(9):
        sampled(keeper, START + second * 10**9, 2 * 10**9 if second in (3, 5) else 0)
    assert keeper.error is None


def test_a_clock_in_tai_has_the_seconds_of_the_system():
    for ahead in (37 * 10**9 + 400_000_000, -START):
        clock = with_seconds_of(lambda: START, lambda ahead=ahead: START + ahead)
        assert clock() == START + (400_000_000 if ahead > 0 else 0)


def sampled(keeper, sent_ns, offset_ns, delay=100_000):
    """Give a keeper the response of a node whose clock is so far ahead; return its request."""
    seconds, part = divmod(sent_ns + delay // 2 + offset_ns, 10**9)
    response = ControlResponse(
        operation=1, result=Result.OK, value=0, seconds=seconds, nanoseconds=part
    )
    return keeper.sample(sent_ns, response, sent_ns + delay)


@pytest.mark.parametrize("offset", [-900_000, 900_000])
def test_a_rate_is_changed_by_500_ppm_at_most(offset):
    """However long the clock has been too far ahead, or behind."""
    keeper = ClockKeeper(NOMINAL)
    found = [sampled(keeper, START + second * 10**9 // 8, offset) for second in range(20)]
    assert found[0] is None
    assert {each.operation for each in found[1:]} == {Operation.SET_RATE}
    limit = NOMINAL * 500e-6 * (-1 if offset > 0 else 1)
    assert {each.argument for each in found[1:]} == {NOMINAL + round(limit)}
    # What was learnt has the same limit, so it is unlearnt in less than a minute.
    found = [sampled(keeper, START + (3 + second) * 10**9, -offset // 3) for second in range(30)]
    assert (found[-1].argument - NOMINAL) * limit < 0


@pytest.mark.parametrize(
    ("offset", "delay", "sets"),
    [
        (1_000_000, 100_000, False),
        (1_000_001, 100_000, True),
        (-1_000_001, 100_000, True),
        # A delay that is longer says less: the clock may be right.
        (5_000_000, 20_000_000, False),
        (20_000_001, 20_000_000, True),
    ],
)
def test_a_clock_is_set_only_if_it_is_certainly_far_away(offset, delay, sets):
    keeper = ClockKeeper(NOMINAL)
    for second in range(3):
        sampled(keeper, START + second * 10**9, 0)
    request = sampled(keeper, START + 3 * 10**9, offset, delay)
    assert (request is not None and request.operation == Operation.SET_TIME) is sets


def test_a_clock_that_was_set_is_not_corrected_by_times_of_before():
    keeper = ClockKeeper(NOMINAL)
    for second, offset, operation in (
        (0, 0, None),
        (1, 0, Operation.SET_RATE),
        (2, 10**9, Operation.SET_TIME),
        (3, 0, None),
        (4, 0, Operation.SET_RATE),
    ):
        request = sampled(keeper, START + second * 10**9, offset)
        assert (request and request.operation) == operation, second


def test_a_keeper_that_never_changes_the_rate_is_found():
    """The twin: without corrections, 100 ppm are 10 ms after 100 s."""

    class Idle(ClockKeeper):
        def sample(self, sent_ns, response, received_ns):
            request = super().sample(sent_ns, response, received_ns)
            return request if request and request.operation == Operation.SET_TIME else None

    offsets, _ = run(100e-6, 1_000, keeper=Idle(NOMINAL))
    assert max(map(abs, offsets[60:])) > 30_000
