"""The effort limit: how much of a type is simulated, and how the rest is reported."""

from __future__ import annotations

import pytest

import firm_hdl.verify.cases.effort as effort
import firm_hdl.verify.ts3.acceptance as acceptance
from firm_hdl.frontend import Library
from firm_hdl.plan import Edge, build_plan
from firm_hdl.verify import Options, accept
from firm_hdl.verify.cases.make import Case
from firm_hdl.verify.results.verdict import NotJudged
from firm_hdl.wire import lay_out
from tests.verify.judged import assert_passed

HEADER = "std_msgs/msg/Header"


@pytest.fixture(scope="module")
def plan():
    return build_plan(lay_out(Library("lyrical").message(HEADER), "cdr"), bus_bytes=8)


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


def test_cases_without_new_decisions_fill_the_remaining_effort(plan):
    packets, taken = [bytes(8), bytes(8), bytes(8)], [some_edges(1)] * 3
    work = effort.work_of(plan, 8)
    assert effort.packets_to_simulate(plan, packets, taken, most=2 * work) == [0, 1]


def test_at_least_one_case_is_simulated(plan):
    assert effort.packets_to_simulate(
        plan, [bytes(80), bytes(800)], [some_edges(1)] * 2, most=0
    ) == [0]


def test_types_are_simulated_in_part(monkeypatch):
    whole = accept("lyrical", HEADER)
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
    assert not accept("lyrical", HEADER, Options(most_cases=3)).note


def test_without_the_largest(plan):
    cases = [Case(what="", value=None, packet=bytes(8 * n), transfers={}) for n in (3, 1, 2, 9)]
    assert effort.limit_work(plan, cases, effort.work_of(plan, 48)) == cases[:3]
    assert effort.limit_work(plan, cases, effort.work_of(plan, 40)) == cases[1:3]
    assert effort.limit_work(plan, cases, 0) == []


def test_types_near_the_limit_are_not_stalled(monkeypatch):
    whole = accept("lyrical", HEADER)
    monkeypatch.setattr(effort, "LARGE_WORK", 1)
    once = accept("lyrical", HEADER)
    assert assert_passed(once) and once.note == "neither stalled nor damaged"
    assert once.cycles == whole.cycles and once.packets < whole.packets / 2


@pytest.fixture
def large(tmp_path):
    folder = tmp_path / "large_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Image.msg").write_text("uint8[3000] pixels\nuint8 last\n")
    (folder / "Cloud.msg").write_text("uint8[6000000] points\nuint8 last\n")
    return Options(paths=(str(tmp_path),))


def test_long_messages_are_simulated(large, monkeypatch):
    monkeypatch.setattr(effort, "MOST_CASE_BYTES", 1)
    monkeypatch.setattr(effort, "MAX_MESSAGE_BYTES", 2000)
    result = accept("lyrical", "large_msgs/msg/Image", large)
    assert assert_passed(result) == 2 * result.cases == 2
    assert result.beats > 3000 // 8


def test_types_over_the_limit_are_named(large):
    result = accept("lyrical", "large_msgs/msg/Cloud", large)
    assert not result.packets
    assert result.verdict == NotJudged(
        "too large to simulate: its smallest message has 6000005 bytes, and its circuits 2 streams"
    )
