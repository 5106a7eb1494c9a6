"""One module as an entity and its architecture."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from firm_hdl.rtlil.ir import Bits, Cell, Slice, Spec, Statement, Value
from firm_hdl.vhdl.declare import Role, initial_value
from firm_hdl.vhdl.expr import Declared
from firm_hdl.vhdl.instance import component, exact, foreign_instance, instance
from firm_hdl.vhdl.messages import message
from firm_hdl.vhdl.package import PACKAGE_NAME
from firm_hdl.vhdl.text import literal, wrap
from firm_hdl.vhdl.uses import trim
from firm_hdl.vhdl.writer import TITLES, Writer

__all__ = ["EntityNames", "ModuleWriter"]


@dataclass(frozen=True, slots=True, kw_only=True)
class EntityNames:
    """The identifiers of one module, by the names in the netlist."""

    entity: str
    ports: Mapping[str, str]
    signals: Mapping[str, str]
    memories: Mapping[str, str]
    instances: Mapping[str, str]


class ModuleWriter(Writer):
    """Writes one module as an entity and its architecture."""

    mark = "--"

    def entity_names(self) -> EntityNames:
        """Return all identifiers of the module."""
        names, graph = self.names, self.graph
        signals = {wire: item.name for wire, item in names.declared.items()}
        signals.update(
            (owner, names.declared[wire].name)
            for wire, owner in graph.name_of.items()
            if wire in names.declared
        )
        return EntityNames(
            entity=self.entity,
            ports={port.wire: port.outer.name for port in names.ports},
            signals=signals,
            memories=names.memories,
            instances=names.labels,
        )

    def text(self) -> str:
        """Write entity and architecture; a line is longer than 100 columns only if unbreakable."""
        lines = [*self._entity_lines(), "", *self._architecture()]
        return "\n".join(part for line in lines for part in wrap(line)) + "\n"

    def _entity_lines(self) -> Iterator[str]:
        yield f"-- Module {self.module.name} of the Amaranth design."
        yield from self.purpose()
        yield from (f"-- {line}" for line in self.registers.summary())
        yield ""
        yield "library ieee;"
        yield "use ieee.std_logic_1164.all;"
        yield "use ieee.numeric_std.all;"
        yield ""
        yield f"use work.{PACKAGE_NAME}.all;"
        yield ""
        yield f"entity {self.entity} is"
        ports = self.names.ports
        if ports:
            yield "  port ("
            size = max(len(port.outer.name) for port in ports)
            for index, port in enumerate(ports):
                mode = {"input": "in", "output": "out"}.get(port.direction, port.direction)
                end = "" if index == len(ports) - 1 else ";"
                remark = self.remark(port.wire, layout=True)
                yield f"    {port.outer.name:<{size}} : {mode:<3} {port.outer.type}{end}{remark}"
            yield "  );"
        yield "end entity;"

    def _architecture(self) -> Iterator[str]:
        # The body shows which constants are used.
        blocks = [list(block) for block in self.blocks()]
        yield f"architecture rtl of {self.entity} is"
        yield from (f"  {line}" if line else "" for line in self._declarations())
        yield "begin"
        for lines in filter(None, blocks):
            yield ""
            yield from (f"  {line}" if line else "" for line in lines)
        yield ""
        yield "end architecture;"

    def _declarations(self) -> Iterator[str]:
        graph = self.graph
        constants = [
            f"constant {name} : unsigned({len(bits) - 1} downto 0) := {literal(bits)};"
            for name, bits in self.constants()
        ]
        yield from _titled("Values of enumerations.", constants)
        for role, title in TITLES.items():
            yield from _titled(title, self._signals(role))
        for memory in self.memories:
            yield ""
            yield from memory.declarations()
        done: dict[str, list[str]] = {}
        for cell in graph.cells:
            if graph.is_instance(cell) and not graph.is_submodule(cell):
                lines = list(component(cell, graph))
                if done.setdefault(cell.kind, lines) != lines:
                    raise ValueError(
                        f"instances of {cell.kind!r} in {self.module.name!r} differ in their "
                        "ports or parameters; one VHDL component cannot declare both"
                    )
        for lines in done.values():
            yield ""
            yield from lines
        yield from self._attributes()

    def _signals(self, role: Role) -> list[str]:
        signals = [each for each in self.names.signals if each.role == role]
        size = max((len(each.declared.name) for each in signals), default=0)
        lines = []
        for each in signals:
            item, start = each.declared, ""
            if role == "register":
                start = f" := {initial_value(self.module.wires[each.wire], item.width)}"
            remark = self.remark(each.wire, layout=role == "register")
            lines.append(f"signal {item.name:<{size}} : {item.type}{start};{remark}")
        return lines

    def _attributes(self) -> Iterator[str]:
        """Yield the attributes of signals, such as ``keep``, for tools."""
        types: dict[str, str] = {}
        uses: list[str] = []
        for signal in self.names.signals:
            for name, value in self.attributes(signal).items():
                kind, text = _attribute(value)
                if types.setdefault(name, kind) != kind:
                    raise ValueError(f"attribute {name!r} has values of different types")
                what = exact(name)
                uses.append(f"attribute {what} of {signal.declared.name} : signal is {text};")
        if uses:
            yield ""
            yield from (f"attribute {exact(name)} : {kind};" for name, kind in types.items())
            yield from uses

    def operator(self, target: Declared, cell: Cell) -> Iterator[str]:
        cells, values = self.values.cells, self.values
        width = target.width
        if cell.kind == "$mux":
            a, b = (
                target.accept(self.statements.value(trim(cell.ports[port], width)), width)
                for port in "AB"
            )
            condition = values.boolean(cell.ports["S"]).text
            yield f"{target.name} <= {b} when {condition} else {a};"
        elif width == 1 and cells.is_condition(cell):
            yield f"{target.name} <= '1' when {cells.boolean(cell).text} else '0';"
        else:
            text = cells.logic(cell) if width == 1 else cells.unsigned(cell)
            yield f"{target.name} <= {target.accept(text, width)};"

    def assign(self, target: Declared, chunk: Slice, value: Spec, enable: Spec) -> Iterator[str]:
        name, width = target.part(chunk.low, chunk.width), chunk.width
        whole = width == target.width and not enable
        text = target.accept(self.statements.value(value, whole=whole), width)
        if enable:
            off = "'Z'" if width == 1 else f'"{"Z" * width}"'
            text = f"{text} when {self.values.boolean(enable).text} else {off}"
        yield f"{name} <= {text};"

    def process(self, wire: str, statements: tuple[Statement, ...]) -> Iterator[str]:
        target = self.names.declared[wire]
        pairs = self.statements.conditional(statements)
        if pairs is None:
            yield f"{self.names.scope.give(f'p_{target.name}')} : process (all)"
            yield "begin"
            yield from (f"  {line}" for line in self.statements.body(statements))
            yield "end process;"
            return
        head = f"{target.name} <="
        for index, (value, condition) in enumerate(pairs):
            end = ";" if index == len(pairs) - 1 else " else"
            when = f" when {condition}" if condition else ""
            yield f"{head} {value}{when}{end}"
            head = " " * len(head)

    def message(self, cell: Cell) -> Iterator[str]:
        return message(cell, self.values, self.module.name)

    def instance(self, cell: Cell) -> Iterator[str]:
        submodule = self.modules.get(cell.kind)
        label = self.names.labels[cell.name]
        if submodule is None:
            return foreign_instance(cell, self.graph, self.values, label)
        return instance(
            cell,
            submodule,
            self.values,
            label=label,
            entity=self.entities[cell.kind],
            ports=self.port_names[cell.kind],
        )

    def outputs(self) -> Iterator[str]:
        for port in self.names.ports:
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
