"""The intake of messages alone: which samples give way, and who is asked before."""

from __future__ import annotations

from amaranth.hdl import Value
from amaranth.sim import Simulator

from firm_hdl.node.rtps.history import MOST_SAMPLES, Part
from firm_hdl.node.rtps.intake import Intake


def test_readers_are_asked_about_samples_that_came_after_the_last_answer():
    # Memory for one sample. Without a reader, all may give way; one may come at any time.
    intake = Intake(4, (1,), (Part(base=0, bytes=8, depth=MOST_SAMPLES + 1),), 8)
    asked, sent, oldest = intake.histories, intake.sent, []

    async def engine(ctx):
        ctx.set(asked.takes, 1)
        ctx.set(asked.free, MOST_SAMPLES)
        ctx.set(sent.payload.topic, 1)
        ctx.set(sent.payload.length, 8)
        for _ in range(4):
            for is_last in (0, 1):
                ctx.set(sent.payload.beat.count, 4)
                ctx.set(sent.payload.beat.last, is_last)
                ctx.set(sent.valid, 1)
                while not ctx.get(sent.ready):
                    asks = ctx.get(asked.asks)
                    if asks:
                        oldest.append(ctx.get(Value.cast(asked.oldest)))
                    ctx.set(asked.answers, asks)
                    await ctx.tick()
                await ctx.tick()
            ctx.set(sent.valid, 0)
            await ctx.tick().until(asked.ends)

    simulator = Simulator(intake)
    simulator.add_clock(1e-6)
    simulator.add_testbench(engine)
    simulator.run()
    assert oldest == [1, 2, 3]
