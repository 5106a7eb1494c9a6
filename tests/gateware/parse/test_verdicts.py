# amaranth: UnusedElaboratable=no
"""The queue of verdicts: in order, none lost, and room for one more than is seen in time."""

from __future__ import annotations

import random
from collections import deque

import pytest
from amaranth.hdl import Value
from amaranth.sim import Simulator

from firm_hdl.gateware.parser import VerdictQueue

CYCLES = 200


def run(ends, ready, queue_type=VerdictQueue):
    """Let packets end and take verdicts; check what is offered against a queue in Python.

    Parameters
    ----------
    ends, ready : callable
        From the number of the cycle to whether a packet ends, if it may, and whether the verdict
        that is offered is taken.

    Returns
    -------
    ended, taken : list of int
        The cycles in which packets ended, and in which their verdicts were taken.
    """
    queue, noise = queue_type(), random.Random(1)
    ended, taken = [], []

    async def bench(ctx):
        inside, shown, moved = deque(), None, False
        for cycle in range(CYCLES):
            # The verdict comes a cycle after the end of its packet.
            came = noise.getrandbits(5) << 1 | (ended[-1:] == [cycle - 1])
            ctx.set(Value.cast(queue.came), came)
            ctx.set(queue.ready, ready(cycle))
            offered = ctx.get(Value.cast(queue.first))
            assert offered & 1 == bool(inside)
            assert not inside or offered == inside[0][1]
            assert moved == (bool(inside) and inside[0][0] != shown)
            shown = inside[0][0] if inside else None
            moved = bool(ctx.get(queue.moves))
            may_end = bool(ctx.get(queue.has_room))
            if inside and ready(cycle):
                inside.popleft()
                taken.append(cycle)
            if came & 1:
                inside.append((cycle, came))
            assert len(inside) <= 3
            if may_end and ends(cycle):
                ended.append(cycle)
            await ctx.tick()

    simulator = Simulator(queue)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    simulator.run()
    return ended, taken


@pytest.mark.parametrize("rates", [(0.9, 0.5), (0.5, 0.9), (0.9, 0.1), (0.7, 0.7)])
def test_verdicts_are_offered_in_order_and_none_is_lost(rates):
    noise = random.Random(str(rates))
    chosen = [[noise.random() < rate for _ in range(CYCLES)] for rate in rates]
    ended, taken = run(*(each.__getitem__ for each in chosen))
    assert len(ended) - 3 <= len(taken) and len(taken) > 15


def test_a_verdict_per_cycle():
    ended, taken = run(lambda _: True, lambda _: True)
    assert ended == list(range(CYCLES)) and taken == list(range(2, CYCLES))


def test_three_packets_end_before_the_first_verdict_is_taken():
    ended, taken = run(lambda _: True, lambda cycle: cycle in (20, 40))
    # When the second verdict is seen to wait, the third packet has ended already. There is room
    # when one verdict is left; two more packets end before the first of theirs is seen to wait.
    assert (ended, taken) == ([0, 1, 2, 41, 42], [20, 40])


class _SeesRoomTooLong(VerdictQueue):
    """The twin: a packet may always end."""

    def elaborate(self, platform):
        m = super().elaborate(platform)
        m.d.comb += self.has_room.eq(1)
        return m


def test_a_queue_without_room_is_noticed():
    with pytest.raises(AssertionError):
        run(lambda _: True, lambda cycle: cycle == 20, _SeesRoomTooLong)
