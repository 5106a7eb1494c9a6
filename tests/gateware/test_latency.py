# amaranth: UnusedElaboratable=no
"""The latency that the manifest states is measured, from beat to leaf and from leaf to beat.

Inputs have gaps, so that converters are idle. Then the cycle of every transfer follows from the
plan: a step is done with its last beat, or with its last leaf, and several steps that are done with
the same one take a cycle each.
"""

from __future__ import annotations

import json

import pytest
from amaranth.hdl import Value
from amaranth.sim import Simulator

from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.export.build import build
from firm_hdl.gateware.signatures import LATENCY_CYCLES, leaf_streams
from firm_hdl.plan import Step, decode
from firm_hdl.sim import Harness, Stalls, leaf_name
from firm_hdl.sim.bench import Job, RunOptions
from firm_hdl.sim.payloads import all_beats, encoder_of
from firm_hdl.timing.rings import first_step
from tests.depth import by_depth

GAP = 24
# The encapsulation on CDR, then fields, each padded to its own size. No value is 0, because values
# after the end of a packet are 0.
TYPES = {
    # Fixed parts, cut between values and inside of them.
    "Bool": ("std_msgs/msg/Bool", "lyrical", "00010000 01"),
    "Point32": ("geometry_msgs/msg/Point32", "lyrical", "00010000" + "0000803f" * 3),
    "Vector3": ("geometry_msgs/msg/Vector3", "lyrical", "00010000" + "000000000000f03f" * 3),
    "Vector3 of ROS 1": ("geometry_msgs/Vector3", "noetic", "000000000000f03f" * 3),
    # Array elements: a run of a constant count, items in a map, and a loop.
    "UUID": ("unique_identifier_msgs/msg/UUID", "lyrical", "00010000" + bytes(range(1, 17)).hex()),
    "MeshTriangle": ("shape_msgs/msg/MeshTriangle", "lyrical", "00010000 010000000200000003000000"),
    "Polygon": ("geometry_msgs/Polygon", "noetic", "02000000" + "0000803f" * 6),
    # Strings: with and without words before the rest, at the end and in the middle.
    "Header": (
        "std_msgs/msg/Header",
        "lyrical",
        "00010000 01000000 02000000 05000000 61626364 00",
    ),
    "long Header": (
        "std_msgs/msg/Header",
        "lyrical",
        "00010000 01000000 02000000 16000000" + "61626364" * 5 + "6500",
    ),
    "UInt8MultiArray": (
        "std_msgs/msg/UInt8MultiArray",
        "lyrical",
        # Dimension "ab" of 5 and 6, offset 7, then the data.
        "00010000 01000000 03000000 61620000 05000000 06000000 07000000 03000000 010203",
    ),
}
every_type = pytest.mark.parametrize("case", TYPES)
every_bus = pytest.mark.parametrize("bus_bytes", by_depth([1, 32], [1, 2, 4, 8, 32, 64]))


def prefixes(plan, packet):
    """Return, for each transfer in wire order, the size of the shortest prefix that contains it."""
    whole = decode(plan, packet)
    assert whole.status == "OK"
    sizes, seen = [], {}
    short = [decode(plan, packet[:size]).streams for size in range(len(packet) + 1)]
    for leaf, payload in whole.transfers:
        number = seen[leaf] = seen.get(leaf, -1) + 1
        sizes.append(
            next(
                size
                for size, streams in enumerate(short)
                if streams.get(leaf, [])[number : number + 1] == [payload]
            )
        )
    return whole.transfers, sizes


