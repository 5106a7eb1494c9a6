"""Logic of positions and selections."""

from __future__ import annotations

import pytest
from amaranth.hdl import Module, Signal
from amaranth.sim import Simulator

from firm_hdl.gateware.positions import pick
from tests.depth import by_depth


@pytest.mark.sampled(2)
@pytest.mark.parametrize("constant", [True, False])
def test_a_value_is_picked_from_thousands(constant):
    # Expressions with one level per case would be nested too deeply for Python.
    count = by_depth(1300, 3000)
    chosen, values, result = Signal(count), Signal(16 * count), Signal(16)
    m = Module()
    cases = [
        (chosen[k], 3 * k + 1 if constant else values[16 * k : 16 * k + 16]) for k in range(count)
    ]
    m.d.comb += result.eq(pick(cases, 16))

    async def bench(ctx):
        ctx.set(values, sum(3 * k + 1 << 16 * k for k in range(count)))
        for k in (0, 1, 1234, count - 1):
            ctx.set(chosen, 1 << k)
            assert ctx.get(result) == 3 * k + 1
        ctx.set(chosen, 0)
        assert ctx.get(result) == 0

    simulator = Simulator(m)
    simulator.add_testbench(bench)
    simulator.run()
