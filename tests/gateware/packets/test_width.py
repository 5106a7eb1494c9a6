# amaranth: UnusedElaboratable=no
"""The width converter: the same packets on another bus."""

from __future__ import annotations

import random
from itertools import product

import pytest
from amaranth.hdl import Cat, Value

from firm_hdl import PacketWidth, load_message
from firm_hdl.plan import build_plan
from firm_hdl.sim import Stalls
from firm_hdl.sim.payloads import beats_of
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.gateware.packets.bench import PacketBench, beats
from tests.gateware.traffic import has_path, random_packets
from tests.strategies import BUS_WIDTHS

TYPE = load_message(by_depth("std_msgs/msg/Header", "sensor_msgs/msg/Imu"))
PAIRS = list(product(BUS_WIDTHS, repeat=2))


def run(width, packets, stalls=None, **options):
    bench = PacketBench(
        width, {"in": width.packets_in}, {"out": (width.packets_out, width.out_bytes, None)}
    )
    source = beats(packets, width.in_bytes, noise=random.Random(1))
    seen = bench.run({"in": source}, {"out": len(packets)}, stalls=stalls, **options)
    assert seen.packets["out"] == packets
    # An empty packet is one beat, too.
    sent = sum(beats_of(len(packet), width.out_bytes) for packet in packets)
    assert len(seen.times["out"]) == sent
    return seen


def of_all_sizes(most):
    return [random.Random(size).randbytes(size) for size in [*range(most), 0, most, 0, 1]]


@pytest.mark.parametrize(("in_bytes", "out_bytes"), PAIRS)
@pytest.mark.sampled(30)
def test_packets_are_the_same_under_any_stall(in_bytes, out_bytes):
    plan = build_plan(lay_out(TYPE), bus_bytes=in_bytes)
    packets = random_packets(plan, 1)
    wide = max(in_bytes, out_bytes)
    packets += of_all_sizes(2 * wide + 1 if wide <= 16 else 20)
    packets += [bytes(wide - 1), bytes(wide), bytes(wide + 1)]
    for stalls in (None, Stalls(0.4, max_cycles=3, seed=wide)):
        run(PacketWidth(in_bytes, out_bytes), packets, stalls)


@pytest.mark.parametrize(("in_bytes", "out_bytes"), [(1, 8), (8, 1), (4, 16), (16, 4), (8, 8)])
def test_a_beat_per_cycle_on_the_narrow_side(in_bytes, out_bytes):
    wide, narrow = max(in_bytes, out_bytes), min(in_bytes, out_bytes)
    packets = [bytes([k]) * size for k, size in enumerate([5 * wide, 3, wide, 1, 2 * wide + 1, 4])]
    seen = run(PacketWidth(in_bytes, out_bytes), packets)
    side = seen.times["in" if in_bytes <= out_bytes else "out"]
    total = sum(beats_of(len(packet), narrow) for packet in packets)
    assert side == list(range(side[0], side[0] + total))
    if in_bytes <= out_bytes:
        assert seen.times["out"][0] == seen.times["in"][wide // narrow - 1] + 1
    else:
        assert seen.times["out"][0] == seen.times["in"][0] + 2


@pytest.mark.parametrize(("in_bytes", "out_bytes"), [(1, 4), (4, 1), (2, 2)])
def test_no_output_depends_on_an_input_in_the_same_cycle(in_bytes, out_bytes):
    width = PacketWidth(in_bytes, out_bytes)
    came, out = width.packets_in, width.packets_out
    inputs = Cat(Value.cast(came.payload), came.valid, out.ready)
    held = Cat(out.valid, Value.cast(out.payload))
    assert not has_path(width, inputs, Cat(came.ready, held))


def test_parameters_are_checked():
    with pytest.raises(ValueError, match=r"^Bus width must be one of .* bytes, not 3$"):
        PacketWidth(8, 3)


class _ForgetsTheLast(PacketWidth):
    """A wide beat leaves only when it is full."""

    def elaborate(self, platform):
        m = super().elaborate(platform)
        out = m.submodules.slice
        with m.If(out.i.payload.count != self.out_bytes):
            m.d.comb += out.i.valid.eq(0)
        return m


@pytest.mark.parametrize("widths", [(2, 8), (8, 2)])
@pytest.mark.parametrize("fault", [_ForgetsTheLast])
def test_a_fault_is_found(fault, widths):
    with pytest.raises(AssertionError):
        run(fault(*widths), of_all_sizes(20))


@pytest.mark.parametrize(("in_bytes", "out_bytes"), [(8, 2), (4, 1)])
def test_an_empty_packet_is_one_beat_on_a_narrow_bus_too(in_bytes, out_bytes):
    run(PacketWidth(in_bytes, out_bytes), [b"", b"abc", b"", b"", bytes(in_bytes + 1), b""])
