"""One module as an entity and its architecture."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from firm_hdl.rtlil.ir import Bits, Cell, Module, Slice, Spec, Value
from firm_hdl.vhdl.body import Body
from firm_hdl.vhdl.declare import (
    Role,
    attributes_of,
    declare,
    enumeration,
    initial_value,
    remark_of,
)
from firm_hdl.vhdl.expr import Values
from firm_hdl.vhdl.instance import component, exact, foreign_instance, instance
from firm_hdl.vhdl.memory import MemoryText, memory_id
from firm_hdl.vhdl.messages import message
from firm_hdl.vhdl.package import PACKAGE_NAME
from firm_hdl.vhdl.passes import graph_of
from firm_hdl.vhdl.process import Statements
from firm_hdl.vhdl.registers import Registers
from firm_hdl.vhdl.text import wrap
from firm_hdl.vhdl.uses import output

__all__ = ["EntityNames", "ModuleWriter"]

_TITLES: Mapping[Role, str] = {
    "register": "Registers.",
    "logic": "Combinational signals.",
    "alias": "Signals that no logic reads, for simulation.",
}
"""Comments above the declarations of signals."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EntityNames:
    """The identifiers of one module, by the names in the netlist."""

    entity: str
    ports: Mapping[str, str]
    signals: Mapping[str, str]
    memories: Mapping[str, str]
    instances: Mapping[str, str]


