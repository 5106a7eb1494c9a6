"""Flip-flops: one clocked process for all flip-flops with the same clock edge and reset."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from firm_hdl.rtlil.ir import (
    Assign,
    Bits,
    Cell,
    Slice,
    Spec,
    Statement,
    Switch,
    bits_of,
    spec_width,
)
from firm_hdl.vhdl.declare import Names, initial_value
from firm_hdl.vhdl.expr import Values
from firm_hdl.vhdl.graph import Graph
from firm_hdl.vhdl.process import Statements, flatten, merged

__all__ = ["Registers"]


@dataclass(frozen=True, slots=True)
class Register:
    wire: str
    cell: Cell
    body: tuple[Statement, ...]
    reset: Spec


@dataclass(frozen=True, slots=True)
class Group:
    """Clock and reset of the registers of one process, as text."""

    edge: str
    clock: str
    reset: str
    asynchronous: bool


class Registers:
    """Writes the registers of a module."""

    def __init__(self, graph: Graph, values: Values, statements: Statements, names: Names) -> None:
        self.graph = graph
        self.values = values
        self.statements = statements
        self.names = names

    def summary(self) -> Iterator[str]:
        """Yield comments on clocks and resets."""
        for group, registers in self._groups.items():
            count = len(registers)
            noun = "1 register" if count == 1 else f"{count} registers"
            kind = "asynchronous" if group.asynchronous else "synchronous"
            reset = f"{kind} reset {group.reset}" if group.reset else "no reset"
            yield f"{noun} at {group.edge}, {reset}."

    @cached_property
    def _groups(self) -> dict[Group, list[Register]]:
        groups: dict[Group, list[Register]] = defaultdict(list)
        for wire, cell in self.graph.register_of.items():
            register = self.register_of(wire, cell)
            asynchronous = cell.kind == "$adff"
            spec = cell.ports["ARST"] if asynchronous else register.reset
            group = Group(
                edge=self.values.edge(cell),
                clock=self.values.logic(cell.ports["CLK"]).text,
                reset=self.values.boolean(spec).text if spec else "",
                asynchronous=asynchronous,
            )
            groups[group].append(register)
        return groups

    def register_of(self, wire: str, cell: Cell) -> Register:
        # Amaranth's process of a register, of which only the middle remains as statements:
        #
        #   next = q               the default, which a clocked process has anyway
        #   switch ...
        #   switch rst             a synchronous reset, which becomes that of the group
        #     case 1: next = init
        process = self.graph.next_state.get(wire)
        if process is None:
            whole = (Slice(wire, 0, spec_width(cell.ports["D"])),)
            body: tuple[Statement, ...] = (Assign(target=whole, value=cell.ports["D"]),)
        else:
            body = flatten(process.body)
        if body and self._holds(body[0], wire):
            body = body[1:]
        reset: Spec = ()
        if cell.kind == "$dff" and body and (reset := self._reset_of(body[-1], wire)):
            body = body[:-1]
        if not body:
            # Assign the register to itself: a process that only resets it would be a latch.
            whole = (Slice(wire, 0, self.graph.width[wire]),)
            body = (Assign(target=whole, value=whole),)
        return Register(wire, cell, body, reset)

    def _holds(self, statement: Statement, wire: str) -> bool:
        """Return whether a statement is the default of a register: to hold its value."""
        if not isinstance(statement, Assign) or len(statement.value) != 1:
            return False
        (chunk,) = statement.value
        return (
            isinstance(chunk, Slice)
            and chunk.wire == wire
            and chunk.low == 0
            and chunk.width == self.graph.width[wire]
            and len(statement.target) == 1
            and statement.target[0].width == chunk.width
        )

    def _reset_of(self, statement: Statement, wire: str) -> Spec:
        """Return the signal of a statement that resets a register to its initial value."""
        if not isinstance(statement, Switch) or spec_width(statement.selector) != 1:
            return ()
        if len(statement.cases) != 1 or statement.cases[0].patterns != ("1",):
            return ()
        (chunk,) = statement.selector
        body = statement.cases[0].body
        if not isinstance(chunk, Slice) or chunk.wire in self.graph.folded or len(body) != 1:
            return ()
        inner = body[0]
        init = self.graph.module.wires[wire].attributes.get("init")
        if not isinstance(inner, Assign) or not isinstance(init, Bits):
            return ()
        return statement.selector if bits_of(inner.value) == init.text else ()

    def processes(self) -> Iterator[Iterator[str]]:
        """Yield one block for each process."""
        for group, registers in self._groups.items():
            yield self.process(group, registers)

    def merged(self, registers: list[Register]) -> tuple[Statement, ...]:
        """Join the statements of registers."""
        body: tuple[Statement, ...] = ()
        for register in registers:
            body = merged(body, register.body)
        return body

    def start_of(self, register: Register) -> str:
        """Return the bits that a register has after a reset."""
        if register.cell.kind == "$adff":
            reset = register.cell.parameters["ARST_VALUE"]
        else:
            reset = self.graph.module.wires[register.wire].attributes["init"]
        assert isinstance(reset, Bits)
        return reset.text

    def process(self, group: Group, registers: list[Register]) -> Iterator[str]:
        label = self.names.scope.give(f"p_{group.clock.partition('(')[0]}")
        sensitivity = group.clock
        if group.asynchronous:
            cell = registers[0].cell
            sensitivity += f", {self.values.logic(cell.ports['ARST']).text}"
        body = self.merged(registers)
        lines = list(self.statements.body(body))
        start = [self._start(register) for register in registers]
        yield f"{label} : process ({sensitivity})"
        yield "begin"
        if group.asynchronous:
            yield f"  if {group.reset} then"
            yield from (f"    {line}" for line in start)
            yield f"  elsif {group.edge} then"
            yield from (f"    {line}" for line in lines)
        else:
            yield f"  if {group.edge} then"
            if group.reset:
                yield f"    if {group.reset} then"
                yield from (f"      {line}" for line in start)
                yield "    else"
                yield from (f"      {line}" for line in lines)
                yield "    end if;"
            else:
                yield from (f"    {line}" for line in lines)
        yield "  end if;"
        yield "end process;"

    def _start(self, register: Register) -> str:
        declared = self.names.declared[register.wire]
        wire = self.graph.module.wires[register.wire]
        value = initial_value(wire, declared.width)
        if register.cell.kind == "$adff":
            reset = register.cell.parameters["ARST_VALUE"]
            assert isinstance(reset, Bits)
            value = self.statements.value((reset,)).text
        return f"{declared.name} <= {value};"