def steps_of(plan, packet):
    """Return the steps of a packet: the beat that is its last, and the transfers."""
    bus = plan.bus_bytes
    transfers, sizes = prefixes(plan, packet)
    visits = decode(plan, packet).steps
    steps = [(-(-visit.end // bus) - 1, []) for visit in visits]
    # The end of a packet is known with its last beat.
    steps[-1] = ((len(packet) - 1) // bus, [])
    for (leaf, _), size in zip(transfers, sizes, strict=True):
        index = next(k for k, visit in enumerate(visits) if visit.end >= size)
        steps[index][1].append(leaf)
    return steps


def case_of(converter, case, bus_bytes):
    name, distro, text = TYPES[case]
    return converter(load_message(name, distro=distro), bus_bytes=bus_bytes), bytes.fromhex(text)


@every_bus
@every_type
@pytest.mark.sampled(24)
def test_deserializer(case, bus_bytes):
    rx, packet = case_of(Deserializer, case, bus_bytes)
    harness = Harness(rx, None)
    found = {name: [] for name in harness.bench.names}
    harness.bench.run(
        Job(
            sources={"packets_in": list(all_beats([packet] * 2, bus_bytes))},
            takes={name: lambda cycle, bits, to=to: to.append(cycle) for name, to in found.items()},
            finished=lambda: len(found["status"]) == 2,
            outstanding=lambda: "",
            options=RunOptions(stalls={"packets_in": Stalls.bits("0" * GAP + "1")}),
        )
    )
    beats = found["packets_in"]
    want = {name: [] for name in found} | {"packets_in": beats}
    steps = steps_of(rx.plan, packet)
    for first in (0, len(beats) // 2):
        for index, (beat, leaves) in enumerate(steps):
            waited = sum(other == beat for other, _ in steps[:index])
            cycle = beats[first + beat] + LATENCY_CYCLES["deserializer"] + waited
            for leaf in leaves:
                want[leaf_name(rx.plan, leaf)].append(cycle)
        want["status"].append(cycle)
    assert found == want


async def time_until_taken(ctx, port, value):
    """Offer a payload; return after how many cycles it was taken."""
    ctx.set(Value.cast(port.payload), value)
    ctx.set(port.valid, 1)
    for waited in range(GAP):
        _, _, ready = await ctx.tick().sample(port.ready)
        if ready:
            ctx.set(port.valid, 0)
            return waited
    raise AssertionError("not taken")


def offered_one_by_one(tx, packets):
    """Return when each leaf was offered, how long it waited, and when each beat came."""
    streams, transfers, beats = leaf_streams(tx.message, tx.tree), [], []
    payloads = [each for packet in packets for each in decode(tx.plan, packet).transfers]

    async def produce(ctx):
        await ctx.tick().repeat(GAP)
        cycle = GAP
        for leaf, payload in payloads:
            waited = await time_until_taken(
                ctx, streams[leaf], encoder_of(tx.plan.leaves[leaf])(payload)
            )
            transfers.append((cycle, waited))
            await ctx.tick().repeat(GAP)
            cycle += waited + 1 + GAP

    async def consume(ctx):
        ctx.set(tx.packets.ready, 1)
        ctx.set(tx.status.ready, 1)
        cycle = 0
        async for _, _, valid in ctx.tick().sample(tx.packets.valid):
            if valid:
                beats.append(cycle)
            cycle += 1

    sim = Simulator(tx)
    sim.add_clock(1e-6)
    sim.add_testbench(produce)
    sim.add_testbench(consume, background=True)
    sim.run()
    return transfers, beats


@every_bus
@every_type
@pytest.mark.sampled(24)
def test_serializer(case, bus_bytes):
    tx, packet = case_of(Serializer, case, bus_bytes)
    plan = tx.plan
    transfers, beats = offered_one_by_one(tx, [packet] * 2)
    steps = steps_of(plan, packet)
    lengths = [plan.leaves[leaf].kind == "length" for _, leaves in steps for leaf in leaves]
    want, waits, done = [], [], -1
    for _ in range(2):
        for visit, (_, leaves) in zip(decode(plan, packet).steps, steps, strict=True):
            step, came = plan.steps[visit.step], []
            if visit.step < first_step(plan):
                # Constants are available before; their beats leave with the first leaf.
                continue
            for _ in leaves:
                at, _ = transfers[len(waits)]
                # A length is decoded first; and earlier steps may take a while.
                waits.append(max(lengths[len(waits) % len(lengths)], done + 1 - at))
                came.append(at + waits[-1])
            if isinstance(step, Step) and not all(part.completes for part in step.parts):
                # The step waits for the next leaf, which belongs to a later step.
                came.append(transfers[len(waits)][0])
            done = max(done + 1, *came, 0)
            want += [(visit.end, done + LATENCY_CYCLES["serializer"])]
    assert [waited for _, waited in transfers] == waits
    assert beats == expected_beats(want, len(packet), bus_bytes)


def expected_beats(steps, size, bus_bytes):
    """Return the cycles of beats: each leaves when the step that fills it is done."""
    beats = []
    for end, cycle in steps:
        count = -(-size // bus_bytes)
        full = count if end == size else end // bus_bytes
        for _ in range(len(beats) % count, full):
            beats.append(max([cycle, *(last + 1 for last in beats[-1:])]))
    return beats


@pytest.mark.thorough
def test_manifest_states_it(tmp_path):
    (built,) = build(["std_msgs/msg/Bool"], tmp_path)
    manifest = json.loads((built.folder / "manifest.json").read_text())
    assert manifest["timing"]["latency_cycles"] == LATENCY_CYCLES
    assert LATENCY_CYCLES == {"deserializer": 5, "serializer": 4}
