"""Memories with one write port and asynchronous reads, which FPGAs build from look-up tables."""

from __future__ import annotations

from amaranth.hdl import Module, ShapeLike
from amaranth.lib.memory import Memory, ReadPort, WritePort
from amaranth.utils import ceil_log2

__all__ = ["LutMemory"]


class LutMemory:
    """A memory with asynchronous reads. Not a component: logic of one module.

    A word can be read from the cycle after its write on. The names of the ports' signals start with
    the name of the memory.

    Parameters
    ----------
    m : Module
    name : str
        Name of the submodule.
    shape : shape-like
        Of one word.
    depth : int
        Number of words.

    Attributes
    ----------
    write : WritePort
        Synchronous: `addr`, `data` and `en`.
    """

    def __init__(self, m: Module, name: str, shape: ShapeLike, depth: int):
        self._name, self._shape, self._bits = name, shape, ceil_log2(depth)
        m.submodules[name] = self._memory = Memory(shape=shape, depth=depth, init=[])
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
