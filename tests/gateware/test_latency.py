# amaranth: UnusedElaboratable=no
"""The latency that the manifest states is measured, from beat to leaf and from leaf to beat.

What comes in has gaps, so that it meets converters that have nothing else to do.
"""

from __future__ import annotations

import json

import pytest

from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.export.build import build
from firm_hdl.gateware.signatures import LATENCY_CYCLES
from firm_hdl.plan import decode
from firm_hdl.sim import Harness, Stalls, leaf_name
from firm_hdl.sim.job import Job, RunOptions
from firm_hdl.sim.payloads import all_beats, encoder_of

GAP = Stalls.bits("0" * 15 + "1")
# Encapsulation where there is one, then fields, each padded to its own size.
TYPES = [
    ("std_msgs/msg/Bool", "lyrical", "00010000 01"),
    ("geometry_msgs/msg/Point32", "lyrical", "00010000" + "0000803f" * 3),
    ("geometry_msgs/msg/Vector3", "lyrical", "00010000" + "000000000000f03f" * 3),
    ("geometry_msgs/msg/Vector3", "noetic", "000000000000f03f" * 3),
    ("unique_identifier_msgs/msg/UUID", "lyrical", "00010000" + "11" * 16),
    ("std_msgs/msg/Header", "lyrical", "00010000 01000000 02000000 05000000 61626364 00"),
]
every_type = pytest.mark.parametrize(("name", "distro", "text"), TYPES)
every_bus = pytest.mark.parametrize("bus_bytes", [1, 8, 64])


def events(harness, sources, packets):
    """Return the cycles in which each stream transfers, when everything but a gap is free."""
    found = {name: [] for name in harness.bench.names}
    job = Job(
        sources=sources,
        takes={name: lambda cycle, bits, to=to: to.append(cycle) for name, to in found.items()},
        finished=lambda: len(found["status"]) == packets,
        outstanding=lambda: "",
        options=RunOptions(stalls=dict.fromkeys(sources, GAP)),
    )
    harness.bench.run(job)
    return found


def ends_of(plan, packet):
    """Return the beat that completes each transfer, by leaf: the shortest packet that has it."""
    ends = {}
    whole = decode(plan, packet).streams
    for leaf, payloads in whole.items():
        ends[leaf] = []
        for number, payload in enumerate(payloads):
            size = next(
                size
                for size in range(len(packet) + 1)
                if decode(plan, packet[:size]).streams.get(leaf, [])[number:][:1] == [payload]
            )
            ends[leaf].append((size - 1) // plan.bus_bytes)
    return ends


@every_bus
@every_type
def test_deserializer(name, distro, text, bus_bytes):
    packet = bytes.fromhex(text)
    rx = Deserializer(load_message(name, distro=distro), bus_bytes=bus_bytes)
    found = events(
        Harness(rx, None), {"packets_in": list(all_beats([packet] * 2, bus_bytes))}, packets=2
    )
    beats = found["packets_in"]
    per_packet = len(beats) // 2
    first = {}
    for leaf, ends in ends_of(rx.plan, packet).items():
        cycles = found[leaf_name(rx.plan, leaf)]
        assert len(cycles) == 2 * len(ends)
        for number, cycle in enumerate(cycles):
            beat = number // len(ends) * per_packet + ends[number % len(ends)]
            first.setdefault(beat, []).append(cycle - beats[beat])
    for cycles in first.values():
        # Of a beat that takes several steps, the first one's leaves.
        assert min(cycles) == LATENCY_CYCLES
        assert max(cycles) == LATENCY_CYCLES or "Header" in name


# Without items that are in two beats: they are taken with the second.
@every_bus
@pytest.mark.parametrize(("name", "distro", "text"), [*TYPES[:4], TYPES[5]])
def test_serializer(name, distro, text, bus_bytes):
    packet = bytes.fromhex(text)
    tx = Serializer(load_message(name, distro=distro), bus_bytes=bus_bytes)
    last = len(tx.plan.leaves) - 1
    sources = {}
    for leaf, payloads in decode(tx.plan, packet).streams.items():
        sources[leaf_name(tx.plan, leaf)] = list(
            map(encoder_of(tx.plan.leaves[leaf]), payloads * 2)
        )
    harness = Harness(None, tx)
    found = events(harness, sources, packets=2)
    beats, leaf = found["packets_out"], found[leaf_name(tx.plan, last)]
    per_packet = len(beats) // 2
    for number in (0, 1):
        # Of the last leaf's first transfer, which completes a beat; others may follow.
        came = leaf[number * len(leaf) // 2]
        mine = [beat - came for beat in beats[number * per_packet : (number + 1) * per_packet]]
        assert LATENCY_CYCLES in mine
        assert mine == [LATENCY_CYCLES] or per_packet > 1


def test_manifest_states_it(tmp_path):
    (built,) = build(["std_msgs/msg/Bool"], tmp_path)
    manifest = json.loads((built.folder / "manifest.json").read_text())
    assert manifest["timing"]["latency_cycles"] == LATENCY_CYCLES == 2
