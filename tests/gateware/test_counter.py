"""The counter of words and elements: loads, late numbers, and the flag of the last one."""

from __future__ import annotations

import pytest
from amaranth.hdl import Const, Module, ResetInserter, Signal
from amaranth.lib.wiring import Component, In, Out
from amaranth.sim import Simulator

from firm_hdl.gateware.counter import Counter


class _Counting(Component):
    """A counter with a load of 9, and a default load of a number, which may come late.

    `number` is what is loaded, and `less` is in the number that the counter gets beside it.
    """

    def __init__(self, *, late: bool, less: int = 0, most: int = 255, start: int | None = None):
        self.late, self.less, self.most, self.start = late, less, most, start
        inputs = {"nine": In(1), "begins": In(1), "number": In(8), "down": In(1)}
        super().__init__({**inputs, "last": Out(1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        counter = Counter(self.most, "counter", self.start)
        value, double, less = self.number + self.less, None, Const(self.less, 1)
        if self.late:
            value, less, double = Signal(9), Signal(), self.number == 2
            # Both are valid one cycle after `begins`, and have any value in others.
            m.d.sync += [value.eq(self.number + self.less), less.eq(self.begins & self.less)]
        counter.load(self.nine, 9)
        counter.preload(self.begins, value, self.number == 1, double, less)
        counter.down(self.down)
        counter.add_logic(m)
        m.d.comb += self.last.eq(counter.last)
        return m


def _counts_until_last(
    counting: _Counting, number: int, *, nine: bool, pause: int = 0, down: bool = False
) -> int:
    """Return the number of counts until `last` is high; `down` is high beside the load, too."""
    found = 0

    async def use(ctx) -> None:  # type: ignore[no-untyped-def]
        nonlocal found
        ctx.set(counting.begins, 1)
        ctx.set(counting.nine, nine)
        ctx.set(counting.number, number)
        ctx.set(counting.down, down)
        await ctx.tick()
        ctx.set(counting.down, 0)
        ctx.set(counting.begins, 0)
        ctx.set(counting.nine, 0)
        ctx.set(counting.number, 0x55)
        while not ctx.get(counting.last) and found < 300:
            await ctx.tick().repeat(pause) if pause else None
            ctx.set(counting.down, 1)
            await ctx.tick()
            ctx.set(counting.down, 0)
            found += 1

    simulator = Simulator(counting)
    simulator.add_clock(1e-6)
    simulator.add_testbench(use)
    simulator.run()
    return found


@pytest.mark.parametrize("pause", [0, 1, 2])
@pytest.mark.parametrize("late", [False, True])
def test_last_is_high_one_cycle_ahead(late: bool, pause: int) -> None:
    for number in (1, 2, 3, 4, 5, 8, 9, 17, 255):
        assert (
            _counts_until_last(_Counting(late=late), number, nine=False, pause=pause) == number - 1
        )


@pytest.mark.parametrize("late", [False, True])
def test_a_constant_is_loaded_before_a_number(late: bool) -> None:
    for number in (0, 1, 2, 3, 200):
        assert _counts_until_last(_Counting(late=late), number, nine=True) == 8


@pytest.mark.parametrize("late", [False, True])
@pytest.mark.parametrize("nine", [False, True])
def test_a_count_beside_a_load_is_not_subtracted(late: bool, nine: bool) -> None:
    for number in (1, 2, 3, 4, 9):
        found = _counts_until_last(_Counting(late=late), number, nine=nine, pause=1, down=True)
        assert found == (8 if nine else number - 1)


@pytest.mark.parametrize("pause", [0, 1])
@pytest.mark.parametrize("late", [False, True])
def test_one_of_the_number_may_be_subtracted_later(late: bool, pause: int) -> None:
    for number in (1, 2, 3, 4, 8, 254):
        counting = _Counting(late=late, less=1)
        assert _counts_until_last(counting, number, nine=False, pause=pause) == number - 1


@pytest.mark.parametrize("late", [False, True])
@pytest.mark.parametrize("most", [1, 7, 8, 9, 127, 128])
def test_the_largest_number_fits(late: bool, most: int) -> None:
    counting = _Counting(late=late, most=most)
    assert _counts_until_last(counting, most, nine=False) == most - 1


@pytest.mark.parametrize("start", [1, 2, 3, 9])
def test_a_reset_restores_the_number_at_the_start(start: int) -> None:
    counting = _Counting(late=False, start=start)
    reset, lasts = Signal(), []

    async def use(ctx) -> None:  # type: ignore[no-untyped-def]
        for counts in (0, 1, start - 1, start + 3):
            ctx.set(counting.down, 1)
            await ctx.tick().repeat(counts) if counts else None
            # A count beside the reset is not subtracted.
            ctx.set(reset, 1)
            await ctx.tick()
            ctx.set(reset, 0)
            ctx.set(counting.down, 0)
            await ctx.tick()
            found = 0
            ctx.set(counting.down, 1)
            while not ctx.get(counting.last) and found < 20:
                await ctx.tick()
                found += 1
            lasts.append(found)

    simulator = Simulator(ResetInserter(reset)(counting))
    simulator.add_clock(1e-6)
    simulator.add_testbench(use)
    simulator.run()
    assert lasts == [start - 1] * 4
