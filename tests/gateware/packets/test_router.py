# amaranth: UnusedElaboratable=no
"""The packet router: each packet to the output of its topic, whole; others are counted."""

from __future__ import annotations

import random

import pytest
from amaranth.hdl import Cat, Module, Value
from amaranth.lib import wiring

from firm_hdl import PacketArbiter, PacketRouter
from firm_hdl.sim import Stalls
from firm_hdl.sim.payloads import beats_of
from tests.gateware.packets.bench import PacketBench, beats, with_side
from tests.gateware.packets.test_arbiter import some
from tests.gateware.traffic import has_path


def run(router, packets, topics, stalls=None, **options):
    bus, count = router.bus_bytes, router.topics
    bench = PacketBench(
        router,
        {"in": with_side(router.packets_in, router.topic)},
        {f"out{k}": (port, bus, None) for k, port in enumerate(router.packets_out)},
        final={name: router.counters[name] for name in ("routed", "unknown")},
    )
    total = sum(beats_of(len(packet), bus) for packet in packets)
    noise = random.Random(7)
    source = []
    for packet, topic in zip(packets, topics, strict=True):
        each = beats([packet], bus, [0], noise=noise)
        side_at = 8 * bus + bus.bit_length() + 1
        # The topic has a meaning only beside the first beat.
        for number, beat in enumerate(each):
            side = noise.getrandbits(len(router.topic)) if number else topic
            source.append(beat | side << side_at)
    want = [
        [packet for packet, topic in zip(packets, topics, strict=True) if topic == k]
        for k in range(count)
    ]
    goal = {"in": total} | {f"out{k}": len(each) for k, each in enumerate(want)}
    seen = bench.run({"in": source}, goal, stalls=stalls, **options)
    assert [seen.packets[f"out{k}"] for k in range(count)] == want
    unknown = sum(topic >= count for topic in topics)
    assert bench.state == {"routed": len(packets) - unknown, "unknown": unknown}
    return seen


@pytest.mark.parametrize("bus_bytes", [1, 8, 64])
@pytest.mark.parametrize("outputs", [1, 2, 5])
@pytest.mark.sampled(9)
def test_each_packet_goes_to_its_topic_under_any_stall(bus_bytes, outputs):
    rng = random.Random(outputs)
    packets = some(40, bus_bytes, outputs)
    topics = [rng.choice([*range(outputs + 1), outputs + 7, 65535]) for _ in packets]
    for stalls in (None, Stalls(0.3, max_cycles=7), {"out0": Stalls(0.8, max_cycles=3)}):
        run(PacketRouter(bus_bytes, outputs), packets, topics, stalls)


def test_latency_is_a_cycle_and_no_cycle_is_lost():
    packets = some(30, 8, 1)
    seen = run(PacketRouter(8, 3), packets, [k % 4 for k in range(30)])
    first, total = seen.times["in"][0], len(seen.times["in"])
    assert seen.times["in"] == list(range(first, first + total))
    left = sorted(time for k in range(3) for time in seen.times[f"out{k}"])
    ends, at = [], first
    for k, packet in enumerate(packets):
        size = beats_of(len(packet), 8)
        ends += range(at + 1, at + 1 + size) if k % 4 < 3 else []
        at += size
    assert left == ends


def test_what_comes_beside_a_packet_leaves_beside_it():
    router = PacketRouter(2, 3, side_bits=20)
    side = Cat(router.topic, router.side_in)
    bench = PacketBench(
        router,
        {"in": with_side(router.packets_in, side)},
        {f"out{k}": (port, 2, router.side_out) for k, port in enumerate(router.packets_out)},
    )
    packets, topics = some(30, 2, 1), [k % 4 for k in range(30)]
    sides = [topic | (1000 + k) << 16 for k, topic in enumerate(topics)]
    want = {f"out{k}": topics.count(k) for k in range(3)}
    seen = bench.run({"in": beats(packets, 2, sides)}, want, stalls=Stalls(0.3))
    for output in range(3):
        want = [{1000 + k} for k, topic in enumerate(topics) if topic == output]
        assert seen.sides[f"out{output}"] == want


def test_an_arbiter_and_a_router_are_the_reverse_of_each_other():
    m = Module()
    m.submodules.arbiter = arbiter = PacketArbiter(4, 3)
    m.submodules.router = router = PacketRouter(4, 3)
    wiring.connect(m, arbiter.packets_out, router.packets_in)
    m.d.comb += router.topic.eq(arbiter.source)
    bench = PacketBench(
        m,
        {f"in{k}": port for k, port in enumerate(arbiter.packets_in)},
        {f"out{k}": (port, 4, None) for k, port in enumerate(router.packets_out)},
    )
    sent = [some(15, 4, k) for k in range(3)]
    seen = bench.run(
        {f"in{k}": beats(packets, 4) for k, packets in enumerate(sent)},
        {f"out{k}": 15 for k in range(3)},
        stalls=Stalls(0.2),
    )
    assert [seen.packets[f"out{k}"] for k in range(3)] == sent


def test_no_output_depends_on_an_input_in_the_same_cycle():
    router = PacketRouter(2, 2, topic_bits=2)
    came = router.packets_in
    outs = router.packets_out
    inputs = Cat(Value.cast(came.payload), came.valid, router.topic, *(p.ready for p in outs))
    held = [Cat(port.valid, Value.cast(port.payload)) for port in outs]
    assert not has_path(router, inputs, Cat(came.ready, *held))


def test_parameters_are_checked():
    with pytest.raises(ValueError, match=r"^Number of topics must be at least 1, not 0$"):
        PacketRouter(8, 0)
    with pytest.raises(ValueError, match=r"^5 topics do not fit into 2 bits$"):
        PacketRouter(8, 5, topic_bits=2)
    with pytest.raises(TypeError, match=r"^Number of topic bits must be an integer, not '4'$"):
        PacketRouter(8, 1, topic_bits="4")
    with pytest.raises(ValueError, match=r"^Number of side bits must be at least 0, not -1$"):
        PacketRouter(8, 1, side_bits=-1)
    assert PacketRouter(8, 4, topic_bits=2).topics == 4


class _ForgetsTheTopic(PacketRouter):
    """Each beat goes to the output of its own topic."""

    def elaborate(self, platform):
        m = super().elaborate(platform)
        named = Cat(self.topic == k for k in range(self.topics))
        m.d.comb += m.submodules.slice.i.payload.to.eq(named)
        return m


@pytest.mark.parametrize("fault", [_ForgetsTheTopic])
def test_a_fault_is_found(fault):
    packets, topics = some(20, 4, 3), [k % 4 for k in range(20)]
    run(PacketRouter(4, 3), packets, topics)
    with pytest.raises(AssertionError):
        run(fault(4, 3), packets, topics)
