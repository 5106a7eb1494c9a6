"""The tail drop without a gate: what becomes of each packet, and how many are counted."""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest
from amaranth.sim import Simulator

from firm_hdl.gateware.packets.tail_drop import TailDrop

Beat = tuple[int, bool, int]
"""Number of the packet, whether the beat is the last one, and its valid lanes."""


class Run:
    """Packets through a tail drop; checks what left against what came.

    Parameters
    ----------
    sizes : list of int
        Beats of each packet. Its beats have its number as data.
    ready, reports : function
        Whether the output is ready, and whether a report is wanted, in a cycle.
    """

    def __init__(
        self,
        sizes: list[int],
        ready: Callable[[int], bool],
        reports: Callable[[int], bool] = lambda _: False,
        gap: Callable[[int], bool] = lambda _: False,
    ) -> None:
        self.sizes = sizes
        self.came = [
            (n, k == size - 1, 1 + n % 2) for n, size in enumerate(sizes) for k in range(size)
        ]
        self.left: list[tuple[Beat, bool, int, bool]] = []
        self.drops = self.reported = 0
        # Reports before each beat that left.
        self.before: list[int] = []
        self._simulate(ready, reports, gap)

    def _simulate(
        self,
        ready: Callable[[int], bool],
        reports: Callable[[int], bool],
        gap: Callable[[int], bool],
    ) -> None:
        dut = TailDrop(2)

        async def bench(ctx) -> None:
            source, out, pending = dut.packets_in, dut.packets_out, list(self.came)
            for cycle in range(2 * len(self.came) + 20):
                offers = bool(pending) and not gap(cycle)
                now = pending.pop(0) if offers else (0, False, 0)
                ctx.set(source.valid, offers)
                ctx.set(source.payload.data[0], now[0] % 256)
                ctx.set(source.payload.data[1], now[0] // 256)
                ctx.set(source.payload.last, now[1])
                ctx.set(source.payload.count, now[2])
                ctx.set(out.ready, ready(cycle))
                takes = ctx.get(out.valid) and ctx.get(out.ready)
                wants = reports(cycle) and not takes and ctx.get(dut.dropped) > 0
                ctx.set(dut.report, wants)
                assert ctx.get(source.ready)
                self.reported += wants
                self.drops += ctx.get(dut.drops)
                if takes:
                    p = out.payload
                    number = ctx.get(p.beat.data[0]) + 256 * ctx.get(p.beat.data[1])
                    beat = (number, bool(ctx.get(p.beat.last)), ctx.get(p.beat.count))
                    dropped = ctx.get(p.dropped)
                    assert ctx.get(p.any_dropped) == (dropped > 0)
                    self.left.append((beat, bool(ctx.get(p.aborted)), dropped))
                    self.before.append(self.reported)
                await ctx.tick()
            self.most = ctx.get(dut.dropped)

        simulator = Simulator(dut)
        simulator.add_clock(1e-6)
        simulator.add_testbench(bench)
        simulator.run()

    def check(self) -> tuple[int, int, int]:
        """Check all packets; return how many passed, were aborted, and were dropped whole."""
        ends = [index for index, (beat, *_) in enumerate(self.left) if beat[1]]
        starts = [0, *(end + 1 for end in ends[:-1])]
        assert ends[-1] == len(self.left) - 1
        passed, aborted, last, reports = 0, 0, -1, 0
        for start, end in zip(starts, ends, strict=True):
            beats = self.left[start : end + 1]
            number = beats[0][0][0]
            assert number > last
            # The number of packets that were dropped whole since the one before.
            dropped = number - last - 1 - (self.before[start] - reports)
            assert beats[0][2] == min(dropped, 255)
            last, reports = number, self.before[start]
            whole = [beat for beat in self.came if beat[0] == number]
            if beats[-1][1]:
                aborted += 1
                assert [beat for beat, *_ in beats[:-1]] == whole[: len(beats) - 1]
                assert 1 < len(beats) <= len(whole) and beats[-1][0][2] == 2
            else:
                passed += 1
                assert [beat for beat, *_ in beats] == whole
            assert not any(aborts for _, aborts, _ in beats[:-1])
        dropped = len(self.sizes) - passed - aborted
        assert self.drops == aborted + dropped
        return passed, aborted, dropped


def test_all_pass_while_there_is_room() -> None:
    sizes = [1, 3, 1, 1, 2, 5, 1]
    assert Run(sizes, lambda _: True).check() == (len(sizes), 0, 0)


@pytest.mark.parametrize("share", [0.2, 0.6, 0.95])
def test_each_packet_passes_whole_or_is_aborted_or_dropped(share: float) -> None:
    chosen = random.Random(share)
    sizes = [chosen.choice([1, 1, 2, 3, 6]) for _ in range(150)]
    run = Run(
        sizes,
        lambda _: chosen.random() < share,
        lambda _: chosen.random() < 0.3,
        lambda _: chosen.random() < 0.2,
    )
    assert all(run.check()) and run.reported


def test_the_number_of_dropped_packets_stops_at_its_largest_value() -> None:
    run = Run([1] * 400, lambda cycle: cycle >= 300)
    passed, aborted, dropped = run.check()
    assert (passed, aborted) == (400 - dropped, 0) and dropped >= 290
    assert run.left[0][2] == 255 and run.left[1][2] == 0
