"""Memories with one write port, in look-up tables or in block RAM."""

from __future__ import annotations

from amaranth.hdl import Cat, Module, Shape, ShapeLike, Signal, Value
from amaranth.lib.memory import Memory, ReadPort, WritePort
from amaranth.utils import ceil_log2

__all__ = ["BlockMemory", "LutMemory"]

BLOCK_BITS = 18 * 1024
"""Bits of a block RAM, as FPGAs commonly have it: 1,024 words of 18 bits, or 8,192 of 2."""


class LutMemory:
    """A memory with asynchronous reads. Not a component: logic of one module.

    A word can be read from the cycle after its write on. The names of the ports' signals start with
    the name of the memory.

    * `name`: name of the submodule.
    * `shape`: of one word.
    * `depth`: number of words.
    """

    def __init__(self, m: Module, name: str, shape: ShapeLike, depth: int):
        self._name, self._shape, self._bits = name, shape, ceil_log2(depth)
        m.submodules[name] = self._memory = Memory(shape=shape, depth=depth, init=[])
        # Synchronous: `addr`, `data` and `en`.
        self.write = WritePort(
            WritePort.Signature(addr_width=self._bits, shape=shape),
            memory=self._memory,
            domain="sync",
            path=(name, "write"),
        )

    def reader(self, name: str = "read") -> ReadPort:
        """Add an asynchronous read port: `addr` and `data`."""
        return ReadPort(
            ReadPort.Signature(addr_width=self._bits, shape=self._shape),
            memory=self._memory,
            domain="comb",
            path=(self._name, name),
        )


class BlockMemory:
    """A memory that is read a cycle later. Not a component: logic of one module.

    A deep memory is divided into memories of a few bits of each word, each as large as one block
    RAM. So no multiplexer between block RAMs comes after the read, whose delay is long already.

    A word must not be read in the cycle in which it is written. The attribute `no_rw_check` tells
    Yosys so; else it would add logic for this case after each bit. Yosys takes it from a memory
    that is read asynchronously, with a register behind, and makes one block RAM of both.

    * `shape`: of one word.
    * `depth`: number of words.
    """

    def __init__(self, m: Module, shape: ShapeLike, depth: int):
        bits, address = Shape.cast(shape).width, ceil_log2(depth)
        # Addresses.
        self.write_at = Signal(address)
        self.read_at = Signal(address)
        self.write_word = Signal(shape)
        # A word is written, or read, in this cycle.
        self.writes = Signal()
        self.reads = Signal()
        step = max(1, BLOCK_BITS // depth)
        parts = range(0, bits, step)
        # The word of the last read, one cycle later, as bits.
        self.word: Value = Cat(
            self._part(m, number, low, min(bits, low + step), depth)
            for number, low in enumerate(parts)
        )

    def _part(self, m: Module, number: int, low: int, high: int, depth: int) -> Signal:
        """Add the memory of some bits of each word; return the register of its last read."""
        memory = Memory(shape=high - low, depth=depth, init=[], attrs={"no_rw_check": 1})
        m.submodules[f"memory_{number}"] = memory
        write, read = memory.write_port(), memory.read_port(domain="comb")
        word = Signal(high - low, name=f"word_{number}", reset_less=True)
        m.d.comb += [
            write.addr.eq(self.write_at),
            write.data.eq(Value.cast(self.write_word)[low:high]),
            write.en.eq(self.writes),
            read.addr.eq(self.read_at),
        ]
        with m.If(self.reads):
            m.d.sync += word.eq(read.data)
        return word
