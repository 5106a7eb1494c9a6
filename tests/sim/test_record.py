"""The recorder of a run: collected packets and statuses, and errors for too many."""

from __future__ import annotations

import pytest

from firm_hdl.gateware.signatures import packet_layout
from firm_hdl.plan import build_plan
from firm_hdl.sim.harness import Recorder
from firm_hdl.sim.payloads import all_beats, packet_beats
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
