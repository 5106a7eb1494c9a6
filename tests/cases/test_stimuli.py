"""The packets for generated test benches: how many there are, and how large they may be."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.cases import NotJudgedError
from firm_hdl.cases import stimuli as module
from firm_hdl.cases.make import Case
from firm_hdl.cases.stimuli import stimuli, stimulus_cases
from firm_hdl.cases.user_oracle import judge_of
from firm_hdl.frontend import Library
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out

BOOL = Library("lyrical").message("std_msgs/msg/Bool")
PLAN = build_plan(lay_out(BOOL), bus_bytes=2, max_message_bytes=100)
JUDGE = judge_of(BOOL)


@pytest.fixture
def made(monkeypatch):
    """A function that replaces the cases by some with packets of given sizes."""

    def replace_cases(*sizes, error=None):
        def make_cases(oracle, name, *, wire, bus_bytes, most):
            assert (name, wire, bus_bytes, most) == ("std_msgs/msg/Bool", "cdr", 2, 16)
            for size in sizes:
                yield Case(what="", value=None, packet=bytes(size), transfers={})
            if error is not None:
                raise error

        monkeypatch.setattr(module, "make_cases", make_cases)

    return replace_cases


def sizes_of(plan=PLAN):
    return [len(case.packet) for case in stimulus_cases(JUDGE, plan)]


def test_packets_end_before_they_are_too_many_bytes(made, monkeypatch):
    monkeypatch.setattr(module, "MOST_BYTES", 60)
    made(10, 20, 30, 1, 1)
    assert sizes_of() == [10, 20, 30]
    made(10, 20, 31, 1)
    assert sizes_of() == [10, 20]
    # The first packet may have any size.
    made(90, 1)
    assert sizes_of() == [90]


def test_sixteen_packets_of_a_type_are_written_for_the_bus_and_the_wire():
    message = Library("noetic").message("std_msgs/String")
    packets = {}
    for bus_bytes in (1, 64):
        plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
        packets[bus_bytes] = stimuli(message, plan)
        assert 5 < len(packets[bus_bytes]) <= 16
        for packet in packets[bus_bytes]:
            assert int.from_bytes(packet[:4], "little") == len(packet) - 4
    # Texts are as long as the words of the bus need.
    assert max(map(len, packets[1])) < 20 < max(map(len, packets[64]))
    cdr = stimuli(message, build_plan(lay_out(message, "cdr"), bus_bytes=8))
    assert {packet[:4] for packet in cdr} == {b"\0\1\0\0"}


def test_wide_text_has_packets_too(make_message):
    message = make_message("wstring w\n")
    plan = build_plan(lay_out(message), bus_bytes=8)
    packets = stimuli(message, plan)
    assert packets and all((len(packet) - 8) % 4 == 0 for packet in packets)
    assert stimuli(message, replace(plan, wire="can")) == []


def test_the_reason_of_the_oracle_is_kept(made):
    made(1, error=NotJudgedError("rosbags does not write can"))
    with pytest.raises(NotJudgedError, match=r"^rosbags does not write can$"):
        sizes_of()
    assert stimuli(BOOL, PLAN) == []
    made(1, error=KeyError("gone"))
    with pytest.raises(NotJudgedError, match=r"^rosbags cannot write it: KeyError: 'gone'$"):
        sizes_of()
