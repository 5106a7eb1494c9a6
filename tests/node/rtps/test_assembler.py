"""Samples in fragments: whatever comes, what is passed on is what one writer has sent."""

from __future__ import annotations

import random

from amaranth.sim import Simulator

from firm_hdl.node.rtps.assembler import Assembler
from firm_hdl.node.rtps.history import Part

PARTS = (Part(base=16, bytes=8), Part(base=0, bytes=16), Part(base=0, bytes=0))


def sample_of(row, number):
    """Return the size of a sample, and the size and the bytes of its fragments."""
    rng = random.Random(f"{row} {number}")
    size, step = rng.randrange(1, 20), rng.randrange(1, 8)
    data = rng.randbytes(size)
    return size, step, [data[at : at + step] for at in range(0, size, step)]


def offers(rng, count):
    """Yield fragments of some writers: in order mostly, some lost, doubled, or with other sizes."""
    at = {}
    for _ in range(count):
        reader, row = rng.randrange(3), rng.randrange(2)
        number, first = at.get((reader, row), (1, 1))
        size, step, parts = sample_of(row, number)
        first = rng.choice((first, first, first, 1, first + 1))
        fragments = rng.randrange(1, 4)
        first = max(1, min(first, len(parts)))
        body = b"".join(parts[first - 1 : first - 1 + fragments])
        # Fragments that end too early; padding; counts and sizes that are not those of before.
        body = rng.choice((body, body, body + b"pad", body[:-1]))
        step, size = rng.choice(((step, size),) * 6 + ((step + 1, size), (step, size + 1)))
        yield reader, row, number, first, fragments, step, size, body
        is_done = first - 1 + fragments >= len(parts)
        at[reader, row] = (number + 1, 1) if is_done else (number, first + fragments)


def test_what_is_passed_on_was_sent():
    assembler = Assembler(PARTS, 2)
    ask, came = assembler.lookup, assembler.fragments
    passed = []

    async def take(ctx, body):
        """Feed bytes as long as they are wanted."""
        for byte in body:
            if not ctx.get(came.wants):
                return
            ctx.set(came.byte, byte)
            ctx.set(came.takes, 1)
            await ctx.tick()
            ctx.set(came.takes, 0)

    async def pulse(ctx, signal):
        ctx.set(signal, 1)
        await ctx.tick()
        ctx.set(signal, 0)

    async def play(ctx):
        got = bytearray()
        await pulse(ctx, came.plays)
        while ctx.get(assembler.busy):
            is_ready = rng.random() < 0.8
            ctx.set(assembler.payload.ready, is_ready)
            if ctx.get(assembler.payload.valid) and is_ready:
                got.append(ctx.get(assembler.payload.payload.data[0]))
            await ctx.tick()
        return bytes(got)

    async def bench(ctx):
        for reader, row, number, first, fragments, step, size, body in offers(rng, 250):
            for signal, value in (
                *((ask.reader, reader), (ask.row, row), (ask.number, number), (ask.first, first)),
                *((ask.fragments, fragments), (ask.fragment_bytes, step)),
                (ask.sample_bytes, size),
            ):
                ctx.set(signal, value)
            ctx.set(ask.tick, rng.random() < 0.1)
            await ctx.tick()
            ctx.set(ask.tick, 0)
            await ctx.tick()
            assert ctx.get(ask.has_room) == (size <= PARTS[reader].bytes)
            if not ctx.get(ask.has_room) or not ctx.get(ask.fits):
                continue
            await pulse(ctx, ask.accepts)
            await take(ctx, body)
            if ctx.get(came.is_whole):
                passed.append((row, number, size, step, await play(ctx)))
            else:
                await pulse(ctx, came.stores)

    rng = random.Random(5)
    simulator = Simulator(assembler)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    simulator.run()
    whole = 0
    for row, number, size, step, got in passed:
        wanted_size, wanted_step, parts = sample_of(row, number)
        assert len(got) == size
        if (size, step) == (wanted_size, wanted_step):
            assert got == b"".join(parts), (row, number)
            whole += 1
    assert whole > 8
