"""The recorder of a run: collected packets and statuses, and errors for too many."""

from __future__ import annotations

import random

import pytest

from firm_hdl.gateware.signatures import packet_layout
from firm_hdl.plan import build_plan
from firm_hdl.sim.payloads import all_beats, packet_beats
from firm_hdl.sim.record import Recorder, RunResult
from firm_hdl.sim.transfers import transfer_table
from firm_hdl.sim.watch import StreamRuleError
from firm_hdl.wire import lay_out
from tests.strategies import make

MESSAGE = make("ros1", {"x": "uint8", "y": "uint8[3]"})
PLAN = build_plan(lay_out(MESSAGE), bus_bytes=4)
MARK = 1 << packet_layout(4).size


def recorder(**which):
    return Recorder(PLAN, 1, **{"decodes": True, "encodes": True, **which})


def beat(data, *, last=True, mark=False):
    (bits,) = packet_beats(data, 4)
    return (bits if last else bits & ~(MARK >> 1)) | (MARK if mark else 0)


def test_packets_and_marks_are_collected():
    run = recorder()
    take = run.takes()["packets_out"]
    take(5, beat(b"abcd", last=False))
    take(6, beat(b"e", mark=True))
    assert (run.result.packets, run.result.packet_errors) == ([b"abcde"], [True])
    assert not run.finished()
    assert run.finish().beats_out == 2


def test_mark_belongs_to_the_last_beat():
    take = recorder().takes()["packets_out"]
    message = r"^packet_error is high in cycle 5, with a beat that is not the last$"
    with pytest.raises(AssertionError, match=message):
        take(5, beat(b"abcd", last=False, mark=True))


@pytest.mark.parametrize("name", ["status", "sent_status"])
def test_more_statuses_than_packets_are_an_error(name):
    take = recorder().takes()[name]
    take(1, 0)
    with pytest.raises(AssertionError, match=rf"^Stream '{name}' has more than the 1 expected, in"):
        take(2, 0)


def test_more_packets_than_went_in_are_an_error():
    take = recorder().takes()["packets_out"]
    take(1, beat(b"ab"))
    with pytest.raises(AssertionError, match=r"^Stream 'packets_out' has more than the 1 expected"):
        take(2, beat(b""))


def test_start_of_another_packet_is_an_error():
    run = recorder()
    take = run.takes()["packets_out"]
    take(1, beat(b"ab"))
    take(2, beat(b"abcd", last=False))
    with pytest.raises(AssertionError, match=r"starts an unexpected packet: 61626364$"):
        run.finish()


def test_beats_that_no_packet_has_are_an_error():
    take = recorder().takes()["packets_out"]
    with pytest.raises(StreamRuleError, match="breaks rule 5 in cycle 3"):
        take(3, beat(b"abc", last=False))


@pytest.mark.parametrize(
    ("which", "needed"),
    [
        ({}, {"status", "packets_out", "sent_status"}),
        ({"encodes": False}, {"status"}),
        ({"decodes": False}, {"status", "packets_out"}),
    ],
)
def test_a_run_is_over_with_the_last_of_all_streams(which, needed):
    run = recorder(**which)
    takes = run.takes()
    for name in sorted(needed):
        assert not run.finished()
        assert f"{name} (0 of 1)" in run.outstanding()
        takes[name](1, beat(b"ab") if name == "packets_out" else 0)
    assert run.finished()
    assert run.outstanding() == "nothing"


def test_leaves_are_missing_only_while_a_message_is():
    run = recorder(encodes=False, table=transfer_table(PLAN, MESSAGE))
    takes = run.takes()
    assert run.outstanding() == "status (0 of 1), message.x (1), message.y.items (1)"
    takes["message.y.items"](1, 0)
    assert run.outstanding() == "status (0 of 1), message.x (1)"
    takes["message.x"](2, 0)
    assert run.outstanding() == "status (0 of 1)"
    takes["status"](3, 0)
    assert run.outstanding() == "nothing"


def test_every_transfer_is_kept_whether_it_is_expected_or_not():
    run = recorder()
    takes = run.takes()
    for cycle, value in enumerate((1, 2, 0)):
        takes["message.x"](cycle, value)
    takes["message.y.items"](3, 0x1_00_03_02_01)
    assert run.finish().transfers == {0: [1, 2, 0], 1: [((1, 2, 3, 0), True)]}


def test_cycles_are_counted_from_the_first_in_to_the_last_out():
    run = recorder()
    takes = run.takes()
    takes["packets_in"](3, 0)
    takes["packets_in"](4, 0)
    takes["packets_out"](9, beat(b"ab"))
    takes["status"](12, 0)
    assert run.finish().cycles == 7


def test_cycle_0_is_the_first_of_all():
    run = recorder()
    takes = run.takes()
    takes["packets_in"](0, 0)
    takes["packets_in"](1, 0)
    takes["packets_out"](9, beat(b"ab"))
    assert run.finish().cycles == 10


