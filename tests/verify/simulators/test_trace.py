# amaranth: UnusedElaboratable=no
"""Traces: the format of their rows, and reading rows back."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.sim import RunOptions, Stalls
from firm_hdl.sim.harness import Harness
from firm_hdl.verify.simulators.trace import Trace, read_row
from firm_hdl.verify.ts3.circuit import first_wrong_port, replay_failures

PACKETS = [bytes((0, 1, 0, 0, value)) for value in (1, 0, 1)]


@pytest.fixture(scope="module")
def recorded():
    """A trace of two runs with a `Bool` on a bus of two bytes, and what was seen in them."""
    message = load_message("std_msgs/msg/Bool")
    options = {"bus_bytes": 2, "max_message_bytes": 99}
    rx, tx = Deserializer(message, **options), Serializer(message, **options)
    trace = Trace((rx, tx), message.name)
    harness = Harness(rx, tx, message=message, probes=trace.probes)
    seen = []
    for name, stalls in (("plain", None), ("stalled", {"packets_in": Stalls.bits("01")})):
        trace.start(name)
        seen.append(harness.run_packets(PACKETS, RunOptions(stalls=stalls, observe=trace.observe)))
    return trace, seen


def test_rows_have_changes_and_resets_separate_runs(recorded):
    trace, _ = recorded
    first = dict(read_row(trace.stimuli[0].removeprefix("1 ")))
    # The reset is released, and every port is written once.
    assert first == {0: "1"} | {pin.number: "0" * pin.port.width for pin in trace.inputs}
    assert set(dict(read_row(trace.expected[0]))) == {pin.number for pin in trace.outputs}
    # The first beat has two bytes and is not the last, so `count` has no meaning.
    beats = [dict(read_row(row.partition(" ")[2])) for row in trace.stimuli[1:9]]
    assert (beats[0][1], beats[0][4]) == ("0000000100000000", "1")
    assert {beat[2] for beat in beats if 2 in beat} > {"11"}
    # The second byte of the last beat is absent, not zero.
    last = next(beat for beat in beats if beat.get(3) == "1")
    assert last[1].endswith("00000001") and last[1] != "0000000000000001"
    at = trace.stimuli.index("0 0 0")
    assert at == trace.runs[1][1]
    assert trace.stimuli[at + 1] == "0"
    assert trace.stimuli[at + 2].startswith("1 0 1 ")
    assert len(trace.stimuli) == len(trace.expected) + 2
    assert trace.run_of(at - 1) == ("plain", at - 1)
    assert trace.run_of(at + 3) == ("stalled", 3)


def test_exactly_the_changed_bits_are_written():
    message = load_message("std_msgs/msg/Bool")
    options = {"bus_bytes": 1, "max_message_bytes": 99}
    trace = Trace((Deserializer(message, **options), Serializer(message, **options)), message.name)
    trace.start("bits")
    nothing = [0] * len(trace.probes)
    trace.observe(nothing)
    told = set()
    for index, probe in enumerate(trace.probes):
        for bit in range(len(probe)):
            trace.observe([*nothing[:index], 1 << bit, *nothing[index + 1 :]])
            rows = (trace.stimuli[-1].partition(" ")[2], trace.expected[-1])
            changes = [(side, *each) for side, row in enumerate(rows) for each in read_row(row)]
            ((side, number, bits),) = changes
            assert bits.count("1") == 1
            told.add((side, number, bits))
            trace.observe(nothing)
    # Each bit of each port once.
    assert len(told) == sum(pin.port.width for pin in [*trace.inputs, *trace.outputs])


@pytest.mark.parametrize("fewer", [1, 9, 40])
def test_missing_and_surplus_rows_are_reported(recorded, fewer):
    trace, _ = recorded
    rows = trace.expected
    count = len(rows)
    assert first_wrong_port(trace, rows[:-fewer]) == f"{count - fewer} cycles instead of {count}"
    assert first_wrong_port(trace, [*rows, *[""] * fewer]) == (
        f"{count + fewer} cycles instead of {count}"
    )


def test_a_simulator_that_shows_nothing_is_no_pass(recorded):
    silent = SimpleNamespace(title="silent", replay=lambda *given: [])
    assert replay_failures(silent, recorded[0], list) == ["silent: no cycle was compared"]
