# amaranth: UnusedElaboratable=no
"""The packet arbiter: whole packets, in turn, with the number of their input."""

from __future__ import annotations

import random
from functools import lru_cache

import pytest
from amaranth.hdl import Cat, Value

from firm_hdl import PacketArbiter, load_message
from firm_hdl.plan import build_plan
from firm_hdl.sim import Stalls
from firm_hdl.sim.payloads import beats_of
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.gateware.packets.bench import PacketBench, beats, with_side
from tests.gateware.traffic import has_path, random_packets

TYPE = load_message(by_depth("std_msgs/msg/Header", "sensor_msgs/msg/Imu"))


@lru_cache(maxsize=1)
def bench_of(arbiter):
    """Return a bench of an arbiter, the same one as long as it is the same."""
    return PacketBench(
        arbiter,
        {f"in{number}": port for number, port in enumerate(arbiter.packets_in)},
        {"out": (arbiter.packets_out, arbiter.bus_bytes, arbiter.source)},
    )


def run(arbiter, sent, stalls=None, **options):
    """Send packets to each input; check order and sources; return the input of each packet."""
    bus = arbiter.bus_bytes
    sources = {
        f"in{number}": beats(packets, bus, noise=random.Random(number))
        for number, packets in enumerate(sent)
    }
    total = sum(map(len, sent))
    seen = bench_of(arbiter).run(sources, {"out": total}, stalls=stalls, **options)
    came = [[] for _ in sent]
    order = []
    for packet, sources in zip(seen.packets["out"], seen.sides["out"], strict=True):
        (source,) = sources
        came[source].append(packet)
        order.append(source)
    assert came == [list(packets) for packets in sent]
    return order, seen


def test_what_comes_beside_a_packet_leaves_beside_it():
    arbiter = PacketArbiter(2, 3, side_bits=20)
    ports = zip(arbiter.packets_in, arbiter.sides_in, strict=True)
    bench = PacketBench(
        arbiter,
        {f"in{number}": with_side(port, side) for number, (port, side) in enumerate(ports)},
        {"out": (arbiter.packets_out, 2, Cat(arbiter.source, arbiter.side_out))},
    )
    sent = [some(9, 2, seed) for seed in range(3)]
    sides = [[1000 * number + k for k in range(9)] for number in range(3)]
    sources = {f"in{n}": beats(sent[n], 2, sides[n]) for n in range(3)}
    seen = bench.run(sources, {"out": 27}, stalls=Stalls(0.3))
    came = [[] for _ in sent]
    for (side,) in seen.sides["out"]:
        came[side & 3].append(side >> 2)
    assert came == sides


def some(count, bus_bytes, seed, sizes=(1, 2, 5)):
    rng = random.Random(f"{seed}")
    return [rng.randbytes(rng.choice(sizes) * bus_bytes - bus_bytes // 2) for _ in range(count)]


@pytest.mark.parametrize("bus_bytes", [1, 8, 64])
@pytest.mark.parametrize("inputs", [1, 2, 3, 8])
@pytest.mark.sampled(12)
def test_packets_stay_whole_under_any_stall(bus_bytes, inputs):
    plan = build_plan(lay_out(TYPE), bus_bytes=bus_bytes)
    sent = [random_packets(plan, 2, seed) + some(9, bus_bytes, seed) for seed in range(inputs)]
    arbiter = PacketArbiter(bus_bytes, inputs)
    for stalls in (None, Stalls(0.3, max_cycles=7), {"out": Stalls(0.7, max_cycles=3)}):
        run(arbiter, sent, stalls)


@pytest.mark.parametrize("inputs", [1, 2, 3, 5])
def test_inputs_take_turns_and_no_cycle_is_lost(inputs):
    sent = [some(10, 4, seed) for seed in range(inputs)]
    order, seen = run(PacketArbiter(4, inputs), sent)
    assert order == [*range(inputs)] * 10
    times = seen.times["out"]
    total = sum(beats_of(len(packet), 4) for packets in sent for packet in packets)
    # Latency 2, and a beat per cycle.
    assert times == list(range(seen.times["in0"][0] + 2, seen.times["in0"][0] + 2 + total))


def test_an_input_that_is_alone_waits_one_cycle_once():
    sent = [[], [], some(10, 4, 2), []]
    order, seen = run(PacketArbiter(4, 4), sent)
    assert order == [2] * 10
    first = seen.times["in2"][0]
    # Offered in cycle 0.
    assert first == 1
    assert seen.times["out"] == list(range(first + 2, first + 2 + len(seen.times["in2"])))


def test_a_busy_input_does_not_starve_another():
    sent = [some(40, 4, 0, [1]), some(4, 4, 1, [1]), some(4, 4, 2, [3])]
    order, _ = run(PacketArbiter(4, 3), sent, {"in1": Stalls(0.8), "in2": Stalls(0.8)})
    rest = {number: len(packets) for number, packets in enumerate(sent)}
    assert order[:12] != [0] * 12
    for source in order:
        rest[source] -= 1
    assert not any(rest.values())
    # Two inputs that always offer have the same share.
    order, _ = run(PacketArbiter(4, 3), [some(20, 4, 0), [], some(20, 4, 2)])
    assert order == [0, 2] * 20


def test_no_output_depends_on_an_input_in_the_same_cycle():
    arbiter = PacketArbiter(2, 3)
    out = arbiter.packets_out
    came = [Cat(Value.cast(port.payload), port.valid) for port in arbiter.packets_in]
    held = Cat(out.valid, Value.cast(out.payload), arbiter.source)
    readies = Cat(port.ready for port in arbiter.packets_in)
    assert not has_path(arbiter, Cat(*came, out.ready), Cat(held, readies))


def test_parameters_are_checked():
    with pytest.raises(ValueError, match=r"^Number of inputs must be at least 1, not 0$"):
        PacketArbiter(8, 0)
    with pytest.raises(ValueError, match=r"^Bus width must be one of"):
        PacketArbiter(3, 2)
    with pytest.raises(TypeError, match=r"^Number of inputs must be an integer, not '2'$"):
        PacketArbiter(8, "2")
    with pytest.raises(ValueError, match=r"^Number of side bits must be at least 0, not -1$"):
        PacketArbiter(8, 2, side_bits=-1)


class _Unfair(PacketArbiter):
    def _choose(self, m, turn, chosen):
        m.d.comb += chosen.eq(turn)
        for number, port in enumerate(self.packets_in):
            with m.If(port.valid):
                m.d.comb += [chosen.number.eq(number), chosen.bits.eq(1 << number)]


def test_an_unfair_arbiter_is_noticed():
    sent = [some(10, 4, seed) for seed in range(3)]
    order, _ = run(_Unfair(4, 3), sent)
    assert order != [0, 1, 2] * 10
