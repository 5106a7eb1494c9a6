# amaranth: UnusedElaboratable=no
"""Words of the collector: joined by the rules of their layout, they make up the packets."""

from __future__ import annotations

import random
from functools import cache

import pytest
from amaranth.hdl import Value
from amaranth.lib import stream
from amaranth.sim import Simulator

from firm_hdl.gateware.collect.collector import Collector
from firm_hdl.gateware.signatures import leaf_shape
from firm_hdl.plan import build_plan, decode
from firm_hdl.sim.payloads import encoder_of
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.gateware.parse.test_places import MESSAGES
from tests.gateware.traffic import random_packets

FIELDS = (
    "items",
    "map",
    "items_bytes",
    "map_bytes",
    "lead",
    "to_map",
    "map_mask",
    "to_end",
    "end_mask",
    "max_beats",
    "last",
    "empty",
    "waits",
    "error",
)


def words_of(plan, packets):
    """Run a collector; return its words."""
    streams = {k: stream.Signature(leaf_shape(leaf)).create() for k, leaf in enumerate(plan.leaves)}
    dut, rng = Collector(plan, streams), random.Random(2)
    offered = {leaf: [] for leaf in range(len(plan.leaves))}
    for packet in packets:
        for leaf, payload in decode(plan, packet).transfers:
            offered[leaf].append(encoder_of(plan.leaves[leaf])(payload))
    words = []

    async def testbench(ctx):
        ctx.set(dut.status.ready, 1)
        idle = 0
        while any(offered.values()) or idle < 20:
            for leaf, payloads in offered.items():
                if payloads:
                    ctx.set(Value.cast(streams[leaf].payload), payloads[0])
                ctx.set(streams[leaf].valid, bool(payloads))
            ready = rng.random() < 0.8
            ctx.set(dut.words.ready, ready)
            for leaf, payloads in offered.items():
                if payloads and ctx.get(streams[leaf].ready):
                    payloads.pop(0)
            idle += 1
            if ready and ctx.get(dut.words.valid):
                words.append({name: ctx.get(dut.words.payload[name]) for name in FIELDS})
                idle = 0
            await ctx.tick()

    simulator = Simulator(dut)
    simulator.add_clock(1e-6)
    simulator.add_testbench(testbench)
    simulator.run()
    return words


def packets_of(plan, words):
    """Join words to packets by the rules of their layout, and check their estimates."""
    bus, header = plan.bus_bytes, plan.header_bytes
    packets, packet, at = [], {}, 0
    for word in words:
        start = at
        items = word["items"].to_bytes(bus, "little")[: word["items_bytes"]]
        whole = word["map"].to_bytes(bus, "little")[: word["map_bytes"]]
        base = rounded(at + word["to_map"], word["map_mask"], header, bus)
        at = base if word["lead"] else start
        for k, byte in enumerate(items):
            packet[at + k] = byte
        for k, byte in enumerate(whole):
            packet[base + bus * word["lead"] + k] = byte
        phase = 0 if word["last"] else header
        at = rounded(base + word["to_end"], word["end_mask"], phase, 8 if word["last"] else bus)
        if bus >= 8:
            assert at // bus - start // bus <= word["max_beats"]
        assert word["empty"] == (not packet)
        if word["last"]:
            size = max(packet, default=-1) + 1
            packets.append((bytes(packet.get(k, 0) for k in range(size)), word["error"]))
            # The next packet starts with the next beat.
            assert at == max(1, -(-size // bus)) * bus
            packet, at = {}, 0
    return packets


def rounded(position, mask, phase, bus):
    """Round up to a position that is equal to `phase` in all bits of the mask.

    On a bus of 8 bytes or more, and at the end of a packet, the distance includes what rounding up
    needs, and these bits are replaced.
    """
    if bus < 8:
        return position + ((phase - position) & mask)
    return position & ~mask | phase & mask


@pytest.mark.parametrize("bus_bytes", by_depth([2, 8], [1, 2, 4, 8, 16]))
@pytest.mark.parametrize("name", MESSAGES)
def test_words_make_the_packets(name, bus_bytes):
    plan = build_plan(lay_out(MESSAGES[name]), bus_bytes=bus_bytes)
    packets = random_packets(plan, 12)
    assert packets_of(plan, words_of(plan, packets)) == [(packet, 0) for packet in packets]


@cache
def some_words():
    plan = build_plan(lay_out(MESSAGES["cdr"]), bus_bytes=8)
    packets = random_packets(plan, 12)
    return plan, packets, words_of(plan, packets)


@pytest.mark.parametrize("field", [name for name in FIELDS if name not in ("max_beats", "waits")])
def test_each_field_matters(field):
    plan, packets, words = some_words()
    words = [word | {field: word[field] ^ 1} for word in words]
    try:
        found = packets_of(plan, words)
    except AssertionError:
        return
    assert found != [(packet, 0) for packet in packets]


@pytest.mark.parametrize(("bus_bytes", "count"), [(1, 4), (2, 2), (4, 1), (8, 1), (16, 1)])
def test_constants_before_the_message_wait(bus_bytes, count):
    plan = build_plan(lay_out(MESSAGES["array"]), bus_bytes=bus_bytes)
    words = words_of(plan, random_packets(plan, 1))
    assert [word["waits"] for word in words[: count + 1]] == [1] * count + [0]
