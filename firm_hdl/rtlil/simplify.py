"""Simplify a module: replace values that are constant or equal to another value.

Amaranth does not evaluate operators on constants. Generated circuits have many such operators: for
example, a comparison with a constant 0, or a condition that no input of the module can meet.
Neither does Amaranth notice that two operators compute the same: here, one of them remains.
Registers with a constant value are replaced, too, and so is all that waits for an edge of a
constant clock. Other parts of memories, and instances, stay.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from firm_hdl.rtlil.evaluate import constant, evaluate
from firm_hdl.rtlil.fields import with_fields
from firm_hdl.rtlil.ir import (
    Assign,
    Bits,
    Case,
    Cell,
    Design,
    Module,
    Process,
    Slice,
    Spec,
    Statement,
    Switch,
    cut,
    join,
    spec_width,
)
from firm_hdl.rtlil.read import parse

__all__ = ["netlist_of", "simplified"]

_FREE = ("$anyconst", "$anyseq")
"""Operators whose result is not determined by their operands."""

_CLOCKED = ("$memrd_v2", "$memwr_v2", "$check", "$print")
_OUTPUTS = {"$dff": "Q", "$adff": "Q", "$memrd_v2": "DATA", "$tribuf": "Y"}


def netlist_of(text: str) -> Design:
    """Read RTLIL as Amaranth prints it, simplify it, and read fields of structures by name.

    Raises `ValueError` if Amaranth 0.5 prints no such text, or the design is empty.
    """
    design = parse(text)
    if not design.modules:
        raise ValueError("The design is empty: it has no module with anything in it")
    modules = (with_fields(simplified(module)) for module in design.modules.values())
    return Design(modules={module.name: module for module in modules})


def simplified(module: Module) -> Module:
    """Return an equivalent module with fewer operators and statements."""
    return _Simplifier(module).run()


class _Simplifier:
    def __init__(self, module: Module) -> None:
        self._module = module
        self._known: dict[str, Spec] = {}
        # The result of each operator, by what computes it.
        self._computed: dict[tuple[object, ...], Spec] = {}
        self._changed = True

    def run(self) -> Module:
        items = self._module.items
        while self._changed:
            self._changed = False
            items = tuple(self._pass(items))
        connections = [(target, self._resolve(value)) for target, value in self._module.connections]
        # A wire whose value is known has no driver any more. If it has a name, the name stays.
        for name in self._known:
            if not name.startswith("$"):
                whole = Slice(name, 0, self._module.wires[name].width, True)
                connections.append(((whole,), self._resolve((whole,))))
        return replace(self._module, items=items, connections=tuple(connections))

    def _resolve(self, spec: Spec) -> Spec:
        if not any(isinstance(chunk, Slice) and chunk.wire in self._known for chunk in spec):
            return spec
        parts: list[Spec] = []
        for chunk in spec:
            if isinstance(chunk, Slice) and chunk.wire in self._known:
                parts.append(self._resolve(cut(self._known[chunk.wire], chunk.low, chunk.width)))
            else:
                parts.append((chunk,))
        return join(*parts)

    def _pass(self, items: tuple[Cell | Process, ...]) -> Iterator[Cell | Process]:
        for item in items:
            kept = self._cell(item) if isinstance(item, Cell) else self._process(item)
            if kept is not None:
                yield kept

    def _cell(self, cell: Cell) -> Cell | None:
        if "Y" in cell.ports and cell.kind.startswith("$") and cell.kind != "$tribuf":
            ports = {
                port: spec if port == "Y" else self._resolve(spec)
                for port, spec in cell.ports.items()
            }
            cell = replace(cell, ports=ports) if ports != cell.ports else cell
            value = evaluate(cell) or self._equal(cell)
            if value is None or not ports["Y"]:
                return cell
            self._learn(ports["Y"], value)
            return None
        output = _OUTPUTS.get(cell.kind)
        ports = {
            port: spec if port == output else self._resolve(spec)
            for port, spec in cell.ports.items()
        }
        if cell.kind in ("$dff", "$adff") and (value := self._constant_register(cell, ports)):
            self._learn(ports["Q"], value)
            return None
        if cell.kind in _CLOCKED and _stands_still(cell, ports):
            if cell.kind == "$memrd_v2":
                # Its register starts at 0.
                self._learn(ports["DATA"], (Bits("0" * spec_width(ports["DATA"])),))
            return None
        return replace(cell, ports=ports) if ports != cell.ports else cell

    def _equal(self, cell: Cell) -> Spec | None:
        """Return the result of another operator that computes the same, else `None`."""
        if cell.kind in _FREE:
            return None
        operands = (item for item in cell.ports.items() if item[0] != "Y")
        parameters = tuple(cell.parameters.items())
        result = cell.ports["Y"]
        key = (cell.kind, parameters, *operands)
        first = self._computed.setdefault(key, result)
        return None if first == result else first

    def _constant_register(self, cell: Cell, ports: Mapping[str, Spec]) -> Spec:
        """Return the value of a register that always keeps its initial value."""
        if not ports["Q"]:
            return ()
        (chunk,) = ports["Q"]
        assert isinstance(chunk, Slice)
        init = self._module.wires[chunk.wire].attributes.get("init")
        if not isinstance(init, Bits) or cell.parameters.get("ARST_VALUE", init) != init:
            return ()
        keeps = _stands_still(cell, ports) or ports["D"] in (ports["Q"], (init,))
        return (init,) if keeps else ()

    def _learn(self, target: Spec, value: Spec) -> None:
        (chunk,) = target
        assert isinstance(chunk, Slice) and spec_width(value) == chunk.width
        self._known[chunk.wire] = value
        self._changed = True

    def _process(self, process: Process) -> Process | None:
        target = _whole_target(process)
        if target is None:
            return process
        body = self._body(process.body, None, start=True)
        if body and all(isinstance(statement, Assign) for statement in body):
            value: Spec = ()
            for statement in body:
                assert isinstance(statement, Assign)
                value = _overlaid(value, statement)
            self._learn(target, value)
            return None
        return replace(process, body=body)

    def _body(
        self, body: tuple[Statement, ...], state: Spec | None, *, start: bool = False
    ) -> tuple[Statement, ...]:
        """Simplify statements.

        * `state`: value of the whole target after the statements before, if known.
        * `start`: whether the body is that of a process, whose first assignment is the default of
          the whole target.
        """
        result: list[Statement] = []
        pending = list(reversed(body))
        while pending:
            statement = pending.pop()
            if isinstance(statement, Switch):
                taken = self._switch(statement, state)
                if any(isinstance(inner, Switch) for inner in taken):
                    result.extend(taken)
                    state = None
                else:
                    pending.extend(reversed(taken))
                continue
            value = self._resolve(statement.value)
            if not value or value == state:
                continue
            whole = start and not result
            whole |= state is not None and spec_width(state) == spec_width(value)
            state = value if whole else None
            _append(result, Assign(target=statement.target, value=value))
        return tuple(result)

    def _switch(self, switch: Switch, state: Spec | None) -> tuple[Statement, ...]:
        selector = self._resolve(switch.selector)
        fixed, kept, positions = _split(selector)
        cases: list[Case] = []
        for case in switch.cases:
            patterns = [
                "".join(pattern[i] for i in positions)
                for pattern in case.patterns
                if all(pattern[i] in (mark, "-") for i, mark in fixed.items())
            ]
            if case.patterns and not patterns:
                continue
            total = not case.patterns or any(not pattern.strip("-") for pattern in patterns)
            unique = () if total else tuple(dict.fromkeys(patterns))
            cases.append(Case(patterns=unique, body=self._body(case.body, state)))
            if total:
                break
        cases = _without_empty(cases)
        if not cases:
            return ()
        if not cases[0].patterns:
            return cases[0].body
        return (Switch(selector=kept, cases=tuple(cases)),)


def _stands_still(cell: Cell, ports: Mapping[str, Spec]) -> bool:
    """Return whether a cell has a clock, and the clock is constant."""
    if cell.kind == "$memrd_v2" and (cell.parameters.get("CLK_ENABLE") != 1 or not ports["DATA"]):
        return False
    clock = ports.get("TRG" if cell.kind in ("$check", "$print") else "CLK", ())
    return bool(clock) and constant(clock) is not None


def _without_empty(cases: list[Case]) -> list[Case]:
    """Drop arms without statements, unless a later arm would match instead."""
    while cases and not cases[-1].body:
        cases = cases[:-1]
    if any(not c.patterns or any("-" in pattern for pattern in c.patterns) for c in cases):
        return cases
    seen: set[str] = set()
    result: list[Case] = []
    for case in cases:
        patterns = tuple(pattern for pattern in case.patterns if pattern not in seen)
        seen.update(patterns)
        if patterns and case.body:
            result.append(Case(patterns=patterns, body=case.body))
    return result


def _append(result: list[Statement], statement: Assign) -> None:
    """Add an assignment; join it with the last one if their targets are adjacent."""
    last = result[-1] if result else None
    if isinstance(last, Assign) and len(last.target) == len(statement.target) == 1:
        target = join(last.target, statement.target)
        if len(target) == 1:
            result[-1] = Assign(target=target, value=join(last.value, statement.value))
            return
    result.append(statement)


def _whole_target(process: Process) -> Spec | None:
    """Return the wire that a process drives: the target of the first assignment."""
    first = process.body[0] if process.body else None
    if not isinstance(first, Assign) or not first.target:
        return None
    (chunk,) = first.target
    assert isinstance(chunk, Slice)
    return (chunk,)


def _overlaid(value: Spec, statement: Assign) -> Spec:
    """Replace the bits of a value to which a statement assigns."""
    if not value:
        return statement.value
    (chunk,) = statement.target
    assert isinstance(chunk, Slice)
    top = chunk.low + chunk.width
    return join(cut(value, 0, chunk.low), statement.value, cut(value, top, spec_width(value) - top))


def _split(selector: Spec) -> tuple[dict[int, str], Spec, list[int]]:
    """Split a selector into constant bits by pattern position, other bits, and their positions.

    Position 0 is that of the first digit of a pattern, and so of the highest bit of the selector.
    """
    fixed: dict[int, str] = {}
    kept: list[Spec] = []
    positions: list[int] = []
    end = spec_width(selector)
    for chunk in selector:
        places = range(end - chunk.width, end)
        end -= chunk.width
        if constant((chunk,)) is None:
            kept.append((chunk,))
            positions[:0] = places
        else:
            assert isinstance(chunk, Bits)
            fixed.update(zip(places, chunk.text, strict=True))
    return fixed, join(*kept), positions
