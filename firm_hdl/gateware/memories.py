"""Memories with one writer and asynchronous reads, which FPGAs have in their look-up tables."""

from __future__ import annotations

from amaranth.hdl import Module, ShapeLike
from amaranth.lib.memory import Memory, ReadPort, WritePort
from amaranth.utils import ceil_log2

__all__ = ["LutMemory"]


class LutMemory:
    """A memory that is read without a cycle of delay. Not a component: logic of one module.

    A word is read in the cycle after it is written, at the earliest. Signals of its ports have the
    name of the memory in theirs.

    Parameters
    ----------
    m : Module
    name : str
        Name of the submodule.
    shape : shape-like
    depth : int

    Attributes
    ----------
    write : WritePort
        `addr`, `data` and `en`.
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
        """Add a reader: `addr` and `data`."""
        return ReadPort(
            ReadPort.Signature(addr_width=self._bits, shape=self._shape),
            memory=self._memory,
            domain="comb",
            path=(self._name, name),
        )
