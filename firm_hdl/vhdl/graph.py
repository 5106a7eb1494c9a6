"""The drivers and readers of each wire of a module, and the expressions that need no signal.

Amaranth gives every operator a wire of its own, including the carry bits that nothing reads. The
passes narrow each generated wire to the bits that are read. Then the wire takes over the name of a
signal with the same value, or it is folded into the expression that reads it. Each pass takes a
graph and returns another one.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import TypeAlias

from firm_hdl.names.attributes import PURPOSE, REMARK
from firm_hdl.rtlil.fields import base_of_field
from firm_hdl.rtlil.ir import Assign, Cell, Module, Process, Slice, Spec, Value, Wire, spec_width
from firm_hdl.vhdl.uses import INLINE, Use, output, statement_uses, uses_of

__all__ = [
    "Connection",
    "Graph",
    "attributes_of",
    "graph_of",
    "only",
    "target_of",
    "uses_with_registers",
    "wires_of",
]


_INTERNAL = ("init", "src", "generator", "top", "enum_base_type", PURPOSE, REMARK)
"""Attributes that are for readers of RTLIL."""

Connection: TypeAlias = "tuple[Spec, Spec]"
"""A target and the value that drives it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Graph:
    """Drivers, readers, widths and folding of one module."""

    module: Module
    modules: Mapping[str, Module]  # All modules of the design.
    cells: tuple[Cell, ...]
    processes: tuple[Process, ...]  # All processes except those in `next_state`.
    # Declared bits of each wire; for generated wires, the bits that are read.
    width: Mapping[str, int]
    drives: tuple[Connection, ...] = ()  # Connections that drive a wire.
    # Connections that only give a value another name, and that tools are to keep.
    aliases: tuple[Connection, ...] = ()
    # Aliases that are fields of a signal, which nothing needs if the signal has a name.
    fields: tuple[Connection, ...] = ()
    # By wire: the signal of the design that was no more than a copy of it.
    copy_of: Mapping[str, str] = field(default_factory=dict)
    # Generated wires that take over the name of a signal or port with the same value.
    name_of: Mapping[str, str] = field(default_factory=dict)
    # Flip-flops by the wire that they drive.
    register_of: Mapping[str, Cell] = field(default_factory=dict)
    # By register wire: the process that computes its next value and nothing else.
    next_state: Mapping[str, Process] = field(default_factory=dict)
    cell_uses: tuple[tuple[Use, ...], ...] = ()  # What each of the cells reads.
    # What a process reads, by the wire that it drives.
    process_uses: Mapping[str, tuple[Use, ...]] = field(default_factory=dict)
    # Generated wires without a signal: their expression is written where they are read.
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
        return chain(*self.cell_uses, *self.process_uses.values())

    def connected(self) -> Iterator[Spec]:
        """Yield the values that connections read."""
        yield from (value for _, value in self.drives + self.aliases)


def only(spec: Spec) -> Slice | None:
    """Return the slice of a value that consists of a single slice, else `None`."""
    return spec[0] if len(spec) == 1 and isinstance(spec[0], Slice) else None


def attributes_of(wire: Wire) -> dict[str, Value]:
    """Return the attributes of a wire that are for tools, such as ``keep``."""
    return {
        name: value
        for name, value in wire.attributes.items()
        if name not in _INTERNAL and not name.startswith("enum_value_")
    }


def wires_of(specs: Iterable[Spec]) -> Counter[str]:
    """Count how often values contain each wire."""
    return Counter(chunk.wire for spec in specs for chunk in spec if isinstance(chunk, Slice))


def target_of(process: Process) -> str | None:
    """Name the wire that a process drives, if any has bits; a process drives one wire only."""
    for statement in process.body:
        if isinstance(statement, Assign) and statement.target:
            chunk = statement.target[0]
            assert isinstance(chunk, Slice)
            return chunk.wire
    return None


_COMPARISONS = frozenset("$eq $ne $lt $le $gt $ge".split())

# Largest number of operands in an expression and in a chain of `or`, and of copies of a comparison.
_MAX_OPERANDS = 6
_MAX_CHAIN = 24
_MAX_REPEATS = 3


