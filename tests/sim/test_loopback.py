# amaranth: UnusedElaboratable=no
"""Converters run as functions, and the reports of the harness."""

from __future__ import annotations

from functools import cache

import pytest
from amaranth.hdl import Cat, Module, Signal
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.frontend import load_message
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.gateware.signatures import Status
from firm_hdl.plan import build_plan
from firm_hdl.sim import (
    DeadlineError,
    Harness,
    RunOptions,
    Stalls,
    decode,
    encode,
    leaf_name,
    leaf_streams,
    loopback,
    to_transfers,
)
from firm_hdl.sim.bench import Bench, Job, Ports
from firm_hdl.sim.transfers import PendingTransfers, split_transfers, transfer_table
from firm_hdl.wire import lay_out
from tests.depth import THOROUGH, by_depth
from tests.sim.components import Faulty, Relay
from tests.strategies import make

IMAGE = load_message("sensor_msgs/msg/CompressedImage", distro="humble")
JOINTS = load_message("trajectory_msgs/msg/JointTrajectory", distro="humble")
VALUE = {
    "header": {"stamp": {"sec": -2, "nanosec": 3}, "frame_id": "map"},
    "format": "",
    "data": list(range(37)),
}
PACKET = bytes.fromhex(
    "00010000 feffffff 03000000 04000000 6d617000 01000000 00 000000 25000000"
) + bytes(range(37))


# Types with few leaves, whose circuits are built sooner.
TEXT = make("ros2", {"a": "uint8", "s": "string"}, "Text")
TEXT_PACKET = b"\0\1\0\0\7\0\0\0\3\0\0\0hi\0"
SHORT, SHORT_PACKET = by_depth((TEXT, TEXT_PACKET), (IMAGE, PACKET))
TINY, TINY_PACKET = make("ros2", {"a": "uint8"}, "Tiny"), b"\0\1\0\0\7"
POINT = make(
    "ros2", {"positions": "float64[]", "accelerations": "float64[]", "sec": "int32"}, "Point"
)
PATH = make("ros2", {"frame_id": "string", "joint_names": "string[]", "points": (POINT, "[]")})


def plan_of(message, bus_bytes=8):
    return build_plan(lay_out(message), bus_bytes=bus_bytes, max_message_bytes=1 << 24)


def point(count):
    return {
        "positions": [0.5] * count,
        "velocities": [],
        "accelerations": [1.0],
        "effort": [],
        "time_from_start": {"sec": 1, "nanosec": 2},
    }