class ModuleWriter:
    """Writes one module.

    Parameters
    ----------
    module : Module
    entities : mapping of str to str
        Identifiers of all entities by module.
    port_names : mapping
        Identifiers of ports, by module and wire.
    modules : mapping of str to Module
    vectors : bool
        Whether the ports of this entity are `std_logic_vector`.
    """

    def __init__(
        self,
        module: Module,
        *,
        entities: Mapping[str, str],
        port_names: Mapping[str, dict[str, str]],
        modules: Mapping[str, Module],
        vectors: bool,
    ) -> None:
        self._module = module
        self._entities = entities
        self._port_names = port_names
        self._modules = modules
        self._entity = entities[module.name]
        self._graph = graph_of(module, modules)
        self._names = declare(
            self._graph,
            entity=self._entity,
            port_names=port_names[module.name],
            child_names=port_names,
            vectors=vectors,
        )
        graph = self._graph
        self._values = Values(self._names.declared, graph.folded, graph.width)
        targets = dict(self._names.declared)
        for register, process in graph.next_state.items():
            targets[graph.target(process)] = targets[register]
        self._statements = Statements(self._values, targets, self._choice)
        self._body = Body(graph, self._values, self._statements, self._names)
        self._registers = Registers(graph, self._values, self._statements, self._names)

    def names(self) -> EntityNames:
        """Return all identifiers of the module."""
        names, graph = self._names, self._graph
        signals = {wire: item.name for wire, item in names.declared.items()}
        signals.update(
            (owner, names.declared[wire].name)
            for wire, owner in graph.name_of.items()
            if wire in names.declared
        )
        return EntityNames(
            entity=self._entity,
            ports={port.wire: port.outer.name for port in names.ports},
            signals=signals,
            memories=names.memories,
            instances=names.labels,
        )

    def text(self) -> str:
        """Write entity and architecture; a line is longer than 100 columns only if unbreakable."""
        lines = [*self._entity_lines(), "", *self._architecture()]
        return "\n".join(part for line in lines for part in wrap(line)) + "\n"

    def _choice(self, spec: Spec, bits: str) -> str:
        (chunk,) = spec
        if not isinstance(chunk, Slice):
            return ""
        owner = self._graph.name_of.get(chunk.wire, chunk.wire)
        return enumeration(self._module.wires[owner], bits)

    def _entity_lines(self) -> Iterator[str]:
        yield f"-- Module {self._module.name} of the Amaranth design."
        yield from (f"-- {line}" for line in self._registers.summary())
        yield ""
        yield "library ieee;"
        yield "use ieee.std_logic_1164.all;"
        yield "use ieee.numeric_std.all;"
        yield ""
        yield f"use work.{PACKAGE_NAME}.all;"
        yield ""
        yield f"entity {self._entity} is"
        ports = self._names.ports
        if ports:
            yield "  port ("
            size = max(len(port.outer.name) for port in ports)
            for index, port in enumerate(ports):
                mode = {"input": "in", "output": "out"}.get(port.direction, port.direction)
                end = "" if index == len(ports) - 1 else ";"
                remark = self._remark(port.wire)
                yield f"    {port.outer.name:<{size}} : {mode:<3} {port.outer.type}{end}{remark}"
            yield "  );"
        yield "end entity;"

    def _remark(self, name: str) -> str:
        """Write a comment on the sign and the enumeration of a wire; its VHDL type has neither."""
        text = remark_of(self._module.wires[name])
        return f"  -- {text}" if text else ""

    def _architecture(self) -> Iterator[str]:
        yield f"architecture rtl of {self._entity} is"
        yield from (f"  {line}" if line else "" for line in self._declarations())
        yield "begin"
        for block in self._blocks():
            lines = list(block)
            if lines:
                yield ""
                yield from (f"  {line}" if line else "" for line in lines)
        yield ""
        yield "end architecture;"

    def _declarations(self) -> Iterator[str]:
        graph = self._graph
        for role, title in _TITLES.items():
            yield from _titled(title, self._signals(role))
        for memory in self._memories():
            yield ""
            yield from memory.declarations()
        done: dict[str, list[str]] = {}
        for cell in graph.cells:
            if graph.is_instance(cell) and not graph.is_submodule(cell):
                lines = list(component(cell, graph))
                if done.setdefault(cell.kind, lines) != lines:
                    raise ValueError(
                        f"instances of {cell.kind!r} in {self._module.name!r} differ in their "
                        "ports or parameters; one VHDL component cannot declare both"
                    )
        for lines in done.values():
            yield ""
            yield from lines
        yield from self._attributes()

    def _signals(self, role: Role) -> list[str]:
        signals = [each for each in self._names.signals if each.role == role]
        size = max((len(each.declared.name) for each in signals), default=0)
        lines = []
        for each in signals:
            item, start = each.declared, ""
            if role == "register":
                start = f" := {initial_value(self._module.wires[each.wire], item.width)}"
            remark = self._remark(self._graph.name_of.get(each.wire, each.wire))
            lines.append(f"signal {item.name:<{size}} : {item.type}{start};{remark}")
        return lines

    def _attributes(self) -> Iterator[str]:
        """Yield the attributes of signals, such as ``keep``, for tools."""
        types: dict[str, str] = {}
        uses: list[str] = []
        for signal in self._names.signals:
            owner = self._graph.name_of.get(signal.wire, signal.wire)
            attributes = {
                **attributes_of(self._module.wires[signal.wire]),
                **attributes_of(self._module.wires[owner]),
            }
            for name, value in attributes.items():
                kind, text = _attribute(value)
                if types.setdefault(name, kind) != kind:
                    raise ValueError(f"attribute {name!r} has values of different types")
                what = exact(name)
                uses.append(f"attribute {what} of {signal.declared.name} : signal is {text};")
        if uses:
            yield ""
            yield from (f"attribute {exact(name)} : {kind};" for name, kind in types.items())
            yield from uses

    def _memories(self) -> list[MemoryText]:
        result = []
        for name, memory in self._module.memories.items():
            if not memory.width or not memory.size:
                continue
            cells = [
                cell
                for cell in self._graph.cells
                if cell.kind.startswith("$mem") and memory_id(cell) == name
            ]
            result.append(
                MemoryText(
                    memory, self._names.memories[name], cells, self._values, self._names.declared
                )
            )
        return result

    def _blocks(self) -> Iterator[Iterator[str]]:
        graph = self._graph
        for cell in graph.cells:
            if graph.is_instance(cell):
                yield self._instance(cell)
        yield self._body.operators()
        yield from self._body.processes()
        for memory in self._memories():
            yield memory.processes()
        yield self._empty_memory_reads()
        yield from self._registers.processes()
        yield self._body.connections(graph.drives)
        yield self._outputs()
        yield self._body.connections(graph.aliases)
        for cell in graph.cells:
            if cell.kind in ("$check", "$print"):
                yield message(cell, self._values, self._module.name)

    def _empty_memory_reads(self) -> Iterator[str]:
        """Yield the value 0 for read ports of memories without words."""
        for cell in self._graph.cells:
            if cell.kind == "$memrd_v2" and not self._module.memories[memory_id(cell)].size:
                target = self._names.declared[output(cell)]
                yield f"{target.name} <= {target.zero};"

    def _instance(self, cell: Cell) -> Iterator[str]:
        submodule = self._modules.get(cell.kind)
        label = self._names.labels[cell.name]
        if submodule is None:
            return foreign_instance(cell, self._graph, self._values, label)
        return instance(
            cell,
            submodule,
            self._values,
            label=label,
            entity=self._entities[cell.kind],
            ports=self._port_names[cell.kind],
        )

    def _outputs(self) -> Iterator[str]:
        for port in self._names.ports:
            if port.inner is not None:
                converted = port.inner.name
                if port.outer.width > 1 and port.outer.vector != port.inner.vector:
                    kind = "std_logic_vector" if port.outer.vector else "unsigned"
                    converted = f"{kind}({converted})"
                yield f"{port.outer.name} <= {converted};"


def _titled(title: str, lines: list[str]) -> Iterator[str]:
    if lines:
        yield ""
        yield f"-- {title}"
        yield from lines


def _attribute(value: Value) -> tuple[str, str]:
    if isinstance(value, Bits):
        return "string", f'"{value.text}"'
    if isinstance(value, int):
        return "integer", str(value)
    if isinstance(value, float):
        return "real", repr(value)
    quoted = value.replace('"', '""')
    return "string", f'"{quoted}"'