def test_latency_is_from_the_last_in_to_the_last_out():
    run = recorder()
    takes = run.takes()
    takes["packets_in"](3, 0)
    takes["packets_in"](4, 0)
    takes["packets_out"](9, beat(b"ab"))
    takes["status"](12, 0)
    found = run.finish()
    assert (found.latency, found.end_cycle) == (5, 12)
    assert RunResult().latency == RunResult(last_cycle_in=3).latency == 0
    # The first cycle is a cycle, too.
    assert RunResult(last_cycle_in=2, last_cycle=0).latency == -2
    assert RunResult().end_cycle == -1
    assert RunResult(last_cycle=7, last_status_cycle=5).end_cycle == 7


@pytest.mark.parametrize(
    ("which", "first", "last_in", "last"),
    [
        # A converter alone begins or ends with its leaves.
        ({"encodes": False}, 2, 3, 6),
        ({"decodes": False}, 5, 6, 9),
        ({}, 2, 3, 9),
    ],
)
def test_times_are_those_of_the_streams_outside(which, first, last_in, last):
    run = recorder(**which)
    takes = run.takes()
    if which != {"decodes": False}:
        takes["packets_in"](2, 0)
        takes["packets_in"](3, 0)
    takes["message.x"](5, 7)
    takes["message.y.items"](6, 0)
    if which != {"encodes": False}:
        takes["packets_out"](9, beat(b"ab"))
    found = run.finish()
    assert (found.first_cycle, found.last_cycle_in, found.last_cycle) == (first, last_in, last)


def test_several_packets_are_outstanding_until_the_last():
    options = {"decodes": True, "encodes": True, "table": transfer_table(PLAN, MESSAGE)}
    run = Recorder(PLAN, 3, **options)
    takes = run.takes()
    for count in (1, 2):
        takes["status"](count, 0)
        takes["packets_out"](count, beat(b"ab"))
        takes["message.x"](count, 0)
        takes["message.y.items"](count, 0)
        assert run.outstanding() == (
            f"status ({count} of 3), packets_out ({count} of 3), sent_status (0 of 3), "
            "message.x (1), message.y.items (1)"
        )
        assert not run.finished()
    takes["packets_out"](3, beat(b"abcd", last=False))
    assert "the rest of a packet after 4 bytes, message.x (1)" in run.outstanding()
    takes["packets_out"](4, beat(b"e"))
    takes["message.x"](4, 0)
    takes["message.y.items"](4, 0)
    takes["status"](4, 0)
    assert run.outstanding() == "sent_status (0 of 3)"
    for _ in range(3):
        assert not run.finished()
        takes["sent_status"](5, 0)
    assert run.finished() and run.outstanding() == "nothing"


# Noise that a deserializer has to ignore is present.


@pytest.mark.parametrize("bus_bytes", [2, 8, 64])
def test_lanes_that_are_not_valid_carry_noise(bus_bytes):
    beats = list(all_beats([b"x"] * 40, bus_bytes))
    rest = [bits >> 8 & (1 << 8 * bus_bytes - 8) - 1 for bits in beats]
    for lane in range(bus_bytes - 1):
        values = {each >> 8 * lane & 0xFF for each in rest}
        assert len(values) > 20
    assert {bits & 0xFF for bits in beats} == {0x78}
    assert list(all_beats([b"x"] * 40, bus_bytes)) == beats


def test_counts_of_beats_that_are_not_the_last_are_noise_where_that_is_asked_for():
    packets = [bytes(13)] * 40
    layout = packet_layout(4)

    def counts(**options):
        beats = [layout.from_bits(bits) for bits in all_beats(packets, 4, **options)]
        return [{beat.count for beat in beats if beat.last == last} for last in (0, 1)]

    assert counts() == [{4}, {1}]
    assert counts(counts=True) == [{0, 1, 2, 3, 4}, {1}]


def test_noise_leaves_the_bytes_of_a_packet_as_they_are():
    noise = random.Random(1)
    for beat in packet_beats(b"abcdef", 4, noise, counts=True):
        parts = packet_layout(4).from_bits(beat)
        text = b"ef" if parts.last else b"abcd"
        assert bytes(parts.data)[: len(text)] == text
        assert parts.count == 2 or not parts.last


@pytest.mark.parametrize(
    ("first", "last", "cycles"), [(-1, -1, 0), (0, -1, 0), (0, 0, 1), (3, 3, 1), (3, 7, 5)]
)
def test_cycles_are_counted_with_the_first_and_the_last(first, last, cycles):
    assert RunResult(first_cycle=first, last_cycle=last).cycles == cycles


def test_nothing_is_seen_at_first():
    run = recorder().result
    assert (run.packets, run.packet_errors, run.statuses, run.sent_statuses) == ([], [], [], [])
    assert (run.beats_in, run.beats_out, run.cycles) == (0, 0, 0)
