# amaranth: UnusedElaboratable=no
"""What a deserializer offers while its packet has not come, and keeps while nobody takes it."""

from __future__ import annotations

import pytest
from amaranth.hdl import Value
from amaranth.sim import Simulator

from firm_hdl import Deserializer, Status
from firm_hdl.gateware.signatures import leaf_streams
from firm_hdl.sim import Harness, RunOptions, Stalls
from firm_hdl.sim.payloads import all_beats
from tests.strategies import make

NOTHING = make("ros1", {}, "Nothing")


def transfers_with_pauses(message, packets, bus_bytes, pause=12):
    """Return the transfers of each pause: before the first packet, and after each packet."""
    rx = Deserializer(message, bus_bytes=bus_bytes)
    leaves = leaf_streams(rx.message, rx.tree)
    outputs = [*leaves.values(), rx.status]
    found = []

    async def testbench(ctx):
        for port in outputs:
            ctx.set(port.ready, 1)
        for packet in [None, *packets]:
            counts = [0] * len(outputs)
            beats = [] if packet is None else list(all_beats([packet], bus_bytes))
            for _ in range(pause + len(beats)):
                ctx.set(rx.packets.valid, bool(beats))
                if beats:
                    ctx.set(Value.cast(rx.packets.payload), beats.pop(0))
                for number, port in enumerate(outputs):
                    counts[number] += ctx.get(port.valid)
                await ctx.tick()
            found.append(counts)

    simulator = Simulator(rx)
    simulator.add_clock(1e-6)
    simulator.add_testbench(testbench)
    simulator.run()
    return found


@pytest.mark.parametrize("bus_bytes", [1, 8])
def test_empty_messages_at_the_start_come_only_with_their_packet(bus_bytes):
    message = make("ros1", {"e": (NOTHING, "[3]"), "x": "uint8"})
    found = transfers_with_pauses(message, [b"\5", b"\6"], bus_bytes)
    assert found == [[0, 0, 0], [3, 1, 1], [3, 1, 1]]


def test_an_empty_packet_has_the_empty_messages_that_it_is_made_of():
    message = make("ros1", {"e": (NOTHING, "[3]")})
    assert transfers_with_pauses(message, [b"", b""], 1) == [[0, 0], [3, 1], [3, 1]]


@pytest.mark.parametrize(
    ("before", "after", "good"),
    [
        ({}, {"a": "uint64[20]"}, bytes(160)),
        ({"x": "uint64"}, {"a": "uint64[20]"}, bytes(168)),
        ({"x": "uint8[]"}, {"a": "uint64[20]"}, b"\x0c" + bytes(3 + 12 + 160)),
        ({"x": "uint64"}, {}, bytes(8)),
    ],
)
def test_steps_without_bytes_go_on_when_the_buffer_is_full(before, after, good):
    """While the empty messages are counted, eight words come, and that is the whole buffer."""
    message = make("ros1", {**before, "e": (NOTHING, "[12]"), **after})
    harness = Harness(Deserializer(message, bus_bytes=8), None)
    seen = harness.run_packets([good, good + bytes(160), good], RunOptions())
    assert list(seen.statuses) == [Status.OK, Status.TRAILING, Status.OK]


@pytest.mark.sampled(2)
@pytest.mark.parametrize("bus_bytes", [2, 8])
def test_what_came_before_the_end_of_a_packet_is_kept_until_it_is_taken(bus_bytes):
    """The leaves of each packet are still there when the errors of the next ones are found."""
    fields = {"a": "uint8", "b": "uint8", "c": "uint16", "d": "uint32"}
    rx = Deserializer(make("ros1", fields), bus_bytes=bus_bytes)
    whole = bytes.fromhex("01020403 08070605")
    packets = [whole[:size] for size in (8, 1, 2, 3, 4, 7, 8, 7, 4, 2, 1)]
    harness = Harness(rx, None)
    slow = Stalls.bits("0" * 11 + "1")
    seen = harness.run_packets(packets, RunOptions(stalls={"message": slow}))
    ends = {0: (1, 1), 1: (2, 2), 2: (4, 0x0304), 3: (8, 0x05060708)}
    for leaf, (end, value) in ends.items():
        assert list(seen.transfers[leaf]) == [value * (len(each) >= end) for each in packets]
    errors = [Status.OK if len(each) == 8 else Status.TRUNCATED for each in packets]
    assert list(seen.statuses) == errors


@pytest.mark.parametrize("bus_bytes", [1, 8])
def test_every_byte_but_0_is_true(bus_bytes):
    message = make("ros1", {"a": "bool", "b": "bool[3]", "c": "bool[]", "d": "bool[9]"})
    rx = Deserializer(message, bus_bytes=bus_bytes)
    values = [0, 1, 2, 0x80, 0xFE]
    packets = [bytes([v, 0, v, v, 3, 0, 0, 0, v, 0, v, *[v, 0, v] * 3]) for v in values]
    seen = Harness(rx, None).run_packets(packets)
    assert [status.name for status in seen.statuses] == ["OK"] * len(values)
    for leaf in rx.plan.leaves:
        if leaf.type != "bool":
            continue
        number = rx.plan.leaves.index(leaf)
        bits = [
            payload if leaf.kind != "items" else payload[0] for payload in seen.transfers[number]
        ]
        flat = [bit for each in bits for bit in (each if isinstance(each, tuple) else (each,))]
        assert set(flat) == {0, 1}
        assert sum(flat) == {"a": 4, "b": 8, "c": 8, "d": 24}[str(leaf).split(".")[0]]
