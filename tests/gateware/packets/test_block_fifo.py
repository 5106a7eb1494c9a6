# amaranth: UnusedElaboratable=no
"""The FIFO in block RAM: order, cycles, and the number of transfers inside."""

from __future__ import annotations

import random

import pytest
from amaranth.hdl import Const

from firm_hdl import PacketFifo
from firm_hdl.gateware.packets.block_fifo import BlockFifo
from firm_hdl.sim import Stalls
from tests.gateware.packets.bench import PacketBench, beats

LATENCY = 3
DEPTH = 9


def fifo_bench(fifo=None):
    fifo = fifo or BlockFifo(16, DEPTH)
    flag = {"empty": (fifo.is_empty, Const(0, 1))}
    return PacketBench(fifo, {"i": fifo.i}, {}, others={"o": fifo.o}, events=flag)


def run(bench, count, **options):
    # All differ, so that each can only be itself.
    words = random.Random(count).sample(range(1 << 16), count)
    seen = bench.run({"i": words}, {"o": count}, **options)
    assert seen.others["o"] == words
    return seen


def test_a_transfer_per_cycle():
    bench = fifo_bench()
    seen = run(bench, 60)
    first = seen.times["i"][0]
    assert seen.times["i"] == list(range(first, first + 60))
    assert seen.times["o"] == list(range(first + LATENCY, first + LATENCY + 60))
    # Also while it is full, apart from the cycle in which the first transfer leaves.
    seen = run(bench, 60, stalls={"o": Stalls.bits("0" * 40 + "1" * 99)})
    inside = sum(cycle < 40 for cycle in seen.times["i"])
    assert inside == DEPTH
    assert seen.times["o"] == list(range(40, 100))
    after = seen.times["i"][DEPTH:]
    assert after == list(range(after[0], after[0] + len(after))) and after[0] <= 42


def test_what_comes_while_the_one_before_waits_takes_a_cycle_more():
    held = Stalls.bits("0" * 20 + "1" * 9)
    apart = {"o": held, "i": Stalls.bits("1" + "0" * 9 + "1" * 9)}
    assert run(fifo_bench(), 2, stalls=apart).times["o"] == [20, 22]
    # Both are in registers when the first one begins to wait.
    assert run(fifo_bench(), 2, stalls={"o": held}).times["o"] == [20, 21]
    # The same of packets.
    fifo, packets = PacketFifo(4, 64, 4), [b"abcd", b"efg"]
    bench = PacketBench(fifo, {"i": fifo.packets_in}, {"o": (fifo.packets_out, 4, fifo.size)})
    for stalls, times in ((apart, [20, 22]), ({"o": held}, [20, 21])):
        seen = bench.run({"i": beats(packets, 4)}, {"o": 2}, stalls=stalls)
        assert seen.times["o"] == times and seen.packets["o"] == packets


@pytest.mark.parametrize("seed", range(4))
def test_order_and_depth_under_any_stall(seed):
    bench = fifo_bench()
    for probability in (0.2, 0.7):
        stalls = {
            "i": Stalls(probability, max_cycles=9, seed=seed),
            "o": Stalls(0.9 - probability, max_cycles=20, seed=seed + 9),
        }
        seen = run(bench, 80, stalls=stalls, deadline=400)
        came, left = seen.times["i"], seen.times["o"]
        inside = [
            sum(t < now for t in came) - sum(t < now for t in left) for now in range(left[-1])
        ]
        assert max(inside) <= DEPTH
        # It is empty exactly when nothing is inside.
        empty = {cycle for cycle, _ in seen.events["empty"]}
        assert empty & set(range(left[-1])) == {k for k, held in enumerate(inside) if not held}


def test_parameters_are_checked():
    for depth in (4, 8, 3):
        with pytest.raises(
            ValueError, match=r"^Depth must be a power of two from 4 on, and 1 more"
        ):
            BlockFifo(8, depth)


def test_a_fault_is_found():
    class TakesAlways(BlockFifo):
        """The twin: a FIFO that takes transfers without room."""

        def elaborate(self, platform):
            m = super().elaborate(platform)
            m.d.comb += self.i.ready.eq(1)
            return m

    held = {"o": Stalls.bits("0" * 40 + "1" * 99)}
    run(fifo_bench(), 60, stalls=held)
    with pytest.raises(AssertionError):
        run(fifo_bench(TakesAlways(16, DEPTH)), 60, stalls=held)
