# amaranth: UnusedElaboratable=no
"""The gate of a service: good requests with their own tags; others are dropped and counted once."""

from __future__ import annotations

import random

import pytest

from firm_hdl.node.description import Store
from firm_hdl.node.gateware.request_gate import RequestGate
from firm_hdl.sim import Stalls
from tests.gateware.packets.bench import PacketBench, beats, with_side
from tests.node.traffic import counters_of
from tests.strategies import make

TEXT = make("ros1", {"text": "string"})
ROOM = 64


def packet(size):
    """Return a good request of `size` bytes."""
    return (size - 4).to_bytes(4, "little") + bytes(range(1, size - 3))


def through_gate(requests, bus=8, **options):
    """Send pairs of a packet and a tag; return those that came out, and the counters."""
    store = Store(
        message=TEXT, max_message_bytes=1000, memory_bytes=ROOM, packets=4, when_full="drop"
    )
    gate = RequestGate(bus, store, "ros1")
    bench = PacketBench(
        gate,
        {"in": with_side(gate.packets_in, gate.tag_in)},
        {"out": (gate.packets_out, bus, gate.tag_out)},
        final={name: gate.counters[name] for name in gate.counters.shape().members},
    )
    # The tag counts with the last beat alone.
    sides = [(lambda last, tag=tag: tag if last else 99) for _, tag in requests]
    source = list(beats([each for each, _ in requests], bus, sides))
    seen = bench.run({"in": source}, {"in": len(source)}, **({"settle": 120} | options))
    pairs = zip(seen.packets["out"], seen.sides["out"], strict=True)
    return [(each, tag) for each, (tag,) in pairs], counters_of(bench)


@pytest.mark.parametrize("bus", [1, 8])
def test_each_cause_has_its_counter_and_good_requests_keep_their_tags(bus):
    good = [(packet(size), 1000 + size) for size in (4, 5, 12, 33, ROOM - bus)]
    bad = {
        "truncated": packet(20)[:-1],
        "trailing": packet(9) + b"x",
        "length": (997).to_bytes(4, "little") + b"abc",
        # It is a good one, but larger than the memory.
        "large": packet(ROOM + 20),
    }
    requests = []
    for number, each in enumerate(good):
        requests += [(wrong, number) for wrong in bad.values()] + [each]
    pause = {"in": Stalls.bits("0" * 40 + "1" * 40)}
    out, counters = through_gate(requests, bus, stalls=pause, settle=400, deadline=1000)
    assert out == good
    assert counters == {"passed": 5, **dict.fromkeys(bad, 5)}


def test_requests_that_nobody_takes_are_dropped_whole_and_counted():
    rng = random.Random(1)
    requests = [(packet(rng.choice((4, 12, 30))), number) for number in range(60)]
    late = {"out": Stalls.bits("0" * 300 + "1" * 10**4)}
    out, counters = through_gate(requests, stalls=late, settle=800, deadline=1000)
    assert set(out) <= set(requests)
    assert [tag for _, tag in out] == sorted(tag for _, tag in out)
    assert counters == {"passed": len(out), "full": 60 - len(out)}
    assert 3 < len(out) < 40
