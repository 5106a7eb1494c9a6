# amaranth: UnusedElaboratable=no
"""The message buffer: every leaf passes, and a deserializer feeds a serializer at full rate."""

from __future__ import annotations

import random

import pytest
from amaranth.hdl import Cat, Module, Value
from amaranth.lib.wiring import connect

from firm_hdl import Deserializer, MessageBuffer, Serializer
from firm_hdl.sim import RunOptions, Stalls, leaf_streams
from firm_hdl.sim.bench import Bench, Job, Ports
from tests.gateware.packets.bench import PacketBench, beats
from tests.gateware.traffic import has_path, random_packets
from tests.strategies import make

MIXED = make("ros1", {"x": "uint8", "name": "string", "y": "int16[]"})


def buffer_and_leaves():
    """Return a buffer, and the streams of its leaves on both sides by the name of the leaf."""
    buffer, tree = MessageBuffer(MIXED, bus_bytes=2), Serializer(MIXED, bus_bytes=2).tree
    paths = ["_".join(path) for _, path in tree.leaves()]
    ends = [
        dict(zip(paths, leaf_streams(end, tree).values(), strict=True))
        for end in (buffer.i, buffer.o)
    ]
    return buffer, *ends


@pytest.mark.parametrize("stalls", [None, Stalls(0.5, max_cycles=3, seed=1)])
def test_every_transfer_of_every_leaf_passes(stalls):
    buffer, came, goes = buffer_and_leaves()
    noise = random.Random(1)
    sent = {
        name: [noise.getrandbits(len(Value.cast(port.payload))) for _ in range(30)]
        for name, port in came.items()
    }
    seen = {name: [] for name in came}
    # The bench checks that `valid` and the payload stay until the transfer.
    Bench(buffer, Ports(sources=came, sinks={f"{name}_out": p for name, p in goes.items()})).run(
        Job(
            sources=sent,
            takes={f"{n}_out": lambda _, bits, to=to: to.append(bits) for n, to in seen.items()},
            finished=lambda: all(len(each) >= 30 for each in seen.values()),
            outstanding=lambda: str(seen),
            options=RunOptions(stalls=stalls),
        )
    )
    assert seen == sent


def test_the_deserializer_does_not_see_the_ready_of_lengths_and_items():
    buffer, came, goes = buffer_and_leaves()
    names = [name for name in came if name.endswith(("length", "items"))]
    assert len(names) == 4
    inputs = Cat(Cat(came[name].valid, goes[name].ready) for name in names)
    assert not has_path(buffer, inputs, Cat(came[name].ready for name in names))


def test_packets_of_strings_pass_at_a_beat_per_cycle():
    # Connected directly, they take 10 cycles for 7 beats.
    message = make("ros2", {"text": "string"})
    m = Module()
    m.submodules.rx = rx = Deserializer(message)
    m.submodules.buffer = buffer = MessageBuffer(message)
    m.submodules.tx = tx = Serializer(message)
    connect(m, rx.message, buffer.i)
    connect(m, buffer.o, tx.message)
    bench = PacketBench(
        m,
        {"in": rx.packets},
        {"out": (tx.packets, 8, None)},
        others={"received": rx.status, "sent": tx.status},
    )
    packets = random_packets(rx.plan, 12, sizes=(range(5, 12), range(1)))
    seen = bench.run({"in": beats(packets, 8)}, {"out": len(packets)})
    assert seen.packets["out"] == packets
    ends = seen.times["out"]
    assert ends == list(range(ends[0], ends[0] + len(ends)))
