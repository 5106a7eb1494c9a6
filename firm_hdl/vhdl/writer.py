"""Writes one module of a netlist: what all languages have in common.

A language has a subclass, with its own writers of values, statements, registers and memories.
"""

from __future__ import annotations

import textwrap
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar

from firm_hdl.names.attributes import PURPOSE
from firm_hdl.rtlil.ir import Bits, Cell, Module, Slice, Spec, Statement, Value, cut
from firm_hdl.vhdl.declare import Role, Signal, declare, enumeration, layouts, remark_of
from firm_hdl.vhdl.expr import Declared, Values
from firm_hdl.vhdl.graph import attributes_of, graph_of, only
from firm_hdl.vhdl.memory import MemoryText, memory_id
from firm_hdl.vhdl.process import Statements, flatten
from firm_hdl.vhdl.registers import Registers
from firm_hdl.vhdl.uses import INLINE, output

__all__ = ["TITLES", "Writer"]

TITLES: Mapping[Role, str] = {
    "register": "Registers.",
    "logic": "Combinational signals.",
    "alias": "Signals that no logic reads, for tools.",
}
"""Comments above the declarations of signals."""


class Writer(ABC):
    """Writes one module.

    * `entities`: identifiers of all modules.
    * `port_names`: identifiers of ports, by module and wire.
    * `vectors`: whether the ports of this module are `std_logic_vector`.
    """

    mark: ClassVar[str]
    """The comment mark of the language."""
    value_writer: ClassVar[Any] = Values
    statement_writer: ClassVar[Any] = Statements
    register_writer: ClassVar[Any] = Registers
    memory_writer: ClassVar[Any] = MemoryText

    def __init__(
        self,
        module: Module,
        *,
        entities: Mapping[str, str],
        port_names: Mapping[str, dict[str, str]],
        modules: Mapping[str, Module],
        vectors: bool = False,
    ) -> None:
        self.module, self.modules = module, modules
        self.entities, self.port_names = entities, port_names
        self.entity = entities[module.name]
        self.graph = graph = graph_of(module, modules, self.is_foldable)
        self.names = declare(
            graph,
            entity=self.entity,
            port_names=port_names[module.name],
            child_names=port_names,
            vectors=vectors,
        )
        self._layouts = layouts(module)
        # By layout: the first wire beside which a comment has it.
        self._shown: dict[str, str] = {}
        declared = self.names.declared
        self.values = self.value_writer(declared, graph.folded, graph.width)
        self.values.choice = self._choice
        # By type, bits and name of a value of an enumeration that the text uses: its identifier.
        self._constants: dict[tuple[str, str, str], str] = {}
        # By the wire of a next value: its register.
        self._registers = {graph.target(each): wire for wire, each in graph.next_state.items()}
        self.targets = dict(declared)
        for target, register in self._registers.items():
            self.targets[target] = self.targets[register]
        self.statements = self.statement_writer(self.values, self.targets)
        self.registers = self.register_writer(graph, self.values, self.statements, self.names)
        self.memories = [
            self.memory_writer(
                memory,
                self.names.memories[name],
                [c for c in graph.cells if c.kind.startswith("$mem") and memory_id(c) == name],
                self.values,
                declared,
            )
            for name, memory in module.memories.items()
            if memory.width and memory.size
        ]

    @staticmethod
    def is_foldable(cell: Cell, width: int) -> bool:
        """Return whether an operator can be in an expression; see :func:`graph_of`."""
        return True

    @abstractmethod
    def text(self) -> str:
        """Write the module; a line is longer than 100 columns only if unbreakable."""

    @abstractmethod
    def instance(self, cell: Cell) -> Iterator[str]:
        """Yield an instance of a module, or of a foreign component."""

    @abstractmethod
    def operator(self, target: Declared, cell: Cell) -> Iterator[str]:
        """Yield the assignment of an operator's result to a signal."""

    @abstractmethod
    def assign(self, target: Declared, chunk: Slice, value: Spec, enable: Spec) -> Iterator[str]:
        """Yield an assignment to bits of a signal; with `enable`, else they are not driven."""

    @abstractmethod
    def process(self, wire: str, statements: tuple[Statement, ...]) -> Iterator[str]:
        """Yield combinational logic that drives a wire."""

    @abstractmethod
    def outputs(self) -> Iterator[str]:
        """Yield assignments of ports that have an inner signal."""

    @abstractmethod
    def message(self, cell: Cell) -> Iterator[str]:
        """Yield what a `Print`, `Assert` or `Assume` does in a simulation."""

    def blocks(self) -> Iterator[Iterator[str]]:
        """Yield the blocks of lines of the module's body."""
        graph = self.graph
        for cell in graph.cells:
            if graph.is_instance(cell):
                yield self.instance(cell)
        yield self._operators()
        for process in graph.processes:
            yield self.process(graph.target(process), flatten(process.body))
        for memory in self.memories:
            yield memory.processes()
        yield self._empty_memory_reads()
        yield from self.registers.processes()
        yield self._connections(graph.drives)
        yield self.outputs()
        yield self._connections(graph.aliases)
        for cell in graph.cells:
            if cell.kind in ("$check", "$print"):
                yield self.message(cell)

    def _operators(self) -> Iterator[str]:
        """Yield assignments of operators whose result is a signal."""
        graph = self.graph
        for cell in graph.cells:
            if cell.kind in INLINE and output(cell) not in graph.folded:
                yield from self.operator(self.names.declared[output(cell)], cell)
            elif cell.kind == "$tribuf":
                yield from self._assigned(cell.ports["Y"], cell.ports["A"], cell.ports["EN"])

    def _connections(self, pairs: Sequence[tuple[Spec, Spec]]) -> Iterator[str]:
        for target, value in pairs:
            yield from self._assigned(target, value)

    def _assigned(self, target: Spec, value: Spec, enable: Spec = ()) -> Iterator[str]:
        position = 0
        for chunk in target:
            assert isinstance(chunk, Slice)
            declared = self.names.declared[chunk.wire]
            part = cut(value, position, chunk.width)
            position += chunk.width
            cell = self.values.folded(part)
            if cell is not None and chunk.width == declared.width and not enable:
                yield from self.operator(declared, cell)
            else:
                yield from self.assign(declared, chunk, part, enable)

    def _empty_memory_reads(self) -> Iterator[str]:
        """Yield the value 0 for read ports of memories without words."""
        for cell in self.graph.cells:
            if cell.kind == "$memrd_v2" and not self.module.memories[memory_id(cell)].size:
                target = cell.ports["DATA"]
                yield from self._assigned(target, (Bits("0" * target[0].width),))

    def _choice(self, spec: Spec, bits: str) -> str:
        """Return the identifier of a constant for a value of a signal with an enumeration."""
        chunk = only(spec)
        if chunk is None or chunk.width != len(bits) or len(bits) == 1:
            return ""
        wire = self.owner(self._registers.get(chunk.wire, chunk.wire))
        name = enumeration(wire, bits) if chunk.low == 0 else ""
        if not name:
            return ""
        kind = str(wire.attributes.get("enum_base_type", ""))
        key = kind, bits, name
        if key not in self._constants:
            self._constants[key] = self.names.scope.give(f"{kind}_{name}".upper())
        return self._constants[key]

    def constants(self) -> Iterator[tuple[str, str]]:
        """Yield identifiers and bits of the values of enumerations that the body uses."""
        for (_, bits, _), name in sorted(self._constants.items()):
            yield name, bits

    def owner(self, wire: str) -> Any:
        """Return the wire whose name another one has taken over, or that wire itself."""
        return self.module.wires[self.graph.name_of.get(wire, wire)]

    def purpose(self) -> Iterator[str]:
        """Yield comments on what the module is for."""
        first, *lines = str(self.module.attributes.get(PURPOSE, "")).split("\n")
        for line in [*textwrap.wrap(first, 96), *lines]:
            if line.isascii() and line.isprintable():
                yield f"{self.mark} {line}".rstrip()

    def remark(self, wire: str, *, layout: bool = False) -> str:
        """Write a comment on what the type of a wire does not say, perhaps with its layout."""
        own, owner = self.names.remarks.get(wire, ""), self.graph.name_of.get(wire, wire)
        fields = (self._layouts.get(owner) or self._layouts.get(wire)) if layout else None
        if fields:
            again = f"bits as of {self.names.declared[self._shown.setdefault(fields, wire)].name}"
            if self._shown[fields] != wire and len(again) < len(fields):
                fields = again
        text = "; ".join(filter(None, [remark_of(self.module.wires[owner]) or own, fields]))
        return f"  {self.mark} {text}" if text else ""

    def attributes(self, signal: Signal) -> dict[str, Value]:
        """Return the attributes of a signal that are for tools, such as ``keep``."""
        wire = self.module.wires[signal.wire]
        return {**attributes_of(wire), **attributes_of(self.owner(signal.wire))}
