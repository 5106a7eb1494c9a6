# amaranth: UnusedElaboratable=no
"""A packet whose end was dropped never leaves a gate, even if it reads like a good one."""

from __future__ import annotations

import pytest

from firm_hdl import PacketGate
from firm_hdl.sim import Stalls
from tests.gateware.packets.gates import OK, OVERRUN, GateRun
from tests.strategies import make

BEATS = 3


@pytest.mark.sampled(2)
@pytest.mark.parametrize("bus_bytes", [1, 8])
def test_a_packet_that_lost_its_last_beat_is_dropped(monkeypatch, bus_bytes):
    """Any bytes are a message here, and the beat that stands for the lost one is full."""
    monkeypatch.setattr("firm_hdl.gateware.packets.gate.BACKLOG_BEATS", 5)
    message = make("ros1", {"x": f"uint8[{BEATS * bus_bytes}]"})
    packets = [bytes([number]) * (BEATS * bus_bytes) for number in range(40)]
    gate = PacketGate(
        message, wire="ros1", bus_bytes=bus_bytes, memory_bytes=4096, when_full="drop"
    )
    # Statuses are taken in bursts, so the backlog is full at each place of a packet.
    stalls = {"status": Stalls.bits("0" * 37 + "1" * 3)}
    run = GateRun(gate, packets, stalls=stalls, deadline=400)
    assert set(run.statuses) == {OK, OVERRUN}
