"""Combinational logic: operators, connections and processes without a clock."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from firm_hdl.rtlil.ir import Cell, Slice, Spec, Statement, cut
from firm_hdl.vhdl.declare import Names
from firm_hdl.vhdl.expr import Declared, Values
from firm_hdl.vhdl.graph import Graph
from firm_hdl.vhdl.process import Statements, flatten
from firm_hdl.vhdl.uses import INLINE, output, trim

__all__ = ["Body"]


class Body:
    """Writes the combinational part of an architecture."""

    def __init__(self, graph: Graph, values: Values, statements: Statements, names: Names) -> None:
        self._graph = graph
        self._values = values
        self._statements = statements
        self._names = names

    def operators(self) -> Iterator[str]:
        """Yield assignments of operators whose result is a signal."""
        graph = self._graph
        for cell in graph.cells:
            if cell.kind in INLINE and output(cell) not in graph.folded:
                yield from self._operator(self._names.declared[output(cell)], cell)
            elif cell.kind == "$tribuf":
                yield from self._tristate(cell)

    def connections(self, pairs: Sequence[tuple[Spec, Spec]]) -> Iterator[str]:
        """Yield assignments of connections, each a target and a value."""
        for target, value in pairs:
            for chunk, declared, part in self._parts(target, value):
                cell = self._values.folded(part)
                if cell is not None and chunk.width == declared.width:
                    yield from self._operator(declared, cell)
                    continue
                text = self._statements.value(part, whole=chunk.width == declared.width)
                name = declared.part(chunk.low, chunk.width)
                yield f"{name} <= {declared.accept(text, chunk.width)};"

    def _parts(self, target: Spec, value: Spec) -> Iterator[tuple[Slice, Declared, Spec]]:
        position = 0
        for chunk in target:
            assert isinstance(chunk, Slice)
            declared = self._names.declared[chunk.wire]
            yield chunk, declared, cut(value, position, chunk.width)
            position += chunk.width

    def _operator(self, target: Declared, cell: Cell) -> Iterator[str]:
        cells, values = self._values.cells, self._values
        width = target.width
        if cell.kind == "$mux":
            a, b = (
                target.accept(self._statements.value(trim(cell.ports[port], width)), width)
                for port in "AB"
            )
            condition = values.boolean(cell.ports["S"]).text
            yield f"{target.name} <= {b} when {condition} else {a};"
        elif width == 1 and cells.is_condition(cell):
            yield f"{target.name} <= '1' when {cells.boolean(cell).text} else '0';"
        else:
            text = cells.logic(cell) if width == 1 else cells.unsigned(cell)
            yield f"{target.name} <= {target.accept(text, width)};"

    def _tristate(self, cell: Cell) -> Iterator[str]:
        enable = self._values.boolean(cell.ports["EN"]).text
        for chunk, target, part in self._parts(cell.ports["Y"], cell.ports["A"]):
            value = self._statements.value(part, whole=False)
            off = "'Z'" if chunk.width == 1 else f'"{"Z" * chunk.width}"'
            name = target.part(chunk.low, chunk.width)
            yield f"{name} <= {target.accept(value, chunk.width)} when {enable} else {off};"

    def processes(self) -> Iterator[Iterator[str]]:
        """Yield a block of lines for each process."""
        for process in self._graph.processes:
            yield self._process(self._graph.target(process), process.body)

    def _process(self, wire: str, body: tuple[Statement, ...]) -> Iterator[str]:
        target = self._names.declared[wire]
        statements = flatten(body)
        pairs = self._statements.conditional(statements)
        if pairs is None:
            yield f"{self._names.scope.give(f'p_{target.name}')} : process (all)"
            yield "begin"
            yield from (f"  {line}" for line in self._statements.body(statements))
            yield "end process;"
            return
        head = f"{target.name} <="
        for index, (value, condition) in enumerate(pairs):
            end = ";" if index == len(pairs) - 1 else " else"
            when = f" when {condition}" if condition else ""
            yield f"{head} {value}{when}{end}"
            head = " " * len(head)
