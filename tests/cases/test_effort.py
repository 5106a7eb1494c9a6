"""The effort limit: how much of a type is simulated, and how the rest is reported."""

from __future__ import annotations

import pytest

import firm_hdl.cases.effort as effort
import firm_hdl.verify.ts3.acceptance as acceptance
from firm_hdl.cases.make import Case
from firm_hdl.frontend import Library
from firm_hdl.plan import Edge, build_plan
from firm_hdl.verify.results.verdict import NotJudged
from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.strategies import make
from tests.verify.judged import accept, assert_passed

HEADER = "std_msgs/msg/Header"
PIXELS = by_depth(600, 3000)


@pytest.fixture(scope="module")
def plan():
    return build_plan(lay_out(Library("lyrical").message(HEADER), "cdr"), bus_bytes=8)


@pytest.fixture(scope="module")
def whole():
    """All cases of a type, without a limit."""
    return accept("lyrical", HEADER)


def some_edges(*numbers):
    return frozenset(Edge(number, "body") for number in numbers)


def test_small_types_are_simulated_completely(plan):
    assert effort.packets_to_simulate(plan, [bytes(8)] * 5, [some_edges(1)] * 5) == [0, 1, 2, 3, 4]


def test_cases_with_most_decisions_for_their_size_come_first(plan):
    packets = [bytes(8000), bytes(80), bytes(8), bytes(16)]
    taken = [some_edges(1, 2, 3), some_edges(1, 2), some_edges(1), some_edges(3)]
    work = effort.work_of(plan, 24)
    # The second case takes a new decision and may cost more; the first takes none.
    assert effort.packets_to_simulate(plan, packets, taken, most=work) == [2, 3]
    assert effort.packets_to_simulate(plan, packets, taken, most=2 * work) == [1, 2, 3]


def test_new_decisions_may_cost_four_times_as_much(plan):
    work = effort.work_of(plan, 8)
    # The second packet takes what the first one took, the third something else, too.
    taken = [some_edges(1, 2), some_edges(1, 2), some_edges(2, 3)]
    assert effort.packets_to_simulate(plan, [bytes(8)] * 3, taken, most=work) == [0, 2]
    taken = [some_edges(number) for number in range(9)]
    assert effort.packets_to_simulate(plan, [bytes(8)] * 9, taken, most=work) == [0, 1, 2, 3]
    assert effort.packets_to_simulate(plan, [bytes(8)] * 9, taken, most=9 * work) == [*range(9)]


def test_work_is_beats_times_leaves(plan):
    # The four streams of a Header count as eight.
    assert [effort.work_of(plan, size) for size in (0, 1, 8, 9)] == [0, 8, 8, 16]
    message = make("ros2", {f"f{n}": "uint8" for n in range(11)})
    assert effort.work_of(build_plan(lay_out(message), bus_bytes=2), 3) == 2 * 11


def test_limits_of_sizes_and_work(plan):
    assert [effort.message_limit(size) for size in (5, 32768, 32769)] == [65536, 65536, 98305]
    assert not effort.too_large(plan, 1_500_000)
    assert "has 1500001 bytes, and its circuits 4 streams" in effort.too_large(plan, 1_500_001)

    def cases(*sizes):
        return [Case(what="", value=None, packet=bytes(n), transfers={}) for n in sizes]

    assert not effort.is_large(plan, cases(100_000, 200_000))
    assert effort.is_large(plan, cases(100_000, 200_001))
    many = cases(*range(1, 10))
    assert effort.cases_to_disturb(plan, many) == [many[0], many[4], many[8]]
    many = cases(200_000, 1, 1, 1, 100_001, 1, 1, 1, 7)
    assert effort.cases_to_disturb(plan, many) == [many[4], many[8]]


def test_types_are_simulated_in_part(monkeypatch, whole):
    monkeypatch.setattr(
        acceptance,
        "packets_to_simulate",
        lambda plan, *given: effort.packets_to_simulate(plan, *given, most=effort.work_of(plan, 8)),
    )
    part = accept("lyrical", HEADER)
    assert assert_passed(part) and 0 < part.cycles < whole.cycles
    assert part.cases == whole.cases
    # Cases that were not simulated do not count as covered, although the golden model ran them.
    assert part.coverage.taken < whole.coverage.taken == whole.coverage.possible
    assert f"of {whole.cases + 1} packets" in part.note and not whole.note
    # A given number of cases is kept.
    few = CaseOptions(most_cases=3, stalled=False, broken=False)
    assert not accept("lyrical", HEADER, few).note


def test_types_near_the_limit_are_not_stalled(monkeypatch, whole):
    monkeypatch.setattr(effort, "LARGE_WORK", 1)
    once = accept("lyrical", HEADER)
    assert assert_passed(once) and once.note == "neither stalled nor damaged"
    assert once.cycles < whole.cycles and once.packets < whole.packets / 2


@pytest.fixture
def large(tmp_path):
    folder = tmp_path / "large_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Image.msg").write_text(f"uint8[{PIXELS}] pixels\nuint8 last\n")
    (folder / "Cloud.msg").write_text("uint8[6000000] points\nuint8 last\n")
    return CaseOptions(paths=(str(tmp_path),))


def test_long_messages_are_simulated(large, monkeypatch):
    monkeypatch.setattr(effort, "MOST_CASE_BYTES", 1)
    monkeypatch.setattr(effort, "MAX_MESSAGE_BYTES", PIXELS - 100)
    result = accept("lyrical", "large_msgs/msg/Image", large)
    assert assert_passed(result) == 2 * result.cases == 2
    assert result.beats > PIXELS // 8


def test_types_over_the_limit_are_named(large):
    result = accept("lyrical", "large_msgs/msg/Cloud", large)
    assert not result.packets
    assert result.verdict == NotJudged(
        "too large to simulate: its smallest message has 6000005 bytes, and its circuits 2 streams"
    )
