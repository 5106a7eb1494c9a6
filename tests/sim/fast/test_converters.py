"""Converters and a gate in both engines, against the harness that runs converters as functions."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest
from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out, connect, flipped

from firm_hdl import (
    Deserializer,
    PacketGate,
    PacketSignature,
    Serializer,
    Status,
    StatusSignature,
    load_message,
)
from firm_hdl.sim import Stalls, encode, loopback
from firm_hdl.sim.fast import FastSimulation, Packet, Transfer
from tests.depth import by_depth
from tests.strategies import make

SMALL = make("ros2", {"a": "uint8", "s": "string", "n": "int16[]"})
HEADER = {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": "map"}
SCAN = {
    "header": HEADER,
    **dict.fromkeys(["angle_min", "angle_max", "angle_increment", "time_increment"], 0.5),
    **dict.fromkeys(["scan_time", "range_min", "range_max"], 1.0),
}
KEYS = [{"key": "k" * n, "value": "v" * (9 - n)} for n in range(4)]
STATUS = {"level": 1, "name": "motor", "message": "", "hardware_id": "x", "values": KEYS}
# Stalls of the streams outside, for both.
STALLS = {
    "packets_in": Stalls.bits("1101"),
    "packets_out": Stalls.bits("011"),
    "status": Stalls.bits("01101"),
}


def values(name: str) -> list[dict]:
    """Return messages of a type."""
    if name == "small":
        return [{"a": n, "s": "text"[:n], "n": list(range(n, 2 * n))} for n in range(6)]
    if name == "sensor_msgs/msg/LaserScan":
        return [SCAN | {"ranges": [0.25] * n, "intensities": [1.0] * (n % 3)} for n in range(9)]
    return [{"header": HEADER, "status": [STATUS] * n} for n in range(4)]


def message_of(name: str):
    return SMALL if name == "small" else load_message(name)


@cache
def packets_of(name: str, bus_bytes: int) -> list[bytes]:
    """Return packets of a type, some of them damaged."""
    good = encode(message_of(name), values(name), bus_bytes=bus_bytes).packets
    return [each for n, whole in enumerate(good) for each in (whole, whole[: -1 - n], whole)]


class Loop(wiring.Component):
    """A deserializer and a serializer of one type."""

    def __init__(self, message, bus_bytes: int):
        self.message, self.bus_bytes = message, bus_bytes
        packets = PacketSignature(bus_bytes)
        super().__init__(
            {"packets_in": In(packets), "packets_out": Out(packets), "status": Out(StatusSignature)}
        )

    def elaborate(self, platform):
        m = Module()
        m.submodules.rx = rx = Deserializer(self.message, bus_bytes=self.bus_bytes)
        m.submodules.tx = tx = Serializer(self.message, bus_bytes=self.bus_bytes)
        connect(m, flipped(self.packets_in), rx.packets)
        connect(m, rx.message, tx.message)
        connect(m, tx.packets, flipped(self.packets_out))
        connect(m, rx.status, flipped(self.status))
        m.d.comb += tx.status.ready.eq(1)
        return m


def run(design, engine, packets, stalls, cache: Path) -> tuple[list[Packet], list[Transfer]]:
    # What compiles fastest.
    options = ["-O0"]
    simulated = FastSimulation(design, engine=engine, stalls=stalls, cache=cache, options=options)
    with simulated as simulation:
        simulation.send_packets("packets_in", packets, counts=True)
        simulation.run_until_idle(quiet=300)
        return simulation.packets("packets_out"), simulation.transfers("status")


@pytest.mark.parametrize("stalls", [None, STALLS], ids=["no stalls", "stalls"])
@pytest.mark.parametrize(
    ("name", "bus_bytes"),
    by_depth(
        [("small", 4)],
        [
            ("small", 1),
            ("sensor_msgs/msg/LaserScan", 8),
            ("diagnostic_msgs/msg/DiagnosticArray", 4),
        ],
    ),
)
@pytest.mark.sampled(2)
def test_converters_do_as_in_the_harness(name, bus_bytes, stalls, tmp_path):
    packets = packets_of(name, bus_bytes)
    message = message_of(name)
    expected = loopback(message, packets, bus_bytes=bus_bytes, stalls=stalls)
    results = [
        run(Loop(message, bus_bytes), engine, packets, stalls, tmp_path)
        for engine in by_depth(["amaranth"], ["amaranth", "verilator"])
    ]
    for out, statuses in results:
        assert [each.data for each in out] == expected.packets
        assert [Status(each.bits) for each in statuses] == expected.statuses
    if stalls is None:
        # From the first beat in, which is in cycle 0.
        assert results[0][0][-1].cycle + 1 == expected.cycles
    assert all(each == results[0] for each in results)
    assert {Status.OK, Status.TRUNCATED} <= set(expected.statuses)


@pytest.mark.thorough
def test_a_gate_with_much_memory(tmp_path):
    """Bad packets are dropped, in the same cycles in both engines."""
    packets = packets_of("small", 8)
    large = encode(SMALL, [{"a": 1, "s": "x" * 20_000, "n": [1]}]).packets
    results = [
        run(
            PacketGate(SMALL, bus_bytes=8, memory_bytes=1 << 16, packets=64, when_full="wait"),
            engine,
            [*packets, *large],
            None,
            tmp_path,
        )
        for engine in ("verilator", "amaranth")
    ]
    assert results[0] == results[1]
    good = [packet for n, packet in enumerate(packets) if n % 3 != 1]
    assert [each.data for each in results[0][0]] == [*good, *large]
