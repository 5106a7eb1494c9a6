"""What drives and what reads each wire of a module, and which expressions need no name.

Amaranth gives every operator a wire of its own and leaves it to the reader to cut off the carry.
Here each made-up wire is narrowed to the bits that are read, takes over the name of a signal that
is the same thing, or disappears into the one expression that reads it.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from firm_hdl.export.rtlil_ir import (
    Assign,
    Bits,
    Cell,
    Chunk,
    Module,
    Process,
    Slice,
    Spec,
    Statement,
    Switch,
    spec_width,
)

__all__ = ["INLINE", "Graph", "enable_runs", "int_parameter", "trim"]

_MODULAR = frozenset("$add $sub $mul $neg $and $or $xor $not $mux $shl".split())
"""Kinds whose low result bits depend on the low operand bits alone."""

INLINE = _MODULAR | frozenset(
    "$reduce_bool $reduce_or $reduce_and $reduce_xor $divfloor $modfloor $shr $sshr $shift "
    "$eq $ne $lt $le $gt $ge".split()
)
"""Kinds that are an expression."""

_FOLD_LEAVES = 6


def trim(spec: Spec, width: int) -> Spec:
    """Keep the `width` low bits."""
    kept: list[Chunk] = []
    for chunk in spec:
        if width <= 0:
            break
        if chunk.width > width:
            chunk = (
                Bits(chunk.text[-width:])
                if isinstance(chunk, Bits)
                else Slice(chunk.wire, chunk.low, width)
            )
        kept.append(chunk)
        width -= chunk.width
    return tuple(kept)


def int_parameter(cell: Cell, name: str) -> int:
    """Read a parameter that is a number."""
    value = cell.parameters.get(name, 0)
    if isinstance(value, Bits):
        return int(value.text or "0", 2)
    if not isinstance(value, int):
        raise ValueError(f"RTLIL line {cell.line}: parameter {name} of {cell.kind} is no number")
    return value


def enable_runs(spec: Spec) -> list[tuple[Chunk, int, int]]:
    """Split a write enable, one bit per data bit, into (bit, lowest data bit, number of bits)."""
    runs: list[tuple[Chunk, int, int]] = []
    position = 0
    for chunk in spec:
        for i in range(chunk.width):
            bit: Chunk = (
                Bits(chunk.text[-1 - i])
                if isinstance(chunk, Bits)
                else Slice(chunk.wire, chunk.low + i, 1)
            )
            if runs and runs[-1][0] == bit:
                runs[-1] = (bit, runs[-1][1], runs[-1][2] + 1)
            else:
                runs.append((bit, position, 1))
            position += 1
    return runs


@dataclass(frozen=True, slots=True)
class _Use:
    """A reading of a specification. `inline`: an expression may stand there."""

    spec: Spec
    inline: bool


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
        self.watches: list[tuple[Spec, Spec]] = []
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

    def output(self, cell: Cell) -> str:
        """Name the wire that an operator, flip-flop or memory port drives."""
        port = {"$dff": "Q", "$adff": "Q", "$memrd_v2": "DATA"}.get(cell.kind, "Y")
        chunk = cell.ports[port][0]
        assert isinstance(chunk, Slice)
        return chunk.wire

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
        spec = cell.ports[port]
        return len(spec) == 1 and isinstance(spec[0], Slice) and spec[0].bare

    # What follows runs once, in the order of the constructor.

    def _drop_division_guards(self) -> None:
        """Let a division's result be what its multiplexer for divisor 0 makes of it.

        `floor_div` and `floor_mod` give 0 in that case by themselves.
        """
        divisions = {
            self.output(cell): cell
            for cell in self.cells
            if cell.kind in ("$divfloor", "$modfloor")
        }
        tests = {self.output(cell): cell for cell in self.cells if cell.kind == "$reduce_bool"}
        guards: set[str] = set()
        cells: list[Cell] = []
        for cell in self.cells:
            source = cell.ports["B"][0] if cell.kind == "$mux" and cell.ports["B"] else None
            test = cell.ports["S"][0] if cell.kind == "$mux" and cell.ports["S"] else None
            if (
                isinstance(source, Slice)
                and source.bare
                and source.wire in divisions
                and isinstance(test, Slice)
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
            if cell.kind not in ("$divfloor", "$modfloor") or self.output(cell) not in guards
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
                self.watches.append((target, value))

    def _is_echo(self, name: str, value: Spec) -> bool:
        """Tell names that add nothing: fields of a signal, and a second copy of a name."""
        cut = min((i for i in (name.find("."), name.find("[")) if i > 0), default=0)
        if cut and name[:cut] in self.module.wires:
            return True
        base, mark, number = name.rpartition("$")
        return bool(
            mark
            and number.isdecimal()
            and len(value) == 1
            and isinstance(value[0], Slice)
            and value[0].wire == base
            and value[0].width == self.width[base]
        )

    def _cell_uses(self) -> Iterator[_Use]:
        for cell in self.cells:
            yield from self._uses_of(cell)
        for process in self.processes:
            yield from _statement_uses(process.body)

    def _uses_of(self, cell: Cell) -> Iterator[_Use]:
        kind, ports = cell.kind, cell.ports
        if kind in INLINE:
            width = self.width[self.output(cell)] if kind in _MODULAR else None
            for port, spec in ports.items():
                if port == "Y":
                    continue
                cut = width is not None and not (port in "BS" and kind in ("$shl",)) and port != "S"
                yield _Use(trim(spec, width) if cut and width is not None else spec, True)
        elif kind in ("$dff", "$adff"):
            yield _Use(ports["D"], True)
            yield _Use(ports["CLK"], False)
            yield _Use(ports.get("ARST", ()), False)
        elif kind == "$memwr_v2":
            runs = enable_runs(ports["EN"])
            yield _Use(ports["ADDR"], False)
            yield _Use(ports["DATA"], False)
            yield _Use(ports["CLK"], False)
            yield from (_Use((bit,), len(runs) == 1) for bit, _, _ in runs)
        elif kind == "$memrd_v2":
            yield _Use(ports["ADDR"], False)
            yield _Use(ports["EN"], True)
            yield _Use(ports["CLK"], False)
        elif kind in ("$check", "$print"):
            yield from (_Use(spec, port in ("A", "EN")) for port, spec in ports.items())
        elif kind == "$tribuf":
            yield from (_Use(ports[port], True) for port in ("A", "EN"))
        elif kind != "$meminit_v2":
            yield from (_Use(spec, False) for port, spec in ports.items())

    def _narrow(self) -> None:
        """Give made-up operator results the width that is read; drop what nobody reads."""
        drivers = {
            self.output(cell): cell
            for cell in self.cells
            if cell.kind in INLINE and self.output(cell).startswith("$")
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
            if cell.kind not in INLINE or self.output(cell) not in drivers:
                for use in self._uses_of(cell):
                    demand(use.spec)
        for process in self.processes:
            for use in _statement_uses(process.body):
                demand(use.spec)
        for _, value in self.drives + self.watches:
            demand(value)
        while pending:
            name = pending.pop()
            self.width[name] = needed[name]
            for use in self._uses_of(drivers[name]):
                demand(use.spec)
        self.cells = [
            cell
            for cell in self.cells
            if cell.kind not in INLINE
            or self.output(cell) not in drivers
            or needed[self.output(cell)]
        ]

    def _adopt_names(self) -> None:
        for connections in (self.drives, self.watches):
            kept: list[tuple[Spec, Spec]] = []
            for target, value in connections:
                to, source = target[0], value[0]
                if (
                    isinstance(to, Slice)
                    and isinstance(source, Slice)
                    and len(value) == 1
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
            register = self.output(cell)
            self.register_of[register] = cell
            data = cell.ports["D"]
            chunk = data[0]
            if (
                isinstance(chunk, Slice)
                and len(data) == 1
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
        yield from (value for _, value in self.drives + self.watches)

    def _all_uses(self) -> Iterator[_Use]:
        for cell in self.cells:
            register = self.output(cell) if cell.kind in ("$dff", "$adff") else None
            process = self.next_state.get(register) if register else None
            for use in self._uses_of(cell):
                if process is None or use.spec != cell.ports["D"]:
                    yield use
            if process is not None:
                yield from _statement_uses(process.body)
        for process in self.processes:
            yield from _statement_uses(process.body)
        for _, value in self.drives + self.watches:
            yield _Use(value, True)

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
            self.output(cell): cell
            for cell in self.cells
            if cell.kind in INLINE
            and self.output(cell).startswith("$")
            and self.output(cell) not in self.name_of
            and self.output(cell) not in fixed
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
            if weight <= _FOLD_LEAVES and (count[name] == 1 or _is_plain_not(cell, self.folded)):
                leaves[name] = weight
                self.folded[name] = cell


def _is_plain_not(cell: Cell, folded: dict[str, Cell]) -> bool:
    spec = cell.ports["A"]
    return (
        cell.kind == "$not"
        and spec_width(spec) == 1
        and isinstance(spec[0], Slice)
        and spec[0].wire not in folded
    )


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


def _statement_uses(body: tuple[Statement, ...]) -> Iterator[_Use]:
    for statement in body:
        if isinstance(statement, Assign):
            yield _Use(statement.value, True)
            continue
        yield from _selector_uses(statement)
        for case in statement.cases:
            yield from _statement_uses(case.body)


def _selector_uses(switch: Switch) -> Iterator[_Use]:
    """A bit of a selector may be an expression if one arm alone looks at it."""
    position = spec_width(switch.selector)
    for chunk in reversed(switch.selector):
        low = position - chunk.width
        looks = sum(
            any(mark != "-" for mark in pattern[len(pattern) - position : len(pattern) - low])
            for case in switch.cases
            for pattern in case.patterns
        )
        both = len(switch.selector) == 1 and looks == 2 and position == 1
        yield _Use((chunk,), chunk.width == 1 and (looks <= 1 or both))
        position = low
