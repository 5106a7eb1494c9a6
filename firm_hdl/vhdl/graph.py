"""What drives and what reads each wire of a module, and which expressions need no name.

Amaranth gives every operator a wire of its own and leaves it to the reader to cut off the carry.
Here each made-up wire is narrowed to the bits that are read, takes over the name of a signal that
is the same thing, or disappears into the one expression that reads it.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping

from firm_hdl.rtlil.ir import (
    Assign,
    Cell,
    Module,
    Process,
    Slice,
    Spec,
    spec_width,
)
from firm_hdl.vhdl.uses import INLINE, Use, output, statement_uses, uses_of

__all__ = ["Graph"]

_COMPARISONS = frozenset("$eq $ne $lt $le $gt $ge".split())

# How many operands an expression has at most, and how often a comparison is written out.
_FOLD_LEAVES = 6
_REPEATS = 3


class Graph:
    """Drivers, readers, widths and folding of one module.

    Attributes
    ----------
    width : dict of str to int
        Bits of each wire that are declared: those that somebody reads, for made-up wires.
    folded : dict of str to Cell
        Made-up wires that have no signal: their expression stands where they are read.
    register_of : dict of str to Cell
        Flip-flops by the wire that they drive.
    next_state : dict of str to Process
        By register wire: the process that computes its next value, for it alone.
    name_of : dict of str to str
        Made-up wires that take over the name of a signal or port that is the same.
    drives, watches : list of (Spec, Spec)
        Connections that drive something; connections that only give a value one more name.
    cells, processes : list
        What is left of the items.
    """

    def __init__(self, module: Module, *, modules: Mapping[str, Module]) -> None:
        self.module = module
        self._modules = modules
        self.width = {name: wire.width for name, wire in module.wires.items()}
        self.cells = [item for item in module.items if isinstance(item, Cell) and _is_real(item)]
        self.processes = [
            item for item in module.items if isinstance(item, Process) and _target(item) is not None
        ]
        self.drives: list[tuple[Spec, Spec]] = []
        self.aliases: list[tuple[Spec, Spec]] = []
        self.register_of: dict[str, Cell] = {}
        self.next_state: dict[str, Process] = {}
        self.name_of: dict[str, str] = {}
        self.folded: dict[str, Cell] = {}
        self._drop_division_guards()
        self._sort_connections()
        self._narrow()
        self._adopt_names()
        self._pair_registers()
        self._fold()

    def target(self, process: Process) -> str:
        """Name the wire that a process drives."""
        name = _target(process)
        assert name is not None
        return name

    def is_instance(self, cell: Cell) -> bool:
        """Tell an instance, of a module of the design or of something foreign."""
        return not cell.kind.startswith("$")

    def is_submodule(self, cell: Cell) -> bool:
        """Tell an instance of a module of the design."""
        return cell.kind in self._modules

    def is_output(self, cell: Cell, port: str) -> bool:
        """Tell whether a port of an instance drives what it is connected to.

        Of a foreign one, Amaranth prints the wire of an output without a slice, and everything else
        with one.
        """
        if cell.kind in self._modules:
            return self._modules[cell.kind].wires[port].direction == "output"
        whole = _only(cell.ports[port])
        return whole is not None and whole.bare

    # What follows runs once, in the order of the constructor.

    def _drop_division_guards(self) -> None:
        """Let a division's result be what its multiplexer for divisor 0 makes of it.

        `floor_div` and `floor_mod` give 0 in that case by themselves.
        """
        divisions = {
            output(cell): cell for cell in self.cells if cell.kind in ("$divfloor", "$modfloor")
        }
        tests = {output(cell): cell for cell in self.cells if cell.kind == "$reduce_bool"}
        guards: set[str] = set()
        cells: list[Cell] = []
        for cell in self.cells:
            source = _only(cell.ports["B"]) if cell.kind == "$mux" else None
            test = _only(cell.ports["S"]) if cell.kind == "$mux" else None
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
        self.cells = [
            cell
            for cell in cells
            if cell.kind not in ("$divfloor", "$modfloor") or output(cell) not in guards
        ]

    def _sort_connections(self) -> None:
        wires = self.module.wires
        read = {
            chunk.wire
            for use in self._cell_uses()
            for chunk in use.spec
            if isinstance(chunk, Slice)
        }
        read |= {
            c.wire for _, value in self.module.connections for c in value if isinstance(c, Slice)
        }
        for target, value in self.module.connections:
            if not target:
                continue
            chunk = target[0]
            assert isinstance(chunk, Slice)
            wire = wires[chunk.wire]
            if wire.direction is not None or wire.name in read:
                self.drives.append((target, value))
            elif not self._is_echo(wire.name, value):
                self.aliases.append((target, value))

    def _is_echo(self, name: str, value: Spec) -> bool:
        """Tell names that add nothing: fields of a signal, and a second copy of a name."""
        cut = min((i for i in (name.find("."), name.find("[")) if i > 0), default=0)
        if cut and name[:cut] in self.module.wires:
            return True
        base, _, number = name.rpartition("$")
        source = _only(value)
        return (
            number.isdecimal()
            and source is not None
            and source.wire == base
            and source.width == self.width[base]
        )

    def _cell_uses(self) -> Iterator[Use]:
        for cell in self.cells:
            yield from uses_of(cell, self.width)
        for process in self.processes:
            yield from statement_uses(process.body)

    def _narrow(self) -> None:
        """Give made-up operator results the width that is read; drop what nobody reads."""
        drivers = {
            output(cell): cell
            for cell in self.cells
            if cell.kind in INLINE and output(cell).startswith("$")
        }
        needed: Counter[str] = Counter()
        pending: list[str] = []

        def demand(spec: Spec) -> None:
            for chunk in spec:
                if isinstance(chunk, Slice) and chunk.low + chunk.width > needed[chunk.wire]:
                    needed[chunk.wire] = chunk.low + chunk.width
                    if chunk.wire in drivers:
                        pending.append(chunk.wire)

        for cell in self.cells:
            if cell.kind not in INLINE or output(cell) not in drivers:
                for use in uses_of(cell, self.width):
                    demand(use.spec)
        for process in self.processes:
            for use in statement_uses(process.body):
                demand(use.spec)
        for _, value in self.drives + self.aliases:
            demand(value)
        while pending:
            name = pending.pop()
            self.width[name] = needed[name]
            for use in uses_of(drivers[name], self.width):
                demand(use.spec)
        self.cells = [
            cell
            for cell in self.cells
            if cell.kind not in INLINE or output(cell) not in drivers or needed[output(cell)]
        ]

    def _adopt_names(self) -> None:
        for connections in (self.drives, self.aliases):
            kept: list[tuple[Spec, Spec]] = []
            for target, value in connections:
                to, source = target[0], _only(value)
                if (
                    isinstance(to, Slice)
                    and source is not None
                    and source.wire.startswith("$")
                    and source.wire not in self.name_of
                    and to.bare
                    and source.low == 0
                    and source.width == self.width[source.wire]
                    and self.module.wires[to.wire].direction != "inout"
                    and self._can_be_named(source.wire)
                ):
                    self.name_of[source.wire] = to.wire
                else:
                    kept.append((target, value))
            connections[:] = kept

    def _can_be_named(self, wire: str) -> bool:
        return all(to[0].wire != wire for to, _ in self.drives if isinstance(to[0], Slice))

    def _pair_registers(self) -> None:
        reads = Counter(
            chunk.wire for spec in self._all_specs() for chunk in spec if isinstance(chunk, Slice)
        )
        by_target = {self.target(process): process for process in self.processes}
        for cell in self.cells:
            if cell.kind not in ("$dff", "$adff"):
                continue
            register = output(cell)
            self.register_of[register] = cell
            chunk = _only(cell.ports["D"])
            if (
                chunk is not None
                and chunk.wire in by_target
                and chunk.wire.startswith("$")
                and chunk.wire not in self.name_of
                and chunk.width == self.width[chunk.wire]
                and reads[chunk.wire] == 1
            ):
                self.next_state[register] = by_target[chunk.wire]
        paired = {id(process) for process in self.next_state.values()}
        self.processes = [process for process in self.processes if id(process) not in paired]

    def _all_specs(self) -> Iterator[Spec]:
        yield from (use.spec for use in self._cell_uses())
        yield from (value for _, value in self.drives + self.aliases)

    def _all_uses(self) -> Iterator[Use]:
        for cell in self.cells:
            register = output(cell) if cell.kind in ("$dff", "$adff") else None
            process = self.next_state.get(register) if register else None
            for use in uses_of(cell, self.width):
                if process is None or use.spec != cell.ports["D"]:
                    yield use
            if process is not None:
                yield from statement_uses(process.body)
        for process in self.processes:
            yield from statement_uses(process.body)
        for _, value in self.drives + self.aliases:
            yield Use(value, True)

    def _fold(self) -> None:
        count: Counter[str] = Counter()
        fixed: set[str] = set()
        for use in self._all_uses():
            for chunk in use.spec:
                if isinstance(chunk, Slice):
                    count[chunk.wire] += 1
                    whole = chunk.low == 0 and chunk.width == self.width[chunk.wire]
                    if not use.inline or not whole:
                        fixed.add(chunk.wire)
        candidates = {
            output(cell): cell
            for cell in self.cells
            if cell.kind in INLINE
            and output(cell).startswith("$")
            and output(cell) not in self.name_of
            and output(cell) not in fixed
        }
        leaves: dict[str, int] = defaultdict(lambda: 1)
        for name in _in_order(candidates):
            cell = candidates[name]
            weight = sum(
                leaves[chunk.wire] if isinstance(chunk, Slice) else 1
                for port, spec in cell.ports.items()
                if port != "Y"
                for chunk in spec
            )
            if weight <= _FOLD_LEAVES and (
                count[name] == 1 or _may_repeat(cell, count[name], self.folded)
            ):
                leaves[name] = weight
                self.folded[name] = cell


def _may_repeat(cell: Cell, uses: int, folded: dict[str, Cell]) -> bool:
    """Tell what is as short as a name for it: an inverted bit, or two signals compared."""
    specs = [spec for port, spec in cell.ports.items() if port != "Y"]
    if any(len(spec) > 1 for spec in specs):
        return False
    if any(isinstance(c, Slice) and c.wire in folded for spec in specs for c in spec):
        return False
    if cell.kind == "$not":
        return spec_width(cell.ports["A"]) == 1
    return cell.kind in _COMPARISONS and uses <= _REPEATS


def _in_order(candidates: dict[str, Cell]) -> Iterator[str]:
    """Yield wires so that operands come before what they are operands of."""
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


def _only(spec: Spec) -> Slice | None:
    """Return the part of a wire that a value is, if it is nothing besides."""
    return spec[0] if len(spec) == 1 and isinstance(spec[0], Slice) else None


def _is_real(cell: Cell) -> bool:
    """Tell cells with a result from those whose result has no bits."""
    for port in ("Y", "Q"):
        if cell.kind.startswith("$") and port in cell.ports and not cell.ports[port]:
            return False
    if cell.kind == "$memrd_v2":
        return bool(cell.ports["DATA"])
    return cell.kind != "$memwr_v2" or bool(cell.ports["DATA"])


def _target(process: Process) -> str | None:
    """Name the wire that a process drives: Amaranth makes one process a signal."""
    for statement in process.body:
        if isinstance(statement, Assign) and statement.target:
            chunk = statement.target[0]
            assert isinstance(chunk, Slice)
            return chunk.wire
    return None