def graph_of(
    module: Module,
    modules: Mapping[str, Module],
    is_foldable: Callable[[Cell, int], bool] = lambda cell, width: True,
) -> Graph:
    """Build the graph of a module.

    * `modules`: all modules of the design, by name.
    * `is_foldable`: whether the language can write the operator in an expression, given the bits of
      its result that are read.
    """
    graph: Graph | None = module.memo.get(graph_of)
    if graph is None or graph.modules is not modules:
        graph = module.memo[graph_of] = _unfolded(module, modules)
    return _fold(graph, is_foldable)


def _unfolded(module: Module, modules: Mapping[str, Module]) -> Graph:
    """Build what is the same in all languages."""
    processes = {
        wire: item
        for item in module.items
        if isinstance(item, Process) and (wire := target_of(item)) is not None
    }
    graph = Graph(
        module=module,
        modules=modules,
        cells=tuple(i for i in module.items if isinstance(i, Cell) and _has_bits(i)),
        processes=tuple(processes.values()),
        process_uses={wire: tuple(statement_uses(i.body)) for wire, i in processes.items()},
        width={name: wire.width for name, wire in module.wires.items()},
    )
    for run_pass in PASSES:
        graph = run_pass(graph)
    return graph


def _drop_division_guards(graph: Graph) -> Graph:
    """Replace a division and its multiplexer for divisor 0 by the division.

    `floor_div` and `floor_mod` of the VHDL package give 0 for divisor 0.
    """
    divisions = {
        output(cell): cell for cell in graph.cells if cell.kind in ("$divfloor", "$modfloor")
    }
    tests = {output(cell): cell for cell in graph.cells if cell.kind == "$reduce_bool"}
    guards: set[str] = set()
    cells: list[Cell] = []
    for cell in graph.cells:
        source = only(cell.ports["B"]) if cell.kind == "$mux" else None
        test = only(cell.ports["S"]) if cell.kind == "$mux" else None
        if (
            source is not None
            and source.bare
            and source.wire in divisions
            and test is not None
            and test.wire in tests
            and tests[test.wire].ports["A"] == divisions[source.wire].ports["B"]
        ):
            division = divisions[source.wire]
            guards.add(source.wire)
            ports = {**division.ports, "Y": cell.ports["Y"]}
            cell = Cell(
                kind=division.kind,
                name=cell.name,
                parameters=division.parameters,
                ports=ports,
                attributes=cell.attributes,
                line=division.line,
            )
        cells.append(cell)
    kept = (
        cell
        for cell in cells
        if cell.kind not in ("$divfloor", "$modfloor") or output(cell) not in guards
    )
    return replace(graph, cells=tuple(kept))


def _sort_connections(graph: Graph) -> Graph:
    """Separate connections that drive a wire from those that only give a value another name."""
    module = graph.module
    uses = chain(
        *(uses_of(cell, graph.width) for cell in graph.cells), *graph.process_uses.values()
    )
    read = {chunk.wire for use in uses for chunk in use.spec if isinstance(chunk, Slice)}
    read |= {c.wire for _, value in module.connections for c in value if isinstance(c, Slice)}
    drives: list[Connection] = []
    aliases: list[Connection] = []
    fields: list[Connection] = []
    for target, value in module.connections:
        if not target:
            continue
        chunk = target[0]
        assert isinstance(chunk, Slice)
        wire = module.wires[chunk.wire]
        if wire.direction is not None or wire.name in read:
            drives.append((target, value))
        elif base_of_field(wire.name) in module.wires:
            fields.append((target, value))
        elif not _is_second_copy(graph, wire.name, value):
            aliases.append((target, value))
    return replace(graph, drives=tuple(drives), aliases=tuple(aliases), fields=tuple(fields))


def _is_second_copy(graph: Graph, name: str, value: Spec) -> bool:
    """Return whether a name is a second copy of the name of a value."""
    base, _, number = name.rpartition("$")
    source = only(value)
    return (
        number.isdecimal()
        and source is not None
        and source.wire == base
        and source.width == graph.width[base]
    )