TRAJECTORY = {
    "header": {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": "é"},
    "joint_names": ["a", "", "long name"],
    "points": [point(0), point(1), point(3)],
}
WAY = {
    "frame_id": "é",
    "joint_names": ["a", "", "long name"],
    "points": [
        {"positions": [0.5] * count, "accelerations": [1.0], "sec": 1} for count in (0, 1, 3)
    ],
}


def test_loopback_returns_all_observations():
    seen = loopback(IMAGE, [PACKET, PACKET])
    plan = plan_of(IMAGE)
    once = to_transfers(plan, IMAGE, VALUE)
    assert seen.transfers == {leaf: payloads * 2 for leaf, payloads in once.items()}
    assert seen.sent_statuses == [Status.OK, Status.OK]
    assert seen.packet_errors == [False, False]
    assert seen.beats_in == seen.beats_out == 2 * -(-len(PACKET) // 8)
    assert seen.beats_out <= seen.cycles <= seen.beats_out + 16


@cache
def without_stalls():
    return loopback(IMAGE, [PACKET] * 3)


@cache
def gated():
    """Return the harness of a loopback with stalls of leaves, which is built once."""
    return Harness(Deserializer(IMAGE), Serializer(IMAGE), gated=True)


@pytest.mark.parametrize(
    "stalls",
    [
        Stalls(0.3, 1, 9, seed=4),
        {"packets_in": Stalls.bits("01")},
        {"packets_out": Stalls.bits("0001")},
        {"status": Stalls.bits("0" * 40 + "1")},
        {"message.data": Stalls(0.9, 3, 3)},
        {"message": Stalls.bits("001"), "message.data": Stalls.none},
    ],
)
@pytest.mark.sampled(6)
def test_stalls_change_nothing_but_the_time(stalls):
    free, packets = without_stalls(), [PACKET] * 3
    if isinstance(stalls, Stalls) or THOROUGH:
        stalled = loopback(IMAGE, packets, stalls=stalls)
    else:
        stalled = gated().run_packets(packets, RunOptions(stalls=stalls))
    assert (stalled.packets, stalled.statuses) == tuple(free)
    assert stalled.transfers == free.transfers
    if "status" not in (stalls if isinstance(stalls, dict) else ()):
        assert stalled.cycles > free.cycles


def test_loopback_on_the_wire_that_is_asked_for():
    message = TEXT
    ros1 = b"\7\2\0\0\0hi"
    assert tuple(loopback(message, [ros1], wire="ros1")) == ([ros1], [Status.OK])
    assert loopback(message, [ros1], wire="cdr").statuses == [Status.ENCAPSULATION]


def test_loopback_has_the_limit_that_is_asked_for():
    long = TEXT_PACKET[:8] + b"\x10\0\0\0" + bytes(16)
    assert loopback(TEXT, [long], max_message_bytes=40).statuses == [Status.OK]
    assert loopback(TEXT, [long], max_message_bytes=20).statuses == [Status.LENGTH]


def test_decode_gives_transfers_and_statuses():
    transfers, statuses = decode(IMAGE, [PACKET[:20], PACKET], stalls=Stalls(0.4, 1, 3))
    assert statuses == [Status.TRUNCATED, Status.OK]
    plan = plan_of(IMAGE)
    messages, _ = split_transfers(transfer_table(plan, IMAGE), transfers)
    assert len(messages) == 2
    assert messages[1] == {
        leaf: payloads for leaf, payloads in to_transfers(plan, IMAGE, VALUE).items() if payloads
    }


def test_encode_takes_transfers_that_are_wrong():
    plan = plan_of(IMAGE)
    transfers = to_transfers(plan, IMAGE, VALUE)
    (items,) = (n for n, leaf in enumerate(plan.leaves) if leaf.path == ("data", "items"))
    lanes, _ = transfers[items][0]
    transfers[items][0] = (lanes, True)
    result = encode(IMAGE, [transfers, VALUE])
    assert result.statuses == [Status.ITEMS, Status.OK]
    assert result.packet_errors == [True, False]
    assert result.packets[1] == PACKET
    assert not result.not_taken


@pytest.mark.thorough
def test_nested_sequences_are_split_into_messages():
    message, value = by_depth((PATH, WAY), (JOINTS, TRAJECTORY))
    plan = plan_of(message)
    packets, _ = encode(message, [value] * 3)
    seen = loopback(message, packets, stalls=Stalls(0.2, 1, 3))
    assert seen.packets == packets
    one = {leaf: p for leaf, p in to_transfers(plan, message, value).items() if p}
    messages, rest = split_transfers(transfer_table(plan, message), seen.transfers)
    assert messages == [one] * 3
    assert rest == PendingTransfers(transfer_table(plan, message))


def test_missing_transfers_hit_the_deadline_with_names():
    plan = plan_of(IMAGE)
    transfers = to_transfers(plan, IMAGE, VALUE)
    (length,) = (n for n, leaf in enumerate(plan.leaves) if leaf.path == ("format", "length"))
    transfers[length] = []
    message = (
        r"^No transfer in 51 cycles up to cycle \d+; "
        r"outstanding: status \(0 of 1\), packets_out \(0 of 1\), "
        r"the rest of a packet after \d+ bytes, message\.format\.length \(1\), .*; "
        r"offered and not taken: message\.data\.length, message\.data\.items$"
    )
    with pytest.raises(DeadlineError, match=message):
        encode(IMAGE, [transfers], deadline=50)


def test_leaf_stalls_need_gates():
    harness = Harness(Deserializer(TINY), Serializer(TINY))
    name = leaf_name(harness.plan, 0)
    with pytest.raises(ValueError, match=rf"^Stream '{name}' can be stalled in a gated harness"):
        harness.run_packets([TINY_PACKET], RunOptions(stalls={name: Stalls.bits("01")}))


def test_harness_needs_a_converter():
    with pytest.raises(ValueError, match=r"^A harness needs a deserializer or a serializer$"):
        Harness(None, None)


def test_harness_has_the_input_of_its_first_converter():
    with pytest.raises(ValueError, match=r"^Packets need a harness with a deserializer$"):
        Harness(None, Serializer(TINY)).run_packets([TINY_PACKET])
    for serializer in (None, Serializer(TINY)):
        harness = Harness(Deserializer(TINY), serializer)
        with pytest.raises(ValueError, match=r"^Messages need a harness without a deserializer$"):
            harness.run_messages([])


def test_waveform_is_written(tmp_path):
    path = tmp_path / "loopback.vcd"
    packets, _ = loopback(TINY, [TINY_PACKET], vcd=path)
    assert packets == [TINY_PACKET]
    assert "$enddefinitions" in path.read_text()


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("fault", "error"),
    [
        ("silent", r"^No transfer in \d+ .*; outstanding: packets_out \(0 of 1\); offered and .*"),
        ("unstable", r"^Stream 'packets_out' breaks rule 3 in cycle \d+: payload changed from "),
        ("count", r"^Stream 'packets_out' breaks rule 5 in cycle \d+: count is 3, not 8, in "),
        ("twice", r"^Stream 'sent_status' has more than the 1 expected, in cycle 1$"),
    ],
)
def test_faults_are_found_by_name(fault, error):
    harness = Harness(Deserializer(SHORT), Faulty(fault, SHORT))
    with pytest.raises(AssertionError, match=error):
        harness.run_packets(
            [SHORT_PACKET], RunOptions(stalls={"packets_out": Stalls.bits("001")}, deadline=60)
        )


def test_streams_must_have_different_names():
    port = stream.Signature(8).create(path=("p",))
    with pytest.raises(ValueError, match=r"^Names of streams must differ, not a, a$"):
        Bench(Relay(8), Ports(sources={"a": port}, sinks={"a": port}))


class Echo(wiring.Component):
    """Offers each payload again, three cycles after it was taken."""

    def __init__(self):
        super().__init__({"i": In(stream.Signature(8)), "o": Out(stream.Signature(8))})

    def elaborate(self, platform):
        m = Module()
        left, wait = Signal(2), Signal(range(4))
        m.d.comb += [
            self.i.ready.eq(left == 0),
            self.o.valid.eq((left != 0) & (wait == 0)),
            self.o.payload.eq(7),
        ]
        with m.If(self.i.valid & self.i.ready):
            m.d.sync += left.eq(2)
        with m.Elif(wait):
            m.d.sync += wait.eq(wait - 1)
        with m.Elif(self.o.valid & self.o.ready):
            m.d.sync += [left.eq(left - 1), wait.eq(3)]
        return m


@pytest.mark.parametrize("stalls", [None, {"o": Stalls.bits("0" * 12 + "1")}])
def test_transfers_after_the_end_are_recorded(stalls):
    dut = Echo()
    got = []
    job = Job(
        sources={"i": [7]},
        takes={"o": lambda cycle, bits: got.append(bits)},
        finished=lambda: len(got) >= 1,
        outstanding=lambda: "some",
        options=RunOptions(stalls=stalls),
    )
    Bench(dut, Ports(sources={"i": dut.i}, sinks={"o": dut.o})).run(job)
    assert got == [7, 7]


def test_gates_stay_open_after_what_is_offered():
    # The gated streams keep the rules, too: `valid` does not fall before the transfer.
    rx, tx = Deserializer(IMAGE), Serializer(IMAGE)
    ports = leaf_streams(tx.message, tx.tree).values()
    probes = [Cat(port.valid for port in ports), Cat(port.ready for port in ports)]
    harness = Harness(rx, tx, gated=True, probes=probes)
    waited = fell = 0
    waiting = 0

    def observe(values):
        nonlocal waited, fell, waiting
        valid, ready = values
        waited += waiting != 0
        fell += (waiting & ~valid) != 0
        waiting = valid & ~ready

    stalls = {"message": Stalls(0.5, 1, 2, seed=3), "packets_out": Stalls.bits("0001")}
    seen = harness.run_packets([PACKET] * 4, RunOptions(stalls=stalls, observe=observe))
    assert seen.packets == [PACKET] * 4
    assert waited > 20 and not fell


NAMES = make("ros2", {"names": "string[]"}, "Names")


def test_the_nul_of_one_packet_is_not_written_in_the_next():
    packets = [b"\0\1\0\0\1\0\0\0\2\0\0\0a\0"] * 2
    assert loopback(NAMES, packets).packets == packets
