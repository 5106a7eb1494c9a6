# amaranth: UnusedElaboratable=no
"""Traffic from rows that are written by hand: handshakes, packets, runs and resets."""

from __future__ import annotations

import pytest

from firm_hdl import Deserializer, Serializer
from firm_hdl.verify.simulators.crosscheck import first_difference
from firm_hdl.verify.simulators.semantics import traffic
from firm_hdl.verify.simulators.trace import Trace
from tests.strategies import make

IDLE = {"m_axis_tvalid": "0"}
FULL = {"m_axis_tvalid": "1", "m_axis_tkeep": "11", "m_axis_tlast": "0", "m_axis_tuser": "0"}


class Rows:
    """A trace of both converters of a string on a bus of two bytes, and rows for it."""

    def __init__(self):
        message = make("ros1", {"s": "string"})
        options = {"bus_bytes": 2, "max_message_bytes": 99}
        cores = (Deserializer(message, **options), Serializer(message, **options))
        self.trace = Trace(cores, message.name)
        self.shown = []

    def words(self, pins, changes, direction):
        """Return the words of a row, for ports of one of the converters by their names."""
        numbers = {
            pin.port.name: pin.number
            for pin in pins
            if self.trace.devices[pin.device].direction == direction
        }
        return " ".join(
            f"{numbers.pop(name)} {bits}" for name, bits in changes.items() if name in numbers
        )

    def run(self, name, *cycles, direction="serializer"):
        """Add a run: the changes of ports in each cycle. All of its inputs are ready at first."""
        trace = self.trace
        trace.start(name)
        for number, changes in enumerate(cycles):
            ready = {"m_axis_tready": "1", "m_axis_status_tready": "1", "s_items_ready": "1"}
            given = changes if number else ready | changes
            trace.stimuli.append(f"1 {self.words(trace.inputs, given, direction)}".strip())
            self.shown.append(self.words(trace.outputs, changes, direction))
            trace.expected.append(self.shown[-1])

    def traffic(self):
        return traffic(self.trace, self.shown)


@pytest.fixture
def rows():
    return Rows()


def beat(data: bytes, last="0", keep="11", **more):
    """Return the ports of a beat; the first byte is in the lowest bits."""
    bits = f"{int.from_bytes(data, 'little'):016b}"
    return FULL | {"m_axis_tdata": bits, "m_axis_tlast": last, "m_axis_tkeep": keep, **more}


def test_a_packet_is_the_valid_bytes_up_to_its_last_beat(rows):
    rows.run(
        "one",
        beat(b"ab"),
        # Not taken, and offered again.
        beat(b"cd", m_axis_tready="0"),
        {},
        {"m_axis_tready": "1"},
        IDLE,
        beat(b"e?", last="1", keep="01"),
        beat(b"??", last="1", keep="00", m_axis_tuser="1"),
        beat(b"fg", last="1"),
        {},
    )
    (run,) = rows.traffic()
    assert run.packets == [b"abcde", b"", b"fg", b"fg"]
    assert run.packet_errors == [False, True, False, False]


@pytest.mark.parametrize("defined", ["1", "0"])
def test_bytes_that_are_not_defined_are_left_out(rows, defined):
    bits = f"{ord('a'):08b}" + ("X" if defined == "0" else "0") + f"{ord('b'):08b}"[1:]
    rows.run("one", FULL | {"m_axis_tdata": bits, "m_axis_tlast": "1"})
    assert rows.traffic()[0].packets == [b"ba" if defined == "1" else b"a"]


def test_what_a_reset_cuts_is_no_part_of_the_next_packet(rows):
    rows.run("cut", beat(b"ab"))
    rows.run("next", beat(b"cd", last="1"))
    rows.run("last", IDLE)
    cut, following, last = rows.traffic()
    assert [run.name for run in (cut, following, last)] == ["cut", "next", "last"]
    assert (cut.packets, following.packets, last.packets) == ([], [b"cd"], [])


def test_nothing_transfers_during_a_reset(rows):
    """The ports keep their values in the cycles of a reset, a `valid` among them."""
    status = {"m_axis_status_tvalid": "1", "m_axis_status_tdata": "00000110"}
    rows.run("one", beat(b"ab", last="1") | status)
    rows.run("two", IDLE | {"m_axis_status_tvalid": "0"})
    rows.run("three", beat(b"cd", last="1"))
    one, two, three = rows.traffic()
    assert (one.packets, two.packets, three.packets) == ([b"ab"], [], [b"cd"])
    assert (one.sent_statuses, two.sent_statuses, three.sent_statuses) == (["00000110"], [], [])
    assert one.statuses == []


def test_transfers_of_leaves_have_their_last_first(rows):
    items = {"s_items_valid": "1", "s_items_data": "0110001001100001", "s_items_last": "0"}
    status = {"m_axis_status_tvalid": "1", "m_axis_status_tdata": "00000001"}
    rows.run(
        "one",
        items,
        {"s_items_last": "1"},
        {"s_items_valid": "0"} | status,
        {"m_axis_status_tready": "0"},
        direction="deserializer",
    )
    (run,) = rows.traffic()
    assert run.transfers == {1: ["00110001001100001", "10110001001100001"]}
    assert (run.statuses, run.sent_statuses) == (["00000001"], [])


def test_rows_that_are_missing_end_the_traffic(rows):
    rows.run("one", beat(b"ab", last="1"), {})
    rows.run("two", beat(b"cd", last="1"))
    one, two = traffic(rows.trace, rows.shown[:1])
    assert (one.packets, two.packets) == ([b"ab"], [])


def test_the_first_row_of_a_run_belongs_to_it(rows):
    rows.run("one", {}, {})
    rows.run("two", {}, {}, {})
    rows.run("three", {})
    assert [rows.trace.run_of(row) for row in range(6)] == [
        *(("one", 0), ("one", 1)),
        *(("two", 0), ("two", 1), ("two", 2)),
        ("three", 0),
    ]


def test_a_port_that_is_never_shown_is_undefined(rows):
    rows.run("one", beat(b"ab"), {})
    rows.run("two", beat(b"cd"))
    expected = rows.trace.expected
    (last,) = (pin for pin in rows.trace.outputs if pin.port.name == "m_axis_tlast")
    shown = [row.replace(f" {last.number} 0", "") for row in expected]
    assert shown != expected
    difference = "one, cycle 0: m_axis_tlast of the serializer is 'U' instead of '0'"
    assert first_difference(rows.trace, shown) == difference
    # A value that was shown once holds, also over a reset.
    assert first_difference(rows.trace, [expected[0], "", shown[2]]) is None