def _narrow(graph: Graph) -> Graph:
    """Give generated wires the width that is read; drop operators that nothing reads."""
    drivers = {
        output(cell): cell
        for cell in graph.cells
        if cell.kind in INLINE and output(cell).startswith("$")
    }
    width = dict(graph.width)
    # By wire: one more than the highest bit that is read. It only grows, so the work has an end.
    needed: Counter[str] = Counter()
    pending: list[str] = []

    def demand(spec: Spec) -> None:
        for chunk in spec:
            if isinstance(chunk, Slice) and chunk.low + chunk.width > needed[chunk.wire]:
                needed[chunk.wire] = chunk.low + chunk.width
                if chunk.wire in drivers:
                    pending.append(chunk.wire)

    for cell in graph.cells:
        if cell.kind not in INLINE or output(cell) not in drivers:
            for use in uses_of(cell, width):
                demand(use.spec)
    for use in chain(*graph.process_uses.values()):
        demand(use.spec)
    for value in graph.connected():
        demand(value)
    while pending:
        name = pending.pop()
        width[name] = needed[name]
        for use in uses_of(drivers[name], width):
            demand(use.spec)
    kept = tuple(
        cell
        for cell in graph.cells
        if cell.kind not in INLINE or output(cell) not in drivers or needed[output(cell)]
    )
    # From here on, neither cells nor widths change.
    uses = tuple(tuple(uses_of(cell, width)) for cell in kept)
    return replace(graph, cells=kept, width=width, cell_uses=uses)


def _adopt_names(graph: Graph) -> Graph:
    """Give wires the names of the signals to which they are connected as a whole.

    A wire needs a name if its own is generated, or is that of a submodule's port.
    """
    name_of: dict[str, str] = {}
    drives = list(graph.drives)
    aliases = list(graph.aliases)
    ports = set(_named_after_ports(graph))
    for connections in (drives, aliases, list(graph.fields)):
        kept: list[Connection] = []
        for target, value in connections:
            to, source = target[0], only(value)
            if (
                isinstance(to, Slice)
                and source is not None
                and (source.wire.startswith("$") or source.wire in ports)
                and to.wire not in ports
                and source.wire not in name_of
                and to.bare
                and source.low == 0
                and source.width == graph.width[source.wire]
                and graph.module.wires[to.wire].direction != "inout"
                and not _is_driven(source.wire, drives)
            ):
                name_of[source.wire] = to.wire
            else:
                kept.append((target, value))
        connections[:] = kept
    return replace(graph, drives=tuple(drives), aliases=tuple(aliases), name_of=name_of)


def _drop_copies(graph: Graph) -> Graph:
    """Drop the copies of values that nothing reads, but those with attributes for tools."""
    kept: list[Connection] = []
    copy_of: dict[str, str] = {}
    for target, value in graph.aliases:
        to, source = target[0], only(value)
        assert isinstance(to, Slice)
        if attributes_of(graph.module.wires[to.wire]):
            kept.append((target, value))
        elif source is not None and source.width == graph.width[source.wire] and to.bare:
            copy_of.setdefault(source.wire, to.wire)
    return replace(graph, aliases=tuple(kept), copy_of=copy_of)


def _named_after_ports(graph: Graph) -> Iterator[str]:
    """Yield the inner wires with the name of the submodule's port to which they are connected."""
    for cell in graph.cells:
        if graph.is_submodule(cell):
            for port, spec in cell.ports.items():
                chunk = only(spec)
                if chunk is not None and graph.module.wires[chunk.wire].direction is None:
                    base, mark, number = chunk.wire.rpartition("$")
                    if port in (chunk.wire, base if mark and number.isdecimal() else None):
                        yield chunk.wire


def _is_driven(wire: str, drives: list[Connection]) -> bool:
    return any(to[0].wire == wire for to, _ in drives if isinstance(to[0], Slice))


def _pair_registers(graph: Graph) -> Graph:
    """Find the registers, and the processes that compute the next value of a single register."""
    reads = wires_of([*(use.spec for use in graph.uses()), *graph.connected()])
    by_target = {target_of(process): process for process in graph.processes}
    registers = {output(cell): cell for cell in graph.cells if cell.kind in ("$dff", "$adff")}
    next_state: dict[str, Process] = {}
    # A next value that nothing but its register reads needs no signal: its process is written as a
    # part of the clocked one.
    for register, cell in registers.items():
        chunk = only(cell.ports["D"])
        if (
            chunk is not None
            and chunk.wire in by_target
            and chunk.wire.startswith("$")
            and chunk.wire not in graph.name_of
            and chunk.width == graph.width[chunk.wire]
            and reads[chunk.wire] == 1
        ):
            next_state[register] = by_target[chunk.wire]
    paired = {id(process) for process in next_state.values()}
    others = tuple(process for process in graph.processes if id(process) not in paired)
    return replace(graph, processes=others, register_of=registers, next_state=next_state)


