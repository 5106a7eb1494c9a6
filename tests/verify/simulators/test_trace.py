# amaranth: UnusedElaboratable=no
"""Traces: the format of their rows, and reading rows back."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.sim import RunOptions, Stalls
from firm_hdl.sim.harness import Harness
from firm_hdl.verify.simulators.crosscheck import first_difference, replay_failures
from firm_hdl.verify.simulators.trace import Trace, read_row

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


def rows_of(trace: Trace, name: str) -> list[str]:
    number = [run for run, _ in trace.runs].index(name)
    starts = [*(first for _, first in trace.runs), len(trace.expected)]
    return trace.expected[starts[number] : starts[number + 1]]


def test_pins_are_numbered_over_both_devices_and_the_reset_is_the_first_input(recorded):
    trace, _ = recorded
    assert [device.name for device in trace.devices] == [
        "std_msgs_msg_bool_cdr_2_deserializer_flat",
        "std_msgs_msg_bool_cdr_2_serializer_flat",
    ]
    assert [pin.number for pin in trace.inputs] == list(range(1, len(trace.inputs) + 1))
    assert [pin.number for pin in trace.outputs] == list(range(len(trace.outputs)))
    names = [(pin.device, pin.port.name) for pin in trace.inputs]
    assert names[:4] == [(0, f"s_axis_{name}") for name in ("tdata", "tkeep", "tlast", "tvalid")]
    assert names[-1] == (1, "m_axis_status_tready")


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
    assert first_difference(trace, rows[:-fewer]) == f"{count - fewer} cycles instead of {count}"
    assert first_difference(trace, [*rows, *[""] * fewer]) == (
        f"{count + fewer} cycles instead of {count}"
    )


def test_first_difference_names_run_cycle_port_and_both_values(recorded):
    trace, _ = recorded
    assert first_difference(trace, trace.expected) is None
    assert rows_of(trace, "plain") + rows_of(trace, "stalled") == trace.expected
    tdata = next(p for p in trace.outputs if p.port.name == "m_axis_tdata")
    ready = next(p for p in trace.outputs if p.port.name == "s_axis_tready")
    at = trace.runs[1][1] + 5
    rows = list(trace.expected)
    # Only the first of two differences is reported, and a value holds until it changes.
    rows[at] = f"{rows[at]} {tdata.number} 1111000011110000".strip()
    rows[at + 2] += f" {ready.number} U"
    told = first_difference(trace, rows)
    assert told is not None
    assert told.startswith("stalled, cycle 5: m_axis_tdata of the serializer is 0xf0f0 instead of ")
    rows = list(trace.expected)
    rows[at] = f"{rows[at]} {ready.number} U".strip()
    assert "s_axis_tready of the deserializer is 'U' instead of '" in str(
        first_difference(trace, rows)
    )


def test_a_simulator_that_shows_nothing_is_no_pass(recorded):
    silent = SimpleNamespace(title="silent", replay=lambda *given: [])
    assert replay_failures(silent, recorded[0], list) == ["silent: no cycle was compared"]


def test_a_repeated_value_is_no_difference(recorded):
    trace, _ = recorded
    rows = list(trace.expected)
    number, bits = next(iter(read_row(rows[0])))
    assert not any(number == other for other, _ in read_row(rows[1]))
    rows[1] = f"{rows[1]} {number} {bits}".strip()
    assert first_difference(trace, rows) is None
