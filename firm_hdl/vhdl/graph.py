"""What drives and what reads each wire of a module, and which expressions need no name.

Amaranth gives every operator a wire of its own and leaves it to the reader to cut off the carry.
Here each made-up wire is narrowed to the bits that are read, takes over the name of a signal that
is the same thing, or disappears into the one expression that reads it. :mod:`firm_hdl.vhdl.passes`
does that, one pass after the other.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from firm_hdl.rtlil.ir import Assign, Cell, Module, Process, Slice, Spec
from firm_hdl.vhdl.uses import Use, statement_uses, uses_of

__all__ = ["Connection", "Graph", "only", "target_of"]

Connection: TypeAlias = "tuple[Spec, Spec]"
"""What is driven, and by what."""


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
        Those that compute the next value of one register alone are in `next_state` instead.
    width : mapping of str to int
        Bits of each wire that are declared: those that somebody reads, for made-up wires.
    drives : tuple of Connection
        Connections that drive something.
    aliases : tuple of Connection
        Connections that only give a value one more name.
    name_of : mapping of str to str
        Made-up wires that take over the name of a signal or port that is the same.
    register_of : mapping of str to Cell
        Flip-flops by the wire that they drive.
    next_state : mapping of str to Process
        By register wire: the process that computes its next value, for it alone.
    folded : mapping of str to Cell
        Made-up wires that have no signal: their expression stands where they are read.
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
        """Tell an instance, of a module of the design or of something foreign."""
        return not cell.kind.startswith("$")

    def is_submodule(self, cell: Cell) -> bool:
        """Tell an instance of a module of the design."""
        return cell.kind in self.modules

    def is_output(self, cell: Cell, port: str) -> bool:
        """Tell whether a port of an instance drives what it is connected to.

        Of a foreign one, Amaranth prints the wire of an output without a slice, and everything else
        with one.
        """
        if cell.kind in self.modules:
            return self.modules[cell.kind].wires[port].direction == "output"
        whole = only(cell.ports[port])
        return whole is not None and whole.bare

    # What follows runs once, in the order of the constructor.

    def uses(self) -> Iterator[Use]:
        """Yield what cells and processes read."""
        for cell in self.cells:
            yield from uses_of(cell, self.width)
        for process in self.processes:
            yield from statement_uses(process.body)

    def connected(self) -> Iterator[Spec]:
        """Yield what connections read."""
        yield from (value for _, value in self.drives + self.aliases)


def only(spec: Spec) -> Slice | None:
    """Return the part of a wire that a value is, if it is nothing besides."""
    return spec[0] if len(spec) == 1 and isinstance(spec[0], Slice) else None


def target_of(process: Process) -> str | None:
    """Name the wire that a process drives, if it has bits: Amaranth makes one process a signal."""
    for statement in process.body:
        if isinstance(statement, Assign) and statement.target:
            chunk = statement.target[0]
            assert isinstance(chunk, Slice)
            return chunk.wire
    return None
