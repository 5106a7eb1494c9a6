"""The drivers and readers of each wire of a module, and the expressions that need no signal.

Amaranth gives every operator a wire of its own, including the carry bits that nothing reads. The
passes of :mod:`firm_hdl.vhdl.passes` narrow each generated wire to the bits that are read. Then the
wire takes over the name of a signal with the same value, or it is folded into the expression that
reads it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from firm_hdl.rtlil.ir import Assign, Cell, Module, Process, Slice, Spec
from firm_hdl.vhdl.uses import Use, statement_uses, uses_of

__all__ = ["Connection", "Graph", "only", "target_of"]

Connection: TypeAlias = "tuple[Spec, Spec]"
"""A target and the value that drives it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Graph:
    """Drivers, readers, widths and folding of one module.

    Attributes
    ----------
    module : Module
    modules : mapping of str to Module
        All modules of the design.
    cells : tuple of Cell
    processes : tuple of Process
        All processes except those in `next_state`.
    width : mapping of str to int
        Declared bits of each wire; for generated wires, the bits that are read.
    drives : tuple of Connection
        Connections that drive a wire.
    aliases : tuple of Connection
        Connections that only give a value another name.
    name_of : mapping of str to str
        Generated wires that take over the name of a signal or port with the same value.
    register_of : mapping of str to Cell
        Flip-flops by the wire that they drive.
    next_state : mapping of str to Process
        By register wire: the process that computes its next value and nothing else.
    folded : mapping of str to Cell
        Generated wires without a signal: their expression is written where they are read.
    """

    module: Module
    modules: Mapping[str, Module]
    cells: tuple[Cell, ...]
    processes: tuple[Process, ...]
    width: Mapping[str, int]
    drives: tuple[Connection, ...] = ()
    aliases: tuple[Connection, ...] = ()
    name_of: Mapping[str, str] = field(default_factory=dict)
    register_of: Mapping[str, Cell] = field(default_factory=dict)
    next_state: Mapping[str, Process] = field(default_factory=dict)
    folded: Mapping[str, Cell] = field(default_factory=dict)

    def target(self, process: Process) -> str:
        """Name the wire that a process drives."""
        name = target_of(process)
        assert name is not None
        return name

    def is_instance(self, cell: Cell) -> bool:
        """Return whether a cell is an instance: of a module or of a foreign component."""
        return not cell.kind.startswith("$")

    def is_submodule(self, cell: Cell) -> bool:
        """Return whether a cell is an instance of a module of the design."""
        return cell.kind in self.modules

    def is_output(self, cell: Cell, port: str) -> bool:
        """Return whether a port of an instance is an output.

        For a foreign component, Amaranth prints the wire of an output without a slice. It prints
        every other connection with a slice.
        """
        if cell.kind in self.modules:
            return self.modules[cell.kind].wires[port].direction == "output"
        whole = only(cell.ports[port])
        return whole is not None and whole.bare

    def uses(self) -> Iterator[Use]:
        """Yield the values that cells and processes read."""
        for cell in self.cells:
            yield from uses_of(cell, self.width)
        for process in self.processes:
            yield from statement_uses(process.body)

    def connected(self) -> Iterator[Spec]:
        """Yield the values that connections read."""
        yield from (value for _, value in self.drives + self.aliases)


def only(spec: Spec) -> Slice | None:
    """Return the slice of a value that consists of a single slice, else `None`."""
    return spec[0] if len(spec) == 1 and isinstance(spec[0], Slice) else None


def target_of(process: Process) -> str | None:
    """Name the wire that a process drives, if any has bits; a process drives one wire only."""
    for statement in process.body:
        if isinstance(statement, Assign) and statement.target:
            chunk = statement.target[0]
            assert isinstance(chunk, Slice)
            return chunk.wire
    return None