def uses_with_registers(graph: Graph) -> Iterator[Use]:
    """Yield all values that are read; for a register, the values that its process reads."""
    for cell, uses in zip(graph.cells, graph.cell_uses, strict=True):
        if cell.kind in ("$dff", "$adff") and output(cell) in graph.next_state:
            yield from (use for use in uses if use.spec != cell.ports["D"])
        else:
            yield from uses
    yield from chain(*graph.process_uses.values())
    for value in graph.connected():
        yield Use(value, True)


def _fold(graph: Graph, is_foldable: Callable[[Cell, int], bool]) -> Graph:
    """Find the generated wires whose expression can be written where they are read."""
    # What is read in part, or where only a name may stand, keeps its signal: neither VHDL nor
    # Verilog has slices of expressions.
    count: Counter[str] = Counter()
    fixed: set[str] = set()
    for use in uses_with_registers(graph):
        for chunk in use.spec:
            if isinstance(chunk, Slice):
                count[chunk.wire] += 1
                whole = chunk.low == 0 and chunk.width == graph.width[chunk.wire]
                if not use.inline or not whole:
                    fixed.add(chunk.wire)
    candidates = {
        output(cell): cell
        for cell in graph.cells
        if cell.kind in INLINE
        and output(cell).startswith("$")
        and output(cell) not in graph.name_of
        and output(cell) not in fixed
        and is_foldable(cell, graph.width[output(cell)])
    }
    folded: dict[str, Cell] = {}
    leaves: dict[str, int] = defaultdict(lambda: 1)
    for name in _in_order(candidates):
        cell = candidates[name]
        weight = sum(
            leaves[chunk.wire] if isinstance(chunk, Slice) else 1
            for port, spec in cell.ports.items()
            if port != "Y"
            for chunk in spec
        )
        most = _MAX_CHAIN if cell.kind == "$or" else _MAX_OPERANDS
        if weight <= most and (count[name] == 1 or _may_repeat(cell, count[name], folded)):
            leaves[name] = weight
            folded[name] = cell
    return replace(graph, folded=folded)


def _may_repeat(cell: Cell, uses: int, folded: dict[str, Cell]) -> bool:
    """Return whether an expression may have copies: of a few bits, or a simple comparison."""
    specs = [spec for port, spec in cell.ports.items() if port != "Y"]
    if any(isinstance(c, Slice) and c.wire in folded for spec in specs for c in spec):
        return False
    if cell.kind in ("$reduce_or", "$reduce_bool") and uses <= _MAX_REPEATS:
        return spec_width(cell.ports["A"]) <= _MAX_REPEATS
    if any(len(spec) > 1 for spec in specs):
        return False
    if cell.kind == "$not":
        return spec_width(cell.ports["A"]) == 1
    is_pair = cell.kind in ("$and", "$or") and spec_width(cell.ports["Y"]) == 1
    return (is_pair or cell.kind in _COMPARISONS) and uses <= _MAX_REPEATS


def _in_order(candidates: dict[str, Cell]) -> Iterator[str]:
    """Yield wires so that operands come before the operators that read them."""
    done: set[str] = set()
    for root in candidates:
        stack = [(root, False)]
        while stack:
            name, visited = stack.pop()
            if visited:
                yield name
                continue
            if name in done:
                continue
            done.add(name)
            stack.append((name, True))
            for port, spec in candidates[name].ports.items():
                if port != "Y":
                    stack.extend(
                        (chunk.wire, False)
                        for chunk in spec
                        if isinstance(chunk, Slice)
                        and chunk.wire in candidates
                        and chunk.wire not in done
                    )


def _has_bits(cell: Cell) -> bool:
    """Return whether the result of a cell has any bits."""
    for port in ("Y", "Q"):
        if cell.kind.startswith("$") and port in cell.ports and not cell.ports[port]:
            return False
    if cell.kind == "$memrd_v2":
        return bool(cell.ports["DATA"])
    return cell.kind != "$memwr_v2" or bool(cell.ports["DATA"])


PASSES: tuple[Callable[[Graph], Graph], ...] = (
    _drop_division_guards,
    _sort_connections,
    _narrow,
    _adopt_names,
    _drop_copies,
    _pair_registers,
)
"""The passes in order: each pass relies on those before it."""
