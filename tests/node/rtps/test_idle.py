"""Whether a topic is idle: messages that came, left, and were dropped."""

from __future__ import annotations

from amaranth.sim import Simulator

from firm_hdl.node.rtps.idle import TopicIdle


def test_a_topic_is_idle_when_all_that_came_has_left_or_was_dropped():
    counter = TopicIdle()

    async def bench(ctx):
        async def after(came=0, left=0, drops=0):
            ctx.set(counter.came, came)
            ctx.set(counter.left, left)
            ctx.set(counter.drops, drops)
            await ctx.tick()
            ctx.set(counter.came, 0)
            ctx.set(counter.left, 0)
            await ctx.tick()
            await ctx.tick()
            return ctx.get(counter.idle)

        assert ctx.get(counter.idle)
        assert not await after(came=1)
        # One leaves while another one comes.
        assert not await after(came=1, left=1)
        assert await after(drops=0b100)
        assert not await after(came=1, drops=0b100)
        assert not await after(came=1, drops=0b100)
        # Two are dropped at once.
        assert await after(drops=0b010)

    simulator = Simulator(counter)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    simulator.run()
