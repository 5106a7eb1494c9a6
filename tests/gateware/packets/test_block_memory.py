# amaranth: UnusedElaboratable=no
"""A memory in block RAM: what is read, and into which memories a deep one is divided."""

from __future__ import annotations

import random
import re

import pytest
from amaranth.back import rtlil
from amaranth.hdl import ClockDomain, Module
from amaranth.sim import Simulator

from firm_hdl.gateware.memories import BlockMemory

# Bits of a word and words; the bits of each memory, of which none has more than 18,432 in all.
PARTS = [
    (1, 4, [1]),
    (40, 4, [40]),
    (18, 1024, [18]),
    (19, 1024, [18, 1]),
    (20, 2048, [9, 9, 2]),
    (10, 4096, [4, 4, 2]),
    (3, 16384, [1, 1, 1]),
    # No word has less than a bit in a memory, so these have 32,768 bits each.
    (2, 32768, [1, 1]),
]


@pytest.mark.parametrize(("bits", "depth", "widths"), PARTS)
def test_a_deep_memory_is_divided_into_block_rams(bits, depth, widths):
    m = Module()
    memory = BlockMemory(m, bits, depth)
    ports = [memory.write_at, memory.read_at, memory.write_word, memory.writes, memory.reads]
    text = rtlil.convert(m, ports=ports, emit_src=False)
    found = re.findall(r"((?: *attribute .*\n)*) *memory width (\d+) size (\d+) ", text)
    assert [int(width) for _, width, _ in found] == widths and sum(widths) == bits
    assert {int(size) for _, _, size in found} == {depth}
    # Else Yosys would add logic for a read of a word that is being written.
    assert all("attribute \\no_rw_check 1\n" in attributes for attributes, _, _ in found)


@pytest.mark.parametrize(("bits", "depth"), [(bits, depth) for bits, depth, _ in PARTS])
def test_each_word_is_read_as_it_was_written(bits, depth):
    m, noise = Module(), random.Random(f"{bits} {depth}")
    memory = BlockMemory(m, bits, depth)
    # Addresses that differ in one bit only, with the first and the last word.
    places = [0, depth - 1, *(1 << bit for bit in range(depth.bit_length() - 1))]
    words = {place: noise.getrandbits(bits) for place in places}
    log = []

    async def bench(ctx):
        async def cycle(*, write=None, read=None):
            """Write or read at a place; the other port has any address, and does nothing."""
            for enable, address, place in (
                (memory.writes, memory.write_at, write),
                (memory.reads, memory.read_at, read),
            ):
                ctx.set(enable, place is not None)
                ctx.set(address, noise.randrange(depth) if place is None else place)
            ctx.set(memory.write_word, noise.getrandbits(bits) if write is None else words[write])
            await ctx.tick()

        for turn in range(2):
            for place in places:
                # What a place had before is overwritten.
                words[place] ^= turn * ((1 << bits) - 1)
                await cycle(write=place)
            for place in noise.sample(places, len(places)):
                await cycle(read=place)
                log.append((ctx.get(memory.word), words[place]))
                # Without a read, the word stays, also if it is written.
                await cycle()
                await cycle(write=noise.choice(places))
                log.append((ctx.get(memory.word), words[place]))

    simulator = Simulator(m)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    simulator.run()
    assert len(log) == 4 * len(places)
    assert [read for read, _ in log] == [written for _, written in log]


def test_a_reset_does_not_touch_what_was_read():
    """A block RAM has no reset; with one, the register of the last read would be no part of it."""
    m = Module()
    m.domains.sync = domain = ClockDomain()
    memory = BlockMemory(m, 20, 2048)
    log = []

    async def bench(ctx):
        ctx.set(memory.write_word, 0xABCDE)
        ctx.set(memory.writes, 1)
        await ctx.tick()
        ctx.set(memory.writes, 0)
        ctx.set(memory.reads, 1)
        await ctx.tick()
        ctx.set(memory.reads, 0)
        for reset in (0, 1):
            ctx.set(domain.rst, reset)
            await ctx.tick()
            log.append(ctx.get(memory.word))

    simulator = Simulator(m)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    simulator.run()
    assert log == [0xABCDE] * 2
