"""Read the RTLIL text that Amaranth prints.

RTLIL is the only public, complete and stable form of an elaborated Amaranth circuit
(`amaranth.back.rtlil.convert`), so every back end starts here. The reader accepts the subset that
Amaranth 0.5 can emit; anything else is a `ValueError` with the number of the line.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NoReturn

from firm_hdl.rtlil.ir import (
    Assign,
    Bits,
    Case,
    Cell,
    Chunk,
    Design,
    Memory,
    Module,
    Process,
    Slice,
    Spec,
    Statement,
    Switch,
    Value,
    Wire,
    spec_width,
)

__all__ = ["parse"]


_CELLS = frozenset(
    "$neg $not $reduce_bool $reduce_or $reduce_and $reduce_xor $add $sub $mul $divfloor $modfloor "
    "$shl $shr $sshr $and $or $xor $eq $ne $lt $le $gt $ge $mux $shift $dff $adff $tribuf "
    "$memrd_v2 $memwr_v2 $meminit_v2 $check $print $anyconst $anyseq $initstate".split()
)
_TOKEN = re.compile(
    r"\s*(?:(\{|\})|(\d+)'([01xz-]*)|(?:\\([^\s]+)|(\$[^\s]+))(?:\s*\[(\d+)(?::(\d+))?\])?)"
)
_WIRE = re.compile(r"wire width (\d+)(?: (input|output|inout) (\d+) *)?( ?signed)? ([\\$]\S+)$")
_MEMORY = re.compile(r"memory width (\d+) size (\d+) ([\\$]\S+)$")
_CELL = re.compile(r"cell ([\\$]\S+) ([\\$]\S+)$")
_VALUE = re.compile(r"(attribute|parameter)(?: (signed|real))? \\(\S+) (.+)$")
_CONST = re.compile(r"(\d+)'([01xz-]*)$")
_ESCAPE = re.compile(r"\\(.)", re.DOTALL)
_ESCAPES = {"t": "\t", "r": "\r", "n": "\n"}


def parse(text: str) -> Design:
    """Parse the text that `amaranth.back.rtlil.convert` returns.

    * `text`: RTLIL, with or without source attributes, which are dropped.

    Returns: all modules.

    Raises `ValueError` if Amaranth 0.5 prints no such line. The message has the number of the line.
    """
    return Design(modules={module.name: module for module in _Parser(text).modules()})


class _Parser:
    def __init__(self, text: str) -> None:
        # Not `splitlines`: it would also split at other characters, which a string may contain.
        lines = enumerate(map(str.strip, text.split("\n")), 1)
        self._lines: Iterator[tuple[int, str]] = (each for each in lines if each[1])
        self._number = 0
        # By line: the name and value of an attribute or parameter, since few differ.
        self._values: dict[str, tuple[str, Value]] = {}
        self._wires: dict[str, Wire] = {}
        self._specs: dict[str, Spec] = {}

    def _fail(self, message: str) -> NoReturn:
        raise ValueError(f"RTLIL line {self._number}: {message}")

    def _next(self) -> str | None:
        self._number, line = next(self._lines, (self._number, None))
        return line

    def _inner(self) -> Iterator[str]:
        """Yield lines up to the `end` of the block that was just opened."""
        while (line := self._next()) is not None:
            if line == "end":
                return
            yield line
        self._fail("the text ends inside a block")

    def modules(self) -> Iterator[Module]:
        attributes: dict[str, Value] = {}
        while (line := self._next()) is not None:
            if line.startswith("attribute "):
                self._value(line, attributes)
            elif line.startswith("module \\"):
                yield self._module(line[8:], attributes)
                attributes = {}
            else:
                self._fail(f"expected a module, not {line!r}")

    def _module(self, name: str, attributes: dict[str, Value]) -> Module:
        self._wires, self._specs = {}, {}
        memories: dict[str, Memory] = {}
        items: list[Cell | Process] = []
        connections: list[tuple[Spec, Spec]] = []
        pending: dict[str, Value] = {}
        for line in self._inner():
            keyword = line.partition(" ")[0]
            if keyword == "attribute":
                self._value(line, pending)
                continue
            if keyword == "wire":
                self._wire(line, pending)
            elif keyword == "cell":
                items.append(self._cell(line, pending))
            elif keyword == "process":
                items.append(self._process(line))
            elif keyword == "connect":
                connections.append(self._pair(line))
            elif keyword == "memory":
                memory = self._memory(line, pending)
                memories[memory.name] = memory
            else:
                self._fail(f"unexpected {line!r} in a module")
            pending = {}
        return Module(
            name=name,
            attributes=attributes,
            wires=self._wires,
            memories=memories,
            items=tuple(items),
            connections=tuple(connections),
        )

    def _wire(self, line: str, attributes: dict[str, Value]) -> None:
        match = _WIRE.match(line) or self._fail(f"malformed wire {line!r}")
        width, direction, _index, signed, name = match.groups()
        name = name.removeprefix("\\")
        if name in self._wires:
            self._fail(f"wire {name!r} is declared twice")
        self._wires[name] = Wire(
            name=name,
            width=int(width),
            signed=signed is not None,
            direction=direction,
            attributes=attributes,
        )

    def _memory(self, line: str, attributes: dict[str, Value]) -> Memory:
        match = _MEMORY.match(line) or self._fail(f"malformed memory {line!r}")
        width, size, name = match.groups()
        return Memory(
            name=name.removeprefix("\\"), width=int(width), size=int(size), attributes=attributes
        )

    def _cell(self, line: str, attributes: dict[str, Value]) -> Cell:
        number = self._number
        match = _CELL.match(line) or self._fail(f"malformed cell {line!r}")
        kind, name = match.groups()
        if kind.startswith("$") and kind not in _CELLS:
            self._fail(f"Amaranth 0.5 emits no cells of kind {kind}")
        parameters: dict[str, Value] = {}
        ports: dict[str, Spec] = {}
        for inner in self._inner():
            if inner.startswith("parameter "):
                self._value(inner, parameters)
            elif inner.startswith("connect \\"):
                port, _, spec = inner[9:].partition(" ")
                ports[port] = self._spec(spec)
            else:
                self._fail(f"unexpected {inner!r} in a cell")
        return Cell(
            kind=kind.removeprefix("\\") if kind.startswith("\\") else kind,
            name=name.removeprefix("\\"),
            parameters=parameters,
            ports=ports,
            attributes=attributes,
            line=number,
        )

    def _process(self, line: str) -> Process:
        number = self._number
        body, last = self._body()
        if last != "end":
            self._fail(f"unexpected {last!r} in a process")
        return Process(name=line.partition(" ")[2], body=body, line=number)

    def _body(self) -> tuple[tuple[Statement, ...], str]:
        """Parse statements; return them and the first line that is not a statement."""
        body: list[Statement] = []
        while (line := self._next()) is not None:
            if line.startswith("assign "):
                target, value = self._pair(line)
                body.append(Assign(target=target, value=value))
            elif line.startswith("switch "):
                body.append(self._switch(line))
            else:
                return tuple(body), line
        return self._fail("the text ends inside a process")

    def _switch(self, line: str) -> Switch:
        selector = self._spec(line[7:])
        cases: list[Case] = []
        last = self._next()
        while last != "end":
            if last is None or not (last == "case" or last.startswith("case ")):
                self._fail(f"expected a case, not {last!r}")
            patterns = tuple(self._pattern(p, selector) for p in last[5:].split(", ") if p)
            body, last = self._body()
            cases.append(Case(patterns=patterns, body=body))
        return Switch(selector=selector, cases=tuple(cases))

    def _pattern(self, text: str, selector: Spec) -> str:
        match = _CONST.match(text)
        if match is None or int(match[1]) != len(match[2]) or len(match[2]) != spec_width(selector):
            self._fail(f"pattern {text!r} does not fit its switch")
        return match[2]

    def _pair(self, line: str) -> tuple[Spec, Spec]:
        """Split a line of a keyword and two specifications."""
        rest = line.partition(" ")[2]
        if rest.startswith("{"):
            # Without an end, all is the target, and malformed.
            split = rest.find("}") + 1 or len(rest)
        else:
            match = re.match(r"\S+(?: \[[\d:]+\])?", rest)
            split = match.end() if match else 0
        target, value = self._spec(rest[:split]), self._spec(rest[split:].strip())
        if spec_width(target) != spec_width(value):
            self._fail(f"widths {spec_width(target)} and {spec_width(value)} differ")
        return target, value

    def _spec(self, text: str) -> Spec:
        spec = self._specs.get(text)
        if spec is None:
            spec = self._specs[text] = self._parse_spec(text)
        return spec

    def _parse_spec(self, text: str) -> Spec:
        chunks: list[Chunk] = []
        position, depth = 0, 0
        while position < len(text):
            match = _TOKEN.match(text, position)
            if match is None:
                self._fail(f"malformed signal {text!r}")
            position = match.end()
            brace, size, bits, name, generated, high, low = match.groups()
            if brace:
                depth += 1 if brace == "{" else -1
            elif bits is not None:
                missing = int(size) - len(bits)
                if missing < 0 or (missing and not bits):
                    self._fail(f"constant {size}'{bits} has {len(bits)} bits")
                if bits:
                    # Missing digits are the first one, but 0 for 1.
                    fill = "0" if bits[0] == "1" else bits[0]
                    chunks.append(Bits(fill * missing + bits))
            else:
                wire = self._wires.get(name or generated)
                if wire is None:
                    self._fail(f"no wire {name or generated!r}")
                chunks.append(self._cut(wire, high, low))
        if depth or (len(chunks) != 1 and not text.startswith("{") and "'" not in text):
            self._fail(f"malformed signal {text!r}")
        return tuple(chunk for chunk in reversed(chunks) if chunk.width)

    def _cut(self, wire: Wire, high: str | None, low: str | None) -> Slice:
        if high is None:
            return Slice(wire.name, 0, wire.width, True)
        top, bottom = int(high), int(low or high)
        if not bottom <= top < wire.width:
            self._fail(f"slice [{top}:{bottom}] is out of range")
        return Slice(wire.name, bottom, top - bottom + 1)

    def _value(self, line: str, into: dict[str, Value]) -> None:
        found = self._values.get(line)
        if found is None:
            match = _VALUE.match(line) or self._fail(f"malformed {line!r}")
            _keyword, flag, name, text = match.groups()
            found = self._values[line] = name, self._constant(text, flag)
        into[found[0]] = found[1]

    def _constant(self, text: str, flag: str | None) -> Value:
        if text.startswith('"') and text.endswith('"') and len(text) > 1:
            inner = _ESCAPE.sub(lambda m: _ESCAPES.get(m[1], m[1]), text[1:-1])
            return float(inner) if flag == "real" else inner
        if text.isascii() and text.isdecimal():
            return int(text)
        match = _CONST.match(text)
        # Amaranth prints the initial value of a register without bits as 0'0.
        if match is None or (int(match[1]) != len(match[2]) and text != "0'0"):
            self._fail(f"malformed constant {text!r}")
        bits = match[2] if int(match[1]) else ""
        if flag == "signed" and bits:
            return int(bits, 2) - ((bits[0] == "1") << len(bits))
        return Bits(bits)
