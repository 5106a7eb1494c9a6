"""The memory that two datagrams in fragments share."""

from __future__ import annotations

from amaranth.sim import Simulator

from firm_hdl.ethernet.fragments import Reassembler


def test_beside_a_datagram_that_fills_the_memory_there_is_room_for_none():
    block, most = Reassembler(4096), 4092
    header, came, drops = block.datagrams.header, block.datagrams.bytes, []

    async def bench(ctx):
        async def fragment(source, offset, size, more):
            fields = {"udp": 1, "source": source, "offset": offset // 8, "more": more}
            fields |= {"first": offset == 0, "length": size}
            ctx.set(came.valid, 1)
            for place in (16, 17, 18, 19):
                ctx.set(header, fields | {"place": place})
                await ctx.tick()
            ctx.set(header, fields | {"place": 20})
            await ctx.tick().repeat(size)
            ctx.set(came.payload, {"end": 1, "good": 1})
            await ctx.tick()
            ctx.set(came.payload, {})
            ctx.set(came.valid, 0)
            await ctx.tick()
            drops.append(ctx.get(block.dropped))
            await ctx.tick().repeat(5)

        ctx.set(block.right, 1)
        ctx.set(block.check, {"length": most, "port": 1})
        await fragment(7, 0, 2048, more=1)
        await fragment(7, 2048, most - 2048, more=0)
        await fragment(8, 0, 8, more=1)
        # One of 4,072 bytes with its source leaves two units: too few for a source and 16 bytes.
        ctx.set(block.store.release, 1)
        await ctx.tick()
        ctx.set(block.store.release, 0)
        await fragment(9, 0, 4072, more=1)
        await fragment(8, 0, 16, more=1)

    simulator = Simulator(block)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    simulator.run()
    assert drops == [0, 0, 1, 0, 1]
