"""The table of machines: it learns, forgets, and remembers who did not answer."""

from __future__ import annotations

from amaranth.sim import Simulator

from firm_hdl.ethernet.arp import ArpCache


def test_machines_are_learned_updated_displaced_and_forgotten():
    cache = ArpCache(4)

    async def learn(ctx, ip, mac, inserts=1):
        ctx.set(cache.peer, {"ip": ip, "mac": mac})
        ctx.set(cache.learns, 1)
        ctx.set(cache.inserts, inserts)
        await ctx.tick()
        ctx.set(cache.learns, 0)
        await ctx.tick().repeat(9)

    async def ask(ctx, ip, what="look"):
        """Return the address, None if the machine is unknown, or that it is gone or stale."""
        ctx.set(cache.ip, ip)
        ctx.set(getattr(cache, what), 1)
        await ctx.tick().until(cache.done)
        ctx.set(getattr(cache, what), 0)
        if what == "absent" or not ctx.get(cache.found):
            return None
        signs = [name for name in ("gone", "stale") if ctx.get(getattr(cache, name))]
        return signs or ctx.get(cache.mac)

    async def ticks(ctx, count):
        for _ in range(count):
            ctx.set(cache.tick, 1)
            await ctx.tick()
            ctx.set(cache.tick, 0)
            await ctx.tick().repeat(6)

    async def test(ctx):
        assert await ask(ctx, 10) is None
        await learn(ctx, 10, 0xA, inserts=0)
        assert await ask(ctx, 10) is None
        for ip in (10, 11, 12, 13):
            await learn(ctx, ip, 0xA0 + ip)
        assert [await ask(ctx, ip) for ip in (10, 11, 12, 13)] == [0xAA, 0xAB, 0xAC, 0xAD]
        # A machine that is known is updated, and a new one takes the place of the oldest.
        await learn(ctx, 12, 0xCC, inserts=0)
        await learn(ctx, 14, 0xEE)
        found = [await ask(ctx, ip) for ip in (10, 11, 12, 13, 14)]
        assert found == [None, 0xAB, 0xCC, 0xAD, 0xEE]
        # Who does not answer is known as gone for 2 ticks, or until it speaks.
        for ip in (20, 21):
            await ask(ctx, ip, "absent")
        assert [(await ask(ctx, ip))[0] for ip in (20, 21)] == ["gone"] * 2
        await learn(ctx, 21, 0x21, inserts=0)
        assert await ask(ctx, 21) == 0x21
        await ticks(ctx, 2)
        assert await ask(ctx, 20) is None
        # Others are stale after 40 ticks, and forgotten after 60.
        await ticks(ctx, 37)
        assert await ask(ctx, 21) == 0x21
        await ticks(ctx, 1)
        assert await ask(ctx, 21) == ["stale"]
        await ticks(ctx, 20)
        assert [await ask(ctx, ip) for ip in (11, 12, 13, 14, 21)] == [None] * 5

    simulator = Simulator(cache)
    simulator.add_clock(1e-6)
    simulator.add_testbench(test)
    simulator.run()


def test_what_is_learned_while_a_lookup_waits_does_not_answer_it():
    cache = ArpCache(4)

    async def test(ctx):
        ctx.set(cache.peer, {"ip": 10, "mac": 0xAA})
        for strobe in (cache.learns, cache.inserts):
            ctx.set(strobe, 1)
        await ctx.tick()
        ctx.set(cache.learns, 0)
        # The cache enters the machine first, and looks for it then.
        ctx.set(cache.ip, 10)
        ctx.set(cache.look, 1)
        await ctx.tick().until(cache.done)
        assert (ctx.get(cache.found), ctx.get(cache.mac)) == (1, 0xAA)

    simulator = Simulator(cache)
    simulator.add_clock(1e-6)
    simulator.add_testbench(test)
    simulator.run()
