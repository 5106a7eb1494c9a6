"""One module as Verilog-2005 that means the same in SystemVerilog.

Combinational logic is in continuous assignments, which every simulator evaluates at time zero. An
``always @*`` would wait for a change of a signal that it reads. The initial value of a register is
such a change in Verilog, but not in SystemVerilog (IEEE Std 1800-2017, clause 6.8: initializers
are executed before any process starts). So a choice that is no conditional expression becomes a
function, whose parameters are the signals that it reads.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

from firm_hdl.names.keywords import VERILOG
from firm_hdl.rtlil.ir import (
    Assign,
    Bits,
    Case,
    Cell,
    Slice,
    Spec,
    Statement,
    Switch,
    Value,
    cut,
    spec_width,
)
from firm_hdl.verilog.expr import Expression, Values, infix, is_foldable, literal, part
from firm_hdl.vhdl.expr import Declared
from firm_hdl.vhdl.memory import MemoryText
from firm_hdl.vhdl.messages import FIELD
from firm_hdl.vhdl.process import Arm, Statements
from firm_hdl.vhdl.registers import Group, Register, Registers
from firm_hdl.vhdl.text import wrap
from firm_hdl.vhdl.uses import enable_runs, int_parameter
from firm_hdl.vhdl.writer import TITLES, Writer

__all__ = ["ModuleWriter"]


class _Statements(Statements):
    """Writes statements; in a function, they are not clocked."""

    values: Values
    true = "1'b1"
    literal = staticmethod(literal)
    operator = "<="

    def all_of(self, *tests: Any) -> Expression:
        return infix("&&", *tests)

    def any_of(self, *tests: Any) -> Expression:
        return infix("||", *tests)

    def equal(self, spec: Spec, bits: str) -> Expression:
        if len(bits) > 1:
            return infix("==", self.values.value(spec), Expression(self.choice(spec, bits)))
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
            value = self.chosen(chunk, spec) or self.values.value(spec)
            yield f"{name} {self.operator} {value.text};"

    def choose(self, chunk: Slice, cell: Cell) -> Iterator[str]:
        b, a = (
            Assign(target=(chunk,), value=cut(cell.ports[port], 0, chunk.width)) for port in "BA"
        )
        yield from self.if_([Arm(self.values.boolean(cell.ports["S"]), (b,)), Arm(None, (a,))])

    def choice_of(self, target: Slice, select: Spec, b: Spec, a: Spec) -> str:
        name = part(self.targets[target.wire], target.low, target.width)
        one, other = (self.values.value(spec).operand() for spec in (b, a))
        return f"{name} {self.operator} {self.values.boolean(select).operand()} ? {one} : {other};"

    def case(self, switch: Switch, plain: list[tuple[list[str], Case]]) -> Iterator[str]:
        yield f"case ({self.values.value(switch.selector).text})"
        for patterns, case in plain:
            named = (self.choice(switch.selector, p) for p in sorted(patterns))
            choices = ", ".join(named) or "default"
            lines = list(self.body(case.body))
            if len(lines) < 2:
                yield f"  {choices}: {lines[0] if lines else ';'}"
                continue
            yield f"  {choices}: begin"
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
        (chunk,) = statement.target
        assert isinstance(chunk, Slice)
        named = self.chosen(chunk, statement.value)
        return named.text if named else self.values.value(statement.value).operand()


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

    values: Values

    def declarations(self, counter: str = "") -> Iterator[str]:
        """Yield the declaration and the initial values; `counter` is a free name."""
        yield f"reg [{self.memory.width - 1}:0] {self.name} [0:{self.memory.size - 1}];"
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


class ModuleWriter(Writer):
    """Writes one module."""

    mark = "//"
    value_writer = Values
    statement_writer = _Statements
    register_writer = _Registers
    memory_writer = _Memory
    is_foldable = staticmethod(is_foldable)

    def text(self) -> str:
        """Write the module; a line is longer than 100 columns only if unbreakable."""
        # The body shows which constants are used.
        blocks = [list(block) for block in self.blocks()]
        lines = [*self._head(), *self._declarations()]
        for inner in filter(None, blocks):
            lines += ["", *(f"  {line}" for line in inner)]
        lines.append("endmodule")
        return "\n".join(piece for line in lines for piece in wrap(line, "//")) + "\n"

    def _head(self) -> Iterator[str]:
        ports = self.names.ports
        name = self.entities[self.module.name]
        yield from self.purpose()
        yield f"module {name} (" if ports else f"module {name};"
        ways = [f"{port.direction} wire {_range(port.outer.width)}".rstrip() for port in ports]
        size = max(map(len, ways), default=0)
        for index, (port, way) in enumerate(zip(ports, ways, strict=True)):
            end = "" if index == len(ports) - 1 else ","
            yield f"  {way:<{size}} {port.outer.name}{end}{self.remark(port.wire, layout=True)}"
        if ports:
            yield ");"

    def _declarations(self) -> Iterator[str]:
        for name, bits in self.constants():
            yield f"  localparam {_range(len(bits))}{name} = {literal(bits)};"
        for role, title in TITLES.items():
            signals = [each for each in self.names.signals if each.role == role]
            if signals:
                yield f"\n  // {title}"
            for each in signals:
                for name, value in self.attributes(each).items():
                    yield f"  (* {_name(name)} = {_constant(value)} *)"
                size = _range(each.declared.width)
                start = ""
                if role == "register":
                    init = self.module.wires[each.wire].attributes.get("init")
                    bits = init.text if isinstance(init, Bits) else "0" * each.declared.width
                    start = f" = {literal(bits)}"
                kind = "reg" if role == "register" else "wire"
                text = f"{kind} {size}{each.declared.name}{start};"
                yield f"  {text}{self.remark(each.wire, layout=role == 'register')}"
        for memory in self.memories:
            yield ""
            counter = self.names.scope.give(f"{memory.name}_at")
            yield from (f"  {line}" for line in memory.declarations(counter))

    def operator(self, target: Declared, cell: Cell) -> Iterator[str]:
        yield f"assign {target.name} = {self.values.result(cell).text};"

    def assign(self, target: Declared, chunk: Slice, value: Spec, enable: Spec) -> Iterator[str]:
        text = self.values.value(value)
        if enable:
            on, off = self.values.boolean(enable).operand(), f"{chunk.width}'bz"
            text = Expression(f"{on} ? {text.operand()} : {off}", "?")
        yield f"assign {part(target, chunk.low, chunk.width)} = {text.text};"

    def outputs(self) -> Iterator[str]:
        for port in self.names.ports:
            if port.inner is not None:
                yield f"assign {port.outer.name} = {port.inner.name};"

    def process(self, wire: str, statements: tuple[Statement, ...]) -> Iterator[str]:
        """Yield a choice: a conditional expression, or a function."""
        target = self.names.declared[wire]
        pairs = self.statements.conditional(statements)
        if pairs is not None:
            head = f"assign {target.name} ="
            for value, condition in pairs:
                yield f"{head} {condition} ? {value} :" if condition else f"{head} {value};"
                head = "   "
            return
        function = Declared(name=self.names.scope.give(f"f_{target.name}"), width=target.width)
        writer = _Statements(self.values, {**self.targets, wire: function})
        writer.operator = "="
        self.values.reads = {}
        lines = list(writer.body(statements))
        reads = list(self.values.reads.values())
        yield f"function {_range(target.width)}{function.name};"
        yield from (f"  input {_range(each.width)}{each.name};" for each in reads)
        yield "  begin"
        yield from (f"    {line}" for line in lines)
        yield "  end"
        yield "endfunction"
        yield f"assign {target.name} = {function.name}({', '.join(each.name for each in reads)});"

    def instance(self, cell: Cell) -> Iterator[str]:
        own = cell.kind in self.modules
        kind = self.entities[cell.kind] if own else _name(cell.kind)
        label = self.names.labels[cell.name]
        settings = {} if own else cell.parameters
        generics = ", ".join(f".{_name(n)}({_constant(v)})" for n, v in settings.items())
        yield f"{kind}{f' #({generics})' if generics else ''} {label} ("
        ports = {}
        for port, spec in cell.ports.items():
            name = self.port_names[cell.kind][port] if own and spec else _name(port)
            if spec:
                ports[name] = self.values.value(spec).text
        size = max(map(len, ports), default=0)
        for index, (name, text) in enumerate(ports.items()):
            yield f"  .{name:<{size}} ({text}){'' if index == len(ports) - 1 else ','}"
        yield ");"

    def message(self, cell: Cell) -> Iterator[str]:
        flavor = str(cell.parameters.get("FLAVOR", "print"))
        if flavor == "cover":
            yield f"// Cover: {self.values.logic(cell.ports['A']).text}"
            return
        text, arguments = _format(cell, self.values)
        tests = []
        if flavor != "print":
            tests.append(self.values.boolean(cell.ports["A"], inverted=True))
            word = "assumption" if flavor == "assume" else "assertion"
            text = text or f"{word} failed in {self.module.name}\n"
        clock = cell.ports.get("TRG", ())
        edge = "posedge" if int_parameter(cell, "TRG_POLARITY") else "negedge"
        when = f"{edge} {self.values.logic(clock).text}" if clock else "*"
        lines = [f"$write({', '.join([_quoted(text), *arguments])});"]
        if flavor != "print":
            lines.append("$stop;")
        yield f"always @({when}) begin"
        guarded = _guarded([cell.ports["EN"]], self.values, lines, tests)
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
