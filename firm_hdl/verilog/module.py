"""One module as Verilog-2005 that means the same in SystemVerilog.

Combinational logic is in continuous assignments, which every simulator evaluates at time zero. An
``always @*`` would wait for a change of a signal that it reads. The initial value of a register is
such a change in Verilog, but not in SystemVerilog (IEEE Std 1800-2017, clause 6.8: initializers
are executed before any process starts). So a choice that is no conditional expression becomes a
function, whose parameters are the signals that it reads.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from firm_hdl.names.keywords import VERILOG
from firm_hdl.rtlil.ir import (
    Assign,
    Bits,
    Case,
    Cell,
    Module,
    Slice,
    Spec,
    Statement,
    Switch,
    Value,
    cut,
    spec_width,
)
from firm_hdl.verilog.expr import Expression, Values, infix, is_foldable, literal, part
from firm_hdl.vhdl.declare import Role, attributes_of, declare, enumeration, remark_of
from firm_hdl.vhdl.expr import Declared
from firm_hdl.vhdl.memory import MemoryText, memory_id
from firm_hdl.vhdl.messages import FIELD
from firm_hdl.vhdl.passes import graph_of
from firm_hdl.vhdl.process import Arm, Statements, flatten
from firm_hdl.vhdl.registers import Group, Register, Registers
from firm_hdl.vhdl.text import wrap
from firm_hdl.vhdl.uses import INLINE, enable_runs, int_parameter, output

__all__ = ["ModuleWriter"]

_TITLES: Mapping[Role, str] = {
    "register": "Registers.",
    "logic": "Combinational signals.",
    "alias": "Signals that no logic reads, for simulation.",
}


class _Statements(Statements):
    """Writes statements; in a function, they are not clocked."""

    true = "1'b1"
    operator = "<="

    def all_of(self, *tests: Expression) -> Expression:
        return infix("&&", *tests)

    def any_of(self, *tests: Expression) -> Expression:
        return infix("||", *tests)

    def equal(self, spec: Spec, bits: str) -> Expression:
        if len(bits) > 1:
            return infix("==", self.values.value(spec), Expression(literal(bits)))
        return self.values.boolean(spec, inverted=bits == "0")

    def assign(self, statement: Assign) -> Iterator[str]:
        position = 0
        for chunk in statement.target:
            assert isinstance(chunk, Slice)
            spec = cut(statement.value, position, chunk.width)
            position += chunk.width
            cell = self.values.folded(spec)
            if cell is not None and cell.kind == "$mux":
                yield from self.choose(chunk, cell)
                continue
            name = part(self.targets[chunk.wire], chunk.low, chunk.width)
            yield f"{name} {self.operator} {self.values.value(spec).text};"

    def choose(self, chunk: Slice, cell: Cell) -> Iterator[str]:
        b, a = (
            Assign(target=(chunk,), value=cut(cell.ports[port], 0, chunk.width)) for port in "BA"
        )
        yield from self.if_([Arm(self.values.boolean(cell.ports["S"]), (b,)), Arm(None, (a,))])

    def case(self, switch: Switch, plain: list[tuple[list[str], Case]]) -> Iterator[str]:
        (chunk,) = switch.selector
        yield f"case ({self.values.value(switch.selector).text})"
        for patterns, case in plain:
            names = [name for p in sorted(patterns) if (name := self.comment((chunk,), p))]
            remark = f"  // {' or '.join(names)}" if names else ""
            choices = ", ".join(map(literal, sorted(patterns))) or "default"
            lines = list(self.body(case.body))
            if len(lines) < 2:
                yield f"  {choices}: {lines[0] if lines else ';'}{remark}"
                continue
            yield f"  {choices}: begin{remark}"
            yield from (f"    {line}" for line in lines)
            yield "  end"
        yield "endcase"

    def if_(self, chain_: list[Arm]) -> Iterator[str]:
        if chain_ and chain_[0].condition is None:
            yield from self.body(chain_[0].body)
            return
        keyword = "if"
        for arm in chain_:
            yield f"{keyword} ({arm.condition.text}) begin" if arm.condition else "end else begin"
            yield from (f"  {line}" for line in self.body(arm.body))
            keyword = "end else if"
        if chain_:
            yield "end"

    def accepted(self, statement: Assign) -> str:
        return self.values.value(statement.value).inside()


class _Registers(Registers):
    def process(self, group: Group, registers: list[Register]) -> Iterator[str]:
        lines = list(self.statements.body(self.merged(registers)))
        edges = f"{group.edge} or posedge {group.reset}" if group.asynchronous else group.edge
        yield f"always @({edges}) begin"
        if not group.reset:
            yield from (f"  {line}" for line in lines)
        else:
            yield f"  if ({group.reset}) begin"
            for register in registers:
                name = self.names.declared[register.wire].name
                yield f"    {name} <= {literal(self.start_of(register))};"
            yield "  end else begin"
            yield from (f"    {line}" for line in lines)
            yield "  end"
        yield "end"


class _Memory(MemoryText):
    """Writes one memory; see :class:`MemoryText`. A write beyond the last word has no effect."""

    def declarations(self) -> Iterator[str]:
        yield f"reg [{self.memory.width - 1}:0] {self.name} [0:{self.memory.size - 1}];"

    def initial(self, counter: str) -> Iterator[str]:
        """Yield the initial values; `counter` is a free name."""
        name, size = self.name, self.memory.size
        words = {i: word for i, word in enumerate(self.words()) if "1" in word}
        yield f"integer {counter};"
        yield "initial begin"
        if len(words) < size:
            zero = literal("0" * self.memory.width)
            yield f"  for ({counter} = 0; {counter} < {size}; {counter} = {counter} + 1)"
            yield f"    {name}[{counter}] = {zero};"
        for index, word in words.items():
            yield f"  {name}[{index}] = {literal(word)};"
        yield "end"

    def processes(self) -> Iterator[str]:
        edges: dict[str, list[Cell]] = {}
        for cell in self.writes:
            edges.setdefault(self.values.edge(cell), []).append(cell)
        for edge, cells in edges.items():
            yield f"always @({edge}) begin"
            yield from (f"  {line}" for cell in cells for line in self._write(cell))
            yield "end"
        for cell in self.reads:
            target = self.target(cell)
            word = self._word(cell.ports["ADDR"])
            if not int_parameter(cell, "CLK_ENABLE"):
                yield f"assign {target.name} = {word};"
                continue
            yield f"always @({self.values.edge(cell)}) begin"
            lines = [f"{target.name} <= {word};", *self._bypasses(cell, target)]
            yield from (f"  {line}" for line in _guarded([cell.ports["EN"]], self.values, lines))
            yield "end"

    def _word(self, address: Spec) -> str:
        size, number = self.memory.size, self.values.constant(address)
        if number is not None:
            zero = literal("0" * self.memory.width)
            return f"{self.name}[{number}]" if number < size else zero
        text = self.values.value(address).text
        if size >= 1 << spec_width(address):
            return f"{self.name}[{text}]"
        last = literal(f"{size - 1:0{spec_width(address)}b}")
        return f"({text} <= {last}) ? {self.name}[{text}] : {literal('0' * self.memory.width)}"

    def _write(self, cell: Cell) -> Iterator[str]:
        address = self.values.constant(cell.ports["ADDR"])
        if address is not None and address >= self.memory.size:
            return
        at = self.values.value(cell.ports["ADDR"]).text if address is None else address
        word = Declared(name=f"{self.name}[{at}]", width=self.memory.width)
        yield from self._parts(cell, word, [])

    def _bypasses(self, cell: Cell, target: Declared) -> Iterator[str]:
        mask, read_at = int_parameter(cell, "TRANSPARENCY_MASK"), cell.ports["ADDR"]
        for write in self.writes:
            write_at = write.ports["ADDR"]
            if mask >> int_parameter(write, "PORTID") & 1:
                sides = [self.values.value(spec) for spec in (read_at, write_at)]
                numbers = [self.values.constant(spec) for spec in (read_at, write_at)]
                if None in numbers or numbers[0] == numbers[1]:
                    tests = [infix("==", *sides)] if None in numbers else []
                    yield from self._parts(write, target, tests)

    def _parts(self, write: Cell, target: Declared, tests: list[Expression]) -> Iterator[str]:
        for bit, low, width in enable_runs(write.ports["EN"]):
            value = self.values.value(cut(write.ports["DATA"], low, width)).text
            line = f"{part(target, low, width)} <= {value};"
            yield from _guarded([(bit,)], self.values, [line], tests)


def _guarded(
    enables: Sequence[Spec], values: Values, lines: list[str], tests: Sequence[Expression] = ()
) -> Iterator[str]:
    """Yield lines with a condition, unless that is constant."""
    tests = [*tests, *(values.boolean(spec) for spec in enables if values.constant(spec) is None)]
    if any(values.constant(spec) == 0 for spec in enables):
        return
    if not tests:
        yield from lines
    else:
        yield f"if ({infix('&&', *tests).text}) begin"
        yield from (f"  {line}" for line in lines)
        yield "end"


class ModuleWriter:
    """Writes one module.

    Parameters
    ----------
    module : Module
    entities : mapping of str to str
        Identifiers of all modules.
    port_names : mapping
        Identifiers of ports, by module and wire.
    modules : mapping of str to Module
    """

    def __init__(
        self,
        module: Module,
        *,
        entities: Mapping[str, str],
        port_names: Mapping[str, dict[str, str]],
        modules: Mapping[str, Module],
    ) -> None:
        self._module, self._modules = module, modules
        self._entities, self._port_names = entities, port_names
        self._graph = graph = graph_of(module, modules, is_foldable)
        self._names = names = declare(
            graph,
            entity=entities[module.name],
            port_names=port_names[module.name],
            child_names=port_names,
            vectors=False,
        )
        self._values = Values(names.declared, graph.folded, graph.width)
        self._targets = dict(names.declared)
        for register, process in graph.next_state.items():
            self._targets[graph.target(process)] = self._targets[register]
        clocked = _Statements(self._values, self._targets, self._choice)
        self._registers = _Registers(graph, self._values, clocked, names)
        self._memories = [
            _Memory(
                memory,
                names.memories[name],
                [c for c in graph.cells if c.kind.startswith("$mem") and memory_id(c) == name],
                self._values,
                names.declared,
            )
            for name, memory in module.memories.items()
            if memory.width and memory.size
        ]

    def text(self) -> str:
        """Write the module; a line is longer than 100 columns only if unbreakable."""
        lines = [*self._head(), *self._declarations()]
        for block in self._blocks():
            if inner := list(block):
                lines += ["", *(f"  {line}" for line in inner)]
        lines.append("endmodule")
        return "\n".join(piece for line in lines for piece in wrap(line, "//")) + "\n"

    def _choice(self, spec: Spec, bits: str) -> str:
        (chunk,) = spec
        assert isinstance(chunk, Slice)
        owner = self._graph.name_of.get(chunk.wire, chunk.wire)
        return enumeration(self._module.wires[owner], bits)

    def _head(self) -> Iterator[str]:
        ports = self._names.ports
        name = self._entities[self._module.name]
        yield f"module {name} (" if ports else f"module {name};"
        ways = [f"{port.direction} wire {_range(port.outer.width)}".rstrip() for port in ports]
        size = max(map(len, ways), default=0)
        for index, (port, way) in enumerate(zip(ports, ways, strict=True)):
            end = "" if index == len(ports) - 1 else ","
            yield f"  {way:<{size}} {port.outer.name}{end}{self._remark(port.wire)}"
        if ports:
            yield ");"

    def _remark(self, wire: str) -> str:
        text = remark_of(self._module.wires[self._graph.name_of.get(wire, wire)])
        return f"  // {text}" if text else ""

    def _declarations(self) -> Iterator[str]:
        for role, title in _TITLES.items():
            signals = [each for each in self._names.signals if each.role == role]
            if signals:
                yield f"\n  // {title}"
            for each in signals:
                wire = self._module.wires[each.wire]
                owner = self._module.wires[self._graph.name_of.get(each.wire, each.wire)]
                for name, value in {**attributes_of(wire), **attributes_of(owner)}.items():
                    yield f"  (* {_name(name)} = {_constant(value)} *)"
                size = _range(each.declared.width)
                start = ""
                if role == "register":
                    init = wire.attributes.get("init")
                    bits = init.text if isinstance(init, Bits) else "0" * each.declared.width
                    start = f" = {literal(bits)}"
                kind = "reg" if role == "register" else "wire"
                text = f"{kind} {size}{each.declared.name}{start};"
                yield f"  {text}{self._remark(each.wire)}"
        for memory in self._memories:
            yield ""
            yield from (f"  {line}" for line in memory.declarations())

    def _blocks(self) -> Iterator[Iterator[str]]:
        graph = self._graph
        for cell in graph.cells:
            if graph.is_instance(cell):
                yield self._instance(cell)
        yield self._operators()
        for process in graph.processes:
            yield self._process(graph.target(process), process.body)
        for memory in self._memories:
            yield memory.initial(self._names.scope.give(f"{memory.name}_at"))
            yield memory.processes()
        yield self._empty_memory_reads()
        yield from self._registers.processes()
        yield self._connections(graph.drives)
        yield (
            f"assign {port.outer.name} = {port.inner.name};"
            for port in self._names.ports
            if port.inner is not None
        )
        yield self._connections(graph.aliases)
        for cell in graph.cells:
            if cell.kind in ("$check", "$print"):
                yield self._message(cell)

    def _operators(self) -> Iterator[str]:
        graph = self._graph
        for cell in graph.cells:
            if cell.kind in INLINE and output(cell) not in graph.folded:
                name = self._names.declared[output(cell)].name
                yield f"assign {name} = {self._values.result(cell).text};"
            elif cell.kind == "$tribuf":
                for target, value in self._parts(cell.ports["Y"], cell.ports["A"]):
                    enable = self._values.boolean(cell.ports["EN"]).inside()
                    off = f"{spec_width(value)}'bz"
                    on = self._values.value(value).inside()
                    yield f"assign {target} = {enable} ? {on} : {off};"

    def _connections(self, pairs: Sequence[tuple[Spec, Spec]]) -> Iterator[str]:
        for target, value in pairs:
            for name, each in self._parts(target, value):
                yield f"assign {name} = {self._values.value(each).text};"

    def _parts(self, target: Spec, value: Spec) -> Iterator[tuple[str, Spec]]:
        position = 0
        for chunk in target:
            assert isinstance(chunk, Slice)
            name = part(self._names.declared[chunk.wire], chunk.low, chunk.width)
            yield name, cut(value, position, chunk.width)
            position += chunk.width

    def _process(self, wire: str, body: tuple[Statement, ...]) -> Iterator[str]:
        """Yield a choice: a conditional expression, or a function."""
        target, statements = self._names.declared[wire], flatten(body)
        writer = _Statements(self._values, self._targets, self._choice)
        pairs = writer.conditional(statements)
        if pairs is not None:
            head = f"assign {target.name} ="
            for value, condition in pairs:
                yield f"{head} {condition} ? {value} :" if condition else f"{head} {value};"
                head = "   "
            return
        function = Declared(name=self._names.scope.give(f"f_{target.name}"), width=target.width)
        writer = _Statements(self._values, {**self._targets, wire: function}, self._choice)
        writer.operator = "="
        self._values.reads = {}
        lines = list(writer.body(statements))
        reads = list(self._values.reads.values())
        yield f"function {_range(target.width)}{function.name};"
        yield from (f"  input {_range(each.width)}{each.name};" for each in reads)
        yield "  begin"
        yield from (f"    {line}" for line in lines)
        yield "  end"
        yield "endfunction"
        yield f"assign {target.name} = {function.name}({', '.join(each.name for each in reads)});"

    def _empty_memory_reads(self) -> Iterator[str]:
        """Yield the value 0 for read ports of memories without words."""
        for cell in self._graph.cells:
            if cell.kind == "$memrd_v2" and not self._module.memories[memory_id(cell)].size:
                target = self._names.declared[output(cell)]
                yield f"assign {target.name} = {literal('0' * target.width)};"

    def _instance(self, cell: Cell) -> Iterator[str]:
        own = cell.kind in self._modules
        kind = self._entities[cell.kind] if own else _name(cell.kind)
        label = self._names.labels[cell.name]
        settings = {} if own else cell.parameters
        generics = ", ".join(f".{_name(n)}({_constant(v)})" for n, v in settings.items())
        yield f"{kind}{f' #({generics})' if generics else ''} {label} ("
        ports = {}
        for port, spec in cell.ports.items():
            name = self._port_names[cell.kind][port] if own and spec else _name(port)
            if spec:
                ports[name] = self._values.value(spec).text
        size = max(map(len, ports), default=0)
        for index, (name, text) in enumerate(ports.items()):
            yield f"  .{name:<{size}} ({text}){'' if index == len(ports) - 1 else ','}"
        yield ");"

    def _message(self, cell: Cell) -> Iterator[str]:
        """Yield what a `Print`, `Assert` or `Assume` does in a simulation."""
        flavor = str(cell.parameters.get("FLAVOR", "print"))
        if flavor == "cover":
            yield f"// Cover: {self._values.logic(cell.ports['A']).text}"
            return
        text, arguments = _format(cell, self._values)
        tests = []
        if flavor != "print":
            tests.append(self._values.boolean(cell.ports["A"], inverted=True))
            word = "assumption" if flavor == "assume" else "assertion"
            text = text or f"{word} failed in {self._module.name}\n"
        clock = cell.ports.get("TRG", ())
        edge = "posedge" if int_parameter(cell, "TRG_POLARITY") else "negedge"
        when = f"{edge} {self._values.logic(clock).text}" if clock else "*"
        lines = [f"$write({', '.join([_quoted(text), *arguments])});"]
        if flavor != "print":
            lines.append("$stop;")
        yield f"always @({when}) begin"
        guarded = _guarded([cell.ports["EN"]], self._values, lines, tests)
        yield from (f"  {line}" for line in guarded)
        yield "end"


def _format(cell: Cell, values: Values) -> tuple[str, list[str]]:
    """Return the format and the arguments of a message."""
    template, low = str(cell.parameters.get("FORMAT", "")), 0
    arguments: list[str] = []

    def field(match: re.Match[str]) -> str:
        nonlocal low
        if match[1] is None:
            return match[0][0]
        width, kind, sign = int(match[1]), match[2] or "c", match[3]
        if not width:
            return "0"
        text = values.value(cut(cell.ports["ARGS"], low, width)).text
        low += width
        arguments.append(f"$signed({text})" if sign == "s" and kind == "d" else text)
        return "%s" if kind == "c" else f"%0{kind.lower()}"

    return FIELD.sub(field, template.replace("%", "%%")), arguments


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return '"' + escaped.replace("\t", "\\t") + '"'


def _range(width: int) -> str:
    return f"[{width - 1}:0] " if width > 1 else ""


_PLAIN = re.compile(r"[A-Za-z_][A-Za-z0-9_$]*")


def _name(name: str) -> str:
    """Keep a foreign name unchanged, escaped if necessary."""
    return name if _PLAIN.fullmatch(name) and name not in VERILOG else f"\\{name} "


def _constant(value: Value) -> str:
    if isinstance(value, Bits):
        return f"{value.width}'b{value.text}"
    return _quoted(value) if isinstance(value, str) else repr(value)
